"""Writes what was fitted as a motion file: a layer that holds for one robot.

robot = "abb/irb6640-180-255"

[blend.tcp]
beta = [-0.54]

[provenance]
"blend.tcp.beta" = { status = "fitted", command = "…", runs = 29, interval = [[-0.55, -0.53]] }
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from typing import Any

from ...core.motion.model import MotionModel
from .fitting import Fit
from .keys import field_of, figure_of, steps_of
from .parameters import Parameter


def motion_file(
    fitted: Fit,
    command: str,
    heading: str = "",
    reference: MotionModel | None = None,
    words: Iterable[str] = (),
) -> str:
    """The text of the file.

    Args:
        fitted: the fit.
        command: that gives the same figures from the same logs.
        heading: comment above all.
        reference: what the file will be laid on; figures that differ from it are written though
            they were not fitted. None if all but the fitted ones agree.
        words: keys that a motion file has, to call the parts of such figures by.
    """
    model, names = fitted.model, _names(fitted)
    figures: dict[str, list[int]] = {}
    for k, one in enumerate(fitted.parameters.parameters):
        for key in one.keys:
            figure = figure_of(key, model)
            if figure is not None:
                figures.setdefault(figure, []).append(k)
    for figure in sorted(model.figures if reference is not None else ()):
        if _value(model, figure) != _value(reference, figure):
            figures.setdefault(figure, [])
    tables: dict[str, list[str]] = {}
    for figure in figures:
        table, _, name = figure.rpartition(".")
        text = _text(_value(model, figure), names, tuple(words))
        tables.setdefault(table, []).append(f"{name} = {text}")
    robot = fitted.runs[0].robot.name
    lines = [f"# {line}".rstrip() for line in heading.splitlines()]
    lines += [f"robot = {_string(robot)}", *tables.pop("", [])]
    for table, entries in tables.items():
        lines += ["", f"[{table}]", *entries]
    lines += ["", "[provenance]"]
    lines += [
        f"{_string(figure)} = {_text(_origin(fitted, figure, command, members), names)}"
        for figure, members in figures.items()
    ]
    return "\n".join(lines) + "\n"


def _origin(fitted: Fit, figure: str, command: str, members: list[int]) -> dict[str, Any]:
    """The provenance of a figure, fitted or not."""
    if members:
        return _provenance(fitted, command, members)
    known = fitted.model.provenance.get(figure)
    if known is None:
        return {"status": "assumed", "source": "stated where the fit began"}
    return {"status": known.status, "source": known.source, **known.details}


def _provenance(fitted: Fit, command: str, members: list[int]) -> dict[str, Any]:
    fitted_keys = [_told(fitted.parameters.parameters[k]) for k in members]
    known = [fitted.intervals[k] for k in members]
    return {
        "status": "fitted",
        "source": _source(fitted),
        "command": command,
        "runs": len(fitted.runs),
        "fitted": fitted_keys,
        "interval": [[_rounded(one.lower, one), _rounded(one.upper, one)] for one in known],
        "confidence": 0.95,
        "loss": float(f"{fitted.after:.4g}"),
    }


def _source(fitted: Fit) -> str:
    """Where the runs come from, as far as their records say."""
    runs = fitted.runs
    sources = dict.fromkeys(run.run.source for run in runs if run.run.source)
    return "; ".join([f"{len(runs)} logged run{'s' * (len(runs) != 1)}", *sources])


def _told(one: Parameter) -> str:
    """The parameter as ``--fit`` takes it."""
    return f"{one.name} in {one.lower:g} .. {one.upper:g}"


def _rounded(value: float, interval: Any) -> float:
    """To two digits of the deviation."""
    if not interval.deviation > 0:
        return float(f"{value:.6g}")
    return float(f"{value:.{max(1, 1 + len(str(int(abs(value) / interval.deviation))))}g}")


def _value(model: Any, figure: str) -> Any:
    owner = model
    for step in steps_of(figure):
        assert isinstance(step, str)
        field = field_of(owner, step)
        owner = owner if field is None else getattr(owner, field)
    return owner


def _names(fitted: Fit) -> dict[str, str]:
    """What the file calls a field, as far as keys of parameters tell."""
    model, found = fitted.model, {}
    for one in fitted.parameters.parameters:
        for key in one.keys:
            owner: Any = model
            for step in steps_of(key):
                if isinstance(step, slice):
                    owner = owner[step][0]
                    continue
                field = field_of(owner, step)
                if field is not None:
                    found[field] = step
                    owner = getattr(owner, field)
    return found


def _text(value: Any, names: Mapping[str, str], words: tuple[str, ...] = ()) -> str:
    """A value in TOML."""
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, list | tuple):
        return f"[{', '.join(_text(entry, names, words) for entry in value)}]"
    if dataclasses.is_dataclass(value):
        fields = [field.name for field in dataclasses.fields(value)]
        told = {word: field_of(value, word) for word in words}
        called = {field: word for word, field in told.items() if field is not None} | dict(names)
        value = {called.get(field, field): getattr(value, field) for field in fields}
    return "{ " + ", ".join(f"{k} = {_text(v, names, words)}" for k, v in value.items()) + " }"


def _number(value: float) -> str:
    text = f"{value:.6g}"
    return text if any(mark in text for mark in ".en") else f"{text}.0"


def _string(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in escaped) + '"'
