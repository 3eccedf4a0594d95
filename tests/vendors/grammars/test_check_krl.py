"""The checker of KRL takes a sound program and refuses each of its broken variants."""

from __future__ import annotations

import pytest

from .check import Refused
from .krl import check_krl

SRC = """&ACCESS RVP
&REL 1
DEF job ( )
;FOLD DECL
DECL INT i
REAL depth[3]
;ENDFOLD
;FOLD INI
BAS (#INITMOV,0 )
;ENDFOLD (INI)
$BASE=BASE_DATA[1]
$TOOL={X 0.0,Y 0.0,Z 100.0,A 0,B -90,C 0}
$LOAD.M=2.5
BAS(#VEL_PTP,50)
$VEL_AXIS[1]=50
$VEL.CP=0.25
$ACC={CP 1.0,ORI1 100.0,ORI2 100.0}
$APO.CDIS=5.5
$APO.CPTP=80
PTP xstart C_PTP
PTP xp1 C_PTP C_DIS
LIN xp1:shift C_DIS
LIN {X 10,Y 20,Z 30,A 0,B 90,C 0,S 'B010',T 10}
CIRC xp1,xp2,CA 90.0 C_ORI
LIN_REL {Z 5.0}
SLIN xp2 WITH $VEL.CP=0.1,$ACC.CP=2.0 C_SPL
again:
FOR i=1 TO 3 STEP 1
  IF (i==2) AND NOT $IN[3] THEN
    WAIT SEC 0.5
    GOTO again
  ELSE
    depth[i]=ABS(depth[1])*2.0-1.0E-3
  ENDIF
ENDFOR
SWITCH i
CASE 1,2
  $OUT[4]=TRUE
DEFAULT
  WAIT FOR $IN[5]
ENDSWITCH
REPEAT
  grip(i,TRUE)
UNTIL i>3
TRIGGER WHEN PATH=-20 DELAY=0 DO $OUT[2]=TRUE
LIN xp2
END

DEF grip(count:IN,shut:OUT)
LOOP
  EXIT
ENDLOOP
RETURN
END
"""
DAT = """&ACCESS RVP
DEFDAT job
;FOLD EXTERNAL DECLARATIONS
EXT BAS (BAS_COMMAND :IN,REAL :IN )
;ENDFOLD
DECL E6POS xp1={X 500.5,Y -3,Z 1.0E3,A 0,B 90,C 0,S 2,T 10,E1 0.0}
DECL E6POS xp2={X 510.5,Y -3,Z 1.0E3,A 0,B 90,C 0,S 2,T 10}
E6AXIS xstart={A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
DECL FRAME shift={X 0,Y 0,Z 5,A 0,B 0,C 0}
DECL FDAT fp1={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE,POINT2[] " ",TQ_STATE FALSE}
DECL REAL table[2]
table[1]=2.0
ENDDAT
"""
SRC_BREAKS = [
    ("DEF job", "DEF work"),  # called as its file
    ("DEF job", "DEF LIN"),
    ("DEF job ( )", "DEF job"),
    ("DECL INT i", "DECL INT i=1"),  # no initial value in a source file
    ("DECL INT i", "DECL INT xp1"),  # in the data list as well
    ("DECL INT i", "DECL INT $i"),
    ("DECL INT i", "DECL WHOLE i"),
    ("DECL INT i\nREAL depth[3]", "DECL INT i REAL depth[3]"),
    ("BAS (#INITMOV,0 )", "BAS (#INITMOVE,0 )"),
    ("BAS (#INITMOV,0 )", "BASE (#INITMOV,0 )"),
    ("BAS (#INITMOV,0 )", "BAS (#INITMOV,0 )\nDECL INT k"),  # declarations come first
    ("BAS(#VEL_PTP,50)", "BAS(#VEL_PTP,150)"),
    ("BAS(#VEL_PTP,50)", "BAS(#VEL_PTP,50"),
    ("$VEL_AXIS[1]=50", "$VEL_AXIS[1]=50.5"),
    ("$VEL_AXIS[1]=50", "$VEL_AXIS[13]=50"),
    ("$VEL_AXIS[1]=50", "$VEL_AXIS=50"),
    ("$VEL_AXIS[1]=50", "$VEL_AXES[1]=50"),
    ("$VEL.CP=0.25", "$VEL.CP=0.0"),
    ("$VEL.CP=0.25", "$VEL.CB=0.25"),
    ("$VEL.CP=0.25", "$VEL=0.25"),
    ("$VEL.CP=0.25", "$VEL.CP=0.25 $APO.CDIS=3"),
    ("$VEL.CP=0.25", "$VEL.CP:=0.25"),
    ("$APO.CPTP=80", "$APO.CPTP=180"),
    ("Z 100.0,A 0", "Z 100.0,Z 0"),
    ("Z 100.0,A 0", "Z 100.0 A 0"),
    ("Z 100.0,A 0", "A 0"),  # a frame that is set whole has all six
    ("{CP 1.0,ORI1", "{CP i,ORI1"),  # aggregates hold constants
    ("$TOOL={", "$TOOL=BASE_DATA[1] {"),
    ("$LOAD.M=2.5", "$LOAD.MASS=2.5"),
    ("PTP xstart C_PTP", "PTP xstart C_DIST"),
    ("PTP xstart C_PTP", "PTP xstart, C_PTP"),
    ("PTP xstart C_PTP", "PTP xbegin C_PTP"),
    ("PTP xstart C_PTP", "PTP"),
    ("LIN xp1:shift C_DIS", "LIN xstart C_DIS"),
    ("LIN xp1:shift C_DIS", "LIN xp1:shift C_PTP"),
    ("S 'B010'", "S 'B012'"),
    ("S 'B010'", "S 200"),
    ("S 'B010'", "S 2.5"),
    ("LIN {X 10,", "LIN {A1 10,"),
    ("CIRC xp1,xp2,", "CIRC xp1,"),
    ("CA 90.0 C_ORI", "C_ORI CA 90.0"),
    ("WITH $VEL.CP=0.1,", "WITH $VEL.CP=0.1"),
    ("again:\n", ""),
    ("again:\n", "again:\nagain:\n"),
    ("FOR i=1 TO 3", "FOR i:=1 TO 3"),
    ("ENDFOR", "END FOR"),
    ("  ENDIF\n", ""),
    ("i==2", "i=2"),
    ("(i==2) AND", "(i==2 AND"),
    ("WAIT SEC 0.5", "WAIT 0.5"),
    ("ABS(depth", "ABSOLUTE(depth"),
    ("grip(i,TRUE)", "grip(i,TRUE,1)"),
    ("grip(i,TRUE)", "grasp(i,TRUE)"),
    ("UNTIL i>3", "UNTIL j>3"),
    ("TRIGGER WHEN PATH=-20 DELAY=0 DO", "TRIGGER WHEN PATH=-20 DO"),
    ("DEF grip(count:IN", "DEF job(count:IN"),
    ("DEF grip(", "DEF g" + "r" * 24 + "ip("),
    ("ENDLOOP\n", "ENDLOOP\nWHILE\n"),
    (";FOLD DECL", ";FOLD Erklärung"),
    (";FOLD DECL", ";FOLD\x0b DECL"),
    (";FOLD DECL", ";FOLD " + "very " * 200 + "DECL"),
]
DAT_BREAKS = [
    ("DEFDAT job", "DEFDAT work"),
    ("ENDDAT\n", ""),
    ("ENDDAT", "END"),
    ("DECL E6POS xp1=", "DECL E6POS xp1\nxp1="),  # declared and set on one line
    ("DECL E6POS xp1=", "DECL E7POS xp1="),
    ("DECL E6POS xp1=", "DECL E6AXIS xp1="),
    ("DECL E6POS xp1=", "E6POS xp1"),
    ("DECL E6POS xp2=", "DECL E6POS XP1="),
    ("DECL E6POS xp1=", "DECL E6POS a_point_of_the_whole_cell="),
    ("DECL E6POS xp1=", "DECL E6POS PTP="),
    ("X 500.5,Y -3", "X 500.5,Y - -3"),
    ("X 500.5,Y -3", "X 500.5;Y -3"),
    ("X 500.5,Y -3,", "X 500.5,"),
    ("X 500.5", "X 500.5.1"),
    ("X 500.5", "X 1.0E39"),
    ("X 500.5", "X TRUE"),
    ("X 500.5", "X 1+2"),
    ("S 2,T 10,E1", "S 2.5,T 10,E1"),
    ("S 2,T 10,E1", "S 2,T 5000,E1"),
    ("A6 0}", "A7 0}"),
    ("A6 0}", "}"),
    ("#BASE", "#BASIS"),
    ("TQ_STATE FALSE", "TQ_STATE 0"),
    ("TOOL_NO 1", 'TOOL_NO "1"'),
    ("table[1]=2.0", "tabel[1]=2.0"),
]


def test_a_sound_program_is_taken() -> None:
    check_krl({"job.src": SRC, "job.dat": DAT})


@pytest.mark.parametrize(("old", "new"), SRC_BREAKS)
def test_a_broken_source_is_refused(old: str, new: str) -> None:
    assert old in SRC
    with pytest.raises(Refused):
        check_krl({"job.src": SRC.replace(old, new, 1), "job.dat": DAT})


@pytest.mark.parametrize(("old", "new"), DAT_BREAKS)
def test_a_broken_data_list_is_refused(old: str, new: str) -> None:
    assert old in DAT
    with pytest.raises(Refused):
        check_krl({"job.src": SRC, "job.dat": DAT.replace(old, new, 1)})


SETTINGS = """DEF short( )
DECL E6POS goal
$BASE=$NULLFRAME
$TOOL=TOOL_DATA[1]
$VEL.CP=0.2
$APO.CDIS=3
$APO.CPTP=50
PTP goal C_PTP
LIN goal C_DIS
END
"""


@pytest.mark.parametrize("line", SETTINGS.splitlines()[2:7])
def test_what_is_not_set_is_found(line: str) -> None:
    check_krl({"short.src": SETTINGS})
    with pytest.raises(Refused, match="is not set"):
        check_krl({"short.src": SETTINGS.replace(line + "\n", "")})


def test_files_come_in_pairs() -> None:
    with pytest.raises(Refused, match="no source file"):
        check_krl({"job.dat": DAT})
    with pytest.raises(Refused, match="without its source"):
        check_krl({"job.src": SRC, "job.dat": DAT, "other.dat": DAT})
    with pytest.raises(Refused, match="not declared"):
        check_krl({"job.src": SRC})


LOG_SRC = """DEF log(what:IN)
DECL KIND what
DECL STATE_T stat
DECL MODUS_T mode
mode=#SYNC
IF what==#FIRST THEN
  count=0
ENDIF
CWRITE($FCT_CALL,stat,mode,"krl_fopen","a.csv","w",count)
END
"""
LOG_DAT = """DEFDAT log PUBLIC
GLOBAL ENUM KIND FIRST,LAST
DECL GLOBAL INT count=0
ENDDAT
"""
USER = """DEF user( )
log(#FIRST)
count=count+1
END
"""


def test_modules_share_what_is_global() -> None:
    sources = {"log.src": LOG_SRC, "log.dat": LOG_DAT, "user.sub": USER}
    check_krl(sources)
    with pytest.raises(Refused, match="needs a data list that is PUBLIC"):
        check_krl({**sources, "log.dat": LOG_DAT.replace(" PUBLIC", "")})
    with pytest.raises(Refused, match="not declared"):
        check_krl({**sources, "log.dat": LOG_DAT.replace("GLOBAL INT", "INT")})
    with pytest.raises(Refused, match="no such routine"):
        check_krl({"user.src": USER})
