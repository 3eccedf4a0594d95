"""The front of an arm is the same wherever its joints are counted from."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.files.tables import TomlTable
from flyby.core.robot.catalogue import robot_of
from flyby.core.robot.model import Robot
from flyby.core.robot.posture import posture

JOINT = """
[[joint]]
name = "J{number}"
xyz_mm = {xyz}
rpy_deg = [0, {turned}, 0]
axis = {axis}
lower_deg = {lower}
upper_deg = {upper}
velocity_deg_s = 300
"""


def arm(zero_deg: float, ahead: float = 1.0) -> Robot:
    """With its forearm turned by so much against the upright one where joint 3 is zero.

    Args:
        ahead: -1 for the arm that bends to the other side.
    """
    lower, upper = sorted(ahead * limit - zero_deg for limit in (0, 161))
    rows = (
        ([0, 0, 0], [0, 0, 1], 0, (-240, 240)),
        ([0, 0, 350], [0, 1, 0], 0, (-120, 120)),
        ([0, 0, 235], [0, 1, 0], zero_deg, (lower, upper)),
        ([-50 * ahead, 0, 0], [0, 0, 1], 0, (-200, 200)),
        ([0, 0, 275], [0, 1, 0], 0, (-120, 120)),
        ([0, 0, 0], [0, 0, 1], 0, (-360, 360)),
    )
    text = 'name = "mitsubishi/arm"\n[origin]\n'
    for group in ("geometry", "range", "velocity", "acceleration"):
        text += f'{group} = "assumed: for this test"\n'
    text += "[assumed]\nacceleration_time_s = 0.2\n[flange]\nxyz_mm = [0, 0, 85]\n"
    for number, (xyz, axis, turned, (low, high)) in enumerate(rows, 1):
        text += JOINT.format(
            number=number, xyz=xyz, axis=axis, turned=turned, lower=low, upper=high
        )
    return robot_of(TomlTable(tomllib.loads(text), Path("arm.toml")))


UPRIGHT, BACKWARDS = arm(0.0), arm(0.0, -1.0)


def test_an_arm_that_bends_forward_has_its_front_there() -> None:
    for q in ([0, 0, 90, 0, 90, 0], [0, 22, 117, 0, 40, 0]):
        at = posture(UPRIGHT, np.radians(q))
        assert at is not None and at.shoulder > 0.1 and at.elbow > 0.1
        back = posture(BACKWARDS, np.radians([-q[k] if k in (1, 2) else q[k] for k in range(6)]))
        assert back is not None and back.shoulder > 0.1 and back.elbow > 0.1


@given(
    zero=st.sampled_from([40.0, 90.0, 120.0]),
    q=st.tuples(*[st.floats(-100, 100)] * 2, st.floats(1, 160), *[st.floats(-100, 100)] * 3),
)
def test_it_does_not_depend_on_where_joint_3_is_zero(zero: float, q: tuple[float, ...]) -> None:
    other = [one - zero if k == 2 else one for k, one in enumerate(q)]
    wanted, found = posture(UPRIGHT, np.radians(q)), posture(arm(zero), np.radians(other))
    assert found == pytest.approx(wanted, abs=1e-9)
