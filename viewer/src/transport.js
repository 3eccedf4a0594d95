// Play, pause, scrub: the row below the scene.

import { h, icon } from "./dom.js";

const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4, 8];

export class Transport {
  constructor(session, host) {
    Object.assign(this, { session, host });
    this.button = h("button", { class: "play", title: "play or pause (space)", "aria-label": "play", onclick: () => session.play() }, icon("play"));
    this.back = h("button", { title: "previous move (shift ←)", "aria-label": "previous move", onclick: () => this.step(-1) }, icon("back"));
    this.next = h("button", { title: "next move (shift →)", "aria-label": "next move", onclick: () => this.step(1) }, icon("next"));
    this.scrub = h("input", { type: "range", min: 0, max: 1, step: "any", value: 0, "aria-label": "time", oninput: () => session.seek(+this.scrub.value) });
    this.clock = h("output", { class: "clock" });
    this.speed = h("select", { "aria-label": "speed of playback", title: "speed (+ and −)", onchange: () => this.setSpeed(+this.speed.value) });
    SPEEDS.forEach((speed) => this.speed.append(h("option", { value: speed }, `× ${speed}`)));
    this.speed.value = "1";
    this.loop = h("button", { title: "loop (l)", "aria-pressed": "true", onclick: () => this.setLoop() }, icon("loop"));
    host.append(this.back, this.button, this.next, this.clock, this.scrub, this.speed, this.loop);
    session.on("time", () => this.tell());
    session.on("playing", () => this.tell());
    session.on("track", () => this.tell());
    this.tell();
  }

  setSpeed(speed) {
    this.session.speed = speed;
    this.speed.value = String(speed);
  }

  faster(step) {
    const k = SPEEDS.indexOf(this.session.speed) + step;
    if (SPEEDS[k]) this.setSpeed(SPEEDS[k]);
  }

  setLoop() {
    this.session.loop = !this.session.loop;
    this.loop.setAttribute("aria-pressed", String(this.session.loop));
  }

  /** To the beginning of the next move, or of this one and then of the one before. */
  step(direction) {
    const { session } = this;
    const now = session.timeOf(session.track);
    const begins = session.track.moves.filter((move) => move.begin !== undefined).map((move) => move.begin);
    const found = direction > 0 ? begins.find((t) => t > now + 1e-3) ?? session.duration : begins.filter((t) => t < now - 1e-3).at(-1) ?? 0;
    session.seek(found);
  }

  tell() {
    const { session } = this;
    this.scrub.max = String(session.duration);
    this.scrub.value = String(session.t);
    this.button.replaceChildren(icon(session.playing ? "pause" : "play"));
    this.button.setAttribute("aria-label", session.playing ? "pause" : "play");
    this.clock.textContent = `${session.t.toFixed(3)} / ${session.duration.toFixed(3)} s`;
  }
}
