"""The nonlinear program of a painting: IPOPT on the same callables, and what larger ones cost."""

from __future__ import annotations

import math
import multiprocessing
import resource
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib.metadata import version

import numpy as np
from ipopt import Ipopt
from report import Figure

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP
from flyby.problems.paint.coating.coat import coat
from flyby.problems.paint.coating.deposition import Deposition
from flyby.problems.paint.initial.curve import initial_curve
from flyby.problems.paint.initial.plan import SweepPlan
from flyby.problems.paint.spray.footprint import ring
from flyby.problems.paint.spray.trajectory import PaintTrajectory
from flyby.problems.paint.thickness.constraints import PaintConstraints
from flyby.problems.paint.thickness.objective import PaintObjective
from flyby.problems.paint.thickness.optimize import optimize
from flyby.problems.paint.thickness.options import OuterLoop, PaintLimits, PaintWeights
from flyby.problems.paint.thickness.reference import ReferencePlanes
from flyby.problems.paint.thickness.robust import NO_ERRORS, scenarios
from flyby.problems.paint.thickness.round import TOLERANCE, JudgedTrajectory, Round
from flyby.problems.paint.thickness.variables import ThicknessVariables
from flyby.validation.surfaces.sheets import plate

TARGET, DISTANCE = 50e-6, 0.25
MICRON, MILLI, MEGA = 1e-6, 1e-3, 1e6
WIDE = OuterLoop(rounds=1, position=0.1, angle=math.radians(20.0), duration=0.9)
"""A box that leaves the limits to say how far things go."""
LONGEST = 300.0
"""s of CPU time after which IPOPT gives up."""


def beside_ipopt(
    case: str, deposition: Deposition, start: PaintTrajectory, target: float
) -> Iterator[Figure]:
    """Our rounds and IPOPT from one start."""
    reference = ReferencePlanes.below(start, DISTANCE)
    begin = time.process_time()
    ours = optimize(deposition, start, target, reference)
    own_time = time.process_time() - begin
    step = _round(deposition, start, target, reference)
    visits: list[tuple[float, FloatArray]] = []
    program = _visited(step.program, visits)
    options = {"tol": TOLERANCE, "max_iter": 1000, "max_cpu_time": LONGEST}
    peer = Ipopt(program, np.zeros(program.n), options)
    begin = time.process_time()
    visits.append((0.0, peer.solve(np.zeros(program.n)).x))
    visits[-1] = (time.process_time(), visits[-1][1])
    peer_time, found = _as_good(step, visits, ours.objective[-1])
    peer_time -= begin
    name = f"ipopt (casadi {version('casadi')})"
    spread = coat(deposition, found.trajectory, target).by_area
    yield Figure(case, "std_um", ours.after.by_area.std / MICRON, "µm", name, spread.std / MICRON)
    yield Figure(case, "objective", ours.objective[-1], "", name, found.cost)
    yield Figure(case, "cpu_s", own_time, "s", name, peer_time)
    yield Figure(case, "cpu_ratio", peer_time / own_time, "", name, peer_time)


def scaling(case: str, across: int, longest: float, subpoints: int) -> Iterator[Figure]:
    """Figures of one size, measured in a process of their own.

    Args:
        across: points along a side of the plate.
        longest: segment, m.
        subpoints: of a segment.
    """
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        yield from pool.apply(_scaling, (case, across, longest, subpoints))


def _scaling(case: str, across: int, longest: float, subpoints: int) -> list[Figure]:
    part = plate(across)
    start = initial_curve(part, SweepPlan(0.18, longest_segment=longest)).trajectory
    plain = Deposition(part.samples, ring(0.25), subpoints)
    footprint = ring(0.25).scaled(TARGET / coat(plain, start, TARGET).by_area.mean)
    deposition = plain.with_footprint(footprint)
    step = _round(deposition, start, TARGET, ReferencePlanes.below(start, DISTANCE))
    z = np.zeros(step.variables.size)
    calls: dict[str, Callable[[], object]] = {
        "thickness_ms": lambda: deposition.thickness(start),
        "gradient_ms": lambda: step.objective.gradient(z),
        "normal_matrix_ms": lambda: step.objective.curvature(z),
    }
    figures = [Figure(case, "segments", start.segments, ""), Figure(case, "variables", len(z), "")]
    figures += [Figure(case, name, _fastest(call) / MILLI, "ms") for name, call in calls.items()]
    loop = OuterLoop(rounds=1, iterations=2)
    optimize(deposition, start, TARGET, ReferencePlanes.below(start, DISTANCE), loop=loop)
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return [*figures, Figure(case, "memory_mb", most / MEGA, "MB")]


def _fastest(call: Callable[[], object]) -> float:
    """s of CPU time: the least of seven, after a first call."""
    call()
    seconds = []
    for _ in range(7):
        begin = time.process_time()
        call()
        seconds.append(time.process_time() - begin)
    return min(seconds)


def _round(
    deposition: Deposition, start: PaintTrajectory, target: float, reference: ReferencePlanes
) -> Round:
    """The whole task as one round."""
    variables = ThicknessVariables.of(start, reference)
    return Round(
        0,
        variables,
        PaintObjective(scenarios(deposition, NO_ERRORS), target, PaintWeights(), variables),
        PaintConstraints(PaintLimits(), variables, start.position),
        WIDE,
    )


def _visited(program: NLP, visits: list[tuple[float, FloatArray]]) -> NLP:
    """The program, which notes where and when (s of CPU time) its gradient was asked for: at every
    iterate."""
    gradient = program.gradient
    assert gradient is not None

    def noted(x: FloatArray) -> FloatArray:
        visits.append((time.process_time(), x.copy()))
        return gradient(x)

    return replace(program, gradient=noted)


def _as_good(
    step: Round, visits: list[tuple[float, FloatArray]], cost: float
) -> tuple[float, JudgedTrajectory]:
    """The first visit that keeps all limits at no more than a cost, else the last one."""
    for when, x in visits:
        found = step.judged(x)
        if found.cost <= cost and found.violation <= TOLERANCE:
            return when, found
    return when, found
