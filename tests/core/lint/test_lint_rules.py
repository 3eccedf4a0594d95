"""Every rule by a program that breaks it and one that does not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.errors import EntryError, MotionError, Note, SourceError, Span
from flyby.core.lint.check import (
    CANNOT_DRIVE,
    CANNOT_READ,
    CLEARANCE,
    COLLISION,
    NEAREST,
    PART,
    check,
    rules,
    unreadable,
)
from flyby.core.lint.finding import Severity
from flyby.core.program.move import MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.origin import MoveOrigin, Origin, Ownership
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, Load, Tool
from flyby.core.program.zone import FINE, Fine, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

ABB, UR = "abb/irb6640-180-255", "ur/ur10e"
SPEED = Speed(tcp=0.3, reorientation=5.0)
DOWN = np.diag([-1.0, 1.0, -1.0])


def target(x=0.0, y=0.0, z=0.0, turn=(0.0, 0.0, 0.0), name=None, centre=(1.3, 0.0, 0.9)):
    matrix = np.eye(4)
    matrix[:3, :3] = DOWN @ matrix_from_rotation_vector(np.array(turn, dtype=float))
    matrix[:3, 3] = np.add(centre, (x, y, z))
    return PoseTarget(Pose.from_matrix(matrix), name=name)


def joint(q, **speed):
    return MoveJ(JointTarget(tuple(map(float, np.radians(q)))), replace(SPEED, **speed))


def line(
    x=0.0, y=0.0, z=0.0, zone=FINE, turn=(0.0, 0.0, 0.0), name=None, tool=FLANGE, load=None, **speed
):
    speed = replace(SPEED, **speed)
    return MoveL(target(x, y, z, turn, name), speed, zone, tool, load=load)


def program(*statements, **more):
    return Program((MoveJ(target(), SPEED), *statements), **more)


def on_ur(*legs):
    """Lines on the small arm, each (x, y, z, radius)."""
    moves = [
        MoveL(target(*leg[:3], centre=(0.6, 0.0, 0.4)), Speed(tcp=0.2, tcp_acceleration=1.2), zone)
        for leg, zone in ((leg, Radius(leg[3]) if leg[3] else FINE) for leg in legs)
    ]
    return Program((MoveJ(target(centre=(0.6, 0.0, 0.4)), Speed(joint=0.5)), *moves))


def found(made: Program, robot: str = ABB):
    return check(made, find_vendor(robot.split("/")[0]), find_robot(robot))


def arc(via: float, end: float) -> MoveC:
    """From (0, 0.1): over (via, 0.15) to (end, 0.2), as `line` has them."""
    return MoveC(line(end, 0.2).target, SPEED, via=line(via, 0.15).target)


GRIPPER = Tool("gripper", load=Load(60.0))
CASES = {
    "payload-exceeded": (
        program(line(0.2, tool=GRIPPER, load=Load(121.0)), line(0.1, tool=GRIPPER)),
        program(line(0.2, tool=GRIPPER, load=Load(119.0)), line(0.1, tool=GRIPPER)),
    ),
    "zone-last": (
        program(line(0.2, zone=Radius(0.01))),
        program(line(0.2)),
    ),
    "zone-switched-off": (
        program(line(0.2, zone=Radius(0.01)), Wait(0.5), line(0.2, 0.2)),
        program(line(0.2, zone=Radius(0.01)), Opaque("Set a;"), line(0.2, 0.2), Wait(0.5)),
    ),
    "joint-limit": (
        program(joint([0, 0, 0, 0, 150, 0])),
        program(joint([0, 0, 0, 0, 90, 0])),
    ),
    "speed-beyond-robot": (
        program(joint([0, 0, 0, 0, 90, 0], joint=10.0)),
        program(joint([0, 0, 0, 0, 90, 0], joint=1.0)),
    ),
    "duplicate-target": (
        program(line(0.2, name="p1"), line(0.2, 0.2, name="p2"), line(0.200005, name="p3")),
        program(line(0.2, name="p1"), line(0.2, 0.2, name="p2"), line(0.2, 0.001, name="p3")),
    ),
    "damaged-text": (
        program(line(0.2), notes=(Note("'=' stands where ':=' should", damage=True),)),
        program(line(0.2), notes=(Note("the condition depends on di1"),)),
    ),
    "reader": (
        program(line(0.2), notes=(Note("the condition depends on di1"),)),
        program(line(0.2)),
    ),
    "zone-cut": (
        program(line(0.2, zone=Radius(0.15)), line(0.2, 0.2)),
        program(line(0.2, zone=Radius(0.1)), line(0.2, 0.2)),
    ),
    "zone-stops": (
        program(line(0.2, zone=Radius(0.01)), line(0.2, turn=(0.3, 0, 0))),
        program(line(0.2, zone=Radius(0.01)), line(0.2, 0.2, turn=(0.3, 0, 0))),
    ),
    "zero-length": (
        program(line(0.2), line(0.2), line(0.2, 0.2)),
        program(line(0.2), line(0.2, 0.001), line(0.2, 0.2)),
    ),
    "configuration-flip": (
        program(joint([0, 0, 0, 80, 20, 0]), joint([0, 0, 0, -95, -20, 175])),
        program(joint([0, 0, 0, 80, 20, 0]), joint([0, 0, 0, 70, 20, 0])),
    ),
    "half-turn": (
        program(line(0.1, turn=(0, 0, np.pi))),
        program(line(0.1, turn=(0, 0, 2.5))),
    ),
    "straight-arc": (
        program(line(0.0, 0.1), arc(0.1, 0.2)),
        program(line(0.0, 0.1), arc(0.15, 0.2)),
    ),
    "speed-not-reached": (
        program(line(0.4, turn=(0, 0, 3.0), tcp=3.0, reorientation=20.0)),
        program(line(0.4, tcp=0.3)),
    ),
    "time-not-met": (
        program(line(0.4, duration=0.05)),
        program(line(0.4, duration=3.0)),
    ),
    "limit-near": (
        program(joint([0, 0, 0, 0, 119, 0])),
        program(joint([0, 0, 0, 0, 100, 0])),
    ),
    CANNOT_DRIVE: (
        program(line(9.0)),
        program(line(0.2)),
    ),
}


def singular_line() -> Program:
    """A line along the forearm while the wrist is all but straight."""
    q = np.radians([0, 10, 10, 0, 0.02, 0])
    robot = find_robot(ABB)
    here = robot.flange_pose(q)
    there = Pose((here.position[0] + 0.02, *here.position[1:]), here.quaternion)
    return Program((joint(np.degrees(q)), MoveL(PoseTarget(there), SPEED)))


@pytest.mark.parametrize("rule", list(CASES))
def test_a_rule_finds_what_is_bad_and_nothing_else(rule) -> None:
    bad, good = CASES[rule]
    hits = [finding for finding in found(bad) if finding.rule == rule]
    assert len(hits) == 1
    assert hits[0].severity is rules()[rule][0]
    assert hits[0].message
    assert hits[0].fix
    assert rule not in {finding.rule for finding in found(good)}


def test_a_stop_that_no_program_says_is_no_zone() -> None:
    stop = line(0.2, zone=Fine(programmed=False))
    assert not [f.rule for f in found(program(stop, Wait(0.5), stop)) if "zone" in f.rule]


def test_a_payload_is_told_with_its_figures_where_it_begins() -> None:
    bad, _ = CASES["payload-exceeded"]
    heavier = replace(bad, statements=(*bad.statements, line(0.2, load=Load(200.0, name="block"))))
    first, second = (f for f in found(heavier) if f.rule == "payload-exceeded")
    assert "carries 181 kg" in first.message
    assert "tool gripper of 60 kg and the payload of 121 kg" in first.message
    assert "rated for 180 kg" in first.message
    assert "rated for 181 kg" in first.fix
    assert (first.move, second.move) == (1, 3)
    assert "block of 200 kg" in second.message


def test_a_singular_stretch_is_found() -> None:
    assert "singular" in {finding.rule for finding in found(singular_line())}
    assert "singular" not in {finding.rule for finding in found(program(line(0.2)))}


def test_waypoints_that_are_left_out_are_found() -> None:
    bad = on_ur((0.1, 0, 0, 0.06), (0.1, 0.1, 0, 0.06), (0.2, 0.1, 0, 0))
    good = on_ur((0.1, 0, 0, 0.04), (0.1, 0.1, 0, 0.04), (0.2, 0.1, 0, 0))
    assert [f.move for f in found(bad, UR) if f.rule == "waypoint-left-out"]
    assert not [f for f in found(good, UR) if f.rule == "waypoint-left-out"]


def test_every_rule_has_an_example() -> None:
    elsewhere = {"singular", "waypoint-left-out", "unused-target", CANNOT_READ}
    elsewhere |= {COLLISION, CLEARANCE, NEAREST, PART}  # of cells: tests/tasks/test_cell_course.py
    assert set(rules()) == {*CASES, *elsewhere}


def test_what_comes_before_an_undrivable_move_is_checked_all_the_same() -> None:
    bad = program(line(0.2, zone=Radius(0.15)), line(0.2, 0.2), line(9.0), line(0.1))
    by_rule = {finding.rule: finding for finding in found(bad)}
    assert by_rule[CANNOT_DRIVE].move == 3
    assert by_rule["zone-cut"].move == 1


def test_a_robot_of_another_size_is_a_finding() -> None:
    short = Program((MoveJ(JointTarget((0.0, 0.1)), SPEED), MoveJ(JointTarget((0.1, 0.1)), SPEED)))
    assert {finding.rule for finding in found(short)} >= {"joint-limit", CANNOT_DRIVE}


def test_a_line_of_a_loop_is_told_once_and_in_order_of_the_text() -> None:
    def placed(move, at):
        span = Span("a.mod", at, 1, 10 * at, 10 * at + 5)
        origin = Origin(Ownership.OWNED, span)
        return replace(move, origin=MoveOrigin(span, origin, origin, origin))

    cut = placed(line(0.2, zone=Radius(0.15)), 7)
    other = placed(line(0.2, 0.2, zone=Radius(0.15)), 5)
    back = placed(line(), 8)
    hits = [f for f in found(program(cut, other, back, cut, other, back)) if f.rule == "zone-cut"]
    assert [finding.span.line for finding in hits] == [5, 7]


def test_an_unreadable_text_is_a_finding_with_its_place() -> None:
    span = Span("a.mod", 4, 2, 30, 31)
    finding = unreadable(SourceError("ENDPROC expected", span))
    assert (finding.rule, finding.severity) == (CANNOT_READ, Severity.ERROR)
    assert (finding.message, finding.span) == ("ENDPROC expected", span)
    assert finding.fix.startswith("correct the text")
    assert unreadable(EntryError("choose", span)).fix.startswith("say which (entry)")
    assert unreadable(MotionError("no target")).message == "no target"
