"""A motion model fitted to logged runs."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.display import counted
from ..core.door import spelt
from ..core.errors import InputError, OptionError
from .catalogue import registry
from .options.entries import COUNT, Extent, number, value
from .options.keywords import by_keywords
from .setup import RobotOptions, setup_of

if TYPE_CHECKING:
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor
    from ..identification.fit import Fit, HeldFit, Outcome, PreparedRun
    from ..identification.fit.selection import Score
    from ..identification.logs import LoggedRun
    from .results.identified import IdentifiedModel


@dataclass(frozen=True, kw_only=True)
class IdentifyOptions(RobotOptions):
    """What is fitted to which logs."""

    parameters: Sequence[str] = value(
        (),
        "A figure to fit, as the motion file calls it, maybe with its start: "
        "'blend.tcp.beta[0] = 0', 'time.smoothing_s[*]'. May be given several times; without it, "
        "what the vendor's figures were fitted by, or the servos of a real robot.",
        several=True,
    )
    columns: str | Path | None = value(
        None, "Names the logs' columns and their units (TOML).", kind=Path
    )
    select: str | None = value(
        None,
        "Also list which figures earn their place, by leaving out runs of the same zone, speed, "
        "moves, posture, or each run.",
    )
    workers: int = number(os.cpu_count() or 1, "Processes.", COUNT, Extent(1))
    found: Callable[[tuple[Path, ...]], object] | None = field(
        default=None, repr=False, compare=False
    )
    """Called with the files of all runs before they are fitted; it may refuse."""


def identify_with(
    logs: str | Path | Sequence[str | Path], options: IdentifyOptions
) -> IdentifiedModel:
    """Fit how a controller drives to logs of what it drove.

    Args:
        logs: records of runs (JSON), programs with a log of the same name beside them, or folders
            of these. Records say whose runs they are where no robot is named.

    Returns:
        The figures with their confidence intervals, how well each run is predicted before and
        after, how runs that were held back are, and the motion file.

    Raises:
        InputError: no run of the robot is found, or one cannot be read or fitted.
    """
    from ..identification.fit import outcomes
    from ..identification.fit.parameters import check_text
    from ..identification.logs import load_columns
    from .files.logged_runs import find_runs, robot_of_records
    from .results.identified import IdentifiedModel

    for text in options.parameters:
        try:
            check_text(text)
        except InputError as error:
            raise OptionError(f"{spelt('parameters')}: {error}") from error
    paths = [Path(log) for log in ([logs] if isinstance(logs, str | Path) else logs)]
    if options.robot is None and options.cell is None:
        options = replace(options, robot=robot_of_records(paths))
    setup = setup_of(options)
    owner, arm = setup.vendor, setup.robot
    columns = None if options.columns is None else load_columns(Path(options.columns))
    options.say("reading logs")
    found = find_runs(paths, owner, arm, columns)
    if options.found is not None:
        options.found(found.files)
    prepared = _prepare(found.runs, owner, arm, options)
    held = _fit(owner, arm, prepared, options)
    fitted = held.fit
    options.say("emulating all runs before and after")
    each = outcomes(fitted)
    scores = [] if options.select is None else _select(fitted, options.select, options)
    text = _motion_file(fitted, each, _command(paths, arm, options), paths, owner)
    inputs = (*found.files, *options.inputs())
    return IdentifiedModel(fitted, tuple(each), held.judgement, tuple(scores), text, found, inputs)


identify = by_keywords(identify_with, IdentifyOptions)


def _prepare(
    runs: tuple[LoggedRun, ...], vendor: Vendor, robot: Robot, options: IdentifyOptions
) -> list[PreparedRun]:
    from ..identification.fit import prepare

    made = []
    for run in runs:
        options.say(f"laying {run.name} on its emulation")
        made.append(prepare(run, vendor, robot, vendor.motion_of(robot)))
    return made


def _fit(
    vendor: Vendor, robot: Robot, runs: list[PreparedRun], options: IdentifyOptions
) -> HeldFit:
    from ..core.sqp import Iteration
    from ..identification.fit import ParameterSet, fit_held, fit_usual

    def watch(iteration: Iteration) -> None:
        options.say(
            f"fitting {what} to {counted(runs, 'run')}: iteration {iteration.number}, loss "
            f"{iteration.objective:.4g}"
        )

    def tell(text: str) -> None:
        options.say(f"fitting with runs held back: {text}")

    model, what = vendor.motion_of(robot), "figures"
    if not options.parameters:
        return fit_usual(model, robot, runs, options.workers, watch, tell)
    chosen = ParameterSet.named(model, list(options.parameters))
    what = counted(chosen.size, "parameter")
    return fit_held(chosen, runs, options.workers, watch, tell)


def _select(fitted: Fit, trait: str, options: IdentifyOptions) -> list[Score]:
    from ..identification.fit.selection import candidates, compare_models, grouped

    parameters = fitted.parameters.starting_at(fitted.values)
    groups = grouped(fitted.runs, trait)
    return compare_models(
        fitted.runs,
        fitted.nuisances,
        candidates(parameters),
        groups,
        options.workers,
        options.say,
    )


def _command(logs: Sequence[Path], robot: Robot, options: IdentifyOptions) -> str:
    """The command that makes the same file, files by their names alone."""
    words = ["flyby", "identify", *(path.name for path in logs), "--robot", robot.name]
    files = {"--cell": options.cell, "--motion": options.motion, "--columns": options.columns}
    for option, file in files.items():
        words += [option, Path(file).name] if isinstance(file, str | Path) else []
    for text in options.parameters:
        words += ["--fit", text]
    return shlex.join(words)


def _motion_file(
    fitted: Fit, each: Sequence[Outcome], command: str, logs: Sequence[Path], vendor: Vendor
) -> str:
    """To be laid on what the vendor states, whatever the fit began with."""
    from ..core.motion.emulator.move_figures import range_of
    from ..core.motion.model.taught_range import merged
    from ..identification.fit import motion_file

    robot = fitted.runs[0].robot
    heading = f"How {robot.name} is driven, fitted to {counted(fitted.runs, 'logged run')}."
    stated = registry().find_vendor(vendor.name).motion_of(robot)
    taught = merged(range_of(one.after.driven) for one in each)
    return motion_file(fitted, command, heading, stated, logs[0].resolve().stem, taught)
