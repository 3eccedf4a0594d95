"""Hulls are those of the arms that vendors list."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.registry import all_listed, find_robot, installed
from flyby.core.robot.hulls import ORIGIN, hulls, reach_of

LISTED = [
    arm
    for vendor in installed().vendors.values()
    for arm in all_listed(vendor)
    if arm.refused is None and arm.reach is not None and arm.payload is not None
]


def test_they_are_drawn_as_those_of_the_lists() -> None:
    """Radii within the mm that the lists round to, at the same places."""
    drawn = 0
    for arm in LISTED:
        robot = find_robot(arm.name)
        if robot.origins.get("shape") != ORIGIN or robot.arm_size != 6:
            continue
        if arm.name.split("/")[0] not in ("abb", "kuka") or len(robot.shapes) != 7:
            continue
        if arm.name in HAND_MADE:
            continue
        made = hulls(robot.joints, robot.flange, robot.payload, arm.reach)
        assert [shape.link for shape in made] == [shape.link for shape in robot.shapes]
        for one, listed in zip(made, robot.shapes, strict=True):
            assert type(one.shape) is type(listed.shape), arm.name
            np.testing.assert_allclose(one.shape.size, listed.shape.size, atol=2.1e-3)
            apart = np.subtract(one.placement.position, listed.placement.position)
            assert np.linalg.norm(apart) < 1e-3, arm.name
        drawn += 1
    assert drawn > 200


HAND_MADE = {
    "abb/irb1200-5-090",
    "abb/irb1600-6-145",
    "abb/irb6640-180-255",
    "abb/irb6640-235-255",
    "abb/irb580-16",  # wider: its hollow wrist is longer than the rule knows
    "kuka/kr3-r540",
    "kuka/kr30-3",
}
"""Drawn one by one, before there was a rule."""


@pytest.mark.parametrize(
    ("name", "reach"), [("kuka/kr8-r2100-2-arc-hw", 2.1), ("kuka/kr10-r1420", 1.42)]
)
def test_the_reach_is_the_published_one(name: str, reach: float) -> None:
    assert reach_of(find_robot(name).joints) == pytest.approx(reach, abs=0.005)
