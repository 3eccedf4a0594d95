"""A program's tree as the script that is read, and the way back: numbers of the script → the tree.

global Waypoint_1_p=p[0.4, …]   the pose follows from the joints, so the joints are changed
global MoveL_3_v=0.25           speed="0.25" of the Move, for all of its waypoints
movel(…, v=0.1, r=0.02)         of the waypoint's own motionParameters, which are put in
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from pathlib import Path
from typing import Self

from .....core.errors import InputError
from .....core.source.patch.edits import alike
from .....core.source.text.files import SourceFile
from .....core.spatial.pose import Pose
from ...syntax.lexer import number_value
from ...values.poses import quaternion_of, rotation_vector_of
from ...values.rotations import nearest_rotation_vector
from ..emission import node_at
from ..installation import Installation
from ..kinematics import DhTable
from ..literals import JOINTS, POSE, Attribute, CodeLine, Ending, Literal, Position
from ..positions import Stored, stored_joints, stored_poses, table_at, taught_at
from ..program import UrProgram, script_of, urp_of
from ..xml_file import Element, child, parsed, unpacked
from .code_files import code_file, stretches
from .xml_edits import XmlEdits, packed_like

Stretch = tuple[int, int, str]
_PUT_IN = re.compile(r", (\w+)=([^,]+)")
_NUMBER = re.compile(r"[^\s,\[\]]+")
_TOGETHER = {
    "jointSpeed": ("jointAcceleration", "acceleration"),
    "jointAcceleration": ("jointSpeed", "speed"),
    "cartesianSpeed": ("cartesianAcceleration", "acceleration"),
    "cartesianAcceleration": ("cartesianSpeed", "speed"),
}
"""What PolyScope states with each of a waypoint's own numbers, and where its ``Move`` has it."""
_SAME = 1e-10
"""m, rad: how near joints must bring the TCP to a pose."""


@dataclass(frozen=True, slots=True)
class PackedScript(SourceFile):
    """A script that gzip has packed.

    Args:
        packed: the file's bytes as they were.
    """

    packed: bytes = field(default=b"", repr=False)

    @property
    def data(self) -> bytes:
        """The file's bytes."""
        return packed_like(SourceFile(self.name, self.text, self.codec).data, self.packed)


@dataclass(frozen=True, slots=True)
class PolyScopeXFile(SourceFile):
    """The script in a program of PolyScope X, which is made of its nodes.

    Args:
        packed: the file's bytes.
    """

    packed: bytes = field(default=b"", repr=False)

    @property
    def data(self) -> bytes:
        """The file's bytes."""
        return self.packed

    def edited(self, stretches: Sequence[Stretch]) -> Self:
        """See `SourceFile.edited`.

        Raises:
            InputError: always.
        """
        raise InputError(
            f"{self.name}: nothing is written into programs of PolyScope X: the script in them is "
            "made anew of their nodes whenever they are saved; change the nodes on the pendant"
        )


@dataclass(frozen=True, slots=True)
class TreeFile(SourceFile):
    """A program's tree as a script.

    Args:
        packed: the file's bytes.
        program: what is in them.
        installation: the one that it names; None if it is not at hand.
        literals: of the script, with their places in the tree.
        beside: the ``.script`` that PolyScope has saved beside it; None if there is none.
        code: script files of its nodes that are at hand, by what they are called without folder.
    """

    packed: bytes = field(default=b"", repr=False, kw_only=True)
    program: UrProgram = field(repr=False, compare=False, kw_only=True)
    installation: Installation | None = field(default=None, repr=False, kw_only=True)
    literals: tuple[Literal, ...] = field(default=(), repr=False, compare=False, kw_only=True)
    beside: SourceFile | None = field(default=None, repr=False, compare=False, kw_only=True)
    code: Mapping[str, SourceFile] = field(
        default_factory=dict, repr=False, compare=False, kw_only=True
    )

    @property
    def data(self) -> bytes:
        """The file's bytes."""
        return self.packed

    @property
    def stem(self) -> str:
        """The name of the script's function."""
        return Path(self.name).stem

    def position_at(self, start: int) -> Position | None:
        """The pose or joints of a waypoint in which a character of the script stands."""
        index = bisect_right(self.literals, start, key=lambda one: one.start) - 1
        found = self.literals[index] if index >= 0 else None
        if found is None or start >= found.end or not isinstance(found.place, Position):
            return None
        return found.place

    def code_changed(self, before: TreeFile) -> Iterator[SourceFile]:
        """The script files of its nodes that are not as they were."""
        yield from (file for name, file in self.code.items() if file != before.code[name])

    def joints_at(
        self, position: Position, pose: Pose, near: Sequence[float]
    ) -> tuple[float, ...] | None:
        """The joints (6,) rad that a waypoint would be stored with at another pose.

        Args:
            pose: of the TCP in the base's frame.
            near: joints of the same posture.

        Returns:
            None if none are found near, or no table of the arm says.
        """
        arm, tool = _arm_and_tool(position.elements[0], self.program.table)
        return None if arm is None else arm.joints(pose @ tool.inverse(), near)

    def edited(self, stretches: Sequence[Stretch]) -> Self:
        """See `SourceFile.edited`; the script is made anew of the changed tree."""
        plain = unpacked(self.packed, self.name)
        edits = _TreeEdits(self, XmlEdits(plain, self.program.root, self.name))
        for literal, changes in groupby(stretches, self._literal):
            edits.change(literal, list(changes))
        changed = edits.all()
        program = urp_of(parsed(changed, self.name), self.name)
        script = script_of(program, self.installation, self.stem)
        return replace(
            self,
            text=script.text,
            packed=packed_like(changed, self.packed),
            program=program,
            literals=script.literals,
            code={**self.code, **edits.code},
        )

    def _literal(self, stretch: Stretch) -> Literal:
        """The literal that a stretch of the script is in.

        Raises:
            InputError: it is in none that has a place in the tree.
        """
        start, end, _ = stretch
        index = bisect_left(self.literals, start, key=lambda one: one.start)
        for literal in self.literals[max(0, index - 1) : index + 2]:
            empty = literal.start == literal.end
            alike = empty == (start == end) or isinstance(literal.place, CodeLine)
            if literal.start <= start and end <= literal.end and alike:
                return literal
        line = self.text.count("\n", 0, start) + 1
        node = node_at(self.text, line) or "the program's tree"
        raise InputError(
            f"{self.name}: {node}: nothing can be written there: it stands in an expression or in "
            "the installation, or belongs to all waypoints of the node; change it on the pendant"
        )


class _TreeEdits:
    """Changes of literals as changes of a tree."""

    def __init__(self, file: TreeFile, xml: XmlEdits) -> None:
        self._file = file
        self._xml = xml
        self._positions: defaultdict[str, dict[str, list[float]]] = defaultdict(dict)
        self._elements: dict[str, list[Element]] = {}
        self._lines: defaultdict[Element, dict[int, str]] = defaultdict(dict)
        self.code: dict[str, SourceFile] = {}
        self._own: defaultdict[tuple[Element, str], dict[str, str]] = defaultdict(dict)

    def change(self, literal: Literal, stretches: Sequence[Stretch]) -> None:
        """A literal with other text at some places.

        Raises:
            InputError: the tree cannot say it.
        """
        place = literal.place
        if isinstance(place, Position):
            text = _text(self._file.text, literal, stretches)
            if not text.lstrip("p").startswith("["):
                raise InputError(
                    f"{self._file.name}: {place.waypoint} has one position in the tree"
                )
            numbers = [number_value(part) for part in _NUMBER.findall(text.lstrip("p"))]
            self._positions[place.waypoint][place.part] = numbers
            self._elements[place.waypoint] = place.elements
        elif isinstance(place, CodeLine):
            self._lines[place.element][place.line] = _text(self._file.text, literal, stretches)
        elif isinstance(place, Ending):
            for name, value in _PUT_IN.findall("".join(text for *_, text in stretches)):
                if name not in place.attributes:
                    raise InputError(f"{self._file.name}: the node has no {name} of its own")
                self._set(place.attributes[name], value)
        else:
            self._set(place, _text(self._file.text, literal, stretches))

    def all(self) -> bytes:
        """The tree's bytes with all changes.

        Raises:
            InputError: a waypoint cannot be put where it shall be.
        """
        for name, parts in self._positions.items():
            for element in self._elements[name]:
                self._move(name, element, parts)
        for (element, tag), values in self._own.items():
            self._state(element, tag, values)
        for element, lines in self._lines.items():
            file = code_file(element, self._file.code, self._file.name)
            for start, end, text in stretches(element.text, lines):
                self._xml.set_stretch(element, start, end, text)
            changed = file.edited(list(stretches(file.text, lines)))
            self.code[Path(file.name).name] = changed
        return self._xml.changed

    def _set(self, place: Attribute, value: str) -> None:
        if place.within is None:
            self._xml.set(place.element, place.name, value)
            return
        values = self._own[place.element, place.within]
        if values.setdefault(place.name, value) != value:
            raise InputError(f"{place.name} of a waypoint is to become two values")

    def _state(self, element: Element, tag: str, values: dict[str, str]) -> None:
        """Numbers that a waypoint states for itself; speed and acceleration always both."""
        inside = child(element, tag)
        node = next(element.iterancestors("Move"), None)
        for one, (other, shared) in _TOGETHER.items():
            known = None if node is None else node.get(shared)
            stated = inside is not None and inside.get(other) is not None
            if one in values and other not in values and not stated and known is not None:
                values = {**values, other: known}
        if inside is None:
            written = "".join(f' {name}="{value}"' for name, value in values.items())
            self._xml.put_first(element, f"<{tag}{written}/>")
            return
        for name, value in values.items():
            self._xml.set(inside, name, value)

    def _move(self, name: str, waypoint: Element, parts: Mapping[str, list[float]]) -> None:
        """Put a waypoint elsewhere: its joints, and the poses that older files keep beside them."""
        taught = taught_at(waypoint, self._file.program.table)
        joints, pose = parts.get(JOINTS), parts.get(POSE)
        if taught.joints is not None and taught.pose is not None:
            arm, tool = _arm_and_tool(waypoint, self._file.program.table)
            if arm is None:
                raise InputError(
                    f"{self._file.name}: {name}: the program does not state the arm's kinematics, "
                    "by which its joints and its pose belong together: save it on the robot first"
                )
            if pose is None:
                assert joints is not None
                reached = arm.flange(joints) @ tool
                pose = [*reached.position, *rotation_vector_of(reached.quaternion)]
            else:
                flange = _pose(pose) @ tool.inverse()
                joints = list(self._joints(name, arm, flange, joints or taught.joints))
        stored = stored_joints(waypoint)
        if stored is not None and joints is not None:
            self._write(stored, joints)
        if pose is not None and taught.pose is not None:
            moved, old = _pose(pose), _pose(taught.pose)
            for place, was, of_flange in stored_poses(waypoint):
                there = _pose(was)
                shift = (
                    moved @ old.inverse() @ there if of_flange else there @ old.inverse() @ moved
                )
                turned = nearest_rotation_vector(shift.quaternion, was[3:])
                self._write(place, [*shift.position, *turned])

    def _joints(
        self, name: str, arm: DhTable, flange: Pose, near: Sequence[float]
    ) -> Sequence[float]:
        """Joints that put the flange at a pose: those at hand, if they do."""
        there = arm.flange(near)
        if alike(there, flange, _SAME):
            return near
        found = arm.joints(flange, near)
        if found is None:
            raise InputError(
                f"{self._file.name}: {name}: no joints near those that it was taught with bring "
                "the TCP to the new pose: it is out of reach, or the wrist is straight on the way"
            )
        return found

    def _write(self, stored: Stored, values: Sequence[float]) -> None:
        """Other numbers; those that stay are left as they are written."""
        left = iter(values)

        def number(found: re.Match[str]) -> str:
            value = next(left)
            return found[0] if float(found[0]) == value else repr(float(value))

        text = _NUMBER.sub(number, stored.text or "")
        self._xml.set(stored.element, stored.attribute, text.strip())


def _arm_and_tool(waypoint: Element, table: DhTable | None) -> tuple[DhTable | None, Pose]:
    """The arm's table, and the TCP that a waypoint's joints and pose belong together by."""
    arm = table_at(waypoint) or table
    taught = taught_at(waypoint, table)
    if arm is None or taught.joints is None or taught.pose is None:
        return None, Pose()
    return arm, arm.flange(taught.joints).inverse() @ _pose(taught.pose)


def _pose(six: Sequence[float]) -> Pose:
    return Pose((six[0], six[1], six[2]), quaternion_of(*six[3:]))


def _text(script: str, literal: Literal, stretches: Sequence[Stretch]) -> str:
    """The text of a literal with changes."""
    parts, at = [], literal.start
    for start, end, text in stretches:
        parts += [script[at:start], text]
        at = end
    return "".join([*parts, script[at : literal.end]])
