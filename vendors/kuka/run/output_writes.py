"""Writes whose moment is not certain: of outputs by pulses, triggers, interrupts and routines
without their text; of data by interrupts."""

from __future__ import annotations

import re

from ....core.errors import SourceError, Span
from ....core.source.execution.control_flow.analysis import Analysis
from ....core.source.execution.transcript import Notes
from ....core.source.text.files import SourceText
from ..syntax.cursor import Cursor
from ..syntax.lexer import tokenize
from ..syntax.statements import parse_statement
from ..syntax.tree import Assign, Block, Call, Declaration, Name, Statement
from ..values.data import Data
from ..values.elements import Names
from ..values.predefined import MOTION, OUTPUTS, POSITION
from ..values.scope import Scope
from .analysis import KrlTree

_HANDLER = re.compile(r"\bDO\s+(.+)", re.IGNORECASE | re.DOTALL)
_PRIORITY = re.compile(r"\bPRIO\s*=.*", re.IGNORECASE | re.DOTALL)

Written = frozenset[str] | None
"""Names of outputs; None for any of them."""


class OutputWrites:
    """Follows such writes.

    Args:
        data: of the program, with what its outputs hold.
        names: finds the outputs that a name stands for.
        tree: the program's statements.
        analysis: what they write.
        notes: of the run.
    """

    def __init__(
        self, data: Data, names: Names, tree: KrlTree, analysis: Analysis[Block], notes: Notes
    ) -> None:
        self._data = data
        self._notes = notes
        self._tree = tree
        self._names = names
        self._analysis = analysis
        self._coming: list[Written] = []

    def pulsed(self, call: Call, scope: Scope) -> None:
        """``PULSE($OUT[1],TRUE,0.5)``, or another call that may write outputs."""
        self._data.outputs.forget(self._by_call(call, scope))

    def triggered(self, action: str, scope: Scope) -> None:
        """A TRIGGER will carry an action out, on the way of the next motion."""
        self._coming.append(self._by_action(action, scope))

    def driven(self) -> None:
        """A motion has been read, with what was laid on its way."""
        coming, self._coming = self._coming, []
        for written in coming:
            self._data.outputs.forget(written)

    def interrupted(self, text: str, scope: Scope, span: Span) -> None:
        """``INTERRUPT DECL 3 WHEN … DO routine()``: its routine may run at any time."""
        handler = _HANDLER.search(text)
        if handler is None:
            return
        self._data.outputs.share(self._by_action(handler[1], scope))
        action = Block(_statements(handler[1]) or ())
        if self._analysis.moves(action):
            self._notes.once(
                f"interrupt {handler[1]}",
                f"the interrupt's {handler[1].strip()} moves the robot whenever it comes, which "
                "nobody knows: what it drives is not in the path and the times; the program is "
                "driven as if it never came",
                span,
            )
        writer = f"the interrupt's {' '.join(_PRIORITY.sub('', handler[1]).split())}"
        for part, names in self._analysis.written_apart(action):
            found = self._tree.routine(part)
            where, own = scope, frozenset[str]()
            if found is not None:
                routine, module = found
                where = Scope("", module)
                declared = (s.name for s in part.statements if isinstance(s, Declaration))
                own = frozenset((*declared, *(p.name for p in routine.parameters)))
            for name in sorted(names - own - MOTION - OUTPUTS.keys() - POSITION.keys()):
                datum = Name(span, name, name.upper())
                cell = self._data.find(name, where) or self._data.implicit(datum)
                if not cell.constant and cell.signal is None:
                    cell.writer, cell.awaited = writer, False
                    cell.found = _places_in(part).get(name)

    # -------------------------------------------------------------------- inside

    def _by_action(self, text: str, scope: Scope) -> Written:
        statements = _statements(text)
        if statements is None:
            return None
        if len(statements) == 1 and isinstance(statements[0], Assign):
            return self._named(statements[0].target, scope)
        return self._analysis.outputs_written(Block(statements))

    def _by_call(self, call: Call, scope: Scope) -> Written:
        if call.name != "pulse":
            return None
        first = call.arguments[0] if call.arguments else None
        return self._named(first, scope) if isinstance(first, Name) else None

    def _named(self, target: Name, scope: Scope) -> Written:
        try:
            return frozenset(self._names.outputs(target, scope))
        except SourceError:  # an index that only the run knows
            return None


def _statements(text: str) -> tuple[Statement, ...] | None:
    """What an interrupt or a trigger carries out; None if it is no statement."""
    try:
        source = SourceText(_PRIORITY.sub("", text).strip(), "")
        return parse_statement(Cursor(tokenize(source)))
    except SourceError:
        return None


def _places_in(block: Block) -> dict[str, str]:
    """The data that are given the place where the robot is, and how: ``pose`` or ``axes``."""
    return {
        s.target.name: POSITION[s.value.name]
        for s in block.statements
        if isinstance(s, Assign)
        and isinstance(s.value, Name)
        and s.value.name in POSITION
        and not (s.target.path or s.value.path)
    }
