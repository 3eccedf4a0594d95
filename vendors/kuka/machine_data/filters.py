"""The filter of set-points: ``$DEF_FLT_CP`` of moves of the TCP, ``$DEF_FLT_PTP`` of joint moves.

Its length is stated, in ms, and multiples of 12; how it smooths is not published. It is taken for
two moving averages over half of it each: with the 96 ms that machine data of small arms state all
six logged runs of a KR 3 are met better than without
(``docs/measurements/identification.md``).
"""

from __future__ import annotations

from typing import Any

from ....core.errors import InputError
from ..data_list import DataList

FILTERS = {"time.smoothing_s": "$DEF_FLT_CP", "time.joint_smoothing_s": "$DEF_FLT_PTP"}
"""By the figures of a motion file."""
LONGEST = 1000.0
"""ms; archives state 96 to 216."""


def filters(data: DataList) -> dict[str, tuple[Any, str]]:
    """What a ``$machine.dat`` says of them: figures of motion files, with their origins."""
    found: dict[str, tuple[Any, str]] = {}
    for key, name in FILTERS.items():
        try:
            length = data.number(name) if data.has(name) else 0.0
        except InputError:
            continue
        if 0.0 < length <= LONGEST:
            said = f"assumed: {data.name}: {name}, {length:g} ms, as two averages of half of it"
            found[key] = ([5e-4 * length] * 2, said)
    return found
