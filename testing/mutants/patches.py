"""Faults of patchers, and of what readers record of where numbers stand."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from difflib import SequenceMatcher
from typing import Any

from ...core.errors import Span
from ...core.program.move import Move
from ...core.program.origin import MoveOrigin, Origin, Ownership
from ...core.program.program import Program
from ...core.source.patch.edits import PARTS, reading_of
from ...core.source.reading import Files
from ...core.source.text.files import SourceFile
from ...core.vendor import Vendor
from ..checks.subject import Subject
from ..hostile import NUMBER
from .mutant import Mutant, has
from .units import COARSE
from .wrapping import each_move, in_patched_files, in_patching, in_reading

PATCHES = ("test_patches_of_golden_texts",)
READS = ("test_recorded_reads_are_those_of_the_text",)


def _at_another_number(files: Files, before: Files) -> Files:
    """What was written stands at the number before the one that it belongs to."""
    made = {}
    for key, file in files.items():
        old = before[file.name]
        numbers = list(NUMBER.finditer(old.text))
        changed = _first_change(old.text, file.text)
        at = next((k for k, one in enumerate(numbers) if one.end() > changed), 0)
        new = list(NUMBER.finditer(file.text))
        if at > 0 and len(new) == len(numbers):
            here = numbers[at - 1]
            made[key] = old.edited([(here.start(), here.end(), new[at].group())])
        else:
            made[key] = file
    return made


def _first_change(old: str, new: str) -> int:
    steps = SequenceMatcher(None, old, new, autojunk=False).get_opcodes()
    return next((start for step, start, *_ in steps if step != "equal"), 0)


def _without_comments(sign: str) -> Callable[[Files, Files], Files]:
    numbered = re.compile(rf"\s*(?:\d+\s*:\s*)?{re.escape(sign)}")

    def left(file: SourceFile) -> SourceFile:
        lines = file.text.splitlines(keepends=True)
        kept = [line for line in lines if not numbered.match(line)]
        return replace(file, text="".join(kept))

    return lambda files, _: {key: left(file) for key, file in files.items()}


def _comments_lost(vendor: Vendor) -> Vendor:
    sign = ";" if vendor.speaks is None else vendor.speaks.comment.strip()
    return in_patched_files(_without_comments(sign))(vendor)


def _other_line_ends(files: Files, _: Files) -> Files:
    return {key: replace(file, text=file.text.replace("\n", "\r\n")) for key, file in files.items()}


def _for_all_readers(program: Program) -> Program:
    """A part that is changed for one move is changed wherever its numbers are read."""
    before = reading_of(program).again({})
    moves = list(program.moves)
    for index, move in enumerate(program.moves):
        for part in PARTS:
            new = getattr(move, part, None)
            if new is None or new == getattr(before.moves[index], part):
                continue
            numbers = _origin(move, part).numbers
            for other, one in enumerate(moves):
                parts = [p for p in PARTS if hasattr(one, p)]
                shares = [p for p in parts if _origin(one, p).numbers == numbers]
                if numbers:
                    moves[other] = replace(one, **dict.fromkeys(shares, new))
    return program.with_moves(tuple(moves))


def _origin(move: Move, part: str) -> Origin:
    nowhere = Origin(Ownership.DERIVED, Span("", 1, 1, 0, 0))
    return getattr(move.origin, part, None) or nowhere


def _origins(change: Callable[[Origin], Origin]) -> Callable[[Move], Move]:
    def changed(move: Move) -> Move:
        origin = move.origin
        if not isinstance(origin, MoveOrigin):
            return move
        parts = {part: getattr(origin, part) for part in PARTS}
        made: dict[str, Any] = {part: change(one) for part, one in parts.items() if one is not None}
        return replace(move, origin=replace(origin, **made))

    return changed


def _all_owned(origin: Origin) -> Origin:
    if origin.ownership is not Ownership.SHARED:
        return origin
    return replace(origin, ownership=Ownership.OWNED)


def _first_reader_alone(program: Program) -> Program:
    """Of the moves that read a literal, only the first says so."""
    seen: set[Span] = set()

    def alone(origin: Origin) -> Origin:
        numbers = tuple(one if one not in seen else None for one in origin.numbers)
        seen.update(one for one in origin.numbers if one is not None)
        return replace(origin, numbers=numbers, ownership=Ownership.OWNED)

    return each_move(_origins(alone))(program)


def _moved_spans(program: Program) -> Program:
    """The numbers of each move are said to stand where those of the next one do."""
    moves = program.moves
    made = []
    for move, other in zip(moves, (*moves[1:], *moves[:1]), strict=True):
        if move.origin is None or other.origin is None:
            made.append(move)
            continue
        target = replace(move.origin.target, numbers=other.origin.target.numbers)
        made.append(replace(move, origin=replace(move.origin, target=target)))
    return program.with_moves(tuple(made))


def _shares(suite: Subject) -> bool:
    return has("shared datum")(suite)


MUTANTS = (
    Mutant("patch of another literal", in_patched_files(_at_another_number), PATCHES),
    Mutant("patch rounded too coarsely", in_patching(COARSE), PATCHES),
    Mutant("patch of data that other moves use", in_patching(_for_all_readers), PATCHES, _shares),
    Mutant("comments lost by the patcher", _comments_lost, PATCHES, has("comment")),
    Mutant("line ends changed by the patcher", in_patched_files(_other_line_ends), PATCHES),
    Mutant(
        "shared data taken for owned", in_reading(each_move(_origins(_all_owned))), READS, _shares
    ),
    Mutant("reads not recorded", in_reading(_first_reader_alone), READS, _shares),
    Mutant("numbers recorded at another place", in_reading(_moved_spans), READS),
)
