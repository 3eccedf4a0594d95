"""The syntax tree of KRL: frozen nodes, each with the place it stands at.

Nothing here is evaluated or checked beyond its form. Names keep their spelling in ``text`` and are
looked up by ``name``, which is lower case.
"""

from __future__ import annotations

from collections.abc import Sequence

from ....core.errors import Note, Span
from ....core.source.text import nodes
from ....core.source.text.files import SourceText
from ....core.source.text.nodes import Looping, Term
from ....core.source.text.quick import quick

Block = nodes.Block
Case = nodes.Case
Expression = nodes.Expression
Goto = nodes.Goto
Keyword = nodes.Keyword
Label = nodes.Label
Operation = nodes.Operation
Return = nodes.Return
Statement = nodes.Statement
Switch = nodes.Switch
Text = nodes.Text
Truth = nodes.Truth
Unary = nodes.Unary
Unread = nodes.Unread
While = nodes.While


@quick(frozen=True, slots=True)
class Literal(Expression):
    """A literal, of which programs hold so many that only some are ever asked for their place."""

    source: SourceText
    start: int
    end: int

    @property
    def span(self) -> Span:
        """Where it stands."""
        return self.source.span(self.start, self.end)


@quick(frozen=True, slots=True)
class Number(Literal):
    """A number, with its sign if one stands before it; an ``int`` if it is written as one."""

    value: int | float


@quick(frozen=True, slots=True)
class Constant(Term):
    """A constant of an enumeration, ``#BASE``; its name is lower case."""

    name: str


@quick(frozen=True, slots=True)
class Flat(Literal):
    """An aggregate whose items are literals, kept as text until it is asked for."""


@quick(frozen=True, slots=True)
class Aggregate(Literal):
    """``{X 1,CM {X 0},POINT2[] " "}``: components by lower-case name, and perhaps a type."""

    type: str | None
    items: tuple[tuple[str, Expression], ...]


@quick(frozen=True, slots=True)
class Name(Term):
    """A datum or a part of it: ``P1``, ``P1.X``, ``P[3]``, ``S[]``, ``TOOL_NAME[1,]``.

    Args:
        name: of the datum, lower case.
        text: as it stands in the source.
        path: components (lower-case words) and tuples of indices, left to right; None in a tuple
            is an index left out.
    """

    name: str
    text: str
    path: tuple[str | tuple[Expression | None, ...], ...] = ()


@quick(frozen=True, slots=True)
class Call(Term):
    """A function's value or the call of a routine; None is an argument left out."""

    name: str
    text: str
    arguments: tuple[Expression | None, ...]

    @property
    def parts(self) -> Sequence[Expression]:
        return [argument for argument in self.arguments if argument is not None]


@quick(frozen=True, slots=True)
class Ambiguous(Term):
    """A condition that means two things: ``A == 1 AND B == 2``.

    Args:
        manual: comparisons last, as KUKA's table of priorities has it.
        usual: comparisons before AND and OR, for programs that mean that.
    """

    manual: Expression
    usual: Expression

    @property
    def parts(self) -> Sequence[Expression]:
        return (self.manual,)


@quick(frozen=True, slots=True)
class Assign(Statement):
    """``target = value``"""

    target: Name
    value: Expression


@quick(frozen=True, slots=True)
class Invoke(Statement):
    """A call of a routine as a statement."""

    call: Call


@quick(frozen=True, slots=True)
class MotionInstruction(Statement):
    """A motion instruction.

    Args:
        word: lower case: ``ptp``, ``lin``, ``circ``, with ``_rel`` and with ``s`` before it.
        targets: the end point; for arcs the auxiliary point and the end point.
        angle: ``CA`` of an arc.
        frame: ``#base`` or ``#tool`` of a relative motion, without the sign.
        approximation: ``c_ptp``, ``c_dis`` and so on, in order.
        approximated: where these words stand, or, empty, where they would.
        settings: what follows ``WITH``: system variables of this motion alone.
        passed: a segment of a spline block that another one follows: the robot does not stop.
    """

    word: str
    targets: tuple[Expression, ...]
    angle: Expression | None
    frame: str | None
    approximation: tuple[str, ...]
    approximated: Span
    settings: tuple[Assign, ...]
    passed: bool = False


@quick(frozen=True, slots=True)
class If(Statement):
    """``IF … THEN … ELSE … ENDIF``"""

    condition: Expression
    body: Block
    otherwise: Block

    @property
    def blocks(self) -> Sequence[Block]:
        return (self.body, self.otherwise)


@quick(frozen=True, slots=True)
class For(Looping):
    """``FOR counter = start TO stop STEP step … ENDFOR``"""

    counter: Name
    start: Expression
    stop: Expression
    step: Expression | None


@quick(frozen=True, slots=True)
class Repeat(Looping):
    """``REPEAT … UNTIL condition``"""

    condition: Expression


@quick(frozen=True, slots=True)
class Loop(Looping):
    """``LOOP … ENDLOOP``"""


@quick(frozen=True, slots=True)
class Exit(Statement):
    """``EXIT``: leave the innermost loop."""


@quick(frozen=True, slots=True)
class Halt(Statement):
    """``HALT``"""


@quick(frozen=True, slots=True)
class Continue(Statement):
    """``CONTINUE``: the next statement does not stop the advance run."""


@quick(frozen=True, slots=True)
class WaitSec(Statement):
    """``WAIT SEC time``"""

    time: Expression


@quick(frozen=True, slots=True)
class WaitFor(Statement):
    """``WAIT FOR condition``"""

    condition: Expression


@quick(frozen=True, slots=True)
class Trigger(Statement):
    """``TRIGGER WHEN DISTANCE=0 DELAY=0 DO action``, ``TRIGGER WHEN PATH=… DELAY=… DO action``

    Args:
        path: whether it counts a distance (mm) on the path; else ``place`` is 0 for the start and
            1 for the end of the next motion.
        on_start: the distance counts from the start point and not from the end point.
        delay: ms; None if it is left out.
        action: the text of what is done.
    """

    path: bool
    on_start: bool
    place: Expression
    delay: Expression | None
    action: str


@quick(frozen=True, slots=True)
class SplineBlock(Statement):
    """``SPLINE … ENDSPLINE``, ``PTP_SPLINE … ENDSPLINE``

    Args:
        settings: what follows ``WITH``: system variables of the block alone.
        body: segments (`MotionInstruction`), and what is laid on them.
    """

    word: str
    settings: tuple[Assign, ...]
    body: tuple[Statement, ...]


@quick(frozen=True, slots=True)
class Declaration(Statement):
    """``[GLOBAL] [DECL] [CONST] type name[dimensions] = value``, one for each name.

    Args:
        type: lower-case name of the type.
        dimensions: None stands for one left open.
    """

    type: str
    name: str
    text: str
    shared: bool
    constant: bool
    dimensions: tuple[Expression | None, ...] = ()
    value: Expression | None = None


@quick(frozen=True, slots=True)
class SignalDeclaration(Statement):
    """``SIGNAL name $IN[1] TO $IN[4]``"""

    name: str
    text: str
    first: Name
    last: Name | None


@quick(frozen=True, slots=True)
class StrucDefinition(Statement):
    """``STRUC name REAL A, B, INT C[3]``: components as (type, name, number of dimensions)."""

    name: str
    components: tuple[tuple[str, str, int], ...]


@quick(frozen=True, slots=True)
class EnumDefinition(Statement):
    """``ENUM name A, B``"""

    name: str
    constants: tuple[str, ...]


@quick(frozen=True, slots=True)
class Parameter:
    """A parameter of a routine: ``name:IN`` or ``name:OUT``.

    Args:
        name: lower case.
        text: as it is declared.
    """

    name: str
    text: str
    by_reference: bool


@quick(frozen=True, slots=True, eq=False)
class Routine:
    """A ``DEF`` or ``DEFFCT``.

    Args:
        returns: type of a function's value, lower case; None for a ``DEF``.
        shared: declared ``GLOBAL``.
    """

    span: Span
    name: str
    text: str
    parameters: tuple[Parameter, ...]
    body: Block
    returns: str | None
    shared: bool


@quick(frozen=True, slots=True, eq=False)
class DataList:
    """A ``DEFDAT``."""

    span: Span
    name: str
    text: str
    public: bool
    body: Block


@quick(frozen=True, slots=True, eq=False)
class Unit:
    """What one file holds.

    Args:
        notes: on what is wrong with the text and does no harm.
    """

    source: SourceText
    routines: tuple[Routine, ...]
    lists: tuple[DataList, ...]
    notes: tuple[Note, ...] = ()
