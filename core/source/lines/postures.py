"""Labels of configurations by letters and turns: FANUC ``N U T, 0, 0, 0`` and its like."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...program.target import Configuration
from ...robot.model import Robot
from ...robot.posture import posture

EDGE = 1e-3
"""rad or m beside a boundary at which either name will do: texts have three decimals."""


@dataclass(frozen=True, slots=True)
class PostureLabel:
    """A letter each for wrist, elbow and shoulder, and the turns of some joints.

    Args:
        letters: of them.
        turns: of the joints: 0 from -180° to 180°, 1 from there to 540°.
        undecided: of a solution's label: indices of letters and turns that are on a boundary.
    """

    letters: str
    turns: tuple[int, ...] = ()
    undecided: frozenset[int] = field(default=frozenset(), compare=False, repr=False)

    def __str__(self) -> str:
        return ", ".join((" ".join(self.letters), *map(str, self.turns)))

    @property
    def hint(self) -> bool:
        """False: it names a solution."""
        return False

    def admits(self, label: Configuration) -> bool:
        """Whether the letters are the label's: turns tell solutions apart that one axis holds."""
        return not any(k < len(self.letters) for k in self._differences(label))

    def mismatch(self, label: Configuration) -> float:
        """The number of letters and turns that differ."""
        return float(len(self._differences(label)))

    def _differences(self, label: Configuration) -> set[int]:
        if not isinstance(label, PostureLabel):
            raise InputError(f"a configuration such as {self} cannot be compared with {label}")
        pairs = zip((*self.letters, *self.turns), (*label.letters, *label.turns), strict=True)
        return {k for k, (a, b) in enumerate(pairs) if a != b} - self.undecided - label.undecided


@dataclass(frozen=True)
class PostureLetters:
    """What the letters of a make mean.

    Args:
        wrist: of an axis 5 below zero, and of one above.
        elbow: of the usual elbow, and of the other.
        shoulder: of a wrist in front of axis 1, and of one behind it.
        turning: indices of the joints whose turns count.
        front: what points to the front with joint 1 at zero, in the robot's base; wherever the
            arm's own zero lies, the letters of the shoulder and the elbow are counted from there.
    """

    wrist: str
    elbow: str
    shoulder: str
    turning: tuple[int, ...] = ()
    front: tuple[float, float, float] = (1.0, 0.0, 0.0)

    def read(self, text: str) -> PostureLabel:
        """The label that a text states, ``N U T, 0, 0, 0``; turns that are left out are 0, and
        letters that are none of these are passed over.

        Raises:
            InputError: a letter is missing.
        """
        words = self.wrist, self.elbow, self.shoulder
        letters, _, turns = text.upper().partition(",")
        found = [next((one for one in letters.split() if one in word), "") for word in words]
        if not all(found):
            raise InputError(f"a configuration has a letter each of {', '.join(words)}")
        numbers = [*map(int, re.findall(r"-?\d+", turns)), *[0] * len(self.turning)]
        return PostureLabel("".join(found), tuple(numbers[: len(self.turning)]))

    def written(self, label: Configuration | None) -> str:
        """The same, the other way; ``""`` for no label.

        Raises:
            InputError: it is another make's.
        """
        if label is not None and not isinstance(label, PostureLabel):
            raise InputError(f"{label} has no letters: label the target's solution for this robot")
        return "" if label is None else str(label)

    def label(self, robot: Robot, q: NDArray[np.float64]) -> PostureLabel | None:
        """The label of joint values (N,) rad; None for an arm that has no such postures.

        Raises:
            InputError: axis 2 turns the arm across the `front`.
        """
        at = posture(robot, q, self.front)
        if at is None:
            return None
        sizes = at.wrist, at.elbow, at.shoulder
        first = at.wrist < 0, at.elbow >= 0, at.shoulder >= 0
        words = self.wrist, self.elbow, self.shoulder
        letters = (word[0 if one else 1] for word, one in zip(words, first, strict=True))
        shares = [(float(q[k]) + math.pi) / math.tau for k in self.turning]
        near = {k for k, v in enumerate(sizes) if abs(v) <= EDGE}
        near |= {3 + k for k, v in enumerate(shares) if abs(v - round(v)) * math.tau <= EDGE}
        return PostureLabel("".join(letters), tuple(map(math.floor, shares)), frozenset(near))
