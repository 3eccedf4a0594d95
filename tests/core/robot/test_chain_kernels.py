"""The compiled kernels against explicit matrix products, Pinocchio and finite differences."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.robot.kinematics.chain import Chain
from flyby.core.robot.kinematics.chain_kernels import (
    acceleration_gradient,
    jacobian,
    jacobians,
    motion,
    motions,
    poses,
    velocity_gradient,
)
from flyby.core.spatial.rotation import matrix_from_rotation_vector

SETTINGS = settings(max_examples=60, deadline=None)


def random_chain(seed: int, joints: int, values: int) -> Chain:
    """A chain with any axes, signs and kinds; indices may repeat and may be missing."""
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=(joints, 3))
    return Chain(
        rotation=matrix_from_rotation_vector(rng.normal(size=(joints, 3))),
        translation=rng.normal(size=(joints, 3)),
        axis=axis / np.linalg.norm(axis, axis=1, keepdims=True),
        prismatic=rng.random(joints) < 0.3,
        joint=rng.integers(0, values, joints),
        sign=rng.choice([-1.0, 1.0], joints),
        end_rotation=matrix_from_rotation_vector(rng.normal(size=3)),
        end_translation=rng.normal(size=3),
    )


@st.composite
def moving_chains(draw: st.DrawFn) -> tuple[Chain, FloatArray, FloatArray, FloatArray, FloatArray]:
    seed = draw(st.integers(0, 2**32 - 1))
    values = draw(st.integers(1, 7))
    chain = random_chain(seed, draw(st.integers(0, 8)), values)
    rng = np.random.default_rng(seed + 1)
    q, dq, ddq = rng.normal(size=(3, values))
    return chain, q, dq, ddq, rng.normal(size=6)


def product(chain: Chain, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """T(q) by the formula of `Chain`, with homogeneous matrices."""
    T = np.eye(4)
    for k in range(len(chain.joint)):
        step, moved = np.eye(4), np.eye(4)
        step[:3, :3], step[:3, 3] = chain.rotation[k], chain.translation[k]
        amount = chain.sign[k] * chain.axis[k] * q[chain.joint[k]]
        if chain.prismatic[k]:
            moved[:3, 3] = amount
        else:
            moved[:3, :3] = matrix_from_rotation_vector(amount)
        T = T @ step @ moved
    return (
        T[:3, :3] @ chain.end_rotation,
        T[:3, :3] @ chain.end_translation + T[:3, 3],
    )


def jacobian_at(chain: Chain, q: FloatArray) -> FloatArray:
    R, p, J = np.empty((3, 3)), np.empty(3), np.empty((6, q.size))
    jacobian(chain, q, R, p, J)
    return J


def motion_at(
    chain: Chain, q: FloatArray, dq: FloatArray, ddq: FloatArray
) -> tuple[FloatArray, FloatArray]:
    v, a = np.empty(6), np.empty(6)
    motion(chain, q, dq, ddq, v, a)
    return v, a


@SETTINGS
@given(moving_chains())
def test_pose_is_the_product_of_the_chain(case) -> None:
    chain, q, *_ = case
    (R,), (p,) = poses(chain, q[None])
    expected_R, expected_p = product(chain, q)
    np.testing.assert_allclose(R, expected_R, atol=1e-13)
    np.testing.assert_allclose(p, expected_p, atol=1e-12)


@SETTINGS
@given(moving_chains())
def test_jacobian_is_the_derivative_of_the_pose(case) -> None:
    chain, q, *_ = case
    J = jacobian_at(chain, q)
    h = 1e-6
    for j in range(q.size):
        step = np.zeros_like(q)
        step[j] = h
        R0, p0 = product(chain, q - step)
        R1, p1 = product(chain, q + step)
        R = product(chain, q)[0]
        spin = (R1 - R0) / (2 * h) @ R.T
        np.testing.assert_allclose(J[:3, j], (p1 - p0) / (2 * h), atol=1e-7)
        np.testing.assert_allclose(J[3:, j], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-7)


@SETTINGS
@given(moving_chains())
def test_velocity_is_the_jacobian_times_the_rates(case) -> None:
    chain, q, dq, ddq, _ = case
    v, _ = motion_at(chain, q, dq, ddq)
    np.testing.assert_allclose(v, jacobian_at(chain, q) @ dq, atol=1e-11)


@SETTINGS
@given(moving_chains())
def test_acceleration_is_the_derivative_of_the_velocity(case) -> None:
    chain, q, dq, ddq, _ = case
    _, a = motion_at(chain, q, dq, ddq)

    def velocity(t: float) -> FloatArray:
        return jacobian_at(chain, q + t * dq + 0.5 * t * t * ddq) @ (dq + t * ddq)

    h = 1e-5
    np.testing.assert_allclose(a, (velocity(h) - velocity(-h)) / (2 * h), rtol=1e-6, atol=1e-5)


def central_gradient(function, x: FloatArray) -> FloatArray:
    h = 1e-6
    steps = h * np.eye(x.size)
    return np.array([(function(x + s) - function(x - s)) / (2 * h) for s in steps])


@SETTINGS
@given(moving_chains())
def test_velocity_gradient(case) -> None:
    chain, q, dq, _, w = case
    grad = np.full(q.size, 2.0)
    velocity_gradient(chain, q, dq, w, grad)
    expected = central_gradient(lambda x: w @ jacobian_at(chain, x) @ dq, q)
    np.testing.assert_allclose(grad - 2.0, expected, rtol=1e-6, atol=1e-6)


@SETTINGS
@given(moving_chains())
def test_acceleration_gradients(case) -> None:
    chain, q, dq, ddq, w = case
    grad_q, grad_dq = np.full(q.size, 2.0), np.full(q.size, 3.0)
    acceleration_gradient(chain, q, dq, ddq, w, grad_q, grad_dq)
    expected_q = central_gradient(lambda x: w @ motion_at(chain, x, dq, ddq)[1], q)
    expected_dq = central_gradient(lambda x: w @ motion_at(chain, q, x, ddq)[1], dq)
    np.testing.assert_allclose(grad_q - 2.0, expected_q, rtol=1e-6, atol=1e-5)
    np.testing.assert_allclose(grad_dq - 3.0, expected_dq, rtol=1e-6, atol=1e-5)


def pinocchio_model(chain: Chain) -> pin.Model:
    model = pin.Model()
    parent = 0
    for k in range(len(chain.joint)):
        axis = chain.sign[k] * chain.axis[k]
        kind = (
            pin.JointModelPrismaticUnaligned
            if chain.prismatic[k]
            else (pin.JointModelRevoluteUnaligned)
        )
        placement = pin.SE3(chain.rotation[k], chain.translation[k])
        parent = model.addJoint(parent, kind(axis), placement, f"joint{k}")
    end = pin.SE3(chain.end_rotation, chain.end_translation)
    model.addFrame(pin.Frame("tcp", parent, 0, end, pin.FrameType.OP_FRAME))
    return model


@pytest.mark.parametrize("seed", range(5))
def test_motion_agrees_with_pinocchio(seed: int) -> None:
    size = 6
    chain = random_chain(seed, size, size)._replace(joint=np.arange(size))
    model = pinocchio_model(chain)
    data = model.createData()
    q, dq, ddq = np.random.default_rng(seed).normal(size=(3, size))
    pin.forwardKinematics(model, data, q, dq, ddq)
    frame = model.getFrameId("tcp")
    placement = pin.updateFramePlacement(model, data, frame)
    axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    R, p, J = np.empty((3, 3)), np.empty(3), np.empty((6, size))
    jacobian(chain, q, R, p, J)
    v, a = motion_at(chain, q, dq, ddq)
    np.testing.assert_allclose(R, placement.rotation, atol=1e-13)
    np.testing.assert_allclose(p, placement.translation, atol=1e-12)
    np.testing.assert_allclose(J, pin.computeFrameJacobian(model, data, q, frame, axes), atol=1e-12)
    np.testing.assert_allclose(v, pin.getFrameVelocity(model, data, frame, axes).vector, atol=1e-11)
    acceleration = pin.getFrameClassicalAcceleration(model, data, frame, axes).vector
    np.testing.assert_allclose(a, acceleration, atol=1e-10)


def test_batches_repeat_the_scalar_kernels() -> None:
    chain = random_chain(3, 7, 5)
    q, dq, ddq = np.random.default_rng(4).normal(size=(3, 9, 5))
    R, p = poses(chain, q)
    J = jacobians(chain, q)
    v, a = motions(chain, q, dq, ddq)
    for m in range(9):
        (expected_R,), (expected_p,) = poses(chain, q[m : m + 1])
        expected_v, expected_a = motion_at(chain, q[m], dq[m], ddq[m])
        np.testing.assert_array_equal(R[m], expected_R)
        np.testing.assert_array_equal(p[m], expected_p)
        np.testing.assert_array_equal(J[m], jacobian_at(chain, q[m]))
        np.testing.assert_array_equal(v[m], expected_v)
        np.testing.assert_array_equal(a[m], expected_a)
