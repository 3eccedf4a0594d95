"""What a run did, move by move: lengths, greatest speeds, how far its zones reach; and what it
covers of speeds, zones and postures, beside what its motion model was taught by."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...display import counted
from ...door import called
from ...errors import Note
from ...program.move import MoveJ
from ...program.zone import Radius
from ...robot.kinematics.chain_kernels import poses
from ..geometry.corners import POSITION
from ..geometry.corners import STOP as STOP_CORNER
from ..model.motion_model import MotionModel
from ..model.taught_range import TaughtRange, beyond
from ..path.path import Path
from ..timing.energy import loads_of
from .run import Run

_NOWHERE = 1e-4
"""m of the TCP's way, below which a move is no leg but a turn."""


def lengths_and_speeds(run: Run) -> tuple[FloatArray, FloatArray]:
    """Length of the TCP's path (M,) m and its greatest speed (M,) m/s on each segment.

    Lengths are the trapezoidal rule with its end correction: ∫f ≈ h (f₀ + f₁) / 2 + h² (f₀' −
    f₁') / 12.
    """
    states, stamp, segment = run.timing.along.states, run.timing.stamp, run.timing.interval_segments
    left = run.path.pieces.interval_samples
    spacing = run.timing.along.spacing
    velocity, acceleration = states.v[:, :3], states.a[:, :3]
    rate = np.linalg.norm(velocity, axis=1)
    moving = np.where(rate > 0.0, rate, 1.0)
    change = np.sum(velocity * acceleration, axis=1) / moving
    pieces = 0.5 * spacing * (rate[left] + rate[left + 1])
    pieces += spacing**2 / 12 * (change[left] - change[left + 1])
    speed = np.maximum(rate[left] * np.sqrt(stamp.x[:-1]), rate[left + 1] * np.sqrt(stamp.x[1:]))
    count = len(run.path.route.moves)
    lengths, tops = np.zeros(count), np.zeros(count)
    np.add.at(lengths, segment, pieces)
    np.maximum.at(tops, segment, speed)
    return lengths, tops


def zone_reaches(path: Path) -> list[tuple[float, float]]:
    """How far, m, from the waypoint at its end each segment's zone begins and ends."""
    layout = path.layout
    found = []
    for i, kind in enumerate(layout.corners.kind):
        if kind == STOP_CORNER:
            found.append((0.0, 0.0))
            continue
        before, after = layout.extent[i, POSITION]
        at = layout.waypoint[i + 1]
        entry = _distance(path, i, at - before, i)
        found.append((entry, _distance(path, i + 1, at + after, i)))
    return [*found, (0.0, 0.0)]


def _distance(path: Path, segment: int, sigma: float, corner: int) -> float:
    """m from the waypoint of a corner to the TCP at σ, in the work object of a segment."""
    route = path.route
    near = 1 if segment == corner else 0
    piece = int(np.argmin(np.abs(path.pieces.edge - sigma)))
    first = path.pieces.first_sample
    # At a boundary two samples stand for one configuration; the last one ends the piece before.
    sample = int(first[piece]) if piece < len(first) - 1 else int(first[piece]) - 1
    rows = np.stack([route.ends.q[segment, near], path.q[sample]])
    _, position = poses(route.chains[segment], np.ascontiguousarray(rows))
    return float(np.linalg.norm(position[1] - position[0]))


def range_of(run: Run) -> TaughtRange:
    """What a run covers. Its speeds begin at the lowest that its moves of the TCP are programmed
    at, as every move starts from rest or from another."""
    route = run.path.route
    lengths, tops = lengths_and_speeds(run)
    moves = [run.program.moves[k] for k in route.moves]
    slowest = [
        min(move.speed.tcp, float(tops.max()))
        for move in moves
        if not isinstance(move, MoveJ) and move.speed.tcp is not None
    ]
    zones = [move.zone.tcp for move in moves[:-1] if isinstance(move.zone, Radius)]
    driven = [zone for zone in zones if zone > 0.0]
    legs = lengths[lengths > _NOWHERE]
    known = [load.mass for load in loads_of(run.program, run.path) if load is not None]
    q = run.trajectory.q
    return TaughtRange(
        tuple(sorted({move.kind for move in moves})),
        len(driven) < len(moves) - 1,
        (min([*slowest, float(tops.max())]), float(tops.max())),
        (min(driven), max(driven)) if driven else None,
        float(legs.min()) if len(legs) else None,
        tuple(map(float, q.min(axis=0))),
        tuple(map(float, q.max(axis=0))),
        (min(known), max(known)) if known else None,
    )


def range_notes(run: Run, model: MotionModel) -> tuple[Note, ...]:
    """One note where a run leaves what its motion model was taught by; none where it does not, or
    nobody says what that was."""
    left = () if model.taught is None else beyond(model.taught, range_of(run))
    if not left:
        return ()
    return (
        Note(
            "beyond the runs that the motion model was fitted to, where it extrapolates (in "
            f"brackets what they cover): {'; '.join(left)}"
        ),
    )


def load_notes(run: Run, model: MotionModel) -> tuple[Note, ...]:
    """One note where a program carries a load of which the motion model knows nothing.

    No figure of a model depends on the load: accelerations are those of the runs that it was fitted
    to, or the catalogue's. Where those runs tell what they carried, `range_notes` speaks.
    """
    if model.taught is not None and model.taught.payload is not None:
        return ()
    moves = [(k, run.program.moves[k].load) for k in run.path.route.moves]
    carried = [(k, load.mass) for k, load in moves if load is not None and load.mass > 0.0]
    if not carried:
        return ()
    least, most = min(mass for _, mass in carried), max(mass for _, mass in carried)
    masses = f"{most:.4g} kg" if most - least < 1e-3 * most else f"{least:.4g} to {most:.4g} kg"
    return (
        Note(
            f"a payload of {masses} is carried on {counted(carried, 'move')}, here first: what "
            "acceleration owes to load the motion model does not know, so the real robot may be "
            f"slower there; fit it to logs with that load ({called('identify')})",
            carried[0][0],
        ),
    )
