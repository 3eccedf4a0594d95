"""A KUKA's $machine.dat laid on a robot of the catalogue, and the lists that it is one of."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.text.files import SourceFile
from flyby.tasks.setup import RobotOptions, Setup, laid_on
from flyby.vendors.kuka.data_list import DataList
from flyby.vendors.kuka.machine_data import robot_of, stated_in, with_machine_data

from .data_lists import FILTER_MS, machine_data, write

KR3 = find_robot("kuka/kr3-r540")
HOME = np.array([0.1, -1.4, 1.5, 0.1, 0.8, 0.2])
KR3_DATA = machine_data(KR3, "#KR3R540 C4SR")


def listed(text: str) -> DataList:
    return DataList.of(SourceFile("$machine.dat", text))


def test_ranges_speeds_and_accelerations(tmp_path) -> None:
    text = KR3_DATA
    for i in range(1, 7):
        text += f"$SOFTN_END[{i}]=-{100 + i}\n$SOFTP_END[{i}]={100 + i}\n"
        text += f"$VEL_AXIS_MA[{i}]={4000 + i}\n$RAT_MOT_AX[{i}]={{N -{500 + i},D 10}}\n"
        text += f"$AXIS_JERK[{i}]={50_000 + i}.0\n"
    robot = with_machine_data(KR3, write(tmp_path, "$machine.dat", text))
    for i, (joint, nominal) in enumerate(zip(robot.joints, KR3.joints, strict=True), start=1):
        assert np.degrees([joint.lower, joint.upper]) == pytest.approx([-100 - i, 100 + i])
        assert np.degrees(joint.velocity) == pytest.approx(6 * (4000 + i) * 10 / (500 + i))
        assert np.degrees(joint.acceleration) == pytest.approx((50_000 + i) * 1e-3 * FILTER_MS / 20)
        assert joint.placement == nominal.placement
    assert "$machine.dat" in robot.origins["velocity"]
    assert robot.origins["geometry"] == KR3.origins["geometry"]
    assert robot.spread == {"acceleration": 1.07}  # it is inferred


def test_filters_of_set_points_are_averages(tmp_path) -> None:
    """Of half their length, two: of lines, and of programs of joint moves alone."""
    file = write(
        tmp_path, "$machine.dat", KR3_DATA.replace("INT $DEF_FLT_CP=96", "$DEF_FLT_CP=120")
    )
    found = stated_in(file)
    assert found["time.smoothing_s"][0] == pytest.approx([0.06, 0.06])
    assert found["time.joint_smoothing_s"][0] == pytest.approx([5e-4 * FILTER_MS] * 2)
    made = laid_on(Setup(find_vendor("kuka"), KR3), RobotOptions(machine_data=file))
    model = made.vendor.motion_of(made.robot)
    assert model.smoothing == pytest.approx((0.06, 0.06))
    origin = model.provenance["time.joint_smoothing_s"]
    assert origin.status == "assumed" and "$DEF_FLT_PTP, 144 ms" in (origin.source or "")
    line = MoveL(PoseTarget(KR3.flange_pose(HOME)), Speed(tcp=0.1), FINE)
    joints = MoveJ(JointTarget(tuple(HOME + 0.1)), Speed(), FINE)
    controller, start = Controller(made.vendor, made.robot), JointTarget(tuple(HOME))
    for moves, window in (((joints,), FILTER_MS), ((joints, line), 120.0)):
        program = Program(moves, start=start)
        path = controller.plan(program)
        assert controller.smoothing(program, path).window == pytest.approx(1e-3 * window)


@pytest.mark.parametrize("length", ["0", "-12", "1E9", '"x"', "1e999"])
def test_filters_of_no_sensible_length_are_not_taken(tmp_path, length: str) -> None:
    text = KR3_DATA.replace("INT $DEF_FLT_CP=96", f"$DEF_FLT_CP={length}")
    assert set(stated_in(write(tmp_path, "$machine.dat", text))) == {"time.joint_smoothing_s"}


def test_a_published_speed(tmp_path) -> None:
    """KR 210 R2700-2, axis 1: 5000 rpm through 1798:7 are 116.80 degrees/s."""
    text = KR3_DATA + "$VEL_AXIS_MA[1]=5000.0\n$RAT_MOT_AX[1]={N -1798,D 7}\n"
    robot = with_machine_data(KR3, write(tmp_path, "$machine.dat", text))
    assert np.degrees(robot.joints[0].velocity) == pytest.approx(116.80, abs=0.005)


def test_kr_c2_states_the_time_to_full_speed(tmp_path) -> None:
    text = machine_data(KR3, "#KR3", raise_time=True) + "$RAISE_TIME[1]=400.0\n"
    robot = with_machine_data(KR3, write(tmp_path, "$machine.dat", text))
    assert robot.joints[0].acceleration == pytest.approx(robot.joints[0].velocity / 0.4)
    assert "$RAISE_TIME" in robot.origins["acceleration"]
    # By how much the dynamic model departs from it is not published.
    later = with_machine_data(KR3, write(tmp_path, "$machine.dat", machine_data(KR3, "#KR3")))
    assert robot.spread["acceleration"] > later.spread["acceleration"] > 1.0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("$LENGTH_B=260", "$LENGTH_B=455.0"), "name the robot"),
        (("$SOFTN_END[3]=", "$SOFTN_OTHER[3]="), r"\$SOFTN_END\[3\] is missing"),
        (("$VEL_AXIS_MA[2]=", "$VEL_AXIS_MA[2]=TRUE;"), r"dat:\d+: .* is not a number"),
        (("$RAT_MOT_AX[2]={N -180,D 1}", "$RAT_MOT_AX[2]=17"), "is not a struct"),
        (("$VEL_AXIS_MA[4]=", "$VEL_AXIS_MA[4]=0;"), "A4 makes no sense: 0 degrees/s"),
        (("$AXIS_DIR[4]=-1", "$AXIS_DIR[4]=0"), "AXIS_DIR is 1 or -1"),
        (("$DEF_A4FIX=FALSE", "$DEF_A4FIX=TRUE"), "holds A4 at 0"),
        (("$AXIS_TYPE[2]=3", "$AXIS_TYPE[2]=1"), "A2 is linear"),
        (("$NUM_AX=6", "$NUM_AX=4"), "has 4 axes"),
    ],
)
def test_files_that_do_not_fit_are_refused(tmp_path, change, said: str) -> None:
    assert change[0] in KR3_DATA
    with pytest.raises(InputError, match=said):
        with_machine_data(KR3, write(tmp_path, "$machine.dat", KR3_DATA.replace(*change)))


def test_an_empty_file_and_an_arm_of_seven_joints(tmp_path) -> None:
    with pytest.raises(InputError, match="assigns nothing"):
        with_machine_data(KR3, write(tmp_path, "$machine.dat", "no data\n"))
    with pytest.raises(InputError, match="six axes"):
        with_machine_data(find_robot("kuka/iiwa7-r800"), write(tmp_path, "$machine.dat", KR3_DATA))


def test_data_are_read_by_name_and_index() -> None:
    data = listed(
        "$RAT_MOT_AX[1]={N -501,D 10}\nINT $DEF_FLT_CP=96 ;ms\n"
        'TOOL_NAME[2,]="gripper; left"\n'
        "LOAD_DATA[1]={M 5.5,CM {X 1,Y 2,Z 3,A 0,B 0,C 0},J {X 0.1}}\n"
        'DECL MACHINE_DEF[1]={NAME[] "KR 16",ROOT {FRAME: X 1.5},MECH_TYPE #ROBOT}\n'
        "$machine_on=true\n$X='B0101' ; five\n$Y='HFf'\n"
    )
    assert data.struct("$RAT_MOT_AX", 1) == {"N": -501.0, "D": 10.0}
    assert data.number("$DEF_FLT_CP") == 96.0 and not data.has("$EX_AX_NUM")
    assert data.text("TOOL_NAME", 2) == "gripper; left"
    assert data.struct("LOAD_DATA", 1)["CM"]["Z"] == 3.0
    robot = data.struct("MACHINE_DEF", 1)
    assert (robot["NAME"], robot["ROOT"], robot["MECH_TYPE"]) == ("KR 16", {"X": 1.5}, "#ROBOT")
    assert data.flag("$MACHINE_ON")
    assert (data.number("$X"), data.number("$Y")) == (5.0, 255.0)
    assert data.data["TOOL_NAME", 2].line == 3


@pytest.mark.parametrize(
    "line",
    [
        "$A={X 1,Y",
        "$A={" * 30,
        "$A=1e999",
        "$A==1",
        "$A=1 2",
        "$A[99999999999999999999999]=1",
        '$A="open',
        "$A='B2'",
        "IF A=B THEN",
    ],
)
def test_lines_that_make_no_sense_are_passed_over(line: str) -> None:
    data = listed(f"{line}\n$B=2\n")
    assert not data.has("$A") and data.number("$B") == 2.0


@given(text=st.text(alphabet=st.sampled_from("$A[]{}=,;:\"' 1.-eETB\n#x"), max_size=80))
def test_no_text_crashes(text: str) -> None:
    for one in listed(text).data.values():
        assert one.line >= 1


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda text: text[: len(text) // 2], "is missing, and the file is cut short"),
        (
            lambda text: text.replace("DEFDAT  $MACHINE", "DEFDAT $ROBCOR"),
            r"is the data list \$ROBCOR: the arm is described by \$machine\.dat, in R1/Mada",
        ),
    ],
)
def test_what_it_is_instead_is_said(tmp_path, change, said: str) -> None:
    text = machine_data(KR3, "#KR3")
    assert robot_of(write(tmp_path, "$machine.dat", text)).arm_size == 6
    changed = change(text)
    assert changed != text
    with pytest.raises(InputError, match=said):
        robot_of(write(tmp_path, "other.dat", changed))
