"""The page of a translated program: the old robot as a ghost beside the new one."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ...core.errors import FlybyError
from ...core.translation.translate import Translation
from ...drawing.page.content import (
    Page,
    PageColumn,
    PageRow,
    PageTable,
)
from ...drawing.page.curves import CHARTS
from ..emulate import EmulateOptions, emulate_with
from ..files.texts import read_again
from ..setup import setup_of_program
from .meetings import meeting_times
from .program_tables import moves_table, page_shares, time_tables
from .run_page import PageDraft, cell_of, fault_notes, made_by

if TYPE_CHECKING:
    from ...core.language import Sources
    from ...core.program.program import Program
    from ...core.spatial.pose import Pose

_LOSSES = (PageColumn("line before"), PageColumn("could not be carried over"))


def translation_page(
    made: Translation, place: Pose | None = None, sources: Sources | None = None
) -> Page:
    """The page of a translated program.

    Args:
        made: the translation.
        place: the new robot's world in the old one's; None if both are the same.
        sources: text of the new program by file name; None for none.

    Raises:
        FlybyError: one of the programs cannot be driven.
    """
    before = emulate_with(made.original, EmulateOptions())
    read = _read_back(made, sources)
    after = emulate_with(read, EmulateOptions())
    draft = PageDraft()
    draft.drive([before], cell_of(before), ["before"], ghosts=1)
    draft.drive([after], None, ["after"])
    if place is not None:
        arm = draft.arms[1]
        world = replace(arm.nodes[0], place=place.matrix())
        draft.arms[1] = replace(arm, nodes=[world, *arm.nodes[1:]])
    runs = [before, after]
    draft.meet(0, meeting_times(runs))
    old, new = before.duration, after.duration
    lost = []
    for note in made.losses:
        source, line = draft.sources.place(0, note.span)
        at = float(line) if line else None
        lost.append(PageRow((at, note.message), "warning", 0, None, note.move, source, line))
    tables = [
        *([PageTable("Losses", _LOSSES, lost)] if lost else []),
        *(table for k, run in enumerate(runs) for table in time_tables(run, draft.sources, k)),
        *(moves_table(run.report, draft.sources, k) for k, run in enumerate(runs)),
    ]
    robots = [setup_of_program(p).robot.name for p in (made.original, made.program)]
    return Page(
        f"{made.original.name}: {robots[0]} → {robots[1]}",
        "translate",
        {
            "cycle time": f"{old:.3f} → {new:.3f} s",
            "change": f"{100 * (new / old - 1):+.1f} %",
            "not carried over": str(len(made.losses)),
        },
        [s for k, run in enumerate(runs) for s in page_shares(run.program, run.report, k)],
        draft.arms,
        draft.tracks,
        draft.files(),
        tables,
        CHARTS,
        notes=fault_notes(after),
        made_by=made_by(),
    )


def _read_back(made: Translation, sources: Sources | None) -> Program:
    """The new program as its text says it, so that its moves have lines; else as it was made."""
    setup = setup_of_program(made.program)
    if sources is not None:
        try:
            return replace(read_again(setup, sources), setup=setup)
        except FlybyError:
            pass  # Code around it is missing here that its robot has.
    return replace(made.program, start=made.program.start or made.start)
