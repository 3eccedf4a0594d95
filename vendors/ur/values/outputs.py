"""Outputs, flags and registers: what the program has set them to is known to it afterwards.

"The URScript Programming Language", module interfaces. Analogue outputs are set as a share of their
range and read in volts or ampere; Modbus signals and ports for fieldbuses are written by others,
too: what these hold is not known.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from ....core.source.execution.outputs import Outputs
from ..syntax.tree import Call, Number
from .values import Value, is_number

_MOST = 256
"""More than there are of any kind."""
_TOOL_FIRST = 8
"""``set_digital_out`` numbers the tool's outputs from here on, behind the standard ones."""

_KINDS = {
    "digital_out": "",
    "standard_digital_out": "standard",
    "configurable_digital_out": "configurable",
    "tool_digital_out": "tool",
    "flag": "flag",
    "euromap_output": "euromap",
}
_REGISTERS = ("boolean", "integer", "float")

WRITING: dict[str, str] = {
    **{f"set_{name}": kind for name, kind in _KINDS.items()},
    **{f"write_output_{kind}_register": f"{kind} register" for kind in _REGISTERS},
}
"""Function that writes an output → kind of the output; "" for standard and tool ones by number."""
READING: dict[str, str] = {
    **{f"get_{name}": kind for name, kind in _KINDS.items()},
    **{f"read_output_{kind}_register": f"{kind} register" for kind in _REGISTERS},
}
"""Function that reads one, likewise."""


def write(outputs: Outputs, function: str, values: Sequence[Value]) -> None:
    """A call of a function of `WRITING` has been carried out."""
    kind = WRITING[function]
    name = _name(kind, values[0]) if len(values) == 2 else None
    if name is None:
        outputs.forget()  # it may be any of them
        return
    value = values[1]
    known = value if isinstance(value, bool) or is_number(value) else None
    outputs.write(name, known)


def held(outputs: Outputs, function: str, values: Sequence[Value]) -> Value | None:
    """What a call of a function of `READING` gives; None if it is not known."""
    name = _name(READING[function], values[0]) if len(values) == 1 else None
    return None if name is None else outputs.value(name)


def written_by(calls: Iterable[Call]) -> set[str]:
    """Names of the outputs that calls may write: any of a kind where the number is computed."""
    return _named_in(calls, WRITING)


def read_by(calls: Iterable[Call]) -> set[str]:
    """Names of the outputs that calls may read, likewise."""
    return _named_in(calls, READING)


def _named_in(calls: Iterable[Call], kinds_of: Mapping[str, str]) -> set[str]:
    found: set[str] = set()
    for call in calls:
        kind = kinds_of.get(call.name)
        if kind is None:
            continue
        index = call.arguments[0].value if call.arguments else None
        name = _name(kind, index.value) if isinstance(index, Number) else None
        if name is None:
            kinds = (kind,) if kind else ("standard", "tool")
            found.update(f"{kind} {number}" for kind in kinds for number in range(_MOST))
        else:
            found.add(name)
    return found


def _name(kind: str, index: Value) -> str | None:
    if not is_number(index) or index != int(index):
        return None
    number = int(index)
    if not kind:
        kind = "standard"
        if number >= _TOOL_FIRST:
            kind, number = "tool", number - _TOOL_FIRST
    return f"{kind} {number}"
