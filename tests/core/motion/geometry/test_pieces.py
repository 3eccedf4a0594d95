"""Where paths are sampled: near stops finer, as speeds begin to change at samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose

HOME = (0.3, 0.3, 0.4, 0.6, -0.5, -0.5)


@pytest.fixture(scope="module")
def controller() -> Controller:
    return Controller(find_vendor("abb"), find_robot("abb/irb6640-180-255"))


def lines(controller: Controller, lengths: list[float], speed: float, zone=FINE) -> Program:
    """There and back along the base's y axis."""
    pose = controller.robot.flange_pose(np.array(HOME))
    x, y, z = pose.position
    moves = []
    for number, length in enumerate(lengths):
        y += length if number % 2 else -length
        target = PoseTarget(Pose((x, y, z), pose.quaternion))
        moves.append(MoveL(target, Speed(tcp=speed, reorientation=5.0), zone))
    moves[-1] = replace(moves[-1], zone=FINE)
    return Program(tuple(moves), start=JointTarget(HOME))


@settings(max_examples=25, deadline=None)
@given(
    lengths=st.lists(st.floats(0.002, 0.5), min_size=1, max_size=4),
    near=st.integers(0, 12),
    halvings=st.integers(0, 9),
    stops=st.booleans(),
)
def test_samples_rise_from_edge_to_edge(controller, lengths, near, halvings, stops) -> None:
    sampling = Sampling(step=0.01, approach=6, near=near, halvings=halvings)
    dense = Controller(find_vendor("abb"), controller.robot, controller.model, sampling)
    pieces = dense.plan(lines(controller, lengths, 0.5, FINE if stops else Radius(0.01))).pieces
    assert len(pieces.sample_shares) == pieces.first_sample[-1]
    for first, last in zip(pieces.first_sample[:-1], pieces.first_sample[1:], strict=True):
        shares = pieces.sample_shares[first:last]
        assert shares[0] == 0.0 and shares[-1] == 1.0 and (np.diff(shares) > 0.0).all()


@pytest.mark.parametrize("speed", [0.2, 0.3, 0.5, 0.6])
def test_a_stop_takes_the_time_of_its_limits(controller, speed) -> None:
    """Without finer samples near stops this takes 0.7 to 3.4 ms too long."""
    program = lines(controller, [0.4, 0.4], speed)
    dense = Sampling(step=5e-4, approach=6, most=2000)
    exact = Controller(find_vendor("abb"), controller.robot, controller.model, dense)
    ideal = exact.stamp(program, exact.plan(program)).stamp.t[-1]
    found = controller.stamp(program, controller.plan(program)).stamp.t[-1]
    assert found == pytest.approx(ideal, abs=2.5e-4)
