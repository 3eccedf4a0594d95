"""A painting made executable: program, coat as emulated, proof."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....core.arrays import FloatArray
from ....core.collision.proof.certificate import certify, scenes_of
from ....core.collision.proof.verdict import CONTACT, Certificate
from ....core.collision.scene.scene import CollisionScene
from ....core.errors import Note
from ....core.motion.emulator.controller import Controller
from ....core.program.program import Program
from ...reading_back import ReadBack
from ...scene_notes import scene_notes
from ..coating.coat import Coat
from ..coating.deposition import Deposition
from ..painting import Painting, PaintingStage
from ..spray.trajectory import PaintTrajectory
from ..surface.part import Part
from .emulated import EmulatedPainting, drive
from .feedback import Execution, Progress, drive_evenly, judged
from .lag import lag_notes
from .spin import Clear, GunPosture, choose_posture
from .station import Station
from .writing import DriveOptions, with_run_in

_BUDGET = 400_000
"""Distances measured for the proof: a minute's worth. Usually some thousand are enough."""


@dataclass(frozen=True, eq=False)
class Executable:
    """A program that paints.

    Args:
        program: as read from its text.
        planned: the trajectory that it drives, run-in included, in the part's frame.
        posture: how the robot holds the gun at its waypoints.
        driven: the gun's motion as emulated.
        coat: that it leaves, on all of the part.
        rounds: standard deviation (m) of the coat as emulated in each round of correction, on the
            points of the optimisation.
        certificate: that the robot keeps its clearance; None where no proof was asked for.
        notes: what the emulator has to say.
    """

    program: Program
    planned: PaintTrajectory
    posture: GunPosture
    driven: EmulatedPainting
    coat: Coat
    rounds: tuple[float, ...]
    certificate: Certificate | None
    notes: tuple[Note, ...]


def execute(
    painting: Painting,
    station: Station,
    options: DriveOptions,
    speed: tuple[float, float],
    *,
    read_back: ReadBack = lambda program: program,
    prove: bool = True,
    progress: Progress | None = None,
) -> Executable:
    """The program of a painting for a robot, corrected until the coat as emulated is even.

    Args:
        painting: what to execute.
        station: robot, gun and place.
        options: zones, run-in, outputs.
        speed: least and largest programmed speed, m/s.
        read_back: the program as it is read from its text.
        prove: whether to prove that robot and gun keep the cell's clearance, from the part too.
        progress: see `drive_evenly`.

    Raises:
        MotionError: the robot cannot reach a stretch of the curve, or cannot drive it.
        InputError: the language cannot say what the gun needs.
    """
    controller = Controller(station.vendor, station.cell.robot)
    planned = with_run_in(painting.best, options.run_in)
    coarse, judge = painting.coarse, painting.judge
    clear = _clear_of(judge.part, station) if prove else _anything
    posture = choose_posture(planned, station, clear)
    made: Execution = drive_evenly(
        controller,
        planned,
        posture,
        station,
        options,
        coarse.deposition,
        coarse.target,
        speed,
        coarse.visible(planned),
        progress,
    )
    program = replace(read_back(made.program), start=made.program.start)
    driven = drive(controller, program, made.planned, station)
    finely = Deposition(judge.part.samples, judge.footprint, subpoints=1)
    found = judged(finely, driven, judge.target, judge.visible(made.planned))
    late = lag_notes(
        made.planned, np.diff(driven.passed), found, painting.coats[PaintingStage.FULL]
    )
    notes = (*_told(driven), *late)
    certificate = None
    if prove:
        names = {move.tool.name for move in program.moves}
        cell = station.with_part(judge.part, names).cell
        scenes = scenes_of(cell)
        certificate = certify(controller, driven.run, scenes, cell.clearance, budget=_BUDGET)
        notes = (*scene_notes(scenes, program), *notes)
    return Executable(
        program,
        made.planned,
        posture,
        driven,
        found,
        made.rounds,
        certificate,
        notes,
    )


def _clear_of(part: Part, station: Station) -> Clear:
    """Whether robot and gun keep the cell's clearance, from the part too."""
    cell = station.with_part(part, (station.gun.name,)).cell
    scene = CollisionScene(cell, station.gun)
    wanted = max(cell.clearance, CONTACT)
    return lambda joints: bool((scene.clearance(joints, within=wanted) >= wanted).all())


def _anything(joints: FloatArray) -> bool:
    return True


def _told(driven: EmulatedPainting) -> tuple[Note, ...]:
    """The emulator's notes, without places in a text that is not the user's yet; the first move
    only makes sure where the robot begins."""
    return tuple(
        replace(note, span=None)
        for note in driven.notes
        if not (note.move == 0 and "goes nowhere" in note.message)
    )
