"""Zone maximisation (thesis, section 4.4): every zone as large as it can be.

The program as driven must keep the clearance. Then the zone of each waypoint grows from nothing,
for itself, as far as rules and obstacles let it; neighbours that share a leg share it out; and
the program that comes out, read back from the text it is written to, is certified.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.cell.cell import Cell
from ...core.collision.certificate import SceneOf, certify, scenes_of
from ...core.collision.strays import smoothing_strays
from ...core.collision.verdict import Certificate
from ...core.errors import MotionError
from ...core.motion.controller import Controller, Run
from ...core.program.program import Program
from ...core.program.zone import Radius, Zone
from ..solution import RESOLUTION, Solution, measure, scene_notes
from .clearing import Clearing
from .driving import ZoneOf, drive
from .neighbourhood import Neighbourhoods
from .options import ZoneOptions
from .points import Points, find_points
from .predefined import choices, choose
from .refusal import check_start
from .repair import Repair
from .rules import Rules, passable
from .search import Asking, Found, Search, Sides
from .settling import settle
from .sizes import Growth
from .table import ZoneChange, changes

FloatArray = NDArray[np.float64]
ReadBack = Callable[[Program], Program]
"""Writes a program and reads what was written."""
Tell = Callable[[str], None]

_EXCESS = 1.5
"""On how far smoothing and leads take the joints off the path before zones have grown: with larger
ones the robot is faster. The certificate that ends every run takes what it is then."""
_INTERRUPTED = Found(0.0, 0.0, MotionError("the search was interrupted"))


@dataclass(frozen=True)
class ZoneSolution(Solution):
    """A program with larger zones.

    Args:
        zones: what became of each zone that might change.
    """

    zones: tuple[ZoneChange, ...] = ()


def maximize_zones(
    controller: Controller,
    program: Program,
    cell: Cell,
    options: ZoneOptions | None = None,
    read_back: ReadBack = lambda program: program,
    tell: Tell = lambda message: None,
) -> ZoneSolution:
    """The program with zones as large as they can be.

    Args:
        controller: drives the program.
        program: whose zones are to grow.
        cell: what stands around, and the clearance to keep.
        options: what is wanted.
        read_back: makes of a program what a controller would read: written and read again.
        tell: called with what is being done.

    Raises:
        InputError: no zone may change, or the cell does not fit the program.
        MotionError: the program cannot be driven, or does not keep the clearance as it is.
    """
    return _Maximization(controller, program, cell, options or ZoneOptions(), tell).run(read_back)


class _Maximization:
    """One run.

    Args:
        controller, program, cell, options, tell: as above.
    """

    def __init__(
        self, controller: Controller, program: Program, cell: Cell, options: ZoneOptions, tell: Tell
    ) -> None:
        self._controller = controller
        self._program = program
        self._options = options
        self._tell = tell
        self._wanted = cell.clearance if options.clearance is None else options.clearance
        self._scenes: SceneOf = scenes_of(cell)

    def run(self, read_back: ReadBack) -> ZoneSolution:
        """All of it."""
        options, program = self._options, self._program
        self._tell("looking at the program as it is")
        freed = dict.fromkeys(options.freed, options.pattern)
        points = find_points(
            self._controller, program, options.start, freed, options.kept, options.apart
        )
        before = self._controller.run(program, options.start)
        proof = self._certified(before)
        check_start(self._controller, before, self._scenes, proof, options.residual)
        trials = Neighbourhoods(self._controller.robot, points.route, self._controller.model)
        found = self._search(points, trials, before)
        self._tell("certifying the new program")
        zones = settle(points, program, trials, self._rules(points), found, options.rounding)
        repair = Repair(points, program, zones, options.rounding)
        after, certificate = self._proven(repair, (before, proof), read_back)
        return ZoneSolution(
            program,
            after.program if repair.changed else program,
            measure(self._controller, before, proof),
            measure(self._controller, after, certificate),
            certificate,
            (*points.notes, *scene_notes(self._scenes, program)),
            zones=changes(points, program, repair.zones, found),
        )

    def _proven(
        self, repair: Repair, given: tuple[Run, Certificate], read_back: ReadBack
    ) -> tuple[Run, Certificate]:
        """The new program driven, and its certificate; zones are made smaller as needed."""
        while repair.changed:
            after = self._controller.run(read_back(repair.program), self._options.start)
            certificate = self._certified(after)
            if certificate.proven:
                again = repair.slower(given[0], after)
            else:
                again = repair.refused(after, certificate)
                if not again and given[1].proven:
                    repair.give_up()
                    break
            if not again:
                return after, certificate
        return given

    def _rules(self, points: Points) -> Rules:
        return Rules(points.route, self._controller.model)

    def _certified(self, run: Run) -> Certificate:
        return certify(
            self._controller,
            run,
            self._scenes,
            self._wanted,
            self._options.residual,
            resolution=RESOLUTION,
        )

    def _search(self, points: Points, trials: Neighbourhoods, run: Run) -> dict[int, Found]:
        """Every zone for itself."""
        rules = self._rules(points)
        looks = self._looks(points, run)
        searches: dict[int, Asking] = {}
        zones: dict[int, ZoneOf] = {}
        for corner, largest in passable(trials, rules, points.growths).items():
            sides = looks[corner], looks[corner + 1]
            growth = points.growths[corner]
            searches[corner], zones[corner] = self._one(growth, sides, largest)
        count = len(searches)
        self._tell(f"growing {count} zones")
        found = drive(
            trials, searches, zones, lambda done: self._tell(f"{done} of {count} zones are grown")
        )
        return {corner: found.get(corner, _INTERRUPTED) for corner in searches}

    def _one(self, growth: Growth, sides: Sides, largest: float) -> tuple[Asking, ZoneOf]:
        """The search at one corner, and what its sizes mean."""
        predefined = self._options.rounding.predefined
        if predefined and isinstance(growth.pattern, Radius):
            allowed = choices(predefined, largest)
            by_size: Mapping[float, Zone] = {zone.tcp: zone for zone in allowed}
            return choose(sides, allowed), by_size.__getitem__
        return Search(sides, largest, self._options.tolerance).run(), growth.zone

    def _looks(self, points: Points, run: Run) -> dict[int, Clearing]:
        """What the segments are looked at by, those of one scene by one and the same."""
        deviation = self._deviation(run)
        known: dict[int, Clearing] = {}
        looks = {}
        for segment, index in enumerate(points.route.moves):
            scene = self._scenes(self._program.moves[index].tool)
            if id(scene) not in known:
                known[id(scene)] = Clearing(scene, self._wanted, deviation, self._options.residual)
            looks[segment] = known[id(scene)]
        return looks

    def _deviation(self, run: Run) -> FloatArray:
        """How far (N,) smoothing in time, and leads of elastic joints, take them off the path."""
        return np.asarray(_EXCESS * smoothing_strays(self._controller, run))
