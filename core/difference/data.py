"""Data by name on both sides: points, tools, frames, loads."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TypeVar

import numpy as np

from ..errors import Span
from ..program.program import Program
from ..program.target import JointTarget, PoseTarget, Target
from ..program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from ..spatial.pose import Pose
from .differences import Difference, Differing

Datum = TypeVar("Datum")
SAME_PLACE = 1e-9
"""m and rad: what rounding in single precision does not hide."""


def points_of(programs: Mapping[str, Program]) -> dict[str, tuple[Target, Span | None]]:
    """Named points that are driven to, with where the first move to each stands."""
    found: dict[str, tuple[Target, Span | None]] = {}
    for program in programs.values():
        for move in program.moves:
            if move.target.name is not None and not move.open:
                found.setdefault(move.target.name, (move.target, move.statement))
    return found


def tools_of(programs: Mapping[str, Program]) -> dict[str, Tool]:
    """Tools that moves are driven with, but the bare flange."""
    moves = (move for program in programs.values() for move in program.moves)
    return {move.tool.name: move.tool for move in moves if move.tool != FLANGE}


def frames_of(programs: Mapping[str, Program]) -> dict[str, WorkObject]:
    """Frames that targets are given in, but the world."""
    moves = (move for program in programs.values() for move in program.moves)
    return {m.work_object.name: m.work_object for m in moves if m.work_object != WORLD}


def loads_of(programs: Mapping[str, Program]) -> dict[str, Load]:
    """Named payloads."""
    moves = (move for program in programs.values() for move in program.moves)
    return {m.load.name: m.load for m in moves if m.load is not None and m.load.name is not None}


def point_differences(
    before: Mapping[str, tuple[Target, Span | None]],
    after: Mapping[str, tuple[Target, Span | None]],
) -> Iterator[Difference]:
    """Points that are others, were added, or are gone; names compare without case."""
    for name, one, other in paired(before, after):
        span = (other or one or (None, None))[1]
        old, new = (None if side is None else side[0] for side in (one, other))
        found = target_difference(Differing.POINT, name, old, new, span)
        if found is not None:
            yield found


def target_difference(
    subject: Differing, name: str, old: Target | None, new: Target | None, span: Span | None
) -> Difference | None:
    """How two targets differ; None if they are the same but for their names."""
    before = "" if old is None else target_text(old)
    after = "" if new is None else target_text(new)
    distance = angle = None
    if isinstance(old, PoseTarget) and isinstance(new, PoseTarget):
        distance, angle = apart(old.pose, new.pose)
        same = max(distance, angle) <= SAME_PLACE and _alike(old, new)
    elif isinstance(old, JointTarget) and isinstance(new, JointTarget):
        angle = _joints_apart(old, new)
        same = angle is not None and angle <= SAME_PLACE and old.external == new.external
    else:
        same = False
    return None if same else Difference(subject, name, before, after, distance, angle, span)


def _alike(old: PoseTarget, new: PoseTarget) -> bool:
    return (
        old.configuration == new.configuration
        and old.external == new.external
        and old.arm_angle == new.arm_angle
    )


def _joints_apart(old: JointTarget, new: JointTarget) -> float | None:
    """The greatest difference of joint values, rad (m of linear joints)."""
    if len(old.joints) != len(new.joints):
        return None
    return max((abs(a - b) for a, b in zip(old.joints, new.joints, strict=True)), default=0.0)


def tool_differences(before: Mapping[str, Tool], after: Mapping[str, Tool]) -> Iterator[Difference]:
    """Tools with another TCP, mass or holder."""
    for name, one, other in paired(before, after):
        if one != other:
            shown = _both(one, other, _tool_text)
            old, new = (None if side is None else side.tcp for side in (one, other))
            yield from _placed(Differing.TOOL, name, (old, new), shown)


def frame_differences(
    before: Mapping[str, WorkObject], after: Mapping[str, WorkObject]
) -> Iterator[Difference]:
    """Work objects that lie elsewhere, or are held or moved by another."""
    for name, one, other in paired(before, after):
        if one != other:
            shown = _both(one, other, _frame_text)
            old, new = (None if side is None else side.pose for side in (one, other))
            yield from _placed(Differing.FRAME, name, (old, new), shown)


def _both(one: Datum | None, other: Datum | None, shown: Callable[[Datum], str]) -> tuple[str, str]:
    """Both sides as texts; nothing of what is not there."""
    return "" if one is None else shown(one), "" if other is None else shown(other)


def _placed(
    subject: Differing, name: str, places: tuple[Pose | None, Pose | None], shown: tuple[str, str]
) -> Iterator[Difference]:
    old, new = places
    if old is None or new is None:
        yield Difference(subject, name, *shown)
        return
    distance, angle = apart(old, new)
    if max(distance, angle) > SAME_PLACE or shown[0] != shown[1]:
        yield Difference(subject, name, *shown, distance, angle)


def load_differences(before: Mapping[str, Load], after: Mapping[str, Load]) -> Iterator[Difference]:
    """Payloads of another mass, centre or inertia."""
    for name, one, other in paired(before, after):
        if one != other:
            yield Difference(Differing.LOAD, name, *_both(one, other, _load_text))


def value_differences(
    subject: Differing,
    before: Mapping[str, Datum],
    after: Mapping[str, Datum],
    shown: Callable[[Datum], str],
) -> Iterator[Difference]:
    """Whatever else has names and shows what differs."""
    for name, one, other in paired(before, after):
        texts = _both(one, other, shown)
        if texts[0] != texts[1]:
            yield Difference(subject, name, *texts)


def paired(
    before: Mapping[str, Datum], after: Mapping[str, Datum]
) -> Iterator[tuple[str, Datum | None, Datum | None]]:
    """Both sides by name, without regard to case, in the order of the second, then the first."""
    olds = {name.casefold(): one for name, one in before.items()}
    news = {name.casefold() for name in after}
    for name, new in after.items():
        yield name, olds.get(name.casefold()), new
    for name, old in before.items():
        if name.casefold() not in news:
            yield name, old, None


def apart(one: Pose, other: Pose) -> tuple[float, float]:
    """m and rad between two poses."""
    distance = math.dist(one.position, other.position)
    turn = one.inverse() @ other
    vector = math.hypot(*turn.quaternion[1:])
    return distance, 2.0 * math.atan2(vector, abs(turn.quaternion[0]))


def target_text(target: Target) -> str:
    """A target in mm or degrees, with its configuration."""
    if isinstance(target, JointTarget):
        text = ", ".join(f"{math.degrees(value):.2f}" for value in target.joints)
        return f"joints {text}"
    where = _place(target.pose)
    turned = ", ".join(f"{part:.4f}" for part in _upright(target.pose))
    which = "" if target.configuration is None else f" {target.configuration}"
    more = f" + {', '.join(f'{value:.4f}' for value in target.external)}" if target.external else ""
    angle = target.arm_angle
    arm = "" if angle is None else f" arm angle {math.degrees(angle):.2f}°"
    return f"{where} [{turned}]{which}{arm}{more}"


def _place(pose: Pose) -> str:
    return ", ".join(f"{1e3 * value + 0.0:.2f}" for value in pose.position)


def _upright(pose: Pose) -> tuple[float, ...]:
    """A quaternion of which the other sign would mean the same."""
    q = np.array(pose.quaternion)
    return tuple(float(part) + 0.0 for part in (-q if q[0] < 0 else q))


def _tool_text(tool: Tool) -> str:
    held = "" if tool.robot_held else ", stands still"
    mass = "" if tool.load is None else f", {_load_text(tool.load)}"
    return f"{pose_text(tool.tcp)}{mass}{held}"


def _frame_text(frame: WorkObject) -> str:
    held = ", held by the robot" if frame.robot_held else ""
    moved = "" if frame.moved_by is None else f", moved by {frame.moved_by}"
    return f"{pose_text(frame.pose)}{held}{moved}"


def pose_text(pose: Pose) -> str:
    """A pose in mm, with its quaternion."""
    return f"{_place(pose)} [{', '.join(f'{part:.4f}' for part in _upright(pose))}]"


def _load_text(load: Load) -> str:
    centre = ", ".join(f"{1e3 * value + 0.0:.1f}" for value in load.centre)
    inertia = ", ".join(f"{value:g}" for value in load.inertia)
    return f"{load.mass:g} kg at {centre}" + (f", {inertia} kg m²" if any(load.inertia) else "")
