"""What an installation declares for all programs, in the words of the core."""

from __future__ import annotations

from ....core.backup.backup import Signal, SignalKind
from ....core.errors import InputError
from ....core.program.target import JointTarget
from ....core.program.tool import Load, Tool, WorkObject
from ....core.robot.inertia import Inertia
from ....core.spatial.pose import IDENTITY, Pose
from ..urp.installation import Installation, Payload, Six
from ..values.poses import quaternion_of
from ..values.values import ValueFault

HOME = "SafeHome"
_KINDS = {
    "digital_in": SignalKind.DIGITAL_INPUT,
    "tool_in": SignalKind.DIGITAL_INPUT,
    "config_in": SignalKind.DIGITAL_INPUT,
    "GP_bool_in": SignalKind.DIGITAL_INPUT,
    "digital_out": SignalKind.DIGITAL_OUTPUT,
    "tool_out": SignalKind.DIGITAL_OUTPUT,
    "config_out": SignalKind.DIGITAL_OUTPUT,
    "GP_bool_out": SignalKind.DIGITAL_OUTPUT,
    "analog_in": SignalKind.ANALOG_INPUT,
    "GP_float_in": SignalKind.ANALOG_INPUT,
    "analog_out": SignalKind.ANALOG_OUTPUT,
    "GP_float_out": SignalKind.ANALOG_OUTPUT,
    "GP_int_in": SignalKind.GROUP_INPUT,
    "GP_int_out": SignalKind.GROUP_OUTPUT,
}


def tools_of(installation: Installation) -> dict[str, Tool]:
    """TCPs by name; the one in force carries the payload in force."""
    load = _load(installation.payloads.get(installation.payload or ""), installation.payload)
    found: dict[str, Tool] = {}
    for name, offset in installation.tcps.items():
        pose = _pose(offset)
        if pose is not None:
            found[name] = Tool(name, pose, load if name == installation.active else None)
    return found


def frames_of(installation: Installation, base: Pose = IDENTITY) -> dict[str, WorkObject]:
    """Features by name.

    Args:
        base: of the robot in the world.
    """
    poses = {name: _pose(feature.pose) for name, feature in installation.features.items()}
    return {n: WorkObject(n, user=base, frame=p) for n, p in poses.items() if p is not None}


def homes_of(installation: Installation) -> dict[str, JointTarget]:
    """The safe home, where there is one."""
    home = installation.home
    return {} if home is None else {HOME: JointTarget(home, name=HOME)}


def signals_of(installation: Installation) -> tuple[Signal, ...]:
    """The signals that have names of the operator's."""
    return tuple(
        Signal(name, _KINDS[address.partition("[")[0]], address)
        for name, address in installation.signals.items()
    )


def _pose(six: Six) -> Pose | None:
    try:
        return Pose((six[0], six[1], six[2]), quaternion_of(*six[3:]))
    except (ValueFault, InputError, OverflowError):
        return None


def _load(payload: Payload | None, name: str | None) -> Load | None:
    if payload is None:
        return None
    x, y, z = payload.centre
    try:
        if payload.inertia is None:
            return Load(payload.mass, (x, y, z), name=name)
        xx, yy, zz, xy, xz, yz = payload.inertia
        tensor = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
        return Load.of_body(Inertia(payload.mass, (x, y, z), tensor), name)
    except InputError:
        return None
