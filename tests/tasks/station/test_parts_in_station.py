"""Stations whose robots pick parts and put them down."""

from __future__ import annotations

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
