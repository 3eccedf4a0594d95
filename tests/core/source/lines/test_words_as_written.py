"""A language is written as its authors write it, and read in upper and lower case."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.dialect import Orientation
from flyby.core.errors import FlybyError, PluginFault
from flyby.core.program.move import Move, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.signal import Level, SetSignal, WaitSignal
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.zone import ZoneKind
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import MotionGrammar, dialect_of
from flyby.core.source.lines.expressions import Spelling
from flyby.core.source.lines.forms import Found
from flyby.core.source.lines.language import LineLanguage, LineWriter
from flyby.core.source.lines.motions import MotionWords
from flyby.core.source.lines.positions import FrameRegisters, PositionForm
from flyby.core.source.lines.program import Said
from flyby.core.source.lines.settings import Setting, Settings
from flyby.core.source.lines.signals import Signals
from flyby.core.source.lines.statements import Line
from flyby.core.source.reading import ReadOptions
from flyby.core.source.text.numerals import nine_decimals

FORM = PositionForm(Orientation.EULER_ZYX)
ROBOT: Any = None
NEAR = {"": Amount("zone", 1e-3)}


class Grammar(MotionGrammar):
    form = FORM
    words = MotionWords(motion="{kind} {via}{point}")
    settings = Settings(
        (
            Setting("Share", {"": Amount("joint_fraction", 0.01)}, {}, 100.0),
            Setting("Pace", {}, {"": Amount("tcp", 1e-3)}, 10.0),
            Setting("Near", NEAR, NEAR, 0.0, words={"off": (0.0,)}),
        ),
        zone=ZoneKind("Near", None, largest=0.5, unit=1e-3, step=1e-3),
    )
    kinds: ClassVar = {"Go": "J", "Line": "L"}
    joints = frozenset({"j"})
    override = "Part"
    registers = re.compile(r"n\w*")
    initial: ClassVar = {("Part", None): 100.0}
    frames = FrameRegisters("Tool", numbered=False, said="{word} {point}", none="{word} none")
    outputs = frozenset({"Out"})
    spelling = Spelling(
        names=True, datum=re.compile(r"(?P<word>Out|In)\((?P<index>\d+)\)", re.IGNORECASE)
    )
    forms: ClassVar = {
        "point": r"(?P<name>(?P<kind>[PJ])\d+)\s*:\s*(?P<values>.*)",
        "motion": r"(?P<kind>Go|Line|Other)\s+(?P<point>\w+)(?P<options>\s.*)?",
        "framed": r"(?P<word>Tool)\s+(?:(?P<place>P\d+)|none)",
        "wait": r"Wait\s+(?P<condition>.*)",
        "assigned.part": r"(?P<target>Part)\s+(?P<value>.*)",
        "assigned": r"(?P<target>Out\(\d+\)|n\w*)\s*=\s*(?P<value>.*)",
    }

    def motion(self, line: Line, found: Found) -> Said:
        self.options(line, found, "options", re.compile(r"slowly|softly"))
        return self.drive(line, found)


class Writer(LineWriter):
    called = "{kind}{number}"

    def point(self, number: int, target: Target, *beside: str) -> str:
        word = "J" if isinstance(target, JointTarget) else "P"
        return f"{word}{number}: {', '.join(map(nine_decimals, FORM.numbers(target)))}"

    def text(self, name: str, lines: list[str]) -> str:
        return "\n".join([*self.points.texts, *lines, ""])


SIGNALS = Signals(
    Grammar,
    digital=("Out",),
    inputs=("In",),
    written="{word}({number})",
    first={"In": 100},
    switch="{signal} = {value}",
    level="{signal} = {value}",
    wait="Wait {condition}",
    truths={True: "1", False: "0"},
)


class Language(LineLanguage):
    name, suffix = "MIXED", ".mixed"
    grammar, writer = Grammar, Writer
    dialect = dialect_of(Grammar, "; ", work_objects=False, signals=SIGNALS.dialect())


TEXT = """\
P1: 0, 0, 100, 0, 0, 0
J2: 0, 10, 20, 0, 50, 0
P3: 400, 0, 300, 180, 0, 90
Tool P1
Share 50
Near 20
Go J2
Pace 200
Near off
Line P3
Out(3) = 1
"""


def read(text: str) -> Program:
    return Language().read(text, "job.mixed", ReadOptions())


def patched(program: Program, moves: tuple[Move, ...]) -> str:
    (source,) = Language().patch(program.with_moves(moves), ROBOT, {}).values()
    return source.text


def test_words_are_written_as_they_are_given() -> None:
    (text,) = Language().write(read(TEXT), ROBOT, {}).values()
    assert text == TEXT


@pytest.mark.parametrize("change", [str.upper, str.lower, str.swapcase])
def test_upper_and_lower_case_are_the_same(change: Any) -> None:
    program, other = read(TEXT), read(change(TEXT))
    bare = [replace(move, origin=None) for move in program.moves]
    assert [replace(move, origin=None) for move in other.moves] == bare
    assert bare[0].tool.tcp.position == (0.0, 0.0, 0.1)
    assert isinstance(bare[0], MoveJ) and isinstance(bare[1], MoveL)


def test_signals_are_called_in_capitals_and_written_as_given() -> None:
    words = SIGNALS.dialect()
    for action, text in (
        (SetSignal("OUT[3]", False), "Out(3) = 0"),
        (WaitSignal(Level("IN[4]", True)), "Wait In(104) = 1"),
    ):
        assert words.said(action) == text
    assert words.read("oUt(3) = 0") == SetSignal("OUT[3]", False)
    assert words.spelt("in(4)") == "IN[4]"
    assert words.example(SetSignal("OUT[3]", True)) == "OUT[?]"


def test_a_kind_of_motion_that_is_none_is_named() -> None:
    with pytest.raises(FlybyError, match=r"job\.mixed:2:1.*OTHER is no kind of motion"):
        read("J1: 0, 0, 0, 0, 0, 0\nOther J1\n")


def test_options_stand_behind_any_number_of_blanks() -> None:
    program = read("J1: 0, 0, 0, 0, 0, 0\nGo J1   slowly  softly\n")
    assert len(program.moves) == 1
    with pytest.raises(FlybyError, match="'slow' is not known"):
        read("J1: 0, 0, 0, 0, 0, 0\nGo J1 softly slow\n")


@given(
    part=st.integers(1, 100),
    share=st.integers(1, 100),
    pace=st.integers(1, 2000),
    percent=st.integers(1, 100),
)
def test_an_override_is_on_the_speeds_of_settings(
    part: int, share: int, pace: int, percent: int
) -> None:
    text = f"J1: 0, 0, 0, 0, 0, 0\nP2: 400, 0, 300, 180, 0, 90\nPart {part}\nShare {share}\n"
    program = read(f"{text}Go J1\nPace {pace}\nLine P2\n")
    first, second = program.moves
    assert first.speed.joint_fraction == pytest.approx(part * share / 1e4)
    assert second.speed.tcp == pytest.approx(part * pace / 1e5)
    assert second.speed.joint_fraction == 1.0
    # What is patched is the setting's number, below the override.
    slower = replace(second.speed, tcp=second.speed.tcp * percent / 100)
    if percent < 100:
        lines = patched(program, (first, replace(second, speed=slower))).splitlines()
        assert float(lines[5].removeprefix("Pace ")) == pytest.approx(pace * percent / 100)
        assert lines[:5] == f"{text}Go J1".splitlines()


def test_with_an_override_of_nothing_the_robot_stands_still() -> None:
    with pytest.raises(FlybyError, match="override of 0 %"):
        read("J1: 0, 0, 0, 0, 0, 0\nPart 0\nGo J1\n")


def test_what_a_generator_fails_at_is_named_where_it_fails() -> None:
    class Failing(Writer):
        def move(self, move: Move) -> Any:
            yield next(iter(()))

    language = Language()
    language.writer = Failing  # type: ignore[assignment]
    with pytest.raises(PluginFault, match=r"StopIteration: , .*test_words_as_written\.py"):
        language.write(read(TEXT), ROBOT, {})
