"""Rotations that change with σ: R = R_ref exp(A) exp(B), their angular velocity, in reverse too.

A and B are rotation vectors with two derivatives. A line of orientations needs B alone; A is the
turn of an arc about its axis. The exponential is taken through the quaternion
h = (cos(|φ|/2), k(n) φ), n = |φ|², whose scalar k is an entire function of n, so that no small
angle is special; ω = 2 vec(h' h*), ω' = 2 vec(h'' h*).
"""

from __future__ import annotations

import math

import numpy as np

from ...arrays import FloatArray
from ...robot.kinematics.lean import inner, lean
from ...robot.kinematics.vectors import Vector, add, cross, dot, load, scale, turn

_TERMS = 11
_SERIES = np.array(
    [(-1.0) ** i / (2.0 ** (2 * i + 1) * math.factorial(2 * i + 1)) for i in range(_TERMS)]
)


@inner
def _half_sine(n: float) -> tuple[float, float, float, float]:
    """k(n) = sin(√n/2)/√n and its first three derivatives."""
    k0 = k1 = k2 = k3 = 0.0
    for i in range(_TERMS - 1, -1, -1):
        k3 = k3 * n + 3 * k2
        k2 = k2 * n + 2 * k1
        k1 = k1 * n + k0
        k0 = k0 * n + _SERIES[i]
    return k0, k1, k2, k3


@inner
def _quaternion_jet(
    phi: FloatArray,
) -> tuple[float, float, float, Vector, Vector, Vector]:
    """Scalar and vector parts of h, h', h'' for φ, φ', φ'' given as (3, 3)."""
    f0, f1, f2 = load(phi[0]), load(phi[1]), load(phi[2])
    n0, n1 = dot(f0, f0), 2 * dot(f0, f1)
    n2 = 2 * (dot(f1, f1) + dot(f0, f2))
    k0, k1, k2, _ = _half_sine(n0)
    c0 = math.cos(0.5 * math.sqrt(n0))
    c1 = -0.25 * k0 * n1
    c2 = -0.25 * (k1 * n1 * n1 + k0 * n2)
    v0 = scale(k0, f0)
    v1 = add(scale(k1 * n1, f0), scale(k0, f1))
    v2 = add(scale(k2 * n1 * n1 + k1 * n2, f0), add(scale(2 * k1 * n1, f1), scale(k0, f2)))
    return c0, c1, c2, v0, v1, v2


@inner
def _rate(c0: float, v0: Vector, c1: float, v1: Vector) -> Vector:
    """2 vec(h₁ h₀*)."""
    rate: Vector = scale(2.0, add(add(scale(c0, v1), scale(-c1, v0)), cross(v0, v1)))
    return rate


@inner
def exponential(phi: FloatArray, R: FloatArray) -> tuple[Vector, Vector]:
    """Write R = exp(φ) (3, 3) and return ω and ω' for φ, φ', φ'' given as (3, 3)."""
    c0, c1, c2, v0, v1, v2 = _quaternion_jet(phi)
    x, y, z = v0
    R[0, 0], R[0, 1], R[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - c0 * z), 2 * (x * z + c0 * y)
    R[1, 0], R[1, 1], R[1, 2] = 2 * (x * y + c0 * z), 1 - 2 * (x * x + z * z), 2 * (y * z - c0 * x)
    R[2, 0], R[2, 1], R[2, 2] = 2 * (x * z - c0 * y), 2 * (y * z + c0 * x), 1 - 2 * (x * x + y * y)
    return _rate(c0, v0, c1, v1), _rate(c0, v0, c2, v2)


@inner
def _pull_rate(
    c0: float, v0: Vector, c1: float, v1: Vector, bar: Vector
) -> tuple[float, Vector, float, Vector]:
    """Reverse of `_rate`: gradients of c0, v0, c1, v1."""
    twice = scale(2.0, bar)
    v0_bar = add(scale(-c1, twice), cross(v1, twice))
    v1_bar = add(scale(c0, twice), cross(twice, v0))
    return dot(v1, twice), v0_bar, -dot(v0, twice), v1_bar


@inner
def pull_exponential(
    phi: FloatArray, theta_bar: Vector, omega_bar: Vector, alpha_bar: Vector, phi_bar: FloatArray
) -> None:
    """Reverse of `exponential`: add to the gradient (3, 3) of φ, φ', φ''.

    ``theta_bar`` is the gradient with respect to a small turn of R from the left.
    """
    c0, c1, c2, v0, v1, v2 = _quaternion_jet(phi)
    # δθ = 2 vec(δh h*): the rate's formula with δh in place of h'.
    _, _, c0_bar, v0_bar = _pull_rate(c0, v0, 0.0, (0.0, 0.0, 0.0), theta_bar)
    p, pv, c1_bar, v1_bar = _pull_rate(c0, v0, c1, v1, omega_bar)
    r, rv, c2_bar, v2_bar = _pull_rate(c0, v0, c2, v2, alpha_bar)
    c0_bar += p + r
    v0_bar = add(v0_bar, add(pv, rv))

    f0, f1, f2 = load(phi[0]), load(phi[1]), load(phi[2])
    n0, n1 = dot(f0, f0), 2 * dot(f0, f1)
    n2 = 2 * (dot(f1, f1) + dot(f0, f2))
    k0, k1, k2, k3 = _half_sine(n0)
    a = dot(v0_bar, f0) - 0.25 * (n1 * c1_bar + n2 * c2_bar)  # gradient of k0
    a += dot(v1_bar, f1) + dot(v2_bar, f2)
    b = n1 * dot(v1_bar, f0) + n2 * dot(v2_bar, f0) + 2 * n1 * dot(v2_bar, f1)  # of k1
    b -= 0.25 * n1 * n1 * c2_bar
    c = n1 * n1 * dot(v2_bar, f0)  # of k2
    n0_bar = k1 * a + k2 * b + k3 * c - 0.25 * k0 * c0_bar
    n1_bar = k1 * dot(v1_bar, f0) + 2 * k2 * n1 * dot(v2_bar, f0) + 2 * k1 * dot(v2_bar, f1)
    n1_bar += -0.25 * k0 * c1_bar - 0.5 * k1 * n1 * c2_bar
    n2_bar = k1 * dot(v2_bar, f0) - 0.25 * k0 * c2_bar

    g0 = add(scale(k0, v0_bar), scale(k1 * n1, v1_bar))
    g0 = add(g0, scale(k2 * n1 * n1 + k1 * n2, v2_bar))
    g0 = add(g0, add(scale(2 * n0_bar, f0), add(scale(2 * n1_bar, f1), scale(2 * n2_bar, f2))))
    g1 = add(scale(k0, v1_bar), scale(2 * k1 * n1, v2_bar))
    g1 = add(g1, add(scale(2 * n1_bar, f0), scale(4 * n2_bar, f1)))
    g2 = add(scale(k0, v2_bar), scale(2 * n2_bar, f0))
    for i in range(3):
        phi_bar[0, i] += g0[i]
        phi_bar[1, i] += g1[i]
        phi_bar[2, i] += g2[i]


@inner
def _matrix(R: FloatArray, v: Vector) -> Vector:
    turned: Vector = turn(
        (R[0, 0], R[0, 1], R[0, 2], R[1, 0], R[1, 1], R[1, 2], R[2, 0], R[2, 1], R[2, 2]), v
    )
    return turned


@inner
def _transposed(R: FloatArray, v: Vector) -> Vector:
    turned: Vector = turn(
        (R[0, 0], R[1, 0], R[2, 0], R[0, 1], R[1, 1], R[2, 1], R[0, 2], R[1, 2], R[2, 2]), v
    )
    return turned


@inner
def _still(vectors: FloatArray) -> bool:
    """Whether A and its derivatives are zero, as on all segments but arcs."""
    for i in range(3):
        for j in range(3):
            if vectors[i, j] != 0.0:
                return False
    return True


@lean
def orientation(
    reference: FloatArray, vectors: FloatArray, scratch: FloatArray, R: FloatArray
) -> tuple[Vector, Vector]:
    """Write R (3, 3) = R_ref exp(A) exp(B) and return ω and ω' in the outer frame.

    Args:
        reference: (3, 3), R_ref.
        vectors: (3, 6), A and B with their first and second derivatives below.
        scratch: (3, 3, 3).
        R: (3, 3), written.
    """
    R1, R2, product = scratch[0], scratch[1], scratch[2]
    if _still(vectors):
        omega2, alpha2 = exponential(vectors[:, 3:], R2)
        for i in range(3):
            for j in range(3):
                R[i, j] = (
                    reference[i, 0] * R2[0, j]
                    + reference[i, 1] * R2[1, j]
                    + reference[i, 2] * R2[2, j]
                )
        return _matrix(reference, omega2), _matrix(reference, alpha2)
    omega1, alpha1 = exponential(vectors[:, :3], R1)
    omega2, alpha2 = exponential(vectors[:, 3:], R2)
    y = _matrix(R1, omega2)
    omega = add(omega1, y)
    alpha = add(add(alpha1, cross(omega1, y)), _matrix(R1, alpha2))
    for i in range(3):
        for j in range(3):
            product[i, j] = R1[i, 0] * R2[0, j] + R1[i, 1] * R2[1, j] + R1[i, 2] * R2[2, j]
    for i in range(3):
        for j in range(3):
            R[i, j] = (
                reference[i, 0] * product[0, j]
                + reference[i, 1] * product[1, j]
                + reference[i, 2] * product[2, j]
            )
    return _matrix(reference, omega), _matrix(reference, alpha)


@lean
def pull_orientation(
    reference: FloatArray,
    vectors: FloatArray,
    theta_bar: Vector,
    omega_bar: Vector,
    alpha_bar: Vector,
    scratch: FloatArray,
    vectors_bar: FloatArray,
) -> Vector:
    """Reverse of `orientation`: add to (3, 6) and return the gradient of a left turn of R_ref.

    ``theta_bar`` is the gradient with respect to a small turn of R from the left.
    """
    R1, R2 = scratch[0], scratch[1]
    omega1, alpha1 = exponential(vectors[:, :3], R1)
    omega2, alpha2 = exponential(vectors[:, 3:], R2)
    y, z = _matrix(R1, omega2), _matrix(R1, alpha2)
    theta, omega, alpha = (
        _transposed(reference, theta_bar),
        _transposed(reference, omega_bar),
        _transposed(reference, alpha_bar),
    )
    whole_omega = add(omega1, y)
    whole_alpha = add(add(alpha1, cross(omega1, y)), z)
    reference_bar = add(theta, add(cross(whole_omega, omega), cross(whole_alpha, alpha)))

    y_bar = add(omega, cross(alpha, omega1))
    omega1_bar = add(omega, cross(y, alpha))
    theta1_bar = add(theta, add(cross(y, y_bar), cross(z, alpha)))
    pull_exponential(vectors[:, :3], theta1_bar, omega1_bar, alpha, vectors_bar[:, :3])
    pull_exponential(
        vectors[:, 3:],
        _transposed(R1, theta),
        _transposed(R1, y_bar),
        _transposed(R1, alpha),
        vectors_bar[:, 3:],
    )
    turned: Vector = _matrix(reference, reference_bar)
    return turned
