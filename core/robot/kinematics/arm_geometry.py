"""Six-axis arms that have closed-form inverse kinematics, recognised by their axes.

Both families turn about axis 1, then in the plane that axes 2 and 3 are normal to. Everything is
written in the arm's own frame: origin on axis 1, z along axis 1, y along axis 2 at zero, x = y × z.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from .chain import Chain

EXACT = 1e-9
"""rad and m by which axes may miss their ideal place for the closed form to be exact."""
NEAR = 2e-2
"""rad and m up to which the closed form is a good start for Newton's method (calibrated arms)."""


class Family(StrEnum):
    """Which closed form applies."""

    SPHERICAL_WRIST = "spherical wrist"
    """Axes 4, 5 and 6 meet in a point (ABB, KUKA and most others)."""
    PARALLEL_AXES = "parallel axes"
    """Axes 2, 3 and 4 are parallel (Universal Robots)."""
    SCARA = "SCARA"
    """Axes 1, 2 and 4 and a slide are parallel; see `scara`."""


class ArmGeometry(NamedTuple):
    """Numbers of both families, in the arm's frame at zero.

    Args:
        frame: (3, 3), rows are the arm's axes x, y, z in the base's frame.
        origin: (3,) m, a point of axis 1 in the base's frame.
        zero: (3, 3), the base's arm frame seen from the flange at zero: R₀ᵀ frameᵀ.
        centre: (3,) m, the wrist's centre in the flange's frame.
        lateral: m, y of the wrist's centre.
        shoulder, elbow, wrist: (2,) m, x and z of axis 2, axis 3, and the wrist's centre
            (spherical wrist) or axis 4 (parallel axes).
        signs: (6,), 1 or -1 where a joint turns against the arm's axis (joints 3 and 4).
        axes: (3, 3), directions of axes 4, 5, 6.
        centre_to_fourth: (3,) m, from the wrist's centre to axis 4 (parallel axes).
    """

    frame: FloatArray
    origin: FloatArray
    zero: FloatArray
    centre: FloatArray
    lateral: float
    shoulder: FloatArray
    elbow: FloatArray
    wrist: FloatArray
    signs: FloatArray
    axes: FloatArray
    centre_to_fourth: FloatArray


class Recognised(NamedTuple):
    """An arm's family and its numbers.

    Args:
        family: which closed form.
        geometry: its numbers.
        error: rad and m, how far the axes miss the ideal.
        coupling: (6, 6), whole numbers: the angles that the closed form speaks of are
            ``coupling @ q``. They differ from q where joints have followers.
        uncoupling: (6, 6), its inverse.
    """

    family: Family
    geometry: ArmGeometry
    error: float
    coupling: FloatArray
    uncoupling: FloatArray

    def angles(self, q: FloatArray) -> FloatArray:
        """Angles (..., 6) of the axes of joints with the values q (..., 6)."""
        turned: FloatArray = q @ self.coupling.T
        return turned

    def values(self, angles: FloatArray) -> FloatArray:
        """Reverse of `angles`."""
        back: FloatArray = angles @ self.uncoupling.T
        return back


class _Lines(NamedTuple):
    """Axes at zero in the base's frame: directions and points (6, 3); flange R (3, 3), p (3,)."""

    directions: FloatArray
    points: FloatArray
    R: FloatArray
    p: FloatArray


def recognise(chain: Chain) -> Recognised | None:
    """The closed form that fits an arm's chain (base to flange) within `NEAR`, None if none."""
    if chain.prismatic.any():
        return _scara(chain)
    chain, coupling = _uncoupled(chain)
    if coupling.shape != (6, 6) or abs(round(float(np.linalg.det(coupling)))) != 1:
        return None
    lines = _lines(chain)
    for family in (Family.SPHERICAL_WRIST, Family.PARALLEL_AXES):
        geometry, error = _geometry(lines, family)
        if error < NEAR:
            return Recognised(family, geometry, error, coupling, np.rint(np.linalg.inv(coupling)))
    return None


def _scara(chain: Chain) -> Recognised | None:
    slides = [False, False, True, False, False, False]
    if chain.joint.tolist() != list(range(6)) or chain.prismatic.tolist() != slides:
        return None
    lines = _lines(chain)
    z = lines.directions
    up = z[0]
    ahead = lines.points[1] - lines.points[0]
    ahead = ahead - up * (up @ ahead)
    length = float(np.linalg.norm(ahead))
    if length < 1e-3:
        return None
    x = ahead / length
    frame = np.array([x, np.cross(up, x), up])
    points, axes = (lines.points - lines.points[0]) @ frame.T, z @ frame.T
    centre, apart = _meeting_point(points[3:], axes[3:])
    misses = [float(np.linalg.norm(np.cross(up, z[k]))) for k in (1, 2, 3)]
    misses += [abs(float(z[3] @ z[4])), abs(float(z[4] @ z[5])), apart]
    misses += [1.0] if np.linalg.norm(centre[:2] - points[1, :2]) < 1e-3 else []
    signs = np.array([1.0, *(np.sign(up @ z[k]) or 1.0 for k in (1, 2)), 1.0, 1.0, 1.0])
    geometry = ArmGeometry(
        frame=frame,
        origin=lines.points[0].copy(),
        zero=lines.R.T @ frame.T,
        centre=lines.R.T @ (lines.points[0] + frame.T @ centre - lines.p),
        lateral=float(centre[2]),
        shoulder=np.zeros(2),
        elbow=np.ascontiguousarray(points[1, :2]),
        wrist=np.ascontiguousarray(centre[:2]),
        signs=signs,
        axes=np.ascontiguousarray(axes[3:]),
        centre_to_fourth=np.zeros(3),
    )
    error = max(misses)
    coupling = np.eye(6)
    return Recognised(Family.SCARA, geometry, error, coupling, coupling) if error < NEAR else None


def _uncoupled(chain: Chain) -> tuple[Chain, FloatArray]:
    """The chain (of turning joints) with a value for each axis, and those axes' angles (K, N) by
    the values of all: turns about one axis right behind each other are one."""
    kept: list[int] = []
    size = int(chain.joint.max()) + 1
    rows: list[FloatArray] = []
    for k, value in enumerate(np.eye(size)[chain.joint] * chain.sign[:, None]):
        along = float(chain.axis[k] @ chain.axis[k - 1]) if kept else 0.0
        still = np.abs(chain.rotation[k] - np.eye(3)).max() < EXACT
        still = bool(still and np.abs(chain.translation[k]).max() < EXACT)
        if still and abs(along) > 1.0 - EXACT and chain.joint[k] in chain.joint[:k]:
            first = kept[-1]
            same = np.sign(chain.axis[k] @ chain.axis[first]) * chain.sign[first]
            rows[-1] = rows[-1] + same * value
        else:
            kept.append(k)
            rows.append(value * chain.sign[k])
    serial = chain._replace(
        rotation=chain.rotation[kept],
        translation=chain.translation[kept],
        axis=chain.axis[kept],
        prismatic=chain.prismatic[kept],
        joint=np.arange(len(kept)),
        sign=chain.sign[kept],
    )
    return serial, np.array(rows)


def _lines(chain: Chain) -> _Lines:
    R, p = np.eye(3), np.zeros(3)
    directions, points = [], []
    for k in range(chain.joint.size):
        p = p + R @ chain.translation[k]
        R = R @ chain.rotation[k]
        directions.append(R @ chain.axis[k] * chain.sign[k])
        points.append(p)
    p = p + R @ chain.end_translation
    return _Lines(np.array(directions), np.array(points), R @ chain.end_rotation, p)


def _geometry(lines: _Lines, family: Family) -> tuple[ArmGeometry, float]:
    z = lines.directions
    up = z[0]
    side = z[1] - up * (up @ z[1])
    side = side / max(float(np.linalg.norm(side)), 1e-12)
    frame = np.array([np.cross(side, up), side, up])
    origin = lines.points[0]
    points = (lines.points - origin) @ frame.T
    axes = z @ frame.T
    parallel = [2] if family is Family.SPHERICAL_WRIST else [2, 3]
    misses = [abs(up @ z[1])]
    misses += [float(np.linalg.norm(np.cross(side, z[k]))) for k in parallel]
    misses += [abs(float(z[3] @ z[4])), abs(float(z[4] @ z[5]))]
    pair = [3, 4, 5] if family is Family.SPHERICAL_WRIST else [4, 5]
    centre, apart = _meeting_point(points[pair], axes[pair])
    misses.append(apart)
    signs = np.ones(6)
    for k in parallel:
        signs[k] = np.sign(side @ z[k]) or 1.0
    fourth = points[3]
    plane = [0, 2]
    geometry = ArmGeometry(
        frame=frame,
        origin=origin.copy(),
        zero=lines.R.T @ frame.T,
        centre=lines.R.T @ (origin + frame.T @ centre - lines.p),
        lateral=float(centre[1]),
        shoulder=points[1][plane],
        elbow=points[2][plane],
        wrist=(centre if family is Family.SPHERICAL_WRIST else fourth)[plane],
        signs=signs,
        axes=np.ascontiguousarray(axes[3:]),
        centre_to_fourth=fourth - centre,
    )
    arms = (geometry.elbow - geometry.shoulder, geometry.wrist - geometry.elbow)
    if min(float(np.linalg.norm(arm)) for arm in arms) < 1e-3:
        misses.append(1.0)  # an arm without length leaves a joint undetermined
    return geometry, max(misses)


def _meeting_point(points: FloatArray, directions: FloatArray) -> tuple[FloatArray, float]:
    """The point nearest to lines in space, and its largest distance from one of them."""
    projectors = [np.eye(3) - np.outer(d, d) for d in directions]
    normal = sum(projectors, np.zeros((3, 3)))
    right = sum((P @ at for P, at in zip(projectors, points, strict=True)), np.zeros(3))
    # Parallel lines leave the point free along them: the least-squares answer is one of them.
    centre = np.linalg.lstsq(normal, right, rcond=None)[0]
    misses = [
        float(np.linalg.norm(P @ (centre - at))) for P, at in zip(projectors, points, strict=True)
    ]
    return centre, max(misses)
