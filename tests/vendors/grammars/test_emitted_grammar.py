"""What the writers write is what the manuals' grammars and checks take."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, Span
from flyby.core.program.move import Move
from flyby.core.program.section import Section
from flyby.testing.checks.subject import Subject

from ..words import AbbWords, KukaWords, UrWords
from .check import checks

PROGRAMS = settings(
    max_examples=40,
    deadline=None,
    phases=set(Phase) - {Phase.shrink},
    suppress_health_check=list(HealthCheck),
)


class _Motion(Subject):
    """Programs that use no signals: these are declared on the controller, not in the text."""

    def acting(self, move: Move) -> st.SearchStrategy[Move]:
        """No events."""
        return st.just(move)

    def kept(self) -> None:
        """No statements but moves and waits."""


class _Abb(_Motion, AbbWords):
    pass


class _Kuka(_Motion, KukaWords):
    pass


class _Ur(_Motion, UrWords):
    pass


@pytest.mark.parametrize("words", [_Abb(), _Kuka(), _Ur()], ids=lambda w: w.name)
class TestEmitted:
    @PROGRAMS
    @given(data=st.data())
    def test_programs_would_be_loaded(self, words: Subject, data: st.DataObject) -> None:
        words.need("writer")
        robot = words.vendor.robot(data.draw(st.sampled_from(words.driven_robots())))
        program = data.draw(words.programs(robot))
        checks()[words.name](words.vendor.write(program, robot))

    @settings(PROGRAMS, max_examples=20)
    @given(data=st.data())
    def test_recordings_would_be_loaded(self, words: Subject, data: st.DataObject) -> None:
        words.need("recorder")
        robot = words.vendor.robot(data.draw(st.sampled_from(words.driven_robots())))
        program = data.draw(words.programs(robot))
        checks()[words.name](words.vendor.record(program, robot, words.periods[0]))

    @PROGRAMS
    @given(data=st.data())
    def test_loops_and_routines_would_be_loaded(self, words: Subject, data: st.DataObject) -> None:
        words.need("writer")
        robot = words.vendor.robot(data.draw(st.sampled_from(words.driven_robots())))
        program = data.draw(words.programs(robot))
        count, span = len(program.statements), Span("main", 1, 1, 0, 0)
        sections = (
            Section("pick place", 0, count, span),
            Section("FOR", count, 3 * count, span, (count, 2 * count)),
            Section("Pick place", count, 2 * count, span),
            Section("Pick place", 2 * count, 3 * count, span),
        )
        thrice = replace(program, statements=program.statements * 3, sections=sections)
        try:
            files = words.vendor.write(thrice, robot, {"structure": "keep"})
        except FlybyError:
            assume(False)  # where the robot comes from may decide what can be said
        checks()[words.name](files)
        text = "".join(files.values()).casefold()
        assert text.count("pick_place(") + text.count("pick_place;") == 3  # two calls
