"""Programs made faster: time, proven clearance, energy, and the time it takes to find them.

    python benchmarks/waypoints.py [--json] [--case 2dof] [--starts 12]

Without ``--case`` all of them, which takes some minutes.

``2dof``, ``stud`` and ``clutter`` are the reference scenes of `flyby.validation.scenes` with blends
of second order, ``2dof-parabola`` and ``stud-with-panel`` the same with parabolas and with the
panel as an obstacle. Times of a scene with several programs are sums.

- ``stop_time_s``: as given, with a stop at every via point.
- ``zones_time_s``: with the best zones found, all points where they are.
- ``optimized_time_s``: with the best via points and zones found.
- ``clearance_mm``: what the optimised programs are proven to keep.
- ``wall_s``: of the search for via points and zones, with its proof, on all processors; compiled
  code is loaded beforehand.
- ``energy_change_percent_joint1`` … ``6``: change of ∫ τ² dt from the given to the optimised
  program; joints that need no torque are left out.

``2dof-vias``, ``stud-vias``: the number of via points may change too. ``optimized_time_s``,
``clearance_mm``, ``cpu_s`` (one process), and ``via_points``, beside ``via_points_given``.

``2dof-transcription`` holds the search through the emulator, from one start and in one process,
against IPOPT on the papers' transcription of the same problem (`flyby.validation.transcription`).

- ``time_s``: of the motion found; IPOPT's as its own transcription says.
- ``emulated_time_s``: by one emulator, densely sampled.
- ``wall_s``: IPOPT's with our callables, exact Hessian included, until its motion keeps the
  clearance between nodes too; the better of several barrier parameters at the start, by time of
  the motion, is what is compared.
- ``callables_s``: how much of IPOPT's is spent in the callables.
- ``sqp_time_s``, ``sqp_wall_s``: the transcription solved by flyby.core.sqp.

``zone-maximization-100``, ``wall_s``: all zones of a program of a hundred waypoints maximised.

The peer: pip install flyby[benchmarks]
"""

from __future__ import annotations

import math
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version

import numpy as np
from ipopt import Ipopt, IpoptResult
from report import Figure, main

from flyby.core.arrays import FloatArray
from flyby.core.collision.proof.certificate import certify, scenes_of
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.sqp import NLP
from flyby.problems.improve.solution import Solution, measure
from flyby.problems.improve.waypoints import (
    Effort,
    Freedom,
    ViaCount,
    WaypointTask,
    optimize_waypoints,
)
from flyby.problems.improve.zones.maximize import maximize_zones
from flyby.problems.improve.zones.options import ZoneTask
from flyby.problems.improve.zones.points import passable_stops
from flyby.validation.scenes.clutter import clutter, clutter_100
from flyby.validation.scenes.scene import PARABOLAS, SECOND_ORDER, SECOND_ORDER_BLENDS, Scene
from flyby.validation.scenes.stud_welding import stud_welding, stud_welding_with_panel
from flyby.validation.scenes.two_joints import two_joints
from flyby.validation.transcription import Grid, Optimum, optimize
from flyby.validation.transcription import TranscriptionTask as TranscriptionTask

SCENES: dict[str, tuple[Callable[[], Scene], MotionModel]] = {
    "2dof": (two_joints, SECOND_ORDER_BLENDS),
    "2dof-parabola": (two_joints, PARABOLAS),
    "stud": (stud_welding, SECOND_ORDER_BLENDS),
    "stud-with-panel": (stud_welding_with_panel, SECOND_ORDER_BLENDS),
    "clutter": (clutter, SECOND_ORDER_BLENDS),
}
VIAS = {"2dof-vias": "2dof", "stud-vias": "stud"}
TRANSCRIPTION, MAXIMIZATION = "2dof-transcription", "zone-maximization-100"
RESOLUTION = 1e-5
"""m, of proven clearances."""
DENSE = Sampling(blend=64, joint=0.02)
FINE = Sampling(blend=32, joint=0.03)
"""Of what is refined, timed and proven: the usual one overestimates times by 0.2 %."""
GRID = Grid(5, 10)
FREEDOM = 0.35
"""rad, how far via points of the transcription may move: farther, IPOPT loses its way."""
START = 0.9
"""Share of the largest zones that the transcription's start has."""
BARRIERS = (1e-1, 1e-2, 1e-3)
CLUTTER, MOST_AMONG_MESHES = "clutter", 1
"""An iteration among meshes costs twenty times as much as one among capsules and boxes."""
PLAIN = Effort(starts=1, generations=0, workers=1)
ONCE = replace(PLAIN, iterations=2)


# ------------------------------------------------------------------------- scenes


def measure_scene(case: str, effort: Effort) -> Iterator[Figure]:
    """Figures of one scene."""
    make, model = SCENES[case]
    scene = make()
    zones = [
        _solved(scene, model, program, effort, freedom=Freedom.ZONES) for program in scene.programs
    ]
    yield Figure(case, "stop_time_s", sum(s.before.time for s in zones), "s")
    yield Figure(case, "zones_time_s", sum(s.after.time for s in zones), "s")
    _solved(scene, model, scene.programs[0], ONCE)
    begin = time.perf_counter()
    free = [_solved(scene, model, program, effort) for program in scene.programs]
    wall = time.perf_counter() - begin
    yield Figure(case, "optimized_time_s", sum(s.after.time for s in free), "s")
    yield _clearance(case, free)
    yield Figure(case, "wall_s", wall, "s")
    yield from _energy_figures(case, free)


def measure_vias(case: str, effort: Effort) -> Iterator[Figure]:
    """Figures of one scene with other numbers of via points."""
    make, model = SCENES[VIAS[case]]
    scene = make()
    _solved(scene, model, scene.programs[0], ONCE)
    begin = time.process_time()
    found = [_solved(scene, model, program, effort, ViaCount.CHANGE) for program in scene.programs]
    spent = time.process_time() - begin
    yield Figure(case, "optimized_time_s", sum(s.after.time for s in found), "s")
    yield _clearance(case, found)
    given, now = (
        sum(len(p.moves) - 1 for p in programs)
        for programs in (scene.programs, [s.program for s in found])
    )
    yield Figure(case, "via_points", now, "1")
    yield Figure(case, "via_points_given", given, "1")
    yield Figure(case, "cpu_s", spent, "s")


def _clearance(case: str, solutions: Sequence[Solution]) -> Figure:
    """The least that is proven."""
    kept = [s.after.clearance for s in solutions]
    proven = [c for c in kept if c is not None]
    least = min(proven) if len(proven) == len(kept) else float("nan")
    return Figure(case, "clearance_mm", 1e3 * least, "mm")


def _solved(
    scene: Scene,
    model: MotionModel,
    program: Program,
    effort: Effort,
    vias: ViaCount = ViaCount.KEEP,
    freedom: Freedom = Freedom.WAYPOINTS_AND_ZONES,
) -> Solution:
    """A program bettered; one without via points as it is, with its proof."""
    controller = scene.controller(model, FINE)
    freed = [i for i in passable_stops(program) if i not in scene.process]
    if not freed:
        run = controller.run(program)
        proof = certify(
            controller, run, scenes_of(scene.cell), scene.cell.clearance, resolution=RESOLUTION
        )
        held = measure(controller, run, proof)
        return Solution(program, program, held, held, proof)
    task = WaypointTask(
        axes=scene.free,
        tilt=math.pi,
        freed=freed,
        keep=scene.process,
        vias=vias,
        freedom=freedom,
    )
    return optimize_waypoints(controller, program, scene.cell, task, effort)


def _energy_figures(case: str, solutions: Sequence[Solution]) -> Iterator[Figure]:
    if any(s.before.energy is None or s.after.energy is None for s in solutions):
        return
    before = np.sum([s.before.energy for s in solutions], axis=0)
    after = np.sum([s.after.energy for s in solutions], axis=0)
    for joint, (was, now) in enumerate(zip(before, after, strict=True), start=1):
        if was > 0.0:
            figure = f"energy_change_percent_joint{joint}"
            yield Figure(case, figure, float(100.0 * (now - was) / was), "%")


# ------------------------------------------------------------------------- transcription


@dataclass
class Clock:
    """Seconds spent in something."""

    spent: float = 0.0

    def timed(self, call: Callable[..., object]) -> Callable[..., object]:
        """The same call, timed."""

        def timed(*arguments: object) -> object:
            begin = time.perf_counter()
            answer = call(*arguments)
            self.spent += time.perf_counter() - begin
            return answer

        return timed


_CALLABLES = ("objective", "gradient", "constraints", "jacobian", "hessian")


def _ipopt(barrier: float, clock: Clock, nlp: NLP, x0: FloatArray) -> IpoptResult:
    """IPOPT on the callables of a problem."""
    timed = replace(nlp, **{name: clock.timed(getattr(nlp, name)) for name in _CALLABLES})
    options: dict[str, str | float | int] = {"tol": 1e-6, "constr_viol_tol": 1e-6}
    return Ipopt(timed, x0, {**options, "max_iter": 500, "mu_init": barrier}).solve(x0)


def measure_transcription(case: str) -> Iterator[Figure]:
    """The search through the emulator beside both solvers of the transcription."""
    scene = two_joints()
    program = scene.programs[0]
    task = TranscriptionTask(scene.cell, _waypoints(program), SECOND_ORDER, scene.tool)
    solve = partial(optimize, task, GRID, FREEDOM, START)
    begin = time.perf_counter()
    transcribed = solve()
    sqp_wall = time.perf_counter() - begin
    its, wall, callables = min(
        map(partial(_peer, solve), BARRIERS), key=lambda found: found[0].time
    )
    _solved(scene, SECOND_ORDER_BLENDS, program, ONCE)
    begin = time.perf_counter()
    ours = _solved(scene, SECOND_ORDER_BLENDS, program, PLAIN)
    spent = time.perf_counter() - begin
    dense = scene.controller(sampling=DENSE)
    peer = f"ipopt (casadi {version('casadi')}), transcription"
    yield Figure(case, "time_s", ours.after.time, "s", peer, its.time)
    emulated = [dense.run(p).duration for p in (ours.program, its.program)]
    yield Figure(case, "emulated_time_s", emulated[0], "s", peer, emulated[1])
    yield Figure(case, "wall_s", spent, "s", peer, wall)
    yield Figure(case, "callables_s", callables, "s", peer)
    yield Figure(case, "sqp_time_s", transcribed.time, "s", peer, its.time)
    yield Figure(case, "sqp_wall_s", sqp_wall, "s", peer, wall)


def _peer(solve: Callable[..., Optimum], barrier: float) -> tuple[Optimum, float, float]:
    """IPOPT's optimum, and its seconds in all and in the callables."""
    clock = Clock()
    begin = time.perf_counter()
    found = solve(solver=partial(_ipopt, barrier, clock))
    return found, time.perf_counter() - begin, clock.spent


def _waypoints(program: Program) -> FloatArray:
    """Start and targets (M + 1, N)."""
    targets = [program.start, *(move.target for move in program.moves)]  # type: ignore[union-attr]
    return np.array([t.joints for t in targets if isinstance(t, JointTarget)])


# ------------------------------------------------------------------------- maximisation


def measure_maximization(case: str) -> Iterator[Figure]:
    """Zones of the long program among meshes, as large as they can be."""
    warm, scene = clutter(), clutter_100()
    for run in (warm, scene):
        program = run.programs[0]
        options = ZoneTask(freed=tuple(passable_stops(program)))
        begin = time.perf_counter()
        maximize_zones(run.controller(), program, run.cell, options)
        wall = time.perf_counter() - begin
    yield Figure(case, "wall_s", wall, "s")


def _measure(case: str, starts: int) -> Iterator[Figure]:
    if case == TRANSCRIPTION:
        return measure_transcription(case)
    if case == MAXIMIZATION:
        return measure_maximization(case)
    if case == CLUTTER:
        return measure_scene(case, Effort(starts=min(starts, MOST_AMONG_MESHES), generations=0))
    if case in VIAS:
        return measure_vias(case, Effort(starts=starts, workers=1))
    return measure_scene(case, Effort(starts=starts))


if __name__ == "__main__":
    main(
        __doc__ or "",
        _measure,
        (*SCENES, *VIAS, TRANSCRIPTION, MAXIMIZATION),
        starts=Effort().starts,
    )
