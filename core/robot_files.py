"""Robots from files: of the catalogue's kind, URDF, or what a robot's own controller says of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from .door import spelt
from .errors import InputError

if TYPE_CHECKING:
    from .registry import Registry
    from .robot.model import Robot

CATALOGUE, URDF, XACRO = ".toml", ".urdf", ".xacro"
_OTHERS = (".xml", ".dat")


def names_file(name: str) -> bool:
    """Whether a robot is named by a file, judged by how the name ends."""
    return Path(name).suffix.lower() in (CATALOGUE, URDF, XACRO, *_OTHERS)


def load_robot_file(
    path: str | Path,
    registry: Registry,
    vendor: str | None = None,
    srdf: str | Path | None = None,
) -> Robot:
    """The robot of a file.

    Args:
        path: a catalogue file (``.toml``), a URDF, or machine data of a controller.
        registry: of vendors.
        vendor: whose controller drives it, where the file does not say.
        srdf: for a URDF, the file of the pairs of links that may touch; see `load_urdf`.

    Raises:
        InputError: it is none of these, nobody says whose controller drives it, or two say so
            differently.
    """
    path = Path(path)
    if vendor is not None:
        registry.find_vendor(vendor)
    suffix = path.suffix.lower()
    if srdf is not None and suffix != URDF:
        raise InputError(f"{path}: an SRDF belongs to a URDF, and this is none; leave {srdf} out")
    if suffix == CATALOGUE:
        return _of_vendor(path, _catalogue(path), registry, vendor)
    if suffix in (URDF, XACRO):
        return _of_urdf(path, registry, vendor, srdf)
    owners = [v for v in registry.vendors.values() if v.described and vendor in (None, v.name)]
    if len(owners) != 1 or owners[0].described is None:
        known = ", ".join(sorted(v.name for v in registry.vendors.values() if v.described))
        whose = f"; say whose it is by {spelt('vendor')}" if owners else ""
        raise InputError(
            f"{path}: a robot is read of a catalogue file (.toml), a URDF (.urdf), or machine data "
            f"of a controller (of {known}), and this is none{whose}"
        )
    return _of_vendor(path, owners[0].described(path), registry, vendor)


def _catalogue(path: Path) -> Robot:
    from .robot.catalogue import load_robot

    return load_robot(path)


def _of_vendor(path: Path, robot: Robot, registry: Registry, vendor: str | None) -> Robot:
    """The robot, whose name says its vendor."""
    own = robot.name.partition("/")[0]
    if own not in registry.vendors:
        known = ", ".join(sorted(registry.vendors))
        raise InputError(
            f"{path}: its name {robot.name!r} says no vendor: vendor/model is expected, with one "
            f"of {known}"
        )
    if vendor is not None and vendor != own:
        raise InputError(f"{path}: it is a robot of {own}, not of {vendor}")
    return robot


def _of_urdf(path: Path, registry: Registry, vendor: str | None, srdf: str | Path | None) -> Robot:
    from .robot.urdf.arm import load_urdf

    if vendor is None:
        known = ", ".join(sorted(registry.vendors))
        raise InputError(
            f"{path}: a URDF does not say whose controller drives the robot: say so with "
            f"{spelt('vendor')} ({known})"
        )
    robot = load_urdf(path, srdf=srdf)
    return replace(robot, name=f"{vendor}/{_called(robot.name)}")


def _called(name: str) -> str:
    """A model's name as the catalogue spells them."""
    spelling = "".join(sign if sign.isalnum() or sign in "._-" else "-" for sign in name.lower())
    return spelling.strip("-._") or "robot"
