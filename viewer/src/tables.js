// Tables below the source: sorted by a click on a heading, filtered by text.

import { h, number } from "./dom.js";

const MOST_ROWS = 3000;
const BRIEF = 14; // characters of a cell that stays in one line
const UNBROKEN = 30; // likewise where there is room; longer ones are prose

export class TablePane {
  constructor(session, host, drawings = []) {
    Object.assign(this, { session, host });
    this.all = [...drawings, ...(session.page.tables ?? [])];
    this.at = 0;
    this.order = null;
    this.tabs = h("div", { class: "tabs", role: "tablist" });
    this.filter = h("input", { type: "search", placeholder: "filter", "aria-label": "filter rows", oninput: () => this.fill() });
    this.note = h("p", { class: "quiet note" });
    this.body = h("div", { class: "scroll" });
    host.append(h("div", { class: "bar" }, this.tabs, this.filter), this.note, this.body);
    session.on("time", () => this.mark());
    session.on("track", () => this.choose());
    new ResizeObserver(() => this.fit()).observe(this.body);
    this.choose();
  }

  /** The tables of all tracks and of the active one; of a table that changes it is the same one. */
  choose() {
    const open = this.tables?.[this.at];
    this.tables = this.all.filter((table) => this.session.beside(table));
    this.names();
    const at = this.tables.findIndex((table) => table.title === open?.title);
    if (open && this.tables[at] === open) {
      this.at = at;
      this.select();
      this.mark();
    } else this.open(Math.max(at, 0));
  }

  select() {
    [...this.tabs.children].forEach((tab, i) => tab.setAttribute("aria-selected", String(i === this.at)));
  }

  names() {
    this.tabs.replaceChildren(
      ...this.tables.map((table, k) =>
        h(
          "button",
          { role: "tab", class: table.rows?.some((row) => row.level === "error") ? "bad" : "", onclick: () => this.open(k) },
          table.title,
          table.rows?.length && (table.rows.some((row) => row.level) || table.title === "Moves")
            ? h("span", { class: "count" }, String(table.rows.length))
            : null,
        ),
      ),
    );
  }

  open(k) {
    if (!this.tables[k]) return;
    this.at = k;
    this.order = null;
    this.select();
    this.note.textContent = this.tables[k].note ?? "";
    this.note.hidden = !this.tables[k].note;
    this.filter.hidden = Boolean(this.tables[k].draw);
    this.fill();
  }

  sort(column) {
    const down = this.order?.column === column && !this.order.down;
    this.order = this.order?.column === column && this.order.down ? null : { column, down };
    this.fill();
  }

  rows() {
    const table = this.tables[this.at];
    const words = this.filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    let rows = table.rows.filter((row) => {
      const text = row.cells.map((cell) => String(cell ?? "")).join(" ").toLowerCase();
      return words.every((word) => text.includes(word));
    });
    if (this.order) {
      const { column, down } = this.order;
      const sign = down ? -1 : 1;
      rows = [...rows].sort((a, b) => sign * compared(a.cells[column], b.cells[column]));
    }
    return rows;
  }

  fill() {
    const table = this.tables[this.at];
    if (table.draw) {
      this.drawn = [];
      this.body.replaceChildren(table.draw());
      return;
    }
    const rows = this.rows();
    const filled = table.columns.map((_, k) => !table.rows.length || table.rows.some((row) => (row.cells[k] ?? "") !== ""));
    const numeric = table.columns.map((_, k) => table.rows.some((row) => typeof row.cells[k] === "number"));
    const most = table.columns.map((_, k) => Math.max(...table.rows.map((row) => (typeof row.cells[k] === "number" ? row.cells[k] : 0)), 1e-12));
    const head = table.columns.map((column, k) => {
      if (!filled[k]) return null;
      const sorted = this.order?.column === k ? (this.order.down ? "descending" : "ascending") : null;
      return h(
        "th",
        { class: numeric[k] ? "right" : "", "aria-sort": sorted, scope: "col" },
        h("button", { onclick: () => this.sort(k) }, column.title, column.unit ? h("small", {}, ` ${column.unit}`) : null),
      );
    });
    const body = rows.slice(0, MOST_ROWS).map((row) => this.row(row, table, numeric, most, filled));
    this.drawn = body;
    const left = rows.length - body.length;
    this.body.replaceChildren(
      h("table", {}, h("thead", {}, h("tr", {}, ...head.filter(Boolean))), h("tbody", {}, ...body)),
      left > 0 ? h("p", { class: "quiet" }, `… and ${left} more rows: filter them`) : "",
      rows.length ? "" : h("p", { class: "quiet" }, table.rows.length ? "no row matches" : "nothing"),
    );
    this.fit();
    this.mark();
  }

  /** Text is broken where a table is wider than its place, then headings, and fits if they are. */
  fit() {
    const table = this.body.querySelector("table");
    if (!table) return;
    const wide = () => this.body.scrollWidth > this.body.clientWidth + 1;
    table.classList.remove("tight", "tightest");
    if (wide()) table.classList.add("tight");
    if (wide()) table.classList.add("tightest");
    if (wide()) table.classList.remove("tight", "tightest");
  }

  /** All tables one below the other, for paper. */
  printed() {
    const at = this.at;
    const made = this.tables.flatMap((table, k) => {
      this.open(k);
      const said = table.note ? [h("p", {}, table.note)] : [];
      return [h("h2", {}, table.title), ...said, ...[...this.body.childNodes].map((node) => node.cloneNode(true))];
    });
    this.open(at);
    return made;
  }

  row(row, table, numeric, most, filled) {
    const cells = row.cells.map((cell, k) => {
      if (!filled[k]) return null;
      const column = table.columns[k];
      if (typeof cell === "number") {
        const td = h("td", { class: "right" }, number(cell, column.digits ?? 0));
        if (column.bar && cell >= 0.5 * 10 ** -(column.digits ?? 0)) {
          const share = (100 * Math.max(cell, 0)) / most[k];
          td.classList.add("barred");
          td.style.setProperty("--share", `${share.toFixed(1)}%`);
        }
        return td;
      }
      const { length } = String(cell ?? "");
      const kind = numeric[k] ? "right" : length <= BRIEF ? "brief" : length <= UNBROKEN ? "short" : "";
      return h("td", { class: kind }, cell ?? "");
    });
    const element = h("tr", { class: row.level ?? "", tabindex: "0" }, ...cells);
    element.data = row;
    const go = () => this.session.go({ track: row.track ?? 0, t: row.t ?? null, source: row.source ?? -1, line: row.line ?? 0 });
    element.addEventListener("click", () => String(window.getSelection()) || go());
    element.addEventListener("keydown", (event) => event.key === "Enter" && go());
    return element;
  }

  /** Mark the rows of the move that is driven now. */
  mark() {
    const { track, active } = this.session;
    if (!track || !this.drawn) return;
    const move = track.moveAt(this.session.timeOf(track));
    if (move === this.move && this.marked === this.drawn) return;
    this.move = move;
    this.marked = this.drawn;
    for (const row of this.drawn) {
      const own = row.data.move === move && (row.data.track ?? 0) === active && move >= 0;
      row.classList.toggle("now", own);
      // Before anything is asked for, a table is seen from its beginning.
      if (own && !this.session.playing && this.session.t > 0) row.scrollIntoView({ block: "nearest" });
    }
  }
}

function compared(a, b) {
  if (a === b) return 0;
  if (a === null || a === undefined || a === "") return 1;
  if (b === null || b === undefined || b === "") return -1;
  if (typeof a === "number" && typeof b === "number") return a - b;
  return String(a).localeCompare(String(b), undefined, { numeric: true });
}
