"""Compiled linear program in two unknowns: the greatest y + z over a polygon that holds the origin.

The polygon is an array of half-planes (M, 3) with rows (p, q, h): p y + q z ≤ h, h ≥ 0. A vertex
is a pair of rows. The walk starts outside, at a vertex at which two half-planes bound the sum, and
takes in the half-plane that is violated most until none is (the dual simplex method): from a good
guess that is one step or none. All comparisons are homogeneous, so units do not matter. Indices
may be negative, as everywhere in numpy.
"""

from __future__ import annotations

from ...arrays import FloatArray
from ...robot.kinematics.lean import inner, lean

ROUNDING = 1e-14
"""Rounding of p y + q z, relative to the size of its terms."""
# Vertices that a walk may pass for each half-plane; one to three in all are the common case.
WALK_PER_PLANE = 2


@inner
def vertex(planes: FloatArray, i: int, j: int) -> tuple[float, float]:
    """(y, z) where the edges of two half-planes meet."""
    # Of the two orders of elimination, the one whose factor times the row keeps rounding down.
    if abs(planes[i, 0] * planes[j, 1]) < abs(planes[j, 0] * planes[i, 1]):
        i, j = j, i
    factor = planes[j, 0] / planes[i, 0]
    z = (planes[j, 2] - factor * planes[i, 2]) / (planes[j, 1] - factor * planes[i, 1])
    return (planes[i, 2] - planes[i, 1] * z) / planes[i, 0], z


@inner
def most_violated(planes: FloatArray, y: float, z: float) -> int:
    """Index of the half-plane that (y, z) is farthest outside of; M if it is in all of them."""
    worst = len(planes)
    distance = 0.0
    for i in range(len(planes)):
        p, q = planes[i, 0] * y, planes[i, 1] * z
        excess = p + q - planes[i, 2]
        if excess > ROUNDING * (abs(p) + abs(q)):
            norm = abs(planes[i, 0]) + abs(planes[i, 1])
            if excess > distance * norm:
                distance = excess / norm
                worst = i
    return worst


@inner
def exchange(planes: FloatArray, entering: int, i: int, j: int) -> tuple[int, int]:
    """The pair that bounds y + z once ``entering`` holds too.

    Of (i, j) that one stays with which the multipliers of (1, 1) = λ_i n_i + λ_j n_j do not
    become negative. The pair comes back unchanged if rounding leaves no such choice.
    """
    pi, qi = planes[i, 0], planes[i, 1]
    pj, qj = planes[j, 0], planes[j, 1]
    p, q = planes[entering, 0], planes[entering, 1]
    determinant = pi * qj - pj * qi
    share_i = (p * qj - pj * q) / determinant
    share_j = (pi * q - p * qi) / determinant
    multiplier_i = (qj - pj) / determinant
    multiplier_j = (pi - qi) / determinant
    if share_i <= 0.0 and share_j <= 0.0:
        return i, j
    if share_j <= 0.0 or (share_i > 0.0 and multiplier_i * share_j < multiplier_j * share_i):
        return entering, j
    return i, entering


@inner
def shrink(planes: FloatArray, y: float, z: float) -> float:
    """The greatest factor in [0, 1] with which (y, z) is in the polygon: the origin is."""
    factor = 1.0
    for i in range(len(planes)):
        value = planes[i, 0] * y + planes[i, 1] * z
        if value * factor > planes[i, 2]:
            factor = planes[i, 2] / value
    return factor


@lean
def greatest_sum(planes: FloatArray, i: int, j: int) -> tuple[float, float, int, int]:
    """(y, z, i, j) where y + z is greatest, from a pair (i, j) that bounds the sum."""
    y = z = 0.0
    for _ in range(WALK_PER_PLANE * len(planes)):
        y, z = vertex(planes, i, j)
        entering = most_violated(planes, y, z)
        if entering == len(planes):
            return y, z, i, j
        next_i, next_j = exchange(planes, entering, i, j)
        if next_i == i and next_j == j:
            break
        i, j = next_i, next_j
    # Rounding among nearly parallel edges: any point on the way to the origin is in the polygon.
    factor = shrink(planes, max(y, 0.0), max(z, 0.0))
    return factor * max(y, 0.0), factor * max(z, 0.0), i, j
