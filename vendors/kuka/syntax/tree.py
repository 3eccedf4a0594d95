"""The syntax tree of KRL's statements; see `terms` for expressions.

Nothing here is evaluated or checked beyond its form.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ....core.errors import Span
from ....core.source.text.files import SourceText
from .expression_tree import Call, Expression, Name


@dataclass(frozen=True, slots=True)
class Assign:
    """``target = value``"""

    span: Span
    target: Name
    value: Expression


@dataclass(frozen=True, slots=True)
class Invoke:
    """A call of a routine as a statement."""

    span: Span
    call: Call


@dataclass(frozen=True, slots=True)
class MotionInstruction:
    """A motion instruction.

    Args:
        word: lower case: ``ptp``, ``lin``, ``circ``, with ``_rel`` and with ``s`` before it.
        targets: the end point; for arcs the auxiliary point and the end point.
        angle: ``CA`` of an arc.
        frame: ``#base`` or ``#tool`` of a relative motion, without the sign.
        approximation: ``c_ptp``, ``c_dis`` and so on, in order.
        approximated: where these words stand, or, empty, where they would.
        settings: what follows ``WITH``: system variables of this motion alone.
    """

    span: Span
    word: str
    targets: tuple[Expression, ...]
    angle: Expression | None
    frame: str | None
    approximation: tuple[str, ...]
    approximated: Span
    settings: tuple[Assign, ...]


@dataclass(frozen=True, slots=True)
class If:
    """``IF … THEN … ELSE … ENDIF``"""

    span: Span
    condition: Expression
    body: Block
    otherwise: Block


@dataclass(frozen=True, slots=True)
class For:
    """``FOR counter = start TO stop STEP step … ENDFOR``"""

    span: Span
    counter: Name
    start: Expression
    stop: Expression
    step: Expression | None
    body: Block


@dataclass(frozen=True, slots=True)
class While:
    """``WHILE condition … ENDWHILE``"""

    span: Span
    condition: Expression
    body: Block


@dataclass(frozen=True, slots=True)
class Repeat:
    """``REPEAT … UNTIL condition``"""

    span: Span
    condition: Expression
    body: Block


@dataclass(frozen=True, slots=True)
class Loop:
    """``LOOP … ENDLOOP``"""

    span: Span
    body: Block


@dataclass(frozen=True, slots=True)
class Case:
    """One ``CASE a, b`` of a ``SWITCH``."""

    values: tuple[Expression, ...]
    body: Block


@dataclass(frozen=True, slots=True)
class Switch:
    """``SWITCH subject CASE … DEFAULT … ENDSWITCH``"""

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
    """``GOTO name``"""

    span: Span
    name: str


@dataclass(frozen=True, slots=True)
class Return:
    """``RETURN`` or ``RETURN value``"""

    span: Span
    value: Expression | None


@dataclass(frozen=True, slots=True)
class Exit:
    """``EXIT``: leave the innermost loop."""

    span: Span


@dataclass(frozen=True, slots=True)
class Halt:
    """``HALT``"""

    span: Span


@dataclass(frozen=True, slots=True)
class Continue:
    """``CONTINUE``: the next statement does not stop the advance run."""

    span: Span


@dataclass(frozen=True, slots=True)
class WaitSec:
    """``WAIT SEC time``"""

    span: Span
    time: Expression


@dataclass(frozen=True, slots=True)
class WaitFor:
    """``WAIT FOR condition``"""

    span: Span
    condition: Expression


@dataclass(frozen=True, slots=True)
class Trigger:
    """``TRIGGER WHEN DISTANCE=0 DELAY=0 DO action``, ``TRIGGER WHEN PATH=… DELAY=… DO action``

    Args:
        path: whether it counts a distance (mm) on the path; else ``place`` is 0 for the start and
            1 for the end of the next motion.
        on_start: the distance counts from the start point and not from the end point.
        delay: ms; None if it is left out.
        action: the text of what is done.
    """

    span: Span
    path: bool
    on_start: bool
    place: Expression
    delay: Expression | None
    action: str


@dataclass(frozen=True, slots=True)
class Keyword:
    """A statement that is kept as it stands: interrupts, ``ANOUT``, ``BRAKE``, … .

    Args:
        word: the statement's first word, lower case.
    """

    span: Span
    word: str


@dataclass(frozen=True, slots=True)
class SplineBlock:
    """``SPLINE … ENDSPLINE``; what stands in it is not read."""

    span: Span
    word: str


@dataclass(frozen=True, slots=True)
class Declaration:
    """``[GLOBAL] [DECL] [CONST] type name[dimensions] = value``, one for each name.

    Args:
        type: lower-case name of the type.
        dimensions: None stands for one left open.
    """

    span: Span
    type: str
    name: str
    text: str
    shared: bool
    constant: bool
    dimensions: tuple[Expression | None, ...] = ()
    value: Expression | None = None


@dataclass(frozen=True, slots=True)
class SignalDeclaration:
    """``SIGNAL name $IN[1] TO $IN[4]``"""

    span: Span
    name: str
    text: str
    first: Name
    last: Name | None


@dataclass(frozen=True, slots=True)
class StrucDefinition:
    """``STRUC name REAL A, B, INT C[3]``: components as (type, name, number of dimensions)."""

    span: Span
    name: str
    components: tuple[tuple[str, str, int], ...]


@dataclass(frozen=True, slots=True)
class EnumDefinition:
    """``ENUM name A, B``"""

    span: Span
    name: str
    constants: tuple[str, ...]


Statement = (
    Assign
    | Invoke
    | MotionInstruction
    | If
    | For
    | While
    | Repeat
    | Loop
    | Switch
    | Label
    | Goto
    | Return
    | Exit
    | Halt
    | Continue
    | WaitSec
    | WaitFor
    | Trigger
    | Keyword
    | SplineBlock
    | Declaration
    | SignalDeclaration
    | StrucDefinition
    | EnumDefinition
)


@dataclass(frozen=True)
class Block:
    """Statements in order."""

    statements: tuple[Statement, ...] = ()

    @cached_property
    def labels(self) -> dict[str, int]:
        """Index of the statement behind each label of this block."""
        return {s.name: i + 1 for i, s in enumerate(self.statements) if isinstance(s, Label)}


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a routine: ``name:IN`` or ``name:OUT``; lower case."""

    name: str
    by_reference: bool


@dataclass(frozen=True, slots=True, eq=False)
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


@dataclass(frozen=True, slots=True, eq=False)
class DataList:
    """A ``DEFDAT``."""

    span: Span
    name: str
    text: str
    public: bool
    body: Block


@dataclass(frozen=True, slots=True, eq=False)
class Unit:
    """What one file holds."""

    source: SourceText
    routines: tuple[Routine, ...]
    lists: tuple[DataList, ...]
