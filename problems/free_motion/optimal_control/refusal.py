"""What cannot be asked of a robot, said before anything is searched for."""

from __future__ import annotations

import numpy as np

from ....core.errors import InputError, MotionError
from ..planning.ends import check_coupled
from .motion.scheme import SchemeKind
from .search.surroundings import Surroundings
from .task.limits import MotionLimits
from .task.sampled import Plant, State
from .task.task import MotionTask

_IN_RANGE = 1e-9


def check_task(
    task: MotionTask,
    limits: MotionLimits,
    plant: Plant | None,
    around: Surroundings | None,
    scheme: SchemeKind,
) -> None:
    """Refuse what no motion can do.

    Raises:
        InputError: the arm has ranges of several joints together, a station is out of a joint's
            range or a given velocity beyond its limit, or torque limits cannot hold the arm where
            it has to rest.
        MotionError: the robot collides at a station.
    """
    check_coupled(task.robot)
    _check_bounded(task, limits, scheme)
    names = _station_names(task)
    for name, q in zip(names, task.stations, strict=True):
        _check_range(task, f"the {name}", q)
    for name, velocity in (("start", task.start_velocity), ("end", task.end_velocity)):
        own = np.abs(np.asarray(velocity))[task.moving]
        fast = np.flatnonzero(own > limits.velocity)
        if len(fast):
            axis = task.robot.axis_names[task.moving[fast[0]]]
            raise InputError(
                f"the {name}: joint {axis} is to move at {own[fast[0]]:.4g}, faster than its "
                f"limit of {limits.velocity[fast[0]]:.4g} per s"
            )
    if plant is not None and limits.dynamic:
        _check_held(task, limits, plant, names)
    if around is not None:
        for name, q in zip(names, task.stations, strict=True):
            _check_clear(name, q, around)


def _check_bounded(task: MotionTask, limits: MotionLimits, scheme: SchemeKind) -> None:
    """What cannot be bounded between nodes."""
    if scheme is SchemeKind.CONSTANT and np.isfinite(limits.jerk).any():
        raise InputError(
            "accelerations that are constant from point to point have no jerk to limit; take the "
            "linear or the Hermite–Simpson scheme"
        )
    outside = task.moving[task.moving >= task.robot.arm_size]
    if len(outside) and (limits.dynamic or np.isfinite(limits.tcp_speed)):
        raise InputError(
            f"external axis {task.robot.axis_names[outside[0]]} is to move: torques and the TCP's "
            "speed cannot be shown to hold all the way then; leave those limits out"
        )


def check_corners(task: MotionTask, points: np.ndarray) -> None:
    """Refuse corners (L, n), of the joints that move, out of their ranges.

    Raises:
        InputError: there is one.
    """
    for k, q in enumerate(task.whole(points)):
        _check_range(task, f"corner {k} of the path to begin with", q)


def _station_names(task: MotionTask) -> list[str]:
    return ["start", *(f"waypoint {k + 1}" for k in range(len(task.waypoints))), "end"]


def _check_range(task: MotionTask, name: str, q: np.ndarray) -> None:
    limits = task.robot.limits
    out = (q < limits.lower - _IN_RANGE) | (q > limits.upper + _IN_RANGE)
    if out.any():
        j = int(np.flatnonzero(out)[0])
        joints = [*task.robot.joints, *(axis.joint for axis in task.robot.external_axes)]
        joint = joints[j]
        raise InputError(
            f"{name} cannot be reached: joint {joint.name} at {joint.shown(float(q[j]))} is "
            f"outside {joint.shown(joint.lower)} to {joint.shown(joint.upper)}"
        )


def _check_held(task: MotionTask, limits: MotionLimits, plant: Plant, names: list[str]) -> None:
    """Torque limits have to hold the arm where it rests."""
    resting = [not np.any(task.start_velocity), *(w.stop for w in task.waypoints)]
    resting.append(not np.any(task.end_velocity))
    axis, most, _ = limits.torques
    for k, (name, q, rests) in enumerate(zip(names, task.stations, resting, strict=True)):
        for leg in {max(k - 1, 0), min(k, task.legs - 1)} if rests else ():
            still = q[None, task.moving]
            state = State(still, 0 * still, 0 * still, np.array([leg]))
            torque = plant.torques(state)[0, axis]
            weak = np.flatnonzero(np.abs(torque) > most)
            if len(weak):
                j = int(weak[0])
                raise InputError(
                    f"the {name}: joint {task.robot.axis_names[axis[j]]} needs "
                    f"{abs(torque[j]):.4g} N m (N) against gravity, more than its limit of "
                    f"{most[j]:.4g}; raise the limit or lighten the load"
                )


def _check_clear(name: str, q: np.ndarray, around: Surroundings) -> None:
    contact = around.scene.contact(q)
    if contact is not None:
        raise MotionError(f"the {name} collides: {contact}")
    found = around.scene.distances(q[None], around.clearance + 1e-3)
    pair = int(found.distance[0].argmin())
    if found.distance[0, pair] < around.clearance:
        first, second = around.scene.pair_names(pair)
        raise MotionError(
            f"the {name}: {first} and {second} are {1e3 * found.distance[0, pair]:.3g} mm apart, "
            f"less than the clearance of {1e3 * around.clearance:.3g} mm"
        )
