"""The plane under the base, where nothing else is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.cell.floor import FLOOR, bare_cell
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.program.tool import FLANGE, Tool
from flyby.core.registry import installed
from flyby.core.spatial.pose import Pose

ROBOTS = installed().robot_names
TILTED = Pose((1.0, -2.0, 3.0), (0.8, 0.6, 0.0, 0.0))


@pytest.mark.parametrize("name", ROBOTS)
def test_what_is_beyond_the_plane_collides_and_nothing_else(name: str) -> None:
    """However the base is mounted: by the flange's height above the plane."""
    robot = installed().find_robot(name).with_base(TILTED)
    scene = CollisionScene(bare_cell(robot, "any"))
    limits = robot.limits
    rows = np.random.default_rng(1).uniform(limits.lower, limits.upper, (200, robot.size))
    heights = [(TILTED.inverse() @ robot.flange_pose(q)).position[2] for q in rows]
    floor = [k for k in range(len(scene.pairs)) if FLOOR in scene.pair_names(k)]
    assert floor
    nearest = scene.distances(rows).distance[:, floor].min(axis=1)
    below = np.array(heights) < -2e-3
    # Some arms cannot come below the plane that they stand on at all.
    assert (nearest[below] < 0.0).all()
    assert (nearest > 0.0).any()


def test_a_tcp_keeps_off_the_plane_and_may_touch_it() -> None:
    robot = installed().find_robot("ur/ur5e")
    pen = Tool("pen", Pose((0.0, 0.0, 0.2)))
    scene = CollisionScene(bare_cell(robot, "ur", [FLANGE, pen]), pen)
    pairs = [set(scene.pair_names(k)) for k in range(len(scene.pairs))]
    assert {"pen", FLOOR} in pairs
    assert not any("pen" in pair for pair in pairs if FLOOR not in pair)

    def distance(height: float) -> float:
        down = Pose((0.4, 0.2, height), (0.0, 1.0, 0.0, 0.0))
        q = robot.inverse(down @ pen.tcp.inverse())[0].q
        found = scene.distances(q[None]).distance[0]
        return float(found[pairs.index({"pen", FLOOR})])

    assert distance(0.0) > 0.0 > distance(-0.002)


def test_a_base_that_counts_from_higher_up_has_its_floor_lower() -> None:
    """FANUC and Yaskawa count from the height of the second axis."""
    robot = replace(installed().find_robot("ur/ur5e"), base_height=0.3).with_base(TILTED)
    pen = Tool("pen", Pose((0.0, 0.0, 0.2)))
    scene = CollisionScene(bare_cell(robot, "ur", [pen]), pen)
    k = [set(scene.pair_names(k)) for k in range(len(scene.pairs))].index({"pen", FLOOR})
    for height, free in ((-0.1, True), (-0.3, True), (-0.302, False)):
        down = TILTED @ Pose((0.4, 0.2, height), (0.0, 1.0, 0.0, 0.0))
        q = robot.inverse(down @ pen.tcp.inverse())[0].q
        assert (scene.distances(q[None]).distance[0, k] > 0.0) == free


def test_the_floor_can_be_lifted() -> None:
    robot = installed().find_robot("ur/ur5e")
    assert bare_cell(robot, "ur", floor=False).obstacles == ()
