"""Blocks of lines: what stands between ``IF`` and ``ENDIF``, ``FOR`` and ``ENDFOR``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from ...errors import SourceError
from .expressions import Expression, Number, Operation
from .statements import (
    Assign,
    Body,
    Close,
    If,
    Jump,
    Label,
    Open,
    Otherwise,
    Statement,
)


@dataclass
class _Block:
    """A block that is being read.

    Args:
        opened: its first line; None of a routine.
        parts: the condition and the statements of each of its branches.
    """

    opened: Open | None
    parts: list[tuple[Otherwise | None, list[Statement]]] = field(default_factory=list)

    @property
    def own(self) -> list[Statement]:
        return self.parts[-1][1]


def nested(statements: Sequence[Statement]) -> list[Statement]:
    """Statements with the blocks among them as one statement each: an `If`, or what a loop is made
    of.

    Raises:
        SourceError: a block is not opened, or not closed.
    """
    blocks = [_Block(None, [(None, [])])]
    for statement in statements:
        here = blocks[-1]
        if isinstance(statement, Open):
            blocks.append(_Block(statement, [(None, [])]))
        elif isinstance(statement, Otherwise) and statement.then is not None:
            _chain(here.own, statement)
        elif isinstance(statement, Otherwise):
            if here.opened is None or here.opened.condition is None:
                raise SourceError("no condition stands before it", statement.span)
            here.parts.append((statement, []))
        elif isinstance(statement, Close):
            if here.opened is None:
                raise SourceError("no block is open here", statement.span)
            blocks.pop()
            blocks[-1].own.extend(_made(here.opened, here.parts))
        else:
            here.own.append(statement)
    if (left := blocks[-1].opened) is not None:
        raise SourceError("the block that begins here has no end", left.span)
    return blocks[0].own


def _chain(own: list[Statement], other: Otherwise) -> None:
    """Put what is done otherwise into the `If` before it."""
    if not own or not isinstance(own[-1], If):
        raise SourceError("no condition stands before it", other.span)
    own[-1] = _with_otherwise(own[-1], other)


def _with_otherwise(first: If, other: Otherwise) -> If:
    if first.otherwise is not None:
        (inner,) = first.otherwise.statements
        if not isinstance(inner, If):
            raise SourceError("what is done otherwise is said already", other.span)
        return replace(first, otherwise=Body((_with_otherwise(inner, other),)))
    assert other.then is not None
    done: Statement = other.then
    if other.condition is not None:
        done = If(other.span, other.condition, Body((done,)))
    return replace(first, otherwise=Body((done,)))


def _made(
    opened: Open, parts: Sequence[tuple[Otherwise | None, list[Statement]]]
) -> Iterator[Statement]:
    if opened.condition is None:
        yield from _loop(opened, parts[0][1])
        return
    rest: Body | None = None
    for other, statements in reversed(parts[1:]):
        assert other is not None
        body = Body(tuple(statements))
        rest = (
            body
            if other.condition is None
            else Body((If(other.span, other.condition, body, rest),))
        )
    yield If(opened.span, opened.condition, Body(tuple(parts[0][1])), rest)


def _loop(opened: Open, inside: Sequence[Statement]) -> Iterator[Statement]:
    """A counted loop by labels: its condition is asked before the first pass and behind each."""
    counter, first, last = opened.counter, opened.first, opened.last
    assert counter is not None and first is not None and last is not None
    span, key = opened.span, f"loop {opened.span.start}"
    onwards: Expression = Operation(span, "+", (counter, Number(span, float(opened.step))))
    beyond, within = (">", "<=") if opened.step > 0 else ("<", ">=")
    yield Assign(span, counter, first)
    yield If(span, Operation(span, beyond, (counter, last)), Body((Jump(span, f"{key} end"),)))
    yield Label(span, key)
    yield from inside
    yield Assign(span, counter, onwards)
    yield If(span, Operation(span, within, (counter, last)), Body((Jump(span, key),)))
    yield Label(span, f"{key} end")
