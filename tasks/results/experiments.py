"""Test motions that were designed, with their files and how they show themselves."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from ...core.cell.cell import Cell
from ...core.display import counted
from ...core.notebook import PictureCurve, page, picture, table
from ...identification.experiment.design import LOG_SUFFIX
from ...identification.experiment.page import described, way
from ...identification.experiment.page import page as make_page
from ...identification.experiment.picture import draw_experiment
from ...identification.experiment.plan import Experiment
from ...identification.experiment.purpose import QUESTIONS
from ...identification.experiment.record import purpose_data, record

PAGE, PLAN, RECORD, FOLDER = "experiment.html", "plan.json", ".json", "program"
"""The page is always written, the plan if runs are about open questions; the program lies in the
folder."""
COLUMNS = (
    ("", "right"),
    ("run", "left"),
    ("moves", "left"),
    ("TCP, mm/s", "right"),
    ("corners", "right"),
    ("turns, °", "left"),
    ("zones, mm", "left"),
    ("motion, s", "right"),
    ("way there", "left"),
    ("gain, nats", "right"),
)


@dataclass(frozen=True)
class DesignedExperiment:
    """Runs worth driving.

    Args:
        experiment: the runs with what each tells, and what was passed over.
        cell: that they were designed in.
        file: of the cell; None where no file says what stands around.
        inputs: the files that it was made from; they are not written over.
    """

    experiment: Experiment
    cell: Cell
    file: Path | None
    inputs: tuple[Path, ...]

    @cached_property
    def files(self) -> dict[str, bytes]:
        """The program of all runs, a record for each log to come, and a page."""
        made = self.experiment
        program = {f"{FOLDER}/{name}": text.encode() for name, text in made.sources.items()}
        found = dict(program)
        for number, run in enumerate(made.runs, 1):
            stem = run.stem(number)
            told = record(run, made.robot, stem + LOG_SUFFIX, made.period, program)
            found[stem + RECORD] = (json.dumps(told, indent=1) + "\n").encode()
        if made.plan.about:
            plan = {"robot": made.robot.name, "runs": list(self._purposes())}
            found[PLAN] = (json.dumps(plan, indent=1) + "\n").encode()
        cell = None if self.file is None else self.file.name
        found[PAGE] = make_page(made, cell, draw_experiment(self.cell, made)).encode()
        return found

    def _purposes(self) -> Iterator[dict[str, Any]]:
        """What each run is for, in SI units, in the order in which they are driven."""
        made, clock = self.experiment, 0.0
        for run in made.runs:
            clock += run.duration + made.plan.overhead
            yield {
                "run": run.candidate.name,
                "duration_s": run.duration,
                "over_at_s": clock,
                **purpose_data(run),
            }

    def topics(self) -> Iterator[str]:
        """A line for each open question that runs are about."""
        made = self.experiment
        for topic in made.plan.about:
            runs = [run for run in made.runs if run.topic is topic]
            if runs:
                seconds = sum(run.duration + made.plan.overhead for run in runs)
                yield (
                    f"{topic}: {counted(runs, 'run')}, {seconds / 60:.0f} min. "
                    f"{' '.join(QUESTIONS[topic].split())}"
                )

    @property
    def notes(self) -> tuple[str, ...]:
        """What the user should know."""
        return tuple(self.experiment.notes)

    def rows(self) -> list[tuple[str, ...]]:
        """A row for each run."""
        return [
            (
                str(number),
                run.candidate.name,
                *described(run),
                f"{run.duration:.1f}",
                way(run, number == 1),
                f"{run.gain:.2f}",
            )
            for number, run in enumerate(self.experiment.runs, 1)
        ]

    def __repr__(self) -> str:
        made = self.experiment
        return (
            f"<Experiment for {made.robot.name}: {counted(made.runs, 'run')}, "
            f"{made.seconds / 60:.0f} min at the robot>"
        )

    def _repr_html_(self) -> str:
        at = [run.run.trajectory.position for run in self.experiment.runs[:4]]
        names = [run.candidate.name for run in self.experiment.runs[:4]]
        curves = [PictureCurve(name, points) for name, points in zip(names, at, strict=True)]
        parts = [table(COLUMNS, self.rows()), *([picture(curves)] if curves else [])]
        return page(repr(self)[1:-1], *parts, notes=self.notes)
