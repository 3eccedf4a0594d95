"""The script that PolyScope saved with a tree, for nodes whose code the tree does not hold.

Nodes of URCaps, and those of which no public file shows how they are stored (Pallet, Seek), have
their code in that script alone. It is what the controller ran when the program was saved.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from ....core.errors import InputError, Note
from ....core.source.text.files import SourceFile
from .changes.tree_file import TreeFile
from .nodes import left_out, listed_nodes, runs
from .script_beside import moved_waypoints

_NAME = re.compile(r"\w+")


@dataclass(frozen=True, slots=True)
class ScriptInPlace(SourceFile):
    """A script that is read in the place of a tree: nothing can be written into it."""

    def edited(self, stretches: Sequence[tuple[int, int, str]]) -> NoReturn:
        """See `SourceFile.edited`.

        Raises:
            InputError: always.
        """
        raise InputError(
            f"{self.name}: PolyScope makes this script anew of the program's tree and never loads "
            "it: what is changed in it would not be driven. Some nodes of the tree have their code "
            "in it alone: change the numbers on the pendant, or have the script run by a Script "
            "node of a program of its own, and name the script"
        )


@dataclass(frozen=True)
class NodesScript:
    """A script that holds the code of nodes.

    Args:
        file: it.
        note: which nodes these are.
    """

    file: ScriptInPlace
    note: Note


def script_of_nodes(tree: TreeFile) -> NodesScript | None:
    """The script beside a tree, if that lacks code of some nodes and both are of one state."""
    lacks = left_out(tree.program.root)
    script = tree.beside
    if script is None or not lacks or not _of_one_state(tree, script):
        return None
    file = ScriptInPlace(script.name, script.text, script.codec)
    name = Path(script.name).name
    said = f"{tree.name}: the code of nodes {listed_nodes(lacks)} is in {name} alone"
    return NodesScript(file, Note(f"{said}, which is read in the place of the tree"))


def _of_one_state(tree: TreeFile, script: SourceFile) -> bool:
    """Whether all waypoints of a tree are in a script, and none is elsewhere in it."""
    words = set(_NAME.findall(script.text))
    waypoints = [node for node in tree.program.root.iter("Waypoint") if runs(node)]
    names = [name for node in waypoints if (name := node.get("name"))]
    known = all(set(_NAME.findall(name)) <= words for name in names)
    return known and not moved_waypoints(tree.text, script.text)
