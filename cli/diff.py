"""``flyby diff``: two states of a program or a station side by side."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import FlybyError, OptionError
from ..tasks.diff.diff import diff_with
from ..tasks.diff.git_states import beside_others
from ..tasks.files.source_places import place_json
from ..tasks.pages.file import check_page, write_page
from ..tasks.read import SourceOptions
from .output.console import fail, print_json, print_rich, print_table, progress
from .parameters import AsJson, Force, PageFile, with_options

if TYPE_CHECKING:
    from ..core.difference.differences import Difference
    from ..core.difference.texts import FileDifference
    from ..core.program.move import Move
    from ..tasks.diff.comparing import RoutineDifference, StateDifference

_NOT_COMPARED = "not compared: cycle times, driven paths, clearances, what cannot be driven"
_OF_GIT = (7, 9)
"""Arguments that git gives to an external diff: name, then file, hash and mode of both sides; the
new name and what git says of it, of a file that was renamed."""
_NOTHING = "/dev/null"
"""What git names in the place of a file that is not there."""

Table = tuple[str, Sequence[str], list[tuple[str, ...]]]
"""Title, heads and rows."""


@with_options
def diff(
    paths: Annotated[
        list[str],
        typer.Argument(
            help="Two programs, folders or backups; one, to list its moves a line each (git's "
            "textconv); or the seven arguments of git's external diff."
        ),
    ],
    source: SourceOptions,
    markdown: Annotated[
        bool, typer.Option("--markdown", help="Print tables in Markdown, for a merge request.")
    ] = False,
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Compare two states: points, tools, zones, speeds, moves, code; cycle times, paths, faults.

    Of programs whose robot nobody names, what needs no robot is compared, and it says so.
    The exit status is 1 if they differ, 2 for an error; as git's external diff it is always 0.
    """
    check_page(report, [*map(Path, paths[:2]), *source.inputs()], force)
    if report is not None and len(paths) != 2:
        raise OptionError("--report is of two states: name both")
    if len(paths) == 1:
        _list_moves(Path(paths[0]), source)
        return
    if len(paths) in _OF_GIT:
        _for_git(paths, source)
        return
    if len(paths) != 2:
        raise OptionError(f"{len(paths)} paths: name the two states that are compared")
    try:
        with progress("reading both") as say:
            found = diff_with(paths[0], paths[1], source)
            if report is not None:
                say("making the page")
            written = write_page(report, found)
    except FlybyError as error:
        fail(str(error))
        raise typer.Exit(2) from None
    if json:
        print_json(_json(found))
    else:
        _tell(found, markdown=markdown)
        for path in written:
            print_rich(f"wrote {path}")
    if found.differs:
        raise typer.Exit(1)


def _for_git(paths: Sequence[str], source: SourceOptions) -> None:
    """Both states of a file as git hands them over; git takes any other status for a failure."""
    name, old, new = paths[0], paths[1], paths[4]
    print_rich(f"diff of {' → '.join([name, *paths[7:8]])}")
    if _NOTHING in (old, new):
        print_rich("added" if old == _NOTHING else "removed")
        return
    with beside_others(name, old, new) as (before, after):
        try:
            found = diff_with(before, after, source)
        except FlybyError as error:
            try:  # it runs nothing by itself, as data: with what lies beside it, it may
                found = diff_with(before.parent, after.parent, source)
            except FlybyError:
                for state in (before, after):
                    error = type(error)(str(error).replace(str(state), name))
                print_rich(f"not compared: {error}")
                return
        _tell(found, markdown=False)


def _list_moves(path: Path, source: SourceOptions) -> None:
    """The moves of a program, a line each, without places in the text.

    What has none, or cannot be read, is listed as it is: git takes an error for its own.
    """
    from ..core.difference.data import target_text
    from ..core.difference.moves import move_text
    from ..tasks.diff.state import program_of, text_of

    moves: Sequence[Move] = ()
    why = ""
    try:
        moves = program_of(path, source).moves
    except FlybyError as error:
        if not path.is_file():
            raise
        why = f"not read: {str(error).replace(str(path), path.name)}"
    if not moves:
        text = text_of(path)
        print_rich(*(text.splitlines() if text and "\0" not in text else filter(None, [why])))
    for move in moves:
        at = f", at {target_text(move.target)}" if move.target.name and not move.open else ""
        print_rich(f"{move_text(move)}{at}")


# tables


def _tell(found: StateDifference, *, markdown: bool) -> None:
    if not found.differs:
        print_rich(f"{found.before} and {found.after} do not differ")
    for title, heads, rows in _tables(found):
        if not rows:
            continue
        if markdown:
            _print_markdown(title, heads, rows)
        else:
            numbers = {"before s", "after s", "%", "mm apart", "Δ mm", "Δ °", "lines +", "lines -"}
            sided = [(head, "right" if head in numbers else "left") for head in heads]
            print_table(sided, rows, title)
    for (said, fault), routines in _faults(found).items():
        print_rich(f"{'- ' * markdown}{said}, {', '.join(routines)}: {fault}")
    if found.undriven:
        print_rich(f"{_NOT_COMPARED}: {found.undriven}")


def _faults(found: StateDifference) -> dict[tuple[str, str], list[str]]:
    """Routines by what cannot be driven in them, and whether that is new."""
    of: dict[tuple[str, str], list[str]] = {}
    for routine in found.routines:
        kinds = (routine.faults, routine.mended, routine.lasting)
        for said, faults in zip(("new fault", "mended", "on both sides"), kinds, strict=True):
            for fault in faults:
                of.setdefault((said, fault), []).append(routine.name)
    return of


def _print_markdown(title: str, heads: Sequence[str], rows: list[tuple[str, ...]]) -> None:
    lines = [f"\n### {title}\n", "| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows]
    for line in lines:
        print_rich(line)
    print_rich("")


def _tables(found: StateDifference) -> list[Table]:
    near = any(value is not None for one in found.routines for value in one.clearances)
    heads = ["routine", "before s", "after s", "%", "mm apart"]
    heads += ["clearance before mm", "after mm"] if near else []
    routines = [_routine_cells(one, near=near) for one in found.routines]
    return [
        ("routines", heads, [] if found.undriven else routines),
        (
            "differences",
            ("what", "name", "before", "after", "Δ mm", "Δ °", "line"),
            [_cells(one) for one in found.differences],
        ),
        (
            "files",
            ("file", "", "lines +", "lines -", "moved"),
            [_file_cells(one) for one in found.files],
        ),
    ]


def _routine_cells(one: RoutineDifference, *, near: bool) -> tuple[str, ...]:
    before, after = one.times
    share = ""
    if before and after is not None:
        share = f"{100 * (after / before - 1):+.1f}"
    cells = (one.name, _seconds(before), _seconds(after), share, _apart(one))
    return (*cells, *(_millimetres(value) for value in one.clearances)) if near else cells


def _apart(one: RoutineDifference) -> str:
    """How far the paths are apart; of what is not driven to its end, that this is not known."""
    in_part = None in one.times
    if one.distance is None:
        return "not driven" if in_part else ""
    return f"{1e3 * one.distance:.2f}" + (" in part" if in_part else "")


def _seconds(time: float | None) -> str:
    return "not driven" if time is None else f"{time:.3f}"


def _millimetres(length: float | None) -> str:
    return "" if length is None else f"{1e3 * length:.1f}"


def _cells(one: Difference) -> tuple[str, ...]:
    distance = "" if one.distance is None else f"{1e3 * one.distance:.3f}"
    angle = "" if one.angle is None else f"{math.degrees(one.angle):.3f}"
    line = "" if one.span is None else f"{Path(one.span.file).name}:{one.span.line}"
    return (one.subject.value, one.name, one.before, one.after, distance, angle, line)


def _file_cells(one: FileDifference) -> tuple[str, ...]:
    return (one.name, one.kind, str(one.added), str(one.removed), str(one.moved or ""))


# JSON


def _json(found: StateDifference) -> dict[str, Any]:
    return {
        "before": str(found.before),
        "after": str(found.after),
        "differs": found.differs,
        "not_driven": found.undriven or None,
        "routines": [_routine_json(one) for one in found.routines],
        "differences": [_difference_json(one) for one in found.differences],
        "files": [
            {
                "file": one.name,
                "kind": one.kind,
                "lines_added": one.added,
                "lines_removed": one.removed,
                "lines_moved": one.moved,
            }
            for one in found.files
        ],
    }


def _routine_json(one: RoutineDifference) -> dict[str, Any]:
    return {
        "routine": one.name,
        "cycle_time_before_s": one.times[0],
        "cycle_time_after_s": one.times[1],
        "greatest_path_distance_m": one.distance,
        "clearance_before_m": one.clearances[0],
        "clearance_after_m": one.clearances[1],
        "new_faults": list(one.faults),
        "mended_faults": list(one.mended),
        "lasting_faults": list(one.lasting),
    }


def _difference_json(one: Difference) -> dict[str, Any]:
    return {
        "subject": one.subject.value,
        "kind": one.kind,
        "name": one.name,
        "before": one.before or None,
        "after": one.after or None,
        "distance_m": one.distance,
        "angle_rad": one.angle,
        **place_json(one.span),
    }
