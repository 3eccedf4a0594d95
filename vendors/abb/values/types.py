"""RAPID's data types: what a value of each looks like, and which component stands where.

Values are Python's: ``num`` and ``dnum`` are float, ``bool`` bool, ``string`` str, records and
arrays tuples in RAPID's own order and units, as `records` takes them. Numbers are kept in double
precision, where a controller keeps a ``num`` in single.

Component names: "RAPID Reference Manual", data types.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from ....core.door import spelt
from ....core.errors import SourceError, Span
from .records import Record


@dataclass(frozen=True, slots=True)
class Unknown:
    """A value that only the running controller has.

    Args:
        reason: what it is and why it is not known, to stand in a message.
        span: where it came into the program.
        key: under which the user may answer it.
        nominal: what it is if all that is not known is at its default; None if that is none.
        lost: whether no default can be taken for it, nor for what is made of it: the text that
            gives it is damaged, or it is where the robot stands.
    """

    reason: str
    span: Span
    key: str = ""
    nominal: Value | None = None
    lost: bool = False


Value = float | bool | str | Record | Unknown


@dataclass(frozen=True, slots=True)
class Scalar:
    """``num``, ``dnum``, ``bool`` or ``string``.

    Args:
        default: of a variable without an initial value.
    """

    name: str
    python: type
    default: float | bool | str


@dataclass(frozen=True, slots=True)
class RecordType:
    """A record: component names and their types, in order."""

    name: str
    components: Mapping[str, Type]
    numeric: bool = field(init=False, compare=False)
    """Whether all components are nums."""

    def __post_init__(self) -> None:
        kinds = [getattr(c, "python", None) for c in self.components.values()]
        object.__setattr__(self, "numeric", all(kind is float for kind in kinds))

    @property
    def default(self) -> Record:
        """The value of a variable without an initial value."""
        return tuple(
            Unknown(f"a {c.name}", NOWHERE) if isinstance(c, Foreign) else c.default
            for c in self.components.values()
        )


@dataclass(frozen=True, slots=True)
class Foreign:
    """A type whose values are not interpreted: signals, clocks, interrupts, sockets, …"""

    name: str


Type = Scalar | RecordType | Foreign

NOWHERE = Span("", 1, 1, 0, 0)

NUM = Scalar("num", float, 0.0)
DNUM = Scalar("dnum", float, 0.0)
BOOL = Scalar("bool", bool, False)
STRING = Scalar("string", str, "")


def _record(name: str, **components: Type) -> RecordType:
    return RecordType(name, MappingProxyType(components))


def _numbers(name: str, components: str) -> RecordType:
    return RecordType(name, MappingProxyType(dict.fromkeys(components.split(), NUM)))


POS = _numbers("pos", "x y z")
ORIENT = _numbers("orient", "q1 q2 q3 q4")
POSE = _record("pose", trans=POS, rot=ORIENT)
CONFDATA = _numbers("confdata", "cf1 cf4 cf6 cfx")
EXTJOINT = _numbers("extjoint", "eax_a eax_b eax_c eax_d eax_e eax_f")
ROBJOINT = _numbers("robjoint", "rax_1 rax_2 rax_3 rax_4 rax_5 rax_6")
ROBTARGET = _record("robtarget", trans=POS, rot=ORIENT, robconf=CONFDATA, extax=EXTJOINT)
JOINTTARGET = _record("jointtarget", robax=ROBJOINT, extax=EXTJOINT)
SPEEDDATA = _numbers("speeddata", "v_tcp v_ori v_leax v_reax")
ZONEDATA = _record(
    "zonedata",
    finep=BOOL,
    pzone_tcp=NUM,
    pzone_ori=NUM,
    pzone_eax=NUM,
    zone_ori=NUM,
    zone_leax=NUM,
    zone_reax=NUM,
)
INPOSDATA = _numbers("inposdata", "position speed mintime maxtime")
STOPPOINTDATA = _record(
    "stoppointdata",
    type=NUM,
    progsynch=BOOL,
    inpos=INPOSDATA,
    stoptime=NUM,
    followtime=NUM,
    signal=STRING,
    relation=NUM,
    checkvalue=NUM,
)
LOADDATA = _record("loaddata", mass=NUM, cog=POS, aom=ORIENT, ix=NUM, iy=NUM, iz=NUM)
TOOLDATA = _record("tooldata", robhold=BOOL, tframe=POSE, tload=LOADDATA)
WOBJDATA = _record("wobjdata", robhold=BOOL, ufprog=BOOL, ufmec=STRING, uframe=POSE, oframe=POSE)

BUILT_IN: Mapping[str, Type] = MappingProxyType(
    {
        t.name: t
        for t in (
            *(NUM, DNUM, BOOL, STRING, POS, ORIENT, POSE, CONFDATA, EXTJOINT, ROBJOINT),
            *(ROBTARGET, JOINTTARGET, SPEEDDATA, ZONEDATA, LOADDATA, TOOLDATA, WOBJDATA),
            *(INPOSDATA, STOPPOINTDATA),
        )
    }
    # Types that are another one under a new name.
    | dict.fromkeys(("errnum", "opnum", "btnres", "icondata", "byte"), NUM)
)
"""name → type; whatever is not here, and not declared by the program, is `Foreign`."""


def interpreted(value: Value, type_: Type, span: Span) -> Value:
    """The value, unknown if its type is `Foreign`: components of those have no known places."""
    if isinstance(value, Unknown):
        return value
    if isinstance(type_, Foreign) and type_.name != "switch":
        return Unknown(f"a {type_.name}", span)
    return value


def find_unknown(value: Value) -> Unknown | None:
    """The first part of a value that is not known, of those that are lost if there is one."""
    if isinstance(value, Unknown):
        return value
    first = None
    if isinstance(value, tuple):
        for part in value:
            found = find_unknown(part)
            if found is not None and (first is None or found.lost):
                first = found
                if found.lost:
                    break
    return first


_FLOATS = {float}


def mismatch(value: Value, type_: Type) -> str | None:
    """What keeps a value from being of a type, None if nothing does; unknown parts fit all."""
    if isinstance(value, Unknown) or isinstance(type_, Foreign):
        return None
    if isinstance(type_, Scalar):
        if type(value) is type_.python:
            return None
        return f"a {type_.name} is wanted, not {describe(value)}"
    count = len(type_.components)
    if not isinstance(value, tuple):
        return f"a {type_.name} of {count} components is wanted, not {describe(value)}"
    if len(value) != count:
        return f"a {type_.name} has {count} components, not {len(value)}"
    if type_.numeric and set(map(type, value)) == _FLOATS:
        return None
    for part, (name, component) in zip(value, type_.components.items(), strict=True):
        found = mismatch(part, component)
        if found is not None:
            return f"{type_.name}.{name}: {found}"
    return None


def describe(value: Value) -> str:
    """A value, for a message."""
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, str):
        return f'"{value[:40]}"'
    if isinstance(value, Unknown):
        return value.reason
    return f"{len(value)} values in brackets"


def refuse_unknown(unknown: Unknown, use: str, span: Span) -> SourceError:
    """The error that a value only the running controller has is needed, and has no default.

    Args:
        use: what depends on it, to stand at the beginning of a message.
    """
    return SourceError(
        f"{use} depends on {unknown.reason}: what only the running controller knows cannot be "
        f"followed; put a fixed value in its place{answerable(unknown)}",
        span,
    )


def check_known(value: Value, use: str, span: Span) -> None:
    """Refuse a value that only the running controller has.

    Raises:
        SourceError: a part of it is not known.
    """
    unknown = find_unknown(value)
    if unknown is not None:
        raise refuse_unknown(unknown, use, span)


def check_type(
    value: Value, type_: Type, use: str, span: Span, own: Type | None = None, name: str = ""
) -> None:
    """Refuse a known value of another type.

    Args:
        own: type of the datum that has the value, None if it is none or that is not known.

    Raises:
        SourceError: it is none of ``type_``.
    """
    wrong = mismatch(value, type_)
    if wrong is not None and own is not None and own != type_:
        wrong = f"{name} is a {own.name}, a {type_.name} is wanted"
    if wrong is not None:
        raise SourceError(f"{use}: {wrong}", span)


def answerable(unknown: Unknown) -> str:
    """How the user may answer it, to stand at the end of a message."""
    if not unknown.key:
        return ""
    return f'; answer it in a file ({spelt("answers")}): [values] "{unknown.key}" = …'
