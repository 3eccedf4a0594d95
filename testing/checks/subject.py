"""Whom the checks are about."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, cached_property
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, find, settings
from hypothesis import strategies as st

from ...core.dialect import SignalWords
from ...core.errors import FlybyError
from ...core.language import Sources
from ...core.program.arc_orientation import ArcOrientation
from ...core.program.move import Move, MoveC, MoveJ, MoveL, Opaque
from ...core.program.program import Program
from ...core.program.signal import SetSignal, SignalAction
from ...core.program.speed import Speed
from ...core.program.target import JointTarget, PoseTarget, Target
from ...core.program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from ...core.program.zone import Zone, ZoneKind
from ...core.registry import find_vendor
from ...core.robot.joint import JointKind
from ...core.robot.model import Robot
from ...core.source.execution.answers import Answers
from ...core.source.patch.edits import TOLERANCE, difference
from ...core.source.write.approach import with_approach
from ...core.spatial.pose import IDENTITY
from ...core.vendor import Vendor
from ..golden import Golden, GoldenRobot, GoldenText
from ..said import (
    DRIVEN_ZONES,
    arcs_in,
    events_in,
    kinds_in,
    speeds_in,
    with_events,
    words_of,
    zones_in,
)
from ..strategies import (
    OfKind,
    Parts,
    Value,
    allowed,
    is_regular,
    loads,
    programs,
    speeds,
    tools,
    work_objects,
    zones,
)
from .telling import line_of, text_of, told

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
    golden: str | Path | None = None
    """TOML file of the golden texts (`flyby.testing.golden`)."""
    comment: str | None = None
    """What a line of comment begins with, if the language has comments and no `Dialect`."""
    precision = TOLERANCE
    """How near the language's numbers come back, as a share and in m, rad, s."""
    periods: tuple[float, ...] = (0.024, 0.12)
    """s between samples of a log that the controllers take."""

    @cached_property
    def vendor(self) -> Vendor:
        """The vendor."""
        return find_vendor(self.name)

    @property
    def comment_sign(self) -> str | None:
        """What a line of comment begins with; None if that is not known."""
        spoken = self.vendor.speaks
        return self.comment if spoken is None else spoken.comment.strip()

    @property
    def signals(self) -> SignalWords | None:
        """How statements on signals are understood."""
        return None if self.vendor.speaks is None else self.vendor.speaks.signals

    @cached_property
    def _golden(self) -> Golden:
        return Golden() if self.golden is None else Golden.read(self.golden)

    @property
    def golden_texts(self) -> tuple[GoldenText, ...]:
        """Texts with what they mean by their author's knowledge."""
        return self._golden.texts

    @property
    def golden_refused(self) -> tuple[GoldenText, ...]:
        """Texts that are refused, by their author's knowledge."""
        return self._golden.refused

    @property
    def golden_robots(self) -> tuple[GoldenRobot, ...]:
        """Numbers of data sheets."""
        return self._golden.robots

    @property
    def golden_none(self) -> frozenset[str]:
        """What the language has no words for, by the golden texts' author."""
        return self._golden.none

    def zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        """Zones of a kind of move that the language can say and the robots drive."""
        spoken = self.vendor.speaks
        if spoken is None:
            return zones()
        kinds = words_of(spoken, kind).zones
        driven = (one for one in kinds if isinstance(one, ZoneKind) or one in DRIVEN_ZONES)
        return zones_in(spoken, tuple(driven))

    def speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        """Speeds, likewise."""
        spoken = self.vendor.speaks
        return speeds() if spoken is None else speeds_in(spoken, words_of(spoken, kind), True)

    def said_zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        """All zones that the language can say."""
        spoken = self.vendor.speaks
        if spoken is None:
            return self.zones(kind)
        return zones_in(spoken, words_of(spoken, kind).zones)

    def said_speeds(self, kind: type[Move]) -> st.SearchStrategy[Speed]:
        """All speeds that the language can say."""
        spoken = self.vendor.speaks
        return self.speeds(kind) if spoken is None else speeds_in(spoken, words_of(spoken, kind))

    def other_speeds(self, move: Move) -> st.SearchStrategy[Speed]:
        """What a patch can put in the place of a move's speed: what settings say of it stays."""
        return self.said_speeds(type(move))

    def aims(self) -> st.SearchStrategy[type[Target]]:
        """What joint moves may end at."""
        return st.sampled_from([JointTarget, PoseTarget])

    def tools(self) -> st.SearchStrategy[Tool]:
        """Tools that the language can say."""
        spoken = self.vendor.speaks
        if spoken is None:
            return tools()
        if not spoken.tools:
            return st.just(FLANGE)
        return tools().map(lambda one: one if spoken.loads else replace(one, load=None))

    def work_objects(self) -> st.SearchStrategy[WorkObject]:
        """Work objects that the language can say."""
        spoken = self.vendor.speaks
        if spoken is None or spoken.user_frames:
            return work_objects()
        if not spoken.work_objects:
            return st.just(WORLD)
        return work_objects().map(lambda one: replace(one, frame=IDENTITY))

    def loads(self) -> st.SearchStrategy[Load | None]:
        """Loads that the language can say."""
        spoken = self.vendor.speaks
        return st.none() if spoken is not None and not spoken.loads else st.none() | loads()

    def arcs(self) -> st.SearchStrategy[ArcOrientation]:
        """How the tool turns along arcs."""
        spoken = self.vendor.speaks
        return st.sampled_from(ArcOrientation) if spoken is None else arcs_in(spoken)

    @property
    def kinds(self) -> tuple[type[Move], ...]:
        """The kinds of move that the language can say."""
        spoken = self.vendor.speaks
        kinds = (MoveJ, MoveL, MoveC) if spoken is None else kinds_in(spoken)
        return tuple(kind for kind in kinds if kind.__name__ not in self.golden_none)

    def labelled(self, kind: type[Move]) -> bool:
        """Whether the language states the configurations of a kind of move's targets."""
        spoken = self.vendor.speaks
        return spoken is None or words_of(spoken, kind).configurations

    def acting(self, move: Move) -> st.SearchStrategy[Move]:
        """A move with events that the language can say."""
        outputs = None if self.vendor.speaks is None else self.vendor.speaks.outputs
        name = self.signal_name(SetSignal("", True))
        drawn = events_in(outputs, name)
        return drawn.map(lambda events: with_events(move, events, outputs))

    def kept(self) -> st.SearchStrategy[Opaque] | None:
        """Statements that are kept as text: those of the golden texts; None if there are none."""
        found = [
            replace(statement, span=None)
            for text in self.golden_texts
            for statement in self.read_golden(text).statements
            if isinstance(statement, Opaque)
        ]
        return st.sampled_from(found) if found else None

    def signal_name(self, action: SignalAction) -> str:
        """What a signal of an action may be called."""
        if self.signals is None:
            return "5"
        shown = self.signals.example(action).replace("?", "5")
        return self.signals.spelt(shown) or shown

    @cache  # noqa: B019 - a suite is as short-lived as its test
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
            self.acting,
            self.kept(),
        )

    @cache  # noqa: B019 - a suite is as short-lived as its test
    def programs(self, robot: Robot) -> st.SearchStrategy[Program]:
        """Programs that the language can say."""
        return programs(robot, self.vendor.label, self.parts(), kinds=self.kinds)

    @cached_property
    def usual_robot(self) -> Robot:
        """One that the language drives."""
        return self.vendor.robot(self.driven_robots()[0])

    @cached_property
    def stand(self) -> tuple[float, ...]:
        """Joints of the usual robot away from limits and singular postures."""
        robot = self.usual_robot
        lower, upper = robot.limits.lower, robot.limits.upper
        shares = np.random.default_rng(1)
        for _ in range(1000):
            q = allowed(robot, lower + shares.uniform(0.35, 0.65, robot.size) * (upper - lower))
            if is_regular(robot, q) and ((lower < q) & (q < upper)).all():
                return tuple(float(value) for value in q)
        raise AssertionError(f"{robot.name}: no regular posture near the middle of its ranges")

    def sample(self) -> tuple[Robot, Sources]:
        """A robot and the sources of a short program, always the same."""
        robot = self.usual_robot
        quiet = settings(PROGRAM_EXAMPLES, database=None, phases=[Phase.generate])
        found = find(
            self.programs(robot), lambda p: len(p.moves) > 2, settings=quiet, random=Random(1)
        )
        return robot, self.vendor.write(found, robot)

    def read_golden(self, text: GoldenText) -> Program:
        """A golden text as the plugin reads it."""
        try:
            return self.read_files(text)
        except FlybyError as error:
            look = "the reader: the text runs on a controller, by its author"
            what = f"{self.name}: golden text {text.about!r} cannot be read: {error}"
            raise AssertionError(told(what, look=look)) from error

    def read_files(self, text: GoldenText) -> Program:
        """The program in the files of a golden text.

        Raises:
            FlybyError: it cannot be read.
        """
        robot = None if text.robot is None else self.vendor.robot(text.robot)
        with TemporaryDirectory() as folder:
            for file, said in text.files.items():
                (Path(folder) / file).write_text(said, "utf-8")
            main = Path(folder) / next(iter(text.files))
            return self.vendor.read_file(main, text.entry, robot, Answers(values=text.answers))

    def written(self, program: Program, robot: Robot) -> Sources:
        """The program as texts; that they are refused when they are read again is a failure."""
        try:
            return self.vendor.write(program, robot)
        except FlybyError as error:
            shown = "\n".join(map(repr, program.statements))
            look = "the writer: what it cannot say, `Dialect` should not speak of"
            raise AssertionError(
                told(f"{self.name}: not written: {error}", written=shown, look=look)
            ) from error

    def check_same(
        self, program: Program, again: Program, sources: Sources, robot: Robot | None = None
    ) -> None:
        """Fail where what was written is read as another program."""
        wanted = program if robot is None else said(program, self.vendor, robot, again)
        found = difference(replace(wanted, start=None), again, self.precision)
        if found is None:
            return
        index, part = found
        if index < 0:
            raise AssertionError(
                told(
                    f"{self.name}: what was written comes back otherwise: {part}",
                    written="\n".join(map(repr, wanted.statements)),
                    read="\n".join(map(repr, again.statements)),
                    look="statements",
                    lines=[text_of(sources)],
                )
            )
        one, other = wanted.moves[index], again.moves[index]
        name = part.replace(" ", "_")
        raise AssertionError(
            told(
                f"{self.name}: move {index + 1} comes back with another {part}",
                written=f"{one!r}: {getattr(one, name, '')}",
                read=f"{other!r}: {getattr(other, name, '')}\nfrom {line_of(sources, other)}",
                look=part,
            )
        )

    def driven_robots(self) -> list[str]:
        """Robots that the vendor's language drives."""
        return sorted(set(self.vendor.robots) - set(self.vendor.emulation_only))

    def need(self, *parts: str) -> None:
        """Skip the check if the vendor lacks one of these parts of a language."""
        for part in parts:
            if getattr(self.vendor, part) is None:
                pytest.skip(f"{self.name} has no {part}")

    def read_back(
        self, sources: Sources, robot: Robot | None = None, vendor: Vendor | None = None
    ) -> Program:
        """The program in ``sources``, read from files as a user would.

        Of an arm with an axis that slides no text says whether its values are mm or degrees, of one
        with an arm angle none which axis is the seventh, and where numbers are shares of what an
        arm can do, none says how much: the reader gets the robot then, and none otherwise.
        """
        asked = robot is not None and (
            robot.arm_angle_reference is not None
            or getattr(self.vendor.reader, "depends", False)
            or any(j.kind is JointKind.PRISMATIC for j in robot.joints)
        )
        texts = {file: text.encode() for file, text in sources.items()}
        return self.read_bytes(texts, robot if asked else None, vendor)

    def read_bytes(
        self, sources: dict[str, bytes], robot: Robot | None = None, vendor: Vendor | None = None
    ) -> Program:
        """The program in files of these bytes; the first that the reader takes is the main one.

        Args:
            vendor: that reads them; None for the one under test.
        """
        vendor = vendor or self.vendor
        main = next(f for f in sources if f.lower().endswith(vendor.suffixes))
        with TemporaryDirectory() as folder:
            for file, data in sources.items():
                (Path(folder) / file).write_bytes(data)
            return vendor.read_file(Path(folder) / main, robot=robot)

    def read_written(self, sources: Sources, robot: Robot) -> Program:
        """What the writer has written; that it cannot be read is a failure."""
        try:
            return self.read_back(sources, robot)
        except FlybyError as error:
            raise AssertionError(
                told(
                    f"{self.name}: what is written cannot be read: {error}",
                    written=text_of(sources),
                )
            ) from error


def said(program: Program, vendor: Vendor, robot: Robot, again: Program) -> Program:
    """What a language says of a program: it has no word for where the robot stands, so that its
    first move is that to the start, at a speed that the program leaves to the language."""
    approached = with_approach(program, vendor.speaks, robot)
    moves = approached.moves
    if len(moves) > len(program.moves) and again.moves:
        approached = approached.with_moves(
            (replace(moves[0], speed=again.moves[0].speed), *moves[1:])
        )
    return replace(approached, start=None)
