"""Writes archives as controllers of several versions would."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from flyby.core.registry import find_robot

from ..machine_data.data_lists import ZERO, machine_data, older, robcor

KR16 = find_robot("kuka/kr16-2")
NAME = "#KR16-2 C4 FLR"
AM_INI = """[Archive]
Name=D:\\cell.zip
Config=All
DiskNo=0
Date=2021.03.04 10:11:12
[Roboter]
RobName=CELL_7
IRSerialNr=0658424
[Version]
Version={version}
[TechPacks]
TechPacks=|GripperTech|
"""
CONFIG = """&ACCESS RVP
DEFDAT  $CONFIG PUBLIC
;FOLD BASISTECH GLOBALS
DECL FRAME TOOL_DATA[16]
TOOL_DATA[1]={X 0.0,Y 0.0,Z 150.0,A 0.0,B 0.0,C 0.0}
TOOL_DATA[2]={X 10.0,Y 0.0,Z 250.0,A 0.0,B 90.0,C 0.0}
TOOL_DATA[3]={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
DECL CHAR TOOL_NAME[16,24]
TOOL_NAME[1,]="Greifer groß"
TOOL_NAME[2,]="TOOL_DATA[2]"
DECL LOAD LOAD_DATA[16]
LOAD_DATA[1]={M 6.5,CM {X 10.0,Y 0.0,Z 80.0,A 0.0,B 0.0,C 0.0},J {X 0.1,Y 0.2,Z 0.3}}
LOAD_DATA[2]={M -1.0,CM {X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0},J {X 0.0,Y 0.0,Z 0.0}}
DECL FRAME BASE_DATA[32]
BASE_DATA[1]={X 900.0,Y -200.0,Z 400.0,A 90.0,B 0.0,C 0.0}
BASE_NAME[1,]="Tisch"
BASE_DATA[2]={X 1.0,Y 2.0,Z 3.0,A 0.0,B 0.0,C 0.0}
BASE_DATA[3]={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
BASE_TYPE[1]=#BASE
BASE_TYPE[2]=#TCP
TOOL_TYPE[2]=#TCP
DECL MACHINE_DEF_T MACHINE_DEF[16]
DECL MACHINE_FRAME_T MACHINE_FRAME_DAT[32]
MACHINE_DEF[1]={NAME[] "KR16-2",PARENT[] "WORLD",ROOT {X 0.0},MECH_TYPE #ROBOT,GEOMETRY[] " "}
E6AXIS XHOME={A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 10.0,A6 0.0,E1 0.0,E2 0.0}
DECL E6AXIS XHOME1={A1 30.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0,E1 500.0}
REAL DEF_ACC_ORI1=120.0
INT PGNO=0
BOOL CHECK_HOME=TRUE
SIGNAL GRIPPER $OUT[12]
SIGNAL PART_NO $IN[1] TO $IN[8]
SIGNAL GLUE $ANOUT[1]
DECL E6POS XHANDOVER={X 1000.0,Y 0.0,Z 800.0,A 0.0,B 90.0,C 0.0,S 2,T 2}
;ENDFOLD
ENDDAT
"""
CELL = """&ACCESS RVP
DEF  CELL ( )
  ;EXT EXAMPLE1 ( )
  BAS (#INITMOV,0 )
  LOOP
    P00 (#EXT_PGNO,#PGNO_GET,DMY[],0 )
    SWITCH  PGNO ; Select with Programnumber
    CASE 1
      P00 (#EXT_PGNO,#PGNO_ACKN,DMY[],0 ) ; Reset Progr.No.-Request
      PICK ( ) ; Call User-Program
    CASE 2,3
      P00 (#EXT_PGNO,#PGNO_ACKN,DMY[],0 )
      PLACE ( )
    DEFAULT
      P00 (#EXT_PGNO,#PGNO_FAULT,DMY[],0 )
    ENDSWITCH
  ENDLOOP
END
"""
PICK = """&ACCESS RVP
&COMMENT Teil holen für Presse
DEF PICK ( )
  BAS(#INITMOV,0)
  BAS(#TOOL,1)
  BAS(#BASE,1)
  PTP XHOME
  PTP XAPP
  LIN XGRIP
  CLOSE_GRIPPER()
  APPROACH(50.0)
END
DEF HELPER ( )
  WAIT SEC 0.1
END
"""
PICK_DAT = """DEFDAT PICK
DECL E6AXIS XAPP={A1 20.0,A2 -80.0,A3 100.0,A4 0.0,A5 30.0,A6 0.0,E1 0.0}
DECL E6POS XGRIP={X 100.0,Y 50.0,Z 300.0,A 0.0,B 180.0,C 0.0,S 2,T 2,E1 0.0}
ENDDAT
"""
TOOLS_SRC = """DEF HANDLING ( )
END
GLOBAL DEF CLOSE_GRIPPER ( )
  GRIPPER=TRUE
  WAIT SEC 0.2
END
GLOBAL DEF APPROACH (UP:IN)
  REAL UP
  LIN_REL {Z UP}
END
GLOBAL DEFFCT REAL HEIGHT (N:IN)
  INT N
  RETURN N*10.0
ENDFCT
"""
PLACE = """DEF PLACE ( )
  BAS(#INITMOV,0)
  PTP XHOME
  PTP XFAR
END
"""
PLACE_DAT = """DEFDAT PLACE PUBLIC
DECL GLOBAL E6AXIS XFAR={A1 -40.0,A2 -80.0,A3 100.0,A4 0.0,A5 30.0,A6 0.0}
ENDDAT
"""
SPS = """DEF SPS ( )
  LOOP
    WAIT FOR GRIPPER
  ENDLOOP
END
"""

Files = dict[str, str | bytes]


def programs(folder: str = "KRC/R1") -> Files:
    """Programs that call each other across folders."""
    return {
        f"{folder}/cell.src": CELL,
        f"{folder}/Program/Line/PICK.src": PICK,
        f"{folder}/Program/Line/PICK.dat": PICK_DAT,
        f"{folder}/Program/PLACE.src": PLACE,
        f"{folder}/Program/PLACE.dat": PLACE_DAT,
        f"{folder}/Program/lib/HANDLING.src": TOOLS_SRC,
        f"{folder}/System/sps.sub": SPS,
    }


def archive(version: str = "V8.3.21", *, machine: str | None = None, **options: str) -> Files:
    """A whole one of KSS 8 or later."""
    lists = machine if machine is not None else machine_data(KR16, NAME, **options)
    # What STEU holds differs, and R1 counts.
    rest = f"DEFDAT $MACHINE PUBLIC\n$LENGTH_A=1.0\n$ROBROOT={ZERO}\n$DECEL_MB=240\nENDDAT\n"
    return {
        "am.ini": AM_INI.format(version=version),
        **programs(),
        "KRC/R1/System/$config.dat": CONFIG,
        "KRC/R1/Mada/$machine.dat": lists,
        "KRC/R1/Mada/$robcor.dat": robcor(NAME, 16.0),
        "KRC/STEU/Mada/$machine.dat": rest,
        "KRC/STEU/Mada/$option.dat": "DEFDAT $OPTION PUBLIC\nENDDAT\n",
        "C/KRC/ROBOTER/Template/vorgabe.src": "DEF vorgabe ( )\nPTP HOME\nEND\n",
    }


def kr_c2() -> Files:
    """KSS 4.1: components in lower case, no comments, upper-case names of files."""
    made: Files = {}
    for name, text in archive("V4.1.7").items():
        data = name.lower().endswith(".dat") and isinstance(text, str)
        upper = name.upper() if "$" not in name else name.replace("$machine", "$MACHINE")
        made[upper] = older(text) if data and isinstance(text, str) else text
    made["KRC/R1/Mada/$MACHINE.dat"] = older(machine_data(KR16, "#KR16 FLR", raise_time=True))
    return {name: text for name, text in made.items() if not name.startswith("KRC/R1/MADA")}


def written(folder: Path, files: Mapping[str, str | bytes]) -> Path:
    """An archive on disk: CR LF, Latin-1."""
    for name, text in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        data = text if isinstance(text, bytes) else text.replace("\n", "\r\n").encode("latin-1")
        file.write_bytes(data)
    return folder
