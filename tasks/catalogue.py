"""Robots, vendors and cells by name."""

from __future__ import annotations

import logging
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from .options.kinds import refuse_others

if TYPE_CHECKING:
    from ..core.cell.cell import Cell
    from ..core.registry import Registry
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor

_log = logging.getLogger("flyby")


@cache
def registry() -> Registry:
    """All that is installed; warns of broken plugins at the first call."""
    from ..core.registry import installed

    found = installed()
    for plugin in found.broken:
        _log.warning(str(plugin))
    return found


def robot(name: str, vendor: str | None = None) -> Robot:
    """The robot called ``vendor/robot``, or as people and controllers write it, or of a file.

    Args:
        name: a name of the catalogue, or a catalogue file (``.toml``), a URDF, or machine data of
            the robot's own controller (a KUKA's ``$machine.dat``).
        vendor: whose controller drives it, where its file does not say.

    Raises:
        UnknownNameError: there is none.
        InputError: the file cannot be used.
    """
    from ..core.robot_files import load_robot_file, names_file

    refuse_others("name", name, "str")
    if names_file(name):
        return load_robot_file(name, registry(), vendor)
    return registry().find_robot(name)


def driver_of(robot: Robot) -> Vendor:
    """The vendor whose controller drives a robot; it knows the robot if no catalogue does.

    Raises:
        UnknownNameError: no vendor is called as the robot's name begins.
    """
    vendor = registry().find_vendor(robot.name.partition("/")[0])
    known = robot.name.removeprefix(f"{vendor.name}/") in vendor.robots
    return vendor if known else vendor.with_robot(robot)


def robots(vendor: str | None = None) -> tuple[str, ...]:
    """Names of all robots, sorted; those of one vendor if it is named.

    Raises:
        UnknownNameError: there is no such vendor.
    """
    if vendor is None:
        return registry().robot_names
    refuse_others("vendor", vendor, "str")
    found = registry().find_vendor(vendor)
    return tuple(f"{found.name}/{model}" for model in sorted(found.robots))


def vendors() -> tuple[Vendor, ...]:
    """All vendors, by name."""
    found = registry().vendors
    return tuple(found[name] for name in sorted(found))


def vendor_of(robot: str) -> Vendor:
    """The vendor of a robot called ``vendor/robot``.

    Raises:
        UnknownNameError: there is none.
    """
    vendor, slash, model = robot.partition("/")
    found = registry().vendors.get(vendor)
    if not slash or found is None or model not in found.robots:
        vendor = registry().robot_called(robot).partition("/")[0]
    return registry().find_vendor(vendor)


def cell(file: str | Path) -> Cell:
    """The cell of a file.

    Raises:
        InputError: the file is unusable.
    """
    return cell_around(file, None)


def cell_around(file: str | Path, robot: Robot | None) -> Cell:
    """The cell of a file; a robot of its name, if it names that one, is the one that is meant.

    Raises:
        InputError: the file is unusable.
    """
    from ..core.cell.file import load_cell

    refuse_others("file", file, "str | Path")
    known = registry()
    return load_cell(Path(file), known if robot is None else known.with_arm(robot))
