// One motion of one arm, asked for anything at a time.

import { Frames, applied, columnMajor, inverted, multiplied } from "./kinematics.js";

const MOST_POINTS = 5000;
const STEP = 0.016; // s from one point of the drawn path to the next, where there is room

/** Index of the last entry that is not above a value; 0 at the least. */
export function before(values, value) {
  let low = 0;
  let high = values.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (values[middle] <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Of two columns over the same rows, never falling, the value in one beside that in the other. */
export function interpolated(from, to, value) {
  const k = Math.min(before(from, value), from.length - 2);
  const span = from[k + 1] - from[k];
  const share = span > 0 ? Math.min(Math.max((value - from[k]) / span, 0), 1) : 0;
  return to[k] + share * (to[k + 1] - to[k]);
}

export class Track {
  constructor(data, arm, index) {
    Object.assign(this, { data, arm, index });
    this.name = data.name ?? "";
    this.duration = data.duration;
    this.ghost = data.ghost ?? false;
    this.group = data.group ?? "";
    this.meets = data.meets ?? null;
    this.t = data.motion.t;
    this.moves = data.moves ?? [];
    this.driven = this.moves.map((_, k) => k).filter((k) => this.moves[k].begin !== undefined);
    this.begins = this.driven.map((k) => this.moves[k].begin);
    this.flags = data.flags ?? [];
    this.parts = data.parts ?? [];
    this.frames = new Frames(arm.nodes);
    this.tools = arm.tools.map((tool) => ({
      name: tool.name,
      node: tool.node,
      place: columnMajor(tool.place),
    }));
    this.channels = [...(data.channels ?? []), ...this.jointChannels()];
    if (data.clearance) this.channels.push(this.clearanceChannel(data.clearance));
  }

  /** Positions and speeds of axes in percent, which follow from the motion itself. */
  jointChannels() {
    return this.arm.axes.flatMap((axis, j) => {
      const middle = (axis.upper + axis.lower) / 2;
      const half = (axis.upper - axis.lower) / 2;
      const q = this.data.motion.q[j];
      const dq = this.data.motion.dq[j];
      return [
        { name: axis.name, chart: "position", axis: j, values: q.map((v) => (100 * (v - middle)) / half) },
        { name: axis.name, chart: "velocity", axis: j, values: dq.map((v) => (100 * v) / axis.velocity) },
      ];
    });
  }

  clearanceChannel({ t, distance }) {
    const values = this.t.map((time) => {
      const k = before(t, time);
      if (k + 1 >= t.length) return 1e3 * distance[k];
      const share = (time - t[k]) / (t[k + 1] - t[k]);
      return 1e3 * (distance[k] + share * (distance[k + 1] - distance[k]));
    });
    return { name: "to the cell", chart: "clearance", values };
  }

  /** Joint values at a time: cubics between knots. */
  joints(time) {
    const { q, dq } = this.data.motion;
    const k = before(this.t, time);
    const next = Math.min(k + 1, this.t.length - 1);
    const span = this.t[next] - this.t[k];
    if (span <= 0) return q.map((column) => column[k]);
    const s = Math.min(Math.max((time - this.t[k]) / span, 0), 1);
    return q.map((column, j) => {
      const rise = column[next] - column[k];
      const first = span * dq[j][k];
      const last = span * dq[j][next];
      return column[k] + s * (first + s * (3 * rise - 2 * first - last + s * (first + last - 2 * rise)));
    });
  }

  poses(time) {
    return this.frames.at(this.joints(time));
  }

  /** Index of the move that is driven; -1 where none is known. */
  moveAt(time) {
    if (!this.driven.length) return -1;
    return this.driven[before(this.begins, time + 1e-6)];
  }

  /** The wait that it stands in; undefined while it drives. */
  restAt(time) {
    return this.flags.find((flag) => flag.duration > 0 && flag.t <= time + 1e-6 && time < flag.t + flag.duration);
  }

  toolAt(time) {
    const move = this.moves[this.moveAt(time)];
    return this.tools[move ? move.tool ?? 0 : this.data.tool ?? 0] ?? this.tools[0];
  }

  tcp(time, poses = this.poses(time)) {
    const tool = this.toolAt(time);
    const m = multiplied(poses[tool.node], tool.place);
    return [m[12], m[13], m[14]];
  }

  /** Value of a curve at a time. */
  value(channel, time) {
    const k = before(this.t, time);
    const next = Math.min(k + 1, this.t.length - 1);
    const span = this.t[next] - this.t[k];
    if (channel.stepped || span <= 0) return channel.values[k];
    const share = Math.min((time - this.t[k]) / span, 1);
    return channel.values[k] + share * (channel.values[next] - channel.values[k]);
  }

  channel(chart, axis = null) {
    return this.channels.find((c) => c.chart === chart && (c.axis ?? null) === axis);
  }

  /** What limits the speed at a time; -1 for nothing, as in waits. */
  limitAt(time) {
    const limits = this.data.limits;
    if (!limits || !limits.begin.length) return -1;
    const k = before(limits.begin, time + 1e-9);
    return time <= limits.end[k] + 1e-6 && time >= limits.begin[k] - 1e-6 ? Math.round(limits.which[k]) : -1;
  }

  clearanceAt(time) {
    const found = this.data.clearance;
    if (!found) return null;
    const k = before(found.t, time);
    const near = k + 1 < found.t.length && found.t[k + 1] - time < time - found.t[k] ? k + 1 : k;
    const pair = Math.round(found.pair[near]);
    if (pair < 0) return null;
    return {
      distance: found.distance[near],
      pair: found.pairs[pair],
      first: found.first.map((column) => column[near]),
      second: found.second.map((column) => column[near]),
      wanted: found.wanted ?? 0,
    };
  }

  /** Times at which the path is drawn: close enough that it looks smooth, the knots among them. */
  pathTimes() {
    if (this.times) return this.times;
    const step = Math.max(STEP, this.duration / MOST_POINTS);
    const times = [];
    for (let k = 0; k + 1 < this.t.length; k += 1) {
      const span = this.t[k + 1] - this.t[k];
      const pieces = Math.max(1, Math.ceil(span / step - 1e-9));
      if (times.length && span > 0 && this.t[k] - times.at(-1) < 0.6 * step && this.t[k] > times.at(-1)) continue;
      for (let i = 0; i < pieces; i += 1) times.push(this.t[k] + (span * i) / pieces);
    }
    times.push(this.t.at(-1));
    this.times = Float64Array.from(times);
    return this.times;
  }

  /** The driven path: points in the frames of its moves' work objects, and in the world. */
  path() {
    if (this.drawn) return this.drawn;
    const times = this.pathTimes();
    const world = new Float32Array(3 * times.length);
    const local = new Float32Array(3 * times.length);
    const nodes = new Int16Array(times.length);
    times.forEach((time, k) => {
      const poses = this.poses(time);
      const at = this.tcp(time, poses);
      const node = this.moves[this.moveAt(time)]?.node ?? 0;
      world.set(at, 3 * k);
      local.set(applied(inverted(poses[node]), ...at), 3 * k);
      nodes[k] = node;
    });
    this.drawn = { times, world, local, nodes };
    return this.drawn;
  }

  /** A point fixed to a node over time, in the world. */
  trace(node, place = null) {
    const times = this.pathTimes();
    const points = new Float32Array(3 * times.length);
    times.forEach((time, k) => {
      const m = this.poses(time)[node];
      points.set(place ? applied(m, ...place) : [m[12], m[13], m[14]], 3 * k);
    });
    return points;
  }
}
