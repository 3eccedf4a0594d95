"""FANUC passes the conformance suite."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from flyby_fanuc.plugin import fanuc
from flyby_fanuc.words import CR
from hypothesis import strategies as st

from flyby.core.program.move import Move
from flyby.core.program.speed import Speed
from flyby.core.program.zone import VendorZone, Zone
from flyby.testing.conformance import VendorConformance

MM = st.integers(1, 40).map(lambda mm: mm / 1000)


class TestFanuc(VendorConformance):
    name = "fanuc"
    vendor = fanuc()  # type: ignore[assignment]
    golden = Path(__file__).parent / "golden.toml"
    periods = (0.008, 0.024)

    def zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        """``CR5,10`` goes on behind the point."""
        return super().zones(kind) | st.builds(VendorZone, st.just(CR), MM, st.just(2.0))

    def said_zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        return self.zones(kind)

    def other_speeds(self, move: Move) -> st.SearchStrategy[Speed]:
        """ACC is neither put in nor taken out."""
        own = move.speed.acceleration_override
        return self.said_speeds(type(move)).map(lambda s: replace(s, acceleration_override=own))
