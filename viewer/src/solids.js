// Bodies of arms and cells as three.js draws them.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  CustomBlending,
  CylinderGeometry,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  OneFactor,
  OneMinusSrcAlphaFactor,
  SphereGeometry,
  SrcAlphaFactor,
} from "three";
import { coarse } from "./coarse.js";
import { columnMajor } from "./kinematics.js";

const MOST_IN_SOFTWARE = 2500; // triangles of a mesh that is drawn without a graphics card
const EDGE_ANGLE = 30; // degrees between triangles from which on their edge is drawn

export function geometryOf(shape, plain) {
  if (shape.vertices) return meshOf(plain ? coarse(shape, MOST_IN_SOFTWARE) : shape);
  const [a, b, c] = shape.size;
  switch (shape.kind) {
    case "box":
      return new BoxGeometry(a, b, c);
    case "sphere":
      return new SphereGeometry(a, 24, 16);
    case "cylinder":
      return new CylinderGeometry(a, a, b, plain ? 20 : 32).rotateX(Math.PI / 2);
    default:
      return new CapsuleGeometry(a, b, plain ? 5 : 8, plain ? 16 : 24).rotateX(Math.PI / 2);
  }
}

export function meshOf({ vertices, faces }) {
  const geometry = new BufferGeometry();
  const count = vertices[0].length;
  const points = new Float32Array(3 * count);
  for (let k = 0; k < count; k += 1) for (let i = 0; i < 3; i += 1) points[3 * k + i] = vertices[i][k];
  const corners = new Uint32Array(3 * faces[0].length);
  for (let k = 0; k < faces[0].length; k += 1) {
    for (let i = 0; i < 3; i += 1) corners[3 * k + i] = faces[i][k];
  }
  geometry.setAttribute("position", new BufferAttribute(points, 3));
  geometry.setIndex(new BufferAttribute(corners, 1));
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

const LOOKS = {
  light: { link: 0xd9dcdf, joint: 0xbfc5ca, tool: 0x5c6770, obstacle: 0xb9a98a, part: 0x3f8f8a, floor: 0xe9ebec, edge: 0x6f6a5e },
  dark: { link: 0x9aa2a9, joint: 0x818a92, tool: 0x59636c, obstacle: 0x8a7c60, part: 0x4aa29c, floor: 0x23272b, edge: 0xa89c84 },
};
const SEEN_THROUGH = { obstacle: 0.42, floor: 0.5 };
const GHOST = { light: 0x2f6fb3, dark: 0x7db7f0 };

/** Seen through, and drawn before all else, so that what is solid hides it: where the two arms went
 * through each other, patches of the one would come and go on the other. */
function ghostMaterial(theme) {
  return new MeshLambertMaterial({
    color: GHOST[theme],
    opacity: 0.3,
    blending: CustomBlending, // with transparent it would be drawn last
    blendSrc: SrcAlphaFactor,
    blendDst: OneMinusSrcAlphaFactor,
    blendSrcAlpha: OneFactor, // the picture stays opaque
    depthTest: false,
    depthWrite: false,
  });
}

function material(role, ghost, theme, number) {
  const looks = LOOKS[theme];
  if (ghost) return ghostMaterial(theme);
  const colour = role === "link" && number % 2 ? looks.joint : looks[role];
  const opacity = SEEN_THROUGH[role] ?? 1;
  return new MeshLambertMaterial({
    color: colour,
    transparent: opacity < 1,
    opacity,
    depthWrite: opacity === 1,
    flatShading: false,
  });
}

/** A body as an object with its place in the frame of its node; plain: drawn in software. */
export function bodyObject(body, { ghost, theme, number, plain }) {
  const geometry = geometryOf(body.shape, plain);
  const group = new Group();
  const mesh = new Mesh(geometry, material(body.role, ghost, theme, number));
  mesh.userData.body = body;
  mesh.userData.solid = true;
  if (ghost) mesh.renderOrder = -1;
  else if (SEEN_THROUGH[body.role]) mesh.renderOrder = 2;
  group.add(mesh);
  if (!ghost && body.role === "obstacle") {
    const colour = LOOKS[theme].edge;
    const lines = new LineSegments(
      new EdgesGeometry(plain ? geometryOf(body.shape) : geometry, EDGE_ANGLE),
      new LineBasicMaterial({ color: colour, transparent: true, opacity: 0.8 }),
    );
    group.add(lines);
  }
  group.matrixAutoUpdate = false;
  group.matrix = new Matrix4().fromArray(columnMajor(body.place));
  return group;
}
