"""Whom the checks are about."""

from __future__ import annotations

from hypothesis import HealthCheck, Phase, settings

from ...core.registry import find_vendor
from ...core.vendor import Vendor

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
    """The vendor under test: ``name`` is looked up among the installed plugins."""

    name: str

    @property
    def vendor(self) -> Vendor:
        """The vendor."""
        return find_vendor(self.name)
