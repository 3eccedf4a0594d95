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
from .telling import text_of, told


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

    def test_golden_recordings_log_as_their_author_says(self) -> None:
        """That they log at all, how often, and from where to where, no text that is read says."""
        self.need("recorder")
        for text in self.golden_texts:
            if text.recorded is None:
                continue
            period, lines = text.recorded
            robot = self.vendor.robot(str(text.robot))
            sources = self.vendor.record(self.read_golden(text), robot, period)
            whole, at = " ".join("\n".join(sources.values()).split()), 0
            for line in lines:
                found = whole.find(" ".join(line.split()), at)
                assert found >= 0, told(
                    f"golden text {text.about!r}, recorded every {1000 * period:g} ms, has no "
                    f"{line!r}" + (" behind the lines before" if at else ""),
                    written=text_of(sources),
                    look="what begins and ends the log, and its period",
                )
                at = found + 1

    def test_a_period_that_is_none_is_refused(self) -> None:
        self.need("recorder")
        robot = self.vendor.robot(self.driven_robots()[0])
        for period in (0.0, -0.1, math.nan, math.inf):
            with pytest.raises(FlybyError):
                self.vendor.record(Program(()), robot, period)


def _silent(program: Program) -> tuple[Move, ...]:
    """The moves alone, without their events."""
    return tuple(replace(move, events=()) for move in program.moves)
