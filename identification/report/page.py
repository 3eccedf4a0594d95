"""The page of a fit: parameters, what is left run by run, pictures, the motion file.

The template alone holds marks; see `identification.pages`.
"""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..fit import Fit, Judgement, Outcome
from ..pages import render_html
from ..residuals import Figures
from .corners import CutCorner, cut_corners
from .picture import draw_prediction

_TEMPLATE = """\
{% macro table(heading, rows) %}
<table><thead><tr>
{%- for cell in heading %}<th>{{ cell }}</th>{% endfor -%}
</tr></thead><tbody>
{% for row in rows %}
<tr>{% for cell in row %}<td>{{ cell }}</td>{% endfor %}</tr>
{% endfor %}
</tbody></table>
{% endmacro %}
<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{{ title }}</title><style>
body { font: 14px/1.5 system-ui, sans-serif; max-width: 75rem; margin: 2rem auto; padding: 0 1rem;
       color: #222 }
h1, h2, h3 { line-height: 1.2 }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums }
th, td { padding: .2rem .7rem; text-align: right; border-bottom: 1px solid #e6e6e6 }
th { border-bottom: 1px solid #888; font-weight: 600; vertical-align: bottom }
th:first-child, td:first-child { text-align: left }
img { width: 100%; height: auto }
pre { background: #f6f6f6; padding: 1rem; overflow-x: auto }
p.note { color: #555 }
</style></head><body>
<h1>{{ title }}</h1>
{% for line in summary %}
<p>{{ line }}</p>
{% endfor %}
{% if refused %}
<p><b>What was fitted {{ refused }} the model before it.</b></p>
{% endif %}
{% if not converged %}
<p><b>The fit was ended before it could go no further.</b></p>
{% endif %}
<h2>Parameters</h2>
{{ table(parameters[0], parameters[1]) }}
{% for one in unseen %}
<p class="note">{{ one.name }} is not identifiable: {{ one.reason }}; it stays as it was.</p>
{% endfor %}
<h2>What is left, run by run</h2>
{{ table(residuals[0], residuals[1]) }}
<p class="note">Log less emulation, before → after the fit. <i>Path</i>: time aside. <i>At their
time</i>: after one constant offset for each run.</p>
<h2>Cycle times</h2>
{{ table(times[0], times[1]) }}
<p class="note"><i>Drift</i>: how far the log falls behind from start to end. <i>Clock</i>: seconds
that pass while the log counts one, fitted; it is taken off the logs. <i>Zones</i>: as a factor of
what the record says, where that was not recorded.</p>
<h2>Runs</h2>
{% for run in runs %}
<h3>{{ run.name }}</h3>
{% for note in run.notes %}
<p class="note">{{ note }}</p>
{% endfor %}
{% if run.corners[1] %}
{{ table(run.corners[0], run.corners[1]) }}
{% endif %}
<img alt="log and emulation of {{ run.name }}" src="data:image/png;base64,{{ run.picture }}">
{% endfor %}
<h2>The motion file</h2>
<pre>{{ motion_file }}</pre>
</body></html>
"""
_WIDTH, _COLOURS = 1600, 128
"""Pixels and colours of a picture."""
_BEFORE_AFTER = " → "
_Rows = tuple[Sequence[str], Sequence[Sequence[str]]]
"""Heading and rows of a table."""
_CORNERS = 12
"""Corners of a run that are listed; those where the log deviates most."""


def page(
    fitted: Fit, outcomes: Sequence[Outcome], motion_file: str, judged: Judgement | None = None
) -> str:
    """The page, whole in one file.

    Args:
        fitted: the fit.
        outcomes: its runs (`fit.outcomes`).
        motion_file: the text of the motion file that it gave (`fit.motion_file`).
        judged: by what was held back; None if nothing was.
    """
    return render_html(
        _TEMPLATE,
        title=f"How {fitted.runs[0].robot.name} is driven",
        summary=_summary(fitted, outcomes, judged),
        refused=None if judged is None or judged.better else judged.verdict,
        converged=fitted.converged,
        parameters=_parameters(fitted),
        unseen=fitted.unseen,
        residuals=_residuals(outcomes),
        times=_times(outcomes),
        runs=[_run(one) for one in outcomes],
        motion_file=motion_file,
    )


def _summary(fitted: Fit, outcomes: Sequence[Outcome], judged: Judgement | None) -> list[str]:
    worst = max(outcomes, key=lambda one: one.after.figures.path_max)
    return [
        f"{fitted.parameters.size} parameters, fitted to {len(outcomes)} logged runs in "
        f"{fitted.iterations} iterations: mean robust loss {fitted.before:.4g} before, "
        f"{fitted.after:.4g} after.",
        f"The log that deviates most from its emulation is {worst.run.name}: "
        f"{1e3 * worst.after.figures.path_max:.3f} mm.",
        *(f"{names}: {what}." for names, what in fitted.scales),
        *(() if judged is None else (f"To judge the fit: {judged.told}.",)),
    ]


def _parameters(fitted: Fit) -> _Rows:
    starts = {p.name: p.start for p in fitted.parameters.parameters}
    known = [
        (
            one.name,
            f"{starts[one.name]:.5g}",
            f"{one.value:.5g}",
            f"{one.deviation:.2g}",
            f"{one.lower:.4g} … {one.upper:.4g}",
        )
        for one in fitted.intervals
    ]
    return ("parameter", "start", "fitted", "deviation", "95 %"), known


def _residuals(outcomes: Sequence[Outcome]) -> _Rows:
    heading = (
        "run",
        "path of the TCP, mm: greatest",
        "99 %",
        "RMS",
        "path of the joints, °: greatest",
        "99 %",
        "RMS",
        "joints at their time, °: greatest",
        "99 %",
        "RMS",
    )
    rows = [
        (one.run.name, *(_both(*pair) for pair in zip(*map(_numbers, _pair(one)), strict=True)))
        for one in outcomes
    ]
    return heading, rows


def _pair(one: Outcome) -> tuple[Figures, Figures]:
    return one.before.figures, one.after.figures


def _numbers(f: Figures) -> tuple[float, ...]:
    path = (f.path_max, f.path_p99, f.path_rms)
    place = (f.joint_path_max, f.joint_path_p99, f.joint_path_rms)
    time = (f.joint_time_max, f.joint_time_p99, f.joint_time_rms)
    return (*(1e3 * value for value in path), *map(float, np.degrees([*place, *time])))


def _both(before: float, after: float) -> str:
    return f"{before:.3f}{_BEFORE_AFTER}{after:.3f}"


def _times(outcomes: Sequence[Outcome]) -> _Rows:
    rows = []
    for one in outcomes:
        before, after = one.before.alignment, one.after.alignment
        rows.append(
            (
                one.run.name,
                f"{after.logged_moving:.3f}",
                _both(before.moving, after.moving),
                f"{before.cycle_time_ratio:.4f}{_BEFORE_AFTER}{after.cycle_time_ratio:.4f}",
                f"{1e3 * one.after.figures.drift:+.1f}",
                f"{one.nuisance.clock:.5f}",
                f"{one.nuisance.size:.4g}" if not one.run.run.zones_known else "as programmed",
            )
        )
    heading = (
        "run", "logged, s", "emulated, s", "emulated / logged", "drift, ms", "clock", "zones",
    )  # fmt: skip
    return heading, rows


def _run(one: Outcome) -> dict[str, Any]:
    picture = base64.b64encode(_small(draw_prediction(one.after, "png"))).decode("ascii")
    return {
        "name": one.run.name,
        "notes": _notes(one),
        "corners": _corners(cut_corners(one.after)),
        "picture": picture,
    }


def _notes(one: Outcome) -> list[str]:
    """What was wrong with the log, and what it would be off by as it was read."""
    found, notes = one.after, list(one.after.log.notes)
    if found.read is not None:
        path, place, _ = _numbers(found.read)[::3]
        notes.append(
            f"As read, the TCP is off its path by up to {path:.3f} mm, the joints off theirs by up "
            f"to {place:.3f}°."
        )
    return notes


def _small(picture: bytes) -> bytes:
    """A PNG with few colours and no wider than pages show, a quarter of the size."""
    from PIL import Image

    image = Image.open(io.BytesIO(picture)).convert("RGB")
    height = round(image.height * min(1.0, _WIDTH / image.width))
    resized = image.resize((min(image.width, _WIDTH), height), Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    resized.quantize(_COLOURS, Image.Quantize.FASTOCTREE).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def _corners(corners: Sequence[CutCorner]) -> _Rows:
    worst = sorted(sorted(corners, key=lambda corner: -corner.off)[:_CORNERS], key=lambda c: c.move)
    rows = [
        (
            f"{corner.move + 1}",
            f"{1e3 * corner.radius:.4g}",
            f"{1e3 * corner.logged:.3f}",
            f"{1e3 * corner.emulated:.3f}",
            f"{1e3 * corner.off:.3f}",
        )
        for corner in worst
    ]
    heading = (
        "corner of move", "zone, mm", "least distance from the waypoint, mm: logged", "emulated",
        "path off nearby, mm",
    )  # fmt: skip
    return heading, rows
