"""Edits in files, and what counts as the same program."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flyby.core.errors import InputError, SourceError
from flyby.core.program.move import MoveJ, MoveL, Opaque, Wait
from flyby.core.program.origin import MoveOrigin, Origin, Ownership
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Load, Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.source.patch.edits import (
    TOLERANCE,
    Edit,
    alike,
    changed_moves,
    difference,
    listed,
    patched,
    reading_of,
)
from flyby.core.source.reading import Files, ReadOptions, read_with
from flyby.core.source.text.files import SourceFile, SourceText
from flyby.core.spatial.pose import Pose
from flyby.testing.strategies import poses

NUMBER = re.compile(r"[-\d.]+")


def read(files: Files, main: str, options: ReadOptions) -> Program:
    """A language of joint moves: every number of the files is a move of all joints by it."""
    moves = []
    for name, file in files.items():
        source = SourceText(file.text, name)
        for match in NUMBER.finditer(file.text):
            span = source.span(match.start(), match.end())
            try:
                value = float(match.group())
            except ValueError:
                raise SourceError("no number", span) from None
            origin = Origin(Ownership.OWNED, span, numbers=(span,))
            where = MoveOrigin(span, origin, origin, origin)
            moves.append(MoveJ(JointTarget((value,)), Speed(tcp=1.0), FINE, origin=where))
    return Program(tuple(moves))


def of(*texts: str) -> Program:
    files = {f"{k}.txt": SourceFile(f"{k}.txt", text) for k, text in enumerate(texts)}
    return read_with(files, "0.txt", ReadOptions(), read)


def with_values(program: Program, values: dict[int, float]) -> Program:
    moves = [
        replace(m, target=JointTarget((values[i],))) if i in values else m
        for i, m in enumerate(program.moves)
    ]
    return program.with_moves(tuple(moves))


def edits_for(before: Program, after: Program) -> list[Edit]:
    return [
        Edit(old.origin.target.span, repr(new.target.joints[0]), i)
        for i, old, new in changed_moves(before, after)
    ]


VALUES = st.floats(-100, 100, allow_subnormal=False).map(lambda x: round(x, 3))
TEXTS = st.lists(VALUES, min_size=1, max_size=6).map(lambda v: " ; ".join(map(repr, v)) + "\r\n")


@given(TEXTS, TEXTS, st.data())
def test_edits_change_their_stretches_and_nothing_else(
    first: str, second: str, data: st.DataObject
) -> None:
    program = of(first, second)
    places = st.integers(0, len(program.moves) - 1)
    values = data.draw(st.dictionaries(places, VALUES, max_size=4))
    after = with_values(program, values)
    edits = edits_for(program, after)
    files = patched(after, reading_of(program), data.draw(st.permutations(edits)))
    assert reading_of(program).again(files) == after
    untouched = {e.span.file for e in edits} ^ set(files)
    assert not untouched
    for name, file in files.items():
        old = reading_of(program).files[name]
        assert NUMBER.split(file.text) == NUMBER.split(old.text)


def test_an_edit_that_changes_nothing_gives_no_file() -> None:
    program = of("1.0 2.0")
    same = Edit(program.moves[0].origin.target.span, "1.0", 0)
    assert patched(program, reading_of(program), [same]) == {}


def test_an_edit_that_does_not_give_the_program_is_refused() -> None:
    program = of("1 2")
    after = with_values(program, {0: 5.0})
    with pytest.raises(InputError, match=r"move 1 has another target.*nothing was changed"):
        patched(after, reading_of(program), [])
    wrong = Edit(program.moves[0].origin.target.span, "5 6", 0)
    with pytest.raises(InputError, match=r"3 moves instead of 2.*nothing was changed"):
        patched(after, reading_of(program), [wrong])
    with pytest.raises(SourceError, match="no number"):
        patched(after, reading_of(program), [replace(wrong, text="..")])


def test_edits_that_contradict_each_other_are_refused() -> None:
    program = of("123 4")
    span = program.moves[0].origin.target.span
    reading = reading_of(program)
    with pytest.raises(InputError, match=r"0\.txt:1:1: moves 1 and 2 .* 5 and 6"):
        patched(program, reading, [Edit(span, "5", 0), Edit(span, "6", 1)])
    inner = span._replace(start=1, end=2)
    with pytest.raises(InputError, match="overlapping"):
        patched(program, reading, [Edit(span, "5", 0), Edit(inner, "6", 1)])
    with pytest.raises(InputError, match=r"9\.txt is not among the files"):
        patched(program, reading, [Edit(span._replace(file="9.txt"), "5", 0)])


def test_the_same_edit_twice_is_one() -> None:
    program = of("1 2")
    after = with_values(program, {0: 5.0})
    edit = Edit(program.moves[0].origin.target.span, "5", 0)
    files = patched(after, reading_of(program), [edit, replace(edit, move=1)])
    assert files["0.txt"].text == "5 2"


def test_text_can_be_put_in() -> None:
    program = of("1 2")
    place = program.moves[0].origin.target.span._replace(start=1, end=1)
    after = with_values(program, {0: 1.5})
    files = patched(after, reading_of(program), [Edit(place, ".5", 0)])
    assert files["0.txt"].text == "1.5 2"


@pytest.mark.parametrize(
    "change",
    [
        lambda s: s[:-1],
        lambda s: (*s, s[0]),
        lambda s: (s[1], s[0], s[2]),
        lambda s: (s[0], Wait(2.0), s[2]),
        lambda s: (MoveL(s[0].target, s[0].speed), *s[1:]),
    ],
)
def test_other_statements_are_no_patch(change) -> None:  # type: ignore[no-untyped-def]
    move = MoveJ(JointTarget((1.0,)), Speed(tcp=1.0))
    program = Program((move, Wait(1.0), Opaque("x")))
    with pytest.raises(InputError, match="write it as new files"):
        changed_moves(program, replace(program, statements=change(program.statements)))


NUMBERS = st.floats(-1e3, 1e3, allow_subnormal=False)
MOVES = st.builds(
    MoveL,
    st.builds(PoseTarget, poses(), name=st.sampled_from(["p1", None])),
    st.builds(Speed, tcp=st.floats(0.01, 5), name=st.sampled_from(["v1", None])),
    st.builds(Radius, st.floats(0, 1), name=st.sampled_from(["z1", None])),
    st.builds(Tool, st.just("gun"), poses(), st.none() | st.builds(Load, st.floats(0, 9))),
)
OTHERS = st.builds(Wait, st.floats(0, 9)) | st.builds(Opaque, st.text(max_size=3))
PROGRAMS = st.lists(MOVES | OTHERS, min_size=1, max_size=5).map(lambda s: Program(tuple(s)))


@given(PROGRAMS)
def test_a_program_does_not_differ_from_itself_by_any_other_name(program: Program) -> None:
    def renamed(move: MoveL) -> MoveL:
        target = replace(move.target, name="q")
        turned = replace(target.pose, quaternion=tuple(-x for x in target.pose.quaternion))
        return replace(
            move,
            target=replace(target, pose=turned),
            speed=replace(move.speed, name="w"),
            zone=replace(move.zone, name=None),
            tool=replace(move.tool, name="other"),
        )

    assert difference(program, program) is None
    other = program.with_moves(tuple(renamed(move) for move in program.moves))
    assert difference(program, replace(other, name="b")) is None


@given(PROGRAMS, st.data())
def test_a_number_that_differs_is_found_with_its_move(
    program: Program, data: st.DataObject
) -> None:
    assume(program.moves)
    index = data.draw(st.integers(0, len(program.moves) - 1))
    move = program.moves[index]
    part = data.draw(st.sampled_from(["target", "speed", "zone", "tool"]))
    step = data.draw(st.sampled_from([1e-6, 0.5]))
    x, y, z = move.target.pose.position
    changed = {
        "target": replace(move.target, pose=replace(move.target.pose, position=(x, y + step, z))),
        "speed": replace(move.speed, tcp=move.speed.tcp + step),
        "zone": replace(move.zone, tcp=move.zone.tcp + step),
        "tool": replace(move.tool, load=Load(20.0)),
    }
    moves = list(program.moves)
    moves[index] = replace(move, **{part: changed[part]})
    assert difference(program, program.with_moves(tuple(moves))) == (index, part)
    if part != "tool":
        assert difference(program, program.with_moves(tuple(moves)), 1.0) is None


@given(PROGRAMS, st.data())
def test_other_statements_and_their_places_count(program: Program, data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(program.statements)))
    statements = list(program.statements)
    statements.insert(at, Wait(123.0))
    longer = replace(program, statements=tuple(statements))
    assert difference(program, longer) == (-1, "statements that are no moves differ")
    elsewhere = data.draw(st.integers(0, len(program.statements)))
    other = list(program.statements)
    other.insert(elsewhere, Wait(123.0))
    moved = replace(program, statements=tuple(other))
    assert (difference(longer, moved) is None) == (moved == longer)
    start = replace(program, start=JointTarget((1.0,)))
    assert difference(program, start) is not None


@given(NUMBERS, NUMBERS)
def test_numbers_are_alike_within_the_tolerance(one: float, other: float) -> None:
    near = abs(one - other) <= TOLERANCE * max(1.0, abs(one), abs(other))
    assert alike(one, other) == near
    assert alike(one, one + 0.5 * TOLERANCE)
    assert alike((one, "a"), (one, "a")) and not alike((one,), (one, one))


def test_kinds_are_not_alike() -> None:
    assert not alike(True, 1.0) and not alike(1.0, True) and alike(True, True)
    assert not alike(None, 0.0) and not alike("1", 1.0) and not alike(Radius(0.0), FINE)
    assert not alike(Pose(), Pose((0, 0, 1e-6)))
    assert not alike(Pose(), Pose(quaternion=(0.0, 1.0, 0.0, 0.0)))


def test_moves_are_listed_by_number() -> None:
    assert listed([2]) == "move 3"
    assert listed([0, 4]) == "moves 1, 5"
    assert listed(range(9)) == "moves 1, 2, 3, 4, 5, 6 and 3 others"
    assert listed(range(7)) == "moves 1, 2, 3, 4, 5, 6 and 1 other"
