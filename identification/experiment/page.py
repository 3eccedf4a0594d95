"""The page that a user takes to the robot: what to run in which order, and what comes of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from .plan import Designed, Experiment, Skipped
from .selection import seconds_of

LOG_SUFFIX = ".csv"
_UNUSED = 12
"""Runs that there was no time for, that are listed."""


def page(experiment: Experiment, cell: str | None) -> str:
    """The page as Markdown.

    Args:
        experiment: what was designed.
        cell: name of the cell file; None if there was none.
    """
    blocks = [
        f"# Test motions of {experiment.robot.name}",
        _summary(experiment, cell),
        _steps(experiment),
        "## Runs",
        _table(("", "run", "moves", "TCP, mm/s", "corners", "turns, °", "zones, mm", "posture",
                "motion, s", "clock, min", "way there", "gain, nats"), _rows(experiment)),
        "*clock*: when the run is over, if loading, starting and fetching take "
        f"{experiment.plan.overhead:.0f} s. *way there*: whether the straight way in joint space "
        "from the end of the run before is proven to keep clear; *jog*: move the robot near the "
        "start by hand. *gain*: what the run tells of the motion model beyond those before it.",
        "## Postures",
        _table(("", *experiment.robot.axis_names), _postures(experiment)),
        "## What the logs would tell",
        "Standard deviations of the figures of the motion model, before and after.",
        _table(("figure", "looked at", "before", "after"), _precision(experiment)),
        *_left_out("## Not possible", experiment.skipped, len(experiment.skipped)),
        *_left_out("## Possible, if there is more time", experiment.unused, _UNUSED),
    ]  # fmt: skip
    return "\n\n".join(blocks) + "\n"


def _summary(experiment: Experiment, cell: str | None) -> str:
    motion = sum(run.duration for run in experiment.runs)
    lines = [
        f"{len(experiment.runs)} runs, {sum(len(r.candidate.corners) for r in experiment.runs)} "
        f"corners: {motion / 60:.0f} min of motion (emulated), {experiment.seconds / 60:.0f} min "
        "at the robot.",
        f"Logged every {1e3 * experiment.period:.4g} ms. Seed {experiment.plan.seed}.",
        f"Cell: {cell}." if cell else "",
        *(f"- {note}" for note in experiment.notes),
    ]
    return "\n\n".join(line for line in lines if line)


def _steps(experiment: Experiment) -> str:
    tool = experiment.plan.tool
    steps = [
        "Drive each run at reduced speed first, in the mode that lets you stop at any time, and "
        "watch it. What is proven begins at the start of the run; the first move of a program goes "
        "there from where the robot stands.",
        f"Mount {tool.name} as it is declared in the programs; set the speed override to 100 %.",
        "For each run, in the order of the table (the most telling come first, so stop whenever "
        "time is up): load the files in its folder as their first lines say, start, fetch the log.",
        f"Put the log beside the run's record: `NAME{LOG_SUFFIX}` beside `NAME.json`. **The "
        "controller writes every log under one name: fetch it before the next run.** Logs of "
        "another form (EGM, RSI, RTDE, trace) do as well, under that name.",
        "`flyby compare NAME.json` holds the log against the emulation. Records and logs together "
        "are what a fit takes.",
    ]
    return "\n".join(f"{k}. {step}" for k, step in enumerate(steps, 1))


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
    return "proven" if made.way_proven and not first else "jog"


def _postures(experiment: Experiment) -> Iterable[Sequence[str]]:
    for number, site in enumerate(experiment.sites, 1):
        yield (str(number), *(f"{math.degrees(value):.2f}" for value in site.q))


def _precision(experiment: Experiment) -> Iterable[Sequence[str]]:
    for figure in experiment.precision:
        numbers = (figure.value, figure.before, figure.after)
        yield (f"`{figure.key}`", *(f"{number:.3g}" for number in numbers))


def _left_out(heading: str, left: Sequence[Skipped], most: int) -> Iterable[str]:
    if not left:
        return
    yield heading
    yield _table(("what", "why"), ((entry.what, entry.reason) for entry in left[:most]))
    if len(left) > most:
        yield f"and {len(left) - most} more."


def _table(heading: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [heading, ["---"] * len(heading), *rows]
    return "\n".join(
        "| " + " | ".join(cell.replace("|", "/") for cell in row) + " |" for row in lines
    )
