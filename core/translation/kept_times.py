"""Moves that do not take as long as on the other robot, and why."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..dialect import Dialect
from ..display import counted
from ..motion.path.path import Path
from ..program.move import Move
from ..program.program import Program
from .emulation import EmulatedProgram, Party
from .losses import LossesOfPart
from .overrides import OVERRIDE, SHARE, accelerates_by

_TOLD = 0.05
"""Share by which a move may be slower before that is reported."""
_SHORT = 0.02
"""s: a difference of times that is not told."""
_TOLD_TOGETHER = 0.02
"""Share of the whole time from which on differences too small by themselves are reported."""
_MET = 0.02
"""Share of a move's time by which it is met."""
_STEPPED = ("joint_fraction", SHARE, OVERRIDE)
"""Numbers that are said in steps."""


@dataclass
class KeptTimes:
    """The times of one program on both robots.

    Args:
        old: the program on the old robot.
        target: the new robot.
        dialect: its language.
        losses: where differences are listed.
        held: what its maker allows less of than was programmed, by move.
    """

    old: EmulatedProgram
    target: Party
    dialect: Dialect
    losses: LossesOfPart
    held: Mapping[int, str]

    def tell(
        self,
        program: Program,
        path: Path,
        sought: Mapping[int, str],
        tied: Mapping[int, Sequence[int]],
    ) -> None:
        """Losses of moves that the new robot does not drive in the same time.

        Args:
            program: as it is written.
            path: the program's.
            sought: moves of which a number was sought that meets the time.
            tied: of moves that are one, by each of them, all of them.
        """
        segment = {i: k for k, i in enumerate(path.route.moves) if i in self.old.segment}
        wanted = {i: float(self.old.peaks.duration[self.old.segment[i]]) for i in segment}
        spent = self._spent(program, path, segment)
        together = _in_time_together(tied, sought, spent, wanted)
        late = [i for i in segment if i not in together and spent[i] > wanted[i] * (1 + _TOLD)]
        late = [i for i in late if spent[i] > wanted[i] + _SHORT]
        small = {i: spent[i] - wanted[i] for i in segment if i not in {*together, *late}}
        tell_small = sum(small.values()) > _TOLD_TOGETHER * sum(wanted.values())
        slower = [i for i in small if small[i] > 0.0] if tell_small else []
        causes = self._causes(program, path, [*late, *slower], segment, wanted)
        for i in together:
            if abs(spent[i] - wanted[i]) > max(_TOLD * wanted[i], _SHORT):
                why = "one speed serves all that this line drives, which take as long as before"
                self._tell(i, spent[i], wanted[i], f"{why} together")
        for i in late:
            self._tell(i, spent[i], wanted[i], causes[i])
        if slower:
            worst, *others = sorted(slower, key=small.__getitem__, reverse=True)
            more = sum(small[i] for i in others)
            also = f"; {counted(others, 'further move')} {more:.3f} s longer together"
            self._tell(worst, spent[worst], wanted[worst], causes[worst] + (also if others else ""))
        for i in segment:
            share = self._lost_share(i)
            faster = spent[i] < wanted[i] * (1 - _TOLD) and spent[i] < wanted[i] - _SHORT
            if share is not None and faster:
                why = f"a reduced acceleration ({share:.0%}) has no words"
                self._tell(i, spent[i], wanted[i], why)

    def _tell(self, i: int, spent: float, wanted: float, why: str) -> None:
        self.losses.at(
            i, f"takes {spent:.3f} s instead of {wanted:.3f} s: {why}", "time", abs(spent - wanted)
        )

    def _spent(self, program: Program, path: Path, segment: Mapping[int, int]) -> dict[int, float]:
        spent = self.target.timing(program, path).settled_durations()
        return {i: float(spent[k]) for i, k in segment.items()}

    def _lost_share(self, i: int) -> float | None:
        """The share of acceleration that a move is not driven with any more; None if it has its."""
        speed, words = self.old.moves[i].speed, self.dialect.words(self.old.moves[i])
        share = speed.joint_acceleration_fraction * speed.acceleration_override
        return share if share < 1.0 and accelerates_by(words) is None else None

    # ---------------------------------------------------------------------------- causes

    def _causes(
        self,
        program: Program,
        path: Path,
        late: Sequence[int],
        segment: Mapping[int, int],
        wanted: Mapping[int, float],
    ) -> dict[int, str]:
        """Why each of some moves takes longer: the first change with which it would not."""
        robot, causes = self.target.robot.name, dict[int, str]()
        step = self.dialect.share_step

        def kept(i: int) -> str:
            speed = program.moves[i].speed
            share = speed.joint_acceleration_fraction * speed.acceleration_override
            return (
                f"its share of acceleration ({share:.3g}) is kept, and {robot} takes longer at it"
            )

        changes: tuple[tuple[Callable[[Move], Move], Callable[[int], str]], ...] = (
            (
                partial(_one_step_up, step=step),
                lambda _: f"shares of speed and acceleration are said in steps of {step:.3g}",
            ),
            (_with_all_acceleration, kept),
        )
        for change, why in changes:
            left = {i for i in late if i not in causes}
            moves = [change(m) if i in left else m for i, m in enumerate(program.moves)]
            changed = program.with_moves(tuple(moves))
            if changed.moves == program.moves:
                continue
            spent = self._spent(changed, self.target.repaced(path, changed), segment)
            most = {i: wanted[i] * (1 + _MET) for i in left}
            causes |= {i: why(i) for i in left if spent[i] <= most[i]}
        limits = f"the limits of {robot} hold it"
        return {i: causes.get(i, limits + self.held.get(i, "")) for i in late}


def _one_step_up(move: Move, step: float) -> Move:
    numbers = {name: getattr(move.speed, name) for name in _STEPPED}
    more: dict[str, Any] = {n: min(1.0, v + step) for n, v in numbers.items() if v < 1.0}
    return replace(move, speed=replace(move.speed, **more))


def _with_all_acceleration(move: Move) -> Move:
    override = max(1.0, move.speed.acceleration_override)
    speed = replace(move.speed, joint_acceleration_fraction=1.0, acceleration_override=override)
    return replace(move, speed=speed)


def _in_time_together(
    tied: Mapping[int, Sequence[int]],
    sought: Mapping[int, str],
    spent: Mapping[int, float],
    wanted: Mapping[int, float],
) -> set[int]:
    """The moves that are one with others and take no longer than before together."""
    sums: dict[int, FloatArray] = {}
    counting = [i for i in spent if i in tied and i in sought]
    for i in counting:
        lead = tied[i][0]
        sums[lead] = sums.get(lead, np.zeros(2)) + np.array((spent[i], wanted[i]))
    return {i for i in spent if i in tied and _kept(sums.get(tied[i][0]))}


def _kept(times: FloatArray | None) -> bool:
    """Whether the new time is as long as the old one, or less."""
    return times is not None and bool(times[0] <= times[1] * (1 + _TOLD))
