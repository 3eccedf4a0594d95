"""Zones that nobody recorded: how large they were, as the log shows it.

A record may have nothing but a rule for radii (a share of the shorter neighbouring leg). The run's
zones are then in proportion to the rule, or all alike; one number is left to find, where the fit
begins from the best of some. It belongs to the run, is fitted, and is never counted as predicted.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from ...core.errors import FlybyError
from ...core.motion.emulator.controller import Controller
from ...core.program.program import Program
from ...core.program.zone import Radius
from ..logs.cleaning import CleanLog
from ..prediction import Prediction, predict

GUESSES = (0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0, 22.0, 32.0)
"""Factors on the rule, or on the largest radius that it gives, to begin from."""
FAR = 1e-3
"""m from the path beyond which it does not matter how far: a waypoint may be left out."""
COARSE = 1e-3
"""s between samples of the emulation that a run is first laid on."""


def resized(program: Program, size: float) -> Program:
    """A program with all its zones resized by a factor."""
    if size == 1.0:
        return program
    return _with_radii(program, [size * radius for radius in _radii(program)])


def alike(program: Program) -> Program:
    """A program with all its zones as large as the largest."""
    radii = _radii(program)
    return _with_radii(program, [max(radii)] * len(radii)) if radii else program


def guess(
    controller: Controller, name: str, program: Program, log: CleanLog
) -> tuple[Program, float, Prediction]:
    """The rule that fits the log best, with a first guess of its factor.

    Returns:
        The program by that rule, the factor on its zones, and what it predicts.

    Raises:
        FlybyError: none of the guesses can be driven, or the log belongs to none.
    """
    best: tuple[float, Program, float, Prediction] | None = None
    problem: FlybyError | None = None
    for rule, size in _rules(program):
        try:
            found = predict(controller, name, resized(rule, size), log, COARSE)
        except FlybyError as error:
            problem = error
            continue
        off = float(np.mean(np.minimum(found.residuals.path, FAR)))
        if best is None or off < best[0]:
            best = off, rule, size, found
    if best is None:
        assert problem is not None
        raise problem
    return best[1:]


def _rules(program: Program) -> Iterable[tuple[Program, float]]:
    for rule in (program, alike(program)):
        for size in GUESSES:
            yield rule, size


def _radii(program: Program) -> list[float]:
    return [m.zone.tcp for m in program.moves if isinstance(m.zone, Radius) and m.zone.tcp > 0]


def _with_radii(program: Program, radii: list[float]) -> Program:
    queue = iter(radii)
    moves = (
        replace(move, zone=move.zone.resized(next(queue)))
        if isinstance(move.zone, Radius) and move.zone.tcp > 0
        else move
        for move in program.moves
    )
    return program.with_moves(tuple(moves))
