"""Readers build large trees fast when nobody looks for garbage among them meanwhile."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

_MOST_BUILT = 300_000
"""Objects built since the last search among old ones, after which the next reader begins with one.

A program of 1000 lines makes some 50 000."""
_AT_MOST = 16
"""Times as many, where searches find next to nothing: of most runs nothing is left."""
_WORTH = 0.1
"""Share of what was built that a search finds, from which on it was worth its time."""


class _Built:
    """What readers have built and nobody has looked through."""

    objects = 0
    patience = 1


@contextmanager
def collection_paused() -> Iterator[None]:
    """Without the collection of cycles, which doubles the time in which large trees are built.

    What was built counts as old afterwards: the next collection does not walk through it. Nor does
    any later one, of its own accord, as Python counts only what grows old by itself; so a reader
    looks for garbage before it begins, where much was built before it.
    """
    was_enabled = gc.isenabled()
    if was_enabled and _Built.objects > _MOST_BUILT * _Built.patience:
        worth = gc.collect() > _WORTH * _Built.objects
        _Built.patience = 1 if worth else min(2 * _Built.patience, _AT_MOST)
        _Built.objects = 0
    gc.disable()
    begun = gc.get_count()[0]
    try:
        yield
    finally:
        _Built.objects += max(0, gc.get_count()[0] - begun)
        if gc.get_freeze_count() == 0:
            gc.freeze()
            gc.unfreeze()
        if was_enabled:
            gc.enable()
