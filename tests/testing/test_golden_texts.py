"""Golden texts: what they may state beside the statements."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import ClassVar

import pytest

from flyby.core.dialect import Orientation
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
