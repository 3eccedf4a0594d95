// The row at the top: what this is, its figures, what the cycle goes into.

import { h, icon } from "./dom.js";

const SHARES = { motion: "var(--accent)", settling: "#56b4e9", waits: "#d55e00", devices: "#e69f00", "waits for others": "#cc79a7" };

const BUTTONS = 3; // tracks of a group that have one each

export function header(session, host, { theme, help }) {
  const { page } = session;
  const facts = Object.entries(page.facts ?? {}).map(([name, value]) =>
    h("div", { class: "fact" }, h("small", {}, name), h("b", {}, value)),
  );
  const pieces = [
    h("div", { class: "title" }, h("small", {}, page.kind), h("h1", { title: page.title }, page.title)),
    h("div", { class: "facts" }, ...facts),
    shareBar(session),
    choice(session),
    h("div", { class: "tools" },
      h("button", { title: "light or dark (t)", onclick: theme }, icon("theme")),
      h("button", { title: "print (p)", onclick: () => window.print() }, icon("print")),
      h("button", { title: "keys (?)", onclick: help }, "?")),
  ];
  host.append(...pieces.filter(Boolean));
  // Where all does not fit in one row, figures stand in two.
  const fit = () => {
    host.classList.remove("narrow");
    host.classList.toggle("narrow", host.scrollWidth > host.clientWidth);
  };
  new ResizeObserver(fit).observe(host);
  session.on("track", fit);
}

/** What the active track's time goes into. */
function shareBar(session) {
  const all = session.page.shares ?? [];
  if (!all.length) return null;
  const host = h("div", { class: "shares" });
  const fill = () => {
    const shares = all.filter((share) => session.beside(share));
    const bar = h("div", { class: "stack" });
    const names = h("div", { class: "names" });
    for (const { name, seconds } of shares) {
      const part = h("i");
      part.style.flexGrow = String(seconds);
      part.style.background = SHARES[name] ?? "#888";
      bar.append(part);
      const label = h("span", {}, h("i", {}), `${name} `, h("b", {}, `${seconds.toFixed(2)} s`));
      label.firstChild.style.background = SHARES[name] ?? "#888";
      names.append(label);
    }
    host.title = shares.map(({ name, seconds }) => `${name}: ${seconds.toFixed(3)} s`).join("\n");
    host.replaceChildren(bar, names);
  };
  session.on("track", fill);
  fill();
  return host;
}

/** Which track is the solid one, and how two run together. */
function choice(session) {
  if (session.tracks.length < 2) return null;
  // Buttons for the few of a group, a list of the groups; a list of all where a group has many.
  const groups = new Map();
  for (const track of session.tracks) groups.set(track.group, [...(groups.get(track.group) ?? []), track]);
  const few = [...groups.values()].every((group) => group.length <= BUTTONS);
  const listed = few ? [...groups.values()].map((group) => group.filter((track) => !track.ghost).at(-1) ?? group.at(-1)) : session.tracks;
  const list = h("select", { "aria-label": "which motion", onchange: () => session.choose(+list.value) });
  for (const track of listed) list.append(h("option", { value: track.index }, few && groups.size > 1 ? track.group : `${track.group} ${track.name}`.trim()));
  list.hidden = listed.length < 2;
  const buttons = h("div", { class: "segments" });
  const mark = () => {
    const own = listed.find((track) => track === session.track) ?? listed.find((track) => track.group === session.track.group);
    list.value = String(own.index);
    const group = few ? groups.get(session.track.group).filter((track) => track.name) : [];
    buttons.replaceChildren(
      ...group.map((track) =>
        h(
          "button",
          { onclick: () => session.choose(track.index), "aria-pressed": String(track === session.track) },
          `${track.name} `,
          h("small", {}, `${(track.data.takes ?? track.duration).toFixed(3)} s`),
        ),
      ),
    );
    buttons.hidden = group.length < 2;
    if (sync) sync.hidden = !session.meeting(session.track.group);
  };
  const sync = session.meeting()
    ? h("select", { "aria-label": "how tracks run together", onchange: () => session.synchronise(sync.value) },
        h("option", { value: "clock" }, "one clock"), h("option", { value: "waypoints" }, "by waypoint"))
    : null;
  session.on("track", mark);
  mark();
  return h("div", { class: "choice" }, list, buttons, sync);
}
