"""Rules on what is written, before anything moves."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from ..door import called, spelt
from ..program.move import Move, MoveJ, Opaque, Wait
from ..program.target import JointTarget, PoseTarget
from ..program.zone import Angle, ContourFraction, Fine, Radius, VendorZone, Zone
from .finding import Hit, ProgramSubject, Rule, Severity
from .text_rules import damaged_text, pitfalls, unused_targets

_SAME_PLACE = 1e-5
"""m within which two targets are one place."""
_SAME_TURN = 1e-4
"""rad, likewise."""
_SLACK = 1e-6


def _zone_last(subject: ProgramSubject) -> Iterator[Hit]:
    moves = subject.program.moves
    cycle = subject.program.cycle  # behind its end its beginning follows
    goes_on = cycle is not None and cycle.end == len(moves)
    if moves and not goes_on and not isinstance(moves[-1].zone, Fine):
        yield Hit(
            "the last move ends in a zone, but nothing follows: the robot stops at the point",
            "end the last move at a stop point (fine; no C_..; r=0)",
            len(moves) - 1,
        )


def _zone_switched_off(subject: ProgramSubject) -> Iterator[Hit]:
    yield from _stopped_zones(subject)
    yield from _empty_zones(subject)
    yield from pitfalls(subject)


def _empty_zones(subject: ProgramSubject) -> Iterator[Hit]:
    for i, move in enumerate(subject.program.moves[:-1]):
        if has_no_size(move.zone):
            yield Hit(
                "a zone is asked for, but its size is 0: the robot stops at the point",
                "give the zone a size, or program a stop point",
                i,
            )


def has_no_size(zone: Zone) -> bool:
    """Whether a zone is programmed that can do nothing."""
    if isinstance(zone, Radius):
        return zone.tcp == 0.0 and zone.angle == 0.0
    if isinstance(zone, Angle):
        return zone.angle == 0.0
    if isinstance(zone, VendorZone):
        return zone.size == 0.0
    return isinstance(zone, ContourFraction) and zone.fraction == 0.0


def _stopped_zones(subject: ProgramSubject) -> Iterator[Hit]:
    index, pending = -1, False
    for statement in subject.program.statements:
        stop = _stop(statement)
        if stop is not None and pending:
            yield Hit(
                f"a zone is programmed, but {stop} stops the robot at the point",
                "program a stop point, or move the instruction away from the corner",
                index,
            )
            pending = False
        if isinstance(statement, Move):
            index, pending = index + 1, not isinstance(statement.zone, Fine)


def _stop(statement: object) -> str | None:
    """How a statement stops the robot; None if it does not."""
    if isinstance(statement, Wait):
        if statement.duration == 0:
            return "an instruction after it that ends the look-ahead"
        return f"the wait of {statement.duration:g} s after it"
    if isinstance(statement, Opaque) and statement.stops:
        lines = statement.text.strip().splitlines()
        return f"{lines[0][:40] if lines else ''!r} after it"
    return None


def _joint_limit(subject: ProgramSubject) -> Iterator[Hit]:
    robot = subject.robot
    joints = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    for i, move in enumerate(subject.program.moves):
        if not isinstance(move.target, JointTarget):
            continue
        if len(move.target.joints) != robot.arm_size:
            yield Hit(
                f"the target has {len(move.target.joints)} joint values, {robot.name} has "
                f"{robot.arm_size} joints",
                "choose the robot that the program is for",
                i,
            )
            continue
        values = (*move.target.joints, *move.target.external)
        names = [joint.name for joint in robot.joints]
        for coupled in robot.coupled_ranges:
            value = float(coupled.row(names) @ np.array(move.target.joints))
            if not coupled.lower - _SLACK <= value <= coupled.upper + _SLACK:
                yield Hit(coupled.excess(value), "keep the joints inside this range", i)
        for joint, value in zip(joints, values, strict=False):
            if joint.lower - _SLACK <= value <= joint.upper + _SLACK:
                continue
            if joint.held:
                yield Hit(
                    f"{joint.name} at {joint.shown(value)} has no motor on {robot.name}",
                    "programme it at 0",
                    i,
                )
            else:
                yield Hit(
                    f"{joint.name} at {joint.shown(value)} is outside its range of "
                    f"{joint.shown(joint.lower)} to {joint.shown(joint.upper)}",
                    "keep the joint inside its range",
                    i,
                )


def _speed_beyond(subject: ProgramSubject) -> Iterator[Hit]:
    robot = subject.robot
    fastest = max(robot.joints, key=lambda joint: joint.velocity)
    for i, move in enumerate(subject.program.moves):
        speed = move.speed.joint
        if isinstance(move, MoveJ) and speed is not None and speed > fastest.velocity + _SLACK:
            yield Hit(
                f"a joint speed of {fastest.shown(speed)}/s is programmed; the fastest joint, "
                f"{fastest.name}, reaches {fastest.shown(fastest.velocity)}/s",
                "program a speed that the robot reaches",
                i,
            )


def _duplicate_targets(subject: ProgramSubject) -> Iterator[Hit]:
    named: dict[str, tuple[int, PoseTarget, object]] = {}
    for i, move in enumerate(subject.program.moves):
        target = move.target
        if isinstance(target, PoseTarget) and target.name is not None:
            named.setdefault(target.name, (i, target, (move.work_object, target.external)))
    cells: dict[object, list[str]] = {}
    for name, (_, target, frame) in named.items():
        # Two places that are one may fall into neighbouring cells of the grid: look around.
        for cell in _cells(target):
            cells.setdefault((frame, cell), []).append(name)
    told: set[tuple[str, str]] = set()
    for names in cells.values():
        for first, second in combinations(names, 2):
            pair = first, second
            if pair in told or not _alike(named[first][1], named[second][1]):
                continue
            told.add(pair)
            yield Hit(
                f"{second} is the same point as {first}",
                f"use {first} in both places, so that one correction serves both",
                named[second][0],
            )


def _cells(target: PoseTarget) -> list[tuple[int, ...]]:
    """The cells of a grid that a target is within half a cell of."""
    cell = 4 * _SAME_PLACE
    low, high = (
        [int(np.floor((x + step) / cell)) for x in target.pose.position]
        for step in (-_SAME_PLACE, _SAME_PLACE)
    )
    return sorted(
        {(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])}
    )


def _alike(first: PoseTarget, second: PoseTarget) -> bool:
    step = first.pose.inverse() @ second.pose
    half_turn = min(1.0, float(np.linalg.norm(step.quaternion[1:])))
    near = float(np.linalg.norm(step.position)) < _SAME_PLACE
    return near and 2 * float(np.arcsin(half_turn)) < _SAME_TURN


def _payload_exceeded(subject: ProgramSubject) -> Iterator[Hit]:
    """Where what the flange carries begins to be more than the robot is rated for."""
    robot, before = subject.robot, 0.0
    for i, move in enumerate(subject.program.moves):
        tool = move.tool.load if move.tool.robot_held else None
        carried = [
            (load, name)
            for load, name in ((tool, f"tool {move.tool.name}"), (move.load, "the payload"))
            if load is not None and load.mass > 0.0
        ]
        mass = sum(load.mass for load, _ in carried)
        if robot.payload is not None and mass > robot.payload + _SLACK and mass != before:
            told = " and ".join(
                f"{load.name or name} of {load.mass:.4g} kg" for load, name in carried
            )
            yield Hit(
                f"the flange carries {mass:.4g} kg from here on ({told}); {robot.name} is rated "
                f"for {robot.payload:g} kg",
                f"carry less, or take a robot rated for {mass:.4g} kg ({called('robots')}); if "
                "the mass is wrong, correct it where it is declared",
                i,
                size=mass,
            )
        before = mass


def _reader_notes(subject: ProgramSubject) -> Iterator[Hit]:
    for note in subject.program.notes:
        if note.damage:
            continue
        meant = f"nothing, if meant so; else answer what is open by {spelt('answers')}"
        yield Hit(note.message, meant, note.move, note.span)


PROGRAM_RULES = (
    Rule(
        "zone-last",
        Severity.WARNING,
        "a zone on the last point",
        _zone_last,
    ),
    Rule(
        "zone-switched-off",
        Severity.WARNING,
        "a zone that is programmed, and something switches it off",
        _zone_switched_off,
    ),
    Rule(
        "damaged-text",
        Severity.ERROR,
        "text that no controller takes, and that was stepped over",
        damaged_text,
    ),
    Rule("joint-limit", Severity.ERROR, "joint targets outside the robot's range", _joint_limit),
    Rule(
        "payload-exceeded",
        Severity.ERROR,
        "loads of tool and payload beyond the robot's rated payload",
        _payload_exceeded,
    ),
    Rule("speed-beyond-robot", Severity.WARNING, "joint speeds above the robot's", _speed_beyond),
    Rule(
        "duplicate-target",
        Severity.INFO,
        "targets with different names at one place (0.01 mm)",
        _duplicate_targets,
    ),
    Rule(
        "unused-target",
        Severity.INFO,
        "targets that are declared and never used",
        unused_targets,
    ),
    Rule("reader", Severity.INFO, "what the reader had to decide or leave aside", _reader_notes),
)
