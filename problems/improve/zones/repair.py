"""Zones made smaller where the certificate is refused, or where they cost time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np

from ....core.collision.proof.verdict import Certificate
from ....core.motion.emulator.run import Run
from ....core.program.program import Program
from ....core.program.zone import Fine, Zone
from ..rounding import Rounding
from .points import Points
from .settling import with_zones
from .sizes import Growth, size_of

SMALLER = 0.99
"""Factor by which a zone is made smaller that the certificate is refused for."""
BESIDE = 0.8
"""The same where other robots refuse it: nothing has been searched with them."""
PATIENCE = 4
"""How often, before it is put back to what it was."""
MOST = 40
"""Changes in all."""
_ONE_BY_ONE = 16
"""Zones that cost time are put back singly so often, then more of them at a time."""
_LATER = 1e-9
"""Share of the cycle time that does not count."""


def is_slower(before: Run, after: Run) -> bool:
    """Whether a program takes longer than another."""
    return after.duration > before.duration * (1 + _LATER)


class Repair:
    """The zones of a new program, and the way back.

    Args:
        points: of the program.
        program: as it was given.
        zones: the new zones by corner.
        rounding: of smaller ones.
        smaller: factor by which zones become smaller, more with every time.
    """

    def __init__(
        self,
        points: Points,
        program: Program,
        zones: Mapping[int, Zone],
        rounding: Rounding,
        smaller: float = SMALLER,
    ) -> None:
        self._points, self._factor = points, smaller
        self.given = program
        self._old = {i: program.moves[points.move[i]].zone for i in zones}
        self._group = {i: members for members in points.groups for i in members}
        self._rounding = rounding
        self._tried: dict[int, int] = {}
        self._left = MOST
        self._returned = 0
        self.zones = dict(zones)

    @property
    def changed(self) -> bool:
        """Whether any zone is another one than was given."""
        return self.zones != self._old

    @property
    def program(self) -> Program:
        """The new program."""
        return with_zones(self.given, self._points, self.zones)

    def refused(self, run: Run, certificate: Certificate) -> bool:
        """Make the zones smaller that a certificate is refused for.

        Returns:
            Whether there was anything to make smaller.
        """
        if certificate.sigma is None:
            return False
        return self._change(self._near(run, *certificate.sigma), self._smaller)

    def slower(self, before: Run, after: Run) -> bool:
        """Put back the zones that cost most time, if the program has become slower.

        Returns:
            Whether there was anything to put back.
        """
        if not is_slower(before, after):
            return False
        lost = self._lost(before, after)
        worst = sorted(self._changed(), key=lambda i: lost.get(i, 0.0), reverse=True)
        batch = worst[: 1 + self._returned // _ONE_BY_ONE]
        self._returned += len(batch)
        return self._change(batch, self._old.__getitem__)

    def hold(self, moves: Iterable[int]) -> None:
        """Put back the zones of some moves: the text has no other place for them."""
        held = set(moves)
        for corner in self._changed():
            if self._points.move[corner] in held:
                self.zones[corner] = self._old[corner]

    def undrivable(self, move: int | None) -> bool:
        """Put back the zones next to a move with which the program cannot be driven.

        Args:
            move: its index; None where it is not known.

        Returns:
            Whether there was anything to put back.
        """
        near = [] if move is None else [move - 1, move, move + 1]
        corners = [i for i in self._changed() if self._points.move[i] in near]
        return self._change(corners, self._old.__getitem__)

    def give_up(self) -> None:
        """Put everything back."""
        self.zones = dict(self._old)

    def _changed(self) -> list[int]:
        return [i for i, zone in self.zones.items() if zone != self._old[i]]

    def _lost(self, before: Run, after: Run) -> dict[int, float]:
        """s lost next to each corner, by the time that moves take."""
        spent: dict[int, float] = {}
        for run, sign in ((before, -1.0), (after, 1.0)):
            durations = run.timing.segment_durations()
            for move, duration in zip(run.path.route.moves, durations, strict=True):
                spent[move] = spent.get(move, 0.0) + sign * float(duration)
        moves = self._points.route.moves
        return {i: spent.get(moves[i], 0.0) + spent.get(moves[i + 1], 0.0) for i in self.zones}

    def _near(self, run: Run, begin: float, end: float) -> list[int]:
        """Corners with a new zone that reaches into a stretch of the path."""
        layout, route = run.path.layout, run.path.route
        waypoint = layout.waypoint[1:-1]
        lower = waypoint - layout.extent[..., 0].max(axis=1)
        upper = waypoint + layout.extent[..., 1].max(axis=1)
        hit = np.flatnonzero((lower <= end) & (upper >= begin))
        programmed = {route.zone_moves[k] for k in hit}
        return [
            i
            for i, zone in self.zones.items()
            if self._points.move[i] in programmed and zone != self._old[i]
        ]

    def _smaller(self, corner: int) -> Zone:
        tried = self._tried[corner] = self._tried.get(corner, 0) + 1
        zone = self.zones[corner]
        if tried > PATIENCE or isinstance(zone, Fine):
            return self._old[corner]
        growth = Growth.of(zone)
        smaller = growth.rounded(size_of(zone) * self._factor**tried, self._rounding)
        return self._old[corner] if isinstance(smaller, Fine) else smaller

    def _change(self, corners: Iterable[int], new: Callable[[int], Zone]) -> bool:
        corners = list(corners)
        self._left -= 1
        if not corners or self._left < 0:
            return False
        for corner in corners:
            zone = new(corner)
            for member in self._group[corner]:
                self.zones[member] = zone
        return True
