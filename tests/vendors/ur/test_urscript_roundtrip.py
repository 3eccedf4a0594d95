"""What is written as URScript is read again, and written again to the same text."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, Load, Tool, WorkObject
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.registry import find_vendor
from flyby.core.source.patch.edits import difference
from flyby.core.source.reading import ReadOptions
from flyby.core.spatial.pose import Pose
from flyby.vendors.ur.motion.arcs import carried_along
from flyby.vendors.ur.motion.configuration import UrConfiguration
from flyby.vendors.ur.run.reader import read
from flyby.vendors.ur.values.poses import quaternion_of, rotation_vector_of
from flyby.vendors.ur.values.rotations import lasting_rotation_vector, nearest_rotation_vector
from flyby.vendors.ur.write.writer import write

VENDOR = find_vendor("ur")
UR5E, UR10E = VENDOR.robot("ur5e"), VENDOR.robot("ur10e")

# Programs that URScript can say. They need not be driveable.

lengths = st.floats(-1.5, 1.5)
positive = st.floats(1e-3, 50.0)
points = st.tuples(lengths, lengths, lengths)
names = st.none() | st.sampled_from(["Waypoint_1_p", "home", "pick", "end", "movej"])


@st.composite
def quaternions(draw: st.DrawFn) -> tuple[float, float, float, float]:
    """Unit quaternions of either sign, those of half turns and small ones among them."""
    first = draw(st.floats(-1, 1) | st.sampled_from([0.0, 1e-17, -1e-17, 1e-9]))
    rest = draw(st.tuples(*[st.floats(-1, 1) | st.sampled_from([0.0, 1e-9])] * 3))
    values = (first, *rest)
    size = math.sqrt(sum(x * x for x in values))
    if size < 1e-6:
        return (1.0, 0.0, 0.0, 0.0)
    w, x, y, z = (value / size for value in values)
    return (w, x, y, z)


poses = st.builds(Pose, points, quaternions())
joints = st.tuples(*[st.floats(-math.tau, math.tau)] * 6)
joint_speeds = st.builds(Speed, joint=positive, joint_acceleration=positive)
tcp_speeds = st.builds(Speed, tcp=positive, tcp_acceleration=positive)
durations = st.builds(Speed, duration=positive)


def _radius(r: float) -> Radius:
    return Radius(r, r, r)


zones: st.SearchStrategy[Zone] = st.just(FINE) | st.floats(1e-4, 0.5).map(_radius)
loads = st.none() | st.builds(
    Load, st.floats(0.01, 20), points, st.tuples(*[st.just(0.0) | st.floats(1e-4, 1)] * 3)
)
tools = st.just(FLANGE) | st.builds(Tool, st.just("tcp"), poses, loads)
joint_targets = st.builds(JointTarget, joints, name=names)
pose_targets = st.builds(PoseTarget, poses, name=names)
near_targets = st.builds(PoseTarget, poses, st.builds(UrConfiguration, joints), name=names)

moves: st.SearchStrategy[Move] = st.one_of(
    st.builds(
        MoveJ,
        joint_targets | pose_targets | near_targets,
        joint_speeds | durations,
        zones,
        tools,
    ),
    st.builds(MoveL, pose_targets | joint_targets, tcp_speeds | durations, zones, tools),
    st.builds(
        MoveC,
        pose_targets,
        tcp_speeds,
        zones,
        tools,
        via=pose_targets,
        orientation=st.just(ArcOrientation.FIXED_FRAME),
    ),
)
waits = st.builds(Wait, st.floats(0, 100))
programs = st.builds(Program, st.lists(moves | waits, max_size=8).map(tuple))


@settings(deadline=None)
@given(programs)
def test_read_after_write_is_the_program(program: Program) -> None:
    ((file, text),) = write(program, UR5E, {}).items()
    again = read(text, file)
    assert difference(program, again) is None
    assert dict(write(again, UR5E, {})) == {file: text}
    assert not {m.target.name for m in again.moves} & {"end", "movej"}


@given(quaternions())
def test_a_lasting_rotation_vector_comes_back(
    quaternion: tuple[float, float, float, float],
) -> None:
    vector = lasting_rotation_vector(quaternion)
    again = quaternion_of(*vector)
    assert lasting_rotation_vector(again) == vector
    assert abs(np.dot(again, quaternion)) > 1 - 1e-14
    assert math.hypot(*vector) <= math.pi + 2e-14


@given(quaternions(), st.tuples(*[st.floats(-12, 12)] * 3))
def test_the_nearest_rotation_vector_is_nearest(
    quaternion: tuple[float, float, float, float], near: tuple[float, float, float]
) -> None:
    found = nearest_rotation_vector(quaternion, near)
    assert abs(np.dot(quaternion_of(*found), quaternion)) > 1 - 1e-13
    base = np.array(rotation_vector_of(quaternion))
    angle = np.linalg.norm(base)
    if angle > 1e-6:
        others = [base * (1 + k * math.tau / angle) for k in range(-4, 5)]
        distance = math.dist(found, near)
        assert distance <= min(math.dist(other, near) for other in others) + 1e-9


@settings(deadline=None)
@given(poses, st.tuples(*[st.floats(-1, 1)] * 3))
def test_targets_of_a_work_object_stand_where_they_did(
    frame: Pose, point: tuple[float, float, float]
) -> None:
    """In the base of a robot that stands elsewhere, which the reader knows."""
    robot = UR5E.with_base(Pose((0.5, -0.25, 1.0), (math.cos(0.3), 0.0, 0.0, math.sin(0.3))))
    table = WorkObject("table", frame)
    speed = Speed(joint=1.0, joint_acceleration=2.0)
    move = MoveJ(PoseTarget(Pose(point), name="p1"), speed, work_object=table)
    ((file, text),) = write(Program((move,)), robot, {}).items()
    again = read(text, file, ReadOptions(robot=robot))
    (seen,) = again.moves
    assert isinstance(seen.target, PoseTarget)
    off = (frame @ Pose(point)).inverse() @ (seen.work_object.pose @ seen.target.pose)
    assert np.abs([*off.position, *off.quaternion[1:]]).max() < 1e-9
    assert "p1" not in text
    # In its own base the targets are those of the text.
    ((file, text),) = write(again, robot, {}).items()
    assert read(text, file, ReadOptions(robot=robot)) == again


def test_an_arc_that_keeps_its_orientation_is_read_again() -> None:
    """``mode=1``: the end's orientation follows from the arc."""
    speed = Speed(tcp=0.1, tcp_acceleration=1.0)
    q = np.radians([-90, -100, -110, -60, 90, 0])
    start = UR10E.flange_pose(q)
    x, y, z = start.position
    via, end = (x + 0.05, y + 0.05, z), (x + 0.1, y, z + 0.01)
    turned = carried_along(start, via, end)
    assert turned is not None
    arc = MoveC(PoseTarget(Pose(end, turned)), speed, via=PoseTarget(Pose(via)))
    home = MoveJ(JointTarget(tuple(q)), Speed(joint=1.0, joint_acceleration=1.0))
    ((file, text),) = write(Program((home, arc)), UR10E, {}).items()
    assert "mode=1" in text
    again = read(text, file, ReadOptions(robot=UR10E))
    assert difference(Program((home, arc)), again) is None


def test_shares_of_joint_speed_drive_alike() -> None:
    """From stop to stop the leading joint's speed says the same as shares of each joint's."""
    stops = ([0, -90, 90, 0, 90, 0], [40, -60, 70, 20, 60, -80], [-10, -80, 100, 20, 90, -80])
    speed = Speed(joint_fraction=0.35, joint_acceleration_fraction=0.2)
    moves = tuple(MoveJ(JointTarget(tuple(np.radians(stop))), speed) for stop in stops)
    start = JointTarget(tuple(np.radians([20, -100, 80, 10, 80, 30])))
    program = Program(moves, start=start)
    ((file, text),) = write(program, UR10E, {}).items()
    controller = Controller(VENDOR, UR10E)
    own = controller.run(program)
    again = controller.run(read(text, file), start)
    assert own.duration > 1
    assert abs(own.duration - again.duration) < 1e-6 * own.duration
