"""Time stamping beside toppra and copp-py: CPU time, duration, violation between the knots.

    python benchmarks/stamping.py [--json] [--case lines-1000]

All solve the same discretised problem (same knots, joint speed and acceleration limits) in one
process.

- ``cpu_ratio``: the peer's CPU time over ours, from q' and q'' at the knots in each one's own
  layout to the stamp, limits included (toppra: its solve alone); ``peer_value`` in µs an interval.
- ``whole_ratio``: the same with the sampling of the path.
- ``duration_gap_percent``: our duration against the peer's, negative where ours is shorter;
  ``peer_value`` in s.
- ``max_violation_percent``: the worst excess over a joint limit at 20 points of each interval,
  with the exact q' and q'' of the path there.

The peers: pip install flyby[benchmarks]
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.metadata import version
from types import SimpleNamespace

import copp_py
import numpy as np
import toppra
from report import Figure, cpu_seconds, main
from scipy.interpolate import CubicSpline
from toppra.algorithm import TOPPRA
from toppra.constraint import (
    DiscretizationType,
    JointAccelerationConstraint,
    JointVelocityConstraint,
)
from toppra.interpolator import AbstractGeometricPath

from flyby.core.arrays import FloatArray
from flyby.core.motion.gradients.stamping_adjoint import stamp_adjoint
from flyby.core.motion.timing.stamping import Stamp, joint_limits, stamp

TOPPRA_NAME, COPP_NAME = f"toppra {version('toppra')}", f"copp-py {version('copp-py')}"
JOINTS = 6
# UR10e-like joint speeds (rad/s) and accelerations (rad/s²).
VELOCITY = np.array([2.1, 2.1, 3.1, 3.1, 3.1, 3.1])
ACCELERATION = np.array([4.0, 4.0, 6.0, 10.0, 10.0, 10.0])


@dataclass(frozen=True)
class Curve:
    """q(σ) with its first two derivatives; each takes (n,) and gives (n, JOINTS)."""

    end: float
    derivatives: tuple[Callable[[FloatArray], FloatArray], ...]

    def __call__(self, sigma: FloatArray, order: int = 0) -> FloatArray:
        return self.derivatives[order](sigma)


def blended_lines(legs: int = 8, blend: float = 0.5) -> Curve:
    """A chain of joint lines of unit length in σ, blended with continuous q''.

    Within ``blend`` / 2 of a corner, q' turns from one leg's to the next one's by 3τ² - 2τ³.
    """
    legs_rate = np.random.default_rng(7).uniform(-1.0, 1.0, (legs, JOINTS))
    turns = np.diff(legs_rate, axis=0)
    corners = np.arange(1, legs)

    def tau(sigma: FloatArray) -> FloatArray:
        return np.clip((sigma[:, None] - corners) / blend + 0.5, 0.0, 1.0)

    def position(sigma: FloatArray) -> FloatArray:
        s = tau(sigma)
        after = np.maximum(sigma[:, None] - corners - blend / 2.0, 0.0)
        return sigma[:, None] * legs_rate[0] + (blend * (s**3 - s**4 / 2.0) + after) @ turns

    def rate(sigma: FloatArray) -> FloatArray:
        s = tau(sigma)
        return legs_rate[0] + (3.0 * s**2 - 2.0 * s**3) @ turns

    def bend(sigma: FloatArray) -> FloatArray:
        s = tau(sigma)
        return (6.0 * s * (1.0 - s) / blend) @ turns

    return Curve(float(legs), (position, rate, bend))


def spline() -> Curve:
    """A cubic spline through eight random configurations."""
    waypoints = np.random.default_rng(3).uniform(-1.5, 1.5, (8, JOINTS))
    curve = CubicSpline(np.linspace(0.0, 1.0, 8), waypoints)
    return Curve(1.0, (curve, curve.derivative(1), curve.derivative(2)))


def circle() -> Curve:
    """Once round an ellipse in joint space."""
    rng = np.random.default_rng(5)
    across, along = rng.uniform(-1.0, 1.0, (2, JOINTS))

    def turned(order: int) -> Callable[[FloatArray], FloatArray]:
        def value(sigma: FloatArray) -> FloatArray:
            angle = sigma[:, None] + order * np.pi / 2.0
            return across * np.cos(angle) + along * np.sin(angle)

        return value

    return Curve(2.0 * np.pi, (turned(0), turned(1), turned(2)))


CASES: dict[str, tuple[Callable[[], Curve], int]] = {
    "lines-100": (blended_lines, 100),
    "lines-1000": (blended_lines, 1000),
    "lines-10000": (blended_lines, 10000),
    "spline-1000": (spline, 1000),
    "circle-1000": (circle, 1000),
}


def both_ends(samples: FloatArray) -> FloatArray:
    """Values at the knots (K + 1, N) as values at the ends of the intervals (K, 2, N)."""
    return np.stack([samples[:-1], samples[1:]], axis=1)


def stamped(spacing: FloatArray, rate: FloatArray, bend: FloatArray) -> Stamp:
    """Our stamp from q' and q'' at both ends of the intervals, (K, 2, N)."""
    return stamp(joint_limits(spacing, rate, bend, VELOCITY, -ACCELERATION, ACCELERATION))


def stamped_whole(curve: Curve, sigma: FloatArray) -> Stamp:
    """Our stamp from the path on."""
    return stamped(np.diff(sigma), both_ends(curve(sigma, 1)), both_ends(curve(sigma, 2)))


class ToppraPath(AbstractGeometricPath):  # type: ignore[misc]
    """A curve as toppra wants it."""

    def __init__(self, curve: Curve) -> None:
        self.curve = curve

    def __call__(self, path_positions: FloatArray, order: int = 0) -> FloatArray:
        return self.curve(np.atleast_1d(path_positions), order)

    @property
    def dof(self) -> int:
        return JOINTS

    @property
    def path_interval(self) -> FloatArray:
        return np.array([0.0, self.curve.end])

    @property
    def waypoints(self) -> None:
        return None


def toppra_instance(curve: Curve, sigma: FloatArray) -> TOPPRA:
    """toppra's solver for the same knots, rows at both ends of each interval."""
    velocity = JointVelocityConstraint(VELOCITY)
    acceleration = JointAccelerationConstraint(
        ACCELERATION, discretization_scheme=DiscretizationType.Interpolation
    )
    return TOPPRA(
        [velocity, acceleration], ToppraPath(curve), gridpoints=sigma, solver_wrapper="seidel"
    )


def toppra_duration(instance: TOPPRA, sigma: FloatArray) -> float:
    """Duration of toppra's answer, s; infinite if it has none."""
    _, speed, _ = instance.compute_parameterization(0.0, 0.0)
    if speed is None or np.any(np.isnan(speed)):
        return np.inf
    return float(np.sum(2.0 * np.diff(sigma) / (speed[:-1] + speed[1:])))


def copp_solve(
    sigma: FloatArray, position: FloatArray, rate: FloatArray, bend: FloatArray
) -> FloatArray:
    """copp-py's squared speeds at the knots, from limits and derivatives on."""
    robot = copp_py.Robot(JOINTS, capacity=len(sigma))
    robot.append_s(sigma)
    robot.set_q(position, rate, bend, 0)
    robot.add_velocity_limits(VELOCITY, -VELOCITY, start_idx_s=0, length=len(sigma))
    robot.add_acceleration_limits(ACCELERATION, -ACCELERATION, start_idx_s=0, length=len(sigma))
    problem = copp_py.solver.topp2_ra.Problem(
        robot.constraints, idx_s_interval=(0, len(sigma) - 1), a_boundary=(0.0, 0.0)
    )
    return copp_py.solver.topp2_ra.solve(problem)


def violation_percent(curve: Curve, sigma: FloatArray, result: Stamp) -> float:
    """Worst excess over a joint speed or acceleration at 20 points of each interval."""
    inside = np.linspace(0.0, 1.0, 20)
    points = sigma[:-1, None] + inside * np.diff(sigma)[:, None]
    x = result.x[:-1, None] + inside * np.diff(result.x)[:, None]
    u = np.repeat(result.u, len(inside))[:, None]
    rate, bend = curve(points.ravel(), 1), curve(points.ravel(), 2)
    speed = np.abs(rate) * np.sqrt(x.reshape(-1, 1)) / VELOCITY
    acceleration = np.abs(rate * u + bend * x.reshape(-1, 1)) / ACCELERATION
    return 100.0 * max(0.0, float(speed.max()) - 1.0, float(acceleration.max()) - 1.0)


def measure(case: str) -> Iterator[Figure]:
    """All figures of one case."""
    make, count = CASES[case]
    curve = make()
    sigma = np.linspace(0.0, curve.end, count + 1)
    position, rate, bend = (curve(sigma, order) for order in range(3))
    instance = toppra_instance(curve, sigma)
    inputs = np.diff(sigma), both_ends(rate), both_ends(bend)
    result = stamped(*inputs)
    seed = np.zeros(count + 1)
    seed[-1] = 1.0
    seconds = SimpleNamespace(
        **cpu_seconds(
            {
                "ours": lambda: stamped(*inputs),
                "ours_whole": lambda: stamped_whole(curve, sigma),
                "sweeps": lambda: stamp(result.limits),
                "adjoint": lambda: stamp_adjoint(result, t_bar=seed),
                "toppra": lambda: instance.compute_parameterization(0.0, 0.0),
                "toppra_whole": lambda: toppra_duration(toppra_instance(curve, sigma), sigma),
                "copp": lambda: copp_solve(sigma, position, rate, bend),
            }
        )
    )
    per = 1e6 / count
    yield Figure(case, "cpu_per_interval", seconds.ours * per, "µs")
    yield Figure(case, "sweeps_per_interval", seconds.sweeps * per, "µs")
    yield Figure(case, "adjoint_per_interval", seconds.adjoint * per, "µs")
    for figure, peer, theirs, ours in (
        ("cpu_ratio", TOPPRA_NAME, seconds.toppra, seconds.ours),
        ("whole_ratio", TOPPRA_NAME, seconds.toppra_whole, seconds.ours_whole),
        ("cpu_ratio", COPP_NAME, seconds.copp, seconds.ours),
    ):
        yield Figure(case, figure, theirs / ours, "", peer, theirs * per)
    squared = copp_solve(sigma, position, rate, bend)
    for peer, duration in (
        (TOPPRA_NAME, toppra_duration(instance, sigma)),
        (COPP_NAME, float(copp_py.interpolation.s_to_t_topp2(sigma, squared, 0.0)[0])),
    ):
        gap = 100.0 * (result.duration / duration - 1.0)
        yield Figure(case, "duration_gap_percent", gap, "%", peer, duration)
    yield Figure(case, "max_violation_percent", violation_percent(curve, sigma, result), "%")


if __name__ == "__main__":
    toppra.setup_logging("ERROR")
    main(__doc__ or "", measure, CASES)
