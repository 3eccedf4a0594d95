"""Zones that legs drive superposed: against the superposition itself, and between samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.emulator.binding_limits import limit_shares
from flyby.core.motion.model.blend import TANGENT_ARC
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import LineTurn, Pace
from flyby.core.motion.timing.superposed_legs import ZONE
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor

SUPERPOSED = MotionModel(pace=Pace.SUPERPOSED)
ARCS = MotionModel(pace=Pace.SUPERPOSED, tcp=TANGENT_ARC)
LEG, RADIUS, A = 0.25, 0.05, 0.6
"""m, m, m/s²: legs that never come to their programmed speed."""


def corner(arm, deflection: float, **numbers: float) -> Program:
    """Two lines of `LEG` that deflect by an angle, without turns of the tool."""
    speed = Speed(**{"tcp": 5.0, "tcp_acceleration": A, **numbers})
    share = LEG / arm.leg
    end = share * np.array([1 + np.cos(deflection), np.sin(deflection), 0.0])
    moves = (
        MoveL(arm.target((share, 0, 0)), speed, Radius(RADIUS)),
        MoveL(arm.target(tuple(end)), speed, FINE),
    )
    return Program(moves, start=arm.start)


def driven(arm, model: MotionModel, program: Program):
    """The run, its times every millisecond, and the TCP (T, 3) there, the start at zero."""
    run = arm.controller(model).run(program)
    t = np.linspace(0.0, run.timing.duration, 1 + round(1e3 * run.timing.duration))
    q = run.timing.states_at(t)[0]
    place = arm.robot.forward(q)[1]
    return run, t, place - place[0]


def trapezoid(t: np.ndarray) -> np.ndarray:
    """The way along a leg from rest to rest, t seconds after its start."""
    half = np.sqrt(LEG / A)
    rising = 0.5 * A * np.clip(t, 0, half) ** 2
    rest = np.clip(t, half, 2 * half) - half
    return rising + rest * A * half - 0.5 * A * rest**2


@settings(max_examples=8, deadline=None)
@given(deflection=st.floats(0.05, 3.0))
def test_a_parabola_is_driven_as_its_legs_superposed(abb, deflection) -> None:
    """The second leg begins where the first one is `RADIUS` before its end."""
    run, t, place = driven(abb, SUPERPOSED, corner(abb, deflection))
    begin = 2 * np.sqrt(LEG / A) - np.sqrt(2 * RADIUS / A)
    first = np.array([1.0, 0.0, 0.0])
    second = np.array([np.cos(deflection), np.sin(deflection), 0.0])
    wanted = trapezoid(t)[:, None] * first + trapezoid(t - begin)[:, None] * second
    # Speeds peak between samples.
    assert np.abs(place - wanted).max() < 2e-3
    assert run.timing.duration == pytest.approx(begin + 2 * np.sqrt(LEG / A), rel=2e-3)


@settings(max_examples=8, deadline=None)
@given(deflection=st.floats(0.1, 2.5))
def test_an_arc_is_driven_at_the_speed_of_its_entry(abb, deflection) -> None:
    _, t, place = driven(abb, ARCS, corner(abb, deflection))
    speed = np.linalg.norm(np.gradient(place, t, axis=0), axis=1)
    apex = np.linalg.norm(place - LEG * np.array([1.0, 0, 0]), axis=1).argmin()
    near = np.abs(t - t[apex]) < 0.4 * RADIUS / speed[apex]
    np.testing.assert_allclose(speed[near], np.sqrt(2 * A * RADIUS), rtol=4e-3)
    centripetal = replace(ARCS, centripetal=0.5)
    _, t, place = driven(abb, centripetal, corner(abb, deflection))
    speed = np.linalg.norm(np.gradient(place, t, axis=0), axis=1)
    bound = 0.5 * A * RADIUS / np.tan(0.5 * deflection)
    wanted = np.sqrt(min(2 * A * RADIUS, bound))
    apex = np.linalg.norm(place - LEG * np.array([1.0, 0, 0]), axis=1).argmin()
    assert speed[apex] == pytest.approx(wanted, rel=4e-3)


def test_programmed_speeds_hold_in_zones_and_stamps_know_what_binds(abb) -> None:
    slow = driven(abb, SUPERPOSED, corner(abb, 1.0, tcp=0.1))[0]
    x = np.linalg.norm(np.gradient(slow.trajectory.position, slow.trajectory.t, axis=0), axis=1)
    assert x.max() < 0.1 * 1.002
    assert not (slow.timing.path_limits.binding[:, 1] == ZONE).any()
    run = driven(abb, SUPERPOSED, corner(abb, 1.0))[0]
    assert {"corner", "programmed TCP acceleration"} <= {
        share.name for shares in limit_shares(run, abb.robot.axis_names) for share in shares
    }


@settings(max_examples=6, deadline=None)
@given(seed=st.integers(0, 1000), arcs=st.booleans())
def test_there_and_back_take_the_same_time(abb, seed, arcs) -> None:
    """With turns of the tool, whose shares of the legs differ, and a programmed speed for each."""
    rng = np.random.default_rng(seed)
    at = [((k + 0.3 * rng.normal()) * 0.7, *(0.5 * rng.normal(size=2))) for k in range(4)]
    turns = 0.2 * rng.normal(size=(4, 3))
    zones = [Radius(0.3 * rng.uniform(0.1, 1.0) * abb.leg) for _ in range(2)]
    speeds = [Speed(tcp=v, tcp_acceleration=A) for v in rng.uniform(0.2, 2.0, 3)]
    model = replace(
        ARCS if arcs else SUPERPOSED, reorientation_acceleration=0.7, line_turn=LineTurn.SWIVEL
    )

    def there(order, zones, speeds):
        begin, *others = (abb.target(at[k], tuple(turns[k])) for k in order)
        moves = [MoveJ(begin, Speed(), FINE)]
        for goal, speed, zone in zip(others, speeds, [*zones, FINE], strict=True):
            moves.append(MoveL(goal, speed, zone))
        run = abb.controller(model).run(Program(tuple(moves), start=abb.start))
        return run.timing.segment_durations()[1:]

    forth = there([0, 1, 2, 3], zones, speeds)
    back = there([3, 2, 1, 0], zones[::-1], speeds[::-1])
    assert forth.sum() == pytest.approx(back.sum(), rel=2e-3)


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 1000))
def test_joint_limits_hold_between_samples(abb, seed) -> None:
    rng = np.random.default_rng(seed)
    speed = Speed(tcp=7.0, reorientation=20.0, tcp_acceleration=40.0)
    offsets = rng.uniform(-0.8, 0.8, (3, 3))
    moves = tuple(
        MoveL(abb.target(tuple(o), tuple(0.2 * rng.normal(size=3))), speed, zone)
        for o, zone in zip(offsets, (Radius(0.05), Radius(0.1), FINE), strict=True)
    )
    controller = abb.controller(SUPERPOSED)
    run = controller.run(Program(moves, start=abb.start))
    t = np.linspace(0, run.timing.duration, 5000)
    ddq = run.timing.states_at(t)[2]
    assert (np.abs(ddq) / abb.robot.limits.acceleration).max() < 1.1


def test_keys_of_the_file(tmp_path) -> None:
    path = tmp_path / "motion.toml"
    path.write_text(
        '[zone]\npace = "superposed"\n[line]\nturn = "swivel"\n[limit]\ncentripetal = 1.5\n'
    )
    model = load_motion_model(path)
    assert (model.pace, model.centripetal) == (Pace.SUPERPOSED, 1.5)
    assert model.line_turn is LineTurn.SWIVEL
    stated = {"zone.pace", "line.turn", "limit.centripetal"}
    assert stated <= model.figures
    assert not stated & MotionModel().figures
    path.write_text("[limit]\ncentripetal = 0.0\n")
    with pytest.raises(InputError, match="centripetal"):
        load_motion_model(path)


@pytest.mark.parametrize("name", ["kuka/kr3-r540", "ur/ur10e"])
def test_what_logs_showed_of_the_controllers(name) -> None:
    """Guards the files: corner speeds, and how fast a KUKA turns."""
    model = find_vendor(name.split("/")[0]).motion_of(find_robot(name))
    assert model.pace is Pace.SUPERPOSED
    if name.startswith("kuka"):
        assert model.line_turn is LineTurn.SWIVEL
        assert model.reorientation_acceleration == pytest.approx(np.radians(100.0))
    else:
        assert model.centripetal == pytest.approx(1.2)
