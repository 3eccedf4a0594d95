"""Arcs that the controller drives."""

from __future__ import annotations

import math

from ....core.dialect import ArcRules

ARCS = ArcRules(math.radians(240), 1e-4, math.radians(1), "MoveC")
"""Limits that RobotComponents checks for (PathGenerator): they follow the controller's own error
messages for circles that are too small or too long."""
