"""A ``.urp``: a program's tree, gzip and XML, as the script that PolyScope would make of it.

The tree is written node by node (`nodes`), in the order of PolyScope: what the installation states,
values of variables, waypoints, subprograms and threads, the sequence before the start, and the main
program, which goes on for ever unless it runs only once. Before the statements of each node a line
``$ n "Robot Program > MoveJ > Waypoint_1"`` names it, as in PolyScope's own scripts.
"""

from __future__ import annotations

from dataclasses import dataclass

from ....core.errors import InputError, Note
from .actions import initial_values
from .emission import GENERATED, Emission, payload_text, pose_text
from .expressions import function_name, identifier
from .installation import Installation
from .kinematics import DhTable, table_of
from .literals import Literal
from .nodes import Tree
from .positions import taught_tcps
from .xml_file import Element, child

ROOT = "URProgram"
_TOP = "SubProgram", "Thread", "Event"


@dataclass(frozen=True)
class UrProgram:
    """A program of PolyScope, not yet written as a script.

    Args:
        name: as stated.
        installation: its name.
        installation_path: where it is, from the program's folder, without suffix.
        serial: of the robot that it was saved on.
        saved_in: version of PolyScope.
        table: of the arm; None if it is not stated.
        root: the element.
    """

    name: str
    installation: str
    installation_path: str
    serial: str
    saved_in: str
    table: DhTable | None
    root: Element


def is_of_old_polyscope(root: Element) -> bool:
    """Whether a file is a program of before PolyScope 3, by its root element."""
    return str(root.tag).startswith("gui.program")


def urp_of(root: Element, file: str) -> UrProgram:
    """A program by its root element.

    Raises:
        InputError: it is none, or one of before PolyScope 3, which cannot be read.
    """
    if is_of_old_polyscope(root):
        raise InputError(
            f"{file}: is a program of PolyScope before 3.0, whose tree is not read: PolyScope "
            "saves the same program as .script beside it; read that"
        )
    if root.tag != ROOT:
        raise InputError(f"{file}: is no program of PolyScope: it begins with <{root.tag}>")
    name = root.get("installation", "")
    return UrProgram(
        root.get("name", ""),
        name,
        root.get("installationRelativePath") or name,
        root.get("robotSerialNumber", ""),
        root.get("lastSavedIn") or root.get("createdIn", ""),
        table_of(child(root, "kinematics")),
        root,
    )


@dataclass(frozen=True)
class TreeScript:
    """A script that was made of a tree.

    Args:
        text: it.
        literals: those with a place in the tree, in order.
        notes: what of the tree is not in it.
    """

    text: str
    literals: tuple[Literal, ...]
    notes: tuple[Note, ...]


def script_of(program: UrProgram, installation: Installation | None, name: str) -> TreeScript:
    """A program as a script.

    Args:
        program: it.
        installation: the one that it names; None if it is not at hand.
        name: of the script's function.
    """
    out = Emission(installation or Installation(), program.installation, installation is not None)
    tree = Tree(program.table)
    _settings(out, program)
    top = child(program.root, "children")
    nodes = [one for one in ([] if top is None else top) if isinstance(one.tag, str)]
    for node in nodes:
        if node.tag == "InitVariablesNode":
            initial_values(out, node)
    settings, out.lines = out.lines, []
    for node in nodes:
        if node.tag in _TOP:
            tree.node(out, node)
    for node in nodes:
        if node.tag == "SpecialSequence":
            with out.node(node.get("type", "BeforeStart")):
                tree.below(out, node)
    mains = [node for node in nodes if node.tag == "MainProgram"]
    for main in mains:
        _main(out, tree, main)
    if not mains:
        out.note("the file holds no main program")
    known = (*_TOP, "InitVariablesNode", "SpecialSequence", "MainProgram")
    for node in nodes:
        if node.tag not in known:
            tree.node(out, node)
    lines = [f"def {function_name(name)}():", *settings, *out.preamble, *out.lines, "end", ""]
    told = [Note(f"{node}: {text}" if node else text) for text, node in out.told.items()]
    text, literals = out.literals.placed(GENERATED + "\n".join(lines))
    return TreeScript(text, literals, tuple(told))


def _settings(out: Emission, program: UrProgram) -> None:
    """What the installation has in force when the program begins."""
    installation = out.installation
    tcp = installation.tcps.get(installation.active or "")
    if tcp is None:
        tcp = next(taught_tcps(program.root), None)
        if tcp is not None:
            out.note(_lacks_tcp(out, program))
    if tcp is not None:
        out.write(f"set_tcp({pose_text(tcp)})")
    payload = installation.payloads.get(installation.payload or "")
    if payload is not None:
        out.write(payload_text(payload))
    for name, feature in installation.features.items():
        if feature.variable:
            out.write(f"global {identifier(name)}={pose_text(feature.pose)}")


def _main(out: Emission, tree: Tree, main: Element) -> None:
    with out.node("Robot Program"):
        initial_values(out, child(main, "InitVariablesNode"))
        if main.get("runOnlyOnce") == "true":
            tree.below(out, main)
            return
        with out.block("while (True):"):
            tree.below(out, main)


def _lacks_tcp(out: Emission, program: UrProgram) -> str:
    lacks = (
        f"the installation '{program.installation}' names no TCP in force"
        if out.with_installation
        else f"the installation '{program.installation}' is not at hand"
    )
    return f"{lacks}: the TCP is the one that the first waypoint was taught with"
