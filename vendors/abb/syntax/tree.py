"""The syntax tree of RAPID: frozen nodes, each with the place it stands at.

Nothing here is evaluated or checked beyond its form; names keep their spelling in ``text`` and are
looked up by ``name``, which is lower case.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from ....core.errors import Span


@dataclass(frozen=True, slots=True)
class Number:
    """A number, with its sign if one stands before it."""

    span: Span
    value: float


@dataclass(frozen=True, slots=True)
class Text:
    """A string."""

    span: Span
    value: str


@dataclass(frozen=True, slots=True)
class Truth:
    """``TRUE`` or ``FALSE``."""

    span: Span
    value: bool


@dataclass(frozen=True, slots=True)
class Aggregate:
    """``[a, b, …]``: a record or an array."""

    span: Span
    items: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Packed:
    """An `Aggregate` of nothing but numbers, two brackets deep at most: most of any program's text.

    Its parts have no nodes of their own until somebody asks for them (`packed`).

    Args:
        text: as it stands in the source.
    """

    span: Span
    value: tuple[float | tuple[float, ...], ...]
    text: str


@dataclass(frozen=True, slots=True)
class Name:
    """A datum or a part of it: ``p10``, ``p10.trans.x``, ``path{3}``.

    Args:
        name: of the datum, lower case.
        text: as it stands in the source.
        path: components (lower-case words) and tuples of indices (expressions), left to right.
    """

    span: Span
    name: str
    text: str
    path: tuple[str | tuple[Expression, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class Call:
    """A function's value: ``Offs(p10, 0, 0, 50)``."""

    span: Span
    name: str
    text: str
    arguments: tuple[Argument, ...]


@dataclass(frozen=True, slots=True)
class Unary:
    """``-``, ``+`` or ``not`` before an operand."""

    span: Span
    operator: str
    operand: Expression


@dataclass(frozen=True, slots=True)
class Operation:
    """Operators of one priority, evaluated from left to right: ``a + b - c``.

    A flat list and no nest of pairs, so that a sum of a thousand terms is no deep tree.
    """

    span: Span
    first: Expression
    rest: tuple[tuple[str, Expression], ...]


@dataclass(frozen=True, slots=True)
class Star:
    """``*`` for a position that is kept outside the text."""

    span: Span


Expression = Number | Text | Truth | Aggregate | Packed | Name | Call | Unary | Operation | Star


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a routine.

    Args:
        option: name of an optional argument (lower case), None for a required one.
        value: None for a switch.
        conditional: given as ``\\Option?parameter``: passed on only if the parameter is present.
        parameter: name of the required argument (lower case) where it is written: ``n:=1``.
    """

    span: Span
    value: Expression | None
    option: str | None = None
    conditional: bool = False
    parameter: str | None = None


@dataclass(frozen=True, slots=True)
class Assign:
    """``target := value;``"""

    span: Span
    target: Name
    value: Expression


@dataclass(frozen=True, slots=True)
class Invoke:
    """A call of a procedure or an instruction: ``MoveL p10, v100, z10, tool0;``"""

    span: Span
    name: str
    text: str
    arguments: tuple[Argument, ...]


@dataclass(frozen=True, slots=True)
class LateInvoke:
    """A call of the procedure that a string names: ``%"part" + n%;``"""

    span: Span
    routine: Expression
    arguments: tuple[Argument, ...]


@dataclass(frozen=True, slots=True)
class Branch:
    """Statements and the condition under which they run."""

    condition: Expression
    body: Block


@dataclass(frozen=True, slots=True)
class If:
    """``IF … ELSEIF … ELSE … ENDIF``, or the compact ``IF condition statement``."""

    span: Span
    branches: tuple[Branch, ...]
    otherwise: Block | None


@dataclass(frozen=True, slots=True)
class For:
    """``FOR name FROM start TO stop STEP step DO … ENDFOR``"""

    span: Span
    name: str
    start: Expression
    stop: Expression
    step: Expression | None
    body: Block


@dataclass(frozen=True, slots=True)
class While:
    """``WHILE condition DO … ENDWHILE``"""

    span: Span
    condition: Expression
    body: Block


@dataclass(frozen=True, slots=True)
class Case:
    """One ``CASE a, b:`` of a ``TEST``."""

    values: tuple[Expression, ...]
    body: Block


@dataclass(frozen=True, slots=True)
class Test:
    """``TEST subject CASE … DEFAULT … ENDTEST``"""

    span: Span
    subject: Expression
    cases: tuple[Case, ...]
    otherwise: Block | None


@dataclass(frozen=True, slots=True)
class Label:
    """``name:``"""

    span: Span
    name: str


@dataclass(frozen=True, slots=True)
class Goto:
    """``GOTO name;``"""

    span: Span
    name: str


@dataclass(frozen=True, slots=True)
class Return:
    """``RETURN;`` or ``RETURN value;``"""

    span: Span
    value: Expression | None


@dataclass(frozen=True, slots=True)
class Keyword:
    """A statement that is one word with, perhaps, an argument that is not read here.

    Args:
        word: ``exit``, ``raise``, ``retry``, ``trynext``, ``connect``, or ``placeholder`` for
            an unfilled ``<SMT>``.
        name: of the trap routine that is connected, lower case.
    """

    span: Span
    word: str
    name: str = ""


Statement = Assign | Invoke | LateInvoke | If | For | While | Test | Label | Goto | Return | Keyword


@dataclass(frozen=True)
class Block:
    """Statements in order."""

    statements: tuple[Statement, ...] = ()

    @cached_property
    def labels(self) -> dict[str, int]:
        """Index of the statement behind each label of this block."""
        return {s.name: i + 1 for i, s in enumerate(self.statements) if isinstance(s, Label)}


@dataclass(frozen=True, slots=True)
class Declaration:
    """``[LOCAL] CONST|VAR|PERS type name{dimensions} := value;``

    Args:
        kind: ``const``, ``var`` or ``pers``.
        type: lower-case name of the type.
        local: known in its own module only.
    """

    span: Span
    kind: str
    type: str
    name: str
    text: str
    dimensions: tuple[Expression, ...] = ()
    value: Expression | None = None
    local: bool = False


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a routine.

    Args:
        mode: ``in``, ``inout``, ``var``, ``pers``.
        type: lower-case name of the type; ``switch`` for a switch.
        dimensions: number of them, 0 if it is no array.
        optional: written with ``\\``.
        group: parameters of one group exclude each other.
    """

    span: Span
    mode: str
    type: str
    name: str
    dimensions: int
    optional: bool
    group: int


@dataclass(frozen=True, slots=True)
class Routine:
    """A ``PROC``, ``FUNC`` or ``TRAP``.

    Args:
        kind: ``proc``, ``func`` or ``trap``.
        returns: type of a function's value.
        handlers: which of ``error``, ``undo`` and ``backward`` it has; they are not kept.
        local: known in its own module only.
    """

    span: Span
    kind: str
    name: str
    text: str
    parameters: tuple[Parameter, ...]
    declarations: tuple[Declaration, ...]
    body: Block
    returns: str | None = None
    handlers: tuple[str, ...] = ()
    local: bool = False


@dataclass(frozen=True, slots=True)
class RecordDefinition:
    """``RECORD name … ENDRECORD``: component types and names, lower case."""

    span: Span
    name: str
    components: tuple[tuple[str, str], ...]
    local: bool = False


@dataclass(frozen=True, slots=True)
class AliasDefinition:
    """``ALIAS type name;``"""

    span: Span
    name: str
    type: str
    local: bool = False


@dataclass(frozen=True)
class Module:
    """``MODULE name … ENDMODULE``"""

    span: Span
    name: str
    text: str
    attributes: tuple[str, ...] = ()
    types: tuple[RecordDefinition | AliasDefinition, ...] = ()
    declarations: tuple[Declaration, ...] = ()
    routines: tuple[Routine, ...] = field(default=())
