"""Files of script nodes: PolyScope keeps a copy of their text in the program.

Where the file is there PolyScope reads it again, so that a change of the copy alone would be lost:
both are changed, or none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from itertools import takewhile
from pathlib import Path

from .....core.errors import FlybyError, InputError
from .....core.source.text.files import SourceFile, lines_of, read_source
from ..xml_file import Element, child

COPY = "cachedContents"


def code_files(root: Element, program: Path) -> dict[str, SourceFile]:
    """The files of a program's script nodes that lie beside it, by their names."""
    found = {}
    for name in set(filter(None, map(_name, root.iter(COPY)))):
        with suppress(FlybyError, OSError, ValueError):
            if (program.parent / name).is_file():
                found[name] = read_source(program.parent / name)
    return found


def code_file(copy: Element, at_hand: Mapping[str, SourceFile], program: str) -> SourceFile:
    """The file that a program's copy of code is of.

    Args:
        copy: the element that holds the copy.
        at_hand: as `code_files` has found them.
        program: its name, for messages.

    Raises:
        InputError: it is not at hand, or holds other code.
    """
    name = _name(copy)
    file = None if name is None else at_hand.get(name)
    if file is None:
        raise InputError(
            f"{program}: the code of a script node stands in {name or 'a file'}, of which the "
            "program holds a copy; PolyScope reads the file again, so that both are changed or "
            "none: put the file beside the program"
        )
    if _lines(file.text) != _lines(copy.text or ""):
        raise InputError(
            f"{program}: {name} beside it is not as the copy in the program, which one of both is "
            "older: open and save the program in PolyScope first"
        )
    return file


def stretches(text: str, lines: Mapping[int, str]) -> Iterator[tuple[int, int, str]]:
    """What of a text changes where lines of code are to be others.

    Args:
        lines: the new ones by their numbers from 0, without blanks behind them.

    Returns:
        From where, to before where, and what takes the place of that; in order.
    """
    at = 0
    for number, line in enumerate(lines_of(text)):
        start = at = text.index(line, at)
        at += len(line)
        old, new = line.rstrip(), lines.get(number)
        if new is None or new == old:
            continue
        same = _alike(old, new)
        rest = _alike(old[same:][::-1], new[same:][::-1])
        yield start + same, start + len(old) - rest, new[same : len(new) - rest]


def _alike(one: str, other: str) -> int:
    """How many characters two texts have in common before the first that differs."""
    pairs = zip(one, other, strict=False)
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))


def _name(copy: Element) -> str | None:
    """What the file is called, without its folder."""
    file = child(copy.getparent(), "file")
    text = "" if file is None else str(file.text or "")
    return text.strip().replace("\\", "/").rpartition("/")[2] or None


def _lines(text: str) -> list[str]:
    return [line.rstrip() for line in lines_of(text.rstrip())]
