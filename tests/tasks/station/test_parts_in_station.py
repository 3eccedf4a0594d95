"""Stations whose robots pick parts and put them down."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import flyby
from flyby.core.errors import InputError
from flyby.tasks.station.changed import ChangedStation

EXAMPLES = Path(__file__).parents[3] / "examples"
PICK = (EXAMPLES / "pick.script").read_text("utf-8").replace("part < 2", "part < 1")
CELL = (EXAMPLES / "cell" / "pick.toml").read_text("utf-8")
for OLD, NEW in (
    ("count = [2]", "count = [1]"),
    ("cylinder_mm = [30, 60]", "box_mm = [400, 60, 60]"),
):
    assert OLD in CELL
    CELL = CELL.replace(OLD, NEW)
OTHER = """def other():
  movej([3.1416, -1.9, 1.6, -1.5, -1.5708, 0], a=1.4, v=1.05)
  movej([3.1416, {near}, 1.6, -1.5, -1.5708, 0], a=1.4, v=1.05)
  movej([3.1416, -1.9, 1.6, -1.5, -1.5708, 0], a=1.4, v=1.05)
end
"""
STATION = """clearance_mm = 5
[robot.pick]
program = "pick.script"
cell = "pick.toml"
[robot.other]
program = "other.script"
cell = "other.toml"
"""


def station(
    folder: Path, cell: str = CELL, near: float = -1.0, more: str = "", rest: str = ""
) -> Path:
    """A robot that picks a bottle, and one opposite that leans over to where it carries it."""
    (folder / "pick.script").write_text(PICK, "utf-8")
    (folder / "pick.toml").write_text(cell, "utf-8")
    (folder / "other.script").write_text(OTHER.format(near=near), "utf-8")
    (folder / "other.toml").write_text(
        f'robot = "ur/ur10e"\nbase = {{ xyz_mm = [-1500, 0, 0] }}\n{more}', "utf-8"
    )
    file = folder / "station.toml"
    file.write_text(STATION + rest, "utf-8")
    return file


def test_what_is_carried_meets_the_other_robot(tmp_path: Path) -> None:
    """In time they keep clear; at any time what is carried is in the way, and nothing else."""
    (pair,) = flyby.station(station(tmp_path)).clearances
    assert pair.in_time.proven and not pair.any_time.proven
    assert {conflict.pair[0] for conflict in pair.any_time.conflicts.values()} == {"bottle"}
    assert {mine for mine, _ in pair.any_time.conflicts} <= {3, 4, 5}
    (bare,) = flyby.station(
        station(tmp_path, CELL.replace('attach = "set', 'attach = "never'))
    ).clearances
    assert bare.any_time.proven


def test_zones_grow_beside_what_the_other_robot_carries(tmp_path: Path) -> None:
    made = flyby.station_zones(station(tmp_path))
    assert made.proven and made.changed and made.gain > 1.0
    assert {name for name, one in made.solutions.items() if one.changed} >= {"pick"}
    assert [p.in_time.proven for p in flyby.station(_written(made, tmp_path)).clearances] == [True]


def _written(made: ChangedStation, folder: Path) -> Path:
    for name, data in made.files.items():
        path = folder / "new" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    return next((folder / "new").glob("*.toml"))


def test_a_part_that_is_handed_over_is_refused_by_name(tmp_path: Path) -> None:
    put = """[[part]]
name = "piece"
box_mm = [400, 60, 60]
pose = { xyz_mm = [-450, 250, 170] }
attach = "movej"
release = "movel"
"""
    stays = CELL.replace("leaves = true", "")
    with pytest.raises(InputError, match=r"'bottle' of pick lies where 'piece' of other does"):
        flyby.station(station(tmp_path, stays, more=put))
    # Let go for good it is none of the first robot's any more.
    allow = '[allow]\npairs = [["pick.bottle", "other.piece"]]\n'
    assert flyby.station(station(tmp_path, more=put, rest=allow)).clearances


def test_what_is_carried_weighs_in_a_station_as_with_one_robot(tmp_path: Path) -> None:
    """In the torques of the motion and in what is made of it, and not in the programs."""
    file = station(tmp_path, CELL.replace("mass_kg = 0.6", "mass_kg = 9"))
    member = flyby.station(file, no_proof=True).station.members["pick"]
    alone = flyby.emulate(flyby.read(tmp_path / "pick.script", cell=tmp_path / "pick.toml"))
    carried = [move.load for move in alone.parts[0].run.program.moves]
    assert [move.load for move in member.run.program.moves] == carried
    assert any(load is not None and load.mass == pytest.approx(9.0) for load in carried)
    assert all(move.load is None for move in member.program.moves)
    figures = [
        member.controller.energy(program, member.run.timing).value
        for program in (member.run.program, member.program)
    ]
    assert figures[0] > 1.1 * figures[1]

    # Searches try programs without one of the moves.
    fewer = list(member.run.program.moves)
    del fewer[4]
    statements = [s for s in member.run.program.statements if s is not member.run.program.moves[4]]
    shorter = replace(member.run.program, statements=tuple(statements))
    assert list(shorter.moves) == fewer
    assert all(move.load is None for move in member.bare(shorter).moves)

    made = flyby.station_optimize(file, zones_only=True)
    solution = made.solutions["pick"]
    assert made.proven and solution.changed
    assert solution.before.energy.sum() == pytest.approx(figures[0], rel=1e-9)
    assert all(move.load is None for move in solution.program.moves)
    after = made.after.station.members["pick"]
    assert [move.load for move in after.run.program.moves] == carried
    assert after.program.moves == solution.program.moves

    heavy = station(tmp_path, CELL.replace("mass_kg = 0.6", "mass_kg = 20"))
    found = flyby.station_check(heavy, no_proof=True).robots["pick"]
    assert [finding.rule for finding in found].count("payload-exceeded") == 1


def test_parts_that_a_program_does_not_meet_are_said(tmp_path: Path) -> None:
    never = CELL.replace('attach = "set', 'attach = "never')
    notes = flyby.station(station(tmp_path, never), no_proof=True).notes
    assert [n.message.startswith("pick: ") for n in notes if "'bottle'" in n.message] == [True]


def test_parts_are_told_by_the_space_that_they_fill(tmp_path: Path) -> None:
    """Shapes with their origins at one place are two parts, and one part may have two origins."""
    stays = CELL.replace("leaves = true", "")
    put = """[[part]]
name = "piece"
{shape}
pose = {{ xyz_mm = [{at}] }}
attach = "movej"
release = "movel"
"""
    corners = [f"{x} {y} {z}" for x in (0, 400) for y in (0, 60) for z in (0, 60)]
    faces = (
        "0 1 3", "0 3 2", "4 6 7", "4 7 5", "0 4 5", "0 5 1",
        "2 3 7", "2 7 6", "0 2 6", "0 6 4", "1 5 7", "1 7 3",
    )  # fmt: skip
    text = "".join(f"v {c}\n" for c in corners)
    text += "".join(f"f {' '.join(str(int(k) + 1) for k in f.split())}\n" for f in faces)
    (tmp_path / "piece.obj").write_text(text, "utf-8")
    mesh = 'mesh = "piece.obj"\nunits = "mm"'
    beside = put.format(shape=mesh, at="-450, 250, 170")
    assert flyby.station(station(tmp_path, stays, more=beside), no_proof=True).station
    small = put.format(shape="box_mm = [40, 60, 60]", at="-450, 250, 170")
    assert flyby.station(station(tmp_path, stays, more=small), no_proof=True).station
    same = put.format(shape=mesh, at="-650, 220, 140")
    with pytest.raises(InputError, match=r"'bottle' of pick lies where 'piece' of other does"):
        flyby.station(station(tmp_path, stays, more=same), no_proof=True)
