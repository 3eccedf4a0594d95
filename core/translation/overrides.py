"""Overrides of accelerations and shares of the joints', of which languages say one."""

from __future__ import annotations

from dataclasses import replace

from ..dialect import Dialect, MoveWords
from ..motion.model.motion_model import MotionModel
from ..program.move import Move, MoveJ
from ..program.program import Program
from .losses import LossesOfPart

OVERRIDE, SHARE = "acceleration_override", "joint_acceleration_fraction"


def without_override(
    program: Program, model: MotionModel, dialect: Dialect, losses: LossesOfPart
) -> Program:
    """The program with shares of the joints' acceleration, and accelerations along lines and arcs
    that were the model's own, in the place of overrides that there are no words for.

    Args:
        model: of the controller that drives it.
        losses: joints accelerated by more than their own limits are listed here.
    """

    def unsaid(move: Move) -> bool:
        stated = move.speed.acceleration_override != 1.0
        return stated and OVERRIDE not in dialect.words(move).speeds

    if not any(map(unsaid, program.moves)):
        return program
    made = [
        _stated(move, i, model, losses) if unsaid(move) else move
        for i, move in enumerate(program.moves)
    ]
    return program.with_moves(tuple(made))


def accelerates_by(words: MoveWords) -> str | None:
    """The number of `Speed` by which moves are accelerated less; None if nothing says it."""
    return next((name for name in (SHARE, OVERRIDE) if name in words.speeds), None)


def _stated(move: Move, i: int, model: MotionModel, losses: LossesOfPart) -> Move:
    speed, override = move.speed, move.speed.acceleration_override
    share = speed.joint_acceleration_fraction * override
    if share > 1.0:
        losses.at(i, f"accelerations of {share:.0%} of the joints' own have no words: 100 % is")
    made = replace(speed, acceleration_override=1.0, joint_acceleration_fraction=min(1.0, share))
    own = model.tcp_acceleration
    if not isinstance(move, MoveJ) and speed.tcp_acceleration is None and own is not None:
        made = replace(made, tcp_acceleration=own * override)
    return replace(move, speed=made)
