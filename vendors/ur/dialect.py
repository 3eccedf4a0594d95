"""What URScript has words for ("Script Directory": movej, movel, movec)."""

from __future__ import annotations

import re

from ...core.dialect import Dialect, MoveWords, Orientation, Wording
from ...core.program.zone import Radius

_WORDING = Wording(
    silent=re.compile(r"#[^\r\n]*|\$[^\r\n]*|\"[^\"\r\n]*\"|'[^'\r\n]*'"),
    # PolyScope writes the joints of every waypoint beside its pose and uses one or both, and
    # features twice.
    targets=re.compile(
        r"^[ \t]*(?:global[ \t]+|local[ \t]+)?(?P<names>(?!\w*_(?:q|const)\b)[^\W\d]\w*)"
        r"[ \t]*=[ \t]*(?:p\[|\[(?:[^,\[\]]+,){5}[^,\[\]]+\])",
        re.MULTILINE,
    ),
    name=re.compile(r"[^\W\d]\w*"),
    same_case=False,
)

_NEEDED = frozenset({"tcp", "tcp_acceleration"})

URSCRIPT = Dialect(
    joint=MoveWords(
        (Radius,),
        frozenset({"joint", "joint_acceleration", "duration"}),
        frozenset({"joint", "joint_acceleration"}),
    ),
    line=MoveWords((Radius,), _NEEDED | {"duration"}, _NEEDED, configurations=False),
    arc=MoveWords((Radius,), _NEEDED, _NEEDED, configurations=False),
    pace="joint",
    comment="# ",
    work_objects=False,
    stationary_tools=False,
    external_axes=False,
    orientation=Orientation.ROTATION_VECTOR,
    in_si=True,
    rigid_arcs=True,
    share_step=0.0,
    fastest=5.0,
    wording=_WORDING,
)
