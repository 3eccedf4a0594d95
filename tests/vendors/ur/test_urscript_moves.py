"""Moves of URScript and what holds for them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import SourceError
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, Load
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_vendor
from flyby.core.source.reading import ReadOptions
from flyby.core.spatial.pose import Pose
from flyby.vendors.ur.motion.configuration import UrConfiguration
from flyby.vendors.ur.run.reader import read
from flyby.vendors.ur.values.poses import quaternion_of, rotation_vector_of

UR5E = find_vendor("ur").robot("ur5e")
DOWN = "0, 3.14159, 0"


def program(text: str, robot: bool = False) -> Program:
    return read(text, "t.script", ReadOptions(robot=UR5E if robot else None))


def moves(text: str, robot: bool = False) -> tuple[Move, ...]:
    return program(text, robot).moves


def within(radius: float) -> Radius:
    return Radius(radius, radius, radius)


def refusal(text: str, robot: bool = False) -> str:
    with pytest.raises(SourceError) as caught:
        program(text, robot=robot)
    return str(caught.value)


# ---------------------------------------------------------------------- arguments


@pytest.mark.parametrize(
    ("call", "speed", "zone"),
    [
        ("movej(Q)", Speed(joint=1.05, joint_acceleration=1.4), FINE),
        ("movej(Q, 0.5, 0.7)", Speed(joint=0.7, joint_acceleration=0.5), FINE),
        ("movej(Q, v=0.7, a=0.5)", Speed(joint=0.7, joint_acceleration=0.5), FINE),
        (
            "movej(Q, 0.5, 0.7, 0, 0.01)",
            Speed(joint=0.7, joint_acceleration=0.5),
            within(0.01),
        ),
        ("movej(Q, t=2, r=0.02)", Speed(duration=2.0), within(0.02)),
        ("movej(q=Q, a=1, v=2, t=0, r=0)", Speed(joint=2.0, joint_acceleration=1.0), FINE),
        ("movel(P)", Speed(tcp=0.25, tcp_acceleration=1.2), FINE),
        ("movel(P, a=0.3, r=0.05)", Speed(tcp=0.25, tcp_acceleration=0.3), within(0.05)),
        ("movel(pose=P, t=1.5)", Speed(duration=1.5), FINE),
        ("movep(P, 0.4, 0.2, 0.03)", Speed(tcp=0.2, tcp_acceleration=0.4), within(0.03)),
        (
            "optimovej(Q, a=0.5, v=0.6)",
            Speed(joint_fraction=0.6, joint_acceleration_fraction=0.5),
            FINE,
        ),
    ],
)
def test_arguments_by_position_and_name_with_their_defaults(
    call: str, speed: Speed, zone: object
) -> None:
    call = call.replace("Q", "[0, -1.5, 1.5, 0, 0, 0]").replace("P", f"p[0.4, 0, 0.3, {DOWN}]")
    (move,) = moves(call)
    assert isinstance(move, MoveJ if "movej" in call else MoveL)
    assert move.speed == speed
    assert move.zone == zone


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        ("movej([0,0,0,0,0,0], b=1)", "movej has no argument 'b'"),
        ("movej([0,0,0,0,0,0], 1, a=1)", "'a' is given twice"),
        ("movej()", "movej needs the argument 'q'"),
        ("movej([0,0,0,0,0,0], 1, 1, 0, 0, 0)", "movej takes 5 arguments"),
        ("movej([0,0,0,0,0])", "six joint values, not a list of 5"),
        ("movel(p[0,0,0,0,0])", "a pose has six numbers"),
        ("movel(0.5)", "not 0.5"),
        ("movel(p[0,0,0,0,0,0], v=0)", "Speed.tcp must be above zero"),
        ("movel(p[0,0,0,0,0,0], a=-1)", "Speed.tcp_acceleration must be above zero"),
        ("movel(p[0,0,0,0,0,0], t=-1)", "the time is above zero"),
        ("movel(p[0,0,0,0,0,0], r=-0.01)", "blend radius of movel is zero m or more"),
        ('movel(p[0,0,0,0,0,0], v="fast")', "'v' of movel is a number"),
        ("movec(p[0,0,0,0,0,0], p[1,0,0,0,0,0], mode=2)", "mode of movec is 0 or 1"),
        ("movel(p[0,0,True,0,0,0])", "a pose p[x, y, z, rx, ry, rz]"),
    ],
)
def test_wrong_arguments_are_named_with_their_line(call: str, complaint: str) -> None:
    message = refusal(f"\n  {call}")
    assert message.startswith("t.script:2:")
    assert complaint in message


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        ("servoj([0,0,0,0,0,0], t=0.002)", "by streams, forces or hand"),
        ("speedl([0,0,0.1,0,0,0], 0.5, 1)", "by streams, forces or hand"),
        (
            "force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,5,0,0,0], 2, [1,1,1,1,1,1])",
            "by streams, forces or hand",
        ),
        ("freedrive_mode()", "by streams, forces or hand"),
        ("path_offset_set([0,0,0,0,0,0], 1)", "shift the path at run time"),
        ("track_conveyor_linear(p[1,0,0,0,0,0], 500)", "shift the path at run time"),
    ],
)
def test_motion_that_is_made_at_run_time_is_kept_by_name(call: str, reason: str) -> None:
    made = program(f"movej([0,0,0,0,0,0])\n{call}\nmovej([1,0,0,0,0,0])")
    assert len(made.moves) == 2
    assert [s.text for s in made.statements if isinstance(s, Opaque)] == [call]
    note = next(n.message for n in made.notes if reason in n.message)
    assert call.split("(")[0] in note


@pytest.mark.parametrize("before", ["", "movej([0,0,0,0,0,0])\n"])
def test_a_program_of_streams_says_so(before: str) -> None:
    message = refusal(f"{before}while True:\n  servoj([0,0,0,0,0,0], t=0.002)\nend")
    assert "servoj drives the robot in steps of a control loop" in message
    assert "freedrive_mode lets forces of contact move" in refusal(f"{before}freedrive_mode()")


# ------------------------------------------------------------------------ targets


def test_joint_lists_and_poses_are_interchangeable() -> None:
    to_pose, to_joints = moves(f"movej(p[0.4, 0, 0.3, {DOWN}])\nmovel([0, -1.5, 1.5, 0, 0, 0])")
    assert isinstance(to_pose, MoveJ)
    assert isinstance(to_pose.target, PoseTarget)
    assert to_pose.target.configuration is None
    assert isinstance(to_joints, MoveL)
    assert to_joints.target == JointTarget((0.0, -1.5, 1.5, 0.0, 0.0, 0.0))


def test_inverse_kinematics_in_a_move_keeps_the_pose_and_qnear() -> None:
    (move,) = moves(
        f"home_p = p[0.4, 0, 0.3, {DOWN}]\n"
        "home_q = [0, -1.5, 1.5, -1.57, -1.57, 0]\n"
        "movej(get_inverse_kin(home_p, qnear=home_q), a=1, v=1)"
    )
    assert isinstance(move.target, PoseTarget)
    assert move.target.configuration == UrConfiguration((0, -1.5, 1.5, -1.57, -1.57, 0))
    assert move.target.name == "home_p"
    assert move.target.pose.position == (0.4, 0.0, 0.3)


def test_near_to_where_the_robot_starts_is_near_to_where_it_comes_from() -> None:
    pose = f"p[0.4, -0.2, 0.3, {DOWN}]"
    plain = moves(f"movej(get_inverse_kin({pose}))")
    here = "q0 = get_actual_joint_positions()\n"
    for text in (
        f"movej(get_inverse_kin({pose}, get_actual_joint_positions()))",
        f"{here}movej(get_inverse_kin({pose}, qnear=q0))",
        f"{here}q = get_inverse_kin({pose}, q0)\nmovej(q)",
    ):
        (move,) = moves(text)
        assert move.target == plain[0].target
    checked = f"if get_inverse_kin_has_solution({pose}, q0):\n movej({pose})\nend"
    assert len(moves(here + checked, robot=True)) == 1
    later = f"{here}movej([0, 0, 0, 0, 0, 0])\nmovej(get_inverse_kin({pose}, q0))"
    assert moves(later)[1].target == plain[0].target
    told = " ".join(note.message for note in program(later).notes)
    assert "qnear depends on get_actual_joint_positions() before the first move" in told


def test_behind_a_move_the_robot_is_at_rest() -> None:
    text = "movej([0,0,0,0,0,0])\nwhile not is_steady():\n sync()\nend\nmovej([1,0,0,0,0,0])"
    assert not [s for s in program(text).statements if isinstance(s, Opaque)]
    assert not [n for n in program(text).notes if "is_steady" in str(n)]


def test_a_stored_solution_needs_no_robot_until_its_numbers_are_asked_for() -> None:
    stored = f"q = get_inverse_kin(p[0.4, 0, 0.3, {DOWN}], [0, -1.5, 1.5, -1.57, -1.57, 0])\n"
    (move,) = moves(stored + "movej(q)")
    assert isinstance(move.target, PoseTarget)
    assert move.target.configuration == UrConfiguration((0, -1.5, 1.5, -1.57, -1.57, 0))
    turned = stored + "q[5] = q[5] + 0.5\nmovej(q)"
    assert "name the robot" in refusal(turned)
    (move,) = moves(turned, robot=True)
    assert isinstance(move.target, JointTarget)


@given(st.tuples(*[st.floats(-3, 3)] * 6))
def test_rotation_vectors_become_unit_quaternions_and_back(numbers: tuple[float, ...]) -> None:
    (move,) = moves(f"movel(p[{', '.join(f'{x:.17g}' for x in numbers)}])")
    assert isinstance(move.target, PoseTarget)
    assert move.target.pose.position == numbers[:3]
    again = quaternion_of(*rotation_vector_of(move.target.pose.quaternion))
    assert again == pytest.approx(move.target.pose.quaternion, abs=1e-12)
    assert math.hypot(*again) == pytest.approx(1.0, abs=1e-12)


# --------------------------------------------------------------------------- arcs


def test_arcs_turn_in_the_base_or_with_the_tangent() -> None:
    start = f"movel(p[0.4, 0, 0.3, {DOWN}])\n"
    arc = f"movec(p[0.5, 0.1, 0.3, 0, 0, 0], p[0.6, 0, 0.3, {DOWN}]"
    fixed = moves(f"{start}{arc})")[1]
    follows = moves(f"{start}{arc}, mode=1)")[1]
    assert isinstance(fixed, MoveC)
    assert isinstance(follows, MoveC)
    assert fixed.orientation is ArcOrientation.FIXED_FRAME
    assert follows.orientation is ArcOrientation.FOLLOWS_ARC
    assert isinstance(fixed.target, PoseTarget)
    assert isinstance(follows.target, PoseTarget)
    # Half a circle, clockwise seen from above: half a turn about -z of what it began with.
    began = Pose(quaternion=quaternion_of(0, 3.14159, 0))
    half = Pose(quaternion=quaternion_of(0, 0, -math.pi))
    turn = Pose(quaternion=follows.target.pose.quaternion).matrix()
    assert turn == pytest.approx((half @ began).matrix(), abs=1e-9)
    assert fixed.target.pose.quaternion == pytest.approx(began.quaternion, abs=1e-12)


def test_arcs_through_joint_values_need_the_robot() -> None:
    text = (
        "movej([0, -1.5, 1.5, -1.57, -1.57, 0])\n"
        "movec([0.2, -1.4, 1.5, -1.57, -1.57, 0], [0.3, -1.5, 1.4, -1.57, -1.57, 0])"
    )
    assert "name the robot" in refusal(text)
    arc = moves(text, robot=True)[1]
    assert isinstance(arc, MoveC)
    assert isinstance(arc.target, PoseTarget)


# ------------------------------------------------------------ tool, payload, waits


def test_tcp_and_payload_hold_until_they_are_changed() -> None:
    first, second, third = moves(
        "movej([0,0,0,0,0,0])\n"
        'set_tcp(p[0, 0, 0.1, 0, 0, 0], "gripper")\n'
        "set_payload(1.5, [0, 0, 0.05])\n"
        "movej([1,0,0,0,0,0])\n"
        "set_tcp(p[0, 0, 0.2, 0, 0, 0])\n"
        "set_target_payload(2, [0, 0, 0.1], [0.1, 0.2, 0.3, 0, 0, 0])\n"
        "movej([2,0,0,0,0,0])"
    )
    assert first.tool == FLANGE
    assert second.tool.name == "gripper"
    assert second.tool.tcp.position == (0.0, 0.0, 0.1)
    assert second.tool.load == Load(1.5, (0.0, 0.0, 0.05))
    assert third.tool.load == Load(2.0, (0.0, 0.0, 0.1), (0.1, 0.2, 0.3))


def test_a_payload_without_a_centre_has_it_at_the_tcp() -> None:
    (move,) = moves("set_payload(3)\nset_tcp(p[0,0,0.3,0,0,0])\nmovej([0,0,0,0,0,0])")
    assert move.tool.load == Load(3.0, (0.0, 0.0, 0.3))


def test_a_full_inertia_tensor_becomes_principal_moments() -> None:
    (move,) = moves("set_target_payload(2, [0,0,0], [2, 2, 1, 1, 0, 0])\nmovej([0,0,0,0,0,0])")
    load = move.tool.load
    assert load is not None
    assert sorted(load.inertia) == pytest.approx([1.0, 1.0, 3.0])
    axes = Pose(quaternion=load.axes).matrix()[:3, :3]
    tensor = axes @ (axes.T * [[m] for m in load.inertia])
    assert tensor == pytest.approx(np.array([[2, 1, 0], [1, 2, 0], [0, 0, 1]]), abs=1e-12)


@pytest.mark.parametrize(
    "call",
    [
        "set_payload(-1)",
        "set_payload(1, [0, 0])",
        "set_target_payload(1, [0,0,0], [1, 1, 1, 5, 0, 0])",
        "set_tcp([0, 0, 0.1])",
    ],
)
def test_impossible_tools_are_refused(call: str) -> None:
    assert refusal(call).startswith(f"t.script:1:1: {call.split('(')[0]}: ")


def test_a_missing_tcp_is_noted_once() -> None:
    notes = program("movej([0,0,0,0,0,0])\nmovej([1,0,0,0,0,0])").notes
    assert [n.span.line for n in notes if "set_tcp" in n.message and n.span] == [1]


def test_sleep_waits_and_other_calls_are_kept_as_they_stand() -> None:
    text = "movej([0,0,0,0,0,0])\n  sleep(0.5)\n  set_digital_out( 1,True )\n  stopj(2)"
    _, wait, output, stop = program(text).statements
    assert wait == Wait(0.5)
    assert output == Opaque("set_digital_out( 1,True )")
    assert stop == Opaque("stopj(2)", stops=True)


def test_robots_that_stand_in_a_cell_have_poses_in_their_own_base() -> None:
    base = Pose((1.0, 2.0, 0.0))
    options = ReadOptions(robot=UR5E.with_base(base))
    (move,) = read(f"movel(p[0.4, 0, 0.3, {DOWN}])", "t.script", options).moves
    assert move.work_object.pose == base
    (plain,) = moves(f"movel(p[0.4, 0, 0.3, {DOWN}])", robot=True)
    assert plain.work_object.pose == Pose()


# ----------------------------------------------------------- the robot's own place


def test_the_last_target_answers_where_the_robot_is() -> None:
    first, above, back = moves(
        f"movel(p[0.4, 0, 0.3, {DOWN}])\n"
        "here = get_actual_tcp_pose()\n"
        "movel(pose_add(here, p[0, 0, 0.1, 0, 0, 0]))\n"
        "movel(here)"
    )
    assert isinstance(above.target, PoseTarget)
    assert isinstance(back.target, PoseTarget)
    assert isinstance(first.target, PoseTarget)
    assert above.target.pose.position == pytest.approx((0.4, 0.0, 0.4))
    assert back.target.pose.position == first.target.pose.position


def test_kinematics_answer_when_the_robot_is_named() -> None:
    text = (
        "q = [0.3, -1.5, 1.5, -1.57, -1.57, 0.2]\nmovej(q)\np1 = get_actual_tcp_pose()\n"
        "p2 = get_forward_kin(q)\nif point_dist(p1, p2) > 1e-9:\n  halt\nend\n"
        "if get_inverse_kin_has_solution(p1, q):\n  back = get_inverse_kin(p1, q)\nend\n"
        "movej([back[0], back[1], back[2], back[3], back[4], back[5]])"
    )
    assert "name the robot" in refusal(text)
    first, second = moves(text, robot=True)
    assert isinstance(first.target, JointTarget)
    assert isinstance(second.target, JointTarget)
    assert second.target.joints == pytest.approx(first.target.joints, abs=1e-8)


def test_a_position_before_the_first_move_is_refused_with_what_to_do() -> None:
    message = refusal("movel(pose_add(get_actual_tcp_pose(), p[0,0,0.1,0,0,0]))")
    assert "before the first move" in message
    assert "[values]" in message


def test_behind_a_move_that_cannot_be_driven_the_robot_stands_where_it_was() -> None:
    text = (
        "movej([0.1,-1.5,1.5,-1.57,-1.57,0])\n"
        f"movel(p[9, 0, 0, {DOWN}])\n"
        "q = get_actual_joint_positions()\nmovej([q[0],0,0,0,0,0])"
    )
    first, _, last = program(text, robot=True).moves
    assert isinstance(first.target, JointTarget) and isinstance(last.target, JointTarget)
    assert last.target.joints[0] == pytest.approx(first.target.joints[0])


def test_unreachable_poses_are_named() -> None:
    with pytest.raises(SourceError, match=r"t\.script:1:5: get_inverse_kin: the pose cannot be"):
        program("q = get_inverse_kin(p[9, 0, 0, 0, 0, 0])\nmovej([q[0],0,0,0,0,0])", robot=True)
