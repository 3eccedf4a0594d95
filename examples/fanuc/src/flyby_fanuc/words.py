"""The words of TP's motions and positions."""

from __future__ import annotations

import math

from flyby.core.dialect import Orientation
from flyby.core.program.zone import ZoneKind
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import FrameRegisters
from flyby.core.source.lines.motions import MotionWords
from flyby.core.source.lines.positions import PositionForm
from flyby.core.source.lines.postures import PostureLetters

CNT = ZoneKind("CNT")
"""The next move begins when braking has come down to a share of the speed."""
CR = ZoneKind("CR", None, largest=1.0, unit=1e-3, step=1e-3)
"""Distances before and behind the point, mm."""
_SECONDS = {"sec": Amount("duration", 1.0), "msec": Amount("duration", 1e-3)}
MOTION = MotionWords(
    joint={**_SECONDS, "%": Amount("joint_fraction", 0.01)},
    line={
        **_SECONDS,
        "mm/sec": Amount("tcp", 1e-3),
        "cm/min": Amount("tcp", 1e-2 / 60),
        "inch/min": Amount("tcp", 0.0254 / 60),
        "deg/sec": Amount("reorientation", math.radians(1)),
    },
    zones={"CNT": CNT, "CR": CR},
    unstated="max_speed",
    share="ACC{number}",
    motion="{kind} {via}{point} {speed} {zone} {share}",
)
XYZ = PositionForm(Orientation.EULER_ZYX, last_first=True)
FRAMES = FrameRegisters(
    XYZ, "UTOOL", "UFRAME", "framevar.va of the controller's backup", ("UTOOL_NUM", "UFRAME_NUM")
)
LETTERS = PostureLetters(wrist="NF", elbow="UD", shoulder="TB", turning=(3, 4, 5))
"""``CONFIG : 'N U T, 0, 0, 0'``: no flip is J5 below zero; the order of the turns is that of
FANUC's remote motion interface (``Turn4, Turn5, Turn6``)."""
