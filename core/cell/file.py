"""The cell file: TOML, every quantity with its unit in the key."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError, UnknownNameError
from ..files.tables import ANGLE, LENGTH, TomlTable, per
from ..program.tool import FLANGE, WORLD, Tool, WorkObject
from ..robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from ..robot.model import Robot
from ..robot.pose_table import pose_at
from ..robot_files import load_robot_file, names_file
from ..spatial.pose import Vector3
from .arm import read_arm
from .cell import Cell, Obstacle
from .geometry import Geometry
from .positioner import positioner
from .tables import read_geometry, read_load
from .workpiece import Workpiece, read_part

if TYPE_CHECKING:
    from ..registry import Registry

_LEAST = 1e-9
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def load_cell(path: str | Path, registry: Registry) -> Cell:
    """Read a cell file; see ``docs/reference/cell.md`` for its keys.

    Args:
        path: the TOML file; meshes are named relative to it.
        registry: where the robot's name is looked up; where it stands and its external axes are its
            own, as long as the file says nothing of them.

    Raises:
        InputError: a file is missing or no TOML, a key is missing, unknown or of a wrong kind or
            unit, a name stands for nothing; the message names file and key. Meshes are read
            later: see `Cell.check_meshes`.
    """
    file = TomlTable.read(path)
    axes = [_external_axis(name, t) for name, t in file.named_tables("external_axis").items()]
    robot = read_arm(file, _robot(file, registry, tuple(axes)))
    tools, shapes = _tools(file)
    tables = {axis.name for axis in robot.external_axes if axis.role is ExternalRole.TABLE}
    obstacles = _obstacles(file, robot.external_axes)
    parts = _parts(file, tables, (*tools, *(o.name for o in obstacles)))
    frames = _frames(file, robot.external_axes)
    clearance = _clearance(file)
    motion = Path(path).parent / file.text("motion") if file.has("motion") else None
    allow = file.table("allow")
    file.finish()
    things = (*(obstacle.name for obstacle in obstacles), *(part.name for part in parts))
    known = {*tools, *things, "base", *robot.axis_names}
    return Cell(
        robot=robot,
        vendor=robot.name.partition("/")[0],
        clearance=clearance,
        tools=tools,
        frames=frames,
        tool_geometries=shapes,
        obstacles=obstacles,
        parts=parts,
        motion=motion,
        allowed=_allowed(allow, known),
        file=file.file,
    )


def _robot(file: TomlTable, registry: Registry, axes: tuple[ExternalAxis, ...]) -> Robot:
    if not file.has("robot") and axes:
        return _positioner(file, registry, axes)
    named = file.text("robot")
    try:
        if names_file(named):
            folder = file.file.parent
            vendor = file.text("vendor") if file.has("vendor") else None
            srdf = file.existing_file("srdf") if file.has("srdf") else None
            robot = load_robot_file(folder / named, registry, vendor, srdf)
        else:
            robot = registry.find_robot(named)
    except InputError as error:
        raise file.error("robot", str(error)) from None
    if file.has("base"):
        robot = robot.with_base(pose_at(file, "base"))
    try:
        return robot.with_external_axes(axes) if axes else robot
    except InputError as error:
        raise file.error("external_axis", str(error)) from None


def _positioner(file: TomlTable, registry: Registry, axes: tuple[ExternalAxis, ...]) -> Robot:
    """External axes without an arm, which a program of their own turns."""
    if not file.has("vendor"):
        raise file.error(
            "robot", "is missing; of a positioner without an arm give the vendor instead"
        )
    vendor = file.text("vendor")
    try:
        registry.find_vendor(vendor)
        return positioner(vendor, axes)
    except InputError as error:
        raise file.error("vendor", str(error)) from None


def _tools(file: TomlTable) -> tuple[dict[str, Tool], dict[str, Geometry]]:
    tools: dict[str, Tool] = {}
    shapes: dict[str, Geometry] = {}
    for name, table in file.named_tables("tool").items():
        if name == FLANGE.name:
            raise file.table("tool").error(name, "is the bare flange and cannot be redefined")
        tools[name] = Tool(
            name=name,
            tcp=pose_at(table, "tcp"),
            load=read_load(table),
            robot_held=table.flag("robot_held", True),
        )
        shape = read_geometry(table, pose_at(table, "pose"))
        if shape is not None:
            shapes[name] = shape
        table.finish()
    return tools, shapes


def _frames(file: TomlTable, axes: Sequence[ExternalAxis]) -> dict[str, WorkObject]:
    frames: dict[str, WorkObject] = {}
    for name, table in file.named_tables("frame").items():
        if name == WORLD.name:
            raise file.table("frame").error(name, "is the world and cannot be redefined")
        frames[name] = WorkObject(
            name=name,
            user=pose_at(table, "pose"),
            frame=pose_at(table, "object"),
            robot_held=table.flag("robot_held", False),
            moved_by=_carrier(table, "moved_by", axes),
        )
        table.finish()
    return frames


def _obstacles(file: TomlTable, axes: Sequence[ExternalAxis]) -> tuple[Obstacle, ...]:
    obstacles: list[Obstacle] = []
    for table in file.listed_tables("obstacle"):
        name = table.text("name")
        if name in (obstacle.name for obstacle in obstacles):
            raise table.error("name", f"another obstacle is called {name!r} already")
        geometry = read_geometry(table, pose_at(table, "pose"))
        if geometry is None:
            raise table.error("mesh", "is missing, and so are box_mm, sphere_mm and the like")
        obstacles.append(Obstacle(name, geometry, _carrier(table, "carried_by", axes)))
        table.finish()
    return tuple(obstacles)


def _parts(
    file: TomlTable, tables: Collection[str], others: Collection[str]
) -> tuple[Workpiece, ...]:
    parts: list[Workpiece] = []
    for table in file.listed_tables("part"):
        part = read_part(table, sorted(tables))
        if part.name in (*others, *(known.name for known in parts)):
            raise table.error("name", f"something else in the cell is called {part.name!r} already")
        parts.append(part)
    return tuple(parts)


def _carrier(table: TomlTable, key: str, axes: Sequence[ExternalAxis]) -> str | None:
    if not table.has(key):
        return None
    roles = {axis.name: axis.role for axis in axes}
    if roles.get(table.text(key)) is ExternalRole.TRACK:
        raise table.error(
            key,
            f"{table.text(key)!r} is a track: it carries the robot alone, and bodies that ride "
            'with it are shapes of its base ([[robot_shape]] with link = "base")',
        )
    return table.choice(key, [name for name, role in roles.items() if role is ExternalRole.TABLE])


def _external_axis(name: str, table: TomlTable) -> ExternalAxis:
    """``[external_axis.NAME]``; lengths for a prismatic axis, angles for a revolute one."""
    kind = JointKind(table.choice("kind", list(JointKind)))
    unit = LENGTH if kind is JointKind.PRISMATIC else ANGLE
    lower, upper = table.quantities("range", unit, 2)
    if lower >= upper:
        raise table.error("range", f"must rise, not run from {lower:g} to {upper:g}")
    joint = Joint(
        name=name,
        placement=pose_at(table, "pose"),
        axis=_direction(table),
        lower=lower,
        upper=upper,
        velocity=_positive(table, "speed", per(unit, "s")),
        acceleration=_positive(table, "acceleration", per(unit, "s2")),
        kind=kind,
    )
    axis = ExternalAxis(
        joint=joint,
        role=ExternalRole(table.choice("role", list(ExternalRole))),
        carried_by=table.text("carried_by") if table.has("carried_by") else None,
        number=_counted(table, "number") if table.has("number") else None,
    )
    table.finish()
    return axis


def _counted(table: TomlTable, key: str) -> int:
    """A place in a row, from 1."""
    number = table.number(key)
    if number < 1 or number != int(number):
        raise table.error(key, f"counts from 1, and is not {number:g}")
    return int(number)


def _direction(table: TomlTable) -> Vector3:
    """``axis``: x, y or z, or three numbers along it."""
    if not isinstance(table.value("axis"), list):
        return AXES[table.choice("axis", AXES)]
    x, y, z = table.numbers("axis", 3)
    length = math.hypot(x, y, z)
    if not _LEAST < length < math.inf:
        raise table.error("axis", "is x, y or z, or three numbers along it that are not all zero")
    return x / length, y / length, z / length


def _allowed(table: TomlTable, known: Collection[str]) -> tuple[tuple[str, str], ...]:
    """Pairs that may touch: tools, obstacles, joints (for the links behind them) and ``base``."""
    pairs = table.value("pairs") if table.has("pairs") else []
    table.finish()
    if not isinstance(pairs, list):
        raise table.error("pairs", f"must be a list of pairs of names, not {pairs!r}")
    return tuple(_pair(table, pair, known) for pair in pairs)


def _pair(table: TomlTable, pair: object, known: Collection[str]) -> tuple[str, str]:
    if not isinstance(pair, list) or len(pair) != 2 or not all(isinstance(n, str) for n in pair):
        raise table.error("pairs", f"must be pairs of names, not {pair!r}")
    for name in pair:
        if name not in known:
            raise table.error("pairs", str(UnknownNameError("part of the cell", name, known)))
    return pair[0], pair[1]


def _clearance(file: TomlTable) -> float:
    value = file.quantity("clearance", LENGTH, 0.0)
    if value < 0:
        raise file.error("clearance", "must be zero or more")
    return value


def _positive(table: TomlTable, key: str, units: Mapping[str, float]) -> float:
    value = table.quantity(key, units)
    if value <= 0:
        raise table.error(key, "must be above zero")
    return value
