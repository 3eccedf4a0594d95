"""What masses on the axes of an arm's joints ask of the joints before them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.model.point_masses import MassLoads, mass_loads, pull_mass_loads
from flyby.core.registry import find_robot
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import Pose

MASSES = [(3, (0.4, -0.3)), (5, (0.2, 0.5, 0.1, 0.7)), (3, (0.1, 0.1))]
TRACK = Joint(
    "track", Pose((0.0, 0.0, 0.1)), (0.0, 1.0, 0.0), -2, 2, 1, 2, kind=JointKind.PRISMATIC
)


def arm(track: bool) -> Robot:
    robot = find_robot("abb/irb6640-180-255")
    return robot.with_external_axes([ExternalAxis(TRACK, ExternalRole.TRACK)]) if track else robot


def states(size: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return rng.uniform(-1.2, 1.2, (3, size)), *rng.normal(size=(2, 3, size))


def points(robot: Robot, joint: int, q: np.ndarray) -> np.ndarray:
    """(3,), the origin of an arm's joint in the world, by plain algebra."""
    chain = robot.chain
    at, turned = np.zeros(3), np.eye(3)
    for k, j in enumerate(chain.joint):
        at = at + turned @ chain.translation[k]
        turned = turned @ chain.rotation[k]
        if j == joint - 1:
            return at
        axis, value = chain.sign[k] * chain.axis[k], q[j]
        if chain.prismatic[k]:
            at = at + turned @ axis * value
            continue
        x, y, z = axis
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        turn = np.eye(3) + np.sin(value) * cross + (1 - np.cos(value)) * cross @ cross
        turned = turned @ turn
    raise AssertionError


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 999), track=st.booleans())
def test_loads_are_those_of_difference_quotients(seed, track) -> None:
    robot = arm(track)
    q, dq, ddq = states(robot.size, seed)
    made = mass_loads(robot, MASSES, "carried", q, dq, ddq)
    h = 1e-4
    for m in range(len(q)):
        along, across, held = np.zeros((3, robot.size))
        for joint, weights in MASSES:
            w = np.zeros(robot.size)
            w[: len(weights)] = weights

            def place(t, joint=joint, m=m):
                return points(robot, joint, q[m] + t * dq[m] + 0.5 * t * t * ddq[m])

            J = np.empty((3, robot.size))
            for j, step in enumerate(np.eye(robot.size) * h):
                after, before = points(robot, joint, q[m] + step), points(robot, joint, q[m] - step)
                J[:, j] = (after - before) / (2 * h)
            along += w * (J.T @ (place(h) - place(-h)) / (2 * h))
            across += w * (J.T @ (place(h) - 2 * place(0.0) + place(-h)) / h**2)
            held += w * (J.T @ np.array(robot.gravity))
        np.testing.assert_allclose(made.along[m], along, atol=1e-5)
        np.testing.assert_allclose(made.across[m], across, atol=1e-5)
        np.testing.assert_allclose(made.held[m], held, atol=1e-5)


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 999), track=st.booleans())
def test_the_reverse_pass_is_the_gradient(seed, track) -> None:
    robot = arm(track)
    own, rng = states(robot.size, seed), np.random.default_rng(seed + 1)
    bars = MassLoads(*rng.normal(size=(3, *own[0].shape)))
    found = tuple(np.zeros_like(own[0]) for _ in range(3))
    pull_mass_loads(robot, MASSES, "carried", own, bars, found)

    def value(changed) -> float:
        loads = mass_loads(robot, MASSES, "carried", *changed)
        return sum(float(np.sum(bar * load)) for bar, load in zip(bars, loads, strict=True))

    way = rng.normal(size=(3, *own[0].shape))
    h = 1e-6
    after, before = (
        value([a + step * b for a, b in zip(own, way, strict=True)]) for step in (h, -h)
    )
    slope = sum(float(np.sum(a * b)) for a, b in zip(found, way, strict=True))
    assert slope == pytest.approx((after - before) / (2 * h), rel=1e-6, abs=1e-6)


def test_a_joint_that_the_arm_lacks_is_named() -> None:
    robot = arm(False)
    q, dq, ddq = states(robot.size, 0)
    with pytest.raises(InputError, match=r"carried: .* has 6 joints, no joint 7"):
        mass_loads(robot, [(7, (1.0,))], "carried", q, dq, ddq)
