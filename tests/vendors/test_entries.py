"""Routines as entries: with arguments, unknown ones, all of them."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import EntryError, InputError, SourceError
from flyby.core.program.assumed_places import refuse_assumed
from flyby.core.program.entry_point import others_drive
from flyby.core.program.program import Program
from flyby.core.program.question import Answer
from flyby.core.registry import find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.core.source.patch.edits import difference
from flyby.core.source.reading import ReadOptions

EXTERNAL = ",".join(["9E9"] * 6)
TEXTS = {
    "abb": (
        "m.mod",
        f"""MODULE m
LOCAL CONST robtarget p10:=[[600,0,900],[0,0,1,0],[0,0,0,0],[{EXTERNAL}]];
PROC Pick(num n, robtarget p)
MoveJ Offs(p,0,0,50*n),v500,z10,tool0;
MoveL p,v100,fine,tool0;
ENDPROC
PROC Home()
MoveAbsJ [[0,0,0,0,30,0],[{EXTERNAL}]],v1000,fine,tool0;
ENDPROC
ENDMODULE
""",
    ),
    "kuka": (
        "m.src",
        """DEF m()
END
DEF Pick(n:IN, p:IN)
INT n
E6POS p
PTP p
LIN_REL {Z 50}
END
DEF Home()
PTP {A1 0,A2 -90,A3 90,A4 0,A5 10,A6 0}
END
""",
    ),
    "ur": (
        "m.script",
        """def Pick(n, p):
  movel(pose_add(p, p[0,0,0.05*n,0,0,0]), a=1, v=0.2)
  movel(p, a=1, v=0.2)
end
def Home():
  movej([0,-1.5,1.5,0,0.1,0], a=1, v=1)
end
def Park():
  movej([0.5,-1.5,1.5,0,0.1,0], a=1, v=1)
end
""",
    ),
}
TARGETS = {"abb": "p10", "kuka": "{X 700,Y 0,Z 800,A 0,B 90,C 0}", "ur": "p[0.4,0,0.4,0,3.1,0]"}


WRITTEN = {
    "abb": f"[[600,0,{{0}}],[0,0,1,0],[0,0,0,0],[{EXTERNAL}]]",
    "kuka": "{{X 700,Y 0,Z {0},A 0,B 90,C 0}}",
    "ur": "p[0.4,0,{0},0,3.1,0]",
}


def answer_of(vendor: str, written: str) -> Answer:
    """A target as a file of answers says it."""
    return nested(json.loads(written.replace("9E9", "9e9"))) if vendor == "abb" else written


def nested(item: Any) -> Answer:
    return tuple(map(nested, item)) if isinstance(item, list) else float(item)


ANSWERS = {vendor: answer_of(vendor, text.format(0.5)) for vendor, text in WRITTEN.items()}


def read(vendor: str, entry: str | None, answers: Answers | None = None) -> Program:
    reader = find_vendor(vendor).reader
    assert reader is not None
    file, text = TEXTS[vendor]
    return reader.read(text, file, ReadOptions(entry=entry, answers=answers or Answers()))


@pytest.mark.parametrize("vendor", TEXTS)
def test_arguments_are_given_as_the_language_writes_them(vendor: str) -> None:
    program = read(vendor, f"Pick(1, {TARGETS[vendor]})")
    assert len(program.moves) == 2
    assert len(read(vendor, "Home").moves) == 1


@pytest.mark.parametrize("vendor", TEXTS)
def test_arguments_are_called_as_they_are_declared(vendor: str) -> None:
    file, text = TEXTS[vendor]
    named = re.sub(r"\bp\b(?!\[)", "pGoal", re.sub(r"\bn\b", "nPart", text))
    reader = find_vendor(vendor).reader
    assert reader is not None
    program = reader.read(named, file, ReadOptions(entry="Pick", answers=Answers(goes_on=True)))
    assert any("its arguments (nPart, pGoal) have no values" in n.message for n in program.notes)
    assert not any("pgoal" in str(note) for note in program.notes)
    assert any(q.key == "pGoal" for q in program.questions)
    assert "pGoal" in program.moves[0].open and "pgoal" not in program.moves[0].open


@pytest.mark.parametrize("vendor", TEXTS)
def test_all_of_them_are_listed_with_their_moves(vendor: str) -> None:
    program = read(vendor, "all")
    assert not program.statements
    shown = [str(entry) for entry in program.entries if entry.moves]
    assert shown[:2] == ["Pick(n, p) (2 moves)", "Home (1 move)"]


@pytest.mark.parametrize("vendor", TEXTS)
@pytest.mark.parametrize("entry", ["Nothing", "Pick(1,", "Nothing(1)"])
def test_one_that_is_not_there_is_refused_with_those_that_are(vendor: str, entry: str) -> None:
    with pytest.raises(SourceError, match=r"Pick\(n, p\) \(2 moves\), Home \(1 move\)"):
        read(vendor, entry)


@pytest.mark.parametrize("vendor", TEXTS)
@pytest.mark.parametrize("arguments", ["1,2,3", "1 1", ")", "1); MoveJ(2", "", '"'])
def test_arguments_that_are_none_are_refused(vendor: str, arguments: str) -> None:
    if vendor == "kuka" and not arguments:  # parameters without values are the language's own
        return
    with pytest.raises(SourceError):
        read(vendor, f"Pick({arguments})")


@pytest.mark.parametrize("vendor", TEXTS)
def test_arguments_that_nobody_gives_are_asked_where_programs_go_on(vendor: str) -> None:
    """A move to one of them is not known, with an answer it goes there; strictly it is refused."""
    first, second = read(vendor, "Pick", Answers(goes_on=True)).moves
    assert first.open and second.open
    program = read(vendor, "Pick", Answers(goes_on=True))
    asked = {question.key.casefold() for question in program.questions if not question.answered}
    assert {"p", "n"} <= asked or vendor == "kuka"  # which asks for what it needs alone
    assert any("read without a caller: its arguments (n, p)" in n.message for n in program.notes)
    told = Answers(goes_on=True, values={"n": 1.0, "p": ANSWERS[vendor]})
    assert not any(move.open for move in read(vendor, "Pick", told).moves)
    if vendor != "kuka":
        with pytest.raises(SourceError, match="argument"):
            read(vendor, "Pick")


@pytest.mark.parametrize("vendor", TEXTS)
def test_nothing_is_proven_or_written_of_one_call_alone(vendor: str) -> None:
    """What a place is taken for where nobody gives the argument holds for no other call."""
    told = Answers(goes_on=True, values={"p": ANSWERS[vendor]})
    program = read(vendor, "Pick", told)
    assert [bool(move.supposed) for move in program.moves] == [vendor != "kuka", False]
    if vendor != "kuka":
        with pytest.raises(InputError, match=r"argument '?n'? of Pick, which nobody says"):
            refuse_assumed(program)
    refuse_assumed(read(vendor, "Pick", replace(told, values={**told.values, "n": 1.0})))
    refuse_assumed(read(vendor, f"Pick(1, {TARGETS[vendor]})", Answers(goes_on=True)))
    refuse_assumed(read(vendor, "Home", Answers(goes_on=True)))


@pytest.mark.parametrize("vendor", TEXTS)
@given(at=st.floats(0.1, 0.4), n=st.integers(0, 5))
def test_answers_and_arguments_drive_alike(vendor: str, at: float, n: int) -> None:
    said = WRITTEN[vendor].format(round(at, 3) * (1.0 if vendor == "ur" else 1000.0))
    answers = Answers(goes_on=True, values={"n": float(n), "p": answer_of(vendor, said)})
    called = read(vendor, f"Pick({n}, {said})", Answers(goes_on=True))
    moves = (Program(program.moves) for program in (read(vendor, "Pick", answers), called))
    assert difference(*moves, 1e-9) is None


SEVERAL = {
    "abb": "MODULE m\nPROC A()\n{0}\nENDPROC\nPROC B()\n{1}\nENDPROC\nENDMODULE\n",
    "ur": "def A():\n{0}\nend\ndef B():\n{1}\nend\n",
}
STILL = {
    "abb": "MODULE m\nPROC main()\nWaitTime 1;\nENDPROC\nPROC B()\n{1}\nENDPROC\nENDMODULE\n",
    "kuka": "DEF m()\nWAIT SEC 1\nEND\nDEF B()\n{1}\nEND\n",
    "ur": "def main():\nsleep(1)\nend\ndef B():\n{1}\nend\n",
}
MOVES = {
    "abb": [f"MoveAbsJ [[0,0,0,0,{n}0,0],[{EXTERNAL}]],v1000,fine,tool0;" for n in (3, 4)],
    "kuka": [f"PTP {{A1 0,A2 -90,A3 90,A4 0,A5 {n},A6 0}}" for n in (10, 20)],
    "ur": [f"movej([0,-1.5,1.5,0,0.{n},0])" for n in (1, 2)],
}


@pytest.mark.parametrize("vendor", SEVERAL)
def test_a_program_without_a_beginning_says_so(vendor: str) -> None:
    reader = find_vendor(vendor).reader
    assert reader is not None
    text = SEVERAL[vendor].format(*MOVES[vendor])
    with pytest.raises(EntryError, match=r"choose as the entry one of A \(1 move\), B"):
        reader.read(text, TEXTS[vendor][0], ReadOptions())


@pytest.mark.parametrize("vendor", STILL)
def test_a_program_whose_beginning_never_drives_tells_who_does(vendor: str) -> None:
    reader = find_vendor(vendor).reader
    assert reader is not None
    made = reader.read(
        STILL[vendor].replace("{1}", MOVES[vendor][0]), TEXTS[vendor][0], ReadOptions()
    )
    assert not made.moves
    assert others_drive(made.entries)
    assert [entry.begun for entry in made.entries] == [True, False]


def test_functions_that_move_are_entries_of_rapid() -> None:
    reader = find_vendor("abb").reader
    assert reader is not None
    text = (
        f"MODULE m\nFUNC num Seek(num n)\n{MOVES['abb'][0]}\nRETURN n;\nENDFUNC\n"
        "FUNC num Twice(num n)\nRETURN 2*n;\nENDFUNC\nENDMODULE\n"
    )
    with pytest.raises(EntryError, match=r"one of Seek\(n\) \(1 move\); all drives"):
        reader.read(text, "m.mod", ReadOptions())
    assert len(reader.read(text, "m.mod", ReadOptions("Seek(3)")).moves) == 1
