"""Reads records of runs: a JSON file with the exact program, and the log that it names.

The log is a file as `read_samples` takes it; the JSON names robot, tool, start and
moves in SI units (``target_pose`` as ``xyz_m`` with ``quat_wxyz`` or ``rotvec``, or
``target_joints_rad``; ``zone.radius_m``, ``rule_radius_m`` or ``contour_fraction``; speeds in
``speed``, see `SPEEDS`, or, for URScript, ``params``; ``arc_orientation`` of arcs).
`flyby.identification.experiment.record` writes them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.files.reading import read_json
from ...core.program.arc_orientation import ArcOrientation
from ...core.program.move import Move, MoveC, MoveJ, MoveL
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget, PoseTarget
from ...core.program.tool import FLANGE, Tool
from ...core.program.zone import FINE, ContourFraction, Radius, Zone
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose
from ...core.spatial.rotation import matrix_from_rotation_vector, quaternion_from_matrix
from .orientations import orientations_at
from .reading import read_samples
from .run import LoggedRun

_ROBOTS = {
    "irb 6640-180/2.55": "abb/irb6640-180-255",
    "kr 3 r540": "kuka/kr3-r540",
    "ur10e": "ur/ur10e",
    "ur3 (cb3)": "ur/ur3",
}
SPEEDS = {
    "tcp_mps": "tcp",
    "ori_radps": "reorientation",
    "acc_mps2": "tcp_acceleration",
    "ori_acc_radps2": "reorientation_acceleration",
    "external_mps": "external_linear",
    "external_radps": "external_angular",
    "joint_radps": "joint",
    "joint_acc_radps2": "joint_acceleration",
    "joint_fraction": "joint_fraction",
    "joint_acc_fraction": "joint_acceleration_fraction",
    "jerk_fraction": "jerk_fraction",
    "duration_s": "duration",
    "name": "name",
}
"""Keys of ``speed`` in a record, and what they are in `Speed`."""
_MOVED_MM = 1.0
"""Distance beyond which a record's first or last target is not where the run began or ended."""
_JOINT_MOVES = {"MoveJ", "MoveAbsJ", "PTP"}
_LINEAR_MOVES = {"MoveL", "LIN"}
_ARC_MOVES = {"MoveC", "CIRC"}
_FOLLOWING = "abb/"
"""Whose arcs turn the tool with them unless programmed otherwise; those of others do not."""


def load_run(path: Path, robots: Callable[[str], Robot]) -> LoggedRun:
    """Read a run from its JSON file; the log is the one that it names, beside it.

    Where the record gives a target's position alone, its orientation is what the log shows, see
    `orientations_at`; where it says that the first or last point was moved before the run, the
    log's first or last sample takes its place. So does the first one where it states no start.

    Args:
        path: the JSON file.
        robots: finds a robot by its catalogue name.

    Raises:
        InputError: naming file and, where there is one, the line or move.
    """
    data = read_json(path)
    if not isinstance(data, dict):
        raise InputError(f"{path}: not a run: an object with robot, log and moves is expected")
    return _run(path, data, robots)


@dataclass(frozen=True, eq=False)
class Record:
    """A record of a run that has been parsed.

    Args:
        path: of the JSON file.
        robot: catalogue name.
        log: that it names.
        data: all that it holds.
    """

    path: Path
    robot: str
    log: Path
    data: Mapping[str, Any]

    def run(self, robots: Callable[[str], Robot]) -> LoggedRun:
        """The run; see `load_run`."""
        return _run(self.path, dict(self.data), robots)


def find_record(path: Path) -> Record | None:
    """The record of a run that a JSON file is; None of other files."""
    try:
        data = read_json(path)
        if not {"moves", "log"} <= set(data):
            return None
        log = path.parent / str(data["log"]["file"])
        return Record(path, _robot(str(data["robot"])), log, data)
    except (TypeError, KeyError, InputError):
        return None


def _run(path: Path, data: dict[str, Any], robots: Callable[[str], Robot]) -> LoggedRun:
    try:
        log = path.parent / data["log"]["file"]
        robot = _robot(str(data["robot"]))
        real = data.get("real")
        samples = read_samples(log, robots(robot))
        data = _completed(data, robots(robot), samples.q)
        moves = tuple(_move(entry, data) for entry in data["moves"])
        start = JointTarget(tuple(map(float, _start(data, samples.q))))
    except KeyError as error:
        raise InputError(f"{path}: not a run: {error} is missing") from error
    except (AttributeError, OverflowError, TypeError, ValueError) as error:
        raise InputError(f"{path}: not a run: a value of the wrong kind ({error})") from error
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    program = Program(moves, path.stem, start)
    said = (str(data["note"]),) if data.get("note") else ()
    real = None if real is None else bool(real)
    notes = (*said, *samples.notes)
    return LoggedRun(
        path.stem,
        robot,
        real,
        program,
        samples.t,
        samples.q,
        notes,
        source=_source(data),
        timed=all("reconstructed" not in entry for entry in data["moves"]),
        zones_known=all("rule_radius_m" not in entry.get("zone", {}) for entry in data["moves"]),
    )


def _source(data: Mapping[str, Any]) -> str:
    """Runs of one data set from one controller were stamped by one clock."""
    return " / ".join(str(data[key]) for key in ("dataset", "controller") if data.get(key))


def _start(data: dict[str, Any], q: FloatArray) -> Sequence[float]:
    moved = float(data.get("checks", {}).get("log_start_to_first_target_mm", 0.0)) > _MOVED_MM
    return tuple(q[0] if moved else data.get("start_joints_rad", q[0]))


def _completed(data: dict[str, Any], robot: Robot, q: FloatArray) -> dict[str, Any]:
    """The record with orientations and the true last target filled in from the log."""
    moves = [dict(entry) for entry in data["moves"]]
    poses = [entry["target_pose"] for entry in moves if "target_pose" in entry]
    moved = float(data.get("checks", {}).get("log_end_to_last_target_mm", 0.0)) > _MOVED_MM
    if not moved and all("quat_wxyz" in pose or "rotvec" in pose for pose in poses):
        return data
    rotation, position = robot.forward(q)
    tcp = _tool(data).tcp.matrix()
    position = position + rotation @ tcp[:3, 3]
    rotation = rotation @ tcp[:3, :3]
    points = [position[0], *(_place(entry, robot, tcp) for entry in moves)]
    reach = [0.0, *(_blended(entry.get("zone", {})) for entry in moves)]
    shown = orientations_at(np.array(points), np.array(reach), position, rotation)
    quaternion = quaternion_from_matrix(shown)
    for entry, own in zip(moves, quaternion[1:], strict=True):
        pose = entry.get("target_pose")
        if pose is not None and "quat_wxyz" not in pose and "rotvec" not in pose:
            entry["target_pose"] = {**pose, "quat_wxyz": own.tolist()}
    if moved:
        last = quaternion_from_matrix(rotation[-1:])[0]
        end = {"xyz_m": position[-1].tolist(), "quat_wxyz": last.tolist()}
        moves[-1]["target_pose"] = end
        moves[-1].pop("target_joints_rad", None)
    return {**data, "moves": moves}


def _place(entry: dict[str, Any], robot: Robot, tcp: FloatArray) -> FloatArray:
    """(3,) m, where a move ends."""
    if "target_pose" in entry:
        return np.array(entry["target_pose"]["xyz_m"], dtype=float)
    rotation, position = robot.forward(np.array([entry["target_joints_rad"]], dtype=float))
    return np.asarray(position[0] + rotation[0] @ tcp[:3, 3])


def _blended(zone: Mapping[str, Any]) -> float:
    """m, how far from a waypoint orientations may blend."""
    return max(float(zone.get(key, 0.0)) for key in ("radius_m", "rule_radius_m", "pzone_ori_m"))


def _robot(name: str) -> str:
    if "/" in name and " " not in name:
        return name
    for known, catalogue in _ROBOTS.items():
        if name.casefold().startswith(known):
            return catalogue
    raise InputError(f"no catalogue robot is known for {name!r}")


def _pose(entry: Mapping[str, Any]) -> Pose:
    x, y, z = map(float, entry["xyz_m"])
    if "quat_wxyz" in entry:
        quaternion = np.array(entry["quat_wxyz"], dtype=float)
        quaternion /= np.linalg.norm(quaternion)
    else:
        quaternion = quaternion_from_matrix(matrix_from_rotation_vector(np.array(entry["rotvec"])))
    w, i, j, k = map(float, quaternion)
    return Pose((x, y, z), (w, i, j, k))


def _tool(data: Mapping[str, Any]) -> Tool:
    tool = data.get("tool")
    return Tool("tool", _pose(tool)) if isinstance(tool, dict) else FLANGE


def _zone(entry: Mapping[str, Any]) -> Zone:
    if entry.get("fine", False):
        return FINE
    if "contour_fraction" in entry:
        return ContourFraction(float(entry["contour_fraction"]))
    radius = float(entry.get("radius_m", entry.get("rule_radius_m", 0.0)))
    if radius == 0.0:
        return FINE
    return Radius(
        radius,
        float(entry.get("pzone_ori_m", 0.0)),
        float(entry.get("pzone_ori_m", 0.0)),
        float(entry.get("zone_ori_rad", 0.0)),
        float(entry.get("zone_linear_m", 0.0)),
        float(entry.get("zone_rotating_rad", 0.0)),
        name=entry.get("name"),
    )


def _speed(entry: Mapping[str, Any], joint: bool) -> Speed:
    if "params" in entry:
        params = entry["params"]
        if float(params.get("t", 0.0)) != 0.0:
            return Speed(duration=float(params["t"]))
        if joint:
            return Speed(joint=float(params["v"]), joint_acceleration=float(params["a"]))
        return Speed(tcp=float(params["v"]), tcp_acceleration=float(params["a"]))
    speed = {SPEEDS[key]: value for key, value in entry.get("speed", {}).items() if key in SPEEDS}
    if joint:
        speed.pop("tcp_acceleration", None)
    return Speed(**speed)


def _move(entry: Mapping[str, Any], data: Mapping[str, Any]) -> Move:
    kind = str(entry["type"])
    tool, zone = _tool(data), _zone(entry.get("zone", {"fine": True}))
    if kind in _JOINT_MOVES:
        speed = _speed(entry, True)
        if "target_joints_rad" in entry:
            target = JointTarget(tuple(map(float, entry["target_joints_rad"])))
            return MoveJ(target, speed, zone, tool)
        return MoveJ(PoseTarget(_pose(entry["target_pose"])), speed, zone, tool)
    goal = PoseTarget(_pose(entry["target_pose"]))
    speed = _speed(entry, False)
    if kind in _LINEAR_MOVES:
        return MoveL(goal, speed, zone, tool)
    if kind in _ARC_MOVES:
        via = PoseTarget(_pose(entry["via_pose"]))
        follows = _robot(str(data["robot"])).startswith(_FOLLOWING)
        usual = ArcOrientation.FOLLOWS_ARC if follows else ArcOrientation.FIXED_FRAME
        turn = ArcOrientation(entry.get("arc_orientation", usual))
        return MoveC(goal, speed, zone, tool, via=via, orientation=turn)
    raise InputError(f"move {entry.get('i', '?')} is of an unknown type {kind!r}")
