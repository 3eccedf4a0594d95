// Bars between panes that can be dragged.

import { h } from "./dom.js";

/** A bar that sets a length in px as a property of the page's root. */
export function splitter(property, direction, measure) {
  const bar = h("div", { class: `split ${direction}`, role: "separator", tabindex: "-1" });
  bar.addEventListener("pointerdown", (event) => {
    bar.setPointerCapture(event.pointerId);
    const move = (moved) => document.documentElement.style.setProperty(property, `${Math.max(measure(moved), 60)}px`);
    const stop = () => bar.removeEventListener("pointermove", move);
    bar.addEventListener("pointermove", move);
    bar.addEventListener("pointerup", stop, { once: true });
    event.preventDefault();
  });
  return bar;
}
