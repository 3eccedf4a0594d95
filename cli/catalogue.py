"""``flyby vendors`` and ``flyby robots``: what is at hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..tasks.catalogue import registry, vendor_of
from .console import print_json, print_rich, print_table

if TYPE_CHECKING:
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor


def vendors(
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List vendors, and what each can read and write."""
    found = [registry().vendors[name] for name in sorted(registry().vendors)]
    if json:
        print_json([_vendor_json(vendor) for vendor in found])
        return
    columns = (("vendor", "left"), ("robots", "right"), ("reads", "left"), ("languages", "left"))
    print_table(
        columns,
        [(v.name, str(len(v.robots)), " ".join(v.suffixes), ", ".join(_parts(v))) for v in found],
    )


def robots(
    name: Annotated[
        str | None, typer.Argument(help="A vendor, or a robot to show in detail.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON, in SI units.")] = False,
) -> None:
    """List robots, or show one with its limits and where its figures come from."""
    if name is not None and "/" in name:
        robot = registry().find_robot(name)
        if json:
            print_json(_robot_json(robot, vendor_of(name)))
        else:
            _print_robot(robot, vendor_of(name))
        return
    chosen = sorted(registry().vendors) if name is None else [registry().find_vendor(name).name]
    owners = [registry().vendors[vendor] for vendor in chosen]
    found = [(owner, owner.robot(robot)) for owner in owners for robot in sorted(owner.robots)]
    if json:
        print_json([_robot_json(robot, owner) for owner, robot in found])
        return
    columns = (("robot", "left"), ("axes", "right"), ("payload kg", "right"), ("", "left"))
    print_table(columns, [_summary(robot, owner) for owner, robot in found])


def _parts(vendor: Vendor) -> list[str]:
    parts = {"reader": "read", "writer": "write", "patcher": "patch", "recorder": "record"}
    return [verb for part, verb in parts.items() if getattr(vendor, part) is not None]


def _vendor_json(vendor: Vendor) -> dict[str, Any]:
    return {
        "vendor": vendor.name,
        "robots": [f"{vendor.name}/{robot}" for robot in sorted(vendor.robots)],
        "suffixes": list(vendor.suffixes),
        "language": _parts(vendor),
    }


def _reason(robot: Robot, vendor: Vendor) -> str | None:
    """Why no program can be written for a robot; None if one can."""
    return vendor.emulation_only.get(robot.name.removeprefix(f"{vendor.name}/"))


def _summary(robot: Robot, vendor: Vendor) -> tuple[str, ...]:
    payload = "" if robot.payload is None else f"{robot.payload:g}"
    return robot.name, str(robot.size), payload, "emulation only" if _reason(robot, vendor) else ""


def _robot_json(robot: Robot, vendor: Vendor) -> dict[str, Any]:
    from ..core.motion.model.taught_range import range_entries

    taught = vendor.motion_of(robot).taught
    return {
        "robot": robot.name,
        "payload_kg": robot.payload,
        "emulation_only": _reason(robot, vendor),
        "joints": [
            {
                "name": joint.name,
                "kind": str(joint.kind),
                "lower": joint.lower,
                "upper": joint.upper,
                "velocity": joint.velocity,
                "acceleration": joint.acceleration,
                "effort": joint.effort,
            }
            for joint in robot.joints
        ],
        "units": {"revolute": "rad, N m", "prismatic": "m, N", "time": "s"},
        "origins": dict(robot.origins),
        "motion_fitted_to": None if taught is None else range_entries(taught),
    }


def _print_robot(robot: Robot, vendor: Vendor) -> None:
    from ..core.motion.model.taught_range import shown
    from ..core.robot.joint import COLUMNS

    payload = "payload not known" if robot.payload is None else f"payload {robot.payload:g} kg"
    print_rich(f"{robot.name}: {counted(robot.joints, 'joint')}, {payload}")
    reason = _reason(robot, vendor)
    if reason is not None:
        print_rich(f"Emulation only: {reason}")
    print_table(COLUMNS, [joint.cells() for joint in robot.joints])
    print_table((("figures", "left"), ("origin", "left")), list(robot.origins.items()))
    taught = vendor.motion_of(robot).taught
    if taught is not None:
        print_rich(
            f"Its motion model was fitted to runs of: {shown(taught)}. Beyond, it extrapolates."
        )
