"""The parts of a program's moves before and after a change."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError, MotionError, Span
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL, Wait
from flyby.core.program.origin import MoveOrigin, Origin, Ownership
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import PoseTarget
from flyby.core.program.tool import Load, Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.source.patch.uses import UseKind, uses
from flyby.core.spatial.pose import Pose

SPEED = Speed(tcp=0.1)


def target(x: float) -> PoseTarget:
    return PoseTarget(Pose((x, 0.0, 0.0)))


def origin(line: int, *, arc: bool = False) -> MoveOrigin:
    """Of a move whose parts stand behind each other in its line."""

    def part(column: int) -> Origin:
        return Origin(Ownership.OWNED, Span("a.txt", line, column, column, column + 1))

    via = part(5) if arc else None
    return MoveOrigin(Span("a.txt", line, 1, 0, 9), part(2), part(3), part(4), via)


LINE = MoveL(target(1.0), SPEED, FINE, origin=origin(1))
ARC = MoveC(target(2.0), SPEED, FINE, via=target(1.5), origin=origin(3, arc=True))
BEFORE = Program((LINE, Wait(1.0), ARC))


def after(line: Move) -> Program:
    """The program with another first move."""
    return BEFORE.with_moves((line, ARC))


def nothing(old: Move, new: Move) -> None:
    """No language."""


def test_every_part_of_every_move_is_named_in_order() -> None:
    found = uses(BEFORE, BEFORE, nothing)
    assert [(use.index, use.kind) for use in found] == [
        *((0, kind) for kind in (UseKind.TARGET, UseKind.SPEED, UseKind.ZONE)),
        *((1, kind) for kind in UseKind),
    ]
    assert [use.statement.line for use in found] == [1] * 3 + [3] * 4
    assert not any(use.changes for use in found)


@given(st.floats(-5, 5), st.floats(0.001, 5), st.floats(0.001, 1))
def test_uses_hold_the_values_of_both_programs(x: float, speed: float, radius: float) -> None:
    new = replace(LINE, target=target(x), speed=Speed(tcp=speed), zone=Radius(radius))
    for use in uses(BEFORE, after(new), nothing):
        moves = [(LINE, new), (ARC, ARC)][use.index]
        assert (use.old, use.new) == tuple(getattr(move, use.kind) for move in moves)
        assert use.move == moves[1]
        assert use.changes == (use.old != use.new and not near(use.old, use.new))


def near(old: object, new: object) -> bool:
    """Whether the two differ by less than a text gives back."""
    if type(old) is not type(new):
        return False
    values = [v.pose.position[0] if isinstance(v, PoseTarget) else v.tcp for v in (old, new)]
    return bool(values[0] == pytest.approx(values[1], rel=1e-9, abs=1e-9))


def test_a_rounding_error_is_no_change() -> None:
    found = uses(BEFORE, after(replace(LINE, target=target(1.0 + 1e-12))), nothing)
    assert not any(use.changes for use in found)


@pytest.mark.parametrize(
    ("new", "what"),
    [
        (replace(LINE, tool=Tool("t", Pose((0.0, 0.0, 0.1)))), "tool"),
        (replace(LINE, load=Load(1.0, (0.0, 0.0, 0.0))), "load"),
    ],
)
def test_what_no_patch_changes_is_refused(new: Move, what: str) -> None:
    with pytest.raises(MotionError, match=f"its {what} has changed.*write the program as new"):
        uses(BEFORE, after(new), nothing)


def test_another_kind_of_move_is_refused() -> None:
    with pytest.raises(InputError, match="write it as new files"):
        uses(BEFORE, after(MoveJ(LINE.target, SPEED, FINE)), nothing)


def test_a_language_refuses_more() -> None:
    def stops_only(old: Move, new: Move) -> str | None:
        return None if new.zone == FINE else "zone"

    assert uses(BEFORE, after(replace(LINE, target=target(3.0))), stops_only)
    with pytest.raises(MotionError, match="its zone has changed") as caught:
        uses(BEFORE, after(replace(LINE, zone=Radius(0.1))), stops_only)
    assert LINE.origin is not None
    assert (caught.value.move, caught.value.span) == (0, LINE.origin.statement)


def test_an_error_names_the_part() -> None:
    use = uses(BEFORE, BEFORE, nothing)[-1]
    error = use.error("too wide")
    assert "zone: too wide" in str(error) and error.span == use.origin.span
