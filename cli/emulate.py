"""``flyby emulate``: drive a program and report its motion; ``flyby ask``: what it asks for."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..core.errors import EntryError, FaultCause, FlybyError, InputError, OptionError
from ..core.program.entry_point import ALL, others_drive
from ..core.source.write.options import OpaqueStyle
from ..tasks.ask import ask_with, next_command
from ..tasks.catalogue import registry
from ..tasks.emulate import EmulateOptions, emulate_with
from ..tasks.files.outputs import (
    check_folder,
    check_outputs,
    page_name,
    picture_kind,
    write_all,
)
from ..tasks.options.guessed_robot import with_robot
from ..tasks.pages.of_results import page_bytes
from ..tasks.read import SourceOptions, read_with
from .output.console import fail, print_json, print_rich, progress, warn, warn_of
from .parameters import AsJson, Force, PageFile, ProgramFile, with_options

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..tasks.results.runs import Run

_CHOOSE = re.compile(r"(?:; or|:) choose as the entry")
"""In what is said of a program that drives nothing where it begins, before the routines that do."""


@dataclass(frozen=True)
class _Files:
    """Where results go, by option."""

    csv: Path | None
    npz: Path | None
    plot: Path | None
    report: Path | None
    write: Path | None
    export: Path | None

    def by_option(self) -> dict[str, Path | None]:
        """The paths by the options that named them."""
        return {f"--{name}": getattr(self, name) for name in self.__dataclass_fields__}


@with_options
def emulate(
    program: ProgramFile,
    source: SourceOptions,
    options: EmulateOptions,
    csv: Annotated[Path | None, typer.Option(help="Write the trajectory as CSV.")] = None,
    npz: Annotated[Path | None, typer.Option(help="Write the trajectory as NumPy arrays.")] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw path and motion: PNG, PDF or SVG.")
    ] = None,
    report: PageFile = None,
    write: Annotated[
        Path | None,
        typer.Option(
            help="Write the program anew, all moves in one routine, as it was driven: a file, "
            "beside which further ones are put if the language takes several, or a folder."
        ),
    ] = None,
    export: Annotated[
        Path | None,
        typer.Option(
            help="Write the motion for other software, by the plugin whose files end so "
            "(flyby vendors lists them)."
        ),
    ] = None,
    opaque: Annotated[
        OpaqueStyle | None,
        typer.Option(
            help="With --write: statements that do not move the robot are kept as they stand, or "
            "become comments; by default those do that cannot stand in the new program."
        ),
    ] = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Drive a program as the robot's controller would: cycle time, path, what limits each move.

    Moves that cannot be driven are faults; the robot goes on behind them, and the exit status is 1.
    """
    files = _Files(csv, npz, plot, report, write, export)
    if export is not None:
        registry().exporter_of(export)
    if opaque is not None and write is None:
        raise OptionError(f"--opaque {opaque} is of the program that --write writes: name its file")
    if plot is not None:
        picture_kind(plot, "--plot")
    if report is not None:
        page_name(report, "--report")
    outputs = files.by_option()
    if write is not None and write.is_dir():
        check_folder("--write", outputs.pop("--write"))
    inputs = [program, *source.inputs()]
    check_outputs(outputs, inputs, replace_existing=force)
    given = [option for option, path in outputs.items() if path is not None]
    with progress("looking for the robot"):
        source, notes = with_robot(program, source, gives_way=True)
    if source.entry == ALL:
        if given:
            raise OptionError(f"{given[0]} is of one program: name one entry, not all")
        warn_of(notes)
        _each(program, source, options, as_json=json)
        return
    with progress("reading the program") as say:
        read = _begun(program, source, each=not given)
        if not isinstance(read, _Nowhere):
            read = replace(read, notes=(*notes, *read.notes))
            run = _driven(read, replace(options, report=say))
            say("writing results")
    if isinstance(read, _Nowhere):
        warn_of(notes)
        _each(program, source, options, as_json=json, nowhere=read)
        return
    with progress("writing results"):
        made = _write_files(files, run, inputs, opaque, force)
    if json:
        print_json(_json(run))
    else:
        _tell(run)
        for path in made:
            print_rich(f"wrote {path}")
    if run.faults:
        raise typer.Exit(1)


@dataclass(frozen=True)
class _Nowhere:
    """A program that drives nothing where it begins.

    Args:
        why: it does not.
        others: the routines that may be driven instead; none for all.
    """

    why: str
    others: tuple[str, ...] = ()


def _begun(program: Path, source: SourceOptions, *, each: bool) -> Program | _Nowhere:
    """The program, read; or why it begins nowhere in particular.

    Args:
        each: whether each of its routines may be driven instead.
    """
    if not each or source.entry is not None:
        return read_with(program, source)
    try:
        read = read_with(program, source)
    except EntryError as error:
        return _Nowhere(_CHOOSE.split(str(error))[0])
    if read.moves or any(question.answered for question in read.questions):
        return read
    if others_drive(read.entries):
        return _Nowhere(f"{program}: {read.name} drives nothing as it begins")
    from ..core.motion.path.no_move import no_move, not_met  # late: programs take time

    others = [entry.name for entry in not_met(read) if entry.moves]
    return _Nowhere(_CHOOSE.split(str(no_move(read)))[0], tuple(others)) if others else read


def _driven(read: Program, options: EmulateOptions) -> Run:
    """A program, driven; where it cannot be, what was said of it on the way is said first."""
    try:
        return emulate_with(read, options)
    except FlybyError:
        from .output.report_text import print_questions

        warn_of(note for note in read.notes if not (note.asked and read.questions))
        print_questions(read.questions)
        raise


def _each(
    program: Path,
    source: SourceOptions,
    options: EmulateOptions,
    *,
    as_json: bool,
    nowhere: _Nowhere | None = None,
) -> None:
    """Drive every routine that a program may begin with, and report each.

    What those move to that take arguments may hang on these alone: that is no fault of theirs.

    Args:
        nowhere: where nobody has asked for each of them.
    """
    with progress("reading the program"):
        entries = read_with(program, replace(source, entry=ALL)).entries
    moving = [entry for entry in entries if entry.moves]
    if nowhere is not None and nowhere.others:
        moving = [entry for entry in moving if entry.name in nowhere.others]
    if not moving:
        raise InputError(f"{program}: no routine in it moves the robot: there is nothing to drive")
    if nowhere is not None:
        each = "each routine that moves the robot is driven by itself; --entry names one"
        warn(f"{nowhere.why}: {each}")
    failed, driven = False, 0
    through: list[bool] = []
    told: list[dict[str, Any]] = []
    for entry in moving:
        call = f"{entry.name}({', '.join(entry.parameters)})" if entry.parameters else entry.name
        said: dict[str, Any] = {"entry": call, "moves": entry.moves}
        told.append(said)
        if not as_json:
            print_rich(f"\n{entry}")
        try:
            with progress(f"driving {entry.name}") as say:
                read = read_with(program, replace(source, entry=entry.name))
                run = _driven(read, replace(options, report=say))
        except FlybyError as error:
            hint = f"; with arguments: --entry '{call}'" if entry.parameters else ""
            fail(f"{error}{hint}")
            failed, said["error"] = failed or not entry.parameters, str(error)
        else:
            causes = {fault.cause for fault in run.faults}
            failed = failed or bool(causes - ({FaultCause.OPEN} if entry.parameters else set()))
            driven += 1
            through += [bool(entry.parameters)] if not causes else []
            if as_json:
                said["run"] = _json(run)
            else:
                _tell(run)
    if as_json:
        print_json({"routines": told})
    else:
        open_ = f", {sum(through)} of them with arguments that nobody says" if any(through) else ""
        print_rich(f"\n{len(through)} of {counted(moving, 'routine')} driven to the end{open_}")
    if failed or not driven:
        raise typer.Exit(1)


def _write_files(
    files: _Files,
    run: Run,
    inputs: Sequence[Path],
    opaque: OpaqueStyle | None,
    replace_existing: bool,
) -> list[Path]:
    """Make everything that can fail first, then write; returns what was written."""
    if files.write is not None and run.faults:
        from ..core.driving.driven_program import refusal

        raise refusal(run.faults)
    if any(files.by_option().values()):
        run.refuse_standing()
    made: dict[Path, bytes] = {}
    if files.csv is not None:
        made[files.csv] = run.trajectory.csv()
    if files.npz is not None:
        made[files.npz] = run.trajectory.npz()
    if files.write is not None:
        sources = _sources(files.write, run, opaque)
        check_outputs({"--write": sources}, inputs, replace_existing)
        made |= sources
    if files.export is not None:
        made[files.export] = run.exported(files.export)
    if files.plot is not None:
        made[files.plot] = run.picture(picture_kind(files.plot, "--plot"))
    if files.report is not None:
        made[files.report] = page_bytes(run)
    write_all(", ".join(option for option, path in files.by_option().items() if path), made)
    return list(made)


def _sources(path: Path, run: Run, opaque: OpaqueStyle | None) -> dict[Path, bytes]:
    from ..tasks.setup import RobotOptions, with_setup
    from ..tasks.write import sources_by_path

    program, setup = with_setup(run.program, RobotOptions())
    chosen = {} if opaque is None else {"opaque": opaque.value}
    return sources_by_path(program, setup, path, chosen, folder=path.is_dir(), option="--write")


def _tell(run: Run) -> None:
    from .output.report_text import print_report

    print_report(run)


def _json(run: Run) -> dict[str, Any]:
    """All that is said of a run, but what goes to the error stream, which is said."""
    from .output.report_text import print_notes, run_json

    print_notes(run.report)
    return run_json(run)


@with_options
def ask(
    program: ProgramFile,
    source: SourceOptions,
    out: Annotated[
        Path | None, typer.Option("--out", help="Write them as a file of answers (TOML).")
    ] = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """List all that a program asks of the world and no file says, as a file of answers."""
    check_outputs({"--out": out}, [program, *source.inputs()], replace_existing=force)
    with progress("reading the program"):
        questions = ask_with(program, source)
    if out is not None:
        write_all("--out", {out: questions.toml.encode()})
    if json:
        from .output.report_text import question_json

        print_json({"questions": [question_json(question) for question in questions]})
    elif out is None:
        print(questions.toml, end="")
    else:
        for line in questions.said or ["nothing is asked"]:
            print_rich(line)
        print_rich(f"wrote {out}", f"next: {next_command(questions, program, out, source)}")
