"""Settings that hold: read, patched where they stand, and put in for one move."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.dialect import Dialect, MoveWords, Orientation
from flyby.core.errors import FlybyError, SourceError
from flyby.core.program.move import Move, Wait
from flyby.core.program.program import Program
from flyby.core.program.zone import FINE, Radius
from flyby.core.source.execution.answers import Answers
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.analysis import unsaid
from flyby.core.source.lines.driving import MotionGrammar
from flyby.core.source.lines.expressions import Operation, Spelling, Truth, parse, parse_all
from flyby.core.source.lines.forms import Found
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.lines.moves import made_move
from flyby.core.source.lines.positions import PositionForm
from flyby.core.source.lines.program import Said, plain_lines
from flyby.core.source.lines.settings import Setting, Settings
from flyby.core.source.lines.statements import Drive, Line, NumberedPoint, Numbers, Situation
from flyby.core.source.patch.uses import UseKind
from flyby.core.source.reading import ReadOptions
from flyby.core.source.text.files import SourceText

MM = {"": Amount("zone", 1e-3)}
HELD = Settings(
    (
        Setting(
            "SPEED",
            {"": Amount("joint_fraction", 0.01)},
            {"MM/S": Amount("tcp", 1e-3), "": Amount("tcp", 0.02)},
            10.0,
            always="ALWAYS",
        ),
        Setting("ACCEL", *[{"": Amount("acceleration_override", 0.01)}] * 2, 100.0, sign=" := "),
        Setting("ACCURACY", MM, MM, 1.0, always="ALWAYS"),
    )
)
SPEEDS = frozenset({"tcp", "joint_fraction", "acceleration_override"})
WORDS = MoveWords((Radius,), SPEEDS, configurations=False)
FORM = PositionForm(Orientation.EULER_ZYZ)


class Grammar(MotionGrammar):
    """Named points, moves without a number of their own, all kinds of loops."""

    form = FORM

    registers = frozenset({"N", "X"})
    settings = HELD
    spelling = Spelling(
        names=True,
        signs={"==": "="},
        truths={"TRUE": True, "FALSE": False},
        functions={
            "SIG": lambda span, given: Operation(span, "NOT", given) if given else Truth(span, True)
        },
    )
    driving = re.compile("[JL]MOVE")
    forms: ClassVar = {
        "motion": r"(?P<kind>[JL])MOVE\s+(?P<point>\w+)",
        "point": r"POINT\s+(?P<name>\w+)\s*=\s*(?P<numbers>.*)",
        "repeated": r"WHILE\s+(?P<condition>.*)",
        "repeated.plain": r"REPEAT",
        "until": r"UNTIL\s+(?P<condition>.*)",
        "selected": r"SELECT\s+(?P<datum>\w+)",
        "case": r"CASE\s+(?P<value>.*)|ELSE",
        "closed": r"END",
        "wait": r"WAIT\s+(?P<time>.*)",
        "both": r"TWICE\s+(?P<time>.*)",
        "assigned": r"(?P<target>\w+)\s*=\s*(?P<value>[^=].*)",
    }

    def motion(self, line: Line, found: Found) -> Said:
        def build(
            target: Numbers, speed: Numbers, zone: Numbers, via: Numbers, now: Situation
        ) -> Move:
            goal = FORM.target(target, False, name=found["point"])
            now.note("tools are not known here")
            pace = HELD.speed(speed, joint=found["kind"] == "J")
            return made_move(found["kind"], goal, pace, HELD.zone_of(zone))

        speed, zone = (HELD.operand(line.span, kind) for kind in (UseKind.SPEED, UseKind.ZONE))
        return Drive(line.span, self.point_at(line, found, "point"), speed, zone, build)

    def point(self, line: Line, found: Found) -> Said:
        numbers = parse_all(line.source, *found.span("numbers"), self.spelling)
        return NumberedPoint(line.span, self.datum(line, found, "name"), numbers)

    def both(self, line: Line, found: Found) -> Said:
        return [self.wait(line, found)] * 2


class Language(LineLanguage):
    """Without a writer."""

    name = "HOLD"
    suffix = ".hold"
    dialect = Dialect(WORDS, WORDS, WORDS, "joint_fraction", "; ")
    grammar = Grammar


POINTS = "POINT a = 500, 0, 300, 0, 180, 0\nPOINT b = 500, 50+50, 300, 0, 180, 0\n"
ROBOT: Any = None


def read(text: str, **values: float) -> Program:
    options = ReadOptions(answers=Answers(values={k: float(v) for k, v in values.items()}))
    return Language().read(POINTS + text, "job.hold", options)


def waits(text: str, **values: float) -> list[float]:
    return [s.duration for s in read(text, **values).statements if isinstance(s, Wait)]


def patched(text: str, change: Callable[[int, Move], Move], **options: str) -> str:
    program = read(text)
    moves = tuple(change(k, move) for k, move in enumerate(program.moves))
    files = Language().patch(program.with_moves(moves), ROBOT, options)
    return files["job.hold"].text.removeprefix(POINTS) if files else text


def faster(*which: int, by: float = 2.0) -> Callable[[int, Move], Move]:
    def change(k: int, move: Move) -> Move:
        if k not in which:
            return move
        speed = move.speed
        numbers = {
            n: by * v
            for n in ("tcp", "joint_fraction")
            if (v := getattr(speed, n)) and (n == "tcp" or speed.tcp is None)
        }
        return replace(move, speed=replace(speed, **numbers))

    return change


def test_a_setting_holds_for_one_move_or_until_it_is_set_again() -> None:
    text = "SPEED 200 MM/S ALWAYS\nLMOVE a\nSPEED 50 MM/S\nACCURACY 0\nLMOVE b\nLMOVE a\n"
    program = read("LMOVE b\n" + text + "accel := 40\nJMOVE b\nSPEED 5 ALWAYS\nJMOVE a")
    tcp = [move.speed.tcp for move in program.moves[:4]]
    assert tcp == pytest.approx([0.2, 0.2, 0.05, 0.2])
    zones = [move.zone for move in program.moves[:4]]
    assert zones == [Radius(0.001, 0.001, 0.001)] * 2 + [FINE] + [Radius(0.001, 0.001, 0.001)]
    assert program.moves[-1].speed.joint_fraction == 0.05
    assert [m.speed.acceleration_override for m in program.moves[-3:]] == [1.0, 0.4, 0.4]
    assert len([n for n in program.notes if "tools are not known" in n.message]) == 1


def test_numbers_are_patched_where_they_stand_in_their_own_unit() -> None:
    text = "SPEED 30 ALWAYS\nACCURACY 4 ALWAYS\nLMOVE a\nLMOVE b\nSPEED 60 MM/S\nLMOVE a\n"
    assert patched(text, faster(0, 1)) == text.replace("SPEED 30", "SPEED 60")
    assert patched(text, faster(2, by=0.5)) == text.replace("60 MM/S", "30 MM/S")
    wide = patched(text, lambda _, m: replace(m, zone=Radius(0.007).with_one_distance()))
    assert wide == text.replace("ACCURACY 4", "ACCURACY 7")


def test_a_number_that_goes_through_a_register_is_patched_at_its_source() -> None:
    text = "x = 25\nSPEED x ALWAYS\nLMOVE a\nLMOVE b\n"
    assert patched(text, faster(0, 1)) == text.replace("25", "50")
    computed = "x = 20 + 5\nSPEED x ALWAYS\nLMOVE a\n"
    with pytest.raises(FlybyError, match="no literal in its files states it"):
        patched(computed, faster(0))


def test_one_move_of_several_gets_a_setting_of_its_own_if_asked() -> None:
    text = "SPEED 30 ALWAYS\nACCEL := 80\n  LMOVE a\n  LMOVE b\n  LMOVE a\n"
    with pytest.raises(FlybyError, match="is read by move"):
        patched(text, faster(1))
    own = patched(text, faster(1), shared="own")
    assert own.splitlines()[3:6] == ["  SPEED 1200 MM/S", "  LMOVE b", "  LMOVE a"]

    def gentler(k: int, move: Move) -> Move:
        speed = replace(move.speed, acceleration_override=0.2 if k == 1 else 0.8)
        return replace(move, speed=speed)

    own = patched(text, gentler, shared="own")
    wanted = ["  LMOVE a", "  ACCEL := 20", "  LMOVE b", "  ACCEL := 80", "  LMOVE a"]
    assert own.splitlines()[2:] == wanted

    def both(k: int, move: Move) -> Move:
        return replace(faster(1)(k, move), zone=FINE if k == 1 else move.zone)

    assert "  ACCURACY 0\n" in patched(text, both, shared="own", derived="own")


@given(st.floats(0.01, 1.0), st.floats(0.001, 0.05), st.integers(0, 2))
def test_what_is_said_before_a_move_is_read_again(tcp: float, size: float, which: int) -> None:
    program = read("LMOVE a\nLMOVE b\nLMOVE a\n")
    moves = list(program.moves)
    zone = Radius(round(size, 6)).with_one_distance()
    speed = replace(moves[which].speed, tcp=round(tcp, 6), acceleration_override=0.5)
    moves[which] = replace(moves[which], speed=speed, zone=zone)
    said: dict[str, str] = {}
    lines: list[str] = []
    for move in moves:
        lines += [*HELD.lines(move, said), f"LMOVE {move.target.name}"]
    again = read("\n".join(lines)).moves
    for one, other in zip(moves, again, strict=True):
        assert other.speed.tcp == pytest.approx(one.speed.tcp)
        assert other.speed.acceleration_override == one.speed.acceleration_override
        assert getattr(other.zone, "tcp", 0.0) == pytest.approx(getattr(one.zone, "tcp", 0.0))


def test_a_language_knows_its_own_texts() -> None:
    assert Language().recognises(POINTS + "SPEED 30 ALWAYS\nLMOVE a\nPRINT 3\n")
    assert not Language().recognises("MODULE job\nMoveJ p1,v100,fine,tool0;\nENDMODULE\nWAIT 3")
    assert not Language().recognises("")


def test_settings_that_code_depends_on_are_found_in_the_text() -> None:
    text = "SPEED 30 ALWAYS\n  LMOVE a\nx = 1\naccel := 5\n"
    found = list(unsaid(HELD, re.compile("[JL]MOVE"))(text))
    assert [(one.datum, one.given) for one in found] == [
        ("SPEED", True),
        ("SPEED", False),
        ("ACCEL", False),
        ("ACCURACY", False),
        ("ACCEL", True),
    ]
    assert text[found[1].start : found[1].end] == "LMOVE a"


def test_nobody_knows_a_setting_that_is_not_said() -> None:
    unknown = replace(HELD, settings=(replace(HELD.settings[0], initial=None),))

    class Unset(Grammar):
        settings = unknown

    class Other(Language):
        grammar = Unset

    with pytest.raises(SourceError, match="SPEED"):
        Other().read(POINTS + "LMOVE a\n", "job.hold", ReadOptions())


def test_loops_cases_and_several_statements_on_a_line() -> None:
    assert waits("n = 0\nWHILE n < 3\nWAIT n\nn = n + 1\nEND") == [0, 1, 2]
    assert waits("n = 5\nWHILE n < 3\nWAIT n\nEND\nWAIT 9") == [9]
    assert waits("n = 5\nREPEAT\nWAIT n\nn = n + 1\nUNTIL n > 6") == [5, 6]
    assert waits("TWICE 2") == [2, 2]
    for n, then in ((1, 1), (2, 4), (3, 9)):
        text = f"n = {n}\nSELECT n\nCASE 1\nWAIT 1\nCASE 2\nWAIT 4\nELSE\nWAIT 9\nEND"
        assert waits(text) == [then]
    with pytest.raises(SourceError, match="unknown point 'NOWHERE'"):
        read("JMOVE nowhere\n")
    with pytest.raises(SourceError, match="it may move the robot"):
        read("JMOVE a b\n")


def test_other_spellings_of_expressions() -> None:
    def value(text: str, spelling: Spelling) -> Any:
        return parse(SourceText(text, "x"), 0, len(text), spelling)

    own = Spelling(datum=re.compile(r"(?P<word>[BI]|OT)#?\(?(?P<index>\d+)\)?"))
    found = value("B012 = 3 AND OT#(7)", own)
    comparison, signal = found.operands
    assert (comparison.operands[0].word, comparison.operands[0].index.value) == ("B", 12)
    assert (signal.word, signal.index.value) == ("OT", 7)
    named = value("count == 3", Grammar.spelling)
    assert (named.word, named.operands[0].word) == ("=", "COUNT")
    assert value("SIG(TRUE)", Grammar.spelling).word == "NOT"
    with pytest.raises(SourceError, match="COUNT has no index"):
        value("count", Spelling())


def test_comments_behind_statements_are_none_of_them() -> None:
    def said(text: str, sign: str) -> list[str]:
        return [line.text for line in plain_lines(SourceText(text, "x"), sign)]

    text = 'GO a ; there\n; nothing\nSAY "a; b" ; c\nSAY \'d;e\'\nSAY "open ; x\n'
    assert said(text, ";") == ["GO a", 'SAY "a; b"', "SAY 'd;e'", 'SAY "open']
    assert said("GO a ' there\nSAY \"it's\" 'x", "'") == ["GO a", 'SAY "it\'s"']
    assert said("a; b\n", "") == ["a; b"]


def test_what_may_move_the_robot_is_no_case_without_a_value() -> None:
    with pytest.raises(SourceError, match="a case with a value should stand first"):
        read("SELECT n\nELSE\nWAIT 1\nEND\n")
    assert read("SELECT n\nEND\nWAIT 1\n", n=1.0).statements
