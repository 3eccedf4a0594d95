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

from ...core.files.toml_text import string_text
from ...core.motion.model.motion_file import figures_text
from ...core.motion.model.motion_model import FIGURES, MotionModel
from ...core.motion.model.provenance import FitRecord, Provenance, provenance_text
from ...core.motion.model.taught_range import TaughtRange
from .fitting import Fit
from .intervals import CONFIDENCE, Interval
from .keys import figure_of
from .parameters import FittedParameter

ASSUMED = Provenance("assumed", "stated where the fit began")
ARC_TURN = "arc.turn"
"""A figure that is no number: logs show which of some it is."""


def motion_file(
    fitted: Fit,
    command: str,
    heading: str = "",
    reference: MotionModel | None = None,
    name: str = "logs",
    taught: TaughtRange | None = None,
) -> str:
    """The text of the file.

    Args:
        fitted: the fit.
        command: that gives the same figures from the same logs.
        heading: comment above all.
        reference: what the file will be laid on; figures that differ from it are written though
            they were not fitted. None if all but the fitted ones agree.
        name: of the fit in the file.
        taught: what the runs cover.
    """
    members = _members(fitted)
    if reference is not None:
        members = members | {figure: [] for figure in _others(fitted.model, reference, members)}
    elif fitted.turn is not None:
        members.setdefault(ARC_TURN, [])
    lines = [f"# {line}".rstrip() for line in heading.splitlines()]
    lines += [f"robot = {string_text(fitted.runs[0].robot.name)}"]
    lines += [figures_text(fitted.model, members, _six_digits)]
    record = _record(fitted, name, command, taught)
    origins = {figure: _origin(fitted, figure, record, ks) for figure, ks in members.items()}
    return "\n".join([*lines, "", provenance_text(origins)])


def _members(fitted: Fit) -> dict[str, list[int]]:
    """Indices of the parameters that belong to each figure."""
    found: dict[str, list[int]] = {}
    for k, one in enumerate(fitted.parameters.parameters):
        for key in one.keys:
            found.setdefault(figure_of(key).key, []).append(k)
    return found


def _others(model: MotionModel, reference: MotionModel, known: Iterable[str]) -> list[str]:
    """Figures beyond the known ones by which two models differ."""
    figures = sorted((model.figures | reference.figures).difference(known))
    return [one for one in figures if FIGURES[one].of(model) != FIGURES[one].of(reference)]


def _record(fitted: Fit, name: str, command: str, taught: TaughtRange | None) -> FitRecord:
    runs = fitted.runs
    sources = dict.fromkeys(run.run.source for run in runs if run.run.source)
    count = f"{len(runs)} logged run{'s' * (len(runs) != 1)}"
    details = {"runs": len(runs), "confidence": CONFIDENCE, "loss": float(f"{fitted.after:.4g}")}
    return FitRecord(name, "; ".join([count, *sources]), command, details, taught)


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


def _told(one: FittedParameter) -> str:
    """The parameter as ``--fit`` takes it."""
    return f"{one.name} in {one.lower:g} .. {one.upper:g}"


def _rounded(value: float, interval: Interval) -> float:
    """To two digits of the deviation."""
    if not interval.deviation > 0:
        return float(f"{value:.6g}")
    return float(f"{value:.{max(1, 1 + len(str(int(abs(value) / interval.deviation))))}g}")


def _six_digits(value: float) -> float:
    return float(f"{value:.6g}")
