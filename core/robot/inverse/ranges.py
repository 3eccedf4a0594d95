"""Solutions brought into the ranges of an arm's joints, and what is wrong where none fits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ..joint import CoupledRange, Joint, JointKind, beyond_coupled
from .solution import Candidate, InverseSolution, UnreachableError

FULL_TURN = 2 * math.pi
LIMIT_SLACK = 1e-9
"""rad or m by which a solution may miss a limit; it is set onto the limit."""
SAME = 1e-6
"""rad or m within which two solutions are one."""


class Ranges:
    """Where the n joints of an arm may stand.

    Args:
        joints: the arm's.
        coupled: ranges of sums of their values.

    Attributes:
        lower, upper: (n,) rad or m.
    """

    def __init__(self, joints: Sequence[Joint], coupled: Sequence[CoupledRange]) -> None:
        self._joints, self._coupled = joints, coupled
        self._names = [joint.name for joint in joints]
        self._revolute = np.array([joint.kind is JointKind.REVOLUTE for joint in joints])
        self.lower: FloatArray = np.array([joint.lower for joint in joints])
        self.upper: FloatArray = np.array([joint.upper for joint in joints])

    def within(self, candidates: Sequence[Candidate]) -> tuple[InverseSolution, ...]:
        """The candidates that fit into the ranges, brought into them.

        Raises:
            UnreachableError: none does.
        """
        turned, inside = self.settled(np.array([candidate.q for candidate in candidates]))
        solutions: list[InverseSolution] = []
        beyond = self._beyond(turned)
        for k in np.flatnonzero(beyond.any(axis=1) & inside) if self._coupled else ():
            # A joint that is counted with another one may turn by more than once.
            fitting = self.turns(turned[k])
            if len(fitting):
                turned[k], beyond[k] = fitting[np.abs(fitting).sum(axis=1).argmin()], False
        broken = beyond & inside[:, None]
        if self._coupled:
            inside &= ~beyond.any(axis=1)
        for candidate, q, fits in zip(candidates, turned, inside, strict=True):
            if not fits or (candidate.doubtful and any(_same(candidate, q, s) for s in solutions)):
                continue
            solutions.append(InverseSolution(q, candidate.branch, candidate.singular))
        if not solutions:
            if broken.any():
                at, which = np.argwhere(broken)[0]
                coupled = self._coupled[which]
                said = coupled.excess(float(coupled.row(self._names) @ turned[at]))
                raise UnreachableError(said, tilted=coupled.fixed)
            raise _beyond_limits(self._joints, candidates)
        return tuple(solutions)

    def settled(self, q: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
        """Configurations (C, n) turned into the limits, nearest to zero, and which fit (C,)."""
        first = np.ceil((self.lower - LIMIT_SLACK - q) / FULL_TURN)
        last = np.floor((self.upper + LIMIT_SLACK - q) / FULL_TURN)
        nearest = np.minimum(np.maximum(np.round(-q / FULL_TURN), first), last)
        turned = np.where(self._revolute, q + FULL_TURN * nearest, q)
        inside = (turned >= self.lower - LIMIT_SLACK) & (turned <= self.upper + LIMIT_SLACK)
        fits: NDArray[np.bool_] = np.all(inside, axis=1)
        return np.minimum(np.maximum(turned, self.lower), self.upper), fits

    def beyond_coupled(self, q: FloatArray) -> NDArray[np.bool_]:
        """(C,), which configurations (C, n) are beyond a coupled range."""
        if not self._coupled:
            return np.zeros(len(q), dtype=np.bool_)
        return np.asarray(self._beyond(q).any(axis=1))

    def turns(self, q: FloatArray) -> FloatArray:
        """All configurations (T, n) within limits, full turns away from q (n,), nearest first."""
        turns = [_turns(joint, float(x)) for joint, x in zip(self._joints, q, strict=True)]
        rows = np.array(list(product(*turns)), dtype=float).reshape(-1, len(self._joints))
        every = rows[np.argsort(np.abs(rows - q).sum(axis=1), kind="stable")]
        return every[~self._beyond(every).any(axis=1)] if self._coupled else every

    def _beyond(self, q: FloatArray) -> NDArray[np.bool_]:
        """(..., C), which coupled ranges configurations (..., n) are beyond."""
        beyond: NDArray[np.bool_] = beyond_coupled(self._coupled, self._names, q) > LIMIT_SLACK
        return beyond


def _same(candidate: Candidate, q: FloatArray, other: InverseSolution) -> bool:
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


def _beyond_limits(joints: Sequence[Joint], candidates: Sequence[Candidate]) -> UnreachableError:
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
