"""What URScript has words for ("Script Directory": movej, movel, movec)."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...core.dialect import Dialect, Mention, MoveWords, Orientation, RoutineText, Wording
from ...core.program.zone import Radius
from .signals import SIGNALS

_BLOCKS = re.compile(
    r"\b(?P<routine>(?:def|thread|sec)\s+(?P<name>\w+)\s*\((?P<parameters>[^)]*)\))"
    r"|\b(?P<begin>if|while|for|thread|sec|def)\b|\b(?P<end>end)\b"
)


def _routines(text: str) -> Iterator[RoutineText]:
    open_blocks: list[re.Match[str]] = []
    for found in _BLOCKS.finditer(text):
        if not found["end"]:
            open_blocks.append(found)
        elif open_blocks:
            begin = open_blocks.pop()
            if begin["routine"]:
                parts = begin["name"], begin["parameters"]
                yield RoutineText(*parts, begin.start(), begin.end(), found.end())


def _named(text: str) -> Iterator[tuple[str, Mention]]:
    from .syntax.defined_names import mentions

    return mentions(text)


def _one_module(_: str) -> str:
    """All files of a program share their names."""
    return ""


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
    heads=re.compile(r"(?:if|while|for|def|thread|sec)\b[^\r\n]*?:"),
    routines=_routines,
    module=_one_module,
    named=_named,
    blocks=re.compile(
        r"\b(?:(?P<open>if|while|for|thread|sec|def)|(?P<part>elif|else)|(?P<close>end))\b"
    ),
)

_NEEDED = frozenset({"tcp", "tcp_acceleration"})
_MOST = {"joint_acceleration": 5.0}
"""rad/s². The arms have no limit of acceleration but what their torques give; this is what the
maker sets for them, "chosen conservatively to work in most use cases" (UniversalRobots/
Universal_Robots_ROS2_Driver, ur_moveit_config/config/joint_limits.yaml). 1.2 m/s² is movel's
default by the "Script Directory"."""

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
    most=_MOST,
    path_acceleration=1.2,
    wording=_WORDING,
    signals=SIGNALS,
    structure=True,
)
