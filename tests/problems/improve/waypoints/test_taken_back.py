"""Changes that bring nothing are taken back, all others stay."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.collision.proof.certificate import scenes_of
from flyby.core.motion.emulator.run import Run
from flyby.core.program.program import Program
from flyby.core.program.zone import Radius
from flyby.problems.improve.solve_round_verify import ProgramFeasibility
from flyby.problems.improve.waypoints.options import WaypointTask
from flyby.problems.improve.waypoints.taken_back import without_idle_changes
from flyby.problems.improve.waypoints.via_selection import Counted
from flyby.validation.scenes.scene import PARABOLAS, with_zone
from flyby.validation.scenes.two_joints import two_joints

SCENE = two_joints()
BEFORE = with_zone(SCENE.programs[0], Radius(0.05))
CONTROLLER = SCENE.controller(PARABOLAS)
FEASIBILITY = ProgramFeasibility(CONTROLLER, scenes_of(SCENE.cell), SCENE.cell.clearance, 1e-4)
GIVEN = CONTROLLER.run(BEFORE, None)
TASK = WaypointTask(axes=SCENE.free)


def judged(program: Program) -> Counted | None:
    run, proof = FEASIBILITY.verified(program)
    if run is None or proof is None or not proof.proven:
        return None
    return Counted(run, proof, run.duration / GIVEN.duration, TASK)


def changed(radii: list[float | None]) -> Counted | None:
    """The program with these radii, m, at its first waypoints; None where it stays."""
    moves = list(BEFORE.moves)
    for i, radius in enumerate(radii[: len(moves) - 1]):
        if radius is not None:
            moves[i] = replace(moves[i], zone=Radius(radius))
    return judged(BEFORE.with_moves(tuple(moves)))


def zones(run: Run) -> list[object]:
    return [move.zone for move in run.program.moves]


def test_what_brings_nothing_is_as_it_was_and_what_pays_stays() -> None:
    idle, paying = 0.0499999, 0.09
    found = changed([idle, paying])
    assert found is not None
    assert found.cost < 0.999
    kept = without_idle_changes(GIVEN, found, judged)
    assert zones(kept.run)[:2] == [Radius(0.05), Radius(paying)]


def test_where_nothing_pays_the_program_is_as_it_was() -> None:
    found = changed([0.0499999, 0.0499998])
    assert found is not None
    assert without_idle_changes(GIVEN, found, judged).run.program == BEFORE


@settings(max_examples=10, deadline=None)
@given(st.lists(st.none() | st.floats(0.03, 0.09), min_size=2, max_size=3))
def test_next_to_nothing_is_lost(radii: list[float | None]) -> None:
    found = changed(radii)
    if found is None:
        return
    kept = without_idle_changes(GIVEN, found, judged)
    assert kept.certificate.proven
    assert kept.cost <= found.cost * (1.0 + 1.0001e-4)
    for old, new, was in zip(zones(kept.run), zones(found.run), zones(GIVEN), strict=True):
        assert old in (new, was)
