"""Settings that hold: words that give the moves behind them a speed, an acceleration, a zone.

``SPEED 30 MM/S ALWAYS``, ``$LIN_SPD := 0.25``, ``CNT 1, 300, 200``, ``CP OFF``. A language says as
data what each sets, in which units, and until when it holds; reading, writing and patching follow
from that.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from ...display import counted
from ...errors import InputError, Span
from ...program.move import Move, MoveC, MoveJ
from ...program.speed import Speed
from ...program.zone import FINE, Fine, Radius, VendorZone, Zone, ZoneKind
from ...robot.model import Robot
from ..patch.edits import Edit
from ..patch.uses import MovePart, Use, UseKind
from ..text.numerals import in_proportion, nine_decimals, with_decimals_of
from .amounts import (
    BEHIND,
    PASSING,
    ZONE,
    ZONES,
    Amount,
    Units,
    of_arm,
    stated,
    with_number,
    zone_number,
)
from .expressions import USUAL, Datum, Expression, Number, Spelling, parse, parse_all
from .statements import Line, Numbers, Operand, Set


@dataclass(frozen=True)
class Setting:
    """A word whose numbers hold.

    Args:
        word: as it is written.
        joint, line: what its number, the first of several, is for joint moves, and for lines and
            arcs, by unit.
        initial: the number, or all of several, that holds before the word is said; None if nobody
            knows: it is asked for then.
        unit: of that number.
        sign: what stands between the word and the number.
        always: what stands behind a number that holds until it is set again, where one without it
            holds for the next move alone; None where every one holds.
        more: what further numbers behind commas are, in all moves.
        omitted: what each of the numbers is where a line leaves it out; empty: as the one before.
        opening: what stands before numbers: ``1,`` of ``CNT 1, 300, 200``.
        words: what may stand in the place of numbers, and those that it means: ``0`` of ``CNT 0``,
            ``OFF``, and ``""`` of the word alone.
    """

    word: str
    joint: Units
    line: Units
    initial: float | Sequence[float] | None = None
    unit: str = ""
    sign: str = " "
    always: str | None = None
    more: tuple[Amount, ...] = ()
    omitted: tuple[float, ...] = ()
    opening: str = ""
    words: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        wrong = [word for word, numbers in self.words.items() if len(numbers) != self.count]
        if wrong or (self.omitted and len(self.omitted) != self.count):
            raise InputError(
                f"setting {self.word}: {repr(wrong[0]) if wrong else 'omitted'} stands for "
                f"{self.count} numbers, as many as it has"
            )

    @cached_property
    def sets(self) -> frozenset[str]:
        """Names of what its numbers are (`Amount`)."""
        amounts = (*self.joint.values(), *self.line.values(), *self.more)
        return frozenset(one.name for one in amounts)

    @property
    def is_zone(self) -> bool:
        """Whether it sets a zone, or a part of one."""
        return not self.sets.isdisjoint(ZONES)

    @property
    def count(self) -> int:
        """How many numbers it has."""
        return 1 + len(self.more)

    @property
    def names(self) -> tuple[str, ...]:
        """Under which its numbers are kept: data are called in capitals."""
        word = self.word.upper()
        return (word, *(f"{word}[{k}]" for k in range(2, self.count + 1)))

    @property
    def whole(self) -> bool:
        """Whether what stands behind the word is one literal, since words may stand there, too."""
        return bool(self.more or self.words or self.opening)

    def of(self, robot: Robot | None) -> Setting:
        """The same for an arm."""
        joint, line = of_arm(self.joint, robot), of_arm(self.line, robot)
        return replace(self, joint=joint, line=line, more=tuple(a.of(robot) for a in self.more))

    def amount(self, k: int, unit: str, joint: bool) -> Amount | None:
        """What a number is, counted from 0; None if it sets nothing of such moves."""
        if k:
            return self.more[k - 1]
        return (self.joint if joint else self.line).get(unit)

    # ----------------------------------------------------------------------- reading

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        """A line that says it."""
        always = re.escape(self.always or "").replace(r"\ ", r"\s+") or "(?!)"
        sign = re.escape(self.sign.strip())
        sign = rf"\s*{sign}\s*" if sign else r"\s+"
        alone = "?" if "" in self.words else ""
        return re.compile(
            rf"{re.escape(self.word)}(?:{sign}(?P<argument>{self._argument})){alone}"
            rf"(?P<always>\s+{always})?",
            re.IGNORECASE,
        )

    @property
    def _argument(self) -> str:
        known = sorted({*self.joint, *self.line} - {""}, key=len, reverse=True)
        units = "|".join(map(re.escape, known)) or "(?!)"
        words = "|".join(re.escape(word) for word in self.words if word) or "(?!)"
        opening = "".join(rf"{re.escape(one)}\s*" for one in self.opening.replace(" ", ""))
        return rf"(?P<word>{words})|{opening}(?P<number>\S.*?)\s*(?P<unit>{units})?"

    def read(self, line: Line, spelling: Spelling = USUAL) -> Set | None:
        """What a line sets; None if it does not say this.

        Raises:
            InputError: it has more numbers than there are.
        """
        found = self.pattern.fullmatch(line.source.text, line.start, line.end)
        if found is None:
            return None
        begin = line.start + len(self.word)
        span = line.source.span(*(found.span("argument") if found["argument"] else (begin, begin)))
        if found["number"] is None:
            given, unit = self._meant(span, found["word"] or ""), self.unit
        else:
            place = line.source, *found.span("number"), spelling
            several = self.more and "," in found["number"]
            given = parse_all(*place) if several else (parse(*place),)
            known = {unit.upper(): unit for unit in (*self.joint, *self.line)}
            unit = known[(found["unit"] or "").upper()]
        if len(given) > self.count:
            raise InputError(f"{self.word} has no more than {counted(self.count, 'number')}")
        left_out = range(len(given), self.count)
        rest = (Number(span, self.omitted[k]) if self.omitted else given[-1] for k in left_out)
        once = self.always is not None and not found["always"]
        alone = self.whole and all(isinstance(one, Number) for one in given)
        return Set(line.span, self.names, (*given, *rest), unit, once, span if alone else None)

    def _meant(self, span: Span, word: str) -> tuple[Expression, ...]:
        """The numbers that a word stands for."""
        numbers = {known.upper(): numbers for known, numbers in self.words.items()}
        return tuple(Number(span, value) for value in numbers[word.upper()])

    # ---------------------------------------------------------- writing and patching

    def stated(self, move: Move, part: MovePart) -> tuple[str, tuple[float, ...]] | None:
        """The unit and the numbers that say a part of a move; None if it states none of it."""
        units = self.joint if isinstance(move, MoveJ) else self.line
        if not isinstance(part, Speed):
            unit = next(iter(units), None)
            found = None if unit is None else (unit, zone_number(part, units[unit]))
            further = [zone_number(part, one) for one in self.more]
        else:
            found = stated(part, units)
            values = [(getattr(part, one.name), one.one) for one in self.more]
            further = [value / scale for value, scale in values if value is not None]
        if found is None or len(further) < len(self.more):
            return None
        return found[0], (found[1], *further)

    def argument(self, unit: str, numbers: Sequence[float]) -> str:
        """What stands behind the word."""
        said = [nine_decimals(value) for value in numbers]
        for word, meant in self.words.items():
            if said == [nine_decimals(value) for value in meant]:
                return word
        gap = " " if unit[:1].isalpha() else ""
        return f"{self.opening}{', '.join(said)}{gap}{unit}"

    def said(self, move: Move, part: MovePart) -> str | None:
        """The line that gives a move what it states, without ``always``; None if it states none of
        it."""
        found = self.stated(move, part)
        if found is None:
            return None
        argument = self.argument(*found)
        return f"{self.word}{self.sign}{argument}" if argument else self.word

    def changed(self, text: str, unit: str, old: Sequence[float], new: Sequence[float]) -> str:
        """What stands behind the word with other numbers; those that stay, stay as they are."""
        if tuple(old) == tuple(new):
            return text
        said = self.argument(unit, new)
        found = re.fullmatch(self._argument, text, re.IGNORECASE)
        if not text:
            return f"{self.sign}{said}"
        if found is None or found["number"] is None or said in self.words:
            return said
        given = found["number"].split(",") if self.more else [found["number"]]
        for k, one in enumerate(given):
            if old[k] != new[k]:
                own = one.strip()
                said = nine_decimals(in_proportion(own, old[k], new[k]))
                given[k] = one.replace(own, with_decimals_of(own, said))
        for k in range(len(given), self.count):
            left_out = self.omitted[k] if self.omitted else new[k - 1]
            if nine_decimals(new[k]) != nine_decimals(left_out):
                given += [f" {nine_decimals(value)}" for value in new[len(given) : k + 1]]
        start, end = found.span("number")
        return f"{text[:start]}{','.join(given)}{text[end:]}"


@dataclass(frozen=True)
class Settings:
    """The settings of a language.

    Args:
        settings: those of speeds in the order in which a move's numbers have them.
        zone: kind of the zones that they set.
        flying: the word by which motions themselves say that there is a zone: ``FLY`` of
            ``MOVEFLY``; ``""`` where they do not. Of a stop nothing is set.

    Raises:
        InputError: spheres have one distance.
    """

    settings: tuple[Setting, ...] = ()
    zone: type[Radius] | ZoneKind = Radius
    flying: str = ""

    def __post_init__(self) -> None:
        two = any(BEHIND in one.sets for one in self.settings)
        if two and not isinstance(self.zone, ZoneKind):
            raise InputError("a Radius has one distance: zones of two are of a ZoneKind")

    def of(self, robot: Robot | None) -> Settings:
        """The same for an arm."""
        return replace(self, settings=tuple(one.of(robot) for one in self.settings))

    def __iter__(self) -> Iterator[Setting]:
        return iter(self.settings)

    def __contains__(self, word: object) -> bool:
        return any(one.names[0] == word for one in self.settings)

    def sets(self, kind: UseKind) -> bool:
        """Whether they set a speed, or a zone."""
        return any(self._of(kind))

    def speeds(self, joint: bool) -> set[str]:
        """The numbers of `Speed` that they set, of joint moves or of lines and arcs."""
        return {
            amount.name
            for one in self._of(UseKind.SPEED)
            for amount in (*(one.joint if joint else one.line).values(), *one.more)
        }

    @property
    def zones(self) -> tuple[type[Radius] | ZoneKind, ...]:
        """The kinds of zone that they set."""
        return (self.zone,) if self.sets(UseKind.ZONE) else ()

    # ----------------------------------------------------------------------- reading

    def read(self, line: Line, spelling: Spelling = USUAL) -> Set | None:
        """What a line sets; None if it sets nothing of this."""
        return next(filter(None, (one.read(line, spelling) for one in self.settings)), None)

    def operand(self, span: Span, kind: UseKind) -> Operand:
        """The speed or zone of a move that states none itself; ``span``: of the move, or of the
        word in it that says that there is a zone."""
        return Operand(
            span,
            tuple(
                Datum(span, one.names[0], None, Number(span, k + 1.0) if k else None)
                for one in self._of(kind)
                for k in range(one.count)
            ),
        )

    def speed(self, numbers: Numbers, joint: bool) -> Speed:
        """The speed that the numbers of `operand` make.

        Raises:
            InputError: a unit sets nothing of such moves, or two numbers that are one here differ.
        """
        speed = Speed()
        for name, value in self._made(UseKind.SPEED, numbers, joint).items():
            speed = with_number(speed, name, value)
        return speed

    def zone_of(self, numbers: Numbers, joint: bool = False) -> Zone:
        """The zone that the numbers of `operand` make."""
        made = self._made(UseKind.ZONE, numbers, joint)
        unsaid = 0.0
        if isinstance(self.zone, ZoneKind) and not any(ZONE in one.sets for one in self.settings):
            unsaid = self.zone.largest
        size = made.get(ZONE, unsaid) if made.get(PASSING, 1.0) else 0.0
        if size == 0:
            return FINE
        if not isinstance(self.zone, ZoneKind):
            return Radius(size).with_one_distance()
        zone = self.zone.sized(size)
        if BEHIND not in made or not isinstance(zone, VendorZone):
            return zone
        return replace(zone, ratio=made[BEHIND] / size)

    def _made(self, kind: UseKind, numbers: Numbers, joint: bool) -> dict[str, float]:
        """What the numbers of `operand` are, by the names of amounts."""
        made: dict[str, float] = {}
        places = ((one, k) for one in self._of(kind) for k in range(one.count))
        for (one, k), number, unit in zip(places, numbers, numbers.kind, strict=True):
            amount = one.amount(k, unit, joint)
            if amount is None:
                continue
            value = number * amount.one
            if made.setdefault(amount.name, value) != value:
                raise InputError(
                    f"{one.word} {number:g}{unit} differs from another setting of "
                    f"Speed.{amount.name}: moves have one of them here"
                )
        return made

    # ---------------------------------------------------------- writing and patching

    def lines(
        self, move: Move, said: dict[str, str], kinds: Container[UseKind] = tuple(UseKind)
    ) -> Iterator[str]:
        """What is said before a move.

        Args:
            move: the move.
            said: the lines that hold, by word, kept here.
            kinds: what is not said by the motion itself.
        """
        for kind, part in ((UseKind.SPEED, move.speed), (UseKind.ZONE, move.zone)):
            for one in self._counting(kind, part) if kind in kinds else ():
                line = one.said(move, part)
                if line is not None and said.get(one.word) != line:
                    said[one.word] = line
                    yield line if one.always is None else f"{line} {one.always}"

    def numbers(self, kind: UseKind, part: MovePart, move: Move) -> tuple[float | None, ...]:
        """The numbers of a speed or zone, in the order of the settings; None for one that may be
        anything."""
        made: list[float | None] = []
        counting = self._counting(kind, part)
        for one in self._of(kind):
            found = one.stated(move, part)
            nothing = 0.0 if one in counting else None
            made += [nothing] * one.count if found is None or nothing is None else found[1]
        return tuple(made)

    def rewritten(self, use: Use, text: Callable[[Span], str]) -> dict[Span, str]:
        """What literals must say that are all that stands behind a word, by their places."""
        made: dict[Span, str] = {}
        counting, at = self._counting(use.kind, use.new), 0
        for one in self._of(use.kind):
            places = {*use.origin.numbers[at : at + one.count]}
            mine = use.origin.numbers and use.origin.datum_of(at) == one.names[0]
            at += one.count
            place = places.pop() if len(places) == 1 else None
            old, new = one.stated(use.move, use.old), one.stated(use.move, use.new)
            if one.whole and mine and place and old and new:
                said, wanted = text(place), new[1] if one in counting else old[1]
                made[place] = one.changed(said, new[0], old[1], wanted)
        return made

    def own(self, use: Use, later: Sequence[Move]) -> Iterator[Edit]:
        """Settings of its own for a move: before it, and where they go on holding, those that held
        before behind it; and its word for a zone, where it has one.

        Args:
            use: what the move is to have.
            later: the moves behind it.

        Raises:
            InputError: the motion has no place for that word.
        """
        old, start = use.old, use.statement
        if self.flying and isinstance(use.old, Fine) != isinstance(use.new, Fine):
            if use.origin.span == use.statement:
                raise InputError(
                    "the motion says nothing of it, and nothing is put in: write it anew"
                )
            passing = not isinstance(use.new, Fine)
            yield Edit(use.origin.span, self.flying if passing else "", use.index)
            # What a stop was driven under nobody reads: what the next zone reads is put back.
            zones = (move.zone for move in later if not isinstance(move.zone, Fine))
            old = next(zones, use.old)
            if not passing:
                return
        before = Span(start.file, start.line, start.column, start.start, start.start)
        behind = Span(start.file, start.line, start.column, start.end, start.end)
        gap = f"\n{' ' * (start.column - 1)}"
        put_in, put_back = "", ""
        # An arc may stand on several lines, and what holds for one motion be used up on the first.
        several = isinstance(use.move, MoveC)
        was = self._counting(use.kind, old)
        for one in self._counting(use.kind, use.new):
            held, new = (one.said(use.move, part) for part in (old, use.new))
            if new and held != new:
                always = f" {one.always}" if one.always and several else ""
                put_in += f"{new}{always}{gap}"
                held = held if (one.always is None or several) and one in was else None
                put_back += f"{gap}{held}{always}" if held else ""
        if put_in:
            yield Edit(before, put_in, use.index)
        if put_back:
            yield Edit(behind, put_back, use.index)

    def _of(self, kind: UseKind) -> list[Setting]:
        return [one for one in self.settings if one.is_zone == (kind is UseKind.ZONE)]

    def _counting(self, kind: UseKind, part: MovePart) -> list[Setting]:
        """Those that count for a part: of a stop, the one that says so, if there is one."""
        every = self._of(kind)
        switches = [one for one in every if PASSING in one.sets]
        return switches if isinstance(part, Fine) and (switches or self.flying) else every
