"""Moves that several robots make together: they begin together, and take what the slowest takes.

MultiMove: moves between ``SyncMoveOn`` and ``SyncMoveOff`` whose ``\\ID`` is the same ("Application
manual MultiMove"). RoboTeam: the motion behind a ``MotionSync``. The faster ones are driven more
slowly all along, at one share of their speed. Where one works on what another one turns, one path
parameter leads them all: at every instant each has driven the same share of its move, and none is
faster than by itself.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..display import counted
from ..errors import InputError, Note, Span
from ..motion.emulator.run import Run
from ..program.program import Program
from ..program.signal import Meet
from ..program.zone import Fine
from .actions import Action, MeetingPoint, stand_of
from .station import ClockPace

IdOf = Callable[[int], str | None]
"""The id of a move by its index; None for none."""
_INSTANTS = 100
"""Of a move at which its share is looked at, evenly in time."""


@dataclass(frozen=True)
class TogetherMove:
    """A move that is made together with others.

    Args:
        robot: that makes it.
        index: among its moves.
        name: what it is called in all programs.
        span: where in the source.
    """

    robot: str
    index: int
    name: str
    span: Span | None

    @property
    def said(self) -> str:
        """The move with its line."""
        return f"{self.robot}'s move {self.index + 1}" + (
            "" if not self.span else f" ({self.span})"
        )


@dataclass(frozen=True)
class TogetherBlock:
    """Moves of one robot between the beginning and the end of such moves.

    Args:
        robot: its name.
        begins: the meeting at which they begin.
        moves: in their order.
    """

    robot: str
    begins: MeetingPoint
    moves: tuple[TogetherMove, ...]

    @property
    def said(self) -> str:
        """Where they begin."""
        return f"behind {self.begins.said}"


@dataclass(frozen=True)
class Together:
    """Blocks of several robots that are made together, as many moves in each.

    Args:
        label: of the meeting at which they begin.
        nth: how many such meetings there were, this one counted.
        blocks: one of each robot.
    """

    label: str
    nth: int
    blocks: tuple[TogetherBlock, ...]

    def of(self, robot: str) -> TogetherBlock | None:
        """The block of a robot; None if it takes no part."""
        return next((block for block in self.blocks if block.robot == robot), None)


def moves_together(
    programs: Mapping[str, Program],
    meetings: Mapping[str, Sequence[MeetingPoint]],
    ids: Mapping[str, IdOf | None],
) -> tuple[Together, ...]:
    """The moves that robots make together.

    Args:
        programs: by robot.
        meetings: of these.
        ids: of moves; None of a language that synchronises one motion at a time.

    Raises:
        InputError: robots do not make the same moves together; it names both lines.
    """
    found: dict[tuple[str, int], list[TogetherBlock]] = {}
    for name, program in programs.items():
        counts: dict[str, int] = {}
        inside: set[int] = set()
        for block in _blocks(name, program, meetings[name], ids[name]):
            label = block.begins.does.label
            nth = counts[label] = counts.get(label, 0) + 1
            found.setdefault((label, nth), []).append(block)
            inside |= {move.index for move in block.moves}
        _check_outside(name, program, ids[name], inside)
    several = {key: blocks for key, blocks in found.items() if len(blocks) > 1}
    for blocks in several.values():
        _check(blocks)
    return tuple(Together(*key, tuple(blocks)) for key, blocks in several.items())


@dataclass(frozen=True)
class Synchronised:
    """What comes of moves that are made together.

    Args:
        paces: of the robots that make such moves.
        actions: of all robots, with meetings where such moves begin.
        notes: what a user should know.
    """

    paces: Mapping[str, ClockPace]
    actions: dict[str, tuple[Action, ...]]
    notes: tuple[Note, ...]


def synchronised(
    runs: Mapping[str, Run],
    actions: Mapping[str, tuple[Action, ...]],
    together: Sequence[Together],
    carried: Collection[str] = (),
) -> Synchronised:
    """How long moves take that are made together.

    Args:
        runs: programs as driven.
        actions: of these.
        together: see `moves_together`.
        carried: robots that work on what others turn, or carry a part with another one.
    """
    spans: dict[str, dict[int, tuple[FloatArray, FloatArray]]] = {name: {} for name in runs}
    meets: dict[str, list[Action]] = {name: [] for name in actions}
    for each in together:
        in_step = any(block.robot in carried for block in each.blocks)
        for k in range(len(each.blocks[0].moves)):
            moves = [block.moves[k] for block in each.blocks]
            robots = [_Progress.of(runs[move.robot], move.index) for move in moves]
            made = _in_step(robots) if in_step else _stretched(robots)
            # On the way through a zone nothing can be waited for, nor is it told when it is passed.
            stand, end = (
                all(_stands(runs[move.robot], move.index + more) for move in moves)
                for more in (0, 1)
            )
            for move, robot, span in zip(moves, robots, made, strict=True):
                # Who goes nowhere waits at the end for those that come there, where all stop.
                if len(robot.share) or not end:
                    spans[move.robot][move.index] = span
                if not stand:
                    continue
                meet = Meet(f"{each.label} {each.nth} {move.name} {k}")
                text = f"moves together, {move.name}"
                begin = float(span[0][0])
                if not len(robot.share):
                    # It leads nowhere; what comes behind it counts from when the robot stands.
                    begin = stand_of(runs[move.robot], move.index, -1).at
                meets[move.robot].append(Action(meet, begin, move.index - 1, text, move.span))
    paces = {
        name: ClockPace.slower([own[index] for index in sorted(own)])
        for name, own in spans.items()
        if own
    }
    made_actions = {
        name: tuple(sorted((*doings, *meets[name]), key=lambda action: (action.time, action.move)))
        for name, doings in actions.items()
    }
    notes = (
        _noted(each, any(block.robot in carried for block in each.blocks)) for each in together
    )
    return Synchronised(paces, made_actions, tuple(notes))


def _blocks(
    name: str, program: Program, meetings: Sequence[MeetingPoint], ids: IdOf | None
) -> Iterator[TogetherBlock]:
    moves = program.moves
    for k, begins in enumerate(meetings):
        if not begins.does.coordinated:
            continue
        first = begins.move + 1
        if ids is None:
            behind = range(first, min(first + 1, len(moves)))
            called = [begins.does.label] * len(behind)
        else:
            last = meetings[k + 1].move if k + 1 < len(meetings) else len(moves) - 1
            behind = range(first, last + 1)
            called = [_called(ids(i)) for i in behind]
        yield TogetherBlock(
            name,
            begins,
            tuple(
                TogetherMove(name, i, one, moves[i].statement)
                for i, one in zip(behind, called, strict=True)
            ),
        )


def _check_outside(name: str, program: Program, ids: IdOf | None, inside: set[int]) -> None:
    """No move has an ID where none are made together.

    Raises:
        InputError: one has.
    """
    for i, move in enumerate(program.moves):
        found = None if ids is None or i in inside else ids(i)
        if found is not None:
            said = TogetherMove(name, i, found, move.statement).said
            raise InputError(
                f"{said} has ID {found}, and no others are made together with it there: it stands "
                "behind no SyncMoveOn, and controllers stop at it"
            )


def _called(name: str | None) -> str:
    return "no ID" if name is None else f"ID {name}"


def _check(blocks: Sequence[TogetherBlock]) -> None:
    """All robots make the same moves, in the same order.

    Raises:
        InputError: naming the first that one makes and another does not.
    """
    first = blocks[0]
    for other in blocks[1:]:
        for one, two in ((first, other), (other, first)):
            names = [move.name for move in two.moves]
            for move in one.moves:
                if move.name not in names:
                    raise InputError(
                        f"{move.said} is made together with others ({move.name}), and {two.robot} "
                        f"has no such move {two.said}: give both the same, or none"
                    )
        for move, counterpart in zip(first.moves, other.moves, strict=False):
            if move.name != counterpart.name:
                raise InputError(
                    f"{move.said} has {move.name} where {counterpart.said} has "
                    f"{counterpart.name}: moves that are made together come in one order"
                )
        if len(first.moves) != len(other.moves):
            longer, shorter = sorted((first, other), key=lambda block: -len(block.moves))
            more = longer.moves[len(shorter.moves)]
            raise InputError(
                f"{more.said} has no counterpart of {shorter.robot} {shorter.said}: robots make as "
                "many moves together"
            )


def _noted(together: Together, in_step: bool) -> Note:
    blocks = together.blocks
    robots = " and ".join(block.robot for block in blocks)
    moves = counted(blocks[0].moves, "move")
    driven = "the others are driven more slowly all along, at one share of their speed"
    if in_step:
        driven = "at every instant each has driven the same share of its move"
    return Note(
        f"{robots} make {moves} together {blocks[0].said}: each takes as long as the slowest, and "
        f"{driven}; how the controller shares the pace out within a move is not known"
    )


def _stands(run: Run, index: int) -> bool:
    """Whether a robot stands where a move begins."""
    return index == 0 or isinstance(run.program.moves[index - 1].zone, Fine)


def own_span(run: Run, index: int) -> tuple[float, float]:
    """s of its own at which a robot begins and ends a move, waits behind it left out."""
    moves, timing = run.path.route.moves, run.timing
    begins = timing.begins()
    k = bisect_left(moves, index)
    if k == len(moves) or moves[k] != index:
        # It leads nowhere: the robot stands there.
        at = float(begins[k]) if k < len(moves) else run.duration
        return at, at
    begin = float(begins[k])
    return begin, begin + float(timing.settled_durations()[k])


@dataclass(frozen=True)
class _Progress:
    """How far a robot is on a move when.

    Args:
        begin, end: s of its own, waits behind the move left out.
        share: (S,) of the move's path, rising from 0 to 1; empty for a move that leads nowhere.
        own: (S,) s of its own.
    """

    begin: float
    end: float
    share: FloatArray
    own: FloatArray

    @classmethod
    def of(cls, run: Run, index: int) -> _Progress:
        """Of a move by its index."""
        begin, end = own_span(run, index)
        if index not in run.path.route.moves:
            return cls(begin, end, np.empty(0), np.empty(0))
        timing, k = run.timing, bisect_left(run.path.route.moves, index)
        rows = np.flatnonzero(timing.interval_segments == k)
        sample = timing.intervals.sample[rows]
        first, last = run.path.sigma[sample[0]], run.path.sigma[sample[-1] + 1]
        own = np.linspace(begin, end, _INSTANTS + 1)
        place = timing.place_at(own - timing.lag)
        share = np.clip((place - first) / (last - first), 0.0, 1.0)
        share[0], share[-1] = 0.0, 1.0
        share, which = np.unique(share, return_index=True)
        return cls(begin, end, share, own[which])

    def at(self, share: FloatArray) -> FloatArray:
        """s of its own at shares of the move."""
        return np.interp(share, self.share, self.own)


def _stretched(robots: Sequence[_Progress]) -> list[tuple[FloatArray, FloatArray]]:
    """As `_in_step`, where each only takes what the slowest takes."""
    ends = np.array([0.0, max(robot.end - robot.begin for robot in robots)])
    return [(np.array([robot.begin, robot.end]), ends) for robot in robots]


def _in_step(robots: Sequence[_Progress]) -> list[tuple[FloatArray, FloatArray]]:
    """Times of each robot's own on a move, and s since it began at which they pass together."""
    driving = [robot for robot in robots if len(robot.share)]
    if not driving:
        return [(np.array([robot.begin]), np.zeros(1)) for robot in robots]
    shares = np.unique(np.concatenate([robot.share for robot in driving]))
    own = [robot.at(shares) for robot in driving]
    for robot, times in zip(driving, own, strict=True):
        times[-1] = robot.end
    # None is faster than by itself: its limits hold, and so do the bounds of its deviations.
    steps = np.max([np.diff(times) for times in own], axis=0)
    passed = np.append(0.0, np.cumsum(steps))
    known = dict(zip(map(id, driving), own, strict=True))
    ends = np.array([0.0, passed[-1]])
    return [
        (known[id(robot)], passed) if id(robot) in known else (np.full(2, robot.begin), ends)
        for robot in robots
    ]
