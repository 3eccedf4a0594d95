"""Zones take at least a while, and so does what is left of a wider one in which the tool turns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.binding_limits import limit_shares
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import OrientationZone
from flyby.core.motion.timing.between_samples import BETWEEN
from flyby.core.motion.timing.least_zone_times import LEAST_TIME
from flyby.core.motion.timing.limits import CENTRIPETAL
from flyby.core.motion.timing.superposed_legs import ZONE
from flyby.core.motion.timing.timed_zones import TIMED
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_vendor

RADIUS = 0.004
"""m"""
FAST = Speed(tcp=5.0, reorientation=1e3)
LEAST = MotionModel(zone_time=0.02, orientation_zone=OrientationZone.OWN)


def lines(arm, turns: list[float], deflection: float = 0.0, wide: float = 1.5) -> Program:
    """Lines of 0.2 of a leg; the tool turns by so many rad on each, about one axis."""
    place, turned, moves = np.zeros(3), 0.0, []
    for k, turn in enumerate(turns):
        place = place + 0.2 * np.array([np.cos(k * deflection), np.sin(k * deflection), 0.0])
        turned += turn
        zone = Radius(RADIUS, wide * RADIUS) if k < len(turns) - 1 else FINE
        moves.append(MoveL(arm.target(tuple(place), (0.0, 0.0, turned)), FAST, zone))
    return Program(tuple(moves), start=arm.start)


def timing(arm, program: Program, least: float):
    controller = arm.controller(replace(LEAST, zone_time=least))
    return controller.stamp(program, controller.plan(program))


def times(timing) -> np.ndarray:
    """s, of each stretch."""
    stretches = timing.path_limits.stretches
    return timing.stamp.t[stretches.last] - timing.stamp.t[stretches.first]


@settings(max_examples=10, deadline=None)
@given(
    least=st.floats(1e-3, 0.1),
    deflection=st.floats(-1.0, 1.0),
    turns=st.lists(st.floats(-0.3, 0.3), min_size=3, max_size=3),
)
def test_no_stretch_takes_less(abb, least, deflection, turns) -> None:
    made = timing(abb, lines(abb, turns, deflection), least)
    assert (times(made) >= least * (1 - 1e-9)).all()


def test_how_many_stretches_a_zone_has(abb) -> None:
    """One where the tool turns on evenly, or with the TCP; three where it turns otherwise."""
    for program, count in (
        (lines(abb, [0.1, 0.1]), 1),
        (lines(abb, [0.0, 0.0]), 1),
        (lines(abb, [0.1, -0.1], wide=1.0), 1),
        (lines(abb, [0.1, -0.1]), 3),
        (lines(abb, [0.1, 0.0]), 3),
    ):
        made = timing(abb, program, 0.08)
        assert times(made).min() == pytest.approx(0.08, rel=0.02)
        assert len(times(made)) == count
        assert (made.path_limits.binding[:, 1] == LEAST_TIME).any()
    assert len(times(timing(abb, lines(abb, [0.1, 0.0]), 0.0))) == 0


def test_speed_goes_with_the_zones_size_and_against_the_time(abb) -> None:
    """Straight on through a zone: twice its radius in that time."""
    for least in (0.04, 0.08, 0.16):
        made = timing(abb, lines(abb, [0.0, 0.0]), least)
        knots = made.path_limits.stretches
        speed = np.linalg.norm(made.along.states.v[:, :3], axis=1)
        at = (knots.first[0] + knots.last[0]) // 2
        sample = made.path.pieces.interval_samples[at]
        assert speed[sample] * np.sqrt(made.stamp.x[at]) == pytest.approx(
            2 * RADIUS / least, rel=1e-6
        )
    assert timing(abb, lines(abb, [0.0, 0.0]), 1e-5).duration < made.duration


def test_what_binds_is_named(abb) -> None:
    run = abb.controller(replace(LEAST, zone_time=0.1)).run(lines(abb, [0.0, 0.0]))
    names = {share.name for shares in limit_shares(run, abb.robot.axis_names) for share in shares}
    assert "corner" in names


def test_what_logs_showed_of_the_controller() -> None:
    """Guards the file: a period of the planner."""
    assert find_vendor("abb").motion().zone_time == pytest.approx(0.004032)


def test_what_stands_for_rows_is_told_apart() -> None:
    """In one column of integers a path says what its ceilings are made of."""
    codes = (ZONE, CENTRIPETAL, LEAST_TIME, TIMED)
    assert len(set(codes)) == len(codes) and max(codes) < -1 < 0 < BETWEEN
