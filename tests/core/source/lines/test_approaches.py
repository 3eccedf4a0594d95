"""Parts of motions that stand on lines of their own, and what is put in at one."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.dialect import Orientation
from flyby.core.errors import FlybyError
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.signal import Level, SetSignal, WaitSignal
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.program.tool import Tool, WorkObject
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import MotionGrammar, dialect_of
from flyby.core.source.lines.expressions import Spelling
from flyby.core.source.lines.language import LineLanguage, LineWriter
from flyby.core.source.lines.motions import MotionWords
from flyby.core.source.lines.positions import FrameRegisters, PositionForm
from flyby.core.source.lines.settings import Setting, Settings
from flyby.core.source.lines.signals import Signals
from flyby.core.source.reading import ReadOptions
from flyby.core.source.text.numerals import nine_decimals
from flyby.core.spatial.pose import Pose

PERCENT = {"": Amount("joint_fraction", 0.01)}
SHARE = {"": Amount("joint_acceleration_fraction", 0.01)}
FORM = PositionForm(Orientation.EULER_ZYZ)
POINT = r"(?P<point>#?[A-Z]\w*|TRANS\s*\(.*?\))"


class Grammar(MotionGrammar):
    form = FORM
    words = MotionWords({}, {}, {}, via="C1MOVE {point}\n", motion="{via}{kind}MOVE {point}")
    settings = Settings(
        (
            Setting("SPEED", PERCENT, {"MM/S": Amount("tcp", 1e-3)}, 20.0, always="ALWAYS"),
            Setting("ACCEL", SHARE, SHARE, 100.0, always="ALWAYS"),
        )
    )
    kinds: ClassVar = {"J": "J", "L": "L", "C2": "C"}
    frames = FrameRegisters(
        "TOOL", "BASE", numbered=False, said="{word} {point}", none="{word} NULL"
    )
    spelling = Spelling(names=True, name=r"#?[A-Za-z_]\w*")
    inline = re.compile(r"(?P<kind>TRANS)\s*\((?P<values>.*)\)", re.I)
    written_inline = "TRANS({numbers})", ""
    joints = frozenset({"#"})
    forms: ClassVar = {
        "motion": rf"(?P<kind>[JL])MOVE\s+{POINT}",
        "via": rf"C1MOVE\s+{POINT}",
        "motion.arc": rf"(?P<kind>C2)MOVE\s+{POINT}",
        "approach": rf"(?P<kind>[JL])APPRO\s+{POINT}\s*,\s*(?P<distance>.+)",
        "depart": r"(?P<kind>[JL])DEPART\s+(?P<distance>.+)",
        "framed": r"(?P<word>TOOL|BASE)\s+(?:NULL|(?P<place>.+))",
        "point": r"(?P<name>(?P<kind>#?)[A-Z]\w*)\s*:(?P<values>.*)",
    }


class Writer(LineWriter):
    called = "{kind}{number}"

    def name(self, target: Target, *beside: str) -> str:
        self.called = "#p{number}" if isinstance(target, JointTarget) else "p{number}"
        return super().name(target, *beside)

    def point(self, number: int, target: Target, *beside: str) -> str:
        word = "#p" if isinstance(target, JointTarget) else "p"
        return f"{word}{number}: {', '.join(map(nine_decimals, FORM.numbers(target)))}"

    def text(self, name: str, lines: list[str]) -> str:
        return "\n".join([*self.points.texts, *lines, ""])


class Language(LineLanguage):
    name = "AS"
    suffix = ".as"
    dialect = dialect_of(Grammar, "; ")
    grammar = Grammar
    writer = Writer


POINTS = "#h: 0, 10, 20, 0, 50, 0\np: 500, 0, 300, 0, 180, 0\nq: 500, 50, 300, 0, 180, 0\n"
POINTS += "r: 520, 25, 300, 0, 180, 0\n"
ROBOT: Any = None


def read(text: str) -> Program:
    return Language().read(POINTS + text, "job.as", ReadOptions())


def patched(text: str, which: int, own: bool, **changes: Any) -> str:
    program = read(text)
    moves = list(program.moves)
    moves[which] = replace(moves[which], **changes)
    options = {"shared": "own", "derived": "own"} if own else {}
    files = Language().patch(program.with_moves(tuple(moves)), ROBOT, options)
    return files["job.as"].text.removeprefix(POINTS)


def test_lines_must_state_their_speed_beside_a_share_of_acceleration() -> None:
    assert Language.dialect.line.needs == {"tcp"}


def test_an_arc_may_stand_on_two_lines() -> None:
    program = read("SPEED 200 MM/S ALWAYS\nLMOVE p\nC1MOVE r\nC2MOVE q\n")
    arc = program.moves[1]
    assert isinstance(arc, MoveC) and arc.statement is not None
    assert arc.via.pose.position == pytest.approx((0.52, 0.025, 0.3))
    assert (arc.statement.line, arc.statement.end - arc.statement.start) == (7, 17)
    text = Language().written(program, "job", _plain())
    assert "\nC1MOVE p2\nC2MOVE p3\n" in text
    assert Language().read(text, "again.as", ReadOptions()).moves[1].target == replace(
        arc.target, name=None
    )
    with pytest.raises(FlybyError, match="an arc has two points"):
        read("C1MOVE r\nLMOVE q\n")


def _plain() -> Any:
    from flyby.core.source.write.options import WriterOptions

    return WriterOptions()


def test_a_speed_of_its_own_holds_for_all_lines_of_an_arc() -> None:
    text = "SPEED 200 MM/S ALWAYS\nLMOVE p\nC1MOVE r\nC2MOVE q\nLMOVE p\n"
    own = patched(text, 1, True, speed=Speed(tcp=0.1))
    lines = ("SPEED 100 MM/S ALWAYS", "C1MOVE r", "C2MOVE q", "SPEED 200 MM/S ALWAYS", "LMOVE p")
    assert own.splitlines()[2:] == list(lines)


APPROACH = "SPEED 200 MM/S ALWAYS\nLAPPRO p, 50\nLMOVE p\n"


def test_motions_end_before_points_and_behind_where_the_robot_stands() -> None:
    moves = read("BASE r\n" + APPROACH + "LDEPART 30\nJAPPRO q, 10+5\n").moves
    assert [type(move) for move in moves] == [MoveL, MoveL, MoveL, MoveJ]
    heights = [move.target.pose.position[2] for move in moves]
    assert heights == pytest.approx([0.35, 0.3, 0.33, 0.315])
    assert len({move.work_object for move in moves}) == 1
    for text, said in (("LAPPRO #h, 5\n", "no z"), ("JMOVE #h\nLDEPART 5\n", "no pose")):
        with pytest.raises(FlybyError, match=said):
            read(text)


@pytest.mark.parametrize(
    "text", ["LAPPRO p, 50\nLMOVE p\n", "LMOVE p\nLDEPART 50\n", "LMOVE p\nLDEPART 9\nLDEPART 9\n"]
)
@pytest.mark.parametrize("own", [False, True])
@given(by=st.tuples(*[st.integers(-90, 90)] * 3))
def test_what_is_computed_of_a_point_goes_with_it(
    text: str, own: bool, by: tuple[int, int, int]
) -> None:
    """A point and what the program computes of it, changed alike: the point's numbers change."""
    program = read("SPEED 200 MM/S ALWAYS\n" + text)
    away = Pose(tuple(one / 1000 for one in by))
    moves = tuple(
        replace(move, target=replace(move.target, pose=away @ move.target.pose))
        for move in program.moves
        if isinstance(move.target, PoseTarget)
    )
    options = {"shared": "own", "derived": "own"} if own else {}
    files = Language().patch(program.with_moves(moves), ROBOT, options)
    x, y, z = (one + other for one, other in zip((500, 0, 300), by, strict=True))
    wanted = POINTS.replace("p: 500, 0, 300,", f"p: {x}, {y}, {z},")
    assert [file.text for file in files.values()] == (
        [f"{wanted}SPEED 200 MM/S ALWAYS\n{text}"] if any(by) else []
    )


def test_a_point_that_an_approach_reads_gets_a_place_of_its_own_if_asked() -> None:
    new = PoseTarget(Pose((0.51, 0.0, 0.3), FORM.pose((0, 0, 0, 0, 180, 0)).quaternion))
    own = patched(APPROACH, 1, True, target=new)
    assert own == APPROACH.replace("LMOVE p", "LMOVE TRANS(510, 0, 300, 0, 180, 0)")
    with pytest.raises(FlybyError, match="computes it from what was changed"):
        patched(APPROACH, 1, False, target=new)
    shared = "SPEED 200 MM/S ALWAYS\nLMOVE p\nLMOVE q\nLMOVE p\n"
    with pytest.raises(FlybyError, match="have the move get its own"):
        patched(shared, 0, False, target=new)
    joints = "JMOVE #h\nJMOVE q\nJMOVE #h\n"
    with pytest.raises(FlybyError, match="change them all alike, or write the program anew"):
        patched(joints, 0, False, target=JointTarget((0.1, 0.2, 0.3, 0.0, 0.5, 0.0)))


def test_tools_and_frames_are_written_as_they_are_read() -> None:
    tool = Tool("gun", Pose((0.0, 0.0, 0.1)))
    table = WorkObject("table", user=Pose((0.2, 0.0, 0.0)))
    move = MoveL(PoseTarget(Pose((0.4, 0.0, 0.3))), Speed(tcp=0.2))
    held = replace(move, tool=tool, work_object=table)
    text = Language().written(Program((move, held, held, move)), "job", _plain())
    said = [line for line in text.splitlines() if line.startswith(("TOOL", "BASE"))]
    assert said == ["TOOL NULL", "BASE NULL", "TOOL p2", "BASE p3", "TOOL NULL", "BASE NULL"]
    again = Language().read(text, "job.as", ReadOptions()).moves
    assert [m.tool.tcp for m in again] == [m.tool.tcp for m in (move, held, held, move)]


def test_inputs_may_be_counted_on_from_a_number() -> None:
    signals = Signals(
        Grammar, ("OX",), ("WX",), written="{number}", first={"WX": 1000}, switch="SIGNAL {signal}"
    )
    assert signals.said(SetSignal("OX[5]", True)) == "SIGNAL 5"
    assert signals.said(WaitSignal(Level("WX[2]", True))) == "WAIT 1002=ON"
