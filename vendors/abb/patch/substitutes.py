"""What may take the place of an operand of a move instruction: a name, ``v100\\V:=87``, a datum."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.zone import Fine, Radius
from ....core.source.patch.edits import alike
from ....core.source.patch.uses import Use
from ....core.source.text.numerals import plain
from ..syntax.tree import Aggregate, Call, Expression, Name, Operation, Unary
from ..values import predefined
from ..values.records import MM
from ..write.operands import refuse_speed
from .additions import Additions
from .literals import in_millimetres, record_text, with_radius
from .places import Operand, Places

TYPES = {
    PoseTarget: "robtarget",
    JointTarget: "jointtarget",
    Speed: "speeddata",
    Fine: "zonedata",
    Radius: "zonedata",
}


class Substitutes:
    """Writes operands anew, with new data where nothing shorter says the value."""

    def __init__(self, places: Places, additions: Additions, axis_kinds: Sequence[str]) -> None:
        self._places = places
        self._additions = additions
        self._axis_kinds = axis_kinds

    def text(self, use: Use, operand: Operand) -> str:
        """An operand, with its options, that says the new value."""
        if isinstance(use.new, Speed):
            return self._speed(use, use.new, operand)
        if isinstance(use.new, Fine | Radius):
            return self._zone(use, operand)
        stem = _stem(use, operand.expression, "p" if isinstance(use.new, PoseTarget) else "j")
        # A target belongs to its instruction; equal ones elsewhere stay apart.
        mark = f"{use.statement.start} {use.kind}"
        name = self._declared(use, stem, mark)
        return name + "".join(self._places.text(o.span) for o in operand.options)

    def _speed(self, use: Use, new: Speed, operand: Operand) -> str:
        r"""``v100``, ``v100\V:=87``, ``vFb_87``; ``\T:=…`` behind it for a duration."""
        refuse_speed(new)
        timed = "" if new.duration is None else f"\\T:={plain(new.duration)}"
        bare = _bare(new)
        for name in predefined.SPEEDS:
            if alike(bare, predefined.speed(name)):
                return name + timed
        if not timed and new.tcp is not None:
            for base, text in self._bases(use, operand):
                if isinstance(base, Speed) and alike(replace(_bare(base), tcp=new.tcp), bare):
                    return f"{text}\\V:={in_millimetres(new.tcp).text}"
        return self._declared(use, _sized_stem(use, "v", new.tcp or 0.0)) + timed

    def _zone(self, use: Use, operand: Operand) -> str:
        r"""``fine``, ``z10``, ``z10\Z:=12``, ``zFb_12``."""
        new = use.new
        for name in predefined.ZONES:
            if alike(new, predefined.zone(name)):
                return name
        if isinstance(new, Radius):
            for base, text in self._bases(use, operand):
                if isinstance(base, Radius) and alike(with_radius(base, new.tcp), new):
                    return f"{text}\\Z:={in_millimetres(new.tcp).text}"
        size = new.tcp if isinstance(new, Radius) else 0.0
        return self._declared(use, _sized_stem(use, "z", size))

    def _bases(self, use: Use, operand: Operand) -> Iterator[tuple[object, str]]:
        """What stands there without its options, if its value is known."""
        expression = operand.expression
        if not isinstance(expression, Name) or expression.path:
            return
        text = self._places.text(expression.span)
        if use.origin.datum is not None and not operand.options:
            yield use.old, text
        elif isinstance(use.new, Speed):
            yield predefined.speed(expression.name), text
        else:
            yield predefined.zone(expression.name), text

    def _declared(self, use: Use, stem: str, mark: str = "") -> str:
        value = replace(use.new, duration=None) if isinstance(use.new, Speed) else use.new
        literal = record_text(value, self._axis_kinds)
        return self._additions.declare(
            TYPES[type(value)], literal, stem, use.statement, use.index, mark
        )


def _bare(speed: Speed) -> Speed:
    """What a speeddata says of a speed, without what instructions set."""
    return Speed(speed.tcp, speed.reorientation, speed.external_linear, speed.external_angular)


def _sized_stem(use: Use, letter: str, size: float) -> str:
    """The name of the user's own datum, or ``zFb_12_5``."""
    if use.origin.datum is not None and use.origin.numbers:
        return use.origin.datum
    return f"{letter}Fb_{plain(float(f'{size / MM:.5g}'))}".replace(".", "_")


def _stem(use: Use, expression: Expression, otherwise: str) -> str:
    """The name of the datum, or of the first one in an expression."""
    return use.origin.datum or _first_name(expression) or otherwise + "Fb"


def _first_name(expression: Expression | None) -> str | None:
    if isinstance(expression, Name):
        return expression.text
    inner: tuple[Expression | None, ...] = ()
    if isinstance(expression, Call):
        inner = tuple(a.value for a in expression.arguments)
    elif isinstance(expression, Aggregate):
        inner = expression.items
    elif isinstance(expression, Operation):
        inner = (expression.first, *(operand for _, operand in expression.rest))
    elif isinstance(expression, Unary):
        inner = (expression.operand,)
    return next(filter(None, map(_first_name, inner)), None)
