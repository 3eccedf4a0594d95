"""What is odd about a station."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..results.findings import Findings
    from ..results.stations import DrivenStation


@dataclass(frozen=True)
class StationFindings:
    """Findings in the programs of a station, and of the whole.

    Args:
        driven: the station on one clock.
        robots: findings in each program.
    """

    driven: DrivenStation
    robots: Mapping[str, Findings]

    def __iter__(self) -> Iterator[str]:
        return iter(self.driven.findings())

    @property
    def errors(self) -> bool:
        """Whether something is wrong with a program, or with the station."""
        alone = any(found.errors for found in self.robots.values())
        return alone or self.driven.deadlock is not None or not self.driven.clear
