"""The energy of a program: `pareto` and `optimize_energy`, through the emulator."""

from .front import Front, FrontPoint
from .options import EnergyScope, EnergyTask, Goal
from .pareto import optimize_energy, pareto

__all__ = [
    "EnergyScope",
    "EnergyTask",
    "Front",
    "FrontPoint",
    "Goal",
    "optimize_energy",
    "pareto",
]
