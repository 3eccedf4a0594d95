"""Loops that would go on for more moves than are read: foreseen after some passes."""

from __future__ import annotations

import re
from typing import Any

import pytest

from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.limits import EndlessError, Meter

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


@pytest.fixture
def foreseen(monkeypatch) -> list[str]:
    """What was foreseen of loops: reading itself drives one pass of such a loop."""
    found: list[str] = []
    ahead = Meter.ahead

    def recording(*values: Any) -> None:
        try:
            ahead(*values)
        except EndlessError as error:
            found.append(error.message)
            raise

    monkeypatch.setattr(Meter, "ahead", recording)
    return found


def read(language: str, body: str) -> int:
    """How many moves a program has."""
    program = find_vendor(language).read(
        FRAME[language].format(body), SUFFIX[language], robot=find_robot(ROBOTS[language])
    )
    return len(program.moves)


def loop(language: str, bound: str, step: str, more: str = "") -> str:
    behind = "\nout:" if language == "abb" and more else ""
    body = STEP[language].format(step) + more
    return WHILE[language].format(bound, MOVE[language], body) + behind


@pytest.mark.parametrize("language", ROBOTS)
@pytest.mark.parametrize(
    ("bound", "step", "message"),
    [
        (">-1", "+1", "comes no nearer to its end, with 1 moves each"),
        ("<=5", "-1", "comes no nearer to its end, with 1 moves each"),
        ("<99999", "+1", "has 99[0-9]{3} passes left, with 1 moves each"),
    ],
)
def test_a_counter_that_does_not_arrive_is_foreseen(
    language, bound, step, message, foreseen
) -> None:
    assert read(language, loop(language, bound, step) + "\n" + MOVE[language]) == 2
    assert len(foreseen) == 1
    assert re.search(f"(?i)^WHILE.* {message}", foreseen[0])


@pytest.mark.parametrize("language", ROBOTS)
def test_a_long_loop_that_ends_is_read_to_its_end(language, foreseen) -> None:
    assert read(language, loop(language, "<300", "+1")) == 300
    assert not foreseen


@pytest.mark.parametrize("language", ROBOTS)
def test_a_way_out_in_the_body_ends_it(language, foreseen) -> None:
    """Nothing is foreseen of a loop that something else may end."""
    assert read(language, loop(language, "<99999", "+1", LEAVE[language])) == 201
    assert not foreseen


FASTER = {"abb": "n:=n*1.05+1;\n", "ur": "n=n*1.05+1\n"}
LAYERS = {"abb": "k:=k+1;\nIF k MOD 150=0 THEN\nn:=n+1;\nENDIF\n",
          "kuka": "k=k+1\nIF k-150*(k/150)==0 THEN\nn=n+1\nENDIF\n",
          "ur": "k=k+1\nif k % 150 == 0:\nn=n+1\nend\n"}  # fmt: skip


@pytest.mark.parametrize("language", ROBOTS)
def test_a_counter_that_steps_unevenly_foresees_nothing(language, foreseen) -> None:
    """Faster and faster, or once in a layer of 150."""
    if language in FASTER:
        body = MOVE[language].replace("k", "0"), FASTER[language]
        assert read(language, WHILE[language].format("<99999999", *body)) == 317
    body = MOVE[language].replace("k", "0"), LAYERS[language]
    assert read(language, WHILE[language].format("<3", *body)) == 450
    assert not foreseen


@pytest.mark.parametrize("language", FOR)
def test_a_for_that_counts_too_far_is_foreseen(language, foreseen) -> None:
    assert read(language, FOR[language].format(MOVE[language])) == 1
    assert len(foreseen) == 1
    assert re.match("FOR k has 99[0-9]{3} passes left, with 1 moves each", foreseen[0])
