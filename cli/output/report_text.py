"""A report as tables, and as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.display import alike, counted
from ...core.driving.driven_program import Fault
from ...core.errors import Span
from ...core.program.program import Program
from ...core.program.question import Question
from ...core.source.execution.answers_text import grouped
from ...tasks.files.source_places import (
    fault_json,
    note_json,
    place_json,
    short_place,
)
from ...tasks.results.causes import COLUMNS as CAUSE_COLUMNS
from ...tasks.results.causes import TimeCause, cause_row
from ...tasks.results.lines import COLUMNS as LINE_COLUMNS
from ...tasks.results.lines import LineReport, line_row
from ...tasks.results.report import COLUMNS, MoveReport, Report, move_row, seconds
from ...tasks.results.shares import CycleShares, shares
from .console import complain_of_fault, print_rich, print_table, warn, warn_of

if TYPE_CHECKING:
    from ...core.collision.clearance import Approach
    from ...tasks.results.runs import Run

_FIGURES = {"velocity": "speeds", "acceleration": "accelerations"}
MOST_ALIKE = 3
"""Faults that say the same of several places, before the rest of them is only counted."""
MOST_NAMED = 3
"""Tools and work objects that are named in the headline."""
MOST_LINES = 10
"""Lines that have a row of their own; the rest of them is summed up."""


def print_report(run: Run) -> None:
    """Print tables on stdout, warnings on stderr."""
    report, program = run.report, run.program
    if not run.parts:
        time = f"{report.waiting:.3f} s" if report.waiting else "no time that is known"
        print_rich(f"{report.program} on {report.robot}: moves nothing; its waits take {time}")
        print_notes(report, program.questions)
        return
    print_table(COLUMNS, _rows(report))
    spent = shares(program, report)
    told = f"cycle time {report.driven_time:.3f} s"
    if spent.passes and round(spent.total - report.driven_time, 6):
        told = f"{report.driven_time:.3f} s, the way to the loop and {_passes(spent)} of it"
    if report.faults:
        faults, parts = counted(report.faults, "fault"), counted(report.parts, "part")
        told = f"{faults}, so no cycle time; {report.driven_time:.3f} s driven in {parts}"
    print_rich(
        f"{report.program} on {report.robot}{_taken(report)}: {told}{_range(report)}; "
        f"TCP path {1e3 * report.length:.1f} mm, at most {1e3 * report.top_speed:.0f} mm/s"
    )
    for line in clearance_lines(report, program):
        print_rich(line)
    if spent.total and (spent.passes or spent.devices):
        print_rich(str(spent))
    _print_losses(run)
    print_notes(report, program.questions)


def _passes(spent: CycleShares) -> str:
    return counted(spent.passes, "pass", "passes")


def _print_losses(run: Run) -> None:
    """Print where the time goes: by source line, where that says more than the moves, and by
    cause."""
    report, lines = run.report, run.lines
    main = run.program.reading.main if run.program.reading is not None else ""

    def place(span: Span | None) -> str:
        return short_place(Path(main), span)

    whole = report.driven_time
    if len(lines) < sum(line.times for line in lines) or len(lines) > MOST_LINES:
        longest = sorted(lines, key=lambda line: -line.total)
        rows = [line_row(line, place(line.span), whole) for line in longest[:MOST_LINES]]
        if rest := longest[MOST_LINES:]:
            rows.append(_further(rest, whole))
        print_table(LINE_COLUMNS, rows)
    if run.causes:
        print_table(CAUSE_COLUMNS, [cause_row(c, place(c.span), whole) for c in run.causes])
        if said := run.first_to_change(place):
            print_rich(said)


def _further(lines: Sequence[LineReport], whole: float) -> tuple[str, ...]:
    """The row of all lines that have none of their own."""
    total = sum(line.total for line in lines)
    times = sum(line.times for line in lines)
    share = f"{100 * total / whole:.0f}" if whole else ""
    what = counted(lines, "further line")
    return ("", what, "", f"×{times}", "", "", f"{total:.3f}", share, "")


def clearance_lines(report: Report, program: Program) -> list[str]:
    """How near a run comes to the cell, and the arm to itself: a line each."""
    sides = {"to the cell": report.to_cell, "between the arm's own parts": report.own}
    return [
        f"clearance {side}: {met} ({_named(program, met.move)})"
        for side, met in sides.items()
        if met is not None
    ]


def _named(program: Program, move: int) -> str:
    span = program.moves[move].statement
    return f"move {move + 1}" + ("" if span is None else f", line {span.line}")


def _taken(report: Report) -> str:
    """That tools and work objects are assumed, if they are."""
    named = ", ".join(report.unknown[:MOST_NAMED])
    more = len(report.unknown) - MOST_NAMED
    return f" with {named}{f' and {more} more' if more > 0 else ''} assumed" if named else ""


def _range(report: Report) -> str:
    """What the robot's assumed figures leave open of the time, if anything."""
    if report.time_range is None:
        return ""
    least, most = (f"{end:.3f}" for end in report.time_range)
    if least == most:
        return ""
    figures = " and ".join(_FIGURES[name] for name in report.assumed)
    return f" ({least} to {most} s, as the robot's {figures} are assumed)"


def print_notes(report: Report, questions: Sequence[Question] = ()) -> None:
    """Print warnings and faults on stderr.

    Of faults that are alike the first is printed, and how many there are; of those of a line in a
    loop as well.
    """
    warn_of(note for note in report.notes if not (note.asked and questions))
    print_questions(questions)
    _print_faults(report.faults)


def _print_faults(faults: Sequence[Fault]) -> None:
    for kind in alike(faults, lambda fault: fault.message):
        places: dict[tuple[object, str], list[Fault]] = {}
        for fault in kind:
            places.setdefault((fault.span or fault.move, fault.message), []).append(fault)
        lines = [*places.values()]
        shown = lines if len(lines) <= MOST_ALIKE else lines[:1]
        for same in shown:
            times = f" ({len(same)} times, here first)" if len(same) > 1 else ""
            more = f" (and {len(lines) - 1} like it)" if len(shown) < len(lines) else ""
            complain_of_fault(f"{same[0]}{times}{more}")


def print_questions(questions: Sequence[Question]) -> None:
    """Print a line a kind of what a program asks on stderr, and what lists it."""
    lines = grouped(questions)
    for line in lines:
        warn(f"not known: {line}")
    if lines:
        warn(
            "the same command with `ask` for `emulate`, and `--out answers.toml`, writes them as a "
            "file that `--io answers.toml` takes"
        )


def _rows(report: Report) -> list[tuple[str, ...]]:
    """What the robot waits before, a line a move, and what all of that takes."""
    before = _no_move("first wait", "", "", seconds(report.first_wait), "")
    length, moving = f"{1e3 * report.length:.1f}", f"{report.moving:.3f}"
    rests = seconds(report.waiting), seconds(report.settling)
    return [
        *([before] if report.first_wait else []),
        *(move_row(move) for move in report.moves),
        _no_move("together", length, moving, *rests),
    ]


def _no_move(what: str, length: str, time: str, wait: str, settling: str) -> tuple[str, ...]:
    return ("", what, "", "", length, time, wait, settling, "", "", "", "")


def report_json(report: Report) -> dict[str, Any]:
    """The report with JSON's types; units in the keys."""
    return {
        "program": report.program,
        "robot": report.robot,
        "cycle_time_s": report.cycle_time,
        "driven_time_s": report.driven_time,
        "driven_time_range_s": report.time_range,
        "not_known": report.unknown,
        "first_wait_s": report.first_wait,
        "waiting_s": report.waiting,
        "settling_s": report.settling,
        "length_m": report.length,
        "top_speed_m_s": report.top_speed,
        "moves": [_move_json(move) for move in report.moves],
        "parts": [{"first": first, "last": last} for first, last in report.parts],
        "faults": [fault_json(fault) for fault in report.faults],
        "clearance": {
            side: _approach_json(met)
            for side, met in (("to_cell", report.to_cell), ("own", report.own))
        },
        "warnings": [note_json(note) for note in report.notes],
    }


def _approach_json(met: Approach | None) -> dict[str, Any] | None:
    if met is None:
        return None
    return {"distance_m": met.distance, "pair": list(met.pair), "move": met.move + 1}


def run_json(run: Run) -> dict[str, Any]:
    """All that is said of a run, with JSON's types."""
    lines = [_line_json(line) for line in run.lines]
    causes = [_cause_json(cause) for cause in run.causes]
    losses = {"lines": lines, "causes": causes}
    return report_json(run.report) | losses | asked_json(run.program, run.report)


def _line_json(line: LineReport) -> dict[str, Any]:
    return {
        **place_json(line.span),
        "kind": line.kind,
        "target": line.target,
        "times": line.times,
        "moves": list(line.moves),
        "total_s": line.total,
        "duration_s": line.time,
        "wait_s": line.wait,
        "settling_s": line.settling,
        "limits": [{"name": limit.name, "share": limit.share} for limit in line.limits],
    }


def _cause_json(cause: TimeCause) -> dict[str, Any]:
    return {
        "cause": cause.name,
        "time_s": cause.time,
        "gain_s": cause.gain,
        "moves": list(cause.moves),
        **place_json(cause.span),
    }


def asked_json(program: Program, report: Report) -> dict[str, Any]:
    """What the time of a run goes into, and what its program asks, with JSON's types."""
    spent = shares(program, report)
    return {
        "cycle": {
            "passes": spent.passes,
            "length": spent.length,
            "total_s": None if spent.faults else spent.total,
            "motion_s": spent.motion,
            "waiting_s": spent.waiting,
            "devices_s": spent.devices,
        },
        "questions": [question_json(question) for question in program.questions],
    }


def question_json(question: Question) -> dict[str, Any]:
    """What a program asks, with JSON's types."""
    return {
        "kind": question.kind.name.lower(),
        "table": question.table,
        "key": question.key,
        "type": question.type,
        "taken": question.taken,
        "meanwhile": question.meanwhile,
        "answered": question.answered,
        "count": question.count,
        **place_json(question.span),
    }


def _move_json(move: MoveReport) -> dict[str, Any]:
    return {
        "move": move.number,
        "kind": move.kind,
        "target": move.target,
        "expression": move.expression,
        "position_m": move.position,
        **place_json(move.span),
        "driven": move.driven,
        "fault": None if move.fault is None else str(move.fault.cause),
        "length_m": move.length,
        "begin_s": move.begin,
        "duration_s": move.time,
        "wait_s": move.wait,
        "settling_s": move.settling,
        "top_speed_m_s": move.top_speed,
        "programmed_speed_m_s": move.programmed_speed,
        "zone": {
            "kind": move.zone.kind,
            "name": move.zone.name,
            "radius_m": move.zone.radius,
            "entry_m": move.zone.entry,
            "exit_m": move.zone.exit,
        },
        "limits": [{"name": limit.name, "share": limit.share} for limit in move.limits],
    }
