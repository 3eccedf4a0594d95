// What stands between the camera and the arm is seen through, so that no fence hides the robot.

import { Box3, Matrix4, Ray, Vector3 } from "three";

const FAINT = 0.07; // of a body in the way
const FAINT_EDGES = 0.22;

export class Veils {
  constructor() {
    this.bodies = [];
  }

  /** Collect what stands around; objects: groups of a body with its mesh and edges. */
  collect(root) {
    this.bodies = [];
    root.updateMatrixWorld(true);
    root.traverse((mesh) => {
      if (!mesh.userData.solid || mesh.userData.body?.role !== "obstacle") return;
      mesh.geometry.computeBoundingBox();
      const parts = mesh.parent.children.map((child) => ({ material: child.material, usual: child.material.opacity, faint: child === mesh ? FAINT : FAINT_EDGES }));
      this.bodies.push({ mesh, box: mesh.geometry.boundingBox, inverse: new Matrix4(), parts, veils: false });
    });
  }

  /** Lift those that hide one of some points (in the world) from a camera; whether any changed. */
  lift(camera, points) {
    let changed = false;
    for (const body of this.bodies) {
      body.inverse.copy(body.mesh.matrixWorld).invert();
      const veils = points.some((point) => hides(body, camera.position, point));
      if (veils === body.veils) continue;
      body.veils = veils;
      changed = true;
      for (const { material, usual, faint } of body.parts) material.opacity = veils ? faint : usual;
    }
    return changed;
  }
}

const ray = new Ray();
const way = new Vector3();
const hit = new Vector3();
const grown = new Box3();

/** Whether a body's box lies between an eye and a point. */
function hides({ box, inverse }, eye, point) {
  ray.origin.copy(eye).applyMatrix4(inverse);
  way.copy(point).applyMatrix4(inverse).sub(ray.origin);
  const far = way.length();
  ray.direction.copy(way).normalize();
  grown.copy(box);
  if (grown.containsPoint(ray.origin)) return true;
  return Boolean(ray.intersectBox(grown, hit)) && hit.distanceTo(ray.origin) < far;
}
