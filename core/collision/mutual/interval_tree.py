"""Intervals of two motions that may come near each other, by boxes round runs of them.

Over the intervals of each robot, in the order of its path, stands a binary tree of boxes along the
world's axes, one a body. For each pair of bodies two trees are walked at once: what is farther
apart than asked for, or at other times, is left with one look.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from .swept_intervals import SweptIntervals

_ROOM = 1024


class IntervalTree(NamedTuple):
    """A tree over the first L intervals of a motion; its D nodes are in the order of a heap.

    Args:
        first, stop: (D,), the intervals below a node.
        low, high: (D, B, 3) m, boxes round the bodies.
        begin, end: (D,) s, from when to when, on the clock that both robots have.
    """

    first: IntArray
    stop: IntArray
    low: FloatArray
    high: FloatArray
    begin: FloatArray
    end: FloatArray


def interval_tree(swept: SweptIntervals, count: int, clock: FloatArray) -> IntervalTree:
    """The tree over the first ``count`` intervals.

    Args:
        swept: what is known of them.
        count: how many, at least one.
        clock: (L, 2) s, when each begins and ends.
    """
    depth = max(int(count - 1).bit_length(), 0)
    nodes, bodies = 2 ** (depth + 1), swept.low.shape[1]
    tree = IntervalTree(
        np.zeros(nodes, dtype=np.int64),
        np.zeros(nodes, dtype=np.int64),
        np.full((nodes, bodies, 3), np.inf),
        np.full((nodes, bodies, 3), -np.inf),
        np.full(nodes, np.inf),
        np.full(nodes, -np.inf),
    )
    leaves = nodes // 2
    at = slice(leaves, leaves + count)
    tree.first[leaves:] = np.minimum(np.arange(leaves), count)
    tree.stop[leaves:] = np.minimum(np.arange(1, leaves + 1), count)
    tree.low[at], tree.high[at] = swept.low[:count], swept.high[:count]
    tree.begin[at], tree.end[at] = clock[:count].T
    level = leaves
    while level > 1:
        upper = level // 2
        left, right = slice(level, 2 * level, 2), slice(level + 1, 2 * level, 2)
        own = slice(upper, level)
        tree.first[own], tree.stop[own] = tree.first[left], tree.stop[right]
        tree.low[own] = np.minimum(tree.low[left], tree.low[right])
        tree.high[own] = np.maximum(tree.high[left], tree.high[right])
        tree.begin[own] = np.minimum(tree.begin[left], tree.begin[right])
        tree.end[own] = np.maximum(tree.end[left], tree.end[right])
        level = upper
    return tree


@njit(cache=True, error_model="numpy")
def near_pairs(
    one: IntervalTree,
    other: IntervalTree,
    pairs: IntArray,
    within: float,
    apart_in_time: float,
    most: int,
) -> IntArray:
    """Pairs of intervals and bodies whose boxes are nearer than ``within`` at one time.

    Args:
        one, other: the trees.
        pairs: (P, 2), bodies of the one and of the other.
        within: m.
        apart_in_time: s by which the two may be off against each other; infinite for at any time.
        most: how many are looked for.

    Returns:
        (K, 3): interval of the one, interval of the other, row of ``pairs``.
    """
    found = np.empty((_ROOM, 3), dtype=np.int64)
    count = 0
    stack = np.empty((256, 2), dtype=np.int64)
    for k in range(pairs.shape[0]):
        a, b = pairs[k, 0], pairs[k, 1]
        stack[0, 0], stack[0, 1] = 1, 1
        left = 1
        while left > 0:
            left -= 1
            i, j = stack[left, 0], stack[left, 1]
            if one.begin[i] > other.end[j] + apart_in_time:
                continue
            if other.begin[j] > one.end[i] + apart_in_time:
                continue
            square = 0.0
            for c in range(3):
                gap = max(
                    one.low[i, a, c] - other.high[j, b, c], other.low[j, b, c] - one.high[i, a, c]
                )
                square += max(gap, 0.0) ** 2
            if not square < within * within:
                continue
            m, n = one.stop[i] - one.first[i], other.stop[j] - other.first[j]
            if m == 1 and n == 1:
                if count == most:
                    return found[:count]
                if count == found.shape[0]:
                    wider = np.empty((min(2 * count, most), 3), dtype=np.int64)
                    wider[:count] = found
                    found = wider
                found[count, 0], found[count, 1], found[count, 2] = one.first[i], other.first[j], k
                count += 1
                continue
            if m >= n:
                stack[left, 0], stack[left, 1] = 2 * i, j
                stack[left + 1, 0], stack[left + 1, 1] = 2 * i + 1, j
            else:
                stack[left, 0], stack[left, 1] = i, 2 * j
                stack[left + 1, 0], stack[left + 1, 1] = i, 2 * j + 1
            left += 2
    return found[:count]
