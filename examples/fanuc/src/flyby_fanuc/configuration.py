"""FANUC's label for an inverse-kinematics solution: ``CONFIG : 'N U T, 0, 0, 0'``."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from flyby.core.errors import InputError
from flyby.core.program.target import Configuration
from flyby.core.robot.model import Robot
from flyby.core.robot.posture import posture

EDGE = 1e-3
"""rad or m beside a boundary at which either letter will do: texts have three decimals."""


@dataclass(frozen=True, slots=True)
class FanucConfiguration:
    """Three letters, and the turns of J4, J5 and J6.

    ``N`` (no flip) is J5 below zero, ``U`` the usual elbow, ``T`` the wrist in front of axis 1. A
    turn is 0 from -180° to 180°, 1 from there to 540°. The order of the turns is that of FANUC's
    remote motion interface (``Turn4, Turn5, Turn6``).

    Args:
        letters: ``NUT``; None if the program does not state them.
        turns: of J4, J5, J6.
        undecided: of a solution's label: indices of letters and turns that are on a boundary.
    """

    letters: str
    turns: tuple[int, int, int] = (0, 0, 0)
    undecided: frozenset[int] = field(default=frozenset(), compare=False, repr=False)

    def __str__(self) -> str:
        return f"{' '.join(self.letters)}, {', '.join(map(str, self.turns))}"

    @property
    def hint(self) -> bool:
        """False: it names a solution."""
        return False

    def admits(self, label: Configuration) -> bool:
        """Whether the letters are the label's: turns tell solutions apart that one axis holds."""
        return not any(k < 3 for k in self._differences(label))

    def mismatch(self, label: Configuration) -> float:
        """The number of letters and turns that differ."""
        return float(len(self._differences(label)))

    def _differences(self, label: Configuration) -> set[int]:
        if not isinstance(label, FanucConfiguration):
            raise InputError(f"a FANUC configuration cannot be compared with {label}")
        pairs = zip((*self.letters, *self.turns), (*label.letters, *label.turns), strict=True)
        return {k for k, (a, b) in enumerate(pairs) if a != b} - self.undecided - label.undecided


def label(robot: Robot, q: NDArray[np.float64]) -> FanucConfiguration | None:
    """The label of joint values (N,) rad."""
    at = posture(robot, q)
    if at is None:
        return None
    letters = (
        "N" if at.wrist < 0 else "F",
        "U" if at.elbow >= 0 else "D",
        "T" if at.shoulder >= 0 else "B",
    )
    near = {k for k, v in enumerate((at.wrist, at.elbow, at.shoulder)) if abs(v) <= EDGE}
    shares = [(float(v) + math.pi) / (2 * math.pi) for v in q[3:6]]
    near |= {3 + k for k, v in enumerate(shares) if abs(v - round(v)) * 2 * math.pi <= EDGE}
    turns = (math.floor(shares[0]), math.floor(shares[1]), math.floor(shares[2]))
    return FanucConfiguration("".join(letters), turns, frozenset(near))
