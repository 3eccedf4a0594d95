"""How large zones may be by the vendor's rules, and how neighbours share what lies between them.

Where no zone may reach further than half way to a neighbouring point, zones do not meet. Where
zones may take the whole way (and shrink, or leave a waypoint out, if they overlap), the two of a
leg share it: both grow at the same rate, until the leg is full or one of them may not grow on;
what one leaves, the other takes. So the smaller zone of any leg is as large as it can be (max-min
fairness), and the outcome does not depend on an order.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from ....core.motion.geometry.corners import STOP
from ....core.motion.geometry.neighbour_zones import way_towards_neighbour
from ....core.motion.geometry.segments import Segments, make_segments
from ....core.motion.model.motion_model import MotionModel
from ....core.motion.model.rules import Overlap
from ....core.motion.path.path import Route
from ....core.program.zone import ContourFraction, Radius
from .neighbourhood import Neighbourhoods
from .sizes import Growth

Leg = int
"""Index of the segment between two corners: leg k lies between corners k − 1 and k."""

APART = 0.999
"""Share of the way to a neighbouring point, or of a leg, that zones take at most."""
_HALVINGS = 30


class Rules:
    """The rules for the zones of one route.

    Args:
        route: the program's.
        model: the vendor's rules.
    """

    def __init__(self, route: Route, model: MotionModel) -> None:
        self._route = route
        self._segments: Segments = make_segments(route.ends)
        self._alone = model.overlap is Overlap.HALF
        self._share = model.neighbour_fraction if self._alone else APART
        self._half = model.neighbour_fraction

    @property
    def shared_legs(self) -> bool:
        """Whether neighbouring zones share their leg."""
        return not self._alone

    def largest(self, corner: int, growth: Growth) -> float:
        """The largest size of the zone at a corner if its neighbours have none; 0 for no zone."""
        if isinstance(growth.pattern, ContourFraction):
            return 1.0
        turn = self._half * max(self._turn(corner), self._turn(corner + 1))
        if not isinstance(growth.pattern, Radius):
            return turn
        sides = corner, corner + 1
        ways = [
            way_towards_neighbour(self._segments, self._route.chains, side, corner, self._share)
            for side in sides
        ]
        known = [way.value for way in ways if way is not None]
        if known:
            return min(known)
        angle = growth.pattern.angle / growth.pattern.tcp
        return turn / angle if angle > 0 else 0.0

    def _turn(self, segment: int) -> float:
        """rad that the tool turns on a segment, beside the turn of an arc."""
        return float(self._segments.turn[segment])


def passable(
    trials: Neighbourhoods, rules: Rules, growths: Mapping[int, Growth]
) -> dict[int, float]:
    """The largest sizes by the rules, of the corners at which the robot passes without stopping.

    Args:
        trials: emulates single corners.
        rules: of the vendor.
        growths: by corner.
    """
    sizes = {corner: rules.largest(corner, growth) for corner, growth in growths.items()}
    sizes = {corner: size for corner, size in sizes.items() if size > 0.0}
    corners = list(sizes)
    kinds = trials.kinds([(corner, growths[corner].zone(sizes[corner])) for corner in corners])
    return {i: sizes[i] for i, kind in zip(corners, kinds, strict=True) if kind != STOP}


def share_legs(
    trials: Neighbourhoods,
    growths: Mapping[int, Growth],
    fixed: Mapping[int, Growth],
    sizes: Mapping[int, float],
) -> dict[int, float]:
    """Sizes with which neighbouring zones do not overlap, none larger than ``sizes``.

    Args:
        trials: emulates single corners.
        growths: of the zones that may be made smaller, by corner.
        fixed: of those that may not.
        sizes: of all zones, by corner.
    """
    sharing = _Sharing(trials, growths, fixed, dict(sizes))
    legs = {k for i in growths for k in (i, i + 1) if sharing.overfull(k)}
    while legs:
        levels = sharing.levels(sorted(legs))
        # Legs fuller than their neighbours are settled; the others may gain from that.
        settled = {
            k for k in legs if all(levels[k] <= levels.get(n, math.inf) for n in (k - 1, k + 1))
        }
        for k in settled:
            sharing.settle(k, levels[k])
        legs = {k for k in legs - settled if sharing.overfull(k)}
    return sharing.sizes


class _Sharing:
    """Zones that grow together on their legs.

    A *level* is what all of them have grown to; a zone stops at its own size.
    """

    def __init__(
        self,
        trials: Neighbourhoods,
        growths: Mapping[int, Growth],
        fixed: Mapping[int, Growth],
        sizes: dict[int, float],
    ) -> None:
        self.sizes = sizes
        self._trials = trials
        self._growths = growths
        self._all = {**fixed, **growths}

    def overfull(self, leg: Leg) -> bool:
        """Whether the zones of a leg overlap."""
        return self._taken([leg], {leg: math.inf})[leg] > 1.0

    def levels(self, legs: list[Leg]) -> dict[Leg, float]:
        """The level at which each leg is full."""
        low = dict.fromkeys(legs, 0.0)
        high = {
            k: max(self.sizes.get(i, 0.0) for i in self._ends(k) if i in self._growths)
            for k in legs
        }
        for _ in range(_HALVINGS):
            middle = {k: 0.5 * (low[k] + high[k]) for k in legs}
            taken = self._taken(legs, middle)
            for k in legs:
                (high if taken[k] > APART else low)[k] = middle[k]
        return low

    def settle(self, leg: Leg, level: float) -> None:
        """Give the zones of a leg the level at which it is full."""
        for i in self._ends(leg):
            if i in self._growths:
                self.sizes[i] = min(self.sizes[i], level)

    def _ends(self, leg: Leg) -> tuple[int, ...]:
        return tuple(i for i in (leg - 1, leg) if i in self.sizes)

    def _taken(self, legs: list[Leg], level: Mapping[Leg, float]) -> dict[Leg, float]:
        """Share of each leg that zones take, all movable ones no larger than the level."""
        trials = []
        for k in legs:
            for i in self._ends(k):
                size = self.sizes[i]
                trials.append((k, i, min(size, level[k]) if i in self._growths else size))
        reaches = self._trials.reaches([(i, self._all[i].zone(size)) for _, i, size in trials])
        taken = dict.fromkeys(legs, 0.0)
        for (k, i, _), reach in zip(trials, reaches, strict=True):
            taken[k] += float(reach[k - i])
        return taken
