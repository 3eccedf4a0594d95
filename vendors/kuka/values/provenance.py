"""Literals of KRL as the sources of a move's parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ....core.errors import Span
from ....core.program.origin import Spans
from .values import Leaf, Root, Value, leaf_of


class LeafSource:
    """One number of a literal, or one literal number."""

    __slots__ = ("_leaf", "root", "span")

    def __init__(self, leaf: Leaf) -> None:
        self._leaf = leaf
        self.root = leaf.root.span
        self.span = leaf.root.part(leaf.component) or self.root

    @property
    def key(self) -> tuple[int, str]:
        """The same for the same number of the same literal."""
        return id(self._leaf.root), self._leaf.component

    @property
    def datum(self) -> str | None:
        """The datum it belongs to, with its component."""
        root, component = self._leaf.root, self._leaf.component
        if root.datum is None or not component:
            return root.datum
        return f"{root.datum}.{component.upper()}"

    @property
    def numbers(self) -> tuple[Span | None, ...]:
        """The number itself."""
        return (self.span,)


class RecordSource:
    """A whole literal aggregate, read component by component.

    Args:
        leaves: one for each component that is wanted, None where the literal has none.
    """

    __slots__ = ("_leaves", "_places", "datum", "key", "root", "span")

    def __init__(self, leaves: Sequence[Leaf | None], root: Root) -> None:
        self._leaves = leaves
        self._places = root.leaves
        self.span = self.root = root.span
        self.datum = root.datum
        self.key = (id(root), "*")

    @property
    def numbers(self) -> Sequence[Span | None]:
        """Its numbers in the order that is wanted."""
        return Spans(self._numbers)

    def _numbers(self) -> tuple[Span | None, ...]:
        whole, places = self.root, self._places
        file, line, before = whole.file, whole.line, whole.column - whole.start
        spans: list[Span | None] = []
        for leaf in self._leaves:
            place = None if leaf is None else places.get(leaf.component)
            # A literal stands on one line.
            spans.append(place and Span(file, line, before + place[0], *place))
        return tuple(spans)

    def parts(self) -> list[LeafSource | None]:
        """Its numbers, each a source of its own."""
        return [None if leaf is None else LeafSource(leaf) for leaf in self._leaves]


KrlSource = LeafSource | RecordSource


@dataclass(frozen=True, slots=True)
class Sources:
    """The literals of one part of a move, ready for `core.source.provenance.Part`."""

    entries: tuple[KrlSource | None, ...]

    def distinct(self) -> list[KrlSource]:
        """The literals, each once, though it may stand for several numbers."""
        return list({entry.key: entry for entry in self.entries if entry is not None}.values())

    @classmethod
    def each(cls, values: Sequence[Value]) -> Sources:
        """Every number by itself, in canonical order; None for a computed one."""
        leaves = [leaf_of(value) for value in values]
        if not any(leaves):
            return cls(())
        return cls(tuple(None if leaf is None else LeafSource(leaf) for leaf in leaves))

    @classmethod
    def of(cls, values: Sequence[Value | None]) -> Sources:
        """The numbers of a target, in canonical order; None for one that is not programmed.

        If one aggregate holds them all, it is the one source.
        """
        leaves = [None if value is None else leaf_of(value) for value in values]
        first = next(filter(None, leaves), None)
        if first is None:
            return cls(())
        root, one = first.root, bool(first.component)
        for value, leaf in zip(values, leaves, strict=True):
            if value is not None and (leaf is None or leaf.root is not root):
                one = False
        if one:
            return cls((RecordSource(leaves, root),))
        return cls(tuple(None if leaf is None else LeafSource(leaf) for leaf in leaves))
