"""Programs for arms of seven axes: the order of their axes, arm angles, configurations."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

import flyby
from flyby.core.errors import MotionError
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.registry import find_robot, find_vendor

ABB = find_vendor("abb")
RIGHT, LEFT = "abb/irb14000-05-056-right", "abb/irb14000-05-056-left"
HOME = "[[0,-130,30,0,40,0],[-135,9E9,9E9,9E9,9E9,9E9]]"
NEAR = "[[35,-95,40,80,-50,60],[-70,9E9,9E9,9E9,9E9,9E9]]"
# Robtargets and the tool of a public program for an IRB 14000 (fourteenjiang/Solid-dispensing).
GRIPPER = "[TRUE,[[0,0,136],[1,0,0,0]],[0.262,[7.8,11.9,50.7],[1,0,0,0],0.00022,0.00024,9E-05]]"
TAUGHT = {
    RIGHT: [
        "[[458.24,-296.65,135.27],[0.000414402,0.904538,0.426386,0.00230888],[1,1,0,5],[130.654",
        "[[346.24,-497.72,112.19],[0.0112058,0.719741,-0.693996,-0.014756],[1,1,1,5],[-178.383",
        "[[413.59,-150.12,312.45],[0.501306,-0.46313,0.532076,-0.501096],[1,1,0,4],[-118.581",
        "[[526.72,-150.17,407.23],[0.505948,-0.457922,0.526966,-0.506587],[1,2,0,4],[-127.024",
        "[[584.33,-169.91,381.83],[0.285748,-0.637886,0.646863,-0.304988],[1,3,0,4],[-173.625",
        "[[579.10,-152.40,354.89],[0.482646,0.542402,0.458756,0.512247],[1,2,-2,4],[-173.792",
        "[[275.38,-493.34,112.48],[0.0088492,0.70793,-0.706062,-0.0152809],[0,1,1,5],[-178.274",
    ],
    LEFT: [
        "[[439.09,273.63,286.84],[0.50907,-0.490757,0.50908,-0.490758],[-1,0,0,5],[115.735",
        "[[330.40,187.06,55.05],[0.0139775,-0.020723,-0.999489,-0.0199153],[-1,2,0,4],[134.391",
        "[[370.08,280.73,405.93],[0.478606,-0.494716,0.528908,-0.496436],[0,2,-1,4],[133.127",
        "[[559.71,-152.38,368.22],[0.49502,-0.493853,0.513177,-0.497708],[-2,3,-2,4],[120.817",
        "[[365.00,200.92,293.33],[0.487136,-0.501848,0.521026,-0.489264],[0,3,-2,4],[120.838",
        "[[540.60,46.29,364.46],[0.783732,0.388931,0.355214,0.329119],[-1,-1,0,4],[121.064",
    ],
}


def module(*body: str, data: str = "") -> str:
    lines = "\n    ".join(body)
    return f"MODULE Yumi\n{data}\n  PROC main()\n    {lines}\n  ENDPROC\nENDMODULE\n"


def end(run, move: int):
    """Where (7,) the arm stands after a move."""
    return run.path.route.ends.q[run.path.route.moves.index(move), 1]


@pytest.fixture
def read(tmp_path):
    def made(text: str, robot: str = RIGHT):
        path = tmp_path / "yumi.mod"
        path.write_text(text, "utf-8")
        return flyby.read(path, robot=robot)

    return made


def test_eax_a_of_a_jointtarget_is_the_third_axis_along_the_arm(read) -> None:
    program = read(module(f"MoveAbsJ {HOME},v500,fine,tool0;", f"MoveAbsJ {NEAR},v500,fine,tool0;"))
    run = flyby.emulate(program)
    robot = run.robot
    assert [robot.joints[k].name for k in robot.along] == ["J1", "J2", "J7", "J3", "J4", "J5", "J6"]
    np.testing.assert_allclose(
        np.degrees(run.trajectory.q[-1]), [35, -95, 40, 80, -50, 60, -70], atol=1e-3
    )


@pytest.mark.parametrize("arm", TAUGHT)
def test_taught_targets_have_one_configuration_that_fits_theirs(read, arm) -> None:
    data = [f"  TASK PERS tooldata grip:={GRIPPER};"]
    data += [
        f"  CONST robtarget p{k}:={one},9E9,9E9,9E9,9E9,9E9]];" for k, one in enumerate(TAUGHT[arm])
    ]
    sign = -1 if arm == RIGHT else 1
    home = HOME.replace("-135", f"{135 * sign}")
    moves = [f"MoveJ p{k},v500,fine,grip;" for k in range(len(TAUGHT[arm]))]
    program = read(module(f"MoveAbsJ {home},v500,fine,grip;", *moves, data="\n".join(data)), arm)
    run = flyby.emulate(program)
    assert not [note for note in run.notes if "configuration" in note.message]
    robot = find_robot(arm)
    ends = [k for k, move in enumerate(program.moves) if isinstance(move.target, PoseTarget)]
    for k in ends:
        q = end(run, k)
        label, target = ABB.label(robot, q), program.moves[k].target
        assert target.configuration.mismatch(label) == 0
        assert abs(math.remainder(robot.arm_angle(q) - target.arm_angle, 2 * math.pi)) < 1e-9


LINES = (
    "VAR robtarget here;",
    f"MoveAbsJ {NEAR},v500,fine,tool0;",
    "here:=CRobT();",
    "here.extax.eax_a:=here.extax.eax_a+20;",
    "MoveL Offs(here,-20,0,30),v200,z10,tool0;",
    "here.extax.eax_a:=here.extax.eax_a-40;",
    "MoveL Offs(here,0,40,30),v200,fine,tool0;",
)


def test_lines_end_with_the_arm_angle_of_their_target(read) -> None:
    program = read(module(*LINES))
    run = flyby.emulate(program)
    robot = run.robot
    for k in (1, 2):
        target = program.moves[k].target
        q = end(run, k)
        assert robot.arm_angle(q) == pytest.approx(target.arm_angle, abs=1e-9)
        at = robot.flange_pose(q).matrix()
        np.testing.assert_allclose(at, target.pose.matrix(), atol=1e-9)
    said = [note for note in run.notes if "third axis turns evenly" in note.message]
    assert len(said) == 1 and said[0].move == 1
    assert re.search(r"up to 1\.\d° elsewhere on the way in line 10$", said[0].message)
    assert not [note for note in run.notes if "count from" in note.message]


def test_the_arm_angle_of_a_circle_point_is_not_used_and_noted(read) -> None:
    def driven(angle: str):
        lines = (
            "VAR robtarget via;",
            *LINES[:3],
            "via:=Offs(here,0,20,20);",
            f"via.extax.eax_a:=here.extax.eax_a+{angle};",
            "MoveC via, Offs(here,0,40,0),v200,fine,tool0;",
        )
        return flyby.emulate(read(module(*lines)))

    one, other = driven("0"), driven("30")
    np.testing.assert_allclose(one.trajectory.q[-1], other.trajectory.q[-1], atol=1e-12)
    assert one.report.cycle_time == pytest.approx(other.report.cycle_time)
    (note,) = [note for note in one.notes if "point on the arc is not used" in note.message]
    assert note.move == 1


def test_what_arm_angles_count_from_is_told_where_it_is_assumed(read) -> None:
    run = flyby.emulate(read(module(*LINES), "IRB 14050"))
    (said,) = [note for note in run.notes if "count from is assumed: z of the base" in note.message]
    assert said.move == 1


def test_crobt_tells_the_arm_angle_and_calcjointt_comes_back(read) -> None:
    body = [
        "VAR robtarget here;",
        "VAR jointtarget back;",
        f"MoveAbsJ {NEAR},v500,fine,tool0;",
        "here:=CalcRobT(CJointT(),tool0);",
        "back:=CalcJointT(here,tool0);",
        "MoveAbsJ back,v500,fine,tool0;",
        "MoveJ here,v500,fine,tool0;",
    ]
    _, back, here = read(module(*body)).moves
    assert isinstance(back.target, JointTarget) and isinstance(here.target, PoseTarget)
    np.testing.assert_allclose(
        np.degrees(back.target.joints), [35, -95, 40, 80, -50, 60, -70], atol=1e-6
    )
    angle = find_robot(RIGHT).arm_angle(np.array(back.target.joints))
    assert here.target.arm_angle == pytest.approx(angle, abs=1e-9)


def test_what_is_written_is_read_back(read, tmp_path) -> None:
    program = read(module(*LINES))
    again = flyby.read(next(iter(flyby.write(program, tmp_path / "new", robot=RIGHT))), robot=RIGHT)
    for one, other in zip(program.moves, again.moves, strict=True):
        if isinstance(one.target, JointTarget):
            np.testing.assert_allclose(one.target.joints, other.target.joints, atol=1e-6)
        else:
            assert one.target.arm_angle == pytest.approx(other.target.arm_angle, abs=1e-6)


def test_changed_values_stand_in_eax_a(read, tmp_path) -> None:
    text = module(
        f"MoveAbsJ {NEAR},v500,fine,tool0;",
        "MoveJ [[300,-200,300],[0,0,1,0],[0,0,0,4],[-120,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;",
        "MoveL [[300,-200,350],[0,0,1,0],[0,0,0,4],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;",
    )
    program = read(text)
    first, second, third = program.moves
    assert second.target.arm_angle == pytest.approx(math.radians(-120))
    assert third.target.arm_angle is None
    joints = (*first.target.joints[:6], math.radians(-71.5))
    moves = [
        replace(first, target=replace(first.target, joints=joints)),
        replace(second, target=replace(second.target, arm_angle=math.radians(-118))),
        third,
    ]
    (path,) = flyby.patch(program.with_moves(tuple(moves)), out=tmp_path / "out")
    new = path.read_text("utf-8")
    wanted = text.replace("[-70,", "[-71.5,").replace("[-120,", "[-118,")
    assert re.sub(r"\s", "", new) == re.sub(r"\s", "", wanted)


def test_refusals_say_what_is_missing(read) -> None:
    unstated = "[[0,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    program = read(module(f"MoveAbsJ {unstated},v500,fine,tool0;"))
    with pytest.raises(MotionError, match="axis 7 of the arm, eax_a, has no value"):
        flyby.emulate(program)
    body = [
        "VAR robtarget here;",
        f"MoveAbsJ {HOME},v500,fine,tool0;",
        "here:=CRobT();",
        "here.extax.eax_a:=here.extax.eax_a-180;",
    ]
    for kind in ("MoveJ", "MoveL"):
        program = read(module(*body, f"{kind} here,v500,fine,tool0;"))
        with pytest.raises(MotionError, match=r"with an arm angle of .*° .*that will do there are"):
            flyby.emulate(program)
    text = module(f"MoveAbsJ {HOME},v500,fine,tool0;", f"MoveAbsJ {NEAR},v500,fine,tool0;")
    with pytest.raises(MotionError, match=r"eax_a is moved from -135 to -70.*name it .IRB 14050"):
        flyby.emulate(read(text, "IRB 1200-5/0.9"))


def test_without_an_arm_angle_the_third_axis_stays(read) -> None:
    body = [
        "VAR robtarget here;",
        f"MoveAbsJ {NEAR},v500,fine,tool0;",
        "here:=CRobT();",
        "here.extax.eax_a:=9E9;",
        "MoveJ Offs(here,10,10,20),v500,fine,tool0;",
        "MoveL Offs(here,0,20,0),v500,fine,tool0;",
    ]
    program = read(module(*body))
    assert [move.target.arm_angle for move in program.moves[1:]] == [None, None]
    run = flyby.emulate(program)
    third = find_robot(RIGHT).along[2]
    assert end(run, 1)[third] == end(run, 2)[third] == pytest.approx(math.radians(-70))


def test_translated_to_it_targets_state_an_arm_angle(tmp_path) -> None:
    free = "[9E9,9E9,9E9,9E9,9E9,9E9]"
    path = tmp_path / "six.mod"
    path.write_text(
        module(
            f"MoveAbsJ [[0,0,0,0,30,0],{free}],v500,fine,tool0;",
            f"MoveJ [[350,0,400],[0,0,1,0],[0,0,0,0],{free}],v500,z10,tool0;",
            f"MoveL [[350,60,400],[0,0,1,0],[0,0,0,0],{free}],v200,fine,tool0;",
        ),
        "utf-8",
    )
    made = flyby.translate(flyby.read(path, robot="IRB 1100-4/0.58"), robot=RIGHT)
    _, joint, line = made.program.moves
    assert joint.target.arm_angle is not None and line.target.arm_angle is not None
    run = flyby.emulate(made.program, robot=RIGHT)
    for k, move in enumerate((joint, line), 1):
        at = run.robot.flange_pose(end(run, k)).matrix()
        np.testing.assert_allclose(at, move.target.pose.matrix(), atol=1e-9)


@pytest.mark.parametrize(
    "joints",
    [
        (-23, -95, 40, 52, -38, 124, 62),
        (71, -104, 6, -74, 21, 118, -47),
        (50, -30, -36, -37, 56, 85, -81),
    ],
)
def test_beside_a_cfx_of_several_digits_quadrants_are_cut_off(read, joints) -> None:
    """Rounded quadrants of these joint values differ from those that are cut off."""
    robot = find_robot(RIGHT)
    q = np.radians(joints)
    label = ABB.label(robot, q)
    cut = [math.floor(joints[axis] / 90) for axis in (0, 3, 5)]
    assert [label.cf1, label.cf4, label.cf6] != cut
    pose = robot.flange_pose(q)
    place, turn = (
        ",".join(f"{v:.9g}" for v in values)
        for values in (np.multiply(pose.position, 1e3), pose.quaternion)
    )
    angle = math.degrees(robot.arm_angle(q))
    target = (
        f"[[{place}],[{turn}],[{','.join(map(str, cut))},11],[{angle:.9g},9E9,9E9,9E9,9E9,9E9]]"
    )
    home = "[[0,-130,30,0,40,0],[-135,9E9,9E9,9E9,9E9,9E9]]"
    run = flyby.emulate(
        read(module(f"MoveAbsJ {home},v500,fine,tool0;", f"MoveJ {target},v500,fine,tool0;"))
    )
    np.testing.assert_allclose(np.degrees(end(run, 1)), joints, atol=1e-3)
    assert not [note for note in run.notes if "configuration" in note.message]
    again = ABB.label(robot, end(run, 1))
    assert run.program.moves[1].target.configuration.mismatch(again) == 0
