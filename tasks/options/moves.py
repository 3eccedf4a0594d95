"""Moves as users name them: by number, by the line of the source, or by where they go."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import at_command_line, spelt
from ...core.errors import InputError, OptionError, Span

if TYPE_CHECKING:
    from ...core.program.move import Move
    from ...core.program.program import Program

NAMED = "a number, line:44 (or line:40-52, line:FILE:44) or the name of a target"
"""How a move may be named."""
_LINE = re.compile(r"line:(?:(?P<file>.+):)?(?P<first>\d+)(?:-(?P<last>\d+))?", re.IGNORECASE)
_OFFERED = 12
"""Lines or names that a message lists at most."""


def is_named(text: str) -> bool:
    """Whether a text says a number or a line; else it is a name."""
    return text.isdecimal() or text.lower().startswith("line:")


def moves_named(program: Program, text: int | str, option: str) -> list[int]:
    """Indices of the moves that a text names, in their order: one, or all that a line drives or
    that go to a target.

    Raises:
        OptionError: it is no name of moves; naming the option.
        InputError: the program has no such move; likewise.
    """
    said = str(text)
    if not is_named(said):
        found = moves_to(program.moves, said)
        if not found:
            raise InputError(f"{spelt(option)} {said or repr(said)}: {_no_target(program, said)}")
        return found
    if said.isdecimal():
        count = len(program.moves)
        if not 1 <= int(said) <= count:
            raise InputError(f"{spelt(option)} {said}: the program has moves 1 to {count}")
        return [int(said) - 1]
    return _on_line(program.moves, said, option)


def moves_to(moves: Sequence[Move], name: str) -> list[int]:
    """Indices of the moves to a target of the source; names are alike in any case."""
    return [i for i, move in enumerate(moves) if name.casefold() in _names(move)]


def targets(moves: Sequence[Move]) -> list[str]:
    """Names of targets, in the order in which they come first."""
    return list(dict.fromkeys(m.target.name for m in moves if m.target.name is not None))


def _names(move: Move) -> set[str]:
    """What the target of a move is called: itself, and the datum that it is made of."""
    datum = None if move.origin is None else move.origin.target.datum
    names = (move.target.name, datum, None if datum is None else re.split(r"[/.]", datum)[-1])
    return {name.casefold() for name in names if name is not None}


def _no_target(program: Program, name: str) -> str:
    known = targets(program.moves)
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.6)
    offer = f"did you mean {near[0]}?" if near else f"targets: {listed_names(known)}"
    return f"no move goes there ({offer}); name moves by {NAMED}"


def listed_names(names: Iterable[str]) -> str:
    """Names for a message, cut where there are too many."""
    known = list(names)
    more = f" and {len(known) - _OFFERED} more" if len(known) > _OFFERED else ""
    return (", ".join(known[:_OFFERED]) or "none has a name") + more


def _on_line(moves: Sequence[Move], text: str, option: str) -> list[int]:
    """Indices of the moves that a line drives, or several lines in a row."""
    match = _LINE.fullmatch(text)
    if match is None:
        raise OptionError(f"{spelt(option)} {text}: {NAMED}{_once(text)}")
    first, last = int(match["first"]), int(match["last"] or match["first"])
    spans = {i: move.statement for i, move in enumerate(moves) if move.statement is not None}
    if match["file"] is not None:
        wanted = match["file"].casefold()
        spans = {i: s for i, s in spans.items() if _called(s, wanted)}
    found = [i for i, span in spans.items() if first <= span.line <= last]
    files = list(dict.fromkeys(Path(spans[i].file).name for i in found))
    if len(files) > 1:
        shown = match["first"] + (f"-{match['last']}" if match["last"] else "")
        either = " or ".join(f"line:{name}:{shown}" for name in files)
        raise InputError(f"{spelt(option)} {text}: which file? {either}")
    if not found:
        lines = sorted({span.line for span in spans.values()})
        near = sorted(sorted(lines, key=lambda line: abs(line - first))[:_OFFERED])
        raise InputError(
            f"{spelt(option)} {text}: no move is driven from there; the nearest are from "
            f"{'line' if len(near) == 1 else 'lines'} {', '.join(map(str, near))}"
            if near
            else f"{spelt(option)} {text}: no move of that file is driven"
        )
    return found


def _called(span: Span, wanted: str) -> bool:
    path = Path(span.file)
    return wanted in (path.name.casefold(), path.stem.casefold(), span.file.casefold())


def _once(text: str) -> str:
    """A remark where several were given at once."""
    return "; once for each move" if at_command_line() and "," in text else ""
