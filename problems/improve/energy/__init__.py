"""The energy of a program: `pareto` and `optimize_energy`, through the emulator."""

from .front import Front, Point
from .options import Goal, Progress, Scope, Task
from .pareto import optimize_energy, pareto

__all__ = [
    "Front",
    "Goal",
    "Point",
    "Progress",
    "Scope",
    "Task",
    "optimize_energy",
    "pareto",
]
