"""qnear: the nearest solution, whole turns counted."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.program.target import Configuration
from flyby.core.registry import find_vendor
from flyby.vendors.ur.motion.configuration import UrConfiguration, label

UR5E = find_vendor("ur").robot("ur5e")

joints = st.tuples(*[st.floats(-math.tau, math.tau)] * 6)


@given(joints, joints)
def test_mismatch_is_the_distance_of_the_joint_values(
    near: tuple[float, ...], q: tuple[float, ...]
) -> None:
    found = label(UR5E, np.array(q))
    wanted = UrConfiguration(near)
    assert wanted.mismatch(found) == pytest.approx(np.linalg.norm(np.subtract(near, q)))
    assert UrConfiguration(q).mismatch(found) == 0
    assert isinstance(found, Configuration)
    assert wanted.admits(found)


def test_a_whole_turn_counts() -> None:
    wanted = UrConfiguration((0.0,) * 6)
    turned = label(UR5E, np.array([math.tau, 0, 0, 0, 0, 0]))
    assert wanted.mismatch(turned) == pytest.approx(math.tau)


@settings(deadline=None)  # the first example compiles
@given(joints)
def test_the_solution_named_by_its_own_joints_is_the_nearest(q: tuple[float, ...]) -> None:
    wanted = UrConfiguration(q)
    solutions = UR5E.inverse(UR5E.flange_pose(np.array(q)))
    turns = [turn for solution in solutions for turn in UR5E.turns(solution.q)]
    nearest = min(turns, key=lambda turn: wanted.mismatch(label(UR5E, turn)))
    if all(not solution.singular for solution in solutions):
        distances = [math.dist(turn, q) for turn in turns]  # a norm of squares would underflow
        assert wanted.mismatch(label(UR5E, nearest)) <= min(distances) * (1 + 1e-12)


@pytest.mark.parametrize("values", [(), (math.nan,) * 6, (math.inf,) * 6])
def test_joint_values_must_be_finite(values: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match="finite"):
        UrConfiguration(values)


def test_another_number_of_joints_is_refused() -> None:
    with pytest.raises(InputError, match="has 5 joint values"):
        UrConfiguration((0.0,) * 5).mismatch(UrConfiguration((0.0,) * 6))
