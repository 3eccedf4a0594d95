"""Expressions, which PolyScope stores by token and character, as URScript.

    <ExpressionToken token="get_actual_tcp_pose"/> <ExpressionChar character="("/>
    <ExpressionVariable><ProgramVariable reference="../../../Assignment/variable"/></…>

What is unfinished is written as it is: the controller refuses it too.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from ..syntax.names import RESERVED
from .installation import BASE_FEATURE, TOOL_FEATURE
from .signals import read_signal
from .xml_file import Element, resolved

_SIGNS = {"≠": "!=", "≟": "==", "≤": "<=", "≥": ">=", "×": "*", "÷": "/", "−": "-", "\xa0": " "}
"""Keys of the pendant, and what the controller writes for them."""
_FEATURES = {BASE_FEATURE: "p[0, 0, 0, 0, 0, 0]", TOOL_FEATURE: "get_target_tcp_pose()"}
_NAME = re.compile(r"\W")


def identifier(name: str) -> str:
    """A name as scripts have it: letters, digits and underscores."""
    made = _NAME.sub("_", name) or "_"
    ascii_only = "".join(sign if sign.isascii() else f"u{ord(sign):x}" for sign in made)
    return f"_{ascii_only}" if ascii_only[0].isdigit() else ascii_only


def function_name(name: str) -> str:
    """The same for a function, which no word of the language is called."""
    made = identifier(name)
    return f"{made}_" if made in RESERVED else made


def expression_text(element: Element | None, named_signals: Mapping[str, str]) -> str:
    """The text of an element ``expression``; empty if nothing was entered.

    Args:
        element: that holds characters, tokens and names.
        named_signals: the controller's names of signals by the operator's.
    """
    if element is None:
        return ""
    return _one_line("".join(_part(part, named_signals) for part in element))


def _part(part: Element, named: Mapping[str, str]) -> str:
    for key in ("character", "token"):
        value = part.get(key)
        if value is not None:
            return "".join(_SIGNS.get(sign, sign) for sign in value)
    found = resolved(part)
    if found is None:
        return " not_known "
    named_as = found.get("referencedName")
    if named_as in _FEATURES:
        return _FEATURES[named_as]
    if named_as is not None:
        return read_signal(named.get(named_as, named_as))
    if found.get("name"):
        return identifier(found.get("name")) + ("_p" if found.tag == "Waypoint" else "")
    if found is not part:
        return _part(found, named)
    return "".join(_part(inner, named) for inner in part)


def _one_line(text: str) -> str:
    return " ".join(text.replace("\r", "\n").split("\n")).strip()


def variable_name(element: Element | None) -> str | None:
    """The name of a program's variable; None if it has none."""
    found = None if element is None else resolved(element)
    if found is None or not found.get("name"):
        return None
    return identifier(found.get("name"))
