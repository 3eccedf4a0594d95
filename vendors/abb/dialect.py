"""What RAPID has words for ("RAPID Reference Manual": speeddata, zonedata, AccSet, PathAccLim)."""

from __future__ import annotations

import re

from ...core.dialect import Dialect, MoveWords, OutputWords, Wording
from ...core.program.zone import Radius

_SPEEDS = frozenset(
    {
        "tcp",
        "reorientation",
        "external_linear",
        "external_angular",
        "tcp_acceleration",
        "joint_acceleration_fraction",
        "jerk_fraction",
        "duration",
    }
)

_WORDING = Wording(
    silent=re.compile(r'![^\r\n]*|"[^"\r\n]*"'),
    targets=re.compile(
        r"\b(?:const|pers|var)\s+(?:robtarget|jointtarget)\s+(?P<names>\w+)", re.IGNORECASE
    ),
    name=re.compile(r"[^\W\d]\w*"),
)

_MOVE = MoveWords((Radius,), _SPEEDS, frozenset({"tcp"}))


def _zones() -> tuple[Radius, ...]:
    """z0 to z200; imported late, since it takes time."""
    from .rapid.predefined import ZONES, zone

    found = (zone(name) for name in ZONES)
    return tuple(one for one in found if isinstance(one, Radius))


_OUTPUTS = OutputWords(
    switch=lambda name, on: f"{name},{int(on)}",
    level=lambda name, value: f"\\AOp:={name},{value:.6g}",
    longest_lead=0.5,  # TriggIO \Time
)

RAPID = Dialect(
    joint=_MOVE,
    line=_MOVE,
    arc=_MOVE,
    pace="tcp",
    comment="! ",
    zone_parts=True,
    user_frames=True,
    least_acceleration_share=0.2,
    fastest=7.0,
    zones=_zones,
    wording=_WORDING,
    outputs=_OUTPUTS,
)
