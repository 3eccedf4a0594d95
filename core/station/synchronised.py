"""Moves that several robots make together: they begin together, and take what the slowest takes.

MultiMove: moves between ``SyncMoveOn`` and ``SyncMoveOff`` whose ``\\ID`` is the same ("Application
manual MultiMove"). RoboTeam: the motion behind a ``MotionSync``. The faster ones are driven more
slowly all along, at one share of their speed.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from ..display import counted
from ..errors import InputError, Note, Span
from ..motion.emulator.run import Run
from ..program.signal import Meet
from ..program.zone import Fine
from .actions import Action
from .pace import ClockPace

IdOf = Callable[[int], str | None]
"""The id of a move by its index; None for none."""


@dataclass(frozen=True)
class _Move:
    """A move that is made together with others."""

    robot: str
    index: int
    name: str
    span: Span | None

    @property
    def said(self) -> str:
        return f"{self.robot}'s move {self.index + 1}" + (
            "" if not self.span else f" ({self.span})"
        )


@dataclass(frozen=True)
class _Block:
    """Moves of one robot between the beginning and the end of such moves.

    Args:
        robot: its name.
        begins: the meeting at which they begin.
        moves: in their order.
    """

    robot: str
    begins: Action
    moves: tuple[_Move, ...]

    @property
    def said(self) -> str:
        span = self.begins.span
        return f"behind {self.begins.text}" + ("" if span is None else f" ({span})")


@dataclass(frozen=True)
class Synchronised:
    """What comes of moves that are made together.

    Args:
        paces: of the robots that are slowed down.
        actions: of all robots, with meetings where such moves begin.
        notes: what a user should know.
    """

    paces: Mapping[str, ClockPace]
    actions: dict[str, tuple[Action, ...]]
    notes: tuple[Note, ...]


def synchronised(
    runs: Mapping[str, Run],
    actions: Mapping[str, tuple[Action, ...]],
    ids: Mapping[str, IdOf | None],
) -> Synchronised:
    """Find the moves that robots make together, and how long they take.

    Args:
        runs: programs as driven.
        actions: of these.
        ids: of moves; None of a language that synchronises one motion at a time.

    Raises:
        InputError: robots do not make the same moves together; it names both lines.
    """
    together: dict[tuple[str, int], list[_Block]] = {}
    for name, doings in actions.items():
        counts: dict[str, int] = {}
        for block in _blocks(name, runs[name], doings, ids[name]):
            does = block.begins.does
            assert isinstance(does, Meet)
            nth = counts[does.label] = counts.get(does.label, 0) + 1
            together.setdefault((does.label, nth), []).append(block)
    lengths: dict[tuple[str, int], float] = {}
    meets: dict[str, list[Action]] = {name: [] for name in actions}
    notes: list[Note] = []
    for (label, nth), blocks in together.items():
        if len(blocks) < 2:
            continue
        _check(blocks)
        notes.append(_noted(blocks))
        for k in range(len(blocks[0].moves)):
            moves = [block.moves[k] for block in blocks]
            longest = max(_length(runs[move.robot], move.index) for move in moves)
            # On the way through a zone nothing can be waited for, nor is it told when it is passed.
            stand = all(_stands(runs[move.robot], move.index) for move in moves)
            for move in moves:
                lengths[move.robot, move.index] = longest
                if not stand:
                    continue
                begin = _span(runs[move.robot], move.index)[0]
                meet = Meet(f"{label} {nth} {move.name} {k}")
                text = f"moves together, {move.name}"
                meets[move.robot].append(Action(meet, begin, move.index - 1, text, move.span))
    paces = {}
    for name, run in runs.items():
        spans = [
            (*_span(run, index), length)
            for (robot, index), length in sorted(lengths.items())
            if robot == name
        ]
        if spans:
            paces[name] = ClockPace.slower(spans)
    made = {
        name: tuple(sorted((*doings, *meets[name]), key=lambda action: action.time))
        for name, doings in actions.items()
    }
    return Synchronised(paces, made, tuple(notes))


def _blocks(name: str, run: Run, doings: Sequence[Action], ids: IdOf | None) -> Iterator[_Block]:
    meetings = [action for action in doings if isinstance(action.does, Meet)]
    moves = run.program.moves
    for k, begins in enumerate(meetings):
        assert isinstance(begins.does, Meet)
        if not begins.does.coordinated:
            continue
        first = begins.move + 1
        if ids is None:
            behind = range(first, min(first + 1, len(moves)))
            named = [_Move(name, i, begins.does.label, moves[i].statement) for i in behind]
        else:
            last = meetings[k + 1].move if k + 1 < len(meetings) else len(moves) - 1
            named = [
                _Move(name, i, _called(ids(i)), moves[i].statement) for i in range(first, last + 1)
            ]
        yield _Block(name, begins, tuple(named))


def _called(name: str | None) -> str:
    return "no ID" if name is None else f"ID {name}"


def _check(blocks: Sequence[_Block]) -> None:
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


def _noted(blocks: Sequence[_Block]) -> Note:
    robots = " and ".join(block.robot for block in blocks)
    moves = counted(blocks[0].moves, "move")
    return Note(
        f"{robots} make {moves} together {blocks[0].said}: each takes as long as the slowest, and "
        "the others are driven more slowly all along, at one share of their speed; how the "
        "controller shares the pace out within a move is not known"
    )


def _stands(run: Run, index: int) -> bool:
    """Whether a robot stands where a move begins."""
    return index == 0 or isinstance(run.program.moves[index - 1].zone, Fine)


def _span(run: Run, index: int) -> tuple[float, float]:
    """s of its own from the beginning of a move to its end, waits behind it left out."""
    moves, begins = run.path.route.moves, run.timing.begins()
    k = bisect_left(moves, index)
    if k == len(moves) or moves[k] != index:
        # It leads nowhere: the robot stands there.
        at = float(begins[k]) if k < len(moves) else run.duration
        return at, at
    begin = float(begins[k])
    return begin, begin + float(run.timing.settled_durations()[k])


def _length(run: Run, index: int) -> float:
    begin, end = _span(run, index)
    return end - begin
