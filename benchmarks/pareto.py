"""Time and energy: velocity tuning, programs between fast and frugal, and the front of a program.

    python benchmarks/pareto.py [--json] [--case pareto] [--starts 6]

Energy is ∫ Σ τ² dt. Weights are those of time: 1 for time alone, 0 for energy alone, 0.5 for both,
as shares of what the baseline takes. The baseline is the papers': the program as a path planner
gives it, piecewise linear with a stop at every via point, passed as fast as the joints can.

``2dof`` and ``stud`` are reference scenes of `flyby.validation.scenes` with blends of second order;
figures of ``stud`` are sums over its 24 motions.

- ``baseline_time_s``, and ``baseline_energy``, N² m² s.
- ``tuned_time_s@W``, ``tuned_energy_ratio@W``: the same path, its speed tuned for the weight W; the
  energy as a share of the baseline's.
- ``program_time_s@W``, ``program_energy_ratio@W``: via points, zones, speeds and accelerations
  chosen for the weight W, as RAPID that was written, read back, driven and proven.
- ``free_time_s@W``, ``free_energy_ratio@W``: the motion that no program language binds, by optimal
  control within the same limits, proven to keep the same clearance.
- ``program_energy_change_percent_joint1@W`` … ``6``, and ``free_…``: change of a joint's energy
  against the baseline; joints that take less than 0.5 % of the whole are left out.
- ``wall_s``: of all programs of the scene, with their proofs.

``pareto``, one line a point: the front of the two-joint program, ``energy_ratio@T_s`` at the cycle
time T. The peer is velocity tuning of the point's own path within its own time: what a controller
could save that may choose any speed at any place, and so what plain code leaves on the table.

``velocity-tuning``: how near two ways come where both apply, and what they cost, on the two-joint
scene's path with torque limits.

- ``time_s``: by sweeps; peer: by second-order cones.
- ``cpu_ms``: likewise.
"""

from __future__ import annotations

import math
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from free_motion import questions
from report import Figure, main

from flyby.core.arrays import FloatArray
from flyby.core.collision.proof.certificate import certify, scenes_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import Radius
from flyby.core.registry import find_vendor
from flyby.problems.free_motion.optimal_control import (
    MotionEffort,
    MotionObjective,
    Optimum,
    energy_of,
    optimize,
)
from flyby.problems.free_motion.optimal_control import MotionTask as FreeTask
from flyby.problems.free_motion.velocity_tuning import (
    FixedPath,
    JointDrive,
    TorqueCurve,
    TuningObjective,
    tune,
    tune_by_cones,
    tune_by_sweeps,
)
from flyby.problems.free_motion.velocity_tuning import TuningTask as TuningTask
from flyby.problems.improve.energy import (
    EnergyScope,
    EnergyTask,
    Front,
    FrontPoint,
    Goal,
    optimize_energy,
    pareto,
)
from flyby.problems.improve.waypoints import Effort, optimize_waypoints
from flyby.problems.improve.waypoints import WaypointTask as Wishes
from flyby.problems.improve.zones.points import passable_stops
from flyby.validation.scenes.scene import SECOND_ORDER_BLENDS, UNHURRIED, Scene, with_zone
from flyby.validation.scenes.stud_welding import stud_welding
from flyby.validation.scenes.two_joints import two_joints

SCENES: dict[str, Callable[[], Scene]] = {"2dof": two_joints, "stud": stud_welding}
WEIGHTS = (1.0, 0.5, 0.0)
FRONT, TUNING = "pareto", "velocity-tuning"
POINTS = 8
FREE = MotionEffort(intervals=40)
ABB = find_vendor("abb")
_TOLD = 0.005


# ------------------------------------------------------------------------- scenes


@dataclass(frozen=True)
class Baseline:
    """The scene's programs one after the other, with a stop at every via point.

    Args:
        scene: the scene.
        controller: that drives it.
        whole: all its motions as one program.
        path: through them.
        time: s, and
        energy: N² m² s, of the fastest motion.
        by_joint: (N,), of the energy.
    """

    scene: Scene
    controller: Controller
    whole: Program
    path: FixedPath
    time: float
    energy: float
    by_joint: FloatArray

    @classmethod
    def of(cls, scene: Scene) -> Baseline:
        """The baseline of a scene."""
        controller = scene.controller(SECOND_ORDER_BLENDS)
        moves = tuple(move for program in scene.programs for move in program.moves)
        whole = replace(scene.programs[0], statements=moves)
        timing = controller.stamp(whole, controller.plan(whole))
        path = FixedPath.of(controller, whole, timing)
        fastest = tune(TuningTask(path))
        return cls(
            scene,
            controller,
            whole,
            path,
            fastest.duration,
            fastest.energy,
            fastest.energy_by_joint,
        )


def measure_scene(case: str, starts: int) -> Iterator[Figure]:
    """Figures of one scene."""
    base = Baseline.of(SCENES[case]())
    yield Figure(case, "baseline_time_s", base.time, "s")
    yield Figure(case, "baseline_energy", base.energy, "N² m² s")
    yield from velocity_tuned(case, base)
    begin = time.perf_counter()
    yield from programs(case, base, starts)
    yield Figure(case, "wall_s", time.perf_counter() - begin, "s")
    yield from free_motions(case, base)


def velocity_tuned(case: str, base: Baseline) -> Iterator[Figure]:
    """The baseline's path at the speeds that are best for each weight."""
    for weight in WEIGHTS:
        made = tune(TuningTask(base.path, objective=TuningObjective(weight)))
        yield Figure(case, f"tuned_time_s@{weight:g}", made.duration, "s")
        yield Figure(case, f"tuned_energy_ratio@{weight:g}", made.energy / base.energy, "")


def programs(case: str, base: Baseline, starts: int) -> Iterator[Figure]:
    """Plain code that is best for each weight."""
    fast = [_fastest(base, program, starts) for program in base.scene.programs]
    for weight in WEIGHTS:
        goal = Goal.weighted(weight, base.time, base.energy)
        points = [_point(base, program, goal) for program in fast]
        total = sum(point.energy for point in points)
        by_joint = np.sum([point.by_joint for point in points], axis=0)
        yield Figure(case, f"program_time_s@{weight:g}", sum(p.duration for p in points), "s")
        yield Figure(case, f"program_energy_ratio@{weight:g}", total / base.energy, "")
        yield from _changes(case, base, "program", weight, by_joint)


def _changes(
    case: str, base: Baseline, what: str, weight: float, by_joint: FloatArray
) -> Iterator[Figure]:
    for joint, (was, now) in enumerate(zip(base.by_joint, by_joint, strict=True), start=1):
        if was > _TOLD * base.energy:
            figure = f"{what}_energy_change_percent_joint{joint}@{weight:g}"
            yield Figure(case, figure, float(100.0 * (now / was - 1.0)), "%")


def free_motions(case: str, base: Baseline) -> Iterator[Figure]:
    """Motions that no program language binds."""
    asked = questions(base.scene)
    fastest = [optimize(task, around, FREE, vias=vias) for task, around, vias in asked]
    for weight in WEIGHTS:
        found = fastest
        if weight < 1.0:
            found = [
                optimize(_weighed(base, known, weight), around, FREE, vias=vias)
                for known, (_, around, vias) in zip(fastest, asked, strict=True)
            ]
        assert all(optimum.proven for optimum in found)
        by_joint = np.zeros(len(base.by_joint))
        for optimum in found:
            by_joint += optimum.energy_by_joint()
        ratio = float(by_joint.sum() / base.energy)
        yield Figure(case, f"free_time_s@{weight:g}", sum(o.time for o in found), "s")
        yield Figure(case, f"free_energy_ratio@{weight:g}", ratio, "")
        yield from _changes(case, base, "free", weight, by_joint)


def _weighed(base: Baseline, known: Optimum, weight: float) -> FreeTask:
    """A motion's task with time and energy in the proportion that they have in the baseline.

    Optimal control measures both by its first guess.
    """
    energy = energy_of(known.task, known.first)
    by_time = weight * known.first.duration / base.time
    by_energy = (1.0 - weight) * energy / base.energy
    return replace(known.task, objective=MotionObjective(by_time / (by_time + by_energy)))


def _fastest(base: Baseline, program: Program, starts: int) -> Program:
    """The fastest program found with the via points that it has."""
    freed = passable_stops(program)
    if not freed:
        return program
    wishes = Wishes(axes=base.scene.free, tilt=math.pi, freed=freed)
    found = optimize_waypoints(
        base.controller, program, base.scene.cell, wishes, Effort(starts=starts, generations=1)
    )
    return replace(found.program, start=program.start)


def _point(base: Baseline, program: Program, goal: Goal) -> FrontPoint:
    """The program that serves a goal best, begun at the fastest one."""
    scope = EnergyScope.WAYPOINTS if len(program.moves) > 1 else EnergyScope.SPEEDS
    task = EnergyTask(scope, wishes=Wishes(axes=base.scene.free, tilt=math.pi))
    cell, effort = base.scene.cell, Effort(starts=1, generations=0, workers=1)
    (point,) = optimize_energy(
        base.controller, program, goal, cell, task, effort, ABB.speaks, _written
    ).points
    return point


def _written(program: Program) -> Program:
    """The program as it is read from its RAPID."""
    (text,) = ABB.write(program, two_joints().cell.robot).values()
    return ABB.read(text, "program.mod", robot=two_joints().cell.robot)


# ------------------------------------------------------------------------- the front


@cache
def two_joint_front() -> tuple[Controller, Front]:
    """The front of the two-joint program, begun at the fastest one that is found."""
    base = Baseline.of(two_joints())
    program = _fastest(base, base.scene.programs[0], 6)
    task = EnergyTask(wishes=Wishes(axes=base.scene.free, tilt=math.pi))
    effort = Effort(starts=1, generations=0, workers=1)
    cell = base.scene.cell
    front = pareto(base.controller, program, cell, task, POINTS, effort, ABB.speaks, _written)
    return base.controller, front


def measure_front(case: str) -> Iterator[Figure]:
    """One line a point."""
    base = Baseline.of(two_joints())
    controller, front = two_joint_front()
    scenes, cell = scenes_of(base.scene.cell), base.scene.cell
    for point in front.points:
        run = controller.run(point.program, base.scene.programs[0].start)
        assert certify(controller, run, scenes, cell.clearance).proven
        path = _unhurried(controller, point.program, base.scene.programs[0].start)
        least = tune(TuningTask(path)).duration
        wanted = TuningObjective(0.0, duration=max(point.duration, least))
        free = tune(TuningTask(path, objective=wanted))
        yield Figure(
            case,
            f"energy_ratio@{point.duration:.4f}_s",
            point.energy / base.energy,
            "",
            "free time law on the same path",
            free.energy / base.energy,
        )


def _unhurried(controller: Controller, program: Program, start: JointTarget | None) -> FixedPath:
    """A program's path without the speeds and accelerations that it states.

    Speeds that limit nothing differ all the same: a path is sampled more closely where they do.
    """
    moves = tuple(
        replace(move, speed=replace(UNHURRIED, tcp=(UNHURRIED.tcp or 1.0) + k))
        for k, move in enumerate(program.moves)
    )
    freely = replace(program.with_moves(moves), start=start)
    return FixedPath.of(controller, freely, controller.stamp(freely, controller.plan(freely)))


# ------------------------------------------------------------------------- ways that agree


def measure_tuning(case: str) -> Iterator[Figure]:
    """Sweeps and cones on one path with torque limits."""
    scene = two_joints()
    controller = scene.controller(SECOND_ORDER_BLENDS)
    program = with_zone(scene.programs[0], Radius(0.1))
    timing = controller.stamp(program, controller.plan(program))
    path = FixedPath.of(controller, program, timing)
    assert path.rigid is not None
    most = 1.2 * np.abs(path.rigid.c).max(axis=(0, 1)) + 50.0
    task = TuningTask(path, tuple(JointDrive(TorqueCurve.constant(float(v))) for v in most))
    found, spent = [], []
    for way in (tune_by_sweeps, tune_by_cones):
        way(task)
        begin = time.process_time()
        found.append(way(task).duration)
        spent.append(1e3 * (time.process_time() - begin))
    peer = "second-order cones (cvxpy, Clarabel)"
    yield Figure(case, "time_s", found[0], "s", peer, found[1])
    yield Figure(case, "cpu_ms", spent[0], "ms", peer, spent[1])


def _measure(case: str, starts: int) -> Iterator[Figure]:
    if case == FRONT:
        return measure_front(case)
    if case == TUNING:
        return measure_tuning(case)
    return measure_scene(case, starts)


if __name__ == "__main__":
    main(__doc__ or "", _measure, (*SCENES, FRONT, TUNING), starts=6)
