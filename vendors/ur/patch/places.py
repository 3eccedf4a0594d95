"""The calls in a script that drive the robot, found by where they stand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from ....core.errors import InputError, Span
from ....core.source.reading import Files
from ....core.source.text.files import SourceFile
from ..motion.kinematics import INVERSE, INVERSE_PARAMETERS
from ..motion.moves import SIGNATURES
from ..syntax.statements import parse
from ..syntax.texts import Texts
from ..syntax.tree import Argument, Assign, Block, Call, Define, Evaluate, Expression
from ..values.arguments import bind

TARGET, POSE, QNEAR, VIA = "target", "pose", "qnear", "via"
PUT_IN = ("a", "v", "t", "r")
"""Arguments that may be put in, in the order in which they stand."""


@dataclass(frozen=True, slots=True)
class MoveCall:
    """A call that drives the robot."""

    call: Call
    texts: Texts

    def takes(self, name: str) -> bool:
        """Whether it has such an argument beside its targets."""
        return name in SIGNATURES[self.call.name].others

    def can_be_put_in(self, name: str) -> bool:
        """Whether an argument is not written, and has a place where it could be."""
        return name in PUT_IN and self.written(name) is None

    def written(self, name: str) -> Expression | None:
        """The expression of an argument; None if it is not written.

        Args:
            name: ``a``, ``v``, ``t``, ``r``; `TARGET` and `VIA`; `QNEAR` is that of a
                ``get_inverse_kin`` that is the target, and `POSE` what stands before it, or else
                the target itself.
        """
        signature = SIGNATURES[self.call.name]
        given = self._bound(self.call, signature.names)
        if name == VIA:
            return given[signature.targets[0]].value if len(signature.targets) > 1 else None
        if name not in (TARGET, POSE, QNEAR):
            return given[name].value if name in given else None
        goal = given[signature.targets[-1]].value
        if name != TARGET and isinstance(goal, Call) and goal.name == INVERSE:
            inner = self._bound(goal, INVERSE_PARAMETERS).get("x" if name == POSE else QNEAR)
            return None if inner is None else inner.value
        return None if name == QNEAR else goal

    def _bound(self, call: Call, names: tuple[str, ...]) -> dict[str, Argument]:
        return bind(call, names, 0, self.texts)

    def span(self, expression: Expression) -> Span:
        """Where an expression of the call stands."""
        return self.texts.span(expression.start, expression.end)

    @property
    def end(self) -> Span:
        """The empty stretch before the closing bracket."""
        return self.texts.span(self.call.end - 1, self.call.end - 1)


class MoveCalls:
    """The moves in a program's files."""

    def __init__(self, files: Files) -> None:
        self._texts = {name: file.text for name, file in files.items()}
        self._files = {name: _File(file) for name, file in files.items()}

    def text(self, span: Span) -> str:
        """What stands at a place."""
        return self._texts[span.file][span.start : span.end]

    def at(self, statement: Span) -> MoveCall:
        """The call of a move's statement.

        Raises:
            InputError: there is none.
        """
        file = self._files.get(statement.file)
        found = file.calls.get(statement.start) if file is not None else None
        if found is None:
            raise InputError(f"{statement}: no move that could be patched stands here")
        return found


class _File:
    def __init__(self, file: SourceFile) -> None:
        self._texts = Texts([file])

    @cached_property
    def calls(self) -> dict[int, MoveCall]:
        """By where they begin."""
        moves = (c for c in _calls(parse(self._texts, 0)) if c.name in SIGNATURES)
        return {call.start: MoveCall(call, self._texts) for call in moves}


def _calls(block: Block) -> Iterator[Call]:
    """The calls that are statements, or the value of an assignment."""
    for statement in block:
        inner = [statement.body] if isinstance(statement, Define) else statement.blocks
        for body in inner:
            yield from _calls(body)
        value = statement.value if isinstance(statement, Assign) else None
        if isinstance(statement, Evaluate):
            value = statement.expression
        if isinstance(value, Call):
            yield value
