"""Blocks of lines: what stands between ``IF`` and ``ENDIF``, ``FOR`` and ``ENDFOR``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from ...errors import SourceError, Span
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
            blocks[-1].own.extend(_made(here.opened, here.parts, statement))
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
    opened: Open, parts: Sequence[tuple[Otherwise | None, list[Statement]]], close: Close
) -> Iterator[Statement]:
    if opened.counter is not None:
        yield from _counted(opened, parts[0][1])
        return
    if opened.repeats:
        yield from _repeated(opened, parts[0][1], close)
        return
    if opened.condition is None:
        raise SourceError("the block has no condition", opened.span)
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


def _counted(opened: Open, inside: Sequence[Statement]) -> Iterator[Statement]:
    """A counted loop: its condition is asked before the first pass and behind each."""
    counter, first, last = opened.counter, opened.first, opened.last
    assert counter is not None and first is not None and last is not None
    span = opened.span
    onwards: Expression = Operation(span, "+", (counter, Number(span, opened.step)))
    sign = "<=" if opened.step > 0 else ">="
    yield Assign(span, counter, first)
    again = Operation(span, sign, (counter, last))
    yield from _by_labels(span, again, [*inside, Assign(span, counter, onwards)], True)


def _repeated(opened: Open, inside: Sequence[Statement], close: Close) -> Iterator[Statement]:
    """``WHILE …``, ``REPEAT … UNTIL …``, and a loop without an end."""
    if opened.condition is not None:
        yield from _by_labels(opened.span, opened.condition, inside, True)
    elif close.until is not None:
        again = Operation(close.until.span, "NOT", (close.until,))
        yield from _by_labels(opened.span, again, inside, False)
    else:
        yield from _by_labels(opened.span, None, inside, False)


def _by_labels(
    span: Span, again: Expression | None, inside: Sequence[Statement], first: bool
) -> Iterator[Statement]:
    """A loop; ``first``: whether its condition is asked before the first pass, too."""
    key = f"loop {span.start}"
    end = f"{key} end"
    if first and again is not None:
        never = Operation(again.span, "NOT", (again,))
        yield If(span, never, Body((Jump(span, end),)))
    yield Label(span, key)
    yield from inside
    back = Jump(span, key)
    yield back if again is None else If(span, again, Body((back,)))
    yield Label(span, end)
