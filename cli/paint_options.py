"""What a user asks of ``flyby paint``, from the options' text."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from enum import StrEnum
from typing import TYPE_CHECKING, TypeVar

from ..core.errors import InputError
from . import values
from .loading import cell_of, robot_of

if TYPE_CHECKING:
    from pathlib import Path

    from ..core.cell.cell import Cell
    from ..core.program.tool import Tool, WorkObject
    from ..problems.paint.executable.station import Station
    from ..problems.paint.executable.writing import DriveOptions
    from ..problems.paint.initial.plan import SweepPlan
    from ..problems.paint.spray.footprint import Footprint
    from ..problems.paint.surface.part import Part
    from ..problems.paint.thickness.options import PaintLimits
    from ..problems.paint.thickness.robust import PaintErrors

Choice = TypeVar("Choice", bound=StrEnum)
_LENGTH = re.compile(r"\s*([0-9.eE+-]+)\s*(um|µm|μm|mm)\s*")
_UNITS = {"um": 1e-6, "µm": 1e-6, "μm": 1e-6, "mm": 1e-3}
SHARE = 0.72
"""Sweep width by the radius of the footprint, where none is given."""


def target_of(text: str) -> float:
    """``--target`` in m: ``50um``, ``0.05mm``.

    Raises:
        InputError: it is no thickness with a unit.
    """
    found = _LENGTH.fullmatch(text)
    try:
        value = float(found[1]) * _UNITS[found[2]] if found else math.nan
    except ValueError:
        value = math.nan
    if not 0.0 < value < 0.01:
        raise InputError(f"--target {text}: a thickness with its unit, such as 50um or 0.05mm")
    return value


def direction_of(text: str | None, option: str) -> tuple[float, float, float] | None:
    """Three numbers of a direction; None if it was not given.

    Raises:
        InputError: naming the option.
    """
    if text is None:
        return None
    found = values.numbers(text, option)
    if len(found) != 3 or not any(found):
        raise InputError(f"{option} {text}: a direction x,y,z such as 0,0,-1")
    x, y, z = found
    return x, y, z


def plan_of(
    footprint: Footprint,
    *,
    sweep: float | None,
    distance: float | None,
    overhang: float,
    step: float,
    method: str,
    view: str | None,
    heading: str | None,
    coats: str,
    turns: str,
) -> SweepPlan:
    """The first curve that the options describe; lengths in mm.

    Raises:
        InputError: naming the option.
    """
    from ..problems.paint.initial.plan import Coats, Gun, Method, SweepPlan

    def one_of(kind: type[Choice], text: str, option: str) -> Choice:
        try:
            return kind(text)
        except ValueError:
            raise InputError(f"{option} {text}: {' or '.join(kind)}") from None

    lengths = {"--sweep": sweep, "--distance": distance, "--step": step}
    for option, value in lengths.items():
        if value is not None and not 0.0 < value < math.inf:
            raise InputError(f"{option} {value:g}: a length in mm above zero")
    if not 0.0 <= overhang < math.inf:
        raise InputError(f"--overhang {overhang:g}: a length in mm, zero or more")
    return SweepPlan(
        SHARE * footprint.radius if sweep is None else 1e-3 * sweep,
        footprint.reference_distance if distance is None else 1e-3 * distance,
        longest_segment=1e-3 * step,
        overhang=1e-3 * overhang,
        method=one_of(Method, method, "--method"),
        view=direction_of(view, "--view"),
        heading=direction_of(heading, "--heading"),
        coats=one_of(Coats, coats, "--coats"),
        turns=one_of(Gun, turns, "--turns"),
    )


def limits_of(distance: float, speed: str, tilt: float, deviation: float) -> PaintLimits:
    """Limits of the optimisation.

    Args:
        distance: planned, m; a fifth to either side is allowed.
        speed: ``least,largest`` in mm/s.
        tilt: degrees.
        deviation: mm.

    Raises:
        InputError: naming the option.
    """
    from ..problems.paint.thickness.options import PaintLimits

    found = values.numbers(speed, "--speed")
    if len(found) != 2 or not 0.0 < found[0] < found[1]:
        raise InputError(f"--speed {speed}: least and largest in mm/s, such as 50,800")
    if not 0.0 < tilt < 80.0:
        raise InputError(f"--tilt {tilt:g}: degrees between 0 and 80")
    if not 0.0 < deviation < math.inf:
        raise InputError(f"--deviation {deviation:g}: a length in mm above zero")
    return PaintLimits(
        distance=(0.8 * distance, 1.2 * distance),
        tilt=math.radians(tilt),
        speed=(1e-3 * found[0], 1e-3 * found[1]),
        deviation=1e-3 * deviation,
    )


def region_of(
    part: Part,
    plan: SweepPlan,
    *,
    facing: float | None,
    inside: str | None,
    covered: str | None,
) -> Part:
    """The part with what is to be painted narrowed down.

    Args:
        part: whose painted triangles are chosen from.
        plan: for the direction in which the gun looks.
        facing: degrees by which normals may be off the direction to the gun; None for all.
        inside, covered: two opposite corners of a box, ``x,y,z,x,y,z`` in mm: what is painted lies
            in the first and not in the second; None for no box.

    Raises:
        InputError: naming the option.
    """
    from ..problems.paint.initial.raster import view_of
    from ..problems.paint.surface.region import facing as facing_triangles
    from ..problems.paint.surface.region import within_box

    triangles = part.vertices, part.faces
    chosen = part.painted_faces
    if facing is not None:
        if not 0.0 < facing <= 180.0:
            raise InputError(f"--facing {facing:g}: degrees from 0 to 180")
        to_gun = -view_of(part, plan)
        chosen &= facing_triangles(*triangles, to_gun, math.radians(facing))
    if inside is not None:
        chosen &= within_box(*triangles, *_corners(inside, "--inside"))
    if covered is not None:
        chosen &= ~within_box(*triangles, *_corners(covered, "--covered"))
    if (chosen == part.painted_faces).all():
        return part
    if not chosen.any():
        raise InputError(
            f"{part.name}: --facing, --inside and --covered leave nothing of it to paint"
        )
    return part.with_painted(chosen)


def _corners(text: str, option: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Least and largest coordinates of a box, m."""
    found = values.numbers(text, option)
    if len(found) != 6:
        raise InputError(f"{option} {text}: two corners of a box in mm, x,y,z,x,y,z")
    sides = [sorted((1e-3 * a, 1e-3 * b)) for a, b in zip(found[:3], found[3:], strict=True)]
    low, high = zip(*sides, strict=True)
    return low, high


def errors_of(text: str | None) -> PaintErrors:
    """``--errors height,radius`` in mm and per cent; none if it was not given.

    Raises:
        InputError: they are not two numbers from 0 on.
    """
    from ..problems.paint.thickness.robust import NO_ERRORS, PaintErrors

    if text is None:
        return NO_ERRORS
    found = values.numbers(text, "--errors")
    if len(found) != 2 or not (0.0 <= found[0] < math.inf and 0.0 <= found[1] < 50.0):
        raise InputError(f"--errors {text}: height in mm and radius in %, such as 3,2")
    return PaintErrors(1e-3 * found[0], 1e-2 * found[1])


def station_of(
    robot: str | None,
    cell: Path | None,
    motion: Path | None,
    tool: str | None,
    frame: str | None,
    place: str | None,
    no_floor: bool,
) -> Station | None:
    """Robot, gun and place that the options name; None without a robot.

    Raises:
        InputError: naming the option.
    """
    if robot is None and cell is None:
        for option, value in {"--motion": motion, "--tool": tool, "--frame": frame}.items():
            if value is not None:
                raise InputError(f"{option} is of a robot: name it by --robot or --cell")
        return None
    from ..problems.paint.executable.station import Station

    vendor, arm = robot_of(robot, cell, motion)
    where = cell_of((vendor, arm), cell, no_floor=no_floor)
    return Station(vendor, where, _gun(where, tool), _part_frame(where, frame, place))


def _gun(cell: Cell, name: str | None) -> Tool:
    from ..problems.paint.executable.station import PLAIN_GUN

    if name is not None:
        return cell.tool(name)
    named = [tool for key, tool in cell.tools.items() if key != "tool0"]
    if len(named) > 1:
        raise InputError(
            f"which tool of the cell is the gun? Give --tool: {', '.join(t.name for t in named)}"
        )
    return named[0] if named else PLAIN_GUN


def _part_frame(cell: Cell, name: str | None, place: str | None) -> WorkObject:
    from ..core.program.tool import WorkObject

    if name is not None:
        if place is not None:
            raise InputError("--frame and --place both say where the part stands: give one")
        return cell.frame(name)
    if place is None:
        raise InputError("where does the part stand? Give --place POSE in the world, or --frame")
    return WorkObject("part", values.pose(place, "--place"))


def drive_of(
    zone: float, run_in: float, signal: str | None, flow: str | None, delay: float
) -> DriveOptions:
    """How the trajectory is driven; lengths in mm, delay in ms.

    Raises:
        InputError: naming the option.
    """
    from ..problems.paint.executable.writing import DriveOptions
    from ..problems.paint.spray.signals import GunSignals

    numbers: Sequence[tuple[str, float]] = (("--zone", zone), ("--run", run_in), ("--delay", delay))
    for option, value in numbers:
        if not 0.0 <= value < 1e4:
            raise InputError(f"{option} {value:g}: a number from 0 on")
    if signal is None and (flow is not None or delay):
        raise InputError("--flow and --delay are of the gun's signals: name its switch by --signal")
    signals = None if signal is None else GunSignals(signal, flow, delay=1e-3 * delay)
    return DriveOptions(1e-3 * zone, 1e-3 * run_in, signals)


def check_signals(drive: DriveOptions, station: Station) -> None:
    """Refuse signals that the robot's language cannot send, before anything is worked out.

    Raises:
        InputError: as `gun.output_words`.
    """
    from ..problems.paint.spray.signals import output_words

    if drive.signals is not None:
        output_words(drive.signals, station.vendor)
