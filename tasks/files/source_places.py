"""Places in the source, in tables and as JSON."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.errors import Note, Span

if TYPE_CHECKING:
    from ...core.driving.driven_program import Fault


def note_json(note: Note) -> dict[str, Any]:
    """A note with JSON's types: message, move from 1, place."""
    move = None if note.move is None else note.move + 1
    return {"message": note.message, "move": move, **place_json(note.span)}


def fault_json(fault: Fault) -> dict[str, Any]:
    """A fault with JSON's types: cause, message, move from 1, place."""
    return {
        "cause": str(fault.cause),
        "message": fault.message,
        "move": fault.move + 1,
        **place_json(fault.span),
    }


def place_json(span: Span | None) -> dict[str, Any]:
    """File, line and column; None where they are not known."""
    return {
        "file": None if span is None else span.file,
        "line": None if span is None else span.line,
        "column": None if span is None else span.column,
    }


def short_place(program: Path | None, span: Span | None) -> str:
    """The line, with the file before it if that is not the program's main one."""
    if span is None:
        return ""
    return (
        str(span.line)
        if program is None or span.file == str(program)
        else f"{Path(span.file).name}:{span.line}"
    )
