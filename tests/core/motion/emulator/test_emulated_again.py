"""A controller that has driven other programs drives one as a controller does that has not."""

from __future__ import annotations

import contextlib
from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.errors import FlybyError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.gradients.derivatives import Derivatives
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import Overlap
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.testing.strategies import programs

VENDOR, ROBOT = find_vendor("abb"), find_robot("abb/irb6640-180-255")
USED = {
    overlap: Controller(VENDOR, ROBOT, MotionModel(overlap=overlap))
    for overlap in (Overlap.HALF, Overlap.SHRINK)
}


def emulated(controller: Controller, program: Program) -> list[FloatArray]:
    """All that an optimisation takes of a driven program."""
    path = controller.plan(program)
    timing = controller.stamp(program, path)
    made = Derivatives(program, timing).duration()
    rooms = [np.array([room.left.value for room in path.rooms()])]
    speeds = [made.speed.tcp, made.speed.joint_fraction, made.speed.joint_acceleration_fraction]
    found = [path.sigma, *path.states, timing.stamp.x, timing.stamp.t, *rooms]
    return [*found, made.joints, made.position, made.turn, made.zone, *speeds]


def changed(program: Program, share: float) -> Program:
    """The same moves at the same speeds, with smaller zones or none, and other joint values."""
    moves = []
    for move in program.moves:
        if isinstance(move.zone, Radius) and move.zone.tcp > 0.0:
            move = replace(move, zone=move.zone.resized(share * move.zone.tcp) if share else FINE)
        if isinstance(move.target, JointTarget):
            joints = tuple(0.98 * value for value in move.target.joints)
            move = replace(move, target=replace(move.target, joints=joints))
        moves.append(move)
    return program.with_moves(tuple(moves))


@settings(max_examples=40, deadline=None)
@given(
    st.one_of(programs(ROBOT), programs(ROBOT, kinds=(MoveJ,))),
    st.sampled_from([Overlap.HALF, Overlap.SHRINK]),
    st.floats(0.3, 1.0),
)
def test_what_was_driven_before_does_not_matter(
    program: Program, overlap: Overlap, share: float
) -> None:
    used = USED[overlap]
    fresh = Controller(VENDOR, ROBOT, used.model)
    try:
        wanted = emulated(fresh, program)
    except FlybyError:
        # What cannot be driven, or has no derivatives, is not compared.
        return
    for other_zones in (share, 0.0):
        with contextlib.suppress(FlybyError):
            emulated(used, changed(program, other_zones))
    for _ in range(2):
        for one, other in zip(emulated(used, program), wanted, strict=True):
            np.testing.assert_array_equal(one, other)
