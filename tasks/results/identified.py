"""A motion model that was fitted, with how sure it is and what it is worth."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.display import counted
from ...core.notebook import PictureCurve, page, picture, table
from ...identification.fit import Fit, Judgement, Outcome
from ...identification.fit.selection import Score
from ..files.logged_runs import LoggedRuns
from .unseen_figures import unseen_said

RUN_COLUMNS = (
    ("run", "left"),
    ("path max, mm", "right"),
    ("99 %", "right"),
    ("joints' path, °", "right"),
    ("at their time 99 %, °", "right"),
    ("cycle time ratio", "right"),
    ("drift, ms", "right"),
)
PARAMETER_COLUMNS = (
    ("parameter", "left"),
    ("start", "right"),
    ("fitted", "right"),
    ("95 %", "left"),
)


@dataclass(frozen=True)
class IdentifiedModel:
    """What came of a fit.

    Args:
        fit: figures with their confidence intervals.
        outcomes: each run, as it was predicted before and as it is after.
        judgement: how runs are predicted that were held back; None where there is nothing to hold
            back.
        scores: which figures earn their place, if that was asked for.
        text: the motion file.
        found: the runs, and where they lie.
        inputs: the files that it was made from; they are not written over.
    """

    fit: Fit
    outcomes: tuple[Outcome, ...]
    judgement: Judgement | None
    scores: tuple[Score, ...]
    text: str
    found: LoggedRuns
    inputs: tuple[Path, ...]

    @property
    def better(self) -> bool:
        """Whether nothing says that the model the fit began with predicts better."""
        return self.judgement is None or self.judgement.better

    @property
    def files(self) -> dict[str, bytes]:
        """The motion file and the page."""
        from ..pages.of_results import page_bytes

        return {"motion.toml": self.text.encode(), "report.html": page_bytes(self)}

    @property
    def notes(self) -> tuple[str, ...]:
        """What the user should know."""
        told: list[str] = []
        for run in self.fit.runs:
            for note in run.log.notes:
                told.append(f"{run.name}: {note}")
            if run.by_place:
                told.append(
                    f"{run.name}: its speeds were not recorded; it is compared by place, "
                    "not by time"
                )
            if not run.run.zones_known:
                told.append(
                    f"{run.name}: its zones were not recorded; one factor on them is fitted"
                )
        for names, what in self.fit.scales:
            told.append(f"{names}: {what}. Figures are fitted beside it")
        others = [
            run.name
            for run in self.fit.runs
            if run.turn is not None and run.turn is not self.fit.turn
        ]
        if others and self.fit.turn is not None:
            told.append(
                f"the tool turns along arcs otherwise in {', '.join(others)} than in the other "
                f'logs (arc.turn = "{self.fit.turn}"): no one model drives both; fit them apart'
            )
        for one in self.fit.rough:
            told.append(f"{one.name} is known roughly ({one.reason}), but the logs ask for it")
        for one in self.fit.unseen:
            told.append(unseen_said(one, self.fit.runs[0].robot.axis_names))
        if not self.fit.converged:
            told.append(
                "the fit was ended before it could go no further; treat its figures with care"
            )
        return tuple(told)

    def parameter_rows(self) -> list[tuple[str, ...]]:
        """Each figure: where it began, what was found, and its 95 % interval."""
        parameters = self.fit.parameters
        starts = dict(zip((p.name for p in parameters.parameters), parameters.start, strict=True))
        return [
            (
                one.name,
                f"{starts[one.name]:.5g}",
                f"{one.value:.5g}",
                f"{one.lower:.4g} … {one.upper:.4g}",
            )
            for one in self.fit.intervals
        ]

    def run_rows(self) -> list[tuple[str, ...]]:
        """Each run: log less emulation, before and after."""
        return [_row(one) for one in self.outcomes]

    def __repr__(self) -> str:
        robot = self.fit.runs[0].robot.name
        told = f"{counted(self.outcomes, 'run')}: {counted(self.fit.intervals, 'figure')}"
        loss = f"loss {self.fit.before:.4g} → {self.fit.after:.4g}"
        return f"<Motion model of {robot} fitted to {told}, {loss}>"

    def _repr_html_(self) -> str:
        shown = [(one.before.figures.path_max, one.after.figures.path_max) for one in self.outcomes]
        k = np.arange(float(len(shown)))
        both = 1e3 * np.array(shown)
        drawn = [
            PictureCurve(name, np.stack([k, both[:, j]], 1), np.stack([k, both[:, j]], 1))
            for j, name in enumerate(("path, mm, before", "after, run by run"))
        ]
        return page(
            repr(self)[1:-1],
            table(PARAMETER_COLUMNS, self.parameter_rows()),
            table(RUN_COLUMNS, self.run_rows()),
            picture(drawn, "runs × mm"),
            notes=self.notes,
        )


def _row(one: Outcome) -> tuple[str, ...]:
    b, a = one.before.figures, one.after.figures

    def both(before: float, after: float, form: str) -> str:
        return f"{before:{form}} → {after:{form}}"

    return (
        one.run.name,
        both(1e3 * b.path_max, 1e3 * a.path_max, ".3f"),
        both(1e3 * b.path_p99, 1e3 * a.path_p99, ".3f"),
        both(np.degrees(b.joint_path_max), np.degrees(a.joint_path_max), ".3f"),
        both(np.degrees(b.joint_time_p99), np.degrees(a.joint_time_p99), ".3f"),
        both(b.cycle_time_ratio, a.cycle_time_ratio, ".4f"),
        both(1e3 * b.drift, 1e3 * a.drift, ".1f"),
    )
