"""A station over time: what each robot drives and waits for, and the signals between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..core.program.signal import SetSignal
from ..core.station.actions import Action
from ..core.station.clock import StationRun
from ..core.station.station import RobotStation, signal_key
from .style import figure_file

_MOVE, _OTHER_MOVE, _WAIT, _SIGNAL = "#1f4e9c", "#6b8fc9", "#e08a1e", "#3a8a4d"
_HEIGHT = 0.36
"""Of a bar, of the distance between two."""


def draw_station(
    station: RobotStation, run: StationRun, actions: Mapping[str, Sequence[Action]], kind: str
) -> bytes:
    """Draw a station's run as a Gantt chart.

    Args:
        station: the robots.
        run: who was where when.
        actions: of each robot.
        kind: ``png``, ``pdf`` or ``svg``.
    """
    finite = [change.time for change in run.changes]
    finite += [s.end for s in run.schedules.values() if np.isfinite(s.end)]
    finite += [spell.begin for s in run.schedules.values() for spell in s.waits]
    last = max([1e-3, *finite]) * 1.02
    keys = _signals(run)
    rows = len(run.schedules) + len(keys)
    figure = Figure(figsize=(10.0, 1.2 + 0.42 * rows), layout="constrained")
    axes = figure.add_subplot()
    for row, (name, schedule) in enumerate(run.schedules.items()):
        timing = station.members[name].run.timing
        begins = np.append(timing.begins(), station.members[name].run.duration)
        spans = schedule.clocked(np.stack([begins[:-1], begins[1:]], -1))
        for k, (begin, end) in enumerate(spans):
            if np.isfinite(begin):
                _bar(axes, row, begin, min(end, last), (_MOVE, _OTHER_MOVE)[k % 2])
        for spell in schedule.waits:
            _bar(axes, row, spell.begin, min(spell.end, last), _WAIT)
    for row, key in enumerate(keys, len(run.schedules)):
        for begin, end in _on(run, key, last):
            _bar(axes, row, begin, end, _SIGNAL, 0.5 * _HEIGHT)
    spelt = _spelt(station, actions)
    axes.set_yticks(range(rows), [*run.schedules, *(spelt.get(key, key) for key in keys)])
    axes.set_ylim(rows - 0.5, -0.5)
    axes.set_xlim(0.0, last)
    axes.set_xlabel("time, s")
    axes.grid(axis="x", alpha=0.3)
    handles = [
        axes.barh([np.nan], [0.0], color=colour, label=label)
        for colour, label in ((_MOVE, "moves, one by one"), (_WAIT, "waits"), (_SIGNAL, "on"))
    ]
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=3)
    return figure_file(figure, kind)


def _bar(
    axes: Axes, row: int, begin: float, end: float, colour: str, half: float = _HEIGHT
) -> None:
    axes.barh(row, end - begin, 2 * half, left=begin, color=colour, linewidth=0)


def _signals(run: StationRun) -> list[str]:
    return list(dict.fromkeys(change.name for change in run.changes))


def _on(run: StationRun, key: str, last: float) -> list[tuple[float, float]]:
    """From when to when a signal is on."""
    found, since = [], None
    for change in run.changes:
        if change.name != key:
            continue
        if change.on:
            since = change.time
        elif since is not None:
            found.append((since, change.time))
            since = None
        else:
            found.append((0.0, change.time))
    return found if since is None else [*found, (since, last)]


def _spelt(station: RobotStation, actions: Mapping[str, Sequence[Action]]) -> dict[str, str]:
    """Names of signals by key, as the station's file and the programs write them."""
    wired = [end for wire in station.wires for end in (wire.source, wire.target)]
    written = [
        f"{name}.{action.does.name}"
        for name, doings in actions.items()
        for action in doings
        if isinstance(action.does, SetSignal)
    ]
    return {signal_key(name): name for name in [*wired, *station.gates, *station.given, *written]}
