"""Settings that hold: words that give the moves behind them a speed, an acceleration, a zone.

``SPEED 30 MM/S ALWAYS``, ``$LIN_SPD := 0.25``, ``OVERRIDE=50%``. A language says as data what each
sets, in which units, and until when it holds; reading, writing and patching follow from that.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from ...dialect import Unsaid
from ...errors import InputError, Span
from ...program.move import Move, MoveJ
from ...program.speed import Speed
from ...program.zone import FINE, Radius, VendorZone, Zone, ZoneKind
from ..patch.edits import Edit
from ..patch.uses import MovePart, Use, UseKind
from ..text.numerals import nine_decimals
from .amounts import Units, stated, with_number
from .expressions import USUAL, Datum, Spelling, parse
from .statements import Line, Numbers, Operand, Set

_LONGEST = 1000
"""Characters of a line that is looked at."""


@dataclass(frozen=True)
class Setting:
    """A word whose number holds.

    Args:
        word: in capitals.
        joint, line: what its number is for joint moves, and for lines and arcs, by unit.
        initial: the number that holds before the word is said; None if nobody knows: it is asked
            for then.
        unit: of that number.
        sign: what stands between the word and the number.
        always: what stands behind a number that holds until it is set again, where one without it
            holds for the next move alone; None where every one holds.
    """

    word: str
    joint: Units
    line: Units
    initial: float | None = None
    unit: str = ""
    sign: str = " "
    always: str | None = None

    @property
    def is_zone(self) -> bool:
        """Whether it sets a zone."""
        return any(one.name == "zone" for one in (*self.joint.values(), *self.line.values()))

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        """A line that says it."""
        known = sorted({*self.joint, *self.line} - {""}, key=len, reverse=True)
        units = "|".join(map(re.escape, known)) or "(?!)"
        always = re.escape(self.always or "").replace(r"\ ", r"\s+") or "(?!)"
        sign = re.escape(self.sign.strip())
        sign = rf"\s*{sign}\s*" if sign else r"\s+"
        return re.compile(
            rf"{re.escape(self.word)}{sign}(?P<number>\S.*?)\s*(?P<unit>{units})?"
            rf"(?P<always>\s+{always})?",
            re.IGNORECASE,
        )

    def said(self, move: Move, number: Callable[[float], str]) -> str | None:
        """The line that gives a move what it states, without ``always``; None if it states none of
        it."""
        found = self.stated(move, move.zone if self.is_zone else move.speed)
        if found is None:
            return None
        unit, value = found
        gap = " " if unit[:1].isalpha() else ""
        return f"{self.word}{self.sign}{number(value)}{gap}{unit}"

    def stated(self, move: Move, part: MovePart) -> tuple[str, float] | None:
        """The unit and the number that say a part of a move; None if it states none of it."""
        units = self.joint if isinstance(move, MoveJ) else self.line
        if isinstance(part, Speed):
            return stated(part, units)
        for unit, one in units.items():
            return unit, _size(part) / one.scale
        return None


def _size(part: MovePart) -> float:
    if isinstance(part, Radius):
        return part.tcp
    return part.size if isinstance(part, VendorZone) else 0.0


@dataclass(frozen=True)
class Settings:
    """The settings of a language.

    Args:
        settings: those of speeds in the order in which a move's numbers have them.
        zone: kind of the zones that they set.
        number: a number as the language writes it.
    """

    settings: tuple[Setting, ...] = ()
    zone: type[Radius] | ZoneKind = Radius
    number: Callable[[float], str] = nine_decimals
    _words: frozenset[str] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        words = frozenset(one.word for one in self.settings)
        object.__setattr__(self, "_words", words)

    def __iter__(self) -> Iterator[Setting]:
        return iter(self.settings)

    def __contains__(self, word: object) -> bool:
        return word in self._words

    # ----------------------------------------------------------------------- reading

    def read(self, line: Line, spelling: Spelling = USUAL) -> Set | None:
        """What a line sets; None if it sets nothing of this."""
        text = line.source.text
        for one in self.settings:
            found = one.pattern.fullmatch(text, line.start, line.end)
            if found is not None:
                value = parse(line.source, *found.span("number"), spelling)
                known = {unit.upper(): unit for unit in (*one.joint, *one.line)}
                unit = known[(found["unit"] or "").upper()]
                once = one.always is not None and not found["always"]
                return Set(line.span, one.word, value, unit, once)
        return None

    def operand(self, line: Line, kind: UseKind) -> Operand:
        """The speed or zone of a move that states none itself."""
        span = line.span
        return Operand(span, tuple(Datum(span, one.word, None) for one in self._of(kind)))

    def speed(self, numbers: Numbers, joint: bool) -> Speed:
        """The speed that the numbers of `operand` make.

        Raises:
            InputError: a unit sets nothing of such moves, or two settings that are one here differ.
        """
        made: dict[str, float] = {}
        for one, number, unit in zip(self._of(UseKind.SPEED), numbers, numbers.kind, strict=True):
            amount = (one.joint if joint else one.line).get(unit)
            if amount is None:
                continue
            value = number * amount.scale
            if made.setdefault(amount.name, value) != value:
                raise InputError(
                    f"{one.word} {number:g}{unit} differs from another setting of "
                    f"Speed.{amount.name}: moves have one of them here"
                )
        speed = Speed()
        for name, value in made.items():
            speed = with_number(speed, name, value)
        return speed

    def zone_of(self, numbers: Numbers) -> Zone:
        """The zone that the numbers of `operand` make."""
        (one,) = self._of(UseKind.ZONE)
        size = numbers[0] * {**one.joint, **one.line}[numbers.kind[0]].scale
        if size == 0:
            return FINE
        if isinstance(self.zone, ZoneKind):
            return self.zone.sized(size)
        return Radius(size).with_one_distance()

    # ---------------------------------------------------------- writing and patching

    def lines(self, move: Move, said: dict[str, str]) -> Iterator[str]:
        """What is said before a move; ``said``: the lines that hold, by word, kept here."""
        for one in self.settings:
            line = one.said(move, self.number)
            if line is not None and said.get(one.word) != line:
                said[one.word] = line
                yield line if one.always is None else f"{line} {one.always}"

    def numbers(self, kind: UseKind, part: MovePart, move: Move) -> tuple[float, ...]:
        """The numbers of a speed or zone, in the order of the settings."""
        found = (one.stated(move, part) for one in self._of(kind))
        return tuple(0.0 if one is None else one[1] for one in found)

    def own(self, use: Use) -> Iterator[Edit]:
        """Settings of its own for a move: before it, and where they go on holding, those that held
        before behind it."""
        start = use.statement
        before = Span(start.file, start.line, start.column, start.start, start.start)
        behind = Span(start.file, start.line, start.column, start.end, start.end)
        gap = f"\n{' ' * (start.column - 1)}"
        was: dict[str, Any] = {use.kind: use.old}
        old = replace(use.move, **was)
        put_in, put_back = "", ""
        for one in self._of(use.kind):
            held, new = (one.said(move, self.number) for move in (old, use.move))
            if new and held != new:
                put_in += f"{new}{gap}"
                put_back += f"{gap}{held}" if one.always is None and held else ""
        yield Edit(before, put_in, use.index)
        if put_back:
            yield Edit(behind, put_back, use.index)

    def unsaid(
        self, motion: re.Pattern[str], others: Sequence[str] = ()
    ) -> Callable[[str], Iterator[Unsaid]]:
        """Finds where settings are set and used, for `core.dialect.Wording.unsaid`.

        Args:
            motion: a line that drives.
            others: words that set what holds and is no number: tools and frames.
        """
        begins = [(re.compile(rf"{re.escape(w)}\b", re.IGNORECASE), w) for w in others]

        def found(text: str) -> Iterator[Unsaid]:
            for line in re.finditer(r"[^\s;][^\r\n;]*", text):
                said = line[0].rstrip()
                if len(said) > _LONGEST:
                    continue
                words = [one.word for one in self.settings if one.pattern.fullmatch(said)]
                words += [word for pattern, word in begins if pattern.match(said)]
                place = line.start(), line.start() + len(said)
                if words:
                    yield Unsaid(words[0], *place, given=True)
                elif motion.match(said):
                    every = (*(one.word for one in self.settings), *others)
                    yield from (Unsaid(word, *place) for word in every)

        return found

    def _of(self, kind: UseKind) -> list[Setting]:
        return [one for one in self.settings if one.is_zone == (kind is UseKind.ZONE)]
