"""Differences of data, moves, texts and paths."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from flyby.core.difference.data import (
    apart,
    load_differences,
    point_differences,
    points_of,
    tool_differences,
)
from flyby.core.difference.differences import Differing
from flyby.core.difference.moves import move_differences, move_pairs
from flyby.core.difference.paths import greatest_distance
from flyby.core.difference.texts import file_differences
from flyby.core.difference.waits import wait_differences
from flyby.core.errors import Span
from flyby.core.program.move import MoveJ, MoveL, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Load, Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.spatial.pose import Pose
from flyby.testing.strategies import poses

FAST, SLOW = Speed(tcp=1.0, name="v1000"), Speed(tcp=0.5, name="v500")


def at(x: float, name: str | None = None) -> PoseTarget:
    return PoseTarget(Pose((x, 0.0, 0.5)), name=name)


def line(x: float, name: str | None = None, speed: Speed = FAST) -> MoveL:
    return MoveL(at(x, name), speed, FINE)


MOVES = [line(0.1, "p1"), line(0.2, "p2"), line(0.3), line(0.4, "p4")]


def found(before: list[MoveL], after: list[MoveL]) -> list[tuple[Differing, str, str]]:
    return [(d.subject, d.name, d.kind) for d in move_differences("main", before, after)]


PLACES = st.lists(st.sampled_from([0.1, 0.2, 0.3, 0.4]), max_size=12)


@given(PLACES, PLACES)
def test_moves_that_belong_together_are_in_the_same_order(
    one: list[float], two: list[float]
) -> None:
    pairs = move_pairs([line(x) for x in one], [line(x) for x in two])
    assert all(a < c and b < d for (a, b), (c, d) in itertools.pairwise(pairs))
    assert move_pairs([line(x) for x in one], [line(x) for x in one]) == [
        (k, k) for k in range(len(one))
    ]


def test_a_move_put_in_belongs_to_none() -> None:
    more = [*MOVES[:2], line(0.25), *MOVES[2:]]
    assert move_pairs(MOVES, more) == [(0, 0), (1, 1), (2, 3), (3, 4)]


@given(poses(), poses())
def test_distances_of_poses_are_those_of_their_matrices(one: Pose, other: Pose) -> None:
    distance, angle = apart(one, other)
    assert distance == pytest.approx(math.dist(one.position, other.position))
    turn = one.matrix()[:3, :3].T @ other.matrix()[:3, :3]
    assert math.cos(angle) == pytest.approx((np.trace(turn) - 1) / 2, abs=1e-9)
    assert apart(one, one)[1] == pytest.approx(0.0, abs=1e-7)


@given(st.lists(st.sampled_from(MOVES), max_size=8))
def test_nothing_differs_from_itself(moves: list[MoveL]) -> None:
    assert found(moves, moves) == []


@given(st.lists(st.sampled_from(MOVES), unique_by=id), st.integers(0, 4))
def test_a_move_that_is_put_in_is_added_and_taken_out_is_removed(
    moves: list[MoveL], place: int
) -> None:
    more = [*moves[:place], line(0.9, "new"), *moves[place:]]
    assert [(subject, kind) for subject, _, kind in found(moves, more)] == [
        (Differing.MOVE, "added")
    ]
    assert [(subject, kind) for subject, _, kind in found(more, moves)] == [
        (Differing.MOVE, "removed")
    ]


def test_what_changes_of_a_move_is_named() -> None:
    old = line(0.1, "p1")
    new = replace(
        old,
        speed=SLOW,
        zone=Radius(0.01, name="z10"),
        tool=Tool("gun"),
        load=Load(2.0, name="part"),
    )
    differences = list(move_differences("main", [old], [new]))
    shown = {d.subject: (d.before, d.after) for d in differences}
    assert shown == {
        Differing.SPEED: ("v1000 (1000 mm/s)", "v500 (500 mm/s)"),
        Differing.ZONE: ("fine", "z10 (10 mm)"),
        Differing.MOVE_TOOL: ("tool0", "gun"),
        Differing.MOVE_LOAD: ("none", "part"),
    }
    assert {d.name for d in differences} == {"main, move 1"}


def test_names_of_speeds_and_zones_alone_are_no_difference() -> None:
    old = replace(line(0.1), zone=Radius(0.01, name="z10"))
    new = replace(old, speed=Speed(tcp=1.0, name="vFast"), zone=Radius(0.01, name="zOwn"))
    assert found([old], [new]) == []


def test_a_target_without_a_name_says_how_far_it_went() -> None:
    (difference,) = move_differences("main", [line(0.1)], [line(0.103)])
    assert difference.subject is Differing.TARGET
    assert difference.distance == pytest.approx(0.003)


def test_moves_of_a_loop_count_once() -> None:
    loop = [line(0.1, "p1"), line(0.2, "p2")]
    assert found(loop * 50, [*loop, *loop]) == []


def waits(before: Program, after: Program) -> list[tuple[str, str, str]]:
    return [(d.name, d.before, d.after) for d in wait_differences("main", before, after)]


STATEMENTS = st.one_of(
    st.sampled_from(MOVES),
    st.sampled_from([0.0, 0.2, 0.5]).map(Wait),
    st.just(Wait(0.3, None, True)),
)


@given(st.lists(STATEMENTS, max_size=10), st.integers(0, 10))
def test_a_wait_that_is_put_in_is_added_and_no_other_one_differs(
    statements: list[MoveL | Wait], place: int
) -> None:
    one = Program(tuple(statements))
    assert waits(one, one) == []
    other = Program((*statements[:place], Wait(0.7), *statements[place:]))
    assert [(a, b) for _, a, b in waits(one, other)] == [("", "0.7 s")]
    assert [(a, b) for _, a, b in waits(other, one)] == [("0.7 s", "")]


def test_a_wait_that_lasts_longer_is_named_by_the_move_before_it() -> None:
    def program(first: float, behind: float, target: float = 0.1) -> Program:
        span = Span("p.mod", 7, 1, 0, 9)
        return Program(
            (Wait(first), line(0.4, "p1"), *[line(target, "p2"), Wait(behind, span)] * 3)
        )

    assert waits(program(1.0, 0.2), program(1.5, 0.3)) == [
        ("main, before the first move", "1 s", "1.5 s"),
        ("main, behind p2", "0.2 s", "0.3 s"),
    ]
    # Neither a point that is taught again nor what a device takes is a wait.
    assert waits(program(1.0, 0.2), program(1.0, 0.2, 0.15)) == []
    taken = [Program((line(0.1), Wait(t, None, True))) for t in (0.5, 0.9)]
    assert waits(*taken) == []


def test_points_are_compared_by_name_without_case() -> None:
    def program(*moves: MoveL | MoveJ) -> dict[str, Program]:
        return {"main": Program(moves)}

    joints = JointTarget((0.0, 0.1), name="home")
    before = program(line(0.1, "P1"), line(0.2, "gone"), MoveJ(joints, FAST))
    after = program(
        line(0.104, "p1"), line(0.3, "new"), MoveJ(replace(joints, joints=(0.0, 0.2)), FAST)
    )
    found = {d.name: d for d in point_differences(points_of(before), points_of(after))}
    assert {name: d.kind for name, d in found.items()} == {
        "p1": "changed",
        "gone": "removed",
        "new": "added",
        "home": "changed",
    }
    assert found["p1"].distance == pytest.approx(0.004)
    assert found["home"].angle == pytest.approx(0.1)


def test_tools_and_loads_differ_in_mass_too() -> None:
    heavy = Tool("gun", load=Load(2.0))
    (difference,) = tool_differences({"gun": Tool("gun", load=Load(1.0))}, {"gun": heavy})
    assert "1 kg" in difference.before and "2 kg" in difference.after
    assert difference.distance == 0.0
    (load,) = load_differences({"a": Load(1.0)}, {"a": Load(1.5)})
    assert (load.before[:4], load.after[:6]) == ("1 kg", "1.5 kg")


POINTS = arrays(float, st.tuples(st.integers(1, 12), st.just(3)), elements=st.floats(-1, 1))


@given(POINTS, POINTS)
def test_distances_of_paths(one: np.ndarray, other: np.ndarray) -> None:
    assert greatest_distance(one, one) == pytest.approx(0.0, abs=1e-12)
    distance = greatest_distance(one, other)
    assert distance == greatest_distance(other, one)
    corners = np.linalg.norm(one[:, None] - other[None], axis=-1)
    assert distance <= max(corners.min(1).max(), corners.min(0).max()) + 1e-12
    shift = np.array([0.3, 0.0, 0.0])
    assert greatest_distance(one, one + shift) <= 0.3 + 1e-12


@given(POINTS, st.integers(1, 5))
def test_the_rate_of_samples_does_not_count(points: np.ndarray, parts: int) -> None:
    shares = np.linspace(0.0, len(points) - 1, parts * (len(points) - 1) + 1)
    finer = np.stack([np.interp(shares, range(len(points)), axis) for axis in points.T], axis=1)
    assert greatest_distance(points, finer) < 1e-9


TEXT = "PROC a()\n  MoveL p1;\n  MoveL p2;\nENDPROC\n\nPROC b()\n  WaitTime 1;\n  Stop;\nENDPROC\n"


def test_code_that_moved_is_not_code_that_changed() -> None:
    a, b = TEXT.split("\n\n")
    swapped = f"{b}\n\n{a}\n".replace("\n\n\n", "\n\n")
    (difference,) = file_differences({"m": TEXT}, {"m": swapped})
    assert (difference.kind, difference.added, difference.removed) == ("moved", 0, 0)
    found = file_differences({"m": TEXT}, {"m": a + "\n", "n": b})
    assert {d.name: (d.kind, d.added, d.removed) for d in found} == {
        "m": ("moved", 0, 0),
        "n": ("moved", 0, 0),
    }
    (difference,) = file_differences({"m": TEXT}, {"m": TEXT.replace("p2", "p3")})
    assert (difference.kind, difference.added, difference.removed) == ("changed", 1, 1)


def test_files_come_and_go() -> None:
    found = file_differences({"a": "x\ny\n", "same": "z"}, {"b": "u\nv\n", "same": "z  \r\n"})
    assert {d.name: d.kind for d in found} == {"a": "removed", "b": "added"}


LINES = st.lists(st.sampled_from(["MoveL p1;", "MoveL p2;", "ENDIF", "", "x := 1;"]), max_size=30)


@given(LINES, LINES)
def test_lines_are_neither_lost_nor_invented(before: list[str], after: list[str]) -> None:
    found = file_differences({"m": "\n".join(before)}, {"m": "\n".join(after)})
    if before == after:
        assert found == ()
    count = [sum(map(bool, side)) for side in (before, after)]
    change = sum(d.added - d.removed for d in found)
    assert change == count[1] - count[0]
    assert all(min(d.added, d.removed, d.moved) >= 0 for d in found)
