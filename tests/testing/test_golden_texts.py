"""Golden texts: what they may state beside the statements."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

import pytest

from flyby.core.dialect import Orientation
from flyby.core.errors import InputError
from flyby.core.program.zone import ZoneKind
from flyby.core.registry import find_vendor
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import MotionGrammar, dialect_of
from flyby.core.source.lines.expressions import Spelling
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.lines.positions import PositionForm
from flyby.core.source.lines.settings import Setting, Settings
from flyby.testing.conformance import VendorConformance
from flyby.testing.golden import GoldenText

from ..vendors.words import AbbWords

JOB = """
[[texts]]
about = "a branch"
robot = "irb1600-6-145"
answers = { di1 = %s }
files."job.mod" = '''
MODULE job
  CONST jointtarget a:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget b:=[[10,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    IF di1 = 1 THEN
      MoveAbsJ a, v100, fine, tool0;
    ELSE
      MoveAbsJ b, v100, fine, tool0;
    ENDIF
  ENDPROC
ENDMODULE
'''

[[texts.statements]]
kind = "MoveJ"
joints_deg = [%d, 0, 0, 0, 30, 0]
stands_deg = [%d, 0, 0, 0, 30, 0]
speed = { tcp_mm_s = 100 }
"""


def suite(folder: Path, answer: str, joint: int) -> VendorConformance:
    class Suite(AbbWords, VendorConformance):
        golden = folder / "golden.toml"

    (folder / "golden.toml").write_text(JOB % (answer, joint, joint), "utf-8")
    return Suite()


@pytest.mark.parametrize(("answer", "joint"), [("1", 0), ("0", 10), ("true", 0)])
def test_they_answer_what_a_text_asks(tmp_path: Path, answer: str, joint: int) -> None:
    suite(tmp_path, answer, joint).test_golden_texts_mean_what_their_author_says()


def test_a_text_of_one_joint_move_is_told_that_it_drives_nothing(tmp_path: Path) -> None:
    with pytest.raises(AssertionError, match="goes nowhere") as caught:
        suite(tmp_path, "1", 0).test_golden_moves_stand_where_their_author_says()
    assert "add a move" in str(caught.value) and "label" not in str(caught.value).split("look")[1]


SHARE = {"": Amount("joint_fraction", 0.01)}
MM, ON = {"": Amount("zone", 1e-3)}, {"": Amount("passing", 1.0)}


class Switched(MotionGrammar):
    """``ACCURACY 10``, ``CP OFF``, ``JMOVE #a``"""

    form = PositionForm(Orientation.EULER_ZYZ)
    joints = frozenset({"#"})
    spelling = Spelling(names=True, name=r"#?[A-Za-z_]\w*")
    settings = Settings(
        (
            Setting("SPEED", SHARE, {"MM/S": Amount("tcp", 1e-3)}, 50.0),
            Setting("ACCURACY", MM, MM, 1.0),
            Setting("CP", ON, ON, 1.0, words={"ON": (1.0,), "OFF": (0.0,)}),
        )
    )
    forms: ClassVar = {
        "motion": r"(?P<kind>J)MOVE\s+(?P<point>#\w+)",
        "point": r"(?P<name>(?P<kind>#)\w+)\s*:(?P<values>.*)",
    }


class Language(LineLanguage):
    name = "CP"
    suffix = ".cp"
    dialect = dialect_of(Switched, "; ")
    grammar = Switched


@pytest.mark.parametrize("word", ["OFF", "ON"])
def test_a_zone_that_is_switched_off_is_no_false_alarm(word: str) -> None:
    text = f"#a: 0,10,20,0,50,0\n#b: 9,10,20,0,50,0\nACCURACY 10\nCP {word}\nJMOVE #a\nJMOVE #b\n"

    class Suite(VendorConformance):
        name = "abb"
        vendor = replace(
            find_vendor("abb"),
            reader=Language(),
            patcher=Language(),
            writer=None,
            speaks=Language.dialect,
            suffixes=(".cp",),
        )
        golden_texts = (GoldenText("zones", {"job.cp": text}, ()),)

    Suite().test_recorded_reads_are_those_of_the_text()


REFUSED = """
[[refused]]
about = "a target that there is not"
says = "%s"
robot = "irb1600-6-145"
files."job.mod" = '''
MODULE job
  CONST jointtarget a:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ %s, v100, fine, tool0;
  ENDPROC
ENDMODULE
'''
"""


def refusing(folder: Path, says: str, target: str) -> VendorConformance:
    class Suite(AbbWords, VendorConformance):
        golden = folder / "golden.toml"

    (folder / "golden.toml").write_text(REFUSED % (says, target), "utf-8")
    return Suite()


def test_they_say_what_is_refused_and_with_which_words(tmp_path: Path) -> None:
    refusing(tmp_path, "NOWHERE", "nowhere").test_golden_texts_are_refused_where_their_author_says()
    with pytest.raises(AssertionError, match="is read, and refused by its author"):
        refusing(tmp_path, "nowhere", "a").test_golden_texts_are_refused_where_their_author_says()
    with pytest.raises(AssertionError, match="refused for something else"):
        refusing(
            tmp_path, "a zone", "nowhere"
        ).test_golden_texts_are_refused_where_their_author_says()


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("answers", "tools.gun = { position_mm = [0, 0, 9] }\nanswers", "tools stand before all"),
        ("answers", 'entri = "main"\nanswers', "unknown key 'entri'.*entry"),
        (JOB, '[[refused]]\nabout = "nothing"\n', "what its message 'says'"),
    ],
)
def test_keys_that_are_none_are_named(
    tmp_path: Path, before: str, after: str, message: str
) -> None:
    made = suite(tmp_path, "1", 0)
    file = tmp_path / "golden.toml"
    text = after if before == JOB else file.read_text("utf-8").replace(before, after, 1)
    file.write_text(text, "utf-8")
    with pytest.raises(InputError, match=message):
        assert made.golden_texts


def test_answers_are_called_in_either_case(tmp_path: Path) -> None:
    made = suite(tmp_path, "0", 10)
    file = tmp_path / "golden.toml"
    file.write_text(file.read_text("utf-8").replace("{ di1", "{ DI1"), "utf-8")
    made.test_golden_texts_mean_what_their_author_says()


def test_a_text_with_fewer_moves_than_stated_is_shown(tmp_path: Path) -> None:
    made = suite(tmp_path, "1", 0)
    file = tmp_path / "golden.toml"
    file.write_text(file.read_text("utf-8") + '\n[[texts.statements]]\nkind = "MoveJ"\n', "utf-8")
    with pytest.raises(AssertionError, match="has 2 statements by its author, and 1 as"):
        made.test_golden_moves_stand_where_their_author_says()


MM_S = {"": Amount("tcp", 1e-3)}
HELD = """
[[texts]]
about = "settings"
files."job.held" = '''
#a: 0,10,20,0,50,0
%s'''
%s
"""
MOVE = """
[[texts.statements]]
kind = "MoveJ"
speed = { joint_fraction_percent = %g }
zone = { kind = "Near", size_mm = %g, ratio = %g }
"""


class Held(Switched):
    """``SHARE 50``, ``NEAR 10, 20``"""

    settings = Settings(
        (
            Setting("SHARE", SHARE, MM_S, 80.0),
            Setting(
                *("NEAR", MM, MM, (5.0, 5.0)),
                more=(Amount("behind", 1e-3),),
                omitted=(0.0, 30.0),
                words={"FAR": (200.0, 200.0)},
            ),
        ),
        zone=ZoneKind("Near", None, largest=0.5, unit=1e-3, step=1e-3),
    )


class HeldLanguage(Language):
    grammar = Held
    dialect = dialect_of(Held, "; ")


def held(folder: Path, *moves: tuple[str, float, float, float]) -> VendorConformance:
    class Suite(VendorConformance):
        name = "abb"
        vendor = replace(
            find_vendor("abb"), reader=HeldLanguage(), speaks=HeldLanguage.dialect, writer=None
        )
        golden = folder / "golden.toml"

    lines = "".join(f"{said}\nJMOVE #a\n" for said, *_ in moves)
    rows = "".join(MOVE % (share, near, behind / near) for _, share, near, behind in moves)
    (folder / "golden.toml").write_text(HELD % (lines, rows), "utf-8")
    return Suite()


SAYS_ALL = (
    ("", 80.0, 5.0, 5.0),
    ("SHARE 50", 50.0, 5.0, 5.0),
    ("NEAR 10, 20", 50.0, 10.0, 20.0),
    ("NEAR 10", 50.0, 10.0, 30.0),
    ("NEAR FAR", 50.0, 200.0, 200.0),
)


def test_what_holds_where_nothing_is_said_needs_a_text(tmp_path: Path) -> None:
    check = "test_every_form_of_line_counts_in_a_golden_text"
    whole = held(tmp_path, *SAYS_ALL)
    whole.test_golden_texts_mean_what_their_author_says()
    getattr(whole, check)()
    for left_out, name in (
        (0, "`initial` of the setting SHARE"),
        (3, "`omitted` of the setting NEAR"),
        (4, "the word 'FAR' of the setting NEAR"),
    ):
        rest = [said for k, said in enumerate(SAYS_ALL) if k != left_out]
        if left_out == 0:
            rest[0] = ("SHARE 50\nNEAR 5, 5", 50.0, 5.0, 5.0)
        with pytest.raises(AssertionError, match=re.escape(name)):
            getattr(held(tmp_path, *rest), check)()
