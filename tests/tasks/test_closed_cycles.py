"""The way from the end of a production loop to its beginning is driven, timed and proven."""

from __future__ import annotations

import pytest

import flyby
from flyby.core.errors import FlybyError

CELL = """robot = "abb/irb6640-180-255"
clearance_mm = 5
[[obstacle]]
name = "bin"
box_mm = [80, 80, 80]
pose = { xyz_mm = [1600, 100, 1300], quat_wxyz = [1, 0, 0, 0] }
"""
PASS = "".join(
    f"MoveL [[1600,{y},{z}],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z20,tool0;\n"
    for y, z in ((250, 1300), (250, 1500), (-50, 1500), (-50, 1300))
)
LOOP = "WHILE TRUE DO\n{0}ENDWHILE\n"
PROGRAM = "MODULE m\nPROC main()\n{0}ENDPROC\nENDMODULE\n"


@pytest.fixture
def files(tmp_path):
    program, cell = tmp_path / "m.mod", tmp_path / "cell.toml"
    program.write_text(PROGRAM.format(LOOP.format(PASS)), "utf-8")
    cell.write_text(CELL, "utf-8")
    return program, cell


def test_the_cycle_is_a_pass_from_where_the_one_before_ends(files) -> None:
    program, _ = files
    report = flyby.emulate(flyby.read(program, robot="abb/irb6640-180-255")).report
    last = report.moves[-4:]
    assert len(report.moves) == 8 and min(move.length for move in last) > 0.19
    assert report.cycle_time == pytest.approx(sum(m.time + m.settling for m in last))
    assert report.cycle_time < report.driven_time


def test_no_loop_is_certified_that_collides_on_its_way_back(files) -> None:
    """Of the pass itself only the way back meets the bin: one pass alone would be proven."""
    program, cell = files
    with pytest.raises(FlybyError, match="collides as it is"):
        flyby.zones(flyby.read(program, cell=cell))
    program.write_text(PROGRAM.format(PASS), "utf-8")
    assert flyby.zones(flyby.read(program, cell=cell)).proven
