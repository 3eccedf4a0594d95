"""The page that a user takes to the robot: what to do, what to run, and what comes of it.

One HTML file that opens from disk and prints on A4. The template alone holds marks; see
`identification.pages`.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ..pages import render_html
from .kinds import Kind, Topic
from .page_template import TEMPLATE
from .plan import Alternative, Designed, Experiment, Skipped
from .purpose import DECISIONS, QUESTIONS, fit_text
from .selection import seconds_of

_UNUSED = 12
"""Runs that there was no time for, that are listed."""
BY_HAND = "by hand"
UNKNOWN = "nothing that the model knows of"
_SHOWN_BY = {
    Kind.LINES: "how corners between lines run and how fast they are passed",
    Kind.JOINTS: "how corners between joint moves run and how fast they are passed",
    Kind.ARCS: "how corners between arcs run and how fast they are passed",
    Kind.LINES_AND_JOINTS: "corners between lines and joint moves, both ways",
    Kind.LINES_AND_ARCS: "corners between lines and arcs, both ways",
    Kind.TURNS: "corners in which the tool turns otherwise before than behind",
    Kind.LINE_STOPS: "accelerations along lines, and settling at stops",
    Kind.JOINT_STOPS: "accelerations of joint moves, and settling at stops",
    Kind.SINGLE_AXES: "the greatest acceleration of each axis",
}


def page(experiment: Experiment, cell: str | None, picture: bytes | None = None) -> str:
    """The page as HTML.

    Args:
        experiment: what was designed.
        cell: name of the cell file; None if there was none.
        picture: PNG of the runs in the cell; None for none.
    """
    runs = list(_rows(experiment))
    return render_html(
        TEMPLATE,
        robot=experiment.robot.name,
        corners=sum(len(run.candidate.corners) for run in experiment.runs),
        motion=f"{sum(run.duration for run in experiment.runs) / 60:.0f}",
        minutes=f"{experiment.seconds / 60:.0f}",
        period=f"{1e3 * experiment.period:.4g}",
        seed=experiment.plan.seed,
        cell=cell,
        notes=experiment.notes,
        tool=experiment.plan.tool.name,
        overhead=f"{experiment.plan.overhead:.0f}",
        steps=experiment.steps,
        files=list(experiment.sources),
        starts=1 + sum(row["by_hand"] for row in runs[1:]),
        fastest=f"{1e3 * max(_speeds(experiment)):.0f}",
        runs=runs,
        axes=experiment.robot.axis_names,
        topics=list(_topics(experiment)),
        fits=_fits(experiment, experiment.runs),
        postures=list(_postures(experiment)),
        precision=list(_precision(experiment)),
        skipped=_left_out(experiment.skipped),
        unused=_left_out(experiment.unused[:_UNUSED]),
        unused_more=max(0, len(experiment.unused) - _UNUSED),
        picture=None if picture is None else base64.b64encode(picture).decode(),
    )


def _speeds(experiment: Experiment) -> Iterable[float]:
    """m/s, the greatest of the TCP in each run."""
    for run in experiment.runs:
        driven = run.run.trajectory
        ways = np.linalg.norm(np.diff(driven.position, axis=0), axis=1)
        yield float((ways / np.diff(driven.t)).max())


def _rows(experiment: Experiment) -> Iterable[dict[str, Any]]:
    clock = 0.0
    for number, made in enumerate(experiment.runs, 1):
        clock += seconds_of(made.duration, experiment.plan)
        kind, speed, corners, turns, zones = described(made)
        yield {
            "number": number,
            "name": made.candidate.name,
            "stem": made.stem(number),
            "for": purpose_text(made),
            "kind": kind,
            "speed": speed,
            "corners": corners,
            "turns": turns,
            "zones": zones,
            "posture": made.candidate.posture + 1,
            "duration": f"{made.duration:.1f}",
            "clock": f"{clock / 60:.0f}",
            "by_hand": way(made, number == 1) == BY_HAND,
            "start": [f"{math.degrees(value):.2f}" for value in made.candidate.start],
            "gain": f"{made.gain:.2f}",
        }


def purpose_text(made: Designed) -> str:
    """What a run is for, in a line."""
    if made.topic is not None:
        return f"{made.topic}: {made.candidate.kind}"
    return _SHOWN_BY[made.candidate.kind]


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
    return "proven" if made.way_proven and not first else BY_HAND


def _fits(experiment: Experiment, runs: Iterable[Designed]) -> str:
    """The options of ``identify`` for the figures that runs show."""
    keys = dict.fromkeys(key for one in runs for key in one.figures)
    texts = sorted(text for key in keys if (text := fit_text(experiment.model, key)))
    return "".join(f" --fit '{text}'" for text in texts)


def _topics(experiment: Experiment) -> Iterable[dict[str, Any]]:
    """What stands of each topic that has runs."""
    for topic in Topic:
        runs = [one for one in experiment.runs if one.topic is topic]
        if not runs:
            continue
        yield {
            "name": topic,
            "question": QUESTIONS[topic],
            "decision": DECISIONS[topic],
            "rows": [
                (one.candidate.name, f"{one.duration:.1f}", grouped(one.figures), instead(one))
                for one in runs
            ],
            "fits": _fits(experiment, runs),
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
