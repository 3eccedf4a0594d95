"""Accelerations where a file states none: times to full speed, as the lists of arms assume them.

exp(a + b ln m + c ln r) s of payload m kg and reach r m, fitted to the 39 arms of the maker whose
accelerations are published (``docs/reference/robots.md``).
"""

from __future__ import annotations

import math

_TIMES = (
    (-1.691, 0.214, 0.401),
    (0.043, -0.085, 0.710),
    (-0.930, 0.092, 0.282),
    (-3.288, 0.608, -0.810),
    (-3.106, 0.530, -0.486),
    (-3.701, 0.669, -0.401),
)
_SHORTEST_REACH = 0.1
SPREAD = 1.9
"""Factor within which accelerations of those arms are of these."""


def starting_times(payload: float, reach: float) -> list[float]:
    """s in which each axis comes to full speed.

    Args:
        payload: kg.
        reach: m.
    """
    m, r = math.log(payload), math.log(max(reach, _SHORTEST_REACH))
    return [math.exp(a + b * m + c * r) for a, b, c in _TIMES]
