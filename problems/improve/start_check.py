"""Programs that cannot be improved because they do not keep the clearance as they are."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.cell.floor import FLOOR, lifted
from ...core.collision.proof.certificate import SceneOf, certify
from ...core.collision.proof.verdict import Certificate, Verdict
from ...core.errors import MotionError
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run

_TOLD = 1e-4
"""m to which the clearance that the program has is reported."""
_CHUNK = 256


def check_start(
    controller: Controller, run: Run, scenes: SceneOf, certificate: Certificate, residual: float
) -> None:
    """Refuse a program that violates the clearance.

    Args:
        controller, run, scenes, residual: of the program as it is.
        certificate: of the run, for the clearance wanted.

    Raises:
        MotionError: naming the first move that collides, the bodies and how deep they overlap; or,
            where they only come too near, the largest clearance that the program keeps.
    """
    if certificate.verdict is not Verdict.VIOLATED:
        return
    overlap = _first_overlap(run, scenes)
    if overlap is not None:
        if FLOOR in overlap.names:
            raise _error(run, overlap.move, f"the program goes {overlap.below()}; {lifted()}")
        cell = scenes(run.program.moves[overlap.move].tool, overlap.move).cell
        hints = "".join(f"; {doubt}" for doubt in cell.doubtful_units())
        raise _error(run, overlap.move, f"the program collides as it is: {overlap}{hints}")
    least = certify(controller, run, scenes, 0.0, residual, resolution=_TOLD)
    advice = "with no clearance at all: " + least.message
    if least.proven:
        kept = math.floor(1e5 * least.clearance) / 1e2
        advice = f"this program keeps {kept:.2f} mm: ask for no more than that"
    what = certificate.message.split(": ", 1)[-1]
    message = f"the program does not keep the clearance as it is: {what}; {advice}"
    raise _error(run, certificate.move, message)


def _error(run: Run, move: int | None, message: str) -> MotionError:
    return MotionError(message, move, None if move is None else run.program.moves[move].statement)


@dataclass(frozen=True, slots=True)
class _Overlap:
    """The deepest overlap of a move.

    Args:
        move: its index.
        time: s.
        names: of the bodies.
        depth: m; None if it has no measure.
    """

    move: int
    time: float
    names: tuple[str, str]
    depth: float | None

    def below(self) -> str:
        """Where it is the floor that something is in."""
        what = next(name for name in self.names if name != FLOOR)
        depth = "" if self.depth is None else f"{1e3 * self.depth:.1f} mm "
        return f"{depth}below {FLOOR} with {what}, at {self.time:.2f} s"

    def __str__(self) -> str:
        depth = "" if self.depth is None else f" by up to {1e3 * self.depth:.2f} mm"
        return (
            f"{self.names[0]} and {self.names[1]} overlap{depth} at {self.time:.2f} s; move the "
            "points, or allow the pair in the cell if it may touch"
        )


def _first_overlap(run: Run, scenes: SceneOf) -> _Overlap | None:
    """The deepest overlap of the first move that has one, by the samples of the motion."""
    motion = run.trajectory
    for move in dict.fromkeys(map(int, motion.move)):
        scene = scenes(run.program.moves[move].tool, move)
        rows = np.flatnonzero(motion.move == move)
        deepest: _Overlap | None = None
        for first in range(0, len(rows), _CHUNK):
            part = rows[first : first + _CHUNK]
            found = scene.distances(motion.q[part], 1e-9)
            row, pair = np.unravel_index(np.argmin(found.distance), found.distance.shape)
            depth = -float(found.distance[row, pair])
            if depth >= 0.0 and (deepest is None or depth > (deepest.depth or 0.0)):
                told = depth if found.measured[row, pair] else None
                names = scene.pair_names(int(pair))
                deepest = _Overlap(move, float(motion.t[part[row]]), names, told)
        if deepest is not None:
            return deepest
    return None
