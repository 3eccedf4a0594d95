"""Where a proof has failed, searches look closer and keep a wider margin; zones leave room."""

from __future__ import annotations

from collections.abc import Callable, Set
from dataclasses import dataclass, replace

import numpy as np

from ....core.arrays import FloatArray
from ....core.collision.proof.verdict import Certificate, Verdict
from ....core.errors import MotionError
from ....core.motion.emulator.run import Run
from ....core.motion.gradients.sensitivity import PathPlaces
from ....core.motion.path.path import Path
from ....core.program.program import Program
from ..rounding import STEP
from .block_emulation import crowd
from .variables import ProgramVariables

COARSE, FINE = 2, 4
"""Density of places of a search and of a refinement."""
_WIDER, _AMPLE = 1.3, 1.15
_STEPS = STEP * 2.0 ** np.arange(8)
"""m by which zones are made smaller in turn that rounding has left without room."""
_TIGHT = 1e-9


@dataclass(frozen=True)
class Aim:
    """How closely a search looks at distances, and how much it keeps.

    Args:
        margin: m beyond the clearance.
        density: of places.
        more: places.
    """

    margin: float
    density: int = COARSE
    more: PathPlaces | None = None

    def after(self, run: Run, certificate: Certificate, clearance: float) -> Aim:
        """With more room, and closer at the place where a proof of a clearance (m) has failed."""
        more = self.more
        if certificate.sigma is not None and certificate.configuration is not None:
            q = np.array(certificate.configuration)
            near = crowd(run.path, 0.5 * sum(certificate.sigma), q, FINE)
            more = near if more is None else more.with_more(near)
        return replace(self, margin=self._wider(certificate, clearance), more=more)

    def _wider(self, certificate: Certificate, clearance: float) -> float:
        """The margin to aim at after a proof has failed.

        Where the path keeps the clearance and the proof fails all the same, for what smoothing in
        time and the model's residual may do, that takes more than the path had to spare there.
        """
        distance = certificate.clearance if certificate.distance is None else certificate.distance
        short = clearance - distance
        if certificate.verdict is Verdict.UNPROVEN:
            return max(_WIDER * self.margin, -_AMPLE * short)
        return max(_WIDER * self.margin, self.margin + _WIDER * short)


def with_room(
    x: FloatArray,
    variables: ProgramVariables,
    planned: Callable[[FloatArray], Path],
    moves: Set[int],
) -> FloatArray:
    """Values with zones small enough for their neighbours when all is rounded.

    Rounded points are a little nearer to each other or further apart than those searched for. A
    controller may leave out a waypoint whose zone then overlaps its neighbour's.

    Args:
        x: (n,) of the variables.
        variables: points and zones.
        planned: the path of the program that is written with such values; a MotionError of it
            leaves all as it is.
        moves: indices of those that are driven before rounding.
    """
    shrunk = x
    for step in _STEPS:
        try:
            path = planned(shrunk)
        except MotionError:
            return x
        corners = path.route.zone_moves
        tight = {corners[room.corner] for room in path.rooms() if room.left.value < -_TIGHT}
        for move in moves - set(path.route.moves):
            tight |= {move - 1, move, move + 1}
        if not tight:
            break
        for move in tight:
            shrunk = variables.with_smaller_zone(shrunk, move, step)
    return shrunk


def driven_moves(
    plan: Callable[[Program], Path], variables: ProgramVariables, x: FloatArray
) -> Set[int]:
    """Indices of the moves that are driven at some values; none where they cannot be driven."""
    try:
        return frozenset(plan(variables.applied(x)).route.moves)
    except MotionError:
        return frozenset()
