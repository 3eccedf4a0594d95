"""KRL's statements as the rules for branches and loops see them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from ....core.errors import SourceError
from ....core.source.execution.steps import NOTHING, Exit, Step
from ..syntax.expression_tree import Call, Expression, Name, Number
from ..syntax.traversal import calls_in, data_in, indices_in
from ..syntax.tree import (
    Assign,
    Block,
    For,
    Goto,
    Halt,
    If,
    Invoke,
    Label,
    Loop,
    MotionInstruction,
    Repeat,
    Return,
    SplineBlock,
    Statement,
    Switch,
    WaitSec,
    While,
)
from ..syntax.tree import (
    Exit as ExitStatement,
)
from ..values.data import Data
from ..values.elements import Names
from ..values.predefined import OUTPUTS
from ..values.scope import Module, Scope
from .instructions import kept

NATIVE = frozenset({"bas"})
"""Routines of KUKA's own that are carried out natively."""
_LOOPS = (For, While, Repeat, Loop)


class KrlTree:
    """The statements of a program.

    Args:
        data: its routines and data.
        names: finds the outputs that a name stands for.
        scopes: of the routines under way, the innermost last; blocks that no other block or
            routine was found to hold stand in its module.
    """

    def __init__(self, data: Data, names: Names, scopes: Sequence[Scope]) -> None:
        self._data = data
        self._names = names
        self._scopes = scopes
        self._homes: dict[int, Module] = {}

    def called(self, call: Call, home: Module) -> Block | None:
        """The body of the routine that a call means; None if it is not at hand."""
        own = self._data.library.main.routines.get(call.name) or home.routines.get(call.name)
        if own is None and (call.name in NATIVE or kept(call.name) is not None):
            return None
        found = self._data.library.routine(call.name, home)
        if found is None:
            return None
        routine, module = found
        self._data.declare_module(module)
        self._homes[id(routine.body)] = module
        return routine.body

    def outputs(self, target: Name, home: Module) -> frozenset[str] | None:
        """The outputs that a name stands for; None if only the run knows which."""
        constant = all(self._is_constant(index, home) for index in indices_in(target))
        try:
            return frozenset(self._names.outputs(target, Scope("", home))) if constant else None
        except SourceError:
            return None

    def data_read(self, expressions: Iterable[Expression], home: Module) -> frozenset[str]:
        """Lower-case names of the data that expressions read; outputs as ``$OUT[3]``."""
        found: set[str] = set()
        for expression in expressions:
            for datum in data_in(expression):
                found |= self.outputs(datum, home) or {datum.name}
                found |= self.data_read(indices_in(datum), home)
        return frozenset(found)

    def asks(self, expressions: Iterable[Expression], home: Module) -> bool:
        """Whether routines of the program have a part in expressions."""
        return any(True for _ in self._functions(expressions, home))

    def steps(self, block: Block) -> Sequence[Step[Block]]:
        """See `core.source.execution.steps.Tree.steps`."""
        home = self._homes.get(id(block)) or self._scopes[-1].module
        return [self._step(statement, home) for statement in block.statements]

    def _step(self, statement: Statement, home: Module) -> Step[Block]:
        if isinstance(statement, Label):
            return Step(mark=statement.name)
        if isinstance(statement, Goto):
            return Step(exit=Exit.JUMP, label=statement.name)
        if isinstance(statement, ExitStatement):
            return Step(exit=Exit.LOOP)
        if isinstance(statement, Halt):
            return Step(halts=True)
        if isinstance(statement, SplineBlock):
            return Step(moves=True)
        evaluated = tuple(_evaluated(statement))
        names = self.data_read(evaluated, home)
        functions = tuple(self._functions(evaluated, home))
        handed = frozenset(
            argument.name
            for expression in evaluated
            for call in calls_in(expression)
            for argument in call.arguments
            if isinstance(argument, Name)
        )
        inner = tuple(inner_blocks(statement))
        if inner:
            for block in inner:
                self._homes[id(block)] = home
            counter = {statement.counter.name} if isinstance(statement, For) else NOTHING
            return Step(
                reads=names,
                writes=handed | counter,
                calls=functions,
                asks=bool(functions),
                inner=inner,
                loop=isinstance(statement, _LOOPS),
                exhaustive=isinstance(statement, If)
                or (isinstance(statement, Switch) and statement.otherwise is not None),
            )
        if isinstance(statement, Invoke):
            return self._invoked(statement.call, home, functions, names, handed)
        writes, outputs = self._assigned(statement, home)
        return Step(
            moves=isinstance(statement, MotionInstruction),
            writes=handed | writes,
            made_of=names,
            outputs=outputs,
            calls=functions,
            asks=bool(functions),
            exit=Exit.ROUTINE if isinstance(statement, Return) else None,
        )

    def _assigned(
        self, statement: Statement, home: Module
    ) -> tuple[frozenset[str], frozenset[str] | None]:
        """The data and the outputs that an assignment writes."""
        if not isinstance(statement, Assign):
            return NOTHING, NOTHING
        target = statement.target
        outputs = self.outputs(target, home)
        if outputs is None:
            is_output = target.name in OUTPUTS
            return (NOTHING, None) if is_output else (frozenset({target.name}), NOTHING)
        return (NOTHING, outputs) if outputs else (frozenset({target.name}), NOTHING)

    def _invoked(
        self,
        call: Call,
        home: Module,
        functions: tuple[Block, ...],
        names: frozenset[str],
        handed: frozenset[str],
    ) -> Step[Block]:
        written = handed | {a.name for a in call.arguments if isinstance(a, Name)}
        body = self.called(call, home)
        if body is not None:
            calls = (*functions, body)
            return Step(writes=written, made_of=names, calls=calls, asks=True)
        outputs: frozenset[str] | None = NOTHING
        if call.name not in NATIVE:
            known = kept(call.name)
            if call.name == "pulse":
                first = call.arguments[0] if call.arguments else None
                outputs = self.outputs(first, home) if isinstance(first, Name) else None
            elif known is None or known.outputs:
                outputs = None
        return Step(
            writes=written, made_of=names, outputs=outputs, calls=functions, asks=bool(functions)
        )

    def _functions(self, expressions: Iterable[Expression], home: Module) -> Iterator[Block]:
        for expression in expressions:
            for call in calls_in(expression):
                body = self.called(call, home)
                if body is not None:
                    yield body

    def _is_constant(self, index: Expression, home: Module) -> bool:
        if isinstance(index, Name) and not index.path:
            cell = self._data.find(index.name, Scope("", home))
            return cell is not None and cell.constant
        return isinstance(index, Number)


def inner_blocks(statement: Statement) -> Iterator[Block]:
    """The blocks that a statement holds."""
    if isinstance(statement, If):
        yield statement.body
        yield statement.otherwise
    elif isinstance(statement, Switch):
        yield from (case.body for case in statement.cases)
        if statement.otherwise is not None:
            yield statement.otherwise
    elif isinstance(statement, _LOOPS):
        yield statement.body


def _evaluated(statement: Statement) -> Iterator[Expression]:
    """The expressions that a statement evaluates itself."""
    if isinstance(statement, If | While | Repeat):
        yield statement.condition
    elif isinstance(statement, Switch):
        yield statement.subject
        yield from (value for case in statement.cases for value in case.values)
    elif isinstance(statement, For):
        yield from (statement.counter, statement.start, statement.stop)
        if statement.step is not None:
            yield statement.step
    elif isinstance(statement, Assign):
        yield statement.value
        yield from indices_in(statement.target)
    elif isinstance(statement, Invoke):
        yield from (argument for argument in statement.call.arguments if argument is not None)
    elif isinstance(statement, MotionInstruction):
        yield from statement.targets
    elif isinstance(statement, Return) and statement.value is not None:
        yield statement.value
    elif isinstance(statement, WaitSec):
        yield statement.time
