"""What fails in a plugin's own form is named with its place, the form and the exception."""

from __future__ import annotations

from typing import Any, ClassVar

import pytest

from flyby.core.dialect import Dialect, MoveWords, Orientation
from flyby.core.errors import InputError, MotionError, PluginFault
from flyby.core.program.move import Move, MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import Radius
from flyby.core.source.lines.driving import MotionGrammar
from flyby.core.source.lines.forms import FormGrammar, Found
from flyby.core.source.lines.language import LineLanguage, LineWriter
from flyby.core.source.lines.positions import PositionForm
from flyby.core.source.lines.program import Said
from flyby.core.source.lines.statements import Drive, Line, Operand
from flyby.core.source.reading import ReadOptions

WORDS = MoveWords((Radius,), frozenset({"joint_fraction"}))
ROBOT: Any = None


class Grammar(MotionGrammar):
    form = PositionForm(Orientation.EULER_ZYX)
    forms: ClassVar = {
        "missing": r"A\s+(?P<kind>\w+)",
        "unknown.word": r"B (?P<word>\w+)",
        "motion": r"C",
        "pair": r"D (?P<pair>.*)",
    }

    def missing(self, line: Line, found: Found) -> Said:
        found["speed"]
        return None

    def unknown(self, line: Line, found: Found) -> Said:
        return {"ON": None}[found["word"]]

    def pair(self, line: Line, found: Found) -> Said:
        _, _ = found["pair"].split(",")
        return None

    def motion(self, line: Line, found: Found) -> Said:
        def build(target: Any, *_: Any) -> Move:
            return target[6]

        none = Operand(line.span)
        return Drive(line.span, none, none, none, build)


class Writer(LineWriter):
    def move(self, move: Move) -> Any:
        return [{}["MOVE"]]


class Language(LineLanguage):
    name, suffix = "ODD", ".odd"
    dialect = Dialect(WORDS, WORDS, WORDS, "joint_fraction", "; ")

    grammar, writer = Grammar, Writer


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "\n  A fast",
            r"^a\.odd:2:3: 'A fast': the form 'missing' \(groups: kind\) of Grammar fails: "
            r"IndexError: no such group, .*test_faults_of_forms\.py:\d+$",
        ),
        ("B OFF", r"^a\.odd:1:1: 'B OFF': the form 'unknown\.word' .*: KeyError: 'OFF'"),
        (
            "D 1,2,3",
            r"'pair' .*: ValueError: too many values .*; what a text does wrong is an InputError$",
        ),
        ("C", r"^a\.odd:1:1: 'C': Grammar\.motion\.build fails: IndexError: tuple index"),
    ],
)
def test_a_form_that_fails_is_named_with_its_line(text: str, said: str) -> None:
    with pytest.raises(PluginFault, match=said) as found:
        Language().read(text, "a.odd", ReadOptions())
    assert isinstance(found.value.__cause__, IndexError | KeyError | ValueError)


def test_a_writer_that_fails_is_named() -> None:
    program = Program((MoveJ(JointTarget((0.0,) * 6), Speed(joint_fraction=0.5)),))
    with pytest.raises(PluginFault, match=r"Writer\.move fails: KeyError: 'MOVE'"):
        Language().write(program, ROBOT, {})
    said = Program((MoveJ(JointTarget((0.0,) * 6), Speed(tcp=0.5)),))
    with pytest.raises(MotionError):
        Language().write(said, ROBOT, {})


@pytest.mark.parametrize(
    ("forms", "said"),
    [
        ({"motin": "A"}, r"forms of .*Wrong: 'motin' is called as no method of it"),
        ({"nothing": "A("}, r"forms of .*Wrong: 'nothing': missing \)"),
        ({"parse.b": "A"}, r"forms of .*Wrong: 'parse\.b' is what forms are made with"),
    ],
)
def test_a_table_that_is_wrong_is_named(forms: dict[str, str], said: str) -> None:
    wrong = type("Wrong", (FormGrammar,), {"forms": forms})
    with pytest.raises(InputError, match=said):
        wrong()


@pytest.mark.parametrize(
    "initial",
    [{"SPDRATE": {None: 100.0}}, {"SPDRATE": 100.0}, {("SPDRATE", None): {1: 100.0}}],
)
def test_what_registers_hold_at_first_has_one_form(initial: Any) -> None:
    said = r"Wrong\.initial: .*SPDRATE.* write \{\(\".*\", None\): 100\.0\}"
    with pytest.raises(InputError, match=said):
        type("Wrong", (FormGrammar,), {"initial": initial})
