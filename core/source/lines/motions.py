"""What motions say beside where they go: a speed with its unit, a zone, a share of acceleration."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ...errors import InputError
from ...program.move import Move, MoveJ
from ...program.speed import Speed
from ...program.zone import FINE, VendorZone, Zone, ZoneKind
from ...robot.model import Robot
from ..patch.edits import Edit
from ..patch.uses import MovePart, Use, UseKind
from ..text.numerals import nine_decimals
from .amounts import Units, of_arm, stated, with_number


@dataclass(frozen=True)
class MotionWords:
    r"""How motions say their speed and zone.

    Args:
        joint, line: what the number of a speed is in joint moves, and in lines and arcs, by its
            unit; the first that a move states is written. Empty where settings say it.
        zones: kinds of zone by word; likewise.
        stop: what stands for none; None where a zone of size 0 does.
        unstated: what stands for a speed of which a move states nothing.
        speed, zone: how they are written: of ``number`` and ``unit``, ``word`` and ``numbers``.
        share: how a share of acceleration is written, of its ``number`` in %.
        via: how an arc's auxiliary point stands in it, of its ``point``, and of what ``motion``
            has; with ``\n`` at its end for one that has a line of its own, which the form ``via``
            reads, or the grammar's `paired` motions.
        motion: a whole motion: of its ``kind`` (J, L, C), ``via``, ``point``, ``speed``, ``zone``
            and ``share``, and of what else the writer hands over.
    """

    joint: Units = field(default_factory=dict)
    line: Units = field(default_factory=dict)
    zones: Mapping[str, ZoneKind] = field(default_factory=dict)
    stop: str | None = "FINE"
    unstated: str = ""
    speed: str = "{number}{unit}"
    zone: str = "{word}{numbers}"
    share: str = ""
    via: str = "{point} "
    motion: str = "MOVE{kind} {via}{point} {speed} {zone} {share}"

    def of(self, robot: Robot | None) -> MotionWords:
        """The same for an arm."""
        return replace(self, joint=of_arm(self.joint, robot), line=of_arm(self.line, robot))

    def says(self, kind: UseKind) -> bool:
        """Whether motions are written with a speed, or zone, of their own."""
        return f"{{{kind}}}" in self.motion

    # ----------------------------------------------------------------------- reading

    def speed_of(
        self,
        kind: str,
        unit: str | None,
        numbers: Sequence[float],
        share: bool = False,
    ) -> Speed:
        """The speed of the numbers of a motion.

        Args:
            kind: ``J``, ``L`` or ``C``.
            unit: of the first number; None if no speed is stated.
            share: whether the last number is a share of acceleration, %.

        Raises:
            InputError: such moves have no speeds in this unit.
        """
        acceleration = numbers[-1] / 100 if share else 1.0
        if unit is None:
            return Speed(acceleration_override=acceleration)
        units = self.joint if kind == "J" else self.line
        amount = next((a for known, a in units.items() if known.upper() == unit.upper()), None)
        if amount is None:
            raise InputError(f"the speed of such a motion is no number of {unit}")
        speed = Speed(acceleration_override=acceleration)
        return with_number(speed, amount.name, numbers[0] * amount.one)

    def zone_of(self, word: str | None, numbers: Sequence[float]) -> Zone:
        """The zone of its word and numbers.

        Args:
            word: None for none: numbers are of the first kind then.
            numbers: none of a stop, and of a kind with one size.

        Raises:
            InputError: there is none of this size.
        """
        if not (word or numbers) or (numbers and numbers[0] == 0):
            return FINE
        words = {known.upper(): kind for known, kind in self.zones.items()}
        kind = words[(word or next(iter(words))).upper()]
        if not numbers:
            if len(kind.sizes) != 1:
                raise InputError(f"a number should stand behind {word}")
            return VendorZone(kind, *kind.sizes)
        if kind.sizes:
            level = int(numbers[0])
            if not 1 <= level <= len(kind.sizes):
                known = f"{kind.word}=0 to {len(kind.sizes)} are"
                raise InputError(f"how far {kind.word}={level} reaches is not published: {known}")
            return VendorZone(kind, kind.sizes[level - 1])
        ratio = numbers[1] / numbers[0] if len(numbers) > 1 else 1.0
        return VendorZone(kind, numbers[0] / (1 / kind.unit), ratio)

    # ---------------------------------------------------------- writing and patching

    def numbers(self, part: MovePart, move: Move) -> tuple[float, ...]:
        """The numbers of a speed or zone, in the order in which a motion has them.

        Raises:
            InputError: there is no zone of this size.
        """
        if isinstance(part, Speed):
            found, share = self._stated(move, part), part.acceleration_override
            shown = () if found is None else (found[1],)
            return shown if share == 1.0 else (*shown, 100 * share)
        if not isinstance(part, VendorZone):
            return () if self.stop is not None else (0.0,)
        if part.kind.sizes:
            if part.size not in part.kind.sizes:
                told = f"{part.kind.word} has {len(part.kind.sizes)} sizes"
                raise InputError(f"{told}, and {1000 * part.size:g} mm is none of them")
            several = len(part.kind.sizes) > 1
            return (1.0 + part.kind.sizes.index(part.size),) if several else ()
        size = part.size / part.kind.unit
        return (size,) if part.ratio == 1.0 else (size, size * part.ratio)

    def text(self, move: Move, *points: str, kind: str = "", **others: object) -> str:
        """A motion to its points, as they are called; ``kind``: the word of a move of this kind,
        where that is not J, L or C; ``others``: what else stands in it, by name."""
        *via, point = points
        share = move.speed.acceleration_override
        parts = {
            "kind": kind or type(move).__name__[-1],
            "speed": self.speed_text(move),
            "zone": self.zone_text(move),
            "share": "" if share == 1.0 else self.share.format(number=nine_decimals(100 * share)),
            **others,
        }
        first = "".join(self.via.format(point=one, **parts) for one in via)
        said = self.motion.format(via=first, point=point, **parts)
        return "\n".join(" ".join(line.split()) for line in said.splitlines())

    def speed_text(self, move: Move) -> str:
        """The words of a move's speed, without its share of acceleration."""
        found = self._stated(move, move.speed)
        if found is None:
            return self.unstated
        return self.speed.format(unit=found[0], number=nine_decimals(found[1]))

    def zone_text(self, move: Move) -> str:
        """The words of a move's zone."""
        if not self.zones:  # settings say it
            return ""
        if self.stop is not None and not isinstance(move.zone, VendorZone):
            return self.stop
        numbers = self.numbers(move.zone, move)
        kinds = {kind: word for word, kind in self.zones.items()}
        first = next(iter(self.zones))
        word = kinds[move.zone.kind] if isinstance(move.zone, VendorZone) else first
        said = self.zone.format(word=word, numbers=",".join(map(nine_decimals, numbers)))
        return said.strip()

    def own(self, use: Use) -> Iterator[Edit]:
        """Other words at the move itself.

        Raises:
            InputError: the move says nothing of this part, or would have to say more.
        """
        if use.origin.span == use.statement:
            raise InputError("the motion says nothing of it, and nothing is put in: write it anew")
        if not isinstance(use.old, Speed):
            yield Edit(use.origin.span, self.zone_text(use.move), use.index)
            return
        old, new = (speed.acceleration_override for speed in (use.old, use.move.speed))
        if not math.isclose(old, new, rel_tol=1e-12):
            raise InputError("no share of acceleration is put in or taken out: write it anew")
        yield Edit(use.origin.span, self.speed_text(use.move), use.index)

    def _stated(self, move: Move, speed: Speed) -> tuple[str, float] | None:
        return stated(speed, self.joint if isinstance(move, MoveJ) else self.line)
