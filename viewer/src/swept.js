// The space that an arm sweeps: its links and tools where they are along the path, seen through.

import { Group, InstancedMesh, Matrix4, MeshLambertMaterial } from "three";
import { columnMajor } from "./kinematics.js";
import { geometryOf } from "./solids.js";
import { before } from "./track.js";

const PLACES = 60; // of the arm along the path, evenly over what its tip and elbow travel
const PLACES_IN_SOFTWARE = 24;
const COLOURS = [0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7];
const OPACITY = 0.05;
const STILL = 1e-6;

/** Copies of the moving bodies of a track's arm, as one group. */
export function sweptSpace(track, plain) {
  const group = new Group();
  const places = timesOf(track, plain ? PLACES_IN_SOFTWARE : PLACES).map((time) => ({ poses: track.poses(time), tool: track.toolAt(time).name }));
  for (const body of track.arm.bodies) {
    if (body.role !== "link" && body.role !== "tool") continue;
    if (places.every(({ poses }) => poses[body.node].every((v, i) => Math.abs(v - places[0].poses[body.node][i]) < STILL))) continue;
    const there = places.filter(({ tool }) => !body.tool || body.tool === tool);
    const material = new MeshLambertMaterial({ color: COLOURS[track.index % COLOURS.length], transparent: true, opacity: OPACITY, depthWrite: false });
    const copies = new InstancedMesh(geometryOf(body.shape, plain), material, there.length);
    const own = new Matrix4().fromArray(columnMajor(body.place));
    there.forEach(({ poses }, k) => copies.setMatrixAt(k, new Matrix4().fromArray(poses[body.node]).multiply(own)));
    copies.frustumCulled = false;
    copies.renderOrder = 5;
    group.add(copies);
  }
  return group;
}

/** Times between which the arm's frames travel equally far. */
function timesOf(track, count) {
  const times = track.pathTimes();
  const travelled = new Float64Array(times.length);
  let last = track.poses(times[0]);
  for (let k = 1; k < times.length; k += 1) {
    const poses = track.poses(times[k]);
    let far = 0;
    poses.forEach((m, i) => {
      far = Math.max(far, Math.hypot(m[12] - last[i][12], m[13] - last[i][13], m[14] - last[i][14]));
    });
    travelled[k] = travelled[k - 1] + far;
    last = poses;
  }
  const whole = travelled.at(-1);
  return Array.from({ length: count }, (_, k) => times[before(travelled, (whole * k) / (count - 1))]);
}
