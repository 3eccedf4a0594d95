"""The checker of RAPID takes a sound module and refuses each of its broken variants."""

from __future__ import annotations

import pytest

from .check import Refused
from .rapid import check_rapid

SOUND = r'''MODULE Job
  ! A sound module.
  RECORD spot
    robtarget place;
    num seconds;
  ENDRECORD
  CONST robtarget p10 := [[500,0,600],[0.7071068,0,0.7071068,0],
    [0,-1,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget home := [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST speeddata v123 := [123,500,5000,1000];
  CONST zonedata z12 := [FALSE,12,18,18,1.8,18,1.8];
  PERS tooldata gun := [TRUE,[[0,0,100],[1,0,0,0]],[1.5,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata table := [FALSE,TRUE,"",[[0,0,0],[1,0,0,0]],[[10,0,0],[1,0,0,0]]];
  TASK PERS loaddata part := [2,[0,0,10],[1,0,0,0],0,0,0];
  CONST string title := "say ""go""";
  VAR num steps{3} := [1,2,3];
  VAR spot first;

  PROC main()
    VAR num i;
    AccSet 50,80;
    ConfL \Off;
    GripLoad part;
    MoveAbsJ home\NoEOffs,v123\T:=2,fine,gun;
    MoveJ p10,vmax,z12,gun\WObj:=table;
    MoveL Offs(p10,0,0,-steps{2}),v123\V:=50,z12\Z:=3,gun\WObj:=table;
    MoveC first.place,p10,v100,z10,gun;
    FOR i FROM 1 TO 3 DO
      again:
      IF i > 2 AND NOT (steps{i} = 4) THEN
        WaitTime 0.5;
      ELSEIF i = 2 THEN
        GOTO again;
      ELSE
        approach p10\quick;
      ENDIF
    ENDFOR
    WHILE TRUE DO
      TEST i
      CASE 1,2:
        TPWrite title;
      DEFAULT:
        Stop;
      ENDTEST
    ENDWHILE
  ERROR
    RETRY;
  ENDPROC

  LOCAL PROC approach(robtarget goal\switch quick)
    IF i_am_done(1) RETURN;
    MoveL goal,v10,fine,tool0;
  ENDPROC

  FUNC bool i_am_done(num count)
    RETURN 2*count > 2/3 OR steps{1} = 1;
  ENDFUNC
ENDMODULE
'''
BREAKS = [
    ("MODULE Job", "MODULE PROC"),  # a reserved word
    ("MODULE Job", "MODULE " + "J" * 33),
    ("ENDMODULE", ""),
    ("  ENDPROC\n\n  FUNC", "  FUNC"),
    ("ENDFOR", ""),
    ("ENDIF", "ENDWHILE"),
    ("PROC main", "PROC start"),
    ("CONST robtarget p10", "CONST robtarget home"),  # declared twice
    ("CONST robtarget p10", "CONST robtarget V123"),  # names are the same in any case
    ("CONST robtarget p10", "CONST robtarget v100"),  # the controller's own
    ("CONST robtarget p10", "CONST robtraget p10"),
    ("[[500,0,600],", "[[500,0],"),
    ("[0.7071068,0,0.7071068,0]", "[0.7,0,0.6,0]"),
    ("[0,-1,0,1]", "[0,-1.5,0,1]"),
    ("[0,-1,0,1]", "[0,-1,0,9]"),
    ("[0,-1,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]", "[0,-1,0,1],[9E9,9E9,9E9,9E9,9E9]"),
    ("[0,0,0,0,30,0]", "[0,0,0,0,30]"),
    ("[123,500,5000,1000]", "[123,500,5000]"),
    ("[123,500,5000,1000]", "[-123,500,5000,1000]"),
    ("[FALSE,12,", "[0,12,"),
    ("[FALSE,12,18,18", "[FALSE,12,8,18"),
    ("[1.5,[0,0,50]", "[0,[0,0,50]"),
    ("PERS tooldata", "CONST tooldata"),
    ("PERS wobjdata", "VAR wobjdata"),
    ('TRUE,"",[[0', "TRUE,0,[[0"),
    ('"say ""go"""', '"say "go""'),
    ('"say ""go"""', '"' + "x" * 81 + '"'),
    ("[1,2,3]", "[1,2,TRUE]"),
    ("[1,2,3]", "1"),
    ("AccSet 50,80", "AccSet 50"),
    ("AccSet 50,80", "AccSet 50,80,90"),
    ("AccSet 50,80", "Accset50,80"),
    ("AccSet 50,80", 'AccSet 50,"80"'),
    ("ConfL \\Off", "ConfL \\Of"),
    ("ConfL \\Off", "ConfL \\Off:=1"),
    ("home\\NoEOffs", "home\\NoOffs"),
    ("v123\\T:=2", "v123\\T"),
    ("v123\\T:=2,fine", "v123,fine\\T:=2"),
    ("MoveAbsJ home", "MoveAbsJ p10"),
    ("MoveJ p10,", "MoveJ home,"),
    ("MoveJ p10,vmax,z12,gun", "MoveJ p10,z12,vmax,gun"),
    ("MoveJ p10,vmax,z12,gun", "MoveJ p10,vmax,z12"),
    ("MoveJ p10,vmax,z12,gun", "MoveJ p10,v124,z12,gun"),
    ("MoveJ p10,vmax,z12,gun", "MoveJ p10,vmax,z11,gun"),
    ("MoveJ p10,vmax,z12,gun", "MoveJ p10,vmax,z12,gum"),
    ("MoveJ p10,vmax,z12,gun", "MoveJ p11,vmax,z12,gun"),
    ("MoveJ p10,", "MoveX p10,"),
    ("gun\\WObj:=table;\n    MoveL", "gun\\WObj:=gun;\n    MoveL"),
    ("gun\\WObj:=table;\n    MoveL", "gun,\\WObj=table;\n    MoveL"),
    ("gun\\WObj:=table;\n    MoveL", "gun\\WObj:=table\n    MoveL"),
    ("MoveC first.place,p10", "MoveC p10"),
    ("first.place", "first.spot"),
    ("-steps{2}", "steps{2"),
    ("Offs(p10", "Off(p10"),
    ("i > 2", "i >> 2"),
    ("i > 2", "j > 2"),
    ("GOTO again", "GOTO agin"),
    ("approach p10\\quick", "approach\\quick p10"),
    ("approach p10\\quick", "approach p10\\fast"),
    ("approach p10\\quick", "reach p10"),
    ("WaitTime 0.5", "WaitTime 0.5.1"),
    ("WaitTime 0.5", "WaitTime 1E39"),
    ("! A sound", "! Größe, a sound"),
    ("! A sound", "! A sound\x00"),
    ("! A sound", "! A" + " very" * 200 + " sound"),
    ("VAR num i;\n    AccSet 50,80;", "AccSet 50,80;\n    VAR num i;"),
    ("VAR num i;", "PERS num i := 1;"),
    ("VAR num i;", "VAR num i;\n    VAR num I;"),
    ("TASK PERS", "TASK CONST"),
    ("RETRY;", "RETRY"),
]


def test_a_sound_module_is_taken() -> None:
    check_rapid({"Job.mod": SOUND})


def test_without_a_module_nothing_is_taken() -> None:
    with pytest.raises(Refused):
        check_rapid({"Job.txt": SOUND})


@pytest.mark.parametrize(("old", "new"), BREAKS)
def test_a_broken_module_is_refused(old: str, new: str) -> None:
    assert SOUND.count(old) >= 1
    with pytest.raises(Refused):
        check_rapid({"Job.mod": SOUND.replace(old, new, 1)})
