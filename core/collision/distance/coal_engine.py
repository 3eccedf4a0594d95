"""Signed distances and witness points by coal, the collision library that comes with Pinocchio.

Convex solids are exact, also in depth. Against a triangle mesh, spheres and capsules are asked
for by their cores, a point or a segment: the distance to the core less the radius is exact until
the core itself crosses the surface, so a depth up to the radius is known, and a depth inside a
closed mesh too.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import coal
import numpy as np

from ...arrays import FloatArray
from ...robot.shape import Box, Capsule, Cylinder, Sphere
from .containment import Nesting
from .engine import BodyPoses, Witness
from .solid import Polytope, Solid, TriangleMesh, core_radius, extent

HAIR = 1e-9
"""m, radius of the core that stands for a point or a segment."""
NUDGES = 1e-7 * np.array([[0.61, 0.35, 0.71], [-0.82, 0.29, 0.5], [0.14, -0.93, 0.34]])
"""m, steps by which bodies that lie exactly centre on centre or the like are moved apart."""
GJK_TOLERANCE = 1e-9
"""Relative; coal's own 1e-6 leaves normals of curved solids 1e-3 off. Its tolerance of depths,
1e-6 m, stays as it is: with less the depths of cylinders fail now and then."""
LEAST_RANGE = 1e-3
"""m, the least range that coal is asked with."""
FIT = 1e-6
"""m by which a distance may miss its own witness points."""
UP = np.array([0.0, 0.0, 1.0])


class CoalEngine:
    """Distances between bodies; see `flyby.core.collision.distance.engine.DistanceEngine`.

    Args:
        solids: of all bodies.
        nesting: tells which of them lie inside which.
    """

    def __init__(self, solids: Sequence[Solid], nesting: Nesting) -> None:
        self._solids = solids
        self._shapes: dict[tuple[int, bool], Any] = {}
        self._middles = [extent(solid).centre for solid in solids]
        self._growth = [_growth(solid) for solid in self._solids]
        self._nesting = nesting
        self._places: BodyPoses | None = None
        self._transforms: dict[int, Any] = {}
        self._calls: dict[tuple[int, int, bool], Any] = {}
        self._request = coal.DistanceRequest()
        self._request.gjk_tolerance = GJK_TOLERANCE
        self._result = coal.DistanceResult()

    def distance(self, a: int, b: int, places: BodyPoses, within: float) -> Witness | None:
        """Signed distance of bodies a and b, None if it is ``within`` m or more."""
        if isinstance(self._solids[a], TriangleMesh) or isinstance(self._solids[b], TriangleMesh):
            return self._to_mesh(a, b, places, within)
        return self._measure(a, b, places, within, False)

    def _to_mesh(self, a: int, b: int, places: BodyPoses, within: float) -> Witness | None:
        """Distance by cores, of which one at least is a mesh."""
        growth = self._growth[a], self._growth[b]
        found = self._measure(a, b, places, within + sum(growth), True)
        if found is not None and found.distance <= HAIR:
            return self._crossing(a, b, places, 0.5 * (found.point_a + found.point_b))
        nested = self._nesting.nested(a, b, places)
        if nested:
            found = self._measure(a, b, places, math.inf, True)
        if found is None:
            return None
        if growth == (0.0, 0.0):
            # Of two meshes coal gives no normal.
            found = found._replace(normal=(found.point_a - found.point_b) / found.distance)
        return _grown(_turned(found) if nested else found, *growth)

    def _crossing(self, a: int, b: int, places: BodyPoses, at: FloatArray | None = None) -> Witness:
        """A core through a surface: no depth is known but that it is the radius at least.

        The way out leads from the crossing (or the middle of body b) to the middle of body a, or
        the other way if that is inside b.
        """
        middle, other = (
            places.translation[k] + places.rotation[k] @ self._middles[k] for k in (a, b)
        )
        at = other if at is None else at
        way = middle - at
        length = float(np.linalg.norm(way))
        normal = way / length if length > HAIR else UP
        if self._nesting.inside(b, middle[None], places):
            normal = -normal
        least = max(self._growth[a] + self._growth[b], HAIR)
        return Witness(-least, at - least * normal, at, normal, measured=False)

    def _measure(
        self, a: int, b: int, places: BodyPoses, within: float, cores: bool
    ) -> Witness | None:
        call = self._call(a, b, cores)
        at_a, at_b = self._placed(a, places), self._placed(b, places)
        found = self._ask(call, at_a, at_b, within)
        for nudge in NUDGES:
            if found is None or found.distance > FIT or _is_sound(found):
                return found
            beside = coal.Transform3s(places.rotation[a], places.translation[a] + nudge)
            found = self._ask(call, beside, at_b, within)
        return self._crossing(a, b, places)

    def _placed(self, body: int, places: BodyPoses) -> Any:
        """A body's place, kept while one configuration is asked for."""
        if places is not self._places:
            self._places, self._transforms = places, {}
        if body not in self._transforms:
            R, p = places.rotation[body], places.translation[body]
            self._transforms[body] = coal.Transform3s(R, p)
        return self._transforms[body]

    def _ask(self, call: Any, at_a: Any, at_b: Any, within: float) -> Witness | None:
        result = self._result
        result.clear()
        if within < math.inf:
            # coal passes over everything that is farther than what it has found so far. Where
            # that is an overlap already, it stops at once.
            result.min_distance = max(within, LEAST_RANGE)
        distance = call(at_a, at_b, self._request, result)
        if distance >= within:
            return None
        return Witness(
            distance, result.getNearestPoint1(), result.getNearestPoint2(), -result.normal
        )

    def _call(self, a: int, b: int, cores: bool) -> Any:
        key = (a, b, cores)
        if key not in self._calls:
            self._calls[key] = coal.ComputeDistance(self._shape(a, cores), self._shape(b, cores))
        return self._calls[key]

    def _shape(self, body: int, core: bool) -> Any:
        """A body's shape or its core, made when it is first needed."""
        core = core and self._growth[body] > 0.0
        if (body, core) not in self._shapes:
            make = _core if core else _shape
            self._shapes[body, core] = make(self._solids[body])
        return self._shapes[body, core]


def _is_sound(found: Witness) -> bool:
    """Whether points, normal and distance fit; they do not where coal meets a degenerate case."""
    miss = found.point_a - found.point_b - found.distance * found.normal
    return bool(np.abs(miss).max() < FIT and abs(found.normal @ found.normal - 1.0) < FIT)


def _grown(core: Witness, radius_a: float, radius_b: float) -> Witness:
    """The distance of bodies from that of their cores."""
    return core._replace(
        distance=core.distance - radius_a - radius_b,
        point_a=core.point_a - radius_a * core.normal,
        point_b=core.point_b + radius_b * core.normal,
    )


def _turned(core: Witness) -> Witness:
    """The same for a core inside a mesh: out is the other way, and the distance a depth."""
    return core._replace(distance=-core.distance, normal=-core.normal)


def _growth(solid: Solid) -> float:
    """m by which a body is larger than its core."""
    return max(core_radius(solid) - HAIR, 0.0)


def _core(solid: Solid) -> Any:
    match solid:
        case Sphere():
            return coal.Sphere(HAIR)
        case Capsule(_, length):
            return coal.Capsule(HAIR, length)
    raise TypeError(f"{type(solid).__name__} has no core")


def _shape(solid: Solid) -> Any:
    match solid:
        case Sphere(radius):
            # coal.Sphere has forms of its own, of which that with a cylinder finds no way out
            # along the cylinder's axis.
            return coal.Capsule(radius, HAIR)
        case Capsule(radius, length):
            return coal.Capsule(radius, length)
        case Cylinder(radius, length):
            return coal.Cylinder(radius, length)
        case Box(size):
            return coal.Box(*size)
        case Polytope():
            return _polytope(solid)
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(solid.faces), len(solid.vertices))
    model.addVertices(np.ascontiguousarray(solid.vertices))
    model.addTriangles(np.ascontiguousarray(solid.faces))
    model.endModel()
    return model


def _polytope(solid: Polytope) -> Any:
    points, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for vertex in solid.vertices:
        points.append(vertex)
    for face in solid.faces.tolist():
        faces.append(coal.Triangle(*face))
    return coal.Convex(points, faces)
