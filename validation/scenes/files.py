"""Writes the reference scenes as a user would have them: cell files, meshes, RAPID modules.

    python -m flyby.validation.scenes.files FOLDER

Then, say, ``flyby optimize FOLDER/two_joints.mod --cell FOLDER/two_joints.toml``. A cell file names
a robot of the catalogue, with the catalogue's limits and shapes; the two scenes on the arm of
`flyby.validation.scenes.arm` have others, and so other times than these files.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import chain
from math import radians
from pathlib import Path

import trimesh

from ...core.cell.geometry import Geometry, Mesh
from ...core.program.move import Move, MoveJ
from ...core.program.program import Program
from ...core.program.target import Configuration, PoseTarget
from ...core.program.tool import Load, Tool
from ...core.program.zone import Radius
from ...core.registry import find_vendor
from ...core.robot.shape import Box, Capsule, Cylinder, Sphere
from ...core.spatial.pose import Pose
from .clutter import clutter, clutter_100
from .scene import Scene, with_zone
from .stud_welding import stud_welding, stud_welding_with_panel
from .two_joints import two_joints

SCENES: tuple[Callable[[], Scene], ...] = (
    two_joints,
    stud_welding,
    stud_welding_with_panel,
    clutter,
    clutter_100,
)
Z10 = Radius(0.01, 0.015, 0.015, radians(1.5), 0.015, radians(1.5), name="z10")


def main(folder: Path) -> None:
    """Write all scenes."""
    for make in SCENES:
        scene = make()
        meshes = folder / "meshes"
        meshes.mkdir(parents=True, exist_ok=True)
        write_meshes(scene, meshes)
        (folder / f"{scene.name}.toml").write_text(cell_text(scene, meshes.name), "utf-8")
        write_module(scene, folder)
        print(f"{folder / scene.name}.toml, .mod: {len(whole_program(scene).moves)} moves")


def whole_program(scene: Scene) -> Program:
    """All programs of a scene in one, each to a stop; via points with ``z10``.

    A module does not say where the robot stands, so the first move goes to the start.
    """
    first = scene.programs[0]
    assert first.start is not None
    driven = chain.from_iterable(with_zone(p, Z10).moves for p in scene.programs)
    start = MoveJ(target=first.start, speed=first.moves[0].speed, tool=scene.tool)
    return Program((start, *driven), name=scene.name, start=first.start)


def write_module(scene: Scene, folder: Path) -> None:
    """The program as a RAPID module, with the configuration of every pose."""
    vendor, robot = find_vendor(scene.cell.vendor), scene.cell.robot
    program = whole_program(scene)
    ends = scene.controller().plan(program).route
    labels = {
        move: vendor.label(robot, q[1]) for move, q in zip(ends.moves, ends.ends.q, strict=True)
    }
    moves = tuple(_labelled(move, labels.get(k)) for k, move in enumerate(program.moves))
    for name, text in vendor.write(program.with_moves(moves), robot).items():
        (folder / name).write_text(text, "utf-8")


def _labelled(move: Move, label: Configuration | None) -> Move:
    if not isinstance(move.target, PoseTarget):
        return move
    return replace(move, target=replace(move.target, configuration=label))


def write_meshes(scene: Scene, folder: Path) -> None:
    """The meshes of the obstacles, binary STL in mm."""
    for obstacle in scene.cell.obstacles:
        mesh = obstacle.geometry.shape
        if isinstance(mesh, Mesh):
            made = trimesh.Trimesh(1e3 * mesh.vertices, mesh.faces, process=False)
            made.export(folder / f"{obstacle.name}.stl")


def cell_text(scene: Scene, meshes: str) -> str:
    """The cell file; see ``docs/reference/cell.md``."""
    cell = scene.cell
    lines = [
        "# Written by `python -m flyby.validation.scenes.files`.",
        f'robot = "{cell.robot.name}"',
        f"clearance_mm = {_mm([cell.clearance])[1:-1]}",
        "",
        *_tool(scene.tool, cell.tool_geometries[scene.tool.name]),
    ]
    for obstacle in cell.obstacles:
        lines += ["", "[[obstacle]]", f'name = "{obstacle.name}"']
        lines += _geometry(obstacle.geometry, f"{meshes}/{obstacle.name}.stl")
    if cell.allowed:
        pairs = ", ".join(f'["{a}", "{b}"]' for a, b in cell.allowed)
        lines += ["", "[allow]", f"pairs = [{pairs}]"]
    return "\n".join([*lines, ""])


def _tool(tool: Tool, geometry: Geometry) -> list[str]:
    load = tool.load or Load(0.0)
    return [
        f"[tool.{tool.name}]",
        f"tcp = {_pose(tool.tcp)}",
        f"mass_kg = {load.mass:g}",
        f"centre_mm = {_mm(load.centre)}",
        f"inertia_kgm2 = {list(load.inertia)}",
        *_geometry(geometry, ""),
    ]


def _geometry(geometry: Geometry, file: str) -> list[str]:
    place = f"pose = {_pose(geometry.placement)}"
    match geometry.shape:
        case Mesh():
            return [f'mesh = "{file}"', 'units = "mm"', place]
        case Box(size):
            return [f"box_mm = {_mm(size)}", place]
        case Sphere(radius):
            return [f"sphere_mm = {_mm([radius])}", place]
        case Capsule(radius, length):
            return [f"capsule_mm = {_mm([radius, length])}", place]
        case Cylinder(radius, length):
            return [f"cylinder_mm = {_mm([radius, length])}", place]


def _pose(pose: Pose) -> str:
    turn = ", ".join(f"{x + 0.0:.9g}" for x in pose.quaternion)
    return f"{{ xyz_mm = {_mm(pose.position)}, quat_wxyz = [{turn}] }}"


def _mm(lengths: Iterable[float]) -> str:
    return "[" + ", ".join(f"{1e3 * x:.9g}" for x in lengths) + "]"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m flyby.validation.scenes.files FOLDER")
    main(Path(sys.argv[1]))
