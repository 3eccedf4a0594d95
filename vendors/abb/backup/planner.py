"""Figures of the motion model that MOC.cfg states.

Of how a controller drives, a backup states next to nothing that has a name in the motion model:
its period follows from the queue times of MOTION_PLANNER. The cap of the TCP's speed
(``linear_max_speed``) is beyond what arms reach on lines; it is noted where it is low, and programs
ask for it (`MaxRobSpeed()`).
"""

from __future__ import annotations

import math
from typing import Any

from ....core.backup.contents import BackupNotes
from ....core.errors import InputError
from .cfg import Parameters, Record, folded

_PERIODS = (0.004032, 0.004)
"""s: the one that queue times of all backups seen are whole multiples of, and the catalogue's."""
_LOW = 4.0
"""m/s; backups as delivered state 6.2 to 8.4."""


def motion_figures(moc: Parameters, notes: BackupNotes) -> dict[str, tuple[Any, str]]:
    """Figures by their names in motion files, each with its value and its origin."""
    planners = moc.section("MOTION_PLANNER")
    for planner in planners:
        _note_cap(planner, notes)
    times = [time for planner in planners for time in _queue_times(planner)]
    for period in _PERIODS:
        if times and all(_multiple(time, period) for time in times):
            what = ", ".join(f"{time:g}" for time in sorted(set(times), reverse=True))
            origin = f"{planners[0].place}: queue times {what} s are whole multiples of it"
            return {"period_s": (period, f"assumed: {origin}")}
    return {}


_ASKED = {
    "maxrobspeed()": ("linear_max_speed", 1000.0),
    "maxrobreorientspeed()": ("reorient_max_speed", 1.0),
}
"""Calls of programs, with what is said to them (m/s, degrees/s), and by what it is multiplied."""


def stated_speeds(moc: Parameters, arm: str) -> dict[str, float]:
    """What programs may ask of an arm of this name; see `BackupRobot.stated`.

    Of several planners it is that which supervises the arm.
    """
    planners = moc.section("MOTION_PLANNER")
    own = [one for one in planners if folded(one.text("use_motion_sup") or "") == folded(arm)]
    found: dict[str, float] = {}
    if len(own) != 1 and len(planners) != 1:
        return found
    for planner in own or planners:
        for call, (key, unit) in _ASKED.items():
            try:
                value = planner.number(key)
            except InputError:
                continue
            if value is not None and 0.0 < value < math.inf:
                found[call] = unit * value
    return found


def _queue_times(planner: Record) -> list[float]:
    found = []
    for key in planner.values:
        if "queue_time" in key:
            try:
                time = planner.number(key)
            except InputError:
                continue
            if time:
                found.append(time)
    return found


def _multiple(time: float, period: float) -> bool:
    count = round(time / period)
    return count > 0 and abs(time - count * period) < 1e-4 * period


def _note_cap(planner: Record, notes: BackupNotes) -> None:
    try:
        speed = planner.number("linear_max_speed")
    except InputError:
        return
    if speed is not None and speed < _LOW:
        notes.add(
            f"the controller drives the TCP at {speed:g} m/s at most (linear_max_speed), which is "
            "not held here: program no faster",
            planner.file,
            planner.line,
        )
