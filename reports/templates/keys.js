"use strict";
// plots by keyboard: arrows turn or shift, plus and minus zoom, Home shows it as it came
(() => {
  const TURN = Math.PI / 18;
  const ZOOM = 1.2;
  const SHIFT = 0.1;
  const away = { "+": 1 / ZOOM, "=": 1 / ZOOM, "-": ZOOM, _: ZOOM };
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const first = new WeakMap();
  const camera = (drawing, key) => {
    const now = drawing._fullLayout.scene.camera;
    if (!first.has(drawing)) first.set(drawing, structuredClone(now.eye));
    if (key === "Home") return first.get(drawing);
    const { x, y, z } = now.eye;
    const flat = Math.hypot(x, y);
    let [size, round, high] = [Math.hypot(flat, z), Math.atan2(y, x), Math.atan2(z, flat)];
    if (away[key]) {
      size *= away[key];
    } else {
      round += TURN * arrows[key][0];
      // over the pole the picture would stand on its head
      high = Math.min(1.5, Math.max(-1.5, high + TURN * arrows[key][1]));
    }
    const level = size * Math.cos(high);
    return { x: level * Math.cos(round), y: level * Math.sin(round), z: size * Math.sin(high) };
  };
  const ranges = (drawing, key) => {
    const changed = {};
    for (const [name, axis] of Object.entries(drawing._fullLayout)) {
      if (!/^[xy]axis\d*$/.test(name) || !axis.range || axis.fixedrange) continue;
      if (key === "Home") {
        changed[`${name}.autorange`] = true;
        continue;
      }
      if (axis.type === "category") continue;
      const [low, high] = axis.range.map(Number);
      const [middle, half] = [(low + high) / 2, (high - low) / 2];
      const way = arrows[key]?.[name.startsWith("x") ? 0 : 1] ?? 0;
      const moved = middle + 2 * SHIFT * half * way;
      const reach = half * (away[key] ?? 1);
      changed[`${name}.range`] = [moved - reach, moved + reach];
    }
    return changed;
  };
  document.addEventListener("keydown", (event) => {
    const drawing = event.target;
    if (!drawing.classList?.contains("js-plotly-plot")) return;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { key } = event;
    if (key !== "Home" && !away[key] && !arrows[key]) return;
    event.preventDefault();
    const solid = drawing._fullLayout.scene;
    if (solid) Plotly.relayout(drawing, { "scene.camera.eye": camera(drawing, key) });
    else Plotly.relayout(drawing, ranges(drawing, key));
  });
})();
