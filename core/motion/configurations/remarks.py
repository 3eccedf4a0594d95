"""What there is to say of the configurations that a program's moves are driven with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ...display import counted
from ...errors import Note
from ...program.move import Move
from ...program.target import PoseTarget


@dataclass(frozen=True)
class Remarks:
    """Remarks by the indices of moves, made while their configurations are found.

    Args:
        assumed: what nobody knows of the place of each move (its tool, its work object, its target,
            where the robot stands first): its configuration tells nothing of a pose that is not its
            own, and gives way.
        departures: of each move that is driven with another configuration than programmed, what
            there is to say.
        tolerated: the same of those whose configuration the controller takes all the same.
        ambiguous: the same of those whose configuration does not tell postures of the arm apart.
        uneven: of each move that is led to an arm angle, rad by which the third axis would be
            elsewhere on the way if that angle turned evenly.
    """

    assumed: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    departures: dict[int, str] = field(default_factory=dict)
    tolerated: dict[int, str] = field(default_factory=dict)
    ambiguous: dict[int, str] = field(default_factory=dict)
    uneven: dict[int, float] = field(default_factory=dict)

    def notes(self, moves: Sequence[Move]) -> list[Note]:
        """Notes on configurations that gave way, and on those that are not quite those of their
        poses, or hold for several."""
        return self._on_departures(moves) + self._on_tolerance()

    def _on_departures(self, moves: Sequence[Move]) -> list[Note]:
        """Notes on configurations that gave way; one for all of moves whose pose is not known."""
        found = []
        guessed = [move for move in self.departures if move in self.assumed]
        for move, said in self.departures.items():
            target = moves[move].target
            assert isinstance(target, PoseTarget)
            message = f"configuration {target.configuration} {said}"
            if guessed and move == guessed[0]:
                names = dict.fromkeys(name for k in guessed for name in self.assumed[k])
                be = "is" if len(names) == 1 else "are"
                others = len(guessed) - 1
                more = f"; so it is with {counted(others, 'other move')}" if others else ""
                *first, last = names
                named = f"{', '.join(first)} and {last}" if first else last
                message += f", as {named} {be} not known{more}"
            if move not in guessed[1:]:
                found.append(Note(message, move))
        return found

    def _on_tolerance(self) -> list[Note]:
        """Notes on configurations that are not quite those of their poses, or hold for several."""
        found = []
        for moves, end in (
            (self.tolerated, ", the nearest that controllers take"),
            (self.ambiguous, " of this arm: the nearest is taken, and may be another one there"),
        ):
            if moves:
                first, what = next(iter(moves.items()))
                others = len(moves) - 1
                more = f"; so it is with {counted(others, 'other move')}" if others else ""
                found.append(Note(f"configuration {what}{end}{more}", first))
        return found
