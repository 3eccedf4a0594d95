"""Signals of a station over time, as charts show them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ..core.program.signal import SetSignal
from ..core.station.actions import Action
from ..core.station.clock import StationRun
from ..core.station.station import RobotStation, signal_key


def signals_on(
    station: RobotStation, run: StationRun, actions: Mapping[str, Sequence[Action]], last: float
) -> dict[str, list[tuple[float, float]]]:
    """From when to when signals that change are on, by their names, in the order of the changes.

    Args:
        station, run, actions: the station, as it ran.
        last: s, until when what stays on is shown.
    """
    spelt = _spelt(station, actions)
    keys = dict.fromkeys(change.name for change in run.changes)
    return {spelt.get(key, key): _on(run, key, last) for key in keys}


def _on(run: StationRun, key: str, last: float) -> list[tuple[float, float]]:
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
