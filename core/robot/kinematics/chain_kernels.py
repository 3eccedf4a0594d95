"""Compiled kinematics of a `Chain`: pose, Jacobian, motion and the gradients of motion.

All vectors are in work-object axes; the point is the TCP. The scalar kernels write into arrays
of the caller and may be called from other compiled code; the batched ones take q of shape (M, N).

Every kernel walks the chain once from the work object to the TCP. With the frame before joint k
at o, turning at ω and α, and the joint's signed axis s, a revolute joint gives

    ω' = ω + s q̇,    α' = α + s q̈ + ω × s q̇

and a point at r from o moves with v_o + ω × r, a_o + α × r + ω × (ω × r).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray
from .chain import Chain
from .lean import inlined, inner, lean
from .orientations import write_quaternion
from .vectors import (
    UNTURNED,
    ZERO,
    Rotation,
    Vector,
    add,
    compose,
    cross,
    dot,
    load,
    load_rotation,
    load_row,
    rotation_about,
    scale,
    subtract,
    turn,
)

_NO_QUATERNIONS = np.empty((0, 4))


@inlined
def place(chain: Chain, k: int, turned: Rotation) -> tuple[Rotation, Vector, Vector]:
    """The frame before joint k: rotation, step to its origin, and the joint's signed axis."""
    step = turn(turned, load_row(chain.translation, k))
    placed = compose(turned, load_rotation(chain.rotation, k))
    axis = turn(placed, scale(chain.sign[k], load_row(chain.axis, k)))
    return placed, step, axis


@inlined
def turned_by(chain: Chain, k: int, value: float, placed: Rotation) -> Rotation:
    """The rotation behind a revolute joint k."""
    moved: Rotation = compose(
        placed, rotation_about(load_row(chain.axis, k), chain.sign[k] * value)
    )
    return moved


@inner
def _finish(chain: Chain, turned: Rotation, at: Vector, R: FloatArray, p: FloatArray) -> None:
    """Write the TCP's pose, given the frame behind the last joint."""
    for j in range(3):
        column = chain.end_rotation[0, j], chain.end_rotation[1, j], chain.end_rotation[2, j]
        R[0, j], R[1, j], R[2, j] = turn(turned, column)
    p[0], p[1], p[2] = add(at, turn(turned, load(chain.end_translation)))


@inner
def pose(chain: Chain, q: FloatArray, R: FloatArray, p: FloatArray) -> None:
    """The TCP in the work object's frame.

    Args:
        chain: K joints.
        q: (N,) rad or m.
        R: (3, 3), written: rotation.
        p: (3,) m, written: position.
    """
    turned, at = UNTURNED, ZERO
    for k in range(chain.joint.size):
        value = q[chain.joint[k]]
        turned, step, axis = place(chain, k, turned)
        at = add(at, step)
        if chain.prismatic[k]:
            at = add(at, scale(value, axis))
        else:
            turned = turned_by(chain, k, value, turned)
    _finish(chain, turned, at, R, p)


@lean
def jacobian(chain: Chain, q: FloatArray, R: FloatArray, p: FloatArray, J: FloatArray) -> None:
    """The TCP's pose and Jacobian.

    Args:
        chain: K joints.
        q: (N,) rad or m.
        R: (3, 3), written: rotation.
        p: (3,) m, written: position.
        J: (6, N), written: rows 0-2 linear velocity of the TCP, rows 3-5 angular velocity.
    """
    J[:, :] = 0.0
    turned, at = UNTURNED, ZERO
    for k in range(chain.joint.size):
        j = chain.joint[k]
        turned, step, axis = place(chain, k, turned)
        at = add(at, step)
        if chain.prismatic[k]:
            at = add(at, scale(q[j], axis))
            linear = axis
        else:
            turned = turned_by(chain, k, q[j], turned)
            # axis × (p - at), of which axis × p joins below once p is known.
            linear = cross(at, axis)
            J[3, j] += axis[0]
            J[4, j] += axis[1]
            J[5, j] += axis[2]
        J[0, j] += linear[0]
        J[1, j] += linear[1]
        J[2, j] += linear[2]
    _finish(chain, turned, at, R, p)
    for j in range(J.shape[1]):
        linear = cross((J[3, j], J[4, j], J[5, j]), (p[0], p[1], p[2]))
        J[0, j] += linear[0]
        J[1, j] += linear[1]
        J[2, j] += linear[2]


@inner
def carry(omega: Vector, alpha: Vector, step: Vector) -> tuple[Vector, Vector]:
    """What a step fixed in a turning frame adds to velocity and acceleration."""
    velocity = cross(omega, step)
    return velocity, add(cross(alpha, step), cross(omega, velocity))


@lean
def motion(
    chain: Chain, q: FloatArray, dq: FloatArray, ddq: FloatArray, v: FloatArray, a: FloatArray
) -> None:
    """The TCP's velocity J q̇ and acceleration J q̈ + J̇ q̇.

    Args:
        chain: K joints.
        q, dq, ddq: (N,) rad or m and derivatives.
        v: (6,), written: linear and angular velocity.
        a: (6,), written: second derivative of the position, derivative of the angular velocity.
    """
    turned = UNTURNED
    omega, alpha, speed, rise = ZERO, ZERO, ZERO, ZERO
    for k in range(chain.joint.size):
        j = chain.joint[k]
        turned, step, axis = place(chain, k, turned)
        rate = scale(dq[j], axis)
        if chain.prismatic[k]:
            step = add(step, scale(q[j], axis))
        velocity, acceleration = carry(omega, alpha, step)
        speed = add(speed, velocity)
        rise = add(rise, acceleration)
        if chain.prismatic[k]:
            speed = add(speed, rate)
            rise = add(rise, add(scale(ddq[j], axis), scale(2.0, cross(omega, rate))))
        else:
            turned = turned_by(chain, k, q[j], turned)
            alpha = add(alpha, add(scale(ddq[j], axis), cross(omega, rate)))
            omega = add(omega, rate)
    velocity, acceleration = carry(omega, alpha, turn(turned, load(chain.end_translation)))
    v[0], v[1], v[2] = add(speed, velocity)
    a[0], a[1], a[2] = add(rise, acceleration)
    v[3], v[4], v[5] = omega
    a[3], a[4], a[5] = alpha


# Columns of a walk: signed axis, origin before the joint, and that frame's motion.
AXIS, ORIGIN, OMEGA, ALPHA, SPEED, RISE, COLUMNS = 0, 1, 2, 3, 4, 5, 6


@inner
def _store(walk: FloatArray, k: int, column: int, value: Vector) -> None:
    walk[k, column, 0], walk[k, column, 1], walk[k, column, 2] = value


@inner
def recall(walk: FloatArray, k: int, column: int) -> Vector:
    return walk[k, column, 0], walk[k, column, 1], walk[k, column, 2]


@inner
def walk_motion(
    chain: Chain, q: FloatArray, dq: FloatArray, ddq: FloatArray, walk: FloatArray
) -> None:
    """Write the motion before each joint, (K + 1, 6, 3); row K belongs to the TCP.

    The first k + 1 rows are the walk of the chain that ends at the origin of joint k; no more are
    written than there are.
    """
    turned, at = UNTURNED, ZERO
    omega, alpha, speed, rise = ZERO, ZERO, ZERO, ZERO
    for k in range(min(chain.joint.size, walk.shape[0])):
        j = chain.joint[k]
        turned, step, axis = place(chain, k, turned)
        velocity, acceleration = carry(omega, alpha, step)
        at, speed, rise = add(at, step), add(speed, velocity), add(rise, acceleration)
        _store(walk, k, AXIS, axis)
        _store(walk, k, ORIGIN, at)
        _store(walk, k, OMEGA, omega)
        _store(walk, k, ALPHA, alpha)
        _store(walk, k, SPEED, speed)
        _store(walk, k, RISE, rise)
        if k + 1 == walk.shape[0]:
            return
        rate = scale(dq[j], axis)
        if chain.prismatic[k]:
            slide = scale(q[j], axis)
            velocity, acceleration = carry(omega, alpha, slide)
            at, speed = add(at, slide), add(speed, add(velocity, rate))
            rise = add(rise, add(acceleration, scale(2.0, cross(omega, rate))))
            rise = add(rise, scale(ddq[j], axis))
        else:
            turned = turned_by(chain, k, q[j], turned)
            alpha = add(alpha, add(scale(ddq[j], axis), cross(omega, rate)))
            omega = add(omega, rate)
    last = chain.joint.size
    step = turn(turned, load(chain.end_translation))
    velocity, acceleration = carry(omega, alpha, step)
    _store(walk, last, ORIGIN, add(at, step))
    _store(walk, last, OMEGA, omega)
    _store(walk, last, ALPHA, alpha)
    _store(walk, last, SPEED, add(speed, velocity))
    _store(walk, last, RISE, add(rise, acceleration))


@njit(cache=True, error_model="numpy")
def velocity_gradient(
    chain: Chain, q: FloatArray, dq: FloatArray, w: FloatArray, grad_q: FloatArray
) -> None:
    """Add the gradient of w · (J(q) q̇) with respect to q.

    Args:
        chain: K joints.
        q, dq: (N,).
        w: (6,).
        grad_q: (N,), added to.
    """
    walk = np.empty((chain.joint.size + 1, COLUMNS, 3))
    walk_motion(chain, q, dq, np.zeros_like(dq), walk)
    pull_velocity(chain, walk, w, grad_q)


@inner
def walk_speeds(chain: Chain, dq: FloatArray, walk: FloatArray) -> None:
    """Write velocities at other rates (N,) into a walk whose axes and origins stand."""
    omega, speed = ZERO, ZERO
    last = walk.shape[0] - 1
    for k in range(last):
        _store(walk, k, OMEGA, omega)
        _store(walk, k, SPEED, speed)
        rate = scale(dq[chain.joint[k]], recall(walk, k, AXIS))
        step = subtract(recall(walk, k + 1, ORIGIN), recall(walk, k, ORIGIN))
        if chain.prismatic[k]:
            speed = add(speed, rate)
        else:
            omega = add(omega, rate)
        speed = add(speed, cross(omega, step))
    _store(walk, last, OMEGA, omega)
    _store(walk, last, SPEED, speed)


@inner
def pull_velocity(chain: Chain, walk: FloatArray, w: FloatArray, grad_q: FloatArray) -> None:
    """Add the gradient of w · (velocity at the end of a walk) with respect to q; w is (6,)."""
    force, torque = (w[0], w[1], w[2]), (w[3], w[4], w[5])
    for k in range(walk.shape[0] - 1):
        linear, angular = _velocity_change(chain, k, walk)
        grad_q[chain.joint[k]] += dot(force, linear) + dot(torque, angular)


@inner
def _relative(walk: FloatArray, k: int) -> tuple[Vector, Vector, Vector]:
    """The TCP against the frame before joint k: place, velocity, angular velocity."""
    last = walk.shape[0] - 1
    r = subtract(recall(walk, last, ORIGIN), recall(walk, k, ORIGIN))
    omega = recall(walk, k, OMEGA)
    velocity = subtract(recall(walk, last, SPEED), recall(walk, k, SPEED))
    spin = subtract(recall(walk, last, OMEGA), omega)
    return r, subtract(velocity, cross(omega, r)), spin


@inner
def _velocity_change(chain: Chain, k: int, walk: FloatArray) -> tuple[Vector, Vector]:
    """Derivative of the TCP's velocity with respect to the value of joint k.

    The joint turns place and relative velocity of all that follows: δr = s × r, δv = s × v_rel.
    """
    axis, omega = recall(walk, k, AXIS), recall(walk, k, OMEGA)
    if chain.prismatic[k]:
        return cross(omega, axis), ZERO
    r, velocity, spin = _relative(walk, k)
    return add(cross(omega, cross(axis, r)), cross(axis, velocity)), cross(axis, spin)


@inner
def _acceleration_change(chain: Chain, k: int, walk: FloatArray) -> tuple[Vector, Vector]:
    """Derivative of the TCP's acceleration with respect to the value of joint k."""
    axis, omega = recall(walk, k, AXIS), recall(walk, k, OMEGA)
    alpha = recall(walk, k, ALPHA)
    if chain.prismatic[k]:
        return carry(omega, alpha, axis)[1], ZERO
    last = walk.shape[0] - 1
    r, velocity, spin = _relative(walk, k)
    relative = subtract(recall(walk, last, RISE), recall(walk, k, RISE))
    relative = subtract(relative, carry(omega, alpha, r)[1])
    relative = subtract(relative, scale(2.0, cross(omega, velocity)))
    linear = add(carry(omega, alpha, cross(axis, r))[1], cross(axis, relative))
    linear = add(linear, scale(2.0, cross(omega, cross(axis, velocity))))
    spun = subtract(recall(walk, last, ALPHA), alpha)
    spun = subtract(spun, cross(omega, spin))
    return linear, add(cross(omega, cross(axis, spin)), cross(axis, spun))


@inner
def _acceleration_change_with_rate(chain: Chain, k: int, walk: FloatArray) -> tuple[Vector, Vector]:
    """Derivative of the TCP's acceleration with respect to the rate of joint k."""
    axis, omega = recall(walk, k, AXIS), recall(walk, k, OMEGA)
    linear, angular = _velocity_change(chain, k, walk)
    if chain.prismatic[k]:
        return scale(2.0, linear), ZERO
    return scale(2.0, linear), add(angular, cross(omega, axis))


@njit(cache=True, error_model="numpy")
def acceleration_gradient(
    chain: Chain,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    w: FloatArray,
    grad_q: FloatArray,
    grad_dq: FloatArray,
) -> None:
    """Add the gradients of w · a, a = J q̈ + J̇ q̇, with respect to q and q̇.

    The gradient with respect to q̈ is Jᵀ w.

    Args:
        chain: K joints.
        q, dq, ddq: (N,).
        w: (6,).
        grad_q, grad_dq: (N,), added to.
    """
    walk = np.empty((chain.joint.size + 1, COLUMNS, 3))
    walk_motion(chain, q, dq, ddq, walk)
    pull_acceleration(chain, walk, w, grad_q, grad_dq)


@inner
def pull_rates(chain: Chain, walk: FloatArray, w: FloatArray, grad_dq: FloatArray) -> None:
    """Add the gradient of w · (J q̇), w (6,), with respect to q̇: Jᵀ w, by the axes of a walk."""
    force, torque, last = (w[0], w[1], w[2]), (w[3], w[4], w[5]), walk.shape[0] - 1
    for k in range(last):
        axis = recall(walk, k, AXIS)
        if chain.prismatic[k]:
            grad_dq[chain.joint[k]] += dot(force, axis)
            continue
        r = subtract(recall(walk, last, ORIGIN), recall(walk, k, ORIGIN))
        grad_dq[chain.joint[k]] += dot(force, cross(axis, r)) + dot(torque, axis)


@inner
def pull_acceleration(
    chain: Chain, walk: FloatArray, w: FloatArray, grad_q: FloatArray, grad_dq: FloatArray
) -> None:
    """Add the gradients of w · (acceleration at the end of a walk) with respect to q and q̇."""
    force, torque = (w[0], w[1], w[2]), (w[3], w[4], w[5])
    for k in range(walk.shape[0] - 1):
        linear, angular = _acceleration_change(chain, k, walk)
        grad_q[chain.joint[k]] += dot(force, linear) + dot(torque, angular)
        linear, angular = _acceleration_change_with_rate(chain, k, walk)
        grad_dq[chain.joint[k]] += dot(force, linear) + dot(torque, angular)


def poses(chain: Chain, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rotations (M, 3, 3) and positions (M, 3) m of configurations (M, N)."""
    R, p = np.empty((q.shape[0], 3, 3)), np.empty((q.shape[0], 3))
    fill_poses(chain, q, R, p)
    return R, p


def fill_poses(chain: Chain, q: FloatArray, R: FloatArray, p: FloatArray) -> None:
    """Write what `poses` gives."""
    _fill_poses(chain, q, R, p, _NO_QUATERNIONS)


def fill_quaternions(chain: Chain, q: FloatArray, quaternions: FloatArray, p: FloatArray) -> None:
    """Write orientations (M, 4), as quaternions, and positions (M, 3) m of configurations."""
    _fill_poses(chain, q, np.empty((1, 3, 3)), p, quaternions)


@lean
def _fill_poses(
    chain: Chain, q: FloatArray, R: FloatArray, p: FloatArray, quaternions: FloatArray
) -> None:
    """Rotations and quaternions are written where there is room for them."""
    for m in range(q.shape[0]):
        rotation = R[m if m < R.shape[0] else 0]
        pose(chain, q[m], rotation, p[m])
        if m < quaternions.shape[0]:
            write_quaternion(rotation, quaternions[m])


@njit(cache=True, error_model="numpy")
def jacobians(chain: Chain, q: FloatArray) -> FloatArray:
    """Jacobians (M, 6, N) of configurations (M, N)."""
    J = np.empty((q.shape[0], 6, q.shape[1]))
    _fill_jacobians(chain, q, np.empty((3, 3)), np.empty(3), J)
    return J


@inner
def _fill_jacobians(
    chain: Chain, q: FloatArray, R: FloatArray, p: FloatArray, J: FloatArray
) -> None:
    for m in range(q.shape[0]):
        jacobian(chain, q[m], R, p, J[m])


@njit(cache=True, error_model="numpy")
def motions(
    chain: Chain, q: FloatArray, dq: FloatArray, ddq: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Velocities (M, 6) and accelerations (M, 6) of motions given by (M, N) arrays."""
    v, a = np.empty((q.shape[0], 6)), np.empty((q.shape[0], 6))
    _fill_motions(chain, q, dq, ddq, v, a)
    return v, a


@inner
def _fill_motions(
    chain: Chain, q: FloatArray, dq: FloatArray, ddq: FloatArray, v: FloatArray, a: FloatArray
) -> None:
    for m in range(q.shape[0]):
        motion(chain, q[m], dq[m], ddq[m], v[m], a[m])
