"""Loops that wait for an output which the program has set, and write others, or may write it."""

from __future__ import annotations

from pathlib import Path

import pytest

from flyby.core.registry import find_robot, find_vendor

RAPID = """MODULE m
  PROC main()
    MoveAbsJ [[0,-4,69,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
    Set do3;
    WHILE DOutput(do3)=1 DO
      SetDO do5,1;
      WaitTime 0.1;
    ENDWHILE
    Set do3;
    WHILE DOutput(do3)=1 DO
      IF di1=1 Reset do3;
      WaitTime 0.1;
    ENDWHILE
    MoveAbsJ [[10,-4,69,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""
KRL = """DEF m()
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
$OUT[3]=TRUE
WHILE $OUT[3]
$OUT[5]=TRUE
WAIT SEC 0.1
ENDWHILE
$OUT[3]=TRUE
WHILE $OUT[3]
IF $IN[1] THEN
$OUT[3]=FALSE
ENDIF
WAIT SEC 0.1
ENDWHILE
PTP {A1 10,A2 -90,A3 90,A4 0,A5 60,A6 0}
END
"""
URSCRIPT = """def m():
  thread lamp():
    while True:
      set_digital_out(6, True)
      sleep(0.1)
    end
  end
  set_digital_out(4, True)
  lit = run lamp()
  movej([0,-1.5,1.5,0,0.5,0], a=1, v=1)
  set_digital_out(3, True)
  while get_digital_out(3):
    set_digital_out(5, True)
    sleep(0.1)
  end
  set_digital_out(3, True)
  while get_digital_out(3):
    if get_digital_in(1):
      set_digital_out(3, False)
    end
    sync()
  end
  if not get_digital_out(4):
    movej([1,-1.5,1.5,0,0.5,0], a=1, v=1)
  end
  movej([0.1,-1.5,1.5,0,0.5,0], a=1, v=1)
end
"""


@pytest.mark.parametrize(
    ("vendor", "robot", "suffix", "text"),
    [
        ("abb", "abb/irb6640-180-255", ".mod", RAPID),
        ("kuka", "kuka/kr30-3", ".src", KRL),
        ("ur", "ur/ur10e", ".script", URSCRIPT),
    ],
)
def test_such_loops_are_waits(
    tmp_path: Path, vendor: str, robot: str, suffix: str, text: str
) -> None:
    path = tmp_path / f"m{suffix}"
    path.write_text(text, "utf-8")
    program = find_vendor(vendor).read_file(path, robot=find_robot(robot))
    assert len(program.moves) == 2
