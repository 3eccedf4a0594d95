"""Planted faults: what authors get wrong, laid round any vendor plugin, whatever its language.

A suite that stays green with a fault planted does not check that. Each `Mutant` names the checks
that must find it; `flyby.testing.conformance.PlantedFaults` runs them, for built-in vendors and
strangers alike.
"""

from __future__ import annotations

from .arms import MUTANTS as _ARMS
from .dialects import MUTANTS as _DIALECTS
from .mutant import Mutant
from .patches import MUTANTS as _PATCHES
from .statements import MUTANTS as _STATEMENTS
from .units import MUTANTS as _UNITS

MUTANTS: tuple[Mutant, ...] = (*_STATEMENTS, *_UNITS, *_DIALECTS, *_PATCHES, *_ARMS)
"""All of them."""

__all__ = ["MUTANTS", "Mutant"]
