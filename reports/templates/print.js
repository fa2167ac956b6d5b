"use strict";
// On paper each plot is a picture as wide as the column it stands in: plots on the screen are drawn
// when their chapter opens, as wide as the window, and printers draw no WebGL.
(() => {
  // between the margins of A4 and between plots in a row, CSS px: those of print.css
  const WIDTH = 680;
  const GAP = 16;
  // plots are lower on paper, so that more stand on a page
  const LOWER = 0.8;
  // text in a table on paper beside that on the screen
  const SMALLER = 0.75;
  const state = document.documentElement.dataset;
  const columns = (row) => {
    const least = parseInt(row.style.getPropertyValue("--width"), 10) || 300;
    const room = Math.max(1, Math.floor((WIDTH + GAP) / (Math.min(least, WIDTH) + GAP)));
    return Math.min(room, row.querySelectorAll(":scope > figure").length);
  };
  const photograph = async (figure) => {
    const drawing = figure.querySelector(".drawing");
    const live = drawing.classList.contains("js-plotly-plot");
    // as the reader turned it, else as it comes
    const spec = live ? drawing : JSON.parse(figure.querySelector("script").textContent);
    const row = figure.closest(".row");
    const many = row ? columns(row) : 1;
    const width = Math.round((WIDTH - (many - 1) * GAP) / many);
    const height = Math.round(LOWER * (parseInt(drawing.style.height, 10) || 1.16 * width));
    const format = spec.layout.scene ? "png" : "svg";
    const url = await Plotly.toImage(spec, { format, width, height, scale: format === "png" ? 2 : 1 });
    const picture = document.createElement("img");
    picture.className = "print";
    picture.alt = drawing.getAttribute("aria-label");
    picture.src = url;
    drawing.after(picture);
    await picture.decode();
  };
  // a table that is wider than paper is set smaller, never cut
  const shrink = (table) => {
    const before = table.style.width;
    table.style.width = "min-content";
    const needed = SMALLER * table.offsetWidth;
    table.style.width = before;
    if (needed > WIDTH) table.style.setProperty("--shrink", Math.max(0.45, WIDTH / needed));
  };
  let folded = null;
  const prepare = async () => {
    if (folded !== null) return;
    folded = [...document.querySelectorAll("main details:not([open])")];
    state.paper = "waits";
    const failed = [];
    for (const figure of document.querySelectorAll("figure.plot")) {
      try {
        await photograph(figure);
      } catch (error) {
        failed.push(figure.id);
        console.error(`picture of ${figure.id}:`, error);
      }
    }
    // chapters open after the pictures are made: their plots need not be drawn on the screen
    state.paper = "ready";
    for (const chapter of folded) chapter.open = true;
    for (const table of document.querySelectorAll("table")) shrink(table);
    // on paper, and in a file that is passed on, a link to a file leads nowhere
    for (const link of document.querySelectorAll(".data[href], .links a[href]")) {
      link.dataset.href = link.getAttribute("href");
      link.removeAttribute("href");
    }
    return failed;
  };
  const restore = () => {
    if (folded === null || state.paper !== "ready") return;
    for (const picture of document.querySelectorAll("img.print")) picture.remove();
    for (const chapter of folded) chapter.open = false;
    for (const table of document.querySelectorAll("table")) table.style.removeProperty("--shrink");
    for (const link of document.querySelectorAll("[data-href]")) {
      link.setAttribute("href", link.dataset.href);
      delete link.dataset.href;
    }
    folded = null;
    delete state.paper;
  };
  const print = async () => {
    await prepare();
    window.print();
  };
  document.querySelector(".to-paper")?.addEventListener("click", print);
  // the keys that print wait for the pictures; a menu of the browser does not
  document.addEventListener("keydown", (event) => {
    const asked = event.key === "p" && (event.ctrlKey || event.metaKey);
    if (!asked || event.altKey || event.shiftKey) return;
    event.preventDefault();
    print();
  });
  window.addEventListener("afterprint", restore);
  // for `strutwork report --pdf`
  window.paper = { prepare, restore };
})();
