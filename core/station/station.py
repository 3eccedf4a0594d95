"""A station as a value: robots with their programs, and what joins their signals."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path

import numpy as np

from ..arrays import FloatArray
from ..cell.cell import Cell
from ..display import counted, in_line
from ..handling.handling import Handling
from ..motion.emulator.controller import Controller
from ..motion.emulator.run import Run
from ..program.program import Program
from ..program.tool import Load
from ..program.world_zone import WorldZone
from ..spatial.pose import IDENTITY, Pose
from .actions import Action

Driven = tuple[Run, tuple[Action, ...]]
"""A program as driven, and what it does with signals."""


@dataclass(frozen=True)
class Passing:
    """What a robot drives where it need not stop for waits behind zones.

    Args:
        moves: indices of the moves in whose zones it may pass.
        drive: drives the program so that it passes through the zones of these moves.
        run, actions: as it passes through all of them.
    """

    moves: tuple[int, ...]
    drive: Callable[[Collection[int]], Driven]
    run: Run
    actions: tuple[Action, ...]


@dataclass(frozen=True)
class ClockPace:
    """Stretches of a robot's own time that take longer.

    Args:
        own: (K,) s, times of its own at which the pace changes, from 0 on, rising.
        clock: (K,) s, the same as they pass, waits left out.
    """

    own: FloatArray
    clock: FloatArray

    @classmethod
    def steady(cls) -> ClockPace:
        """As driven."""
        return cls(np.zeros(1), np.zeros(1))

    @classmethod
    def slower(cls, spans: Sequence[tuple[FloatArray, FloatArray]]) -> ClockPace:
        """With spans that take longer.

        Args:
            spans: times (K,) s of its own, in their order, and s since the span began at which
                they pass.
        """
        own, clock = [np.zeros(1)], [np.zeros(1)]
        for times, passed in spans:
            own.append(times)
            clock.append(clock[-1][-1] + times[0] - own[-2][-1] + passed)
        return cls(np.concatenate(own), np.concatenate(clock))

    def passed(self, own: FloatArray) -> FloatArray:
        """s on the clock at times of its own; beyond all changes it is as driven."""
        return _mapped(own, self.own, self.clock)

    def at(self, own: float) -> float:
        """The same of one time."""
        return float(self.passed(np.array([own]))[0])

    def own_at(self, clock: FloatArray) -> FloatArray:
        """s of its own at times on the clock."""
        return _mapped(clock, self.clock, self.own)


def _mapped(t: FloatArray, known: FloatArray, other: FloatArray) -> FloatArray:
    inside = np.interp(t, known, other)
    before, behind = np.minimum(t - known[0], 0.0), np.maximum(t - known[-1], 0.0)
    # What is infinite stays so.
    return np.asarray(inside + before + behind)


@dataclass(frozen=True)
class CarriedMoves:
    """What another robot turns under a program, and the moves on which it turns.

    Args:
        carrier: the robot that turns it.
        axes: names of the carrier's axes, and of the robot's own that stand for them.
        blocks: moves in a row, by index, and those of the carrier that are made together with them;
            none where it stands while the robot works on it.
    """

    carrier: str
    axes: Mapping[str, str]
    blocks: tuple[Mapping[int, int], ...]


@dataclass(frozen=True, repr=False)
class StationRobot:
    """One robot of a station with its program.

    Args:
        name: in the station.
        program: that it drives, as it was read.
        controller: that drives it.
        cell: where it stands, with what stands around.
        run: the program as driven, with the weight of the parts that it carries.
        begins: s after the station's start at which its program begins.
        pace: at which its own time passes where others set it.
        passing: what it drives where it passes through zones that waits stand behind; None where
            there are none.
        handling: of the parts of its cell; None for a cell without.
        carried: what other robots turn under its program.
        world: where what its controller calls the world is in the station's.
    """

    name: str
    program: Program
    controller: Controller
    cell: Cell
    run: Run
    begins: float = 0.0
    pace: ClockPace = field(default_factory=ClockPace.steady)
    passing: Passing | None = None
    handling: Handling | None = None
    carried: tuple[CarriedMoves, ...] = ()
    world: Pose = IDENTITY

    def carrying(self, program: Program) -> Program:
        """A program of the same moves with the parts that the robot carries along them."""
        return _with_loads(program, [move.load for move in self.run.program.moves])

    def bare(self, program: Program) -> Program:
        """What `carrying` makes, without the parts; moves may have gone from it, or come."""
        pairs = zip(self.run.program.moves, self.program.moves, strict=True)
        known = {(carrying.tool, carrying.load): bare.load for carrying, bare in pairs}
        return _with_loads(
            program, [known.get((move.tool, move.load), move.load) for move in program.moves]
        )

    def __repr__(self) -> str:
        return in_line(
            f"StationRobot {self.name}: {self.cell.robot.name} with {self.program.name}, "
            f"{self.run.duration:.3f} s"
        )


def _with_loads(program: Program, loads: Sequence[Load | None]) -> Program:
    pairs = list(zip(program.moves, loads, strict=True))
    if all(move.load == load for move, load in pairs):
        return program
    return program.with_moves(tuple(replace(move, load=load) for move, load in pairs))


@dataclass(frozen=True, slots=True)
class Wire:
    """What one signal does to another.

    Args:
        source: ``robot.signal`` or ``gate.output``.
        target: ``robot.signal``.
        least, greatest: s that a change takes from the one to the other.
    """

    source: str
    target: str
    least: float = 0.0
    greatest: float = 0.0

    @property
    def usual(self) -> float:
        """s that a change takes where one figure is asked for."""
        return 0.5 * (self.least + self.greatest)


class GateKind(StrEnum):
    """What a gate makes of its inputs."""

    AND = "and"
    OR = "or"
    LATCH = "latch"
    COUNTER = "counter"
    TIMER = "timer"


@dataclass(frozen=True, slots=True)
class Input:
    """A signal that a gate looks at.

    Args:
        name: ``robot.signal`` or ``plc.gate``.
        on: whether it counts when it is on; else when it is off (``not …``).
    """

    name: str
    on: bool = True

    @classmethod
    def read(cls, text: str) -> Input:
        """From ``left.doInside`` or ``not left.doInside``."""
        words = text.split(maxsplit=1)
        if len(words) == 2 and words[0].casefold() == "not":
            return cls(words[1].strip(), False)
        return cls(text.strip())


@dataclass(frozen=True, slots=True)
class Gate:
    """One output of the PLC, called ``plc.NAME``.

    Args:
        kind: see `GateKind`.
        inputs: of AND and OR all; of a latch what sets it; of a counter what is counted, at each
            rise; of a timer what has to be on for a while.
        resets: what sets a latch back, which wins, or a counter to zero.
        least: of a counter the number from which on it is on.
        delay: of a timer, s that its input is on before it is.
    """

    kind: GateKind
    inputs: tuple[Input, ...]
    resets: tuple[Input, ...] = ()
    least: int = 1
    delay: float = 0.0


@dataclass(frozen=True, slots=True)
class HandOver:
    """A part that one robot hands to another.

    Args:
        giver, given: the robot that has it first, and what its cell calls the part.
        taker, taken: the other robot, and what its cell calls it.
    """

    giver: str
    given: str
    taker: str
    taken: str


@dataclass(frozen=True, slots=True)
class HeldTogether:
    """A part that two robots carry together, on moves that they make together.

    Args:
        holder: the robot in whose cell it is.
        part: what that calls it.
        other: that holds it, too.
    """

    holder: str
    part: str
    other: str


@dataclass(frozen=True, repr=False)
class RobotStation:
    """Robots that share a cell.

    Args:
        members: by name, in the order of the file.
        wires: that carry signals from one to another.
        gates: of the PLC, by name.
        initial: signals that are on at the beginning.
        given: inputs that nobody of the station sets, and what they are.
        clearance: m that robots must keep from each other.
        allowed: pairs of ``robot.thing`` that may touch.
        file: that it was read from.
        zones: spaces with outputs.
        hand_overs: parts that robots hand to each other.
    """

    members: Mapping[str, StationRobot]
    wires: tuple[Wire, ...] = ()
    gates: Mapping[str, Gate] = field(default_factory=dict)
    initial: frozenset[str] = frozenset()
    given: Mapping[str, bool] = field(default_factory=dict)
    clearance: float = 0.0
    allowed: tuple[tuple[str, str], ...] = ()
    file: Path | None = None
    zones: tuple[WorldZone, ...] = ()
    hand_overs: tuple[HandOver, ...] = ()

    def __repr__(self) -> str:
        name = "" if self.file is None else f" {self.file.name}"
        return in_line(
            f"Station{name}: {', '.join(self.members)}; {counted(self.wires, 'wire')}, "
            f"clearance {1e3 * self.clearance:g} mm"
        )


def signal_key(name: str) -> str:
    """A signal's name as it is looked up: languages write names in many ways.

    Args:
        name: ``robot.signal``.
    """
    return "".join(name.split()).casefold()


def levels_at_start(station: RobotStation) -> frozenset[str]:
    """The keys of the signals that are on before anything has happened.

    Inputs that a link leads to have had the time to follow outputs which are on; what is ``given``
    stays what it is.
    """
    levels = {signal_key(name) for name in station.initial}
    given = {signal_key(name): on for name, on in station.given.items()}
    levels |= {name for name, on in given.items() if on}
    links = [(signal_key(wire.source), signal_key(wire.target)) for wire in station.wires]
    for _ in links:
        levels |= {target for source, target in links if source in levels and target not in given}
    return frozenset(levels)
