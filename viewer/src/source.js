// The user's own text beside the scene: the driven line is marked, a click goes to its time.

import { h, seconds } from "./dom.js";

const BLOCK = 200; // lines that the browser lays out together

/** The active track's source; where several robots share one clock that of another one below it. */
export function sourcePanes(session, host) {
  const first = new SourcePane(session, host);
  if (session.page.gantt?.length && session.tracks.length > 1) {
    new SourcePane(session, host, new Beside(session));
    first.scroll(first.now); // It has half of its room now.
  }
  return first;
}

/** Another robot than the active one: the next, or who was chosen. */
class Beside {
  constructor(session) {
    this.session = session;
    this.chosen = null;
  }

  get index() {
    const { active, tracks } = this.session;
    if (this.chosen !== null && this.chosen !== active) return this.chosen;
    return (active + 1) % tracks.length;
  }

  list(pane) {
    const { session } = this;
    if (session.tracks.length < 3) return null;
    const choose = h("select", { "aria-label": "which other robot", onchange: () => {
      this.chosen = +choose.value;
      pane.fill();
    } });
    session.tracks.forEach((track, k) => choose.append(h("option", { value: k }, track.name)));
    return choose;
  }
}

export class SourcePane {
  constructor(session, host, beside = null) {
    Object.assign(this, { session, host, beside });
    this.sources = session.page.sources ?? [];
    this.chosen = 0;
    this.files = h("select", { "aria-label": "source file", onchange: () => this.open(+this.files.value) });
    this.note = h("span", { class: "quiet" });
    this.text = h("div", { class: "code", tabindex: "0", role: "region", "aria-label": "source text" });
    this.text.addEventListener("click", (event) => this.clicked(event));
    this.text.addEventListener("keydown", (event) => this.stepped(event));
    this.robots = beside?.list(this) ?? null;
    host.append(h("div", { class: "bar" }, this.robots ?? "", this.files, this.note), this.text);
    session.on("track", () => this.fill());
    session.on("time", () => this.mark());
    session.on("line", () => this.follow(this.session.line));
    this.fill();
  }

  get index() {
    return this.beside?.index ?? this.session.active;
  }

  get track() {
    return this.session.tracks[this.index];
  }

  /** The files of the track. */
  fill() {
    const active = this.index;
    if (this.robots) this.robots.value = String(active);
    this.shown = this.sources
      .map((source, index) => ({ ...source, index }))
      .filter((source) => (source.track ?? 0) === active);
    if (!this.shown.length) this.shown = this.sources.map((source, index) => ({ ...source, index }));
    this.files.replaceChildren(...this.shown.map((s, k) => h("option", { value: k }, s.name)));
    this.files.hidden = this.shown.length < 2;
    this.open(0);
    this.mark();
  }

  open(k) {
    this.chosen = k;
    this.files.value = String(k);
    const source = this.shown[k];
    this.marked = null;
    this.lines = [];
    if (!source) {
      this.text.replaceChildren(h("p", { class: "quiet" }, "No source text: the program was built in Python, or this is a log."));
      this.note.textContent = "";
      return;
    }
    const robot = this.session.page.gantt?.length ? `${this.track.name}: ` : "";
    this.note.textContent = this.shown.length < 2 ? `${robot}${source.name}` : robot;
    const spent = this.spent(source.index);
    const most = Math.max(0, ...[...spent.values()].map((one) => one.time));
    const rows = source.text.split("\n");
    const blocks = [];
    for (let first = 0; first < rows.length; first += BLOCK) {
      const block = h("div", { class: "block" });
      block.style.containIntrinsicSize = `auto ${Math.min(BLOCK, rows.length - first) * 17}px`;
      rows.slice(first, first + BLOCK).forEach((row, k) => {
        const line = first + k + 1;
        const element = this.line(row, line, spent.get(line), most);
        this.lines[line] = element;
        block.append(element);
      });
      blocks.push(block);
    }
    this.text.replaceChildren(...blocks);
  }

  /** Time, waits included, and number of passes of each line of a file. */
  spent(index) {
    const found = new Map();
    const at = ({ source = -1, line }) => {
      if (source !== index || !line) return null;
      if (!found.has(line)) found.set(line, { time: 0, passes: 0, waits: 0, fault: false });
      return found.get(line);
    };
    for (const move of this.track?.moves ?? []) {
      const one = at(move);
      if (!one) continue;
      one.fault ||= move.fault ?? false;
      if (move.end === undefined) continue;
      one.passes += 1;
      one.time += move.end - move.begin;
    }
    for (const flag of this.track?.flags ?? []) {
      const one = flag.duration > 0 ? at(flag) : null;
      if (!one) continue;
      one.waits += 1;
      one.time += flag.duration;
    }
    for (const one of found.values()) one.passes ||= one.waits;
    return found;
  }

  line(text, number, spent, most) {
    const kind = spent ? (spent.fault ? " drives fault" : " drives") : "";
    const row = h("div", { class: `line${kind}`, "data-line": number });
    const heat = h("span", { class: "heat" });
    if (spent?.fault) row.title = "cannot be driven: see Faults";
    else if (spent?.passes && most > 0) {
      const bar = h("i");
      bar.style.width = `${Math.max(4, (100 * spent.time) / most)}%`;
      heat.append(bar);
      const times = spent.passes > 1 ? `, ${spent.passes} times` : "";
      row.title = `${seconds(spent.time)}${times}`;
    }
    const cost = spent?.fault ? "fault" : spent?.passes ? `${spent.passes > 1 ? `${spent.passes} × ` : ""}${(spent.time / spent.passes).toFixed(2)}` : "";
    row.append(
      h("span", { class: "gutter" }, h("span", { class: "number" }, String(number)), h("span", { class: "cost" }, cost), heat),
      h("span", { class: "words" }, text || " "),
    );
    return row;
  }

  clicked(event) {
    const row = event.target.closest(".line");
    if (!row || String(window.getSelection())) return;
    this.go(+row.dataset.line);
  }

  go(line) {
    if (this.index !== this.session.active) this.session.choose(this.index);
    this.session.goLine(this.shown[this.chosen].index, line);
    this.select(line);
  }

  /** The arrows lead from driven line to driven line. */
  stepped(event) {
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const from = this.picked ?? this.now;
    let line = from ? +from.dataset.line : 0;
    do line += step;
    while (this.lines[line] && !this.lines[line].matches(".drives"));
    if (!this.lines[line]) return;
    this.go(line);
    this.scroll(this.picked);
  }

  select(line) {
    this.picked?.classList.remove("picked");
    this.picked = this.lines[line];
    this.picked?.classList.add("picked");
  }

  /** Show a place that was asked for elsewhere. */
  follow({ source, line }) {
    const k = this.shown.findIndex((one) => one.index === source);
    if (k < 0) return;
    if (k !== this.chosen) this.open(k);
    this.select(line);
    this.lines[line]?.scrollIntoView({ block: "nearest" });
  }

  /** Mark the line that is driven now. */
  mark() {
    const { session, track } = this;
    if (!track) return;
    const t = session.timeOf(track);
    const rest = track.restAt(t);
    const move = rest?.line ? rest : track.moves[track.moveAt(t)];
    const key = move?.line ? `${move.source ?? -1}:${move.line}` : "";
    if (key === this.marked) return;
    this.marked = key;
    this.now?.classList.remove("now");
    this.now = null;
    if (!move?.line) return;
    const k = this.shown.findIndex((one) => one.index === (move.source ?? -1));
    if (k < 0) return;
    if (k !== this.chosen) {
      this.open(k);
      this.marked = key;
    }
    this.now = this.lines[move.line];
    this.now?.classList.add("now");
    this.scroll(this.now);
  }

  scroll(row) {
    if (!row) return;
    const { top, bottom } = row.getBoundingClientRect();
    const room = this.text.getBoundingClientRect();
    if (top < room.top + 20 || bottom > room.bottom - 20) {
      this.text.scrollTop += (top + bottom) / 2 - (room.top + room.bottom) / 2;
    }
  }
}
