"""Events on the way of a move: MoveLDO and its like, TriggL and the data that it takes.

"RAPID Reference Manual", instructions MoveLDO, MoveLAO, MoveLGO, MoveLSync, TriggIO, TriggEquip,
TriggInt, TriggCheckIO, TriggSpeed, TriggRampAO, TriggL, TriggLIOs. An event changes nothing about
the motion. Distances count back from the target, with ``\\Start`` forward from the start, with
``\\Time`` they are seconds before the target; an equipment's lag is a time in advance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from ....core.errors import InputError, SourceError, Span
from ....core.program.event import Event, EventAnchor
from ..syntax.tree import Expression, Invoke, Name
from ..values.arguments import Bound, bind
from ..values.outputs import write
from ..values.records import PER_METRE
from ..values.scope import Scope
from ..values.types import NUM, Unknown, Value, mismatch
from .move_arguments import MovesRun
from .moves import (
    FORMS,
    OVER_POINT,
    TO_JOINTS,
    TO_POINT,
    Form,
    MovesHandler,
    bind_move,
    drive,
)


@dataclass(frozen=True, slots=True)
class TriggData(Unknown):
    """A triggdata: not a value that a program could compute with, but events.

    Args:
        signal: the output that they write; None if they write none, or it is not known which.
    """

    events: tuple[Event, ...] = ()
    signal: str | None = None


_SIGNALS = {"dop": "", "gop": "\\GOp:=", "aop": "\\AOp:=", "procid": "\\ProcID:="}
"""option → what stands before an event's text, if it is no digital output."""

_DEFINITIONS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "triggio": (("TriggData", "Distance", "SetValue"), ("start", "time", "dodelay", *_SIGNALS)),
    "triggequip": (
        ("TriggData", "Distance", "EquipLag", "SetValue"),
        ("start", "inhib", "inhibvalue", *_SIGNALS),
    ),
    "triggint": (("TriggData", "Distance", "Interrupt"), ("start", "time", "inhib")),
    "triggcheckio": (
        ("TriggData", "Distance", "Signal", "Relation", "CheckValue", "Interrupt"),
        ("start", "time", "stopmove", "inhib"),
    ),
    "triggspeed": (
        ("TriggData", "Distance", "ScaleLag", "AOp", "ScaleValue"),
        ("start", "diplag", "errdo", "inhib", "dipl"),
    ),
    "triggrampao": (
        ("TriggData", "Distance", "EquipLag", "AOutput", "SetValue", "RampLength"),
        ("start", "time", "inhib"),
    ),
}
"""Instructions that fill a triggdata: their required and optional arguments."""

_LAGS = ("EquipLag", "ScaleLag")


def _define(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    names, options = _DEFINITIONS[invoke.name]
    bound = bind(invoke, names, options)
    target = bound.named("TriggData")
    if not isinstance(target, Name):
        raise SourceError(f"{invoke.text} takes a triggdata", target.span)
    distance = _number(run, bound, bound.named("Distance"), scope)
    lag = next((n for n in names if n in _LAGS), None)
    time = 0.0 if lag is None else _number(run, bound, bound.named(lag), scope)
    if "time" in bound.options:
        distance, time = 0.0, distance
    anchor = EventAnchor.START if "start" in bound.options else EventAnchor.END
    event = _event(_action(run, bound), anchor, distance, time, invoke.span)
    reason = f"'{target.text}', a triggdata"
    output = next((bound.options[o] for o in _SIGNALS if o in bound.options), None)
    if output is None:
        output = next((bound.named(n) for n in ("AOp", "AOutput") if n in names), None)
    signal = run.evaluator.signal(output, scope)
    data = TriggData(reason, target.span, events=(event,), signal=signal)
    run.evaluator.assign(target, data, scope)
    if invoke.name == "triggspeed":
        why = "it sets an output in proportion to the speed, and the scale along the path"
        run.out.notes.count(f"{invoke.text} is kept as an event: {why}", invoke.span)


def _event(text: str, anchor: EventAnchor, distance: float, time: float, span: Span) -> Event:
    try:
        return Event(text, anchor, distance / PER_METRE, time, span)
    except InputError as error:
        raise SourceError(str(error), span) from None


def _number(run: MovesRun, bound: Bound, expression: Expression, scope: Scope) -> float:
    """A distance or time, 0 with a note if it is not known."""
    value = run.evaluator.evaluate(expression, scope)
    if isinstance(value, Unknown):
        message = f"{bound.text}: where the event is depends on {value.reason}: taken as 0"
        run.out.notes.once("event", message, expression.span)
        return 0.0
    wrong = mismatch(value, NUM)
    if wrong is not None or not isinstance(value, float):
        raise SourceError(f"{bound.text}: {wrong}", expression.span)
    return value


def _action(run: MovesRun, bound: Bound) -> str:
    r"""``do1,1``, ``\AOp:=ao1,5``, or the instruction's own name and data."""
    for option, kind in _SIGNALS.items():
        signal = bound.options.get(option)
        if signal is not None:
            value = bound.named("SetValue")
            return kind + ",".join(run.out.text_of(e.span) for e in (signal, value))
    data = [n for n in bound.names if n not in ("TriggData", "Distance", *_LAGS)]
    return " ".join([bound.text, ",".join(run.out.text_of(bound.named(n).span) for n in data)])


# ------------------------------------------------------------- moves with trigger data

_TRIGGERS = tuple(f"t{number}" for number in range(2, 9))


def _triggered(names: tuple[str, ...]) -> tuple[str, ...]:
    at = names.index("Speed") + 1
    return (*names[:at], "Trigg", *names[at:])


_TRIGG_FORMS = {
    "triggl": Form("linear", _triggered(TO_POINT), _TRIGGERS),
    "triggj": Form("joint", _triggered(TO_POINT), _TRIGGERS),
    "triggc": Form("circular", _triggered(OVER_POINT), _TRIGGERS),
    "triggabsj": Form("absolute", _triggered(TO_JOINTS), (*_TRIGGERS, "noeoffs")),
    "trigglios": Form("linear", TO_POINT, ("triggdata1", "triggdata2", "triggdata3")),
    "triggjios": Form("joint", TO_POINT, ("triggdata1", "triggdata2", "triggdata3")),
}


def _trigger_move(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    form = _TRIGG_FORMS[invoke.name]
    bound = bind_move(invoke, form)
    given = [bound.named("Trigg")] if "Trigg" in bound.names else []
    options = (*_TRIGGERS, "triggdata1", "triggdata2", "triggdata3")
    given += [e for o in options if (e := bound.options.get(o)) is not None]
    data = [run.evaluator.locate(e, scope, asking=False).value for e in given]
    events = tuple(
        event
        for e, value in zip(given, data, strict=True)
        for event in _events_of(run, e, _collected(value))
    )
    drive(run, form, invoke, scope, events, bound)
    for found in map(_collected, data):
        # When the event comes is a matter of the motion, which lags behind the program.
        signals = [one.signal for one in found if one.signal is not None]
        run.evaluator.outputs.forget(signals if found else None)


def _events_of(
    run: MovesRun, expression: Expression, found: tuple[TriggData, ...]
) -> tuple[Event, ...]:
    if found:
        return tuple(event for one in found for event in one.events)
    text = run.out.text_of(expression.span)
    message = f"the trigger data {text} are not known: the event is taken to be at the target"
    run.out.notes.once(f"trigger {text.lower()}", message, expression.span)
    return (Event(text, span=expression.span),)


def _collected(value: Value) -> tuple[TriggData, ...]:
    if isinstance(value, TriggData):
        return (value,)
    if isinstance(value, tuple):
        return tuple(data for part in value for data in _collected(part))
    return ()


# --------------------------------------------------------- moves with one more action


_ACTION_FORMS = {
    f"{move}{suffix}": replace(FORMS[move], names=(*FORMS[move].names, *names))
    for move in ("movel", "movej", "movec")
    for suffix, names in (
        ("do", ("Signal", "Value")),
        ("ao", ("Signal", "Value")),
        ("go", ("Signal",)),
        ("sync", ("ProcName",)),
    )
}


def _action_move(run: MovesRun, invoke: Invoke, scope: Scope) -> None:
    form = _ACTION_FORMS[invoke.name]
    bound = bind_move(invoke, replace(form, options=("value", "dvalue")))
    extra = [bound.named(n) for n in ("Signal", "Value", "ProcName") if n in bound.names]
    extra += [e for o in ("value", "dvalue") if (e := bound.options.get(o)) is not None]
    kind = _SIGNALS.get(f"{invoke.name[-2:]}p", "")
    text = kind + ",".join(run.out.text_of(e.span) for e in extra)
    if "ProcName" in bound.names:
        message = f"{invoke.text} calls {text} on its way, which is not run"
        run.out.notes.count(message, invoke.span)
    drive(run, form, invoke, scope, (Event(text, span=invoke.span),), bound)
    if "Signal" in bound.names:
        write(run.evaluator, bound.named("Signal"), None, scope)
    else:
        run.evaluator.outputs.forget()


TRIGGER_DEFINITIONS: dict[str, MovesHandler] = dict.fromkeys(_DEFINITIONS, _define)
TRIGGER_MOVES: dict[str, MovesHandler] = {
    **dict.fromkeys(_TRIGG_FORMS, _trigger_move),
    **dict.fromkeys(_ACTION_FORMS, _action_move),
}
