"""Figures that no log shows, as an engineer calls them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ...identification.fit.intervals import Unseen

_JOINTS = {"limit.joint_acceleration_scale": "acceleration limit"}
"""By key, what is one of each joint."""
_WHOLE = {
    "limit.tcp_acceleration": "the TCP's acceleration limit",
    "limit.blend_acceleration": "the acceleration limit in zones",
    "limit.reorientation_acceleration": "the limit of the tool's angular acceleration",
    "limit.centripetal": "the centripetal limit",
}
_INDEXED = re.compile(r"([\w.]+)\[(\d+)(:?)(\d*)\]")


def reached(name: str, axes: Sequence[str]) -> str | None:
    """What a motion does not reach that a limit does not hold back; None of other figures.

    Args:
        name: of the figure, as `--fit` takes it.
        axes: names of the robot's axes.
    """
    if name in _WHOLE:
        return _WHOLE[name]
    found = _INDEXED.fullmatch(name)
    key = found[1] if found else name
    if key not in _JOINTS:
        return None
    if not found:
        return f"the joints' {_JOINTS[key]}s"
    first = int(found[2])
    last = first + 1 if not found[3] else int(found[4]) if found[4] else len(axes)
    chosen = list(axes[first:last])
    if len(chosen) == 1:
        return f"{chosen[0]}'s {_JOINTS[key]}"
    return f"the {_JOINTS[key]}s of {', '.join(chosen)}"


def unseen_said(one: Unseen, axes: Sequence[str]) -> str:
    """Why a figure stays as it was, in a sentence."""
    limit = reached(one.name, axes) if one.unused else None
    if limit is not None:
        return f"these logs never reach {limit}; it stays as it was ({one.name})"
    return f"{one.name} is not identifiable: {one.reason}; it stays as it was"
