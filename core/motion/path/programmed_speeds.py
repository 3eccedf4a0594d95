"""Programmed speeds along a route."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...program.program import Program
from ...program.speed import Speed
from .path import Route


def programmed(speeds: Sequence[Speed]) -> dict[str, Any]:
    """What `Ends` have of the speeds of M moves: (M,) each, inf where none is; shares."""
    return {
        "speed": _or_inf([v.tcp for v in speeds]),
        "acceleration": _or_inf([v.tcp_acceleration for v in speeds]),
        "joint_speed": _or_inf([v.joint for v in speeds]),
        "joint_acceleration": _or_inf([v.joint_acceleration for v in speeds]),
        "duration": _or_inf([v.duration for v in speeds]),
        "joint_fraction": np.array([v.joint_fraction for v in speeds]),
        "joint_acceleration_fraction": np.array([v.joint_acceleration_fraction for v in speeds]),
        "override": np.array([v.acceleration_override for v in speeds]),
    }


def with_programmed(route: Route, program: Program) -> Route:
    """The same way with the speeds that a program's moves have now."""
    ends = replace(route.ends, **programmed([program.moves[i].speed for i in route.moves]))
    return replace(route, ends=ends)


def _or_inf(values: Sequence[float | None]) -> FloatArray:
    return np.array([math.inf if value is None else value for value in values])
