"""URScript's values.

Numbers, strings, booleans and None are Python's, lists are tuples, so that a value once read never
changes: URScript copies lists, too. What is more stands here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypeGuard

from ....core.errors import Span
from ....core.program.target import Configuration
from ....core.spatial.pose import Pose

LONGEST = 10_000
"""Elements of a list, and characters of a string; controllers hold a tenth of it."""
DEEPEST = 4
"""Lists inside each other; URScript has lists of poses and matrices."""


@dataclass(frozen=True, slots=True)
class Unknown:
    """A value that only the running controller has.

    Args:
        reason: what it is and why it is not known, to stand in a message.
        span: where it came into the program.
        held: what a move takes it for: what was computed with zero in its place; None if there is
            no such value.
        damaged: a line that is no statement would have set it: a move takes it for nothing.
        key: under which it was asked for, as it stands in the program; empty if it was not.
        depth: of what was asked for it is an element: how many indices lead there.
    """

    reason: str
    span: Span
    held: Value = None
    damaged: bool = False
    key: str = ""
    depth: int = 0


@dataclass(frozen=True, slots=True)
class AtStart(Unknown):
    """The joints of the robot before the first move: nobody knows where it stands."""


class UrPose(NamedTuple):
    """``p[x, y, z, rx, ry, rz]``: m, and a rotation vector in rad."""

    x: Value
    y: Value
    z: Value
    rx: Value
    ry: Value
    rz: Value


@dataclass(frozen=True, slots=True)
class Struct:
    """``struct(name=value, …)``"""

    names: tuple[str, ...]
    values: tuple[Value, ...]

    def get(self, name: str) -> Value:
        """The value of a part; KeyError if there is none of that name."""
        if name not in self.names:
            raise KeyError(name)
        return self.values[self.names.index(name)]

    def with_part(self, name: str, value: Value) -> Struct:
        """The struct with a part changed; KeyError as `get`."""
        self.get(name)
        pairs = zip(self.names, self.values, strict=True)
        return Struct(self.names, tuple([value if n == name else v for n, v in pairs]))


@dataclass(frozen=True, slots=True)
class PendingInverse:
    """What ``get_inverse_kin`` returns, before anybody asks for its numbers.

    Args:
        pose: of the TCP that was asked for.
        tcp: that TCP in the flange's frame.
        near: ``qnear``, or where the robot stood; None if neither is known.
    """

    pose: Pose
    tcp: Pose
    near: Configuration | None
    span: Span


@dataclass(frozen=True, slots=True)
class ThreadHandle:
    """What ``run`` returns.

    Args:
        number: of the run, from 1; 0 is False, as scripts test it.
    """

    name: str
    number: int


Value = (
    int
    | float
    | bool
    | str
    | None
    | tuple["Value", ...]
    | UrPose
    | Struct
    | Unknown
    | PendingInverse
    | ThreadHandle
)


class ValueFault(Exception):
    """Values that do not go together; whoever knows the place makes a SourceError of it."""


def is_number(value: Value) -> TypeGuard[float]:
    """Whether a value is an int or a float, and no bool."""
    return type(value) is float or type(value) is int


def numbers(value: Value, count: int | None = None) -> list[float] | None:
    """The numbers of a list or pose of nothing but known numbers; None if it is no such thing.

    Args:
        count: how many there must be; None for any number.
    """
    if not isinstance(value, tuple) or (count is not None and len(value) != count):
        return None
    found = [float(v) for v in value if type(v) is float or type(v) is int]
    return found if len(found) == len(value) else None


def find_unknown(value: Value) -> Unknown | None:
    """The first part of a value that is not known."""
    if isinstance(value, Unknown):
        return value
    parts: tuple[Value, ...] = ()
    if isinstance(value, tuple):
        parts = value
    elif isinstance(value, Struct):
        parts = value.values
    for part in parts:
        if type(part) is not float:
            found = find_unknown(part)
            if found is not None:
                return found
    return None


def supposed(value: Value) -> Value:
    """What a move takes a value for that is not known, as far as there is something."""
    if isinstance(value, Unknown):
        return value if value.held is None or value.damaged else supposed(value.held)
    if isinstance(value, UrPose):
        return UrPose(*map(supposed, value))
    return tuple(map(supposed, value)) if isinstance(value, tuple) else value


def checked(value: Value) -> Value:
    """A value that operators or functions made, if the language can hold it.

    Raises:
        ValueFault: it is not finite, or too large.
    """
    if type(value) is float:
        if value - value != 0.0:
            raise ValueFault("there is no finite result")
    elif type(value) is int:
        if not -(2**63) <= value < 2**64:
            raise ValueFault("the result is too large for an integer")
    elif isinstance(value, str):
        if len(value) > LONGEST:
            raise ValueFault(f"the string is longer than {LONGEST} characters")
    elif isinstance(value, tuple):
        if len(value) > LONGEST:
            raise ValueFault(f"the list is longer than {LONGEST} elements")
        if _depth(value) > DEEPEST:
            raise ValueFault(f"more than {DEEPEST} lists inside each other")
    return value


def _depth(value: Value) -> int:
    """Lists inside each other; never looks deeper than one of more than `DEEPEST` can be."""
    depth = 0
    level: list[Value] = [value]
    while level and depth <= DEEPEST:
        level = [part for item in level if isinstance(item, tuple) for part in _nested(item)]
        depth += 1
    return depth


def _nested(value: tuple[Value, ...]) -> list[Value]:
    return [part for part in value if isinstance(part, tuple)]


def describe(value: Value) -> str:
    """A value, for a message."""
    if value is None or isinstance(value, bool):
        return str(value)
    if isinstance(value, int | float):
        return f"{value:g}"
    if isinstance(value, str):
        return f'"{value[:40]}"'
    if isinstance(value, Unknown):
        return value.reason
    if isinstance(value, UrPose):
        return "a pose"
    if isinstance(value, tuple):
        return f"a list of {len(value)}"
    if isinstance(value, Struct):
        return "a struct"
    return "a thread" if isinstance(value, ThreadHandle) else "joint values"


def shown(value: Value) -> str:
    """A value as ``to_str`` writes it."""
    if isinstance(value, str):
        return value
    if isinstance(value, UrPose):
        return f"p[{', '.join(map(shown, value))}]"
    if isinstance(value, tuple):
        return f"[{', '.join(map(shown, value))}]"
    if isinstance(value, bool) or value is None or isinstance(value, int | float):
        return str(value)
    return describe(value)
