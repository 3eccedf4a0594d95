"""A station over time: what each robot drives and waits for, and the signals between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..core.station.actions import Action
from ..core.station.clock import StationRun
from ..core.station.station import RobotStation
from .signals import signals_on
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
    return figure_file(make_station_figure(station, run, actions), kind)


def make_station_figure(
    station: RobotStation, run: StationRun, actions: Mapping[str, Sequence[Action]]
) -> Figure:
    """The same as a figure."""
    finite = [change.time for change in run.changes]
    finite += [s.end for s in run.schedules.values() if np.isfinite(s.end)]
    finite += [spell.begin for s in run.schedules.values() for spell in s.waits]
    last = max([1e-3, *finite]) * 1.02
    signals = signals_on(station, run, actions, last)
    rows = len(run.schedules) + len(signals)
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
    for row, lit in enumerate(signals.values(), len(run.schedules)):
        for begin, end in lit:
            _bar(axes, row, begin, end, _SIGNAL, 0.5 * _HEIGHT)
    axes.set_yticks(range(rows), [*run.schedules, *signals])
    axes.set_ylim(rows - 0.5, -0.5)
    axes.set_xlim(0.0, last)
    axes.set_xlabel("time, s")
    axes.grid(axis="x", alpha=0.3)
    handles = [
        axes.barh([np.nan], [0.0], color=colour, label=label)
        for colour, label in ((_MOVE, "moves, one by one"), (_WAIT, "waits"), (_SIGNAL, "on"))
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _bar(
    axes: Axes, row: int, begin: float, end: float, colour: str, half: float = _HEIGHT
) -> None:
    axes.barh(row, end - begin, 2 * half, left=begin, color=colour, linewidth=0)
