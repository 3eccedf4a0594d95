"""What a user asks of an experiment, and the values of a design."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from ...core.collision.proof.verdict import Certificate
from ...core.door import spelt
from ...core.errors import InputError, OptionError
from ...core.language import Sources
from ...core.motion.emulator.run import Run
from ...core.motion.model.motion_model import MotionModel
from ...core.program.program import Program
from ...core.program.tool import FLANGE, Tool
from ...core.robot.model import Robot
from .kinds import KINDS, Kind, Topic
from .postures import Site

TURNS = tuple(math.radians(turn) for turn in (30, 60, 90, 120, 150))
SPEEDS = (0.05, 0.2, 0.5, 1.0)
RADII = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2)
"""m; predefined by ABB but for 2 mm."""
SMALLEST_SHARE, LARGEST_SHARE = 0.0015, 0.08
"""Of the robot's reach, between which the usual zones lie."""
ZONE_LEVELS = 4
POSTURES, MANY_POSTURES, FEW_POSTURES = 3, 8, 2
"""How many there are where nobody says: of all runs; of those about postures; of other topics."""


@dataclass(frozen=True)
class Plan:
    """What shall be measured, and how much time there is.

    Args:
        turns: changes of direction at the corners, rad, in (0, π).
        radii: of the zones, m; None for `usual_radii` of the robot.
        speeds: of the TCP, m/s; None for the usual ones of the kinds, or topics.
        kinds: of moves.
        about: the open questions that runs are to settle; none for runs of all kinds.
        postures: how many, or the configurations (N,) themselves; None for the usual number.
        minutes: at the robot; None for all runs.
        overhead: s, what a run takes beside its motion: the way there, writing the log.
        longest: s, that one run may last.
        margin: rad (m) that joints keep from their limits.
        period: s between samples; None for what the recorder usually takes.
        tool: that is mounted.
        seed: of all that is drawn.

    Raises:
        InputError: a number is out of its range.
    """

    turns: tuple[float, ...] = TURNS
    radii: tuple[float, ...] | None = None
    speeds: tuple[float, ...] | None = None
    kinds: tuple[Kind, ...] = KINDS
    about: tuple[Topic, ...] = ()
    postures: int | Sequence[FloatArray] | None = None
    minutes: float | None = 60.0
    overhead: float = 20.0
    longest: float = 30.0
    margin: float = math.radians(5)
    period: float | None = None
    tool: Tool = FLANGE
    seed: int = 1

    def __post_init__(self) -> None:
        _check("angles", self.turns, math.pi, math.degrees, "°")
        _check("zones", self.radii or (1e-3,), 1.0, lambda value: 1e3 * value, " mm")
        _check("speeds", self.speeds or SPEEDS, 10.0, lambda value: 1e3 * value, " mm/s")
        for name in ("longest", "margin"):
            if not 0 < getattr(self, name) < math.inf:
                raise OptionError(f"{spelt(name)}: must be above zero and finite")
        if not 0 <= self.overhead < math.inf:
            raise OptionError(f"{spelt('overhead')}: must be zero or more seconds")
        if self.minutes is not None and not 0 < self.minutes < math.inf:
            raise OptionError(f"{spelt('minutes')}: must be above zero and finite")
        if not self.kinds:
            raise OptionError(f"{spelt('kinds')}: an experiment needs at least one")
        count = self.posture_count
        if not 1 <= count <= 99:
            raise OptionError(f"{spelt('postures')}: an experiment has 1 to 99, not {count}")
        if not self.tool.robot_held:
            raise InputError(
                f"the tool {self.tool.name} stands still: records of runs know tools that the "
                "robot carries"
            )

    @property
    def posture_count(self) -> int:
        """How many postures are wanted."""
        if isinstance(self.postures, int):
            return self.postures
        if self.postures is not None:
            return len(self.postures)
        return MANY_POSTURES if Topic.POSTURES in self.about else POSTURES

    def topics_at(self, posture: int) -> tuple[Topic, ...]:
        """What runs at a posture, counted from 0, are about."""
        few = self.postures is None and posture >= FEW_POSTURES
        return tuple(one for one in self.about if one is Topic.POSTURES or not few)


def _check(
    what: str,
    values: Sequence[float],
    below: float,
    shown: Callable[[float], float],
    unit: str,
) -> None:
    if not values:
        raise OptionError(f"{spelt(what)}: an experiment needs at least one")
    for value in values:
        if not 0 < value < below:
            raise OptionError(
                f"{spelt(what)}: {shown(value):.4g}{unit} does not lie between 0 and "
                f"{shown(below):.4g}{unit}"
            )
    if len(set(values)) != len(values):
        raise OptionError(f"{spelt(what)}: one is given twice")


def usual_radii(reach: float) -> tuple[float, ...]:
    """Zones, m, for a robot of a reach, m: up to four, evenly graded."""
    fit = [r for r in RADII if SMALLEST_SHARE * reach <= r <= LARGEST_SHARE * reach]
    chosen = np.unique(np.round(np.linspace(0, len(fit) - 1, ZONE_LEVELS)).astype(int))
    return tuple(fit[k] for k in chosen)


@dataclass(frozen=True)
class PlannedCorner:
    """A fly-by point as it is designed.

    Args:
        turn: change of the TCP's direction, rad.
        radius: of the zone, m.
        share: of the contour, in zones that are given by one instead.
    """

    turn: float
    radius: float
    share: float | None = None

    @property
    def zone(self) -> str:
        """In words."""
        if self.share is not None:
            return f"{100 * self.share:.5g} %"
        return f"{1e3 * self.radius:.5g} mm"


@dataclass(frozen=True)
class Study:
    """What a run is for that settles an open question.

    Args:
        topic: the question.
        levels: of the factors that the runs about it cross.
        joints: whose figures it shows, counted from 0; none for all.
    """

    topic: Topic
    levels: frozenset[str]
    joints: tuple[int, ...] = ()


@dataclass(frozen=True)
class Alternative:
    """How a run would be driven if the motion model were another one.

    Args:
        what: is otherwise then, in words.
        longer: s that the run takes more than as emulated.
        apart: m, greatest distance of the motors' TCP from where it goes as emulated.
        turned: rad (m), greatest distance of a joint from where it is at the same time as emulated;
            None where the run takes another time.
    """

    what: str
    longer: float
    apart: float
    turned: float | None = None


@dataclass(frozen=True)
class Purpose:
    """What a run is for, in words and numbers.

    Args:
        question: that it settles.
        figures: of the motion model that it shows, by their keys.
        alternatives: which its log tells from what is emulated; those that change nothing, or
            under which it cannot be driven, are left out.
    """

    question: str
    figures: tuple[str, ...]
    alternatives: tuple[Alternative, ...]


@dataclass(frozen=True)
class CandidateRun:
    """A run that may become part of the experiment.

    Args:
        name: of its program.
        kind: of moves.
        posture: number from 0.
        speed: m/s of the TCP; None of single axes.
        corners: in their order.
        program: begins with a joint move to ``start``, a stop.
        start: (N,), where the measured motion begins.
        study: the open question that it is about; None of the usual runs.
    """

    name: str
    kind: Kind
    posture: int
    speed: float | None
    corners: tuple[PlannedCorner, ...]
    program: Program
    start: FloatArray
    study: Study | None = None


@dataclass(frozen=True)
class Designed:
    """A run of the experiment.

    Args:
        candidate: what was designed.
        program: as it is read back from its text.
        sources: its text, by file name.
        run: its emulation.
        certificate: of its clearance; None where nothing is known of the robot's shape.
        gain: nats of information on the motion model (see `information`) that it adds to the
            runs before it.
        way_proven: whether the joint line from the end of the run before to the start keeps
            clear; None if that is not known.
    """

    candidate: CandidateRun
    program: Program
    sources: Sources
    run: Run
    certificate: Certificate | None
    gain: float
    way_proven: bool | None = None
    purpose: Purpose | None = None

    def stem(self, number: int) -> str:
        """What record and log of the run are called without their endings.

        Args:
            number: of the run among those of the experiment, from 1.
        """
        return f"{number:02}_{self.candidate.name}"

    @property
    def duration(self) -> float:
        """s, emulated."""
        return self.run.duration

    @property
    def topic(self) -> Topic | None:
        """The open question that it is about; None of the usual runs."""
        return None if self.candidate.study is None else self.candidate.study.topic

    @property
    def figures(self) -> tuple[str, ...]:
        """Keys of the figures that a run about an open question shows."""
        return () if self.purpose is None else self.purpose.figures


@dataclass(frozen=True)
class Skipped:
    """What is not part of an experiment."""

    what: str
    reason: str


@dataclass(frozen=True)
class Precision:
    """What the runs would tell of one figure of the motion model.

    Args:
        key: dotted key of the motion model's file, with an index where there are several.
        value: where it was looked at.
        before: assumed standard deviation.
        after: standard deviation with all runs.
    """

    key: str
    value: float
    before: float
    after: float


@dataclass(frozen=True)
class Experiment:
    """A set of runs, in the order in which they should be driven.

    Args:
        robot: that drives them.
        plan: what was asked for.
        model: the robot's motion, as far as it is known.
        period: s between the samples of the logs.
        sites: the postures, with the planes that the corners lie in.
        runs: the most informative first.
        skipped: what is not possible, with the reasons.
        unused: runs that there was no time for, the most informative first.
        precision: of each figure of the motion model.
        notes: what a user should know.
        sources: all runs as what is loaded at once, by file name.
        steps: what is done at the controller.
    """

    robot: Robot
    plan: Plan
    model: MotionModel
    period: float
    sites: tuple[Site, ...]
    runs: tuple[Designed, ...]
    skipped: tuple[Skipped, ...]
    unused: tuple[Skipped, ...]
    precision: tuple[Precision, ...]
    notes: tuple[str, ...]
    sources: Sources
    steps: tuple[str, ...]

    @property
    def seconds(self) -> float:
        """s at the robot: motion, and what each run takes beside it."""
        return sum(run.duration + self.plan.overhead for run in self.runs)
