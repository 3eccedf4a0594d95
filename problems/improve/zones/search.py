"""The largest size of one zone below the first that fails, growing from nothing.

Sizes that fit need not form an interval: a larger zone may lead round the other side of a post.
So a whole range of sizes is cleared before the next one is looked at. Ranges that cannot be
cleared are halved, the lower half first, and take along only what is not clear yet: the places
and pairs of bodies. A size found to fail ends the search above it. What remains between the
largest size cleared and the smallest found to fail shrinks below `TOLERANCE` of it.

The searches of several waypoints go side by side: each is a generator that asks for paths of some
sizes and is sent them, so that all can be emulated in one go.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace

from ....core.errors import MotionError
from ..rounding import SMALLEST
from .clearing import Clearing, PathCells, Shortfall, joined
from .neighbourhood import CornerPath

TOLERANCE = 0.005
"""Share of the first failing size by which the answer may be smaller."""
FINEST = 1 / 32
"""Share of what the answer may be off, below which a range of sizes is not halved again."""
SHORTEST = 1e-7
"""Length on σ below which a cell is not cut again."""
MOST_CELLS = 4000
"""Cells beyond which cutting in σ ends: a stretch that runs along a surface within rounding of the
clearance."""

Reason = Shortfall | MotionError
Trial = CornerPath | MotionError
Asking = Generator[Sequence[float], Mapping[float, Trial], "SizeBracket"]
"""Yields sizes, is sent the paths of those sizes, returns what it found."""
Sides = tuple[Clearing, Clearing]
"""What the stretches before and behind a waypoint are looked at by."""
Open = tuple[PathCells, PathCells]
"""Cells before and behind the waypoint that are not clear."""


@dataclass(frozen=True, slots=True)
class SizeBracket:
    """What is known of the sizes of a zone.

    Args:
        size: all sizes up to this one are clear.
        fails: the smallest size known to fail, or at which nothing could be decided; None if all
            sizes up to the largest allowed are clear.
        reason: why it fails; None where nothing could be decided.
    """

    size: float
    fails: float | None = None
    reason: Reason | None = None


@dataclass(frozen=True, slots=True)
class _Range:
    """Sizes from ``low`` to ``high``, and what is not clear for all of them; None if not known."""

    low: float
    high: float
    cells: Open | None

    @property
    def middle(self) -> float:
        return 0.5 * (self.low + self.high)


class SizeSearch:
    """Searches the size of the zone at one waypoint.

    Args:
        sides: see `Sides`.
        largest: size that the rules allow.
        tolerance: see `TOLERANCE`.
    """

    def __init__(self, sides: Sides, largest: float, tolerance: float = TOLERANCE) -> None:
        self._sides = sides
        self._largest = largest
        self._tolerance = tolerance
        self._paths: dict[float, Trial] = {}

    def run(self) -> Asking:
        """The search; see `Asking`."""
        found = SizeBracket(0.0)
        ranges = [_Range(0.0, self._largest, None)]
        while ranges:
            work = ranges.pop()
            if found.fails is not None:
                gap = found.fails - work.low
                if gap <= max(self._tolerance * found.fails, SMALLEST):
                    return replace(found, size=work.low)
            if work.high - work.low <= FINEST * max(self._tolerance * work.high, SMALLEST):
                return (yield from self._undecided(work.low, work.high))
            yield from self._ask(work.low, work.middle, work.high)
            reason, cells = self._examine(work)
            outside = reason is not None and self._outside(reason, work.middle)
            # What may touch there is reached by larger zones alone: the upper half tells which.
            reached_later = outside and isinstance(reason, Shortfall) and reason.touching
            if reason is not None and not reached_later:
                if outside:
                    return SizeBracket(0.0, 0.0, reason)
                found = SizeBracket(work.low, work.middle, reason)
                ranges = [_Range(work.low, work.middle, cells)]
            elif reached_later or cells is None or any(map(len, cells)):
                ranges.append(_Range(work.middle, work.high, cells))
                ranges.append(_Range(work.low, work.middle, cells))
        if found.fails is None:
            return SizeBracket(self._largest)
        return replace(found, size=found.fails * (1 - self._tolerance))

    def _undecided(
        self, low: float, high: float
    ) -> Generator[Sequence[float], Mapping[float, Trial], SizeBracket]:
        """What is found where sizes up to ``low`` are clear, and those to ``high`` hardly so.

        That is so just before a size that fails: one a little larger tells.
        """
        for size in (high, min(max(low * (1 + self._tolerance), high), self._largest)):
            yield from self._ask(size)
            path = self._paths[size]
            if isinstance(path, MotionError):
                return SizeBracket(low, size, path)
            reason, _ = examine(self._sides, whole(path, self._sides), (), path)
            if reason is not None:
                return SizeBracket(low, size, reason)
        return SizeBracket(low, high)

    def _ask(self, *sizes: float) -> Generator[Sequence[float], Mapping[float, Trial], None]:
        wanted = [size for size in sizes if size not in self._paths]
        if wanted:
            self._paths.update((yield wanted))

    def _examine(self, work: _Range) -> tuple[Reason | None, Open | None]:
        """Why the middle fails, if it does, and the cells that are not clear."""
        low, middle, high = (self._paths[s] for s in (work.low, work.middle, work.high))
        if isinstance(middle, MotionError):
            return middle, work.cells
        if isinstance(low, MotionError) or isinstance(high, MotionError):
            return None, work.cells
        cells = whole(high, self._sides) if work.cells is None else work.cells
        return examine(self._sides, clipped(cells, high), (low, high), middle)

    def _outside(self, reason: Reason, size: float) -> bool:
        """Whether a place fails that a zone of this size, and any smaller one, leaves alone."""
        path = self._paths[size]
        if isinstance(reason, MotionError) or isinstance(path, MotionError):
            return False
        before, after = path.extent
        return not -before <= reason.sigma <= after


def examine(
    sides: Sides, cells: Open, paths: Sequence[CornerPath], middle: CornerPath
) -> tuple[Reason | None, Open]:
    """Clear cells, cutting them in σ as long as that helps.

    Args:
        sides: of the waypoint.
        cells: to be cleared.
        paths: at the ends of the range of sizes; none for a single size.
        middle: the path in its middle.

    Returns:
        Why the middle fails, if it does, and the cells that are not clear.
    """
    left: list[PathCells] = []
    for side, part in zip(sides, cells, strict=True):
        reason, rest = _examine_side(side, part, paths, middle)
        left.append(rest)
        if reason is not None:
            left += cells[len(left) :]
            return reason, (left[0], left[1])
    return None, (left[0], left[1])


def _examine_side(
    side: Clearing, cells: PathCells, paths: Sequence[CornerPath], middle: CornerPath
) -> tuple[Reason | None, PathCells]:
    kept = [cells.rows(cells.begin > cells.end)]
    while len(cells):
        look = side.look(cells, paths, middle)
        if look.shortfall is not None:
            return look.shortfall, joined([*kept, look.left])
        cut = look.left.end - look.left.begin > SHORTEST
        if len(look.left) > MOST_CELLS:
            cut[:] = False
        if paths:
            cut &= look.by_sigma
        kept.append(look.left.rows(~cut))
        cells = look.left.rows(cut).halves()
    return None, joined(kept)


def whole(path: CornerPath, sides: Sides) -> Open:
    """The cells before and behind the waypoint over a whole zone."""
    before, after = path.extent
    return sides[0].whole(-before, 0.0), sides[1].whole(0.0, after)


def clipped(cells: Open, path: CornerPath) -> Open:
    """The cells' parts inside a zone."""
    before, after = path.extent
    return cells[0].clipped(-before, 0.0), cells[1].clipped(0.0, after)
