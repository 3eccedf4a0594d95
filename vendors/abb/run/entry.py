"""Which routine a program starts in."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PureWindowsPath

from ....core.errors import EntryError, Note, SourceError, Span
from ....core.program.entry_point import EntryPoint, listed, without_caller
from ....core.source.text.files import SourceText
from ..syntax.parser import parse
from ..syntax.traversal import calls_in, expressions_of
from ..syntax.tree import Argument, Invoke, Module, Routine
from ..values.data import Globals
from ..values.scope import NOWHERE, unknown_name
from .analysis import count_moves
from .calls import needed_by

MAIN = "main"
ENTRY = "--entry"
"""What the text of a user's arguments is called in messages."""


def entry_points(
    data: Globals, own: Sequence[Module], begun: Routine | None = None
) -> tuple[EntryPoint, ...]:
    """The procedures of the user's file, and the functions that move the robot.

    Args:
        begun: the routine that the program was begun with.
    """
    counted = [(r, count_moves(data, r)) for module in own for r in module.routines]
    return tuple(
        EntryPoint(r.text, tuple(p.text for p in needed_by(r)), moves, r is begun)
        for r, moves in counted
        if r.kind == "proc" or (r.kind == "func" and moves)
    )


def entry_arguments(name: str, text: str) -> tuple[SourceText, tuple[Argument, ...]]:
    """The arguments that a user gives to the entry, and the text that they are read from.

    Raises:
        SourceError: they are no arguments in RAPID.
    """
    call = f"MODULE entry\nPROC entry()\n{name} {text};\nENDPROC\nENDMODULE\n"
    source = SourceText(call, ENTRY)
    (module,) = parse(source)
    statements = module.routines[0].body.statements
    if len(statements) != 1 or not isinstance(statements[0], Invoke):
        raise SourceError(f"'{text}' are no arguments", source.span(0, 0))
    return source, statements[0].arguments


def choose_entry(
    data: Globals,
    own: Sequence[Module],
    entry: str | None,
    file: str,
    arguments: bool = False,
    goes_on: bool = False,
) -> tuple[Routine, tuple[Note, ...]]:
    """The routine to run, and what is to be said about the choice.

    Without the user's word this is ``main``; else the only procedure of the file; else the one
    that is called as the file or its module; else the only one with ``main`` in its name; else the
    only one that moves the robot and is not called by another.

    Args:
        own: modules of the file that the user named.
        entry: a procedure's name; None if the user gave none.
        file: name of the user's file.
        arguments: whether the user gives arguments.
        goes_on: whether it may be read without those that it takes.

    Raises:
        SourceError: there is no such procedure, it takes arguments, or several would do.
    """
    where = own[0].span if own else Span(file, 1, 1, 0, 0)
    found = _routine(data, own, entry or MAIN, where, fetch=entry is not None)
    if found is not None:
        if not _startable(found) and not arguments:
            needed = [p.text for p in needed_by(found)]
            if goes_on:
                return found, (Note(without_caller(found.text, needed), span=found.span),)
            names = ", ".join(needed)
            message = (
                f"PROC {found.text} takes arguments: name them with the entry, as "
                f"{found.text}({names}), with values or names of data in their places"
            )
            raise SourceError(message, found.span)
        return found, ()
    routines = [r for module in own for r in module.routines if r.kind == "proc"]
    candidates = [r for r in routines if _startable(r)]
    if entry is None and candidates:
        chosen, why = _fallback(data, own, candidates, file)
        if chosen is not None:
            message = f"there is no PROC main; {why}, {chosen.text}, is read"
            return chosen, (Note(message, span=chosen.span),)
    points = entry_points(data, own)
    if not points:
        message = "no routine in it can be run: it holds data, or functions that move nothing"
        raise SourceError(message, where)
    lacks = "there is no PROC main"
    if entry is not None:
        lacks = unknown_name("procedure", entry, [point.name for point in points]).split(":")[0]
    offer = "" if candidates else "; give those with arguments theirs, as Pick(1,p10)"
    message = (
        f"{lacks}: choose as the entry one of {listed(points)}; all drives each of them{offer}"
    )
    raise (EntryError if entry is None else SourceError)(message, where)


def _startable(routine: Routine) -> bool:
    return not needed_by(routine)


def _routine(
    data: Globals, own: Sequence[Module], name: str, where: Span, fetch: bool
) -> Routine | None:
    for module in own:
        for routine in module.routines:
            if routine.name == name.lower() and routine.kind in ("proc", "func"):
                return routine
    found = data.routines.get(name.lower())
    if found is None and fetch:
        found = data.fetched_routine(name.lower(), NOWHERE, where)
    return found if found is not None and found.kind == "proc" else None


def _fallback(
    data: Globals, own: Sequence[Module], candidates: Sequence[Routine], file: str
) -> tuple[Routine | None, str]:
    if len(candidates) == 1:
        return candidates[0], "the only procedure"
    names = {PureWindowsPath(file).stem.lower(), *(module.name for module in own)}
    named = [r for r in candidates if r.name in names]
    if len(named) == 1:
        return named[0], "the procedure that is called as its file or module"
    alike = [r for r in candidates if MAIN in r.name]
    if len(alike) == 1:
        return alike[0], "the only procedure with 'main' in its name"
    called = _called(own)
    roots = [r for r in candidates if r.name not in called and count_moves(data, r)]
    if len(roots) == 1:
        return roots[0], "the only procedure that moves the robot and that no other calls"
    return None, ""


def _called(modules: Sequence[Module]) -> set[str]:
    """Lower-case names of the routines that others call."""
    called: set[str] = set()
    for module in modules:
        for routine in module.routines:
            for statement in routine.body.walk():
                if isinstance(statement, Invoke) and statement.name != routine.name:
                    called.add(statement.name)
                for expression in expressions_of(statement):
                    called.update(call.name for call in calls_in(expression))
    return called
