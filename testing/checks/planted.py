"""Checks of the checks: a fault that is planted in the plugin is found by those that must."""

from __future__ import annotations

import pytest

from ..mutants import MUTANTS, Mutant
from .subject import Subject
from .telling import told


class PlantedFaults(Subject):
    """Each planted fault is found: the golden texts say enough of the language."""

    @pytest.mark.parametrize("mutant", MUTANTS, ids=str)
    def test_a_planted_fault_is_found(self, mutant: Mutant) -> None:
        self.need("reader", "writer")
        if self.golden is None or not mutant.needs(self):
            pytest.skip(f"{self.name} has nothing that this is about")
        suite = type(self)()
        suite.__dict__["vendor"] = mutant.plant(self.vendor)
        for check in mutant.found_by:
            try:
                getattr(suite, check)()
            except (AssertionError, ExceptionGroup):
                continue
            except pytest.skip.Exception as skipped:
                raise AssertionError(f"{mutant.name}: {check} is skipped: {skipped}") from skipped
            raise AssertionError(
                told(
                    f"{self.name}, with a fault planted ({mutant.name}), passes {check}: nothing "
                    "in the golden file shows the difference",
                    lines=[f"what would: {mutant.bites}"],
                )
            )
