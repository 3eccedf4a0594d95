"""Inverse kinematics of an arm: all branches, by the closed form that fits or numerically."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..errors import FaultCause, MotionError
from .joint import CoupledRange, Joint, JointKind, beyond_coupled
from .kinematics.arm_geometry import EXACT, Family, Recognised
from .kinematics.chain import Chain
from .kinematics.closed_form import SLACK
from .kinematics.numerical import STARTS, solve_numerically
from .kinematics.scara import solve_scara
from .kinematics.spherical_wrist import solve_spherical_wrist
from .kinematics.tracking import track
from .kinematics.ur_geometry import solve_parallel_axes
from .seven_axes.arm_angle import ArmAngle
from .seven_axes.self_motion import self_motions, with_arm_angle

FULL_TURN = 2 * math.pi
LIMIT_SLACK = 1e-9
"""rad or m by which a solution may miss a limit; it is set onto the limit."""
UNSURE = 1e-6
"""m out of reach that rounding near two singularities may feign: Newton's method decides."""
SINGULAR = 1e-6
"""m (shoulder) or sine (elbow, wrist) below which a solution counts as singular."""
SAME = 1e-6
"""rad or m within which two solutions are one."""
_SEEDS = 2 * STARTS
"""Starts from which a curve of configurations at a pose is looked for: some are short."""
_APART = 6
"""° between arm angles of samples on a curve, above which there is a gap."""
SOLVERS = {
    Family.SPHERICAL_WRIST: solve_spherical_wrist,
    Family.PARALLEL_AXES: solve_parallel_axes,
    Family.SCARA: solve_scara,
}


class UnreachableError(MotionError):
    """A pose that the arm cannot take.

    Args:
        message: by how much it is missed, and what to do.
        distance: m by which the wrist is out of reach; 0 if only limits are in the way.
        tilted: whether a joint that has no motor would have to turn.
    """

    def __init__(self, message: str, distance: float = 0.0, tilted: bool = False) -> None:
        limited = distance == 0.0 and not tilted
        super().__init__(message, cause=FaultCause.LIMIT if limited else FaultCause.REACH)
        self.distance = distance


@dataclass(frozen=True, slots=True)
class Branch:
    """Which of the up to eight solutions of a six-axis arm.

    Args:
        shoulder: whether the wrist's centre lies behind axis 1, that is, on the side of -x when
            axis 2 points along y and axis 1 along z.
        elbow: whether the forearm (from axis 3 to the wrist's centre, or to axis 4 if that is
            parallel) turns against axis 2 from the upper arm's direction.
        wrist: whether axis 6 is turned against axis 5 from axis 4 (axis 2 if axes 2, 3 and 4
            are parallel), the shorter way.
    """

    shoulder: bool
    elbow: bool
    wrist: bool


_BRANCHES = tuple(Branch(*bits) for bits in product((False, True), repeat=3))
_REGULAR: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True, eq=False)
class InverseSolution:
    """A configuration of the arm.

    Args:
        q: (n,) rad or m, within the limits; of equivalent turns the one nearest to zero.
        branch: None if it was found numerically.
        singular: which of ``"shoulder"``, ``"elbow"``, ``"wrist"`` are singular. There other
            solutions lie infinitely near; q is one of them.
    """

    q: FloatArray
    branch: Branch | None
    singular: frozenset[str]


@dataclass(frozen=True, slots=True)
class UnboundedSolution:
    """A solution before limits are looked at; a ``doubtful`` one may equal another."""

    q: FloatArray
    branch: Branch | None
    singular: frozenset[str]
    doubtful: bool


class Ranges(NamedTuple):
    """Where the n joints of an arm may stand.

    Args:
        lower, upper: (n,) rad or m.
        revolute: (n,), which of them turn.
    """

    lower: FloatArray
    upper: FloatArray
    revolute: NDArray[np.bool_]

    @staticmethod
    def of(joints: Sequence[Joint]) -> Ranges:
        """Those of some joints."""
        return Ranges(
            np.array([joint.lower for joint in joints]),
            np.array([joint.upper for joint in joints]),
            np.array([joint.kind is JointKind.REVOLUTE for joint in joints]),
        )


class WantedAngle(NamedTuple):
    """The arm angle that configurations are to have.

    Args:
        measured: what it is measured by.
        value: rad.
    """

    measured: ArmAngle
    value: float


def solve(
    chain: Chain,
    joints: Sequence[Joint],
    ranges: Ranges,
    coupled: Sequence[CoupledRange],
    known: Recognised | None,
    R: FloatArray,
    p: FloatArray,
    angle: WantedAngle | None = None,
) -> tuple[InverseSolution, ...]:
    """All solutions within limits for a flange pose in the base's frame.

    Args:
        chain: from the base to the flange, over the n joints.
        joints: the arm's joints.
        ranges: theirs.
        coupled: ranges of sums of their values.
        known: the closed form that fits the chain; None to search numerically, where not every
            solution need be found, and of an arm with more than six joints only samples can be.
        R, p: (3, 3), (3,) m, the pose.
        angle: of an arm with seven axes; None if any will do.

    Raises:
        UnreachableError: there is none.
    """
    if angle is not None:
        return _with_arm_angle(chain, joints, ranges, coupled, angle, R, p)
    if known is None:
        candidates, least = _searched(chain, ranges, R, p)
    else:
        candidates, least = _closed_form(chain, known, R, p)
    if not candidates:
        raise UnreachableError(_out_of_reach(known, least), least)
    return _within_limits(joints, ranges, coupled, candidates)


def _with_arm_angle(
    chain: Chain,
    joints: Sequence[Joint],
    ranges: Ranges,
    coupled: Sequence[CoupledRange],
    angle: WantedAngle,
    R: FloatArray,
    p: FloatArray,
) -> tuple[InverseSolution, ...]:
    """All solutions with an arm angle; arguments and errors as of `solve`."""
    seeds, least = solve_numerically(chain, ranges.lower, ranges.upper, R, p, _SEEDS)
    if not seeds:
        raise UnreachableError(_out_of_reach(None, least), least)
    curves = self_motions(chain, angle.measured, seeds, R, p)
    found = with_arm_angle(chain, angle.measured, curves, R, p, angle.value)
    try:
        if not found:
            raise UnreachableError("the arm cannot take the pose", tilted=True)
        candidates = [UnboundedSolution(q, None, frozenset(), False) for q in found]
        return _within_limits(joints, ranges, coupled, candidates)
    except UnreachableError as error:
        degrees = math.degrees(math.remainder(angle.value, FULL_TURN))
        fits = [_settled(ranges, curve.q)[1] for curve in curves]
        some = np.concatenate([c.angle[one] for c, one in zip(curves, fits, strict=True)])
        raise UnreachableError(
            f"with an arm angle of {degrees:.4g}° {error.message}; {_angles_that_do(some)}",
            tilted=error.cause is not FaultCause.LIMIT,
        ) from None


def _angles_that_do(angles: FloatArray) -> str:
    """Which arm angles a pose can be taken with, of many (M,) rad on its curves."""
    if not len(angles):
        return "no arm angle will do within the joints' ranges: move the target"
    whole = np.unique(np.round(np.degrees(angles)).astype(int) % 360)
    gaps = np.flatnonzero(np.diff(whole, append=whole[0] + 360) > _APART)
    if not len(gaps):
        return "with another posture all arm angles will do"
    firsts = whole[(gaps + 1) % len(whole)]
    lasts = whole[np.roll(gaps, -1)]
    runs = sorted((_signed(int(a)), _signed(int(b))) for a, b in zip(firsts, lasts, strict=True))
    said = [f"{a}° {'over 180° ' if b < a else ''}to {b}°" for a, b in runs]
    return f"arm angles that will do there are {' and '.join(map(str, said))}"


def _signed(degrees: int) -> int:
    return (degrees + 180) % 360 - 180


def _within_limits(
    joints: Sequence[Joint],
    ranges: Ranges,
    coupled: Sequence[CoupledRange],
    candidates: list[UnboundedSolution],
) -> tuple[InverseSolution, ...]:
    """The candidates that fit into the ranges, brought into them; errors as of `solve`."""
    settled, inside = _settled(ranges, np.array([candidate.q for candidate in candidates]))
    solutions: list[InverseSolution] = []
    names = [joint.name for joint in joints]
    beyond = beyond_coupled(coupled, names, settled) > LIMIT_SLACK
    for k in np.flatnonzero(beyond.any(axis=1) & inside) if coupled else ():
        others = equivalent_turns(joints, settled[k])
        fitting = others[(beyond_coupled(coupled, names, others) <= LIMIT_SLACK).all(axis=1)]
        if len(fitting):  # a joint that is counted with another one may turn by more than once
            settled[k], beyond[k] = fitting[np.abs(fitting).sum(axis=1).argmin()], False
    broken = beyond & inside[:, None]
    if coupled:
        inside &= ~beyond.any(axis=1)
    for candidate, q, fits in zip(candidates, settled, inside, strict=True):
        if not fits or (candidate.doubtful and any(_same(candidate, q, s) for s in solutions)):
            continue
        solutions.append(InverseSolution(q, candidate.branch, candidate.singular))
    if not solutions:
        if broken.any():
            at, which = np.argwhere(broken)[0]
            said = coupled[which].excess(float(coupled[which].row(names) @ settled[at]))
            raise UnreachableError(said, tilted=coupled[which].fixed)
        raise _beyond_limits(joints, candidates)
    return tuple(solutions)


def _closed_form(
    chain: Chain, known: Recognised, R: FloatArray, p: FloatArray
) -> tuple[list[UnboundedSolution], float]:
    q, measures = np.empty((8, 6)), np.empty((8, 4))
    least = float(SOLVERS[known.family](known.geometry, R, p, q, measures))
    q = np.ascontiguousarray(known.values(q))
    candidates = []
    for branch, at, (*sizes, missing) in zip(_BRANCHES, q, measures.tolist(), strict=True):
        if missing > max(UNSURE, known.error):
            continue
        ideal = known.error <= EXACT and missing <= SLACK
        if not ideal and not track(chain, at, R, p, np.arange(6), at)[0]:
            continue
        singular = _REGULAR
        if min(map(abs, sizes)) < SINGULAR:
            names = zip(("shoulder", "elbow", "wrist"), sizes, strict=True)
            singular = frozenset([name for name, size in names if abs(size) < SINGULAR])
        doubtful = bool(singular) or not ideal
        candidates.append(UnboundedSolution(at, branch, singular, doubtful))
    return candidates, least


def _searched(
    chain: Chain, ranges: Ranges, R: FloatArray, p: FloatArray
) -> tuple[list[UnboundedSolution], float]:
    found, least = solve_numerically(chain, ranges.lower, ranges.upper, R, p)
    return [UnboundedSolution(q, None, frozenset(), True) for q in found], least


def _same(candidate: UnboundedSolution, q: FloatArray, other: InverseSolution) -> bool:
    """Whether a solution is there already, or lies in the same family of a singular wrist."""
    if "wrist" in candidate.singular and "wrist" in other.singular:
        return bool(np.abs(q[:3] - other.q[:3]).max() < SAME)
    apart = np.abs(q - other.q)
    return bool(np.minimum(apart, np.abs(FULL_TURN - apart)).max() < SAME)


def _turns(joint: Joint, value: float) -> list[float]:
    """Equivalent values of a joint within its limits."""
    if joint.kind is JointKind.PRISMATIC:
        steps = [value]
    else:
        first = math.ceil((joint.lower - LIMIT_SLACK - value) / FULL_TURN)
        last = math.floor((joint.upper + LIMIT_SLACK - value) / FULL_TURN)
        steps = [value + k * FULL_TURN for k in range(first, last + 1)]
    inside = [x for x in steps if joint.lower - LIMIT_SLACK <= x <= joint.upper + LIMIT_SLACK]
    return [min(max(x, joint.lower), joint.upper) for x in inside]


def _settled(ranges: Ranges, q: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Configurations (C, n) turned into the limits, nearest to zero, and which of them fit (C,)."""
    lower, upper, revolute = ranges
    first = np.ceil((lower - LIMIT_SLACK - q) / FULL_TURN)
    last = np.floor((upper + LIMIT_SLACK - q) / FULL_TURN)
    nearest = np.minimum(np.maximum(np.round(-q / FULL_TURN), first), last)
    turned = np.where(revolute, q + FULL_TURN * nearest, q)
    inside = (turned >= lower - LIMIT_SLACK) & (turned <= upper + LIMIT_SLACK)
    fits: NDArray[np.bool_] = np.all(inside, axis=1)
    return np.minimum(np.maximum(turned, lower), upper), fits


def equivalent_turns(joints: Sequence[Joint], q: FloatArray) -> FloatArray:
    """All configurations (T, n) within limits that differ from q by full turns, nearest first."""
    turns = [_turns(joint, float(x)) for joint, x in zip(joints, q, strict=True)]
    rows = np.array(list(product(*turns)), dtype=float).reshape(-1, len(joints))
    order = np.argsort(np.abs(rows - q).sum(axis=1), kind="stable")
    return np.asarray(rows[order])


def _out_of_reach(known: Recognised | None, least: float) -> str:
    if known is None:
        return (
            f"no configuration was found for the pose; the nearest misses it by {least:.3g} (m, "
            "rad): move the target into the arm's reach, or give it as joint values"
        )
    return (
        f"the pose is out of reach: the wrist misses it by {least:.4g} m; "
        "move the target, the base or the tool"
    )


def _beyond_limits(
    joints: Sequence[Joint], candidates: list[UnboundedSolution]
) -> UnreachableError:
    """What is wrong with the solution that breaks its worst limit by least."""
    worst = [_worst(joints, candidate.q) for candidate in candidates]
    nearest = min(range(len(worst)), key=lambda k: worst[k][0])
    excess, joint, value = worst[nearest]
    if joint.held:
        still = [k for k, one in enumerate(joints) if one.held]
        apart = np.abs(np.remainder(candidates[nearest].q[still] + math.pi, FULL_TURN) - math.pi)
        missed, names = math.degrees(math.hypot(*apart)), [joints[k].name for k in still]
        return UnreachableError(
            f"this arm cannot turn its flange so: the pose is {missed:.4g}° away from what it can "
            f"take, as there is no motor for {' and '.join(names)}; turn the target, its frame or "
            "the tool back",
            tilted=True,
        )
    if joint.kind is JointKind.REVOLUTE:
        unit, scale = "°", 180 / math.pi
    else:
        unit, scale = " m", 1.0
    return UnreachableError(
        f"every solution breaks a joint limit; the nearest needs {joint.name} at "
        f"{value * scale:.4g}{unit}, {excess * scale:.4g}{unit} beyond its range of "
        f"{joint.lower * scale:.4g}{unit} to {joint.upper * scale:.4g}{unit}"
    )


def _worst(joints: Sequence[Joint], q: FloatArray) -> tuple[float, Joint, float]:
    """How far the worst joint is beyond its limits at the nearest turn, which, and its value."""
    found = []
    for joint, value in zip(joints, map(float, q), strict=True):
        shifts = (-2, -1, 0, 1, 2) if joint.kind is JointKind.REVOLUTE else (0,)
        turned = [value + k * FULL_TURN for k in shifts]
        excess = [max(joint.lower - x, x - joint.upper, 0.0) for x in turned]
        nearest = int(np.argmin(excess))
        found.append((excess[nearest], joint, turned[nearest]))
    return max(found, key=lambda entry: entry[0])
