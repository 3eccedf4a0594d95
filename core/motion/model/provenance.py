"""Where the figures of a motion model come from, as its file says.

    [fits.robotstudio]
    source = "29 runs of …"
    command = "flyby identify …"
    runs = 29

    [fits.robotstudio.range]
    speed_mps = [0.05, 1.5]

    [provenance]
    "*" = { status = "assumed", source = "…" }
    "zone.overlap" = { status = "published", source = "…" }
    "time.ramp_s" = { status = "fitted", by = "robotstudio", fitted = ["time.ramp_s in 0 .. 1"] }

A fit is described once, and what came of it points to it. Names of fits hold within their file.
A key that ends in ``*`` is that of all figures that begin so and have none of their own
(``blend.*``); of several the longest counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, cast, get_args

from ...errors import InputError, UnknownNameError
from ...files.toml_text import command_text, key_text, pair_text, value_text
from .taught_range import TaughtRange, range_entries, read_range

Status = Literal["published", "fitted", "assumed"]
_SEVERAL = "*"


@dataclass(frozen=True)
class FitRecord:
    """A fit that figures came of.

    Args:
        name: that figures point to it by.
        source: whose logs were fitted to.
        command: that gives the figures, or what else was done.
        details: further entries of the file (runs, confidence, loss).
        taught: what the runs cover; None if nobody says so.

    Raises:
        InputError: source or command is empty.
    """

    name: str
    source: str
    command: str
    details: Mapping[str, Any] = field(default_factory=dict)
    taught: TaughtRange | None = None

    def __post_init__(self) -> None:
        for key in ("source", "command"):
            if not getattr(self, key):
                raise InputError(f"the {key} is missing")


@dataclass(frozen=True)
class Provenance:
    """Where a figure comes from.

    Args:
        status: ``published``, ``fitted`` or ``assumed``.
        source: the document, or why it is assumed; that of a fitted figure stands in its fit.
        fit: that the figure came of, if it is fitted.
        fitted: the parameters that were fitted, as ``--fit`` takes them; none if the fit was none
            of ``flyby identify``.
        interval: of each of them, lower and upper end.
        details: further entries of the file.

    Raises:
        InputError: the status is unknown, or what it asks for is missing.
    """

    status: Status
    source: str = ""
    fit: FitRecord | None = None
    fitted: tuple[str, ...] = ()
    interval: tuple[tuple[float, float], ...] = ()
    details: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.status not in get_args(Status):
            raise UnknownNameError("status of a figure", self.status, get_args(Status))
        if self.status != "fitted" and not self.source:
            raise InputError(f"the source is missing: {self.status} by whom?")
        if (self.status == "fitted") != (self.fit is not None):
            raise InputError("figures that are fitted, and no others, name their fit: by = …")
        if self.fit is not None and self.source:
            raise InputError("the source of a fitted figure is said by its fit")
        if self.interval and len(self.interval) != len(self.fitted):
            raise InputError(
                f"{len(self.interval)} intervals of {len(self.fitted)} fitted parameters"
            )


def read_provenance(fits: Mapping[str, Any], entries: Mapping[str, Any]) -> dict[str, Provenance]:
    """The provenance of each figure that a file states one of.

    Args:
        fits, entries: the tables ``fits`` and ``provenance``.

    Raises:
        InputError: one is malformed; the message names its key.
    """
    known = {name: _fit(name, entry) for name, entry in fits.items()}
    return {key: _provenance(key, entry, known) for key, entry in entries.items()}


def of_each(origins: Mapping[str, Provenance], figures: Iterable[str]) -> dict[str, Provenance]:
    """The provenance of each figure, where some are stated for several (``*``, ``blend.*``).

    Args:
        origins: by dotted key, or by how several begin.
        figures: keys of those that may be meant by the latter.
    """
    several = sorted((key for key in origins if key.endswith(_SEVERAL)), key=len)
    meant = {
        figure: origins[key]
        for key in several
        for figure in figures
        if figure.startswith(key.removesuffix(_SEVERAL))
    }
    return meant | {key: one for key, one in origins.items() if not key.endswith(_SEVERAL)}


def provenance_text(origins: Mapping[str, Provenance]) -> str:
    """The tables ``fits`` and ``provenance`` of a file; fits of one name get others."""
    names: list[tuple[FitRecord, str]] = []
    entries = []
    for key, origin in origins.items():
        entry: dict[str, Any] = {"status": origin.status}
        if origin.fit is None:
            entry["source"] = origin.source
        else:
            entry["by"] = _named(origin.fit, names)
        entry |= {"fitted": origin.fitted} if origin.fitted else {}
        entry |= {"interval": origin.interval} if origin.interval else {}
        entries.append(pair_text(key, entry | {**origin.details}))
    tables = [_fit_text(name, fit) for fit, name in names]
    return "\n\n".join([*tables, "\n".join(["[provenance]", *entries])]) + "\n"


def _fit(name: str, entry: Any) -> FitRecord:
    key = f"fits.{name}"
    details = _table(key, entry)
    taught = _range(f"{key}.range", details.pop("range", None))
    try:
        told = _word("source", details), _word("command", details)
        return FitRecord(name, *told, details, taught)
    except InputError as error:
        raise InputError(f"{key}: {error}") from error


def _range(key: str, entry: Any) -> TaughtRange | None:
    try:
        return None if entry is None else read_range(entry)
    except InputError as error:
        raise InputError(f"{key}: {error}") from error


def _provenance(name: str, entry: Any, fits: Mapping[str, FitRecord]) -> Provenance:
    key = f"provenance.{name}"
    details = _table(key, entry)
    try:
        if "status" not in details:
            raise InputError(f"the status is missing ({', '.join(get_args(Status))})")
        status, by = _word("status", details), _word("by", details)
        if by and by not in fits:
            raise UnknownNameError("fit of this file", by, fits)
        return Provenance(
            cast("Status", status),  # Refused if it is none.
            _word("source", details),
            fits.get(by),
            _words("fitted", details),
            _intervals("interval", details),
            details,
        )
    except InputError as error:
        raise InputError(f"{key}: {error}") from error


def _table(key: str, entry: Any) -> dict[str, Any]:
    if not isinstance(entry, dict):
        raise InputError(f"{key}: a table is expected, not {entry!r}")
    return dict(entry)


def _word(key: str, entry: dict[str, Any]) -> str:
    """Taken out of an entry."""
    value = entry.pop(key, "")
    if not isinstance(value, str):
        raise InputError(f"{key}: a text is expected, not {value!r}")
    return value


def _words(key: str, entry: dict[str, Any]) -> tuple[str, ...]:
    values = entry.pop(key, [])
    if not isinstance(values, list) or not all(isinstance(one, str) for one in values):
        raise InputError(f"{key}: a list of texts is expected, not {values!r}")
    return tuple(values)


def _intervals(key: str, entry: dict[str, Any]) -> tuple[tuple[float, float], ...]:
    values = entry.pop(key, [])
    if not isinstance(values, list) or not all(map(_is_pair, values)):
        raise InputError(f"{key}: pairs [lower, upper] are expected, not {values!r}")
    return tuple((float(lower), float(upper)) for lower, upper in values)


def _is_pair(value: Any) -> bool:
    return (
        isinstance(value, list)
        and len(value) == 2
        and all(isinstance(v, int | float) and not isinstance(v, bool) for v in value)
        and value[0] <= value[1]
    )


def _named(fit: FitRecord, names: list[tuple[FitRecord, str]]) -> str:
    """The fit's name in the file, which is added to those that there are."""
    for other, name in names:
        if other == fit:
            return name
    taken, made, count = {name for _, name in names}, fit.name, 1
    while made in taken:
        count += 1
        made = f"{fit.name}-{count}"
    names.append((fit, made))
    return made


def _fit_text(name: str, fit: FitRecord) -> str:
    lines = [
        f"[fits.{key_text(name)}]",
        f"source = {value_text(fit.source)}",
        f"command = {command_text(fit.command)}",
    ]
    tables = {"": fit.details}
    if fit.taught is not None:
        tables[f"\n[fits.{key_text(name)}.range]"] = range_entries(fit.taught)
    for heading, entries in tables.items():
        lines += [heading] if heading else []
        lines += [f"{key_text(key)} = {value_text(value)}" for key, value in entries.items()]
    return "\n".join(lines)
