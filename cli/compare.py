"""``flyby compare``: how well the emulator predicts a log."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..tasks.compare import CompareOptions, compare_with
from ..tasks.files.outputs import check_outputs, picture_kind, write_all
from ..tasks.pages.file import check_page, write_page
from .output.console import print_json, print_rich, print_table, progress, warn
from .parameters import AsJson, Force, PageFile, with_options

if TYPE_CHECKING:
    from ..identification.residuals import Figures
    from ..tasks.results.comparison import Comparison


@with_options
def compare(
    program: Annotated[
        Path,
        typer.Argument(
            help="Program file in its vendor's language, or the record of a run (JSON)."
        ),
    ],
    options: CompareOptions,
    log: Annotated[
        Path | None, typer.Argument(help="Log of a run; of a record it is the one that it names.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw corners, deviation and speed: PNG, PDF or SVG.")
    ] = None,
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Hold a controller's log against the emulation of its program: in space and in time."""
    options = replace(options, log=log)
    if plot is not None:
        picture_kind(plot, "--plot")
    check_outputs({"--plot": plot}, [program, *options.inputs()], replace_existing=force)
    check_page(report, [program, *options.inputs()], force)
    with progress("reading program and log") as say:
        found = compare_with(program, replace(options, report=say))
        if plot is not None:
            write_all("--plot", {plot: found.picture(picture_kind(plot, "--plot"))})
        if report is not None:
            say("making the page")
        paged = write_page(report, found)
    for note in found.notes:
        warn(note)
    if json:
        print_json(_json(found))
        return
    _tell(found)
    for path in (*([] if plot is None else [plot]), *paged):
        print_rich(f"wrote {path}")


def _tell(found: Comparison) -> None:
    from ..tasks.results.comparison import COLUMNS

    compared, f = found.prediction, found.figures
    log, aligned = compared.log, compared.alignment
    print_rich(f"{found.run.name} on {compared.robot.name}: log less emulation")
    print_table(COLUMNS, found.rows())
    print_rich(
        found.times_said,
        f"laid on the emulation, the log begins at {f.offset:+.4f} s, and is "
        f"{1e3 * abs(f.drift):.1f} ms {'behind' if f.drift > 0 else 'ahead'} at its end",
        f"{len(aligned.rows)} of {len(log.t)} samples compared, every {1e3 * log.period:.3g} ms "
        f"(jitter {1e3 * log.jitter:.2g} ms); {len(log.torn)} off the path, {len(log.held)} held, "
        f"{counted(log.holes, 'hole')}",
    )


def _json(found: Comparison) -> dict[str, Any]:
    """SI units, in the keys."""
    import numpy as np

    compared, run, scale = found.prediction, found.run, found.scale
    log, aligned = compared.log, compared.alignment
    place = np.abs(compared.residuals.joint_path).max(axis=0)
    moment = np.abs(compared.residuals.joint_time).max(axis=0)
    return {
        "run": run.name,
        "robot": compared.robot.name,
        **_figures(compared.figures),
        "cycle_time_s": aligned.moving,
        "logged_cycle_time_s": aligned.logged_moving,
        "axes": [
            {"name": name, "path_max": float(a), "time_max": float(b)}
            for name, a, b in zip(compared.robot.axis_names, place, moment, strict=True)
        ],
        "timed": run.timed,
        "moves": [
            {
                "move": one.move + 1,
                "emulated_s": one.emulated,
                "logged_s": one.logged,
                "path_max_m": one.off,
            }
            for one in found.moves
        ],
        "samples": len(log.t),
        "compared": len(aligned.rows),
        "torn": len(log.torn),
        "held": len(log.held),
        "holes": [{"begin_s": hole.begin, "end_s": hole.end} for hole in log.holes],
        "period_s": log.period,
        "jitter_s": log.jitter,
        "notes": list(log.notes),
        "arc_turn": compared.turn,
        "time_scale": None if scale is None else {"cause": scale.cause, "value": scale.value},
        "as_read": None if compared.read is None else _figures(compared.read),
    }


def _figures(f: Figures) -> dict[str, float]:
    return {
        "path_max_m": f.path_max,
        "path_p99_m": f.path_p99,
        "path_rms_m": f.path_rms,
        "joint_path_max_rad": f.joint_path_max,
        "joint_path_p99_rad": f.joint_path_p99,
        "joint_path_rms_rad": f.joint_path_rms,
        "joint_time_max_rad": f.joint_time_max,
        "joint_time_p99_rad": f.joint_time_p99,
        "joint_time_rms_rad": f.joint_time_rms,
        "joint_clock_max_rad": f.joint_clock_max,
        "joint_clock_p99_rad": f.joint_clock_p99,
        "joint_clock_rms_rad": f.joint_clock_rms,
        "offset_s": f.offset,
        "drift_s": f.drift,
        "cycle_time_ratio": f.cycle_time_ratio,
    }
