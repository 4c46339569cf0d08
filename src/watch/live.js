// Keeps the page of `calcine watch` up to date: progress and log every other second, the rest where results have changed.
"use strict";
(() => {
  const live = document.getElementById("live");
  const part = (name) => document.getElementById(`live-${name}`);
  const main = document.querySelector("main");
  const name = (section) => section.querySelector("h2")?.textContent ?? section.tagName;
  let shown = live.dataset.stamp, asked = 0, ended = 0;

  /// Brings the sections of a newer page in, and keeps what has not changed: what is open stays so.
  function renew(text) {
    const fresh = new DOMParser().parseFromString(text, "text/html");
    const old = new Map([...main.children].map((section) => [name(section), section]));
    const parts = [...fresh.querySelector("main").children].map((section) => {
      if (section.id === "live") {
        shown = section.dataset.stamp;
        return live;
      }
      const before = old.get(name(section));
      if (!before || before.isEqualNode(section)) return before ?? document.importNode(section, true);
      const [view, data] = [before.querySelector(".bed-view"), section.querySelector(".bed-data")];
      if (view?.reload && data) {
        const own = view.querySelector(".bed-data");
        if (own.textContent !== data.textContent) {
          own.textContent = data.textContent;
          view.reload();
        }
        return before;
      }
      const made = document.importNode(section, true);
      const open = [...before.querySelectorAll("details")].map((details) => details.open);
      made.querySelectorAll("details").forEach((details, k) => { details.open = open[k] ?? details.open; });
      return made;
    });
    // Nothing moves that can stay: a canvas that is taken out and put back would be drawn anew.
    parts.forEach((section, k) => {
      if (main.children[k] !== section) main.insertBefore(section, main.children[k] ?? null);
    });
    while (main.children.length > parts.length) main.lastElementChild.remove();
    if (typeof bedView === "function") {
      main.querySelectorAll(".bed-view").forEach((view) => { if (!view.reload) bedView(view); });
    }
  }

  async function look() {
    try {
      const now = await (await fetch("live.json")).json();
      const state = part("state");
      state.textContent = now.state;
      state.className = `badge ${now.state}`;
      part("done").style.width = `${(100 * now.done).toFixed(2)}%`;
      part("words").textContent = `${(100 * now.done).toFixed(1)} % · ${now.words}`;
      const log = part("log");
      if (log.textContent !== now.log) {
        const low = log.scrollTop + log.clientHeight > log.scrollHeight - 30;
        log.textContent = now.log;
        if (low) log.scrollTop = log.scrollHeight;
      }
      ended = 0;
      if (now.stamp !== shown && Date.now() - asked > 1000 * now.pause) {
        renew(await (await fetch("/")).text());
        asked = Date.now();
      }
    } catch (error) {
      if (++ended > 1) part("words").textContent = `No answer: calcine watch has ended (${error.message}).`;
    }
    setTimeout(look, 2000);
  }
  look();
})();
