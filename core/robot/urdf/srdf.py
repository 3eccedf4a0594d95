"""Pairs of links that may touch, from the SRDF that MoveIt's setup assistant writes of a URDF.

    <disable_collisions link1="base_link" link2="link_2" reason="Never"/>

also ``<disable_default_collisions link="…"/>`` (with all others) and ``<enable_collisions
link1="…" link2="…"/>``, which takes single ones back.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Any

from ...errors import InputError
from ...files.reading import read_bytes
from ..shape import TouchingLinks

MOST_BYTES = 20_000_000
SUFFIX = ".srdf"
_BESIDE = (".", "../srdf", "../config")
"""Folders, seen from the URDF's, in which packages of ROS keep it."""
_UNSAID = "no reason given"
_DEFAULT = "Default"
_SHOWN = 5
"""Links that a note names."""

Pair = frozenset[str]


@dataclass
class TouchRules:
    """What an SRDF says of the links of its robot.

    Args:
        file: it.
        pairs: that may touch, with the reason.
        always: links that may touch all others.
        never: pairs that are looked at in spite of ``always``.
        doubts: what is odd about the file.
    """

    file: Path
    pairs: dict[Pair, str] = field(default_factory=dict)
    always: set[str] = field(default_factory=set)
    never: set[Pair] = field(default_factory=set)
    doubts: list[str] = field(default_factory=list)

    def reason(self, first: str, second: str) -> str | None:
        """Why two links may touch; None if they may not."""
        pair = frozenset((first, second))
        if pair in self.pairs:
            return self.pairs[pair]
        if pair in self.never or not {first, second} & self.always:
            return None
        return _DEFAULT

    def touching(self, bodies: Sequence[Collection[str]]) -> tuple[TouchingLinks, ...]:
        """Which links of an arm may touch each other.

        An arm's link is one or more links of the URDF. Two of them may touch where each of the
        one may touch each of the other.

        Args:
            bodies: names of the links with geometry of the base and of each link, in their order.
        """
        found = []
        for i in range(len(bodies)):
            for j in range(i + 1, len(bodies)):
                reasons = [self.reason(a, b) for a, b in product(bodies[i], bodies[j])]
                told = list(dict.fromkeys(reason for reason in reasons if reason is not None))
                if reasons and None not in reasons:
                    found.append(TouchingLinks(i, j, self.file.name, ", ".join(told)))
        return tuple(found)


def find_srdf(urdf: Path, robot: str) -> Path | None:
    """The SRDF of a URDF by the names that ROS gives it: of the file, or of its robot.

    Args:
        urdf: the file.
        robot: the name that it states.
    """
    names = [urdf.stem, *([robot] if robot and Path(robot).name == robot else [])]
    for folder in _BESIDE:
        for name in names:
            path = urdf.parent / folder / f"{name}{SUFFIX}"
            if path.is_file():
                return path
    return None


def read_srdf(path: Path, robot: str, links: Collection[str]) -> TouchRules:
    """The pairs of links that a file lets touch.

    Args:
        path: the SRDF.
        robot: the name that the URDF states; another one in the SRDF is doubted.
        links: of the URDF; pairs of others are left out, and said.

    Raises:
        InputError: it cannot be read, is no SRDF, or an entry lacks a link; the message names file
            and line.
    """
    root = _root(path)
    rules = TouchRules(path)
    own = root.get("name") or ""
    if own != robot:
        rules.doubts.append(f"{path}: is of a robot {own!r}, the URDF of {robot!r}")
    unknown: dict[str, int] = {}
    for element in root:
        match element.tag:
            case "disable_collisions":
                pair = _pair(path, element)
                rules.pairs[pair] = (element.get("reason") or "").strip() or _UNSAID
                named = pair
            case "enable_collisions":
                named = _pair(path, element)
                rules.never.add(named)
            case "disable_default_collisions":
                named = frozenset((_link(path, element, "link"),))
                rules.always |= named
            case _:
                continue
        for name in sorted(named - set(links)):
            unknown.setdefault(name, element.sourceline)
    if unknown:
        told = ", ".join(f"{name!r} (line {line})" for name, line in list(unknown.items())[:_SHOWN])
        more = f" and {len(unknown) - _SHOWN} more" if len(unknown) > _SHOWN else ""
        rules.doubts.append(f"{path}: names links that the URDF does not have: {told}{more}")
    return rules


def _root(path: Path) -> Any:
    from lxml import etree

    data = read_bytes(path, MOST_BYTES)
    if b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        raise InputError(f"{path}: is not an SRDF file: it declares a document type; remove that")
    parser = etree.XMLParser(resolve_entities=False, no_network=True, remove_comments=True)
    try:
        root = etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, ValueError) as error:
        line = getattr(error, "lineno", None)
        reason = getattr(error, "msg", None) or str(error) or "it is empty"
        where = f"{path}:{line}" if line else str(path)
        raise InputError(
            f"{where}: is not an SRDF file: {reason}; mend it, or move it away from the URDF"
        ) from None
    if root.getroottree().docinfo.internalDTD is not None:
        raise InputError(f"{path}: is not an SRDF file: it declares a document type; remove that")
    if root.tag != "robot":
        raise InputError(
            f"{path}:{root.sourceline}: is not an SRDF file: it begins with <{root.tag}>, not with "
            "<robot>"
        )
    return root


def _pair(path: Path, element: Any) -> Pair:
    first, second = _link(path, element, "link1"), _link(path, element, "link2")
    if first == second:
        raise InputError(f"{path}:{element.sourceline}: pairs {first!r} with itself")
    return frozenset((first, second))


def _link(path: Path, element: Any, key: str) -> str:
    name = (element.get(key) or "").strip()
    if not name:
        raise InputError(f"{path}:{element.sourceline}: <{element.tag}> needs {key}=")
    return name
