// The path of a track in space: programmed and driven, zones, stops, what happens on the way.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  InstancedMesh,
  Line,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Points,
  PointsMaterial,
  SphereGeometry,
  Vector2,
} from "three";
import { Line2 } from "three/examples/jsm/lines/Line2.js";
import { LineGeometry } from "three/examples/jsm/lines/LineGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { kindOf, rgb, viridis } from "./colours.js";
import { fewer } from "./fewer.js";
import { applied, inverted } from "./kinematics.js";
import { before } from "./track.js";

export const COLOURINGS = {
  speed: { name: "TCP speed", chart: "speed", unit: "mm/s" },
  push: { name: "TCP acceleration", chart: "push", unit: "m/s²" },
  limit: { name: "what limits" },
  clearance: { name: "clearance", chart: "clearance", unit: "mm" },
  power: { name: "mechanical power", chart: "energy", unit: "kW" },
  spray: { name: "gun on, off" },
  plain: { name: "plain" },
};
const PROGRAMMED = { light: 0x8a8f94, dark: 0x7d858c };
const GHOST = { light: "#2f6fb3", dark: "#7db7f0" };
// Points of a path that is drawn wide, of a longer one that are; zones at once, of more those round
// the present move; of what pieces they are made, and how rough thin lines are: with a graphics card,
// and without one.
const AMOUNTS = [
  { wide: 3000, near: 900, zones: 40, ball: [20, 14], rough: 1 },
  { wide: 400, near: 240, zones: 12, ball: [14, 9], rough: 3 },
];
const MANY_FLAGS = 30; // from which on they are drawn smaller
const FLAGS = { wait: 0xd55e00, device: 0xe69f00, statement: 0x0072b2, event: 0x009e73 };

export class PathView {
  constructor(view, track, arm) {
    Object.assign(this, { view, track, arm });
    this.ghost = arm.ghost;
    this.amounts = AMOUNTS[view.plain ? 1 : 0];
    this.groups = { driven: new Group(), programmed: new Group(), zones: new Group(), stops: new Group(), flags: new Group() };
    this.balls = [];
    this.driven();
    if (!this.ghost) {
      this.programmed();
      this.zones();
      this.flags();
    }
    this.marker();
    if (view.trace !== null) this.traceNode(view.trace);
  }

  carrier(node) {
    return this.arm.nodes[node];
  }

  /** Put an object on a node, in a group that is switched as a whole. */
  put(group, node, object) {
    this.carrier(node).add(object);
    (this.groups[group].userData.members ??= []).push(object);
  }

  apply(show) {
    const seen = { driven: true, programmed: show.programmed, zones: show.zones, stops: true, flags: show.flags };
    for (const [name, group] of Object.entries(this.groups)) {
      for (const object of group.userData.members ?? []) object.visible = seen[name];
    }
  }

  /** Short paths are drawn wide; of long ones, where lines lie over each other, that which is near. */
  driven() {
    const { times, local, nodes } = this.track.path();
    const runs = [];
    let from = 0;
    for (let k = 1; k <= times.length; k += 1) {
      const gap = k < times.length && times[k] === times[k - 1];
      if (k < times.length && nodes[k] === nodes[from] && !gap) continue;
      if (k - from > 1) runs.push([from, k]);
      from = k;
    }
    this.shades = this.colours().colours;
    const drawn = runs.reduce((sum, run) => sum + fewer(local, this.shades, ...run).length, 0);
    const wide = drawn <= this.amounts.wide;
    this.lines = runs.map((run) => this.line(...run, wide));
    this.near = wide || this.ghost || !this.lines.length ? null : this.line(0, Math.min(this.amounts.near, this.lines[0].to), true);
    this.colour();
  }

  line(from, to, wide) {
    const { nodes } = this.track.path();
    let line;
    if (wide) {
      const material = new LineMaterial({ linewidth: this.ghost ? 1.6 : 3, vertexColors: true, worldUnits: false });
      material.resolution = new Vector2(this.view.host.clientWidth || 1, this.view.host.clientHeight || 1);
      if (this.ghost) Object.assign(material, { transparent: true, opacity: 0.65 });
      line = new Line2(new LineGeometry(), material);
    } else line = new Line(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true }));
    line.frustumCulled = false;
    this.put("driven", nodes[from], line);
    return { line, from, to, wide };
  }

  /** Draw wide what is near to a time. */
  drawNear(time) {
    const { times, nodes } = this.track.path();
    const k = before(times, time);
    if (this.near.at !== undefined && Math.abs(k - this.near.at) < this.amounts.near / 6) return;
    this.near.at = k;
    const own = this.lines.find(({ from, to }) => from <= k && k < to) ?? this.lines[0];
    const from = Math.max(own.from, Math.min(k - this.amounts.near / 2, own.to - this.amounts.near));
    const to = Math.min(own.to, from + this.amounts.near);
    Object.assign(this.near, { from, to });
    this.carrier(nodes[from]).add(this.near.line);
    this.fill(this.near);
  }

  /** Points and colours of a line. */
  fill(one) {
    const { local } = this.track.path();
    const kept = fewer(local, this.shades, one.from, one.to, one.wide ? 1 : this.amounts.rough);
    const xyz = kept.flatMap((k) => [local[3 * k], local[3 * k + 1], local[3 * k + 2]]);
    const colours = kept.flatMap((k) => this.shades[k]);
    if (one.wide) {
      one.line.geometry.dispose();
      one.line.geometry = new LineGeometry();
      one.line.geometry.setPositions(xyz);
      one.line.geometry.setColors(colours);
      return;
    }
    one.line.geometry.dispose();
    one.line.geometry = new BufferGeometry();
    one.line.geometry.setAttribute("position", new BufferAttribute(new Float32Array(xyz), 3));
    one.line.geometry.setAttribute("color", new BufferAttribute(new Float32Array(colours.map((c) => c ** 2.2)), 3));
  }

  /** Colour of each point of the path, and what the colours stand for. */
  colours() {
    const { times } = this.track.path();
    const by = COLOURINGS[this.view.colourBy] ?? COLOURINGS.plain;
    if (this.ghost) {
      const colour = rgb(GHOST[this.view.theme]);
      return { colours: Array.from(times, () => colour) };
    }
    if (this.view.colourBy === "limit") {
      const names = this.track.data.limits?.names ?? [];
      return { colours: Array.from(times, (t) => rgb(kindOf(names[this.track.limitAt(t)]).colour)) };
    }
    if (this.view.colourBy === "spray") {
      const [on, off] = this.view.theme === "dark" ? ["#f0b050", "#59636c"] : ["#0b5cad", "#b9bfc5"];
      return { colours: Array.from(times, (t) => rgb(this.view.coat?.sprays(t) ? on : off)) };
    }
    const channel = by.chart && this.track.channel(by.chart);
    if (!channel) return { colours: Array.from(times, () => rgb(this.view.theme === "dark" ? "#7db7f0" : "#0b5cad")) };
    let values = Array.from(times, (t) => this.track.value(channel, t));
    if (this.view.colourBy === "power") {
      values = values.map((v, k) => (k && times[k] > times[k - 1] ? (v - values[k - 1]) / (times[k] - times[k - 1]) : 0));
    }
    const finite = values.filter(Number.isFinite);
    const low = this.view.colourBy === "clearance" ? Math.min(...finite, 0) : 0;
    const high = finite.reduce((most, v) => Math.max(most, v), low + 1e-9);
    // Small clearances are what counts: bright.
    const turned = this.view.colourBy === "clearance";
    const colours = values.map((v) => {
      if (!Number.isFinite(v)) return [0.6, 0.6, 0.6];
      const share = (v - low) / (high - low);
      return viridis(turned ? 1 - share : share, this.view.theme);
    });
    return { colours, low, high, unit: by.unit, turned };
  }

  colour() {
    const { colours, ...scale } = this.colours();
    this.scale = scale;
    this.shades = colours;
    for (const line of this.lines) this.fill(line);
    if (this.near) this.fill(this.near);
  }

  programmed() {
    const material = new LineBasicMaterial({ color: PROGRAMMED[this.view.theme] });
    const byNode = new Map();
    for (const { node = 0, points } of this.track.data.programmed ?? []) {
      if (!byNode.has(node)) byNode.set(node, []);
      const ends = byNode.get(node);
      for (let k = 1; k < points[0].length; k += 1) {
        for (const at of [k - 1, k]) ends.push(points[0][at], points[1][at], points[2][at]);
      }
    }
    for (const [node, ends] of byNode) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
      this.put("programmed", node, new LineSegments(geometry, material));
    }
  }

  zones() {
    const waypoints = this.track.data.waypoints;
    if (!waypoints) return;
    const byNode = new Map();
    waypoints.nodes.forEach((node, k) => byNode.set(node, [...(byNode.get(node) ?? []), k]));
    for (const [node, rows] of byNode) {
      const passed = rows.filter((k) => waypoints.radius[k] > 0);
      const material = new MeshBasicMaterial({ color: 0xe69f00, transparent: true, opacity: 0.2, depthWrite: false });
      const balls = new InstancedMesh(new SphereGeometry(1, ...this.amounts.ball), material, Math.min(passed.length, this.amounts.zones));
      balls.renderOrder = 4;
      balls.frustumCulled = false;
      this.balls.push({ balls, passed });
      this.fillZones(balls, passed);
      this.put("zones", node, balls);
      const stops = rows.filter((k) => waypoints.radius[k] === 0);
      this.put("stops", node, this.dots(waypoints.points, stops, this.view.theme === "dark" ? 0xf2f2f2 : 0x22272b, 6));
      this.put("stops", node, this.dots(waypoints.points, passed, 0xb87400, 4));
    }
  }

  fillZones(balls, rows) {
    const waypoints = this.track.data.waypoints;
    rows.forEach((k, i) => {
      const r = waypoints.radius[k];
      const m = new Matrix4().makeScale(r, r, r);
      m.setPosition(...waypoints.points.map((column) => column[k]));
      balls.setMatrixAt(i, m);
    });
    balls.count = rows.length;
    balls.instanceMatrix.needsUpdate = true;
  }

  /** Of many zones those round a move. */
  nearZones(move) {
    if (move === this.zonesOf) return;
    this.zonesOf = move;
    const { moves } = this.track.data.waypoints;
    for (const { balls, passed } of this.balls) {
      if (passed.length <= this.amounts.zones) continue;
      const at = passed.findIndex((k) => moves[k] >= move);
      const middle = at < 0 ? passed.length : at;
      const first = Math.min(Math.max(middle - this.amounts.zones / 2, 0), passed.length - this.amounts.zones);
      this.fillZones(balls, passed.slice(first, first + this.amounts.zones));
    }
  }

  dots(points, rows, colour, size) {
    const xyz = new Float32Array(rows.flatMap((k) => points.map((column) => column[k])));
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(xyz, 3));
    const dots = new Points(geometry, new PointsMaterial({ color: colour, size, sizeAttenuation: false, depthTest: false }));
    dots.renderOrder = 6;
    dots.frustumCulled = false;
    return dots;
  }

  /** Waits, outputs and events as dots beside the path. */
  flags() {
    const { flags } = this.track;
    if (!flags.length) return;
    const into = inverted(this.track.poses(0)[0]);
    const xyz = new Float32Array(flags.flatMap((flag) => applied(into, ...this.track.tcp(flag.t))));
    const colours = new Float32Array(flags.flatMap((flag) => new Color(FLAGS[flag.kind] ?? 0x888888).toArray()));
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(xyz, 3));
    geometry.setAttribute("color", new BufferAttribute(colours, 3));
    const dots = new Points(geometry, new PointsMaterial({ vertexColors: true, size: flags.length > MANY_FLAGS ? 6 : 9, sizeAttenuation: false, depthTest: false }));
    dots.renderOrder = 7;
    dots.frustumCulled = false;
    this.put("flags", 0, dots);
  }

  marker() {
    const colour = this.ghost ? GHOST[this.view.theme] : "#d0342c";
    this.tip = new Mesh(new SphereGeometry(1, 12, 8), new MeshBasicMaterial({ color: colour, depthTest: false }));
    this.tip.renderOrder = 8;
    this.view.root.add(this.tip);
  }

  pose(time) {
    const at = this.track.tcp(time);
    if (this.near) this.drawNear(time);
    if (this.balls.length) this.nearZones(this.track.moveAt(time));
    this.tip.position.set(...at);
    const away = this.view.camera.position.distanceTo(this.tip.position);
    this.tip.scale.setScalar(0.006 * away);
  }

  traceNode(node) {
    this.traced?.removeFromParent();
    this.traced = null;
    if (node === null || node < 0) return;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.track.trace(node), 3));
    const colour = this.ghost ? GHOST[this.view.theme] : 0xcc79a7;
    this.traced = new Line(geometry, new LineBasicMaterial({ color: colour }));
    this.traced.frustumCulled = false;
    this.view.root.add(this.traced);
  }

  resize(width, height) {
    for (const { line, wide } of [...this.lines, ...(this.near ? [this.near] : [])]) {
      if (wide) line.material.resolution.set(width, height);
    }
  }

  /** The time at which the path passes nearest to a place on the screen, and how many pixels off;
   * null if none is near. */
  pick(x, y, reach = 10) {
    const { times, local, nodes } = this.track.path();
    const matrices = this.arm.nodes.map((node) => node.matrix.elements);
    let best = null;
    for (let k = 0; k < times.length; k += 1) {
      const m = matrices[nodes[k]];
      const [a, b, c] = [local[3 * k], local[3 * k + 1], local[3 * k + 2]];
      const point = [
        m[0] * a + m[4] * b + m[8] * c + m[12],
        m[1] * a + m[5] * b + m[9] * c + m[13],
        m[2] * a + m[6] * b + m[10] * c + m[14],
      ];
      const at = this.view.onScreen(point);
      if (!at) continue;
      const off = Math.hypot(at[0] - x, at[1] - y);
      if (off < reach && (!best || off < best.off)) best = { off, t: times[k], track: this.track.index };
    }
    return best;
  }
}
