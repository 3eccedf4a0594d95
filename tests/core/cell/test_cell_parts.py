"""``[[part]]`` in a cell file: trays, what takes and releases, and what is wrong by key."""

from __future__ import annotations

from pathlib import Path

import pytest

from flyby.core.cell.cell import Cell
from flyby.core.cell.file import load_cell
from flyby.core.errors import InputError
from flyby.core.registry import installed
from flyby.core.robot.shape import Box

HEAD = """
robot = "abb/irb1200-5-090"

[external_axis.table]
role = "table"
kind = "revolute"
axis = "z"
range_deg = [-360, 360]
speed_deg_s = 90
acceleration_deg_s2 = 180

[[obstacle]]
name = "wall"
box_mm = [100, 3000, 2000]

[[part]]
"""
PART = """name = "crate"
box_mm = [60, 40, 100]
pose = { xyz_mm = [500, 0, 300], abc_deg = [90, 0, 0] }
mass_kg = 2
centre_mm = [0, 0, 10]
count = [2, 3]
pitch_mm = [100, 50]
attach = "doGrip, 1"
release = ["Reset doGrip", "Open"]
"""


def read(folder: Path, text: str, head: str = HEAD) -> Cell:
    (folder / "cell.toml").write_text(head + text, "utf-8")
    return load_cell(folder / "cell.toml", installed())


def test_a_tray_is_read_whole(tmp_path: Path) -> None:
    (part,) = read(tmp_path, PART + 'near_mm = 5\nreleased_on = "table"\nleaves = true').parts
    assert part.geometry.shape == Box((0.06, 0.04, 0.1))
    assert part.attach == ("doGrip, 1",)
    assert part.release == ("Reset doGrip", "Open")
    assert part.load is not None
    assert (part.load.mass, part.load.centre) == (2.0, (0.0, 0.0, 0.01))
    assert (part.near, part.released_on, part.leaves) == (0.005, "table", True)
    pieces = list(part.pieces())
    assert [name for name, _ in pieces] == [f"crate {k}" for k in range(1, 7)]
    # The tray is turned by a quarter: its x leads along the world's y, its y against the x.
    assert pieces[1][1].position == pytest.approx((0.5, 0.1, 0.3))
    assert pieces[2][1].position == pytest.approx((0.45, 0.0, 0.3))


def test_a_part_alone_has_its_own_name(tmp_path: Path) -> None:
    text = 'name = "ring"\nsphere_mm = [20]\nattach = "on"\nrelease = "off"'
    (part,) = read(tmp_path, text).parts
    assert [name for name, _ in part.pieces()] == ["ring"]
    assert (part.load, part.carried_by, part.near) == (None, None, 0.05)


def test_parts_may_be_allowed_to_touch(tmp_path: Path) -> None:
    assert read(tmp_path, PART + '[allow]\npairs = [["crate", "wall"]]').allowed == (
        ("crate", "wall"),
    )


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("box_mm = [60, 40, 100]", "", "mesh.*is missing"),
        ('attach = "doGrip, 1"', "", "attach.*missing"),
        ('attach = "doGrip, 1"', 'attach = ""', "attach.*names a signal"),
        ('attach = "doGrip, 1"', "attach = [1]", "attach.*list of strings"),
        ('attach = "doGrip, 1"', 'attach = "Open"', "release.*is the same as attach"),
        ("count = [2, 3]", "count = [2, 0]", "count.*whole numbers from 1"),
        ("count = [2, 3]", "count = [2, 1.5]", "count.*whole numbers from 1"),
        ("count = [2, 3]", "count = [100, 100]", "makes 10000 parts"),
        ("count = [2, 3]", "", "pitch.*means nothing without count"),
        ("pitch_mm = [100, 50]", "", "pitch_mm.*is missing"),
        ("pitch_mm = [100, 50]", "pitch_mm = [100]", "list of 2 numbers"),
        ("mass_kg = 2", "", "centre_mm.*without mass_kg"),
        ("mass_kg = 2", "mass_kg = 2\nnear_mm = -1", "near.*zero or more"),
        ("mass_kg = 2", 'mass_kg = 2\ncarried_by = "belt"', "carried_by.*table"),
        ("mass_kg = 2", "mass_kg = 2\nweight = 3", "weight"),
        ('name = "crate"', 'name = "wall"', "something else in the cell is called 'wall'"),
    ],
)
def test_what_is_wrong_is_said_by_file_and_key(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in PART
    with pytest.raises(InputError, match=rf"(?s)cell\.toml.*{message}"):
        read(tmp_path, PART.replace(old, new))
