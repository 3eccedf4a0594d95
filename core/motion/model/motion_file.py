"""Motion models in TOML files, in which every figure states where it comes from."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...errors import InputError, UnknownNameError
from ...files.reading import read_toml
from ...files.toml_text import key_text, value_text
from .figures import Figure, with_figures
from .motion_model import FIGURES, MotionModel
from .provenance import Provenance, of_each, read_provenance

_LARGEST = 1e12
_BESIDE = ("robot", "fits", "provenance")
"""What a file states beside figures."""
_TABLES = frozenset(
    key[:at] for key in FIGURES for at, character in enumerate(key) if character == "."
)


def load_motion_model(
    path: Path, base: MotionModel | None = None, robot: str | None = None
) -> MotionModel:
    """Read a motion model.

    Args:
        path: TOML. A file may name the one ``robot`` that it holds for.
        base: what holds where the file states nothing; None for the defaults of `MotionModel`.
        robot: that is to be driven, such as ``abb/irb6640-180-255``; None for any.

    Raises:
        InputError: the file is missing or no TOML, is another robot's, a key is unknown, a value
            has the wrong type or range; the message names file and key.
    """
    data = read_toml(path, _LARGEST)
    own = data.pop("robot", robot)
    if robot is not None and own != robot:
        raise InputError(f"{path}: it says how {own} is driven, not {robot}")
    try:
        return _model(data, MotionModel() if base is None else base)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def with_stated(base: MotionModel, stated: Mapping[str, tuple[Any, str]]) -> MotionModel:
    """A motion model with figures that a controller's own files state.

    Args:
        base: what holds where they state nothing.
        stated: value, as files have it, and origin of each figure by its key (``time.period_s``):
            "published: …" or "assumed: …".

    Raises:
        InputError: a key is unknown, or a value has the wrong type or range; it is named.
    """
    values = {}
    for key, (entry, _) in stated.items():
        if key not in FIGURES:
            raise UnknownNameError("key of a motion model", key, FIGURES)
        values[FIGURES[key]] = FIGURES[key].kind.read(key, entry)
    origins = {key: _stated(source) for key, (_, source) in stated.items()}
    return replace(with_figures(base, values), provenance={**base.provenance, **origins})


def _stated(origin: str) -> Provenance:
    """The provenance of an origin as robots' have it."""
    status, _, source = origin.partition(": ")
    if status == "assumed":
        return Provenance("assumed", source)
    return Provenance("published", source if status == "published" else origin)


def _model(data: dict[str, Any], base: MotionModel) -> MotionModel:
    fits, origins = (_table(key, data.pop(key, {})) for key in ("fits", "provenance"))
    values = _values(data)
    made = with_figures(base, values)
    # What the file says of several figures at once is said of those that it states itself.
    stated = {figure.key for figure in values}
    own = made.figures & (stated | (made.figures - base.provenance.keys()))
    provenance = {**base.provenance, **of_each(read_provenance(fits, origins), own)}
    return replace(made, provenance=provenance)


def _values(table: dict[str, Any], prefix: str = "") -> dict[Figure, Any]:
    """What a table states, and those in it."""
    found: dict[Figure, Any] = {}
    for name, entry in table.items():
        key = prefix + name
        if key in FIGURES and "." not in name:
            found[FIGURES[key]] = FIGURES[key].kind.read(key, entry)
        elif key in _TABLES and "." not in name:
            found |= _values(_table(key, entry), f"{key}.")
        else:
            raise UnknownNameError("key of a motion model", key, _known(prefix))
    return found


def _known(prefix: str) -> set[str]:
    """Keys that a table may have."""
    inner = (key[len(prefix) :] for key in FIGURES if key.startswith(prefix))
    return {prefix + key.partition(".")[0] for key in inner} | set(() if prefix else _BESIDE)


def _table(key: str, entry: Any) -> dict[str, Any]:
    if not isinstance(entry, dict):
        raise InputError(f"{key}: a table is expected, not {entry!r}")
    return entry


def figures_text(
    model: MotionModel, keys: Iterable[str], rounded: Callable[[float], float] = float
) -> str:
    """The lines of a file that state some figures, tables after what stands in none.

    Args:
        model: that has them.
        keys: of the figures.
        rounded: what numbers are rounded by.
    """
    tables: dict[str, list[str]] = {"": []}
    for key in keys:
        one = FIGURES[key]
        entry = _rounded(one.kind.entry(one.of(model)), rounded)
        name = key_text(key.rpartition(".")[2])
        tables.setdefault(one.table, []).append(f"{name} = {value_text(entry)}")
    lines = tables.pop("")
    for table, entries in tables.items():
        lines += ["", f"[{table}]", *entries]
    return "\n".join(lines)


def _rounded(entry: Any, rounded: Callable[[float], float]) -> Any:
    if isinstance(entry, float):
        return rounded(entry)
    if isinstance(entry, list):
        return [_rounded(one, rounded) for one in entry]
    if isinstance(entry, dict):
        return {key: _rounded(one, rounded) for key, one in entry.items()}
    return entry
