"""Loops without an end that a state drives: a cycle is all passes until the state comes back."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers

ROBOTS = {"abb": "abb/irb1600-6-145", "kuka": "kuka/kr30-3", "ur": "ur/ur10e"}
FILE = {"abb": "m.mod", "kuka": "m.src", "ur": "m.script"}
FRAME = {
    "abb": (
        "MODULE m\nVAR num s:={first};\nVAR num n:=0;\nVAR bool b;\nPROC main()\n{loop}"
        "ENDPROC\nPROC other()\n{other}ENDPROC\nPROC go(num k)\nMoveAbsJ [[k,0,0,0,30,0],"
        "[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\nENDPROC\nENDMODULE\n"
    ),
    "kuka": (
        "DEF m()\nDECL INT s,n\nDECL BOOL b\nBAS(#INITMOV,0)\ns={first}\nn=0\n{loop}END\n"
        "DEF other()\n{other}END\n"
        "DEF go(k:IN)\nINT k\nDECL E6AXIS a\na={{A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}}\na.A1=k\n"
        "PTP a\nEND\n"
    ),
    "ur": (
        "def m():\ndef other():\n{other}end\ndef go(k):\nmovej([d2r(k),-1.57,1.57,-1.57,-1.57,0])\n"
        "end\ns={first}\nn=0\n{loop}end\n"
    ),
}
LOOP = {
    "abb": "WHILE TRUE DO\n{0}ENDWHILE\n",
    "kuka": "LOOP\n{0}ENDLOOP\n",
    "ur": "while True:\n{0}end\n",
}
JUMP = {
    "abb": "again:\n{0}GOTO again;\n",
    "kuka": "AGAIN:\n{0}GOTO AGAIN\n",
}
UNTIL = {
    "abb": "WHILE s<>99 DO\n{0}ENDWHILE\n",
    "kuka": "WHILE s<>99\n{0}ENDWHILE\n",
    "ur": "while s != 99:\n{0}end\n",
}
MOVE = {
    "abb": "MoveAbsJ [[{0},0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\n",
    "kuka": "PTP {{A1 {0},A2 -90,A3 90,A4 0,A5 30,A6 0}}\n",
    "ur": "movej([d2r({0}),-1.57,1.57,-1.57,-1.57,0])\n",
}
IF = dict.fromkeys(("abb", "kuka"), "IF {0} THEN\n{1}ENDIF\n") | {"ur": "if {0}:\n{1}end\n"}
SET = {"abb": "{0}:={1};\n", "kuka": "{0}={1}\n", "ur": "{0}={1}\n"}
CALL = {"abb": "other;\n", "ur": "other()\n"}
GO = {"abb": "go {0};\n", "kuka": "go({0})\n", "ur": "go({0})\n"}
BOTH = dict.fromkeys(("abb", "kuka"), "AND") | {"ur": "and"}
EQUAL = {"abb": "=", "kuka": "==", "ur": "=="}


def step(language: str, at: int, next_: int, what: str) -> str:
    """What is done in a state: once in a pass, as a later state of the same pass is another's."""
    return IF[language].format(
        f"n{EQUAL[language]}0 {BOTH[language]} s{EQUAL[language]}{at}",
        what + SET[language].format("s", next_) + SET[language].format("n", 1),
    )


def read(
    language: str,
    body: str,
    first: int = 0,
    other: str = "",
    cycles: int = 1,
    before: str = "",
    loop: dict[str, str] = LOOP,
    closes: bool = False,
) -> Program:
    body = before + loop[language].format(SET[language].format("n", 0) + body)
    other = other or SET[language].format("n", "n")
    return find_vendor(language).read(
        FRAME[language].format(first=first, loop=body, other=other),
        FILE[language],
        robot=find_robot(ROBOTS[language]),
        answers=Answers(goes_on=True, cycles=cycles, closes=closes),
    )


def places(program: Program) -> list[int]:
    """The numbers that the moves of a program have been given."""
    targets = [move.target for move in program.moves]
    return [
        round(t.joints[0] * 180 / 3.141592653589793) for t in targets if isinstance(t, JointTarget)
    ]


@pytest.mark.parametrize("language", ROBOTS)
@given(data=st.data())
def test_a_cycle_is_all_states_until_the_first_comes_back(language, data) -> None:
    count = data.draw(st.integers(2, 5))
    order = data.draw(st.permutations(range(count)))
    after = dict(zip(order, (*order[1:], order[0]), strict=True))
    idle = data.draw(st.sets(st.sampled_from(order), max_size=count - 1))
    body = "".join(
        step(language, k, after[k], "" if k in idle else MOVE[language].format(k + 1))
        for k in range(count)
    )
    first = next(k for k in order if k not in idle)  # a loop that begins idle may wait for others
    program = read(language, body, first)
    start = order.index(first)
    driven = [k + 1 for k in (*order[start:], *order[:start]) if k not in idle]
    assert places(program) == driven
    cycle = program.cycle
    assert cycle is not None and (cycle.begin, cycle.end) == (0, len(driven))
    if len(driven) > 1:
        assert cycle.passes == cycle.length == count


@pytest.mark.parametrize("language", ROBOTS)
def test_what_is_done_once_before_is_no_part_of_the_cycle(language) -> None:
    states = (9, 1), (1, 2), (2, 1)
    body = "".join(step(language, a, b, MOVE[language].format(a)) for a, b in states)
    program = read(language, body, 9)
    assert places(program) == [9, 1, 2]
    assert program.cycle is not None
    assert (program.cycle.begin, program.cycle.length, program.cycle.passes) == (1, 2, 3)


@pytest.mark.parametrize("language", ["abb", "ur"])
def test_states_of_routines_count(language) -> None:
    other = step(language, 0, 1, MOVE[language].format(1))
    other += step(language, 1, 0, MOVE[language].format(2))
    assert places(read(language, CALL[language], 0, other)) == [1, 2]


@pytest.mark.parametrize("language", ROBOTS)
def test_one_without_states_has_one_pass(language) -> None:
    body = MOVE[language].format(1) + SET[language].format("s", "s+1")
    body += IF[language].format("s>0", MOVE[language].format(2))
    program = read(language, body)
    assert places(program) == [1, 2]
    assert program.cycle is not None and program.cycle.length == 1


@pytest.mark.parametrize("language", ROBOTS)
def test_a_service_now_and_then_is_no_state(language) -> None:
    """A pass more is read, in which it might have come; the cycle is one pass."""
    body = MOVE[language].format(1) + SET[language].format("s", "s+1")
    body += IF[language].format("s>50", MOVE[language].format(2))
    program = read(language, body)
    assert places(program) == [1, 1]
    cycle = program.cycle
    assert cycle is not None and (cycle.begin, cycle.end, cycle.length) == (1, 2, 1)


@pytest.mark.parametrize("language", ROBOTS)
def test_parts_that_are_counted_are_a_cycle_once_nothing_new_comes(language) -> None:
    """A pass more is read, to see that."""
    body = SET[language].format("s", "s+1")
    for bound, at in ((2, 1), (3, 2)):
        inner = MOVE[language].format(at) + SET[language].format("n", 1)
        condition = f"s<{bound} {'and' if language == 'ur' else 'AND'} n{EQUAL[language]}0"
        body += IF[language].format(condition, inner)
    body += IF[language].format("s>2", MOVE[language].format(2))
    program = read(language, body)
    assert places(program) == [1, 2, 2, 2]
    cycle = program.cycle
    assert cycle is not None and (cycle.begin, cycle.end, cycle.length) == (3, 4, 1)


@pytest.mark.parametrize("language", ROBOTS)
def test_as_many_passes_as_are_asked_for_are_read(language) -> None:
    states = (0, 1), (1, 0)
    body = "".join(step(language, a, b, MOVE[language].format(a + 1)) for a, b in states)
    program = read(language, body, cycles=5)
    assert places(program) == [1, 2, 1, 2, 1]


@pytest.mark.parametrize("language", ROBOTS)
def test_one_routine_for_all_states_is_called_for_each(language) -> None:
    states = (0, 1), (1, 2), (2, 0)
    body = "".join(step(language, a, b, GO[language].format(a + 1)) for a, b in states)
    program = read(language, body)
    assert places(program) == [1, 2, 3]
    assert program.cycle is not None and program.cycle.length == 3


@pytest.mark.parametrize("language", ROBOTS)
def test_a_state_is_asked_by_what_is_made_of_it(language) -> None:
    body = SET[language].format("b", f"s{EQUAL[language]}0")
    first = MOVE[language].format(1) + SET[language].format("s", 1)
    second = MOVE[language].format(2) + SET[language].format("s", 0)
    no = f"{'NOT' if language != 'ur' else 'not'} b"
    body += IF[language].format("b", first) + IF[language].format(no, second)
    program = read(language, body)
    assert places(program) == [1, 2]
    assert program.cycle is not None and program.cycle.length == 2


@pytest.mark.parametrize("language", JUMP)
@given(count=st.integers(2, 5))
def test_loops_by_jumps_have_states(language, count) -> None:
    """Their first pass shows itself at its end: the cycle begins with the second."""
    body = "".join(
        step(language, k, (k + 1) % count, MOVE[language].format(k + 1)) for k in range(count)
    )
    program = read(language, body, loop=JUMP)
    assert places(program) == [*range(1, count + 1), 1]
    cycle = program.cycle
    assert cycle is not None
    assert (cycle.begin, cycle.end, cycle.length) == (1, count + 1, count)


@pytest.mark.parametrize("language", JUMP)
def test_loops_by_jumps_without_states_have_one_pass(language) -> None:
    program = read(language, MOVE[language].format(1), loop=JUMP)
    assert places(program) == [1]
    assert program.cycle is not None and program.cycle.passes == 1


@pytest.mark.parametrize("language", ROBOTS)
def test_states_come_round_before_an_open_way_out_is_taken(language) -> None:
    leave = {"abb": "EXIT;\n", "kuka": "HALT\n", "ur": "halt\n"}[language]
    signal = {"abb": "di1=1", "kuka": "$IN[1]", "ur": "get_standard_digital_in(1)"}[language]
    states = (0, 1), (1, 0)
    body = "".join(step(language, a, b, MOVE[language].format(a + 1)) for a, b in states)
    body += IF[language].format(signal, SET[language].format("s", 0))
    body += IF[language].format(f"s{EQUAL[language]}9", leave)
    program = read(language, body)
    assert places(program) == [1, 2]
    assert program.cycle is not None and program.cycle.length == 2


def closing(program: Program) -> list[str]:
    return [note.message for note in program.notes if "the first cycle of the loop" in note.message]


@pytest.mark.parametrize("language", ROBOTS)
@given(data=st.data())
def test_a_cycle_that_begins_elsewhere_than_the_next_is_said(language, data) -> None:
    before = data.draw(st.integers(0, 3))
    ways = data.draw(st.lists(st.integers(1, 3), min_size=1, max_size=3))
    body = "".join(MOVE[language].format(way) for way in ways)
    start = MOVE[language].format(before) if before else ""
    program = read(language, body, before=start)
    assert bool(closing(program)) == (before != ways[-1])
    assert not closing(read(language, body, before=start, cycles=2))


@pytest.mark.parametrize("language", ROBOTS)
@given(data=st.data())
def test_a_cycle_is_closed_by_one_pass_more(language, data) -> None:
    """However the robot came to the loop, the last cycle begins where it ends."""
    count = data.draw(st.integers(1, 4))
    before = data.draw(st.integers(0, count))
    body = "".join(
        step(language, k, (k + 1) % count, MOVE[language].format(k + 1)) for k in range(count)
    )
    start = MOVE[language].format(before) if before else ""
    program = read(language, body, before=start, closes=True)
    cycle, driven = program.cycle, [0, *places(program)]
    assert cycle is not None and cycle.length == count
    assert driven[cycle.begin] == driven[cycle.end] and not closing(program)
    ways = places(program)[cycle.begin : cycle.end]
    assert sorted(ways) == [*range(1, count + 1)]


@pytest.mark.parametrize("language", ROBOTS)
def test_a_state_that_never_ends_its_loop_comes_round(language) -> None:
    states = (0, 1), (1, 2), (2, 0)
    body = "".join(step(language, a, b, MOVE[language].format(a + 1)) for a, b in states)
    program = read(language, body, loop=UNTIL)
    assert places(program) == [1, 2, 3]
    assert program.cycle is not None and program.cycle.length == 3
    ends = "".join(step(language, a, b, MOVE[language].format(a + 1)) for a, b in ((0, 1), (1, 99)))
    program = read(language, ends, loop=UNTIL)
    assert places(program) == [1, 2] and program.cycle is None


@pytest.mark.parametrize("language", ROBOTS)
def test_a_state_that_a_counter_turns_has_the_counter_in_it(language) -> None:
    equal, plus = EQUAL[language], SET[language].format("n", "n+1")
    turn = SET[language].format("s", "1-s") + SET[language].format("n", 0)
    body = IF[language].format(f"s{equal}0", MOVE[language].format(1))
    body += IF[language].format(f"s{equal}1", MOVE[language].format(2))
    body += plus + IF[language].format(f"n{equal}3", turn)
    before = SET[language].format("n", 0)
    text = before + LOOP[language].format(body)
    other = SET[language].format("n", "n")
    program = find_vendor(language).read(
        FRAME[language].format(first=0, loop=text, other=other),
        FILE[language],
        robot=find_robot(ROBOTS[language]),
        answers=Answers(goes_on=True, cycles=9),
    )
    assert places(program) == [1, 1, 1, 2, 2, 2, 1, 1, 1]
    assert program.cycle is not None and program.cycle.length == 6


@pytest.mark.parametrize("language", ROBOTS)
def test_an_open_way_out_is_taken_when_the_state_has_come_back(language) -> None:
    leave = {"abb": "EXIT;\n", "kuka": "HALT\n", "ur": "halt\n"}[language]
    signal = {"abb": "di1=1", "kuka": "$IN[1]", "ur": "get_standard_digital_in(1)"}[language]
    states = (0, 1), (1, 0)
    body = "".join(step(language, a, b, MOVE[language].format(a + 1)) for a, b in states)
    program = read(language, body + IF[language].format(signal, leave))
    assert places(program)[:2] == [1, 2]
    assert program.cycle is not None and program.cycle.length == 2
