"""Which pairs of bodies are looked at, and why the others are not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...cell.cell import Cell
from ...errors import Note
from ...robot.model import Robot
from .bodies import Body, BodyKind

Touch = Callable[[FloatArray, NDArray[np.int64]], NDArray[np.bool_]]

ROUNDS = (8, 64, 440)
"""Configurations sampled in turn for the pairs that touched at all those before."""
SEED = 20


@dataclass(frozen=True, slots=True)
class Exclusion:
    """Two bodies that are not looked at together.

    Args:
        first, second: names of the bodies.
        reason: why not.
    """

    first: str
    second: str
    reason: str

    def __str__(self) -> str:
        return f"{self.first} and {self.second}: {self.reason}"


@dataclass(frozen=True, slots=True)
class Pairs:
    """The pairs of a scene.

    Args:
        kept: (P, 2) int64, indices of bodies.
        exclusions: the others, except bodies of one part.
    """

    kept: NDArray[np.int64]
    exclusions: tuple[Exclusion, ...]


def sort_pairs(cell: Cell, bodies: tuple[Body, ...]) -> Pairs:
    """Leave out what never moves against each other, adjacent links, and what the cell allows."""
    kept: list[tuple[int, int]] = []
    exclusions: list[Exclusion] = []
    for i, j in combinations(range(len(bodies)), 2):
        first, second = bodies[i], bodies[j]
        if first.thing == second.thing and first.kind is second.kind:
            continue
        reason = exclusion_reason(cell, first, second)
        if reason is None:
            kept.append((i, j))
        else:
            exclusions.append(Exclusion(first.name, second.name, reason))
    return Pairs(np.array(kept, dtype=np.int64).reshape(-1, 2), tuple(exclusions))


def exclusion_reason(cell: Cell, first: Body, second: Body) -> str | None:
    """Why two bodies are not looked at together; None if they are."""
    if first.frame == second.frame:
        return "they do not move against each other"
    if _adjacent(cell.robot, first, second):
        return "adjacent links"
    told = _told_by_robot(cell.robot, first, second)
    if told is not None:
        return told
    for pair in cell.allowed:
        if _meant(cell.robot, pair, first, second):
            return f"allowed by the cell as {pair[0]!r}, {pair[1]!r}"
    return None


def _adjacent(robot: Robot, first: Body, second: Body) -> bool:
    links = _links(robot, first, second)
    if links is None:
        return False
    places = [0, *(robot.along.index(index) + 1 for index in range(robot.arm_size))]
    return abs(places[links[1]] - places[links[0]]) == 1


def _told_by_robot(robot: Robot, first: Body, second: Body) -> str | None:
    """Why the robot's own file lets two of its links touch; None if it does not."""
    links = _links(robot, first, second)
    for pair in robot.may_touch:
        if links == (pair.first, pair.second):
            return f"allowed by {pair.file} ({pair.reason})"
    return None


def _links(robot: Robot, first: Body, second: Body) -> tuple[int, int] | None:
    """The numbers of two links, the lower first; None if one is none."""
    if first.kind is not BodyKind.LINK or second.kind is not BodyKind.LINK:
        return None
    order = ["base", *(joint.name for joint in robot.joints)]
    a, b = sorted((order.index(first.part), order.index(second.part)))
    return a, b


def robot_notes(robot: Robot) -> tuple[Note, ...]:
    """A note on the links that may touch by the word of a file, for every report."""
    order = ["base", *(joint.name for joint in robot.joints)]
    files = dict.fromkeys(pair.file for pair in robot.may_touch)
    return tuple(
        Note(
            f"pairs allowed to touch by {file}: "
            + ", ".join(
                f"{order[pair.first]} and {order[pair.second]} ({pair.reason})"
                for pair in robot.may_touch
                if pair.file == file
            )
        )
        for file in files
    )


def _meant(robot: Robot, pair: tuple[str, str], first: Body, second: Body) -> bool:
    def answers(body: Body, name: str) -> bool:
        if body.part == name:
            return True
        carried = body.kind is BodyKind.OBSTACLE and body.frame > 0
        return carried and robot.axis_names[body.frame - 1] == name

    a, b = pair
    return (answers(first, a) and answers(second, b)) or (answers(first, b) and answers(second, a))


def always_touching(
    robot: Robot,
    pairs: NDArray[np.int64],
    touch: Touch,
) -> NDArray[np.bool_]:
    """Which pairs touch wherever the robot stands, as far as samples tell.

    Args:
        robot: configurations are drawn evenly between its limits, the same ones every time.
        pairs: (P, 2), indices of bodies.
        touch: whether pairs (K, 2) touch at configurations (M, N): (M, K) bool.

    Returns:
        (P,) bool.
    """
    rng = np.random.default_rng(SEED)
    always = np.ones(len(pairs), dtype=np.bool_)
    for count in ROUNDS:
        q = rng.uniform(robot.limits.lower, robot.limits.upper, (count, robot.size))
        left = np.flatnonzero(always)
        always[left] = touch(q, pairs[left]).all(axis=0)
    return always


def drop_own_overlaps(pairs: Pairs, bodies: tuple[Body, ...], always: NDArray[np.bool_]) -> Pairs:
    """Leave out parts of the robot that always overlap each other: shapes round near links do.

    Args:
        pairs: P pairs.
        bodies: of the scene.
        always: (P,), which pairs always touch.
    """
    dropped = always & _own(pairs, bodies)
    reason = f"they overlap at all of {sum(ROUNDS)} configurations drawn between the limits"
    found = (Exclusion(bodies[i].name, bodies[j].name, reason) for i, j in pairs.kept[dropped])
    return Pairs(pairs.kept[~dropped], (*pairs.exclusions, *found))


def overlap_notes(
    pairs: Pairs, bodies: tuple[Body, ...], always: NDArray[np.bool_]
) -> tuple[Note, ...]:
    """Notes on pairs that always overlap and are no parts of one robot: a mistake, or allowed.

    What surrounds the robot is not left out silently.
    """
    return tuple(
        Note(
            f"{bodies[i].name} and {bodies[j].name} overlap wherever the robot stands; move one "
            f'of them, or allow it: [allow] pairs = [["{bodies[i].part}", "{bodies[j].part}"]]'
        )
        for i, j in pairs.kept[always & ~_own(pairs, bodies)]
    )


def _own(pairs: Pairs, bodies: tuple[Body, ...]) -> NDArray[np.bool_]:
    """Which pairs are of the arm and what it carries, (P,)."""
    own = np.array([body.own for body in bodies])
    return np.asarray(own[pairs.kept].all(axis=1))
