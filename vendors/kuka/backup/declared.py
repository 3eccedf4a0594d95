"""Tools, bases, loads and homes of ``$config.dat``.

``TOOL_DATA[n]`` is a frame at the flange with ``LOAD_DATA[n]``, {M kg, CM {X…C} mm and degrees at
the flange, J {X, Y, Z} kg m²}, M below zero for none that was stated; ``BASE_DATA[n]`` a frame in
the world. Where ``BASE_TYPE[n]`` is ``#TCP`` the base is a tool that stands still, and a
``TOOL_TYPE[n]`` of ``#TCP`` makes of the tool the frame of the work at the flange.
``MACHINE_DEF[n]`` are the robot and its tables, and ``MACHINE_FRAME_DAT[n]`` names the one that
base n stands on.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from ....core.backup.contents import BackupNotes
from ....core.errors import InputError
from ....core.program.target import JointTarget
from ....core.program.tool import Load, Tool, WorkObject
from ....core.robot.joint import JointKind
from ....core.robot.model import Robot
from ....core.spatial.pose import IDENTITY, Pose
from ..data_list import Assigned, DataList, Value, numbers_of, part_of
from ..machine_data.geometry import pose_of

HOMES = ("XHOME", *(f"XHOME{k}" for k in range(1, 6)))
ROBOT = "#ROBOT"
"""Of ``MECH_TYPE``."""
_STANDING = "#TCP"
_READ = frozenset({"TOOL_DATA", "BASE_DATA", "LOAD_DATA", "MACHINE_DEF", *HOMES})
_MOST_MACHINES = 1000.0
_AXES = tuple(f"A{k}" for k in range(1, 7))


@dataclass
class Declared:
    """What they are, by the names that programs use, and what the operator calls them."""

    tools: dict[str, Tool] = field(default_factory=dict)
    frames: dict[str, WorkObject] = field(default_factory=dict)
    homes: dict[str, JointTarget] = field(default_factory=dict)
    comments: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Machine:
    """A ``MACHINE_DEF``: the robot, or what bases stand on."""

    name: str
    kind: str
    root: Pose


def machines_of(config: DataList | None, notes: BackupNotes) -> dict[int, Machine]:
    """The mechanisms of a cell by their numbers; 1 is the robot."""
    found: dict[int, Machine] = {}
    for index, one in config.items("MACHINE_DEF") if config else ():
        kind = one.value.get("MECH_TYPE") if isinstance(one.value, Mapping) else None
        if not isinstance(one.value, Mapping) or not isinstance(kind, str) or kind == "#NONE":
            continue
        name = one.value.get("NAME")
        root = _pose(f"MACHINE_DEF[{index}].ROOT", one, part_of(one.value, "ROOT"), notes)
        found[index] = Machine(name.strip() if isinstance(name, str) else "", kind, root)
    return found


def declared_in(
    config: DataList,
    machines: Mapping[int, Machine],
    tables: Mapping[str, str],
    robot: Robot | None,
    notes: BackupNotes,
) -> Declared:
    """What a ``$config.dat`` declares.

    Args:
        config: the list.
        machines: see `machines_of`.
        tables: the robot's axis of each, by its type.
        robot: for its external axes; None if it is not known.
        notes: where it is said what makes no sense.
    """
    for (name, index), line in config.unread.items():
        if name in _READ and (name, index) not in config.data:
            shown = f"{name}[{index}]" if index else name
            notes.add(f"{shown} is left out: its value makes no sense", config.name, line)
    made = Declared()
    for index, one in config.items("TOOL_DATA"):
        if not isinstance(one.value, Mapping) or not index >= 1:
            continue
        pose, load = (
            _pose(f"TOOL_DATA[{index}]", one, one.value, notes),
            _load(config, index, notes),
        )
        named = _named(config, "TOOL", index)
        if pose == IDENTITY and load is None and not named:
            continue
        name = f"TOOL_DATA[{index}]"
        made.comments |= {name: named} if named else {}
        if config.text("TOOL_TYPE", index) == _STANDING:
            made.frames[name] = WorkObject(name, pose, robot_held=True)
        else:
            made.tools[name] = Tool(name, pose, load)
    for index, one in config.items("BASE_DATA"):
        if not isinstance(one.value, Mapping) or not index >= 1:
            continue
        pose, named = (
            _pose(f"BASE_DATA[{index}]", one, one.value, notes),
            _named(config, "BASE", index),
        )
        table = _table(config, machines, index, tables, notes)
        if pose == IDENTITY and not named and table is None:
            continue
        name = f"BASE_DATA[{index}]"
        made.comments |= {name: named} if named else {}
        if config.text("BASE_TYPE", index) == _STANDING:
            made.tools[name] = Tool(name, pose, robot_held=False)
        else:
            made.frames[name] = WorkObject(name, pose, moved_by=table)
    made.homes = _homes(config, robot)
    return made


def _named(config: DataList, kind: str, index: int) -> str:
    """What the operator calls it."""
    name = config.text(f"{kind}_NAME", index)
    return "" if name.upper() == f"{kind}_DATA[{index}]" else name


def _load(config: DataList, index: int, notes: BackupNotes) -> Load | None:
    one = config.data.get(("LOAD_DATA", index))
    if one is None or not isinstance(one.value, Mapping):
        return None
    mass = numbers_of(one.value).get("M", 0.0)
    if mass <= 0.0:
        return None
    what = f"LOAD_DATA[{index}]"
    centre = _pose(f"{what}.CM", one, part_of(one.value, "CM"), notes)
    moments = numbers_of(part_of(one.value, "J"))
    x, y, z = (moments.get(axis, 0.0) for axis in "XYZ")
    try:
        return Load(mass, centre.position, (x, y, z), centre.quaternion, what)
    except InputError as error:
        notes.add(f"{what} is left out: {error}", one.file, one.line)
        return None


def _table(
    config: DataList,
    machines: Mapping[int, Machine],
    index: int,
    tables: Mapping[str, str],
    notes: BackupNotes,
) -> str | None:
    """The axis of the robot whose table a base stands on."""
    one = config.data.get(("MACHINE_FRAME_DAT", index))
    if one is None or not isinstance(one.value, Mapping):
        return None
    number = numbers_of(one.value).get("MACH_DEF_INDEX", 0.0)
    machine = machines.get(int(number)) if 0.0 < number < _MOST_MACHINES else None
    if machine is None or machine.kind == ROBOT:
        return None
    if machine.kind not in tables:
        notes.add(
            f"BASE_DATA[{index}] stands on {machine.name or machine.kind}, which is no table in "
            "$machine.dat: it is taken to stand still",
            one.file,
            one.line,
        )
    return tables.get(machine.kind)


def _homes(config: DataList, robot: Robot | None) -> dict[str, JointTarget]:
    found = {}
    for name in HOMES:
        one = config.data.get((name, 0))
        values = numbers_of(one.value) if one and isinstance(one.value, Mapping) else {}
        if not all(axis in values for axis in _AXES):
            continue
        axes = robot.external_axes if robot is not None else ()
        external = tuple(
            values.get(f"E{k}", 0.0)
            * (1e-3 if axis.joint.kind is JointKind.PRISMATIC else math.pi / 180.0)
            for k, axis in enumerate(axes, 1)
        )
        found[name] = JointTarget(
            tuple(math.radians(values[axis]) for axis in _AXES), external, name
        )
    return found


def _pose(what: str, one: Assigned, struct: Mapping[str, Value], notes: BackupNotes) -> Pose:
    try:
        return pose_of(struct)
    except InputError as error:
        notes.add(f"{what} is taken for zero: {error}", one.file, one.line)
        return IDENTITY
