"""Golden texts: what they may state beside the statements."""

from __future__ import annotations

from pathlib import Path

import pytest

from flyby.testing.conformance import VendorConformance

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
