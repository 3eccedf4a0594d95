"""KRL's statements as the rules for branches and loops see them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress

from ....core.errors import SourceError
from ....core.source.execution.control_flow.steps import NOTHING, PLACE, Exit, Step
from ....core.source.text.lexer import words
from ..motion.bas import set_by
from ..syntax import tree
from ..syntax.traversal import calls_in, data_in, indices_in
from ..values.data import Data
from ..values.elements import Names
from ..values.functions import COMPUTED
from ..values.predefined import MOTION, OUTPUTS, POSITION
from ..values.scope import Module, Scope
from .instructions import kept

NATIVE = frozenset({"bas"})
"""Routines of KUKA's own that are carried out natively."""
_MOVING = words(
    "ptp lin circ ptp_rel lin_rel circ_rel spl sptp slin scirc spl_rel sptp_rel slin_rel scirc_rel"
)
_LOOPS = (tree.For, tree.While, tree.Repeat, tree.Loop)


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
        self._routines: dict[int, tree.Routine] = {}

    def called(self, call: tree.Call, home: Module) -> tree.Block | None:
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
        self._routines[id(routine.body)] = routine
        return routine.body

    def routine(self, body: tree.Block) -> tuple[tree.Routine, Module] | None:
        """The routine of a body, and its module; None of a block that is no routine's."""
        routine = self._routines.get(id(body))
        return None if routine is None else (routine, self._homes[id(body)])

    def own(self, block: tree.Block) -> frozenset[str]:
        """See `core.source.execution.control_flow.steps.Tree.own`."""
        routine = self._routines.get(id(block))
        if routine is None:
            return NOTHING
        given = {one.name for one in routine.parameters}
        declared = (one for one in block.statements if isinstance(one, tree.Declaration))
        return frozenset(given.union(one.name for one in declared))

    def outputs(self, target: tree.Name, home: Module) -> frozenset[str] | None:
        """The outputs that a name stands for; None if only the run knows which."""
        constant = all(self._is_constant(index, home) for index in indices_in(target))
        try:
            return frozenset(self._names.outputs(target, Scope("", home))) if constant else None
        except SourceError:
            return None

    def data_read(self, expressions: Iterable[tree.Expression], home: Module) -> frozenset[str]:
        """Lower-case names of the data that expressions read; outputs as ``$OUT[3]``."""
        found: set[str] = set()
        for expression in expressions:
            for datum in data_in(expression):
                found |= self.outputs(datum, home) or {datum.name}
                if datum.name in POSITION:
                    found.add(PLACE)
                found |= self.data_read(indices_in(datum), home)
        return frozenset(found)

    def asks(self, expressions: Iterable[tree.Expression], home: Module) -> bool:
        """Whether routines of the program have a part in expressions."""
        return any(True for _ in self._functions(expressions, home))

    def steps(self, block: tree.Block) -> Sequence[Step[tree.Block]]:
        """See `core.source.execution.control_flow.steps.Tree.steps`."""
        home = self._homes.get(id(block)) or self._scopes[-1].module
        return [self._step(statement, home) for statement in block.statements]

    def _step(self, statement: tree.Statement, home: Module) -> Step[tree.Block]:
        if isinstance(statement, tree.Label):
            return Step(mark=statement.name)
        if isinstance(statement, tree.Goto):
            return Step(exit=Exit.JUMP, label=statement.name)
        if isinstance(statement, tree.Exit):
            return Step(exit=Exit.LOOP)
        if isinstance(statement, tree.Halt):
            return Step(halts=True)
        if isinstance(statement, tree.Unread):
            return self.unread(statement, home)
        evaluated = tuple(_evaluated(statement))
        names = self.data_read(evaluated, home)
        functions = tuple(self._functions(evaluated, home))
        handed = frozenset(
            name
            for expression in evaluated
            for call in calls_in(expression)
            for name in self._handed(call, home)
        )
        inner = tuple(statement.blocks)
        if inner:
            for block in inner:
                self._homes[id(block)] = home
            counter = {statement.counter.name} if isinstance(statement, tree.For) else NOTHING
            return Step(
                reads=names,
                writes=handed | counter,
                calls=functions,
                asks=bool(functions),
                inner=inner,
                loop=isinstance(statement, _LOOPS),
                exhaustive=isinstance(statement, tree.If)
                or (isinstance(statement, tree.Switch) and statement.otherwise is not None),
            )
        if isinstance(statement, tree.Invoke):
            return self._invoked(statement.call, home, functions, names, handed)
        writes, outputs = self._assigned(statement, home)
        return Step(
            moves=isinstance(statement, tree.MotionInstruction | tree.SplineBlock),
            writes=handed | writes,
            sets=writes & MOTION,
            made_of=names,
            outputs=outputs,
            calls=functions,
            asks=bool(functions),
            exit=Exit.ROUTINE if isinstance(statement, tree.Return) else None,
        )

    def unread(self, statement: tree.Unread, home: Module) -> Step[tree.Block]:
        """What a damaged statement may do, by the words in it."""
        target = statement.target
        bodies: list[tree.Block | None] = []
        for word in sorted(statement.words):
            with suppress(SourceError):  # said where it is called
                bodies.append(self.called(tree.Call(statement.span, word, word, ()), home))
        return Step(
            moves=not _MOVING.isdisjoint(statement.words),
            writes=frozenset({target.name}) if isinstance(target, tree.Name) else NOTHING,
            sets=set_by(statement.words) if NATIVE & statement.words else NOTHING,
            calls=tuple(body for body in bodies if body is not None),
        )

    def _assigned(
        self, statement: tree.Statement, home: Module
    ) -> tuple[frozenset[str], frozenset[str] | None]:
        """The data and the outputs that an assignment writes."""
        if not isinstance(statement, tree.Assign):
            return NOTHING, NOTHING
        target = statement.target
        outputs = self.outputs(target, home)
        if outputs is None:
            is_output = target.name in OUTPUTS
            return (NOTHING, None) if is_output else (frozenset({target.name}), NOTHING)
        return (NOTHING, outputs) if outputs else (frozenset({target.name}), NOTHING)

    def _invoked(
        self,
        call: tree.Call,
        home: Module,
        functions: tuple[tree.Block, ...],
        names: frozenset[str],
        handed: frozenset[str],
    ) -> Step[tree.Block]:
        body = self.called(call, home)
        written = handed.union(self._handed(call, home))
        if body is not None:
            calls = (*functions, body)
            return Step(writes=written, made_of=names, calls=calls, asks=True)
        outputs: frozenset[str] | None = NOTHING
        known = None if call.name in NATIVE else kept(call.name)
        if call.name not in NATIVE:
            if call.name == "pulse":
                first = call.arguments[0] if call.arguments else None
                outputs = self.outputs(first, home) if isinstance(first, tree.Name) else None
            elif known is None or known.outputs:
                outputs = None
        return Step(
            sent=known is not None and known.sent,
            writes=written,
            sets=set_by(_commands(call)) if call.name in NATIVE else NOTHING,
            made_of=names,
            outputs=outputs,
            calls=functions,
            asks=bool(functions),
        )

    def _handed(self, call: tree.Call, home: Module) -> Iterator[str]:
        """Names of the data that a call may write: those that are passed by reference."""
        body = self.called(call, home)
        found = None if body is None else self.routine(body)
        known = kept(call.name) if found is None else None
        if found is None and (call.name in COMPUTED or (known and not known.writes)):
            return
        for k, argument in enumerate(call.arguments):
            given = found[0].parameters[k : k + 1] if found is not None else ()
            if isinstance(argument, tree.Name) and all(p.by_reference for p in given):
                yield argument.name

    def _functions(
        self, expressions: Iterable[tree.Expression], home: Module
    ) -> Iterator[tree.Block]:
        for expression in expressions:
            for call in calls_in(expression):
                body = self.called(call, home)
                if body is not None:
                    yield body

    def _is_constant(self, index: tree.Expression, home: Module) -> bool:
        if isinstance(index, tree.Name) and not index.path:
            cell = self._data.find(index.name, Scope("", home))
            return cell is not None and cell.constant
        return isinstance(index, tree.Number)


def _evaluated(statement: tree.Statement) -> Iterator[tree.Expression]:
    """The expressions that a statement evaluates itself."""
    if isinstance(statement, tree.If | tree.While | tree.Repeat):
        yield statement.condition
    elif isinstance(statement, tree.Switch):
        yield statement.subject
        yield from (value for case in statement.cases for value in case.values)
    elif isinstance(statement, tree.For):
        yield from (statement.counter, statement.start, statement.stop)
        if statement.step is not None:
            yield statement.step
    elif isinstance(statement, tree.Assign):
        yield statement.value
        yield from indices_in(statement.target)
    elif isinstance(statement, tree.Invoke):
        yield from (argument for argument in statement.call.arguments if argument is not None)
    elif isinstance(statement, tree.MotionInstruction):
        yield from statement.targets
    elif isinstance(statement, tree.SplineBlock):
        for segment in statement.body:
            yield from _evaluated(segment)
    elif isinstance(statement, tree.Return) and statement.value is not None:
        yield statement.value
    elif isinstance(statement, tree.WaitSec):
        yield statement.time


def _commands(call: tree.Call) -> frozenset[str]:
    """The command of a call of BAS, where it is written as a constant."""
    first = call.arguments[0] if call.arguments else None
    return frozenset({first.name} if isinstance(first, tree.Constant) else ())
