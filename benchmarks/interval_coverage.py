"""How often confidence intervals of a fit hold the truth: logs are made of a model that is known,
with other noise each time, fitted, and the intervals counted.

    python benchmarks/interval_coverage.py [--json] [--draws 100]

``white`` has noise and jitter that differ from sample to sample; ``coloured`` has noise that is
alike for 40 ms (an autoregressive process), which plain least squares would take for many more
samples than it is worth; ``faulty`` adds torn samples and a hole of 0.14 s. ``coverage`` is the
share of intervals that hold the truth (target 0.95), per parameter, with the number of draws as
peer value; ``naive`` is what intervals from the curvature alone (residuals independent and of one
size) would give.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace

import numpy as np
from report import Figure, main

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.blend import Blend
from flyby.core.motion.model.elasticity import Elasticity
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.identification.fit import ParameterSet, prepare
from flyby.identification.fit.intervals import clusters_of, intervals
from flyby.identification.fit.loss import influence
from flyby.identification.fit.minimum import minimise
from flyby.identification.fit.problem import Problem, first_nuisances
from flyby.identification.fit.run_pool import RunPool
from flyby.identification.logs.synthetic import Faults, synthetic_run

VENDOR, ROBOT = find_vendor("abb"), find_robot("abb/irb6640-180-255")
HOME = np.array([0.3, 0.3, 0.4, 0.6, -0.5, -0.5])
TRUTH = replace(
    MotionModel(),
    tcp=Blend(beta=(-0.5,)),
    smoothing=(0.04, 0.04),
    elasticity=Elasticity((5e-5, 1.2e-4)),
    joint_acceleration_scale=(1.3, 1.0),
)
TRUE = {
    "blend.tcp.beta[0]": -0.5,
    "time.smoothing_s[*]": 0.04,
    "elasticity.own_s2[1]": 1.2e-4,
    "limit.joint_acceleration_scale[0]": 1.3,
}
CASES = {
    "white": Faults(period=0.008, noise=3e-5, jitter=2e-4, stamp=2e-4),
    "coloured": Faults(period=0.008, noise=3e-5, jitter=2e-4),
    "faulty": Faults(period=0.008, noise=3e-5, jitter=2e-4, stamp=2e-4, torn=4, hole=0.14),
}
ALIKE = 0.04
"""s, time constant of coloured noise."""
RUNS = ((0.03, 0.5), (0.08, 0.25), (0.05, 0.8), (0.02, 0.4), (0.04, 1.2))
QUANTILE = 1.96


def program(radius: float, speed: float) -> Program:
    """A line with a corner, and back to the start in joints."""
    at = ROBOT.flange_pose(HOME)

    def there(*offset: float) -> PoseTarget:
        return PoseTarget(Pose(tuple(np.array(at.position) + offset), at.quaternion))

    told = Speed(tcp=speed, reorientation=2.0)
    moves = (
        MoveL(there(0.0, -0.25, 0.0), told, Radius(radius, radius, radius, 0.05)),
        MoveL(there(0.2, -0.35, 0.1), told, FINE),
        MoveJ(JointTarget(tuple(HOME)), told, FINE),
    )
    return Program(moves, start=JointTarget(tuple(HOME)))


def draw(case: str, seed: int) -> tuple[list[bool], list[bool]]:
    """Which intervals of one draw hold the truth: ours, and those from the curvature alone."""
    controller = Controller(VENDOR, ROBOT, TRUTH)
    runs = []
    for k, (radius, speed) in enumerate(RUNS):
        made = synthetic_run(
            controller, program(radius, speed), f"r{k}", CASES[case], 1000 * seed + k
        )
        if case == "coloured":
            rng = np.random.default_rng(10**6 + 1000 * seed + k)
            made = replace(made, q=made.q + coloured(made.q.shape, CASES[case], rng))
        runs.append(prepare(made, VENDOR, ROBOT, TRUTH))
    parameters = ParameterSet.named(TRUTH, TRUE)
    with RunPool(runs) as pool:
        end = minimise(pool, parameters, first_nuisances(runs))
        linearised = Problem(pool, end.variables).linearised(end.x)
    samples = sum(rows.values.size for rows, _ in linearised)
    known = intervals(parameters, end.values, clusters_of(runs, linearised), samples)
    ours = [one.lower <= TRUE[one.name] <= one.upper for one in known]
    A = sum(c.curvature for c in clusters_of(runs, linearised))
    spread = np.concatenate([influence(rows.values).ravel() for rows, _ in linearised]).std()
    deviation = parameters.scale * spread * np.sqrt(np.diag(np.linalg.inv(A))[: parameters.size])
    naive = [
        abs(one.value - TRUE[one.name]) <= QUANTILE * d
        for one, d in zip(known, deviation, strict=True)
    ]
    return ours, naive


def coloured(shape: tuple[int, int], faults: Faults, rng: np.random.Generator) -> np.ndarray:
    """(T, N), noise that forgets within `ALIKE`."""
    keep = float(np.exp(-faults.period / ALIKE))
    out = np.empty(shape)
    out[0] = rng.normal(size=shape[1])
    for k in range(1, shape[0]):
        out[k] = keep * out[k - 1] + np.sqrt(1 - keep**2) * rng.normal(size=shape[1])
    return faults.noise * out


def measure(case: str, draws: int) -> Iterator[Figure]:
    """Shares of one kind of noise."""
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(draw, [case] * draws, range(draws)))
    ours, naive = (np.array([pair[k] for pair in found]) for k in (0, 1))
    for k, name in enumerate(TRUE):
        yield Figure(case, f"coverage {name}", float(ours[:, k].mean()), "", "draws", draws)
    yield Figure(case, "coverage", float(ours.mean()), "", "target", 0.95)
    yield Figure(case, "naive", float(naive.mean()), "", "target", 0.95)


if __name__ == "__main__":
    main(__doc__ or "", measure, CASES, draws=100)
