"use strict";
(async () => {
  const config = {
    responsive: true,
    displaylogo: false,
    displayModeBar: "hover",
    toImageButtonOptions: { format: "png", scale: 2 },
  };
  const flat = [["toImage"], ["zoom2d", "pan2d", "resetScale2d"]];
  const solid = [["toImage"], ["orbitRotation", "zoom3d", "pan3d", "resetCameraDefault3d"]];
  const still = window.matchMedia("(prefers-reduced-motion: reduce)");
  // a mode swings about the shape at rest; with reduced motion each press shows the other extreme
  const swing = (figure, drawing, motion) => {
    const parts = motion.also ? [motion, motion.also] : [motion];
    const choice = figure.querySelector(".modes select");
    const button = figure.querySelector(".modes button");
    const reach = figure.querySelector(".modes input");
    let phase = Math.PI / 2;
    let before = null;
    const show = async () => {
      const turn = Math.sin(phase) * reach.value;
      for (const { trace, colour = "line.color", rest, modes } of parts) {
        const mode = modes[choice.value];
        const at = (side) =>
          rest[side].map((v, i) => (v === null ? null : v + turn * mode[side][i]));
        const moved = { x: [at("x")], y: [at("y")], z: [at("z")], [colour]: [mode.size] };
        await Plotly.restyle(drawing, moved, [trace]);
      }
    };
    const stop = () => {
      before = null;
      button.textContent = still.matches ? "Other extreme" : "Play";
    };
    const frame = async (now) => {
      if (before === null) return;
      if (now - before >= 40) {
        phase += (2 * Math.PI * Math.min(now - before, 100)) / 2000;
        before = now;
        await show();
      }
      requestAnimationFrame(frame);
    };
    button.addEventListener("click", () => {
      if (still.matches) {
        phase = phase > 0 && phase < Math.PI ? -Math.PI / 2 : Math.PI / 2;
        show();
      } else if (before === null) {
        before = performance.now();
        button.textContent = "Pause";
        requestAnimationFrame(frame);
      } else {
        stop();
      }
    });
    const chosen = () => {
      if (before === null) phase = Math.PI / 2;
      return show();
    };
    choice.addEventListener("change", chosen);
    reach.addEventListener("change", chosen);
    still.addEventListener("change", stop);
    // nobody sees it: let the processor rest
    new IntersectionObserver(([seen]) => seen.isIntersecting || stop()).observe(drawing);
    stop();
  };
  const failures = [];
  const state = document.documentElement.dataset;
  const draw = async (figure) => {
    const drawing = figure.querySelector(".drawing");
    try {
      const spec = JSON.parse(figure.querySelector("script").textContent);
      if (spec.layout.scene) {
        // in a narrow window the view needs more room around it, or its labels are cut
        const { eye, center } = spec.layout.scene.camera;
        const away = Math.max(1, (1.15 * drawing.clientHeight) / drawing.clientWidth);
        for (const side of ["x", "y", "z"]) {
          eye[side] = center[side] + away * (eye[side] - center[side]);
        }
      }
      const modeBarButtons = spec.layout.scene ? solid : flat;
      await Plotly.newPlot(drawing, spec.data, spec.layout, { ...config, modeBarButtons });
      // each 3-D view would have the same id
      const view = drawing.querySelector("#scene");
      if (view) view.id = `${figure.id}-scene`;
      if (spec.motion) swing(figure, drawing, spec.motion);
      drawing.on("plotly_click", ({ points: [{ customdata }] }) => {
        figure.dispatchEvent(new CustomEvent("chosen", { detail: customdata }));
      });
      figure.dispatchEvent(new CustomEvent("drawn"));
    } catch (error) {
      drawing.textContent = "This plot could not be drawn here; its numbers are in the data files.";
      failures.push(figure.id);
      console.error(`figure ${figure.id}:`, error);
    }
  };
  // a folded chapter has no room to draw in: its plots wait until somebody opens it
  const started = new Set();
  let work = Promise.resolve();
  const drawOpen = () => {
    // pictures stand in for them on paper
    if (state.paper) return work;
    const figures = [...document.querySelectorAll("figure.plot")].filter(
      (figure) => !started.has(figure) && !figure.closest("details:not([open])"),
    );
    figures.forEach((figure) => started.add(figure));
    work = work.then(async () => {
      for (const figure of figures) await draw(figure);
      const all = document.querySelectorAll("figure.plot").length === started.size;
      const done = all ? "drawn" : "drawn, folded ones apart";
      state.plots = failures.length ? `failed: ${failures}` : done;
    });
    return work;
  };
  // details within a chapter hold tables alone, and stay as the reader left them
  const chapters = [...document.querySelectorAll("main > section > details:not(.more)")];
  for (const chapter of chapters) {
    chapter.addEventListener("toggle", () => chapter.open && drawOpen());
  }
  const unfold = () => {
    for (const chapter of chapters) chapter.open = true;
  };
  document.querySelector(".unfold button")?.addEventListener("click", unfold);
  // a link into a folded chapter opens it
  const arrive = () => {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    const chapter = target.closest("details") ?? target.querySelector(":scope > details");
    if (!chapter || chapter.open) return;
    chapter.open = true;
    target.scrollIntoView();
  };
  window.addEventListener("hashchange", arrive);
  // the same link a second time changes no hash
  document.addEventListener("click", (event) => {
    const link = event.target.closest?.('a[href^="#"]');
    if (link && link.hash === location.hash) arrive();
  });
  // the list of chapters marks the one that is read
  const entries = new Map(
    [...document.querySelectorAll("nav a")].map((link) => [link.hash.slice(1), link]),
  );
  const mark = () => {
    const read = [...document.querySelectorAll("main > section")]
      .filter((section) => section.getBoundingClientRect().top < 0.35 * innerHeight)
      .at(-1);
    for (const [key, link] of entries) {
      if (read && key === read.id) link.setAttribute("aria-current", "true");
      else link.removeAttribute("aria-current");
    }
  };
  let waiting = false;
  const later = () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      mark();
    });
  };
  window.addEventListener("scroll", later, { passive: true });
  mark();
  arrive();
  await drawOpen();
})();
