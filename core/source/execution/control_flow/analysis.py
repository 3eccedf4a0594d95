"""What can be said of statements without running them.

It is asked only where a run meets a condition that is not known, or a loop; the answers are kept.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from typing import Generic, NamedTuple, TypeVar

from .steps import NOTHING, Block, Exit, Step, Tree

_NONE_LEFT_OUT: frozenset[int] = frozenset()
Found = TypeVar("Found")
Way = tuple[Exit, str | None]
"""How a block is left, and the label where it is left by a jump."""


class Lost(NamedTuple):
    """What nobody knows behind a damaged statement.

    Args:
        moves: whether it may have moved the robot: where it stands.
        settings: names of those that it may have changed.
        data: names of those that it may have written.
    """

    moves: bool
    settings: frozenset[str]
    data: frozenset[str]


class Analysis(Generic[Block]):
    """Asks statements, and the routines that they call, what they do.

    Args:
        tree: the statements of the language.
    """

    def __init__(self, tree: Tree[Block]) -> None:
        self._tree = tree
        self._steps: dict[int, tuple[Block, Sequence[Step[Block]]]] = {}
        self._known: dict[tuple[str, int], object] = {}
        self._written: dict[tuple[int, frozenset[int]], frozenset[str]] = {}
        self._deciding: dict[tuple[object, ...], frozenset[str] | None] = {}

    def steps(self, block: Block) -> Sequence[Step[Block]]:
        """The statements of a block."""
        found = self._steps.get(id(block))
        if found is None:
            # The block is kept with them: its identity must not be given to another.
            found = self._steps[id(block)] = block, self._tree.steps(block)
        return found[1]

    def moves(self, block: Block) -> bool:
        """Whether what moves the robot stands in a block or in a routine that it calls."""

        def find() -> bool:
            # Not from what the called ones do: of two that call each other one is not known yet.
            return any(step.moves for step in self._reached(block, _NONE_LEFT_OUT))

        return self._once("moves", block, False, find)

    def sent(self, block: Block) -> bool:
        """Whether what a computer sends moves the robot in a block or in what it calls."""

        def find() -> bool:
            return any(step.sent for step in self._reached(block, _NONE_LEFT_OUT))

        return self._once("sent", block, False, find)

    def lost(self, step: Step[Block]) -> Lost:
        """What nobody knows behind a damaged statement.

        Args:
            step: what its words say: settings and routines that it names, a datum that it writes.
        """
        called = step.calls
        return Lost(
            step.moves or any(map(self.moves, called)),
            step.sets.union(*map(self.settings, called)),
            step.writes.union(*map(self.written, called)),
        )

    def move_count(self, block: Block) -> int:
        """How many statements in a block, and in the routines that it calls, move the robot."""
        return sum(step.moves for step in self._reached(block, _NONE_LEFT_OUT))

    def way_count(self, block: Block) -> int:
        """The same, with those of a routine once for each call."""

        def find() -> int:
            steps = self.steps(block)
            inside = ((*step.inner, *step.calls) for step in steps)
            return sum(step.moves for step in steps) + sum(
                self.way_count(one) for blocks in inside for one in blocks
            )

        return self._once("ways", block, 0, find)

    def leads_to(self, block: Block) -> Exit | None:
        """Where a block leads in any case; None if the program may go on behind it."""

        def find() -> Exit | None:
            return next(filter(None, map(self._step_leads_to, self.steps(block))), None)

        return self._once("leads to", block, None, find)

    def ways_out(self, block: Block) -> frozenset[Way]:
        """How a block may be left before its end."""

        def find() -> frozenset[Way]:
            steps = self.steps(block)
            marks = {step.mark for step in steps}
            ways = {way for step in steps for way in self._step_ways(step)}
            return frozenset(way for way in ways if way[0] is not Exit.JUMP or way[1] not in marks)

        return self._once("ways out", block, frozenset(), find)

    def written(self, block: Block, left_out: frozenset[int] = _NONE_LEFT_OUT) -> frozenset[str]:
        """Names of the data that a block, and what it calls, may write.

        Args:
            left_out: ids of blocks in it that do not count.
        """

        def find() -> frozenset[str]:
            return NOTHING.union(*(step.writes for step in self._reached(block, left_out)))

        if not left_out:
            return self._once("written", block, NOTHING, find)
        key = id(block), left_out
        if key not in self._written:
            self._written[key] = find()
        return self._written[key]

    def settings(self, block: Block) -> frozenset[str]:
        """Names of the settings that a block, and what it calls, may change."""

        def find() -> frozenset[str]:
            return NOTHING.union(*(step.sets for step in self._reached(block, _NONE_LEFT_OUT)))

        return self._once("settings", block, NOTHING, find)

    def written_apart(self, body: Block) -> list[tuple[Block, frozenset[str]]]:
        """Names of the data that a block may write, and apart from it those that each routine does
        which is called from there, but for what it keeps to itself."""

        def find() -> list[tuple[Block, frozenset[str]]]:
            found: list[tuple[Block, frozenset[str]]] = []
            todo, reached = [body], {id(body)}
            for one in todo:
                steps = [*self._all(one)]
                own = NOTHING if one is body else self._tree.own(one)
                found.append((one, NOTHING.union(*(step.writes for step in steps)) - own))
                for called in (called for step in steps for called in step.calls):
                    if id(called) not in reached:
                        reached.add(id(called))
                        todo.append(called)
            return found

        return self._once("written apart", body, [], find)

    def outputs_written(self, block: Block) -> frozenset[str] | None:
        """Names of the outputs that a block, and what it calls, may write; None for any."""

        def find() -> frozenset[str] | None:
            found: set[str] = set()
            for step in self._reached(block, _NONE_LEFT_OUT):
                if step.outputs is None:
                    return None
                found |= step.outputs
            return frozenset(found)

        return self._once("outputs", block, None, find)

    def deciding(
        self,
        body: Block,
        reads: frozenset[str],
        left_out: frozenset[int] = _NONE_LEFT_OUT,
    ) -> frozenset[str] | None:
        """Names of the data that decide when a loop ends.

        Those that its condition reads, and the conditions of its ways out; and those that these
        are made of. None if a routine of the program has a part in it: it may read anything.

        Args:
            body: of the loop.
            reads: names that its condition reads.
            left_out: ids of blocks in it that do not count: ways out that nobody can decide.
        """
        key = id(body), reads, left_out
        if key not in self._deciding:
            self._deciding[key] = self._find_deciding(body, reads, left_out)
        return self._deciding[key]

    def _find_deciding(
        self, body: Block, reads: frozenset[str], left_out: frozenset[int]
    ) -> frozenset[str] | None:
        guards = [*self._guards(body, left_out)]
        if any(step.asks for step in guards):
            return None
        names = reads.union(*(step.reads for step in guards))
        inside = [*self._with_conditions(body, left_out, NOTHING)]
        while True:
            more = names
            for step, around in inside:
                if names.isdisjoint(step.writes | (step.outputs or NOTHING)):
                    continue
                if step.asks or step.calls:
                    return None
                more = more.union(step.made_of, around)
            if more == names:
                return names
            names = more

    def guards_of_motion(self, block: Block) -> frozenset[str]:
        """Names of the data that decide whether a block, or what it calls, moves the robot: those
        that conditions read on which a motion depends, and those that these are made of."""

        def find() -> frozenset[str]:
            names = NOTHING
            inside = [*self._reached(block, _NONE_LEFT_OUT)]
            for step in inside:
                if any(self.moves(inner) for inner in step.inner):
                    asked = (self._reached(body, _NONE_LEFT_OUT) for body in step.calls)
                    own = (one.reads | one.made_of for steps in asked for one in steps)
                    names = names.union(step.reads, *own)
            return _made_of(names, [(step, NOTHING) for step in inside])

        return self._once("guards", block, NOTHING, find)

    def choosing(self, block: Block) -> frozenset[str]:
        """Names of the data that conditions in a block, or in what it calls, read to choose between
        ways of which one at least moves the robot, and of those that these are made of. Conditions
        of loops do not count, nor data that the block sets before it reads them."""

        def find() -> frozenset[str]:
            reached = [*self._reached(block, _NONE_LEFT_OUT)]
            steps = (s for s in reached if not s.loop and any(map(self.moves, s.inner)))
            names = NOTHING.union(*(step.reads for step in steps))
            return _made_of(names, self._with_all_conditions(block)) - self.set_first(block)

        return self._once("choosing", block, NOTHING, find)

    def set_first(self, block: Block) -> frozenset[str]:
        """Names of the data that a block sets in any case, before it reads them."""
        read: set[str] = set()
        found: set[str] = set()
        for step in self.steps(block):
            inside = (self._reached(one, _NONE_LEFT_OUT) for one in (*step.calls, *step.inner))
            for one in (step, *(one for steps in inside for one in steps)):
                read |= one.reads | one.made_of
            if not step.inner and not step.calls:
                found |= step.writes - read
        return frozenset(found)

    def marks(self, block: Block) -> frozenset[str]:
        """The labels in a block, those in its inner blocks included."""

        def find() -> frozenset[str]:
            found = {step.mark for step in self._all(block) if step.mark is not None}
            return frozenset(found)

        return self._once("marks", block, NOTHING, find)

    def blocks_in(self, block: Block) -> frozenset[int]:
        """Ids of a block, of all blocks in it and of those that it calls."""

        def find() -> frozenset[int]:
            reached, todo = {id(block)}, [block]
            while todo:
                for step in self.steps(todo.pop()):
                    for other in (*step.calls, *step.inner):
                        if id(other) not in reached:
                            reached.add(id(other))
                            todo.append(other)
            return frozenset(reached)

        return self._once("blocks", block, frozenset(), find)

    # --------------------------------------------------------------------- inside

    def _once(self, kind: str, block: Block, meanwhile: Found, find: Callable[[], Found]) -> Found:
        """What was found before, or is found now.

        Args:
            meanwhile: taken for true while it is looked for, by routines that call each other.
        """
        key = kind, id(block)
        if key not in self._known:
            self._known[key] = meanwhile
            self._known[key] = find()
        return self._known[key]  # type: ignore[return-value]  # of the kind's own type

    def _step_leads_to(self, step: Step[Block]) -> Exit | None:
        if step.exit is not None or step.halts:
            return step.exit or Exit.PROGRAM
        if any(self.leads_to(body) is Exit.PROGRAM for body in step.calls):
            return Exit.PROGRAM
        if step.exhaustive and not step.loop:
            ends = [self.leads_to(block) for block in step.inner]
            if ends and None not in ends:
                return min(end for end in ends if end is not None)
        return None

    def _step_ways(self, step: Step[Block]) -> Iterator[Way]:
        if step.exit is not None:
            yield step.exit, step.label
        for body in step.calls:
            yield from (way for way in self.ways_out(body) if way[0] is Exit.PROGRAM)
        for block in step.inner:
            for way in self.ways_out(block):
                if not (step.loop and way[0] in (Exit.PASS, Exit.LOOP)):
                    yield way

    def _all(self, block: Block) -> Iterator[Step[Block]]:
        for step in self.steps(block):
            yield step
            for inner in step.inner:
                yield from self._all(inner)

    def _reached(self, block: Block, left_out: frozenset[int]) -> Iterator[Step[Block]]:
        """The statements of a block and of all that it calls."""
        reached, todo = {id(block), *left_out}, [block]
        while todo:
            for step in self.steps(todo.pop()):
                yield step
                for other in (*step.calls, *step.inner):
                    if id(other) not in reached:
                        reached.add(id(other))
                        todo.append(other)

    def _guards(self, block: Block, left_out: frozenset[int]) -> Iterator[Step[Block]]:
        """The statements whose conditions decide whether a block is left."""
        for step in self.steps(block):
            inner = [b for b in step.inner if id(b) not in left_out and self._leaves_step(step, b)]
            if inner:
                yield step
            for one in inner:
                yield from self._guards(one, left_out)

    def _leaves_step(self, step: Step[Block], block: Block) -> bool:
        ways = self.ways_out(block)
        within = (Exit.PASS, Exit.LOOP) if step.loop else (Exit.PASS,)
        return any(how not in within for how, _ in ways)

    def _with_all_conditions(self, block: Block) -> list[tuple[Step[Block], frozenset[str]]]:
        """The statements of a block and of all that it calls, each with what the conditions read
        that it runs on in its own routine."""
        bodies = [body for body, _ in self.written_apart(block)]
        return [
            pair for body in bodies for pair in self._with_conditions(body, _NONE_LEFT_OUT, NOTHING)
        ]

    def _with_conditions(
        self, block: Block, left_out: frozenset[int], around: frozenset[str]
    ) -> Iterator[tuple[Step[Block], frozenset[str]]]:
        """The statements of a block, each with what the conditions read that it runs on."""
        for step in self.steps(block):
            yield step, around
            for inner in step.inner:
                if id(inner) not in left_out:
                    yield from self._with_conditions(inner, left_out, around | step.reads)
            for body in step.calls:
                writes = self.written(body)
                if writes:
                    yield Step(writes=writes, calls=(body,)), around


def _made_of(
    names: frozenset[str], steps: Collection[tuple[Step[Block], frozenset[str]]]
) -> frozenset[str]:
    """Names of data, and of those that these are made of in some statements, each with what the
    conditions read that it runs on."""
    while True:
        made = (s.made_of | around for s, around in steps if not names.isdisjoint(s.writes))
        more = names.union(*made)
        if more == names:
            return names
        names = more
