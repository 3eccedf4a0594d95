"""The solver beside IPOPT: CPU time, iterations, objective, violation.

    python benchmarks/sqp.py [--json] [--case double-integrator-400]
                             [--method auto|interior_point|sqp]
                             [--qp clarabel|osqp|piqp|interior_point]

Without ``--case``, those that take a few minutes together.

Both get the same problem, the same start, exact Hessians and the tolerance 1e-6, in one process,
with one thread; CPU times are medians of five solutions that take turns (of one, where it takes
more than 20 s), without the set-up of the callables (for casadi, the derivation of its functions).

There are two peers. ``ipopt`` runs on casadi's own functions, its best case; ``ipopt, same
callables`` on the very numpy callables that our solver gets, through IPOPT's C interface.

- ``objective``, ``violation`` (largest of a constraint or bound), ``iterations``, ``cpu_ms``: of
  one problem from one start; ``peer_value`` the peer's.
- ``callables_ms``, ``subproblems_ms``: how much of ours is spent in either, wall time.
- ``cpu_ratio``: ours over the peer's, of the same work; ``peer_value`` in ms. In ``warm-resolve``
  the median over problems nearby, each solved from the solution of the first; IPOPT with its
  multipliers, its warm start's options and the best of several barrier parameters for each problem,
  or from that point without them where this is faster.
- ``share_faster``: share of these that ours solves faster.
- ``equal_or_better``: share of starts from which our optimum is at most the peer's, to 1e-6.
- ``solved``: share of starts that end in success; ``best`` and ``worst`` the optima among them.

The peer: pip install flyby[benchmarks]
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import statistics
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import casadi_problems
import numpy as np
from banded import Banded
from casadi_peer import CasadiIpopt
from ipopt import Ipopt, IpoptResult, warm_options
from report import Figure, main

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP, BackendKind, Result, SolverMethod, solve
from flyby.validation.textbook import (
    CUBIC_START,
    GARDEN,
    MAZE,
    Avoidance,
    DoubleIntegrator,
    PointMass,
    Scene,
    cubic,
)
from flyby.validation.trajectories.cops import COPS
from flyby.validation.trajectories.mechanics import (
    MECHANICS,
    cart_pole,
    double_pendulum,
    two_link_arm,
)
from flyby.validation.trajectories.stated import StatedTrajectory

THREE_DISCS = Scene(
    start=(1.0, 1.0), goal=(9.0, 9.0), circles=((3.2, 2.6, 1.1), (5.2, 5.4, 1.2), (7.6, 7.0, 0.9))
)
PEER, SAME = "ipopt", "ipopt, same callables"
TOLERANCE = 1e-6
REPEATS = 5
STARTS = 16
PERTURBATIONS = 6
MU = (1e-2, 1e-4, 1e-6, 1e-8)
LONG = 20.0
"""Seconds of CPU time from which on a solution is measured once."""


@dataclass(frozen=True)
class Task:
    """A problem in both forms, and where to start."""

    nlp: NLP
    expressions: dict[str, Any]
    x0: FloatArray


def cubic_task() -> Task:
    """The cubic problem from (5, 5)."""
    return _task(cubic(), casadi_problems.cubic(), CUBIC_START)


def integrator_task(nodes: int, start: tuple[float, float] = (4.0, 1.0)) -> Task:
    """The thesis's double integrator."""
    problem = DoubleIntegrator(nodes, start=start)
    expressions = casadi_problems.double_integrator(problem)
    return _task(problem.nlp(), expressions, problem.initial_guess())


def mass_task(
    nodes: int,
    avoidance: Avoidance = Avoidance.SAMPLES,
    via: Sequence[tuple[float, float]] = (),
    scene: Scene = GARDEN,
) -> Task:
    """The point mass from the straight line, or from a line through other places."""
    problem = PointMass(scene, nodes, avoidance)
    guess = problem.through((scene.start, *via, scene.goal))
    return _task(problem.nlp(), casadi_problems.point_mass(problem), guess)


def banded_task(nodes: int, seed: int = 0, shift: float = 0.0) -> Task:
    """A random chain from zero."""
    problem = Banded(nodes, seed, shift)
    return _task(problem.nlp(), casadi_problems.banded(problem), np.zeros(problem.n))


def stated_task(stated: StatedTrajectory) -> Task:
    """A trajectory problem from its start."""
    return _task(stated.problem.nlp(), casadi_problems.separable(stated.problem), stated.start)


def _task(nlp: NLP, expressions: dict[str, Any], x0: FloatArray) -> Task:
    return Task(nlp, casadi_problems.checked(expressions, nlp, x0), x0)


SIZES = (40, 100, 200, 400, 1600, 10000)
SINGLE: dict[str, Callable[[], Task]] = {
    "cubic": cubic_task,
    **{f"double-integrator-{n}": lambda n=n: integrator_task(n) for n in SIZES},
    **{f"point-mass-{n}": lambda n=n: mass_task(n) for n in SIZES},
    **{
        f"point-mass-bernstein-{n}": lambda n=n: mass_task(n, Avoidance.BERNSTEIN)
        for n in (40, 100)
    },
    **{f"banded-{n}": lambda n=n: banded_task(n) for n in (40, 100, 400, 1600)},
    "three-discs-80": lambda: mass_task(80, scene=THREE_DISCS),
    "maze-100": lambda: mass_task(100, scene=MAZE),
    **{f"{k}-41": lambda k=k: stated_task(MECHANICS[k](41)) for k in MECHANICS},
    **{f"{k}-101": lambda k=k: stated_task(COPS[k](101)) for k in COPS},
}


# ------------------------------------------------------------------------- one problem


def measure_single(case: str, how: dict[str, str]) -> Iterator[Figure]:
    """Figures of one problem from one start."""
    task = SINGLE[case]()
    best, same = CasadiIpopt(task.nlp, task.expressions, TOLERANCE), _same_callables(task)
    ours, theirs, twin, seconds = _race(
        lambda: solve(task.nlp, task.x0, tolerance=TOLERANCE, **how),
        lambda: best.solve(task.x0),
        lambda: same.solve(task.x0),
    )
    for peer, result, spent in ((PEER, theirs, seconds[1]), (SAME, twin, seconds[2])):
        yield Figure(case, "objective", ours.objective, "", peer, result.objective)
        violation = _violation(task.nlp, result.x)
        yield Figure(case, "violation", ours.constraint_violation, "", peer, violation)
        yield Figure(case, "iterations", ours.iterations, "", peer, result.iterations)
        yield Figure(case, "cpu_ms", 1e3 * seconds[0], "ms", peer, 1e3 * spent)
        yield Figure(case, "cpu_ratio", seconds[0] / spent, "", peer, 1e3 * spent)
    yield Figure(case, "callables_ms", 1e3 * ours.timings.callables, "ms")
    yield Figure(case, "subproblems_ms", 1e3 * ours.timings.subproblems, "ms")


def _same_callables(task: Task, **options: str | float) -> Ipopt:
    return Ipopt(task.nlp, task.x0, {"tol": TOLERANCE, "constr_viol_tol": TOLERANCE, **options})


def _race(*calls: Callable[[], Any]) -> tuple[Any, ...]:
    """What each call gave, and the medians of their CPU times, taken in turns."""
    results, samples = [], []
    for call in calls:
        result, spent = _timed(call)
        results.append(result)
        samples.append([spent])
    if max(s[0] for s in samples) < LONG:
        samples = [[_timed(call)[1]] for call in calls]  # the first run warms caches only
        for _ in range(REPEATS - 1):
            for call, mine in zip(calls, samples, strict=True):
                mine.append(_timed(call)[1])
    return *results, [statistics.median(mine) for mine in samples]


def _timed(call: Callable[[], Any]) -> tuple[Any, float]:
    begin = time.process_time()
    result = call()
    return result, time.process_time() - begin


def _violation(nlp: NLP, x: FloatArray) -> float:
    x_lower, x_upper, c_lower, c_upper = nlp.bounds
    assert nlp.constraints is not None
    c = nlp.constraints(x)
    excess = (x_lower - x, x - x_upper, c_lower - c, c - c_upper)
    return max(0.0, *(float(e.max(initial=0.0)) for e in excess))


# ------------------------------------------------------------------------- many starts


def places(count: int, seed: int = 0) -> list[tuple[float, float]]:
    """Random places in the square through which a guess may go."""
    random = np.random.default_rng(seed)
    return [(float(x), float(y)) for x, y in random.uniform(0.5, 9.5, (count, 2))]


STARTED: dict[str, Callable[[], list[Task]]] = {
    **{
        f"point-mass-starts-{n}": lambda n=n: [mass_task(n, via=[p]) for p in places(STARTS)]
        for n in (40, 100, 200)
    },
    "double-pendulum-starts-41": lambda: [
        stated_task(double_pendulum(41, push)) for push in (-4.0, -1.0, 0.0, 1.0, 4.0)
    ],
    "two-link-arm-starts-41": lambda: [
        stated_task(two_link_arm(41, bend)) for bend in (-2.0, -1.0, 0.0, 1.0, 2.0)
    ],
    "cart-pole-starts-41": lambda: [
        stated_task(cart_pole(41, swing)) for swing in (-0.5, 0.0, 0.5, 1.0, 1.5)
    ],
    **{
        f"banded-seeds-{n}": lambda n=n: [banded_task(n, seed) for seed in range(STARTS)]
        for n in (100,)
    },
}


def measure_starts(case: str, how: dict[str, str]) -> Iterator[Figure]:
    """Figures over random starts (point mass) or random problems (banded)."""
    ours: list[Result] = []
    theirs: list[IpoptResult] = []
    ratios: list[tuple[float, float]] = []
    times: list[tuple[float, float]] = []
    for task in STARTED[case]():
        best, same = CasadiIpopt(task.nlp, task.expressions, TOLERANCE), _same_callables(task)
        mine, spent = _timed(lambda task=task: solve(task.nlp, task.x0, **how))
        its, its_spent = _timed(lambda task=task, best=best: best.solve(task.x0))
        _, same_spent = _timed(lambda task=task, same=same: same.solve(task.x0))
        ours.append(mine)
        theirs.append(its)
        ratios.append((spent / its_spent, spent / same_spent))
        times.append((its_spent, same_spent))
    equal = [_as_good(mine, its) for mine, its in zip(ours, theirs, strict=True)]
    yield Figure(case, "equal_or_better", float(np.mean(equal)), "", PEER)
    solved = float(np.mean([r.success for r in ours]))
    yield Figure(case, "solved", solved, "", PEER, float(np.mean([r.success for r in theirs])))
    for column, peer in enumerate((PEER, SAME)):
        median = statistics.median(ratio[column] for ratio in ratios)
        spent = statistics.median(t[column] for t in times)
        yield Figure(case, "cpu_ratio", median, "", peer, 1e3 * spent)
    if not case.startswith("banded"):
        for name, pick in (("best", min), ("worst", max)):
            mine, its = (pick(r.objective for r in rs if r.success) for rs in (ours, theirs))
            yield Figure(case, name, mine, "", PEER, its)


def _as_good(ours: Result, theirs: IpoptResult) -> bool:
    if not theirs.success:
        return True
    slack = TOLERANCE * max(1.0, abs(theirs.objective))
    return ours.success and ours.objective <= theirs.objective + slack


# ------------------------------------------------------------------------- warm starts


def _moved(scene: Scene, by: FloatArray) -> Scene:
    circles = tuple((x + by[0], y + by[1], r) for x, y, r in scene.circles)
    return Scene(scene.start, scene.goal, circles, scene.lower, scene.upper, scene.way)


def _nearby(kind: str, size: int) -> Iterator[Task]:
    """A problem, and then some with slightly different data."""
    random = np.random.default_rng(4)
    for k in range(PERTURBATIONS + 1):
        by = (k > 0) * random.normal(scale=0.02, size=2)
        if kind == "double-integrator":
            yield integrator_task(size, (4.0 + by[0], 1.0 + by[1]))
        elif kind == "point-mass":
            yield mass_task(size, scene=_moved(GARDEN, by))
        elif kind == "point-mass-bernstein":
            yield mass_task(size, Avoidance.BERNSTEIN, scene=_moved(GARDEN, by))
        else:
            yield banded_task(size, shift=float(by[0]))


RESOLVED = {
    "warm-resolve-double-integrator-40": ("double-integrator", 40),
    "warm-resolve-double-integrator-200": ("double-integrator", 200),
    "warm-resolve-point-mass-100": ("point-mass", 100),
    "warm-resolve-point-mass-bernstein-40": ("point-mass-bernstein", 40),
    "warm-resolve-banded-100": ("banded", 100),
}
ALL_RESOLVED = "warm-resolve"


def measure_resolve(case: str, how: dict[str, str]) -> Iterator[Figure]:
    """Ratios over problems nearby; ``warm-resolve`` over those of all kinds."""
    chosen = RESOLVED if case == ALL_RESOLVED else {case: RESOLVED[case]}
    found = [pair for kind, size in chosen.values() for pair in _resolved(kind, size, how)]
    for column, peer in enumerate((PEER, SAME)):
        ratios = [ours / theirs[column] for ours, theirs in found]
        spent = 1e3 * statistics.median(theirs[column] for _, theirs in found)
        yield Figure(case, "cpu_ratio", statistics.median(ratios), "", peer, spent)
        faster = float(np.mean([ratio < 1.0 for ratio in ratios]))
        yield Figure(case, "share_faster", faster, "", peer)
    yield Figure(case, "cpu_ms", 1e3 * statistics.median(ours for ours, _ in found), "ms")


def _resolved(
    kind: str, size: int, how: dict[str, str]
) -> Iterator[tuple[float, tuple[float, float]]]:
    """CPU seconds of ours and of both peers for each perturbation."""
    first, *others = _nearby(kind, size)
    mine = solve(first.nlp, first.x0, **how)
    x = mine.x
    its = CasadiIpopt(first.nlp, first.expressions, TOLERANCE).solve(x)
    for task in others:
        calls: list[Callable[[], Any]] = [
            lambda task=task: solve(task.nlp, mine.x, warm_start=mine, **how)
        ]
        for mu in (None, *MU):
            options = {} if mu is None else warm_options(mu)
            warm = None if mu is None else its
            fast = CasadiIpopt(task.nlp, task.expressions, TOLERANCE, options)
            same = _same_callables(task, **options)
            calls.append(lambda fast=fast, warm=warm: fast.solve(its.x, warm))
            calls.append(lambda same=same, warm=warm: same.solve(its.x, warm))
        *results, seconds = _race(*calls)
        ended = [s if r.success else np.inf for r, s in zip(results, seconds, strict=True)]
        yield ended[0], (min(ended[1::2]), min(ended[2::2]))


# -------------------------------------------------------------------------------- main

USUAL = (
    "cubic",
    "double-integrator-40",
    "double-integrator-200",
    "double-integrator-1600",
    "point-mass-40",
    "point-mass-100",
    "point-mass-200",
    "three-discs-80",
    "maze-100",
    "banded-100",
    *(f"{k}-41" for k in MECHANICS),
    *(f"{k}-101" for k in COPS),
    "double-pendulum-starts-41",
    "two-link-arm-starts-41",
    "cart-pole-starts-41",
    ALL_RESOLVED,
)


def _measure(how: dict[str, str]) -> Callable[[str], Iterator[Figure]]:
    def measure(case: str) -> Iterator[Figure]:
        if case in SINGLE:
            return measure_single(case, how)
        return measure_starts(case, how) if case in STARTED else measure_resolve(case, how)

    return measure


def _options() -> dict[str, str]:
    """Takes ``--qp`` and ``--method`` out of the command line, whose rest all benchmarks share."""
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("--qp", default="clarabel", choices=tuple(BackendKind))
    parser.add_argument("--method", default="auto", choices=tuple(SolverMethod))
    options, sys.argv[1:] = parser.parse_known_args()
    return vars(options)


if __name__ == "__main__":
    chosen = _options()
    main(__doc__ or "", _measure(chosen), (*SINGLE, *STARTED, ALL_RESOLVED, *RESOLVED), USUAL)
