"""Settings of their own for single moves: statements before the motion, and back again after it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from ....core.errors import InputError, Span
from ....core.program.move import Move
from ....core.source.patch.edits import Edit
from ..write.speeds import speed_settings, zone_settings
from .places import Places


@dataclass(frozen=True, slots=True)
class PlacedMove:
    """A move where it stands.

    Args:
        literals: where the numbers of a variable stand that it reads.
    """

    index: int
    move: Move
    statement: Span
    literals: Mapping[str, frozenset[Span]]


def settings_of(move: Move) -> dict[str, str]:
    """The statements that set what a move's speed and zone read, by variable.

    Raises:
        InputError: KRL cannot say it.
    """
    return dict([*speed_settings(move), *zone_settings(move.zone)])


class Additions:
    """Collects what is put in.

    Args:
        motions: all moves in the order of execution.
    """

    def __init__(self, places: Places, motions: Sequence[PlacedMove]) -> None:
        self._places = places
        self._motions = motions
        self._own: dict[int, dict[str, str]] = defaultdict(dict)

    def set(self, index: int, settings: Mapping[str, str]) -> None:
        """The motion of a move gets settings of its own.

        Args:
            settings: statements by the variable that they set.

        Raises:
            InputError: the motion stands in an inline form, which has no room for them.
        """
        if self._places.form(self._motions[index].statement) is not None:
            raise InputError(
                "the motion stands in an inline form, which has no room for a setting of its own: "
                "give it move data of its own on the teach pendant"
            )
        self._own[index].update(settings)

    def edits(self) -> Iterator[Edit]:
        """All of them.

        Raises:
            InputError: a motion is executed several times and is to have different settings.
        """
        lines: dict[Span, dict[tuple[int, str], tuple[str, int]]] = defaultdict(dict)
        for index, settings in sorted(self._own.items()):
            line, indent, ending = self._places.line(self._motions[index].statement)
            before = self._places.span(line.file, line.start, line.start)
            after = self._places.span(line.file, line.end, line.end)
            unended = not self._places.text(line).endswith(("\n", "\r"))
            for variable, text in settings.items():
                _put(lines[before], (1, variable), f"{indent}{text}{ending}", index)
            for variable, text in self._restored(index, settings).items():
                whole = f"{ending}{indent}{text}" if unended else f"{indent}{text}{ending}"
                _put(lines[after], (0, variable), whole, index)
        for place, found in lines.items():
            texts = [found[key][0] for key in sorted(found, key=lambda key: key[0])]
            yield Edit(place, "".join(texts), next(iter(found.values()))[1])

    def _restored(self, index: int, settings: Mapping[str, str]) -> dict[str, str]:
        """What the next motion that reads a variable as it was set before must find there."""
        restored: dict[str, str] = {}
        for variable, text in settings.items():
            for later in self._motions[index + 1 :]:
                value = settings_of(later.move).get(variable)
                if value is None or not self._relies(later, variable, index):
                    continue
                if variable not in self._own.get(later.index, {}) and value != text:
                    restored[variable] = value
                break
        return restored

    def _relies(self, later: PlacedMove, variable: str, index: int) -> bool:
        """Whether a motion reads a variable as it was set before the motion ``index``."""
        literals = later.literals.get(variable)
        if not literals:
            return True
        here = self._motions[index].statement
        if any(s.file == here.file and s.start < here.start for s in literals):
            return True
        earlier = self._motions[: index + 1]
        return any(literals & motion.literals.get(variable, frozenset()) for motion in earlier)


def _put(
    lines: dict[tuple[int, str], tuple[str, int]], key: tuple[int, str], text: str, index: int
) -> None:
    known, other = lines.setdefault(key, (text, index))
    if known != text:
        raise InputError(
            f"moves {other + 1} and {index + 1} are executions of one instruction, or follow it, "
            f"and would need {known.strip()} and {text.strip()} there: change them all alike"
        )
