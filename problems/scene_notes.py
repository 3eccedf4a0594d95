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
    first = {move.tool: index for index, move in reversed(list(enumerate(program.moves)))}
    looked = [scenes(tool, index) for tool, index in sorted(first.items(), key=lambda one: one[1])]
    around = [obstacle.name for scene in looked for obstacle in scene.cell.obstacles]
    notes = [note for scene in looked for note in scene.notes]
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
