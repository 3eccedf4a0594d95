"""A grammar as a table: for each form of line a pattern, and what it says."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import ClassVar

from ...errors import FlybyError, InputError, PluginFault
from ...program.signal import SetSignal
from .expressions import (
    USUAL,
    Datum,
    Expression,
    Number,
    Operation,
    Spelling,
    Truth,
    parse,
    parse_all,
)
from .program import Grammar, Said, several
from .statements import (
    Assign,
    Body,
    Call,
    Close,
    End,
    If,
    Jump,
    Kept,
    Label,
    Line,
    Open,
    Operand,
    Otherwise,
    Pause,
    Return,
    Routine,
    Statement,
)

Found = re.Match[str]
Form = Callable[["FormGrammar", Line, Found], Said]


class FormGrammar(Grammar):
    """A grammar whose lines have forms: the first whose pattern fits the whole line counts.

    A form is called by the name of the method that says what it means. The groups of its pattern
    are those that the method names; their texts are read as expressions by the `Spelling`. A
    language adds methods of its own, for motions and positions first of all.

    Attributes:
        forms: patterns by the name of a method, in the order in which they are tried; a ``.`` and
            anything behind it tell forms of one method apart. Upper and lower case are the same.
        spelling: of expressions.
        driving: what begins a motion: lines that begin so and fit no form are refused, since they
            may move the robot; other lines are kept as text.
        stopping: names of kept instructions at which the robot stops.
        longest: characters of a line.
        second: how many of the units in which waits are stated a second has.
        helpers: methods that are no forms.
    """

    forms: ClassVar[Mapping[str, str]] = {}
    spelling: Spelling = USUAL
    driving: re.Pattern[str] = re.compile(r"(?!)")
    stopping: frozenset[str] = frozenset()
    longest: int = 1000
    second: float = 1.0
    helpers: ClassVar[frozenset[str]] = frozenset(
        {"statement", "parse", "datum", "point_at", "options", "holds", "ended"}
    )

    def __init__(self) -> None:
        self._selected: list[tuple[Expression, bool]] = []
        self._blocks: list[bool] = []  # whether each that is open is a selection
        self._table = _table(type(self))

    def statement(self, line: Line) -> Said:
        """See `Grammar`.

        Raises:
            InputError: it says nothing that there is.
        """
        if line.end - line.start > self.longest:
            raise InputError(f"a line has {self.longest} characters at most")
        said = self.settings.read(line, self.spelling)
        if said is not None:
            return said
        for name, pattern, form in self._table:
            found = pattern.fullmatch(line.source.text, line.start, line.end)
            if found is not None:
                return self._said(name, form, line, found)
        if self.driving.match(line.text):
            raise InputError("this form of a motion is not known, and it may move the robot")
        return self.kept(line)

    def _said(self, name: str, form: Form, line: Line, found: Found) -> Said:
        try:
            return form(self, line, found)
        except FlybyError:
            raise
        except Exception as error:
            groups = ", ".join(found.re.groupindex) or "none"
            form_of = f"the form {name!r} (groups: {groups}) of {type(self).__qualname__}"
            what = f"{line.text!r}: {form_of}"
            raise PluginFault.of(what, error, line.span) from error

    def parse(self, line: Line, found: Found, group: str) -> Expression:
        """The expression in a group."""
        return parse(line.source, *found.span(group), self.spelling)

    def datum(self, line: Line, found: Found, group: str) -> Datum:
        """The datum in a group.

        Raises:
            InputError: something else stands there.
        """
        one = self.parse(line, found, group)
        if not isinstance(one, Datum):
            raise InputError(f"{found[group]} is no datum")
        return one

    def point_at(self, line: Line, found: Found, group: str) -> Operand:
        """The point in a group, as a part of a move."""
        datum = self.datum(line, found, group)
        return Operand(datum.span, point=datum)

    def options(
        self, line: Line, found: Found, group: str, option: re.Pattern[str]
    ) -> dict[str, tuple[int, int]]:
        """The options in a group: where what their named groups hold stands in the text. The
        pattern is of one of them, without the blanks before it.

        Raises:
            InputError: an option is not known.
        """
        given: dict[str, tuple[int, int]] = {}
        text, (at, end) = line.source.text, found.span(group)
        while text[at:end].strip():
            at += len(text[at:end]) - len(text[at:end].lstrip())
            one = option.match(text, at, end)
            if one is None or one.end() == at:
                left = text[at:end].strip()
                raise InputError(f"the option {left!r} is not known: it may move the robot")
            given |= {name: one.span(name) for name, said in one.groupdict().items() if said}
            at = one.end()
        return given

    def _action(self, line: Line, found: Found, group: str = "action") -> Body:
        start, end = found.span(group)
        done = several(self.statement(replace(line, start=start, end=end)))
        if not done:
            raise InputError("an action should follow the condition")
        return Body(done)

    # --------------------------------------------------------- what forms may be called

    def nothing(self, line: Line, found: Found) -> Said:
        """A comment, or what says nothing that counts."""
        return None

    def kept(
        self, line: Line, found: Found | None = None, why: str = "what it does is not known"
    ) -> Kept:
        """What is not carried out."""
        word = re.match(r"[\w.$#]+", line.text)
        name = word[0] if word else line.text[:12]
        return Kept(line.span, name, why, name.upper() in self.stopping)

    def harmless(self, line: Line, found: Found) -> Kept:
        """What does not move the robot, and is kept."""
        return self.kept(line, found, "it does not move the robot")

    def refused(self, line: Line, found: Found) -> Said:
        """What is known to move the robot, and is not emulated."""
        raise InputError("it may move the robot, and is not emulated")

    def routine(self, line: Line, found: Found) -> Statement:
        """``name``: the lines behind it are its."""
        return Routine(line.span, found["name"])

    def label(self, line: Line, found: Found) -> Said:
        """``name``, and in ``action`` what stands on its line, if that has the group."""
        own = Label(line.span, found["name"].upper())
        rest = found.groupdict().get("action")
        return (own, *self._action(line, found).statements) if rest else own

    def jump(self, line: Line, found: Found) -> Statement:
        """To ``name``; in ``condition`` whether, if that has the group."""
        jump = Jump(line.span, found["name"].upper())
        if not found.groupdict().get("condition"):
            return jump
        return If(line.span, self.parse(line, found, "condition"), Body((jump,)))

    def call(self, line: Line, found: Found) -> Statement:
        """``name``, with ``arguments`` between commas; texts in quotes are left out."""
        given, arguments = found.groupdict().get("arguments") or "", []
        at = found.start("arguments") if given else 0
        for part in given.split(",") if given.strip() else []:
            if part.strip()[:1] not in "'\"":
                span = at, at + len(part)
                arguments.append(parse(line.source, *span, self.spelling))
            at += len(part) + 1
        return Call(line.span, found["name"], tuple(arguments))

    def returned(self, line: Line, found: Found) -> Statement:
        """The routine ends."""
        return Return(line.span)

    def end(self, line: Line, found: Found) -> Statement:
        """The program ends."""
        return End(line.span)

    def when(self, line: Line, found: Found) -> Statement:
        """``condition`` and ``action`` on one line."""
        condition = self.parse(line, found, "condition")
        return If(line.span, condition, self._action(line, found))

    def opened(self, line: Line, found: Found) -> Statement:
        """A block begins that is carried out on a ``condition``."""
        self._blocks.append(False)
        return Open(line.span, self.parse(line, found, "condition"))

    def otherwise(self, line: Line, found: Found) -> Statement:
        """What is done else; in ``condition`` whether, if that has the group."""
        asked = found.groupdict().get("condition")
        return Otherwise(line.span, self.parse(line, found, "condition") if asked else None)

    def closed(self, line: Line, found: Found) -> Said:
        """A block, a loop or a selection ends; there is nothing of a selection without cases."""
        if self._blocks and self._blocks.pop():
            begun = self._selected.pop()[1]
            return Close(line.span) if begun else None
        return Close(line.span)

    def selected(self, line: Line, found: Found) -> Said:
        """``datum`` is compared with the cases that follow; with the first, if it has the group
        ``value``, and an ``action``."""
        datum = self.parse(line, found, "datum")
        self._selected.append((datum, False))
        if found.groupdict().get("value"):
            return self.case(line, found)
        self._blocks.append(True)
        return None

    def case(self, line: Line, found: Found) -> Statement:
        """A case of one ``value`` or of several, or of none of them; what is done stands in
        ``action``, or on the lines behind it.

        Raises:
            InputError: nothing is compared here.
        """
        if not self._selected:
            raise InputError("nothing that is compared stands before it")
        datum, begun = self._selected[-1]
        self._selected[-1] = datum, True
        condition: Expression | None = None
        if found.groupdict().get("value"):
            for one in parse_all(line.source, *found.span("value"), self.spelling):
                same = Operation(one.span, "=", (datum, one))
                condition = (
                    same if condition is None else Operation(one.span, "OR", (condition, same))
                )
        inline = found.groupdict().get("action") is not None
        body = self._action(line, found) if inline else None
        if begun:
            return Otherwise(line.span, condition, body.statements[0] if body else None)
        if condition is None:
            raise InputError("a case with a value should stand first")
        return Open(line.span, condition) if body is None else If(line.span, condition, body)

    def counted(self, line: Line, found: Found) -> Statement:
        """A ``counter`` goes from ``first`` to ``last`` by ``step``, downwards if there is a group
        ``down``."""
        parts = found.groupdict()
        step = -1.0 if parts.get("down") else 1.0
        if parts.get("step"):
            given = self.parse(line, found, "step")
            if not isinstance(given, Number) or given.value == 0:
                raise InputError("a loop counts by a number that is written out")
            step = given.value
        self._blocks.append(False)
        return Open(
            line.span,
            counter=self.datum(line, found, "counter"),
            first=self.parse(line, found, "first"),
            last=self.parse(line, found, "last"),
            step=step,
        )

    def repeated(self, line: Line, found: Found) -> Statement:
        """A loop begins, while a ``condition`` holds if it has one."""
        asked = found.groupdict().get("condition")
        condition = self.parse(line, found, "condition") if asked else None
        self._blocks.append(False)
        return Open(line.span, condition, repeats=True)

    def until(self, line: Line, found: Found) -> Statement:
        """A loop ends, when a ``condition`` holds."""
        if self._blocks:
            self._blocks.pop()
        return Close(line.span, self.parse(line, found, "condition"))

    def wait(self, line: Line, found: Found) -> Statement:
        """A ``time``, or a ``condition`` that holds."""
        if found.groupdict().get("time"):
            time = self.parse(line, found, "time")
            whole = Number(line.span, self.second)
            return Pause(line.span, Operation(time.span, "/", (time, whole)))
        return Pause(line.span, condition=self.parse(line, found, "condition"))

    def assigned(self, line: Line, found: Found) -> Statement:
        """A ``target`` becomes a ``value``; what is no register and no output is kept."""
        target = self.datum(line, found, "target")
        if not self.holds(target.word) and target.word not in self.outputs:
            return Kept(line.span, target.word, "it does not move the robot")
        return Assign(line.span, target, self.parse(line, found, "value"))

    def pulsed(self, line: Line, found: Found) -> Statement:
        """An output ``target`` is turned on for a ``time``, s."""
        name, time = self.datum(line, found, "target"), self.parse(line, found, "time")
        done = None
        if isinstance(name.index, Number) and isinstance(time, Number):
            done = SetSignal(f"{name.word}[{name.index.value:g}]", True, time.value)
        return replace(self.harmless(line, found), signal=done)

    def switched(self, line: Line, found: Found) -> Statement:
        """An output ``target`` is turned on, or off if there is a group ``off``."""
        target = self.datum(line, found, "target")
        return Assign(line.span, target, Truth(line.span, not found.groupdict().get("off")))


def _table(kind: type[FormGrammar]) -> list[tuple[str, re.Pattern[str], Form]]:
    """Names, patterns, and what they mean, of a language; each is made once.

    Raises:
        InputError: a form is called as no method, or its pattern is none.
    """
    made: list[tuple[str, re.Pattern[str], Form]] | None = kind.__dict__.get("_made")
    if made is None:
        made = [_form(kind, name, pattern) for name, pattern in kind.forms.items()]
        kind._made = made  # type: ignore[attr-defined]
    return made


def _form(kind: type[FormGrammar], name: str, pattern: str) -> tuple[str, re.Pattern[str], Form]:
    method = getattr(kind, name.partition(".")[0], None)
    if method is None:
        raise InputError(f"forms of {kind.__qualname__}: {name!r} is called as no method of it")
    if name.partition(".")[0] in kind.helpers:
        raise InputError(
            f"forms of {kind.__qualname__}: {name!r} is what forms are made with: call it otherwise"
        )
    try:
        return name, re.compile(pattern, re.IGNORECASE | re.DOTALL), method
    except re.error as error:
        raise InputError(f"forms of {kind.__qualname__}: {name!r}: {error}") from None
