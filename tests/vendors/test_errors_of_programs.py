"""What a controller stops a program at: in what a move is made of, and elsewhere."""

from __future__ import annotations

import pytest

import flyby
from flyby.core.errors import FaultCause, SourceError
from flyby.core.program.move import Wait
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers

ROBOTS = {"abb": "abb/irb2600-12-165", "kuka": "kuka/kr16-2", "ur": "ur/ur10e"}
EXTERNAL = ",".join(["9E9"] * 6)
TEXTS = {
    "abb": f"""MODULE m
VAR jointtarget p{{2}}:=[[[0,0,0,0,30,0],[{EXTERNAL}]],[[20,0,0,0,30,0],[{EXTERNAL}]]];
VAR num n:=7;
PERS num order:=0;
VAR num none:=0;
PROC main()
BODY
ENDPROC
ENDMODULE
""",
    "kuka": """DEF m()
DECL E6AXIS p[2]
DECL INT n,none
n=7
none=0
p[1]={A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
p[2]={A1 20,A2 -90,A3 90,A4 0,A5 30,A6 0}
BODY
END
""",
    "ur": """def m():
n = 7
none = 0
p = [[0,-1.5,1.5,0,1,0], [0.4,-1.5,1.5,0,1,0]]
BODY
end
""",
}
LINES = {
    "abb": {
        "first": "MoveAbsJ p{1},v1000,fine,tool0;",
        "second": "MoveAbsJ p{2},v1000,fine,tool0;",
        "literal": "MoveAbsJ p{3},v1000,fine,tool0;",
        "variable": "MoveAbsJ p{n},v1000,fine,tool0;",
        "division": f"MoveAbsJ [[10/none,0,0,0,30,0],[{EXTERNAL}]],v1000,fine,tool0;",
        "elsewhere": "n:=10/none;",
    },
    "kuka": {
        "first": "PTP p[1]",
        "second": "PTP p[2]",
        "literal": "PTP p[0]",
        "variable": "PTP p[n]",
        "division": "PTP {A1 10/none,A2 -90,A3 90,A4 0,A5 30,A6 0}",
        "elsewhere": "n=10/none",
    },
    "ur": {
        "first": "movej(p[0])",
        "second": "movej(p[1])",
        "literal": "movej(p[2])",
        "variable": "movej(p[n])",
        "division": "movej([10/none,-1.5,1.5,0,1,0])",
        "elsewhere": "n = 10/none",
    },
}


def read(vendor: str, *lines: str, goes_on: bool = True) -> Program:
    body = "\n".join(LINES[vendor].get(line, line) for line in lines)
    text = TEXTS[vendor].replace("BODY", body)
    name = f"m{find_vendor(vendor).suffixes[0]}"
    answers = Answers(goes_on=goes_on)
    return find_vendor(vendor).read(text, name, robot=find_robot(ROBOTS[vendor]), answers=answers)


@pytest.mark.parametrize("kind", ["literal", "variable", "division"])
@pytest.mark.parametrize("vendor", ROBOTS)
def test_in_a_moves_own_target_it_is_a_fault_behind_which_the_moves_are_driven(
    vendor: str, kind: str
) -> None:
    program = read(vendor, "first", "second", kind, "first", "second")
    run = flyby.emulate(program, robot=ROBOTS[vendor])
    (fault,) = run.faults
    assert fault.move == 2 and fault.cause is FaultCause.ERROR
    assert fault.message.endswith(": the controller stops the program here")
    assert [bool(move.open) for move in program.moves] == [False, False, True, False, False]
    with pytest.raises(SourceError):
        read(vendor, "first", kind, "second", goes_on=False)


@pytest.mark.parametrize("vendor", ROBOTS)
def test_elsewhere_it_ends_the_program(vendor: str) -> None:
    program = read(vendor, "first", "second", "elsewhere", "first")
    assert [move.stops for move in program.moves] == [False, False, True]
    assert program.moves[2].open == "division by zero: the controller stops the program here"


WAITS = {"abb": "WaitTime {};", "kuka": "WAIT SEC {}", "ur": "sleep({})"}
NO_WAIT = {
    "abb": "WaitTime of -1.5 s: the least that it takes is 0 s",
    "kuka": "WAIT SEC of -1.5 s: the program does not wait",
    "ur": "sleep of -1.5 s: there is no such time",
}


@pytest.mark.parametrize("goes_on", [True, False])
@pytest.mark.parametrize("vendor", ROBOTS)
def test_a_wait_of_a_time_below_zero_is_none_and_stops_the_robot(
    vendor: str, goes_on: bool
) -> None:
    wait = WAITS[vendor]
    program = read(vendor, "first", wait.format("-1.5"), "second", wait.format(2), goes_on=goes_on)
    waits = [one.duration for one in program.statements if isinstance(one, Wait)]
    assert waits == [0.0, 2.0] and len(program.moves) == 2
    (note,) = (note for note in program.notes if NO_WAIT[vendor] in note.message)
    text = TEXTS[vendor].partition("BODY")[0]
    assert note.span is not None and note.span.line == text.count("\n") + 2


LOOPS = {
    "abb": ("FOR i FROM {} TO {} STEP none DO", "ENDFOR"),
    "kuka": ("FOR n={} TO {} STEP none", "ENDFOR"),
}


@pytest.mark.parametrize(("bounds", "passes"), [((1, 5), 1), ((2, 2), 1), ((5, 1), 0)])
@pytest.mark.parametrize("vendor", LOOPS)
def test_a_loop_that_counts_by_nothing_is_left_with_a_note(
    vendor: str, bounds: tuple[int, int], passes: int
) -> None:
    begin, end = LOOPS[vendor]
    program = read(vendor, "first", begin.format(*bounds), "second", end, "first")
    assert len(program.moves) == 2 + passes and not any(move.open for move in program.moves)
    assert any("STEP is zero" in note.message for note in program.notes)


def test_a_handler_takes_one_of_a_move() -> None:
    program = read("abb", "first", "literal", "second", "ERROR", "TRYNEXT;")
    assert [move.stops for move in program.moves] == [False, False]


@pytest.mark.parametrize(("index", "others"), [("order", True), ("n", False)])
def test_what_others_write_an_index_into_is_told_how_to_answer(index: str, others: bool) -> None:
    program = read("abb", "first", f"MoveAbsJ p{{{index}}},v1000,fine,tool0;")
    assert ("what others write into order is said" in program.moves[1].open) == others
