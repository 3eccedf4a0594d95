r"""Outputs set on the way of a move: ``MoveLDO``, or ``TriggIO`` and ``TriggL``.

An event's text is an output and its value, ``doGun,1``, or the same with the kind of output before
it, ``\AOp:=aoFlow,0.5``; a routine in quotes; or an instruction and what it takes beside place and
time, ``TriggInt iDoor``. What else it may be is another language's and cannot be said.

"RAPID Reference Manual": MoveLDO, TriggIO, TriggEquip, TriggL.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from ....core.errors import InputError
from ....core.program.event import Event, EventAnchor
from ....core.program.move import Move, MoveJ
from ....core.program.target import JointTarget
from ....core.source.write.declarations import NewDatum
from ....core.source.write.options import OpaqueStyle, as_comments
from ..values.records import MM
from .numbers import number
from .operands import Operand, Operands

MOST = 8
"""``TriggL`` takes so many events."""

_OUTPUT = re.compile(
    r"\s*(?:\\(?P<kind>DOp|GOp|AOp|ProcID)\s*:=)?\s*(?P<signal>[A-Za-z]\w*|\d+)\s*,\s*(?P<value>\S.*)",
    re.IGNORECASE,
)
_ROUTINE = re.compile(r'"[^"\r\n]*"')
_OTHER = re.compile(
    r"(?P<name>TriggInt|TriggCheckIO|TriggSpeed|TriggRampAO)\s+(?P<data>\S.*)", re.IGNORECASE
)
_LAGGING = ("triggspeed", "triggrampao")
"""They take a lag beside the distance."""
_KINDS = {"dop": "DOp", "gop": "GOp", "aop": "AOp", "procid": "ProcID"}


@dataclass(frozen=True, slots=True)
class Said:
    """How the events of a move are said.

    Args:
        before: lines to stand before the move.
        verb: the instruction, ``MoveL``, ``MoveLDO`` or ``TriggL``.
        triggers: data to stand before the zone.
        output: ``,doGun,1`` to stand at the end.
    """

    before: tuple[tuple[Operand, ...], ...]
    verb: str
    triggers: tuple[Operand, ...] = ()
    output: str = ""


class Events:
    """Says the events of a program's moves; each trigger is defined once."""

    def __init__(self, operands: Operands, style: OpaqueStyle) -> None:
        self._operands = operands
        self._style = style
        self._defined: set[NewDatum] = set()

    def of(self, move: Move) -> Said:
        """How the events of a move are said.

        Raises:
            InputError: RAPID cannot say one, or not so many.
        """
        absolute = isinstance(move, MoveJ) and isinstance(move.target, JointTarget)
        plain = "MoveAbsJ" if absolute else type(move).__name__
        if not move.events or self._style is OpaqueStyle.COMMENT:
            return Said(tuple((f"! on the way: {_line(e)}",) for e in move.events), plain)
        if len(move.events) == 1 and not absolute:
            alone = _at_the_target(plain, move.events[0])
            if alone is not None:
                return alone
        if len(move.events) > MOST:
            raise InputError(f"{plain} takes {MOST} events, not {len(move.events)}: leave some out")
        triggers = [
            self._operands.declarations.add_undefined("triggdata", _definition(event))
            for event in move.events
        ]
        verb = plain.replace("Move", "Trigg")
        return Said(tuple(self._definitions(triggers)), verb, tuple(triggers))

    def _definitions(self, triggers: Sequence[NewDatum]) -> list[tuple[Operand, ...]]:
        r"""``TriggIO trigg10,25\DOp:=doGun,1;`` of those that are not defined yet."""
        new = [t for t in dict.fromkeys(triggers) if t not in self._defined]
        self._defined.update(new)
        lines: list[tuple[Operand, ...]] = []
        for trigger in new:
            instruction, _, rest = trigger.text.partition(" ")
            lines.append((f"{instruction} ", trigger, f",{rest};"))
        return lines


def _at_the_target(plain: str, event: Event) -> Said | None:
    """``MoveLDO``, ``MoveLAO``, ``MoveLGO`` and ``MoveLSync`` act where the corner is half done."""
    if event.anchor is not EventAnchor.END or event.distance != 0 or event.time != 0:
        return None
    if _ROUTINE.fullmatch(event.text.strip()):
        return Said((), f"{plain}Sync", output=f",{event.text.strip()}")
    found = _OUTPUT.fullmatch(event.text)
    kind = _kind(found) if found else ""
    if found is None or kind == "ProcID":
        return None
    value = found["value"].strip()
    # The value of a group is an optional argument (MoveLGO).
    said = f"\\Value:={value}" if kind == "GOp" else f",{value}"
    return Said((), plain + kind.upper().removesuffix("P"), output=f",{found['signal']}{said}")


def _definition(event: Event) -> str:
    r"""What defines a trigger, without its name: ``TriggIO 25\DOp:=doGun,1``.

    ``TriggIO Distance [\Start] | [\Time] \DOp, SetValue``,
    ``TriggEquip Distance [\Start], EquipLag \DOp, SetValue``.
    """
    found = _OUTPUT.fullmatch(event.text)
    other = _OTHER.fullmatch(event.text.strip())
    if found is not None:
        output = f"\\{_kind(found)}:={found['signal']},{found['value'].strip()}"
    elif other is not None:
        output = f",{other['data']}"
    else:
        raise InputError(
            f"the event {_line(event)!r} is no output and its value, as in 'doGun,1': RAPID has "
            f"no words for it; take it out, or have it written as a comment ({as_comments()})"
        )
    start = "\\Start" if event.anchor is EventAnchor.START else ""
    distance = number(event.distance / MM)
    lagging = other is not None and other["name"].lower() in _LAGGING
    if event.time == 0 and not lagging:
        return f"{other['name'] if other else 'TriggIO'} {distance}{start}{output}"
    if event.distance == 0 and not lagging:
        name = other["name"] if other else "TriggIO"
        return f"{name} {number(event.time)}{start}\\Time{output}"
    if other is not None and not lagging:
        raise InputError(f"the event {_line(event)!r} has a distance or a time, not both")
    name = other["name"] if other else "TriggEquip"
    return f"{name} {distance}{start},{number(event.time)}{output}"


def _kind(found: re.Match[str]) -> str:
    return _KINDS[(found["kind"] or "DOp").lower()]


def _line(event: Event) -> str:
    return " ".join(event.text.split())
