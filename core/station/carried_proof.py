"""Proof that a robot keeps clear of what another one turns under it, on moves made together.

The table is an axis of the robot's own there (`carried`): the proof is that of a robot in its own
cell, with what lies on the table.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..cell.cell import Cell
from ..collision.handled_scenes import scenes_along
from ..collision.mutual.carried_work import CarriedWork, Unproven
from ..collision.proof.certificate import SceneOf, certify_stretch
from ..collision.proof.verdict import Certificate
from ..collision.scene.frames import frame_of_axis
from ..collision.scene.scene import CollisionScene
from ..errors import InputError
from ..handling.handling import Handling
from ..program.tool import Tool
from .station import CarriedMoves, StationRobot


def carried_work(
    worker: StationRobot,
    carrier: StationRobot,
    handling: Handling | None,
    clearance: float,
    allowed: Sequence[tuple[str, str]],
) -> Iterator[CarriedWork]:
    """What is proven of a robot's moves on what another one turns.

    Args:
        worker, carrier: the two.
        handling: of the worker's parts.
        clearance: m that is to be kept.
        allowed: pairs of things of the worker and of the carrier that may touch.

    Raises:
        InputError: a part that is picked and placed lies on what turns.
    """
    for moves in worker.carried:
        if moves.carrier != carrier.name or not moves.blocks:
            continue
        _check_parts(carrier, moves)
        cell, things = _with_table(worker.cell, carrier.cell, moves, allowed)
        scenes = _beside(
            scenes_along(cell, handling, worker.run.program, lambda: worker.run.path, clearance),
            things,
        )
        found = []
        for block in moves.blocks:
            rows = np.isin(worker.run.path.sample_moves(), list(block))
            if not rows.any():
                continue
            sigma = worker.run.path.sigma[rows]
            span = float(sigma.min()), float(sigma.max())
            made = certify_stretch(worker.controller, worker.run, scenes, clearance, [span])
            if not made.proven:
                # Where a stretch begins and ends it touches the moves beside it.
                near = min(block) if made.move is None else made.move
                move = min(block, key=lambda own: abs(own - near))
                pair = made.pair or ("arm", ", ".join(sorted(things)))
                if pair[0].partition(" (")[0] in things:
                    pair = pair[::-1]
                times = made.time or 0.0, _passed(worker, carrier, moves, block[move], made)
                found.append(Unproven(move, pair, made.distance, times, made.message))
        frames = {frame_of_axis(carrier.cell.robot, axis) for axis in moves.axes}
        yield CarriedWork(0, frozenset(frames), moves.blocks, tuple(found))


def _passed(
    worker: StationRobot,
    carrier: StationRobot,
    moves: CarriedMoves,
    move: int,
    made: Certificate,
) -> float:
    """s of the carrier's own at which it has what it turns where a certificate says."""
    trajectory = carrier.run.trajectory
    rows = np.flatnonzero(trajectory.move == move)
    if made.configuration is None or not len(rows):
        return float(carrier.run.timing.begins()[0])
    off = np.zeros(len(rows))
    for own, copy in moves.axes.items():
        at = made.configuration[worker.cell.robot.axis_names.index(copy)]
        off += np.abs(trajectory.q[rows, carrier.cell.robot.axis_names.index(own)] - at)
    return float(trajectory.t[rows[off.argmin()]])


def _check_parts(carrier: StationRobot, moves: CarriedMoves) -> None:
    for part in carrier.cell.parts:
        if {part.carried_by, part.released_on} & set(moves.axes):
            raise InputError(
                f"{carrier.name}'s part {part.name!r} lies on what turns while another robot works "
                "on it: that is not followed; give it as an [[obstacle]] that the axis carries"
            )


def _with_table(
    own: Cell, other: Cell, moves: CarriedMoves, allowed: Sequence[tuple[str, str]]
) -> tuple[Cell, set[str]]:
    """A robot's cell with what lies on the table, and the names of that."""
    carried = {o.name: o for o in other.obstacles if o.carried_by in moves.axes}
    kept = [obstacle for obstacle in own.obstacles if obstacle.name not in carried]
    kept += [
        replace(o, carried_by=moves.axes[o.carried_by])
        for o in carried.values()
        if o.carried_by is not None
    ]
    cell = replace(own, obstacles=tuple(kept), allowed=(*own.allowed, *allowed))
    return cell, set(carried)


def _beside(scenes: SceneOf, things: set[str]) -> SceneOf:
    """Scenes in which nothing counts but how near the robot is to some things."""
    known: dict[int, tuple[CollisionScene, CollisionScene]] = {}

    def scene(tool: Tool, move: int = 0, /) -> CollisionScene:
        whole = scenes(tool, move).whole
        if id(whole) not in known:
            its = np.array([body.thing in things for body in whole.bodies], np.bool_)
            pairs = whole.pairs[its[whole.pairs].sum(axis=1) == 1]
            known[id(whole)] = whole, whole.of_pairs(pairs)
        return known[id(whole)][1]

    return scene
