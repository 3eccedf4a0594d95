"""Stops that are come to from another side are named, and no others."""

from __future__ import annotations

import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.program.move import Move, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.problems.improve.approaches import approach_notes

CONTROLLER = Controller(find_vendor("kuka"), find_robot("kuka/kr16-2"))
DOWN = (0.0, 0.7071067811865476, 0.0, 0.7071067811865476)
START = MoveJ(JointTarget((0.0, -1.57, 1.57, 0.0, 0.3, 0.0)), Speed(joint_fraction=0.5))


def line(x: float, y: float, z: float, zone: Zone = FINE) -> Move:
    return MoveL(PoseTarget(Pose((x, y, z), DOWN)), Speed(tcp=0.5), zone)


def driven(*moves: Move) -> Run:
    return CONTROLLER.run(Program((START, *moves), "test"), None)


def program(x: float = 0.9, zone: float = 0.02) -> Run:
    """To a stop, down from above by a via point at x, and up again."""
    above = line(x, 0.2, 0.8, Radius(zone))
    return driven(line(0.9, -0.3, 0.8), above, line(0.9, 0.2, 0.5), line(0.9, 0.2, 0.8))


def test_a_via_point_that_moves_turns_what_leads_to_it_and_from_it() -> None:
    left, approached = approach_notes(program(), program(x=1.1))
    assert (left.move, approached.move) == (1, 3)
    assert "is left in another direction than before, by 22°" in left.message
    assert "the point behind it" in left.message
    assert "is approached in another direction than before, by 34°" in approached.message
    assert "the point before it" in approached.message


@pytest.mark.parametrize("zone", [0.05, 0.1])
def test_zones_that_end_before_the_stop_change_nothing(zone: float) -> None:
    assert not approach_notes(program(), program(zone=zone))


def test_other_moves_say_nothing() -> None:
    before = program()
    assert not approach_notes(before, driven(line(0.9, -0.3, 0.8), line(0.9, 0.2, 0.5)))
