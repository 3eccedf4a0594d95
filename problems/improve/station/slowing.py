"""Robots that would wait drive slower, and so gentler, in the time until others let them on.

A section is what a robot drives between two actions that bear on others. Where it would wait at the
end of one, all moves of the section become slower by one factor, so that it comes to the wait when
it may nearly go on; and behind its last action, so that it ends with the station.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ....core.collision.proof.certificate import SceneOf
from ....core.collision.proof.verdict import Certificate
from ....core.dialect import Dialect
from ....core.errors import FlybyError, MotionError
from ....core.motion.emulator.run import Run
from ....core.program.signal import SetSignal
from ....core.program.target import JointTarget
from ...reading_back import ReadBack, read_as_written
from ..energy.pacing import Pacing, make_pacing
from ..solve_round_verify import ProgramFeasibility
from ..waypoints import WaypointTask
from .feasibility import StationFeasibility

_SLOWEST = 0.2
"""Share of the speed that a move reaches below which it is not driven."""
_HALVINGS = 7
_WORTH = 0.05
"""s of waiting below which nothing is made slower."""


@dataclass(frozen=True)
class _Section:
    """What a robot drives before it waits.

    Args:
        first, last: indices of its moves.
        begins, ends: rows of the actions at both ends; None for the program's own ends.
        spare: s that it may take longer.
    """

    first: int
    last: int
    begins: int | None
    ends: int | None
    spare: float


@dataclass(frozen=True)
class Slowing:
    """How one robot of a station is driven slower.

    Args:
        feasibility: of the station.
        name: of the robot.
        scenes: its cell with each tool.
        dialect: what its language has words for; None for everything.
        wishes: which moves stay.
        start: where the robot stands; None for the program's own start.
        reserve: s that it comes to a wait before it may go on.
    """

    feasibility: StationFeasibility
    name: str
    scenes: SceneOf
    dialect: Dialect | None
    wishes: WaypointTask
    start: JointTarget | None
    reserve: float

    def run(self, read_back: ReadBack) -> tuple[Run, Certificate] | None:
        """The program as driven slower, read back and proven; None where there is nothing to win.

        Args:
            read_back: makes of a program what a controller would read.
        """
        member = self.feasibility.state.station.members[self.name]
        given = member.run
        sections = list(self._sections())
        if not sections:
            return None
        pacing = make_pacing(
            given.program,
            given.timing,
            member.controller.robot,
            self.dialect,
            self.wishes,
            _SLOWEST,
        )
        y = pacing.upper.copy()
        for section in sections:
            y = self._slower(pacing, given, y, section)
        program = pacing.written(given.program, y)
        if program.moves == given.program.moves:
            return None
        try:
            written = read_as_written(given.program, program, read_back)
        except FlybyError:
            return None
        held = ProgramFeasibility(
            member.controller,
            self.scenes,
            member.cell.clearance,
            start=self.start,
            beside=self.feasibility.beside(self.name),
        )
        run, certificate = held.verified(written.program)
        if run is None or certificate is None or not certificate.proven:
            return None
        return run, certificate

    def _sections(self) -> Iterator[_Section]:
        """Those behind which the robot waits."""
        state = self.feasibility.state
        schedule = state.run.schedules[self.name]
        doings = state.ordered[self.name]
        spent = {spell.action: spell.end - spell.begin for spell in schedule.waits}
        moves = len(state.station.members[self.name].program.moves)
        for k, action in enumerate(doings):
            before = k - 1 if k else None
            first = 0 if before is None else doings[before].move + 1
            spare = spent.get(action, 0.0) - self.reserve
            if not isinstance(action.does, SetSignal) and spare > _WORTH:
                yield _Section(first, action.move, before, k, spare)
        spare = state.duration - schedule.end - self.reserve
        if spare > _WORTH:
            last = len(doings) - 1 if doings else None
            first = 0 if last is None else doings[last].move + 1
            yield _Section(first, moves - 1, last, None, spare)

    def _slower(self, pacing: Pacing, given: Run, y: FloatArray, section: _Section) -> FloatArray:
        """With the moves of a section slower by the greatest factor that there is time for."""
        those = np.array(
            [
                section.first <= number.move <= section.last and not number.accelerates
                for number in pacing.numbers
            ],
            dtype=bool,
        )
        if not those.any():
            return y
        taken = self._taken(given, section)
        low, high = np.log(_SLOWEST), 0.0
        best = y
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            tried = np.clip(np.where(those, pacing.start + middle, y), pacing.lower, pacing.upper)
            try:
                member = self.feasibility.state.station.members[self.name]
                run = member.controller.run(pacing.written(given.program, tried), self.start)
            except MotionError:
                low = middle
                continue
            if self._taken(run, section) <= taken + section.spare:
                best, high = tried, middle
            else:
                low = middle
        return best

    def _taken(self, run: Run, section: _Section) -> float:
        """s that a section takes."""
        doings = self.feasibility.ordered_of(self.name, run)
        begin = 0.0 if section.begins is None else doings[section.begins].time
        end = run.duration if section.ends is None else doings[section.ends].time
        return end - begin
