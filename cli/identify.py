"""``flyby identify``: fit a motion model to logged runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..core.errors import InputError
from ..tasks.files.outputs import check_outputs, page_name, write_all
from ..tasks.identify import IdentifyOptions, identify_with
from ..tasks.pages.of_results import page_bytes
from .output.console import print_json, print_rich, print_table, progress, warn
from .parameters import AsJson, Force, PageFile, with_options

if TYPE_CHECKING:
    from ..identification.fit import Fit, Judgement, Outcome
    from ..identification.fit.selection import Score
    from ..tasks.results.identified import IdentifiedModel

SCORE_COLUMNS = (
    ("fitted", "left"),
    ("parameters", "right"),
    ("loss, fitted to", "right"),
    ("loss, left out", "right"),
    ("worse than all by", "right"),
)


@with_options
def identify(
    logs: Annotated[
        list[Path],
        typer.Argument(
            help="Records of runs (JSON), programs with a log of the same name beside them, or "
            "folders of these."
        ),
    ],
    options: IdentifyOptions,
    out: Annotated[
        Path | None, typer.Option("--out", help="Write the motion file (TOML), for --motion.")
    ] = None,
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Fit how a controller drives to logs of what it drove."""
    if report is not None:
        page_name(report, "--report")
    outputs = {"--out": out, "--report": report}
    check_outputs(outputs, options.inputs(), replace_existing=force)

    def checked(files: tuple[Path, ...]) -> None:
        check_outputs(outputs, files, replace_existing=force)

    with progress("reading logs") as say:
        made = identify_with(logs, replace(options, report=say, found=checked))
    judged = made.judgement
    kept = not made.better and not force
    files = {} if out is None or kept else {out: made.text.encode()}
    if report is not None:
        files[report] = page_bytes(made)
    write_all("--out and --report", files)
    if json:
        print_json(_json(made.fit, list(made.outcomes), judged, list(made.scores)))
    else:
        if made.found.others:
            warn(
                f"{counted(made.found.others, 'run')} of other robots in these folders passed over"
            )
        for note in made.notes:
            warn(note)
        _tell(made)
        _tell_judged(judged)
        for path in files:
            print_rich(f"wrote {path}")
    if kept and out is not None and judged is not None:
        raise InputError(
            f"--out {out}: not written, as what was fitted {judged.verdict} the model that the fit "
            f"began with, which stays: {judged.told}. {_help_of(judged)}; --force writes it"
        )


def _tell(made: IdentifiedModel) -> None:
    from ..tasks.results.identified import PARAMETER_COLUMNS, RUN_COLUMNS

    fitted, each, scores = made.fit, made.outcomes, made.scores
    print_table(
        PARAMETER_COLUMNS,
        made.parameter_rows(),
        f"fitted to {counted(each, 'run')}: loss {fitted.before:.4g} → {fitted.after:.4g}",
    )
    print_table(RUN_COLUMNS, made.run_rows(), "log less emulation, before → after")
    clocks = {
        one.run.clock: one.nuisance.clock
        for one in each
        if one.run.clock is not None and one.run.own_clock is None
    }
    for name, clock in clocks.items():
        print_rich(f"the clock of {name}: {clock:.5f} s pass while its logs count one")
    for one in each:
        if not one.run.run.zones_known:
            print_rich(f"{one.run.name}: zones {one.nuisance.size:.4g} times what the record says")
    if scores:
        print_table(
            SCORE_COLUMNS,
            [
                (
                    score.name,
                    str(score.count),
                    f"{score.fitted:.4g}",
                    f"{score.mean:.4g}",
                    f"{-score.gain:+.2g} ± {score.error:.1g}",
                )
                for score in scores
            ],
            "what is lost if a figure is not fitted",
        )


def _tell_judged(judged: Judgement | None) -> None:
    if judged is None:
        warn("there is nothing to hold back that would judge the fit: log more than one move")
        return
    print_rich(judged.told)
    if judged.worse:
        worse = ", ".join(judged.worse)
        helped = "" if judged.by_corners else f". {_help_of(judged)}"
        warn(f"predicted worse than before the fit when held back: {worse}{helped}")
    if judged.by_corners:
        warn(f"corners of the same runs judged the fit. {_help_of(judged)}")


def _help_of(judged: Judgement) -> str:
    return f"These would help: {'; '.join(judged.helpful)} (flyby experiment designs them)"


def _json(
    fitted: Fit, each: list[Outcome], judged: Judgement | None, scores: list[Score]
) -> dict[str, Any]:
    """SI units, in the keys."""
    from dataclasses import asdict

    return {
        "parameters": [asdict(one) for one in fitted.intervals],
        "not_identifiable": [asdict(one) for one in fitted.unseen],
        "known_roughly": [asdict(one) for one in fitted.rough],
        "arc_turn": fitted.turn,
        "time_scales": [{"runs": names, "says": says} for names, says in fitted.scales],
        "held_back": None if judged is None else {**asdict(judged), "better": judged.better},
        "loss_before": fitted.before,
        "loss_after": fitted.after,
        "iterations": fitted.iterations,
        "converged": fitted.converged,
        "runs": [
            {
                "name": one.run.name,
                "by_place": one.run.by_place,
                "offset_s": one.nuisance.offset,
                "clock": one.nuisance.clock,
                "zone_size": one.nuisance.size,
                "override": one.nuisance.override,
                "before": asdict(one.before.figures),
                "after": asdict(one.after.figures),
                "notes": list(one.run.log.notes),
            }
            for one in each
        ],
        "selection": [{**asdict(score), "left_out": score.mean} for score in scores],
    }
