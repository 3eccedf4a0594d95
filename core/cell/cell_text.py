"""Cells as cell files, as far as a backup tells of them: robot, axes, tools and frames."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ..files.toml_text import key_text, value_text
from ..program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from ..robot.catalogue_text import pose_entries
from ..robot.joint import ExternalAxis, JointKind
from ..robot.model import Robot
from ..spatial.pose import IDENTITY, Pose
from .file import AXES

_UNITS = {JointKind.REVOLUTE: "rad", JointKind.PRISMATIC: "m"}


def cell_text(
    robot: Robot,
    named: str,
    tools: Mapping[str, Tool],
    frames: Mapping[str, WorkObject],
    motion: str | None = None,
) -> str:
    """The text of a cell file (`file.load_cell`) with nothing around the robot.

    Args:
        robot: where it stands, with its external axes.
        named: as the file names it: its name, or a file beside the cell's.
        tools, frames: by name; the bare flange and the world are left out.
        motion: file of how it is driven, beside the cell's; None for none.
    """
    lines = [f"robot = {value_text(named)}"]
    if motion is not None:
        lines.append(f"motion = {value_text(motion)}")
    if robot.base != IDENTITY:
        lines += _table("base", pose_entries(robot.base))
    for axis in robot.external_axes:
        lines += _table(f"external_axis.{key_text(axis.name)}", _axis(axis))
    for name, tool in tools.items():
        if name != FLANGE.name:
            lines += _table(f"tool.{key_text(name)}", _tool(tool))
    tables = {axis.name for axis in robot.external_axes}
    for name, frame in frames.items():
        if name != WORLD.name:
            lines += _table(f"frame.{key_text(name)}", _frame(frame, tables))
    return "\n".join(lines) + "\n"


def _table(heading: str, entries: Mapping[str, Any]) -> Iterator[str]:
    yield ""
    yield f"[{heading}]"
    for key, value in entries.items():
        yield f"{key_text(key)} = {value_text(value)}"


def _tool(tool: Tool) -> dict[str, Any]:
    entries: dict[str, Any] = {}
    entries |= {"tcp": pose_entries(tool.tcp)} if tool.tcp != IDENTITY else {}
    entries |= {} if tool.robot_held else {"robot_held": False}
    return entries | ({} if tool.load is None else _load(tool.load))


def _load(load: Load) -> dict[str, Any]:
    entries: dict[str, Any] = {"mass_kg": load.mass}
    if any(load.centre):
        entries["centre_m"] = list(load.centre)
    if any(load.inertia):
        entries["inertia_kgm2"] = list(load.inertia)
        axes = Pose(quaternion=load.axes)
        entries |= {"inertia_axes": pose_entries(axes)} if axes != IDENTITY else {}
    return entries


def _frame(frame: WorkObject, tables: set[str]) -> dict[str, Any]:
    entries: dict[str, Any] = {}
    entries |= {"pose": pose_entries(frame.user)} if frame.user != IDENTITY else {}
    entries |= {"object": pose_entries(frame.frame)} if frame.frame != IDENTITY else {}
    entries |= {"robot_held": True} if frame.robot_held else {}
    return entries | ({"moved_by": frame.moved_by} if frame.moved_by in tables else {})


def _axis(axis: ExternalAxis) -> dict[str, Any]:
    joint = axis.joint
    along = next((name for name, unit in AXES.items() if unit == tuple(joint.axis)), None)
    unit = _UNITS[joint.kind]
    entries: dict[str, Any] = {
        "role": axis.role.value,
        "kind": joint.kind.value,
        "axis": along or list(joint.axis),
        f"range_{unit}": [joint.lower, joint.upper],
        f"speed_{unit}_s": joint.velocity,
        f"acceleration_{unit}_s2": joint.acceleration,
    }
    entries |= {"pose": pose_entries(joint.placement)} if joint.placement != IDENTITY else {}
    entries |= {} if axis.carried_by is None else {"carried_by": axis.carried_by}
    return entries if axis.number is None else {**entries, "number": axis.number}
