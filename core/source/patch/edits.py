"""Changes in a user's own source files, byte for byte.

A vendor's patcher says which stretches of text become what; here they are put in place, and the
result is read again: it must be the changed program, or nothing is handed out.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from itertools import pairwise

from ...display import counted
from ...errors import InputError, Span
from ...program.move import Move
from ...program.origin import Origin, Ownership
from ...program.program import Program
from ...program.zone import Radius
from ...spatial.pose import Pose
from ..reading import Files, Reading
from ..text.files import SourceFile

TOLERANCE = 1e-9
"""m, rad, s and their like: how near a number must come back. Decimals of mm and degrees do not
give every double; a nanometre is a thousand times below what controllers resolve."""

_SHOWN = 6
"""Moves that a message names."""

PARTS = ("target", "via", "speed", "zone")
"""The parts of a move whose numbers have a place in the text."""

_LABELS = ("name", "origin", "span", "notes", "reading")
"""Fields that say where a value stands or what it is called, and not what it is."""


@dataclass(frozen=True, slots=True)
class Edit:
    """A stretch of text and what takes its place.

    Args:
        span: of the text that goes; empty where text is put in.
        move: index of the move that asks for it.
    """

    span: Span
    text: str
    move: int


def reading_of(program: Program) -> Reading:
    """How a program was read.

    Raises:
        InputError: it was not read from source files, and so there is nothing to patch.
    """
    if not isinstance(program.reading, Reading):
        raise InputError(
            f"program {program.name!r} was not read from source files: there is nothing to patch; "
            "write it as new files"
        )
    return program.reading


def changed_moves(before: Program, after: Program) -> list[tuple[int, Move, Move]]:
    """Index, old and new move where a program has been changed.

    Raises:
        InputError: statements were added, removed or put in another order.
    """
    old, new = before.statements, after.statements
    kinds = [type(s) for s in old] == [type(s) for s in new]
    if not kinds or any(o != n for o, n in zip(old, new, strict=True) if not isinstance(o, Move)):
        raise InputError(
            "a patch changes targets, zones and speeds of the moves that there are; this program "
            "has other statements: write it as new files"
        )
    pairs = zip(before.moves, after.moves, strict=True)
    return [(i, o, n) for i, (o, n) in enumerate(pairs) if o != n]


def with_one_distance(program: Program) -> Program:
    """The program with zones as they are read in a language that has one distance for all.

    Zones that it cannot say stay as they are: the patcher refuses them with their move.
    """
    return program.with_moves(tuple(map(_with_one_distance, program.moves)))


def _with_one_distance(move: Move) -> Move:
    if not isinstance(move.zone, Radius):
        return move
    try:
        return replace(move, zone=move.zone.with_one_distance())
    except InputError:
        return move


def _why_not(after: Program, move: int, part: str) -> str:
    """What to do about a part that comes out otherwise than it was wanted."""
    origin = getattr(after.moves[move].origin, part, None)
    if isinstance(origin, Origin) and origin.ownership is Ownership.DERIVED:
        return (
            "The program computes it from what was changed (a point that it reads too, or where "
            "the move before ends): change both, as the program has it, or neither"
        )
    return "A number that several moves read must be changed for all of them or for none"


def patched(after: Program, reading: Reading, edits: Iterable[Edit]) -> Files:
    """The files with their edits, read again and found to be the changed program.

    Args:
        after: the program that is to come out.
        edits: at most one text for a stretch.

    Returns:
        The files that changed, by name.

    Raises:
        InputError: two edits contradict each other, or what is read again is not ``after``.
        FlybyError: the patched text cannot be read.
    """
    files = _apply(reading, edits)
    again = reading.again(files)
    found = difference(after, again)
    if found is not None:
        move, part = found
        raise InputError(
            f"the patched text does not give the changed program: move {move + 1} has another "
            f"{part}. {_why_not(after, move, part)}; nothing was changed"
            if move >= 0
            else f"the patched text does not give the changed program: {part}; nothing was changed"
        )
    return files


def difference(
    first: Program, second: Program, tolerance: float = TOLERANCE
) -> tuple[int, str] | None:
    """The first move, and the part of it, in which two programs differ; None if in none.

    Names and places in the source do not count; numbers may differ by ``tolerance``, and the two
    quaternions of one rotation are alike. The move is -1 for a difference that is no move's.
    """
    if len(first.moves) != len(second.moves):
        return -1, f"it has {len(second.moves)} moves instead of {len(first.moves)}"
    for index, (one, other) in enumerate(zip(first.moves, second.moves, strict=True)):
        part = _differing_part(one, other, tolerance)
        if part is not None:
            return index, part
    # A move holds the place of a move: it has been compared.
    rest = [[None if isinstance(s, Move) else s for s in p.statements] for p in (first, second)]
    same = alike(rest[0], rest[1], tolerance)
    if not same or not alike(first.start, second.start, tolerance):
        return -1, "statements that are no moves differ"
    return None


def alike(one: object, other: object, tolerance: float = TOLERANCE) -> bool:
    """Whether two values are the same but for labels, signs of quaternions and ``tolerance``."""
    if isinstance(one, float | int) and isinstance(other, float | int):
        if isinstance(one, bool) or isinstance(other, bool):
            return one is other
        return math.isclose(one, other, rel_tol=tolerance, abs_tol=tolerance)
    if type(one) is not type(other):
        return False
    if isinstance(one, Pose) and isinstance(other, Pose):
        return _same_pose(one, other, tolerance)
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        pairs = zip(one, other, strict=False)
        return len(one) == len(other) and all(alike(a, b, tolerance) for a, b in pairs)
    if is_dataclass(one) and not isinstance(one, type):
        names = [f.name for f in fields(one) if f.compare and f.name not in _LABELS]
        return all(alike(getattr(one, n), getattr(other, n), tolerance) for n in names)
    return one == other


def _same_pose(one: Pose, other: Pose, tolerance: float) -> bool:
    opposite = tuple(-x for x in other.quaternion)
    return alike(one.position, other.position, tolerance) and (
        alike(one.quaternion, other.quaternion, tolerance)
        or alike(one.quaternion, opposite, tolerance)
    )


def listed(moves: Sequence[int]) -> str:
    """Moves by number, for messages: "moves 1, 2 and 3 others"."""
    numbers = ", ".join(str(move + 1) for move in moves[:_SHOWN])
    more = f" and {counted(len(moves) - _SHOWN, 'other')}" if len(moves) > _SHOWN else ""
    return f"move{'s' if len(moves) > 1 else ''} {numbers}{more}"


def _differing_part(one: Move, other: Move, tolerance: float) -> str | None:
    if one == other:
        return None
    if type(one) is not type(other):
        return "kind"
    names = [f.name for f in fields(one) if f.compare and f.name not in _LABELS]
    for name in names:
        if not alike(getattr(one, name), getattr(other, name), tolerance):
            return name.replace("_", " ")
    return None


def _apply(reading: Reading, edits: Iterable[Edit]) -> Files:
    by_file: dict[str, dict[tuple[int, int], Edit]] = {}
    put_in: dict[tuple[str, int], list[Edit]] = {}
    for edit in edits:
        place = (edit.span.start, edit.span.end)
        own = by_file.setdefault(edit.span.file, {})
        if edit.span.start == edit.span.end and _also(edit, put_in):
            every = put_in[edit.span.file, edit.span.start]
            own[place] = replace(edit, text="".join(one.text for one in every))
            continue
        known = own.setdefault(place, edit)
        if known.text != edit.text:
            raise InputError(
                f"{edit.span}: moves {known.move + 1} and {edit.move + 1} read the same number and "
                f"want it to become {known.text} and {edit.text}: give them one value, or each a "
                "datum of its own"
            )
    files = {
        name: _edited(reading, name, list(places.values())) for name, places in by_file.items()
    }
    return {n: file for n, file in files.items() if file.text != reading.files[n].text}


def _also(edit: Edit, put_in: dict[tuple[str, int], list[Edit]]) -> bool:
    """Whether what a move has put in at a place stands beside what is put in there already: its
    speed beside its zone, or the same of another pass."""
    every = put_in.setdefault((edit.span.file, edit.span.start), [])
    if any(one.text == edit.text for one in every):
        return True
    if every and all(one.move != edit.move for one in every):
        return False
    every.append(edit)
    return True


def _edited(reading: Reading, name: str, edits: list[Edit]) -> SourceFile:
    if name not in reading.files:
        raise InputError(f"{name} is not among the files of the program: it cannot be patched")
    edits.sort(key=lambda edit: (edit.span.start, edit.span.end))
    for first, second in pairwise(edits):
        if second.span.start < first.span.end:
            raise InputError(
                f"{second.span}: moves {first.move + 1} and {second.move + 1} want to change "
                "overlapping stretches of the text"
            )
    return reading.files[name].edited([(e.span.start, e.span.end, e.text) for e in edits])
