"""The energy of a program: `pareto` and `optimize_energy`, through the emulator."""

from .front import Front, FrontPoint
from .options import EnergyTask, Goal, Progress, Scope
from .pareto import optimize_energy, pareto

__all__ = [
    "EnergyTask",
    "Front",
    "FrontPoint",
    "Goal",
    "Progress",
    "Scope",
    "optimize_energy",
    "pareto",
]
