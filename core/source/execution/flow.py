"""Which branch is taken, and when a loop ends, where the text alone does not say it.

A program is read along one course that it can take. What the user answers goes before all rules.

*A branch whose condition is not known.* The first is taken that moves the robot and comes back: the
program goes on behind the statement, or behind the call of the routine that it returns from, and is
neither left nor sent elsewhere. Else none of the conditions counts as fulfilled: ELSE runs, or
nothing. If that does not come back, the first branch that does is taken; if all lead elsewhere, the
one that leads there least far.

*A loop whose condition is not known* runs once if its body moves the robot, else not at all.

*A loop whose condition holds* is followed while it gets on: while a datum that decides when it
ends (see `Analysis.deciding`), an answer in turn, or a position that it asks for, is another one
after a pass than before. If it does not get on, the first of these is so:

- A way out of it was not taken, as its condition is not known: its body runs once, and then this
  way out is carried out. A branch that gives a datum or an output on which the end depends another
  value is a way out, too. A loop that gets on is followed past such a way out, but not for ever
  (`FOLLOWED`).
- It reads outputs that only others can change: from now on these may have changed.
- It does not move the robot: it waits for others, and is left, as all waits are satisfied at once;
  what its condition reads has values afterwards that end it, as after a wait.
- It is endless. One pass is read, and the program ends there.

A loop that neither has a condition nor a way out is endless, whether it moves the robot or not. A
jump back closes a loop whose body is what stands between the label and the jump.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Generic, NoReturn, Protocol

from ...errors import InputError, SourceError, Span
from .analysis import Analysis
from .answers import Course
from .limits import Meter
from .outputs import Outputs
from .steps import NOTHING, Block, Exit

FOLLOWED = 100
"""Passes of a loop without a condition that gets on and moves the robot, after which a way out is
taken that nobody can decide."""
FOLLOWED_UNMOVED = 1000
"""The same where it has a condition, which may well end it, or does not move the robot."""


@dataclass(frozen=True, slots=True)
class Undecided:
    """What a condition is that only the running controller knows.

    Args:
        reason: what it depends on.
    """

    reason: str


class Snapshot(Protocol):
    """Data as they were."""

    def changed(self) -> bool:
        """Whether some datum has another value now."""
        ...


class Host(Protocol):
    """The run of a program, as far as branches and loops need it."""

    @property
    def course(self) -> Course:
        """Decides, and remembers what was decided."""
        ...

    @property
    def meter(self) -> Meter:
        """Counts what is executed."""
        ...

    @property
    def outputs(self) -> Outputs:
        """What the program has set its outputs to."""
        ...

    @property
    def position_asked(self) -> int:
        """How often the program has asked where the robot stands."""
        ...

    @property
    def place(self) -> object:
        """Where the robot stands: another object after every move to another place."""
        ...

    def snapshot(self, names: frozenset[str] | None, written: frozenset[str]) -> Snapshot:
        """Data as they are now.

        Args:
            names: of the data, found from where the program stands; None for all data.
            written: names of the data that may be written meanwhile, by routines too.
        """
        ...

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless one of its kind was taken before."""
        ...

    def finish(self, message: str, span: Span) -> NoReturn:
        """End the program here, with a note."""
        ...


def _nothing() -> None:
    pass


@dataclass(frozen=True, slots=True)
class Loop(Generic[Block]):
    """A loop.

    Args:
        body: what runs again and again.
        span: in whose line the user answers how often it runs.
        words: what messages call it, as the text does: ``WHILE TRUE``.
        reads: names of the data that its condition reads.
        asks: whether routines of the program have a part in its condition.
        writes: names of the data that the loop itself steps on.
        endless: whether no condition ends it.
        labels: that stand in it beside those of its body.
        ended: gives the data that its condition reads values with which it does not let the loop
            go on, for a loop that is left though they say that it goes on.
    """

    body: Block
    span: Span
    words: str
    reads: frozenset[str] = NOTHING
    asks: bool = False
    writes: frozenset[str] = NOTHING
    endless: bool = False
    labels: frozenset[str] = NOTHING
    ended: Callable[[], None] = _nothing


@dataclass(frozen=True, slots=True)
class Choice(Generic[Block]):
    """The branch that is taken.

    Args:
        block: None for nothing.
        skipped: branches that could have been taken as well.
    """

    block: Block | None
    skipped: tuple[Block, ...]


@dataclass(frozen=True, slots=True)
class _Skip(Generic[Block]):
    """A branch that was not taken, as its condition is not known.

    Args:
        number: of all branches that were not taken.
        routine: that it stands in, by its number.
        loop: the innermost that it stands in, by its number.
    """

    block: Block
    reason: str
    number: int
    routine: int
    loop: int


@dataclass(slots=True)
class _Passes(Generic[Block]):
    """One execution of a loop.

    Args:
        since: how many branches had not been taken when it began.
        mark: in what is asked of outputs: since when this pass runs.
        count: passes that have been read.
        most: passes to be read, once it is found that nobody knows.
        watched: names of the data that decide when it ends, as far as was known before this pass.
        written: names of the data that a pass may write.
        skips: branches that had not been taken when ``watched`` was found.
        looked: whether the state before this pass is known; it is not where a jump is met first.
        snapshot, turned, asked, place, held: this state: data, answers in turn, questions for the
            position, the position, and outputs.
        left_to_others: whether outputs that its condition reads have just been left to others: it
            is to be asked again.
    """

    loop: Loop[Block]
    since: int
    mark: int
    count: int = 0
    most: int | None = None
    snapshot: Snapshot | None = None
    watched: frozenset[str] | None = NOTHING
    written: frozenset[str] = NOTHING
    skips: int = 0
    looked: bool = False
    turned: int = 0
    asked: int = 0
    place: object = None
    held: dict[str, bool | float] = field(default_factory=dict)
    left_to_others: bool = False


class Flow(Generic[Block]):
    """Decides about the branches and loops of one run.

    Args:
        analysis: of the program's statements.
        host: the run.
    """

    def __init__(self, analysis: Analysis[Block], host: Host) -> None:
        self._analysis = analysis
        self._host = host
        self._skipped: dict[int, _Skip[Block]] = {}  # by the block's id, each with its last time
        self._skips = 0
        self._numbers = 0
        self._routine = 0
        self._depth = 0
        self._loop = 0
        self._jumps: dict[tuple[int, object, object], _Passes[Block]] = {}
        self._reached: dict[tuple[int, object], tuple[int, int]] = {(0, None): (0, 0)}

    # ------------------------------------------------------------------- branches

    def choose(
        self,
        span: Span,
        reason: str,
        blocks: Sequence[Block],
        otherwise: Block | None,
        possible: Sequence[bool] | None = None,
    ) -> Choice[Block]:
        """The branch that is taken where a condition is not known.

        Args:
            span: of the condition.
            reason: what it depends on.
            blocks: the branches.
            otherwise: of ELSE; None if there is none.
            possible: for each branch, and for none of them, whether it is not ruled out; None if
                nothing is.

        Raises:
            SourceError: the user's answer names a branch that there is not.
        """
        may = [True] * (len(blocks) + 1) if possible is None else [*possible]
        written = [*blocks, *([] if otherwise is None else [otherwise])]
        course = self._host.course
        try:
            answer = course.answered_branch(span, len(written))
        except InputError as error:
            raise SourceError(str(error), span) from None
        if answer is None:
            answer, why = self._rule(blocks, otherwise, may)
            course.decided(span, f"the condition depends on {reason}: {why}")
        chosen = otherwise if answer == 0 else written[answer - 1]
        skipped = tuple(
            block for block, able in zip(written, may, strict=False) if able and block is not chosen
        )
        for block in skipped:
            self._skips += 1
            self._skipped[id(block)] = _Skip(block, reason, self._skips, self._routine, self._loop)
        return Choice(chosen, skipped)

    def _rule(
        self, blocks: Sequence[Block], otherwise: Block | None, may: Sequence[bool]
    ) -> tuple[int, str]:
        """The number of the branch that is taken, 0 for none, and why."""
        ask = self._analysis
        written = [*blocks, *([] if otherwise is None else [otherwise])]
        ways = [
            (number, self._leads_to(block), ask.moves(block))
            for number, (block, able) in enumerate(zip(written, may, strict=False), 1)
            if able
        ]
        count = len(written)
        for number, leads, moves in ways:
            if leads is None and moves:
                return (
                    number,
                    f"branch {number} of {count}, the first that moves the robot, is taken",
                )
        if may[-1] and (otherwise is None or self._leads_to(otherwise) is None):
            return 0, "no branch that moves the robot: taken as not fulfilled"
        for number, leads, _ in ways:
            if leads is None:
                return number, f"branch {number} of {count}, the first that comes back, is taken"
        number, _, _ = min(ways, key=lambda way: (way[1], not way[2], way[0]))
        return number, f"all lead elsewhere: branch {number} of {count} is taken"

    def _leads_to(self, block: Block) -> Exit | None:
        """Where a block leads; None if the program goes on behind it, or behind a call."""
        leads = self._analysis.leads_to(block)
        return None if leads is Exit.ROUTINE and self._depth > 1 else leads

    # ---------------------------------------------------------------------- loops

    def loop(
        self,
        loop: Loop[Block],
        goes_on: Callable[[], bool | Undecided],
        run: Callable[[Block], bool],
        run_pass: Callable[[], bool] | None = None,
        tested_first: bool = True,
    ) -> None:
        """Run a loop until it ends.

        Args:
            loop: which.
            goes_on: whether its condition lets it go on.
            run: runs a block where the loop stands; False if a statement in it leaves the loop.
            run_pass: runs a pass likewise; None for ``run`` of the body.
            tested_first: whether the condition is asked before the first pass.
        """
        outer, self._loop = self._loop, self._number()
        try:
            self._run(loop, goes_on, run, run_pass or (lambda: run(loop.body)), tested_first)
        finally:
            self._loop = outer

    def _run(
        self,
        loop: Loop[Block],
        goes_on: Callable[[], bool | Undecided],
        run: Callable[[Block], bool],
        run_pass: Callable[[], bool],
        tested: bool,
    ) -> None:
        host = self._host
        passes = _Passes(loop, self._skips, host.outputs.mark())
        while True:
            if tested or passes.count:
                holds = goes_on()
                if isinstance(holds, Undecided):
                    if passes.count >= self._most(passes, holds.reason):
                        return
                elif not holds:
                    return
                elif passes.left_to_others:
                    passes.left_to_others = False
                elif passes.count and self._ends(passes, run):
                    return
                elif passes.left_to_others:
                    continue
            passes.mark = host.outputs.mark()
            self._look(passes)
            if not run_pass():
                return
            host.meter.statement(loop.span)
            passes.count += 1

    def _most(self, passes: _Passes[Block], reason: str) -> int:
        """How often a loop runs whose condition is not known; asked once in an execution."""
        if passes.most is None:
            loop = passes.loop
            moving = self._analysis.moves(loop.body)
            passes.most = self._host.course.passes(loop.span, reason, moving)
        return passes.most

    def label(self, label: object) -> None:
        """A label is reached, but not by a jump back: the loops that jumps to it close begin anew.

        Args:
            label: its key.
        """
        for place in [p for p in self._jumps if p[:2] == (self._routine, label)]:
            del self._jumps[place]
        self._reached[self._routine, label] = self._skips, self._host.outputs.mark()

    def jump(
        self, loop: Loop[Block], label: object, key: object, run: Callable[[Block], bool]
    ) -> bool:
        """Whether a jump back is carried out.

        Args:
            loop: what stands between the label and the jump.
            label: key of the label, as `label` is given it.
            key: of the jump.
            run: runs a block where the jump stands; False if it leaves a loop round it.
        """
        place = self._routine, label, key
        passes = self._jumps.get(place)
        if passes is None:
            since, mark = self._reached.get(place[:2]) or self._reached[self._routine, None]
            passes = self._jumps[place] = _Passes(loop, since, mark)
            passes.held = self._host.outputs.held()
        passes.count += 1
        self._host.meter.statement(loop.span)
        if self._ends(passes, run):
            del self._jumps[place]
            return False
        for other, inner in [*self._jumps.items()]:
            # Loops to the same label that end before this one does begin anew in its next pass.
            if other[:2] == place[:2] and inner.loop.span.start < loop.span.start:
                del self._jumps[other]
        passes.mark = self._host.outputs.mark()
        self._reached[place[:2]] = self._skips, passes.mark
        self._look(passes)
        return True

    @contextmanager
    def routine(self) -> Iterator[None]:
        """Inside a routine: jumps and ways out of others do not count."""
        outer = self._routine, self._loop
        self._routine, self._loop = self._number(), 0
        self.label(None)  # where the routine begins
        self._depth += 1
        try:
            yield
        finally:
            self._depth -= 1
            for place in [p for p in self._jumps if p[0] == self._routine]:
                del self._jumps[place]
            for reached in [r for r in self._reached if r[0] == self._routine]:
                del self._reached[reached]
            self._routine, self._loop = outer

    # --------------------------------------------------------------------- inside

    def _number(self) -> int:
        self._numbers += 1
        return self._numbers

    def _look(self, passes: _Passes[Block]) -> None:
        """Remember what decides when a loop ends, as it is before a pass."""
        host, loop = self._host, passes.loop
        if not passes.looked or passes.skips != self._skips:
            passes.watched = self._deciding(passes)
            passes.written = self._analysis.written(loop.body) | loop.writes
            passes.skips = self._skips
            passes.looked = True
        names = None if passes.watched is None else passes.watched & passes.written
        some = names is None or names
        passes.snapshot = host.snapshot(names, passes.written) if some else None
        passes.turned = host.course.turned
        passes.asked = host.position_asked
        passes.place = host.place
        passes.held = host.outputs.held()

    def _deciding(self, passes: _Passes[Block]) -> frozenset[str] | None:
        if passes.loop.asks:
            return None
        left_out = frozenset(id(skip.block) for skip in self._open(passes))
        return self._analysis.deciding(passes.loop.body, passes.loop.reads, left_out)

    def _gets_on(self, passes: _Passes[Block]) -> bool:
        """Whether a pass has changed what decides when a loop ends."""
        host = self._host
        if passes.looked:
            if host.course.turned != passes.turned:
                return True
            if host.position_asked != passes.asked and host.place is not passes.place:
                return True
        read = host.outputs.asked_since(passes.mark)
        held = host.outputs.held()
        if any(held.get(name) != passes.held.get(name) for name in read):
            return True
        if passes.looked and passes.skips == self._skips:
            return passes.snapshot is not None and passes.snapshot.changed()
        now = self._deciding(passes)
        if not passes.looked or now != passes.watched:  # a branch was not taken meanwhile
            left_out = frozenset(id(skip.block) for skip in self._open(passes))
            written = self._analysis.written(passes.loop.body, left_out) | passes.loop.writes
            return now is None or not now.isdisjoint(written)
        return passes.snapshot is not None and passes.snapshot.changed()

    def _open(self, passes: _Passes[Block]) -> Iterator[_Skip[Block]]:
        """Branches in a loop that were not taken since it began."""
        inside: frozenset[int] | None = None
        for skip in self._skipped.values():
            if skip.number > passes.since:
                inside = inside or self._analysis.blocks_in(passes.loop.body)
                if id(skip.block) in inside:
                    yield skip

    def _way_out(self, passes: _Passes[Block]) -> _Skip[Block] | None:
        """The first branch that was not taken and would have ended a loop."""
        for skip in self._open(passes):
            if self._leaves(skip, passes.loop):
                return skip
        read = self._host.outputs.asked_since(passes.mark)
        for skip in self._open(passes):
            outputs = self._analysis.outputs_written(skip.block)
            if read and (outputs is None or outputs & read):
                return skip
            written = self._analysis.written(skip.block)
            if written and (passes.watched is None or written & passes.watched):
                return skip
        return None

    def _leaves(self, skip: _Skip[Block], loop: Loop[Block]) -> bool:
        """Whether a branch may leave a loop, or the program."""
        ways = self._analysis.ways_out(skip.block)
        if not ways or skip.routine != self._routine:
            return any(how is Exit.PROGRAM for how, _ in ways)
        for how, label in ways:
            if how is Exit.LOOP and skip.loop != self._loop:
                continue
            if how is Exit.JUMP and label in self._analysis.marks(loop.body) | loop.labels:
                continue
            if how is not Exit.PASS:
                return True
        return False

    def _ends(self, passes: _Passes[Block], run: Callable[[Block], bool]) -> bool:
        """Whether a loop is left after a pass though its condition lets it go on."""
        host, loop = self._host, passes.loop
        moving = self._analysis.moves(loop.body)
        answer = host.course.answered_passes(loop.span)
        if loop.endless and not self._has_way_out(loop):
            self._endless(passes, moving, answer)
            return False
        gets_on = self._gets_on(passes)
        skip = self._way_out(passes)
        if skip is not None:
            followed = FOLLOWED if moving and loop.endless else FOLLOWED_UNMOVED
            if gets_on and answer is None and passes.count < followed:
                return False
            if passes.most is None:
                passes.most = host.course.passes(loop.span, skip.reason, True, leaves=True)
            if passes.count < passes.most:
                return False
            self._leave_by(skip, loop, run)
            if not self._leaves(skip, loop):
                loop.ended()
            return True
        if gets_on:
            return False
        if self._left_to_others(passes):
            passes.left_to_others = True
            passes.mark = host.outputs.mark()
            return False
        if not moving:
            host.note_once(
                f"waits {loop.span.file}:{loop.span.start}",
                f"the loop ({loop.words}) only waits for what the program does not change itself: "
                "it is taken as satisfied at once",
                loop.span,
            )
            way = self._known_way(loop.body) if loop.endless else None
            if way is not None:
                run(way)
            loop.ended()
            return True
        self._endless(passes, moving, answer)
        return False

    def _has_way_out(self, loop: Loop[Block]) -> bool:
        inside = self._analysis.marks(loop.body) | loop.labels
        return any(
            how is not Exit.PASS and (how is not Exit.JUMP or label not in inside)
            for how, label in self._analysis.ways_out(loop.body)
        )

    def _known_way(self, block: Block) -> Block | None:
        """The first branch in a loop without a condition that leaves it."""
        for step in self._analysis.steps(block):
            for inner in step.inner:
                leads = self._analysis.leads_to(inner)
                if leads is not None and leads > (Exit.LOOP if step.loop else Exit.PASS):
                    return inner
                found = None if step.loop else self._known_way(inner)
                if found is not None:
                    return found
        return None

    def _leave_by(
        self, skip: _Skip[Block], loop: Loop[Block], run: Callable[[Block], bool]
    ) -> None:
        """Carry out the way out that was not taken."""
        if skip.routine == self._routine:
            run(skip.block)
        elif any(how is Exit.PROGRAM for how, _ in self._analysis.ways_out(skip.block)):
            self._host.finish(f"the program is left by what depends on {skip.reason}", loop.span)

    def _left_to_others(self, passes: _Passes[Block]) -> bool:
        """Whether a loop has read outputs that only others can change; they have from now on."""
        outputs = self._host.outputs
        asked = outputs.asked_since(passes.mark)
        written = self._analysis.outputs_written(passes.loop.body)
        if not asked or written is None or asked & written:
            return False
        outputs.forget(asked)
        return True

    def _endless(self, passes: _Passes[Block], moving: bool, answer: int | None) -> None:
        """End the program, if enough of an endless loop has been read."""
        if passes.count < (answer or 1):
            return
        read = "one pass is read" if passes.count == 1 else f"{passes.count} passes are read"
        what = read if moving else "the program ends there"
        loop = passes.loop
        self._host.finish(f"the program is an endless loop ({loop.words}): {what}", loop.span)
