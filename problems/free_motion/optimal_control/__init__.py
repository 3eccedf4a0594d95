"""Optimal control of the free robot: how fast, and how cheaply, it could go if no program language
stood in the way.

After S. Björkenstam, D. Gleeson, R. Bohlin, J. S. Carlson and B. Lennartson, "Energy Efficient and
Collision Free Motion of Industrial Robots using Optimal Control" (CASE 2013), and D. Gleeson,
"Trajectory Optimization including Robot Controller Emulation" (thesis, Chalmers 2025), chapters 2
and 3. What it does and what it reaches stands in docs/guides/free_motion.md.
"""

from .motion.audit import Audit
from .motion.motion import Motion
from .motion.result import Optimum, SearchStep, energy_by_joint, energy_of
from .motion.scheme import SchemeKind
from .optimize import optimize
from .search.effort import MotionEffort
from .search.surroundings import Surroundings
from .task.task import ControlLimits, MotionObjective, MotionTask, TorqueLine, Waypoint

__all__ = [
    "Audit",
    "ControlLimits",
    "Motion",
    "MotionEffort",
    "MotionObjective",
    "MotionTask",
    "Optimum",
    "SchemeKind",
    "SearchStep",
    "Surroundings",
    "TorqueLine",
    "Waypoint",
    "energy_by_joint",
    "energy_of",
    "optimize",
]
