"""Moves that a signal, external axes or a process take part in: SearchL, MoveExtJ, ArcL, SpotL.

"RAPID Reference Manual", instructions SearchL, SearchC, MoveExtJ; the application manuals of arc
welding, spot welding, dispensing and painting for the instructions of option packages. Those are
read as the moves that they are; what their process data do to the motion is not emulated.
"""

from __future__ import annotations

from dataclasses import replace

from ....core.errors import SourceError
from ....core.program.event import Event
from ..syntax.tree import Invoke, Name
from ..values.scope import Scope, Variable
from ..values.types import ROBTARGET
from .moves import Form, MovesHandler, MovesRun, bind_move, drive

# --------------------------------------------------------------------------- searches

_STOPS = ("stop", "pstop", "sstop")
_FLANKS = ("flanks", "posflank", "negflank", "highlevel", "lowlevel", "sup")

_SEARCHES = {
    "searchl": Form(
        "linear", ("Signal", "SearchPoint", "ToPoint", "Speed", "Tool"), (*_STOPS, *_FLANKS)
    ),
    "searchc": Form(
        "circular",
        ("Signal", "SearchPoint", "CirPoint", "ToPoint", "Speed", "Tool"),
        (*_STOPS, *_FLANKS),
    ),
}


_FOUND = "what the search finds"


def _search(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    """A search drives to its end, where it is taken to have found what it looks for.

    The user may answer the point that it finds; with \\Stop it drives there and no further. The
    point gets its value after the move: its arguments may be made of what it held before.
    """
    form = _SEARCHES[invoke.name]
    bound = bind_move(invoke, form)
    point = bound.named("SearchPoint")
    cell = run.evaluator.cell(point, scope) if isinstance(point, Name) else None
    if cell is None or cell.constant or not isinstance(point, Name):
        raise SourceError(f"{invoke.text} needs a robtarget to put its point in", point.span)
    end = bound.named("ToPoint")
    answer = run.evaluator.answers.ask(point.span, cell.type)
    where = "at its end; answer the point if the program computes with it"
    if answer is not None:
        where = "where the answers say"
    run.out.notes.count(f"{invoke.text} is taken to find its point {where}", invoke.span)
    inner = scope
    if answer is not None and any(option in bound.options for option in _STOPS):
        inner = scope.inner(scope.where)
        inner.cells[_FOUND] = Variable(_FOUND, ROBTARGET, value=answer)
        there = Name(end.span, _FOUND, point.text)
        bound = replace(bound, required=tuple(there if e is end else e for e in bound.required))
    event = Event(f"{invoke.text} {run.out.text_of(bound.named('Signal').span)}", span=invoke.span)
    reached = drive(run, form, invoke, inner, (event,), bound)
    run.evaluator.assign(point, reached if answer is None else answer, scope)


# --------------------------------------------------------------- external axes alone

_EXTERNAL = Form("external", ("ToJointPos", "Speed", "Zone"), ("useeoffs",))


def _external(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    drive(run, _EXTERNAL, invoke, scope)


# ------------------------------------------------------------------- option packages

_ARC = ("", "start", "end", "1", "2", "1start", "1end", "2start", "2end")
_PROCESS_OPTIONS = (
    *("on", "off", "start", "end", "weave", "track", "seamname", "servroutine", "optaction"),
    *("time", "preproc", "num", "noconc", "retract", "openhlift", "closehlift", "qualityparam"),
    *("d", "d1", "d2", "d3", "speedref", "ra", "movestart", "moveend", "t1", "t2", "t3", "t4"),
    *("t5", "t6", "t7", "t8", "t9", "t10", "startoffset", "stopoffset", "adaptid", "simulate"),
)


def _shapes() -> dict[str, tuple[str, bool]]:
    shapes: dict[str, tuple[str, bool]] = {}
    for family in ("arc", "disp", "paint", "cut", "lasercut", "cap", "glue"):
        for suffix in _ARC:
            shapes[f"{family}l{suffix}"] = ("linear", True)
            shapes[f"{family}c{suffix}"] = ("circular", True)
    for letter, kind in (("l", "linear"), ("j", "joint"), ("c", "circular")):
        shapes[f"arcmove{letter}"] = (kind, True)
    for family in ("spot", "nut", "spotm", "calib"):
        shapes[f"{family}l"] = ("linear", False)
        shapes[f"{family}j"] = ("joint", False)
    return shapes


_PROCESSES = _shapes()
"""name → kind of move, and whether a zone stands before the tool; the others go to a stop."""


def _process(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    """``ArcL ToPoint, Speed, Seam, Weld, Zone, Tool`` and its like.

    Their process data stand between the speed and the zone, and are as many as they are.
    """
    kind, zone = _PROCESSES[invoke.name]
    head = ("CirPoint", "ToPoint", "Speed") if kind == "circular" else ("ToPoint", "Speed")
    tail = ("Zone", "Tool") if zone else ("Tool",)
    count = sum(a.option is None for a in invoke.arguments)
    data = tuple(f"Data{number + 1}" for number in range(count - len(head) - len(tail)))
    form = Form(kind, (*head, *data, *tail), _PROCESS_OPTIONS)
    bound = bind_move(invoke, form)
    run.out.notes.count(
        f"{invoke.text} is read as a move at its programmed speed: process data (a weld's own "
        "speed, weaving, waiting times) are not emulated",
        invoke.span,
    )
    text = ",".join(run.out.text_of(bound.named(name).span) for name in data)
    event = Event(f"{invoke.text} {text}".strip(), span=invoke.span)
    drive(run, form, invoke, scope, (event,), bound)


SPECIAL_MOVES: dict[str, MovesHandler] = {
    **dict.fromkeys(_SEARCHES, _search),
    "moveextj": _external,
    **dict.fromkeys(_PROCESSES, _process),
}
