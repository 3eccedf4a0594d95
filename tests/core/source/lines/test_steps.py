"""Motions that are steps: a number to jump to, tool and frame by number, arcs of two steps."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, ClassVar

import pytest

from flyby.core.dialect import Orientation
from flyby.core.errors import SourceError
from flyby.core.program.move import Move, MoveC, MoveL
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.tool import Tool
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import MotionGrammar, dialect_of
from flyby.core.source.lines.expressions import Spelling
from flyby.core.source.lines.language import LineLanguage, LineWriter
from flyby.core.source.lines.motions import MotionWords
from flyby.core.source.lines.positions import FrameRegisters, PositionForm
from flyby.core.source.reading import ReadOptions
from flyby.core.source.text.numerals import nine_decimals
from flyby.core.spatial.pose import Pose

FORM = PositionForm(Orientation.EULER_ZYX)
STEP = "MOVE {kind},{point},S={speed},T={tool}{frame}"
ROBOT: Any = None


class Grammar(MotionGrammar):
    """``S12 MOVE L,P3,S=200mm/s,T=12``"""

    form = FORM
    words = MotionWords(
        joint={"%": Amount("joint_fraction", 0.01)},
        line={"mm/s": Amount("tcp", 1e-3)},
        via=STEP + "\n",
        motion="{via}" + STEP,
    )
    kinds: ClassVar = {"P": "J"}
    paired = frozenset("c")
    joints = frozenset("A")
    registers = frozenset("V")
    frames = FrameRegisters("TOOL", "UCS")
    vectors: ClassVar = {"TOOL": 6, "UCS": 6}
    spelling = Spelling(datum=re.compile(r"(?P<word>P|V|TOOL|UCS)(?P<index>\d+)"))
    forms: ClassVar = {
        "motion": r"(?:(?P<step>S\d+)\s+)?MOVE (?P<kind>\w),(?P<point>P\d+),"
        r"S=(?P<speed>[\d.]+)(?P<unit>%|mm/s),T=(?P<tool>\d+)(?:,U=(?P<frame>\d+))?",
        "point": r"(?P<name>P\d+)=\((?P<values>.*)\)(?P<kind>[AR])",
        "assigned.frame": r"(?P<target>(?:TOOL|UCS)\d+)=\((?P<values>.*)\)",
        "assigned": r"(?P<target>V\d+)=(?P<value>.*)",
        "when": r"IF (?P<condition>.*) (?P<action>GOTO .*)",
        "jump": r"GOTO (?P<name>\S+)",
        "call": r"CALL (?P<name>\d+)",
    }


class Writer(LineWriter):
    called = "P{number}"

    def point(self, number: int, target: Target, *beside: str) -> str:
        kind = "A" if isinstance(target, JointTarget) else "R"
        return f"P{number}=({','.join(map(nine_decimals, FORM.numbers(target)))}){kind}"

    def move(self, move: Move) -> Iterator[str]:
        def declared(word: str, pose: Pose) -> Any:
            numbers = ",".join(map(nine_decimals, FORM.numbers(pose)))
            return lambda number: (f"{word}{number}=({numbers})",)

        pose = move.tool.tcp
        tool = self.numbered("TOOL", 31, pose, move.tool.name, declared("TOOL", pose))
        yield from self.motion(move, tool=tool, frame="").splitlines()

    def text(self, name: str, lines: list[str]) -> str:
        return "\n".join([*self.setup, *self.points.texts, *lines, ""])


class Language(LineLanguage):
    name, suffix = "STEP", ".job"
    grammar, writer = Grammar, Writer
    dialect = dialect_of(Grammar, "'")
    called = re.compile(r"CALL (\d+)")


POINTS = """TOOL1=(0,0,100,0,0,0)
TOOL12=(0,0,200,0,0,0)
UCS3=(10,0,0,0,0,0)
P1=(400,0,300,180,0,180)R
P2=(450,50,300,180,0,180)R
P3=(400,100,300,180,0,180)R
P4=(0,10,20,0,50,0)A
"""
ARC = "S1 MOVE L,P1,S=200mm/s,T=1\nS2 MOVE C,P2,S=%s,T=%s\nS3 MOVE C,P3,S=200mm/s,T=1\n"


def read(text: str) -> Program:
    return Language().read(POINTS + text, "1.job", ReadOptions())


def test_an_arc_of_two_steps_goes_through_the_first() -> None:
    program = read(ARC % ("200mm/s", "1"))
    line, arc = program.moves
    assert isinstance(line, MoveL) and isinstance(arc, MoveC) and not program.notes
    assert arc.via.pose.position == pytest.approx((0.45, 0.05, 0.3))
    assert arc.target.pose.position == pytest.approx((0.4, 0.1, 0.3))


def test_another_speed_of_the_first_step_is_noted_and_another_tool_refused() -> None:
    (note,) = read(ARC % ("90mm/s", "1")).notes
    assert "auxiliary point says 90 mm/s" in note.message
    with pytest.raises(SourceError, match=r"1\.job:10:.*names another tool"):
        read(ARC % ("200mm/s", "12"))
    with pytest.raises(SourceError, match="an arc has two points"):
        read("S2 MOVE C,P2,S=9mm/s,T=1\nS3 MOVE L,P3,S=9mm/s,T=1\n")
    with pytest.raises(SourceError, match=r"1\.job:8:.*an arc has no end"):
        read("S2 MOVE C,P2,S=9mm/s,T=1\n")


def test_a_motion_names_its_tool_and_its_frame() -> None:
    flange, tool, frame = read(
        "MOVE L,P1,S=9mm/s,T=0\nMOVE L,P1,S=9mm/s,T=12\nMOVE P,P4,S=9%,T=1,U=3\n"
    ).moves
    assert flange.tool.tcp == Pose() and flange.work_object.pose == Pose()
    assert tool.tool == Tool("TOOL[12]", Pose((0.0, 0.0, 0.2)))
    assert frame.tool.tcp == Pose((0.0, 0.0, 0.1)) and isinstance(frame.target, JointTarget)
    assert frame.work_object.pose == Pose((0.01, 0.0, 0.0))


def test_a_step_is_where_jumps_lead() -> None:
    text = "V1=1\nIF V1=1 GOTO S12\nS1 MOVE L,P1,S=9mm/s,T=0\nS12 MOVE L,P3,S=9mm/s,T=0\n"
    (move,) = read(text).moves
    assert move.target.name is None and move.target.pose.position[1] == pytest.approx(0.1)


def test_a_jump_to_no_label_is_noted_where_it_is_not_carried_out() -> None:
    text = "V1=1\nIF V1=2 GOTO S99\nIF V1=2 GOTO S12\nS12 MOVE L,P3,S=9mm/s,T=0\n"
    (note,) = read(text).notes
    assert "there is no label S99" in note.message and note.span.line == 9
    with pytest.raises(SourceError, match="there is no label S99"):
        read(text.replace("V1=1", "V1=2"))


def test_it_is_written_with_what_the_language_hands_over() -> None:
    program = read(ARC % ("200mm/s", "1"))
    (text,) = Language().write(program, ROBOT, {}).values()
    assert "MOVE C,P2,S=200mm/s,T=1\nMOVE C,P3,S=200mm/s,T=1\n" in text
    again = Language().read(text, "1.job", ReadOptions())
    assert [move.target.pose for move in again.moves] == [m.target.pose for m in program.moves]


@pytest.mark.parametrize(("called", "file"), [("12", "0012.job"), ("0012", "12.job")])
def test_a_number_is_the_same_with_zeros_before_it(called: str, file: str, tmp_path: Path) -> None:
    (tmp_path / "1.job").write_text(f"{POINTS}CALL {called}\n")
    (tmp_path / file).write_text("MOVE P,P4,S=9%,T=0\nP4=(0,10,20,0,50,0)A\n")
    program = Language().read_file(tmp_path / "1.job", ReadOptions())
    assert len(program.moves) == 1
