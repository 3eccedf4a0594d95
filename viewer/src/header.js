// The row at the top: what this is, its figures, what the cycle goes into.

import { h, icon } from "./dom.js";

const SHARES = { motion: "var(--accent)", settling: "#56b4e9", waits: "#d55e00", devices: "#e69f00" };

export function header(session, host, { theme, help }) {
  const { page } = session;
  const facts = Object.entries(page.facts ?? {}).map(([name, value]) =>
    h("div", { class: "fact" }, h("small", {}, name), h("b", {}, value)),
  );
  const pieces = [
    h("div", { class: "title" }, h("small", {}, page.kind), h("h1", { title: page.title }, page.title)),
    h("div", { class: "facts" }, ...facts),
    shareBar(page.shares ?? []),
    choice(session),
    h("div", { class: "tools" },
      h("button", { title: "light or dark (t)", onclick: theme }, icon("theme")),
      h("button", { title: "print (p)", onclick: () => window.print() }, icon("print")),
      h("button", { title: "keys (?)", onclick: help }, "?")),
  ];
  host.append(...pieces.filter(Boolean));
}

function shareBar(shares) {
  const total = shares.reduce((sum, share) => sum + share.seconds, 0);
  if (!total) return null;
  const bar = h("div", { class: "stack" });
  const names = h("div", { class: "names" });
  for (const { name, seconds } of shares) {
    const part = h("i", { title: `${name}: ${seconds.toFixed(3)} s` });
    part.style.flexGrow = String(seconds);
    part.style.background = SHARES[name] ?? "#888";
    bar.append(part);
    const label = h("span", {}, h("i", {}), `${name} `, h("b", {}, `${seconds.toFixed(2)} s`));
    label.firstChild.style.background = SHARES[name] ?? "#888";
    names.append(label);
  }
  return h("div", { class: "shares" }, bar, names);
}

/** Which track is the solid one, and how two run together. */
function choice(session) {
  const groups = [...new Set(session.tracks.map((track) => track.group))];
  const many = groups.length > 1 || session.tracks.length > 3;
  if (session.tracks.length < 2) return null;
  const list = h("select", { "aria-label": "which motion", onchange: () => session.choose(+list.value) });
  session.tracks.forEach((track, k) => list.append(h("option", { value: k }, `${track.group} ${track.name}`.trim())));
  list.hidden = !many;
  const buttons = h("div", { class: "segments" });
  const mark = () => {
    list.value = String(session.active);
    const group = session.tracks.filter((track) => track.group === session.track.group && track.name);
    buttons.replaceChildren(
      ...group.map((track) =>
        h(
          "button",
          { onclick: () => session.choose(track.index), "aria-pressed": String(track === session.track) },
          `${track.name} `,
          h("small", {}, `${track.duration.toFixed(3)} s`),
        ),
      ),
    );
    buttons.hidden = group.length > 3 || group.length < 2;
  };
  session.on("track", mark);
  mark();
  const sync = session.page.together
    ? h("select", { "aria-label": "how tracks run together", onchange: () => session.synchronise(sync.value) },
        h("option", { value: "clock" }, "one clock"), h("option", { value: "waypoints" }, "waypoint by waypoint"))
    : null;
  return h("div", { class: "choice" }, list, buttons, sync);
}
