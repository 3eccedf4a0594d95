"""Where things stand in the source files of a RAPID program, for those who change them."""

from __future__ import annotations

import re
from bisect import bisect_left
from dataclasses import dataclass
from functools import cached_property

from ....core.errors import InputError, Span
from ....core.source.reading import Files
from ....core.source.text.files import SourceFile, SourceText
from ....core.source.text.names import Names
from ..syntax.cursor import Cursor
from ..syntax.lexer import Tokens, tokenize
from ..syntax.parser import parse
from ..syntax.statements import parse_statement
from ..syntax.tree import Argument, Expression, Invoke, Module
from ..write.formatting import NAME_RULES

_WORD = re.compile(r"[A-Za-z]\w*")
_LINE_END = re.compile(r"\r\n|\r|\n")
_BLANK = re.compile(r"[^\S\r\n]*(?:![^\r\n]*)?")


@dataclass(frozen=True, slots=True)
class Operand:
    """A required argument of an instruction with the optional ones that belong to it.

    Args:
        expression: the argument: ``z10``.
        options: behind it: ``\\Z:=12``, ``\\Inpos:=inpos50``.
    """

    expression: Expression
    options: tuple[Argument, ...]

    @property
    def span(self) -> Span:
        """Of all of it."""
        expression = self.expression.span
        end = max((o.span.end for o in self.options), default=expression.end)
        return Span(expression.file, expression.line, expression.column, expression.start, end)

    def option(self, name: str) -> Argument | None:
        """The option called so."""
        return next((o for o in self.options if o.option == name), None)


class FilePlaces:
    """One source file."""

    def __init__(self, file: SourceFile) -> None:
        self.source = SourceText(file.text, file.name)

    @cached_property
    def tokens(self) -> Tokens:
        """All tokens."""
        return tokenize(self.source)

    @cached_property
    def modules(self) -> tuple[Module, ...]:
        """The modules of the file."""
        return parse(self.source)

    def token_at(self, start: int) -> int:
        """Index of the token that begins at an offset, or the first behind it."""
        return bisect_left(self.tokens.starts, start)

    def line_end(self, offset: int) -> re.Match[str] | None:
        """The end of the line of an offset, if nothing but blanks and a comment comes before."""
        blank = _BLANK.match(self.source.text, offset)
        assert blank is not None
        return _LINE_END.match(self.source.text, blank.end())

    def indentation(self, offset: int) -> str | None:
        """The blanks from the beginning of the line to an offset; None if there is more."""
        text = self.source.text
        start = max(text.rfind("\n", 0, offset), text.rfind("\r", 0, offset)) + 1
        before = text[start:offset].lstrip("\ufeff")
        return None if before.strip() else before

    @cached_property
    def new_line(self) -> str:
        """The file's own end of line; a blank in a file of one line."""
        found = _LINE_END.search(self.source.text)
        return found[0] if found else " "


class Places:
    """The files of a program."""

    def __init__(self, files: Files) -> None:
        self._files = files
        self._places: dict[str, FilePlaces] = {}

    def file(self, span: Span) -> FilePlaces:
        """The file that a span lies in."""
        if span.file not in self._files:
            raise InputError(f"{span.file} is not among the files of the program")
        if span.file not in self._places:
            self._places[span.file] = FilePlaces(self._files[span.file])
        return self._places[span.file]

    def text(self, span: Span) -> str:
        """What stands at a span."""
        return self._files[span.file].text[span.start : span.end]

    def operand(self, statement: Span, expression: Span) -> Operand:
        """The argument of an instruction that begins where ``expression`` does."""
        file = self.file(statement)
        cursor = Cursor(file.tokens)
        cursor.index = file.token_at(statement.start)
        parsed = parse_statement(cursor)
        arguments = parsed.arguments if isinstance(parsed, Invoke) else ()
        for index, argument in enumerate(arguments):
            value = argument.value
            if argument.option is None and value and value.span.start == expression.start:
                return Operand(value, _options(arguments[index + 1 :]))
        raise InputError(f"{expression}: this is no argument of the instruction at {statement}")

    def module(self, span: Span) -> Module:
        """The module that a span lies in."""
        modules = self.file(span).modules
        return next(m for m in modules if m.span.start <= span.start < m.span.end)

    def names(self) -> Names:
        """All words of all files, and what else is no name for a new datum."""
        words = {word for f in self._files.values() for word in _WORD.findall(f.text)}
        return Names(NAME_RULES, words)

    def truth_before(self, number: Span) -> Span | None:
        """The TRUE or FALSE in front of the first number of a zonedata."""
        file = self.file(number)
        index = file.token_at(number.start) - 2
        tokens = file.tokens
        if index < 0 or tokens.kinds[index + 1] != "," or tokens.kinds[index] not in _TRUTHS:
            return None
        return file.source.span(tokens.starts[index], tokens.ends[index])


_TRUTHS = ("true", "false")


def _options(arguments: tuple[Argument, ...]) -> tuple[Argument, ...]:
    last = next((i for i, a in enumerate(arguments) if a.option is None), len(arguments))
    return arguments[:last]
