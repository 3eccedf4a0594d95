"""Inverse kinematics of an arm: all branches, by the closed form that fits or numerically."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product

import numpy as np

from ...arrays import FloatArray
from ...errors import FaultCause
from ..joint import CoupledRange, Joint
from ..kinematics.arm_geometry import EXACT, Family, Recognised
from ..kinematics.chain import Chain
from ..kinematics.closed_form import SLACK
from ..kinematics.numerical import STARTS, solve_numerically
from ..kinematics.scara import solve_scara
from ..kinematics.spherical_wrist import solve_spherical_wrist
from ..kinematics.tracking import track
from ..kinematics.ur_geometry import solve_parallel_axes
from ..seven_axes.arm_angle import ArmAngle
from ..seven_axes.self_motion import self_motions, with_arm_angle
from .ranges import FULL_TURN, Ranges
from .solution import Branch, Candidate, InverseSolution, UnreachableError

UNSURE = 1e-6
"""m out of reach that rounding near two singularities may feign: Newton's method decides."""
SINGULAR = 1e-6
"""m (shoulder) or sine (elbow, wrist) below which a solution counts as singular."""
_SEEDS = 2 * STARTS
"""Starts from which a curve of configurations at a pose is looked for: some are short."""
_APART = 6
"""° between arm angles of samples on a curve, above which there is a gap."""
_KEPT = 2000
"""Poses of which the solutions with an arm angle, or why there are none, are kept: they take
long."""
SOLVERS = {
    Family.SPHERICAL_WRIST: solve_spherical_wrist,
    Family.PARALLEL_AXES: solve_parallel_axes,
    Family.SCARA: solve_scara,
}
_BRANCHES = tuple(Branch(*bits) for bits in product((False, True), repeat=3))
_REGULAR: frozenset[str] = frozenset()


class ArmInverse:
    """Finds the configurations of an arm.

    Args:
        chain: from the base to the flange, over the n joints.
        joints: the arm's.
        coupled: ranges of sums of their values.
        known: the closed form that fits the chain; None to search numerically, where not every
            solution need be found, and of an arm with more than six joints only samples can be.
        angle: what the arm angle is measured by; None of an arm that counts none.
    """

    def __init__(
        self,
        chain: Chain,
        joints: Sequence[Joint],
        coupled: Sequence[CoupledRange],
        known: Recognised | None,
        angle: ArmAngle | None = None,
    ) -> None:
        self._chain, self._known, self._angle = chain, known, angle
        self.ranges = Ranges(joints, coupled)
        self._found: dict[
            tuple[bytes, bytes, float], tuple[InverseSolution, ...] | UnreachableError
        ] = {}

    def at(
        self, R: FloatArray, p: FloatArray, arm_angle: float | None = None
    ) -> tuple[InverseSolution, ...]:
        """All solutions within limits for a flange pose in the base's frame.

        Args:
            R, p: (3, 3), (3,) m, the pose.
            arm_angle: rad, of an arm that counts one; None if any will do.

        Raises:
            UnreachableError: there is none.
        """
        if arm_angle is None or self._angle is None:
            return self._any_angle(R, p)
        key = (R.tobytes(), p.tobytes(), arm_angle)
        if key not in self._found:
            if len(self._found) >= _KEPT:
                self._found.clear()
            try:
                self._found[key] = self._with_arm_angle(self._angle, arm_angle, R, p)
            except UnreachableError as error:
                self._found[key] = error
        found = self._found[key]
        if isinstance(found, UnreachableError):
            raise found.with_traceback(None)
        return found

    def at_each(self, R: FloatArray, p: FloatArray) -> list[FloatArray | None]:
        """The same configurations (K, n), in the same order, at each of M poses at once.

        Args:
            R, p: (M, 3, 3), (M, 3) m, the poses.

        Returns:
            None where `at` has to look closer: where there is no closed form, or not for the arm as
            it was calibrated; at singularities, out of reach, and beyond ranges.
        """
        known = self._known
        if known is None or known.error > EXACT:
            return [None] * len(p)
        q, measures = _solutions(known, R, p)
        missing = measures[..., 3]
        unclear = (missing > SLACK) | (np.abs(measures[..., :3]).min(axis=2) < SINGULAR)
        unclear &= missing <= UNSURE
        turned, inside = self.ranges.settled(q.reshape(-1, q.shape[2]))
        beyond = self.ranges.beyond_coupled(turned).reshape(missing.shape)
        fits = inside.reshape(missing.shape) & (missing <= SLACK)
        sure = fits.any(axis=1) & ~(unclear | (beyond & fits)).any(axis=1)
        rows = zip(turned.reshape(q.shape), fits, sure, strict=True)
        return [found[own] if clear else None for found, own, clear in rows]

    def _any_angle(self, R: FloatArray, p: FloatArray) -> tuple[InverseSolution, ...]:
        if self._known is None:
            found, least = self._searched(R, p)
            candidates = [Candidate(q, None, _REGULAR, True) for q in found]
        else:
            candidates, least = _closed_form(self._chain, self._known, R, p)
        if not candidates:
            raise UnreachableError(_out_of_reach(self._known, least), least)
        return self.ranges.within(candidates)

    def _searched(
        self, R: FloatArray, p: FloatArray, starts: int = STARTS
    ) -> tuple[list[FloatArray], float]:
        ranges = self.ranges
        return solve_numerically(self._chain, ranges.lower, ranges.upper, R, p, starts)

    def _with_arm_angle(
        self, angle: ArmAngle, wanted: float, R: FloatArray, p: FloatArray
    ) -> tuple[InverseSolution, ...]:
        seeds, least = self._searched(R, p, _SEEDS)
        if not seeds:
            raise UnreachableError(_out_of_reach(None, least), least)
        curves = self_motions(self._chain, angle, seeds, R, p)
        found = with_arm_angle(self._chain, angle, curves, R, p, wanted)
        try:
            if not found:
                raise UnreachableError("the arm cannot take the pose", tilted=True)
            return self.ranges.within([Candidate(q, None, _REGULAR, False) for q in found])
        except UnreachableError as error:
            degrees = math.degrees(math.remainder(wanted, FULL_TURN))
            fits = [self.ranges.settled(curve.q)[1] for curve in curves]
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


def _closed_form(
    chain: Chain, known: Recognised, R: FloatArray, p: FloatArray
) -> tuple[list[Candidate], float]:
    (q,), (measures,) = _solutions(known, R[None], p[None])
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
        candidates.append(Candidate(at, branch, singular, doubtful))
    return candidates, float(measures[:, 3].min())


def _solutions(known: Recognised, R: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values (M, 8, 6) and measures (M, 8, 4) of the closed form at M poses; see `SOLVERS`."""
    q, measures = np.empty((len(p), 8, 6)), np.empty((len(p), 8, 4))
    SOLVERS[known.family](known.geometry, R, p, q, measures)
    return np.ascontiguousarray(known.values(q)), measures


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
