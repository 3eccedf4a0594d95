"""Searches at many waypoints side by side: trials of one round are emulated in one go."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress

from ....core.program.zone import Zone
from .neighbourhood import Neighbourhoods
from .search import Asking, SizeBracket, Trial

ZoneOf = Callable[[float], Zone]
"""The zone of a size."""
SIDE_BY_SIDE = 128
"""Searches that go on at a time: each keeps the paths that it has asked for."""


def drive(
    trials: Neighbourhoods,
    searches: Mapping[int, Asking],
    zones: Mapping[int, ZoneOf],
    tell: Callable[[int], None] = lambda done: None,
) -> dict[int, SizeBracket]:
    """Run searches to their ends, or until the user interrupts them.

    Args:
        trials: emulates single corners.
        searches: by corner.
        zones: what a size means, by corner.
        tell: called with the number of searches that have ended, whenever it grows.

    Returns:
        What was found; after an interrupt (`KeyboardInterrupt`) of the searches that had ended.
    """
    found: dict[int, SizeBracket] = {}
    corners = list(searches)
    with suppress(KeyboardInterrupt):
        for first in range(0, len(corners), SIDE_BY_SIDE):
            part = corners[first : first + SIDE_BY_SIDE]
            _drive(trials, {corner: searches[corner] for corner in part}, zones, found, tell)
    return found


def _drive(
    trials: Neighbourhoods,
    running: dict[int, Asking],
    zones: Mapping[int, ZoneOf],
    found: dict[int, SizeBracket],
    tell: Callable[[int], None],
) -> None:
    asked: dict[int, Sequence[float]] = {}
    answers: dict[int, Mapping[float, Trial]] = {}
    while running:
        for corner, search in list(running.items()):
            try:
                asked[corner] = search.send(answers[corner]) if answers else next(search)
            except StopIteration as end:
                found[corner] = end.value
                del running[corner]
                tell(len(found))
        answers = _answered(trials, zones, {corner: asked[corner] for corner in running})


def _answered(
    trials: Neighbourhoods, zones: Mapping[int, ZoneOf], asked: Mapping[int, Sequence[float]]
) -> dict[int, Mapping[float, Trial]]:
    wanted = [(corner, size) for corner, sizes in asked.items() for size in sizes]
    paths = trials.paths([(corner, zones[corner](size)) for corner, size in wanted])
    answers: dict[int, dict[float, Trial]] = {corner: {} for corner in asked}
    for (corner, size), path in zip(wanted, paths, strict=True):
        answers[corner][size] = path
    return dict(answers)
