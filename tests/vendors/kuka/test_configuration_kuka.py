"""Status and Turn, against points that were taught on robots."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.program.target import Configuration
from flyby.core.registry import find_vendor
from flyby.core.robot.model import Robot
from flyby.testing.strategies import configurations
from flyby.vendors.kuka.motion.configuration import KukaConfiguration, label
from flyby.vendors.ur.motion.configuration import UrConfiguration

KUKA = find_vendor("kuka")
KR30 = KUKA.robot("kr30-3")
SIX_AXES = [name for name in KUKA.robots if not name.startswith("iiwa")]


def label_of(robot: Robot, *q: float) -> KukaConfiguration:
    found = label(robot, np.radians(q))
    assert found is not None
    return found


def test_the_home_position_is_status_2() -> None:
    """HOME of every KR (0,-90,90,0,0,0) is taught as S 2, and with A5 below zero as S 6."""
    assert label_of(KR30, 10, -90, 90, 10, 30, 10) == KukaConfiguration(2, 0b000010)
    assert label_of(KR30, 10, -90, 90, 10, -30, 10) == KukaConfiguration(6, 0b010010)


@given(q=st.tuples(*[st.floats(-350, 350)] * 6))
def test_turn_holds_the_signs_of_the_axes(q: tuple[float, ...]) -> None:
    turn = label_of(KR30, *q).turn
    assert turn is not None
    assert [bool(turn >> k & 1) for k in range(6)] == [value < 0 for value in np.radians(q)]


@given(q=st.tuples(*[st.floats(-120, 120)] * 6))
def test_status_bit_1_is_a3_above_the_threshold(q: tuple[float, ...]) -> None:
    """KR 30-3: forearm 820 mm, its axis 145 mm above A3, so φ = atan(145/820)."""
    phi = math.degrees(math.atan2(145, 820))
    found = label_of(KR30, *q)
    assert found.status is not None
    if abs(q[2] - phi) > 0.1:
        assert bool(found.status & 2) == (phi <= q[2] < phi + 180)
        assert not found.undecided_status & 2


def test_status_bit_0_is_the_wrist_behind_axis_1() -> None:
    assert label_of(KR30, 0, -130, 90, 0, 30, 0).status == 2
    assert label_of(KR30, 0, -130, 20, 0, 30, 0).status == 3


@pytest.mark.parametrize("name", SIX_AXES)
@settings(max_examples=20, deadline=None)  # of more than a hundred arms each
@given(data=st.data())
def test_solutions_of_one_pose_have_different_status(name: str, data: st.DataObject) -> None:
    robot = KUKA.robot(name)
    q = data.draw(configurations(robot, margin=0.0))
    solutions = robot.inverse(robot.flange_pose(q))
    labels = [label(robot, solution.q) for solution in solutions if not solution.singular]
    decided = [found for found in labels if found is not None and not found.undecided_status]
    assert len({found.status for found in decided}) == len(decided)


def test_parts_that_are_not_stated_match_anything() -> None:
    found = label_of(KR30, 10, -90, 90, 10, -30, 10)
    assert KukaConfiguration(None, None).mismatch(found) == 0
    assert KukaConfiguration(6, None).mismatch(found) == 0
    assert KukaConfiguration(2, None).mismatch(found) == 1
    assert KukaConfiguration(None, 0).mismatch(found) == 2
    assert isinstance(found, Configuration)
    assert found.admits(found)


def test_axes_at_zero_fit_either_sign() -> None:
    found = label_of(KR30, 0, -90, 90, 0, 0, 0)
    for status, turn in ((2, 0b000010), (6, 0b111011), (6, 0b010010)):
        assert KukaConfiguration(status, turn).mismatch(found) == 0
    assert KukaConfiguration(2, 0).mismatch(found) == 1


def test_seven_axes_have_no_label() -> None:
    assert label(KUKA.robot("iiwa7-r800"), np.zeros(7)) is None


@pytest.mark.parametrize(("status", "turn"), [(32, 0), (-1, 0), (0, 4096), (0, -1)])
def test_values_out_of_range_are_refused(status: int, turn: int) -> None:
    with pytest.raises(InputError, match="lies between"):
        KukaConfiguration(status, turn)


def test_another_vendors_label_is_refused() -> None:
    with pytest.raises(InputError, match="cannot be compared"):
        KukaConfiguration(0, 0).mismatch(UrConfiguration((0.0,)))


def test_another_turn_is_admitted_and_no_other_status() -> None:
    found = label_of(KR30, 10, -90, 90, 10, 30, 10)
    assert KukaConfiguration(found.status, 0b111111).admits(found)
    assert not KukaConfiguration((found.status or 0) ^ 4, found.turn).admits(found)
