"""Robots that a $machine.dat alone describes: they are the arms that it was written of."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.assembly import assemble
from flyby.core.robot.joint import ExternalRole, JointKind
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.core.spatial.rotation import matrix_from_rotation_vector
from flyby.vendors.kuka.data_list import DataList, numbers_of
from flyby.vendors.kuka.machine_data import robot_of
from flyby.vendors.kuka.machine_data.named_arms import payload_of_name

from .data_lists import external_axis, machine_data, older, robcor, write

KUKA = find_vendor("kuka")
ARMS = [arm for arm in KUKA.listed().values() if arm.refused is None and arm.axes == 6]
KR6 = """$TRAFONAME[]="#KR6R900 C4SR FLR 230"
$TIRORO={X 0.0,Y 0.0,Z 400.0,A 0.0,B 0.0,C 0.0}
$LENGTH_A=25.0
$LENGTH_B=455.0
$TX3P3={X 420.0,Y 0.0,Z 35.0,A 0.0,B 90.0,C 0.0}
$TFLWP={X 0.0,Y 0.0,Z 80.0,A 0.0,B 0.0,C 0.0}
"""


def turn(axis: int, degrees: float) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3] = matrix_from_rotation_vector(math.radians(degrees) * np.eye(3)[axis])
    return T


def shift(x: float, y: float = 0.0, z: float = 0.0) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def framed(struct) -> np.ndarray:
    own = {key: float(struct.get(key, 0.0)) for key in "XYZABC"}
    turned = turn(2, own["A"]) @ turn(1, own["B"]) @ turn(0, own["C"])
    return shift(own["X"], own["Y"], own["Z"]) @ turned


def flange(data: DataList, q: np.ndarray) -> np.ndarray:
    """The published formula, mm and degrees, word by word."""
    t = [data.number("$AXIS_DIR", i + 1) * x for i, x in enumerate(q)]
    hand = []
    for name in ("$DH_4", "$DH_5"):
        row = numbers_of(data.struct(name))
        hand.append(shift(row["DHART_A"], 0.0, row["DHART_D"]) @ turn(0, row["DHART_ALPHA"]))
    T = framed(data.struct("$ROBROOT")) @ framed(data.struct("$TIRORO")) @ turn(2, t[0])
    T = T @ shift(data.number("$LENGTH_A")) @ turn(1, t[1]) @ shift(data.number("$LENGTH_B"))
    T = T @ turn(1, t[2]) @ framed(data.struct("$TX3P3")) @ turn(2, t[3]) @ hand[0]
    return T @ turn(2, t[4]) @ hand[1] @ turn(2, t[5]) @ framed(data.struct("$TFLWP"))


def assert_same(robot, q_deg, wanted_mm) -> None:
    pose = robot.flange_pose(np.radians(q_deg)).matrix()
    np.testing.assert_allclose(1e3 * pose[:3, 3], wanted_mm[:3, 3], atol=1e-6)
    np.testing.assert_allclose(pose[:3, :3], wanted_mm[:3, :3], atol=1e-9)


def test_every_listed_arm_comes_back(tmp_path) -> None:
    """The flange within 0.1 mm, limits, name, dynamics; and closed-form inverse kinematics."""
    rng = np.random.default_rng(1)
    for arm in ARMS:
        known = find_robot(arm.name)
        text = machine_data(known, f"#{arm.model.upper().replace(' ', '')} C4 FLR")
        robot = robot_of(write(tmp_path, "$machine.dat", text))
        q = rng.uniform(known.limits.lower, known.limits.upper, (10, 6))
        apart = np.linalg.norm(robot.forward(q)[1] - known.forward(q)[1], axis=1)
        assert apart.max() < 1e-4, arm.name
        np.testing.assert_allclose(robot.forward(q)[0], known.forward(q)[0], atol=1e-5)
        for one, other in zip(robot.joints, known.joints, strict=True):
            for figure in ("lower", "upper", "velocity", "acceleration"):
                assert getattr(one, figure) == pytest.approx(getattr(other, figure), rel=1e-6)
        assert robot.recognised is not None and robot.recognised.error < 1e-9, arm.name
        found = robot.inverse(robot.flange_pose(q[0]))
        off = [np.abs(np.remainder(s.q - q[0] + np.pi, 2 * np.pi) - np.pi).max() for s in found]
        assert min(off) < 1e-6, arm.name
        if robot.name == known.name:
            np.testing.assert_allclose(
                robot.outline(), known.outline(), atol=2e-3, err_msg=arm.name
            )
        assert len(robot.shapes) == len(known.shapes) or robot.name != known.name
    assert len(ARMS) > 150


def test_most_are_found_by_the_names_that_controllers_write(tmp_path) -> None:
    named = {}
    for arm in ARMS:
        text = machine_data(find_robot(arm.name), f"#{arm.model.upper()} C4 FLR")
        named[arm.name] = robot_of(write(tmp_path, "$machine.dat", text))
    assert all(robot.name in KUKA_NAMES for robot in named.values())
    other = {name: robot.name for name, robot in named.items() if robot.name != name}
    for name, robot in named.items():  # one of the same lengths
        if name in other:
            assert any(name in doubt for doubt in robot.doubts), name
    assert len(other) < 10


KUKA_NAMES = {arm.name for arm in ARMS}


def test_the_worked_example(tmp_path) -> None:
    """KR 6 R900: published figures in mm."""
    text = machine_data(find_robot("kuka/kr6-r900-sixx")) + KR6
    robot = robot_of(write(tmp_path, "$machine.dat", text))
    home = robot.flange_pose(np.radians([0, -90, 90, 0, 0, 0])).matrix()
    np.testing.assert_allclose(1e3 * home[:3, 3], [525, 0, 890], atol=1e-9)
    np.testing.assert_allclose(home[:3, 2], [1, 0, 0], atol=1e-12)
    away = robot.flange_pose(np.radians([10, -80, 70, 20, 30, 40])).position
    assert 1e3 * np.array(away) == pytest.approx([575.025, -115.284, 930.502], abs=1e-3)
    assert robot.name == "kuka/kr6-r900-sixx"
    assert robot.shapes and robot.origins["geometry"].startswith("published: $mach")


lengths = st.floats(20.0, 3000.0)
angles = st.floats(-180.0, 180.0)


@given(
    a=st.floats(0.0, 800.0),
    b=lengths,
    forearm=lengths,
    offset=st.floats(-200.0, 200.0),
    flange_z=st.floats(0.0, 400.0),
    root=st.tuples(*[st.floats(-3000, 3000)] * 3, *[angles] * 3),
    directions=st.lists(st.sampled_from([-1, 1]), min_size=6, max_size=6),
    q=st.lists(angles, min_size=6, max_size=6),
    hand=st.sampled_from([0.0, 0.0, 265.0]),
)
@example(25.0, 455.0, 420.0, 35.0, 80.0, (0.0,) * 6, [-1, 1, 1, -1, -1, -1], [0.0] * 6, 0.0)
def test_any_lengths(tmp_path_factory, a, b, forearm, offset, flange_z, root, directions, q, hand):
    """Hands with lengths, ceilings, axes that are counted the other way: the formula holds."""
    text = machine_data(find_robot("kuka/kr6-r900-sixx"), "#KR77 SPECIAL C4")
    root_text = ",".join(f"{key} {value:.12g}" for key, value in zip("XYZABC", root, strict=True))
    text += (
        f"$LENGTH_A={a!r}\n$LENGTH_B={b!r}\n$TX3P3={{X {forearm!r},Z {offset!r},B 90.0}}\n"
        f"$TFLWP={{Z {flange_z!r}}}\n$ROBROOT={{{root_text}}}\n"
        f"$DH_5={{DHART_A {hand},DHART_D 0.0,DHART_ALPHA -90.0}}\n"
    )
    text += "".join(f"$AXIS_DIR[{i}]={sign}\n" for i, sign in enumerate(directions, 1))
    file = write(tmp_path_factory.mktemp("mada"), "$machine.dat", text)
    robot = robot_of(file)
    assert_same(robot, q, flange(DataList.read(file), np.array(q)))
    assert robot.name == "kuka/kr77-special"
    assert robot.payload == 77.0 and any("not in the catalogue" in d for d in robot.doubts)
    assert len(robot.shapes) in (6, 7) and not robot.links


def test_kr_c2_and_the_rated_load(tmp_path) -> None:
    known = find_robot("kuka/kr125-2")
    text = older(machine_data(known, "#KR125_2 FLR ZH120", raise_time=True))
    write(tmp_path, "$RobCor.dat", robcor("#KR125_2 FLR ZH120", 120.0))
    robot = robot_of(write(tmp_path, "$machine.dat", text))
    assert robot.payload == 120.0
    q = np.full(6, 0.3)
    np.testing.assert_allclose(
        robot.flange_pose(q).position, known.flange_pose(q).position, atol=1e-4
    )
    assert "$RAISE_TIME" in robot.origins["acceleration"]


def test_a_name_of_another_arm_is_said(tmp_path) -> None:
    text = machine_data(find_robot("kuka/kr6-r900-sixx"), "#KR120R2700_2 C4 FLR")
    robot = robot_of(write(tmp_path, "$machine.dat", text))
    assert robot.name == "kuka/kr120r2700-2"
    assert any("KR 120 R2700-2, whose flange" in doubt for doubt in robot.doubts)


@pytest.mark.parametrize(
    ("name", "mass"),
    [
        ("#KR210 L180 C2 FLR", 180.0),
        ("#KR30L16_2 C4 FLR", 16.0),
        ("KR 6 R900 sixx", 6.0),
        ("KR_16_LW", 16.0),
        ("robot", None),
    ],
)
def test_the_load_that_a_name_states(name: str, mass: float | None) -> None:
    """A longer arm of a type carries less, as its name says."""
    assert payload_of_name(["cell", name]) == mass


def test_a_file_without_a_name_or_a_load(tmp_path) -> None:
    text = machine_data(find_robot("kuka/kr6-r900-sixx"), "")
    robot = robot_of(write(tmp_path, "$machine.dat", text))
    assert robot.name == "kuka/robot" and not robot.shapes and robot.payload is None
    assert any("no shapes" in doubt for doubt in robot.doubts)


def test_accelerations_that_are_not_stated_are_assumed(tmp_path) -> None:
    text = machine_data(find_robot("kuka/kr6-r900-sixx"), "#KR77 C4")
    text = text.replace("$AXIS_JERK", "$AXIS_OTHER")
    robot = robot_of(write(tmp_path, "$machine.dat", text))
    assert robot.origins["acceleration"].startswith("assumed") and robot.spread["acceleration"] > 1
    assert all(0.01 < joint.velocity / joint.acceleration < 5 for joint in robot.joints)


TRACK = """INT $EX_AX_NUM=1
DECL EX_KIN $EX_KIN={ET1 #ERSYS,ET2 #NONE,ET3 #NONE,ET4 #NONE,ET5 #NONE,ET6 #NONE}
DECL ET_AX $ET1_AX={TR_A1 #E1,TR_A2 #NONE,TR_A3 #NONE}
$ERSYSROOT={X 100.0,Y 200.0,Z 0.0,A 90.0,B 0.0,C 0.0}
$ET1_TA1KR={X 0.0,Y 0.0,Z 450.0,A 0.0,B 90.0,C 0.0}
$ET1_TA2A1={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
$ET1_TFLA3={X 30.0,Y 0.0,Z 0.0,A 0.0,B -90.0,C 0.0}
"""
TABLE = """$EX_AX_NUM=2
$EX_KIN={ET1 #EASYS,ET2 #NONE}
$ET1_AX={TR_A1 #E1,TR_A2 #E2,TR_A3 #NONE}
$ET1_TA1KR={X 0.0,Y 0.0,Z 500.0,A 0.0,B 90.0,C 0.0}
$ET1_TA2A1={X 75.0,Y 2.0,Z -5.0,A 90.0,B 90.0,C 90.0}
$ET1_TFLA3={X 0.0,Y 0.0,Z 120.0,A -90.0,B 0.1,C -180.0}
"""


def test_a_track_carries_the_robot(tmp_path) -> None:
    known = find_robot("kuka/kr16-2")
    extra = TRACK + external_axis(7, linear=True, lower=-100.0, upper=5000.0, speed=1000.0, sign=-1)
    robot = robot_of(write(tmp_path, "$machine.dat", machine_data(known, "#KR16-2", extra=extra)))
    (track,) = robot.external_axes
    assert (track.role, track.joint.kind) == (ExternalRole.TRACK, JointKind.PRISMATIC)
    assert (track.joint.lower, track.joint.upper) == pytest.approx((-0.1, 5.0))
    assert track.joint.velocity == pytest.approx(1.0)
    q = np.radians([10, -80, 70, 20, 30, 40])
    for e1 in (0.0, 1500.0):
        root = framed({"X": 100.0, "Y": 200.0, "A": 90.0}) @ framed({"Z": 450.0, "B": 90.0})
        root = root @ shift(0, 0, -e1) @ framed({"X": 30.0, "B": -90.0})
        wanted = root @ (np.diag([1e3, 1e3, 1e3, 1.0]) @ known.flange_pose(q).matrix())
        at = robot.flange_pose([*q, 1e-3 * e1]).position
        np.testing.assert_allclose(1e3 * np.array(at), wanted[:3, 3], atol=1e-2)
    assert any("no acceleration of E1" in doubt for doubt in robot.doubts)


def test_a_table_of_two_axes(tmp_path) -> None:
    extra = TABLE + external_axis(7, linear=False, lower=-90, upper=90, speed=60.0)
    extra += "\n" + external_axis(8, linear=False, lower=-400, upper=400, speed=120.0, sign=-1)
    text = machine_data(find_robot("kuka/kr16-2"), "#KR16-2", extra=extra)
    robot = robot_of(write(tmp_path, "$machine.dat", text))
    tilt, turned = robot.external_axes
    assert (tilt.name, turned.name, turned.carried_by) == ("E1", "E2", "E1")
    for e1, e2 in ((0.0, 0.0), (30.0, -120.0)):
        wanted = framed({"Z": 500.0, "B": 90.0}) @ turn(2, e1)
        wanted = wanted @ framed({"X": 75, "Y": 2, "Z": -5, "A": 90, "B": 90, "C": 90})
        wanted = wanted @ turn(2, -e2) @ framed({"Z": 120, "A": -90, "B": 0.1, "C": -180})
        q = np.array([[0.0] * 6 + [math.radians(e1), math.radians(e2)]])
        R, p = poses(assemble(robot.frame_stages("E2")), q)
        np.testing.assert_allclose(1e3 * p[0], wanted[:3, 3], atol=1e-6)
        np.testing.assert_allclose(R[0], wanted[:3, :3], atol=1e-9)
    assert any("where the table of E1 stands" in doubt for doubt in robot.doubts)


def test_an_axis_of_no_chain_keeps_its_number(tmp_path) -> None:
    extra = TRACK.replace("#E1", "#E2").replace("NUM=1", "NUM=2")
    extra += external_axis(7, linear=False, lower=-90, upper=90, speed=60.0) + "\n"
    extra += external_axis(8, linear=True, lower=0, upper=900, speed=60.0)
    text = machine_data(find_robot("kuka/kr16-2"), "#KR16-2", extra=extra)
    robot = robot_of(write(tmp_path, "$machine.dat", text))
    assert [axis.name for axis in robot.external_axes] == ["E1", "E2"]
    assert [axis.role for axis in robot.external_axes] == [ExternalRole.TABLE, ExternalRole.TRACK]
    assert any("E1 belongs to no kinematic chain" in doubt for doubt in robot.doubts)


@pytest.mark.parametrize(
    ("extra", "said"),
    [
        (TRACK, r"\$RAT_MOT_AX\[7\] is missing"),
        ("$EX_AX_NUM=9", r"\$EX_AX_NUM is 0 to 6, not 9"),
        (TABLE.replace("TR_A2 #E2", "TR_A2 #E1"), "names an axis twice"),
    ],
)
def test_external_axes_that_make_no_sense(tmp_path, extra: str, said: str) -> None:
    text = machine_data(find_robot("kuka/kr16-2"), "#KR16-2", extra=extra)
    with pytest.raises(InputError, match=said):
        robot_of(write(tmp_path, "$machine.dat", text))


WHOLE = machine_data(find_robot("kuka/kr16-2"), "#KR16-2", extra=TRACK) + external_axis(
    7, linear=True, lower=0, upper=1000, speed=1000.0
)


@given(data=st.data())
def test_damaged_files_are_refused_or_read(tmp_path_factory, data) -> None:
    lines = WHOLE.split("\n")
    for _ in range(data.draw(st.integers(1, 3))):
        k = data.draw(st.integers(0, len(lines) - 1))
        at = data.draw(st.integers(0, len(lines[k])))
        junk = data.draw(st.sampled_from(["", "1e308", "-", "{", "}", "#", "0", "9" * 40, "TRUE"]))
        lines[k] = lines[k][:at] + junk + lines[k][data.draw(st.integers(at, len(lines[k]))) :]
    file = write(tmp_path_factory.mktemp("mada"), "$machine.dat", "\n".join(lines))
    try:
        robot = robot_of(file)
    except FlybyError as error:
        assert "machine.dat" in str(error)
    else:
        assert robot.size == 6 + len(robot.external_axes)
