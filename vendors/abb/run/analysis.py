"""RAPID's statements as the rules for branches and loops see them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress

from ....core.errors import SourceError, Span
from ....core.source.execution.control_flow.analysis import Analysis
from ....core.source.execution.control_flow.steps import NOTHING, PLACE, Exit, Step
from ....core.source.text.lexer import words
from ..motion.settings_instructions import SETS
from ..syntax import tree
from ..syntax.traversal import calls_in, expressions_of, names_in
from ..values.data import Globals
from ..values.outputs import WRITING
from ..values.scope import NOWHERE, Home
from .instructions import INTERPRETED, MOVING
from .kept import KEPT, REFUSED, written

_HALTING = frozenset({"stop", "systemstopaction"})
_ENDING = frozenset({"exit", "raise"})
_LEAVING = frozenset({"exitcycle", "errraise", "raisetouser"})
_STEPPING = words("incr decr add clear bitset bitclear getdataval getsysdata bookerrno")
_SEARCHING = words("searchl searchc searchextj")
_WRITING_FUNCTIONS = frozenset({"strtoval", "getnextsym", "readdir"})
_PLACE_READING = frozenset({"crobt", "cpos", "cjointt", "calcjointt"})


def data_read(expression: tree.Expression) -> frozenset[str]:
    """Lower-case names of the data that an expression reads, the robot's place among them."""
    asks = any(call.name in _PLACE_READING for call in calls_in(expression))
    return frozenset(names_in(expression)) | ({PLACE} if asks else NOTHING)


class RapidTree:
    """The statements of a program.

    Args:
        data: its routines.
        home: the module of the routine that is being run; blocks that no other block or routine
            was found to hold stand in it.
    """

    def __init__(self, data: Globals, home: Callable[[], Home] = lambda: NOWHERE) -> None:
        self._data = data
        self._home = home
        self._homes: dict[int, Home] = {}
        self._routines: dict[int, tree.Routine] = {}

    def body(self, routine: tree.Routine) -> tree.Block:
        """What a routine runs."""
        self._homes[id(routine.body)] = self._data.scope_of(routine).home
        self._routines[id(routine.body)] = routine
        return routine.body

    def routine(self, body: tree.Block) -> tree.Routine:
        """The routine of a body."""
        return self._routines[id(body)]

    def own(self, block: tree.Block) -> frozenset[str]:
        """See `core.source.execution.control_flow.steps.Tree.own`."""
        routine = self._routines.get(id(block))
        if routine is None:
            return NOTHING
        given = {one.name for one in routine.parameters}
        return frozenset(given.union(one.name for one in routine.declarations))

    def called(self, expression: tree.Expression, home: Home) -> Iterator[tree.Block]:
        """Bodies of the program's own functions that an expression calls."""
        for call in calls_in(expression):
            routine = self._data.routine(call.name, home)
            if routine is not None:
                yield self.body(routine)

    def steps(self, block: tree.Block) -> Sequence[Step[tree.Block]]:
        """See `core.source.execution.control_flow.steps.Tree.steps`."""
        home = self._homes.get(id(block)) or self._home()
        return [self._step(statement, home) for statement in block.statements]

    def _step(self, statement: tree.Statement, home: Home) -> Step[tree.Block]:
        if isinstance(statement, tree.Label):
            return Step(mark=statement.name)
        if isinstance(statement, tree.Goto):
            return Step(exit=Exit.JUMP, label=statement.name)
        if isinstance(statement, tree.Keyword):
            return Step(exit=Exit.PROGRAM if statement.word in _ENDING else None)
        inner = tuple(statement.blocks)
        for block in inner:
            self._homes[id(block)] = home
        expressions = list(_evaluated(statement))
        functions = tuple(body for e in expressions for body in self.called(e, home))
        given = frozenset(
            name
            for e in expressions
            for call in calls_in(e)
            for name in self._handed(call.name, call.arguments, home)
        )
        names = frozenset[str]().union(*map(data_read, expressions))
        if inner:
            return Step(
                reads=names,
                writes=given,
                calls=functions,
                asks=bool(functions),
                inner=inner,
                loop=isinstance(statement, tree.For | tree.While),
                exhaustive=isinstance(statement, tree.If | tree.Test)
                and statement.otherwise is not None,
            )
        if isinstance(statement, tree.Invoke | tree.LateInvoke):
            return self._invoked(statement, home, functions, names, given)
        if isinstance(statement, tree.Unread):
            return self.unread(statement, home)
        written = {statement.target.name} if isinstance(statement, tree.Assign) else NOTHING
        return Step(
            writes=given | written,
            made_of=names,
            calls=functions,
            asks=bool(functions),
            exit=Exit.ROUTINE if isinstance(statement, tree.Return) else None,
        )

    def unread(self, statement: tree.Unread, home: Home) -> Step[tree.Block]:
        """What a damaged statement may do, by the words in it."""
        found = (self._data.routine(word, home) for word in sorted(statement.words))
        target = statement.target
        return Step(
            moves=not MOVING.isdisjoint(statement.words),
            sets=NOTHING.union(*(SETS.get(word, ()) for word in statement.words)),
            writes=frozenset({target.name}) if isinstance(target, tree.Name) else NOTHING,
            calls=tuple(self.body(routine) for routine in found if routine is not None),
        )

    def _handed(self, name: str, arguments: Sequence[tree.Argument], home: Home) -> Iterator[str]:
        """Names of the data that a function, or a routine of the program, may write."""
        routine = self._data.routine(name, home)
        if routine is None:
            yield from _given(arguments) if name in _WRITING_FUNCTIONS else ()
            return
        options = {p.name: p for p in routine.parameters if p.optional}
        required = iter([p for p in routine.parameters if not p.optional])
        for argument in arguments:
            option = argument.option
            parameter = next(required, None) if option is None else options.get(option)
            if isinstance(argument.value, tree.Name) and (
                parameter is None or parameter.mode != "in"
            ):
                yield argument.value.name

    def _elsewhere(self, name: str, home: Home, span: Span) -> tree.Routine | None:
        """A procedure of a module beside the program that is not taken in yet."""
        if name in INTERPRETED or name in KEPT or name in REFUSED:
            return None
        with suppress(SourceError):  # said where it is called
            found = self._data.fetched_routine(name, home, span)
            return found if found is not None and found.kind == "proc" else None
        return None

    def _invoked(
        self,
        statement: tree.Invoke | tree.LateInvoke,
        home: Home,
        functions: tuple[tree.Block, ...],
        names: frozenset[str],
        given: frozenset[str],
    ) -> Step[tree.Block]:
        handed = frozenset(_given(statement.arguments))
        if isinstance(statement, tree.LateInvoke):
            return Step(
                moves=True,
                writes=handed | given,
                made_of=names,
                outputs=None,
                calls=functions,
                asks=True,
            )
        name = statement.name
        own = self._data.routine(name, home) or self._elsewhere(name, home, statement.span)
        if own is not None:
            # What is handed to a routine may be an output that it writes.
            calls = (*functions, self.body(own))
            writes = given.union(self._handed(name, statement.arguments, home))
            return Step(writes=writes, made_of=names, outputs=handed, calls=calls, asks=True)
        filled = name in (*_STEPPING, *_SEARCHING) or (name in KEPT and KEPT[name].writes)
        filled = filled or (name not in INTERPRETED and name not in KEPT)  # by nobody knows what
        brought = frozenset(_given(written(name, statement.arguments)) if filled else ())
        return Step(
            moves=name in MOVING,
            sent=name in KEPT and KEPT[name].sent,
            sets=frozenset(SETS.get(name, ())),
            writes=brought | given,
            made_of=names,
            outputs=handed if name in WRITING else NOTHING,
            calls=functions,
            asks=bool(functions),
            exit=Exit.PROGRAM if name in _LEAVING else None,
            halts=name in _HALTING,
        )


def count_moves(data: Globals, routine: tree.Routine) -> int:
    """How many statements of a routine, and of those that it calls, move the robot."""
    statements = RapidTree(data)
    return Analysis(statements).move_count(statements.body(routine))


def _evaluated(statement: tree.Statement) -> Iterator[tree.Expression]:
    """The expressions that a statement evaluates itself."""
    yield from expressions_of(statement)
    if isinstance(statement, tree.Test):
        yield statement.subject
        for case in statement.cases:
            yield from case.values
    elif isinstance(statement, tree.For):
        yield from (statement.start, statement.stop)
        if statement.step is not None:
            yield statement.step
    elif isinstance(statement, tree.Assign):
        for step in statement.target.path:
            if not isinstance(step, str):
                yield from step


def _given(arguments: Iterable[tree.Argument]) -> Iterator[str]:
    for argument in arguments:
        if isinstance(argument.value, tree.Name):
            yield argument.value.name
