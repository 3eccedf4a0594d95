"""Assignments: to variables, elements of lists and poses, parts of structs."""

from __future__ import annotations

from dataclasses import replace

from ..syntax.tree import Expression, Index, Member, Name, Place
from .elements import replaced, whole
from .evaluator import Evaluation, locate, no_member, plain
from .located import Located
from .provenance import Sources, elements
from .scope import Scope, Variable
from .values import PendingInverse, Struct, Unknown, Value, ValueFault


def store(run: Evaluation, target: Place, found: Located, scope: Scope, storage: str = "") -> None:
    """Give a variable, or a part of it, another value.

    Args:
        storage: ``global``, ``local`` or empty.

    Raises:
        SourceError: the target has no such part.
    """
    if isinstance(target, Name):
        cell = _cell(target.text, scope, storage)
        cell.value = found.value
        run.course.sets(cell)
        cell.sources = _named(found.sources, target.text)
        return
    base = _place(run, target.base)
    holder = locate(run, base, scope)
    if isinstance(target, Index):
        changed = _with_element(run, target, holder, found, scope)
    else:
        changed = Located(_with_member(run, target, holder.value, found.value))
        run.literals.consume(found.sources)
    store(run, base, changed, scope)


def _place(run: Evaluation, expression: Expression) -> Place:
    if isinstance(expression, Name | Index | Member):
        return expression
    raise run.texts.error_at("this cannot be assigned: it is no variable", expression)


def _with_element(
    run: Evaluation, target: Index, holder: Located, found: Located, scope: Scope
) -> Located:
    value = holder.value
    if isinstance(value, PendingInverse):
        value = run.joints(value)
    indices = [plain(run, index, scope) for index in target.indices]
    unknown = next((v for v in (value, *indices) if isinstance(v, Unknown)), None)
    if unknown is not None:
        run.literals.consume(found.sources)
        return Located(unknown)
    if isinstance(value, tuple):
        run.work(len(value), run.texts.span_of(target))
    try:
        changed = replaced(value, indices, found.value)
    except ValueFault as fault:
        raise run.texts.stop_at(fault, target) from None
    if len(indices) != 1 or not isinstance(value, tuple) or len(found.sources) > 1:
        run.literals.consume(found.sources)
        return Located(changed)
    sources = list(elements(holder.sources, len(value)))
    sources[whole(indices[0])] = found.sources[0] if found.sources else None
    return Located(changed, tuple(sources) if any(sources) else ())


def _with_member(run: Evaluation, target: Member, value: Value, part: Value) -> Value:
    if isinstance(value, Unknown):
        return value
    if not isinstance(value, Struct) or target.name not in value.names:
        raise no_member(run, target, value)
    return value.with_part(target.name, part)


def _cell(name: str, scope: Scope, storage: str) -> Variable:
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
