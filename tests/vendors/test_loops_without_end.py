"""Loops that go on for long: what can be read is read to its end, else it is a fault."""

from __future__ import annotations

import math
import re

import pytest

from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.limits import EndlessError

ROBOTS = {"abb": "abb/irb1600-6-145", "kuka": "kuka/kr30-3", "ur": "ur/ur10e"}
SUFFIX = {"abb": "m.mod", "kuka": "m.src", "ur": "m.script"}
FRAME = {
    "abb": "MODULE m\nVAR num n;\nVAR num k;\nPROC main()\n{}\nENDPROC\nENDMODULE\n",
    "kuka": "DEF m( )\nINT n, k\nBAS(#INITMOV,0)\nn=0\nk=0\n{}\nEND\n",
    "ur": "def m():\n  n = 0\n  k = 0\n{}\nend\n",
}
MOVE = {
    "abb": "MoveAbsJ [[k/100,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;",
    "kuka": "PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}",
    "ur": "movej([0.001*k,-1.57,1.57,-1.57,-1.57,0])",
}
WHILE = {
    "abb": "WHILE n{} DO\n{}\n{}ENDWHILE",
    "kuka": "WHILE n{}\n{}\n{}ENDWHILE",
    "ur": "while n{}:\n{}\n{}end",
}
STEP = {"abb": "n:=n{};\n", "kuka": "n=n{}\n", "ur": "n=n{}\n"}
LEAVE = {"abb": "IF n>200 GOTO out;\n", "kuka": "IF n>200 THEN\nEXIT\nENDIF\n",
         "ur": "if n>200:\nbreak\nend\n"}  # fmt: skip
FOR = {"abb": "FOR k FROM 1 TO 99999 DO\n{}\nENDFOR", "kuka": "FOR k=1 TO 99999\n{}\nENDFOR"}


def program(language: str, body: str) -> Program:
    """A program as `flyby emulate` reads it."""
    return find_vendor(language).read(
        FRAME[language].format(body),
        SUFFIX[language],
        robot=find_robot(ROBOTS[language]),
        answers=Answers(goes_on=True),
    )


def read(language: str, body: str) -> int:
    """How many moves a program has, all of which are known."""
    moves = program(language, body).moves
    assert not any(move.open for move in moves)
    return len(moves)


def loop(language: str, bound: str, step: str, more: str = "") -> str:
    behind = "\nout:" if language == "abb" and more else ""
    body = STEP[language].format(step) + more
    return WHILE[language].format(bound, MOVE[language], body) + behind


@pytest.mark.parametrize("language", ROBOTS)
@pytest.mark.parametrize(("bound", "step"), [(">-1", "+1"), ("<=5", "-1")])
def test_a_counter_that_does_not_arrive_makes_an_endless_loop(language, bound, step) -> None:
    """One pass is what a cycle is, and what stands behind the loop is never reached."""
    found = program(language, loop(language, bound, step) + "\n" + MOVE[language])
    assert len(found.moves) == 1
    assert found.cycle is not None and found.cycle.passes == 1
    assert any("endless loop" in note.message for note in found.notes)


@pytest.mark.parametrize("language", ROBOTS)
@pytest.mark.parametrize("passes", [99999, 30000])
def test_passes_that_are_too_many_are_no_part_of_a_cycle_time(language, passes) -> None:
    """One pass, what says so and what helps, and what stands behind the loop."""
    found = program(language, loop(language, f"<{passes}", "+1") + "\n" + MOVE[language])
    assert [bool(move.open) for move in found.moves] == [False, True, False]
    assert re.search(
        rf"WHILE.* has {passes - 100} passes left, with 1 moves each.*one pass is driven, and no "
        r'time is claimed for the others;.*\[passes\] "m\..*:\d+" = ',
        str(found.moves[1].open),
        re.IGNORECASE,
    )
    assert found.cycle is not None and (found.cycle.begin, found.cycle.end) == (0, 1)


@pytest.mark.parametrize("language", ROBOTS)
def test_passes_as_the_message_says_them_are_driven(language) -> None:
    body = loop(language, "<99999", "+1")
    (entry,) = re.findall(r'"(m\..*:\d+)"', str(program(language, body).moves[1].open))
    found = find_vendor(language).read(
        FRAME[language].format(body),
        SUFFIX[language],
        robot=find_robot(ROBOTS[language]),
        answers=Answers(goes_on=True, passes={entry: 7}),
    )
    assert len(found.moves) == 7 and not any(move.open for move in found.moves)


@pytest.mark.parametrize("language", ROBOTS)
def test_what_goes_on_too_long_is_refused_where_programs_do_not(language) -> None:
    with pytest.raises(EndlessError, match="99900 passes left"):
        find_vendor(language).read(
            FRAME[language].format(loop(language, "<100000", "+1")), SUFFIX[language]
        )


NESTED = {
    "abb": "WHILE n<99999 DO\nWHILE k<2 DO\n{0}\nk:=k+1;\nENDWHILE\nk:=0;\nn:=n+1;\nENDWHILE\n{0}",
    "kuka": "WHILE n<99999\nWHILE k<2\n{0}\nk=k+1\nENDWHILE\nk=0\nn=n+1\nENDWHILE\n{0}",
    "ur": "while n < 99999:\nwhile k < 2:\n{0}\nk=k+1\nend\nk=0\nn=n+1\nend\n{0}",
}
JUMP = {
    "abb": "again:\n{0}\nn:=n+1;\nIF n<99999 GOTO again;\n{0}",
    "kuka": "AGAIN:\n{0}\nn=n+1\nIF n<99999 THEN\nGOTO AGAIN\nENDIF\n{0}",
}


@pytest.mark.parametrize(
    ("language", "text", "moves"),
    [*((name, text, 2) for name, text in NESTED.items()), *((n, t, 1) for n, t in JUMP.items())],
)
def test_of_loops_in_loops_the_outer_one_is_cut_short(language, text, moves) -> None:
    found = program(language, text.format(MOVE[language]))
    assert [bool(move.open) for move in found.moves] == [False] * moves + [True, False]


PLAIN = {"abb": "FOR i FROM 1 TO {} DO\n{}\nENDFOR\n", "kuka": "FOR k=1 TO {}\n{}\nENDFOR\n",
         "ur": "while k < {}:\n{}\nk=k+1\nend\n"}  # fmt: skip
AFTER = {"abb": MOVE["abb"].replace("k/", "n/1"), "kuka": MOVE["kuka"].replace("A1 0", "A1 n/1000"),
         "ur": MOVE["ur"].replace("0.001*k", "n/1000000.0")}  # fmt: skip


@pytest.mark.parametrize("language", ROBOTS)
@pytest.mark.parametrize("passes", [150, 2500, 25000])
def test_what_loops_without_a_move_compute_is_what_the_controller_does(language, passes) -> None:
    body = PLAIN[language].format(passes, STEP[language].format("+1")) + AFTER[language]
    (move,) = program(language, body).moves
    assert isinstance(move.target, JointTarget)
    expected = passes / 1e6 if language == "ur" else math.radians(passes // 1000)
    if language == "abb":
        expected = math.radians(passes / 1100)
    assert move.target.joints[0] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("language", ["abb", "kuka"])
def test_a_loop_whose_results_are_not_computed_leaves_no_cycle_time(language) -> None:
    """Its passes are more than are read: the numbers behind it would be others."""
    body = PLAIN[language].format(900000, STEP[language].format("+1")) + AFTER[language]
    assert "what it makes of n is lost" in str(program(language, body).moves[0].open)


@pytest.mark.parametrize("language", ["abb", "kuka"])
def test_a_loop_that_only_counts_passes_time(language) -> None:
    body = PLAIN[language].format(900000, "") + MOVE[language].replace("k/100", "0")
    assert read(language, body) == 1


@pytest.mark.parametrize("passes", [2500, 900000])
def test_a_counter_of_krl_has_its_end_value_however_often_it_counts(passes) -> None:
    """It is the program's own datum; a body that does nothing but wait is not run so often."""
    move = MOVE["kuka"].replace("A1 0", "A1 k/100000.0")
    (driven,) = program("kuka", PLAIN["kuka"].format(passes, "") + move).moves
    assert isinstance(driven.target, JointTarget)
    assert driven.target.joints[0] == pytest.approx(math.radians((passes + 1) / 1e5))


@pytest.mark.parametrize("language", ROBOTS)
def test_a_production_of_thousands_of_parts_takes_the_time_of_all(language) -> None:
    """All passes of a loop that ends are in the program, however often one move is driven."""
    assert read(language, loop(language, "<2500", "+1")) == 2500


@pytest.mark.parametrize("language", ROBOTS)
def test_a_long_loop_that_ends_is_read_to_its_end(language) -> None:
    assert read(language, loop(language, "<300", "+1")) == 300


@pytest.mark.parametrize("language", ROBOTS)
def test_a_way_out_in_the_body_ends_it(language) -> None:
    """Nothing is foreseen of a loop that something else may end."""
    assert read(language, loop(language, "<99999", "+1", LEAVE[language])) == 201


FASTER = {"abb": "n:=n*1.05+1;\n", "ur": "n=n*1.05+1\n"}
LAYERS = {"abb": "k:=k+1;\nIF k MOD 150=0 THEN\nn:=n+1;\nENDIF\n",
          "kuka": "k=k+1\nIF k-150*(k/150)==0 THEN\nn=n+1\nENDIF\n",
          "ur": "k=k+1\nif k % 150 == 0:\nn=n+1\nend\n"}  # fmt: skip


@pytest.mark.parametrize("language", ROBOTS)
def test_a_counter_that_steps_unevenly_foresees_nothing(language) -> None:
    """Faster and faster, or once in a layer of 150."""
    if language in FASTER:
        body = MOVE[language].replace("k", "0"), FASTER[language]
        assert read(language, WHILE[language].format("<99999999", *body)) == 317
    body = MOVE[language].replace("k", "0"), LAYERS[language]
    assert read(language, WHILE[language].format("<3", *body)) == 450


@pytest.mark.parametrize("language", FOR)
def test_a_for_that_counts_too_far_is_cut_short(language) -> None:
    move, cut = program(language, FOR[language].format(MOVE[language])).moves
    assert not move.open and "FOR k has 99899 passes left" in str(cut.open)


def test_a_counter_of_krl_that_an_int_does_not_hold_stops_the_program() -> None:
    """What comes behind the loop is never reached."""
    move = MOVE["kuka"]
    found = program("kuka", f"{move}\nFOR k=1 TO 1e38\nn=n+1\nENDFOR\n{move}")
    assert found.moves[-1].stops and "too large for an INT" in found.moves[-1].open


@pytest.mark.parametrize(("end", "step"), [("1e38", ""), ("-1e38", " STEP -1")])
def test_an_end_of_a_for_of_krl_that_no_int_reaches_is_foreseen(end, step) -> None:
    """No pass shows to come nearer to such a number: it would be run as often as loops may."""
    body = f"FOR k=1 TO {end}{step}\n{MOVE['kuka']}\nENDFOR"
    with pytest.raises(EndlessError, match=r"has 2\.14748e\+09 passes left, with 1 moves each"):
        find_vendor("kuka").read(FRAME["kuka"].format(body), SUFFIX["kuka"])
