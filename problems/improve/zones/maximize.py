"""Zone maximisation (thesis, section 4.4): every zone as large as it can be.

The program as driven must keep the clearance. Then the zone of each waypoint grows from nothing,
for itself, as far as rules and obstacles let it; neighbours that share a leg share it out; and
the program that comes out, read back from the text it is written to, is certified.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ....core.cell.cell import Cell
from ....core.collision.handled_scenes import scenes_along
from ....core.collision.proof.certificate import SceneOf
from ....core.collision.proof.verdict import Certificate
from ....core.errors import FlybyError, MotionError, Note
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.program.program import Program
from ....core.program.zone import Radius, Zone
from ...reading_back import ReadBack, read_as_written
from ...scene_notes import scene_notes
from ..approaches import approach_notes
from ..gains import seconds_gained
from ..solution import Solution, measure
from ..solve_round_verify import ProgramFeasibility, solve_round_verify
from .changes import ZoneChange, changes
from .clearing import Clearing
from .deviation import segment_deviations
from .neighbourhood import Neighbourhoods
from .options import ZoneTask
from .points import Points, find_points
from .predefined import choices, choose
from .repair import BESIDE, SMALLER, Repair, is_slower
from .rules import Rules, passable
from .search import Asking, Sides, SizeBracket, SizeSearch
from .settling import settle, with_zones
from .side_by_side import ZoneOf, drive
from .sizes import Growth

Tell = Callable[[str], None]

_AIM = 1.1
"""On deviations that zones turn out to need, so that it takes few rounds until they have them."""
_INTERRUPTED = SizeBracket(0.0, 0.0, MotionError("the search was interrupted"))


@dataclass(frozen=True, repr=False)
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
    options: ZoneTask | None = None,
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
    return _Maximization(controller, program, cell, options or ZoneTask(), tell).run(read_back)


class _Maximization:
    """One run.

    Args:
        controller, program, cell, options, tell: as above.
    """

    def __init__(
        self, controller: Controller, program: Program, cell: Cell, options: ZoneTask, tell: Tell
    ) -> None:
        self._controller = controller
        self._program = program
        self._options = options
        self._tell = tell
        self._wanted = cell.clearance if options.clearance is None else options.clearance
        self._scenes: SceneOf = scenes_along(
            cell,
            options.handling,
            program,
            lambda: controller.plan(program, options.start),
            self._wanted + options.residual,
        )
        self._feasibility = ProgramFeasibility(
            controller,
            self._scenes,
            self._wanted,
            options.residual,
            options.start,
            beside=options.beside,
        )

    def run(self, read_back: ReadBack) -> ZoneSolution:
        """All of it."""
        options, program = self._options, self._program
        self._tell("looking at the program as it is")
        freed = dict.fromkeys(options.freed, options.pattern)
        points = find_points(
            self._controller,
            program,
            options.start,
            freed,
            options.kept,
            options.apart,
            options.process,
        )
        before, proof = self._feasibility.given(program)
        found, zones = self._grown(points, before)
        self._tell("certifying the new program")
        smaller = SMALLER if options.beside is None else BESIDE
        repair = Repair(points, program, zones, options.rounding, smaller)
        proven = proof is not None and proof.proven
        larger = _LargerZones(repair, before, proven, read_back, dict.fromkeys(points.notes))
        after, certificate = solve_round_verify(self._feasibility, larger) or (before, proof)
        return ZoneSolution(
            program,
            after.program if repair.changed else program,
            measure(self._controller, before, proof),
            measure(self._controller, after, certificate),
            certificate,
            (
                *larger.notes,
                *scene_notes(self._scenes, program),
                *approach_notes(before, after),
            ),
            gained=seconds_gained(before, after),
            zones=changes(points, program, repair.zones, found),
        )

    def _grown(self, points: Points, before: Run) -> tuple[dict[int, SizeBracket], dict[int, Zone]]:
        """What was found at each corner, and the zones that come of it.

        They leave room for how far smoothing in time takes the links off the path. Larger zones may
        make that more: then they grow anew, with that much room.
        """
        moves = points.route.moves
        deviations = segment_deviations(self._controller, before, moves)
        rules = Rules(points.route, self._controller.model)
        while True:
            found = self._search(points, rules, deviations)
            zones = settle(points, self._program, rules, found, self._options.rounding)
            if _INTERRUPTED in found.values() or not deviations.any():
                return found, zones
            program = with_zones(self._program, points, zones)
            try:
                run = self._controller.run(program, self._options.start)
            except MotionError:
                return found, zones  # Some of them go together badly: these are put back.
            needed = segment_deviations(self._controller, run, moves)
            if (needed <= deviations).all():
                return found, zones
            deviations = np.where(needed > deviations, _AIM * needed, deviations)

    def _search(
        self, points: Points, rules: Rules, deviations: FloatArray
    ) -> dict[int, SizeBracket]:
        """Every zone for itself."""
        trials = Neighbourhoods(self._controller.robot, points.route, self._controller.model)
        looks = self._looks(points, deviations)
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
        return SizeSearch(sides, largest, self._options.tolerance).run(), growth.zone

    def _looks(self, points: Points, deviations: FloatArray) -> list[Clearing]:
        """What each segment is looked at by."""
        moves = self._program.moves
        return [
            Clearing(
                self._scenes(moves[index].tool, index),
                self._wanted,
                deviation,
                self._options.residual,
            )
            for index, deviation in zip(points.route.moves, deviations, strict=True)
        ]


@dataclass(frozen=True)
class _LargerZones:
    """Larger zones on their way into the text; those that do not hold there are made smaller.

    Args:
        repair: the new zones, and the way back.
        before: the program as it was given; the new one is no slower.
        proven: whether that one is proven.
        read_back: see `maximize_zones`.
        notes: what the user should know; more come to them.
    """

    repair: Repair
    before: Run
    proven: bool
    read_back: ReadBack
    notes: dict[Note, None]

    def rounded(self) -> Program | None:
        """The new program as read from its text; zones it has no place for are what they were."""
        repair = self.repair
        if not repair.changed:
            return None
        try:
            written = read_as_written(repair.given, repair.program, self.read_back)
        except FlybyError as error:
            self.notes[Note(f"no zone is changed, as none can be written: {error}")] = None
            repair.give_up()
            return None
        self.notes.update(dict.fromkeys(written.notes))
        repair.hold(i for i, _ in written.refused)
        return written.program if repair.changed else None

    def undrivable(self, error: MotionError) -> None:
        """Zones next to the move are put back."""
        if not self.repair.undrivable(error.move):
            self.repair.give_up()

    def accepted(self, run: Run, certificate: Certificate | None) -> bool:
        """Whether it is proven, and no slower."""
        proven = certificate is not None and certificate.proven
        if certificate is not None and not proven and self.repair.refused(run, certificate):
            return False
        if is_slower(self.before, run):
            if not self.repair.slower(self.before, run):
                self.repair.give_up()
            return False
        if not proven and self.proven:
            self.repair.give_up()
            return False
        return True
