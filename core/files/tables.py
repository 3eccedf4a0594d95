"""TOML files read key by key: every error names file and key, and every key must be asked for."""

from __future__ import annotations

import difflib
import math
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from ..errors import InputError
from .reading import read_toml

MILLI = 1e-3
LENGTH = {"mm": MILLI, "m": 1.0}
LARGEST = 1e12
"""Beyond any quantity of robots and cells, in whatever unit; products of larger ones overflow."""
ANGLE = {"deg": math.pi / 180, "rad": 1.0}


def per(units: Mapping[str, float], time: str) -> dict[str, float]:
    """Units of a rate: ``deg_s`` of ``deg`` and ``s``."""
    return {f"{unit}_{time}": scale for unit, scale in units.items()}


class TomlTable:
    """One table of a TOML file.

    Args:
        data: the table's values.
        file: the file, for messages.
        key: where the table stands in the file, e.g. ``"tool.gun"``; empty for the file itself.
    """

    def __init__(self, data: Mapping[str, Any], file: Path, key: str = "") -> None:
        self.data = data
        self.file = file
        self.key = key
        self._asked: set[str] = set()

    @classmethod
    def read(cls, path: str | Path) -> TomlTable:
        """The file's outermost table.

        Raises:
            InputError: the file is missing or unreadable, or is not TOML.
        """
        return cls(read_toml(path), Path(path))

    def error(self, key: str, message: str) -> InputError:
        """An error about ``key`` of this table, for the caller to raise."""
        return InputError(f"{self.file}: {self._full(key)}: {message}")

    def finish(self) -> None:
        """Check that no key was left unread.

        Raises:
            InputError: there is one; the message offers the nearest that would have been read.
        """
        for key in self.data:
            if key not in self._asked:
                raise self.error(key, f"unknown key; {_nearest(key, self._asked)}")

    def has(self, key: str) -> bool:
        """Whether ``key`` is given."""
        self._asked.add(key)
        return key in self.data

    def value(self, key: str) -> Any:
        """The value of ``key`` as TOML has it.

        Raises:
            InputError: it is missing.
        """
        if not self.has(key):
            raise self.error(key, "is missing")
        return self.data[key]

    def text(self, key: str, default: str | None = None) -> str:
        """A string; required without ``default``."""
        if default is not None and not self.has(key):
            return default
        value = self.value(key)
        if not isinstance(value, str):
            raise self.error(key, f"must be a string, not {value!r}")
        return value

    def choice(self, key: str, choices: Collection[str], default: str | None = None) -> str:
        """A string out of ``choices``."""
        if default is None and not self.has(key):
            raise self.error(key, f"is missing: one of {', '.join(choices)}")
        value = self.text(key, default)
        if value not in choices:
            raise self.error(key, f"{value!r} is unknown; {_nearest(value, choices)}")
        return value

    def flag(self, key: str, default: bool) -> bool:
        """A boolean."""
        value = self.value(key) if self.has(key) else default
        if not isinstance(value, bool):
            raise self.error(key, f"must be true or false, not {value!r}")
        return value

    def number(self, key: str, default: float | None = None) -> float:
        """A finite number; required without ``default``."""
        if default is not None and not self.has(key):
            return default
        return self._finite(key, self.value(key))

    def numbers(self, key: str, count: int | None = None) -> tuple[float, ...]:
        """A list of finite numbers, ``count`` of them if given."""
        value = self.value(key)
        if not isinstance(value, list) or (count is not None and len(value) != count):
            many = "" if count is None else f"{count} "
            raise self.error(key, f"must be a list of {many}numbers, not {value!r}")
        return tuple(self._finite(key, item) for item in value)

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of strings."""
        value = self.value(key)
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            raise self.error(key, f"must be a list of strings, not {value!r}")
        return tuple(value)

    def table(self, key: str) -> TomlTable:
        """The table at ``key``; an empty one if there is none."""
        value = self.value(key) if self.has(key) else {}
        if not isinstance(value, Mapping):
            raise self.error(key, f"must be a table, not {value!r}")
        return TomlTable(value, self.file, self._full(key))

    def named_tables(self, key: str) -> dict[str, TomlTable]:
        """The tables ``[key.NAME]`` by name; empty if there is none."""
        outer = self.table(key)
        return {name: outer.table(name) for name in outer.data}

    def listed_tables(self, key: str) -> tuple[TomlTable, ...]:
        """The tables ``[[key]]``; messages count them from 1."""
        value = self.value(key) if self.has(key) else []
        if not isinstance(value, list) or not all(isinstance(item, Mapping) for item in value):
            raise self.error(key, f"must be an array of tables ([[{key}]]), not {value!r}")
        return tuple(
            TomlTable(item, self.file, f"{self._full(key)}[{i}]") for i, item in enumerate(value, 1)
        )

    def unit_key(self, key: str, units: Mapping[str, float]) -> str | None:
        """The key that gives ``key`` in one of ``units`` (``xyz`` as ``xyz_mm``), None if none.

        Raises:
            InputError: it is given twice, without a unit or in an unknown one.
        """
        names = [f"{key}_{unit}" for unit in units]
        found = [name for name in names if self.has(name)]
        if len(found) > 1:
            raise self.error(found[1], f"is given by {found[0]} already")
        wrong = [k for k in self.data if k not in names and f"{k}_".startswith(f"{key}_")]
        if wrong:
            raise self.error(wrong[0], f"needs one of the units {', '.join(names)}")
        return found[0] if found else None

    def quantity(self, key: str, units: Mapping[str, float], default: float | None = None) -> float:
        """A number in SI, given with a unit in its key (``clearance_mm``)."""
        name = self.unit_key(key, units)
        if name is None:
            if default is None:
                raise self.error(f"{key}_{next(iter(units))}", "is missing")
            return default
        return self.number(name) * units[name.removeprefix(f"{key}_")]

    def quantities(self, key: str, units: Mapping[str, float], count: int) -> tuple[float, ...]:
        """Numbers in SI, given with a unit in their key (``xyz_mm``)."""
        name = self.unit_key(key, units)
        if name is None:
            raise self.error(f"{key}_{next(iter(units))}", "is missing")
        scale = units[name.removeprefix(f"{key}_")]
        return tuple(x * scale for x in self.numbers(name, count))

    def existing_file(self, key: str) -> Path:
        """A file named relative to this one.

        Raises:
            InputError: there is no such file.
        """
        name = self.text(key)
        path = self.file.parent / name
        try:
            there = path.is_file()
            if not there and path.exists() and not path.is_dir():
                raise self.error(key, f"{path} is no regular file")
        except OSError as error:  # a name longer than names are
            raise self.error(key, f"{name[:60]!r}…: {error.strerror or error}") from None
        if not there:
            siblings = [p.name for p in path.parent.glob("*")] if path.parent.is_dir() else []
            raise self.error(key, f"there is no file {path}; {_nearest(path.name, siblings)}")
        return path

    def _finite(self, key: str, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.error(key, f"must be a number, not {value!r}")
        if not math.isfinite(value):
            raise self.error(key, f"must be finite, not {value}")
        if abs(value) > LARGEST:
            raise self.error(key, f"must lie within ±{LARGEST:g}, not {value:g}")
        return float(value)

    def _full(self, key: str) -> str:
        return ".".join(filter(None, (self.key, key)))


def _nearest(name: str, known: Collection[str]) -> str:
    near = difflib.get_close_matches(name, sorted(known), n=2, cutoff=0.5)
    if near:
        return f"did you mean {' or '.join(map(repr, near))}?"
    return f"known: {', '.join(sorted(known)) or 'none'}"
