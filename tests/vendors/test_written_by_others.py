"""Data that an interrupt's routine or a thread writes are not known where the program tests them.

In the texts ``<A>`` to ``<C>`` are joint moves that differ in the first axis.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_vendor
from flyby.core.source.execution.answers import Answer, Answers
from flyby.core.source.reading import ReadOptions

ZEROS = ",".join(["9E9"] * 6)
MOVES = {
    "abb": f"MoveAbsJ [[#,0,0,0,0,0],[{ZEROS}]],v100,fine,tool0;",
    "kuka": "PTP {A1 #,A2 -90,A3 90,A4 0,A5 0,A6 0}",
    "ur": "movej([d2r(#),0,0,0,0,0], a=1, v=1)",
}
WHOLE = {
    "abb": (
        "m.mod",
        "MODULE m\nVAR num n;\nVAR bool go;\nVAR intnum i1;\nVAR num k:=2;\n"
        "TRAP t\nOTHER\nENDTRAP\n"
        "PROC set(INOUT bool b,num v)\nVAR num n;\nn:=v;\nb:=TRUE;\nENDPROC\n"
        "PROC main()\nBODY\nENDPROC\nENDMODULE\n",
    ),
    "kuka": (
        "m.src",
        "DEF m()\nBODY\nEND\nDEF t()\nOTHER\nEND\n"
        "DEF set(B:OUT,V:IN)\nDECL BOOL B\nDECL INT V,N\nN=V\nB=TRUE\nEND\n",
    ),
    "ur": ("m.script", "def m():\nn = 0\nk = 2\ngo = True\nthread t():\nOTHER\nend\nBODY\nend\n"),
}
CONNECT = {
    "abb": "CONNECT i1 WITH t;\n",
    "kuka": "INTERRUPT DECL 3 WHEN $IN[1] DO t()\nINTERRUPT ON 3\n",
    "ur": "h = run t()\n",
}
BRANCH = {
    "abb": "IF go THEN\n<A>\nENDIF\n<B>",
    "kuka": "IF go THEN\n<A>\nENDIF\n<B>",
    "ur": "if go:\n<A>\nend\n<B>",
}
FALSE = {"abb": "go:=FALSE;\n", "kuka": "go=FALSE\n", "ur": "go = False\n"}
TRUE = {"abb": "go:=TRUE;", "kuka": "go=TRUE", "ur": "go = True"}


@dataclass(frozen=True)
class Case:
    """A program by vendor.

    Args:
        others: what the trap, the interrupt's routine or the thread does.
        bodies: what the program does.
        driven: its moves.
        values: answers.
    """

    others: dict[str, str]
    bodies: dict[str, str]
    driven: str
    values: dict[str, Answer] = field(default_factory=dict)


def after(*parts: dict[str, str]) -> dict[str, str]:
    return {vendor: "".join(part[vendor] for part in parts) for vendor in MOVES}


CASES = {
    "nothing writes it": Case(
        {"abb": "k:=3;", "kuka": "k=3", "ur": "k = 3"}, after(FALSE, CONNECT, BRANCH), "B"
    ),
    "written before": Case(TRUE, after(FALSE, CONNECT, BRANCH), "A B"),
    "written behind": Case(TRUE, after(CONNECT, FALSE, BRANCH), "A B"),
    "tested before": Case(TRUE, after(FALSE, BRANCH, dict.fromkeys(MOVES, "\n"), CONNECT), "B"),
    "answered": Case(TRUE, after(FALSE, CONNECT, BRANCH), "B", {"go": False}),
    "by reference, through another routine": Case(
        {"abb": "set go,k;", "kuka": "set(go,k)"},
        after(FALSE, CONNECT, BRANCH),
        "A B",
    ),
    "handed over by its value, and a routine's own": Case(
        {"abb": "set go,k;", "kuka": "set(go,k)"},
        {
            "abb": CONNECT["abb"] + "n:=1;\nIF k=3 OR n=2 THEN\n<A>\nENDIF\n<B>",
            "kuka": "k=2\nn=1\n" + CONNECT["kuka"] + "IF (k==3) OR (n==2) THEN\n<A>\nENDIF\n<B>",
        },
        "B",
    ),
    "computed with": Case(
        {"abb": "k:=Abs(n);", "kuka": "k=ABS(n)", "ur": "k = floor(n)"},
        {
            "abb": CONNECT["abb"] + "n:=1;\nIF n=2 THEN\n<A>\nENDIF\nIF k=7 THEN\n<C>\nENDIF\n<B>",
            "kuka": CONNECT["kuka"]
            + "n=1\nk=2\nIF n==2 THEN\n<A>\nENDIF\nIF k==7 THEN\n<C>\nENDIF\n<B>",
            "ur": CONNECT["ur"] + "n = 1\nif n == 2:\n<A>\nend\nif k == 7:\n<C>\nend\n<B>",
        },
        "C B",
    ),
    "waited for": Case(
        TRUE,
        {
            "abb": CONNECT["abb"] + "go:=FALSE;\nWaitUntil go;\n"
            "IF NOT go THEN\n<A>\nENDIF\ngo:=FALSE;\nIF go THEN\n<C>\nENDIF\n<B>",
            "kuka": CONNECT["kuka"] + "go=FALSE\nWAIT FOR go\n"
            "IF NOT go THEN\n<A>\nENDIF\ngo=FALSE\nIF go THEN\n<C>\nENDIF\n<B>",
        },
        "C B",
    ),
    "waited for with what nobody knows": Case(
        TRUE,
        {
            "abb": CONNECT["abb"] + "go:=FALSE;\nWaitUntil go OR di1=1;\n" + BRANCH["abb"],
            "kuka": CONNECT["kuka"] + "go=FALSE\nWAIT FOR go OR $IN[1]\n" + BRANCH["kuka"],
        },
        "A B",
    ),
    "a loop on it": Case(
        TRUE,
        {
            "abb": CONNECT["abb"] + "WHILE NOT go DO\n<A>\nENDWHILE\n<B>",
            "kuka": CONNECT["kuka"] + "WHILE NOT go\n<A>\nENDWHILE\n<B>",
            "ur": "go = False\n" + CONNECT["ur"] + "while not go:\n<A>\nend\n<B>",
        },
        "A B",
    ),
}


def driven(program: Program) -> str:
    letters = []
    for move in program.moves:
        assert isinstance(move.target, JointTarget)
        letters.append("ABC"[round(move.target.joints[0] * 18 / 3.14159265) - 1])
    return " ".join(letters)


@pytest.mark.parametrize(
    ("name", "vendor"),
    [(name, v) for name, case in CASES.items() for v in case.others if v in case.bodies],
)
def test_it_is_decided_by_rule_or_answer(name: str, vendor: str) -> None:
    case = CASES[name]
    file, text = WHOLE[vendor]
    text = text.replace("BODY", case.bodies[vendor]).replace("OTHER", case.others[vendor])
    for k, letter in enumerate("ABC", 1):
        text = text.replace(f"<{letter}>", MOVES[vendor].replace("#", str(10 * k)))
    reader = find_vendor(vendor).reader
    assert reader is not None
    program = reader.read(text, file, ReadOptions(answers=Answers(values=case.values)))
    assert driven(program) == case.driven, [str(note) for note in program.notes]
