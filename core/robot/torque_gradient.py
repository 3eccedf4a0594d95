"""Compiled reverse of inverse dynamics: gradients of what torques weigh together.

Weights w on the torques of a tree of joints are rates that do power: where bodies move at ν (their
centres) and Ω with the joints' rates at w,

    wᵀ τ = Σ_bodies m p̈ · ν + (I ω' + ω × I ω) · Ω,

p̈ with gravity taken off. So this needs no matrix of derivatives. It is differentiated from the
tips of the tree to its base: every frame hands on how the power of what it carries changes with its
own motion (ω, ω', p̈, Ω, V). Turning a joint turns all that it carries against that motion, which
is turned back in its stead: ∂/∂q = −Σ_X (s × X) · X̄ over the motion X of the frame before a joint
with the axis s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from .kinematics.chain import Chain
from .kinematics.chain_kernels import carry, place, turned_by
from .kinematics.lean import inner, lean
from .kinematics.vectors import (
    UNTURNED,
    ZERO,
    Rotation,
    Vector,
    add,
    cross,
    dot,
    load,
    load_row,
    scale,
    subtract,
    turn,
)

OMEGA, ALPHA, RISE, SPIN, SPEED, ORIGIN, AXIS, ROWS = 0, 1, 2, 3, 4, 5, 6, 7
"""Of a frame: ω, ω', p̈ less gravity, Ω, the velocity at rates w, its origin; of a joint: s."""


class TreeBodies(NamedTuple):
    """K joints, each after its parent, with a body behind each.

    Args:
        joints: their placements and axes, as if each stood on the one before.
        parent: (K,), the joint that each stands on, -1 for the world.
        mass: (K,) kg.
        centre: (K, 3) m, in the frame behind the joint.
        tensor: (K, 3, 3) kg m², about the centre in that frame's axes.
    """

    joints: Chain
    parent: IntArray
    mass: FloatArray
    centre: FloatArray
    tensor: FloatArray


class _Scratch(NamedTuple):
    """Frames (K, 9) behind the joints; motion before and behind them, and its gradient."""

    turned: FloatArray
    before: FloatArray
    behind: FloatArray
    bar: FloatArray


def pull_torques(
    bodies: TreeBodies,
    gravity: FloatArray,
    states: tuple[FloatArray, FloatArray, FloatArray],
    weight: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Gradients (M, N) of Σ_j weight_j τ_j of M motions with respect to q, q̇ and q̈.

    Args:
        bodies: the tree.
        gravity: (3,) m/s², in the world.
        states: q, q̇ and q̈, (M, N) each.
        weight: (M, N), of the torques.
    """
    own = [np.ascontiguousarray(array) for array in (*states, weight)]
    out = [np.zeros_like(own[0]) for _ in range(3)]
    count = len(bodies.parent)
    moved = (np.empty((count, ROWS, 3)) for _ in range(3))
    _pull(bodies, gravity, *own, *out, _Scratch(np.empty((count, 9)), *moved))
    return out[0], out[1], out[2]


@inner
def _store(rows: FloatArray, k: int, row: int, value: Vector) -> None:
    rows[k, row, 0], rows[k, row, 1], rows[k, row, 2] = value


@inner
def _recall(rows: FloatArray, k: int, row: int) -> Vector:
    return rows[k, row, 0], rows[k, row, 1], rows[k, row, 2]


@inner
def _add(rows: FloatArray, k: int, row: int, value: Vector) -> None:
    for i in range(3):
        rows[k, row, i] += value[i]


@inner
def _turned(work: _Scratch, k: int) -> Rotation:
    row = work.turned[k]
    return row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7], row[8]


@inner
def _through(rotation: Rotation, tensor: FloatArray, a: Vector) -> Vector:
    """I a for an inertia given in a turned frame."""
    r = rotation
    x = r[0] * a[0] + r[3] * a[1] + r[6] * a[2]
    y = r[1] * a[0] + r[4] * a[1] + r[7] * a[2]
    z = r[2] * a[0] + r[5] * a[1] + r[8] * a[2]
    own = (
        tensor[0, 0] * x + tensor[0, 1] * y + tensor[0, 2] * z,
        tensor[1, 0] * x + tensor[1, 1] * y + tensor[1, 2] * z,
        tensor[2, 0] * x + tensor[2, 1] * y + tensor[2, 2] * z,
    )
    made: Vector = turn(r, own)
    return made


@inner
def _carry_back(omega: Vector, step: Vector, rise_bar: Vector) -> Vector:
    """Gradient with respect to ω of ω × (ω × step), by that of the acceleration."""
    made: Vector = add(cross(cross(omega, step), rise_bar), cross(step, cross(rise_bar, omega)))
    return made


@inner
def _move(
    bodies: TreeBodies,
    gravity: FloatArray,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    weight: FloatArray,
    work: _Scratch,
) -> None:
    """Write the motion before and behind every joint, base first."""
    chain, before, behind = bodies.joints, work.before, work.behind
    for k in range(bodies.parent.size):
        p, j = bodies.parent[k], chain.joint[k]
        turned, at = UNTURNED, ZERO
        omega, alpha, rise = ZERO, ZERO, scale(-1.0, load(gravity))
        spin, speed = ZERO, ZERO
        if p >= 0:
            turned, at = _turned(work, p), _recall(behind, p, ORIGIN)
            omega, alpha = _recall(behind, p, OMEGA), _recall(behind, p, ALPHA)
            rise = _recall(behind, p, RISE)
            spin, speed = _recall(behind, p, SPIN), _recall(behind, p, SPEED)
        turned, step, axis = place(chain, k, turned)
        at, rise = add(at, step), add(rise, carry(omega, alpha, step)[1])
        speed = add(speed, cross(spin, step))
        for row, value in (
            (OMEGA, omega),
            (ALPHA, alpha),
            (RISE, rise),
            (SPIN, spin),
            (SPEED, speed),
            (ORIGIN, at),
            (AXIS, axis),
        ):
            _store(before, k, row, value)
        rate, own = scale(dq[j], axis), scale(weight[j], axis)
        if chain.prismatic[k]:
            slide = scale(q[j], axis)
            rise = add(rise, add(carry(omega, alpha, slide)[1], scale(2.0, cross(omega, rate))))
            rise = add(rise, scale(ddq[j], axis))
            at, speed = add(at, slide), add(speed, add(cross(spin, slide), own))
        else:
            turned = turned_by(chain, k, q[j], turned)
            alpha = add(alpha, add(scale(ddq[j], axis), cross(omega, rate)))
            omega, spin = add(omega, rate), add(spin, own)
        for row, value in (
            (OMEGA, omega),
            (ALPHA, alpha),
            (RISE, rise),
            (SPIN, spin),
            (SPEED, speed),
            (ORIGIN, at),
        ):
            _store(behind, k, row, value)
        for i in range(9):
            work.turned[k, i] = turned[i]


@inner
def _pull_body(bodies: TreeBodies, k: int, work: _Scratch) -> None:
    """Add how the power of a body changes with the motion of its frame."""
    rotation, tensor, mass = _turned(work, k), bodies.tensor[k], bodies.mass[k]
    r = turn(rotation, load_row(bodies.centre, k))
    omega, alpha = _recall(work.behind, k, OMEGA), _recall(work.behind, k, ALPHA)
    spin = _recall(work.behind, k, SPIN)
    rise = add(_recall(work.behind, k, RISE), carry(omega, alpha, r)[1])
    rise_bar = scale(mass, add(_recall(work.behind, k, SPEED), cross(spin, r)))
    force = scale(mass, rise)
    momentum = _through(rotation, tensor, omega)
    moment = add(_through(rotation, tensor, alpha), cross(omega, momentum))
    omega_bar = add(_carry_back(omega, r, rise_bar), cross(momentum, spin))
    omega_bar = add(omega_bar, _through(rotation, tensor, cross(spin, omega)))
    alpha_bar = add(cross(r, rise_bar), _through(rotation, tensor, spin))
    _add(work.bar, k, OMEGA, omega_bar)
    _add(work.bar, k, ALPHA, alpha_bar)
    _add(work.bar, k, RISE, rise_bar)
    _add(work.bar, k, SPIN, add(cross(r, force), moment))
    _add(work.bar, k, SPEED, force)


@lean
def _pull(
    bodies: TreeBodies,
    gravity: FloatArray,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    weight: FloatArray,
    q_bar: FloatArray,
    dq_bar: FloatArray,
    ddq_bar: FloatArray,
    work: _Scratch,
) -> None:
    chain, before, bar = bodies.joints, work.before, work.bar
    for m in range(q.shape[0]):
        _move(bodies, gravity, q[m], dq[m], ddq[m], weight[m], work)
        bar[:, :, :] = 0.0
        for k in range(bodies.parent.size - 1, -1, -1):
            _pull_body(bodies, k, work)
            j, p = chain.joint[k], bodies.parent[k]
            axis, omega = _recall(before, k, AXIS), _recall(before, k, OMEGA)
            alpha, rise = _recall(before, k, ALPHA), _recall(before, k, RISE)
            spin, speed = _recall(before, k, SPIN), _recall(before, k, SPEED)
            omega_bar, alpha_bar = _recall(bar, k, OMEGA), _recall(bar, k, ALPHA)
            rise_bar = _recall(bar, k, RISE)
            spin_bar, speed_bar = _recall(bar, k, SPIN), _recall(bar, k, SPEED)
            rate = scale(dq[m, j], axis)
            if chain.prismatic[k]:
                q_bar[m, j] += dot(carry(omega, alpha, axis)[1], rise_bar)
                q_bar[m, j] += dot(cross(spin, axis), speed_bar)
                dq_bar[m, j] += 2.0 * dot(cross(omega, axis), rise_bar)
                ddq_bar[m, j] += dot(axis, rise_bar)
                slide = scale(q[m, j], axis)
                omega_bar = add(omega_bar, _carry_back(omega, slide, rise_bar))
                omega_bar = add(omega_bar, scale(2.0, cross(rate, rise_bar)))
                alpha_bar = add(alpha_bar, cross(slide, rise_bar))
                spin_bar = add(spin_bar, cross(slide, speed_bar))
            else:
                dq_bar[m, j] += dot(axis, omega_bar) + dot(cross(omega, axis), alpha_bar)
                ddq_bar[m, j] += dot(axis, alpha_bar)
                omega_bar = add(omega_bar, cross(rate, alpha_bar))
                turning = add(cross(omega_bar, omega), cross(alpha_bar, alpha))
                turning = add(turning, add(cross(rise_bar, rise), cross(spin_bar, spin)))
                q_bar[m, j] += dot(axis, add(turning, cross(speed_bar, speed)))
            if p < 0:
                continue
            step = subtract(_recall(before, k, ORIGIN), _recall(work.behind, p, ORIGIN))
            _add(bar, p, OMEGA, add(omega_bar, _carry_back(omega, step, rise_bar)))
            _add(bar, p, ALPHA, add(alpha_bar, cross(step, rise_bar)))
            _add(bar, p, RISE, rise_bar)
            _add(bar, p, SPIN, add(spin_bar, cross(step, speed_bar)))
            _add(bar, p, SPEED, speed_bar)
