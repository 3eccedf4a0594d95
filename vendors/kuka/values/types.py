"""Data types, and how a value becomes one of a type.

Sources: KUKA "Quickguide KRL-Syntax" (scalar types), published programs (predefined structures and
the inline forms' FDAT, PDAT, LDAT).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping

from ....core.errors import InputError
from ....core.robot.model import Robot
from .values import Array, Choice, Real, Struct, Unknown, Value, Whole, leaf_of, shown

FRAME_FIELDS = ("x", "y", "z", "a", "b", "c")
AXIS_FIELDS = ("a1", "a2", "a3", "a4", "a5", "a6")
EXTERNAL_FIELDS = ("e1", "e2", "e3", "e4", "e5", "e6")
_E = re.compile(r"E([1-6])", re.IGNORECASE)


def external_fields(robot: Robot | None) -> tuple[str, ...]:
    """The components of positions that a robot's external axes have, in their order: by the axis's
    number, or a name as ``E3``; else the one behind that of the axis before.

    Raises:
        InputError: two are the same, or there is none of the number.
    """
    found: list[str] = []
    place = 0
    for axis in () if robot is None else robot.external_axes:
        called = _E.fullmatch(axis.name)
        place = axis.number or (int(called[1]) if called else place + 1)
        name = f"e{place}"
        if name in found or place > len(EXTERNAL_FIELDS):
            raise InputError(
                f"external axis {axis.name} is {name.upper()} of positions, "
                + ("as another one is" if name in found else "of which KRL has six")
                + ": give it another number"
            )
        found.append(name)
    return tuple(found)


class KrlTypeError(Exception):
    """A value is of another type than is wanted; the message says both."""


def no_component(type_name: str, name: str, fields: Iterable[str]) -> KrlTypeError:
    """The error that a structure has no such component."""
    known = ", ".join(field.upper() for field in fields)
    return KrlTypeError(f"{type_name.upper()} has no component {name.upper()} (it has {known})")


def _fields(text: str) -> dict[str, str]:
    """``"real a b int c"`` → type by component."""
    found: dict[str, str] = {}
    type_name = ""
    for word in text.split():
        if word.startswith("@"):
            type_name = word[1:]
        else:
            found[word] = type_name
    return found


_FRAME = "@real x y z a b c "
_EXTERNAL = "@real e1 e2 e3 e4 e5 e6 "
PREDEFINED: dict[str, dict[str, str]] = {
    "frame": _fields(_FRAME),
    "pos": _fields(_FRAME + "@int s t"),
    "e3pos": _fields(_FRAME + "@int s t @real e1 e2 e3"),
    "e6pos": _fields(_FRAME + "@int s t " + _EXTERNAL),
    "axis": _fields("@real a1 a2 a3 a4 a5 a6"),
    "e3axis": _fields("@real a1 a2 a3 a4 a5 a6 e1 e2 e3"),
    "e6axis": _fields("@real a1 a2 a3 a4 a5 a6 " + _EXTERNAL),
    "cp": _fields("@real cp ori1 ori2"),
    "jerk_struc": _fields("@real cp ori"),
    # CPTP and CVEL are INT on the controller; emulation has no reason to round them.
    "apo": _fields("@real cptp cdis cori cvel @ ptp_mode cp_mode"),
    "inertia": _fields("@real x y z"),
    "load": _fields("@real m @frame cm @inertia j"),
    "fdat": _fields("@int tool_no base_no @ ipo_frame point2 @bool tq_state"),
    "pdat": _fields("@real vel acc apo_dist @ apo_mode @real gear_jerk @int exax_ign"),
    "ldat": _fields(
        "@real vel acc apo_dist apo_fac axis_vel axis_acc @ ori_typ circ_typ "
        "@real jerk_fac gear_jerk @int exax_ign @ cb"
    ),
    "machine_def_t": _fields("@ name coop_krc_index parent geometry @char mech_type @frame root"),
}
"""Type of each component by structure; "" where any value is kept as it is."""

POSES = frozenset({"frame", "pos", "e3pos", "e6pos"})
AXES = frozenset({"axis", "e3axis", "e6axis"})

Types = Mapping[str, Mapping[str, str]]


def convert(value: Value, type_name: str, types: Types) -> Value:
    """The value as one of a type; types that are not known take every value.

    Raises:
        KrlTypeError: it cannot be one.
    """
    if type_name == "real":
        return _real(value)
    if isinstance(value, Unknown) or not type_name:
        return value
    if type_name == "int":
        return _int(value)
    if type_name == "bool":
        if not isinstance(value, bool):
            raise KrlTypeError(f"a BOOL is wanted, not {shown(value)}")
        return value
    if type_name == "char":
        if not isinstance(value, str | int):
            raise KrlTypeError(f"a CHAR is wanted, not {shown(value)}")
        return value
    fields = types.get(type_name)
    if fields is None:
        return value
    if not isinstance(value, Struct):
        raise KrlTypeError(f"a {type_name.upper()} is wanted, not {shown(value)}")
    return _struct(value, type_name, fields, types)


def _real(value: Value) -> Value:
    if isinstance(value, float):
        return value
    if isinstance(value, bool) or not isinstance(value, int):
        if isinstance(value, Unknown):
            return value
        raise KrlTypeError(f"a number is wanted, not {shown(value)}")
    leaf = leaf_of(value)
    return float(value) if leaf is None else Real.at(float(value), leaf)


def _int(value: Value) -> Value:
    if isinstance(value, str) and len(value) == 1:
        return ord(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise KrlTypeError(f"a whole number is wanted, not {shown(value)}")
    if isinstance(value, int):
        return value
    if not math.isfinite(value) or abs(value) >= 2**31:
        raise KrlTypeError(f"{shown(value)} is too large for an INT")
    leaf = leaf_of(value)
    whole = math.floor(value + 0.5)
    return whole if leaf is None or whole != value else Whole.at(whole, leaf)


def _struct(value: Struct, type_name: str, fields: Mapping[str, str], types: Types) -> Struct:
    """A structure of the type; components that it has not are dropped between positions."""
    if value.type == type_name:
        return value.copy()
    made: dict[str, Value] = {}
    for name, part in value.fields.items():
        wanted = fields.get(name)
        if wanted is None:
            if value.type and type_name in POSES | AXES:
                continue  # an E6POS handed to a POS or FRAME
            raise no_component(type_name, name, fields)
        if (wanted == "real" and isinstance(part, float)) or wanted in ("", "char"):
            made[name] = part
            continue
        if isinstance(part, Array | Choice):
            made[name] = part
            continue
        try:
            made[name] = convert(part, wanted, types)
        except KrlTypeError as error:
            raise KrlTypeError(f"component {name.upper()}: {error}") from None
    return Struct(type_name, made, value.label, value.shipped, value.moved_by)


def default(type_name: str, types: Types) -> Value | None:
    """What a datum holds before anything is assigned to it; None for a scalar."""
    return Struct(type_name) if type_name in types else None
