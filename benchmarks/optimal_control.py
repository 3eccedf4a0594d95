"""Optimal control of the free robot: how fast, and at what cost to compute.

``2dof``: two joints round a box. ``stud``: the 24 motions of the stud welding station, from rest
to rest; beside ``time_s`` stands the time of the motions that the searches began with.
``6dof-clutter``: one planned motion of an IRB 6640 among things on a bench, under limits of speed,
acceleration and torque; ``6dof-clutter-speeds``: the same without those of torque. Figures
``time_s``, ``energy_ratio`` (squared torque over time, to that of the first guess),
``torque_violation_percent``, ``clearance_mm`` (proven), ``wall_s`` and ``cpu_s``.

``6dof-free``: a wide motion under torque limits, 60 intervals, no obstacles: ``time_s`` and
``cpu_ms`` of one solution of the transcription; the peer is IPOPT on the same callables, with the
same Hessian and tolerance. ``6dof-free-energy``: the same with equal weights on time and energy.
Method and Hessian are those of `MotionSearch`.

The peer: pip install flyby[benchmarks]
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from free_motion import Question, configurations, questions
from ipopt import Ipopt
from report import Figure, main

from flyby.core.collision.proof.certificate import scenes_of
from flyby.core.motion.model.consumption import SQUARED_TORQUE
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_robot
from flyby.core.robot.inertia import carried_inertia
from flyby.core.sqp import solve
from flyby.problems.free_motion.optimal_control import (
    ControlLimits,
    MotionEffort,
    MotionObjective,
    MotionTask,
    Optimum,
    SchemeKind,
    Surroundings,
    energy_of,
    optimize,
)
from flyby.problems.free_motion.optimal_control.motion.first_guess import Polyline, first_guess
from flyby.problems.free_motion.optimal_control.motion.scheme import Scheme
from flyby.problems.free_motion.optimal_control.task.limits import MotionLimits
from flyby.problems.free_motion.optimal_control.task.sampled import Plant, TorqueField
from flyby.problems.free_motion.optimal_control.transcription.sample_rows import EnergyTerm
from flyby.problems.free_motion.optimal_control.transcription.transcription import (
    Bounds,
    Transcription,
)
from flyby.problems.free_motion.planning.plan import PlanningOptions, plan_path
from flyby.validation.scenes.clutter import clutter
from flyby.validation.scenes.stud_welding import stud_welding
from flyby.validation.scenes.two_joints import two_joints

CASES = ("2dof", "stud", "6dof-clutter", "6dof-clutter-speeds", "6dof-free", "6dof-free-energy")

FREE_START = (0.0, -15.0, 15.0, 0.0, 60.0, 0.0)
FREE_END = (70.0, 20.0, -10.0, 40.0, -50.0, 90.0)
TORQUE = (3000.0, 6000.0, 2500.0, 600.0, 500.0, 200.0)
CLUTTER_ENDS = (2, 10)
"""Moves of the tour whose ends are joined."""
TOLERANCE = 1e-6


def measure(case: str) -> Iterator[Figure]:
    """The figures of a case."""
    if case == "2dof":
        yield from _scene_figures(case, questions(two_joints()), MotionEffort(intervals=70))
    elif case == "stud":
        yield from _scene_figures(case, questions(stud_welding()), MotionEffort(intervals=40))
    elif case.startswith("6dof-clutter"):
        limits = ControlLimits(torque=None if case.endswith("speeds") else TORQUE)
        effort = MotionEffort(intervals=60, gain=1e-3, trials=0)
        yield from _scene_figures(case, [_clutter(limits)], effort)
    else:
        weight = 0.5 if case.endswith("energy") else 1.0
        yield from _beside_ipopt(case, weight)


def _clutter(limits: ControlLimits) -> Question:
    scene = clutter()
    controller = scene.controller()
    ends = controller.plan(scene.programs[0]).route.ends.q[list(CLUTTER_ENDS), 0]
    scenes = scenes_of(scene.cell)
    start, goal = (JointTarget(tuple(map(float, q))) for q in ends)
    options = PlanningOptions(seed=0)
    planned = plan_path(
        scene.cell, start, goal, scene.tool, options=options, controller=controller, scenes=scenes
    )
    q = configurations(planned.program)
    task = MotionTask(
        scene.cell.robot,
        q[0],
        q[-1],
        tcp=scene.tool.tcp,
        loads=(carried_inertia(scene.tool),),
        limits=limits,
    )
    return task, Surroundings(scenes(scene.tool), scene.cell.clearance), [q[1:-1]]


def _scene_figures(case: str, asked: list[Question], effort: MotionEffort) -> Iterator[Figure]:
    # What is compiled, and the shapes' hulls, are there before it counts.
    task, around, vias = asked[0]
    optimize(task, around, replace(effort, outer=1), vias=vias)
    wall, cpu = time.perf_counter(), time.process_time()
    found = [optimize(task, around, effort, vias=vias) for task, around, vias in asked]
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    first = sum(optimum.first.duration for optimum in found)
    yield Figure(case, "time_s", sum(o.time for o in found), "s", "first guess", first)
    yield Figure(case, "energy_ratio", _energy_ratio(found), "")
    violation = max(optimum.audit.torque_violation for optimum in found)
    yield Figure(case, "torque_violation_percent", 100.0 * violation, "%")
    least = min(o.certificate.clearance if o.proven and o.certificate else 0.0 for o in found)
    yield Figure(case, "clearance_mm", 1e3 * least, "mm")
    yield Figure(case, "wall_s", wall, "s")
    yield Figure(case, "cpu_s", cpu, "s")


def _energy_ratio(found: list[Optimum]) -> float:
    before = sum(energy_of(o.task, o.first) for o in found)
    return sum(o.energy() for o in found) / before


def _beside_ipopt(case: str, weight: float) -> Iterator[Figure]:
    task = MotionTask(
        find_robot("abb/irb6640-180-255"),
        np.radians(FREE_START),
        np.radians(FREE_END),
        limits=ControlLimits(torque=TORQUE),
        objective=MotionObjective(weight),
    )
    limits, plant = MotionLimits.of(task), Plant(task)
    scheme = Scheme(SchemeKind.LINEAR)
    guess = first_guess(task, limits, plant, Polyline.direct(task), scheme, 60, None)
    unit = None
    if weight < 1.0:
        field = TorqueField(plant, guess.scale)
        term = EnergyTerm(guess.layout, field, SQUARED_TORQUE, guess.scale, 0.0)
        unit = term.size(guess.x)
    points = guess.layout.points
    bounds = Bounds(np.tile(limits.lower, (points, 1)), np.tile(limits.upper, (points, 1)))
    energetic = weight < 1.0
    stated = Transcription(
        task, limits, guess.layout, guess.scale, unit, plant, indefinite=energetic
    )
    nlp = stated.nlp(bounds)
    how = {"method": "interior_point" if energetic else "sqp", "qp": "interior_point"}
    solve(nlp, guess.x, max_iterations=2, **how)
    begin = time.process_time()
    ours = solve(nlp, guess.x, tolerance=TOLERANCE, **how)
    own = time.process_time() - begin
    options = {"tol": TOLERANCE, "constr_viol_tol": TOLERANCE, "max_iter": 500}
    begin = time.process_time()
    theirs = Ipopt(nlp, guess.x, options).solve(guess.x)
    peer = time.process_time() - begin
    times = [guess.scale * float(np.sqrt(x[0])) for x in (ours.x, theirs.x)]
    yield Figure(case, "time_s", times[0], "s", "ipopt", times[1])
    yield Figure(case, "objective", ours.objective, "", "ipopt", theirs.objective)
    yield Figure(case, "iterations", ours.iterations, "", "ipopt", theirs.iterations)
    yield Figure(case, "cpu_ms", 1e3 * own, "ms", "ipopt", 1e3 * peer)


if __name__ == "__main__":
    main(__doc__, measure, CASES)
