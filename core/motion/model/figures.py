"""The figures of a motion model, each stated once.

A motion model and its parts are dataclasses whose fields `figure` declares: the key in files, the
kind with its range and unit, the value that stands for nothing, the stage of the emulator that it
enters first, how it is fitted, and what it is. All else follows from that: `figures_of` makes the
table of all figures from it, by which files are read and written (`motion_file`), values checked,
provenances asked for, keys of ``--fit`` found, and stages of an emulation kept. A figure more is
one field, and what the emulator does with it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from enum import IntEnum
from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar, cast

from ...errors import InputError
from .kinds import FigureKind, words_of

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Model = TypeVar("Model", bound="DataclassInstance")

MOST_TABLES = 100
"""Masses on an arm, or pairs of its joints."""
_FIGURE, _PART = "figure", "part"


class Stage(IntEnum):
    """What of an emulation a figure enters first; that and all that follows depend on it."""

    PATH = 1
    """Route, zones and blends: `Controller.plan`."""
    TIMING = 2
    """Limits, time parametrisation, rests, and what is averaged over: `Controller.stamp`."""
    LEAD = 3
    """How far motors are ahead of their links, on top of the smoothed motion."""
    SAMPLES = 4
    """At which times the motion is looked at: `Controller.sample`."""


@dataclass(frozen=True)
class FitRange:
    """How ``flyby identify`` fits a number.

    Args:
        lower, upper: what it may become.
        scale: how far it may well be from its start; None for half of what it starts with.
    """

    lower: float = 0.0
    upper: float = math.inf
    scale: float | None = None


@dataclass(frozen=True)
class Figure:
    """What is said of one figure.

    Args:
        key: in files, with dots; in a part of a model, what comes after the part's own.
        kind: how it is stated, and what it may be.
        stage: of the emulation that it enters first.
        unit: of its numbers.
        help: what it is.
        always: every model states it, whatever its value, and has a provenance of it.
        fit: how it is fitted; None where it is not.
        neutral: what stands for nothing, the field's default.
        path: names of the fields that lead to it from the model.
    """

    key: str
    kind: FigureKind
    stage: Stage
    unit: str
    help: str
    always: bool = False
    fit: FitRange | None = None
    neutral: Any = None
    path: tuple[str, ...] = ()

    @property
    def table(self) -> str:
        """Of the file, that its key stands in; empty for the outermost."""
        return self.key.rpartition(".")[0]

    def of(self, model: DataclassInstance) -> Any:
        """What a model has."""
        found: Any = model
        for name in self.path:
            found = getattr(found, name)
        return found

    def stated(self, model: DataclassInstance) -> bool:
        """Whether a model states it."""
        return self.always or self.of(model) != self.neutral


@dataclass(frozen=True)
class Member:
    """What is said of one figure of several alike, each with tables of its own (`Tables`).

    Args:
        key: in the table.
        kind: how it is stated, and what it may be.
        unit: of its numbers.
        help: what it is.
        fit: how it is fitted; None where it is not.
        name: of the field.
    """

    key: str
    kind: FigureKind
    unit: str
    help: str
    fit: FitRange | None = None
    name: str = ""


@dataclass(frozen=True)
class Tables:
    """Several tables alike.

    Args:
        of: the dataclass that each becomes; `member` declares its fields.
    """

    of: type[DataclassInstance]

    @property
    def members(self) -> tuple[Member, ...]:
        """What each has."""
        return _members(self.of)

    def read(self, key: str, entry: Any) -> tuple[Any, ...]:
        """See `FigureKind`."""
        if not isinstance(entry, list):
            raise InputError(f"{key}: a list of tables is expected, not {entry!r}")
        return tuple(self._read(f"{key}[{k}]", one) for k, one in enumerate(entry))

    def _read(self, key: str, entry: Any) -> Any:
        keys = [member.key for member in self.members]
        if not isinstance(entry, Mapping) or set(entry) != set(keys):
            raise InputError(f"{key}: a table of {words_of(keys)} is expected, not {entry!r}")
        read = {m.name: m.kind.read(f"{key}.{m.key}", entry[m.key]) for m in self.members}
        return self.of(**read)

    def check(self, key: str, value: Any) -> None:
        """See `FigureKind`."""
        if len(value) > MOST_TABLES:
            raise InputError(f"{key} has {len(value)} tables; at most {MOST_TABLES} are taken")
        for k, one in enumerate(value):
            if not isinstance(one, self.of):
                raise InputError(f"{key}[{k}]: {self.of.__name__} is expected, not {one!r}")
            for member in self.members:
                member.kind.check(f"{key}[{k}].{member.key}", getattr(one, member.name))

    def entry(self, value: Any) -> Any:
        """See `FigureKind`."""
        return [{m.key: m.kind.entry(getattr(one, m.name)) for m in self.members} for one in value]

    def __str__(self) -> str:
        return f"tables of {words_of([member.key for member in self.members])}"


def figure(
    key: str,
    kind: FigureKind,
    stage: Stage,
    help: str,
    *,
    default: Any,
    unit: str = "",
    always: bool = False,
    fit: FitRange | None = None,
) -> Any:
    """A field of a motion model, or of a part of one, that is a figure; see `Figure`."""
    said = Figure(key, kind, stage, unit, help, always, fit, neutral=default)
    return field(default=default, metadata={_FIGURE: said})


def part(key: str, default: DataclassInstance) -> Any:
    """A field that holds figures of its own, which files state below a key."""
    return field(default=default, metadata={_PART: key})


def member(
    key: str, kind: FigureKind, help: str, *, unit: str = "", fit: FitRange | None = None
) -> Any:
    """A field of one of several tables; see `Member`."""
    return field(metadata={_FIGURE: Member(key, kind, unit, help, fit)})


@cache
def figures_of(owner: type[DataclassInstance]) -> tuple[Figure, ...]:
    """All figures of a motion model's class, those of its parts included, in their order."""
    found: list[Figure] = []
    for one in fields(owner):
        if _FIGURE in one.metadata:
            found.append(replace(one.metadata[_FIGURE], path=(one.name,)))
        elif _PART in one.metadata:
            key = one.metadata[_PART]
            found += [
                replace(inner, key=f"{key}.{inner.key}", path=(one.name, *inner.path))
                for inner in figures_of(cast("type[DataclassInstance]", type(one.default)))
            ]
    return tuple(found)


def check_figures(owner: DataclassInstance, table: str = "") -> None:
    """Refuse a model, or a part of one, whose own figures make no sense.

    Args:
        owner: that declares them.
        table: what messages call it.

    Raises:
        InputError: with the key.
    """
    for one in figures_of(type(owner)):
        if len(one.path) == 1:
            one.kind.check(table + one.key, getattr(owner, one.path[0]))


def with_figures(model: Model, values: Mapping[Figure, Any]) -> Model:
    """A motion model with other values of some figures.

    Raises:
        InputError: a value makes no sense, on its own or beside others; the message names the key.
    """
    for one, value in values.items():
        one.kind.check(one.key, value)
    return _replaced(model, [(one.path, one, value) for one, value in values.items()])


def _replaced(owner: Model, values: list[tuple[tuple[str, ...], Figure, Any]]) -> Model:
    """An owner of figures, or of parts that own them, with values at paths below it."""
    changed: dict[str, Any] = {}
    parts: dict[str, list[tuple[tuple[str, ...], Figure, Any]]] = {}
    for (name, *rest), one, value in values:
        if rest:
            parts.setdefault(name, []).append((tuple(rest), one, value))
        else:
            changed[name] = value
    for name, inner in parts.items():
        try:
            changed[name] = _replaced(getattr(owner, name), inner)
        except InputError as error:
            table = inner[0][1].table
            if str(error).startswith(f"{table}."):
                raise
            # Parts of one class do not know which of them they are.
            raise InputError(f"{table}: {error}") from error
    return replace(owner, **changed)


@cache
def _members(owner: type[DataclassInstance]) -> tuple[Member, ...]:
    return tuple(replace(one.metadata[_FIGURE], name=one.name) for one in fields(owner))
