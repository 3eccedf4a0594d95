"""When a loop ends that nothing known ends, see `flow`."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Generic, NoReturn

from ....door import spelt
from ....errors import SourceError, Span
from ..host import Host
from .analysis import Analysis
from .branches import Branches, Skip
from .loops import Head, Loop, Passes, Start
from .states import FOLLOWED, LoopStates, named
from .steps import NOTHING, PLACE, Block, Exit

FOLLOWED_UNMOVED = 1000
"""The same where it has a condition, which may well end it, or does not move the robot."""
FORESEEN = 100
"""Passes after which it is foreseen how many more a loop has that nothing but its condition ends:
from how far that came nearer to its end in the second half of them, if it did so evenly in both
halves of that."""
_MEASURED = 3
"""Distances that this takes."""
_EVEN = 1e-9
"""Share by which such halves may differ."""
_UNMOVED = "does not move the robot, as nothing fulfils the conditions of its motion"


class Endings(Generic[Block]):
    """Decides when the loops of one run end.

    Args:
        analysis: of the program's statements.
        host: the run.
        branches: those that were not taken.
    """

    def __init__(self, analysis: Analysis[Block], host: Host, branches: Branches[Block]) -> None:
        self._analysis = analysis
        self._host = host
        self._branches = branches
        self._states = LoopStates(analysis, host)
        self._long: set[Span] = set()

    def start(self) -> Start:
        """Now."""
        host = self._host
        meter = host.meter
        asked = host.outputs.mark()
        skips = self._branches.skips
        return Start(skips, asked, meter.moves, meter.row, meter.driven, host.place)

    def most(self, passes: Passes[Block], reason: str) -> int:
        """How often a loop runs whose condition is not known; asked once in an execution."""
        if passes.most is None:
            loop = passes.loop
            moving = self._analysis.moves(loop.body)
            passes.most = self._host.course.passes(loop.span, reason, moving, passes.count)
            self._suppose(passes, reason)
            if not passes.most and not moving:
                self._host.pause(loop.words, loop.span)
        return passes.most

    def _suppose(self, passes: Passes[Block], reason: str) -> None:
        """Nobody says how often a loop runs."""
        span = passes.loop.span
        if self._host.course.answered_passes(span) is None:
            passes.suppose(f"the loop at {span.file}:{span.line} ({reason})")

    def look(self, passes: Passes[Block]) -> None:
        """A pass begins: remember what decides when the loop ends, as it is now."""
        host, loop = self._host, passes.loop
        passes.heads.append(Head(host.meter.moves, host.meter.driven, host.place))
        if self._runs_out(passes):
            return
        passes.mark = host.outputs.mark()
        if not passes.looked or passes.skips != self._branches.skips:
            passes.watched = self._deciding(passes)
            passes.written = self._analysis.written(loop.body) | loop.writes
            passes.skips = self._branches.skips
            passes.looked = True
        names = None if passes.watched is None else passes.watched & passes.written
        some = names is None or names
        passes.snapshot = host.snapshot(names, passes.written) if some else None
        waiting = not self._has_moved(passes) and self._analysis.moves(loop.body)
        passes.still = host.snapshot(passes.written, passes.written) if waiting else None
        passes.turned = host.course.turned
        passes.asked = host.position_asked
        passes.place = host.place
        passes.held = host.outputs.held()
        self._states.look(passes)

    def _has_moved(self, passes: Passes[Block]) -> bool:
        """Whether a loop has moved the robot since it began."""
        return self._host.meter.moves != passes.start.moves

    def _may_come_to_move(self, passes: Passes[Block]) -> bool:
        """Whether a loop that has not moved the robot changes data that its motion may need."""
        if passes.count >= FOLLOWED:
            return False
        return not passes.looked or (passes.still is not None and passes.still.changed())

    def _deciding(self, passes: Passes[Block]) -> frozenset[str] | None:
        if passes.loop.asks:
            return None
        return self._analysis.deciding(passes.loop.body, passes.loop.reads, self._left_out(passes))

    def _left_out(self, passes: Passes[Block]) -> frozenset[int]:
        """Ids of the branches in a loop that were not taken since it began."""
        skips = self._branches.open_in(passes.loop.body, passes.start.skips)
        return frozenset(id(skip.block) for skip in skips)

    def _gets_on(self, passes: Passes[Block]) -> bool:
        """Whether a pass has changed what decides when a loop ends."""
        host = self._host
        if passes.loop.counts:
            return True
        if passes.looked:
            if host.course.turned != passes.turned:
                return True
            decides = passes.watched is None or PLACE in passes.watched
            asked = host.position_asked != passes.asked
            if decides and asked and host.place is not passes.place:
                return True
        read = host.outputs.asked_since(passes.mark)
        held = host.outputs.held()
        if any(held.get(name) != passes.held.get(name) for name in read):
            return True
        if passes.looked and passes.skips == self._branches.skips:
            return passes.snapshot is not None and passes.snapshot.changed()
        now = self._deciding(passes)
        if not passes.looked or now != passes.watched:  # a branch was not taken meanwhile
            written = self._analysis.written(passes.loop.body, self._left_out(passes))
            if not passes.looked:  # nor is it known what outputs held before
                written |= self._analysis.outputs_written(passes.loop.body) or NOTHING
            return now is None or not now.isdisjoint(written | passes.loop.writes)
        return passes.snapshot is not None and passes.snapshot.changed()

    def _way_out(self, passes: Passes[Block]) -> Skip[Block] | None:
        """The first branch that was not taken and would have ended a loop."""
        skips = [*self._branches.open_in(passes.loop.body, passes.start.skips)]
        for skip in skips:
            if self._leaves(skip, passes.loop):
                return skip
        read = self._host.outputs.asked_since(passes.mark)
        for skip in skips:
            outputs = self._analysis.outputs_written(skip.block)
            if read and (outputs is None or outputs & read):
                return skip
            written = self._analysis.written(skip.block)
            if written and (passes.watched is None or written & passes.watched):
                return skip
        return None

    def _leaves(self, skip: Skip[Block], loop: Loop[Block]) -> bool:
        """Whether a branch may leave a loop, or the program."""
        ways = self._analysis.ways_out(skip.block)
        if not ways or skip.routine != self._branches.nesting.routine:
            return any(how is Exit.PROGRAM for how, _ in ways)
        for how, label in ways:
            if how is Exit.LOOP and skip.loop != self._branches.nesting.loop:
                continue
            if how is Exit.JUMP and label in self._analysis.marks(loop.body) | loop.labels:
                continue
            if how is not Exit.PASS:
                return True
        return False

    def left(self, passes: Passes[Block], run: Callable[[Block], bool]) -> bool:
        """Whether a loop is left after a pass though its condition lets it go on."""
        if self._runs_out(passes):
            return False
        host, loop = self._host, passes.loop
        moving = self._analysis.moves(loop.body)
        moved = self._has_moved(passes)
        answer = host.course.answered_passes(loop.span)
        if moving and not moved and self._polls(passes):
            return False
        if loop.endless and not self._has_way_out(loop):
            waiting = moving and not moved and answer is None
            if not (waiting and self._may_come_to_move(passes)):
                self._endless(passes, moving, answer)
            return False
        gets_on = self._gets_on(passes)
        skip = self._way_out(passes)
        if skip is not None:
            alone = answer is None and moved and loop.endless and host.course.answers.cycles == 1
            if alone and self._states.are_under_way(passes):
                return False
            followed = FOLLOWED if moving and loop.endless else FOLLOWED_UNMOVED
            round_ = moved and loop.endless and self._states.come_round(passes)
            if gets_on and answer is None and passes.count < followed and not round_:
                return False
            if passes.most is None:
                driven = passes.count
                if answer is None and moved and loop.endless:
                    driven = max(driven, host.course.answers.cycles)
                    driven += self._is_open(passes) and driven == passes.count
                passes.most = host.course.passes(loop.span, skip.reason, True, driven, leaves=True)
                self._suppose(passes, skip.reason)
            if passes.count < passes.most:
                return False
            if moved and loop.endless:
                self._states.tell_cycle(passes)
            self._leave_by(skip, loop, run)
            if not self._leaves(skip, loop):
                loop.ended()
            return True
        if gets_on:
            if answer is None and moved and self._recurs(passes):
                self._endless(passes, moving, answer)
                return False
            if answer is None:
                self._look_ahead(passes)
            return self._passed(passes, answer) or self._too_long(passes)
        if self._left_to_others(passes):
            passes.left_to_others = True
            passes.mark = host.outputs.mark()
            return False
        if moved or (answer is not None and moving):
            self._endless(passes, moving, answer)
            return False
        if moving and self._may_come_to_move(passes):
            return False
        self._satisfy(passes, moving, run)
        return True

    def _runs_out(self, passes: Passes[Block]) -> bool:
        """Whether a loop counts to its end, as was foreseen, whatever it does until then."""
        return passes.runs_out and passes.start.skips == self._branches.skips

    def _look_ahead(self, passes: Passes[Block]) -> None:
        """Foresee how long a loop runs.

        Raises:
            SourceError: it would go on for more moves than are read.
        """
        loop, meter = passes.loop, self._host.meter
        half = FORESEEN // 2
        if passes.count == half:
            passes.distances, passes.moved = [loop.distance()], meter.moves
            passes.row = meter.row
        elif passes.distances and passes.count in (half + half // 2, FORESEEN):
            passes.distances.append(loop.distance())
        known = len(passes.distances) == _MEASURED and None not in passes.distances
        if passes.count == FORESEEN and known and not self._analysis.ways_out(loop.body):
            first, middle, distance = (float(one) for one in passes.distances if one is not None)
            nearer, bend = (first - distance) / half, first - 2.0 * middle + distance
            # Else it comes nearer now and then, or faster and faster.
            if nearer != 0.0 and abs(bend) <= _EVEN * abs(first - distance):
                left = distance / nearer if nearer > 0 else math.inf
                moves = (meter.moves - passes.moved) / half
                meter.ahead(left, moves, loop.words, loop.span)
                fits = moves > 0 or meter.has_room(left * (meter.row - passes.row) / half)
                passes.runs_out, passes.left = fits, None if fits else left
        if self._has_moved(passes) and not passes.runs_out:
            meter.passed(passes.count, lambda: self._nears(passes), loop.words, loop.span)

    def _nears(self, passes: Passes[Block]) -> bool:
        """Whether a loop has come nearer to its end since half way to what was foreseen of it."""
        now, before = passes.loop.distance(), next(iter(passes.distances), None)
        return now is not None and before is not None and now < before

    def _polls(self, passes: Passes[Block]) -> bool:
        """Whether a loop that does not come to move the robot by itself waits for others to tell it
        what to do; from now on they may have."""
        if passes.polled or self._may_come_to_move(passes) or self._gets_on(passes):
            return False
        return self._leave_motion_to_others(passes)

    def _leave_motion_to_others(self, passes: Passes[Block]) -> bool:
        """Whether others may write what a loop's motion depends on, which is unknown afterwards."""
        host, loop = self._host, passes.loop
        if passes.polled or not self._analysis.moves(loop.body):
            return False
        passes.polled = True
        left = host.leave_to_others(self._analysis.guards_of_motion(loop.body) - {PLACE}, loop.span)
        if not left:
            return False
        host.note_once(
            f"polls {loop.span.file}:{loop.span.start}",
            f"the loop ({loop.words}) moves the robot only if others (another task, a computer, an "
            f"operator) write {', '.join(left)}: what they write is not known; say it in a file "
            f"({spelt('answers')}): [values], or [sequences] with [passes] for one after the other",
            loop.span,
        )
        passes.count = 0
        passes.heads.clear()
        host.meter.row = passes.start.statements
        return True

    def enters(self, loop: Loop[Block]) -> bool:
        """Whether a loop whose condition lets it go on is entered: the user may say that not."""
        if loop.endless or self._host.course.answered_passes(loop.span) != 0:
            return True
        loop.ended()
        return False

    def _passed(self, passes: Passes[Block], answer: int | None) -> bool:
        """Whether a loop which goes on has gone on enough: as the user says, or as no more of it
        is read."""
        if answer is None or passes.count < answer:
            return False
        host, loop = self._host, passes.loop
        loop.ended()
        why = host.course.answers.cut_short(loop.span)
        if why is not None:
            self._states.tell_cycle(passes)
            if not why:
                self._end(passes, f"({loop.words})")
            host.open_move(SourceError(why, loop.span), loop.span)
        return True

    def _too_long(self, passes: Passes[Block]) -> bool:
        """Whether a loop counts on and on without a move: it passes time, or waits for others.

        It is left as soon as it is foreseen that it has more statements than a program may execute
        in a row, or once as many are executed; from then on after its first pass.
        """
        host, loop = self._host, passes.loop
        meter = host.meter
        if self._has_moved(passes) or passes.runs_out:
            return False
        foreseen = loop.span in self._long or passes.left is not None
        if not foreseen and meter.row - passes.start.statements < meter.patience:
            return False
        if self._leave_motion_to_others(passes):
            return False
        self._long.add(loop.span)
        self._suppose(passes, "it passes time")
        meter.row = passes.start.statements
        loop.ended()
        made = self._analysis.written(loop.body) - loop.reads - loop.writes
        went = f"the loop ({loop.words}) has run {passes.count} times without a move and goes on"
        if passes.left is not None and passes.left != math.inf and made:
            # What it would have made of them is not what it has made of them so far.
            message = f"{went} for {passes.left:.6g} more: what it makes of {named(made)} is lost"
            if host.open_move(SourceError(message, loop.span), loop.span):
                return True
        host.note_once(
            f"long {loop.span.file}:{loop.span.start}",
            f"{went}: it is left, as one that only passes time",
            loop.span,
        )
        return True

    def _satisfy(self, passes: Passes[Block], moving: bool, run: Callable[[Block], bool]) -> None:
        """Leave a loop that waits for others."""
        loop = passes.loop
        what = f"{_UNMOVED}, and only waits" if moving else "only waits"
        self._host.note_once(
            f"waits {loop.span.file}:{loop.span.start}",
            f"the loop ({loop.words}) {what} for what the program does not change itself: it is "
            "taken as satisfied at once",
            loop.span,
        )
        self._host.pause(loop.words, loop.span)
        self._suppose(passes, "it waits for others")
        way = self._known_way(loop.body) if loop.endless else None
        if way is not None:
            run(way)
        loop.ended()

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

    def _leave_by(self, skip: Skip[Block], loop: Loop[Block], run: Callable[[Block], bool]) -> None:
        """Carry out the way out that was not taken."""
        if skip.routine == self._branches.nesting.routine:
            run(skip.block)
        elif any(how is Exit.PROGRAM for how, _ in self._analysis.ways_out(skip.block)):
            self._host.finish(f"the program is left by what depends on {skip.reason}", loop.span)

    def _left_to_others(self, passes: Passes[Block]) -> bool:
        """Whether a loop has read outputs that only others can change; they have from now on."""
        outputs = self._host.outputs
        asked = outputs.asked_since(passes.mark)
        written = self._analysis.outputs_written(passes.loop.body)
        if not asked or written is None or asked & written:
            return False
        outputs.forget(asked)
        return True

    def _endless(self, passes: Passes[Block], moving: bool, answer: int | None) -> None:
        """End the program, if enough of an endless loop has been read."""
        cycles = self._host.course.answers.cycles if moving and self._has_moved(passes) else 1
        if passes.count < (answer or cycles):
            return
        if answer is None and cycles == 1 and self._states.are_under_way(passes):
            return
        if answer is None and self._is_open(passes):
            return
        self._states.tell_cycle(passes)
        words = f"({passes.loop.words})"
        if moving and not self._has_moved(passes):
            words = f"{words} that {_UNMOVED}"
        self._end(passes, words)

    def _recurs(self, passes: Passes[Block]) -> bool:
        """Whether a loop goes on for ever though it has a condition: all that its passes, and its
        end, depend on is as it was before one of them."""
        host = self._host
        alone = not host.course.answers.sequences and not host.outputs.asked_since(passes.mark)
        return alone and self._states.come_round(passes)

    def _is_open(self, passes: Passes[Block]) -> bool:
        """Whether another pass is read to know how the robot comes to the beginning of a cycle."""
        answers = self._host.course.answers
        return (
            answers.closes
            and answers.cycles == 1
            and self._has_moved(passes)
            and passes.count < FOLLOWED
            and not self._states.closes(passes)
        )

    def _end(self, passes: Passes[Block], words: str) -> NoReturn:
        """End the program in a loop that nothing ends."""
        what = "the program ends there"
        if self._has_moved(passes):
            self._states.say(passes, words)
            what = "one pass is read" if passes.count == 1 else f"{passes.count} passes are read"
        self._host.finish(f"the program is an endless loop {words}: {what}", passes.loop.span)
