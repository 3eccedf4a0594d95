"""What the emulation checks measure with is right."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.testing import observation
from flyby.testing.observation import Observed, at_speed, away_from_legs, outside_zones

POINT = st.tuples(*[st.floats(-1, 1)] * 3).map(np.array)
ROBOT = find_robot("abb/irb1600-6-145")
HOME = JointTarget((0.0, 0.2, 0.3, 0.0, 0.9, 0.0))
AT = ROBOT.flange_pose(np.array(HOME.joints))


@given(POINT, POINT, POINT, st.floats(0, 6.2), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_the_distance_from_a_circle(centre, x, y, angle, out, up) -> None:
    normal = np.cross(x, y)
    assume(np.linalg.norm(normal) > 0.1 and np.linalg.norm(x) > 0.6)
    x = x / np.linalg.norm(x)
    z = normal / np.linalg.norm(normal)
    y = np.cross(z, x)

    def at(turn: float) -> np.ndarray:
        return centre + np.cos(turn) * x + np.sin(turn) * y

    point = at(angle) + out * (at(angle) - centre) + up * z
    found = observation._away_from_circle(point[None], at(0.3), at(1.2), at(2.5))
    np.testing.assert_allclose(found, np.hypot(out, up), atol=1e-9)


@given(POINT, POINT, POINT)
def test_the_nearest_point_of_a_stretch(x, start, end) -> None:
    found = observation._nearest_on_line(x[None], start, end)[0]
    others = start + np.linspace(0, 1, 101)[:, None] * (end - start)
    assert np.linalg.norm(x - found) <= np.linalg.norm(x - others, axis=1).min() + 1e-12


def corner(zone) -> Observed:
    def at(x: float, y: float) -> PoseTarget:
        position = tuple(np.add(AT.position, (x, y, 0.0)))
        return PoseTarget(Pose(position, AT.quaternion))

    speed = Speed(0.3, 2.0)
    moves = MoveL(at(0.1, 0), speed, zone), MoveL(at(0.1, 0.1), speed, FINE)
    program = Program(moves, start=HOME)
    return Observed.of(ROBOT, Controller(find_vendor("abb"), ROBOT, MotionModel()).run(program))


def test_a_parabola_is_away_by_what_its_formula_says() -> None:
    """At the apex the parabola is r/4 from either leg."""
    seen = corner(Radius(0.04))
    away = away_from_legs(seen)
    outside = outside_zones(seen, MotionModel(), False)
    np.testing.assert_allclose(away.max(), 0.01, rtol=1e-3)
    assert 0.2 < outside.mean() < 0.9
    assert away[outside].max() < 1e-8


def test_without_a_zone_everything_is_outside_and_on_the_legs() -> None:
    seen = corner(FINE)
    assert outside_zones(seen, MotionModel(), False).all()
    assert away_from_legs(seen).max() < 1e-8


def test_zones_are_cut_half_way() -> None:
    seen = corner(Radius(0.08))
    assert np.isclose(observation.effective_radius(seen, MotionModel(), 0, False), 0.05)


def test_the_twist_is_that_of_the_flange() -> None:
    seen = corner(Radius(0.04))
    assert np.isclose(np.linalg.norm(seen.twist()[:, :3], axis=1).max(), 0.3, rtol=1e-2)


def test_slower_programs_scale_what_they_state_and_nothing_else() -> None:
    speed = Speed(tcp=2.0, tcp_acceleration=4.0, joint_fraction=0.8, name="v2000")
    (move,) = at_speed(Program((MoveJ(HOME, speed),)), 0.5).moves
    expected = Speed(
        tcp=1.0,
        tcp_acceleration=1.0,
        joint_fraction=0.4,
        joint_acceleration_fraction=0.25,
    )
    assert move == replace(move, speed=expected)
