"""URScript's statements as the rules for branches and loops see them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence

from ....core.source.execution.control_flow.steps import PLACE, Exit, Step
from ....core.source.text.lexer import words
from ..motion.jogs import PARAMETERS as JOGS
from ..motion.kinematics import KINEMATICS
from ..motion.settings import CALLS as SETTING
from ..syntax import tree
from ..syntax.traversal import (
    all_statements,
    base_name,
    calls_in,
    calls_of,
    calls_written,
    expressions_of,
    methods_in,
    names_in,
)
from ..values.instructions import MOVES
from ..values.lists import METHODS
from ..values.outputs import read_by, written_by

_EXITS = {"break": Exit.LOOP, "continue": Exit.PASS, "halt": Exit.PROGRAM}


SENT = words("servoj servoc servol speedj speedl")
"""What a computer sends moves the robot by them."""
_MOVING = MOVES | SENT
_TIME = 2
"""Arguments before the time of a jog."""


class ScriptTree:
    """The statements of a program.

    A name stands for all functions of that name, wherever they are defined.

    Args:
        blocks: the statements of all files.
        streamed: names of the functions that drive the robot by what a computer sends, where the
            user says what that is.
    """

    def __init__(self, blocks: Iterable[tree.Block], streamed: Iterable[str] = ()) -> None:
        self._moves = MOVES.union(streamed)
        self._functions: defaultdict[str, list[tree.Define]] = defaultdict(list)
        for block in blocks:
            for statement in all_statements(block):
                if isinstance(statement, tree.Define):
                    self._functions[statement.name].append(statement)

    def bodies(self, names: Iterable[str]) -> tuple[tree.Block, ...]:
        """Bodies of the program's own functions of some names."""
        return tuple(d.body for name in names for d in self._functions.get(name, ()))

    def asks(self, expression: tree.Expression) -> bool:
        """Whether an expression calls what may read anything: a function, a remote procedure."""
        methods = {call.name for call in methods_in(expression)}
        return not methods <= METHODS.keys() or any(
            c in self._functions for c in _called(expression)
        )

    def reads(self, expression: tree.Expression) -> frozenset[str]:
        """Names of the variables and outputs that an expression reads itself, and the robot's
        place."""
        names = frozenset(names_in(expression)) | read_by(calls_written(expression))
        return names if KINEMATICS.keys().isdisjoint(_called(expression)) else names | {PLACE}

    def own(self, block: tree.Block) -> frozenset[str]:
        """See `core.source.execution.control_flow.steps.Tree.own`."""
        defines = (one for ones in self._functions.values() for one in ones if one.body is block)
        return frozenset(parameter.name for one in defines for parameter in one.parameters)

    def steps(self, block: tree.Block) -> Sequence[Step[tree.Block]]:
        """See `core.source.execution.control_flow.steps.Tree.steps`."""
        return [self._step(s) for s in block if not isinstance(s, tree.Define)]

    def _step(self, statement: tree.Statement) -> Step[tree.Block]:
        if isinstance(statement, tree.Unread):
            return self.unread(statement)
        expressions = expressions_of(statement)
        inner = tuple(statement.blocks)
        called = {name for e in expressions for name in _called(e)}
        foreign = {name for name in called if name not in self._functions}
        names = frozenset[str]().union(*map(self.reads, expressions))
        jogs = any(_is_jog(call) for e in expressions for call in calls_written(e))
        return Step(
            moves=jogs or not foreign.isdisjoint(self._moves),
            sent=not jogs and not foreign.isdisjoint(SENT - self._moves),
            reads=names if inner else frozenset(),
            writes=frozenset(_written(statement, expressions)),
            sets=frozenset(foreign) & SETTING,
            made_of=names,
            outputs=frozenset(written_by(call for e in expressions for call in calls_written(e))),
            calls=self.bodies(called),
            asks=any(map(self.asks, expressions)),
            exit=_exit(statement),
            inner=inner,
            loop=isinstance(statement, tree.While),
            exhaustive=isinstance(statement, tree.If) and statement.otherwise is not None,
        )

    def unread(self, statement: tree.Unread) -> Step[tree.Block]:
        """What a damaged statement may do, by the words in it."""
        target = statement.target
        return Step(
            moves=not _MOVING.isdisjoint(statement.words),
            writes=frozenset() if target is None else frozenset({target.text}),
            sets=statement.words & SETTING,
            calls=self.bodies(sorted(statement.words)),
        )

    # -------------------------------------------------------------------- threads

    def thread_writes(self, name: str) -> frozenset[str]:
        """Names of the variables outside that a thread may write, if there are such."""
        return frozenset(base_name(s.target) for s in self._assignments(name, ("", "global")))

    def thread_makes(self, name: str) -> frozenset[str]:
        """Names of the variables that a thread makes for the whole program."""
        return frozenset(base_name(s.target) for s in self._assignments(name, ("global",)))

    def _assignments(self, name: str, storages: tuple[str, ...]) -> Iterator[tree.Assign]:
        """Those in a function and in all that it calls."""
        for body in self.reached(name):
            for statement in all_statements(body):
                if isinstance(statement, tree.Assign) and statement.storage in storages:
                    yield statement

    def reached(self, name: str) -> Iterator[tree.Block]:
        """Bodies of a function and of all functions and threads that it calls or starts, and they
        in turn."""
        todo = [name]
        met = {name}
        while todo:
            for body in self.bodies([todo.pop()]):
                called = calls_of(body) - met
                met |= called
                todo += sorted(called)
                yield body


def _is_jog(call: tree.Call) -> bool:
    """Whether a call drives for a time that is said, see `motion.jogs`."""
    timed = len(call.arguments) > _TIME or any(a.name == "t" for a in call.arguments)
    return call.name in JOGS and timed


def _called(expression: tree.Expression) -> Iterator[str]:
    """Names of the functions and threads that an expression calls or starts."""
    return (name for name in calls_in(expression) if not name.startswith("."))


def _written(statement: tree.Statement, expressions: Sequence[tree.Expression]) -> Iterator[str]:
    """Names of the variables that a statement writes itself."""
    if isinstance(statement, tree.Assign):
        yield base_name(statement.target)
    for expression in expressions:
        for call in methods_in(expression):
            yield base_name(call.base)


def _exit(statement: tree.Statement) -> Exit | None:
    if isinstance(statement, tree.Return):
        return Exit.ROUTINE
    return _EXITS.get(statement.word) if isinstance(statement, tree.Keyword) else None
