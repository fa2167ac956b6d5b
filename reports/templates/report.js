"use strict";
(async () => {
  const config = {
    responsive: true,
    displaylogo: false,
    displayModeBar: "hover",
    toImageButtonOptions: { format: "png", scale: 2 },
  };
  // printers do not draw WebGL: a picture of each 3-D view stands in for it on paper
  const photograph = async (drawing) => {
    const url = await Plotly.toImage(drawing, { format: "png", width: 1000, height: 700 });
    let picture = drawing.parentElement.querySelector(".print");
    if (!picture) {
      picture = document.createElement("img");
      picture.className = "print";
      picture.alt = drawing.getAttribute("aria-label");
      drawing.after(picture);
    }
    picture.src = url;
  };
  const flat = [["toImage"], ["zoom2d", "pan2d", "resetScale2d"]];
  const solid = [["toImage"], ["orbitRotation", "zoom3d", "pan3d", "resetCameraDefault3d"]];
  const solids = [];
  const failures = [];
  for (const figure of document.querySelectorAll("figure.plot")) {
    const drawing = figure.querySelector(".drawing");
    try {
      const spec = JSON.parse(figure.querySelector("script").textContent);
      if (spec.layout.scene) {
        // in a narrow window the view needs more room around it, or its labels are cut
        const { eye } = spec.layout.scene.camera;
        const away = Math.min(1.35, Math.max(1, 700 / drawing.clientWidth));
        for (const side of ["x", "y", "z"]) eye[side] *= away;
      }
      const modeBarButtons = spec.layout.scene ? solid : flat;
      await Plotly.newPlot(drawing, spec.data, spec.layout, { ...config, modeBarButtons });
      if (spec.layout.scene) {
        drawing.classList.add("solid");
        solids.push(drawing);
      }
    } catch (error) {
      drawing.textContent = "This plot could not be drawn here; its numbers are in the data files.";
      failures.push(figure.id);
      console.error(`figure ${figure.id}:`, error);
    }
  }
  document.documentElement.dataset.plots = failures.length ? `failed: ${failures}` : "drawn";
  for (const drawing of solids) {
    await new Promise((resolve) => setTimeout(resolve, 200));
    await photograph(drawing);
    drawing.on("plotly_relayout", () => photograph(drawing));
  }
})();
