"""``flyby compare``: how well the emulator predicts a log."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import InputError
from .console import print_json, print_rich, print_table, progress, warn
from .installed import registry
from .loading import Source, robot_of, start_of
from .options import (
    AnswersFile,
    AsJson,
    CellFile,
    Entry,
    Force,
    MotionFile,
    OtherFiles,
    RobotName,
    Start,
)
from .outputs import check_outputs, check_plot_name, write_all

if TYPE_CHECKING:
    from ..core.motion.model.motion_model import ArcTurn
    from ..core.program.target import JointTarget
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor
    from ..identification.logs import LoggedRun
    from ..identification.prediction import Prediction
    from ..identification.residuals import Figures
    from ..identification.time_scale import TimeScale

RECORD = ".json"
COLUMNS = (("", "left"), ("greatest", "right"), ("99 %", "right"), ("RMS", "right"))


def compare(
    program: Annotated[
        Path,
        typer.Argument(
            help="Program file in its vendor's language, or the record of a run (JSON)."
        ),
    ],
    log: Annotated[
        Path | None, typer.Argument(help="Log of a run; of a record it is the one that it names.")
    ] = None,
    robot: RobotName = None,
    cell: CellFile = None,
    motion: MotionFile = None,
    entry: Entry = None,
    io: AnswersFile = None,
    others: OtherFiles = None,
    start: Start = None,
    columns: Annotated[
        Path | None, typer.Option(help="Names the log's columns and their units (TOML).")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw corners, deviation and speed: PNG, PDF or SVG.")
    ] = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Hold a controller's log against the emulation of its program: in space and in time."""
    check_plot_name(plot)
    source = Source.of(program, entry, io, others, start)
    check_outputs(
        {"--plot": plot}, source.inputs(cell, log, columns, motion), replace_existing=force
    )
    with progress("reading program and log") as say:
        vendor, arm, run = _load(source, log, _Driven(robot, cell, motion), columns)
        stand = start_of(start, arm)
        say(f"emulating {len(run.program.moves)} moves")
        compared, scale = _compare(vendor, arm, run, stand)
        if plot is not None:
            _draw(compared, plot)
    for note in (*run.notes, *compared.log.notes[len(run.notes) :]):
        warn(f"{program if log is None else log}: {note}")
    _warn(compared, scale, vendor.motion_of(arm).arc_turn)
    _tell(compared, run, scale, as_json=json)
    if plot is not None and not json:
        print_rich(f"wrote {plot}")


@dataclass(frozen=True)
class _Driven:
    """The robot, as the options name it."""

    robot: str | None
    cell: Path | None
    motion: Path | None

    def find(self, of_record: str | None = None) -> tuple[Vendor, Robot]:
        name = of_record if self.robot is None and self.cell is None else self.robot
        return robot_of(name, self.cell, self.motion)


def _load(
    source: Source, log: Path | None, driven: _Driven, columns: Path | None
) -> tuple[Vendor, Robot, LoggedRun]:
    """The robot with its vendor, and the run."""
    from ..identification.logs import LoggedRun, load_columns, load_run, read_samples

    mapped = None if columns is None else load_columns(columns)
    if source.file.suffix.lower() == RECORD:
        if log is not None or mapped is not None:
            raise InputError(f"{source.file}: a record of a run names its log; give no other")
        run = load_run(source.file, registry().find_robot)
        vendor, arm = driven.find(run.robot)
        if arm.name != run.robot:
            raise InputError(f"{source.file}: the run is one of {run.robot}, not of {arm.name}")
        return vendor, arm, run
    if log is None:
        raise InputError(f"which log? Name it behind {source.file}")
    vendor, arm = driven.find()
    program = source.read(vendor, arm)
    samples = read_samples(log, arm, mapped)
    found = LoggedRun(log.stem, arm.name, None, program, samples.t, samples.q, samples.notes)
    return vendor, arm, found


def _compare(
    vendor: Vendor, robot: Robot, run: LoggedRun, start: JointTarget | None
) -> tuple[Prediction, TimeScale | None]:
    """The log beside its emulation, and what alone explains its times."""
    from ..core.motion.emulator.controller import Controller
    from ..identification.logs import clean
    from ..identification.prediction import predict
    from ..identification.time_scale import time_scale

    try:
        log = clean(run)
    except InputError as error:
        raise InputError(f"{run.name}: {error}") from error
    program = run.program if start is None else replace(run.program, start=start)
    controller = Controller(vendor, robot)
    found = predict(controller, run.name, program, log)
    scale = time_scale(controller, found) if run.timed else None
    return found, scale if scale is not None and scale.alone else None


def _warn(compared: Prediction, scale: TimeScale | None, turn: ArcTurn) -> None:
    if scale is not None:
        warn(f"{compared.name}: {scale.told}")
    if compared.turn is not None and compared.turn is not turn:
        warn(
            f'{compared.name}: along arcs the tool turns as arc.turn = "{compared.turn}" says, '
            f'not "{turn}" as the motion model does: so it was emulated. flyby identify writes it'
        )


def _draw(found: Prediction, plot: Path) -> None:
    from ..identification.report.picture import draw_prediction

    data = draw_prediction(found, plot.suffix.lower()[1:])
    write_all("--plot", {plot: data})


def _tell(compared: Prediction, run: LoggedRun, scale: TimeScale | None, *, as_json: bool) -> None:
    if as_json:
        print_json(_json(compared, run, scale))
        return
    f, log, aligned = compared.figures, compared.log, compared.alignment
    rows = _rows(f)
    if compared.read is not None:
        rows += [(f"{name}, as read", *told) for name, *told in _rows(compared.read)]
    print_rich(f"{run.name} on {compared.robot.name}: log less emulation")
    print_table(COLUMNS, rows)
    print_rich(
        f"cycle time {aligned.moving:.3f} s emulated, {aligned.logged_moving:.3f} s logged: "
        f"ratio {f.cycle_time_ratio:.4f}",
        f"the log's clock is {f.offset:+.4f} s off, and {1e3 * f.drift:+.1f} ms more at the end "
        "than at the start",
        f"{len(aligned.rows)} of {len(log.t)} samples compared, every {1e3 * log.period:.3g} ms "
        f"(jitter {1e3 * log.jitter:.2g} ms); {len(log.torn)} off the path, {len(log.held)} held, "
        f"{len(log.holes)} holes",
    )


def _rows(f: Figures) -> list[tuple[str, ...]]:
    import numpy as np

    return [
        (
            "path of the TCP, mm",
            f"{1e3 * f.path_max:.3f}",
            f"{1e3 * f.path_p99:.3f}",
            f"{1e3 * f.path_rms:.3f}",
        ),
        (
            "path of the joints, °",
            f"{np.degrees(f.joint_path_max):.4f}",
            f"{np.degrees(f.joint_path_p99):.4f}",
            f"{np.degrees(f.joint_path_rms):.4f}",
        ),
        (
            "joints at their time, °",
            f"{np.degrees(f.joint_time_max):.4f}",
            f"{np.degrees(f.joint_time_p99):.4f}",
            f"{np.degrees(f.joint_time_rms):.4f}",
        ),
        (
            "the same, less drift, °",
            f"{np.degrees(f.joint_clock_max):.4f}",
            f"{np.degrees(f.joint_clock_p99):.4f}",
            f"{np.degrees(f.joint_clock_rms):.4f}",
        ),
    ]


def _json(compared: Prediction, run: LoggedRun, scale: TimeScale | None) -> dict[str, Any]:
    """SI units, in the keys."""
    import numpy as np

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
