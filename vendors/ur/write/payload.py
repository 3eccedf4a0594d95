"""What the flange carries, as a controller takes it: one body."""

from __future__ import annotations

from ....core.program.tool import Load, Tool
from ....core.robot.inertia import Inertia, carried_inertia
from ....core.spatial.pose import Vector3

Payload = tuple[float, Vector3, tuple[float, ...]]
"""Mass, kg; centre of gravity in the flange's frame, m; inertia about it in the flange's axes,
Ixx, Iyy, Izz, Ixy, Ixz, Iyz, kg m²."""

NO_PAYLOAD: Payload = (0.0, (0.0, 0.0, 0.0), (0.0,) * 6)

_UNTURNED = (1.0, 0.0, 0.0, 0.0)
_DIGITS = 12
"""Significant digits of a turned tensor: what is computed again must come to the same text."""


def payload(tool: Tool, load: Load | None) -> Payload:
    """Tool and load together; the numbers of a single body stay as they are, to the last digit."""
    own = tool.load
    if load is None and (own is None or own.mass == 0):
        return NO_PAYLOAD
    if load is None and own is not None:
        if own.axes == _UNTURNED:
            return own.mass, own.centre, (*own.inertia, 0.0, 0.0, 0.0)
        return own.mass, own.centre, _tensor(Inertia.of_load(own))
    carried = carried_inertia(tool, load)
    if carried.mass == 0:
        return NO_PAYLOAD
    return carried.mass, carried.centre, _tensor(carried)


def _tensor(body: Inertia) -> tuple[float, ...]:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.tensor
    values = (xx, yy, zz, xy, xz, yz)
    largest = max(map(abs, values))
    if largest == 0:
        return (0.0,) * 6
    step = 10.0**-_DIGITS * largest
    return tuple(float(f"{value:.{_DIGITS}g}") if abs(value) > step else 0.0 for value in values)
