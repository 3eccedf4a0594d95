"""A KUKA's $machine.dat: ranges, speeds and accelerations of its axes, and whose arm it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from flyby.core.errors import InputError
from flyby.core.registry import find_robot
from flyby.vendors.kuka.machine_data import MachineData, flange, with_machine_data

KR3 = find_robot("kuka/kr3-r540")
AXES = """
$VEL_AXIS_MA[{i}]={rpm} ;maximum
$RAT_MOT_AX[{i}]={{N -{turns},D 10}}
$SOFTN_END[{i}]=-{range}.0
$SOFTP_END[{i}]={range}.0
$AXIS_DIR[{i}]={sign}
$AXIS_JERK[{i}]={jerk}.0
"""
KR3_DATA = """&ACCESS RVP
DEFDAT  $MACHINE PUBLIC
CHAR $TRAFONAME[32]
$TRAFONAME[]="#KR3R540 C4SR"
BOOL $DEF_A4FIX=FALSE
$TIRORO={X 0.0,Y 0.0,Z 345.0,A 0.0,B 0.0,C 0.0}
$LENGTH_A=20.0
$LENGTH_B=260.0
$TX3P3={FRAME: X 260.0,Y 0.0,Z 20.0,A 0.0,B 90.0,C 0.0}
$DH_4={DHART_A 0.0,DHART_D 0.0,DHART_ALPHA 90.0}
$DH_5={DHART_A 0.0,DHART_D 0.0,DHART_ALPHA -90.0}
$TFLWP={X 0.0,Y 0.0,Z 75.0,A 0.0,B 0.0,C 0.0}
$DEF_FLT_PTP=144
INT $DEF_FLT_CP=96 ;ms
""" + "".join(
    AXES.format(i=i, rpm=4000 + i, turns=500 + i, range=100 + i, sign=sign, jerk=50_000 + i)
    for i, sign in zip(range(1, 7), (-1, 1, 1, -1, -1, -1), strict=True)
)


def file_of(folder: Path, text: str) -> Path:
    file = folder / "$machine.dat"
    file.write_bytes(text.replace("\n", "\r\n").encode("latin-1"))
    return file


def test_ranges_speeds_and_accelerations(tmp_path) -> None:
    robot = with_machine_data(KR3, file_of(tmp_path, KR3_DATA))
    for i, (joint, nominal) in enumerate(zip(robot.joints, KR3.joints, strict=True), start=1):
        assert np.degrees([joint.lower, joint.upper]) == pytest.approx([-100 - i, 100 + i])
        assert np.degrees(joint.velocity) == pytest.approx(6 * (4000 + i) * 10 / (500 + i))
        assert np.degrees(joint.acceleration) == pytest.approx((50_000 + i) * 0.144 / 20)
        assert joint.placement == nominal.placement
    assert "$machine.dat" in robot.origins["velocity"]


def test_data_are_read_by_name_and_index(tmp_path) -> None:
    data = MachineData.read(file_of(tmp_path, KR3_DATA))
    assert data.number("$VEL_AXIS_MA", 1) == 4001.0
    assert data.struct("$RAT_MOT_AX", 1) == {"N": -501.0, "D": 10.0}
    assert data.number("$DEF_FLT_CP") == 96.0 and not data.has("$EX_AX_NUM")


def test_the_flange_is_that_of_the_catalogue(tmp_path) -> None:
    data = MachineData.read(file_of(tmp_path, KR3_DATA))
    for q in np.random.default_rng(3).uniform(-2, 2, (20, 6)):
        found = flange(data, q).matrix()
        np.testing.assert_allclose(found, KR3.flange_pose(q).matrix(), atol=1e-12)


def test_a_published_check_point(tmp_path) -> None:
    """KR 6 R900 at (10, −80, 70, 20, 30, 40)°: (575.025, −115.284, 930.502) mm."""
    text = KR3_DATA.replace("Z 345.0", "Z 400.0").replace("$LENGTH_A=20.0", "$LENGTH_A=25.0")
    text = text.replace("$LENGTH_B=260.0", "$LENGTH_B=455.0").replace(
        "X 260.0,Y 0.0,Z 20.0", "X 420.0,Y 0.0,Z 35.0"
    )
    data = MachineData.read(file_of(tmp_path, text.replace("Z 75.0", "Z 80.0")))
    q = np.radians([10, -80, 70, 20, 30, 40])
    assert 1e3 * np.array(flange(data, q).position) == pytest.approx(
        [575.025, -115.284, 930.502], abs=1e-3
    )


def test_kr_c2_states_the_time_to_full_speed(tmp_path) -> None:
    text = KR3_DATA.replace("$AXIS_JERK", "$RAISE_TIME").replace("=50001.0", "=400.0")
    robot = with_machine_data(KR3, file_of(tmp_path, text))
    assert robot.joints[0].acceleration == pytest.approx(robot.joints[0].velocity / 0.4)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("$LENGTH_B=260.0", "$LENGTH_B=455.0"), "name the robot"),
        (("$SOFTN_END[3]=", "$SOFTN_OTHER[3]="), r"\$SOFTN_END\[3\] is missing"),
        (("$VEL_AXIS_MA[2]=4002", "$VEL_AXIS_MA[2]=TRUE"), "is not a number"),
        (("{N -502,D 10}", "17"), "is not a struct"),
        (("$VEL_AXIS_MA[4]=4004", "$VEL_AXIS_MA[4]=0"), "makes no sense"),
    ],
)
def test_files_that_do_not_fit_are_refused(tmp_path, change, said: str) -> None:
    with pytest.raises(InputError, match=said):
        with_machine_data(KR3, file_of(tmp_path, KR3_DATA.replace(*change)))


def test_an_empty_file_and_an_arm_of_seven_joints(tmp_path) -> None:
    with pytest.raises(InputError, match="assigns nothing"):
        with_machine_data(KR3, file_of(tmp_path, "no data\n"))
    with pytest.raises(InputError, match="six axes"):
        with_machine_data(find_robot("kuka/iiwa7-r800"), file_of(tmp_path, KR3_DATA))
