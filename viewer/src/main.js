// Puts the page together, and lets its one clock run.

import uPlotStyle from "uplot/dist/uPlot.min.css";
import style from "./styles.css";
import { coatDrawing } from "./coat.js";
import { readPage } from "./decode.js";
import { h } from "./dom.js";
import { frontDrawing } from "./front.js";
import { header } from "./header.js";
import { help, keys } from "./keys.js";
import { Overlay } from "./overlay.js";
import { PlotPane } from "./plots.js";
import { SceneView } from "./scene.js";
import { Session } from "./session.js";
import { sourcePanes } from "./source.js";
import { splitter } from "./split.js";
import { TablePane } from "./tables.js";
import { Transport } from "./transport.js";

const preferred = () => (window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");

function scene(session, host) {
  try {
    return new SceneView(session, host);
  } catch (error) {
    host.append(h("p", { class: "quiet" }, `This browser draws no 3-D here (${error.message}); all else works.`));
    return null;
  }
}

function layout(session) {
  const areas = Object.fromEntries(
    ["top", "scene", "transport", "plots", "source", "tables"].map((name) => [name, h("section", { class: name })]),
  );
  const side = h("div", { class: "side" }, areas.source, splitter("--tables", "horizontal", (e) => window.innerHeight - e.clientY), areas.tables);
  const main = h("div", { class: "main" }, areas.scene, areas.transport, splitter("--plots", "horizontal", (e) => window.innerHeight - e.clientY), areas.plots);
  const root = h("div", { class: "page" }, areas.top, main, splitter("--side", "vertical", (e) => window.innerWidth - e.clientX), side);
  if (session.page.gantt?.length) root.classList.add("several");
  if (!(session.page.sources ?? []).length) root.classList.add(session.tracks.length ? "textless" : "plain");
  return { root, ...areas };
}

/** Sentences that the reader should not miss. */
function notices(session, host) {
  const notes = session.page.notes ?? [];
  if (notes.length) host.append(h("ul", { class: "notices" }, ...notes.map((note) => h("li", {}, note))));
}

function start(page) {
  document.head.append(h("style", {}, uPlotStyle), h("style", {}, style));
  const session = new Session(page);
  const parts = layout(session);
  document.body.append(parts.root);
  const root = document.documentElement;
  let theme = preferred();
  const dress = (as = theme) => {
    root.dataset.theme = as;
    view?.setTheme(as);
    overlay?.fillLabels();
    overlay?.legend();
    plots.setTheme();
  };
  const turn = () => {
    theme = theme === "dark" ? "light" : "dark";
    dress();
  };
  root.dataset.theme = theme;
  header(session, parts.top, { theme: turn, help });
  const view = session.track ? scene(session, parts.scene) : null;
  const overlay = view && new Overlay(session, view, parts.scene);
  notices(session, parts.scene);
  const transport = new Transport(session, parts.transport);
  const plots = new PlotPane(session, parts.plots);
  const source = sourcePanes(session, parts.source);
  const drawings = [
    ...(page.front ? [frontDrawing(session)] : []),
    ...(page.coat ? [coatDrawing(page.coat)] : []),
  ];
  const tables = new TablePane(session, parts.tables, drawings);
  keys({ session, transport, view, overlay, tables, theme: turn });
  dress();
  printing(parts, view, tables, dress);
  run(session, view);
  const hash = /[#&]t=([\d.]+)/.exec(window.location.hash);
  if (hash) session.seek(+hash[1]);
  return { session, view, overlay, transport, plots, source, tables, theme: turn };
}

function run(session, view) {
  let last = null;
  const frame = (now) => {
    if (last !== null) session.pass(Math.min((now - last) / 1000, 0.25));
    last = now;
    view?.render();
    window.requestAnimationFrame(frame);
  };
  window.requestAnimationFrame(frame);
}

/** On paper, which is light, the scene is a picture, and tables stand one below the other. */
function printing({ root, scene }, view, tables, dress) {
  const papers = h("section", { class: "papers" });
  const image = view && h("img", { class: "printed", alt: "the cell" });
  root.append(papers);
  if (image) scene.append(image);
  window.addEventListener("beforeprint", () => {
    dress("light");
    if (image) image.src = view.picture();
    papers.replaceChildren(...tables.printed());
  });
  window.addEventListener("afterprint", () => {
    papers.replaceChildren();
    dress();
  });
}

const ready = readPage().then(start);
/** For tests, and for whoever drives the page from its frame. */
window.flyby = { ready };
ready.then((parts) => Object.assign(window.flyby, parts));
