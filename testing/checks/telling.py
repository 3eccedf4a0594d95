"""What a check that fails says: what was written, what was read, where to look."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ...core.program.move import Move, Statement

_LONGEST = 2_000
"""Characters of a text that are shown."""

LOOK: Mapping[str, str] = {
    "kind": "which instruction makes which kind of move",
    "stands": "the label (`Vendor.label`), the tool, the frame and their directions",
    "joints": "the unit and the sense of joints",
    "external": "the unit and the order of external axes",
    "position": "the unit of lengths, the sense of increments, the frame",
    "quaternion": "the order of quaternions, the convention of angles, which frame turns in which",
    "configuration": "configuration data",
    "via": "which of an arc's two points is the auxiliary one",
    "arc": "how the tool turns along arcs",
    "speed": "units of speeds, overrides, settings, and which moves they hold for",
    "zone": "kinds of zone, their unit, and where they end",
    "tool": "which tool holds at the move, its unit, the TCP in the flange or the flange in it",
    "frame": "which frame holds at the move, its unit, and whether it stands in the world",
    "work object": "which frame holds at the move, its unit, and whether it stands in the world",
    "load": "which load holds at the move, and its unit",
    "events": "actions along moves: which move they belong to, their place and their unit",
    "duration": "the unit of waits",
    "statements": "the order of statements, and which of them are kept",
}
"""Where to look, by what is wrong."""


def told(
    what: str, *, written: object = "", read: object = "", look: str = "", lines: Iterable[str] = ()
) -> str:
    """A message of a check.

    Args:
        what: is wrong.
        written, read: what was given, or written, and what came of it.
        look: where to look, or a term of `LOOK`.
        lines: more of it.
    """
    told = [what, *(f"  {line}" for line in lines)]
    for name, value in (("written", written), ("read", read)):
        if value != "":
            told += [f"  {name}: {_indented(str(value))}"]
    where = LOOK.get(look.split(".")[0].split(":")[0], look)
    return "\n".join([*told, *([f"  look at: {where}"] if where else [])])


def text_of(sources: Mapping[str, str]) -> str:
    """Texts for a message."""
    found = "\n".join(f"--- {name}\n{text}" for name, text in sources.items())
    return found if len(found) < _LONGEST else f"{found[:_LONGEST]}\n…"


def line_of(sources: Mapping[str, str], statement: Statement) -> str:
    """The line of a text that a statement was read from, for a message."""
    span = statement.statement if isinstance(statement, Move) else statement.span
    if span is None:
        return "no place in the text is known"
    for name, text in sources.items():
        if span.file.endswith(name):
            lines = text.splitlines()
            if span.line <= len(lines):
                return f"{name}:{span.line}: {lines[span.line - 1].strip()}"
    return str(span)


def _indented(text: str) -> str:
    lines = text.splitlines()
    return lines[0] if len(lines) == 1 else "\n    ".join(["", *lines])
