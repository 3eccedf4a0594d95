"""What proofs of a clearance cost.

    python benchmarks/certificate.py [--json] [--case two-joints]

``two-joints``: two joints round a box. ``clutter-100``: a hundred moves among 24 meshes of 10 000
triangles. Blends of second order, zones of 10 mm. ``cpu_ms`` is the CPU time of a proof of the
cell's clearance, ``measured`` counts its distances and enclosures. ``…_told`` are the same with the
least distance enclosed to 0.01 mm, ``proven_mm`` is what is proven then. ``stretch_cpu_ms`` is for
a hundredth of the path, in its middle.
"""

from __future__ import annotations

from collections.abc import Iterator

from report import Figure, cpu_seconds, main

from flyby.core.collision.proof.certificate import certify, certify_stretch, scenes_of
from flyby.core.program.zone import Radius
from flyby.validation.scenes.clutter import clutter_100
from flyby.validation.scenes.scene import with_zone
from flyby.validation.scenes.two_joints import two_joints

CASES = {"two-joints": two_joints, "clutter-100": clutter_100}
ZONE = 0.01
RESOLUTION = 1e-5


def measure(case: str) -> Iterator[Figure]:
    """The figures of a case."""
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
    main(__doc__ or "", measure, CASES)
