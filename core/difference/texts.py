"""Lines of source files on both sides: added, removed, and those that only moved elsewhere."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher

_LEAST_MOVED = 2
"""Lines in a row that count as moved; a single one (``ENDIF``) stands everywhere."""
_MOST_LINES = 4000
"""Between the first and the last difference of a file that are laid side by side; of more, which
takes time with their square, all count as changed."""
_MOST_PLACES = 20
"""Where a stretch of lines may have gone that are looked at."""

Block = tuple[str, ...]
"""Lines in a row."""


@dataclass(frozen=True, slots=True)
class FileDifference:
    """How a source file differs.

    Args:
        name: below the folder of each side.
        before, after: whether it is there.
        added, removed: lines that are new or gone, without those that moved.
        moved: lines that stand elsewhere now, in this file or another, as they were.
    """

    name: str
    before: bool
    after: bool
    added: int
    removed: int
    moved: int

    @property
    def kind(self) -> str:
        """``added``, ``removed``, ``moved`` (nothing else but that) or ``changed``."""
        if self.added or self.removed or not self.moved:
            if not self.before:
                return "added"
            return "changed" if self.after else "removed"
        return "moved"


def file_differences(
    before: Mapping[str, str], after: Mapping[str, str]
) -> tuple[FileDifference, ...]:
    """Files that are not the same; blank lines, indents and ends of line do not count.

    Args:
        before, after: texts by name.
    """
    names = list(dict.fromkeys([*after, *before]))
    changes = {name: _changes(_lines(before.get(name)), _lines(after.get(name))) for name in names}
    gone = [(name, block) for name in names for block in changes[name][0]]
    come = [(name, block) for name in names for block in changes[name][1]]
    out, into = _moved(gone, come)
    found = []
    for name in names:
        removed, added = (sum(map(len, side)) for side in changes[name])
        if removed or added or (name in before) != (name in after):
            left, there = out[name], into[name]
            counts = added - there, removed - left, max(left, there)
            found.append(FileDifference(name, name in before, name in after, *counts))
    return tuple(found)


def _moved(
    gone: Sequence[tuple[str, Block]], come: Sequence[tuple[str, Block]]
) -> tuple[Counter[str], Counter[str]]:
    """How many lines left each file, and came into each, as they were.

    Where stretches of a file moved, single lines count that are left over at their ends: which of
    several ``ENDPROC`` belongs to which is not known.
    """
    pairs: dict[Block, list[tuple[int, int]]] = {}
    for b, (_, block) in enumerate(come):
        for k in range(len(block) - 1):
            pairs.setdefault(block[k : k + _LEAST_MOVED], []).append((b, k))
    used: set[tuple[int, int]] = set()
    out: Counter[str] = Counter()
    into: Counter[str] = Counter()
    rest: list[tuple[str, str]] = []
    for name, block in gone:
        at = 0
        while at < len(block):
            best, begin = 0, (0, 0)
            for b, k in pairs.get(block[at : at + _LEAST_MOVED], [])[:_MOST_PLACES]:
                length = _common(block[at:], come[b][1], b, k, used)
                if length > best:
                    best, begin = length, (b, k)
            if best >= _LEAST_MOVED:
                used |= {(begin[0], begin[1] + n) for n in range(best)}
                out[name] += best
                into[come[begin[0]][0]] += best
            else:
                rest.append((name, block[at]))
            at += best if best >= _LEAST_MOVED else 1
    places: dict[str, list[str]] = {}
    for b, (name, block) in enumerate(come):
        for k, line in enumerate(block):
            if (b, k) not in used and into[name]:
                places.setdefault(line, []).append(name)
    for name, line in rest:
        if out[name] and places.get(line):
            out[name] += 1
            into[places[line].pop()] += 1
    return out, into


def _common(block: Block, other: Block, b: int, k: int, used: set[tuple[int, int]]) -> int:
    """How many lines a stretch has in common with another from its line k on."""
    length = 0
    for line, there in zip(block, other[k:], strict=False):
        if line != there or (b, k + length) in used:
            break
        length += 1
    return length


def _lines(text: str | None) -> Block:
    lines = () if text is None else (line.strip() for line in text.splitlines())
    return tuple(line for line in lines if line)


def _changes(before: Block, after: Block) -> tuple[list[Block], list[Block]]:
    """Stretches of lines that are gone, and that are new."""
    head = _alike(before, after)
    before, after = before[head:], after[head:]
    tail = _alike(before[::-1], after[::-1])
    before, after = before[: len(before) - tail], after[: len(after) - tail]
    if max(len(before), len(after)) > _MOST_LINES:
        return [before], [after]
    matcher = SequenceMatcher(None, before, after, autojunk=False)
    removed: list[Block] = []
    added: list[Block] = []
    for what, a, b, c, d in matcher.get_opcodes():
        if what != "equal":
            removed += [before[a:b]] if b > a else []
            added += [after[c:d]] if d > c else []
    return removed, added


def _alike(before: Block, after: Block) -> int:
    """How many lines are the same from the beginning."""
    pairs = zip(before, after, strict=False)
    return next((k for k, (a, b) in enumerate(pairs) if a != b), min(len(before), len(after)))
