"""What programs ask that no file says: one policy in all languages, and a file that reads back."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError
from flyby.core.program.move import Wait
from flyby.core.program.program import Program
from flyby.core.program.question import QuestionKind
from flyby.core.registry import find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.answers_file import load_answers
from flyby.core.source.execution.answers_text import answers_text
from flyby.core.source.reading import ReadOptions

EXTERNAL = ",".join(["9E9"] * 6)
WHOLE = {
    "abb": "MODULE m\nVAR num n:=0;\nVAR num part;\nVAR robtarget pOpen;\n"
    f"CONST jointtarget j1:=[[10,0,0,0,30,0],[{EXTERNAL}]];\n"
    "PROC main()\nBODY\nENDPROC\nENDMODULE\n",
    "kuka": "DEF m()\nDECL INT N,PART\nDECL E6POS POPEN\nN=0\nBODY\nEND\n",
    "ur": "def m():\nn = 0\nBODY\nend\n",
}
FILES = {"abb": "m.mod", "kuka": "m.src", "ur": "m.script"}
GO = {
    "abb": "MoveAbsJ j1,v100,fine,tool0;",
    "kuka": "PTP {A1 10,A2 -90,A3 90,A4 0,A5 10,A6 0}",
    "ur": "movej([0.2,-1.5,1.5,0,0.1,0], a=1, v=1)",
}
PIECES = {
    "wait": {
        "abb": "WaitDI diReady,1;",
        "kuka": "WAIT FOR $IN[7]",
        "ur": "while not get_digital_in(7):\nsync()\nend",
    },
    "branch": {
        "abb": "IF diPart=1 THEN\nGO\nENDIF",
        "kuka": "IF $IN[8] THEN\nGO\nENDIF",
        "ur": "if get_digital_in(5):\nGO\nend",
    },
    "loop": {
        "abb": "WHILE diMore=1 DO\nGO\nENDWHILE",
        "kuka": "WHILE $IN[9]\nGO\nENDWHILE",
        "ur": "while get_digital_in(6):\nGO\nend",
    },
    "menu": {
        "abb": 'TPReadNum part,"which";\nTEST part\nCASE 1:\nGO\nCASE 2:\nn:=3;\nENDTEST',
        "kuka": "SWITCH PLCJOB\nCASE 1\nGO\nDEFAULT\nN=3\nENDSWITCH",
        "ur": 'part = request_integer_from_primary_client("which")\n'
        "if part == 1:\nGO\nelse:\nn = 3\nend",
    },
    "device": {"abb": "rGripOpen;", "kuka": "GREIFER(1)", "ur": "my_gripper(1)"},
    "count": {
        "abb": "FOR i FROM 1 TO 3 DO\nGO\nENDFOR",
        "kuka": "FOR N=1 TO 3\nGO\nENDFOR",
        "ur": "n = 0\nwhile n < 3:\nGO\nn = n + 1\nend",
    },
    "open move": {
        "abb": "MoveJ pOpen,v100,fine,tool0;",
        "kuka": "PTP PNOWHERE",
        "ur": "movel(p_installed, a=1, v=1)",
    },
    "sensor": {
        "abb": "n:=AInput(aiForce);",
        "kuka": "N=$ANIN[1]",
        "ur": "n = get_standard_analog_in(1)",
    },
}
ASKED = {
    "wait": {("durations", "waitdidiready,1|waitfor$in[7]|whilenotget_digital_in(7)")},
    "branch": {("branches", "*"), ("values", "dipart|$in[8]|get_digital_in(5)")},
    "loop": {("passes", "*"), ("values", "dimore|$in[9]|get_digital_in(6)")},
    "device": {("calls", "rgripopen|greifer|my_gripper")},
    "open move": {("values", "popen|pnowhere|p_installed")},
    "sensor": {("values", "ainput(aiforce)|$anin[1]|get_standard_analog_in(1)")},
}
VENDORS = sorted(WHOLE)


def text_of(vendor: str, pieces: list[str]) -> str:
    body = "\n".join([GO[vendor], *(PIECES[p][vendor] for p in pieces), GO[vendor]])
    return WHOLE[vendor].replace("BODY", body.replace("GO\n", GO[vendor] + "\n"))


def read(vendor: str, text: str, answers: Answers | None = None) -> Program:
    reader = find_vendor(vendor).reader
    assert reader is not None
    told = replace(answers or Answers(), goes_on=True)
    return reader.read(text, FILES[vendor], ReadOptions(answers=told))


def loaded(toml: str) -> Answers:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "answers.toml"
        file.write_text(toml, "utf-8")
        return load_answers(file)


def complaints(program: Program) -> list[str]:
    return [n.message for n in program.notes if "did not ask" in n.message]


@pytest.mark.parametrize("vendor", VENDORS)
@pytest.mark.parametrize("piece", sorted(ASKED))
def test_what_is_asked_is_listed(piece: str, vendor: str) -> None:
    program = read(vendor, text_of(vendor, [piece]))
    found = {(q.table, re.sub(r"\s", "", q.key).lower()) for q in program.questions}
    for table, keys in ASKED[piece]:
        assert any(t == table and (keys == "*" or k in keys.split("|")) for t, k in found), found


STANDS = {
    "abb": "jHere:=CJointT();",
    "kuka": "AHERE=$AXIS_ACT",
    "ur": "here = get_actual_joint_positions()",
}


@pytest.mark.parametrize("vendor", VENDORS)
def test_where_the_robot_stands_is_asked_only_where_nobody_knows_it(vendor: str) -> None:
    whole = WHOLE[vendor].replace("PROC main()", "VAR jointtarget jHere;\nPROC main()")
    whole = whole.replace("DECL INT", "DECL E6AXIS AHERE\nDECL INT")
    known = read(vendor, whole.replace("BODY", f"{GO[vendor]}\n{STANDS[vendor]}"))
    assert not known.questions


@settings(max_examples=25, deadline=None)
@given(st.sampled_from(VENDORS), st.lists(st.sampled_from(sorted(PIECES)), max_size=5))
def test_the_file_changes_nothing_and_lists_what_is_used(vendor: str, pieces: list[str]) -> None:
    text = text_of(vendor, pieces)
    program = read(vendor, text)
    toml = answers_text(program.questions, FILES[vendor])
    again = read(vendor, text, loaded(toml))
    assert again.statements == program.statements
    assert not complaints(again)
    assert answers_text(again.questions, FILES[vendor]) == toml
    filled = re.sub(r"^#(?=\S)", "", toml, flags=re.MULTILINE)
    assert filled.count("=") == toml.count("=")
    answered = loaded(filled)
    known = {*answered.values, *answered.branches, *answered.passes, *answered.durations}
    assert len(known) + len(answered.skipped) == len(program.questions)


@pytest.mark.parametrize("vendor", VENDORS)
def test_answers_act(vendor: str) -> None:
    text = text_of(vendor, ["branch", "loop", "device"])
    program = read(vendor, text)
    toml = answers_text(program.questions, FILES[vendor])
    edited = re.sub(r'^#("m\..*") = 1$', r"\1 = 0", toml, flags=re.MULTILINE)
    device = {"abb": "rGripOpen", "kuka": "GREIFER", "ur": "my_gripper"}[vendor]
    edited = re.sub(rf'^(("?){device}.*) = 0$', r"\1 = 0.4", edited, flags=re.MULTILINE)
    again = read(vendor, text, loaded(edited))
    assert len(program.moves) == 4
    assert len(again.moves) == 2
    waits = [s for s in again.statements if isinstance(s, Wait) and s.device]
    assert [wait.duration for wait in waits] == [0.4]


@pytest.mark.parametrize("vendor", VENDORS)
def test_a_move_that_nobody_knows_stays_open_and_the_program_goes_on(vendor: str) -> None:
    text = text_of(vendor, ["open move"])
    program = read(vendor, text)
    assert [bool(move.open) for move in program.moves] == [False, True, False]
    if vendor == "abb":  # it steps over such moves by itself
        return
    with pytest.raises(FlybyError):
        reader = find_vendor(vendor).reader
        assert reader is not None
        reader.read(text, FILES[vendor], ReadOptions())


@pytest.mark.parametrize(
    ("vendor", "answer"),
    [
        ("abb", '"[[600,0,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"'),
        ("abb", "[[600,0,900],[0,0,1,0],[0,0,0,0],[9e9,9e9,9e9,9e9,9e9,9e9]]"),
        ("abb", "{ trans = [600,0,900], rot = [0,0,1,0] }"),
        ("kuka", '"{X 700,Y 0,Z 800,A 0,B 90,C 0}"'),
        ("kuka", "[700, 0, 800, 0, 90, 0]"),
        ("kuka", "{ X = 700, Y = 0, Z = 800, A = 0, B = 90, C = 0 }"),
        ("ur", '"p[0.4,0,0.4,0,3.14,0]"'),
        ("ur", "[0.1, -1.5, 1.5, 0, 0.1, 0]"),
        ("ur", '"[0.1, -1.5, 1.5, 0, 0.1, 0]"'),
    ],
)
def test_structures_are_answered_as_tables_arrays_and_as_the_language_has_them(
    vendor: str, answer: str
) -> None:
    name = {"abb": "pOpen", "kuka": "PNOWHERE", "ur": "p_installed"}[vendor]
    answers = loaded(f"[values]\n{name} = {answer}\n")
    program = read(vendor, text_of(vendor, ["open move"]), answers)
    assert [move.open for move in program.moves] == ["", "", ""]
    assert not complaints(program)


@pytest.mark.parametrize("vendor", VENDORS)
def test_a_loop_that_waits_takes_the_time_of_its_signal(vendor: str) -> None:
    signal = {"abb": "diReady", "kuka": '"$IN[7]"', "ur": '"get_digital_in(7)"'}[vendor]
    program = read(vendor, text_of(vendor, ["wait"]), loaded(f"[durations]\n{signal} = 6\n"))
    assert sum(s.duration for s in program.statements if isinstance(s, Wait)) == 6.0
    (question,) = [q for q in program.questions if q.kind is QuestionKind.PAUSE]
    assert question.answered


@settings(max_examples=40, deadline=None)
@given(
    st.text(max_size=80), st.sampled_from(["values", "durations", "branches", "calls", "passes"])
)
def test_hostile_answers_are_refused_by_name_or_read(text: str, table: str) -> None:
    try:
        answers = loaded(f"[{table}]\n{text}\n")
    except FlybyError:
        return
    for vendor in VENDORS:
        with suppress(FlybyError):
            read(vendor, text_of(vendor, ["menu", "open move"]), answers)


@pytest.mark.parametrize("vendor", ["abb", "kuka"])
def test_a_branch_is_followed_into_files_beside_the_program(vendor: str, tmp_path: Path) -> None:
    main = {
        "abb": "MODULE m\nPROC main()\nIF di1=1 THEN\nn1;\nELSE\nrWork;\nENDIF\nENDPROC\n"
        "PROC n1()\nENDPROC\nENDMODULE\n",
        "kuka": "DEF m()\nIF $IN[1] THEN\nN1()\nELSE\nRWORK()\nENDIF\nEND\nDEF N1()\nEND\n",
    }[vendor]
    beside = {
        "abb": "MODULE w\n"
        f"CONST jointtarget j1:=[[10,0,0,0,30,0],[{EXTERNAL}]];\n"
        f"PROC rWork()\n{GO['abb']}\nENDPROC\nENDMODULE\n",
        "kuka": f"DEF RWORK()\n{GO['kuka']}\nEND\n",
    }[vendor]
    (tmp_path / FILES[vendor]).write_text(main, "utf-8")
    (tmp_path / {"abb": "w.mod", "kuka": "rwork.src"}[vendor]).write_text(beside, "utf-8")
    program = find_vendor(vendor).read_file(tmp_path / FILES[vendor])
    assert len(program.moves) == 1


COMPOSED = {
    "abb": (
        "p := Offs(getPoint(1), getShift(n), 0, 0);\nMoveL p,v100,fine,tool0;\n"
        "MoveL Offs(CRobT(), 0, getShift(2), 0),v100,fine,tool0;",
        {"getPoint(1)": "robtarget", "getShift(n)": "number", "getShift(2)": "number"},
    ),
    "kuka": (
        "LIN_REL {Z getShift(1)}\nIF isDone(getPart(), 2) THEN\nGO\nENDIF",
        {"getShift(1)": "", "isDone(getPart(), 2)": ""},
    ),
    "ur": (
        "if count(get_part(n)) > 1:\nGO\nend\nother = get_part(n)",
        {"count(get_part(n))": "number", "get_part(n)": ""},
    ),
}


@pytest.mark.parametrize("vendor", VENDORS)
def test_what_comes_of_other_things_that_are_asked_is_not_asked_as_well(vendor: str) -> None:
    body, asked = COMPOSED[vendor]
    text = WHOLE[vendor].replace("BODY", f"{GO[vendor]}\n{body}".replace("GO", GO[vendor]))
    text = text.replace("VAR num part;", "VAR robtarget p;")
    program = read(vendor, text, Answers())
    found = {q.key: q.type for q in program.questions if q.table == "values"}
    found.pop("CRobT()", None)
    assert {name: found.get(name, "not asked") for name in asked} == asked
    assert found.keys() == asked.keys()
