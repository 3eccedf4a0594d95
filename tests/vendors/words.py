"""What the built-in vendors' languages can say beyond, or short of, what their dialects tell."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from hypothesis import strategies as st

from flyby.core.program.move import Move, MoveJ
from flyby.core.program.speed import Speed
from flyby.core.program.tool import FLANGE, Load, Tool
from flyby.core.program.zone import Zone
from flyby.testing.checks.subject import Subject
from flyby.testing.strategies import tools
from flyby.vendors.kuka.zone_kinds import C_VEL

HERE = Path(__file__).parent
FLOATS = st.floats(0.01, 5.0)
PERCENT = st.integers(1, 100).map(lambda percent: percent / 100)


class AbbWords(Subject):
    """RAPID."""

    name = "abb"
    precision = 1.2e-7  # single precision
    golden = HERE / "abb" / "golden.toml"

    def said_speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        """A speeddata states all four speeds; settings state the rest."""
        four = ("tcp", "reorientation", "external_linear", "external_angular")
        values = dict.fromkeys(four, FLOATS) | {"duration": st.none() | FLOATS}
        stated = st.fixed_dictionaries(values)
        settings = super().said_speeds(kind)
        return st.builds(lambda speed, values: replace(speed, **values), settings, stated)

    def other_speeds(self, move: Move) -> st.SearchStrategy[Speed]:
        """``AccSet`` and ``PathAccLim`` are instructions of their own."""
        settings = ("tcp_acceleration", "joint_acceleration_fraction", "jerk_fraction")
        kept = {name: getattr(move.speed, name) for name in settings}
        return self.said_speeds(type(move)).map(lambda speed: replace(speed, **kept))


class KukaWords(Subject):
    """KRL."""

    name = "kuka"
    golden = HERE / "kuka" / "golden.toml"

    def said_zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        """``C_VEL`` as well, which no translation asks for."""
        if kind is MoveJ:
            return super().said_zones(kind)
        return super().said_zones(kind) | PERCENT.map(C_VEL.sized)

    def tools(self) -> st.SearchStrategy[Tool]:
        """``$TOOL`` is a frame; what the flange carries is one ``$LOAD``."""
        return st.just(FLANGE) | tools().map(lambda tool: replace(tool, load=None))

    def loads(self) -> st.SearchStrategy[Load | None]:
        """There is one load, that of the tool."""
        return st.none()

    def labelled(self, kind: type[Move]) -> bool:
        """S and T do not count along LIN and CIRC."""
        return kind is MoveJ


class UrWords(Subject):
    """URScript."""

    name = "ur"
    golden = HERE / "ur" / "golden.toml"

    def tools(self) -> st.SearchStrategy[Tool]:
        """A TCP has no name and no weight of its own."""
        return st.just(FLANGE) | tools().map(lambda tool: replace(tool, load=None))

    def loads(self) -> st.SearchStrategy[Load | None]:
        """The payload is the flange's."""
        return st.none()
