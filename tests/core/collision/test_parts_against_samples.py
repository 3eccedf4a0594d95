"""Certificates and clearances of random cells with parts, against dense samples of their paths."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.collision.clearance import ClearanceMeter, nearest_of
from flyby.core.collision.handled_scenes import HandledScenes, PartScenes
from flyby.core.collision.proof.certificate import TOLERANCE, certify
from flyby.core.collision.proof.verdict import Verdict
from flyby.core.handling.handling import handling_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.registry import find_vendor
from flyby.validation.scenes.handling import random_handling, worst_fault

DENSE = Sampling(step=0.002, turn=0.01, joint=0.003, halvings=1, most=5000)


@settings(max_examples=8)
@given(st.integers(0, 10**9), st.sampled_from([0.0, 0.003, 0.006]))
def test_nothing_is_proven_or_found_clear_that_dense_samples_contradict(seed, clearance) -> None:
    """A larger run of the same: ``python benchmarks/certificate.py --case parts``."""
    scene = random_handling(seed)
    cell, program = replace(scene.cell, clearance=clearance), scene.program
    controller = Controller(find_vendor("ur"), cell.robot)
    handling, run = handling_of(program, cell), controller.run(program)
    dense = Controller(find_vendor("ur"), cell.robot, controller.model, DENSE).plan(program)
    fault = worst_fault(cell, handling, dense, clearance)
    scenes = HandledScenes(PartScenes(cell), handling, run.program, run.path, clearance)
    made = certify(controller, run, scenes, clearance)
    met = nearest_of(ClearanceMeter(cell, program, handling).over(run.path, 0))
    checked = all(x is None or not (x.overlaps or x.distance < clearance - 1e-5) for x in met)
    if fault.by > TOLERANCE + 1e-6:
        assert made.verdict is Verdict.VIOLATED and not checked
    if fault.by < -1.5e-3:
        assert made.proven and checked
