"""Loops with branches that nobody knows: what is asked of them does not grow with the passes."""

from __future__ import annotations

from pathlib import Path

import pytest

from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.control_flow.analysis import Analysis

PASSES = 300
RAPID = f"""MODULE m
  PROC main()
    VAR num i:=0;
    WHILE i<{PASSES} DO
      Incr i;
      IF di1=1 SetDO do1,1;
      IF di2=1 RETURN;
    ENDWHILE
    MoveAbsJ [[0,-4,69,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""
KRL = f"""DEF m()
DECL INT I
I=0
WHILE I<{PASSES}
I=I+1
IF $IN[1] THEN
$OUT[1]=TRUE
ENDIF
ENDWHILE
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}}
END
"""


def moves(vendor: str, robot: str, path: Path, text: str) -> int:
    path.write_text(text, "utf-8")
    return len(find_vendor(vendor).read_file(path, robot=find_robot(robot)).moves)


@pytest.mark.parametrize(
    ("vendor", "robot", "file", "text", "most"),
    [
        ("abb", "abb/irb6640-180-255", "m.mod", RAPID, 2),
        ("kuka", "kuka/kr30-3", "m.src", KRL, 1),
    ],
)
def test_branches_left_out_count_once(  # type: ignore[no-untyped-def]
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, vendor, robot, file, text, most
) -> None:
    asked: list[int] = []
    deciding = Analysis.deciding

    def counting(self, body, reads, left_out):  # type: ignore[no-untyped-def]
        asked.append(len(left_out))
        return deciding(self, body, reads, left_out)

    monkeypatch.setattr(Analysis, "deciding", counting)
    assert moves(vendor, robot, tmp_path / file, text) == 1
    assert max(asked) == most
