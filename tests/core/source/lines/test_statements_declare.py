"""A language whose points and tools are given by statements, with words before the point."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest

from flyby.core.dialect import Orientation
from flyby.core.errors import InputError, SourceError
from flyby.core.program.move import MoveC, MoveL, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.zone import FINE, VendorZone, ZoneKind
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import MotionGrammar, dialect_of
from flyby.core.source.lines.expressions import Spelling
from flyby.core.source.lines.language import LineLanguage, LineWriter
from flyby.core.source.lines.motions import MotionWords
from flyby.core.source.lines.positions import FrameRegisters, PositionForm
from flyby.core.source.lines.settings import Setting, Settings
from flyby.core.source.reading import ReadOptions
from flyby.core.source.text.numerals import nine_decimals

FASTEST = {"small": 2.0, "large": 4.0}
SHARE = Amount("tcp", lambda robot: FASTEST[robot.name] / 100)
PASS = ZoneKind("@P", None, largest=0.02, unit=1e-3, step=1e-3, sizes=(0.02,))
NEAR = ZoneKind("@", None, largest=0.5, unit=1e-3, step=1e-3)
FORM = PositionForm(Orientation.EULER_ZYX, last_first=True)
POINT = r"(?:[PJ]\d+|[PJ]\([^()]*\))"
SMALL: Any = SimpleNamespace(name="small")
LARGE: Any = SimpleNamespace(name="large")


class Grammar(MotionGrammar):
    form = FORM
    words = MotionWords(
        joint={"S": Amount("joint_fraction", 0.01)},
        line={"S": SHARE},
        zones={"@P": PASS, "@": NEAR},
        stop="@0",
        speed="{unit}={number}",
        via="{point}, ",
        motion="MOVE {kind}, {via}{zone} {point}, {speed}",
    )
    settings = Settings(
        (Setting("SPEED", {"": Amount("joint_fraction", 0.01)}, {"": SHARE}, initial=100.0),)
    )
    kinds: ClassVar = {"P": "J"}
    joints = frozenset({"J"})
    inline = re.compile(r"(?P<kind>[PJ])\((?P<values>[^()]*)\)")
    frames = FrameRegisters("TOOL", "FIELD", chosen=("CHANGETOOL", "CHANGEFIELD"))
    vectors: ClassVar = {"P": 6, "J": 6}
    registers = frozenset({"I"})
    spelling = Spelling(
        names=True, datum=re.compile(r"(?P<word>[PJI]|TOOL|FIELD)\s*(?P<index>\d+)")
    )
    driving = re.compile("MOVE")
    second = 1000.0
    forms: ClassVar = {
        "motion": r"MOVE\s+(?P<kind>[PLC]),\s*"
        rf"(?:(?P<via>{POINT}),\s*(?=@))?(?P<zone>@0|(?P<word>@P|@)(?P<size>\d+)?)\s+"
        rf"(?P<point>{POINT})(?:,\s*(?P<pace>(?P<unit>S)=(?P<speed>\w+)))?",
        "wait": r"DELAY\s+(?P<time>.*)",
        "assigned.frame": r"(?P<target>(?:TOOL|FIELD)\s+\d+),\s*P\((?P<values>.*)\)",
        "assigned.held": r"(?P<target>CHANGETOOL|CHANGEFIELD)\s+(?P<value>.*)",
        "assigned": r"(?P<target>\w+)\s*=(?P<value>.*)",
    }


class Writer(LineWriter):
    called = "{kind}{number}"
    pause = "DELAY {time}"

    def point(self, number: int, target: Target, *beside: str) -> str:
        word = "J" if isinstance(target, JointTarget) else "P"
        values = ", ".join(map(nine_decimals, FORM.numbers(target)))
        return f"{word}{number} = {word}({values})"

    def text(self, name: str, lines: list[str]) -> str:
        return "\n".join([*self.points.texts, *lines, ""])


class Language(LineLanguage):
    name, suffix = "PAC", ".pac"
    dialect = dialect_of(Grammar, "' ")
    grammar, writer = Grammar, Writer


PROGRAM = """\
P1 = P(400, 0, 300, 180, 0, 180)
P2 = P(400, 50, 300, 180, 0, 180)
MOVE L, @0 P1, S=50
SPEED 10
MOVE L, @P P2
P1 = P(420, 0, 300, 180, 0, 180)
P3 = P1
TOOL 1, P(0, 0, 100, 0, 0, 0)
CHANGETOOL 1
MOVE C, P3, @20 P(400, -50, 300, 180, 0, 180), S=25
DELAY 500
MOVE P, @0 P1
"""


def read(text: str = PROGRAM, robot: Any = SMALL) -> Program:
    return Language().read(text, "job.pac", ReadOptions(robot=robot))


def test_points_and_tools_are_what_the_statements_before_give_them() -> None:
    first, second, arc, last = read().moves
    assert first.target.pose.position == pytest.approx((0.4, 0, 0.3))
    assert second.target.pose.position == pytest.approx((0.4, 0.05, 0.3))
    assert isinstance(arc, MoveC) and arc.via.pose.position == pytest.approx((0.42, 0, 0.3))
    assert arc.target.pose.position == pytest.approx((0.4, -0.05, 0.3))
    assert last.target == arc.via
    assert first.tool.tcp.position == (0, 0, 0)
    assert (arc.tool.name, arc.tool.tcp.position) == ("TOOL[1]", (0, 0, 0.1))


def test_zones_stand_before_the_point_with_a_number_or_without() -> None:
    assert [move.zone for move in read().moves] == [
        FINE,
        VendorZone(PASS, 0.02),
        VendorZone(NEAR, 0.02),
        FINE,
    ]
    lower = read(PROGRAM.replace("@P", "@p").replace("S=", "s="))
    assert [(m.zone, m.speed) for m in lower.moves] == [(m.zone, m.speed) for m in read().moves]
    with pytest.raises(SourceError, match="a number should stand behind @"):
        read(PROGRAM.replace("@20", "@"))


def test_a_motion_may_state_its_speed_beside_a_setting_and_percent_are_the_arms_own() -> None:
    assert [move.speed.tcp for move in read().moves] == pytest.approx([1.0, 0.2, 0.5, None])
    assert [move.speed.tcp for move in read(robot=LARGE).moves] == pytest.approx(
        [2.0, 0.4, 1.0, None]
    )
    assert read().moves[-1].speed == Speed(joint_fraction=0.1)
    with pytest.raises(SourceError, match="depends on the arm: name the robot"):
        read(robot=None)


def test_waits_are_in_ms() -> None:
    assert [s.duration for s in read().statements if isinstance(s, Wait)] == [0.5]


def patched(**changes: Any) -> str:
    """The text with another part of the move of an index."""
    program = read()
    moves = list(program.moves)
    for name, new in changes.items():
        part, index = name.rsplit("_", 1)
        moves[int(index)] = replace(moves[int(index)], **{part: new})
    (file,) = Language().patch(program.with_moves(tuple(moves)), SMALL, {}).values()
    return file.text


def test_each_is_patched_where_it_stands() -> None:
    assert patched(speed_0=Speed(tcp=0.2)) == PROGRAM.replace("S=50", "S=10")
    assert patched(zone_0=VendorZone(PASS, 0.02)) == PROGRAM.replace("@0 P1, S", "@P P1, S")
    assert patched(zone_1=FINE) == PROGRAM.replace("@P P2", "@0 P2")
    assert patched(zone_1=VendorZone(NEAR, 0.01)) == PROGRAM.replace("@P P2", "@10 P2")
    assert patched(zone_2=VendorZone(NEAR, 0.03)) == PROGRAM.replace("@20", "@30")
    slower = {"speed_1": Speed(tcp=0.1), "speed_3": Speed(joint_fraction=0.05)}
    assert patched(**slower) == PROGRAM.replace("SPEED 10", "SPEED 5")
    first = read().moves[0].target
    moved = replace(first, pose=replace(first.pose, position=(0.41, 0, 0.3)))
    assert patched(target_0=moved) == PROGRAM.replace("P(400, 0", "P(410, 0", 1)


@pytest.mark.parametrize("robot", [SMALL, LARGE])
def test_what_is_written_is_read_again(robot: Any) -> None:
    program = read(robot=robot)
    moves = tuple(replace(m, tool=program.moves[0].tool) for m in program.moves)
    program = program.with_moves(moves)
    text = Language().write(program, robot, {})["main.pac"]
    assert "MOVE C, P3, @20 P4, S=25\nDELAY 500\n" in text and "@P P2, S=10" in text
    again = read(text, robot)
    for one, other in zip(program.moves, again.moves, strict=True):
        assert (one.speed, one.zone) == (other.speed, other.zone)
    with pytest.raises(InputError, match="depends on the arm"):
        Language().numbers(*_speed(program))


def _speed(program: Program) -> Any:
    from flyby.core.source.patch.uses import UseKind

    line = next(move for move in program.moves if isinstance(move, MoveL))
    return UseKind.SPEED, line.speed, line
