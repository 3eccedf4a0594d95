// What lies over the scene: how it is looked at, what is shown, labels, and the state in numbers.

import { COLOURINGS } from "./path.js";
import { css, kindOf, KINDS, REST, viridis } from "./colours.js";
import { h, number } from "./dom.js";
import { VIEWS } from "./scene.js";

const TELL_EVERY = 120; // ms between numbers while time runs
const OPTIONS = { programmed: "programmed path", zones: "zones", flags: "waits, outputs", frames: "frames", labels: "names", robot: "robot", obstacles: "cell", coat: "coat", swept: "swept space" };

export class Overlay {
  constructor(session, view, host) {
    Object.assign(this, { session, view, host });
    this.labels = h("div", { class: "labels" });
    this.state = h("dl", { class: "state" });
    this.scale = h("div", { class: "scale" });
    this.proof = h("button", { class: "proof" });
    this.tip = h("div", { class: "tip" });
    this.tip.hidden = true;
    host.append(this.labels, this.bar(), this.state, this.scale, this.proof, this.tip);
    view.onrender = () => this.draw();
    session.on("time", () => {
      const now = performance.now();
      if (session.playing && now - (this.told ?? 0) < TELL_EVERY) return;
      this.told = now;
      this.tell();
    });
    session.on("track", () => {
      this.tell();
      this.legend();
      this.fillLabels();
      this.fillProof();
      this.fillTraces();
    });
    this.tell();
    this.legend();
    this.fillLabels();
    this.fillProof();
    this.pointer();
  }

  bar() {
    const { view, session } = this;
    const views = Object.keys(VIEWS).map((name, k) =>
      h("button", { title: `${name} (${k + 1})`, onclick: () => view.look(name) }, name),
    );
    this.followed = h("button", { title: "follow the TCP (f)", "aria-pressed": "false", onclick: () => this.follow() }, "follow TCP");
    const colours = h("select", { "aria-label": "colour of the path", onchange: () => this.recolour(colours.value) });
    for (const [key, { name, chart }] of Object.entries(COLOURINGS)) {
      const usable = session.tracks.some((track) => (chart ? track.channel(chart) : key === "limit" ? track.data.limits : key !== "spray" || view.coat));
      if (usable) colours.append(h("option", { value: key }, name));
    }
    this.colours = colours;
    this.traces = h("select", { "aria-label": "trace of a link", onchange: () => view.traceNode(this.traces.value === "" ? null : +this.traces.value) });
    this.fillTraces();
    const known = Object.entries(OPTIONS).filter(([key]) => key !== "coat" || view.coat);
    const switches = known.map(([key, name]) => {
      const box = h("input", { type: "checkbox", checked: view.show[key], onchange: () => this.set(key, box.checked) });
      return h("label", {}, box, name);
    });
    const menu = h("details", { class: "menu" }, h("summary", {}, "show"),
      h("div", {}, ...switches, h("label", { class: "row" }, "trace of ", this.traces)));
    return h("div", { class: "bar over" }, h("div", { class: "segments" }, ...views), this.followed, h("label", { class: "row" }, h("span", { class: "quiet" }, "path by "), colours), menu);
  }

  fillTraces() {
    if (!this.traces) return;
    const { track } = this.session;
    const nodes = (track?.arm.nodes ?? []).map((node, k) => [node.name, k]).filter(([name]) => name !== "world" && name !== "base");
    this.traces.replaceChildren(h("option", { value: "" }, "nothing"), ...nodes.map(([name, k]) => h("option", { value: k }, name)));
    this.traces.value = this.view.trace === null ? "" : String(this.view.trace);
  }

  set(key, value) {
    this.view.set(key, value);
    if (key === "labels") this.draw();
  }

  follow() {
    this.view.follow = !this.view.follow;
    this.followed.setAttribute("aria-pressed", String(this.view.follow));
    this.view.touch();
  }

  recolour(key) {
    this.colours.value = key;
    this.view.recolour(key);
    this.legend();
  }

  legend() {
    const { view, session } = this;
    const path = view.paths.find((one) => !one.ghost);
    const names = session.track?.data.limits?.names ?? [];
    if (view.colourBy === "limit") {
      const kinds = [...new Set(names.map(kindOf))].sort((a, b) => KINDS.indexOf(a) - KINDS.indexOf(b));
      this.scale.replaceChildren(...[...kinds, REST].map((kind) => {
        const key = h("span", { class: "key" }, h("i", {}), kind.name);
        key.firstChild.style.background = kind.colour;
        return key;
      }));
      return;
    }
    const { low, high, unit, turned } = path?.scale ?? {};
    if (high === undefined) {
      this.scale.replaceChildren();
      return;
    }
    const stops = Array.from({ length: 9 }, (_, k) => css(viridis(turned ? 1 - k / 8 : k / 8, view.theme)));
    const ramp = h("i", { class: "ramp" });
    ramp.style.background = `linear-gradient(90deg, ${stops.join(",")})`;
    this.scale.replaceChildren(h("span", {}, number(low)), ramp, h("span", {}, `${number(high)} ${unit}`));
  }

  /** Names at things that stand around, and at frames. */
  fillLabels() {
    const { arms } = this.view;
    this.named = [];
    if (!arms.length) return;
    const seen = new Set();
    arms[0].group.updateMatrixWorld(true);
    arms[0].group.traverse((object) => {
      const body = object.userData.body;
      if (body?.role !== "obstacle" || seen.has(body.name)) return;
      seen.add(body.name);
      this.named.push({ text: body.name, object: object.parent, switch: "obstacles" });
    });
    for (const { name, object } of this.view.frames) this.named.push({ text: name, object, switch: "frames" });
    for (const one of this.named) one.element = h("span", {}, one.text);
    this.labels.replaceChildren(...this.named.map((one) => one.element));
  }

  draw() {
    const { view } = this;
    const taken = [];
    for (const one of this.named) {
      const m = one.object.matrixWorld.elements;
      const at = view.show.labels && view.show[one.switch] ? view.onScreen([m[12], m[13], m[14]]) : null;
      const free = at && !taken.some(([x, y]) => Math.abs(x - at[0]) < 70 && Math.abs(y - at[1]) < 14);
      one.element.hidden = !free;
      if (!free) continue;
      taken.push(at);
      one.element.style.transform = `translate(${Math.round(at[0] + 5)}px, ${Math.round(at[1] - 7)}px)`;
    }
  }

  /** Where the robot is, in words. */
  tell() {
    const { session, view } = this;
    const { track } = session;
    if (!track) return;
    const t = session.timeOf(track);
    const move = track.moves[track.moveAt(t)];
    const speed = track.channel("speed");
    const limit = track.data.limits?.names[track.limitAt(t)];
    const rest = track.restAt(t);
    const rows = [];
    if (move) rows.push(["move", `${move.number}${move.line ? ` · line ${move.line}` : ""}`], ["", move.label]);
    if (speed) rows.push(["TCP", `${number(track.value(speed, t), 0)} mm/s`]);
    if (track.data.limits) rows.push(["limit", rest ? rest.text : limit ?? "standing still"]);
    const near = track.clearanceAt(t);
    const spraying = view.coat?.sprays(t);
    if (spraying !== undefined) rows.push(["gun", spraying ? "on" : "off"]);
    if (near) rows.push(["clearance", `${number(1e3 * near.distance, 1)} mm`], ["", `${near.pair[0]} – ${near.pair[1]}`]);
    this.state.replaceChildren(...rows.flatMap(([name, text]) => [h("dt", {}, name), h("dd", {}, text)]));
  }

  fillProof() {
    const proof = this.session.track?.data.proof;
    this.proof.hidden = !proof;
    if (!proof) return;
    this.proof.className = proof.proven ? "proof" : "proof bad";
    this.proof.replaceChildren(h("b", {}, proof.proven ? "✓ proven " : "✗ not proven "), proof.text);
    this.proof.onclick = () => proof.t !== undefined && this.session.seek(proof.t);
  }

  /** A click on the path goes to its time; a pointer on a thing names it. */
  pointer() {
    const canvas = this.view.renderer.domElement;
    let down = null;
    canvas.addEventListener("pointerdown", (event) => (down = [event.offsetX, event.offsetY]));
    canvas.addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) > 4) return;
      const solid = this.view.paths.filter((path) => !path.ghost);
      const near = solid.map((path) => path.pick(event.offsetX, event.offsetY)).filter(Boolean);
      near.sort((a, b) => a.off - b.off);
      if (near.length) this.session.go(near[0]);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) return;
      const flag = this.view.show.flags ? this.flagAt(event.offsetX, event.offsetY) : null;
      this.tip.hidden = !flag;
      if (!flag) return;
      this.tip.textContent = flag;
      this.tip.style.transform = `translate(${event.offsetX + 12}px, ${event.offsetY + 8}px)`;
    });
  }

  flagAt(x, y) {
    const { track } = this.session;
    const found = (track?.flags ?? []).filter((flag) => {
      const at = this.view.onScreen(track.tcp(flag.t));
      return at && Math.hypot(at[0] - x, at[1] - y) < 8;
    });
    return found.slice(0, 6).map((flag) => `${flag.t.toFixed(3)} s${flag.line ? `, line ${flag.line}` : ""}: ${flag.text}`).join("\n");
  }
}
