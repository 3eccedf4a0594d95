"""The syntax tree of RAPID: frozen nodes, each with the place it stands at.

Nothing here is evaluated or checked beyond its form; names keep their spelling in ``text`` and are
looked up by ``name``, which is lower case.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field

from ....core.source.text import nodes
from ....core.source.text.nodes import Looping, Node, Term
from ....core.source.text.quick import quick

Block = nodes.Block
Case = nodes.Case
Expression = nodes.Expression
Goto = nodes.Goto
Label = nodes.Label
Operation = nodes.Operation
Return = nodes.Return
Statement = nodes.Statement
Test = nodes.Switch
Text = nodes.Text
Truth = nodes.Truth
Unary = nodes.Unary
Unread = nodes.Unread
Unreadable = nodes.Unreadable
While = nodes.While


@quick(frozen=True, slots=True)
class Number(Term):
    """A number, with its sign if one stands before it."""

    value: float


@quick(frozen=True, slots=True)
class Aggregate(Term):
    """``[a, b, …]``: a record or an array."""

    items: tuple[Expression, ...]

    @property
    def parts(self) -> Sequence[Expression]:
        return self.items


@quick(frozen=True, slots=True)
class Packed(Term):
    """An `Aggregate` of nothing but numbers, two brackets deep at most: most of any program's text.

    Its parts have no nodes of their own until somebody asks for them (`packed`).

    Args:
        text: as it stands in the source.
    """

    value: tuple[float | tuple[float, ...], ...]
    text: str


@quick(frozen=True, slots=True)
class Name(Term):
    """A datum or a part of it: ``p10``, ``p10.trans.x``, ``path{3}``.

    Args:
        name: of the datum, lower case.
        text: as it stands in the source.
        path: components (lower-case words) and tuples of indices (expressions), left to right.
    """

    name: str
    text: str
    path: tuple[str | tuple[Expression, ...], ...] = ()

    @property
    def parts(self) -> Sequence[Expression]:
        return [index for step in self.path if not isinstance(step, str) for index in step]


@quick(frozen=True, slots=True)
class Call(Term):
    """A function's value: ``Offs(p10, 0, 0, 50)``."""

    name: str
    text: str
    arguments: tuple[Argument, ...]

    @property
    def parts(self) -> Sequence[Expression]:
        return [a.value for a in self.arguments if a.value is not None]


@quick(frozen=True, slots=True)
class Star(Term):
    """``*`` for a position that is kept outside the text."""


@quick(frozen=True, slots=True)
class Argument(Node):
    """An argument of a routine.

    Args:
        option: name of an optional argument (lower case), None for a required one.
        value: None for a switch.
        conditional: given as ``\\Option?parameter``: passed on only if the parameter is present.
        parameter: name of the required argument (lower case) where it is written: ``n:=1``.
    """

    value: Expression | None
    option: str | None = None
    conditional: bool = False
    parameter: str | None = None


@quick(frozen=True, slots=True)
class Assign(Statement):
    """``target := value;``"""

    target: Name
    value: Expression


@quick(frozen=True, slots=True)
class Invoke(Statement):
    """A call of a procedure or an instruction: ``MoveL p10, v100, z10, tool0;``"""

    name: str
    text: str
    arguments: tuple[Argument, ...]


@quick(frozen=True, slots=True)
class LateInvoke(Statement):
    """A call of the procedure that a string names: ``%"part" + n%;``"""

    routine: Expression
    arguments: tuple[Argument, ...]


@quick(frozen=True, slots=True)
class Branch:
    """Statements and the condition under which they run."""

    condition: Expression
    body: Block


@quick(frozen=True, slots=True)
class If(Statement):
    """``IF … ELSEIF … ELSE … ENDIF``, or the compact ``IF condition statement``."""

    branches: tuple[Branch, ...]
    otherwise: Block | None

    @property
    def blocks(self) -> Sequence[Block]:
        bodies = [branch.body for branch in self.branches]
        return bodies if self.otherwise is None else [*bodies, self.otherwise]


@quick(frozen=True, slots=True)
class For(Looping):
    """``FOR name FROM start TO stop STEP step DO … ENDFOR``"""

    name: str
    start: Expression
    stop: Expression
    step: Expression | None


@quick(frozen=True, slots=True)
class Keyword(nodes.Keyword):
    """A statement that is one word with, perhaps, an argument that is not read here.

    Its word is ``exit``, ``raise``, ``retry``, ``trynext``, ``connect``, or ``placeholder`` for an
    unfilled ``<SMT>``.

    Args:
        name: of the trap routine that is connected, lower case.
        value: the number that is raised.
    """

    name: str = ""
    value: Expression | None = None


@quick(frozen=True, slots=True)
class Declaration(Node):
    """``[LOCAL] CONST|VAR|PERS type name{dimensions} := value;``

    Args:
        kind: ``const``, ``var`` or ``pers``.
        type: lower-case name of the type.
        local: known in its own module only.
    """

    kind: str
    type: str
    name: str
    text: str
    dimensions: tuple[Expression, ...] = ()
    value: Expression | None = None
    local: bool = False


@quick(frozen=True, slots=True)
class Parameter(Node):
    """A parameter of a routine.

    Args:
        mode: ``in``, ``inout``, ``var``, ``pers``.
        type: lower-case name of the type; ``switch`` for a switch.
        name: lower case.
        text: the name as it is declared.
        dimensions: number of them, 0 if it is no array.
        optional: written with ``\\``.
        group: parameters of one group exclude each other.
    """

    mode: str
    type: str
    name: str
    text: str
    dimensions: int
    optional: bool
    group: int


@quick(frozen=True, slots=True)
class Handler:
    """``ERROR`` or ``ERROR (number, …)`` at the end of a routine.

    Args:
        numbers: the errors that it takes; empty for all.
    """

    numbers: tuple[Expression, ...]
    body: Block


@quick(frozen=True, slots=True)
class Routine(Node):
    """A ``PROC``, ``FUNC`` or ``TRAP``.

    Args:
        kind: ``proc``, ``func`` or ``trap``.
        returns: type of a function's value.
        handler: what its ERROR part runs; None if it has none. UNDO and BACKWARD are not kept.
        local: known in its own module only.
    """

    kind: str
    name: str
    text: str
    parameters: tuple[Parameter, ...]
    declarations: tuple[Declaration, ...]
    body: Block
    returns: str | None = None
    handler: Handler | None = None
    local: bool = False


@quick(frozen=True, slots=True)
class RecordDefinition(Node):
    """``RECORD name … ENDRECORD``: component types and names, lower case."""

    name: str
    components: tuple[tuple[str, str], ...]
    local: bool = False


@quick(frozen=True, slots=True)
class AliasDefinition(Node):
    """``ALIAS type name;``"""

    name: str
    type: str
    local: bool = False


@quick(frozen=True)
class Module(Node):
    """``MODULE name … ENDMODULE``"""

    name: str
    text: str
    attributes: tuple[str, ...] = ()
    types: tuple[RecordDefinition | AliasDefinition, ...] = ()
    declarations: tuple[Declaration, ...] = ()
    routines: tuple[Routine, ...] = field(default=())
