"""The nodes of a program's tree, each to its statements."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

from . import actions
from .emission import Emission
from .expressions import function_name, variable_name
from .kinematics import DhTable
from .moves import move, safe_home
from .xml_file import Element, child, number, resolved

_SILENT = frozenset({"Placeholder", "InitVariablesNode", "SuppressedNode", "children"})
"""What has no statements; what was suppressed does not run."""
_KNOWN = _SILENT | {
    *("Move", "SafeHome", "Folder", "Loop", "If", "Switch", "Set", "Wait", "Popup", "Assignment"),
    *("Script", "Comment", "Timer", "Halt", "CallSubProgram", "SubProgram", "Thread", "Force"),
    *("Waypoint", "CircleMove", "MainProgram", "SpecialSequence"),
}
"""Nodes that are carried out, or have nothing to carry out."""
_PARTS_OF_NODES = ("Case", "Until", "Direction")
"""What the tags of nodes hold that belong to another one."""
_BRANCHES = ("ElseIf", "Else")
_LOOP_FLAGS = frozenset({"type", "checkContinuously", "reference"})
_DEEPEST = 100
Write = Callable[[Emission, Element], None]


class Tree:
    """Writes nodes.

    Args:
        table: of the program's arm.
        depth: of the tree so far.
    """

    def __init__(self, table: DhTable | None) -> None:
        self._table = table
        self._writers: dict[str, Write] = {
            "Move": self._move,
            "SafeHome": safe_home_node,
            "Folder": self._folder,
            "Loop": self._loop,
            "Switch": self._switch,
            "Set": actions.set_node,
            "Wait": actions.wait,
            "Popup": actions.popup,
            "Assignment": actions.assignment,
            "Script": actions.script,
            "Comment": actions.comment,
            "Timer": actions.timer,
            "Halt": _halt,
            "CallSubProgram": self._call,
            "SubProgram": self._subprogram,
            "Thread": self._thread,
            "Event": self._event,
            "Force": self._force,
            "Contributed": self._contributed,
        }

    def below(self, out: Emission, node: Element) -> None:
        """The nodes below a node."""
        inside = child(node, "children")
        steps = [] if inside is None else [one for one in inside if isinstance(one.tag, str)]
        index = 0
        while index < len(steps):
            if steps[index].tag == "If":
                index = self._branches(out, steps, index)
            else:
                self.node(out, steps[index])
                index += 1

    def node(self, out: Emission, node: Element) -> None:
        """One node; one of a kind that is not known is named in a note."""
        if node.tag in _SILENT:
            return
        writer = self._writers.get(node.tag)
        found = resolved(node)
        if found is None:
            out.note(f"a node {node.tag} stands for another one that is not in the file")
        elif writer is not None and len(out.path) < _DEEPEST:
            writer(out, found)
        else:
            with out.node(node.get("name") or node.tag):
                out.write(f"# {node.tag}: not known")
                out.note(_not_known(node))

    def _move(self, out: Emission, node: Element) -> None:
        with out.node(node.get("motionType", "Move")):
            move(out, node, self._table, self.node)

    def _folder(self, out: Emission, node: Element) -> None:
        with out.node(node.get("name") or "Folder"):
            self.below(out, node)

    def _loop(self, out: Emission, node: Element) -> None:
        kind = node.get("type", "Forever")
        with out.node("Loop"):
            _continuous(out, node)
            if kind == "Forever":
                with out.block("while (True):"):
                    self.below(out, node)
                    out.write("sync()")
            elif kind == "Counting":
                self._counting(out, node)
            else:
                condition = out.expression(child(node, "expression")) or "False"
                with out.block(f"while ({condition}):"):
                    self.below(out, node)

    def _counting(self, out: Emission, node: Element) -> None:
        name = variable_name(child(node, "variable", "loopVariable")) or f"Loop_{out.number}"
        count = _count(out, node)
        if count is None:
            out.note("how often it is passed is not stored: once")
        out.write(f"global {name}=0")
        with out.block(f"while ({name} < {count or 1}):"):
            self.below(out, node)
            out.mark()
            out.write(f"{name}={name}+1")

    def _branches(self, out: Emission, steps: list[Element], index: int) -> int:
        """An ``If`` with the branches behind it; where the next node stands."""
        first = steps[index]
        with out.node("If"):
            _continuous(out, first)
            kind = first.get("type", "If")
            if kind != "If":
                out.note("an else without an if before it: it is left out")
                return index + 1
            self._branch(out, f"if ({_condition(out, first)}):", first)
            index += 1
            while index < len(steps):
                node = steps[index]
                if node.tag in ("SuppressedNode", "Comment", "Placeholder"):
                    if not _branch_follows(steps, index):
                        break
                    index += 1
                    continue
                if node.tag != "If" or node.get("type") not in _BRANCHES:
                    break
                last = node.get("type") == "Else"
                head = "else:" if last else f"elif ({_condition(out, node)}):"
                self._branch(out, head, node)
                index += 1
                if last:
                    break
            out.write("end")
        return index

    def _branch(self, out: Emission, head: str, node: Element) -> None:
        with out.part(head):
            self.below(out, node)

    def _switch(self, out: Emission, node: Element) -> None:
        with out.node("Switch"):
            name = f"switch_value_{out.number}"
            out.write(f"global {name}={out.expression(child(node, 'expression')) or 'not_known'}")
            inside = child(node, "children")
            cases = [one for one in ([] if inside is None else inside) if "Case" in str(one.tag)]
            defaults = [one for one in cases if _is_default(one)]
            head = "if"
            for case in cases:
                if case in defaults:
                    continue
                value = _case_value(out, case)
                self._branch(out, f"{head} ({name} == {value}):", case)
                head = "elif"
            if defaults and head == "if":
                self.below(out, defaults[0])
            elif defaults:
                self._branch(out, "else:", defaults[0])
            if head != "if":
                out.write("end")

    def _force(self, out: Emission, node: Element) -> None:
        with out.node("Force"):
            actions.force(out, node)
            self.below(out, node)
            out.mark()
            out.write("end_force_mode()")

    def _contributed(self, out: Emission, node: Element) -> None:
        actions.contributed(out, node)
        self.below(out, node)

    def _call(self, out: Emission, node: Element) -> None:
        found = _called(node)
        if found is not None and found != node and found.getparent() == node:
            self._subprogram(out, found)
        name = None if found is None else found.get("name")
        with out.node(f"Call {name or 'SubProg'}"):
            if not name:
                out.note(
                    "the subprogram that is called is not in the program: the call is left out"
                )
                return
            out.write(f"{function_name(name)}()")

    def _subprogram(self, out: Emission, node: Element) -> None:
        with out.apart(), out.node(node.get("name") or "SubProgram"):
            with out.block(f"def {function_name(node.get('name') or 'SubProgram')}():"):
                self.below(out, node)
            if child(node, "children") is None:
                out.note("the subprogram's nodes are not in the program, but in a file of its own")

    def _thread(self, out: Emission, node: Element) -> None:
        name = function_name(node.get("name") or f"Thread_{out.number}")
        with out.apart(), out.node(node.get("name") or "Thread"):
            with out.block(f"thread {name}():"):
                loops = node.get("runForever", node.get("loopForever", "true")) != "false"
                if loops:
                    with out.block("while (True):"):
                        self.below(out, node)
                        out.write("sync()")
                else:
                    self.below(out, node)
            out.write(f"threadId_{name} = run {name}()")

    def _event(self, out: Emission, node: Element) -> None:
        with out.node(node.get("name") or "Event"):
            out.write("# Event")
            out.note(
                "an event interrupts the program when its condition comes true: not carried out"
            )


def left_out(root: Element) -> Counter[str]:
    """How many nodes of each kind a program has of which nothing is carried out.

    URCaps are named; what was suppressed does not count.
    """
    return Counter(_kind(node) for node in root.iter("*") if _lacks(node) and runs(node))


def listed_nodes(kinds: Counter[str]) -> str:
    """Kinds of nodes with how many there are: ``Pallet (1), URCap Gripper (2)``."""
    return ", ".join(f"{kind} ({count})" for kind, count in kinds.items())


def runs(node: Element) -> bool:
    """Whether an element is in none that is suppressed, or of which nothing is carried out."""
    return not any(one.tag == "SuppressedNode" or _lacks(one) for one in node.iterancestors())


def _lacks(node: Element) -> bool:
    above = node.getparent()
    if above is None or above.tag != "children" or node.tag in _KNOWN:
        return False
    return not any(part in node.tag for part in _PARTS_OF_NODES)


def _kind(node: Element) -> str:
    if node.tag != "Contributed":
        return str(node.tag)
    return f"URCap {node.get('strategyURCapName') or node.get('strategyProgramNodeType') or ''}"


def _not_known(node: Element) -> str:
    count = sum(1 for _ in node.iter("Waypoint"))
    below = f" with the {count} waypoints below it" if count > 1 else ""
    below = " with the waypoint below it" if count == 1 else below
    return (
        f"a node of the kind '{node.tag}', whose code is not in the program tree but in the "
        f".script that PolyScope saves beside it: it is left out{below}"
    )


def safe_home_node(out: Emission, node: Element) -> None:
    """``SafeHome``."""
    safe_home(out, node)


def _halt(out: Emission, node: Element) -> None:
    with out.node("Halt"):
        out.write("halt")


def _condition(out: Emission, node: Element) -> str:
    return out.expression(child(node, "expression")) or "False"


def _continuous(out: Emission, node: Element) -> None:
    if node.get("checkContinuously") == "true":
        out.note("the condition is checked continuously: here only where the node begins")


def _branch_follows(steps: list[Element], index: int) -> bool:
    for node in steps[index:]:
        if node.tag not in ("SuppressedNode", "Comment", "Placeholder"):
            return bool(node.tag == "If" and node.get("type") in _BRANCHES)
    return False


def _count(out: Emission, node: Element) -> str | None:
    """How often a counting loop is passed: the one whole number that the node states."""
    stated = [value for name, value in node.attrib.items() if name not in _LOOP_FLAGS]
    for one in node:
        if one.tag not in ("children", "variable", "loopVariable", "expression"):
            stated += [one.text, *one.attrib.values()]
    for text in stated:
        value = number(text)
        if value is not None and value == int(value) and value >= 0:
            return str(int(value))
    return out.expression(child(node, "expression")) or None


def _is_default(case: Element) -> bool:
    told = f"{case.tag} {case.get('type', '')} {case.get('name', '')}"
    return "efault" in told or case.get("default") == "true"


def _case_value(out: Emission, case: Element) -> str:
    for name in ("value", "caseValue", "caseNumber", "number", "case"):
        inside = child(case, name)
        text = case.get(name) if inside is None else inside.get("value") or inside.text
        if number(text) is not None:
            return str(text).strip()
    return out.expression(child(case, "expression")) or "not_known"


def _called(node: Element) -> Element | None:
    """The subprogram that a call is of."""
    for one in node:
        if isinstance(one.tag, str) and one.tag.casefold() in ("subprogram", "target"):
            return resolved(one)
    return node if node.get("name") else None
