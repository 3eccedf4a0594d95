// Paint on a part: its thickness as colours, how it is spread, and when the gun is on.

import { BufferAttribute, ConeGeometry, DoubleSide, Mesh, MeshBasicMaterial, MeshLambertMaterial, Vector3 } from "three";
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

/** For each vertex the corners of faces at it: of vertex v those from first[v] to first[v + 1]. */
function cornersOf(faces, count) {
  const first = new Uint32Array(count + 1);
  for (const column of faces) for (const v of column) first[v + 1] += 1;
  for (let v = 0; v < count; v += 1) first[v + 1] += first[v];
  const next = first.slice();
  const corners = new Uint32Array(first[count]);
  for (let k = 0; k < faces[0].length; k += 1) {
    for (let i = 0; i < 3; i += 1) corners[next[faces[i][k]]++] = 3 * k + i;
  }
  return { first, corners };
}

/** What each interval of time lays: points and steps, without those on which it lays nothing. */
function risesOf(growth, known) {
  return growth.laid.map((column) => {
    const points = [];
    const steps = [];
    column.forEach((value, k) => {
      if (!value) return;
      points.push(known[k]);
      steps.push(value * growth.step);
    });
    return { points: Uint32Array.from(points), steps: Float32Array.from(steps) };
  });
}

export class CoatView {
  constructor(coat) {
    this.coat = coat;
    const { faces } = coat.mesh;
    const count = coat.thickness.length;
    this.known = Array.from(coat.thickness.keys()).filter((v) => Number.isFinite(coat.thickness[v]));
    this.at = cornersOf(faces, count);
    this.colours = new BufferAttribute(new Float32Array(9 * faces[0].length), 3);
    for (let v = 0; v < count; v += 1) this.paint(v, coat.thickness[v], 1);
    const geometry = meshOf(coat.mesh);
    geometry.setAttribute("color", this.colours);
    this.mesh = new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
    this.rises = coat.growth ? risesOf(coat.growth, this.known) : null;
    this.base = new Float32Array(count);
    this.until = null; // intervals that are in the base; null where the whole coat is shown
    this.cone = this.coneObject();
  }

  coneObject() {
    const { spray } = this.coat;
    if (!spray) return null;
    const geometry = new ConeGeometry(spray.radius, spray.reach, 28, 1, true).translate(0, -spray.reach / 2, 0);
    const material = new MeshBasicMaterial({ color: 0xd55e00, transparent: true, opacity: 0.28, depthWrite: false, side: DoubleSide });
    const cone = new Mesh(geometry, material);
    cone.renderOrder = 5;
    return cone;
  }

  build(view) {
    view.root.add(this.mesh);
    if (this.cone) view.root.add(this.cone);
    this.mesh.visible = view.show.coat;
  }

  /** The colour of a vertex; share: how far the coat is on its way, as bare metal fades. */
  paint(vertex, value, share) {
    const [r, g, b] = colourOf(this.coat, value).map((c, i) => ((1 - share) * BARE[i] + share * c) ** 2.2);
    // Colours of materials are linear, those of a palette are not.
    for (let k = this.at.first[vertex]; k < this.at.first[vertex + 1]; k += 1) this.colours.setXYZ(this.at.corners[k], r, g, b);
  }

  grown(vertex, value) {
    this.paint(vertex, value, Math.min(1, value / (0.5 * this.coat.target)));
  }

  /** Show the coat as it is at a time; tip: where the gun's TCP is. */
  show(t, tip, shown) {
    this.aim(t, tip, shown);
    if (!this.rises || !shown) return;
    const { times } = this.coat.growth;
    if (t >= times.at(-1)) {
      if (this.until === null) return;
      for (const v of this.known) this.paint(v, this.coat.thickness[v], 1);
      this.until = null;
    } else {
      this.upTo(Math.max(before(times, t), 0), t);
    }
    this.colours.needsUpdate = true;
  }

  upTo(interval, t) {
    if (this.until === null || interval < this.until) {
      this.base.fill(0);
      this.until = 0;
      for (const v of this.known) this.grown(v, 0);
    }
    for (; this.until < interval; this.until += 1) {
      const { points, steps } = this.rises[this.until];
      points.forEach((v, k) => this.grown(v, (this.base[v] += steps[k])));
    }
    const { times } = this.coat.growth;
    const share = Math.min(Math.max((t - times[interval]) / (times[interval + 1] - times[interval]), 0), 1);
    const { points, steps } = this.rises[interval];
    points.forEach((v, k) => this.grown(v, this.base[v] + share * steps[k]));
  }

  /** Thickness at the points that are to be painted, at the last of the times kept before the one shown. */
  thickness() {
    return this.until === null ? this.known.map((v) => this.coat.thickness[v]) : this.known.map((v) => this.base[v]);
  }

  aim(t, tip, shown) {
    if (!this.cone) return;
    this.cone.visible = Boolean(shown && this.sprays(t));
    if (!this.cone.visible) return;
    const { times, nozzle } = this.coat.spray;
    const k = Math.max(before(times, t), 0);
    this.cone.position.set(...tip);
    this.cone.quaternion.setFromUnitVectors(new Vector3(0, -1, 0), new Vector3(...nozzle.map((column) => column[k])).normalize());
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
