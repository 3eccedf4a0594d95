"""Literal numbers changed where they stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ....core.errors import Span
from ....core.program.speed import Speed
from ....core.program.zone import Fine, Radius
from ....core.source.patch.edits import alike
from ....core.source.patch.plan import Texts, Wish
from ....core.source.patch.uses import Use
from ..syntax.tree import Name
from ..values import predefined
from ..write.operands import refuse_speed
from .literals import ZONE_NUMBERS, LiteralNumber, as_it_is, in_millimetres, numbers_of, with_radius
from .places import Operand, Places


class RapidLiterals:
    """What the literals of a program would have to say."""

    def __init__(self, places: Places, axis_kinds: Sequence[str]) -> None:
        self._places = places
        self._axis_kinds = axis_kinds

    def text(self, span: Span) -> str:
        """What stands at a place."""
        return self._places.text(span)

    def wish(self, use: Use) -> Wish:
        """See `core.source.patch.plan.Literals.wish`."""
        texts = self._texts(use)
        if texts is not None:
            return Wish(texts)
        return Wish({s: self.text(s) for s in use.origin.numbers if s is not None}, complete=False)

    def _texts(self, use: Use) -> Texts | None:
        numbers = use.origin.numbers
        if type(use.old) is not type(use.new) and not isinstance(use.new, Fine | Radius):
            return None
        if len(numbers) == 1:
            return self._option_text(use, numbers[0])
        if isinstance(use.new, Fine | Radius):
            return self._zone_texts(use) if len(numbers) == ZONE_NUMBERS else None
        if isinstance(use.new, Speed):
            refuse_speed(use.new)
            if use.new.duration is not None:
                return None
        found = numbers_of(use.new, use.old, self._axis_kinds)
        return self._number_texts(found, numbers) if len(found) == len(numbers) else None

    def _number_texts(
        self, found: Sequence[LiteralNumber], numbers: Sequence[Span | None]
    ) -> Texts:
        return {
            span: number.text_for(self._places.text(span))
            for number, span in zip(found, numbers, strict=True)
            if span is not None and number.value is not None
        }

    def _zone_texts(self, use: Use) -> Texts | None:
        """The numbers of a zonedata, and its ``finep``."""
        first = use.origin.numbers[0]
        truth = self._places.truth_before(first) if first is not None else None
        if truth is None or self._operand(use).option("inpos") is not None:
            return None
        said = self._places.text(truth)
        stops = isinstance(use.new, Fine)
        finep = {truth: said if (said.lower() == "true") is stops else str(stops).upper()}
        if stops:
            return finep
        found = numbers_of(use.new, use.old, self._axis_kinds)
        return {**finep, **self._number_texts(found, use.origin.numbers)}

    def _option_text(self, use: Use, span: Span | None) -> Texts | None:
        r"""The number of ``\V``, ``\T`` or ``\Z``."""
        operand = self._operand(use)
        if span is None or len(operand.options) != 1:
            return None
        number = _option_number(operand, operand.options[0].option or "", use)
        return None if number is None else self._number_texts([number], [span])

    def _operand(self, use: Use) -> Operand:
        return self._places.operand(use.statement, use.origin.span)


def _option_number(operand: Operand, option: str, use: Use) -> LiteralNumber | None:
    old, new = use.old, use.new
    if isinstance(old, Speed) and isinstance(new, Speed):
        if option == "t" and new.duration is not None:
            fits = alike(replace(old, duration=new.duration), new)
            return as_it_is(new.duration) if fits else None
        if option == "v" and new.tcp is not None:
            return in_millimetres(new.tcp) if alike(replace(old, tcp=new.tcp), new) else None
    if option == "z" and isinstance(new, Radius) and isinstance(old, Radius):
        fits = alike(old, new) or alike(_resized(operand, old, new.tcp), new)
        return in_millimetres(new.tcp) if fits else None
    return None


def _resized(operand: Operand, old: Radius, tcp: float) -> object:
    r"""The zone with another ``\Z``; None if what stands before that is not known."""
    base = operand.expression
    if isinstance(base, Name) and not base.path:
        known = predefined.zone(base.name)
        if isinstance(known, Radius):
            return with_radius(known, tcp)
    # Where a part was widened to the radius, its own size is not known any more.
    if min(old.reorientation, old.external) > old.tcp:
        return with_radius(old, tcp)
    return None
