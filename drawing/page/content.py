"""What a page shows, as plain data: `flyby.drawing.page.html` makes the file of it.

Units are SI; the page itself shows mm and degrees. Times of a track are its own, from 0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from ...core.arrays import FloatArray
from .packing import Quantised

PageCell = str | float | None
"""Of a table: text, or a number in the unit of its column; None is empty."""


class PageRole(StrEnum):
    """What a body is, which says how it is drawn and what switches it off."""

    LINK = "link"
    TOOL = "tool"
    OBSTACLE = "obstacle"
    PART = "part"
    FLOOR = "floor"


@dataclass(frozen=True)
class PageNode:
    """A frame that things ride on.

    Args:
        name: of the axis, or of what the frame is.
        parent: its index among the arm's nodes, before this one; -1 for the world.
        place: (4, 4), of the frame in its parent's with the axis at zero.
        value: index of the axis in a configuration; -1 where it stands still.
        axis: unit axis in the frame itself.
        slides: whether the axis is a linear one.
    """

    name: str
    parent: int
    place: FloatArray
    value: int = -1
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    slides: bool = False


@dataclass(frozen=True)
class PageMesh:
    """Triangles.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3), indices of them.
    """

    vertices: Quantised
    faces: Quantised


@dataclass(frozen=True)
class PageSolid:
    """A simple solid.

    Args:
        kind: ``box``, ``sphere``, ``cylinder`` or ``capsule``; the latter two along z.
        size: m; edges of a box, radius and length of the others.
    """

    kind: str
    size: tuple[float, ...]


@dataclass(frozen=True)
class PageBody:
    """A solid on a node.

    Args:
        name: that the user knows it by.
        role: what it is.
        node: that carries it.
        place: (4, 4), in the node's frame.
        shape: of it.
        tool: name of the tool with which it is mounted; empty where it is always there.
    """

    name: str
    role: PageRole
    node: int
    place: FloatArray
    shape: PageSolid | PageMesh
    tool: str = ""


@dataclass(frozen=True)
class PageAxis:
    """An axis of a configuration, with what its motion is a percentage of.

    Args:
        name: of it.
        linear: whether its values are m, not rad.
        lower, upper, velocity, acceleration: its limits.
        effort: N m or N; None where not known.
    """

    name: str
    linear: bool
    lower: float
    upper: float
    velocity: float
    acceleration: float
    effort: float | None


@dataclass(frozen=True)
class PageFrame:
    """A frame by its name: a work object, or a tool's centre point.

    Args:
        name: of it.
        node: that carries it.
        place: (4, 4), in the node's frame.
    """

    name: str
    node: int
    place: FloatArray


@dataclass(frozen=True)
class PageArm:
    """A robot with all that rides on it, and the cell round it.

    Args:
        name: of the robot.
        nodes: carriers before what they carry; the first is the world.
        axes: of its configurations.
        bodies: links, tools, obstacles.
        tools: centre points; the first is the flange.
        frames: work objects.
        flange: node of the flange.
    """

    name: str
    nodes: Sequence[PageNode]
    axes: Sequence[PageAxis]
    bodies: Sequence[PageBody]
    tools: Sequence[PageFrame]
    frames: Sequence[PageFrame]
    flange: int


@dataclass(frozen=True)
class PageMotion:
    """Joints over time: cubics that meet position and speed at K knots.

    Args:
        t: (K,) s, never falling; two knots at one time stand round a gap.
        q, dq: (K, N), each axis by itself.
    """

    t: Quantised
    q: Sequence[Quantised]
    dq: Sequence[Quantised]


@dataclass(frozen=True)
class PageChannel:
    """A curve over the knots of a motion, linear between them.

    Args:
        name: of the curve.
        chart: key of the chart that shows it.
        values: (K,), in the chart's unit; not a number where there is none.
        stepped: whether it keeps its value up to the next knot.
        axis: index of the axis whose it is; None for the whole.
    """

    name: str
    chart: str
    values: Quantised
    stepped: bool = False
    axis: int | None = None


@dataclass(frozen=True)
class PageChart:
    """A plot.

    Args:
        key: that channels name.
        title: above it.
        unit: of its values.
        span: lowest and highest value to show at least; None to fit the curves.
    """

    key: str
    title: str
    unit: str
    span: tuple[float, float] | None = None


@dataclass(frozen=True)
class PageMove:
    """A move, as the page names it.

    Args:
        number: from 1.
        label: kind and target.
        source: index of its file; -1 for none.
        line: from 1; 0 where it has none.
        tool: index of the tool among the arm's.
        node: that carries its work object: the path is drawn there.
        begin, end: s, when it is driven, waits at its end included; both None where it is not.
        fault: whether it cannot be driven.
    """

    number: int
    label: str
    source: int = -1
    line: int = 0
    tool: int = 0
    node: int = 0
    begin: float | None = None
    end: float | None = None
    fault: bool = False


@dataclass(frozen=True)
class PageLimits:
    """What limits the speed when.

    Args:
        names: of the limits, each once.
        begin, end: (R,) s.
        which: (R,), indices of names.
    """

    names: Sequence[str]
    begin: Quantised
    end: Quantised
    which: Quantised


@dataclass(frozen=True)
class PageLine:
    """A line in space.

    Args:
        node: that carries it.
        points: (P, 3) m.
        move: index of the move; -1 for none.
    """

    node: int
    points: Quantised
    move: int = -1


@dataclass(frozen=True)
class PageWaypoints:
    """Where moves end, with their zones.

    Args:
        nodes: (W,), what carries the frame that each is given in.
        points: (W, 3) m in the nodes' frames.
        radius: (W,) m, of the zone as driven; 0 at stops.
        moves: (W,), index of the move that ends there; -1 for the start.
    """

    nodes: Quantised
    points: Quantised
    radius: Quantised
    moves: Quantised


@dataclass(frozen=True)
class PageFlag:
    """Something that happens at a time: a wait, an output, an event.

    Args:
        kind: ``wait``, ``device``, ``statement`` or ``event``.
        text: as the source has it, or in words.
        t: s.
        duration: s; 0 for a moment.
        source, line: where it stands; -1 and 0 for nowhere.
    """

    kind: str
    text: str
    t: float
    duration: float = 0.0
    source: int = -1
    line: int = 0


@dataclass(frozen=True)
class PageClearance:
    """How near the arm comes to the cell, at T times.

    Args:
        t: (T,) s.
        distance: (T,) m; not a number where all is farther than was looked.
        first, second: (T, 3) m in the world, the nearest points.
        pair: (T,), indices of pairs.
        pairs: names of the two bodies.
        wanted: m, what the cell wants to be kept.
    """

    t: Quantised
    distance: Quantised
    first: Quantised
    second: Quantised
    pair: Quantised
    pairs: Sequence[tuple[str, str]]
    wanted: float = 0.0


@dataclass(frozen=True)
class PagePlace:
    """Where a part is from a move on.

    Args:
        move: index of the first move.
        node: that carries it.
        place: (4, 4), in the node's frame.
        gone: whether it has left the cell.
    """

    move: int
    node: int
    place: FloatArray
    gone: bool = False


@dataclass(frozen=True)
class PagePart:
    """A part that is handled.

    Args:
        name: of it.
        shape: index of the body that is drawn for it.
        places: from move to move.
    """

    name: str
    shape: int
    places: Sequence[PagePlace]


@dataclass(frozen=True)
class PageProof:
    """Where a proof is tightest, or fails.

    Args:
        proven: whether it holds.
        text: in a sentence.
        t: s, where; None for nowhere.
        pair: names of the two bodies.
        first, second: their nearest points, m in the world; None where not known.
    """

    proven: bool
    text: str
    t: float | None = None
    pair: tuple[str, str] | None = None
    first: tuple[float, float, float] | None = None
    second: tuple[float, float, float] | None = None


@dataclass(frozen=True)
class PageTrack:
    """One motion of one arm.

    Args:
        name: such as ``before``; empty where there is but one.
        arm: index of the arm.
        duration: s.
        motion: joints over time.
        moves: that it is of; empty for a log.
        channels: curves over its knots.
        limits: what limits it.
        programmed: the programmed path.
        waypoints: with their zones.
        flags: what happens on the way.
        clearance: to the cell.
        parts: that are handled.
        proof: of it.
        ghost: whether it is drawn as a ghost beside the solid one of its group.
        group: tracks of one group are shown together.
        tool: index of the tool among the arm's where there are no moves.
    """

    name: str
    arm: int
    duration: float
    motion: PageMotion
    moves: Sequence[PageMove] = ()
    channels: Sequence[PageChannel] = ()
    limits: PageLimits | None = None
    programmed: Sequence[PageLine] = ()
    waypoints: PageWaypoints | None = None
    flags: Sequence[PageFlag] = ()
    clearance: PageClearance | None = None
    parts: Sequence[PagePart] = ()
    proof: PageProof | None = None
    ghost: bool = False
    group: str = ""
    tool: int = 0


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
    """

    title: str
    columns: Sequence[PageColumn]
    rows: Sequence[PageRow]
    note: str = ""


@dataclass(frozen=True)
class PageShare:
    """A piece of the bar at the top: what the cycle goes into.

    Args:
        name: such as ``motion``.
        seconds: of it.
    """

    name: str
    seconds: float


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
    """

    node: int
    mesh: PageMesh
    thickness: Quantised
    target: float
    tolerance: float
    strokes: Quantised | None = None


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
class Page:
    """All of a page.

    Args:
        title: of it.
        kind: what was done: ``emulate``, ``zones``, ….
        facts: figures at the top, by name.
        shares: what the cycle goes into.
        arms: robots with their cells.
        tracks: motions; the last one that is no ghost is shown first.
        sources: files.
        tables: below the source.
        charts: plots, by their order.
        coat: paint.
        front: to pick from.
        together: times at which tracks pass the same waypoint, s, a row a waypoint and a column a
            track; None where tracks run by the clock alone.
        notes: sentences that the reader should not miss.
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
    together: Quantised | None = None
    notes: Sequence[str] = ()
    made_by: str = ""
