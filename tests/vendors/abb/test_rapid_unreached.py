"""Routines that move the robot and that a run does not come to are named."""

from __future__ import annotations

import pytest

import flyby

TEXT = """MODULE tray
  CONST robtarget pOver:=[[450,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS bool bSendReq:=FALSE;
  PERS num nKind{3}:=[0,0,0];
  PROC main()
    MoveJ pOver,v500,fine,tool0;
    WHILE NOT bSendReq DO
      WaitTime 0.2;
    ENDWHILE
    FOR i FROM 1 TO 3 DO
      IF nKind{i}<>0 Fetch nKind{i};
    ENDFOR
    MoveL Offs(pOver,0,0,50),v200,fine,tool0;
  ENDPROC
  PROC Fetch(num kind)
    IF kind=1 Low;
    IF kind=2 High;
  ENDPROC
  PROC Low()
    MoveL Offs(pOver,0,0,-80),v200,fine,tool0;
    MoveL pOver,v200,fine,tool0;
  ENDPROC
  PROC High()
    MoveL Offs(pOver,0,90,-20),v200,fine,tool0;
    MoveL pOver,v200,fine,tool0;
  ENDPROC
  PROC Aside()
    MoveL pOver,v200,fine,tool0;
  ENDPROC
ENDMODULE
"""


def told(text: str, **options: str) -> list[str]:
    program = flyby.read(text, robot="abb/irb1200-5-090", **options)
    return [note.message for note in program.notes if "are driven: conditions" in note.message]


def test_most_of_the_motion_that_is_passed_by_is_said() -> None:
    (message,) = told(TEXT)
    assert message.startswith("2 of 6 statements that move the robot are driven")
    assert "conditions lead past Low, High; entry" in message


@pytest.mark.parametrize(
    "text",
    [
        TEXT.replace("[0,0,0];", "[1,0,0];"),  # more is driven than not
        TEXT.replace("[0,0,0];", "[1,2,0];"),
        TEXT.replace("IF nKind{i}<>0 Fetch nKind{i};", "n:=i;").replace(
            "PERS bool", "VAR num n;\n  PERS bool"
        ),  # nothing leads there
    ],
)
def test_what_is_driven_for_the_most_part_is_not(text: str) -> None:
    assert told(text) == []


def test_routines_beside_the_one_that_is_driven_do_not_count() -> None:
    assert told(TEXT, entry="Aside") == []
