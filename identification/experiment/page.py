"""The page that a user takes to the robot: what to run in which order, and what comes of it.

The template alone holds marks; see `identification.pages`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from ..pages import render_markdown
from .plan import Designed, Experiment, Skipped
from .selection import seconds_of

LOG_SUFFIX = ".csv"
_UNUSED = 12
"""Runs that there was no time for, that are listed."""
_TEMPLATE = """\
{% macro table(heading, rows) %}
|{% for cell in heading %} {{ cell }} |{% endfor %}

|{% for cell in heading %} --- |{% endfor %}

{% for row in rows %}
|{% for cell in row %} {{ cell }} |{% endfor %}

{% endfor %}
{% endmacro %}
{% macro left_out(entries, most) %}
{{ table(("what", "why"), entries[:most]) }}
{% if entries | length > most %}

and {{ entries | length - most }} more.
{% endif %}
{% endmacro %}
# Test motions of {{ robot }}

{{ runs | length }} runs, {{ corners }} corners: {{ motion }} min of motion (emulated), {{ \
minutes }} min at the robot.

Logged every {{ period }} ms. Seed {{ seed }}.

{% if cell %}
Cell: {{ cell }}.

{% endif %}
{% for note in notes %}
- {{ note }}

{% endfor %}
1. Drive each run at reduced speed first, in the mode that lets you stop at any time, and watch \
it. What is proven begins at the start of the run; the first move of a program goes there from \
where the robot stands.
2. Mount {{ tool }} as it is declared in the programs; set the speed override to 100 %.
3. For each run, in the order of the table (the most informative come first, so stop when time is \
up): load the files in its folder as their first lines say, start, fetch the log.
4. Put the log beside the run's record: `NAME{{ log_suffix }}` beside `NAME.json`. **The \
controller writes every log under one name: fetch it before the next run.** Logs of another form \
(EGM, RSI, RTDE, trace) do as well, under that name.
5. `flyby compare NAME.json` holds the log against the emulation. Records and logs together are \
what a fit takes.

## Runs

{{ table(("", "run", "moves", "TCP, mm/s", "corners", "turns, °", "zones, mm", "posture",
          "motion, s", "clock, min", "way there", "gain, nats"), runs) }}
*clock*: when the run is over, if loading, starting and fetching take {{ overhead }} s. *way \
there*: whether the straight way in joint space from the end of the run before is proven to keep \
clear; *by hand*: it is not, so jog the robot to the start: the first move of the program goes \
there straight. *gain*: what the run tells of the motion model beyond those before it.

## Postures

{{ table(axes, postures) }}
## What the logs would tell

Standard deviations of the figures of the motion model, before and after.

{{ table(("figure", "looked at", "before", "after"), precision) }}
{% if skipped %}
## Not possible

{{ left_out(skipped, skipped | length) }}
{% endif %}
{% if unused %}
## Possible, if there is more time

{{ left_out(unused, most_unused) }}
{% endif %}
"""


def page(experiment: Experiment, cell: str | None) -> str:
    """The page as Markdown.

    Args:
        experiment: what was designed.
        cell: name of the cell file; None if there was none.
    """
    return render_markdown(
        _TEMPLATE,
        robot=experiment.robot.name,
        corners=sum(len(run.candidate.corners) for run in experiment.runs),
        motion=f"{sum(run.duration for run in experiment.runs) / 60:.0f}",
        minutes=f"{experiment.seconds / 60:.0f}",
        period=f"{1e3 * experiment.period:.4g}",
        seed=experiment.plan.seed,
        cell=cell,
        notes=experiment.notes,
        tool=experiment.plan.tool.name,
        log_suffix=LOG_SUFFIX,
        overhead=f"{experiment.plan.overhead:.0f}",
        runs=list(_rows(experiment)),
        axes=("", *experiment.robot.axis_names),
        postures=list(_postures(experiment)),
        precision=list(_precision(experiment)),
        skipped=_left_out(experiment.skipped),
        unused=_left_out(experiment.unused),
        most_unused=_UNUSED,
    )


def _rows(experiment: Experiment) -> Iterable[Sequence[str]]:
    clock = 0.0
    for number, made in enumerate(experiment.runs, 1):
        clock += seconds_of(made.duration, experiment.plan)
        yield (
            str(number),
            made.candidate.name,
            *described(made),
            str(made.candidate.posture + 1),
            f"{made.duration:.1f}",
            f"{clock / 60:.0f}",
            way(made, number == 1),
            f"{made.gain:.2f}",
        )


def described(made: Designed) -> tuple[str, str, str, str, str]:
    """Kind, speed in mm/s, number of corners, turns in degrees and zones in mm of a run."""
    candidate = made.candidate
    turns = sorted({round(math.degrees(corner.turn), 2) for corner in candidate.corners})
    radii = sorted({1e3 * corner.radius for corner in candidate.corners})
    return (
        str(candidate.kind),
        "" if candidate.speed is None else f"{1e3 * candidate.speed:.5g}",
        str(len(candidate.corners) or ""),
        " ".join(f"{turn:.4g}" for turn in turns),
        " ".join(f"{radius:.4g}" for radius in radii),
    )


def way(made: Designed, first: bool) -> str:
    """Whether the way to a run is proven."""
    return "proven" if made.way_proven and not first else "by hand"


def _postures(experiment: Experiment) -> Iterable[Sequence[str]]:
    for number, site in enumerate(experiment.sites, 1):
        yield (str(number), *(f"{math.degrees(value):.2f}" for value in site.q))


def _precision(experiment: Experiment) -> Iterable[Sequence[str]]:
    for figure in experiment.precision:
        numbers = (figure.value, figure.before, figure.after)
        yield (figure.key, *(f"{number:.3g}" for number in numbers))


def _left_out(left: Sequence[Skipped]) -> list[tuple[str, str]]:
    return [(entry.what, entry.reason) for entry in left]
