// What is shown now: the one clock, which track is the solid one, and who wants to know.

import { interpolated, Track } from "./track.js";

const alike = (one, other) =>
  one.group === other.group && one.meets !== null && one.meets.length === other.meets?.length;

export class Session extends EventTarget {
  constructor(page) {
    super();
    this.page = page;
    this.arms = page.arms ?? [];
    this.tracks = (page.tracks ?? []).map((data, k) => new Track(data, this.arms[data.arm ?? 0], k));
    const solid = this.tracks.filter((track) => !track.ghost);
    this.active = page.chosen ?? (solid.at(-1) ?? this.tracks.at(-1))?.index ?? -1;
    this.sync = "clock";
    // A coat is first seen as it is in the end; playback begins at the beginning.
    this.t = page.coat?.growth ? (this.tracks[this.active]?.duration ?? 0) : 0;
    this.playing = false;
    this.speed = 1;
    this.loop = true;
    this.view = null; // s, from when to when plots show
  }

  get track() {
    return this.tracks[this.active];
  }

  /** Tracks in the scene, the active one first: its group's ghosts beside a solid one, the solid
   * one beside a ghost; of a group without ghosts all robots. */
  shown() {
    const { track } = this;
    if (!track) return [];
    const group = this.tracks.filter((one) => one.group === track.group && one !== track);
    const ghosts = group.filter((one) => one.ghost);
    if (track.ghost) return [track, ...group.filter((one) => !one.ghost).slice(-1)];
    if (ghosts.length) return [track, ...ghosts];
    return [track, ...group.filter((one) => one.arm !== track.arm)];
  }

  /** Whether a track is drawn as a ghost beside the active one. */
  isGhost(track) {
    const paired = this.tracks.some((one) => one.group === this.track.group && one.ghost);
    return paired && track !== this.track;
  }

  /** Whether something of the page is to be seen beside the active track. */
  beside({ track = -1 }) {
    return track < 0 || track === this.active;
  }

  get duration() {
    if (!this.track) return 0;
    const beside = this.shown().filter((track) => !this.met(track));
    return Math.max(...beside.map((track) => track.duration));
  }

  /** Time of a track when the clock shows t. */
  timeOf(track, t = this.t) {
    const met = this.met(track);
    return met ? interpolated(met.own, met.other, t) : Math.min(t, track.duration);
  }

  /** Times of the active track, and of another one, at which both are at the same places; null
   * where they run by the clock. */
  met(track) {
    if (this.sync !== "waypoints" || track === this.track || !alike(track, this.track)) return null;
    return { own: this.track.meets, other: track.meets };
  }

  /** Whether any tracks of a group, or of all of them, can run waypoint by waypoint. */
  meeting(group = null) {
    const found = this.tracks.filter((track) => group === null || track.group === group);
    return found.some((one) => found.some((other) => one !== other && alike(one, other)));
  }

  emit(name) {
    this.dispatchEvent(new Event(name));
  }

  on(names, call) {
    for (const name of names.split(" ")) this.addEventListener(name, call);
  }

  seek(t) {
    this.t = Math.min(Math.max(t, 0), this.duration);
    this.emit("time");
  }

  play(playing = !this.playing) {
    if (playing && this.t >= this.duration - 1e-6) this.t = 0;
    this.playing = playing;
    this.emit("playing");
  }

  /** Let time pass: s by the wall. */
  pass(seconds) {
    if (!this.playing) return;
    let t = this.t + seconds * this.speed;
    if (t >= this.duration) {
      if (this.loop) t %= Math.max(this.duration, 1e-6);
      else {
        t = this.duration;
        this.play(false);
      }
    }
    this.seek(t);
  }

  choose(index) {
    if (index === this.active || !this.tracks[index]) return;
    const share = this.duration ? this.t / this.duration : 0;
    this.active = index;
    this.view = null;
    this.emit("track");
    this.seek(share * this.duration);
  }

  synchronise(how) {
    this.sync = how;
    this.emit("track");
    this.seek(this.t);
  }

  zoom(range) {
    this.view = range;
    this.emit("view");
  }

  /** Go to where something happens: a time of a track, or a line of the source. */
  go({ track = this.active, t = null, source = -1, line = 0 }) {
    if (track !== this.active && this.tracks[track]) this.choose(track);
    if (t !== null && t !== undefined) this.seek(t);
    else if (line > 0) this.goLine(source, line);
    if (line > 0) {
      this.line = { source, line };
      this.emit("line");
    }
  }

  /** The next time that a line is driven, from now on, round again at the end. */
  goLine(source, line) {
    const found = this.track?.moves.filter(
      (move) => move.line === line && (move.source ?? -1) === source && move.begin !== undefined,
    );
    const flags = this.track?.flags.filter((flag) => flag.line === line && (flag.source ?? -1) === source);
    const times = [...(found ?? []).map((move) => move.begin), ...(flags ?? []).map((flag) => flag.t)];
    times.sort((a, b) => a - b);
    if (!times.length) return false;
    this.seek(times.find((time) => time > this.t + 1e-3) ?? times[0]);
    return true;
  }
}
