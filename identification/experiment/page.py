"""The page that a user takes to the robot: what to run in which order, and what comes of it.

The template alone holds marks; see `identification.pages`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from markupsafe import Markup

from ..pages import render_markdown
from .kinds import Topic
from .plan import Alternative, Designed, Experiment, Skipped
from .purpose import DECISIONS, QUESTIONS, fit_text
from .selection import seconds_of

LOG_SUFFIX = ".csv"
_UNUSED = 12
"""Runs that there was no time for, that are listed."""
UNKNOWN = "nothing that the model knows of"
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

{% if topics %}
## What the runs are for

*If instead*: what may be so instead of what is emulated; how much longer the run takes then, and \
how far from the emulated path it runs. `flyby compare NAME.json` says which of them the log is \
nearest to.

{% for topic in topics %}
### {{ topic.name }}

{{ topic.question }} {{ topic.decision }}

{{ table(("run", "motion, s", "figures that it shows", "if instead"), topic.rows) }}
{% if topic.fits %}
With the logs beside the records: `flyby identify FOLDER --robot ROBOT{{ topic.fits }}`

{% endif %}
{% endfor %}
{% endif %}
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
        topics=list(_topics(experiment)),
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
    ordered = sorted(candidate.corners, key=lambda one: (one.share or 0.0, one.radius))
    zones = dict.fromkeys(one.zone.removesuffix(" mm") for one in ordered)
    return (
        str(candidate.kind),
        "" if candidate.speed is None else f"{1e3 * candidate.speed:.5g}",
        str(len(candidate.corners) or ""),
        " ".join(f"{turn:.4g}" for turn in turns),
        " ".join(zones),
    )


def way(made: Designed, first: bool) -> str:
    """Whether the way to a run is proven."""
    return "proven" if made.way_proven and not first else "by hand"


def _topics(experiment: Experiment) -> Iterable[dict[str, Any]]:
    """What stands of each topic that has runs."""
    for topic in Topic:
        runs = [one for one in experiment.runs if one.topic is topic]
        if not runs:
            continue
        keys = dict.fromkeys(key for one in runs for key in one.figures)
        texts = sorted(text for key in keys if (text := fit_text(experiment.model, key)))
        yield {
            "name": topic,
            "question": QUESTIONS[topic],
            "decision": DECISIONS[topic],
            "rows": [
                (one.candidate.name, f"{one.duration:.1f}", grouped(one.figures), instead(one))
                for one in runs
            ],
            # Keys of the model alone, which hold no marks that a page must not have.
            "fits": Markup("".join(f" --fit '{text}'" for text in texts)),
        }


def instead(made: Designed) -> str:
    """What may be so instead of what is emulated, and what it would change."""
    found = () if made.purpose is None else made.purpose.alternatives
    return "; ".join(f"{one.what}: {_changed(one)}" for one in found) or UNKNOWN


def _changed(one: Alternative) -> str:
    if one.turned is None:
        return f"{one.longer:+.2f} s, {1e3 * one.apart:.2g} mm"
    return f"joints {1e3 * one.turned:.2g} mrad"


def grouped(keys: Iterable[str]) -> str:
    """Keys of figures, entries of one list together: ``torque.own_s2[0, 1]``."""
    lists: dict[str, list[str]] = {}
    for key in keys:
        name, _, index = key.partition("[")
        lists.setdefault(name, []).extend([index.rstrip("]")] if index else [])
    return ", ".join(
        f"{name}[{', '.join(entries)}]" if entries else name for name, entries in lists.items()
    )


def _postures(experiment: Experiment) -> Iterable[Sequence[str]]:
    for number, site in enumerate(experiment.sites, 1):
        yield (str(number), *(f"{math.degrees(value):.2f}" for value in site.q))


def _precision(experiment: Experiment) -> Iterable[Sequence[str]]:
    for figure in experiment.precision:
        numbers = (figure.value, figure.before, figure.after)
        yield (figure.key, *(f"{number:.3g}" for number in numbers))


def _left_out(left: Sequence[Skipped]) -> list[tuple[str, str]]:
    return [(entry.what, entry.reason) for entry in left]
