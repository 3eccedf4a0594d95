"""Writes what was fitted as a motion file: a layer that holds for one robot.

robot = "abb/irb6640-180-255"

[blend.tcp]
beta = [-0.54]

[fits.robotstudio]
source = "29 logged runs; …"
command = "flyby identify …"

[provenance]
"blend.tcp.beta" = { status = "fitted", by = "robotstudio", fitted = ["…"], interval = [[…]] }
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...core.files.toml_text import key_text, string_text, value_text
from ...core.motion.command.elasticity import Carried, Coupled
from ...core.motion.model.motion_model import MotionModel
from ...core.motion.model.provenance import FitRecord, Provenance, provenance_text
from ...core.motion.timing.torque import Borne
from .fitting import Fit
from .intervals import CONFIDENCE, Interval
from .keys import field_of, figure_of, steps_of
from .parameters import Parameter

ASSUMED = Provenance("assumed", "stated where the fit began")
ARC_TURN = "arc.turn"
"""A figure that is no number: logs show which of some it is."""


def motion_file(
    fitted: Fit,
    command: str,
    heading: str = "",
    reference: MotionModel | None = None,
    name: str = "logs",
) -> str:
    """The text of the file.

    Args:
        fitted: the fit.
        command: that gives the same figures from the same logs.
        heading: comment above all.
        reference: what the file will be laid on; figures that differ from it are written though
            they were not fitted. None if all but the fitted ones agree.
        name: of the fit in the file.
    """
    members = _members(fitted)
    if reference is not None:
        members = members | {figure: [] for figure in _others(fitted.model, reference, members)}
    elif fitted.turn is not None:
        members.setdefault(ARC_TURN, [])
    tables: dict[str, list[str]] = {}
    for figure in members:
        table, _, key = figure.rpartition(".")
        text = value_text(_plain(_value(fitted.model, figure)))
        tables.setdefault(table, []).append(f"{key_text(key)} = {text}")
    lines = [f"# {line}".rstrip() for line in heading.splitlines()]
    lines += [f"robot = {string_text(fitted.runs[0].robot.name)}", *tables.pop("", [])]
    for table, entries in tables.items():
        lines += ["", f"[{table}]", *entries]
    record = _record(fitted, name, command)
    origins = {figure: _origin(fitted, figure, record, ks) for figure, ks in members.items()}
    return "\n".join([*lines, "", provenance_text(origins)])


def _members(fitted: Fit) -> dict[str, list[int]]:
    """Indices of the parameters that belong to each figure."""
    parameters = fitted.parameters
    # What was fitted down to nothing is a figure of the start.
    start = parameters.model(parameters.start)
    stated = fitted.model.figures | start.figures | parameters.base.figures
    found: dict[str, list[int]] = {}
    for k, one in enumerate(parameters.parameters):
        for key in one.keys:
            figure = figure_of(key, stated)
            if figure is not None:
                found.setdefault(figure, []).append(k)
    return found


def _others(model: MotionModel, reference: MotionModel, known: Iterable[str]) -> list[str]:
    """Figures beyond the known ones by which two models differ."""
    figures = sorted((model.figures | reference.figures).difference(known))
    return [one for one in figures if _value(model, one) != _value(reference, one)]


def _record(fitted: Fit, name: str, command: str) -> FitRecord:
    runs = fitted.runs
    sources = dict.fromkeys(run.run.source for run in runs if run.run.source)
    count = f"{len(runs)} logged run{'s' * (len(runs) != 1)}"
    details = {"runs": len(runs), "confidence": CONFIDENCE, "loss": float(f"{fitted.after:.4g}")}
    return FitRecord(name, "; ".join([count, *sources]), command, details)


def _origin(fitted: Fit, figure: str, record: FitRecord, members: list[int]) -> Provenance:
    """The provenance of a figure, fitted or not."""
    if figure == ARC_TURN and fitted.turn is not None:
        shown = [run.name for run in fitted.runs if run.turn is fitted.turn]
        return Provenance("fitted", fit=record, details={"shown_by": shown})
    if not members:
        return fitted.model.provenance.get(figure, ASSUMED)
    intervals = [fitted.intervals[k] for k in members]
    return Provenance(
        "fitted",
        fit=record,
        fitted=tuple(_told(fitted.parameters.parameters[k]) for k in members),
        interval=tuple((_rounded(one.lower, one), _rounded(one.upper, one)) for one in intervals),
    )


def _told(one: Parameter) -> str:
    """The parameter as ``--fit`` takes it."""
    return f"{one.name} in {one.lower:g} .. {one.upper:g}"


def _rounded(value: float, interval: Interval) -> float:
    """To two digits of the deviation."""
    if not interval.deviation > 0:
        return float(f"{value:.6g}")
    return float(f"{value:.{max(1, 1 + len(str(int(abs(value) / interval.deviation))))}g}")


def _value(model: MotionModel, figure: str) -> Any:
    """What a model has as a figure."""
    owner: Any = model
    group = ""
    for step in steps_of(figure):
        assert isinstance(step, str)
        # A table that names no field may be part of the name of one: zone.orientation is
        # orientation_zone, line.turn line_turn.
        names = (f"{step}_{group}", f"{group}_{step}", step)
        field = next((one for name in names if (one := field_of(owner, name))), None)
        group = step if field is None else ""
        owner = owner if field is None else getattr(owner, field)
    return owner


def _plain(value: Any) -> Any:
    """A value as the file has it, numbers to six digits."""
    if value is None:
        return "none"
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if isinstance(value, Carried | Coupled | Borne):
        return _plain(value.entry)
    if isinstance(value, tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    return value
