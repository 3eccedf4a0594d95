"""Loops with branches that nobody knows: what is asked of them does not grow with the passes."""

from __future__ import annotations

from pathlib import Path

import pytest

from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.analysis import Analysis
from flyby.vendors.kuka.run import flow as krl

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


def test_rapid(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    deciding = Analysis.deciding

    def counting(self, body, reads, left_out):  # type: ignore[no-untyped-def]
        asked.append(len(left_out))
        return deciding(self, body, reads, left_out)

    monkeypatch.setattr(Analysis, "deciding", counting)
    assert moves("abb", "abb/irb6640-180-255", tmp_path / "m.mod", RAPID) == 1
    assert max(asked) == 2


def test_krl(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    names_written = krl.names_written

    def counting(*arguments):  # type: ignore[no-untyped-def]
        asked.append(1)
        return names_written(*arguments)

    monkeypatch.setattr(krl, "names_written", counting)
    assert moves("kuka", "kuka/kr30-3", tmp_path / "m.src", KRL) == 1
    assert len(asked) <= 2
