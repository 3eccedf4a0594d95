"""Readers that run one after the other leave no garbage behind for good."""

from __future__ import annotations

import gc
import weakref

import pytest

from flyby.core.source import collection
from flyby.core.source.collection import collection_paused


class Node:
    """A part of a tree that knows its neighbour, and so is in a circle."""

    def __init__(self) -> None:
        self.own = self


def test_garbage_of_many_readers_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(collection, "_MOST_BUILT", 2000)
    alive: list[weakref.ref[Node]] = []
    most = 0
    for _ in range(60):
        with collection_paused():
            nodes = [Node() for _ in range(200)]
        alive.append(weakref.ref(nodes[0]))
        del nodes
        most = max(most, sum(ref() is not None for ref in alive))
    assert most < 30


def test_collection_stays_as_it_was() -> None:
    assert gc.isenabled()
    with pytest.raises(KeyError), collection_paused():
        assert not gc.isenabled()
        raise KeyError
    assert gc.isenabled()
    gc.disable()
    try:
        with collection_paused():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()
