"""When a robot is where on its path, beside its trajectory."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.cell.floor import bare_cell
from flyby.core.collision.mutual.meetings import Meetings
from flyby.core.collision.mutual.pair_proof import PairProver
from flyby.core.collision.mutual.robot_motion import RobotMotion
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose

HOME = np.array([0.0, -1.0, 1.4, 0.0, 0.6, 0.0])
NOWHERE = Pose((0.0, 0.0, 0.0))


def driven(
    turns: list[np.ndarray], zone: Zone = FINE, base: Pose = NOWHERE, **averages: object
) -> RobotMotion:
    """A KR 6 that drives from joint target to joint target, with averages of its own."""
    vendor = find_vendor("kuka")
    robot = find_robot("kuka/kr6-r900-2").with_base(base)
    controller = Controller(vendor, robot, replace(vendor.motion_of(robot), **averages))
    moves = [MoveJ(JointTarget(tuple(q)), Speed(joint=3.0), zone) for q in turns[1:]]
    run = controller.run(Program(tuple(moves), start=JointTarget(tuple(turns[0]))), None, None)
    return RobotMotion("one", controller, run, bare_cell(robot, "kuka", floor=False))


def turned(*first: float) -> list[np.ndarray]:
    return [HOME + np.array([turn, *(0.0,) * 5]) for turn in first]


def at(run: Run, t: np.ndarray) -> np.ndarray:
    return np.stack([np.interp(t, run.trajectory.t, q) for q in run.trajectory.q.T], -1)


@pytest.mark.parametrize(
    "averages",
    [
        {},
        {"smoothing": (0.2,), "joint_smoothing": ()},
        {"ramp": 0.15},
        {"smoothing": (0.03, 0.1), "joint_smoothing": (), "ramp": 0.1},
    ],
    ids=["own", "long", "ramp", "both"],
)
@pytest.mark.parametrize("zone", [FINE, Radius(0.05, 0.05, 0.05)], ids=["stops", "fly-by"])
def test_a_robot_is_on_an_interval_of_the_time(averages: dict[str, object], zone: Zone) -> None:
    rng = np.random.default_rng(4)
    turns = [HOME + rng.uniform(-0.7, 0.7, 6) for _ in range(3)]
    moving = driven([*turned(-1.5, 0.5), *turns], zone, **averages)
    rows = np.arange(moving.first)
    for _ in range(5):
        child, known = moving.halved(rows)
        rows = np.concatenate([rows[~known], child[known], child[known] + 1])
    t = np.arange(0.0, moving.run.duration, 2e-3)
    _, p = moving.placed(at(moving.run, t))
    _, p0 = moving.placed(moving.middles[rows])
    motion, times = moving.side.swept.motion[rows], moving.own_time[rows]
    assert motion.max() < 0.06
    for k in range(len(t)):
        there = (times[:, 0] <= t[k]) & (t[k] <= times[:, 1])
        assert there.any()
        gone = np.linalg.norm(p0[there] - p[k], axis=-1)
        assert (gone - motion[there]).max(axis=1).min() < 2e-5, t[k]


def test_proofs_in_time_are_as_fine_as_motions_are_fast() -> None:
    """No coarser than by samples of the paths: two arms that pass each other at 3 rad/s."""
    one, other = (
        driven(turned(-1.193, 0.275, -1.193)),
        driven(turned(-1.446, 0.3, -1.446), base=Pose((1.3, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))),
    )
    prover = PairProver(one, other)
    late = 0.494
    t = np.arange(0.0, max(one.run.duration, other.run.duration) + late, 5e-4)
    least, _, _ = prover.nearest(at(one.run, t), at(other.run, t - late))
    assert 0.1 < least < 0.2
    meetings = Meetings((lambda own: own, lambda own: own + late), 0.0, every=False)
    assert prover.prove(least - 5e-3, meetings).proven
    assert not prover.prove(least + 1e-3, meetings).proven


def test_distances_beyond_a_hand_are_measured_too() -> None:
    one = driven(turned(-1.5, -1.2))
    other = driven(turned(-1.5, -1.2), base=Pose((1.3, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))
    prover = PairProver(one, other)
    t = np.arange(0.0, one.run.duration, 2e-3)
    i, j = (k.ravel() for k in np.indices((len(t), len(t))))
    q = at(one.run, t), at(other.run, t)
    least, _, _ = prover.nearest(q[0][i][::7], q[1][j][::7])
    assert least > 0.2
    assert prover.prove(least - 5e-3, Meetings.at_any_time()).proven
    (conflict,) = prover.prove(least + 5e-3, Meetings.at_any_time()).conflicts.values()
    assert conflict.distance is not None and conflict.distance > least - 1e-2
