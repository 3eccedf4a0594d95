"""A language whose motions, points and signals are data alone: read, written, patched."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, ClassVar

import pytest

from flyby.core.dialect import Dialect, MoveWords, Orientation
from flyby.core.errors import FlybyError, SourceError
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.signal import Level, SetSignal, WaitSignal
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, ZoneKind
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import MotionGrammar
from flyby.core.source.lines.expressions import Spelling
from flyby.core.source.lines.language import LineLanguage, LineWriter
from flyby.core.source.lines.motions import MotionWords
from flyby.core.source.lines.positions import FrameRegisters, PositionForm
from flyby.core.source.lines.signals import Signals
from flyby.core.source.reading import ReadOptions
from flyby.core.source.text.numerals import nine_decimals
from flyby.core.spatial.pose import Pose

NEAR = ZoneKind("NEAR", None, largest=0.5, unit=1e-3, step=1e-3)
FORM = PositionForm(Orientation.EULER_ZYX)
POINT = r"[PJ]\d+|AT\s*\([^()]*\)"
ROBOT: Any = None


class Grammar(MotionGrammar):
    form = FORM
    words = MotionWords(
        {"%": Amount("joint_fraction", 0.01)},
        {"": Amount("tcp", 1e-3)},
        {"NEAR": NEAR},
        zone="{word} {numbers}",
        share="A{number}",
        motion="{kind}GO {via}{point} {speed} {zone} {share}",
    )
    kinds: ClassVar = {"L": "L", "R": "L"}
    chained = frozenset({"A"})
    joints = frozenset({"J"})
    inline = re.compile(r"(?P<kind>AT)\s*\((?P<values>[^()]*)\)")
    override = "OVR"
    frames = FrameRegisters("TOOL", "BASE", numbered=False)
    registers = re.compile(r"V\w*|OVR")
    outputs = frozenset({"OUT"})
    spelling = Spelling(datum=re.compile(r"(?P<word>OUT|IN)#(?P<index>\d+)"), names=True)
    driving = re.compile(r"\wGO")
    forms: ClassVar = {
        "point": r"(?P<name>(?P<kind>[PJ])\d+)\s*:\s*(?P<values>.*)",
        "motion": rf"(?P<kind>[JLCAR])GO\s+(?:(?P<via>{POINT})\s+(?={POINT}))?(?P<point>{POINT})"
        r"\s+(?P<pace>(?P<speed>[\w.]+?)(?P<unit>%?))\s+"
        r"(?P<zone>FINE|(?P<word>NEAR)\s+(?P<size>[\w.]+)(?:,(?P<behind>[\w.]+))?)"
        r"(?:\s+A(?P<share>\d+))?",
        "framed": r"(?P<word>TOOL|BASE)\s+(?:(?P<place>P\d+)|NONE|\((?P<values>.*)\))",
        "wait.for": r"WAIT\s+(?P<condition>.*=.*)",
        "wait": r"WAIT\s+(?P<time>.*)",
        "assigned": r"(?P<target>OUT#\d+|\w+)\s*=\s*(?P<value>.*)",
    }


class Writer(LineWriter):
    called = "{kind}{number}"

    def point(self, number: int, target: Target, *beside: str) -> str:
        word = "J" if isinstance(target, JointTarget) else "P"
        return f"{word}{number}: {', '.join(map(nine_decimals, FORM.numbers(target)))}"

    def text(self, name: str, lines: list[str]) -> str:
        return "\n".join([*self.setup, *self.points.texts, *lines, ""])


SPEEDS = frozenset({"tcp", "joint_fraction", "acceleration_override"})
WORDS = MoveWords((NEAR,), SPEEDS, configurations=False)
SIGNALS = Signals(
    Grammar, ("OUT",), ("IN",), written="{word}#{number}", truths={True: "1", False: "0"}
)


class Language(LineLanguage):
    name = "GO"
    suffix = ".go"
    dialect = Dialect(WORDS, WORDS, WORDS, "joint_fraction", "' ", signals=SIGNALS.dialect())
    grammar = Grammar
    writer = Writer
    trailing = "'"
    longest_name = 8
    capitals = True
    longest_comment = 6


POINTS = "J1: 0, 10, 20, 0, 50, 0\nP2: 500, 0, 300, 0, 180, 0\nP3: 500, 50, 300, 0, 180, 0\n"


def read(text: str) -> Program:
    return Language().read(POINTS + text, "job.go", ReadOptions())


def test_motions_of_all_kinds_are_read() -> None:
    program = read(
        "JGO J1 50% NEAR 20\nLGO P2 250 NEAR 20,40 A80\nCGO P3 P2 100 FINE\nRGO P3 250 FINE\n"
    )
    assert [type(move) for move in program.moves] == [MoveJ, MoveL, MoveC, MoveL]
    assert [move.speed.tcp for move in program.moves] == [None, 0.25, 0.1, 0.25]
    assert program.moves[1].speed.acceleration_override == 0.8
    assert program.moves[1].zone == replace(NEAR.sized(0.02), ratio=2.0)
    assert isinstance(program.moves[0].target, JointTarget)


def test_arcs_of_one_point_a_line_go_on_from_the_last() -> None:
    text = (
        "LGO P2 90 FINE\nAGO P2 90 FINE\nAGO P3 90 FINE\nAGO AT (540, 60, 300, 0, 180, 0) 90 FINE\n"
    )
    assert [type(move) for move in read(text).moves] == [MoveL, MoveC]
    here = "AT (500, V1, 300, 0, 180, 0) 90 FINE\n"
    moved = read(f"V1 = 0\nLGO {here}V1 = 50\nAGO {here}").moves
    assert [move.target.pose.position[1] for move in moved] == pytest.approx([0.0, 0.05])
    with pytest.raises(SourceError, match="the arc before has no end"):
        read("AGO P2 90 FINE\nAGO P3 90 FINE\nLGO P2 90 FINE\n")
    with pytest.raises(SourceError, match="an arc has two points, other motions have one"):
        read("CGO P2 90 FINE\n")


def test_positions_at_the_motion_and_an_override() -> None:
    text = "OVR = 50\nV1 = 60\nLGO AT (500, V1, 300, 0, 180, 0) 90 NEAR V1\n"
    (move,) = read(text).moves
    assert move.target.pose.position == pytest.approx((0.5, 0.06, 0.3))
    assert (move.speed.tcp, move.zone) == (pytest.approx(0.045), NEAR.sized(0.06))
    with pytest.raises(SourceError, match="a position has 6 numbers, not 2"):
        read("LGO AT (1, 2) 90 FINE\n")


def test_tools_and_frames_hold_until_others_are_set() -> None:
    text = "LGO P2 90 FINE\nTOOL (0, 0, 100, 0, 0, 0)\nLGO P2 90 FINE\nBASE P3\nLGO P2 90 FINE\n"
    moves = read(text + "TOOL NONE\nLGO P2 90 FINE\n").moves
    assert [move.tool.tcp.position[2] for move in moves] == [0.0, 0.1, 0.1, 0.0]
    frames = [move.work_object.pose.position for move in moves]
    assert frames[:2] == [(0.0, 0.0, 0.0)] * 2
    assert frames[2] == frames[3] == pytest.approx((0.5, 0.05, 0.3))
    with pytest.raises(SourceError, match="a position has 6 numbers, not 2"):
        read("TOOL (1, 2)\n")


def test_what_is_written_is_read_again() -> None:
    program = read("JGO J1 50% NEAR 20\nLGO P2 250 FINE A80\nWAIT 0.5\nLGO P2 250 NEAR 20,40\n")
    sources = Language().write(replace(program, name="a long name"), ROBOT, {})
    assert dict(sources) == {
        "A_LONG_N.go": "J1: 0, 10, 20, 0, 50, 0\nP2: 500, 0, 300, 180, 0, 180\n"
        "JGO J1 50% NEAR 20\nLGO P2 250 FINE A80\nWAIT 0.5\nLGO P2 250 NEAR 20,40\n"
    }
    assert list(Language().comment("a long one")) == ["' a long", "'  one"]
    assert Language().named("1st-job") == "P_1ST_JO"


def test_each_part_is_patched_where_it_stands() -> None:
    text = "LGO P2 250 NEAR 20,40\n"
    program = read(text)
    (move,) = program.moves
    speed = replace(move.speed, tcp=0.1)
    changes: dict[str, Any] = {
        text.replace("250", "100"): replace(move, speed=speed),
        text.replace("20,40", "10,20"): replace(
            move, zone=NEAR.sized(0.01).__class__(NEAR, 0.01, 2.0)
        ),
        text.replace("NEAR 20,40", "FINE"): replace(move, zone=FINE),
    }
    for wanted, changed in changes.items():
        files = Language().patch(program.with_moves((changed,)), ROBOT, {})
        assert files["job.go"].text == POINTS + wanted
    with pytest.raises(FlybyError, match="no share of acceleration is put in"):
        slower = replace(move, speed=replace(move.speed, acceleration_override=0.5))
        Language().patch(program.with_moves((slower,)), ROBOT, {})


def test_signals_that_are_numbers() -> None:
    words = SIGNALS.dialect()
    assert words.read("OUT#3 = 1") == SetSignal("OUT[3]", True)
    assert words.read("WAIT IN#4 = 0") == WaitSignal(Level("IN[4]", False))
    assert words.read("OUT#3 = 7") == SetSignal("OUT[3]", 7.0)
    assert words.said(SetSignal("OUT[3]", False)) == "OUT#3=0"


def test_tools_and_frames_are_numbered_and_said_once() -> None:
    writer = Writer()
    poses = [Pose((0.0, 0.0, 0.1)), Pose(), Pose((0.0, 0.0, 0.1)), Pose((0.0, 0.0, 0.2))]
    tools = [Tool("tool7", pose) for pose in poses]
    numbers = [
        writer.numbered("TOOL", 9, one.tcp, one.name, lambda n: [f"TOOL {n}"]) for one in tools
    ]
    assert numbers == [7, 0, 7, 1]
    assert writer.setup == ["TOOL 7", "TOOL 1"]
    lines = [line for n in (7, 7, 1, 7) for line in writer.changed("TOOL", f"USE {n}")]
    assert lines == ["USE 7", "USE 1", "USE 7"]
