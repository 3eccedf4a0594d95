"""What the writers write is what the manuals' grammars and checks take."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from flyby.testing.checks.subject import Subject

from ..words import AbbWords, KukaWords, UrWords
from .check import checks

PROGRAMS = settings(
    max_examples=40,
    deadline=None,
    phases=set(Phase) - {Phase.shrink},
    suppress_health_check=list(HealthCheck),
)


@pytest.mark.parametrize("words", [AbbWords(), KukaWords(), UrWords()], ids=lambda w: w.name)
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
