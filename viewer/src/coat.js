// Paint on a part: its thickness as colours, how it is spread, and when the gun is on.

import { BufferAttribute, DoubleSide, Mesh, MeshLambertMaterial } from "three";
import { css, diverging } from "./colours.js";
import { h, svg } from "./dom.js";
import { meshOf } from "./solids.js";
import { before } from "./track.js";

const BARE = [0.72, 0.74, 0.76];
const BINS = 41;
const MICRON = 1e-6;

/** −1 to 1 of what may be off as 0 to 1. */
const shareOf = (coat, value) => 0.5 + (value / coat.target - 1) / (4 * coat.tolerance);

const colourOf = (coat, value) => (Number.isFinite(value) ? diverging(shareOf(coat, value)) : BARE);

export class CoatView {
  constructor(coat) {
    this.coat = coat;
    const { faces } = coat.mesh;
    const colours = new Float32Array(9 * faces[0].length);
    for (let k = 0; k < faces[0].length; k += 1) {
      for (let i = 0; i < 3; i += 1) {
        const colour = colourOf(coat, coat.thickness[faces[i][k]]);
        // Colours of materials are linear, those of a palette are not.
        colours.set(colour.map((c) => c ** 2.2), 9 * k + 3 * i);
      }
    }
    const geometry = meshOf(coat.mesh);
    geometry.setAttribute("color", new BufferAttribute(colours, 3));
    this.mesh = new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
  }

  build(view) {
    view.root.add(this.mesh);
    this.mesh.visible = view.show.coat;
  }

  /** Whether the gun is on; undefined where nobody says. */
  sprays(t) {
    const strokes = this.coat.strokes;
    if (!strokes || !strokes[0].length) return undefined;
    const k = before(strokes[0], t);
    return t >= strokes[0][k] && t <= strokes[1][k];
  }
}

/** The tab with the spread of thickness and what colours mean. */
export function coatDrawing(coat) {
  return { title: "Coat", draw: () => drawn(coat) };
}

function drawn(coat) {
  const known = Array.from(coat.thickness).filter(Number.isFinite);
  const low = coat.target * (1 - 2 * coat.tolerance);
  const high = coat.target * (1 + 2 * coat.tolerance);
  const counts = new Array(BINS).fill(0);
  for (const value of known) {
    const k = Math.floor(((value - low) / (high - low)) * BINS);
    counts[Math.min(Math.max(k, 0), BINS - 1)] += 1;
  }
  const most = Math.max(...counts, 1);
  const [width, height, left, bottom] = [520, 190, 8, 34];
  const x = (value) => left + ((value - low) / (high - low)) * (width - 2 * left);
  const bars = counts.map((count, k) => {
    const at = low + ((k + 0.5) / BINS) * (high - low);
    const tall = (count / most) * (height - bottom - 12);
    const bar = svg("rect", { x: x(at) - (width / BINS) * 0.46, y: height - bottom - tall, width: (width / BINS) * 0.9, height: tall });
    bar.style.fill = css(colourOf(coat, at));
    bar.style.stroke = "var(--quiet)";
    bar.style.strokeWidth = "0.4";
    return bar;
  });
  const marks = [1 - 2 * coat.tolerance, 1 - coat.tolerance, 1, 1 + coat.tolerance, 1 + 2 * coat.tolerance].flatMap((share) => {
    const at = x(share * coat.target);
    const text = `${((share * coat.target) / MICRON).toFixed(1)} µm`;
    return [
      svg("line", { class: "axis", x1: at, x2: at, y1: 8, y2: height - bottom + 4 }),
      svg("text", { x: Math.min(Math.max(at, 26), width - 28), y: height - bottom + 16, "text-anchor": "middle" }, text),
      svg("text", { x: Math.min(Math.max(at, 26), width - 28), y: height - bottom + 29, "text-anchor": "middle" }, share === 1 ? "target" : `${share > 1 ? "+" : "−"}${Math.round(100 * Math.abs(share - 1))} %`),
    ];
  });
  const within = known.filter((value) => Math.abs(value / coat.target - 1) <= coat.tolerance).length;
  return h("div", { class: "drawing" },
    svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "spread of thickness" }, ...marks, ...bars),
    h("p", { class: "quiet" }, `points of the surface by thickness; ${((100 * within) / Math.max(known.length, 1)).toFixed(1)} % of them within ±${Math.round(100 * coat.tolerance)} % of the target`));
}
