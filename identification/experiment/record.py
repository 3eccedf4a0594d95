"""Records of runs as `flyby.identification.logs.records` reads them: the exact program, and where
its log will be."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...core.errors import InputError
from ...core.program.move import Move, MoveC, MoveJ, MoveL
from ...core.program.speed import Speed
from ...core.program.target import JointTarget, PoseTarget
from ...core.program.zone import ContourFraction, Fine, Radius, Zone
from ...core.robot.model import Robot
from ...core.spatial.pose import IDENTITY, Pose
from ..logs.records import SPEEDS
from .plan import Designed, PlannedCorner

_USUAL = Speed()


def record(
    made: Designed, robot: Robot, log: str, period: float, program: Iterable[str]
) -> dict[str, Any]:
    """The record of a designed run.

    Poses are in the robot's base, so that the robot of the catalogue drives the record. It states
    no start: the first move goes from where the log begins to where the measured motion does.

    Args:
        made: the run.
        robot: that drives it.
        log: name of the file, beside the record, that the log will be put into.
        period: s between its samples.
        program: files of the program that drives it.

    Raises:
        InputError: records do not hold such a program.
    """
    candidate, tool = made.candidate, made.program.moves[0].tool
    held: dict[str, Any] = {} if tool.tcp == IDENTITY else {"tool": _pose(tool.tcp)}
    return {
        "robot": robot.name,
        "log": {"file": log, "period_s": period},
        "program": list(program),
        "design": {
            "kind": str(candidate.kind),
            "posture": candidate.posture + 1,
            "speed_mps": candidate.speed,
            "corners": [corner_data(corner) for corner in candidate.corners],
            "start_rad": candidate.start.tolist(),
            "duration_s": made.duration,
            **purpose_data(made),
        },
        **held,
        "moves": [
            {"i": k, **_move(move, robot.base)} for k, move in enumerate(made.program.moves, 1)
        ],
    }


def corner_data(corner: PlannedCorner) -> dict[str, float]:
    """A corner in SI units, in the keys."""
    if corner.share is not None:
        return {"turn_rad": corner.turn, "contour_fraction": corner.share}
    return {"turn_rad": corner.turn, "radius_m": corner.radius}


def purpose_data(made: Designed) -> dict[str, Any]:
    """What a run about an open question is for; nothing of the usual runs."""
    if made.purpose is None:
        return {}
    instead = [
        {"if": one.what, "longer_s": one.longer, "apart_m": one.apart, "joints_rad": one.turned}
        for one in made.purpose.alternatives
    ]
    return {
        "about": str(made.topic),
        "question": made.purpose.question,
        "figures": list(made.purpose.figures),
        "instead": instead,
    }


def _move(move: Move, base: Pose) -> dict[str, Any]:
    entry: dict[str, Any] = {"type": type(move).__name__}
    match move:
        case MoveJ():
            if not isinstance(move.target, JointTarget):
                raise InputError("joint moves of a designed run end at joint values")
            entry["target_joints_rad"] = list(move.target.joints)
        case MoveC():
            entry["via_pose"] = _placed(move.via, base)
            entry["arc_orientation"] = str(move.orientation)
    if isinstance(move, MoveL | MoveC):
        if not isinstance(move.target, PoseTarget):
            raise InputError("lines and arcs of a designed run end at poses")
        entry["target_pose"] = _placed(move.target, base)
    return {**entry, "zone": _zone(move.zone), "speed": _speed(move.speed)}


def _placed(target: PoseTarget, base: Pose) -> dict[str, Any]:
    return _pose(target.pose if base == IDENTITY else base.inverse() @ target.pose)


def _pose(pose: Pose) -> dict[str, Any]:
    return {"xyz_m": list(pose.position), "quat_wxyz": list(pose.quaternion)}


def _zone(zone: Zone) -> dict[str, Any]:
    if isinstance(zone, Fine):
        return {"fine": True}
    if isinstance(zone, ContourFraction):
        return {"contour_fraction": zone.fraction}
    if not isinstance(zone, Radius):
        raise InputError(
            f"records of runs know zones with a radius or a share of the contour, not {zone}"
        )
    said = {
        "radius_m": zone.tcp,
        "pzone_ori_m": zone.reorientation,
        "zone_ori_rad": zone.angle,
        "zone_linear_m": zone.external_linear,
        "zone_rotating_rad": zone.external_angular,
        "name": zone.name,
    }
    return {key: value for key, value in said.items() if value is not None}


def _speed(speed: Speed) -> dict[str, Any]:
    """What differs from what `Speed` has by itself."""
    stated = {key: getattr(speed, name) for key, name in SPEEDS.items()}
    return {key: value for key, value in stated.items() if value != getattr(_USUAL, SPEEDS[key])}
