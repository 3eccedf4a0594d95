"""``flyby identify``: fit a motion model to logged runs."""

from __future__ import annotations

import os
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import InputError
from .console import print_json, print_rich, print_table, progress, warn
from .installed import registry
from .loading import robot_of
from .logged_runs import find_runs
from .options import AsJson, CellFile, Force, MotionFile, RobotName
from .outputs import check_outputs, write_all

if TYPE_CHECKING:
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor
    from ..identification.fit import Fit, Judgement, Outcome, ParameterSet, PreparedRun
    from ..identification.fit.selection import Score
    from ..identification.logs import LoggedRun

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
SCORE_COLUMNS = (
    ("fitted", "left"),
    ("parameters", "right"),
    ("loss, fitted to", "right"),
    ("loss, left out", "right"),
    ("worse than all by", "right"),
)


def identify(
    logs: Annotated[
        list[Path],
        typer.Argument(
            help="Records of runs (JSON), programs with a log of the same name beside them, or "
            "folders of these."
        ),
    ],
    robot: RobotName = None,
    cell: CellFile = None,
    motion: MotionFile = None,
    vendor: Annotated[
        str | None, typer.Option("--vendor", help="Whose controller drove; the robot's by itself.")
    ] = None,
    parameters: Annotated[
        list[str] | None,
        typer.Option(
            "--fit",
            help="A figure to fit, as the motion file calls it, maybe with its start: "
            "'blend.tcp.beta[0] = 0', 'time.smoothing_s[*]'. May be given several times; without "
            "it, what the vendor's figures were fitted by.",
        ),
    ] = None,
    columns: Annotated[
        Path | None, typer.Option(help="Names the logs' columns and their units (TOML).")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", help="Write the motion file (TOML), for --motion.")
    ] = None,
    report: Annotated[
        Path | None,
        typer.Option("--report", help="Write a page of all runs, before and after (HTML)."),
    ] = None,
    select: Annotated[
        str | None,
        typer.Option(
            "--select",
            help="Also tell which figures earn their place, by leaving out runs of the same zone, "
            "speed, moves, posture, or each run.",
        ),
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes.", min=1)] = os.cpu_count() or 1,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Fit how a controller drives to logs of what it drove."""
    outputs = {"--out": out, "--report": report}
    check_outputs(outputs, [*_files(cell, motion, columns)], replace_existing=force)
    owner, arm = robot_of(robot, cell, motion)
    if vendor is not None and vendor != owner.name:
        raise InputError(f"--vendor {vendor}: {arm.name} is driven by {owner.name}")
    with progress("reading logs") as say:
        found = find_runs(logs, owner, arm, _columns(columns))
        check_outputs(outputs, found.files, replace_existing=force)
        prepared = _prepare(found.runs, owner, arm, say)
        chosen = _parameters(owner, arm, parameters)
        say(f"fitting {chosen.size} parameters to {len(prepared)} runs")
        fitted = _fit(chosen, prepared, workers, say)
        say("emulating all runs before and after")
        from ..identification.fit import outcomes

        each = outcomes(fitted)
        judged = _judge(fitted, workers, say)
        scores = [] if select is None else _select(fitted, select, workers, say)
    command = _command(
        logs, arm, parameters, {"--cell": cell, "--motion": motion, "--columns": columns}
    )
    text = _motion_file(fitted, command, logs, owner)
    kept = judged is not None and not judged.better and not force
    files = {} if out is None or kept else {out: text.encode()}
    if report is not None:
        files[report] = _page(fitted, each, text, judged).encode()
    write_all("--out and --report", files)
    if json:
        print_json(_json(fitted, each, judged, scores))
    else:
        if found.others:
            warn(f"{found.others} runs of other robots in these folders are passed over")
        _warn(fitted)
        _tell(fitted, each, scores)
        _tell_judged(judged)
        for made in files:
            print_rich(f"wrote {made}")
    if kept and out is not None and judged is not None:
        raise InputError(
            f"--out {out}: not written, as what was fitted predicts worse than the model that the "
            f"fit began with: {judged.told}. {_help_of(judged)}; --force writes it"
        )


def _files(*files: Path | None) -> list[Path]:
    return [file for file in files if file is not None]


def _columns(file: Path | None) -> Any:
    from ..identification.logs import load_columns

    return None if file is None else load_columns(file)


def _prepare(
    runs: tuple[LoggedRun, ...], vendor: Vendor, robot: Robot, say: Any
) -> list[PreparedRun]:
    from ..identification.fit import prepare

    made = []
    for run in runs:
        say(f"laying {run.name} on its emulation")
        made.append(prepare(run, vendor, robot, vendor.motion_of(robot)))
    return made


def _parameters(vendor: Vendor, robot: Robot, texts: list[str] | None) -> ParameterSet:
    from ..identification.fit import ParameterSet, usual_parameters

    model = vendor.motion_of(robot)
    return ParameterSet.named(model, texts or usual_parameters(model, robot))


def _fit(parameters: ParameterSet, runs: list[PreparedRun], workers: int, say: Any) -> Fit:
    from ..core.sqp import Iteration
    from ..identification.fit import fit

    def watch(iteration: Iteration) -> None:
        say(
            f"fitting {parameters.size} parameters to {len(runs)} runs: iteration "
            f"{iteration.number}, loss {iteration.objective:.4g}"
        )

    return fit(parameters, runs, workers, watch)


def _select(fitted: Fit, trait: str, workers: int, say: Any) -> list[Score]:
    from ..identification.fit.selection import candidates, compare_models, grouped

    parameters = fitted.parameters.starting_at(fitted.values)
    groups = grouped(fitted.runs, trait)
    return compare_models(
        fitted.runs, fitted.nuisances, candidates(parameters), groups, workers, say
    )


def _judge(fitted: Fit, workers: int, say: Any) -> Judgement | None:
    from ..identification.fit import judge

    say("fitting with runs held back")
    return judge(fitted, workers, lambda text: say(f"fitting with runs held back: {text}"))


def _command(
    logs: list[Path], robot: Robot, parameters: list[str] | None, files: dict[str, Path | None]
) -> str:
    """The command that makes the same file, files by their names alone."""
    words = ["flyby", "identify", *(path.name for path in logs), "--robot", robot.name]
    for option, file in files.items():
        words += [] if file is None else [option, file.name]
    for text in parameters or ():
        words += ["--fit", text]
    return shlex.join(words)


def _motion_file(fitted: Fit, command: str, logs: list[Path], vendor: Vendor) -> str:
    """To be laid on what the vendor states, whatever the fit began with."""
    from ..identification.fit import motion_file

    robot = fitted.runs[0].robot
    heading = f"How {robot.name} is driven, fitted to {len(fitted.runs)} logged runs."
    stated = registry().find_vendor(vendor.name).motion_of(robot)
    return motion_file(fitted, command, heading, stated, logs[0].resolve().stem)


def _page(fitted: Fit, each: list[Outcome], text: str, judged: Judgement | None) -> str:
    from ..identification.report.page import page

    return page(fitted, each, text, judged)


def _warn(fitted: Fit) -> None:
    for run in fitted.runs:
        for note in run.log.notes:
            warn(f"{run.name}: {note}")
        if run.by_place:
            warn(f"{run.name}: its speeds were not recorded; it is compared by place, not by time")
        if not run.run.zones_known:
            warn(f"{run.name}: its zones were not recorded; one factor on them is fitted")
    for names, what in fitted.scales:
        warn(f"{names}: {what}. Figures are fitted beside it")
    others = [
        run.name for run in fitted.runs if run.turn is not None and run.turn is not fitted.turn
    ]
    if others and fitted.turn is not None:
        warn(
            f"the tool turns along arcs otherwise in {', '.join(others)} than in the other logs "
            f'(arc.turn = "{fitted.turn}"): no one model drives both; fit them apart'
        )
    for one in fitted.rough:
        warn(f"{one.name} is known roughly ({one.reason}), but the logs ask for it")
    for one in fitted.unseen:
        warn(f"{one.name} is not identifiable: {one.reason}; it stays as it was")
    if not fitted.converged:
        warn("the fit was ended before it could go no further; treat its figures with care")


def _tell(fitted: Fit, each: list[Outcome], scores: list[Score]) -> None:
    starts = dict(
        zip((p.name for p in fitted.parameters.parameters), fitted.parameters.start, strict=True)
    )
    print_table(
        PARAMETER_COLUMNS,
        [
            (
                one.name,
                f"{starts[one.name]:.5g}",
                f"{one.value:.5g}",
                f"{one.lower:.4g} … {one.upper:.4g}",
            )
            for one in fitted.intervals
        ],
        f"fitted to {len(each)} runs: loss {fitted.before:.4g} → {fitted.after:.4g}",
    )
    print_table(RUN_COLUMNS, [_row(one) for one in each], "log less emulation, before → after")
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


def _row(one: Outcome) -> tuple[str, ...]:
    import numpy as np

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
