"""The entries of a class of options: name, unit, range, help and form of each, stated once.

A class of options is a frozen dataclass; its fields come from the functions of this module. The
value is checked when the options are made, whichever door it came by; `cli` makes parameters of
the entries, and `keywords` makes the keywords of the Python call.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields
from numbers import Integral, Real
from pathlib import Path
from typing import Any

from ...core.door import at_command_line, spelt, switched
from ...core.errors import InputError, OptionError
from .kinds import listed, refuse_others
from .shell import SHELL

Read = Callable[[Any, str], object]
"""Makes a value of what was given, text or value; the second argument names it in messages."""


@dataclass(frozen=True, slots=True)
class Scale:
    """What a number is said in.

    Args:
        typed, typed_unit: at the command line; the unit takes the place of ``{unit}`` in helps.
        si, si_unit: in Python.
        factor: one of the first in the second.
    """

    typed: str
    si: str
    typed_unit: str = ""
    si_unit: str = ""
    factor: float = 1.0

    @property
    def unit(self) -> str:
        """At the door at hand."""
        return self.typed_unit if at_command_line() else self.si_unit


NUMBER = Scale("a number", "a number")
COUNT = Scale("a number", "a number")
"""Of whole things."""
LENGTH = Scale("a length in mm", "a length in m", "mm", "m", 1e-3)
DISTANCE = Scale("a distance in mm", "a distance in m", "mm", "m", 1e-3)
ANGLE = Scale("degrees", "rad", "degrees", "rad", math.pi / 180)
TIME = Scale("seconds", "seconds", "s", "s")
MILLISECONDS = Scale("milliseconds", "seconds", "ms", "s", 1e-3)


@dataclass(frozen=True, slots=True)
class Extent:
    """The numbers that an option takes, as they are typed; ends that are left out do not count.

    Args:
        least, most: the ends.
        ends: which of them are taken themselves: ``[]``, ``()``, ``[)`` or ``(]``.
    """

    least: float = -math.inf
    most: float = math.inf
    ends: str = "[]"

    def holds(self, value: float, factor: float) -> bool:
        """Whether a number, ``factor`` times one that is typed, lies in it."""
        least, most = factor * self.least, factor * self.most
        above = value >= least if self.ends[0] == "[" else value > least
        below = value <= most if self.ends[1] == "]" else value < most
        return above and below and math.isfinite(value)

    def said(self, factor: float) -> str:
        """The extent in words, after what the number is said in."""
        least, most = (f"{factor * end:.6g}" for end in (self.least, self.most))
        if math.isinf(self.most):
            if math.isinf(self.least):
                return ", finite"
            if self.least == 0.0:
                return ", zero or more" if self.ends[0] == "[" else " above zero"
            return f" from {least} on" if self.ends[0] == "[" else f" above {least}"
        if self.ends == "()":
            return f" between {least} and {most}"
        if self.ends == "(]":
            return f" above {least}, {most} at most"
        return f" from {least} to {most}" if self.ends == "[]" else f" from {least} to below {most}"


ANY = Extent()
POSITIVE = Extent(0.0, ends="(]")
NOT_NEGATIVE = Extent(0.0)


@dataclass(frozen=True, slots=True)
class Entry:
    """An option.

    Args:
        help: what it is, in a sentence.
        kind: of a value that is typed: bool, int, float, str or Path.
        scale: of a number.
        extent: of a number.
        choices: of a word.
        read: makes what counts of a value, and refuses it; None where nothing needs to be made.
        several: whether it may be given several times.
        flag: at the command line, where it is not simply the name.
        numbers: unit of what may be given as numbers in Python and is typed as a text.
        typed: whether the command line has it at all.
    """

    help: str
    kind: type
    scale: Scale = NUMBER
    extent: Extent = ANY
    choices: tuple[str, ...] = ()
    read: Read | None = None
    several: bool = False
    flag: str | None = None
    numbers: str = ""
    typed: bool = True

    @property
    def explained(self) -> str:
        """The help at the door at hand."""
        text = self.help.replace("{unit}", self.scale.unit)
        if not self.numbers or at_command_line():
            return text
        return f"{text} As numbers: {self.numbers}."

    def taken(self, name: str, value: Any, hint: str) -> Any:
        """A value as the option takes it; where it is a list, one of its entries is a list of one.

        Args:
            name: of the option in Python.
            value: not None.
            hint: the type that the option is annotated with.

        Raises:
            OptionError: naming the option as the door at hand does.
        """
        called = spelt(name, self.flag)
        if self.kind is bool:
            if not isinstance(value, bool):
                raise OptionError(f"{name} is True or False, not {value!r}")
        elif self.kind in (int, float) and not self.several:
            self._check_number(called, value)
        elif self.several and not isinstance(value, Mapping):
            value = listed(value, hint.count("Sequence[") > 1)
            for one in value:
                refuse_others(called, one, hint.split(" | Mapping[")[0].replace("Sequence[", "", 1))
        else:
            if "Sequence[" in hint and isinstance(value, Real):
                value = (value,)
            refuse_others(called, value, hint)
        if self.choices and value not in self.choices:
            *most, last = self.choices
            raise OptionError(f"{called} {value}: {', '.join(most)} or {last}")
        if self.read is not None:
            try:
                self.read(value, called)
            except OptionError:
                raise
            except InputError as error:
                raise OptionError(str(error)) from None
        return value

    def _check_number(self, name: str, value: object) -> None:
        wanted = Integral if self.kind is int else Real
        if not isinstance(value, wanted) or isinstance(value, bool):
            raise OptionError(f"{name} {value!r}: {self._said()}")
        if not self.extent.holds(float(value), self.scale.factor):
            shown = float(value) / (self.scale.factor if at_command_line() else 1.0)
            raise OptionError(f"{name} {shown:g}: {self._said()}")

    def _said(self) -> str:
        if at_command_line():
            return self.scale.typed + self.extent.said(1.0)
        return self.scale.si + self.extent.said(self.scale.factor)


ENTRY = "option"
"""Key of an entry in its field's metadata."""


@dataclass(frozen=True, kw_only=True)
class TaskOptions:
    """Options of all tasks.

    Args:
        report: called with what is being done; None for no reports.
    """

    report: Callable[[str], object] | None = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        hints = {f.name: str(f.type) for f in fields(self)}
        for name, entry in entries(type(self)).items():
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, entry.taken(name, value, hints[name]))

    def inputs(self) -> tuple[Path, ...]:
        """All files that are named here: none of them is ever written to."""
        found: list[Any] = []
        for name, entry in entries(type(self)).items():
            if entry.kind is Path:
                given = getattr(self, name)
                found += given if entry.several else [given]
        files = (v if isinstance(v, str | Path) else getattr(v, "file", None) for v in found)
        return tuple(Path(file) for file in files if file)

    def say(self, what: str) -> None:
        """Report what is being done."""
        if self.report is not None:
            self.report(what)

    def spelt(self, name: str) -> str:
        """An option of these as messages name it."""
        entry = entries(type(self))[name]
        return switched(name) if entry.kind is bool else spelt(name, entry.flag)


def entries(options: type[TaskOptions]) -> Mapping[str, Entry]:
    """The entries of a class of options by their names in Python."""
    return {f.name: f.metadata[ENTRY] for f in fields(options) if ENTRY in f.metadata}


def defaults(options: type[TaskOptions]) -> Mapping[str, object]:
    """The defaults of a class of options by their names; those that must be given are missing."""
    return {f.name: f.default for f in fields(options) if f.default is not MISSING}


def flag(options: type[TaskOptions], name: str) -> str:
    """The flag of an option at the command line."""
    return entries(options)[name].flag or SHELL.flag_of(name)


# The functions that state an option. Their results are fields: `Any`, as `dataclasses.field` is.

REQUIRED = MISSING
"""In the place of a default: the option must be given."""


def number(
    default: Any,
    help: str,
    scale: Scale = NUMBER,
    extent: Extent = ANY,
    *,
    flag: str | None = None,
) -> Any:
    """A number; default and extent are stated as they are typed."""
    kind = int if scale is COUNT else float
    entry = Entry(help, kind, scale, extent, flag=flag)
    scaled = isinstance(default, int | float) and scale.factor != 1.0
    return _field(scale.factor * default if scaled else default, entry)


def count(default: Any, help: str, least: int = 0) -> Any:
    """A whole number from the least one on."""
    return number(default, help, COUNT, Extent(least))


def switch(help: str) -> Any:
    """Something that is off if nothing is said."""
    return _field(False, Entry(help, bool))


def choice(default: Any, help: str, choices: Sequence[str], *, flag: str | None = None) -> Any:
    """One of several words."""
    return _field(default, Entry(help, str, choices=tuple(choices), flag=flag))


def value(
    default: Any,
    help: str,
    read: Read | None = None,
    *,
    kind: type = str,
    several: bool = False,
    flag: str | None = None,
    numbers: str = "",
    typed: bool = True,
) -> Any:
    """Anything else: text at the command line, in Python the same text or what it stands for."""
    entry = Entry(
        help,
        kind,
        read=read,
        several=several,
        flag=flag,
        numbers=numbers,
        typed=typed,
    )
    return _field(default, entry)


def _field(default: Any, entry: Entry) -> Any:
    return field(default=default, metadata={ENTRY: entry})
