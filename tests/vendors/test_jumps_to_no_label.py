"""Jumps to labels that there are not: controllers refuse such a program when they load it."""

from __future__ import annotations

import pytest

from flyby.core.errors import FaultCause, ParseError, SourceError
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers

EXTERNAL = ",".join(["9E9"] * 6)
ROBOTS = {"abb": "abb/irb2600-12-165", "kuka": "kuka/kr16-2"}
MOVES = {
    "abb": f"MoveAbsJ [[{{0}},0,0,0,30,0],[{EXTERNAL}]],v1000,fine,tool0;",
    "kuka": "PTP {{A1 {0},A2 -90,A3 90,A4 0,A5 30,A6 0}}",
}
TEXTS = {
    "abb": "MODULE m\nPROC main()\nVAR num n:=0;\n{0}\nENDPROC\nENDMODULE\n",
    "kuka": "DEF m()\nINT n\nn=0\n{0}\nEND\n",
}
JUMP = {"abb": "GOTO {0};", "kuka": "GOTO {0}"}
IF = {"abb": "IF n={0} THEN\n{1}\nENDIF", "kuka": "IF n=={0} THEN\n{1}\nENDIF"}


def read(vendor: str, *lines: str, goes_on: bool = True) -> Program:
    text = TEXTS[vendor].format("\n".join(lines))
    answers = Answers(goes_on=goes_on, mends=goes_on)
    name = f"m{find_vendor(vendor).suffixes[0]}"
    return find_vendor(vendor).read(text, name, robot=find_robot(ROBOTS[vendor]), answers=answers)


def jump(vendor: str, label: str, n: int) -> str:
    return IF[vendor].format(n, JUMP[vendor].format(label))


def moves(vendor: str, *joints: int) -> list[str]:
    return [MOVES[vendor].format(angle) for angle in joints]


@pytest.mark.parametrize("vendor", TEXTS)
def test_one_that_is_not_carried_out_is_damage(vendor: str) -> None:
    first, second = moves(vendor, 0, 20)
    program = read(vendor, first, jump(vendor, "gone", 1), second)
    assert len(program.moves) == 2 and not any(move.open for move in program.moves)
    (note,) = (note for note in program.notes if note.damage)
    assert "there is no label gone" in note.message and note.span is not None
    assert note.span.line == {"abb": 6, "kuka": 6}[vendor]
    with pytest.raises(ParseError, match="there is no label gone"):
        read(vendor, first, jump(vendor, "gone", 1), second, goes_on=False)


@pytest.mark.parametrize("vendor", TEXTS)
def test_one_that_is_carried_out_ends_the_program_with_a_fault(vendor: str) -> None:
    first, second, third = moves(vendor, 0, 20, 40)
    program = read(vendor, first, second, jump(vendor, "gone", 0), third)
    assert [bool(move.open) for move in program.moves] == [False, False, True]
    assert program.moves[2].stops and "there is no label gone" in program.moves[2].open


@pytest.mark.parametrize("vendor", TEXTS)
def test_nothing_that_was_driven_is_refused(vendor: str) -> None:
    with pytest.raises(SourceError, match="there is no label gone"):
        read(vendor, JUMP[vendor].format("gone"), *moves(vendor, 0))


@pytest.mark.parametrize("vendor", TEXTS)
def test_a_label_inside_of_another_block_is_none(vendor: str) -> None:
    """Nothing jumps into a block; out of one, to a label round it, a jump may."""
    within = IF[vendor].format(0, "inner:")
    program = read(vendor, *moves(vendor, 0, 20), within, jump(vendor, "inner", 1))
    assert any("no label inner" in note.message for note in program.notes)
    inside = IF[vendor].format(0, jump(vendor, "end_", 0))
    program = read(vendor, *moves(vendor, 0), inside, *moves(vendor, 20), "end_:")
    assert len(program.moves) == 1 and not any(note.damage for note in program.notes)


def test_the_fault_says_that_it_is_the_programs_own() -> None:
    import flyby

    lines = [*moves("abb", 0, 20), JUMP["abb"].format("gone")]
    run = flyby.emulate(read("abb", *lines), robot=ROBOTS["abb"])
    (fault,) = run.faults
    assert fault.cause is FaultCause.ERROR and fault.span is not None and fault.span.line == 6
