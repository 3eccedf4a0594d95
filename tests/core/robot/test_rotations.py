"""Rotations one by one are what they are in a stack, and come back as they went."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from flyby.core.arrays import FloatArray
from flyby.core.registry import find_robot
from flyby.core.robot.kinematics.chain_kernels import fill_quaternions, poses
from flyby.core.spatial.rotation import (
    matrix_from_quaternion,
    matrix_from_rotation_vector,
    quaternion_from_matrix,
    rotation_vector,
)

_PARTS = st.one_of(st.floats(-3.2, 3.2), st.sampled_from([0.0, -0.0, 1e-9, np.pi, -np.pi, 1e-200]))
_VECTORS = arrays(float, st.tuples(st.integers(0, 4), st.just(3)), elements=_PARTS)


@given(_VECTORS)
def test_a_stack_of_rotations_is_each_of_them(vectors: FloatArray) -> None:
    matrices = matrix_from_rotation_vector(vectors)
    quaternions = quaternion_from_matrix(matrices)
    back = matrix_from_quaternion(quaternions)
    assert matrices.shape == back.shape == (len(vectors), 3, 3)
    for vector, matrix, quaternion, again in zip(vectors, matrices, quaternions, back, strict=True):
        # NumPy's sine and Python's may differ in the last digit.
        np.testing.assert_allclose(matrix_from_rotation_vector(vector), matrix, atol=1e-15)
        np.testing.assert_array_equal(quaternion_from_matrix(matrix), quaternion)
        np.testing.assert_array_equal(matrix_from_quaternion(quaternion), again)
    np.testing.assert_allclose(matrices @ np.swapaxes(matrices, -1, -2) - np.eye(3), 0, atol=1e-14)
    np.testing.assert_allclose(back, matrices, atol=1e-14)
    assert np.all(quaternions[:, 0] >= 0.0)


@given(arrays(float, 3, elements=st.floats(-1.8, 1.8)))
def test_a_rotation_vector_comes_back(vector: FloatArray) -> None:
    np.testing.assert_allclose(
        rotation_vector(matrix_from_rotation_vector(vector)), vector, atol=1e-12
    )


@pytest.mark.parametrize("what", [np.nan, np.inf])
def test_what_is_no_number_stays_so(what: float) -> None:
    vector = np.array([what, 0.0, 0.0])
    for vectors in (vector, vector[None], vector[None, None]):
        matrix = matrix_from_rotation_vector(vectors)
        assert matrix.shape == (*vectors.shape, 3)
        assert np.isnan(matrix).any()
        assert np.isnan(quaternion_from_matrix(matrix)).any()


@given(arrays(float, (5, 6), elements=st.floats(-3.1, 3.1)))
def test_orientations_of_configurations_are_those_of_their_matrices(q: FloatArray) -> None:
    chain = find_robot("ur/ur5e").chain
    R, p = poses(chain, q)
    quaternions, positions = np.empty((5, 4)), np.empty((5, 3))
    fill_quaternions(chain, q, quaternions, positions)
    np.testing.assert_array_equal(positions, p)
    np.testing.assert_allclose(matrix_from_quaternion(quaternions), R, atol=1e-14)
    np.testing.assert_allclose(quaternions, quaternion_from_matrix(R), atol=1e-14)
