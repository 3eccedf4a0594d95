"""A table that a program of its own turns, and robots that weld on it, as files of a station."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .stations import UNUSED

TABLE = """vendor = "abb"
[external_axis.STN1]
role = "table"
kind = "revolute"
axis = "z"
pose = {{ xyz_mm = [{x}, 0, 200] }}
range_deg = [-360, 360]
speed_deg_s = 90
acceleration_deg_s2 = 180
[[obstacle]]
name = "disc"
cylinder_mm = [200, 20]
pose = {{ xyz_mm = [0, 0, -10] }}
carried_by = "STN1"
[[obstacle]]
name = "post"
box_mm = [30, 30, 60]
pose = {{ xyz_mm = [-150, 0, 30] }}
carried_by = "STN1"
"""
X = 400
"""mm from the first robot to the table."""
WELD = "[[{},{},{}],[0,0,1,0],[0,0,0,0]," + UNUSED + "]"


def turn(angle: float, name: int | None = None, zone: str = "fine", speed: str = "vrot50") -> str:
    """The table turns to an angle, in degrees."""
    made = "" if name is None else f"\\ID:={name}"
    there = f"[[0,0,0,0,0,0],[{angle},9E9,9E9,9E9,9E9,9E9]]"
    return f"MoveExtJ {there}{made}, {speed}, {zone}"


def weld(
    x: float,
    y: float,
    z: float,
    name: int | None = None,
    *,
    kind: str = "L",
    zone: str = "fine",
    speed: str = "v100",
) -> str:
    """A robot drives its torch to a place on the table."""
    made = "" if name is None else f"\\ID:={name}"
    target = WELD.format(x, y, z)
    return f"Move{kind} {target}{made}, {speed}, {zone}, torch \\WObj:=wTable"


def module(name: str, statements: Sequence[str]) -> str:
    """A module of one task."""
    body = "\n    ".join(f"{statement};" for statement in statements)
    frames = "[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]"
    return (
        f"MODULE {name}\n  VAR syncident s1;\n  VAR syncident s2;\n  VAR syncident s3;\n"
        '  PERS tasks all{2} := [["T1"],["T2"]];\n'
        "  PERS tooldata torch := [TRUE,[[0,0,120],[1,0,0,0]],[1,[0,0,20],[1,0,0,0],0,0,0]];\n"
        f'  PERS wobjdata wTable := [FALSE,FALSE,"STN1",{frames}];\n'
        "  PERS speeddata vrot50 := [100,50,100,50];\n"
        f"  PROC main()\n    ConfJ \\Off;\n    ConfL \\Off;\n    {body}\n  ENDPROC\nENDMODULE\n"
    )


def write_station(
    folder: Path,
    programs: dict[str, Sequence[str]],
    table: Sequence[str],
    rest: str = "",
    clearance: float = 5.0,
) -> Path:
    """A station of one or two robots that face each other over a table."""
    text = f"clearance_mm = {clearance}\n{rest}"
    for k, (name, statements) in enumerate(programs.items()):
        turned = "[0, 0, 0, 1]" if k % 2 else "[1, 0, 0, 0]"
        (folder / f"{name}.toml").write_text(
            'robot = "abb/irb120-3-058"\n'
            f"base = {{ xyz_mm = [{2 * X * (k % 2)}, 0, 0], quat_wxyz = {turned} }}\n"
            "[tool.torch]\ntcp = { xyz_mm = [0, 0, 120] }\nmass_kg = 1\n"
            "capsule_mm = [8, 80]\npose = { xyz_mm = [0, 0, 60] }\n"
            '[allow]\npairs = [["J6", "torch"]]\n'
        )
        (folder / f"{name}.mod").write_text(module(name, statements))
        text += f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{name}.mod"\n'
    (folder / "table.toml").write_text(TABLE.format(x=X))
    (folder / "table.mod").write_text(module("table", table))
    text += '[robot.table]\ncell = "table.toml"\nprogram = "table.mod"\n'
    file = folder / "station.toml"
    file.write_text(text)
    return file
