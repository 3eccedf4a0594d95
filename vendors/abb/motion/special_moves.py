"""Moves that a signal, external axes or a process take part in: SearchL, MoveExtJ, ArcL, SpotL.

"RAPID Reference Manual", instructions SearchL, SearchC, SearchExtJ, MoveExtJ; the application
manuals of arc welding, spot welding, dispensing, painting, force control, SoftMove and externally
guided motion for the instructions of option packages. Those are read as the moves that they are;
what their process data do to the motion is not emulated.
"""

from __future__ import annotations

from dataclasses import replace

from ....core.errors import SourceError
from ....core.program.event import Event
from ....core.program.question import QuestionKind
from ..syntax.tree import Invoke, Name
from ..values.scope import Scope, Variable
from ..values.types import JOINTTARGET, ROBTARGET, Unknown
from .move_arguments import MovesRun
from .moves import OVER_POINT, TO_POINT, Form, MovesHandler, bind_move, drive

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
    "searchextj": Form(
        "external", ("Signal", "SearchPoint", "ToJointPos", "Speed"), (*_STOPS, *_FLANKS)
    ),
}
"""They end where the search does, at a stop."""


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
    if not isinstance(point, Name) or (cell is not None and cell.constant):
        raise SourceError(f"{invoke.text} needs a datum to put its point in", point.span)
    kind = JOINTTARGET if form.kind == "external" else ROBTARGET
    end = bound.named("ToJointPos" if form.kind == "external" else "ToPoint")
    asked = kind if cell is None else cell.type
    answer = run.evaluator.answers.ask(point.span, asked, kind=QuestionKind.SENSOR)
    where = "at its end; answer the point if the program computes with it"
    if answer is not None:
        where = "where the answers say"
    run.out.notes.count(f"{invoke.text} is taken to find its point {where}", invoke.span)
    inner = scope
    if answer is not None and any(option in bound.options for option in _STOPS):
        inner = scope.inner(scope.where)
        inner.cells[_FOUND] = Variable(_FOUND, kind, value=answer)
        there = Name(end.span, _FOUND, point.text)
        bound = replace(bound, required=tuple(there if e is end else e for e in bound.required))
    event = Event(f"{invoke.text} {run.out.text_of(bound.named('Signal').span)}", span=invoke.span)
    reached = drive(run, form, invoke, inner, (event,), bound)
    found = reached if answer is None else answer
    if found is None:
        reason = f"where {invoke.text} finds {point.text}"
        run.evaluator.fill(point, Unknown(reason, invoke.span, point.text), scope, invoke.name)
    else:
        run.evaluator.assign(point, found, scope)


# --------------------------------------------------------------- external axes alone

_EXTERNAL = Form("external", ("ToJointPos", "Speed", "Zone"), ("useeoffs",))


def _external(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    drive(run, _EXTERNAL, invoke, scope)


# ------------------------------------------------------------------- option packages

_ARC = ("", "start", "end", "1", "2", "1start", "1end", "2start", "2end")
_WITH_ZONE = ("arc", "arcadapt", "arccalc", "disp", "paint", "cut", "lasercut", "cap", "glue")
_TO_A_STOP = ("spot", "spotm", "nut", "calib", "measurewear", "daprocm")


def _shapes() -> dict[str, tuple[str, bool]]:
    shapes: dict[str, tuple[str, bool]] = {}
    for family in _WITH_ZONE:
        for suffix in _ARC:
            shapes[f"{family}l{suffix}"] = ("linear", True)
            shapes[f"{family}c{suffix}"] = ("circular", True)
    for letter, kind in (("l", "linear"), ("j", "joint"), ("c", "circular")):
        shapes[f"arcmove{letter}"] = (kind, True)
        for family in _TO_A_STOP:
            shapes[f"{family}{letter}"] = (kind, False)
    shapes |= dict.fromkeys(("fcpress1lstart", "fcpressl", "paintlsig"), ("linear", True))
    shapes |= dict.fromkeys(("fcpressend", "cssdeactmovel"), ("linear", False))
    return {**shapes, "fcpressc": ("circular", True), "arcmoveabsj": ("absolute", True)}


_PROCESSES = _shapes()
"""name → kind of move, and whether a zone stands before the tool; the others go to a stop."""

_HEADS = {
    "circular": ("CirPoint", "ToPoint", "Speed"),
    "absolute": ("ToJointPos", "Speed"),
}


def _process(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    """``ArcL ToPoint, Speed, Seam, Weld, Zone, Tool`` and its like.

    Their process data stand between the speed and the zone, and are as many as they are; so are
    their options.
    """
    kind, zone = _PROCESSES[invoke.name]
    head = _HEADS.get(kind, ("ToPoint", "Speed"))
    tail = ("Zone", "Tool") if zone else ("Tool",)
    count = sum(a.option is None for a in invoke.arguments)
    data = tuple(f"Data{number + 1}" for number in range(count - len(head) - len(tail)))
    form = Form(kind, (*head, *data, *tail), _own_options(invoke))
    bound = bind_move(invoke, form)
    run.out.notes.count(
        f"{invoke.text} is read as a move at its programmed speed: process data (a weld's own "
        "speed, weaving, forces, waiting times) are not emulated",
        invoke.span,
    )
    text = ",".join(run.out.text_of(bound.named(name).span) for name in data)
    event = Event(f"{invoke.text} {text}".strip(), span=invoke.span)
    drive(run, form, invoke, scope, (event,), bound)


def _own_options(invoke: Invoke) -> tuple[str, ...]:
    return tuple(a.option for a in invoke.arguments if a.option is not None)


# ------------------------------------------------------------- moves that sensors correct

_GUIDED = {
    "egmmovel": ("linear", ("EGMid", *TO_POINT)),
    "egmmovec": ("circular", ("EGMid", *OVER_POINT)),
    "contactl": ("linear", ("ToPoint", "Speed", "Tool")),
}


def _guided(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    """``EGMMoveL``, ``ContactL``: a sensor says how far off the path, or how far, it goes."""
    kind, names = _GUIDED[invoke.name]
    form = Form(kind, names, _own_options(invoke))
    run.out.notes.count(
        f"{invoke.text} is driven to its end as it is programmed: what a sensor changes of it is "
        "not known",
        invoke.span,
    )
    drive(run, form, invoke, scope)


SPECIAL_MOVES: dict[str, MovesHandler] = {
    **dict.fromkeys(_SEARCHES, _search),
    **dict.fromkeys(("moveextj", "arcmoveextj"), _external),
    **dict.fromkeys(_GUIDED, _guided),
    **dict.fromkeys(_PROCESSES, _process),
}
