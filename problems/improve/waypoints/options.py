"""What a user may say about an optimisation of via points and zones."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

from ....core.errors import InputError
from ....core.handling.handling import Handling
from ....core.motion.geometry.pieces import Sampling
from ....core.program.target import JointTarget
from ....core.program.zone import Radius, VendorZone
from ....core.robot.model import Robot
from ..rounding import Rounding
from ..solve_round_verify import Beside
from ..zones.sizes import GRADED
from .point_limits import FREE, Fixed, Free, PointBox, PointCone, PointLimit

_SAMPLING = Sampling()
_ROUNDING = Rounding()


class Freedom(StrEnum):
    """What of a program may change."""

    ZONES = "zones"
    """Zones alone; every point stays."""
    WAYPOINTS_AND_ZONES = "waypoints_and_zones"
    """Via points and zones."""


class ViaCount(StrEnum):
    """What may become of the number of via points."""

    KEEP = "keep"
    """It stays: the new program can be patched into the old one's files."""
    CHANGE = "change"
    """Via points that serve nothing go, and others come where they save enough."""


@dataclass(frozen=True)
class WaypointTask:
    """What is wanted, and what must stay.

    Args:
        time_weight: w of the objective w · time + (1 − w) · energy, each as a share of what the
            input takes: 1 for time alone, 0 for energy alone.
        keep: indices of moves (from 0) whose path and speed the process fixes: they stay as they
            are, with the zones at both their ends.
        keep_speeds: names of speeds by which such moves are known.
        process: outputs by the indices of the moves that are driven while they are on, and stay
            likewise, except for a point with a limit of its own that lets it move.
        limits: how far the via points at the ends of these moves may be moved.
        limit: the same for all others.
        axes: joints (from 0) that joint targets may change; None for all.
        tilt: rad by which the tool may be turned at a via point from what is programmed, where no
            limit of that point speaks of it: the tool may hold something that is full, or hot. π
            lets it turn as it likes.
        clearance: m to keep; None for the cell's own.
        freed: indices of moves that end in a stop for no reason but that it is programmed: the
            robot may pass there, and they become via points.
        pattern: proportions of the zones that freed stops and new via points get.
        vias: see `ViaCount`.
        residual: m by which the real robot may deviate from the emulated one.
        rounding: of new numbers, as the program's language writes them. With predefined zones
            points are refined once more when zones have been chosen.
        start: where the robot stands; None for the program's own start.
        freedom: what may change.
        beside: what other robots say of a program; None where there are none.
        handling: of the cell's parts, by the program as it was given; None for a cell without.
        settled: why points and zones stay at the ends of some moves of that program.
        ways: indices of its moves along which what touches comes apart or together: neither end
            goes.
        given: for each move, the index of the one of the program as it was given that it comes
            from; None where these are its own moves.

    Raises:
        InputError: a number out of its range.
    """

    time_weight: float = 1.0
    keep: Collection[int] = ()
    keep_speeds: Collection[str] = ()
    process: Mapping[int, str] = field(default_factory=dict)
    limits: Mapping[int, PointLimit] = field(default_factory=dict)
    limit: PointLimit = FREE
    axes: Collection[int] | None = None
    tilt: float = 0.0
    clearance: float | None = None
    freed: Collection[int] = ()
    pattern: Radius | VendorZone = GRADED
    vias: ViaCount = ViaCount.KEEP
    residual: float = 0.0
    rounding: Rounding = _ROUNDING
    start: JointTarget | None = None
    freedom: Freedom = Freedom.WAYPOINTS_AND_ZONES
    beside: Beside | None = None
    handling: Handling | None = None
    settled: Mapping[int, str] = field(default_factory=dict)
    ways: Collection[int] = ()
    given: tuple[int, ...] | None = None

    def __post_init__(self) -> None:
        if not 0.0 <= self.time_weight <= 1.0:
            raise InputError(
                f"WaypointTask.time_weight lies between 0 and 1, not {self.time_weight}"
            )
        if not 0.0 <= self.tilt <= math.pi:
            raise InputError(f"WaypointTask.tilt lies between 0 and π, not {self.tilt}")
        for name in ("clearance", "residual"):
            value = getattr(self, name)
            if value is not None and not 0.0 <= value < math.inf:
                raise InputError(f"WaypointTask.{name} is zero or more metres, not {value}")

    @property
    def as_many_moves(self) -> bool:
        """Whether the program has the moves of the one that was given: none came, and none went."""
        return self.given is None or self.given == tuple(range(len(self.given)))

    def given_move(self, move: int) -> int:
        """The index of a move in the program as it was given."""
        return move if self.given is None else self.given[move]

    def free_axes(self, robot: Robot) -> list[int]:
        """Joints of an arm that joint targets may change."""
        free = [a for a, joint in enumerate(robot.joints) if not joint.held]
        return [a for a in free if self.axes is None or a in self.axes]

    def turn_at(self, move: int) -> float | None:
        """rad by which the tool may turn at the end of a move; None where no number bounds it."""
        limit = self.limits.get(move, self.limit)
        if isinstance(limit, PointCone):
            return None
        turn = self.tilt
        if isinstance(limit, PointBox) and limit.turn is not None:
            turn = limit.turn
        return None if turn >= math.pi else turn

    def spent(self) -> WaypointTask:
        """The same for a program whose points have been moved already.

        Limits are about where a point was in the program as it was given: those points have had
        their way, and stay; tools that may be tilted a little are not tilted further. So do points
        at the ends of `ways`, which are not to become longer again and again.
        """
        moves = self.ways if self.given is None else range(len(self.given))
        ways = [i for i in moves if self.given_move(i) in self.ways]
        held = dict.fromkeys([k for i in ways for k in (i - 1, i) if k >= 0], Fixed())
        return replace(
            self,
            limits={i: _spent(limit) for i, limit in self.limits.items()} | held,
            limit=_spent(self.limit),
            tilt=self.tilt if self.tilt >= math.pi else 0.0,
        )

    def renumbered(self, new: Callable[[int], int | None], count: int) -> WaypointTask:
        """The same of a program whose moves have other indices.

        Args:
            new: old index → new one; None for a move that is gone, one at the most.
            count: of its moves. One that is new comes before the one that it was made of.
        """
        limits = {new(i): limit for i, limit in self.limits.items()}
        given: dict[int, int] = {}
        for old in range(count + 1) if self.given is None else range(len(self.given)):
            k = new(old)
            if k is not None and k < count:
                given[k] = self.given_move(old)
        for k in reversed(range(count)):
            given.setdefault(k, given.get(k + 1, k))
        return replace(
            self,
            keep=[k for i in self.keep if (k := new(i)) is not None],
            process={k: v for i, v in self.process.items() if (k := new(i)) is not None},
            freed=[k for i in self.freed if (k := new(i)) is not None],
            limits={i: limit for i, limit in limits.items() if i is not None},
            given=tuple(given[k] for k in range(count)),
        )


def _spent(limit: PointLimit) -> PointLimit:
    return limit if isinstance(limit, Free) else Fixed()


@dataclass(frozen=True)
class Effort:
    """How hard to search.

    Args:
        starts: paths to start from in every stretch: the input and seeded variations of it.
        spread: standard deviation of a varied point, rad of each joint or m of a position.
        generations: how often the best path found is varied in turn, by less.
        variations: of the best path in each generation.
        seed: of the variations: the same seed gives the same result.
        iterations: at most, from each start.
        margin: m beyond the clearance that candidates aim at, so that the proof ends.
        proofs: how often a candidate that cannot be proven is tried again with a wider margin.
        sampling: how densely paths are sampled while routes are searched; results are refined,
            timed and proven with the controller's own.
        workers: processes; None for as many as there are processors. The result does not depend
            on it.

    Raises:
        InputError: a number out of its range.
    """

    starts: int = 12
    spread: float = 0.2
    generations: int = 2
    variations: int = 6
    seed: int = 0
    iterations: int = 60
    margin: float = 5e-5
    proofs: int = 6
    sampling: Sampling = _SAMPLING
    workers: int | None = None

    def __post_init__(self) -> None:
        for name, least in _LEAST.items():
            if getattr(self, name) < least:
                raise InputError(f"Effort.{name} is {least} or more, not {getattr(self, name)}")
        if self.workers is not None and self.workers < 1:
            raise InputError(f"Effort.workers is one or more, not {self.workers}")
        for name in ("spread", "margin"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"Effort.{name} must be above zero, not {value}")

    @property
    def processes(self) -> int:
        """How many processes to use."""
        if self.workers is not None:
            return self.workers
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1


_LEAST = {
    "starts": 1,
    "generations": 0,
    "variations": 0,
    "iterations": 1,
    "proofs": 0,
    "seed": 0,
}
