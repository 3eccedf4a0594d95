"""Joints follow a path on one branch of inverse kinematics, or the program is refused."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell
from flyby.core.collision.proof.certificate import certify, scenes_of
from flyby.core.collision.proof.verdict import Verdict
from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.motion.path.tcp_walk import JOINED
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.model import Robot
from flyby.core.robot.singularities import nearest_singularity
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

SPEED = Speed(tcp=0.25)
ROBOTS = ["ur/ur10", "ur/ur5e", "abb/irb6640-235-255", "kuka/kr30-3"]


def joints(q) -> JointTarget:
    return JointTarget(tuple(map(float, q)))


def drive(robot: Robot, start, *moves) -> Run:
    vendor = find_vendor(robot.name.split("/")[0])
    return Controller(vendor, robot).run(Program(moves, start=joints(start)))


def line(robot: Robot, q, zone: Zone = FINE) -> MoveL:
    return MoveL(PoseTarget(robot.flange_pose(q)), SPEED, zone)


def furthest_jump(run: Run) -> float:
    """The largest step of a joint from one piece of the path to the next."""
    right = run.path.pieces.first_sample[1:-1]
    return float(np.abs(run.path.q[right] - run.path.q[right - 1]).max(initial=0.0))


def branch(robot: Robot, q) -> tuple[bool, ...] | None:
    """The arm's own closed form of what stands at q; None where it stands singular."""
    found = robot.inverse(robot.flange_pose(q))
    apart = [np.abs(np.remainder(s.q - q + np.pi, 2 * np.pi) - np.pi).max() for s in found]
    nearest = found[int(np.argmin(apart))]
    if nearest.singular or nearest.branch is None or min(apart) > 1e-4:
        return None
    return nearest.branch.shoulder, nearest.branch.elbow, nearest.branch.wrist


def branches(robot: Robot, run: Run) -> list[set]:
    """The branches met on each stretch in TCP space."""
    pieces, met = run.path.pieces, []
    for p in np.flatnonzero(~pieces.joint_space):
        rows = range(pieces.first_sample[p], pieces.first_sample[p + 1], 3)
        met.append({branch(robot, run.path.q[row]) for row in rows} - {None})
    return met


def stretched(robot: Robot) -> float:
    """Where the third joint of an arm stretches it."""
    arm = robot.recognised.geometry
    upper, fore = arm.elbow - arm.shoulder, arm.wrist - arm.elbow
    bend = np.arctan2(fore[0], fore[1]) - np.arctan2(upper[0], upper[1])
    return float(-arm.signs[2] * bend)


def test_the_elbow_does_not_flip_between_two_samples() -> None:
    robot = find_robot("ur/ur10")
    start = np.array([1.443, 0.557, -0.1, 0.565, -0.333, -1.095])
    turn = matrix_from_rotation_vector(np.array([1.02263, 1.27299, 1.19667]))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, (0.25988, -0.998381, -0.368107)
    run = drive(
        robot,
        start,
        MoveL(PoseTarget(Pose.from_matrix(matrix)), SPEED, FINE),
        MoveJ(joints([1.775, 0.772, -0.229, 0.757, 0.1, -0.634]), SPEED, FINE),
    )
    assert furthest_jump(run) < JOINED
    assert run.path.q[:, 2].max() < -0.05
    t = run.trajectory
    fastest = np.abs(np.diff(t.q, axis=0)) / np.diff(t.t)[:, None]
    assert fastest.max() <= 1.01 * np.abs(t.dq).max() + 1e-6


def near_singularity(robot: Robot, seed: int, axis: int) -> tuple[np.ndarray, MoveL, MoveJ]:
    """A start, a line and a joint move, the line's ends near where an axis is singular."""
    rng = np.random.default_rng(seed)
    lower, upper = robot.limits.lower + 0.01, robot.limits.upper - 0.01
    middle = stretched(robot) if axis == 2 else 0.0

    def near(q) -> np.ndarray:
        q = np.array(q)
        q[axis] = middle + rng.uniform(0.02, 0.4) * rng.choice([-1, 1])
        return np.clip(q, lower, upper)

    a = near(rng.uniform(np.maximum(lower, -2), np.minimum(upper, 2)))
    b = near(a + rng.uniform(-0.3, 0.3, 6))
    end = np.clip(b + rng.uniform(-0.3, 0.3, 6), lower, upper)
    zone = FINE if seed % 2 else Radius(0.01, 0.01, 0.01, 0.1)
    return a, line(robot, b, zone), MoveJ(joints(end), SPEED, FINE)


@settings(max_examples=25)
@given(seed=st.integers(0, 10**6), name=st.sampled_from(ROBOTS), axis=st.sampled_from([2, 4]))
@example(seed=3, name="ur/ur10", axis=2)
@example(seed=31, name="ur/ur5e", axis=2)
@example(seed=2, name="kuka/kr30-3", axis=4)
def test_lines_that_begin_near_a_singularity_keep_their_branch(seed, name, axis) -> None:
    robot = find_robot(name)
    try:
        run = drive(robot, *near_singularity(robot, seed, axis))
    except MotionError as error:
        assert error.move is not None
        return
    assert furthest_jump(run) < JOINED
    if not any("conditioning 0.0" in note.message for note in run.notes):
        assert all(len(met) <= 1 for met in branches(robot, run))


def test_where_a_line_leaves_the_reach_is_told() -> None:
    robot, told = find_robot("ur/ur10"), []
    for seed in range(60):
        try:
            drive(robot, *near_singularity(robot, seed, 2))
        except MotionError as error:
            told.append(error)
    assert told
    place = r"\d+ % of the way along, [\d.]+ mm from its beginning"
    for error in told:
        assert error.move == 0
        if "reached" not in error.message and "limit" not in error.message:
            assert re.search(place, error.message), error.message


@pytest.mark.parametrize(
    ("q", "name"),
    [
        ([0.1, 0.2, 0.3, 0.4, 1e-4, 0.1], "wrist"),
        ([0.1, 0.2, None, 0.4, 0.9, 0.1], "elbow"),
    ],
)
def test_the_singularity_is_named(q, name) -> None:
    robot = find_robot("abb/irb6640-180-255")
    q = np.array([stretched(robot) + 1e-4 if value is None else value for value in q])
    assert nearest_singularity(robot, q).name == name


def test_a_path_that_is_torn_is_not_proven() -> None:
    robot = find_robot("abb/irb6640-180-255")
    q = np.array([0.1, 0.2, 0.3, 0.2, 0.6, 0.1])
    run = drive(robot, q, line(robot, q + 0.05), MoveJ(joints(q - 0.1), SPEED, FINE))
    controller = Controller(find_vendor("abb"), robot)
    scenes = scenes_of(Cell(robot, "abb"))
    assert certify(controller, run, scenes, 0.0).proven
    states = run.path.states
    after = np.zeros_like(states.q)
    after[run.path.pieces.first_sample[1] :] = 0.1
    torn = replace(run, path=replace(run.path, states=states._replace(q=states.q + after)))
    found = certify(controller, torn, scenes, 0.0)
    assert found.verdict is Verdict.UNPROVEN and "jump" in found.message
    assert found.move == 0
