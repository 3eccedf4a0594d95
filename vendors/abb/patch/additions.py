"""New data in the user's own modules, declared beside those that are there."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import chain

from ....core.errors import Span
from ....core.source.patch.edits import Edit
from ..syntax.tree import Module
from .places import FilePlaces, Places

DEFAULT_INDENTATION = "    "
_FALLBACK = {"robtarget": "pFb", "jointtarget": "jFb", "zonedata": "zFb", "speeddata": "vFb"}


@dataclass
class Additions:
    """Data to be declared; names are unique in all modules of the program."""

    places: Places
    _given: dict[tuple[str, int, str, str, str], str] = field(default_factory=dict)
    _lines: dict[tuple[str, int], tuple[int, list[str]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._names = self.places.names()

    def declare(
        self, type_: str, literal: str, wanted: str, user: Span, move: int, share: str = ""
    ) -> str:
        """The name of a new datum in the module that ``user`` lies in.

        Args:
            wanted: a name to be near to.
            user: where it will be used.
            move: index of the move that needs it.
            share: data of one value and mark are one datum.
        """
        module = self.places.module(user)
        key = (module.span.file, module.span.start, type_, literal, share)
        if key not in self._given:
            name = self._names.claim(wanted, _FALLBACK[type_])
            line = f"LOCAL CONST {type_} {name}:={literal};"
            self._given[key] = name
            at = _Anchor.of(module, type_, self.places.file(user))
            self._lines.setdefault((module.span.file, at.offset), (move, []))[1].append(
                at.before + line
            )
        return self._given[key]

    def edits(self) -> list[Edit]:
        """The declarations, each where it belongs."""
        return [
            Edit(self._point(file, offset), "".join(lines), move)
            for (file, offset), (move, lines) in self._lines.items()
        ]

    def _point(self, file: str, offset: int) -> Span:
        source = self.places.file(Span(file, 1, 1, 0, 0)).source
        return source.span(offset, offset)


@dataclass(frozen=True, slots=True)
class _Anchor:
    """Where a declaration goes in, and what goes before it."""

    offset: int
    before: str

    @classmethod
    def of(cls, module: Module, type_: str, file: FilePlaces) -> _Anchor:
        """Behind the last declaration of its type, of any type, or the module's head."""
        of_type = [d.span for d in module.declarations if d.type == type_]
        others = [node.span for node in (*module.declarations, *module.types)]
        spans = of_type or others
        if spans:
            last = max(spans, key=lambda span: span.end)
            offset, begin = last.end, last.start
        else:
            offset, begin = _head_end(module, file), -1
        indentation = file.indentation(begin) if begin >= 0 else None
        if indentation is None:
            indentation = _indentation(module, file)
        end = file.line_end(offset)
        if end is not None:
            return cls(end.start(), end[0] + indentation)
        new_line = file.new_line
        return cls(offset, new_line + (indentation if new_line != " " else ""))


def _head_end(module: Module, file: FilePlaces) -> int:
    """Where ``MODULE name (attributes)`` ends."""
    tokens = file.tokens
    index = file.token_at(module.span.start) + 1
    if tokens.kinds[index + 1] == "(":
        while tokens.kinds[index] != ")":
            index += 1
    return tokens.ends[index]


def _indentation(module: Module, file: FilePlaces) -> str:
    """That of the module's first line that has any."""
    for node in chain(module.declarations, module.types, module.routines):
        found = file.indentation(node.span.start)
        if found is not None:
            return found
    return DEFAULT_INDENTATION
