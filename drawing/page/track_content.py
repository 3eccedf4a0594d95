"""A motion on a page, as plain data: SI units, times its own, from 0."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ...core.arrays import FloatArray
from .packing import Quantised


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
        begin, end: s, when it is driven, waits at its end left out; both None where it is not.
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
        begins, ends: s between which it is this arm's; None for all the time. Before, and from
            then on, it is another's.
    """

    name: str
    shape: int
    places: Sequence[PagePlace]
    begins: float | None = None
    ends: float | None = None


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
        takes: s that are said beside its name where these are not its duration; None where they
            are.
        meets: (W,) s, never falling, at which it is where the others of its group are at theirs;
            None where they run by the clock alone.
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
    takes: float | None = None
    meets: Quantised | None = None
