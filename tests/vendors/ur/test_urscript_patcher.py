"""Changes in the user's own scripts: exact bytes, and what is refused."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError, MotionError, UnknownNameError
from flyby.core.program.move import Move, MoveJ, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, Angle, Radius
from flyby.core.registry import find_vendor
from flyby.core.source.patch.edits import difference
from flyby.core.spatial.pose import Pose
from flyby.vendors.ur.motion.configuration import UrConfiguration
from flyby.vendors.ur.patch.patcher import patch
from flyby.vendors.ur.run.reader import read
from flyby.vendors.ur.values.poses import quaternion_of

UR5E = find_vendor("ur").robot("ur5e")
Change = Callable[[Move], Move]


def part(name: str, /, **changes: object) -> Change:
    """A change of some fields of a move's target, speed or zone."""

    def change(move: Move) -> Move:
        return replace(move, **{name: replace(getattr(move, name), **changes)})  # type: ignore[arg-type]

    return change


def zone(radius: float) -> Change:
    return lambda move: replace(move, zone=Radius(radius) if radius else FINE)


def at(x: float, y: float, z: float) -> Change:
    def change(move: Move) -> Move:
        assert isinstance(move.target, PoseTarget)
        pose = Pose((x, y, z), move.target.pose.quaternion)
        return replace(move, target=replace(move.target, pose=pose))

    return change


def joints(*values: float) -> Change:
    return lambda move: replace(move, target=JointTarget(values))


def changed(program: Program, changes: dict[int, Change]) -> Program:
    moves = [changes.get(k, lambda m: m)(move) for k, move in enumerate(program.moves)]
    return program.with_moves(tuple(moves))


def patched(text: str, changes: dict[int, Change], **options: str) -> str:
    program = read(text, "own.script")
    (file,) = patch(changed(program, changes), UR5E, options).values()
    return file.text


ONE = "p[0.4, -0.2, .300, 0, 3.14, 0]"

CASES: list[Any] = [
    pytest.param(
        f"movel({ONE}, a=1.2, v=0.25, r=0.01)\n",
        {0: at(0.4, -0.25, 0.3)},
        "movel(p[0.4, -0.25, .300, 0, 3.14, 0], a=1.2, v=0.25, r=0.01)\n",
        id="a number, the others as they are spelled",
    ),
    pytest.param(
        f"  movel( {ONE},1.2, 0.25 ,0 , 1e-2 )  # slow\r\n",
        {0: lambda m: part("speed", tcp=0.125)(zone(0.02)(m))},
        f"  movel( {ONE},1.2, 0.125 ,0 , 0.02 )  # slow\r\n",
        id="arguments by position",
    ),
    pytest.param(
        f"movel({ONE})\nmovel({ONE}, v=0.1 )",
        {0: zone(0.05), 1: lambda m: part("speed", tcp_acceleration=0.5)(zone(0.025)(m))},
        f"movel({ONE}, r=0.05)\nmovel({ONE}, v=0.1 , a=0.5, r=0.025)",
        id="arguments that were not written",
    ),
    pytest.param(
        f"movel({ONE}, r=0.05)\n",
        {0: zone(0)},
        f"movel({ONE}, r=0)\n",
        id="a stop",
    ),
    pytest.param(
        f"movel({ONE}, a=1.2, v=0.25)\nmovel({ONE}, 1, 0.5, 2.0)\n",
        {
            0: lambda m: replace(m, speed=Speed(duration=1.5)),
            1: lambda m: replace(m, speed=Speed(tcp=0.25, tcp_acceleration=1.0)),
        },
        f"movel({ONE}, a=1.2, v=0.25, t=1.5)\nmovel({ONE}, 1, 0.25, 0)\n",
        id="a duration that comes and one that goes",
    ),
    pytest.param(
        "global Wegpunkt_1_p=p[.4, -.2, .3, 0, 3.14, 0]\n"
        "global Wegpunkt_1_q=[0.0, -1.5, 1.5, -1.5, -1.5, 0.0]\n"
        '$ 2 "Über Größe"\n'
        "movej(get_inverse_kin(Wegpunkt_1_p, qnear=Wegpunkt_1_q), a=1.39, v=1.04)\n"
        "movel(Wegpunkt_1_p, a=1.2, v=0.25)\n",
        {0: at(0.5, -0.2, 0.3), 1: at(0.5, -0.2, 0.3)},
        "global Wegpunkt_1_p=p[0.5, -.2, .3, 0, 3.14, 0]\n"
        "global Wegpunkt_1_q=[0.0, -1.5, 1.5, -1.5, -1.5, 0.0]\n"
        '$ 2 "Über Größe"\n'
        "movej(get_inverse_kin(Wegpunkt_1_p, qnear=Wegpunkt_1_q), a=1.39, v=1.04)\n"
        "movel(Wegpunkt_1_p, a=1.2, v=0.25)\n",
        id="a waypoint of several moves that agree",
    ),
    pytest.param(
        f"q = [0, -1.5, 1.5, -1.5, -1.5, 0]\nmovej(get_inverse_kin({ONE}, q))\n",
        {0: part("target", configuration=UrConfiguration((0.1, -1.5, 1.5, -1.5, -1.5, 0.0)))},
        f"q = [0.1, -1.5, 1.5, -1.5, -1.5, 0]\nmovej(get_inverse_kin({ONE}, q))\n",
        id="qnear",
    ),
    pytest.param(
        "k = 0\nwhile k < 2:\n  movej([0, k, 0.5, 0, 0, 0], v=0.5, r=0.02)\n  k = k + 1\nend\n",
        {0: joints(0, 0, 0.6, 0, 0, 0), 1: lambda m: joints(0, 1, 0.6, 0, 0, 0)(m)},
        "k = 0\nwhile k < 2:\n  movej([0, k, 0.6, 0, 0, 0], v=0.5, r=0.02)\n  k = k + 1\nend\n",
        id="a number beside computed ones, in a loop",
    ),
    pytest.param(
        f"a = 0.5\nmovec(p[0, 0.1, 0, 0, 0, 0], {ONE}, a, mode=0)\nx = a * 2\n",
        {0: lambda m: zone(0.01)(at(0.4, -0.2, 0.35)(m))},
        "a = 0.5\nmovec(p[0, 0.1, 0, 0, 0, 0], p[0.4, -0.2, 0.35, 0, 3.14, 0], a, mode=0, r=0.01)\n"
        "x = a * 2\n",
        id="an arc",
    ),
    pytest.param(
        f"optimovel({ONE}, a=0.3, v=0.3)\n",
        {0: part("speed", joint_fraction=0.5)},
        f"optimovel({ONE}, a=0.3, v=0.5)\n",
        id="shares",
    ),
]


@pytest.mark.parametrize(("text", "changes", "expected"), CASES)
def test_exact_bytes(text: str, changes: dict[int, Change], expected: str) -> None:
    assert patched(text, changes) == expected


OWN_CASES: list[Any] = [
    pytest.param(
        f"W = {ONE}\nv1 = 0.25\nmovel(W, v=v1)\nmovel(W, v=v1)\n",
        {1: lambda m: part("speed", tcp=0.5)(at(0.5, -0.2, 0.3)(m))},
        {"shared": "own"},
        f"W = {ONE}\nv1 = 0.25\nmovel(W, v=v1)\nmovel(p[0.5, -0.2, 0.3, 0, 3.14, 0], v=0.5)\n",
        id="shared numbers",
    ),
    pytest.param(
        f"W = {ONE}\nmovel(W)\nmovel(pose_add(W, p[0, 0, 0.1, 0, 0, 0]))\n",
        {0: at(0.5, -0.2, 0.3)},
        {"shared": "own"},
        "W = p[0.4, -0.2, .300, 0, 3.14, 0]\nmovel(p[0.5, -0.2, 0.3, 0, 3.14, 0])\n"
        "movel(pose_add(W, p[0, 0, 0.1, 0, 0, 0]))\n",
        id="numbers that an expression reads",
    ),
    pytest.param(
        "f = p[0.4, 0, 0, 0, 0, 0]\nmovel(pose_trans(f, p[0, -0.25, 0.5, 0, 0, 0]), v=0.1*2)\n",
        {0: lambda m: part("speed", tcp=0.25)(at(0.4, -0.5, 0.5)(m))},
        {"derived": "own"},
        "f = p[0.4, 0, 0, 0, 0, 0]\nmovel(p[0.4, -0.5, 0.5, 0, 0, 0], v=0.25)\n",
        id="computed numbers",
    ),
    pytest.param(
        f"q = [0, -1.5, 1.5, -1.5, -1.5, 0]\nW = {ONE}\nmovej(get_inverse_kin(W, qnear=q))\n"
        "movej(get_inverse_kin(W, qnear=q))\n",
        {1: at(0.5, -0.2, 0.3)},
        {"shared": "own"},
        f"q = [0, -1.5, 1.5, -1.5, -1.5, 0]\nW = {ONE}\nmovej(get_inverse_kin(W, qnear=q))\n"
        "movej(get_inverse_kin(p[0.5, -0.2, 0.3, 0, 3.14, 0], qnear=q))\n",
        id="the pose of get_inverse_kin",
    ),
]


@pytest.mark.parametrize(("text", "changes", "options", "expected"), OWN_CASES)
def test_literals_of_their_own(
    text: str, changes: dict[int, Change], options: dict[str, str], expected: str
) -> None:
    with pytest.raises(FlybyError, match=r"own=True|must be changed for all|change both"):
        patched(text, changes)
    assert patched(text, changes, **options) == expected


# Rotations


@given(
    st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: math.hypot(*v) > 0.1),
    st.floats(0, 12),
    st.tuples(*[st.floats(-0.05, 0.05)] * 3),
)
def test_rotation_vectors_stay_on_the_users_branch(
    axis: tuple[float, float, float], angle: float, turn: tuple[float, float, float]
) -> None:
    old = np.array(axis) / math.hypot(*axis) * angle
    text = f"movel(p[0, 0, 0, {old[0]:.12f}, {old[1]:.12f}, {old[2]:.12f}])\n"
    program = read(text, "own.script")
    target = program.moves[0].target
    assert isinstance(target, PoseTarget)
    pose = target.pose @ Pose(quaternion=quaternion_of(*turn))
    after = changed(program, {0: part("target", pose=pose)})
    files = patch(after, UR5E, {})
    made = next(iter(files.values())).text if files else text
    new = [float(x) for x in re.findall(r"-?[\d.]+", made)][3:6]
    # Multiples of a whole turn are one rotation, where the axis may be any.
    whole = abs(angle / math.tau - round(angle / math.tau)) * math.tau
    if whole > 0.3:
        assert math.dist(new, old) < 60 * max(0.01, math.hypot(*turn)) / whole
        assert abs(math.hypot(*new) - angle) < math.pi


# Whole programs


@settings(deadline=None)
@given(st.data())
def test_patching_gives_the_changed_program_and_keeps_the_rest(data: st.DataObject) -> None:
    lines = [
        "movej([0.1, -1.2, 1.3, -1.4, -1.5, 0.6], a=1.4, v=1.05, r=0.01)",
        "movej(get_inverse_kin(p[.1, .2, .3, 3.1, .2, .1], qnear=[0,0,0,0,0,0]), 1.4, 1.05)",
        "movel(p[0.1, 0.2, 0.3, 2.2, -2.2, 0.01], a=1.2, v=0.25)  # größer",
        "movep(p[0.1, 0.2, 0.35, 2.2, -2.2, 0.01], v=0.1, r=0.002)",
        "movec(p[0.2, 0.2, 0.3, 0, 0, 0], p[0.3, 0.1, 0.3, 0.1, 0, 0])",
        "movel(p[0.1, 0.2, 0.3, 2.2, -2.2, 0.01], t=2)",
    ]
    end = data.draw(st.sampled_from(["\n", "\r\n", "\r"]))
    text = end.join(["def prog():", *lines, "end"])
    program = read(text, "own.script")
    numbers = st.floats(-2, 2)
    moves = list(program.moves)
    touched = data.draw(st.sets(st.integers(0, len(moves) - 1)))
    for k in touched:
        move = moves[k]
        if isinstance(move.target, JointTarget):
            move = replace(move, target=JointTarget(data.draw(st.tuples(*[numbers] * 6))))
        else:
            turn = quaternion_of(*data.draw(st.tuples(*[numbers] * 3)))
            pose = Pose(data.draw(st.tuples(*[numbers] * 3)), turn)
            move = replace(move, target=replace(move.target, pose=pose))
        radius = data.draw(st.floats(0.001, 0.1) | st.just(0.0))
        move = zone(radius)(move)
        if move.speed.duration is None:
            field = "joint" if isinstance(move, MoveJ) else "tcp"
            move = part("speed", **{field: data.draw(st.floats(0.01, 3))})(move)
        moves[k] = move
    after = program.with_moves(tuple(moves))
    files = patch(after, UR5E, {})
    made = files["own.script"].text if files else text
    rounded = tuple(
        replace(m, zone=Radius(m.zone.tcp, m.zone.tcp, m.zone.tcp))
        if isinstance(m.zone, Radius)
        else m
        for m in moves
    )
    assert difference(read(made, "own.script"), program.with_moves(rounded)) is None
    old, new = text.split(end), made.split(end)
    assert len(old) == len(new)
    assert {k - 1 for k, (a, b) in enumerate(zip(old, new, strict=True)) if a != b} <= touched
    for a, b in zip(old, new, strict=True):
        # Only numbers differ, and arguments that were put in before the closing bracket.
        kept, made_of = _NUMBER.sub("#", a), _NUMBER.sub("#", b)
        assert re.fullmatch(re.escape(kept).replace(r"\)", r"(, [avtr]=\#)*\)"), made_of)


_NUMBER = re.compile(r"(?<![A-Za-z_])-?(\d+\.?\d*|\.\d+)")


def test_nothing_changed_is_no_patch() -> None:
    program = read(f"movel({ONE})\n", "own.script")
    assert patch(program, UR5E, {}) == {}
    renamed = changed(program, {0: part("target", name="another")})
    assert patch(renamed, UR5E, {}) == {}


# What is refused

REFUSED: list[Any] = [
    (f"movel({ONE})", part("speed", reorientation=1.0), "a speed of reorientation"),
    (f"movel({ONE})", lambda m: replace(m, zone=Angle(0.1)), "no zone by Angle"),
    (f"movel({ONE})", lambda m: replace(m, zone=Radius(0.01, 0.02)), "one radius for all"),
    (
        f"movel({ONE})",
        lambda m: replace(m, tool=Tool("other", Pose((0, 0, 0.1)))),
        "its tool has changed",
    ),
    (f"movel({ONE})", joints(0, 0, 0, 0, 0, 0), "no pose of joint values"),
    ("movej([0,0,0,0,0,0])", joints(0, 0, 0, 0, 0), "5 joints instead of 6"),
    ("movej([0,0,0,0,0,0])", part("speed", tcp=0.5), "no limit on the speed of the TCP"),
    (f"movep({ONE})", lambda m: replace(m, speed=Speed(duration=1)), "no such argument"),
    (
        f"movej({ONE})",
        part("target", configuration=UrConfiguration((0.0,) * 6)),
        "neither adds nor takes away a qnear",
    ),
    (
        f"x = 0.5\nmovel({ONE}, a=x, v=x)",
        part("speed", tcp=0.25),
        "x does not state all of it",
    ),
    (f"movel({ONE}, v=0.5/2)", part("speed", tcp=0.5), "the program computes it"),
]


@pytest.mark.parametrize(("text", "change", "message"), REFUSED, ids=[m for *_, m in REFUSED])
def test_what_has_no_place_is_refused_by_move(text: str, change: Change, message: str) -> None:
    text = f"movej([0.1, 0, 0, 0, 0, 0])\n{text}\n"
    with pytest.raises(MotionError, match=re.escape(message)) as caught:
        patched(text, {1: change})
    assert caught.value.move == 1
    assert "own.script:" in str(caught.value)


def test_other_statements_are_refused() -> None:
    program = read(f"movel({ONE})\n", "own.script")
    more = replace(program, statements=(*program.statements, Wait(1.0)))
    with pytest.raises(InputError, match="other statements"):
        patch(more, UR5E, {})


def test_another_kind_of_move_is_refused() -> None:
    program = read(f"movel({ONE})\n", "own.script")
    other = changed(program, {0: lambda m: MoveJ(m.target, m.speed, origin=m.origin)})
    with pytest.raises(InputError, match="other statements"):
        patch(other, UR5E, {})


def test_what_was_not_read_is_refused() -> None:
    with pytest.raises(InputError, match="was not read from source files"):
        patch(Program(()), UR5E, {})


def test_moves_that_disagree_are_named() -> None:
    text = f"W = {ONE}\nmovel(W)\nmovel(W)\n"
    with pytest.raises(MotionError, match="move 2: target: W is read by move 1 as well"):
        patched(text, {1: at(0.5, 0, 0)})


def test_unknown_options_are_refused() -> None:
    with pytest.raises(UnknownNameError, match="option of the URScript patcher"):
        patched(f"movel({ONE})", {0: zone(0.1)}, opaque="comment")
    with pytest.raises(InputError, match="one of refuse, own"):
        patched(f"movel({ONE})", {0: zone(0.1)}, shared="copy")


@pytest.mark.parametrize("radius", [0.025, 0.1])
def test_zones_grow_and_shrink_by_one_rule(radius: float) -> None:
    def resized(move: Move) -> Move:
        assert isinstance(move.zone, Radius)
        return replace(move, zone=move.zone.resized(radius))

    def torn(move: Move) -> Move:
        assert isinstance(move.zone, Radius)
        return replace(move, zone=replace(move.zone, tcp=radius))

    text = f"movel({ONE}, r=0.05)\n"
    assert patched(text, {0: resized}) == f"movel({ONE}, r={radius})\n"
    with pytest.raises(MotionError, match=r"move 1: zone: URScript has one radius .*resized"):
        patched(text, {0: torn})
