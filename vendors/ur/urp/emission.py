"""A script as it grows: lines, the nodes that they come from, and what is to be said of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache

from ....core.source.text.files import lines_of
from .expressions import expression_text, identifier
from .installation import Installation, Payload
from .literals import Attribute, CodeLine, Literals, Position
from .xml_file import Element, number

GENERATED = "# Generated from the program tree of PolyScope; the tree itself is not changed.\n"
"""The first line of every generated script."""
MARKER = "$"
"""Begins the line that names a node, as in PolyScope's own scripts."""
_SEPARATOR = " > "


def pose_text(pose: Sequence[float]) -> str:
    """``p[…]`` of a pose, in m and rad."""
    return f"p[{', '.join(repr(float(value)) for value in pose)}]"


def list_text(values: Sequence[float]) -> str:
    """``[…]`` of numbers."""
    return f"[{', '.join(repr(float(value)) for value in values)}]"


def quoted(text: str) -> str:
    """A text as a literal; scripts have no way to write a quote in one."""
    return '"' + " ".join(text.replace('"', "'").split()) + '"'


def payload_text(payload: Payload) -> str:
    """The call that sets a payload."""
    stated = f"{payload.mass!r}, {list_text(payload.centre)}"
    if payload.inertia is None:
        return f"set_payload({stated})"
    return f"set_target_payload({stated}, {list_text(payload.inertia)})"


@dataclass
class Emission:
    """A script that is being written.

    Args:
        installation: the one of the program; an empty one if there is none.
        named: the installation that the program names.
        with_installation: whether it is at hand.

    Attributes:
        lines: of the program's body.
        preamble: what stands before it: waypoints, functions, subprograms.
        told: notes by their text, each with the node that it is first about.
        waypoints: the data of each, by its name.
        literals: with their places in the tree.
        path: of the node that is being written.
    """

    installation: Installation
    named: str
    with_installation: bool
    lines: list[str] = field(default_factory=list)
    preamble: list[str] = field(default_factory=list)
    told: dict[str, str] = field(default_factory=dict)
    waypoints: dict[str, Mapping[str, str]] = field(default_factory=dict)
    literals: Literals = field(default_factory=Literals)
    path: tuple[str, ...] = ()
    _depth: int = 1
    _nodes: int = 0
    _elements: dict[str, list[Element]] = field(default_factory=dict)

    @property
    def named_signals(self) -> Mapping[str, str]:
        """The controller's names of signals by the operator's."""
        return self.installation.signals

    @property
    def number(self) -> int:
        """Of the node that is being written, from 1."""
        return self._nodes

    def write(self, text: str) -> None:
        """Lines at the present depth."""
        indent = "  " * self._depth
        self.lines += [f"{indent}{line}".rstrip() for line in lines_of(text)]

    def code(self, element: Element) -> None:
        """The code that an element holds, line by line."""
        for index, line in enumerate(lines_of(element.text.rstrip())):
            code = line.rstrip()
            self.write(self.literals.token(code, CodeLine(element, index)) if code else "")

    def expression(self, element: Element | None) -> str:
        """An expression's text."""
        return expression_text(element, self.named_signals)

    def note(self, message: str) -> None:
        """A note on the present node, unless the same was said of another one."""
        self.told.setdefault(message, _SEPARATOR.join(self.path))

    @contextmanager
    def node(self, label: str) -> Iterator[None]:
        """What is written inside comes from a node of this name in the tree."""
        before = self.path
        self.path = (*before, " ".join(label.replace('"', "'").split()))
        self._nodes += 1
        self.mark()
        try:
            yield
        finally:
            self.path = before

    def mark(self) -> None:
        """Name the present node: what is written behind comes from it, not from one below it."""
        self.write(f'{MARKER} {self._nodes} "{_SEPARATOR.join(self.path)}"')

    @contextmanager
    def block(self, head: str) -> Iterator[None]:
        """A block of a head, to its ``end``."""
        self.write(head)
        self._depth += 1
        yield
        self._depth -= 1
        self.write("end")

    @contextmanager
    def part(self, head: str) -> Iterator[None]:
        """A block that others follow before the ``end``."""
        self.write(head)
        self._depth += 1
        yield
        self._depth -= 1

    @contextmanager
    def apart(self) -> Iterator[None]:
        """What is written inside goes into the preamble."""
        lines, depth = self.lines, self._depth
        self.lines, self._depth = [], 1
        try:
            yield
        finally:
            self.preamble += self.lines
            self.lines, self._depth = lines, depth

    def declared(self, name: str, value: Mapping[str, str], element: Element | None = None) -> str:
        """A name for data of a waypoint, which stand in the preamble: one for each that differs.

        Args:
            name: of the waypoint.
            value: of each of its variables, by what their names end with.
            element: that holds them; None where they have no place of their own in the tree.
        """
        stem = identifier(name) or "Waypoint"
        tried, count = stem, 1
        while self.waypoints.get(tried, value) != value:
            count += 1
            tried = f"{stem}_{count}"
        elements = self._elements.setdefault(tried, [])
        if tried not in self.waypoints:
            self.waypoints[tried] = dict(value)
            for end, text in value.items():
                place = Position(tried, end, elements)
                shown = text if element is None else self.literals.token(text, place)
                self.preamble.append(f"  global {tried}{end}={shown}")
        if element is not None and element not in elements:
            elements.append(element)
        return tried

    def shared(self, node: Element, attribute: str, end: str) -> str | None:
        """A variable for a number that all moves of a node share; None if it states none.

        Args:
            node: that states it.
            attribute: in which.
            end: what the variable's name ends with.
        """
        value = number(node.get(attribute))
        if value is None:
            return None
        name = f"{identifier(node.get('motionType') or node.tag)}_{self._nodes}{end}"
        text = self.literals.token(repr(value), Attribute(node, attribute))
        self.preamble.append(f"  global {name}={text}")
        return name


def node_at(text: str, line: int) -> str | None:
    """The node that a line of a generated script comes from; None if that is not known.

    Args:
        text: of the script.
        line: counted from 1.
    """
    nodes = _nodes(text) if text.startswith(GENERATED) else ()
    return nodes[line - 1] if 0 < line <= len(nodes) else None


@lru_cache(maxsize=4)
def _nodes(text: str) -> tuple[str | None, ...]:
    """The node of each line."""
    node: str | None = None
    found = []
    for line in lines_of(text):
        marked = line.strip()
        if marked.startswith(f"{MARKER} ") and marked.endswith('"'):
            node = marked.partition('"')[2][:-1]
        found.append(node)
    return tuple(found)
