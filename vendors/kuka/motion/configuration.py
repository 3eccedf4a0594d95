"""KUKA's label for an inverse-kinematics solution: Status and Turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ....core.errors import InputError
from ....core.program.target import Configuration
from ....core.robot.joint import JointKind
from ....core.robot.model import Robot
from ....core.robot.posture import posture

EDGE_ANGLE = 1e-3
"""rad. Programs hold angles of two to five decimals, so an axis that was taught at 0° comes back
from inverse kinematics off by up to 1e-4 rad, on either side."""

EDGE_DISTANCE = 1e-3
"""m, the same for the wrist's centre beside axis 1 and beside the line through A2 and A3."""


@dataclass(frozen=True, slots=True)
class KukaConfiguration:
    """``S`` and ``T`` of a position of a six-axis KR arm.

    Status, bit by bit:

    - 1: overhead: the wrist's centre is behind axis 1 (x < 0 in the frame of A1).
    - 2: A3 ≥ φ, where φ is the value of A3 that puts the wrist's centre on the line through A2
      and A3: 0 without an elbow offset, else atan(offset / length of the forearm). So the bit is
      1 for the usual elbow. Public sources disagree: taught points in published .dat files, the
      Beckhoff TF5200 manual and visose/Robots say this; the Robotics API of ISSE Augsburg says
      the opposite. The sign of φ follows from the arm's geometry.
    - 4: A5 < 0.

    Turn: bit i - 1 is 1 where axis i is below zero.

    Args:
        status: S; None if the program does not state it.
        turn: T; None if the program does not state it.
        undecided_status: of a solution's label: bits of S whose quantity is about zero.
        undecided_turn: of a solution's label: bits of T whose axis is about zero.
    """

    status: int | None
    turn: int | None
    undecided_status: int = field(default=0, compare=False, repr=False)
    undecided_turn: int = field(default=0, compare=False, repr=False)

    def __post_init__(self) -> None:
        # Bits 8 and 16 of S tell the arm's generation and the point's accuracy, not a solution.
        if self.status is not None and not 0 <= self.status < 32:
            raise InputError(f"a Status lies between 0 and 31, not {self.status}")
        if self.turn is not None and not 0 <= self.turn < 4096:
            raise InputError(f"a Turn lies between 0 and 4095, not {self.turn}")

    def __str__(self) -> str:
        """As KRL writes it; what is not stated is left out."""
        stated = (("S", self.status), ("T", self.turn))
        return ", ".join(f"{name} {value}" for name, value in stated if value is not None)

    @property
    def hint(self) -> bool:
        """False: it names a solution."""
        return False

    def admits(self, label: Configuration) -> bool:
        """Whether S is the label's, where both are stated.

        T tells turns of an axis apart that its range holds; where it holds one only, as those of
        axes 1, 2, 3 and 5 do, there is no other turn to go to.

        Raises:
            InputError: the label is another vendor's.
        """
        return self._differences(label)[0] == 0

    def mismatch(self, label: Configuration) -> float:
        """The number of bits in which S and T differ where both are stated; 0 for a match.

        Raises:
            InputError: the label is another vendor's.
        """
        return float(sum(self._differences(label)))

    def _differences(self, label: Configuration) -> tuple[int, int]:
        """The bits in which S, and those in which T differ."""
        if not isinstance(label, KukaConfiguration):
            raise InputError(f"a KUKA configuration cannot be compared with {label}")
        status = 0b111 & ~(self.undecided_status | label.undecided_status)
        turn = 0b111111 & ~(self.undecided_turn | label.undecided_turn)
        return (
            _differing(self.status, label.status, status),
            _differing(self.turn, label.turn, turn),
        )


def label(robot: Robot, q: NDArray[np.float64]) -> KukaConfiguration | None:
    """The label of joint values (N,) rad; None for an arm of another number of axes than six.

    Of a SCARA Turn alone is looked at: what Status counts there no source says.
    """
    if robot.arm_size != 6:
        return None
    at = posture(robot, q)
    if at is None:
        slides = [joint.kind is JointKind.PRISMATIC for joint in robot.joints]
        turns = [0.0 if slide else float(value) for slide, value in zip(slides, q, strict=False)]
        return _turned(turns, status=0, undecided=0b111)
    # Clear of the singular line "in front of it" is A3 above φ.
    status = ((at.shoulder < 0, 1), (at.elbow >= 0, 2), (at.wrist < 0, 4))
    edges = (
        (abs(at.shoulder) <= EDGE_DISTANCE, 1),
        (abs(at.elbow) <= EDGE_DISTANCE, 2),
        (abs(at.wrist) <= EDGE_ANGLE, 4),
    )
    return _turned(
        [float(value) for value in q[:6]],
        status=sum(bit for true, bit in status if true),
        undecided=sum(bit for true, bit in edges if true),
    )


def _turned(axes: Sequence[float], status: int, undecided: int) -> KukaConfiguration:
    return KukaConfiguration(
        status=status,
        turn=sum(1 << i for i, value in enumerate(axes) if value < 0),
        undecided_status=undecided,
        undecided_turn=sum(1 << i for i, value in enumerate(axes) if abs(value) <= EDGE_ANGLE),
    )


def _differing(mine: int | None, its: int | None, mask: int) -> int:
    return 0 if mine is None or its is None else ((mine ^ its) & mask).bit_count()
