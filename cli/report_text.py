"""A report as tables, and as JSON."""

from __future__ import annotations

from typing import Any

from .console import print_rich, print_table, warn
from .places import note_json, place_json
from .report import MoveReport, Report, ZoneReport
from .values import fixed

COLUMNS = (
    ("#", "right"),
    ("move", "left"),
    ("target", "left"),
    ("line", "right"),
    ("length\nmm", "right"),
    ("time\ns", "right"),
    ("wait\ns", "right"),
    ("settling\ns", "right"),
    ("top speed\nmm/s", "right"),
    ("programmed\nmm/s", "right"),
    ("zone", "left"),
    ("limited by", "left"),
)
KINDS = {
    "contourfraction": "share of contour",
    "angle": "angle",
    "speedfraction": "share of speed",
}
"""Zones that are no radius, by the class of the programmed zone."""
CUT = 1e-6
"""m by which a zone is smaller than programmed before it is shown as cut."""


def print_report(report: Report) -> None:
    """Print tables on stdout, warnings on stderr."""
    print_table(COLUMNS, _rows(report))
    print_rich(
        f"{report.program} on {report.robot}: cycle time {report.cycle_time:.3f} s; "
        f"TCP path {1e3 * report.length:.1f} mm, at most {1e3 * report.top_speed:.0f} mm/s"
    )
    print_notes(report)


def print_notes(report: Report) -> None:
    """Print warnings on stderr."""
    for note in report.notes:
        warn(str(note))


def _rows(report: Report) -> list[tuple[str, ...]]:
    """What the robot waits before, a line a move, and what all of that takes."""
    before = _no_move("first wait", "", "", _seconds(report.first_wait), "")
    length, moving = f"{1e3 * report.length:.1f}", f"{report.moving:.3f}"
    rests = _seconds(report.waiting), _seconds(report.settling)
    return [
        *([before] if report.first_wait else []),
        *(_row(move) for move in report.moves),
        _no_move("together", length, moving, *rests),
    ]


def _no_move(what: str, length: str, time: str, wait: str, settling: str) -> tuple[str, ...]:
    return ("", what, "", "", length, time, wait, settling, "", "", "", "")


def _seconds(rest: float) -> str:
    """A time of rest, empty for none."""
    return f"{rest:.3f}" if rest else ""


def _row(move: MoveReport) -> tuple[str, ...]:
    line = "" if move.span is None else str(move.span.line)
    head = (str(move.number), move.kind, _target(move), line)
    if not move.driven:
        return (*head, *[""] * (len(COLUMNS) - len(head) - 1), "not driven")
    return (
        *head,
        f"{1e3 * move.length:.1f}",
        f"{move.duration:.3f}",
        _seconds(move.wait),
        _seconds(move.settling),
        f"{1e3 * move.top_speed:.0f}",
        "" if move.programmed_speed is None else f"{1e3 * move.programmed_speed:.0f}",
        zone_text(move.zone),
        f"{move.limits[0].name} ({100 * move.limits[0].share:.0f} %)" if move.limits else "",
    )


def _target(move: MoveReport) -> str:
    if move.target is not None:
        return move.target
    if move.position is None:
        return "joint values"
    return ", ".join(fixed(1e3 * value, 1) for value in move.position)


def zone_text(zone: ZoneReport) -> str:
    """A zone and what became of it, in mm."""
    if zone.kind == "fine":
        return "fine"
    kind = KINDS.get(zone.kind, zone.kind)
    name = zone.name or (kind if zone.radius is None else f"{1e3 * zone.radius:g} mm")
    if zone.stops:
        return f"{name}, stops"
    reach = min(zone.entry, zone.exit)
    if zone.radius is None:
        return f"{name}, {1e3 * reach:.1f} mm"
    return name if reach > zone.radius - CUT else f"{name}, cut to {1e3 * reach:.1f} mm"


def report_json(report: Report) -> dict[str, Any]:
    """The report with JSON's types; units in the keys."""
    return {
        "program": report.program,
        "robot": report.robot,
        "cycle_time_s": report.cycle_time,
        "first_wait_s": report.first_wait,
        "waiting_s": report.waiting,
        "settling_s": report.settling,
        "length_m": report.length,
        "top_speed_m_s": report.top_speed,
        "moves": [_move_json(move) for move in report.moves],
        "warnings": [note_json(note) for note in report.notes],
    }


def _move_json(move: MoveReport) -> dict[str, Any]:
    return {
        "move": move.number,
        "kind": move.kind,
        "target": move.target,
        "position_m": move.position,
        **place_json(move.span),
        "driven": move.driven,
        "length_m": move.length,
        "begin_s": move.begin,
        "duration_s": move.duration,
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
