// The keyboard.

import { h } from "./dom.js";
import { VIEWS } from "./scene.js";

const KEYS = [
  ["space", "play, pause"],
  ["← →", "a step of 20 ms"],
  ["shift ← →", "the move before, the next"],
  ["↑ ↓", "in the source: from driven line to driven line"],
  ["home, end", "beginning, end"],
  ["+ −", "faster, slower"],
  ["l", "loop"],
  ["1 to 4", "camera: oblique, front, side, top"],
  ["f", "follow the TCP"],
  ["b", "before or after, the next motion"],
  ["z", "plots back to the whole time"],
  ["/", "filter the table"],
  ["t", "light or dark"],
  ["p", "print"],
  ["?", "this list"],
];

export function help() {
  const dialog = h("dialog", { class: "help" },
    h("h2", {}, "Keys"),
    h("table", {}, ...KEYS.map(([key, what]) => h("tr", {}, h("th", {}, key), h("td", {}, what)))),
    h("p", { class: "quiet" }, "A click on a line, a row, a point of a plot or of the path goes there. Drag in a plot to zoom, double-click to see all of it. In the scene: drag turns, right drag (or two fingers) moves, the wheel zooms."),
    h("form", { method: "dialog" }, h("button", {}, "close")));
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

export function keys({ session, transport, view, overlay, tables, theme }) {
  const views = Object.keys(VIEWS);
  const steps = { ArrowLeft: -1, ArrowRight: 1 };
  const single = {
    " ": () => session.play(),
    Home: () => session.seek(0),
    End: () => session.seek(session.duration),
    "+": () => transport.faster(1),
    "-": () => transport.faster(-1),
    l: () => transport.setLoop(),
    f: () => overlay?.follow(),
    t: theme,
    z: () => session.zoom(null),
    p: () => window.print(),
    "/": () => tables.filter.focus(),
    "?": help,
    b: () => session.choose((session.active + 1) % session.tracks.length),
  };
  window.addEventListener("keydown", (event) => {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (/^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName) && target.type !== "range" && target.type !== "checkbox") {
      if (key === "Escape") target.blur();
      return;
    }
    if (!session.track && key !== "?" && key !== "t" && key !== "p") return;
    if (steps[key]) {
      if (event.shiftKey) transport.step(steps[key]);
      else session.seek(session.t + 0.02 * steps[key]);
    } else if (view && views[+key - 1]) view.look(views[+key - 1]);
    else if (single[key] && !(key === " " && target.tagName === "BUTTON")) single[key]();
    else return;
    event.preventDefault();
  });
}
