"""Faults of units and conventions, made alike on reading and writing: no round trip shows them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

from ...core.program.move import Move, MoveC, Wait
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget, PoseTarget, Target
from ...core.program.zone import Fine, Radius, VendorZone, Zone
from ...core.spatial.pose import Pose
from ..checks.subject import Subject
from .mutant import Mutant, has
from .statements import AGAIN, GOLDEN
from .wrapping import Fault, Plant, each_move, everywhere, in_writing

_LENGTHS = ("tcp", "reorientation", "external", "external_linear")


def _both(fault: Callable[[float], Fault], factor: float) -> Plant:
    return everywhere(fault(factor), fault(1.0 / factor))


def _zones(factor: float) -> Fault:
    def scaled(zone: Zone) -> Zone:
        if isinstance(zone, Fine):
            return zone
        if isinstance(zone, Radius):
            return replace(zone, **{n: factor * getattr(zone, n) for n in _LENGTHS}, name=None)
        if isinstance(zone, VendorZone):
            return replace(zone, size=min(zone.kind.largest, factor * zone.size))
        name = fields(zone)[0].name
        most = math.inf if name == "angle" else 1.0
        return replace(zone, **{name: min(most, factor * getattr(zone, name))})

    return each_move(lambda move: replace(move, zone=scaled(move.zone)))


def _speeds(*names: str) -> Callable[[float], Fault]:
    def fault(factor: float) -> Fault:
        def scaled(speed: Speed) -> Speed:
            values = {n: getattr(speed, n) for n in names}
            stated = {n: factor * v for n, v in values.items() if v is not None}
            stated |= {n: min(1.0, v) for n, v in stated.items() if "fraction" in n}
            return replace(speed, **stated, name=None)

        return each_move(lambda move: replace(move, speed=scaled(move.speed)))

    return fault


def _targets(change: Callable[[Target], Target]) -> Fault:
    def changed(move: Move) -> Move:
        made = replace(move, target=change(move.target))
        if isinstance(made, MoveC):
            via = change(made.via)
            made = replace(made, via=via if isinstance(via, PoseTarget) else made.via)
        return made

    return each_move(changed)


def _joints(factor: float) -> Fault:
    def scaled(target: Target) -> Target:
        if not isinstance(target, JointTarget):
            return target
        return replace(target, joints=tuple(factor * q for q in target.joints))

    return _targets(scaled)


def _reversed_joints(target: Target) -> Target:
    if not isinstance(target, JointTarget):
        return target
    return replace(target, joints=target.joints[::-1])


def _lengths(factor: float) -> Fault:
    def scaled(pose: Pose) -> Pose:
        x, y, z = (factor * p for p in pose.position)
        return replace(pose, position=(x, y, z))

    return _poses(scaled)


def _poses(change: Callable[[Pose], Pose]) -> Fault:
    def changed(target: Target) -> Target:
        if not isinstance(target, PoseTarget):
            return target
        return replace(target, pose=change(target.pose))

    return _targets(changed)


def _transposed(pose: Pose) -> Pose:
    w, x, y, z = pose.quaternion
    return replace(pose, quaternion=(w, -x, -y, -z))


def _scalar_last(pose: Pose) -> Pose:
    w, x, y, z = pose.quaternion
    return replace(pose, quaternion=(x, y, z, w))


def _scalar_first(pose: Pose) -> Pose:
    x, y, z, w = pose.quaternion
    return replace(pose, quaternion=(w, x, y, z))


def _inverted_tool(move: Move) -> Move:
    return replace(move, tool=replace(move.tool, tcp=move.tool.tcp.inverse()))


def _waits(factor: float) -> Fault:
    def changed(statement: Any) -> Any:
        if not isinstance(statement, Wait):
            return statement
        return replace(statement, duration=factor * statement.duration)

    def fault(program: Program) -> Program:
        return replace(program, statements=tuple(map(changed, program.statements)))

    return fault


def _rounded(decimals: int) -> Fault:
    def changed(target: Target) -> Target:
        if isinstance(target, JointTarget):
            return replace(target, joints=tuple(round(q, decimals) for q in target.joints))
        x, y, z = (round(p, decimals) for p in target.pose.position)
        return replace(target, pose=replace(target.pose, position=(x, y, z)))

    return _targets(changed)


COARSE = _rounded(3)
"""Targets in whole mm and thousandths of rad."""
_DEGREES = 180.0 / math.pi
_TURNS = ("reorientation", "external_angular", "joint", "joint_acceleration")


def _paced_by_shares(suite: Subject) -> bool:
    spoken = suite.vendor.speaks
    return spoken is not None and "joint_fraction" in spoken.joint.speeds


def _turns(suite: Subject) -> bool:
    spoken = suite.vendor.speaks
    said = _TURNS if spoken is None else {*spoken.joint.speeds, *spoken.line.speeds}
    return any(name in said for name in _TURNS)


MUTANTS = (
    Mutant("zones 100 times as large", _both(_zones, 100.0), GOLDEN),
    Mutant("zones as diameters", _both(_zones, 0.5), GOLDEN),
    Mutant("zones a little larger", _both(_zones, 1.02), GOLDEN),
    Mutant("speeds of the TCP in mm/s", _both(_speeds("tcp"), 1000.0), GOLDEN),
    Mutant("speeds of turning in degrees/s", _both(_speeds(*_TURNS), _DEGREES), GOLDEN, _turns),
    Mutant(
        "shares of speed halved", _both(_speeds("joint_fraction"), 0.5), GOLDEN, _paced_by_shares
    ),
    Mutant("joints in degrees", _both(_joints, _DEGREES), GOLDEN, has("joint target")),
    Mutant(
        "joints in another order",
        everywhere(*[_targets(_reversed_joints)] * 2),
        GOLDEN,
        has("joint target"),
    ),
    Mutant("positions in mm", _both(_lengths, 1000.0), GOLDEN, has("pose target")),
    Mutant(
        "orientations transposed",
        everywhere(*[_poses(_transposed)] * 2),
        GOLDEN,
        has("pose target"),
    ),
    Mutant(
        "quaternions with the scalar last",
        everywhere(_poses(_scalar_last), _poses(_scalar_first)),
        GOLDEN,
        has("pose target"),
    ),
    Mutant("tools inverted", everywhere(*[each_move(_inverted_tool)] * 2), GOLDEN, has("tool")),
    Mutant("waits in ms", _both(_waits, 1000.0), GOLDEN, has("Wait")),
    Mutant("targets rounded too coarsely on writing", in_writing(COARSE), AGAIN),
)
