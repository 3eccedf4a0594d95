"""What answers to a script's questions look like: in words, and by an example."""

from __future__ import annotations

import re
from collections.abc import Collection

from ....core.program.question import Answer
from ..syntax.tree import Call, Expression, MethodCall, Number

Expected = tuple[str, Answer]

_POSE = "p[0, 0, 0, 0, 0, 0]"
_SIX = (0.0,) * 6
EXPECTED: dict[str, Expected] = {
    "truth": ("true or false", False),
    "whole": ("whole number", 0.0),
    "signal": ("number, or true or false", 0.0),
    "number": ("number", 0.0),
    "text": ("text", ""),
    "pose": ("pose, m and rad", _POSE),
    "joints": ("six joint values, rad", _SIX),
    "goal": ("pose (m and rad), or six joint values (rad)", _POSE),
    "six": ("six numbers", _SIX),
}
"""Kinds of values as an answer's, in words and by an example."""
_OF_SIX = ("pose", "joints", "goal", "six")
_SIX_READ = ("pose (m and rad), or six numbers", _POSE)
"""Of what six numbers are read one by one."""
_RECEIVED = "list: how many numbers have come, and the numbers"
_MOST = 100
"""Numbers of an example."""
_BY_NAME = tuple(
    (re.compile(pattern), kind)
    for pattern, kind in (
        (r"\w*(string|_line|_str)\w*|to_str|str_(at|sub|cat)", "text"),
        (r"\w*(digital|bool|flag|_bit)\w*|(is|has)_\w+|socket_(open|send\w*|set_var)", "truth"),
        (r"\w*(integer|_int|port_register)\w*|socket_get_var|str_(len|find)", "whole"),
        (r"\w*_(state|mode|tick_count)|tool_contact", "whole"),
        (r"modbus_get_\w+|get_euromap_\w+|profinet_\w+", "signal"),
        (r"get_(actual|target)_joint_positions\w*|get_inverse_kin\w*", "joints"),
        (r"get_\w*(joint_(speeds|torques|accelerations)|tcp_(force|speed))\w*", "six"),
        (r"get_\w*(tcp_pose|flange_pose|tcp_offset)\w*|get_forward_kin\w*|wrench_trans", "pose"),
        (r"\w*(analog|float|force|steptime)\w*|time|random|norm|pose_dist|to_num", "number"),
    )
)


def returned_by(call: Call | MethodCall) -> Expected | None:
    """What a function of the controller returns, by its name; None if that is not known."""
    if re.fullmatch(r"socket_read_(ascii_float|binary_integer|byte_list)", call.name):
        count = _count(call.arguments[0].value) if call.arguments else 1
        return _RECEIVED, (float(count), *((0.0,) * count))
    kind = next((kind for pattern, kind in _BY_NAME if pattern.fullmatch(call.name)), None)
    return None if kind is None else EXPECTED[kind]


def _count(expression: Expression) -> int:
    """How many numbers an argument asks for, where it is written as a number."""
    if not isinstance(expression, Number) or not 1 <= expression.value <= _MOST:
        return 1
    return int(expression.value)


def used(kind: str, depth: int, count: int) -> Expected:
    """What was asked for, of which an element is used.

    Args:
        kind: of `EXPECTED`; of the element.
        depth: indices that lead to it; 0 where the whole is used.
        count: elements of the whole that are known to be there.
    """
    if (kind, depth, count) == ("number", 1, len(_SIX)):
        return _SIX_READ
    expected = EXPECTED[kind]
    for level in range(depth, 0, -1):
        words, example = expected
        expected = (
            f"list of: {words}",
            (example,) * (min(max(2, count), _MOST) if level == 1 else 2),
        )
    return expected


def vaguer(kind: str, depth: int) -> Collection[str]:
    """Words for what may turn out to be of a kind: numbers of which more are read, or all at
    once."""
    more = (kind, depth) == ("number", 1) or (kind in _OF_SIX and not depth)
    return (used("number", 1, 0)[0], _SIX_READ[0]) if more else ()
