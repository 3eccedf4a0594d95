"""FANUC passes the conformance suite."""

from __future__ import annotations

from dataclasses import replace

from flyby_fanuc.dialect import CNT, CR
from flyby_fanuc.plugin import fanuc
from hypothesis import strategies as st

from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import Move, MoveJ
from flyby.core.program.speed import Speed
from flyby.core.program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from flyby.core.program.zone import FINE, VendorZone, Zone
from flyby.testing.conformance import VendorConformance
from flyby.testing.strategies import tools, work_objects

PERCENT = st.integers(1, 100)
OVERRIDE = st.sampled_from([1.0, 0.5, 0.8])


class TestFanuc(VendorConformance):
    name = "fanuc"
    vendor = fanuc()  # type: ignore[assignment]
    periods = (0.008, 0.024)

    def zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        sized = st.builds(
            VendorZone,
            st.just(CR),
            st.integers(1, 40).map(lambda mm: mm / 1000),
            st.sampled_from([1.0, 2.0]),
        )
        return st.just(FINE) | PERCENT.map(lambda p: CNT.sized(p / 100)) | sized

    def speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        if kind is MoveJ:
            return st.builds(
                Speed, joint_fraction=PERCENT.map(lambda p: p / 100), acceleration_override=OVERRIDE
            )
        return st.builds(
            Speed, tcp=st.integers(50, 2000).map(lambda v: v / 1000), acceleration_override=OVERRIDE
        )

    def said_speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        timed = st.builds(Speed, duration=st.integers(1, 50).map(lambda v: v / 10))
        if kind is MoveJ:
            hard = self.speeds(kind).map(lambda s: replace(s, acceleration_override=1.5))
            return self.speeds(kind) | timed | hard
        turns = st.builds(Speed, reorientation=st.floats(0.1, 3.0))
        return self.speeds(kind) | timed | turns | st.just(Speed())

    def other_speeds(self, move: Move) -> st.SearchStrategy[Speed]:
        """ACC is neither put in nor taken out."""
        own = move.speed.acceleration_override
        return self.said_speeds(type(move)).map(lambda s: replace(s, acceleration_override=own))

    def tools(self) -> st.SearchStrategy[Tool]:
        return st.just(FLANGE) | tools().map(lambda tool: Tool(tool.name, tool.tcp))

    def work_objects(self) -> st.SearchStrategy[WorkObject]:
        return st.just(WORLD) | work_objects().map(lambda frame: WorkObject(frame.name, frame.pose))

    def loads(self) -> st.SearchStrategy[Load | None]:
        return st.none()

    def arcs(self) -> st.SearchStrategy[ArcOrientation]:
        return st.just(ArcOrientation.FIXED_FRAME)
