"""A ``.urpx`` of PolyScope X: JSON that holds application and program with the code made of them.

Both have ``urscript.script``; the application's contributions ``ur-end-effector``, ``ur-frames``
and ``ur-mounting`` state TCPs, payloads, frames and how the base stands. Values come with units.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import Any

from ....core.errors import InputError
from .emission import GENERATED
from .installation import Feature, Installation, Payload, Six

_UNITS = {
    "m": 1.0,
    "cm": 1e-2,
    "mm": 1e-3,
    "in": 0.0254,
    "rad": 1.0,
    "deg": math.pi / 180,
    "kg": 1.0,
    "g": 1e-3,
    "lb": 0.45359237,
    "kg*m^2": 1.0,
}
_OWN_FRAMES = frozenset({"base", "tcp", "world", "flange", "tool"})
_COORDINATES = "x", "y", "z", "rx", "ry", "rz"
_INERTIA = "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz"


def content_of(plain: bytes, name: str) -> dict[str, Any]:
    """What a file of PolyScope X holds.

    Raises:
        InputError: it is damaged, or none.
    """
    try:
        data = json.loads(plain)
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{name}: its JSON is damaged ({str(error) or 'nested too deeply'}); export it again"
        ) from None
    if not isinstance(data, dict) or not {"application", "program"} & set(data):
        raise InputError(f"{name}: is no program of PolyScope X: it has no application or program")
    return data


def script_in(content: dict[str, Any], name: str) -> str:
    """The code of a program, the application's before it.

    Raises:
        InputError: it holds none.
    """
    parts = {key: list(_scripts(content.get(key))) for key in ("application", "program")}
    program = "\n".join(parts["program"])
    if not program.strip():
        raise InputError(
            f"{name}: holds no code of its program: open it in PolyScope X and save it again"
        )
    application = [one for one in parts["application"] if one.strip() and one not in program]
    return GENERATED + "\n".join([*application, program, ""])


def installation_in(content: dict[str, Any]) -> Installation:
    """What the application states, in the words of installations."""
    effectors = _contribution(content, "ur-end-effector")
    tcps: dict[str, Six] = {}
    payloads: dict[str, Payload] = {}
    active = payload = None
    default = _part(effectors, "defaultTcp", {})
    for effector in _parts(effectors, "endEffectors"):
        own = _payload(effector)
        name = str(effector.get("name", ""))
        if own is not None and name:
            payloads[name] = own
            if effector.get("id") == _part(default, "endEffectorId", None):
                payload = name
        for tcp in _parts(effector, "tcps"):
            offset = _values(tcp, _COORDINATES)
            if offset is None or not tcp.get("name"):
                continue
            tcps[str(tcp["name"])] = offset
            if tcp.get("id") == _part(default, "tcpId", None):
                active = str(tcp["name"])
    mounting = _part(_contribution(content, "ur-mounting"), "mounting", {})
    return Installation(
        tcps=tcps,
        active=active,
        payloads=payloads,
        payload=payload,
        features=dict(_frames(content)),
        tilt=_value(_part(mounting, "tiltAngle", 0.0)) or 0.0,
        turn=_value(_part(mounting, "baseAngle", 0.0)) or 0.0,
        version="PolyScope X",
    )


def _scripts(value: Any) -> Iterator[str]:
    """Every text ``urscript.script`` below a value, in order; without recursion."""
    pending = [value]
    while pending:
        one = pending.pop()
        if isinstance(one, dict):
            script = _part(one.get("urscript"), "script", None)
            if isinstance(script, str):
                yield script
            pending += [inner for key, inner in reversed(one.items()) if key != "urscript"]
        elif isinstance(one, list):
            pending += reversed(one)


def _contribution(content: dict[str, Any], kind: str) -> Any:
    """A contribution of the application by its type; an empty one if there is none."""
    pending = [content.get("application")]
    while pending:
        one = pending.pop()
        if isinstance(one, dict):
            if one.get("type") == kind:
                return one
            pending += one.values()
        elif isinstance(one, list):
            pending += one
    return {}


def _part(value: Any, name: str, other: Any) -> Any:
    return value.get(name, other) if isinstance(value, dict) else other


def _parts(value: Any, name: str) -> list[dict[str, Any]]:
    found = _part(value, name, [])
    return [one for one in found if isinstance(one, dict)] if isinstance(found, list) else []


def _value(stated: Any) -> float | None:
    """A number with its unit, in SI."""
    factor: float | None = 1.0
    if isinstance(stated, dict):
        factor, stated = _UNITS.get(str(stated.get("unit", "m"))), stated.get("value")
    if factor is None or isinstance(stated, bool) or not isinstance(stated, int | float):
        return None
    try:
        value = factor * float(stated)
    except OverflowError:
        return None
    return value if math.isfinite(value) else None


def _values(stated: Any, names: tuple[str, ...]) -> tuple[float, ...] | None:
    values = [_value(_part(stated, name, None)) for name in names]
    known = [value for value in values if value is not None]
    return tuple(known) if len(known) == len(names) else None


def _payload(effector: dict[str, Any]) -> Payload | None:
    mass = _value(_part(effector.get("payload"), "weight", None))
    if mass is None or mass < 0.0:
        return None
    centre = _values(effector.get("cog"), ("cx", "cy", "cz")) or (0.0, 0.0, 0.0)
    return Payload(mass, centre, _values(effector.get("inertia"), _INERTIA))


def _frames(content: dict[str, Any]) -> Iterator[tuple[str, Feature]]:
    """Frames that stand in the base."""
    for frame in _parts(_contribution(content, "ur-frames"), "framesList"):
        name = str(frame.get("name", ""))
        if name.casefold() in _OWN_FRAMES or frame.get("parent") not in ("base", None):
            continue
        pose = frame.get("pose")
        places = [_part(pose, "position", None), _part(pose, "orientation", None)]
        six = [_value(one) for place in places if isinstance(place, list) for one in place]
        known = [one for one in six if one is not None]
        if name and len(known) == len(six) == len(_COORDINATES):
            yield name, Feature(tuple(known), variable=True)
