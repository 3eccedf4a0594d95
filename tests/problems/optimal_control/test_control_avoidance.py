"""Obstacles: proven motions, no jumps, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry
from flyby.core.collision.scene import CollisionScene
from flyby.core.errors import InputError, MotionError
from flyby.core.robot.inertia import Inertia
from flyby.core.robot.joint import Joint, JointKind
from flyby.core.robot.model import Robot
from flyby.core.robot.shape import Box, LinkShape, Sphere
from flyby.core.spatial.pose import IDENTITY, Pose
from flyby.problems.optimal_control import (
    ControlLimits,
    Effort,
    Objective,
    SchemeKind,
    SquaredTorque,
    Step,
    Surroundings,
    Task,
    Waypoint,
    optimize,
)
from flyby.problems.optimal_control.proof import prove
from flyby.problems.scenes.two_joints import two_joints

from .control_tasks import ARM, END, START, TORQUE, arm_task, cart, pendulum

WEAK = (1e4, 5500.0, 2600.0, 1e3, 1e3, 1e3)
"""N m, some more than what holds the arm."""
WALL = 0.02
"""m, thinner than the way between two nodes."""


@cache
def gantry(x: float = 0.0, top: float = 0.5) -> Surroundings:
    """A ball of 1 cm that two rails move in a plane, and a thin wall at x across its way."""
    rails = [
        Joint(name, IDENTITY, axis, -3, 3, 5.0, 10.0, None, JointKind.PRISMATIC)
        for name, axis in (("X", (1, 0, 0)), ("Y", (0, 1, 0)))
    ]
    robot = Robot(
        "test/gantry",
        tuple(rails),
        links=(Inertia(1.0), Inertia(1.0)),
        shapes=(LinkShape(2, Sphere(0.01)),),
    )
    height = 2.0 + top
    wall = Geometry(Box((WALL, height, 1.0)), Pose((x, top - height / 2, 0.0)))
    cell = Cell(robot, "abb", clearance=0.005, obstacles=(Obstacle("wall", wall),))
    return Surroundings(CollisionScene(cell), 0.005)


def across(around: Surroundings, **more: object) -> Task:
    robot = around.scene.robot
    return Task(robot, [-1.0, 0.0], [1.0, 0.0], **more)  # type: ignore[arg-type]


OVER = [np.array([[-1.0, 0.8], [1.0, 0.8]])]


@pytest.mark.parametrize("scheme", list(SchemeKind))
@pytest.mark.parametrize("intervals", [12, 24])
def test_no_jump_through_a_thin_wall(intervals: int, scheme: SchemeKind) -> None:
    """The straight motion's nodes stand on both sides of the wall, none in it: it would be
    quicker, and every motion that is tried may go anywhere within a metre."""
    effort = Effort(intervals=intervals, box=1.0, scheme=scheme)
    through = optimize(across(gantry()), effort=effort)
    nodes = through.motion.at(through.motion.knots)
    widest = int(np.diff(nodes[:, 0]).argmax())
    around = gantry(float(nodes[widest : widest + 2, 0].mean()))
    task = across(around)
    free = np.array([not around.scene.collides(q) for q in nodes])
    assert free.all() and not prove(task, through.motion, around.scene, 0.005).certificate.proven
    steps: list[Step] = []
    found = optimize(task, around, effort, vias=OVER, report=lambda step: steps.append(step))
    assert found.proven
    t = np.linspace(0.0, found.time, 5000)
    clear = around.scene.clearance(found.motion.at(t), 0.1)
    assert clear.min() >= 0.005 - 1.1e-5
    assert found.motion.at(t)[:, 1].max() > 0.5
    assert through.time < found.time < 0.8 * found.first.duration
    accepted = [step.objective for step in steps if step.accepted]
    assert accepted == sorted(accepted, reverse=True)


def test_two_joints_round_a_box() -> None:
    scene = two_joints()
    program = scene.programs[0]
    targets = [program.start, *(move.target for move in program.moves)]
    q = [np.array(target.joints) for target in targets]  # type: ignore[union-attr]
    around = Surroundings(CollisionScene(scene.cell, scene.tool), scene.cell.clearance)
    task = Task(scene.cell.robot, q[0], q[-1], joints=scene.free, tcp=scene.tool.tcp)
    found = optimize(task, around, Effort(intervals=40), vias=[np.array(q[1:-1])])
    assert found.converged and found.proven
    assert found.time <= 1.130
    whole = found.trajectory(0.001)
    assert around.scene.clearance(whole.q, 0.1).min() >= 0.005 - 1.1e-5
    tip = whole.position
    assert tip[:, 2].max() > 0.75 and np.abs(tip[:, 1]).max() < 1e-9


def test_two_joints_round_a_box_with_weak_drives() -> None:
    scene = two_joints()
    program = scene.programs[0]
    targets = [program.start, *(move.target for move in program.moves)]
    q = [np.array(target.joints) for target in targets]  # type: ignore[union-attr]
    around = Surroundings(CollisionScene(scene.cell, scene.tool), scene.cell.clearance)
    limits = ControlLimits(torque=WEAK)
    task = Task(scene.cell.robot, q[0], q[-1], joints=scene.free, tcp=scene.tool.tcp, limits=limits)
    found = optimize(task, around, Effort(intervals=20, trials=0), vias=[np.array(q[1:-1])])
    assert found.converged and found.proven and 1.14 < found.time < 0.5 * found.first.duration
    used = np.abs(found.torque(np.linspace(0.0, found.time, 4001))) / found.limits.torque
    assert 0.999 < used.max() <= 1.001


def test_refused_stations() -> None:
    around = gantry()
    with pytest.raises(MotionError, match=r"the start collides: .*wall"):
        optimize(replace(across(around), start=[0.0, 0.0]), around)
    with pytest.raises(MotionError, match=r"the end: .*apart, less than the clearance of 5 mm"):
        optimize(replace(across(around), end=[0.022, 0.0]), around)
    with pytest.raises(InputError, match=r"the end cannot be reached: joint Y at 3500 mm"):
        optimize(replace(across(around), end=[1.0, 3.5]), around)
    with pytest.raises(MotionError, match="path to begin with"):
        optimize(across(around), around, vias=[[]])


def test_a_path_is_planned_where_none_is_given() -> None:
    pytest.importorskip("ompl")
    around = gantry()
    found = optimize(across(around), around, Effort(intervals=12, trials=0))
    assert found.proven and found.motion.at(found.motion.knots)[:, 1].max() > 0.5
    beside = replace(across(around), end=[-0.5, 0.3])
    assert optimize(beside, around, Effort(intervals=12)).first.leg.max() == 0
    with pytest.raises(MotionError, match="joint Y is to stand still: give corners"):
        optimize(replace(across(around), joints=(0,)), around)


@pytest.mark.parametrize(
    ("vias", "message"),
    [
        ([], "corners of 0 legs were given; there are 1"),
        ([[[0.0, 1.0, 2.0]]], r"corners of leg 1 have shape \(1, 3\); a row has the 2 axes"),
        ([[[0.0, np.nan]]], "corners of leg 1 are not finite"),
    ],
)
def test_bad_corners(vias: list[list[list[float]]], message: str) -> None:
    around = gantry()
    with pytest.raises(InputError, match=message):
        optimize(across(around), around, vias=vias)


def test_torque_limits_that_cannot_hold_the_arm() -> None:
    weak = list(TORQUE)
    weak[2] = 100.0
    with pytest.raises(InputError, match=r"the start: joint J3 needs .* against gravity"):
        optimize(arm_task(limits=ControlLimits(torque=weak)))
    with pytest.raises(InputError, match=r"the end: joint P needs 9.81 N m"):
        optimize(Task(pendulum(5.0), [0.0], [np.pi / 2]))


def test_missing_inertias() -> None:
    bare = replace(ARM, links=())
    with pytest.raises(InputError, match=r"abb/irb6640-180-255 need the inertias of its links"):
        optimize(Task(bare, START, END, objective=Objective(0.5)))
    # Nothing is needed where only speeds and accelerations count.
    assert optimize(Task(bare, START, END), effort=Effort(intervals=8)).time > 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"start": [0.0, 1.0]}, r"start has shape \(2,\)"),
        ({"end": [np.nan]}, "joint X is not finite"),
        ({"joints": (0, 0)}, "joints are different indices"),
        ({"loads": (None, None)}, "2 loads were given for 1 legs"),
        ({"start_velocity": [200.0]}, "joint X is to move at 200, faster than its limit of 100"),
        ({"limits": ControlLimits(acceleration=[np.inf])}, "joint X has neither"),
        ({"limits": ControlLimits(velocity=[-1.0])}, "joint X: the velocity limit must be"),
        ({"waypoints": (Waypoint([99.0]),)}, "waypoint 1 cannot be reached: joint X"),
        ({"objective": Objective(0.5, SquaredTorque((1.0, 2.0)))}, "figures of 2 joints; 1 joints"),
        ({"limits": ControlLimits(torque=[np.nan])}, "joint X: the torque limit must be"),
        ({"limits": ControlLimits(torque="abc")}, "torque limits must be 1 numbers, one an axis"),
        ({"limits": ControlLimits(tcp_speed="fast")}, "speed limit must be positive, not 'fast'"),  # type: ignore[arg-type]
        ({"waypoints": ([1.0],)}, r"waypoint 1 is a Waypoint, not \[1.0\]"),
        ({"start": ["here"]}, "start must be 1 numbers, one an axis, not"),
        ({"limits": ControlLimits(tcp_speed=np.nan)}, "TCP's speed limit must be positive"),
    ],
)
def test_bad_tasks(change: dict[str, object], message: str) -> None:
    given: dict[str, object] = {"robot": cart(), "start": [0.0], "end": [3.0], **change}
    with pytest.raises(InputError, match=message):
        optimize(Task(**given))  # type: ignore[arg-type]


def test_a_time_that_is_too_short_is_refused() -> None:
    """At full acceleration it takes 2 √3 s."""
    task = Task(cart(), [0.0], [3.0], objective=Objective(longest=3.4))
    with pytest.raises(MotionError, match=r"takes 3.4 s at most was found"):
        optimize(task, effort=Effort(intervals=12))


def test_bad_settings() -> None:
    for wrong in (np.nan, -0.001):
        with pytest.raises(InputError, match="clearance is zero or more metres"):
            Surroundings(gantry().scene, wrong)
    with pytest.raises(InputError, match=r"intervals is a whole number, one or more, not 2.5"):
        Effort(intervals=2.5)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"trials is from 0 to 16, not 17"):
        Effort(trials=17)


def test_a_joint_that_may_not_move_cannot_be_asked_to() -> None:
    with pytest.raises(InputError, match="joint J1 has to move"):
        Task(ARM, START, END, joints=(1, 2, 3, 4, 5))


def test_a_jerk_limit_needs_a_scheme_with_jerk() -> None:
    task = Task(cart(), [0.0], [1.0], limits=ControlLimits(jerk=[5.0]))
    with pytest.raises(InputError, match="have no jerk to limit"):
        optimize(task, effort=Effort(scheme=SchemeKind.CONSTANT))
