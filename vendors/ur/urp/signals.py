"""Names that PolyScope gives to signals, as calls of URScript."""

from __future__ import annotations

import re

_PIN = re.compile(r"\s*(?P<kind>\w+?)\s*\[(?P<index>\d+)\]\s*")
_TOOL_ANALOG = 2
"""From this number on analog inputs are the tool's."""
_READ = {
    "digital_in": "get_standard_digital_in",
    "config_in": "get_configurable_digital_in",
    "tool_in": "get_tool_digital_in",
    "analog_in": "get_standard_analog_in",
    "digital_out": "get_standard_digital_out",
    "config_out": "get_configurable_digital_out",
    "tool_out": "get_tool_digital_out",
    "analog_out": "get_standard_analog_out",
    "GP_bool_in": "read_input_boolean_register",
    "GP_int_in": "read_input_integer_register",
    "GP_float_in": "read_input_float_register",
    "GP_bool_out": "read_output_boolean_register",
    "GP_int_out": "read_output_integer_register",
    "GP_float_out": "read_output_float_register",
}
_WRITE = {
    "digital_out": "set_standard_digital_out",
    "config_out": "set_configurable_digital_out",
    "tool_out": "set_tool_digital_out",
    "analog_out": "set_standard_analog_out",
    "GP_bool_out": "write_output_boolean_register",
    "GP_int_out": "write_output_integer_register",
    "GP_float_out": "write_output_float_register",
}


def read_signal(name: str) -> str:
    """The value of a signal; of one that is none of the controller's own, a variable's name."""
    found = _PIN.fullmatch(name)
    if found is None or found["kind"] not in _READ:
        return re.sub(r"\W", "_", name)
    kind, index = found["kind"], int(found["index"])
    if kind == "analog_in" and index >= _TOOL_ANALOG:
        return f"get_tool_analog_in({index - _TOOL_ANALOG})"
    return f"{_READ[kind]}({index})"


def set_signal(name: str, value: str) -> str | None:
    """The call that sets a signal; None for one that is none of the controller's own."""
    found = _PIN.fullmatch(name)
    if found is None or found["kind"] not in _WRITE:
        return None
    return f"{_WRITE[found['kind']]}({int(found['index'])}, {value})"
