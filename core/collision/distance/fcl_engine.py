"""Contacts by python-fcl, the Flexible Collision Library."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import fcl
import numpy as np

from ...robot.shape import Box, Capsule, Cylinder, Sphere
from .containment import Nesting
from .engine import BodyPoses
from .solid import Polytope, Solid


class FclEngine:
    """Whether bodies touch; see `flyby.core.collision.distance.engine.ContactEngine`.

    Args:
        solids: of all bodies.
        nesting: tells which of them lie inside which.
    """

    def __init__(self, solids: Sequence[Solid], nesting: Nesting) -> None:
        self._solids = solids
        self._objects: dict[int, Any] = {}
        self._nesting = nesting
        self._request = fcl.CollisionRequest()

    def touch(self, a: int, b: int, places: BodyPoses) -> bool:
        """Whether bodies a and b touch, overlap, or lie one inside the other."""
        placed = self._placed(a, places), self._placed(b, places)
        if fcl.collide(*placed, self._request, fcl.CollisionResult()) > 0:
            return True
        return self._nesting.nested(a, b, places)

    def _placed(self, body: int, places: BodyPoses) -> Any:
        """A body at its place, made when it is first needed."""
        if body not in self._objects:
            self._objects[body] = fcl.CollisionObject(_shape(self._solids[body]))
        placed = self._objects[body]
        placed.setTransform(fcl.Transform(places.rotation[body], places.translation[body]))
        return placed


def _shape(solid: Solid) -> Any:
    match solid:
        case Sphere(radius):
            return fcl.Sphere(radius)
        case Capsule(radius, length):
            return fcl.Capsule(radius, length)
        case Cylinder(radius, length):
            return fcl.Cylinder(radius, length)
        case Box(size):
            return fcl.Box(*size)
        case Polytope(vertices, faces):
            corners = np.column_stack([np.full(len(faces), 3), faces])
            return fcl.Convex(vertices, len(faces), corners.ravel())
    model = fcl.BVHModel()
    model.beginModel(len(solid.vertices), len(solid.faces))
    model.addSubModel(solid.vertices, solid.faces)
    model.endModel()
    return model
