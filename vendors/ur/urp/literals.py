"""Numbers of a generated script, each with its place in the program's tree.

While a script grows, a literal that has a place is a token; at the end tokens become text, and it
is known from where to where each literal stands.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from .xml_file import Element

PARAMETERS = "motionParameters"
"""The element of a waypoint that holds its own speeds, time and blend radius."""
POSE, JOINTS = "_p", "_q"
"""What variables of a waypoint end with."""
_OPEN, _CLOSE = "\ue000", "\ue001"
_TOKEN = re.compile(f"{_OPEN}([0-9]+){_CLOSE}")


@dataclass(frozen=True)
class Attribute:
    """A number of a node.

    Args:
        element: the node.
        name: of the attribute.
        within: the child of the node that has it, which is put in where it is missing; None for the
            node itself.
    """

    element: Element
    name: str
    within: str | None = None


@dataclass(frozen=True)
class Ending:
    """The place before the closing bracket of a move's call, where arguments are put in.

    Args:
        attributes: of each argument that the node can have.
    """

    attributes: Mapping[str, Attribute]


@dataclass(frozen=True)
class Position:
    """The pose or the joints of a waypoint.

    Args:
        waypoint: its name in the script.
        part: `POSE` or `JOINTS`.
        elements: that hold it; waypoints of one name are one waypoint, and change together.
    """

    waypoint: str
    part: str
    elements: list[Element]


@dataclass(frozen=True)
class CodeLine:
    """A line of code of a script file, whose text the program holds.

    Args:
        element: that holds it.
        line: its number, from 0.
    """

    element: Element
    line: int


Place = Attribute | Ending | Position | CodeLine


@dataclass(frozen=True)
class Literal:
    """A literal of a script: from ``start`` to before ``end``, characters."""

    start: int
    end: int
    place: Place


@dataclass
class Literals:
    """The literals of a script that is being written."""

    _found: list[tuple[str, Place]] = field(default_factory=list)

    def token(self, text: str, place: Place) -> str:
        """What stands for a literal until the script is complete."""
        self._found.append((text, place))
        return f"{_OPEN}{len(self._found) - 1}{_CLOSE}"

    def placed(self, script: str) -> tuple[str, tuple[Literal, ...]]:
        """A script with its literals in the place of their tokens, and where they are, in order."""
        parts: list[str] = []
        literals: list[Literal] = []
        at = length = 0
        for found in _TOKEN.finditer(script):
            index = int(found[1])
            if index >= len(self._found):
                continue  # a text of the user's has such signs
            text, place = self._found[index]
            parts += [script[at : found.start()], text]
            length += found.start() - at
            literals.append(Literal(length, length + len(text), place))
            length, at = length + len(text), found.end()
        return "".join([*parts, script[at:]]), tuple(literals)
