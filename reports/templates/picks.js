"use strict";
// what is chosen from a list or by a click on its point in a figure
(() => {
  for (const picks of document.querySelectorAll(".picks")) {
    const choice = picks.querySelector("select");
    const items = [...picks.querySelectorAll(".pick")];
    const figure = document.getElementById(picks.dataset.figure);
    const mark = () => {
      const drawing = figure?.querySelector(".drawing");
      (drawing?.data ?? []).forEach((trace, number) => {
        const at = trace.customdata?.indexOf(Number(choice.value)) ?? -1;
        if (at >= 0) Plotly.restyle(drawing, { selectedpoints: [[at]] }, [number]);
      });
    };
    const show = () => {
      items.forEach((item, number) => {
        item.hidden = number !== Number(choice.value);
      });
      mark();
    };
    choice.addEventListener("change", show);
    figure?.addEventListener("drawn", mark);
    figure?.addEventListener("chosen", ({ detail }) => {
      if (!items[detail]) return;
      choice.value = detail;
      show();
    });
  }
})();
