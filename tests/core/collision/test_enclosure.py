"""Enclosures hold the path: every densely sampled configuration, and how fast it changes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.collision.proof.enclosure import EnclosedIntervals, Enclosure
from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.corners import POSITION
from flyby.core.motion.geometry.curves import parameter_jet
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.blend import PARABOLA, TANGENT_ARC, Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.path.path import Path
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Tool, WorkObject
from flyby.core.program.zone import Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector
from flyby.testing.strategies import programs

SECOND_ORDER = Blend(alpha=(0.0, 0.0, 0.0, 10.0, -15.0, 6.0))
BLENDS = {
    "parabola": MotionModel(),
    "second order": MotionModel(tcp=SECOND_ORDER, joint=SECOND_ORDER, orientation=SECOND_ORDER),
    "bulging": MotionModel(tcp=Blend(beta=(3.0, 1.0)), joint=Blend(beta=(2.0,))),
    "tangent arc": MotionModel(tcp=TANGENT_ARC, joint=PARABOLA),
}
ROBOTS = ["abb/irb6640-180-255", "kuka/kr3-r540", "ur/ur10e"]
DENSE = Sampling(step=0.004, turn=0.02, joint=0.02, halvings=1, most=2000)
FEW = settings(max_examples=12)


def leaves(path: Path, levels: int = 22) -> list[EnclosedIntervals]:
    """Intervals with enclosures that cover the path."""
    enclosure = Enclosure.of(path)
    intervals = enclosure.over([(0.0, path.sigma[-1])])
    found = []
    for _ in range(levels):
        found.append(intervals)
        open_ = np.flatnonzero(~intervals.boxes.verified)
        if not len(open_):
            return found
        intervals = enclosure.halves(intervals, open_)
    raise AssertionError(f"not enclosed: conditioning {intervals.boxes.conditioning.min():.1e}")


def parameters(path: Path, piece: int, sigma: FloatArray) -> FloatArray:
    if not path.pieces.joint_space[piece]:
        return sigma
    window = path.joint.window[path.pieces.curve[piece, POSITION]]
    return np.array([parameter_jet(window, value)[0] for value in sigma])


def assert_enclosed(path: Path, dense: Path) -> None:
    """Every sample of ``dense`` lies in the boxes of ``path``, and so do the rates."""
    covered = np.zeros(len(dense.sigma), dtype=bool)
    first = dense.pieces.first_sample
    for intervals in leaves(path):
        boxes = intervals.boxes
        for i in np.flatnonzero(boxes.verified):
            piece = int(intervals.piece[i])
            rows = np.arange(first[piece], first[piece + 1])
            at = parameters(path, piece, dense.sigma[rows])
            begin, end = intervals.begin[i], intervals.end[i]
            slack = 1e-9 * (end - begin)
            inside = (at >= begin - slack) & (at <= end + slack)
            rows, at = rows[inside], at[inside]
            covered[rows] = True
            t = ((2 * at - begin - end) / (end - begin))[:, None]
            moved = dense.q[rows] - boxes.q[i]
            rest = moved - boxes.rate[i] * t
            assert (np.abs(moved) <= boxes.reach[i] + 1e-8).all()
            assert (np.abs(rest) <= 0.5 * boxes.second[i] * t**2 + 1e-8).all()
            between = np.abs(np.diff(dense.q[rows], axis=0))
            assert (between <= boxes.first[i] * np.diff(t, axis=0) + 1e-8).all()
            assert (np.abs(boxes.rate[i]) <= boxes.first[i] + 1e-12).all()
            assert (boxes.reach[i] <= boxes.first[i] + 1e-12).all()
    assert covered.all()


def assert_program_enclosed(name: str, model: MotionModel, program: Program, robot=None) -> None:
    robot = robot or find_robot(name)
    vendor = find_vendor(name.split("/")[0])
    try:
        path = Controller(vendor, robot, model).plan(program)
    except MotionError:
        assume(False)
    dense = Controller(vendor, robot, model, DENSE).plan(program)
    assert_enclosed(path, dense)


@FEW
@given(st.data(), st.sampled_from(ROBOTS), st.sampled_from(sorted(BLENDS)))
def test_random_programs_stay_in_their_enclosures(data, name, blend) -> None:
    program = data.draw(programs(find_robot(name), max_moves=4))
    assert_program_enclosed(name, BLENDS[blend], program)


HOME = np.array([0.1, 0.2, 0.3, 0.2, 0.9, 0.1])
TRACK = ExternalAxis(
    Joint("E1", Pose((0, -1, 0)), (0.0, 1.0, 0.0), -3, 3, 1, 2, kind=JointKind.PRISMATIC),
    ExternalRole.TRACK,
)
TABLE = ExternalAxis(
    Joint("T", Pose((1.6, 0.0, 0.6)), (0.0, 0.0, 1.0), -6, 6, 2, 4), ExternalRole.TABLE
)
STEPS = st.tuples(*[st.floats(-0.2, 0.2)] * 3).map(np.array)
TURNS = st.tuples(*[st.floats(-0.4, 0.4)] * 3).map(np.array)


def moved(pose: Pose, step: FloatArray, turn: FloatArray) -> Pose:
    matrix = pose.matrix()
    matrix[:3, :3] = matrix_from_rotation_vector(turn) @ matrix[:3, :3]
    matrix[:3, 3] += step
    return Pose.from_matrix(matrix)


@FEW
@given(
    st.lists(st.tuples(STEPS, TURNS, st.floats(-0.5, 0.5)), min_size=2, max_size=3),
    st.sampled_from([TRACK, TABLE]),
)
def test_external_axes_count_along_lines(points, axis) -> None:
    name = ROBOTS[0]
    robot = find_robot(name).with_external_axes([axis])
    moves_work = axis.role is ExternalRole.TABLE
    work = WorkObject("part", moved_by="T") if moves_work else WorkObject()
    home = np.array([*HOME, 0.0])
    flange = robot.flange_pose(home)
    if moves_work:
        flange = axis.joint.placement.inverse() @ flange
    moves = tuple(
        MoveL(
            PoseTarget(moved(flange, step, turn), external=(value,)),
            Speed(tcp=0.5),
            Radius(0.03),
            work_object=work,
        )
        for step, turn, value in points
    )
    program = Program(moves, start=JointTarget(tuple(HOME), (0.0,)))
    assert_program_enclosed(name, BLENDS["parabola"], program, robot)


@settings(FEW, suppress_health_check=[HealthCheck.filter_too_much])
@given(STEPS, STEPS, TURNS, st.sampled_from(list(ArcOrientation)))
def test_arcs_with_a_turning_tool_stay_in_their_enclosures(via, end, turn, orientation) -> None:
    assume(np.linalg.norm(np.cross(via, end)) > 0.3 * np.linalg.norm(via) * np.linalg.norm(end))
    assume(min(map(np.linalg.norm, (via, end, end - via))) > 0.05)
    robot = find_robot(ROBOTS[0])
    flange = robot.flange_pose(HOME)
    tool = Tool("bent", Pose((0.1, 0.0, 0.3), (0.8, 0.0, 0.6, 0.0)))
    tcp = flange @ tool.tcp
    arc = MoveC(
        PoseTarget(moved(tcp, end, turn)),
        Speed(tcp=0.5),
        Radius(0.02),
        tool,
        via=PoseTarget(moved(tcp, via, np.zeros(3))),
        orientation=orientation,
    )
    line = MoveL(PoseTarget(tcp), Speed(tcp=0.5), tool=tool)
    program = Program((arc, line), start=JointTarget(tuple(HOME)))
    assert_program_enclosed(ROBOTS[0], BLENDS["second order"], program)


def wrist_line(offset: float) -> Program:
    """A line on which the wrist (axis 5) passes its singular posture at a distance."""
    robot = find_robot(ROBOTS[0])
    q = np.array([0.0, 0.2, 0.3, 0.0, 0.0, 0.0])
    straight = robot.flange_pose(q)
    tilt = moved(straight, np.array([0.0, 0.15, 0.0]), np.array([0.0, offset, 0.3]))
    back = moved(straight, np.array([0.0, -0.15, 0.0]), np.array([0.0, offset, -0.3]))
    return Program(
        (MoveJ(PoseTarget(tilt), Speed(tcp=1.0)), MoveL(PoseTarget(back), Speed(tcp=1.0))),
        start=JointTarget((0.0, 0.2, 0.3, 0.1, 0.5, 0.1)),
    )


@pytest.mark.parametrize("offset", [0.3, 0.03])
def test_near_a_singular_posture_enclosures_shrink_and_hold(offset) -> None:
    program = wrist_line(offset)
    assert_program_enclosed(ROBOTS[0], BLENDS["parabola"], program)


def test_spans_cover_what_was_asked_for_and_little_more() -> None:
    robot = find_robot(ROBOTS[0])
    flange = robot.flange_pose(HOME)
    steps = ([0.2, 0.0, 0.0], [0.2, 0.2, 0.0], [0.0, 0.2, 0.1])
    moves = [
        kind(PoseTarget(moved(flange, np.array(step), np.zeros(3))), Speed(tcp=0.5), Radius(0.04))
        for kind, step in zip((MoveL, MoveL, MoveJ), steps, strict=True)
    ]
    controller = Controller(find_vendor("abb"), robot, MotionModel())
    path = controller.plan(Program(tuple(moves), start=JointTarget(tuple(HOME))))
    enclosure = Enclosure.of(path)
    whole = path.sigma[-1]
    for first, last in ((0.0, whole), (0.1 * whole, 0.45 * whole), (0.3 * whole, 0.31 * whole)):
        found = enclosure.over([(first, last)])
        begin = enclosure.sigma(found.piece, found.begin)
        end = enclosure.sigma(found.piece, found.end)
        assert begin[0] <= first + 1e-12 and end[-1] >= last - 1e-12
        np.testing.assert_allclose(begin[1:], end[:-1], atol=1e-9)
        spacing = np.diff(path.sigma).max()
        assert begin[0] >= first - spacing and end[-1] <= last + spacing
