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
- It has not moved the robot, and might if data had other values that something beside the program
  may write: from now on they are not known.
- It reads outputs that only others can change: from now on these may have changed.
- It does not move the robot: it waits for others, and is left, as all waits are satisfied at once;
  what its condition reads has values afterwards that end it, as after a wait.
- It is endless. One pass is read (`Answers.cycles`), and the program ends there. Of one that is
  driven by a state, which a pass sets and the next one asks for, all are read until the state comes
  back: they are the cycle. Where the first cycle begins elsewhere than later ones one pass more is
  read (`Answers.closes`).
- All that its end and the ways of its passes depend on is as it was before one of them, though it
  has a condition: it is endless, too.

*What is set on a way that nobody has decided* is supposed from there on, in that branch's block and
in those that were not taken, and in a loop of which it is not known how often it runs. So is what
is made of it, what is set on a way that it decides, and a move to it (`Move.supposed`).

A loop that gets on without a move, for more statements than a program may execute in a row, passes
time or waits for others, and is left.

A loop that neither has a condition nor a way out is endless, whether it moves the robot or not. A
jump back closes a loop whose body is what stands between the label and the jump.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Generic

from ....errors import Span
from ..guard import Guard
from ..host import Host, Undecided
from ..limits import EndlessError
from .analysis import Analysis, Way
from .branches import ActiveBlocks, Branches
from .endings import Endings
from .loops import Loop, Passes, Start
from .steps import NOTHING, PLACE, Block, Exit


class Flow(Generic[Block]):
    """Decides about the branches and loops of one run.

    Args:
        analysis: of the program's statements.
        host: the run.
    """

    def __init__(self, analysis: Analysis[Block], host: Host) -> None:
        self._analysis = analysis
        self._host = host
        self._nesting = ActiveBlocks()
        self._branches: Branches[Block] = Branches(analysis, host.course, self._nesting)
        self._endings = Endings(analysis, host, self._branches)
        self.choose = self._branches.choose
        self._passed: set[tuple[int, str]] = set()  # labels, by their names
        self._returns = ""  # what it depends on which RETURN of the routine under way is taken
        self._loops: list[Passes[Block]] = []  # under way, the innermost last
        self._jumps: dict[tuple[int, object, object], Passes[Block]] = {}
        self._reached: dict[tuple[int, object], Start] = {(0, None): Start(0, 0, 0, 0)}

    @contextmanager
    def supposing(self, blocks: Iterable[Block | None], reason: str) -> Iterator[None]:
        """One of some branches runs inside, and it is not known whether that one does: what they
        set is supposed afterwards.

        Args:
            blocks: all that may run there.
            reason: what it depends on; empty if it is known which one runs.
        """
        try:
            yield
        finally:
            if reason:
                found = [block for block in blocks if block is not None]
                ways = {way for block in found for way in self._analysis.ways_out(block)}
                if self._nesting.loop and any(how is not Exit.PASS for how, _ in ways):
                    self._loops[-1].suppose(reason)
                self._suppose(found, reason)
                self._guard(ways, reason)

    def _guard(self, ways: Iterable[Way], reason: str) -> None:
        """A branch that nobody decides has these ways out."""
        host, routine = self._host, self._nesting.routine
        guards = host.course.guards
        open_ = {guard.label for guard in guards if guard.routine == routine}
        for how, name in ways:
            back = how is Exit.JUMP and (routine, name) in self._passed
            label = self._end_of_pass() if how is Exit.PASS else name
            meets = how in (Exit.PASS, Exit.JUMP, Exit.ROUTINE)
            if meets and not back and label not in open_:
                guards.append(Guard(reason, routine, label, host.place))
            if how is Exit.ROUTINE:
                self._returns = self._returns or reason

    def _ends_with_pass(self, guard: Guard) -> bool:
        return guard.label == self._end_of_pass()

    def _end_of_pass(self) -> str:
        """Of the loop under way, as a label: no language can write it."""
        return f"the end of pass {self._nesting.loop}"

    def _close(self, comes_together: Callable[[Guard], bool]) -> None:
        """The ways of some guards have come together."""
        host = self._host
        for guard in [guard for guard in host.course.guards if comes_together(guard)]:
            host.course.guards.remove(guard)
            guard.close()
            if guard.place is not host.place:
                host.leave_supposed(frozenset({PLACE}), NOTHING, guard.reason)

    def _suppose(
        self, blocks: Iterable[Block], reason: str, names: frozenset[str] = NOTHING
    ) -> None:
        settings, called = NOTHING, NOTHING
        for block in blocks:
            (_, own), *others = self._analysis.written_apart(block)
            names |= own
            called = called.union(*(written for _, written in others))
            settings |= self._analysis.settings(block)
            if self._analysis.moves(block):
                names |= {PLACE}
        if names or settings or called:
            self._host.leave_supposed(names, settings, reason, called)

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
        nesting = self._nesting
        outer, nesting.loop = nesting.loop, nesting.number()
        passes = Passes(loop, self._endings.start(), supposed=self._host.course.supposed)
        self._loops.append(passes)
        try:
            with self._host.course.sections.loop(loop.words, loop.span, not loop.endless) as begins:
                run_pass = run_pass or (lambda: run(loop.body))
                self._run(passes, goes_on, run, run_pass, tested_first, begins)
        except EndlessError as error:
            _goes_on(error, passes)
            raise
        finally:
            self._loops.pop()
            nesting.loop = outer
            if passes.supposed:
                self._suppose([loop.body], passes.supposed, loop.writes)
                own = Exit.PASS, Exit.LOOP
                ways = self._analysis.ways_out(loop.body)
                self._guard([way for way in ways if way[0] not in own], passes.supposed)

    def _run(
        self,
        passes: Passes[Block],
        goes_on: Callable[[], bool | Undecided],
        run: Callable[[Block], bool],
        run_pass: Callable[[], bool],
        tested: bool,
        begins: Callable[[], None],
    ) -> None:
        host, loop = self._host, passes.loop
        while True:
            if tested or passes.count:
                host.course.supposed = ""
                holds = goes_on()
                passes.suppose(host.course.supposed)
                if isinstance(holds, Undecided):
                    if passes.count >= self._endings.most(passes, holds.reason):
                        return
                elif not holds:
                    return
                elif passes.left_to_others:
                    passes.left_to_others = False
                elif not passes.count:
                    if not self._endings.enters(loop):
                        return
                elif self._endings.left(passes, run):
                    return
                elif passes.left_to_others:
                    continue
            self._endings.look(passes)
            if self._passed:  # the labels of a pass are ahead again
                names = self._analysis.marks(loop.body)
                self._passed -= {(self._nesting.routine, name) for name in names}
            begins()
            stays = run_pass()
            if host.course.guards:
                self._close(self._ends_with_pass)
            if not stays:
                return
            host.meter.statement(loop.span)
            passes.count += 1

    def label(self, label: object, name: str = "") -> None:
        """A label is reached, but not by a jump back: the loops that jumps to it close begin anew.

        Args:
            label: its key.
            name: as jumps have it.
        """
        routine = self._nesting.routine
        self._passed.add((routine, name))
        if self._host.course.guards:
            self._close(lambda guard: guard.routine == routine and guard.label == name)
        for place in [p for p in self._jumps if p[:2] == (self._nesting.routine, label)]:
            del self._jumps[place]
        self._reached[self._nesting.routine, label] = self._endings.start()

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
        place = self._nesting.routine, label, key
        passes = self._jumps.get(place)
        if passes is None:
            start = self._reached.get(place[:2]) or self._reached[place[0], None]
            passes = self._jumps[place] = Passes(loop, start, unseen=1)
            passes.held = self._host.outputs.held()
        passes.count += 1
        self._host.meter.statement(loop.span)
        if self._endings.left(passes, run):
            del self._jumps[place]
            if passes.supposed:
                self._suppose([loop.body], passes.supposed)
            return False
        for other, inner in [*self._jumps.items()]:
            # Loops to the same label that end before this one does begin anew in its next pass.
            if other[:2] == place[:2] and inner.loop.span.start < loop.span.start:
                del self._jumps[other]
        self._reached[place[:2]] = self._endings.start()
        self._endings.look(passes)
        return True

    @contextmanager
    def routine(self, name: str, span: Span) -> Iterator[None]:
        """Inside a routine: jumps and ways out of others do not count.

        Args:
            name: of the routine.
            span: of the call.
        """
        nesting = self._nesting
        outer = nesting.routine, nesting.loop
        nesting.routine, nesting.loop = nesting.number(), 0
        self.label(None)  # where the routine begins
        nesting.depth += 1
        returns, self._returns = self._returns, ""
        try:
            with self._host.course.sections.routine(name, span):
                yield
        except EndlessError as error:
            for place, passes in self._jumps.items():
                if place[0] == nesting.routine:
                    _goes_on(error, passes)
            raise
        finally:
            nesting.depth -= 1
            own, course = nesting.routine, self._host.course
            if course.guards:
                self._close(lambda guard: guard.routine == own)
            course.suppose(self._returns)
            self._returns = returns
            self._passed = {p for p in self._passed if p[0] != own}
            self._jumps = {p: found for p, found in self._jumps.items() if p[0] != own}
            self._reached = {r: found for r, found in self._reached.items() if r[0] != own}
            nesting.routine, nesting.loop = outer


def _goes_on(error: EndlessError, passes: Passes[Block]) -> None:
    """A program without an end was in this loop, again and again: of several the outermost."""
    if passes.count > 1 and not error.foreseen:
        error.loop = passes.loop.span
