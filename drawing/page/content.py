"""What a page shows, as plain data: `flyby.drawing.page.html` makes the file of it.

Units are SI; the page itself shows mm and degrees.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from .arm_content import PageArm, PageMesh
from .packing import Quantised
from .track_content import PageChart, PageTrack

PageCell = str | float | None
"""Of a table: text, or a number in the unit of its column; None is empty."""


@dataclass(frozen=True)
class PageSource:
    """A source file.

    Args:
        name: of it.
        text: of it.
        track: index of the track that runs it.
    """

    name: str
    text: str
    track: int = 0


@dataclass(frozen=True)
class PageColumn:
    """A column of a table.

    Args:
        title: heading.
        unit: of its numbers; empty for text.
        digits: decimals of its numbers.
        bar: whether numbers are drawn as bars, too.
    """

    title: str
    unit: str = ""
    digits: int = 0
    bar: bool = False


@dataclass(frozen=True)
class PageRow:
    """A row of a table, and where a click on it leads.

    Args:
        cells: one a column.
        level: ``error``, ``warning`` or ``note``; empty for none.
        track, t: a time on a track, s.
        move: index of the move that the row is of: marked while that is driven.
        source, line: a place in the source; -1 and 0 for none.
    """

    cells: Sequence[PageCell]
    level: str = ""
    track: int = 0
    t: float | None = None
    move: int | None = None
    source: int = -1
    line: int = 0


@dataclass(frozen=True)
class PageTable:
    """A table; columns sort, rows are found by text.

    Args:
        title: of its tab.
        columns: of it.
        rows: of it.
        note: a sentence above it.
        track: index of the track beside which alone it is shown; -1 for all.
    """

    title: str
    columns: Sequence[PageColumn]
    rows: Sequence[PageRow]
    note: str = ""
    track: int = -1


@dataclass(frozen=True)
class PageShare:
    """A piece of the bar at the top: what the cycle goes into.

    Args:
        name: such as ``motion``.
        seconds: of it.
        track: index of the track beside which alone it is shown; -1 for all.
    """

    name: str
    seconds: float
    track: int = -1


@dataclass(frozen=True)
class PageGrowth:
    """How a coat builds up.

    Args:
        times: (K + 1,) s.
        laid: (P, K) whole steps that each interval of time lays on each point that is to be
            painted, in the order of the vertices.
        step: m.
    """

    times: Quantised
    laid: Quantised
    step: float


@dataclass(frozen=True)
class PageSpray:
    """Where the gun sprays while it is on.

    Args:
        times: (T,) s.
        nozzle: (T, 3) unit vectors in the world.
        reach: m, from the TCP.
        radius: of the cone there, m.
    """

    times: Quantised
    nozzle: Quantised
    reach: float
    radius: float


@dataclass(frozen=True)
class PageCoat:
    """Paint on a part.

    Args:
        node: that carries the part.
        mesh: of it.
        thickness: (V,) m at its vertices; not a number where nothing is to be painted.
        target: m.
        tolerance: share of the target within which it is as it should be.
        strokes: (S, 2) s, when the gun is on.
        growth: the coat as time runs; None where only its end is known.
        spray: the cone.
    """

    node: int
    mesh: PageMesh
    thickness: Quantised
    target: float
    tolerance: float
    strokes: Quantised | None = None
    growth: PageGrowth | None = None
    spray: PageSpray | None = None


@dataclass(frozen=True)
class PagePoint:
    """A point of a front.

    Args:
        x, y: in the units of its axes.
        name: of it.
        track: index of the track that drives it; -1 where none is on the page.
    """

    x: float
    y: float
    name: str
    track: int = -1


@dataclass(frozen=True)
class PageFront:
    """Points between two objectives.

    Args:
        x, y: names of the axes, with units.
        points: of it.
    """

    x: str
    y: str
    points: Sequence[PagePoint]


@dataclass(frozen=True)
class PageBar:
    """A stretch of time in a row of a chart.

    Args:
        kind: ``move``, ``wait``, ``meeting``, ``device`` or ``on``.
        begin, end: s.
        text: what it is.
        source, line: where it stands; -1 and 0 for nowhere.
    """

    kind: str
    begin: float
    end: float
    text: str = ""
    source: int = -1
    line: int = 0


@dataclass(frozen=True)
class PageBars:
    """A row of a chart over time (Gantt chart).

    Args:
        name: of the robot or signal.
        bars: in their order.
        track: index of the robot's track; -1 for a signal.
    """

    name: str
    bars: Sequence[PageBar]
    track: int = -1


@dataclass(frozen=True)
class Page:
    """All of a page.

    Args:
        title: of it.
        kind: what was done: ``emulate``, ``zones``, ….
        facts: figures at the top, by name.
        shares: what the cycle goes into.
        arms: robots with their cells.
        tracks: motions.
        sources: files.
        tables: below the source.
        charts: plots, by their order.
        coat: paint.
        front: to pick from.
        gantt: who does what when, a row each, where several robots share one clock.
        notes: sentences that the reader should not miss.
        chosen: index of the track that is shown first; -1 for the last one that is no ghost.
        made_by: the program's name and version.
    """

    title: str
    kind: str
    facts: Mapping[str, str] = field(default_factory=dict)
    shares: Sequence[PageShare] = ()
    arms: Sequence[PageArm] = ()
    tracks: Sequence[PageTrack] = ()
    sources: Sequence[PageSource] = ()
    tables: Sequence[PageTable] = ()
    charts: Sequence[PageChart] = ()
    coat: PageCoat | None = None
    front: PageFront | None = None
    gantt: Sequence[PageBars] = ()
    notes: Sequence[str] = ()
    chosen: int = -1
    made_by: str = ""
