"""What holds until it is changed: TCP and payload.

Source: "The URScript Programming Language", module internals: set_tcp, set_payload,
set_payload_mass, set_payload_cog, set_target_payload.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

from ....core.errors import InputError
from ....core.program.tool import FLANGE, Load, Tool
from ....core.spatial.pose import IDENTITY, Pose, Quaternion, Vector3
from ..syntax.tree import Call
from ..values.answers import used_as
from ..values.arguments import bind
from ..values.evaluator import Evaluation, evaluate
from ..values.instructions import Kept
from ..values.located import NOTHING, Located
from ..values.poses import pose_of
from ..values.scope import Scope
from ..values.values import (
    Unknown,
    Value,
    ValueFault,
    describe,
    find_unknown,
    is_number,
    numbers,
)

DEFAULT_NAME = "tcp"


@dataclass(frozen=True)
class Settings:
    """TCP and payload in force; values, so that every move keeps its own.

    Args:
        tcp: in the flange's frame.
        name: of the TCP.
        mass: payload with the tool, kg.
        centre: its centre of gravity in the flange's frame, m; None for the TCP.
        inertia: its inertia about the centre, Ixx, Iyy, Izz, Ixy, Ixz, Iyz, kg m².
        stated: whether the program has set the TCP.
        unknown: what the TCP depends on, if that is not known.
        supposed: what the TCP depends on, if a way that was chosen by rule has set it.
        load_lost: the damaged line that would have set the payload; None if there is none.
    """

    tcp: Pose = IDENTITY
    name: str = FLANGE.name
    mass: float = 0.0
    centre: Vector3 | None = None
    inertia: tuple[float, ...] = (0.0,) * 6
    stated: bool = False
    unknown: Unknown | None = None
    supposed: str = ""
    load_lost: Unknown | None = None

    @cached_property
    def tool(self) -> Tool:
        """The tool of moves; all that the flange carries is its load."""
        return Tool(self.name, self.tcp, self._load())

    def _load(self) -> Load | None:
        if self.mass == 0:
            return None
        centre = self.tcp.position if self.centre is None else self.centre
        moments, axes = _principal(self.inertia)
        return Load(self.mass, centre, moments, axes)


def mass_of(value: Value) -> float:
    """A payload's mass, kg.

    Raises:
        ValueFault: it is none.
    """
    if not is_number(value) or float(value) < 0:
        raise ValueFault(f"the mass is a number of kg, not {describe(value)}")
    return float(value)


def centre_of(value: Value) -> Vector3:
    """A centre of gravity ``[x, y, z]``, m.

    Raises:
        ValueFault: it is none.
    """
    found = numbers(value, 3)
    if found is None:
        raise ValueFault(f"the centre of gravity is [x, y, z], not {describe(value)}")
    x, y, z = found
    return x, y, z


def inertia_of(value: Value) -> tuple[float, ...]:
    """``[Ixx, Iyy, Izz, Ixy, Ixz, Iyz]``, kg m².

    Raises:
        ValueFault: it is none.
    """
    found = numbers(value, 6)
    if found is None:
        raise ValueFault(f"the inertia is [Ixx, Iyy, Izz, Ixy, Ixz, Iyz], not {describe(value)}")
    return tuple(found)


def _principal(inertia: tuple[float, ...]) -> tuple[Vector3, Quaternion]:
    """Principal moments, kg m², and their axes."""
    xx, yy, zz, xy, xz, yz = inertia
    if not (xy or xz or yz):
        if min(xx, yy, zz) < 0:
            raise ValueFault("moments of inertia are not negative")
        return (xx, yy, zz), (1.0, 0.0, 0.0, 0.0)
    import numpy as np

    from ....core.spatial.rotation import quaternion_from_matrix

    moments, axes = np.linalg.eigh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
    if moments[0] < -1e-9:
        raise ValueFault("the matrix of inertia has a negative principal moment")
    if np.linalg.det(axes) < 0:
        axes = -axes
    a, b, c = (max(float(m), 0.0) for m in moments)
    w, x, y, z = (float(v) for v in quaternion_from_matrix(axes))
    return (a, b, c), (w, x, y, z)


# ------------------------------------------------------------------- calls that set them


class SettingsRun(Evaluation, Protocol):
    """What the calls that change settings ask of a run."""

    settings: Settings

    def keep(self, call: Call, entry: Kept, name: str) -> Value:
        """Keep a call as it stands; what it returns."""


Change = Callable[[Settings, dict[str, Value]], Settings]


def _set_tcp(settings: Settings, values: dict[str, Value]) -> Settings:
    name = values.get("tcp_name")
    return replace(
        settings,
        tcp=pose_of(values["pose"], "the TCP"),
        name=name if isinstance(name, str) and name else DEFAULT_NAME,
        stated=True,
        unknown=None,
        supposed="",
    )


def _set_payload(settings: Settings, values: dict[str, Value]) -> Settings:
    """Without a centre of gravity the TCP is it; the payload has no inertia of its own."""
    centre = centre_of(values["cog"]) if "cog" in values else None
    mass, inertia = mass_of(values["m"]), (0.0,) * 6
    return replace(settings, mass=mass, centre=centre, inertia=inertia, load_lost=None)


def _set_target_payload(settings: Settings, values: dict[str, Value]) -> Settings:
    inertia = inertia_of(values["inertia"]) if "inertia" in values else (0.0,) * 6
    return replace(_set_payload(settings, values), inertia=inertia)


def _set_payload_mass(settings: Settings, values: dict[str, Value]) -> Settings:
    return replace(settings, mass=mass_of(values["m"]))


def _set_payload_cog(settings: Settings, values: dict[str, Value]) -> Settings:
    return replace(settings, centre=centre_of(values["CoG"]))


_CALLS: dict[str, tuple[Change, tuple[str, ...], int]] = {
    "set_tcp": (_set_tcp, ("pose", "tcp_name"), 1),
    "set_payload": (_set_payload, ("m", "cog"), 1),
    "set_target_payload": (
        _set_target_payload,
        ("m", "cog", "inertia", "transition_time"),
        2,
    ),
    "set_payload_mass": (_set_payload_mass, ("m",), 1),
    "set_payload_cog": (_set_payload_cog, ("CoG", "transition_time"), 1),
}


_KINDS = {"pose": "pose", "m": "number"}
"""Of arguments, as `EXPECTED` has them."""
_UNKNOWN_PAYLOAD = Kept("set a payload that is not known, where the one before stays in force")


def change(run: SettingsRun, call: Call, scope: Scope) -> Located:
    """Carry out a call of `CALLS`.

    Raises:
        SourceError: its arguments are no such setting.
    """
    made, parameters, required = _CALLS[call.name]
    given = bind(call, parameters, required, run.texts)
    values = {name: evaluate(run, a.value, scope) for name, a in given.items()}
    for name, argument in given.items():
        if name in _KINDS:
            used_as(run, argument.value, values[name], _KINDS[name])
    unknown = find_unknown(tuple(values.values()))
    if unknown is not None and call.name == "set_tcp":
        run.settings = replace(run.settings, stated=True, unknown=unknown)
        return NOTHING
    if unknown is not None and unknown.damaged:
        run.settings = replace(run.settings, load_lost=unknown)
        return NOTHING
    if unknown is not None:
        run.keep(call, _UNKNOWN_PAYLOAD, call.name)
        return NOTHING
    try:
        run.settings = made(run.settings, values)
        if call.name == "set_tcp" and run.course.supposed:
            run.settings = replace(run.settings, supposed=run.course.supposed)
        _ = run.settings.tool
    except (ValueFault, InputError) as error:
        raise run.texts.stop_at(f"{call.name}: {error}", call) from None
    return NOTHING


def spoiled(settings: Settings, calls: frozenset[str], lost: Unknown) -> Settings:
    """The settings behind a damaged statement, which may have made some of `CALLS`."""
    if "set_tcp" in calls:
        settings = replace(settings, stated=True, unknown=lost)
    if calls - {"set_tcp"}:
        settings = replace(settings, load_lost=lost)
    return settings


CALLS = frozenset(_CALLS)
"""Names of the functions that `change` carries out."""
