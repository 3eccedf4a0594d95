"""The three ways to write a rotation mean what they say."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.files.tables import TomlTable
from flyby.core.robot.pose_table import read_pose
from flyby.core.spatial.rotation import matrix_from_quaternion, rotation_vector

angles = st.floats(-180.0, 180.0)


def rotation(**data: object) -> np.ndarray:
    pose = read_pose(TomlTable(data, Path("cell.toml"), "base"))
    return matrix_from_quaternion(np.array(pose.quaternion))


def about(axis: int, angle: float) -> np.ndarray:
    matrix = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


@given(angles, angles, angles)
def test_abc_turns_about_z_then_new_y_then_new_x(a: float, b: float, c: float) -> None:
    expected = about(2, a) @ about(1, b) @ about(0, c)
    assert np.allclose(rotation(abc_deg=[a, b, c]), expected, atol=1e-12)


@given(angles, angles, angles)
def test_all_three_ways_agree(a: float, b: float, c: float) -> None:
    matrix = rotation(abc_deg=[a, b, c])
    pose = read_pose(TomlTable({"abc_deg": [a, b, c]}, Path("cell.toml")))
    assert np.allclose(rotation(quat_wxyz=list(pose.quaternion)), matrix, atol=1e-12)
    turn = rotation_vector(matrix)
    assert np.allclose(rotation(rotvec_rad=turn.tolist()), matrix, atol=1e-9)


@given(st.lists(st.floats(-1e4, 1e4), min_size=3, max_size=3))
def test_positions_scale_by_their_unit(xyz: list[float]) -> None:
    mm = read_pose(TomlTable({"xyz_mm": xyz}, Path("cell.toml"))).position
    m = read_pose(TomlTable({"xyz_m": [0.001 * x for x in xyz]}, Path("cell.toml"))).position
    assert np.allclose(mm, m, rtol=1e-15, atol=0)
