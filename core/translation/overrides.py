"""Overrides of accelerations, said as the accelerations that they make."""

from __future__ import annotations

from dataclasses import replace

from ..motion.model.motion_model import MotionModel
from ..program.move import Move, MoveJ
from ..program.program import Program
from .losses import LossesOfPart


def without_override(program: Program, model: MotionModel, losses: LossesOfPart) -> Program:
    """The program with shares of the joints' acceleration, and accelerations along lines and arcs
    that were the model's own, in the place of overrides.

    Args:
        model: of the controller that drives it.
        losses: joints accelerated by more than their own limits are listed here.
    """
    if all(move.speed.acceleration_override == 1.0 for move in program.moves):
        return program
    made = [_stated(move, i, model, losses) for i, move in enumerate(program.moves)]
    return program.with_moves(tuple(made))


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
