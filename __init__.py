"""Emulates how industrial robot controllers drive a program, checks, improves and translates it.

Everything is SI (m, rad, s, kg), quaternions are w, x, y, z. ``help(flyby.emulate)`` and its like
list the options of a task; the parts behind are in `flyby.core` and its neighbours.
"""

# By their full names: pytest imports this file by its place, where no package is around it.
# ruff: noqa: TID251
from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from flyby.core import numba_import

if TYPE_CHECKING:
    from flyby.tasks.ask import ask
    from flyby.tasks.backup.opening import open_backup
    from flyby.tasks.catalogue import cell, robot, robots, vendors
    from flyby.tasks.check import check
    from flyby.tasks.compare import compare
    from flyby.tasks.cspace import cspace
    from flyby.tasks.diff.diff import diff
    from flyby.tasks.emulate import emulate
    from flyby.tasks.experiment import experiment
    from flyby.tasks.free_motion.free_motion import free_motion
    from flyby.tasks.free_motion.tune import tune
    from flyby.tasks.identify import identify
    from flyby.tasks.optimize import optimize
    from flyby.tasks.pages.show import report, show
    from flyby.tasks.paint import paint
    from flyby.tasks.pareto import pareto
    from flyby.tasks.read import read
    from flyby.tasks.record import record
    from flyby.tasks.station.check import station_check
    from flyby.tasks.station.optimize import station_optimize
    from flyby.tasks.station.place import place, station_place
    from flyby.tasks.station.station import station
    from flyby.tasks.station.zones import station_zones
    from flyby.tasks.translate import translate
    from flyby.tasks.write import patch, write
    from flyby.tasks.zones import zones

__all__ = [
    "ask",
    "cell",
    "check",
    "compare",
    "cspace",
    "diff",
    "emulate",
    "experiment",
    "free_motion",
    "identify",
    "open_backup",
    "optimize",
    "paint",
    "pareto",
    "patch",
    "place",
    "read",
    "record",
    "report",
    "robot",
    "robots",
    "show",
    "station",
    "station_check",
    "station_optimize",
    "station_place",
    "station_zones",
    "translate",
    "tune",
    "vendors",
    "write",
    "zones",
]

_ELSEWHERE = {
    "cell": "catalogue",
    "diff": "diff.diff",
    "free_motion": "free_motion.free_motion",
    "open_backup": "backup.opening",
    "place": "station.place",
    "patch": "write",
    "report": "pages.show",
    "robot": "catalogue",
    "robots": "catalogue",
    "show": "pages.show",
    "station": "station.station",
    "station_check": "station.check",
    "station_optimize": "station.optimize",
    "station_place": "station.place",
    "station_zones": "station.zones",
    "tune": "free_motion.tune",
}
"""Files of `flyby.tasks` that are not called as what they hold."""

numba_import.install()


def __getattr__(name: str) -> Any:
    """What `__all__` names, imported when it is asked for.

    Raises:
        AttributeError: it is none of these.
    """
    if name not in __all__:
        raise AttributeError(f"module 'flyby' has no attribute {name!r}")
    if name == "vendors":  # the package of that name, which can be called
        return import_module("flyby.vendors")
    found = getattr(import_module(f"flyby.tasks.{_ELSEWHERE.get(name, name)}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
