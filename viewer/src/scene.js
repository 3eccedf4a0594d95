// The cell in space: arms that move, what stands around, and a camera that people can hold.

import {
  AmbientLight,
  AxesHelper,
  Box3,
  BufferAttribute,
  BufferGeometry,
  DirectionalLight,
  GridHelper,
  Group,
  HemisphereLight,
  Line,
  LineBasicMaterial,
  Matrix4,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { columnMajor } from "./kinematics.js";
import { CoatView } from "./coat.js";
import { PathView } from "./path.js";
import { bodyObject } from "./solids.js";
import { sweptSpace } from "./swept.js";
import { Veils } from "./veils.js";

export const VIEWS = {
  oblique: [1, -1.25, 0.8],
  front: [1, 0, 0.12],
  side: [0, -1, 0.12],
  top: [0, -0.001, 1],
};
const LOOKS = 8; // places of the arm that a view holds
const SNUG = 0.95; // of what holds all corners of the box round the arms, which are empty
const BACKGROUND = { light: 0xf6f7f8, dark: 0x15181b };

/** One arm of one track. */
class ArmView {
  constructor(track, { ghost, theme, around, plain }) {
    this.track = track;
    this.ghost = ghost;
    this.group = new Group();
    this.nodes = track.arm.nodes.map(() => {
      const node = new Group();
      node.matrixAutoUpdate = false;
      this.group.add(node);
      return node;
    });
    this.tools = [];
    let number = 0;
    let last = "";
    track.arm.bodies.forEach((body) => {
      if (body.role === "part") return;
      const still = body.role === "obstacle" || body.role === "floor";
      if (still && !around) return;
      if (body.name !== last) number += 1;
      last = body.name;
      const object = bodyObject(body, { ghost: ghost && !still, theme, number, plain });
      this.nodes[body.node].add(object);
      if (body.tool) this.tools.push([body.tool, object]);
    });
    this.parts = track.parts.map((part) => {
      const object = bodyObject(
        { ...track.arm.bodies[part.shape], name: part.name },
        { ghost, theme, number: 0, plain },
      );
      this.group.add(object);
      return { ...part, object };
    });
  }

  /** Put everything where it is at a time of the track. */
  pose(time) {
    const poses = this.track.poses(time);
    poses.forEach((m, k) => {
      this.nodes[k].matrix.fromArray(m);
      this.nodes[k].matrixWorldNeedsUpdate = true;
    });
    const tool = this.track.toolAt(time).name;
    for (const [name, object] of this.tools) object.visible = name === tool;
    const move = this.track.moveAt(time);
    for (const part of this.parts) {
      const place = part.places.filter((one) => one.move <= move).at(-1) ?? part.places[0];
      const own = time >= (part.begins ?? -Infinity) && time < (part.ends ?? Infinity);
      part.object.visible = own && !place.gone;
      part.object.matrix
        .fromArray(poses[place.node])
        .multiply(new Matrix4().fromArray(columnMajor(place.place)));
      part.object.matrixWorldNeedsUpdate = true;
    }
  }
}

export class SceneView {
  constructor(session, host) {
    Object.assign(this, { session, host });
    this.theme = "light";
    this.follow = false;
    this.show = { zones: true, programmed: true, frames: true, flags: true, labels: true, robot: true, obstacles: true, coat: true, swept: false };
    this.colourBy = "speed";
    this.trace = null;
    this.drawn = 0;
    const plain = drawnInSoftware();
    this.plain = plain;
    this.renderer = new WebGLRenderer({ antialias: !plain, powerPreference: "high-performance" });
    this.renderer.setPixelRatio(plain ? 1 : Math.min(window.devicePixelRatio, 2));
    host.append(this.renderer.domElement);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(38, 1, 0.01, 200);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.touch());
    this.veils = new Veils();
    this.coat = session.page.coat ? new CoatView(session.page.coat) : null;
    this.lights();
    // What is sized is blank until it is drawn, and the next frame is late for that.
    new ResizeObserver(() => {
      this.resize();
      this.render();
    }).observe(host);
    this.rebuild();
    this.resize();
    this.look("oblique");
    session.on("time", () => this.touch());
    session.on("track", () => {
      this.rebuild();
      this.touch();
    });
  }

  lights() {
    this.scene.add(new AmbientLight(0xffffff, 0.55), new HemisphereLight(0xffffff, 0x9a958c, 1.3));
    const key = new DirectionalLight(0xffffff, 1.5);
    key.position.set(2, -3, 5);
    this.scene.add(key);
  }

  rebuild() {
    this.root?.removeFromParent();
    dispose(this.root);
    this.root = new Group();
    this.scene.add(this.root);
    const { session, theme } = this;
    const shown = session.shown();
    const around = new Set();
    this.arms = shown.map((track) => {
      const first = !around.has(track.arm);
      around.add(track.arm);
      return new ArmView(track, { ghost: session.isGhost(track), theme, around: first, plain: this.plain });
    });
    for (const arm of this.arms) this.root.add(arm.group);
    this.paths = shown.map((track) => new PathView(this, track, this.arms[shown.indexOf(track)]));
    this.frames = this.frameObjects();
    this.gap = gapLine(0x009e73);
    this.tightest = gapLine(0xd0342c);
    this.root.add(this.gap, this.tightest);
    this.proof();
    this.coat?.build(this);
    this.swept = null;
    this.scene.background?.dispose?.();
    this.renderer.setClearColor(BACKGROUND[theme]);
    this.grid();
    this.applyShow();
    this.pose();
    this.veils.collect(this.root);
  }

  /** Points of the arms that shall be seen, ghosts left out: their joints and tips. */
  seen() {
    return this.arms.filter((arm) => !arm.ghost).flatMap((arm) => {
      const links = arm.nodes.slice(1).map((node) => new Vector3().setFromMatrixPosition(node.matrix));
      return [...links, new Vector3(...arm.track.tcp(this.session.timeOf(arm.track)))];
    });
  }

  /** Where the active track's proof is tightest. */
  proof() {
    const proof = this.session.track?.data.proof;
    this.tightest.visible = Boolean(proof?.first);
    if (proof?.first) drawGap(this.tightest, proof);
  }

  frameObjects() {
    if (!this.arms.length) return [];
    const { arm } = this.arms[0].track;
    return arm.frames.map((frame) => {
      const axes = new AxesHelper(0.15);
      axes.matrixAutoUpdate = false;
      axes.matrix = new Matrix4().fromArray(columnMajor(frame.place));
      this.arms[0].nodes[frame.node].add(axes);
      return { name: frame.name, object: axes };
    });
  }

  grid() {
    const box = this.bounds();
    const size = Math.ceil(Math.max(box.max.x - box.min.x, box.max.y - box.min.y, 1) * 1.6);
    const [major, minor] = this.theme === "dark" ? [0x3a4046, 0x272b30] : [0xc9cdd1, 0xe2e4e7];
    const grid = new GridHelper(2 * size, (this.plain ? 2 : 4) * size, major, minor);
    grid.rotateX(Math.PI / 2);
    grid.position.set(Math.round((box.min.x + box.max.x) / 2), Math.round((box.min.y + box.max.y) / 2), Math.min(0, box.min.z) - 0.002);
    this.root.add(grid);
  }

  /** What the camera should hold: arms as they stand, and where their tools go. */
  bounds() {
    const box = new Box3();
    for (const arm of this.arms) {
      for (let k = 0; k <= LOOKS; k += 1) {
        arm.pose((k / LOOKS) * arm.track.duration);
        arm.group.updateMatrixWorld(true);
        arm.group.traverse((object) => {
          const role = object.userData.body?.role;
          if (role === "link" || role === "tool") box.expandByObject(object);
        });
      }
      const { world } = arm.track.path();
      for (let k = 0; k < world.length; k += 3) box.expandByPoint(new Vector3(world[k], world[k + 1], world[k + 2]));
    }
    this.pose();
    if (this.coat) box.expandByObject(this.coat.mesh);
    if (box.isEmpty()) box.set(new Vector3(-1, -1, 0), new Vector3(1, 1, 1));
    return box;
  }

  /** How far from its centre a camera holds a box, looking against a direction. */
  distance(box, towards) {
    const right = this.camera.up.clone().cross(towards).normalize();
    const up = towards.clone().cross(right);
    const tall = Math.tan((Math.PI / 360) * this.camera.fov);
    const wide = tall * this.camera.aspect;
    const half = box.getSize(new Vector3()).multiplyScalar(0.5);
    let away = 0;
    for (let k = 0; k < 8; k += 1) {
      const corner = new Vector3(k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z);
      const off = Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(up)) / tall);
      away = Math.max(away, off + corner.dot(towards));
    }
    return SNUG * away;
  }

  look(view) {
    const box = this.bounds();
    const centre = box.getCenter(new Vector3());
    const towards = new Vector3(...VIEWS[view]).normalize();
    const away = this.distance(box, towards);
    this.camera.position.copy(centre).addScaledVector(towards, away);
    this.controls.target.copy(centre);
    this.camera.near = away / 200;
    this.camera.far = away * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.touch();
  }

  setTheme(theme) {
    this.theme = theme;
    this.rebuild();
    this.touch();
  }

  set(option, value) {
    this.show[option] = value;
    this.applyShow();
    this.touch();
  }

  applyShow() {
    if (this.show.swept && !this.swept) {
      this.swept = this.arms.filter((arm) => !arm.ghost).map((arm) => sweptSpace(arm.track, this.plain));
      this.root.add(...this.swept);
    }
    for (const group of this.swept ?? []) group.visible = this.show.swept;
    for (const path of this.paths) path.apply(this.show);
    if (this.coat) this.coat.mesh.visible = this.show.coat;
    for (const { object } of this.frames) object.visible = this.show.frames;
    for (const arm of this.arms) {
      arm.group.traverse((object) => {
        const role = object.userData.body?.role;
        if (role === "obstacle" || role === "floor") object.parent.visible = this.show.obstacles;
        if (role === "link") object.parent.visible = this.show.robot;
      });
    }
  }

  recolour(by) {
    this.colourBy = by;
    for (const path of this.paths) path.colour();
    this.touch();
  }

  /** Trace a point of a node; null for none. */
  traceNode(node) {
    this.trace = node;
    for (const path of this.paths) path.traceNode(node);
    this.touch();
  }

  pose() {
    for (const arm of this.arms) arm.pose(this.session.timeOf(arm.track));
    for (const path of this.paths) path.pose(this.session.timeOf(path.track));
    const { track } = this.session;
    if (this.coat && track) {
      const t = this.session.timeOf(track);
      this.coat.show(t, track.tcp(t), this.show.coat);
    }
    const near = track?.clearanceAt(this.session.timeOf(track));
    this.gap.visible = Boolean(near) && this.show.obstacles;
    if (near) {
      drawGap(this.gap, near);
      this.gap.material.color.set(near.distance < near.wanted || near.distance <= 0 ? 0xd55e00 : 0x009e73);
    }
    if (this.follow && track) {
      const at = new Vector3(...track.tcp(this.session.timeOf(track)));
      const step = at.clone().sub(this.controls.target);
      this.controls.target.copy(at);
      this.camera.position.add(step);
      this.camera.lookAt(at);
    }
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width && height) this.size(width, height);
  }

  size(width, height) {
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    for (const path of this.paths) path.resize(width, height);
    this.touch();
  }

  touch() {
    this.dirty = true;
  }

  /** Draw if anything has changed. */
  render() {
    if (!this.dirty) return false;
    this.dirty = false;
    this.pose();
    this.veils.lift(this.camera, this.seen());
    this.renderer.render(this.scene, this.camera);
    this.drawn += 1;
    this.onrender?.();
    return true;
  }

  /** A picture of the cell as it is seen now, whatever the window's size. */
  picture(width = 1500, height = 760) {
    this.size(width, height);
    this.render();
    const made = this.renderer.domElement.toDataURL("image/png");
    this.resize();
    return made;
  }

  /** Pixels from the left and from above of a point in the world; null behind the camera. */
  onScreen(point) {
    const at = new Vector3(...point).project(this.camera);
    if (at.z > 1) return null;
    return [((at.x + 1) / 2) * this.host.clientWidth, ((1 - at.y) / 2) * this.host.clientHeight];
  }
}

/** Whether no graphics card draws: then edges are not smoothed, which takes a third of the time. */
function drawnInSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return false;
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

function gapLine(colour) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
  const line = new Line(geometry, new LineBasicMaterial({ color: colour, depthTest: false }));
  line.renderOrder = 10;
  line.frustumCulled = false;
  return line;
}

function drawGap(line, { first, second }) {
  const points = line.geometry.attributes.position;
  points.setXYZ(0, ...first);
  points.setXYZ(1, ...second);
  points.needsUpdate = true;
}

function dispose(root) {
  root?.traverse((object) => {
    object.geometry?.dispose();
    object.material?.dispose?.();
  });
}
