"""Readers build large trees fast when nobody looks for garbage among them meanwhile."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

_MOST_BUILT = 300_000
"""Objects built since the last search among old ones, after which the next reader begins with one.

A program of 1000 lines makes some 50 000."""


class _Built:
    """What readers have built and nobody has looked through."""

    objects = 0


@contextmanager
def collection_paused() -> Iterator[None]:
    """Without the collection of cycles, which doubles the time in which large trees are built.

    What was built counts as old afterwards: the next collection does not walk through it. Nor does
    any later one, of its own accord, as Python counts only what grows old by itself; so a reader
    looks for garbage before it begins, where much was built before it.
    """
    was_enabled = gc.isenabled()
    if was_enabled and _Built.objects > _MOST_BUILT:
        gc.collect()
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
