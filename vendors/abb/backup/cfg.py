"""System parameters: ``.cfg`` files as records.

The first line names the topic, ``MOC:CFG_1.0:6:0::``. Lines ``#`` separate sections, each with a
head ``ROBOT:``. A record is ``-attribute value …`` in any order and goes on over lines that end in
``\\``; texts stand in quotes, an attribute without value is a true flag, and defaults are left out.
Records link by name. Units are SI.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

from ....core.errors import InputError, Note, Span
from ....core.source.text.files import lines_of

_HEAD = re.compile(r"\s*\ufeff?\w+:CFG_\d")
_SECTION = re.compile(r"([A-Za-z]\w*):\s*")
_TOKEN = re.compile(r'"[^"]*"?|[^\s"]+')
_ATTRIBUTE = re.compile(r"-([A-Za-z_][\w.]*)")
_NO = ("0", "false", "no", "off")


@dataclass(frozen=True, slots=True)
class Record:
    """A record of system parameters.

    Args:
        section: that it stands in, in capitals.
        values: by attribute, lower case; ``""`` of a flag.
        file: below the backup's root.
        line: where it begins.
    """

    section: str
    values: Mapping[str, str]
    file: str
    line: int

    @property
    def name(self) -> str:
        """``""`` of a record without one."""
        return self.values.get("name", "")

    @property
    def place(self) -> str:
        """Where it stands, for origins: ``MOC.cfg ROBOT ROB_1``."""
        return f"{self.file.rpartition('/')[2]} {self.section} {self.name}".rstrip()

    def text(self, attribute: str) -> str | None:
        """The value of an attribute; None if it is left out or empty."""
        return self.values.get(attribute) or None

    def flag(self, attribute: str) -> bool:
        """Whether an attribute is given, and not as FALSE."""
        return self.values.get(attribute, "no").lower() not in _NO

    def number(self, attribute: str) -> float | None:
        """A number; None if it is left out.

        Raises:
            InputError: it is given and is none.
        """
        value = self.text(attribute)
        if value is None:
            return None
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise InputError(f"{self.file}:{self.line}: {attribute} of {self.name} is no number")
        return number

    def numbered(self, attribute: str) -> list[str]:
        """The values of ``attribute0``, ``attribute1``, …, as far as they are given."""
        digits = len(attribute)
        found = [
            (int(key[digits:]), value)
            for key, value in self.values.items()
            if value and key.startswith(attribute) and key[digits:].isdecimal()
        ]
        return [value for _, value in sorted(found)]


@dataclass(frozen=True)
class Parameters:
    """What a ``.cfg`` file states.

    Args:
        file: below the backup's root.
        records: in the file's order.
        notes: what of it is no record.
    """

    file: str = ""
    records: tuple[Record, ...] = ()
    notes: tuple[Note, ...] = ()
    _sections: dict[str, list[Record]] = field(default_factory=dict, repr=False, compare=False)

    def __post_init__(self) -> None:
        for record in self.records:
            self._sections.setdefault(record.section, []).append(record)

    def __bool__(self) -> bool:
        return bool(self.records)

    def section(self, name: str) -> Sequence[Record]:
        """Its records of a section."""
        return self._sections.get(name, ())

    def named(self, section: str, *names: str | None) -> Record | None:
        """The first record of a section that is called so, whatever the case."""
        for name in filter(None, names):
            for record in self.section(section):
                if record.name.casefold() == name.casefold():
                    return record
        return None


def parse_parameters(text: str, file: str) -> Parameters:
    """The records of a ``.cfg`` file; what is none is passed over, and noted once."""
    records: list[Record] = []
    wrong: list[tuple[int, str]] = []
    section = ""
    for number, line in _logical_lines(text):
        blank = line.strip()
        if not blank or blank.startswith("#") or _HEAD.match(line):
            continue
        head = _SECTION.fullmatch(blank)
        if head is not None:
            section = head[1].upper()
            continue
        values = _values(blank)
        if section and values:
            records.append(Record(section, MappingProxyType(values), file, number))
        else:
            wrong.append((number, blank))
    return Parameters(file, tuple(records), _said(wrong, records, file))


def _said(wrong: list[tuple[int, str]], records: list[Record], file: str) -> tuple[Note, ...]:
    """That a file holds what is no record."""
    if not records:
        return (Note(f"{file} is passed over: it holds no record of system parameters"),)
    if not wrong:
        return ()
    line, text = wrong[0]
    more = f", and {len(wrong) - 1} more lines" if len(wrong) > 1 else ""
    shown = text if len(text) <= 40 else text[:39] + "…"
    message = f"this is no record of system parameters and is passed over: {shown!r}{more}"
    return (Note(message, span=Span(file, line, 1, 0, 0)),)


def _logical_lines(text: str) -> Iterator[tuple[int, str]]:
    """Lines with the number that they begin at; those that end in ``\\`` go on in the next one."""
    parts: list[str] = []
    begin = 1
    for number, line in enumerate(lines_of(text), 1):
        if not parts:
            begin = number
        cut = line.rstrip()
        if cut.endswith("\\"):
            parts.append(cut[:-1])
            continue
        yield begin, " ".join([*parts, line])
        parts = []
    if parts:
        yield begin, " ".join(parts)


def _values(line: str) -> dict[str, str]:
    """The attributes of a record; empty if the line is none."""
    values: dict[str, str] = {}
    attribute = ""
    for token in _TOKEN.findall(line):
        found = _ATTRIBUTE.fullmatch(token)
        if found is not None:
            attribute = found[1].lower()
            values.setdefault(attribute, "")
        elif not attribute:
            return {}
        else:
            value = token.strip('"')
            before = values[attribute]
            values[attribute] = f"{before} {value}" if before else value
    return values


def folded(name: str) -> str:
    """``ROB_1`` and ``rob1`` are one robot; its first joint is ``rob1_1``."""
    return name.casefold().replace("_", "")
