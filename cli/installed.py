"""Vendors and robots by name, with a warning for every plugin that is broken."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from ..core.errors import InputError
from .console import warn

if TYPE_CHECKING:
    from pathlib import Path

    from ..core.registry import Registry
    from ..core.vendor import Vendor


@cache
def registry() -> Registry:
    """All that is installed; warns of broken plugins at the first call."""
    from ..core.registry import installed

    found = installed()
    for plugin in found.broken:
        warn(str(plugin))
    return found


def vendor_of(robot: str) -> Vendor:
    """The vendor of a robot called ``vendor/robot``.

    Raises:
        UnknownNameError: there is none.
    """
    vendor, slash, _ = robot.partition("/")
    if not slash:
        registry().find_robot(robot)  # offers the robots that may be meant
    return registry().find_vendor(vendor)


def check_language(vendor: Vendor, program: Path) -> None:
    """Refuse a program that another vendor's controller runs.

    Raises:
        InputError: the file is no program of the vendor, judged by its suffix, or a folder.
    """
    if program.is_dir():
        raise InputError(f"{program} is a folder; name a program file in it")
    if program.suffix.lower() in vendor.suffixes:
        return
    other = registry().reader_of(program)
    raise InputError(
        f"{program} is a program for {other.name}, the robot is driven by {vendor.name}; "
        f"choose a robot of {other.name} ('flyby robots {other.name}')"
    )
