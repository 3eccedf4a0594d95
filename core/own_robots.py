"""The user's own robots: files in a folder of theirs, found as those of the catalogue are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from .door import switched
from .errors import InputError
from .vendor import NAME, lazy_robots

if TYPE_CHECKING:
    from .robot.model import Robot
    from .vendor import Vendor

_SUFFIX = ".toml"


def own_folder() -> Path:
    """Where the user's own robots are kept, in a folder of each vendor."""
    from platformdirs import user_data_path

    return user_data_path("flyby", appauthor=False) / "robots"


def with_own_robots(vendors: Mapping[str, Vendor]) -> dict[str, Vendor]:
    """Vendors with the robots more that the user keeps; a file is read when it is asked for.

    A robot of the catalogue's name does not count: none is called like another.
    """
    made = dict(vendors)
    folder = own_folder()
    for name, vendor in vendors.items():
        own = lazy_robots((folder / name).glob(f"*{_SUFFIX}"))
        own = {robot: load for robot, load in own.items() if NAME.fullmatch(robot)}
        if own:
            made[name] = replace(vendor, robots={**own, **vendor.robots})
    return made


def keep_robot(robot: Robot, vendor: Vendor, replace_existing: bool = False) -> Path:
    """Put a robot among the user's own, from where it is found by its name.

    Its external axes belong to a cell, and are not kept: the robot says so.

    Args:
        robot: called ``vendor/model``.
        vendor: whose robots it must not be called like.
        replace_existing: whether one of the user's that is called so is replaced.

    Returns:
        The file.

    Raises:
        InputError: it is called like another, or as nothing can be, or cannot be written.
    """
    model = robot.name.partition("/")[2]
    if not NAME.fullmatch(model):
        raise InputError(
            f"robot {robot.name!r}: models are called by lower-case letters, digits, '.', '_' and "
            "'-': give it such a name in its file"
        )
    file = own_folder() / vendor.name / f"{model}{_SUFFIX}"
    if not file.exists() and model in vendor.robots:
        raise InputError(
            f"robot {robot.name!r} is in the catalogue already: give it another name in its file"
        )
    if file.exists() and not replace_existing:
        raise InputError(
            f"robot {robot.name!r} is kept already ({file}); {switched('force')} replaces it"
        )
    from .files.writing import write_files
    from .robot.catalogue_text import robot_text

    write_files({file: robot_text(_alone(robot)).encode()}, own_folder())
    return file


def _alone(robot: Robot) -> Robot:
    """A robot without its external axes, which says so."""
    if not robot.external_axes:
        return robot
    names = ", ".join(axis.name for axis in robot.external_axes)
    said = (
        f"its external axes ({names}) are not kept: say them in a cell file ([external_axis]), or "
        "name the robot by the file that they are in"
    )
    origins = {group: said for group, said in robot.origins.items() if group != "external axes"}
    return replace(robot, external_axes=(), origins=origins, doubts=(*robot.doubts, said))
