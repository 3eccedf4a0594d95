"""Obstacles: proven motions, no jumps, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.errors import InputError, MotionError
from flyby.core.motion.model.consumption import SquaredTorque
from flyby.core.robot.inertia import Inertia, carried_inertia
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.robot.model import Robot
from flyby.core.robot.shape import Box, LinkShape, Sphere
from flyby.core.spatial.pose import IDENTITY, Pose
from flyby.problems.free_motion.optimal_control import (
    ControlLimits,
    MotionEffort,
    MotionObjective,
    MotionTask,
    SchemeKind,
    SearchStep,
    Surroundings,
    TorqueLine,
    Waypoint,
    optimize,
)
from flyby.problems.free_motion.optimal_control.motion.proof import prove
from flyby.validation.scenes.stud_welding import stud_welding
from flyby.validation.scenes.two_joints import two_joints

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


def across(around: Surroundings, **more: object) -> MotionTask:
    robot = around.scene.robot
    return MotionTask(robot, [-1.0, 0.0], [1.0, 0.0], **more)  # type: ignore[arg-type]


OVER = [np.array([[-1.0, 0.8], [1.0, 0.8]])]


@pytest.mark.parametrize("scheme", list(SchemeKind))
@pytest.mark.parametrize("intervals", [12, 24])
def test_no_jump_through_a_thin_wall(intervals: int, scheme: SchemeKind) -> None:
    """The straight motion's nodes stand on both sides of the wall, none in it: it would be
    quicker, and every motion that is tried may go anywhere within a metre."""
    effort = MotionEffort(intervals=intervals, box=1.0, scheme=scheme)
    through = optimize(across(gantry()), effort=effort)
    nodes = through.motion.at(through.motion.knots)
    widest = int(np.diff(nodes[:, 0]).argmax())
    around = gantry(float(nodes[widest : widest + 2, 0].mean()))
    task = across(around)
    free = np.array([not around.scene.collides(q) for q in nodes])
    assert free.all() and not prove(task, through.motion, around.scene, 0.005).certificate.proven
    steps: list[SearchStep] = []
    found = optimize(task, around, effort, vias=OVER, report=lambda step: steps.append(step))
    assert found.proven
    t = np.linspace(0.0, found.time, 5000)
    clear = around.scene.clearance(found.motion.at(t), 0.1)
    assert clear.min() >= 0.005 - 1e-9
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
    task = MotionTask(scene.cell.robot, q[0], q[-1], joints=scene.free, tcp=scene.tool.tcp)
    found = optimize(task, around, MotionEffort(intervals=40), vias=[np.array(q[1:-1])])
    assert found.converged and found.proven
    assert found.time <= 1.130
    whole = found.trajectory(0.001)
    assert around.scene.clearance(whole.q, 0.1).min() >= 0.005 - 1e-9
    tip = whole.position
    assert tip[:, 2].max() > 0.75 and np.abs(tip[:, 1]).max() < 1e-9


def test_least_energy_does_not_keep_to_the_way_of_the_first_guess() -> None:
    """From a stop at every corner the search for energy alone ends at 8.3e6 N² m² s."""
    scene = stud_welding()
    program = scene.programs[13]
    targets = [program.start, *(move.target for move in program.moves)]
    q = [np.array(target.joints) for target in targets]  # type: ignore[union-attr]
    around = Surroundings(CollisionScene(scene.cell, scene.tool), scene.cell.clearance)
    load = carried_inertia(scene.tool)
    task = MotionTask(
        scene.cell.robot,
        q[0],
        q[-1],
        joints=scene.free,
        tcp=scene.tool.tcp,
        loads=(load,),
        objective=MotionObjective(0.0),
    )
    effort, vias = MotionEffort(intervals=16, trials=0), [np.array(q[1:-1])]
    found = optimize(task, around, effort, vias=vias)
    assert found.converged and found.proven
    assert found.energy() < 4.7e6
    ended = optimize(task, around, effort, vias=vias, report=lambda step: step.accepted)
    assert ended.proven and not ended.converged and ended.task is task
    assert found.energy() < ended.energy() and ended.time < ended.first.duration


def test_two_joints_round_a_box_with_weak_drives() -> None:
    scene = two_joints()
    program = scene.programs[0]
    targets = [program.start, *(move.target for move in program.moves)]
    q = [np.array(target.joints) for target in targets]  # type: ignore[union-attr]
    around = Surroundings(CollisionScene(scene.cell, scene.tool), scene.cell.clearance)
    limits = ControlLimits(torque=WEAK)
    task = MotionTask(
        scene.cell.robot, q[0], q[-1], joints=scene.free, tcp=scene.tool.tcp, limits=limits
    )
    found = optimize(task, around, MotionEffort(intervals=20, trials=0), vias=[np.array(q[1:-1])])
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
    found = optimize(across(around), around, MotionEffort(intervals=12, trials=0))
    assert found.proven and found.motion.at(found.motion.knots)[:, 1].max() > 0.5
    beside = replace(across(around), end=[-0.5, 0.3])
    assert optimize(beside, around, MotionEffort(intervals=12)).first.leg.max() == 0
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
        optimize(MotionTask(pendulum(5.0), [0.0], [np.pi / 2]))


def test_missing_inertias() -> None:
    bare = replace(ARM, links=())
    with pytest.raises(InputError, match=r"abb/irb6640-180-255 need the inertias of its links"):
        optimize(MotionTask(bare, START, END, objective=MotionObjective(0.5)))
    # Nothing is needed where only speeds and accelerations count.
    assert optimize(MotionTask(bare, START, END), effort=MotionEffort(intervals=8)).time > 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"start": [0.0, 1.0]}, r"start has shape \(2,\)"),
        ({"end": [np.nan]}, "joint X is not finite"),
        ({"joints": (0, 0)}, "MotionTask.joints are different indices"),
        ({"loads": (None, None)}, "2 loads were given for 1 legs"),
        ({"start_velocity": [200.0]}, "joint X is to move at 200, faster than its limit of 100"),
        ({"limits": ControlLimits(acceleration=[np.inf])}, "joint X has neither"),
        ({"limits": ControlLimits(velocity=[-1.0])}, "joint X: the velocity limit must be"),
        ({"waypoints": (Waypoint([99.0]),)}, "waypoint 1 cannot be reached: joint X"),
        (
            {"objective": MotionObjective(0.5, SquaredTorque((1.0, 2.0)))},
            "of 2 joints; there are 1",
        ),
        ({"limits": ControlLimits(torque=[np.nan])}, "joint X: the torque limit must be"),
        (
            {"limits": ControlLimits(torque="abc")},
            r"need one number an axis \(X\), not 'abc'",
        ),
        (
            {"waypoints": ([1.0],)},
            r"MotionTask.waypoints, number 1 is of type Waypoint, not \[1.0\]",
        ),
        ({"waypoints": Waypoint([1.0])}, "MotionTask.waypoints is a tuple of Waypoint values, not"),
        ({"loads": Inertia(1.0)}, "MotionTask.loads is a tuple of Inertia or None values, not"),
        ({"loads": (30.0,)}, "MotionTask.loads, number 1 is of type Inertia or None, not 30.0"),
        ({"tcp": None}, "MotionTask.tcp is of type Pose, not None"),
        ({"robot": "abb/irb6640"}, "MotionTask.robot is of type Robot, not 'abb/irb6640'"),
        ({"objective": 0.5}, "MotionTask.objective is of type MotionObjective, not 0.5"),
        ({"limits": {"torque": [1.0]}}, "MotionTask.limits is of type ControlLimits, not {"),
        ({"joints": 0}, "MotionTask.joints are different indices below 1, one at least, not 0"),
        ({"start": ["here"]}, r"start needs one number an axis \(X\), not"),
    ],
)
def test_bad_tasks(change: dict[str, object], message: str) -> None:
    given: dict[str, object] = {"robot": cart(), "start": [0.0], "end": [3.0], **change}
    with pytest.raises(InputError, match=message):
        optimize(MotionTask(**given))  # type: ignore[arg-type]


def test_a_time_that_is_too_short_is_refused() -> None:
    """At full acceleration it takes 2 √3 s."""
    task = MotionTask(cart(), [0.0], [3.0], objective=MotionObjective(longest=3.4))
    with pytest.raises(MotionError, match=r"takes 3.4 s at most was found"):
        optimize(task, effort=MotionEffort(intervals=12))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Surroundings(gantry().scene, np.nan), "clearance is zero or more metres"),
        (lambda: Surroundings(gantry().scene, -0.001), "clearance is zero or more metres"),
        (lambda: MotionEffort(intervals=2.5), "intervals is a whole number, 1 or more, not 2.5"),
        (lambda: MotionEffort(trials=17), "trials is a whole number, from 0 to 16, not 17"),
        (lambda: MotionEffort(group=0), "group is a whole number, 1 or more, not 0"),
        (lambda: MotionEffort(scheme="rk4"), "scheme is of type SchemeKind, not 'rk4'"),
        (lambda: MotionEffort(gain="small"), "gain is a finite number above zero, not 'small'"),
        (lambda: MotionObjective("fast"), "time_weight is a number from 0 to 1, not 'fast'"),
        (lambda: MotionObjective(np.nan), "time_weight is a number from 0 to 1, not nan"),
        (lambda: MotionObjective(0.5, None), "consumption is of type Consumption, not None"),
        (lambda: MotionObjective(longest=-1.0), "longest is a finite number above zero, not -1.0"),
        (
            lambda: MotionObjective(smoothing=0.0),
            "smoothing is a finite number above zero, not 0.0",
        ),
        (lambda: ControlLimits(tcp_speed="fast"), "tcp_speed is a finite number above zero"),
        (lambda: ControlLimits(tcp_speed=np.nan), "tcp_speed is a finite number above zero"),
        (lambda: ControlLimits(curves=TorqueLine("X", 1.0, 1.0)), "curves is a tuple of Torque"),
        (lambda: TorqueLine("X", "a lot", 1.0), "torque line of X: most is a finite number"),
        (
            lambda: optimize(arm_task(), effort={"intervals": 8}),
            "effort is of type MotionEffort or",
        ),
        (lambda: optimize(arm_task(), "cell.toml"), "around is of type Surroundings or None"),
    ],
)
def test_bad_settings(make: Callable[[], object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()


def test_corners_out_of_range() -> None:
    around = gantry()
    with pytest.raises(InputError, match=r"corner 1 of the path .* joint Y .* is outside"):
        optimize(across(around), around, vias=[[[0.0, 99.0]]])


def test_a_joint_that_may_not_move_cannot_be_asked_to() -> None:
    with pytest.raises(InputError, match="joint J1 has to move"):
        MotionTask(ARM, START, END, joints=(1, 2, 3, 4, 5))


def test_a_torque_line_of_an_axis_that_brakes_hold() -> None:
    track = Joint("E1", Pose(), (1.0, 0.0, 0.0), -1, 1, 1, 1, kind=JointKind.PRISMATIC)
    robot = ARM.with_external_axes([ExternalAxis(track, ExternalRole.TRACK)])
    for axis, message in (("J9", "given for 'J9'"), ("E1", "'E1'; the axes are J1, .*, J6$")):
        limits = ControlLimits(curves=(TorqueLine(axis, 100.0, 1.0),))
        task = MotionTask(robot, [*START, 0.0], [*END, 0.0], joints=range(6), limits=limits)
        with pytest.raises(InputError, match=message):
            optimize(task)


def test_a_jerk_limit_needs_a_scheme_with_jerk() -> None:
    task = MotionTask(cart(), [0.0], [1.0], limits=ControlLimits(jerk=[5.0]))
    with pytest.raises(InputError, match="have no jerk to limit"):
        optimize(task, effort=MotionEffort(scheme=SchemeKind.CONSTANT))


def test_joints_that_stand_still_have_to_be_held() -> None:
    ends = np.array([START, START])
    ends[1, [1, 2]] += 0.7
    weak = list(TORQUE)
    weak[4] = 1.0
    with pytest.raises(InputError, match=r"the start: joint J5 needs .* against gravity"):
        optimize(MotionTask(ARM, *ends, joints=(1, 2), limits=ControlLimits(torque=weak)))
