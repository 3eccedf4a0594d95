"""Ceilings that keep velocity limits between samples, and their reverse."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.motion.path.tcp_samples import States
from flyby.core.motion.timing.between_samples import BETWEEN, lower_between, pull_between
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius


@pytest.fixture
def timing(arm):
    """There and nearly back, so that the TCP all but turns back in a corner of the joints."""
    speed = Speed(tcp=0.05, reorientation=0.3)
    moves = (
        MoveJ(arm.joints([0.3, 0.05, 0, 0, 0, 0]), speed, Radius(0.3 * arm.leg)),
        MoveJ(arm.joints([0, 0.1, 0.01, 0, 0, 0.1]), speed, FINE),
    )
    return arm.controller().run(Program(moves, start=arm.start)).timing


def lowered(timing, states: States, spacing, velocity) -> tuple[np.ndarray, np.ndarray]:
    ceiling = np.full(len(spacing) + 1, np.inf)
    ceiling[[0, -1]] = 0.0
    binding = np.full((len(ceiling), 3), -1, dtype=np.int64)
    lower_between(states, spacing, timing.path.pieces.indices, velocity, ceiling, binding)
    return ceiling, binding


def test_speeds_would_be_passed_without(timing) -> None:
    _, binding = lowered(timing, timing.along.states, timing.along.spacing, timing.limits.velocity)
    assert (binding[:, 1] >= BETWEEN).any()


@pytest.mark.parametrize("part", [*States._fields, "spacing", "velocity"])
def test_the_reverse_is_the_slope(timing, part) -> None:
    rng = np.random.default_rng(1)
    states, spacing = timing.along.states, timing.along.spacing
    velocity = timing.limits.velocity.copy()
    if part in ("q", "dq", "ddq"):
        velocity[:, -2:] = np.inf
    ceiling, binding = lowered(timing, states, spacing, velocity)
    weights = np.where(np.isfinite(ceiling), rng.normal(size=len(ceiling)), 0.0)
    bars = States(*(np.zeros_like(array) for array in states))
    by_spacing, by_velocity = np.zeros_like(spacing), np.zeros_like(velocity)
    pull_between(
        states,
        spacing,
        timing.path.pieces.indices,
        velocity,
        ceiling,
        binding,
        weights,
        bars,
        by_spacing,
        by_velocity,
    )
    given = {**states._asdict(), "spacing": spacing, "velocity": velocity}
    claimed = {**bars._asdict(), "spacing": by_spacing, "velocity": by_velocity}[part]
    assert claimed.any()
    step = 1e-7 * np.where(np.isfinite(given[part]), rng.normal(size=given[part].shape), 0.0)
    step *= np.maximum(np.abs(np.where(np.isfinite(given[part]), given[part], 0.0)), 1e-3)
    sides = []
    for sign in (1, -1):
        moved = {**given, part: given[part] + sign * step}
        made, _ = lowered(
            timing,
            States(*(moved[name] for name in States._fields)),
            moved["spacing"],
            moved["velocity"],
        )
        known = np.isfinite(ceiling)
        sides.append(weights[known] @ made[known])
    slope, expected = 0.5 * (sides[0] - sides[1]), float(np.sum(claimed * step))
    assert slope == pytest.approx(expected, rel=1e-4, abs=1e-12 * abs(sides[0]) + 1e-12)
