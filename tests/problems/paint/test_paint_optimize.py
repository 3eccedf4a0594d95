"""The full optimisation: on plates it reaches what it is meant to, keeps every limit, and can be
told what counts."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flyby.core.sqp import Status
from flyby.problems.paint.coating.coat import coat
from flyby.problems.paint.coating.deposition import Deposition
from flyby.problems.paint.spray.trajectory import PaintTrajectory
from flyby.problems.paint.thickness.optimize import PaintSolution, optimize
from flyby.problems.paint.thickness.options import OuterLoop, PaintLimits, PaintWeights
from flyby.problems.paint.thickness.reference import ReferencePlanes
from flyby.problems.paint.thickness.robust import PaintErrors, scenarios

from .paint_cases import TARGET, plate, plate_case

MICRON = 1e-6


def held(found: PaintSolution, start: PaintTrajectory, limits: PaintLimits) -> None:
    """Every limit, from the trajectory itself."""
    after, reference = found.trajectory, ReferencePlanes.below(start, 0.25)
    slack = 1e-3
    distance = after.position[:, 2]
    assert limits.distance[0] - slack * 0.1 <= distance.min()
    assert distance.max() <= limits.distance[1] + slack * 0.1
    assert reference.tilt(after).max() <= limits.tilt + 1e-9
    assert after.speeds.min() >= limits.speed[0] * (1 - 1e-9)
    assert after.speeds.max() <= limits.speed[1] * (1 + 1e-9)
    assert after.lengths.min() >= limits.step[0] - slack * 0.1
    assert after.lengths.max() <= limits.step[1] + slack * 0.1
    away = np.linalg.norm(after.position - start.position, axis=1)
    assert away.max() <= limits.deviation * (1 + 1e-9)


@pytest.mark.parametrize(
    ("radius", "deviation", "std"), [(0.25, 0.1, 0.25), (0.225, 0.1, 0.30), (0.25, 0.05, 0.30)]
)
def test_plates_get_even(radius, deviation, std):
    """Optimised on 25² points, judged on 101²."""
    deposition, start = plate_case(radius, 25)
    limits = PaintLimits(deviation=deviation)
    found = optimize(deposition, start, TARGET, ReferencePlanes.below(start, 0.25), limits=limits)
    fine = Deposition(plate(101), deposition.footprint, 12)
    after = coat(fine, found.trajectory, TARGET).by_area
    assert after.std <= std * MICRON
    assert after.within_5_percent == 1.0
    assert abs(after.mean - TARGET) < 0.1 * MICRON
    assert found.violation <= 1e-3
    assert list(found.objective) == sorted(found.objective, reverse=True)
    held(found, start, limits)


def test_tight_limits_hold():
    deposition, start = plate_case(0.25, 21)
    limits = PaintLimits(
        distance=(0.24, 0.26),
        tilt=math.radians(3.0),
        speed=(0.2, 0.3),
        step=(0.06, 0.14),
        deviation=0.02,
    )
    loop = OuterLoop(rounds=2, iterations=3, position=0.02)
    found = optimize(
        deposition, start, TARGET, ReferencePlanes.below(start, 0.25), limits=limits, loop=loop
    )
    held(found, start, limits)
    assert found.after.by_area.std < 0.9 * found.before.by_area.std


def test_a_shorter_time_can_be_bought():
    deposition, start = plate_case(0.25, 17)
    reference = ReferencePlanes.below(start, 0.25)
    loop = OuterLoop(rounds=2, iterations=2)
    plain = optimize(deposition, start, TARGET, reference, loop=loop)
    hurried = optimize(
        deposition, start, TARGET, reference, loop=loop, weights=PaintWeights(time=0.5)
    )
    sparing = optimize(
        deposition, start, TARGET, reference, loop=loop, weights=PaintWeights(paint=20.0)
    )
    assert hurried.after.duration < plain.after.duration - 0.3
    assert sparing.after.transfer_efficiency > plain.after.transfer_efficiency + 0.01
    assert hurried.after.by_area.std > plain.after.by_area.std


def test_robust_trajectories_stand_errors_better():
    deposition, start = plate_case(0.25, 17)
    reference = ReferencePlanes.below(start, 0.25)
    errors = PaintErrors(height=0.01, radius=0.03)
    cases = scenarios(deposition, errors)

    def expected(trajectory: PaintTrajectory) -> float:
        return sum(
            case.weight * coat(case.deposition, trajectory, TARGET).squared_error for case in cases
        )

    loop = OuterLoop(rounds=3, iterations=2)
    plain = optimize(deposition, start, TARGET, reference, loop=loop)
    robust = optimize(deposition, start, TARGET, reference, loop=loop, errors=errors)
    assert expected(robust.trajectory) < expected(plain.trajectory)


def test_gun_stays_off_where_it_is_off():
    deposition, start = plate_case(0.25, 21)
    flow = start.flow.copy()
    flow[12:14] = 0.0
    off = start.with_flow(flow)
    found = optimize(
        deposition, off, TARGET, ReferencePlanes.below(off, 0.25), loop=OuterLoop(rounds=1)
    )
    assert np.array_equal(found.trajectory.flow, flow)
    assert found.after.by_area.std < 0.5 * found.before.by_area.std


def test_the_reference_is_asked_each_round():
    deposition, start = plate_case(0.25, 15)
    asked = []

    def surroundings(trajectory: PaintTrajectory) -> ReferencePlanes:
        asked.append(trajectory)
        foot = trajectory.position * (1.0, 1.0, 0.0)
        return ReferencePlanes(foot, np.tile((0.0, 0.0, 1.0), (len(foot), 1)))

    loop = OuterLoop(rounds=3, iterations=1, enough=0.0)
    optimize(deposition, start, TARGET, surroundings, loop=loop)
    assert asked[0] is start
    assert len(asked) == 3


def test_what_is_hidden_gets_paint_from_elsewhere():
    """Half of the plate is hidden from every other segment; the mask follows the trajectory."""
    deposition, start = plate_case(0.25, 15)

    def sight(trajectory: PaintTrajectory) -> np.ndarray:
        seen = np.ones((deposition.samples.size, trajectory.segments), dtype=bool)
        seen[: deposition.samples.size // 2, ::2] = False
        return seen

    reference, loop = ReferencePlanes.below(start, 0.25), OuterLoop(rounds=2, iterations=2)
    found = optimize(deposition, start, TARGET, reference, sight=sight, loop=loop)
    hidden = deposition.with_visible(sight(start))
    assert found.before.by_area == coat(hidden, start, TARGET).by_area
    assert found.after.by_area == coat(hidden, found.trajectory, TARGET).by_area
    assert found.after.by_area.std < 0.2 * found.before.by_area.std


def test_interrupting_keeps_the_best_so_far():
    deposition, start = plate_case(0.25, 15)
    seen = []

    def progress(number: int, iteration: object) -> bool:
        seen.append(number)
        return len(seen) > 4

    found = optimize(
        deposition, start, TARGET, ReferencePlanes.below(start, 0.25), progress=progress
    )
    assert found.interrupted
    assert found.status is Status.INTERRUPTED
    assert found.after.by_area.std < found.before.by_area.std
    held(found, start, PaintLimits())
