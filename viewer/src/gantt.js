// Several robots over one clock: moves, waits and signals, a row each, over the plots.

import { h } from "./dom.js";

const ROW = 15;
const HALF = 5.5;
const KINDS = {
  move: { name: "moves, one by one", colour: "#0072b2", other: "#6fa8d6" },
  wait: { name: "waits for another", colour: "#d55e00" },
  meeting: { name: "meets another", colour: "#cc79a7" },
  dwell: { name: "waits by itself", colour: "#b9b9b9" },
  device: { name: "device", colour: "#e69f00" },
  on: { name: "signal on", colour: "#009e73" },
};
const NEAR = 4; // pixels beside a bar at which it is still meant

export class Gantt {
  constructor(session, rows) {
    Object.assign(this, { session, rows });
    this.height = ROW * rows.length + 4;
  }

  legend() {
    const used = new Set(this.rows.flatMap((row) => row.bars.map((bar) => bar.kind)));
    return Object.entries(KINDS).filter(([key]) => used.has(key)).map(([, kind]) => {
      const item = h("span", { class: "key" }, h("i", {}), kind.name);
      item.firstChild.style.background = kind.colour;
      return item;
    });
  }

  /** Draw all rows: x of a time, from left to right of the plots. */
  draw(ctx, { x, left, right, text, line }) {
    ctx.font = "11px system-ui, sans-serif";
    ctx.textBaseline = "middle";
    this.rows.forEach((row, k) => {
      const middle = 2 + ROW * (k + 0.5);
      ctx.fillStyle = line;
      ctx.fillRect(left, middle + ROW / 2 - 0.5, right - left, 0.5);
      ctx.save();
      ctx.beginPath();
      ctx.rect(left, 0, right - left, this.height);
      ctx.clip();
      let moves = 0;
      for (const bar of row.bars) {
        const kind = KINDS[bar.kind] ?? KINDS.dwell;
        ctx.fillStyle = bar.kind === "move" && moves++ % 2 ? kind.other : kind.colour;
        const half = bar.kind === "on" ? 3 : HALF;
        ctx.fillRect(x(bar.begin), middle - half, Math.max(x(bar.end) - x(bar.begin), 1), 2 * half);
      }
      ctx.restore();
      ctx.fillStyle = text;
      ctx.textAlign = "right";
      const chosen = (row.track ?? -1) === this.session.active;
      ctx.font = `${chosen ? "600 " : ""}${(row.track ?? -1) < 0 ? 10 : 11}px system-ui, sans-serif`;
      ctx.fillText(shortened(ctx, row.name, left - 6), left - 4, middle);
    });
    ctx.textAlign = "left";
  }

  /** The row and bar at a place. */
  at(t, y, seconds) {
    const row = this.rows[Math.floor((y - 2) / ROW)];
    if (!row) return {};
    const inside = row.bars.find((bar) => t >= bar.begin && t <= bar.end);
    const near = inside ?? row.bars.find((bar) => t >= bar.begin - NEAR * seconds && t <= bar.end + NEAR * seconds);
    return { row, bar: near };
  }

  told(t, y, seconds) {
    const { row, bar } = this.at(t, y, seconds);
    if (!row) return "";
    const what = bar ? `: ${bar.text}${bar.line ? `, line ${bar.line}` : ""} (${bar.begin.toFixed(3)} to ${bar.end.toFixed(3)} s)` : "";
    return `${t.toFixed(3)} s, ${row.name}${what}`;
  }

  clicked(t, y, seconds) {
    const { row, bar } = this.at(t, y, seconds);
    const track = row?.track ?? -1;
    this.session.go({ track: track < 0 ? this.session.active : track, t, source: bar?.source ?? -1, line: bar?.line ?? 0 });
  }
}

function shortened(ctx, name, room) {
  if (ctx.measureText(name).width <= room) return name;
  let kept = name;
  while (kept.length > 1 && ctx.measureText(`…${kept}`).width > room) kept = kept.slice(1);
  return `…${kept}`;
}
