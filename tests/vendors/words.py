"""What the built-in vendors' languages can say, for tests that draw programs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from flyby.core.program.move import ArcOrientation, Move, MoveJ
from flyby.core.program.speed import Speed
from flyby.core.program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from flyby.core.program.zone import FINE, Angle, ContourFraction, Radius, Zone
from flyby.core.spatial.pose import IDENTITY
from flyby.testing.checks.subject import Subject
from flyby.testing.strategies import radii, tools, work_objects
from flyby.vendors.kuka.values.zone_kinds import C_VEL

HERE = Path(__file__).parent
FLOATS = st.floats(0.01, 5.0)
PERCENT = st.integers(1, 100).map(lambda percent: percent / 100)
SPHERES = radii().map(lambda zone: Radius(zone.tcp))


class AbbWords(Subject):
    """RAPID."""

    name = "abb"
    precision = 1.2e-7  # single precision
    golden = HERE / "abb" / "golden.toml"

    def said_speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        """A speeddata states all four speeds; settings state the rest."""
        share = st.integers(20, 100).map(lambda percent: percent / 100)
        return st.builds(
            Speed,
            tcp=FLOATS,
            reorientation=FLOATS,
            external_linear=FLOATS,
            external_angular=FLOATS,
            tcp_acceleration=st.none() | FLOATS,
            joint_acceleration_fraction=share,
            jerk_fraction=share,
            duration=st.none() | FLOATS,
        )

    def other_speeds(self, move: Move) -> st.SearchStrategy[Speed]:
        """``AccSet`` and ``PathAccLim`` are instructions of their own."""
        settings = ("tcp_acceleration", "joint_acceleration_fraction", "jerk_fraction")
        kept = {name: getattr(move.speed, name) for name in settings}
        return self.said_speeds(type(move)).map(lambda speed: replace(speed, **kept))


class KukaWords(Subject):
    """KRL."""

    name = "kuka"
    golden = HERE / "kuka" / "golden.toml"

    def zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        """``C_DIS`` for all, ``C_PTP`` for joint moves, ``C_ORI`` for the others."""
        spheres = SPHERES.map(lambda zone: Radius(zone.tcp, zone.tcp, zone.tcp))
        if kind is MoveJ:
            return st.just(FINE) | spheres | st.builds(ContourFraction, PERCENT)
        return st.just(FINE) | spheres

    def said_zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        """``C_ORI`` and ``C_VEL`` as well."""
        if kind is MoveJ:
            return self.zones(kind)
        angles = st.builds(Angle, st.floats(0.01, 1.0))
        return self.zones(kind) | angles | PERCENT.map(C_VEL.sized)

    def tools(self) -> st.SearchStrategy[Tool]:
        """``$TOOL`` is a frame; what the flange carries is one ``$LOAD``."""
        return st.just(FLANGE) | tools().map(lambda tool: replace(tool, load=None))

    def speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        """Shares of the axes' speeds, or speed and acceleration of the TCP."""
        if kind is MoveJ:
            shares = {"joint_fraction": PERCENT, "joint_acceleration_fraction": PERCENT}
            return st.builds(Speed, **shares)
        turn = st.integers(5, 200).map(lambda degrees: float(np.radians(degrees)))
        return st.builds(Speed, tcp=st.floats(0.01, 2.0), reorientation=turn)

    def said_speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        """Any of the parts."""
        if kind is MoveJ:
            return self.speeds(kind)
        parts = ("reorientation", "tcp_acceleration", "reorientation_acceleration")
        return st.builds(
            Speed, tcp=st.floats(0.01, 2.0), **{part: st.none() | FLOATS for part in parts}
        )

    def work_objects(self) -> st.SearchStrategy[WorkObject]:
        """A base is one frame."""
        one = work_objects().map(lambda base: replace(base, frame=IDENTITY))
        return st.just(WORLD) | one

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

    def zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        """Blend radii: position and orientation begin together."""
        return st.just(FINE) | SPHERES.map(lambda zone: Radius(zone.tcp, zone.tcp, zone.tcp))

    def speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        """The leading joint's speed and acceleration, or the TCP's."""
        if kind is MoveJ:
            return st.builds(Speed, joint=FLOATS, joint_acceleration=FLOATS)
        return st.builds(Speed, tcp=FLOATS, tcp_acceleration=FLOATS)

    def work_objects(self) -> st.SearchStrategy[WorkObject]:
        """Targets are in the base."""
        return st.just(WORLD)

    def tools(self) -> st.SearchStrategy[Tool]:
        """A TCP has no name and no weight of its own."""
        return st.just(FLANGE) | tools().map(lambda tool: replace(tool, load=None))

    def loads(self) -> st.SearchStrategy[Load | None]:
        """The payload is the flange's."""
        return st.none()

    def labelled(self, kind: type[Move]) -> bool:
        """``get_inverse_kin`` stands in joint moves only."""
        return kind is MoveJ

    def arcs(self) -> st.SearchStrategy[ArcOrientation]:
        """``movec`` takes the end's orientation in one of its modes only."""
        return st.just(ArcOrientation.FIXED_FRAME)
