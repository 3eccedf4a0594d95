// Curves over the one clock, and the band that says what limits the robot when.

import uPlot from "uplot";
import { KINDS, NAMED, REST, kindOf } from "./colours.js";
import { h, number } from "./dom.js";
import { Gantt } from "./gantt.js";
import { interpolated } from "./track.js";

const LEFT = 54;
const LEFT_OF_ROWS = 112; // where rows have names
const RIGHT = 14;
const GAP = 1e-9;
const FAR = 3; // programmed by driven speed, from which on only what is driven scales a plot
const READ_EVERY = 120; // ms between read-outs while time runs

export class PlotPane {
  constructor(session, host) {
    Object.assign(this, { session, host });
    this.charts = (session.page.charts ?? []).filter((chart) =>
      session.tracks.some((track) => track.channels.some((channel) => channel.chart === chart.key)),
    );
    this.gantt = session.page.gantt?.length ? new Gantt(session, session.page.gantt) : null;
    this.left = this.gantt ? LEFT_OF_ROWS : LEFT;
    this.colours = { text: "#444", line: "#ddd" };
    this.bandHost = h("div", { class: "band" });
    this.band = h("canvas", { "aria-label": this.gantt ? "who does what over time" : "what limits the robot over time" });
    this.legend = h("div", { class: "legend" });
    this.head = h("i", { class: "playhead" });
    this.bandHost.append(this.band, this.head);
    if (this.gantt) this.bandHost.style.height = `${this.gantt.height}px`;
    this.row = h("div", { class: "bandrow" }, this.bandHost);
    this.plots = [];
    host.append(this.legend, this.row);
    if (this.charts.length) {
      this.slots = [this.slot(0), this.slot(Math.min(2, this.charts.length - 1))];
      if (this.charts.length < 2 || this.gantt) this.slots.pop().root.remove();
    } else this.slots = [];
    this.band.addEventListener("click", (event) => {
      const t = this.timeAt(event.offsetX);
      if (this.gantt) this.gantt.clicked(t, event.offsetY, this.secondsAPixel());
      else session.seek(t);
    });
    this.band.addEventListener("mousemove", (event) => this.tell(event));
    session.on("time", () => this.cursor());
    session.on("track", () => this.rebuild());
    session.on("view", () => this.range());
    new ResizeObserver(() => this.resize()).observe(host);
    this.rebuild();
  }

  slot(k) {
    const choose = h("select", { "aria-label": "which plot", onchange: () => this.draw(slot) });
    this.charts.forEach((chart, i) => choose.append(h("option", { value: i }, chart.title)));
    choose.value = String(k);
    const unit = h("span", { class: "quiet" });
    const read = h("span", { class: "read" });
    const plot = h("div", { class: "plot" });
    const root = h("div", { class: "slot" }, h("div", { class: "bar" }, choose, unit, read), plot);
    this.host.append(root);
    const slot = { choose, unit, read, plot, root, hidden: new Set() };
    return slot;
  }

  choose(key, slot = 1) {
    const k = this.charts.findIndex((chart) => chart.key === key);
    if (k < 0 || !this.slots[slot]) return;
    this.slots[slot].choose.value = String(k);
    this.draw(this.slots[slot]);
  }

  setTheme() {
    const style = getComputedStyle(document.documentElement);
    this.colours = { text: style.getPropertyValue("--quiet").trim(), line: style.getPropertyValue("--rule").trim() };
    this.rebuild();
  }

  rebuild() {
    for (const slot of this.slots) this.draw(slot);
    this.drawBand();
  }

  /** Curves of a chart: the active track's, and of its ghosts those of the whole arm. */
  curves(chart) {
    const found = [];
    const shown = this.session.shown();
    for (const track of shown) {
      const own = track === this.session.track;
      const channels = track.channels.filter((channel) => channel.chart === chart.key);
      channels.forEach((channel, k) => {
        const joint = channel.axis ?? null;
        if (!own && (channel.stepped || joint !== null || chart.key === "between")) return; // of two robots once
        found.push({ track, channel, own, name: own ? channel.name : `${channel.name}, ${track.name}`, colour: colourOf(channel, joint, own ? k : shown.indexOf(track)) });
      });
    }
    for (const curve of found) curve.dashed = !curve.own && found.some((one) => one.own);
    return found;
  }

  draw(slot) {
    slot.made?.destroy();
    slot.made = null;
    const chart = this.charts[+slot.choose.value];
    if (!chart || !this.session.track) return;
    slot.unit.textContent = chart.unit;
    const curves = this.curves(chart);
    slot.curves = curves;
    const tables = curves.map(({ track, channel }) => [this.clockTimes(track), Array.from(channel.values, (v) => (Number.isFinite(v) ? v : null))]);
    const data = curves.length ? uPlot.join(tables.map(([x, y]) => [x, y]), tables.map(() => [2])) : [[0]];
    const limit = chart.span;
    // What is programmed may be far beyond what is driven (vmax): it runs out of the plot then.
    const [driven, asked] = [false, true].map((stepped) => highest(curves.filter(({ channel }) => !!channel.stepped === stepped)));
    const series = curves.map(({ channel, colour, own, dashed, name }) => ({
      label: name,
      stroke: colour,
      width: own ? 1.4 : 1,
      dash: channel.stepped ? [5, 3] : dashed ? [2, 3] : undefined,
      points: { show: false },
      spanGaps: true,
      paths: channel.stepped ? uPlot.paths.stepped({ align: 1 }) : undefined,
      show: !slot.hidden.has(name),
      auto: !channel.stepped || driven === 0 || asked < FAR * driven,
    }));
    const options = {
      width: Math.max(slot.plot.clientWidth, 50),
      height: Math.max(slot.plot.clientHeight, 40),
      padding: [6, RIGHT, 0, 0],
      legend: { show: false },
      cursor: { y: false, drag: { x: true, y: false, setScale: false }, points: { show: false }, sync: { key: "clock" } },
      scales: {
        x: { time: false, range: () => this.session.view ?? [0, Math.max(this.session.duration, 1e-3)] },
        y: { range: (u, low, high) => ranged(low, high, limit) },
      },
      axes: [this.axis({ size: slot === this.slots.at(-1) ? 22 : 4, values: (u, at) => at.map((v) => (slot === this.slots.at(-1) ? `${+v.toFixed(3)} s` : "")) }), this.axis({ size: this.left, space: 24 })],
      series: [{}, ...series],
      hooks: {
        draw: [(u) => this.overlay(u, limit)],
        setSelect: [(u) => this.zoomed(u)],
        setCursor: [(u) => this.read(slot, u)],
      },
    };
    slot.made = new uPlot(options, data, slot.plot);
    slot.head = h("i", { class: "playhead" });
    slot.made.over.append(slot.head);
    slot.made.over.addEventListener("click", () => {
      const { left } = slot.made.cursor;
      if (left >= 0 && !slot.dragged) this.session.seek(slot.made.posToVal(left, "x"));
      slot.dragged = false;
    });
    slot.made.over.addEventListener("dblclick", () => this.session.zoom(null));
    this.putHead(slot);
    this.read(slot, slot.made);
  }

  axis(more) {
    const grid = { stroke: this.colours.line, width: 1 };
    return { stroke: this.colours.text, grid, ticks: { ...grid, size: 4 }, font: "11px system-ui, sans-serif", ...more };
  }

  /** Times of a track's knots on the clock: never falling, which plots ask for. */
  clockTimes(track) {
    let last = -1;
    const { session } = this;
    const met = session.met(track);
    return Array.from(track.t, (t) => {
      const at = met ? interpolated(met.other, met.own, t) : t;
      last = at <= last ? last + GAP : at;
      return last;
    });
  }

  overlay(u, limit) {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    if (limit) {
      ctx.strokeStyle = "#b3261e";
      ctx.setLineDash([6, 4]);
      ctx.lineWidth = 1;
      for (const value of limit) {
        const y = u.valToPos(value, "y", true);
        ctx.beginPath();
        ctx.moveTo(bbox.left, y);
        ctx.lineTo(bbox.left + bbox.width, y);
        ctx.stroke();
      }
    }
    ctx.restore();
  }

  zoomed(u) {
    const { left, width } = u.select;
    if (width < 6) return;
    for (const slot of this.slots) if (slot.made === u) slot.dragged = true;
    const range = [u.posToVal(left, "x"), u.posToVal(left + width, "x")];
    u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    this.session.zoom([Math.max(range[0], 0), Math.min(range[1], this.session.duration)]);
  }

  /** Values under the pointer, or at the playhead. */
  read(slot, u) {
    const hover = u.cursor.left >= 0 && u.over.matches(":hover");
    const t = hover ? u.posToVal(u.cursor.left, "x") : this.session.t;
    const chart = this.charts[+slot.choose.value];
    const parts = slot.curves.map(({ track, channel, colour, name }) => {
      const value = track.value(channel, this.session.timeOf(track, t));
      const label = h("button", { class: slot.hidden.has(name) ? "key off" : "key", title: `${name}: hide or show` }, h("i", {}), h("span", {}, name), h("b", {}, number(value, chart.unit.startsWith("%") ? 0 : null)));
      label.firstChild.style.background = colour;
      label.addEventListener("click", () => {
        if (!slot.hidden.delete(name)) slot.hidden.add(name);
        this.draw(slot);
      });
      return label;
    });
    slot.read.replaceChildren(...parts);
  }

  /** The playheads follow at once, numbers some times a second: curves stay as they are drawn. */
  cursor() {
    const now = performance.now();
    const told = !this.session.playing || now - (this.told ?? 0) > READ_EVERY;
    if (told) this.told = now;
    for (const slot of this.slots) {
      if (!slot.made) continue;
      this.putHead(slot);
      if (told && !slot.made.over.matches(":hover")) this.read(slot, slot.made);
    }
    this.putBandHead();
  }

  putHead(slot) {
    const x = slot.made.valToPos(this.session.t, "x");
    slot.head.hidden = !(x >= 0 && x <= slot.made.over.clientWidth);
    slot.head.style.transform = `translateX(${x}px)`;
  }

  putBandHead() {
    const x = this.placeOf(this.gantt ? this.session.t : this.session.timeOf(this.session.track));
    this.head.hidden = !(x >= this.left - 1 && x <= this.band.clientWidth - RIGHT + 1);
    this.head.style.transform = `translateX(${x}px)`;
  }

  range() {
    for (const slot of this.slots) slot.made?.redraw(false, true);
    for (const slot of this.slots) slot.made?.setScale("x", { min: this.span()[0], max: this.span()[1] });
    this.drawBand();
    if (this.session.track) this.cursor();
  }

  span() {
    return this.session.view ?? [0, Math.max(this.session.duration, 1e-3)];
  }

  resize() {
    for (const slot of this.slots) {
      if (slot.made) slot.made.setSize({ width: Math.max(slot.plot.clientWidth, 50), height: Math.max(slot.plot.clientHeight, 40) });
    }
    this.drawBand();
    if (this.session.track) this.cursor();
  }

  // The band

  timeAt(x) {
    const [from, to] = this.span();
    const width = this.band.clientWidth - this.left - RIGHT;
    return Math.min(Math.max(from + ((x - this.left) / width) * (to - from), 0), this.session.duration);
  }

  placeOf(t) {
    const [from, to] = this.span();
    return this.left + ((t - from) / (to - from)) * (this.band.clientWidth - this.left - RIGHT);
  }

  secondsAPixel() {
    const [from, to] = this.span();
    return (to - from) / (this.band.clientWidth - this.left - RIGHT);
  }

  drawBand() {
    const { track } = this.session;
    const width = this.row.offsetWidth; // a bar to scroll with lies in the margin
    const height = this.bandHost.clientHeight;
    if (!track || !width || !height) return;
    const scale = devicePixelRatio;
    if (this.band.width !== width * scale || this.band.height !== height * scale) {
      this.band.width = width * scale;
      this.band.height = height * scale;
      this.band.style.width = `${width}px`;
      this.band.style.height = `${height}px`;
    }
    const ctx = this.band.getContext("2d");
    ctx.setTransform(scale, 0, 0, scale, 0, 0);
    ctx.clearRect(0, 0, width, height);
    if (this.gantt) {
      this.gantt.draw(ctx, { x: (t) => this.placeOf(t), left: this.left, right: width - RIGHT, ...this.colours });
      this.putBandHead();
      if (!this.legend.childElementCount) this.legend.replaceChildren(...this.gantt.legend());
      return;
    }
    const top = 12;
    const bottom = height - 2;
    ctx.save();
    ctx.beginPath();
    ctx.rect(this.left, 0, width - this.left - RIGHT, height);
    ctx.clip();
    ctx.fillStyle = REST.colour;
    ctx.fillRect(this.placeOf(0), top, this.placeOf(track.duration) - this.placeOf(0), bottom - top);
    const used = new Map([[REST.key, 0]]);
    const limits = track.data.limits;
    let moving = 0;
    for (let k = 0; k < (limits?.begin.length ?? 0); k += 1) {
      const kind = kindOf(limits.names[limits.which[k]]);
      const [a, b] = [limits.begin[k], limits.end[k]];
      used.set(kind.key, (used.get(kind.key) ?? 0) + b - a);
      moving += b - a;
      ctx.fillStyle = kind.colour;
      ctx.fillRect(this.placeOf(a), top, Math.max(this.placeOf(b) - this.placeOf(a), 0.5), bottom - top);
    }
    used.set(REST.key, Math.max(track.duration - moving, 0));
    this.moveTicks(ctx, track, top, bottom);
    ctx.restore();
    this.putBandHead();
    this.fillLegend(used, track);
  }

  moveTicks(ctx, track, top, bottom) {
    ctx.fillStyle = this.colours.text;
    ctx.font = "10px system-ui, sans-serif";
    ctx.textBaseline = "top";
    let free = -100;
    let ticked = -100;
    for (const move of track.moves) {
      if (move.begin === undefined) continue;
      const x = this.placeOf(move.begin);
      if (x - ticked < 4) continue;
      ticked = x;
      ctx.fillRect(x, top - 2, 1, bottom - top + 4);
      const text = move.line ? String(move.line) : String(move.number);
      const end = this.placeOf(move.end);
      const size = ctx.measureText(text).width;
      if (x > free && end - x > size + 3) {
        ctx.fillText(text, x + 2, 0);
        free = x + size + 6;
      }
    }
    for (const flag of track.flags) {
      ctx.fillStyle = "#0072b2";
      if (flag.kind !== "wait" && flag.kind !== "device") ctx.fillRect(this.placeOf(flag.t) - 1, bottom - 4, 2, 4);
    }
  }

  fillLegend(used, track) {
    const key = `${track.index}`;
    if (this.legendOf === key) return;
    this.legendOf = key;
    const total = track.duration || 1;
    const kinds = [...KINDS, REST].filter((kind) => (used.get(kind.key) ?? 0) > 5e-4);
    if (!track.data.limits) {
      this.legend.replaceChildren();
      return;
    }
    this.legend.replaceChildren(
      h("span", { class: "quiet" }, "limited by"),
      ...kinds.map((kind) => {
        const item = h("span", { class: "key" }, h("i", {}), `${kind.name} `, h("b", {}, `${((100 * used.get(kind.key)) / total).toFixed(0)} %`));
        item.firstChild.style.background = kind.colour;
        return item;
      }),
    );
  }

  tell(event) {
    const { track } = this.session;
    if (!track) return;
    const t = this.timeAt(event.offsetX);
    if (this.gantt) {
      this.band.title = this.gantt.told(t, event.offsetY, this.secondsAPixel());
      return;
    }
    const move = track.moves[track.moveAt(t)];
    const name = track.data.limits?.names[track.limitAt(t)] ?? "standing still";
    const what = move ? `move ${move.number}${move.line ? `, line ${move.line}` : ""}: ` : "";
    this.band.title = `${t.toFixed(3)} s, ${what}${name}`;
  }
}

function highest(curves) {
  return curves.reduce((most, { channel }) => channel.values.reduce((top, v) => (v > top ? v : top), most), 0);
}

function colourOf(channel, joint, k) {
  if (channel.stepped) return "#8a8f94";
  if (joint !== null) return NAMED[joint % NAMED.length];
  return NAMED[k % NAMED.length];
}

function ranged(low, high, limit) {
  if (low === null || high === null) return [0, 1];
  const near = limit && (high > 0.55 * limit[1] || low < 0.55 * limit[0]);
  const least = near ? Math.min(limit[0] * 1.08, low) : Math.min(0, 1.1 * low);
  const most = near ? Math.max(limit[1] * 1.08, high) : Math.max(0, 1.1 * high);
  return most > least ? [least, most] : [least - 1, least + 1];
}
