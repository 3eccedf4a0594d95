"""Programs that were saved as plain text are read as what they are."""

from __future__ import annotations

from pathlib import Path

import pytest

import flyby
from flyby.core.errors import InputError

POINT = "{X 900,Y %d,Z 900,A 0,B 180,C 0}"
KRL = (
    "&ACCESS RVP\nDEF wechsel( )\nBAS(#INITMOV,0)\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n"
    "PTP XLINKS\nLIN XRECHTS\nEND\n"
)
DATA = (
    f"DEFDAT wechsel\nDECL E6POS XLINKS={POINT % 200}\nDECL E6POS XRECHTS={POINT % -200}\nENDDAT\n"
)
RAPID = (
    "MODULE m\nPROC main()\nMoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\n"
    "ENDPROC\nENDMODULE\n"
)


@pytest.mark.parametrize("names", [("wechsel.src.txt", "wechsel.dat.TXT"), ("w.txt", "w.dat")])
def test_krl_with_its_data_list(names: tuple[str, str], tmp_path: Path) -> None:
    main, data = (tmp_path / name for name in names)
    main.write_text(KRL, "utf-8")
    data.write_text(DATA, "utf-8")
    (tmp_path / "notes.txt").write_text("XLINKS was taught by hand", "utf-8")
    program = flyby.read(main, robot="kuka/kr30-3")
    assert len(program.moves) == 2 and not any(move.open for move in program.moves)
    assert flyby.emulate(program, robot="kuka/kr30-3").duration > 0


def test_a_program_has_no_data_of_a_copy_as_text(tmp_path: Path) -> None:
    """Beside a ``.src`` stands what was put there to be read, not what was written off it."""
    main = tmp_path / "wechsel.src"
    main.write_text(KRL, "utf-8")
    (tmp_path / "wechsel.dat.txt").write_text(DATA, "utf-8")
    moves = flyby.read(main, robot="kuka/kr30-3").moves
    assert all("unknown point" in move.open for move in moves)


def test_rapid_and_urscript(tmp_path: Path) -> None:
    file = tmp_path / "main.txt"
    for robot, text in (
        ("abb/irb1200-5-090", RAPID),
        ("ur/ur5e", "def main():\n  movej([0,-1,1,-1,-1,0])\nend\n"),
    ):
        file.write_text(text, "utf-8")
        assert len(flyby.read(file, robot=robot).moves) == 1
    with pytest.raises(InputError, match="is a program for ur, the robot is driven by kuka"):
        flyby.read(file, robot="kuka/kr30-3")
