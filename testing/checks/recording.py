"""Checks of a vendor's recorder: the program, driven and logged."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ...core.errors import FlybyError
from ...core.program.move import Move
from ...core.program.program import Program
from ...core.source.patch.edits import difference
from .subject import PROGRAM_EXAMPLES, Subject, said


class RecordingChecks(Subject):
    """What logs itself drives the same moves."""

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_a_recording_drives_the_same_moves(self, data: st.DataObject) -> None:
        self.need("recorder")
        robot = self.vendor.robot(data.draw(st.sampled_from(self.driven_robots())))
        program = data.draw(self.programs(robot))
        sources = self.vendor.record(program, robot, data.draw(st.sampled_from(self.periods)))
        assert sources and all(sources.values())
        if self.vendor.reader is None:
            return
        # What happens on the way is the program's, not the log's.
        again = Program(_silent(self.read_back(sources, robot)))
        wanted = Program(_silent(said(program, self.vendor, robot, again)))
        found = difference(wanted, again, self.precision)
        assert found is None, f"move {found[0] + 1} is driven with another {found[1]}"

    def test_a_period_that_is_none_is_refused(self) -> None:
        self.need("recorder")
        robot = self.vendor.robot(self.driven_robots()[0])
        for period in (0.0, -0.1, math.nan, math.inf):
            with pytest.raises(FlybyError):
                self.vendor.record(Program(()), robot, period)


def _silent(program: Program) -> tuple[Move, ...]:
    """The moves alone, without their events."""
    return tuple(replace(move, events=()) for move in program.moves)
