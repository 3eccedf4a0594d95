"""Backups as they have grown over years: every command runs on them, and writes them back."""

from __future__ import annotations

from pathlib import Path

import pytest

import flyby
from flyby.core.errors import InputError

from ...vendors.abb.backup.station import Station, one_robot
from ...vendors.kuka.backup.archives import archive, written

NINES = "[9E9,9E9,9E9,9E9,9E9,9E9]"
DOWN = f"[0,0,1,0],[0,0,0,0],{NINES}]"
TARGETS = [[f"[[{x},{y},700],{DOWN}" for x in (900, 1000)] for y in (0, 200)]
ROWS = [f"[{','.join(row)}]" for row in TARGETS]
MAIN = f"""%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

MODULE MainModule
  ! Zelle 7 - Prüfplatz, geändert 12.03.
  PERS tooldata tGreifer:=[TRUE,[[12.5,0,180],[1,0,0,0]],[4.5,[0,0,60],[1,0,0,0],0.1,0.2,0.3]];
  CONST jointtarget jHome:=[[0,-20,20,0,60,0],{NINES}];
  CONST robtarget pTray{{2,2}}:=[{ROWS[0]},{ROWS[1]}];
  RECORD job
    num row;
    num col;
    speeddata v;
  ENDRECORD
  CONST job jobs{{2}}:=[[1,1,[800,500,5000,1000]],[2,2,[600,500,5000,1000]]];
  PROC main()
    MoveAbsJ jHome\\NoEOffs, v1000, fine, tGreifer;
    Load \\Dynamic, diskhome \\File:="prog/TYPE1.MOD";
    Load \\Dynamic, "HOME:/prog" \\File:="GONE.MOD";
    WHILE TRUE DO
      WaitGI giPart, 1;
      FOR k FROM 1 TO Dim(jobs,1) DO
        %"rPick"%jobs{{k}};
      ENDFOR
      %"rType"+ValToStr(1)%;
    ENDWHILE
  ENDPROC
  PROC rPick(job j)
    MoveJ Offs(pTray{{j.row,j.col}},0,0,120), j.v, z30, tGreifer;
    MoveL RelTool(pTray{{j.row,j.col}},0,0,-15), v200, z5, tGreifer;
    MoveL pTray{{j.row,j.col}}, v100, fine, tGreifer;
    MoveL Offs(pTray{{j.row,j.col}},0,0,120), v400, z30, tGreifer;
  ENDPROC
ENDMODULE
"""
TYPE1 = """MODULE TYPE1
  PROC rType1()
    MoveJ Offs(pDrop,-100,300,300), v1500, z100, tGreifer;
    MoveAbsJ jHome\\NoEOffs, v1000, fine, tGreifer;
  ENDPROC
ENDMODULE
"""
DATA = f"""MODULE Daten(SYSMODULE,NOSTEPIN)
  PERS robtarget pDrop:=[[1100,-500,600],{DOWN};
ENDMODULE
"""


def grown_abb(folder: Path, data: str = DATA) -> Path:
    """Targets in arrays, calls by name, a module of the controller's disk loaded as it runs."""
    modules = {"PROGMOD/MainModule.mod": MAIN, "SYSMOD/Daten.sys": data, "PROGMOD/Fehlt.mod": ""}
    disk = {"HOME/prog/TYPE1.MOD": TYPE1, "HOME/old/MainModule.mod": "MODULE MainModule\nENDMODULE"}
    made = Station(
        system="Zelle7_2024",
        tasks={"TASK1": ("T_ROB1", modules)},
        moc=one_robot("-base_frame_pos_z 0.2"),
        unlisted={name: text.encode("latin-1") for name, text in disk.items()},
    ).write(folder / "2024-03-12 Zelle7 (Kopie)")
    (made / "RAPID/TASK1/PROGMOD/Fehlt.mod").unlink()
    return folder


def test_a_module_of_the_controllers_disk_is_driven(tmp_path: Path) -> None:
    station = grown_abb(tmp_path / "station")
    backup = flyby.open_backup(station)
    notes = [note.message for note in backup.notes]
    assert any("TYPE1.MOD" in note and "is taken as loaded" in note for note in notes)
    assert any("loads HOME/prog/GONE.MOD, which is not in the backup" in note for note in notes)
    entries = {entry.name: entry for task in backup.tasks for entry in task.entries}
    assert entries["rType1"].file.endswith("HOME/prog/TYPE1.MOD")
    run = flyby.emulate(flyby.read(station))
    assert len(run.program.moves) == 1 + 2 * 4 + 2 and not run.faults
    assert not any("rType1" in note.message for note in run.notes)


def test_every_command_takes_it(tmp_path: Path) -> None:
    station = grown_abb(tmp_path / "station")
    assert flyby.check(flyby.read(station))
    grown = flyby.zones(flyby.read(station))
    assert grown.certificate is not None and grown.certificate.proven
    flyby.patch(grown, out=tmp_path / "new")
    changed = tmp_path / "new/2024-03-12 Zelle7 (Kopie)"
    before = station / "2024-03-12 Zelle7 (Kopie)"
    files = [path.relative_to(before) for path in before.rglob("*") if path.is_file()]
    differ = [f for f in files if (before / f).read_bytes() != (changed / f).read_bytes()]
    assert differ and all(f.suffix.lower() == ".mod" for f in differ)
    again = flyby.emulate(flyby.read(tmp_path / "new"))
    moves = zip(again.program.moves, grown.program.moves, strict=True)
    assert all(one.zone == other.zone for one, other in moves)
    with pytest.raises(InputError, match="a station has two robots or more"):
        flyby.station(station)


def test_faults_of_both_sides_are_one_whatever_the_folders_name(tmp_path: Path) -> None:
    """rType1 alone begins where it is not known; the folder's name has blanks and brackets."""
    moved = DATA.replace("1100,-500,600", "1100,-500,640")
    found = flyby.diff(grown_abb(tmp_path / "a"), grown_abb(tmp_path / "b", moved))
    assert found.differs
    assert not any(routine.mended or routine.faults for routine in found.routines)


WELD = """&ACCESS RVP
&REL 17
&COMMENT Schweissen Tür links
DEF Schweiss_Tür( )
;FOLD INI;%{PE}
BAS (#INITMOV,0 )
;ENDFOLD (INI)
;FOLD PTP HOME  Vel= 100 % DEFAULT;%{PE}
PDAT_ACT=PDEFAULT
FDAT_ACT=FHOME
BAS(#PTP_PARAMS,100)
PTP XHOME
;ENDFOLD
;FOLD LIN P2 CONT Vel=0.5 m/s CPDAT1 Tool[1]:Greifer Base[1]:Tisch;%{PE}
LDAT_ACT=LCPDAT1
FDAT_ACT=FP2
BAS(#CP_PARAMS,0.5)
LIN XP2 C_DIS
;ENDFOLD
SPLINE WITH $VEL.CP=0.3
  SPL XP3
  SLIN XP4
  SPL XP2
ENDSPLINE
FOR I=1 TO 2
  LIN_REL {Z 40.0} C_DIS
  Sub_Prog(I)
ENDFOR
PTP XHOME
END
"""
WELD_DAT = """DEFDAT  SCHWEISS_TÜR PUBLIC
DECL INT I
DECL E6POS XP2={X 150.0,Y 150.0,Z 300.0,A 0.0,B 180.0,C 0.0,S 2,T 2,E1 0.0,E2 0.0}
DECL FDAT FP2={TOOL_NO 1,BASE_NO 1,IPO_FRAME #BASE,POINT2[] " "}
DECL LDAT LCPDAT1={VEL 0.5,ACC 100.0,APO_DIST 20.0,APO_FAC 50.0,ORI_TYP #VAR}
DECL E6POS XP3={X 200.0,Y 100.0,Z 330.0,A 0.0,B 180.0,C 0.0,S 2,T 2}
DECL E6POS XP4={X 250.0,Y 0.0,Z 330.0,A 0.0,B 180.0,C 0.0,S 2,T 2}
ENDDAT
"""
SUB = """GLOBAL DEF Sub_Prog(NR:IN)
INT NR
SWITCH NR
CASE 1
  LIN_REL {X 40.0}
DEFAULT
  LIN_REL {Y -40.0}
ENDSWITCH
END
"""


def test_an_archive_with_inline_forms_and_splines_below_folders_of_any_name(tmp_path) -> None:
    folder = "KRC/R1/Program/Kunde/Linie 3"
    names = {"Schweiss_Tür.src": WELD, "schweiss_tür.dat": WELD_DAT, "Sub_Prog.src": SUB}
    files = {**archive(), **{f"{folder}/{name}": text for name, text in names.items()}}
    written(tmp_path / "HALLE2_R07 Archiv", files)
    program = flyby.read(tmp_path, entry="Schweiss_Tür")
    assert len(program.moves) == 10
    findings = [str(finding) for finding in flyby.check(program)]
    assert not any("1000 mm" in finding for finding in findings), findings
    grown = flyby.zones(program)
    assert grown.certificate is not None and grown.certificate.proven
    found = flyby.diff(tmp_path, tmp_path)
    assert not found.differs
