"use strict";
// the page carries its data: a link to a file beside it also works where the page stands alone
(() => {
  const carrier = document.getElementById("carried");
  if (!carrier || typeof DecompressionStream === "undefined") return;
  const names = JSON.parse(carrier.dataset.names);
  const state = document.documentElement.dataset;
  const bytes = () => {
    const text = atob(carrier.textContent.trim());
    const content = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i += 1) content[i] = text.charCodeAt(i);
    return content;
  };
  const file = async (content, name) => {
    const [start, length] = names[name];
    const part = new Blob([content.subarray(start, start + length)]);
    if (name.endsWith(".zip")) return part;
    const stream = part.stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Response(stream).blob();
  };
  const link = async () => {
    const content = bytes();
    const made = new Map();
    for (const anchor of document.querySelectorAll("a[data-file]")) {
      const name = anchor.dataset.file;
      try {
        if (!made.has(name)) made.set(name, URL.createObjectURL(await file(content, name)));
        anchor.href = made.get(name);
        anchor.download = name;
      } catch (error) {
        // the link to the file beside the page stays
        console.warn(`file ${name}:`, error);
      }
    }
    state.files = "linked";
  };
  // after the first screen is drawn
  (window.requestIdleCallback ?? ((call) => setTimeout(call, 500)))(link, { timeout: 3000 });
})();
