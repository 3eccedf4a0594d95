"""How large zones may be by the vendor's rules, and how neighbours share what lies between them.

Where no zone may reach further than half way to a neighbouring point, zones do not meet. Where
zones may take the whole way (and shrink, or leave a waypoint out, if they overlap), the two of a
leg share it: both grow at the same rate, until the leg is full or one of them may not grow on;
what one leaves, the other takes. So the smaller zone of any leg is as large as it can be (max-min
fairness), and the outcome does not depend on an order.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ....core.motion.geometry.corners import STOP
from ....core.motion.geometry.segments import make_segments
from ....core.motion.geometry.zones import ZonePlanner
from ....core.motion.model.motion_model import MotionModel
from ....core.motion.model.rules import Overlap
from ....core.motion.path.path import Route
from ....core.program.zone import Angle, ContourFraction, VendorZone, Zone
from .neighbourhood import Neighbourhoods
from .sizes import Growth

APART = 0.999
"""Share of the way to a neighbouring point, or of a leg, that zones take at most."""
_HALVINGS = 30


class Rules:
    """The emulator's rules for the zones of one route, asked how large zones may be.

    Args:
        route: the program's.
        model: the vendor's rules.

    Attributes:
        shared_legs: whether neighbouring zones share their leg.
    """

    def __init__(self, route: Route, model: MotionModel) -> None:
        self._zones = route.zones
        self._segments = make_segments(route.ends)
        self._planner = ZonePlanner(
            self._segments, route.chains, model, route.moves, route.robot.limits
        )
        self._half = model.neighbour_fraction
        self.shared_legs = model.overlap is not Overlap.HALF

    def largest(self, corner: int, growth: Growth) -> float:
        """The largest size of the zone at a corner if its neighbours have none; 0 for no zone."""
        if isinstance(growth.pattern, ContourFraction):
            return 1.0
        if isinstance(growth.pattern, VendorZone) and growth.pattern.kind.reach is not None:
            return growth.pattern.kind.largest
        turn = self._half * float(self._segments.turn[corner : corner + 2].max())
        if isinstance(growth.pattern, Angle):
            return turn
        radius = self._planner.widest(corner, APART)
        if isinstance(growth.pattern, VendorZone):
            return min(radius or 0.0, growth.pattern.kind.largest)
        if radius is not None:
            return radius
        angle = growth.pattern.angle / growth.pattern.tcp
        return turn / angle if angle > 0 else 0.0

    def share_legs(
        self, growths: Mapping[int, Growth], sizes: Mapping[int, float]
    ) -> dict[int, float]:
        """Sizes with which neighbouring zones do not overlap, none larger than ``sizes``.

        Args:
            growths: of the zones that may be made smaller, by corner; the others are the route's.
            sizes: theirs.
        """
        sharing = _Sharing(self._planner, self._zones, growths, sizes)
        legs = {k for i in sizes for k in (i, i + 1) if sharing.taken(k) > 1.0}
        while legs:
            levels = {k: sharing.level(k) for k in legs}
            # Legs fuller than their neighbours are settled; the others may gain from that.
            settled = {
                k for k in legs if all(levels[k] <= levels.get(n, math.inf) for n in (k - 1, k + 1))
            }
            for k in settled:
                sharing.settle(k, levels[k])
            legs = {k for k in legs - settled if sharing.taken(k) > 1.0}
        return sharing.sizes


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
    kinds = trials.kinds([(corner, growths[corner].zone(size)) for corner, size in sizes.items()])
    return {i: sizes[i] for i, kind in zip(sizes, kinds, strict=True) if kind != STOP}


class _Sharing:
    """Zones that grow together on their legs; leg k lies between corners k − 1 and k.

    A *level* is what both zones of a leg have grown to; a zone stops at its own size.
    """

    def __init__(
        self,
        planner: ZonePlanner,
        zones: Sequence[Zone],
        growths: Mapping[int, Growth],
        sizes: Mapping[int, float],
    ) -> None:
        self.sizes = dict(sizes)
        self._planner = planner
        self._zones = list(zones)
        self._growths = growths

    def taken(self, leg: int, level: float = math.inf) -> float:
        """Share of a leg that its zones take, those that may change no larger than the level."""
        for i in self._ends(leg):
            self._zones[i] = self._growths[i].zone(min(self.sizes[i], level))
        return self._planner.share_taken(leg, self._zones)

    def level(self, leg: int) -> float:
        """The level at which a leg is full."""
        low, high = 0.0, max(self.sizes[i] for i in self._ends(leg))
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if self.taken(leg, middle) > APART:
                high = middle
            else:
                low = middle
        return low

    def settle(self, leg: int, level: float) -> None:
        """Give the zones of a leg the level at which it is full."""
        for i in self._ends(leg):
            self.sizes[i] = min(self.sizes[i], level)

    def _ends(self, leg: int) -> list[int]:
        return [i for i in (leg - 1, leg) if i in self.sizes]
