"""What a user should know of the shapes that a program has been looked at with."""

from __future__ import annotations

from ..core.cell.floor import FLOOR
from ..core.collision.proof.certificate import SceneOf
from ..core.errors import Note
from ..core.program.program import Program


def scene_notes(scenes: SceneOf, program: Program) -> tuple[Note, ...]:
    """What a user should know of the shapes that a program has been looked at with.

    Args:
        scenes: the cell with each tool.
        program: whose tools count.
    """
    tools = dict.fromkeys(move.tool for move in program.moves)
    around = [obstacle.name for tool in tools for obstacle in scenes(tool).cell.obstacles]
    notes = [note for tool in tools for note in scenes(tool).notes]
    if FLOOR in around:
        notes.append(
            Note(
                "nothing is known of tools and surroundings: it is proven that the arm touches "
                f"neither itself nor {FLOOR}, and that TCPs stay above it"
            )
        )
    elif not around:
        notes.append(
            Note("nothing stands around the robot: it is proven that it does not touch itself")
        )
    return tuple(dict.fromkeys(notes))
