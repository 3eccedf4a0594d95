"""How configurations on paths of all kinds of moves change, against difference quotients."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.gradients.segment_tangents import Directions
from flyby.core.motion.gradients.sensitivity import PathPlaces, Sensitivity, configurations
from flyby.core.motion.path.path import Path
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import WORLD, Tool
from flyby.core.program.zone import FINE, ContourFraction, Radius, Zone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.kinematics.chain_kernels import pose
from flyby.core.robot.work_chain import work_chain
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector, quaternion_from_matrix

POINTS = 4
STEP = 1e-6
LONG = Tool("long", Pose((0.05, 0.0, 0.2), (1.0, 0.0, 0.0, 0.0)), True)


@dataclass(frozen=True)
class Make:
    """A controller, and a configuration with room around it."""

    name: str
    robot: str
    home: tuple[float, ...]

    def controller(self) -> Controller:
        # Dense: places are found between samples.
        sampling = Sampling(step=0.005, turn=0.02, joint=0.02, blend=32)
        return Controller(find_vendor(self.name), find_robot(self.robot), sampling=sampling)


MAKES = (
    Make("abb", "abb/irb6640-180-255", (0.0, 0.3, 0.2, 0.2, 0.9, 0.0)),
    Make("kuka", "kuka/kr30-3", (0.0, -1.4, 1.5, 0.2, 0.9, 0.0)),
    Make("ur", "ur/ur10e", (0.0, -1.5, 1.6, -1.5, -1.5, 0.0)),
)
numbers = st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6)
points = st.lists(numbers, min_size=POINTS, max_size=POINTS)
kinds = st.lists(st.sampled_from("JLCj"), min_size=POINTS, max_size=POINTS)
zones = st.lists(st.floats(0.02, 0.1), min_size=POINTS, max_size=POINTS)


def mixed(
    controller: Controller, make: Make, offsets: FloatArray, sizes: FloatArray, kinds: list[str]
) -> Program:
    """Moves of these kinds to points round home (P, 6), joint targets for ``j``, all passed by."""
    chain = work_chain(controller.robot, LONG, WORLD)
    R, p = np.empty((3, 3)), np.empty(3)
    pose(chain, np.array(make.home), R, p)
    moves: list[Move] = []
    for k, (kind, offset, size) in enumerate(zip(kinds, offsets, sizes, strict=True)):
        zone: Zone = Radius(float(size), 1.5 * float(size), 1.5 * float(size), 0.0)
        if kind in "Jj" and make.name == "kuka":
            zone = ContourFraction(5.0 * float(size))
        zone = FINE if k == POINTS - 1 else zone
        along = np.array([0.0, 0.12, 0.0]) * (2 * k - POINTS)
        shift = along + 0.1 * offset[:3]
        turned = matrix_from_rotation_vector(0.3 * offset[3:]) @ R
        target: PoseTarget | JointTarget = PoseTarget(_pose(p + shift, turned))
        if kind == "j":
            target = JointTarget(tuple(np.array(make.home) + 0.2 * offset + 0.1 * k))
        speed = Speed(tcp=0.8, joint_fraction=0.5)
        common = {"target": target, "speed": speed, "zone": zone, "tool": LONG}
        if kind == "C":
            via = PoseTarget(_pose(p + along + np.array([0.04, -0.12, 0.05]), R))
            moves.append(MoveC(via=via, **common))
        else:
            moves.append((MoveL if kind == "L" else MoveJ)(**common))
    return Program(tuple(moves), start=JointTarget(make.home))


def _pose(position: FloatArray, rotation: FloatArray) -> Pose:
    x, y, z = map(float, position)
    w, i, j, k = map(float, quaternion_from_matrix(rotation))
    return Pose((x, y, z), (w, i, j, k))


def everywhere(path: Path, each: int = 9) -> PathPlaces:
    count = 2 * len(path.segments.scale) - 1
    return PathPlaces(
        np.repeat(np.arange(count), each), np.tile(np.linspace(0.0, 1.0, each), count)
    )


def waypoints(path: Path) -> FloatArray:
    q = path.segments.ends.q
    return np.concatenate([q[:1, 0], q[:, 1]])


@pytest.mark.parametrize("make", MAKES, ids=lambda make: make.name)
@given(points=points, rates=points, kinds=kinds, sizes=zones, seed=st.integers(0, 2**32 - 1))
@settings(max_examples=15, deadline=None)
def test_tangents_are_difference_quotients(
    make: Make,
    points: list[list[float]],
    rates: list[list[float]],
    kinds: list[str],
    sizes: list[float],
    seed: int,
) -> None:
    controller = make.controller()
    size_rates = np.random.default_rng(seed).uniform(-0.1, 0.1, POINTS)

    def at(step: float) -> Path:
        offsets = np.array(points) + step * np.array(rates)
        made = mixed(controller, make, offsets, np.array(sizes) + step * size_rates, kinds)
        return controller.plan(made)

    try:
        before, path, after = at(-STEP), at(0.0), at(STEP)
    except MotionError:
        assume(False)
    assume(len(path.route.moves) == POINTS and (path.segments.scale > 0.05).all())
    assume(all(np.array_equal(one.corners.kind, path.corners.kind) for one in (before, after)))
    places = everywhere(path)
    q0, q1, q2 = (configurations(one, places) for one in (before, path, after))
    # Away from ties: where the rule that ends a zone changes, derivatives are one-sided.
    assume(np.allclose(q1 - q0, q2 - q1, rtol=0.0, atol=1e-3 * STEP))
    directions = Directions(
        ((waypoints(after) - waypoints(before)) / (2 * STEP))[..., None],
        {
            name: factor * size_rates[: POINTS - 1, None]
            for name, factor in (("tcp", 1.0), ("reorientation", 1.5), ("external", 1.5))
        },
    )
    if make.name == "kuka":
        fives = np.array([5.0 if kind in "Jj" else 1.0 for kind in kinds[: POINTS - 1]])
        directions.sizes["tcp"][:] *= fives[:, None]
    made = Sensitivity(path, directions)
    found = made.configurations(places, q1)[:, :, 0]
    wanted = (q2 - q0) / (2 * STEP)
    assert found == pytest.approx(wanted, abs=1e-4 * max(1.0, float(np.abs(wanted).max())))
