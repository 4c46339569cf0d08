// Looks at a page from within: errors, what is cut off, how many spheres are drawn. What it finds is the text of #found.
"use strict";
(() => {
  const errors = [];
  let spheres = 0;
  const note = (kind, text) => errors.push(`${kind}: ${text}`);
  addEventListener("error", (event) => note("error", event.message ?? event.target?.src));
  addEventListener("unhandledrejection", (event) => note("rejection", String(event.reason)));
  for (const kind of ["error", "warn"]) console[kind] = (...words) => note(kind, words.join(" "));
  const draw = WebGL2RenderingContext.prototype;
  // Spheres are instances, or points where they are small.
  for (const [name, at] of [["drawArraysInstanced", 3], ["drawArrays", 2]]) {
    const own = draw[name];
    draw[name] = function (...words) {
      if (at === 3 || words[0] === this.POINTS) spheres = Math.max(spheres, words[at]);
      const result = own.apply(this, words);
      const code = this.getError();
      if (code) note("webgl", code);
      return result;
    };
  }

  const shown = (element) => element.getClientRects().length > 0;
  const place = (element) => {
    const section = element.closest("section");
    const words = (element.textContent ?? "").trim().replace(/\s+/g, " ").slice(0, 60);
    return `${section?.querySelector("h2")?.textContent ?? "page"}: ${element.tagName.toLowerCase()} ${words}`;
  };

  /// What is cut off: wider than the page, than its own box, or outside of its picture.
  function cut() {
    const found = [];
    const wide = document.documentElement;
    if (wide.scrollWidth > wide.clientWidth + 1) found.push(`page of ${wide.scrollWidth} px in ${wide.clientWidth}`);
    for (const element of document.querySelectorAll("table, th, td, h1, h2, h3, p, li, svg, canvas, select, button, dt, dd")) {
      if (!shown(element)) continue;
      const box = element.getBoundingClientRect();
      if (box.right > wide.clientWidth + 1 || box.left < -1) found.push(`over the edge, ${place(element)}`);
      else if (!["svg", "CANVAS", "SELECT"].includes(element.tagName) && element.scrollWidth > element.clientWidth + 1 && getComputedStyle(element).display !== "inline") {
        found.push(`wider than its box, ${place(element)}`);
      }
    }
    for (const text of document.querySelectorAll("svg text")) {
      if (!shown(text) || !text.textContent.trim()) continue;
      const [box, own] = [text.getBoundingClientRect(), text.ownerSVGElement.getBoundingClientRect()];
      const out = Math.max(own.left - box.left, box.right - own.right, own.top - box.top, box.bottom - own.bottom);
      if (out > 1) found.push(`outside of its picture by ${out.toFixed(0)} px, ${place(text)}`);
    }
    return found;
  }

  // The clock of the browser runs ahead of its threads that unpack the bed, except while an answer is awaited.
  addEventListener("load", async () => {
    const view = document.querySelector(".bed-view");
    view?.scrollIntoView();
    for (let k = 0; k < (view ? 20 : 1) && !spheres; k++) await fetch("/hold");
    await fetch("/hold");
    const result = document.createElement("script");
    result.type = "text/plain";
    result.id = "found";
    result.textContent = ["", `spheres ${spheres}`, ...errors, ...cut().map((one) => `cut: ${one}`), ""].join("\n");
    document.body.append(result);
  });
})();
