"""Assignments: to variables, elements of lists and poses, parts of structs."""

from __future__ import annotations

from dataclasses import replace

from ....core.errors import SourceError
from ..syntax.tree import Assign, Expression, Index, Member, Name, Place
from .elements import replaced, whole
from .evaluator import Evaluator
from .located import Host, Located
from .provenance import Sources, elements
from .scope import Cell, Scope
from .values import Solution, Struct, Unknown, Value, ValueFault


class Assignments:
    """Changes variables.

    Args:
        evaluator: of the expressions that are assigned.
        host: see `Host`.

    Attributes:
        changes: how often a variable got another value.
    """

    def __init__(self, evaluator: Evaluator, host: Host) -> None:
        self.changes = 0
        self._evaluator = evaluator
        self._host = host

    def carry_out(self, assign: Assign, scope: Scope) -> None:
        """``target = value``

        Raises:
            SourceError: the value is none, or the target has no such part.
        """
        found = self._evaluator.locate(assign.value, scope)
        self.store(assign.target, found, scope, assign.storage)

    def store(self, target: Place, found: Located, scope: Scope, storage: str = "") -> None:
        """Give a variable, or a part of it, another value.

        Args:
            storage: ``global``, ``local`` or empty.

        Raises:
            SourceError: the target has no such part.
        """
        if isinstance(target, Name):
            cell = _cell(target.text, scope, storage)
            self.changes += cell.value != found.value
            cell.value = found.value
            cell.sources = _named(found.sources, target.text)
            return
        base = self._place(target.base)
        holder = self._evaluator.locate(base, scope)
        if isinstance(target, Index):
            changed = self._with_element(target, holder, found, scope)
        else:
            changed = Located(self._with_member(target, holder.value, found.value))
            self._evaluator.consume(found.sources)
        self.store(base, changed, scope)

    def _place(self, expression: Expression) -> Place:
        if isinstance(expression, Name | Index | Member):
            return expression
        raise SourceError(
            "this cannot be assigned: it is no variable", self._evaluator.span(expression)
        )

    def _with_element(
        self, target: Index, holder: Located, found: Located, scope: Scope
    ) -> Located:
        value = holder.value
        if isinstance(value, Solution):
            value = self._host.joints(value)
        indices = [self._evaluator.plain(index, scope) for index in target.indices]
        unknown = next((v for v in (value, *indices) if isinstance(v, Unknown)), None)
        if unknown is not None:
            self._evaluator.consume(found.sources)
            return Located(unknown)
        if isinstance(value, tuple):
            self._host.work(len(value), self._evaluator.span(target))
        try:
            changed = replaced(value, indices, found.value)
        except ValueFault as fault:
            raise self._evaluator.fault(fault, target) from None
        if len(indices) != 1 or not isinstance(value, tuple) or len(found.sources) > 1:
            self._evaluator.consume(found.sources)
            return Located(changed)
        sources = list(elements(holder.sources, len(value)))
        sources[whole(indices[0])] = found.sources[0] if found.sources else None
        return Located(changed, tuple(sources) if any(sources) else ())

    def _with_member(self, target: Member, value: Value, part: Value) -> Value:
        if isinstance(value, Unknown):
            return value
        if not isinstance(value, Struct) or target.name not in value.names:
            raise self._evaluator.no_member(target, value)
        return value.with_part(target.name, part)


def _cell(name: str, scope: Scope, storage: str) -> Cell:
    if storage == "global":
        return scope.root().own(name)
    if storage == "local":
        return scope.own(name)
    return scope.find(name) or scope.own(name)


def _named(sources: Sources, datum: str) -> Sources:
    """The sources as those of a variable, where they stand at the place of assignment."""
    if len(sources) == 1:
        only = sources[0]
        return (only.named(datum),) if only is not None and only.datum is None else sources
    return tuple(
        [
            replace(s, datum=f"{datum}[{k}]") if s is not None and s.datum is None else s
            for k, s in enumerate(sources)
        ]
    )
