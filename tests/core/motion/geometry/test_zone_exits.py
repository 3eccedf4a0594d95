"""Where joint lines leave zones."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.geometry.zone_exits import first_exit, ways
from flyby.core.program.tool import FLANGE, WORLD
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.core.robot.work_chain import work_chain


def lines(arm, seed: int):
    """The arm's chain and both ends of a joint line."""
    random = np.random.default_rng(seed)
    q = np.array(arm.start.joints)
    return work_chain(arm.robot, FLANGE, WORLD), q, q + random.uniform(-0.6, 0.6, len(q))


def apart(chain, q0, q1, shares):
    """m, between the TCP at the line's beginning and at shares of it."""
    q = (1 - shares)[:, None] * q0 + shares[:, None] * q1
    return np.linalg.norm(poses(chain, q)[1] - poses(chain, q0[None])[1], axis=1)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), radius=st.floats(1e-4, 0.5))
def test_a_line_leaves_a_zone_where_its_radius_is_first_met(abb, seed, radius) -> None:
    chain, q0, q1 = lines(abb, seed)
    share, _, _, _ = first_exit(chain, q0, q1, radius, 1.0)
    before = np.linspace(0.0, 1.0 if share < 0.0 else share * (1 - 1e-9), 400)
    assert apart(chain, q0, q1, before).max() < radius
    if share >= 0.0:
        assert abs(apart(chain, q0, q1, np.array([share]))[0] - radius) < 1e-14


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10_000), radius=st.floats(0.01, 0.2), joint=st.integers(0, 5))
def test_how_an_exit_changes_with_the_ends_of_its_line(abb, seed, radius, joint) -> None:
    chain, q0, q1 = lines(abb, seed)
    share, by_near, by_far, speed = first_exit(chain, q0, q1, radius, 1.0)
    if share < 0.0 or speed < 0.05:
        return
    step = np.zeros(len(q0))
    step[joint] = 1e-6
    for slope, ends in (
        (by_near, ((q0 - step, q1), (q0 + step, q1))),
        (by_far, ((q0, q1 - step), (q0, q1 + step))),
    ):
        less, more = (first_exit(chain, *pair, radius, 1.0)[0] for pair in ends)
        assert abs((more - less) / 2e-6 - slope[joint]) < 1e-5 * (1.0 + abs(slope[joint]))


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 10_000), share=st.floats(0.1, 1.0))
def test_ways_are_measured_from_both_ends(abb, seed, share) -> None:
    chain, q0, q1 = lines(abb, seed)
    distance, _ = ways(chain, np.array([[q0, q1]]), share)
    shares = np.array([share])
    expected = apart(chain, q0, q1, shares)[0], apart(chain, q1, q0, shares)[0]
    np.testing.assert_allclose(distance[0], expected, rtol=1e-12)
