"""Whom the checks are about."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st

from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.zone import Zone
from ...core.registry import find_vendor
from ...core.vendor import Sources, Vendor
from ..strategies import speeds, zones

EXAMPLES = settings(
    max_examples=25,
    deadline=None,
    suppress_health_check=[
        HealthCheck.differing_executors,  # every vendor's class inherits the same methods
        HealthCheck.filter_too_much,
        HealthCheck.too_slow,
    ],
)
PROGRAM_EXAMPLES = settings(EXAMPLES, phases=set(Phase) - {Phase.shrink})
"""For checks that draw whole programs: to shrink one takes minutes and leaves it hardly shorter."""


class Subject:
    """The vendor under test: ``name`` is looked up among the installed plugins.

    A vendor whose language says other zones or speeds overrides `zones` and `speeds`.
    """

    name: str

    @property
    def vendor(self) -> Vendor:
        """The vendor."""
        return find_vendor(self.name)

    def zones(self) -> st.SearchStrategy[Zone]:
        """Zones that the language can say."""
        return zones()

    def speeds(self) -> st.SearchStrategy[Speed]:
        """Speeds that the language can say."""
        return speeds()

    def driven_robots(self) -> list[str]:
        """Robots that the vendor's language drives."""
        return sorted(set(self.vendor.robots) - set(self.vendor.emulation_only))

    def need(self, *parts: str) -> None:
        """Skip the check if the vendor lacks one of these parts of a language."""
        for part in parts:
            if getattr(self.vendor, part) is None:
                pytest.skip(f"{self.name} has no {part}")

    def read_back(self, sources: Sources) -> Program:
        """The program in ``sources``, read from files as a user would."""
        (main,) = (f for f in sources if f.lower().endswith(self.vendor.suffixes[0]))
        with TemporaryDirectory() as folder:
            for file, text in sources.items():
                (Path(folder) / file).write_text(text, "utf-8", newline="")
            return self.vendor.read_file(Path(folder) / main)
