// Programs between two objectives: points to pick.

import { h, number, svg } from "./dom.js";

export function frontDrawing(session) {
  return { title: "Front", draw: () => drawn(session) };
}

function drawn(session) {
  const { front } = session.page;
  const [width, height, left, bottom] = [520, 250, 54, 40];
  const spread = (values) => {
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const room = 0.12 * (high - low) || 0.05 * Math.abs(high) || 1;
    return [low - room, high + room];
  };
  const [x0, x1] = spread(front.points.map((point) => point.x));
  const [y0, y1] = spread(front.points.map((point) => point.y));
  const x = (value) => left + ((value - x0) / (x1 - x0)) * (width - left - 10);
  const y = (value) => height - bottom - ((value - y0) / (y1 - y0)) * (height - bottom - 10);
  const axes = [
    ...ticks(x0, x1).flatMap((value) => [
      svg("line", { class: "axis", x1: x(value), x2: x(value), y1: 8, y2: height - bottom }),
      svg("text", { x: x(value), y: height - bottom + 14, "text-anchor": "middle" }, ticked(value, ticks(x0, x1))),
    ]),
    ...ticks(y0, y1).flatMap((value) => [
      svg("line", { class: "axis", x1: left, x2: width - 10, y1: y(value), y2: y(value) }),
      svg("text", { x: left - 5, y: y(value) + 4, "text-anchor": "end" }, ticked(value, ticks(y0, y1))),
    ]),
    svg("text", { x: (left + width) / 2, y: height - 8, "text-anchor": "middle" }, front.x),
    svg("text", { x: -(height - bottom) / 2, y: 13, "text-anchor": "middle", transform: "rotate(-90)" }, front.y),
  ];
  // Between two programs nothing better than the faster one is known.
  const found = front.points.filter((point) => point.name !== "given");
  const step = found.map((point, k) => (k ? `H${x(point.x)}V${y(point.y)}` : `M${x(point.x)} ${y(point.y)}`)).join("");
  const dots = front.points.map((point) => {
    const dot = svg("circle", { class: `point${point.name === "given" ? " given" : ""}`, cx: x(point.x), cy: y(point.y), r: point.name === "given" ? 10 : 6, tabindex: 0 });
    dot.append(svg("title", {}, `${point.name}: ${number(point.x, 3)} s, ${number(point.y, 1)} %`));
    dot.addEventListener("click", () => session.choose(point.track ?? -1));
    dot.addEventListener("keydown", (event) => event.key === "Enter" && session.choose(point.track ?? -1));
    return dot;
  });
  const names = front.points.map((point) => {
    const given = point.name === "given";
    return svg("text", { class: "number", x: x(point.x) + 9, y: y(point.y) + (given ? 16 : -6) }, point.name.replace("point ", ""));
  });
  const mark = () => front.points.forEach((point, k) => dots[k].classList.toggle("picked", point.track === session.active));
  session.on("track", mark);
  mark();
  return h("div", { class: "drawing" },
    svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "front" }, ...axes, svg("path", { class: "step", d: step }), ...dots, ...names),
    h("p", { class: "quiet" }, "pick a point: its program is driven, the given one beside it as a ghost"));
}

/** Some round numbers in a range. */
function ticks(from, to) {
  const rough = (to - from) / 5;
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = size * ([1, 2, 5].find((one) => one * size >= rough) ?? 10);
  const first = Math.ceil(from / step - 1e-9);
  return Array.from({ length: Math.floor(to / step + 1e-9) - first + 1 }, (_, k) => (first + k) * step);
}

function ticked(value, all) {
  const step = all.length > 1 ? all[1] - all[0] : Math.abs(value) || 1;
  return number(value, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
}
