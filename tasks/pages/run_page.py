"""The page of one driven program, and the parts that pages of several share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING

from ...core.arrays import FloatArray
from ...core.display import counted
from ...core.errors import FlybyError, Span
from ...core.program.tool import Tool, WorkObject
from ...drawing.page.arm_content import (
    PageArm,
)
from ...drawing.page.arms import Nodes, page_arm
from ...drawing.page.content import (
    Page,
    PageSource,
)
from ...drawing.page.curves import CHARTS
from ...drawing.page.nearness import page_clearance
from ...drawing.page.packing import Quantised
from ...drawing.page.parts import with_parts
from ...drawing.page.track_content import (
    PageClearance,
    PageTrack,
)
from ...drawing.page.tracks import (
    driven_curves,
    frame_node,
    page_limits,
    page_lines,
    page_motion,
    page_waypoints,
    tools_and_frames,
)
from ..setup import Setup, start_of
from .happenings import page_flags
from .program_tables import (
    faults_table,
    moves_table,
    notes_rows,
    page_moves,
    page_shares,
    time_tables,
)
from .sources import SourceList

if TYPE_CHECKING:
    from ...core.cell.cell import Cell
    from ...core.collision.proof.verdict import Certificate
    from ...core.handling.handling import Handling
    from ..results.runs import Run


@dataclass
class PageDraft:
    """The robots and tracks of a page, as they are put together.

    Args:
        arms, tracks: so far.
        sources: so far.
    """

    arms: list[PageArm] = field(default_factory=list)
    tracks: list[PageTrack] = field(default_factory=list)
    sources: SourceList = field(default_factory=SourceList)

    def drive(
        self,
        runs: Sequence[Run],
        cell: Cell | None,
        names: Sequence[str] = ("",),
        group: str = "",
        ghosts: int | None = None,
    ) -> None:
        """Add runs of one robot in one cell, each as a track.

        Args:
            runs: of one robot.
            cell: what stands around; None for nothing.
            names: of the tracks.
            group: of the tracks.
            ghosts: how many of them, the first, are drawn as ghosts; None for all but the last.

        Raises:
            InputError: a mesh cannot be used.
        """
        robot = runs[0].robot
        tools: dict[Tool, None] = {}
        frames: dict[WorkObject, None] = {}
        for run in runs:
            used = tools_and_frames(run)
            tools |= dict.fromkeys(used[0])
            frames |= dict.fromkeys(used[1])
        self.arms.append(page_arm(robot, cell, tools, frames))
        for k, (run, name) in enumerate(zip(runs, names, strict=True)):
            ghost = k < (len(runs) - 1 if ghosts is None else ghosts)
            self._track(run, cell, name, group, ghost=ghost)

    def _track(self, run: Run, cell: Cell | None, name: str, group: str, *, ghost: bool) -> None:
        index, arm_index = len(self.tracks), len(self.arms) - 1
        arm, robot, report = self.arms[arm_index], run.robot, run.report
        nodes, trajectory = Nodes.of(robot), run.trajectory
        self.sources.add(run.program, index, [move.span for move in report.moves])
        motion, channels = page_motion(trajectory, robot, driven_curves(run, robot))
        tools = [tool.name for tool in arm.tools]
        moves = [
            replace(made, node=frame_node(nodes, move.work_object))
            for made, move in zip(
                page_moves(run.program, report, self.sources, index, tools),
                run.program.moves,
                strict=True,
            )
        ]
        handling = handling_in(run, cell)
        arm, parts = with_parts(arm, nodes, robot, handling, cell)
        self.arms[arm_index] = arm
        self.tracks.append(
            PageTrack(
                name,
                arm_index,
                run.duration,
                motion,
                moves,
                channels,
                page_limits(run, robot),
                page_lines(run, nodes),
                page_waypoints(run, nodes),
                page_flags(run.program, report, trajectory, self.sources, index),
                _clearance(run, cell, handling),
                parts,
                ghost=ghost,
                group=group,
            )
        )

    def meet(self, first: int, times: FloatArray) -> None:
        """Say when tracks are at the same places.

        Args:
            first: index of the first of R tracks.
            times: (W, R) s, of each its own, never falling.
        """
        for track, own in enumerate(times.T, first):
            self.tracks[track] = replace(self.tracks[track], meets=Quantised(own, 1e-4))

    def prove(self, track: int, proof: Certificate, run: Run, cell: Cell) -> None:
        """Lay the proof of a run on its track."""
        from ...drawing.page.proofs import page_proof

        handling = handling_in(run, cell)
        parts = None
        if handling is not None and proof.move is not None:
            parts = handling.arrangements[proof.move]
        told = page_proof(proof, cell, run.program, parts)
        self.tracks[track] = replace(self.tracks[track], proof=told)

    def files(self) -> list[PageSource]:
        """The source files."""
        return self.sources.made


def handling_in(run: Run, cell: Cell | None) -> Handling | None:
    """What a run does to the parts of its cell; None where there are none."""
    if cell is None or not cell.parts:
        return None
    from ...core.handling.handling import handling_of

    return handling_of(run.program, cell, start_of(run.program))


def _clearance(run: Run, cell: Cell | None, handling: Handling | None) -> PageClearance | None:
    if cell is None:
        return None
    from ...core.collision.clearance import ClearanceMeter

    try:
        meter = ClearanceMeter(cell, run.program, handling)
        paths = [(part.run.path, part.first) for part in run.parts]
        return page_clearance(meter, paths, run.trajectory, cell.clearance)
    except FlybyError:
        return None  # The report says why clearances are not known.


def cell_of(run: Run) -> Cell | None:
    """The cell that a program was read for; None where no file says what stands around."""
    setup = run.program.setup
    return setup.cell if isinstance(setup, Setup) else None


def made_by() -> str:
    """Name and version of this program."""
    try:
        return f"flyby {version('flyby')}"
    except PackageNotFoundError:
        return "flyby"


def run_page(run: Run, kind: str = "emulate", spans: Sequence[Span | None] = ()) -> Page:
    """The page of a driven program.

    Args:
        run: as `flyby.emulate` gives it.
        kind: what was done.
        spans: further places in the source that the page shows.

    Raises:
        InputError: a mesh cannot be used.
    """
    draft = PageDraft()
    draft.drive([run], cell_of(run))
    draft.sources.add(run.program, 0, spans)
    report = run.report
    tables = [
        *time_tables(run, draft.sources, 0),
        moves_table(report, draft.sources, 0),
        faults_table(report, draft.sources, 0),
        *notes_rows(report.notes, report, draft.sources, 0),
    ]
    return Page(
        f"{run.program.name} on {run.robot.name}",
        kind,
        facts_of(run),
        page_shares(run.program, report),
        draft.arms,
        draft.tracks,
        draft.files(),
        [table for table in tables if table is not None],
        CHARTS,
        notes=fault_notes(run),
        made_by=made_by(),
    )


def fault_notes(run: Run) -> list[str]:
    """A sentence where moves cannot be driven."""
    if not run.faults:
        return []
    first = run.faults[0]
    line = "" if first.span is None else f", line {first.span.line}"
    return [
        f"{counted(run.faults, 'move')} cannot be driven, the first is move {first.move + 1}{line} "
        f"({first.cause}): no time is claimed across them, see Faults"
    ]


def facts_of(run: Run) -> dict[str, str]:
    """Figures at the top of the page."""
    report = run.report
    facts = {}
    if report.faults:
        facts["driven"] = f"{report.driven_time:.3f} s"
        facts["faults"] = str(len(report.faults))
    else:
        assert report.cycle_time is not None
        facts["cycle time"] = f"{report.cycle_time:.3f} s"
        if round(report.cycle_time - report.driven_time, 6):
            facts["with the way to its loop"] = f"{report.driven_time:.3f} s"
    if report.time_range is not None and report.time_range[0] != report.time_range[1]:
        least, most = report.time_range
        facts["with assumed figures"] = f"{least:.2f} to {most:.2f} s"
    facts["moves"] = str(len(report.moves))
    facts["path"] = f"{report.length:.3f} m"
    facts["top speed"] = f"{1e3 * report.top_speed:.0f} mm/s"
    if report.to_cell is not None:
        facts["clearance to the cell"] = (
            "touches" if report.to_cell.overlaps else f"{1e3 * report.to_cell.distance:.1f} mm"
        )
    return facts
