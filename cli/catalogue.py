"""``flyby vendors`` and ``flyby robots``: what is at hand."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..core.errors import OptionError
from ..core.own_robots import keep_robot
from ..core.registry import all_listed
from ..core.robot_files import load_robot_file, names_file
from ..tasks.catalogue import driver_of, registry, robot, vendor_of
from ..tasks.files.new_vendor import new_vendor as make_vendor
from .output.console import print_json, print_rich, print_table

if TYPE_CHECKING:
    from ..core.robot.arm_list import Listed
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor

ADD = "add"
"""The word in the place of a name that keeps a file's robot."""


def vendors(
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List vendors, what each can read and write, and the plugin that it comes with; below, what
    else plugins add: robots, readers of logs, exporters, rules of flyby check."""
    found = [registry().vendors[name] for name in sorted(registry().vendors)]
    if json:
        print_json([*map(_vendor_json, found), *_others()])
        return
    columns = (
        *(("vendor", "left"), ("robots", "right"), ("reads", "left"), ("languages", "left")),
        ("from", "left"),
    )
    print_table(columns, list(map(_vendor_row, found)))
    if others := _others():
        keys = ("adds", "name", "distribution", "what")
        heads = [(key.replace("distribution", "from"), "left") for key in keys]
        print_table(heads, [tuple(one[key] for key in keys) for one in others])
    if broken := registry().broken:
        print_table(
            (("plugin, not loaded", "left"), ("from", "left"), ("because", "left")),
            [(one.plugin, one.distribution, str(one.error)) for one in broken],
        )


def new_vendor(
    name: Annotated[str, typer.Argument(help="Of the vendor, in lower case: acme.")],
    folder: Annotated[
        Path | None, typer.Option(help="What to make; without, flyby-NAME here.")
    ] = None,
) -> None:
    """Write a plugin for another vendor, with a robot, a small language and its tests."""
    written = make_vendor(name, folder)
    for file in written:
        print_rich(str(file))


def robots(
    name: Annotated[
        str | None,
        typer.Argument(
            help="A vendor, a robot or a file of one to show in detail, or part of a name: 120, "
            "IRB 6640; or add, to keep a file's robot among your own."
        ),
    ] = None,
    file: Annotated[
        Path | None, typer.Argument(help="With add: catalogue file, URDF or $machine.dat.")
    ] = None,
    vendor: Annotated[
        str | None,
        typer.Option(help="Whose controller drives a file's robot, where it does not say."),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="With add: replace one that is kept already.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON, in SI units.")] = False,
) -> None:
    """List robots, those like a name, or show one with its limits and its figures' origins."""
    if name == ADD or file is not None:
        _add(name, file, vendor, force)
        return
    vendors = registry().vendors
    if name is not None and names_file(name):
        _show(robot(name, vendor), json)
        return
    if name is None or name in vendors:
        owners = [vendors[vendor] for vendor in (sorted(vendors) if name is None else [name])]
        found = [arm for owner in owners for arm in all_listed(owner)]
    else:
        found = registry().robots_like(name)
        if len(found) < 2:
            _show(registry().find_robot(name), json)
            return
    drivable = [arm for arm in found if arm.refused is None]
    if json:
        arms = [registry().find_robot(arm.name) for arm in drivable]
        print_json([_robot_json(arm, vendor_of(arm.name)) for arm in arms])
        return
    columns = (
        *(("robot", "left"), ("model", "left"), ("axes", "right"), ("payload kg", "right")),
        *(("reach m", "right"), ("", "left")),
    )
    if drivable:
        print_table(columns, list(map(_summary, drivable)))
    if refused := [arm for arm in found if arm.refused is not None]:
        print_table(
            (("known, not driven", "left"), ("because", "left")),
            [(arm.model, arm.refused or "") for arm in refused],
        )


def _add(name: str | None, file: Path | None, vendor: str | None, force: bool) -> None:
    """Keep the robot of a file among the user's own."""
    if name != ADD or file is None:
        raise OptionError(
            f"flyby robots {ADD} FILE keeps a file's robot; {ADD} and FILE go together"
        )
    added = load_robot_file(file, registry(), vendor)
    kept = keep_robot(added, registry().find_vendor(added.name.partition("/")[0]), force)
    print_rich(f"{added.name} is kept as {kept}")
    if added.external_axes:
        print_rich(load_robot_file(kept, registry()).doubts[-1])


def _show(robot: Robot, json: bool) -> None:
    vendor = driver_of(robot)
    if json:
        print_json(_robot_json(robot, vendor))
    else:
        _print_robot(robot, vendor)


def _parts(vendor: Vendor) -> list[str]:
    parts = {"reader": "read", "writer": "write", "patcher": "patch", "recorder": "record"}
    parts |= {"speaks": "translate into", "backups": "import", "machine_data": "machine data"}
    return [verb for part, verb in parts.items() if getattr(vendor, part) is not None]


def _others() -> list[dict[str, str]]:
    """What plugins add beside vendors."""
    offers, told = registry().offers, registry().distributions
    rules = {**offers.program_rules, **offers.run_rules}
    found = [("robot", name, "") for name in offers.robots]
    found += [("reads logs", one.name, one.summary) for one in offers.logs.values()]
    found += [
        ("exports", one.name, f"{' '.join(one.suffixes)}: {one.summary}")
        for one in offers.exporters.values()
    ]
    found += [("rule", one.id, one.summary) for one in rules.values()]
    return [
        {"adds": adds, "name": name, "distribution": told.get(name, ""), "what": what}
        for adds, name, what in found
    ]


def _vendor_row(vendor: Vendor) -> tuple[str, ...]:
    return (
        *(vendor.name, str(len(vendor.robots)), " ".join(vendor.suffixes)),
        *(", ".join(_parts(vendor)), registry().distributions.get(vendor.name, "")),
    )


def _vendor_json(vendor: Vendor) -> dict[str, Any]:
    return {
        "distribution": registry().distributions.get(vendor.name),
        "vendor": vendor.name,
        "robots": [f"{vendor.name}/{robot}" for robot in sorted(vendor.robots)],
        "suffixes": list(vendor.suffixes),
        "language": _parts(vendor),
    }


def _reason(robot: Robot, vendor: Vendor) -> str | None:
    """Why no program can be written for a robot; None if one can."""
    return vendor.emulation_only.get(robot.name.removeprefix(f"{vendor.name}/"))


def _summary(arm: Listed) -> tuple[str, ...]:
    vendor, _, model = arm.name.partition("/")
    numbers = (f"{value:g}" if value is not None else "" for value in (arm.payload, arm.reach))
    emulated = registry().vendors[vendor].emulation_only
    shown = "" if arm.model == model else arm.model
    return (
        *(arm.name, shown, "" if arm.axes is None else str(arm.axes), *numbers),
        "emulation only" if model in emulated else "",
    )


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
                "coupling": joint.coupling(),
                "held": joint.held,
            }
            for joint in robot.joints
        ],
        "units": {"revolute": "rad, N m", "prismatic": "m, N", "time": "s"},
        "origins": dict(robot.origins),
        "spread": dict(robot.spread),
        "doubts": list(robot.doubts),
        "coupled_ranges": [coupled.shown() for coupled in robot.coupled_ranges],
        "may_touch": [
            {"links": [p.first, p.second], "file": p.file, "reason": p.reason}
            for p in robot.may_touch
        ],
        "motion_fitted_to": None if taught is None else range_entries(taught),
    }


def _print_robot(robot: Robot, vendor: Vendor) -> None:
    from ..core.collision.scene.allowed_pairs import robot_notes
    from ..core.motion.model.taught_range import shown
    from ..core.robot.joint import COLUMNS

    payload = "payload not known" if robot.payload is None else f"payload {robot.payload:g} kg"
    driven = [joint for joint in robot.joints if not joint.held]
    print_rich(f"{robot.name}: {counted(driven, 'joint')}, {payload}")
    reason = _reason(robot, vendor)
    if reason is not None:
        print_rich(f"Emulation only: {reason}")
    print_table(COLUMNS, [joint.cells() for joint in robot.joints])
    for turns in filter(None, (joint.coupling() for joint in robot.joints)):
        print_rich(f"Coupled by rods or gears: {turns}")
    for coupled in robot.coupled_ranges:
        print_rich(f"Coupled: {coupled.shown()}")
    print_table((("figures", "left"), ("origin", "left")), list(robot.origins.items()))
    for note in robot_notes(robot):
        print_rich(f"In collisions: {note}")
    for doubt in robot.doubts:
        print_rich(f"In doubt: {doubt}")
    taught = vendor.motion_of(robot).taught
    if taught is not None:
        print_rich(
            f"Its motion model was fitted to runs of: {shown(taught)}. Beyond, it extrapolates."
        )
