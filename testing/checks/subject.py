"""Whom the checks are about."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

import pytest
from hypothesis import HealthCheck, Phase, find, settings
from hypothesis import strategies as st

from ...core.language import Sources
from ...core.program.move import ArcOrientation, Move
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget, PoseTarget, Target
from ...core.program.tool import Load, Tool, WorkObject
from ...core.program.zone import Zone
from ...core.registry import find_vendor
from ...core.robot.joint import JointKind
from ...core.robot.model import Robot
from ...core.source.patch.edits import TOLERANCE
from ...core.vendor import Vendor
from ..strategies import (
    OfKind,
    Parts,
    Value,
    loads,
    programs,
    speeds,
    tools,
    work_objects,
    zones,
)

EXAMPLES = settings(
    max_examples=25,
    deadline=None,
    suppress_health_check=[
        HealthCheck.differing_executors,  # every vendor's class inherits the same methods
        HealthCheck.filter_too_much,
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
    ],
)
PROGRAM_EXAMPLES = settings(EXAMPLES, phases=set(Phase) - {Phase.shrink})
"""For checks that draw whole programs: to shrink one takes minutes and leaves it hardly shorter."""


def _made_once(make: OfKind[Value]) -> OfKind[Value]:
    """A strategy for each kind of move: to make one takes longer than to draw from it."""
    made: dict[type[Move], st.SearchStrategy[Value]] = {}

    def strategy(kind: type[Move]) -> st.SearchStrategy[Value]:
        if kind not in made:
            made[kind] = make(kind)
        return made[kind]

    return strategy


class Subject:
    """The vendor under test: ``name`` is looked up among the installed plugins.

    A vendor whose language says other things than these overrides what differs: `zones`, `speeds`
    (programs are driven with them), `said_zones`, `said_speeds` (and written with these),
    `other_speeds`, `aims`, `tools`, `work_objects`, `loads`, `arcs`, `labelled`.
    """

    name: str
    precision = TOLERANCE
    """How near the language's numbers come back, as a share and in m, rad, s."""
    comment: str | None = None
    """What a line of comment begins with, if the language has comments."""
    periods: tuple[float, ...] = (0.024, 0.12)
    """s between samples of a log that the controllers take."""

    @property
    def vendor(self) -> Vendor:
        """The vendor."""
        return find_vendor(self.name)

    def zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        """Zones of a kind of move that the language can say and the robots drive."""
        return zones()

    def speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        """Speeds, likewise."""
        return speeds()

    def said_zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        """All zones that the language can say."""
        return self.zones(kind)

    def said_speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        """All speeds that the language can say."""
        return self.speeds(kind)

    def other_speeds(self, move: Move) -> st.SearchStrategy[Speed]:
        """What a patch can put in the place of a move's speed: what settings say of it stays."""
        return self.said_speeds(type(move))

    def aims(self) -> st.SearchStrategy[type[Target]]:
        """What joint moves may end at."""
        return st.sampled_from([JointTarget, PoseTarget])

    def tools(self) -> st.SearchStrategy[Tool]:
        """Tools that the language can say."""
        return tools()

    def work_objects(self) -> st.SearchStrategy[WorkObject]:
        """Work objects that the language can say."""
        return work_objects()

    def loads(self) -> st.SearchStrategy[Load | None]:
        """Loads that the language can say."""
        return st.none() | loads()

    def arcs(self) -> st.SearchStrategy[ArcOrientation]:
        """How the tool turns along arcs."""
        return st.sampled_from(ArcOrientation)

    def labelled(self, kind: type[Move]) -> bool:
        """Whether the language states the configurations of a kind of move's targets."""
        return True

    def parts(self) -> Parts:
        """What the language's programs are made of."""
        return Parts(
            _made_once(self.said_zones),
            _made_once(self.said_speeds),
            self.aims(),
            self.tools(),
            self.work_objects(),
            self.loads(),
            self.labelled,
            self.arcs(),
        )

    @cache  # noqa: B019 - a suite is as short-lived as its test
    def programs(self, robot: Robot) -> st.SearchStrategy[Program]:
        """Programs that the language can say."""
        return programs(robot, self.vendor.label, self.parts())

    def sample(self) -> tuple[Robot, Sources]:
        """A robot and the sources of a short program, always the same."""
        robot = self.vendor.robot(self.driven_robots()[0])
        quiet = settings(PROGRAM_EXAMPLES, database=None, phases=[Phase.generate])
        found = find(
            self.programs(robot), lambda p: len(p.moves) > 2, settings=quiet, random=Random(1)
        )
        return robot, self.vendor.write(found, robot)

    def driven_robots(self) -> list[str]:
        """Robots that the vendor's language drives."""
        return sorted(set(self.vendor.robots) - set(self.vendor.emulation_only))

    def need(self, *parts: str) -> None:
        """Skip the check if the vendor lacks one of these parts of a language."""
        for part in parts:
            if getattr(self.vendor, part) is None:
                pytest.skip(f"{self.name} has no {part}")

    def read_back(self, sources: Sources, robot: Robot | None = None) -> Program:
        """The program in ``sources``, read from files as a user would.

        Of an arm with an axis that slides no text says whether its values are mm or degrees: the
        reader gets the robot then, and none otherwise.
        """
        slides = robot is not None and any(j.kind is JointKind.PRISMATIC for j in robot.joints)
        texts = {file: text.encode() for file, text in sources.items()}
        return self.read_bytes(texts, robot if slides else None)

    def read_bytes(self, sources: dict[str, bytes], robot: Robot | None = None) -> Program:
        """The program in files of these bytes; the first that the reader takes is the main one."""
        main = next(f for f in sources if f.lower().endswith(self.vendor.suffixes))
        with TemporaryDirectory() as folder:
            for file, data in sources.items():
                (Path(folder) / file).write_bytes(data)
            return self.vendor.read_file(Path(folder) / main, robot=robot)
