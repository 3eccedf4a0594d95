"""Data lists (``.dat``) as the controller keeps them: what a line assigns, by name.

``$NAME[i]=value ;comment``, one a line, ``DECL`` and a type before it or not. Values are numbers,
``TRUE``, ``#CONSTANTS``, ``"texts"``, ``'B0101'`` and structs ``{X 0.0,CM {…},NAME[] "…"}``, with
the type's name inside the braces or not. Programs are read by the parser of the language; here a
line that makes no sense is passed over, as these files are long and of them little is asked.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from ...core.errors import InputError, Span
from ...core.source.text.files import SourceFile, lines_of, read_source

Value = float | bool | str | Mapping[str, "Value"]
"""Constants keep their ``#``; components of structs are named in capitals."""
_LINE = re.compile(
    r"\s*(?:(?:DECL|GLOBAL|CONST)\s+)*(?:[A-Z_]\w*\s+)?(\$?[A-Z_][\w$]*)\s*"
    r"(?:\[\s*(\d{0,6})\s*,?\s*\])?\s*=(?!=)\s*(.*)",
    re.IGNORECASE | re.ASCII,
)
_HEAD = re.compile(r"^[ \t]*DEFDAT[ \t]+(\S+)", re.IGNORECASE | re.MULTILINE)
_END = re.compile(r"^[ \t]*ENDDAT\b", re.IGNORECASE | re.MULTILINE)
_TOKEN = re.compile(
    r"""\s*(?:(?P<text>"[^"]*")|(?P<bits>'[BH][0-9A-F]*')|(?P<sign>[{},:;])"""
    r"""|(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:E[-+]?\d+)?(?![\w.]))|(?P<word>[#$]?[A-Z_][\w$]*"""
    r"""(?:\s*\[\s*\])?))""",
    re.IGNORECASE | re.ASCII,
)
_DEEPEST = 8
"""Structs in one another."""


@dataclass(frozen=True, slots=True)
class Assigned:
    """A value and where it is assigned."""

    value: Value
    file: str
    line: int

    @property
    def span(self) -> Span:
        """Its place, for notes."""
        return Span(self.file, self.line, 1, 0, 0)


class DataList:
    """What data lists assign.

    Args:
        name: of the list, for messages.
        data: by name, in capitals, and index; 0 of what has none.
        unread: lines whose values make no sense, in the same way.
        declared: what it calls itself, as ``$MACHINE``; empty if it does not.
        ends: whether it has an end where it has a beginning.
    """

    def __init__(
        self,
        name: str,
        data: Mapping[tuple[str, int], Assigned],
        unread: Mapping[tuple[str, int], int] | None = None,
        declared: str = "",
        ends: bool = True,
    ) -> None:
        self.name = name
        self.data = data
        self.unread = unread or {}
        self.declared = declared
        self.ends = ends

    @classmethod
    def read(cls, file: Path) -> DataList:
        """The data of a file.

        Raises:
            FlybyError: it cannot be read.
        """
        return cls.of(read_source(file))

    @classmethod
    def of(cls, source: SourceFile) -> DataList:
        """The data of a file's text."""
        data: dict[tuple[str, int], Assigned] = {}
        unread: dict[tuple[str, int], int] = {}
        for number, line in enumerate(lines_of(source.text), 1):
            found = _LINE.match(line) if "=" in line else None
            if found is None:
                continue
            value, key = _value_of(found[3]), (found[1].upper(), int(found[2] or 0))
            if value is None:
                unread[key] = number
            else:
                data[key] = Assigned(value, source.name, number)
        head = _HEAD.search(source.text)
        ends = head is None or _END.search(source.text) is not None
        return cls(source.name, data, unread, head[1] if head else "", ends)

    def over(self, other: DataList) -> DataList:
        """Both, where this one counts for what both assign."""
        below = {key: one for key, one in other.data.items() if key not in self.unread}
        ends = self.ends and other.ends
        return DataList(self.name, {**below, **self.data}, self.unread, self.declared, ends)

    def has(self, name: str, index: int = 0) -> bool:
        """Whether it assigns a datum."""
        return (name, index) in self.data

    def items(self, name: str) -> Iterator[tuple[int, Assigned]]:
        """The items of an array that are assigned, by their index in ascending order."""
        found = [(index, one) for (known, index), one in self.data.items() if known == name]
        return iter(sorted(found, key=lambda item: item[0]))

    def number(self, name: str, index: int = 0) -> float:
        """A number.

        Raises:
            InputError: there is none.
        """
        value = self._datum(name, index)
        if isinstance(value, bool) or not isinstance(value, float):
            raise self._wrong(name, index, "a number")
        return value

    def struct(self, name: str, index: int = 0) -> Mapping[str, Value]:
        """A struct's components by their names, in capitals.

        Raises:
            InputError: there is none.
        """
        value = self._datum(name, index)
        if not isinstance(value, Mapping):
            raise self._wrong(name, index, "a struct in braces")
        return value

    def text(self, name: str, index: int = 0) -> str:
        """A text or a constant; empty where there is none."""
        found = self.data.get((name, index))
        return found.value.strip() if found and isinstance(found.value, str) else ""

    def flag(self, name: str, index: int = 0) -> bool:
        """Whether a datum is TRUE."""
        found = self.data.get((name, index))
        return found is not None and found.value is True

    def _datum(self, name: str, index: int) -> Value:
        if not self.has(name, index) and (name, index) in self.unread:
            line = self.unread[name, index]
            raise InputError(f"{self.name}:{line}: {_spelt(name, index)} has no value that is one")
        if not self.has(name, index):
            why = "" if self.ends else ", and the file is cut short: it has no ENDDAT. Copy it anew"
            raise InputError(f"{self.name}: {_spelt(name, index)} is missing{why}")
        return self.data[name, index].value

    def _wrong(self, name: str, index: int, wanted: str) -> InputError:
        line = self.data[name, index].line
        return InputError(f"{self.name}:{line}: {_spelt(name, index)} is not {wanted}")


def numbers_of(struct: Mapping[str, Value]) -> dict[str, float]:
    """The numbers of a struct by their names."""
    return {
        key: value
        for key, value in struct.items()
        if isinstance(value, float) and not isinstance(value, bool)
    }


def part_of(struct: Mapping[str, Value], name: str) -> Mapping[str, Value]:
    """A struct in a struct; empty if there is none."""
    found = struct.get(name)
    return found if isinstance(found, Mapping) else {}


def _value_of(text: str) -> Value | None:
    """A value as a file writes it; None if it is none."""
    tokens = _Tokens(text)
    value = tokens.value(_DEEPEST)
    return value if tokens.at_end() else None


class _Tokens:
    """The words of a value, one after the other."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def value(self, depth: int) -> Value | None:
        """The value that stands here."""
        found = self._next()
        if found is None or depth == 0:
            return None
        if found["text"] is not None:
            return found["text"][1:-1]
        if found["bits"] is not None:
            return _bits(found["bits"])
        if found["number"] is not None:
            number = float(found["number"])
            return number if math.isfinite(number) else None
        if found["word"] is not None:
            word = found["word"].upper()
            return word == "TRUE" if word in ("TRUE", "FALSE") else word
        return self._struct(depth) if found["sign"] == "{" else None

    def _struct(self, depth: int) -> Value | None:
        fields: dict[str, Value] = {}
        while (found := self._next()) is not None:
            if found["sign"] == "}":
                return fields
            if found["sign"] == ",":
                continue
            name = found["word"]
            if name is None:
                return None
            if self._passed(":"):  # the type's name
                continue
            value = self.value(depth - 1)
            if value is None:
                return None
            fields[name.upper().partition("[")[0].strip()] = value
        return None

    def at_end(self) -> bool:
        """Whether nothing follows but a comment."""
        return self._text[self._at :].strip()[:1] in ("", ";")

    def _passed(self, sign: str) -> bool:
        found = _TOKEN.match(self._text, self._at)
        if found is None or found["sign"] != sign:
            return False
        self._at = found.end()
        return True

    def _next(self) -> re.Match[str] | None:
        found = _TOKEN.match(self._text, self._at)
        if found is not None:
            self._at = found.end()
        return found


def _bits(text: str) -> float | None:
    """``'B0101'`` or ``'H1F'``."""
    digits = text[2:-1]
    try:
        return float(int(digits, 2 if text[1] in "Bb" else 16))
    except (ValueError, OverflowError):
        return None


def _spelt(name: str, index: int) -> str:
    return f"{name}[{index}]" if index else name
