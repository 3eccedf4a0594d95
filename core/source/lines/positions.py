"""Positions as six or seven numbers of a text, and back; the tools and frames that they are in."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dialect import Orientation
from ...errors import InputError, SourceError
from ...program.target import Configuration, JointTarget, PoseTarget, Target
from ...program.tool import FLANGE, WORLD, Tool, WorkObject
from ...spatial.pose import IDENTITY, Pose
from ...spatial.rotation import (
    euler_zyx,
    euler_zyz,
    matrix_from_euler_zyx,
    matrix_from_euler_zyz,
    matrix_from_rotation_vector,
    rotation_vector,
)
from .statements import Situation


@dataclass(frozen=True, slots=True)
class PositionForm:
    """How a language says positions: x, y, z, and a rotation.

    Args:
        orientation: the form of the rotation.
        last_first: whether the angle about the last axis stands first: W, P, R about x, y, z for
            turns about z, the new y, the new x.
        in_si: whether lengths are in m and angles in rad, not in mm and degrees.
    """

    orientation: Orientation
    last_first: bool = False
    in_si: bool = False

    def pose(self, numbers: Sequence[float]) -> Pose:
        """The pose of its numbers."""
        length = 1.0 if self.in_si else 1e-3
        x, y, z = (length * value for value in numbers[:3])
        if self.orientation is Orientation.QUATERNION:
            a, b, c, d = numbers[3:7]
            return Pose((x, y, z), (a, b, c, d))
        turns = [value if self.in_si else math.radians(value) for value in numbers[3:6]]
        matrix = np.eye(4)
        matrix[:3, :3] = self._matrix(turns[::-1] if self.last_first else turns)
        matrix[:3, 3] = x, y, z
        return Pose.from_matrix(matrix)

    def _matrix(self, turns: Sequence[float]) -> np.ndarray:
        if self.orientation is Orientation.ROTATION_VECTOR:
            return matrix_from_rotation_vector(np.array(turns))
        zyz = self.orientation is Orientation.EULER_ZYZ
        return (matrix_from_euler_zyz if zyz else matrix_from_euler_zyx)(*turns)

    def target(
        self,
        numbers: Sequence[float],
        joints: bool,
        configuration: Configuration | None = None,
        name: str | None = None,
    ) -> Target:
        """The target of its numbers: of joint values, or of a pose."""
        if not joints:
            return PoseTarget(self.pose(numbers), configuration, name=name)
        values = numbers if self.in_si else map(math.radians, numbers)
        return JointTarget(tuple(values), name=name)

    def numbers(self, value: Target | Pose) -> tuple[float, ...]:
        """The numbers of a target or pose; see `core.spatial.rotation` for turns that have several
        names."""
        if isinstance(value, JointTarget):
            return value.joints if self.in_si else tuple(map(math.degrees, value.joints))
        pose = value.pose if isinstance(value, PoseTarget) else value
        place = pose.position if self.in_si else tuple(1000 * v for v in pose.position)
        if self.orientation is Orientation.QUATERNION:
            return (*place, *pose.quaternion)
        matrix = pose.matrix()[:3, :3]
        if self.orientation is Orientation.ROTATION_VECTOR:
            turns = tuple(map(float, rotation_vector(matrix)))
        else:
            zyz = self.orientation is Orientation.EULER_ZYZ
            turns = (euler_zyz if zyz else euler_zyx)(matrix)
        turns = turns[::-1] if self.last_first else turns
        if self.in_si:
            return (*place, *turns)
        return (*place, *(_one_name(math.degrees(turn)) for turn in turns))


@dataclass(frozen=True, slots=True)
class Placed:
    """Where a motion goes, and with what."""

    target: Target
    tool: Tool = FLANGE
    work_object: WorkObject = WORLD


@dataclass(frozen=True, slots=True)
class Place:
    """What a position is beside its numbers, where it says so itself.

    Args:
        joints: whether they are joint values.
        tool, frame: numbers of `FrameRegisters`; None for what is set where it is used.
        configuration: of a pose.
    """

    joints: bool = False
    tool: int | None = None
    frame: int | None = None
    configuration: Configuration | None = None


@dataclass(frozen=True)
class FrameRegisters:
    """The tools and frames of a language. The program itself may set them.

    Args:
        tool, frame: their words; ``""`` for none.
        beside: the file that states them, to be put beside programs; ``""`` where there is none.
        chosen: words of the settings that hold the numbers of those that a motion names none of.
        numbered: whether they are called by numbers, 0 for the flange and the robot's base; else
            there is one of each, called as the point that it was set to (`MotionGrammar.framed`).
        said: how one that is not numbered is set, of its ``word`` and ``point``; ``""`` where the
            writer says it otherwise.
        none: how it is set to none.
    """

    tool: str
    frame: str = ""
    beside: str = ""
    chosen: tuple[str, str] = ("", "")
    numbered: bool = True
    said: str = ""
    none: str = "{word} NONE"

    def both(self, form: PositionForm, place: Place, now: Situation) -> tuple[Tool, WorkObject]:
        """The tool and the work object of a place.

        Args:
            form: of their numbers.

        Raises:
            InputError: nobody knows them.
        """
        words = zip((self.tool, self.frame), self.chosen, (place.tool, place.frame), strict=True)
        (tool, at), (frame, user) = (self._found(*one, form, now) for one in words)
        return Tool(tool, at) if tool else FLANGE, WorkObject(frame, user=user) if frame else WORLD

    def _found(
        self, word: str, chosen: str, number: int | None, form: PositionForm, now: Situation
    ) -> tuple[str, Pose]:
        """What one is called, ``""`` for none, and where it is."""
        if not self.numbered:
            numbers = now.vector(word.upper(), None) if word else form.numbers(IDENTITY)
            pose, kind = form.pose(numbers), getattr(numbers, "kind", None)
            name = kind if isinstance(kind, str) else word.strip("$").lower()
            return "" if pose == IDENTITY else name, pose
        number = int(now.setting(chosen.upper(), 0.0)) if number is None else number
        if not number:
            return "", IDENTITY
        try:
            return f"{word}[{number}]", form.pose(now.vector(word.upper(), number))
        except SourceError:
            offer = f"put {self.beside} beside the program, or " if self.beside else ""
            raise InputError(
                f"{word}[{number}] is not known: {offer}answer {word}[{number},1] to "
                f"{word}[{number},6] in the table [values]"
            ) from None


def _one_name(degrees: float) -> float:
    """180° and -180° are one turn, and have one name."""
    return -degrees if degrees <= -180.0 + 1e-9 else degrees
