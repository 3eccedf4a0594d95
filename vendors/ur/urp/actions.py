"""Nodes that leave the robot where it is: signals, waits, messages, assignments, scripts."""

from __future__ import annotations

from .emission import Emission, payload_text, quoted
from .expressions import variable_name
from .frames import installation, set_tcp
from .installation import TOOL_FEATURE
from .signals import read_signal, set_signal
from .xml_file import Element, child, number, resolved

_COMPARISONS = {"0": "<", "1": ">", "2": "=="}
"""As analog waits state them."""
_REQUESTS = {"bool": "boolean", "int": "integer", "str": "string", "text": "string"}


def set_node(out: Emission, node: Element) -> None:
    """``Set``: an output, the TCP, the payload."""
    kind = node.get("type", "NoAction")
    with out.node("Set"):
        if child(node, "tcp") is not None:
            set_tcp(out, child(node, "tcp"), node)
        _set_payload(out, node)
        if kind in ("NoAction", "None"):
            return
        name = _pin(out, node)
        value = _set_value(out, node)
        call = None if name is None or value is None else set_signal(name, value)
        if call is None:
            out.note(
                f"what it sets ({name or kind}) is no output of the controller: it is left out"
            )
            return
        out.write(call)
        if "ulse" in kind:
            out.note("a pulse: that the output goes back by itself is not followed")


def _set_payload(out: Emission, node: Element) -> None:
    named = child(node, "payload", "Payload")
    if named is None:
        return
    name = named.get("referencedName") or named.get("name") or ""
    known = out.installation.payloads.get(name)
    if known is None:
        lacks = "has it not" if out.with_installation else "is not at hand"
        out.note(
            f"the payload '{name}' is not known, as {installation(out)} {lacks}: the one before "
            "stays in force"
        )
        return
    out.write(payload_text(known))


def _pin(out: Emission, node: Element) -> str | None:
    pin = child(node, "pin", "signal", "register")
    if pin is None:
        return None
    name = str(pin.get("referencedName") or pin.get("name") or "")
    return out.named_signals.get(name, name)


def _set_value(out: Emission, node: Element) -> str | None:
    digital = _text(node, "digitalValue")
    if digital is not None:
        return "True" if digital.strip().casefold() in ("1", "true", "hi", "high") else "False"
    for name in ("analogValue", "floatValue", "intValue", "registerValue", "value"):
        value = number(_text(node, name))
        if value is not None:
            return repr(value)
    return out.expression(child(node, "expression")) or None


def _text(node: Element, tag: str) -> str | None:
    found = child(node, tag)
    stated = node.get(tag) if found is None else found.get("value") or found.text
    return str(stated) if stated else None


def wait(out: Emission, node: Element) -> None:
    """``Wait``: a time, or until a signal or an expression says so."""
    kind = node.get("type", "NoWait")
    with out.node("Wait"):
        if kind == "Sleep":
            time = _text(node, "waitTime") or ""
            text = time if number(time) is not None else out.expression(child(node, "expression"))
            if text:
                out.write(f"sleep({text.strip()})")
            else:
                out.note("the time is not stored: it waits for nothing")
            return
        condition = _condition(out, node, kind)
        if condition:
            with out.block(f"while (not ({condition})):"):
                out.write("sync()")
        elif "NoWait" not in kind and kind != "None":
            out.note(f"what it waits for ({kind}) is not stored: it waits for nothing")


def _condition(out: Emission, node: Element, kind: str) -> str:
    name = _pin(out, node)
    if name:
        asked = read_signal(name)
        if "Analog" not in kind:
            level = _text(node, "digitalValue") or "1"
            on = level.strip().casefold() in ("1", "true", "hi", "high")
            return f"{asked} == {on}"
        sign = _COMPARISONS.get((_text(node, "analogComparison") or "").strip(), ">")
        value = number(_text(node, "analogValue"))
        return "" if value is None else f"{asked} {sign} {value!r}"
    return out.expression(child(node, "expression"))


def popup(out: Emission, node: Element) -> None:
    """``Popup``: a message that waits for the operator."""
    with out.node("Popup"):
        kind = node.get("type", "Message")
        shown = variable_name(child(node, "variable")) if node.get("message") is None else None
        text = shown or quoted(node.get("message") or _text(node, "message") or "")
        flags = f"warning={kind == 'Warning'}, error={kind == 'Error'}, blocking=True"
        out.write(f"popup({text}, title={quoted(kind)}, {flags})")
        if node.get("haltProgram") == "true":
            out.write("halt")


def assignment(out: Emission, node: Element) -> None:
    """``Assignment``: of an expression, or of what an operator enters."""
    variable = child(node, "variable")
    name = variable_name(variable)
    with out.node(f"{name or '?'}:=…"):
        if name is None:
            out.note("no variable was chosen for the assignment: it is left out")
            return
        if node.get("valueSource", "Expression") == "Expression":
            text = out.expression(child(node, "expression"))
            if text:
                out.write(f"global {name}={text}")
            else:
                out.note(f"nothing was entered that {name} is set to: it is left out")
            return
        asked = " ".join(f"{key} {value}" for key, value in node.attrib.items()).casefold()
        kind = next((kind for word, kind in _REQUESTS.items() if word in asked), "float")
        message = quoted(node.get("message") or _text(node, "message") or name)
        out.write(f"global {name}=request_{kind}_from_primary_client({message})")


def script(out: Emission, node: Element) -> None:
    """``Script``: a line, or a file, whose text PolyScope keeps in the program."""
    if node.get("type") != "File" and child(node, "cachedContents") is None:
        line = out.expression(child(node, "expression"))
        with out.node("Script"):
            if line:
                out.write(line)
        return
    file, cached = child(node, "file"), child(node, "cachedContents")
    name = str((file.text if file is not None else "") or "").strip().replace("\\", "/")
    with out.node(f"Script: {name.rpartition('/')[2] or 'file'}"):
        if cached is not None and cached.text and cached.text.strip():
            out.code(cached)
        else:
            out.note(
                f"the text of the script file {name or '(none)'} is not in the program: "
                "name the file among the others of the program"
            )


def comment(out: Emission, node: Element) -> None:
    """``Comment``."""
    text = node.get("comment")
    if text:
        out.write(f"# {' '.join(text.split())}")


def force(out: Emission, node: Element) -> None:
    """What begins a ``Force``; the path of the robot is driven as if nothing yielded."""
    feature = child(node, "feature")
    name = "" if feature is None else feature.get("referencedName", "")
    frame = "get_target_tcp_pose()" if name == TOOL_FEATURE else "p[0, 0, 0, 0, 0, 0]"
    lists = [_list(node, tag) for tag in ("selection", "wrench", "limitsMotion")]
    out.write(f"force_mode({frame}, {lists[0]}, {lists[1]}, 2, {lists[2]})")


def _list(node: Element, tag: str) -> str:
    found = child(node, tag)
    return f"[{'0, 0, 0, 0, 0, 0' if found is None else found.get('value', '')}]"


def timer(out: Emission, node: Element) -> None:
    """``Timer``: what it measures is not known."""
    out.note("timers are not followed: what they measure is not known")


def contributed(out: Emission, node: Element) -> None:
    """``Contributed``: a node of a URCap, whose code only the controller makes."""
    name = node.get("strategyURCapName") or node.get("strategyProgramNodeType") or "a URCap"
    kind = node.get("strategyProgramNodeType") or name
    with out.node(kind):
        out.write(f"# URCap {name}: {kind}")
        out.note(
            f"a node of the URCap {name}, whose code is not in the program tree but in the .script "
            "that PolyScope saves beside it: nothing of it is carried out"
        )


def initial_values(out: Emission, node: Element | None) -> None:
    """``InitVariablesNode``: what variables are before the program begins."""
    variables = child(node, "variables")
    for one in [] if variables is None else variables:
        found = resolved(one)
        name, text = variable_name(one), "" if found is None else _initial(out, found)
        if name and text:
            out.write(f"global {name}={text}")


def _initial(out: Emission, variable: Element) -> str:
    return out.expression(child(variable, "expression", "initializeExpression"))
