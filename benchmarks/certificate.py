"""What proofs of a clearance cost.

    python benchmarks/certificate.py [--json] [--case two-joints]

``two-joints``: two joints round a box. ``clutter-100``: a hundred moves among 24 meshes of 10 000
triangles. Blends of second order, zones of 10 mm. ``cpu_ms`` is the CPU time of a proof of the
cell's clearance, ``measured`` counts its distances and enclosures. ``…_told`` are the same with the
least distance enclosed to 0.01 mm, ``proven_mm`` is what is proven then. ``stretch_cpu_ms`` is for
a hundredth of the path, in its middle.

``parts``: ``--programs`` random cells in which parts are taken and put down. ``contradicted``
counts those that are proven although samples ten times as dense break the rules of parts,
``missed`` those that are not proven although they keep them by 1.5 mm, ``unlike`` those of which
`flyby check` says something else than the proof.

``parts-optimized``: what `flyby optimize` makes of these: ``refused`` collide as they are,
``faster`` and ``moved`` count programs with better zones, or points, ``contradicted`` those among
the results that break the rules of parts in such samples.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

from report import Figure, cpu_seconds, main

from flyby.core.collision.clearance import ClearanceMeter, nearest_of
from flyby.core.collision.handled_scenes import HandledScenes, PartScenes
from flyby.core.collision.proof.certificate import (
    TOLERANCE,
    certify,
    certify_stretch,
    scenes_of,
)
from flyby.core.errors import MotionError
from flyby.core.handling.handling import handling_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.program.zone import Radius
from flyby.core.registry import find_vendor
from flyby.problems.improve.waypoints import Effort, WaypointTask, optimize_waypoints
from flyby.validation.scenes.clutter import clutter_100
from flyby.validation.scenes.handling import random_handling, worst_fault
from flyby.validation.scenes.scene import with_zone
from flyby.validation.scenes.two_joints import two_joints

OPTIMIZED = "parts-optimized"
BRIEF = Effort(starts=2, generations=0, iterations=30, workers=1)
CASES = {"two-joints": two_joints, "clutter-100": clutter_100}
ZONE = 0.01
RESOLUTION = 1e-5
DENSE = Sampling(step=0.002, turn=0.01, joint=0.003, halvings=1, most=5000)
CLEARLY = 1.5e-3
"""m; a program that touches where it takes parts keeps at most 2 mm of what it may."""


def measure(case: str, programs: int) -> Iterator[Figure]:
    """The figures of a case."""
    if case == OPTIMIZED:
        return parts_optimized(programs)
    return parts(programs) if case == "parts" else costs(case)


def parts(programs: int) -> Iterator[Figure]:
    """How proofs of programs with parts agree with dense samples, and with what `check` finds."""
    found = sum(map(_against_samples, range(programs)), Counter[str]())
    for figure in ("programs", "proven", "broken", "contradicted", "missed", "unlike"):
        yield Figure("parts", figure, found[figure], "")


def _against_samples(seed: int) -> Counter[str]:
    scene, clearance = random_handling(seed), (0.0, 0.003, 0.006)[seed % 3]
    cell, program = replace(scene.cell, clearance=clearance), scene.program
    controller = Controller(find_vendor(cell.vendor), cell.robot)
    handling, run = handling_of(program, cell), controller.run(program)
    dense = Controller(find_vendor(cell.vendor), cell.robot, controller.model, DENSE)
    by = worst_fault(cell, handling, dense.plan(program), clearance).by
    scenes = HandledScenes(PartScenes(cell), handling, run.program, run.path, clearance)
    proven = certify(controller, run, scenes, clearance).proven
    met = nearest_of(ClearanceMeter(cell, program, handling).over(run.path, 0))
    clear = all(x is None or not (x.overlaps or x.distance < clearance - TOLERANCE) for x in met)
    return Counter(
        programs=1,
        proven=proven,
        broken=by > TOLERANCE,
        contradicted=proven and by > TOLERANCE,
        missed=not proven and by < -CLEARLY,
        unlike=proven != clear,
    )


def parts_optimized(programs: int) -> Iterator[Figure]:
    """What `optimize` makes of such programs, and whether dense samples agree with its proofs."""
    found: Counter[str] = Counter()
    gained: list[float] = []
    for seed in range(programs):
        found["programs"] += 1
        scene, clearance = random_handling(seed), (0.0, 0.003, 0.006)[seed % 3]
        cell, program = replace(scene.cell, clearance=clearance), scene.program
        controller = Controller(find_vendor(cell.vendor), cell.robot)
        task = WaypointTask(handling=handling_of(program, cell))
        try:
            made = optimize_waypoints(controller, program, cell, task, BRIEF)
        except MotionError:
            found["refused"] += 1  # it collides as it is
            continue
        dense = Controller(find_vendor(cell.vendor), cell.robot, controller.model, DENSE)
        again = handling_of(made.program, cell)
        by = worst_fault(cell, again, dense.plan(made.program), clearance).by
        found["faster"] += made.changed
        found["moved"] += bool(made.moved)
        found["contradicted"] += by > TOLERANCE + 1e-6
        gained.append(1.0 - made.after.time / made.before.time)
    for figure in ("programs", "refused", "faster", "moved", "contradicted"):
        yield Figure(OPTIMIZED, figure, found[figure], "")
    yield Figure(OPTIMIZED, "gained_percent", 100.0 * sum(gained) / max(len(gained), 1), "%")


def costs(case: str) -> Iterator[Figure]:
    """What proofs of one scene cost."""
    scene = CASES[case]()
    controller, scenes = scene.controller(), scenes_of(scene.cell)
    clearance = scene.cell.clearance
    run = controller.run(with_zone(scene.programs[0], Radius(ZONE)))
    sigma = run.path.sigma
    middle = 0.5 * float(sigma[-1])
    stretch = [(middle - 0.005 * float(sigma[-1]), middle + 0.005 * float(sigma[-1]))]
    asked = certify(controller, run, scenes, clearance)
    told = certify(controller, run, scenes, clearance, resolution=RESOLUTION)
    cost = cpu_seconds(
        {
            "cpu_ms": lambda: certify(controller, run, scenes, clearance),
            "cpu_ms_told": lambda: certify(
                controller, run, scenes, clearance, resolution=RESOLUTION
            ),
            "stretch_cpu_ms": lambda: certify_stretch(controller, run, scenes, clearance, stretch),
        }
    )
    for name, seconds in cost.items():
        yield Figure(case, name, 1e3 * seconds, "ms")
    yield Figure(case, "measured", asked.measured, "")
    yield Figure(case, "measured_told", told.measured, "")
    yield Figure(case, "proven_mm", 1e3 * told.clearance, "mm")


if __name__ == "__main__":
    main(__doc__ or "", measure, (*CASES, "parts", OPTIMIZED), CASES, programs=300)
