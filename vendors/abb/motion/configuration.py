"""ABB's label for an inverse-kinematics solution: confdata."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ....core.errors import InputError
from ....core.program.target import Configuration
from ....core.robot.model import Robot
from ....core.robot.posture import posture
from ..values.records import ARM_AXES

EDGE_ANGLE = 1e-3
"""rad. Programs hold quaternions of five to seven digits, so an axis that was taught at 90° comes
back from inverse kinematics off by up to 1e-4 rad. Solutions that share cfx lie whole turns
apart, so a generous edge never confuses them."""

EDGE_DISTANCE = 1e-3
"""m, the same for the wrist's centre beside axis 1 and beside the lower arm."""

_QUADRANT = math.pi / 2
_ALL = 7
"""The bits of cfx."""
_POSTURE, _WRIST = 6, 1
"""Those of shoulder and elbow, and that of axis 5."""
_GREATEST_OF_SEVEN = 9999
_USUAL_OF_SEVEN = 4


@dataclass(frozen=True, slots=True)
class AbbConfiguration:
    """``[cf1, cf4, cf6, cfx]`` of a six-axis arm.

    cf1, cf4 and cf6 are the quadrants of axes 1, 4 and 6: floor(angle / 90°), so 0 for 0..90°, -1
    for -90..0° ("RAPID Reference Manual", confdata). cfx numbers the eight postures:

        4 · (wrist centre behind axis 1) + 2 · (behind the lower arm) + (axis 5 negative)

    (tables of RobotComponents, ARTE and others from the manual's newer editions; older arms with
    fewer solutions write 0).

    Args:
        edges: of a solution's label: which of axes 1, 4, 6 stand on the lower edge of their
            quadrant, so that the quadrant below fits as well.
        undecided: of a solution's label: bits of cfx whose quantity is about zero.
        seven: whether the arm has seven axes, of which newer controllers write a cfx of up to four
            digits.
        cut: of a solution's label of such an arm: for axes 1, 4 and 6 the quadrants that count
            beside such a cfx.
    """

    cf1: int
    cf4: int
    cf6: int
    cfx: int
    edges: tuple[bool, bool, bool] = field(default=(False, False, False), compare=False, repr=False)
    undecided: int = field(default=0, compare=False, repr=False)
    seven: bool = field(default=False, compare=False, repr=False)
    cut: tuple[tuple[int, ...], ...] = field(default=(), compare=False, repr=False)

    def __post_init__(self) -> None:
        if not 0 <= self.cfx <= (_GREATEST_OF_SEVEN if self.seven else _ALL):
            raise InputError(f"cfx numbers eight postures from 0 to 7, not {self.cfx}")

    def __str__(self) -> str:
        """As RAPID writes it."""
        return f"[{self.cf1},{self.cf4},{self.cf6},{self.cfx}]"

    @property
    def record(self) -> tuple[float, ...]:
        """As a confdata."""
        return tuple(map(float, (self.cf1, self.cf4, self.cf6, self.cfx)))

    @property
    def hint(self) -> bool:
        """Whether it names no solution: where it leaves all of them open."""
        return self.undecided & _POSTURE == _POSTURE

    def admits(self, label: Configuration) -> bool:
        """Whether cfx is the label's, and each quadrant the label's or a neighbour of it.

        So RobotStudio's API says which solutions comply with a target ("ConfigurationMode"), and
        so pallets are driven whose places were computed from one taught on the other side of axis
        1's zero. Solutions of one cfx lie whole turns apart, so that one at most is admitted.

        Raises:
            InputError: the label is another vendor's.
        """
        turns, bits = self._differences(label)
        return bits == 0 and max(turns) <= 1

    def mismatch(self, label: Configuration) -> float:
        """Quadrants between the axes, plus the bits in which cfx differs; 0 for a match.

        Raises:
            InputError: the label is another vendor's.
        """
        turns, bits = self._differences(label)
        return float(sum(turns) + bits)

    def _differences(self, label: Configuration) -> tuple[list[int], int]:
        """Quadrants between axes 1, 4 and 6; number of bits in which cfx differs."""
        if not isinstance(label, AbbConfiguration):
            raise InputError(f"an ABB configuration cannot be compared with {label}")
        digits = max(self.cfx, label.cfx) > _ALL
        pairs = zip(self._quadrants(digits), label._quadrants(digits), strict=True)
        turns = [min(abs(a - b) for a in mine for b in its) for mine, its in pairs]
        decided = 0 if digits else _ALL & ~(self.undecided | label.undecided)
        return turns, ((self.cfx ^ label.cfx) & decided).bit_count()

    def _quadrants(self, digits: bool) -> Sequence[tuple[int, ...]]:
        """For axes 1, 4 and 6 the quadrants that fit, beside a cfx of several digits or not."""
        if digits and self.cut:
            return self.cut
        quadrants = zip((self.cf1, self.cf4, self.cf6), self.edges, strict=True)
        return [(cf, cf - 1) if edge else (cf,) for cf, edge in quadrants]


def label(robot: Robot, q: NDArray[np.float64]) -> AbbConfiguration | None:
    """The label of joint values (N,) rad; None for an arm of another number of axes than six, but
    for those of ABB with seven.

    Of those cf1, cf4 and cf6 are the quarter turns that axes 1, 4 and 6 are nearest to, and 1 in
    cfx that axis 5 is negative: so count the robtargets of programs for the IRB 14000, but those
    whose cfx has several digits, which count quadrants as on six axes (docs/reference/robots.md).
    The rest of their cfx is not looked at, nor the whole of it where
    the arm has fewer motors, and then one posture, or no spherical wrist (CRB 15000, IRB 5500),
    where no source says what it counts.
    """
    seven = robot.arm_angle_reference is not None
    if robot.arm_size != ARM_AXES and not seven:
        return None
    shift = 0.5 if seven else 0.0
    quarters = [float(q[axis]) / _QUADRANT + shift for axis in (0, 3, 5)]
    cf1, cf4, cf6 = (math.floor(quarter + EDGE_ANGLE / _QUADRANT) for quarter in quarters)
    edges = [abs(v - round(v)) * _QUADRANT <= EDGE_ANGLE for v in quarters]
    at = None if seven else posture(robot, q)
    cut = tuple(_cut(float(q[axis]) / _QUADRANT) for axis in (0, 3, 5)) if seven else ()
    bits: tuple[tuple[float, float, int], ...] = ()
    left_open, usual = _ALL, 0
    if seven:
        bits = ((float(q[4]), EDGE_ANGLE, _WRIST),)
        left_open, usual = _POSTURE, _USUAL_OF_SEVEN
    if at is not None and not robot.has_held:
        bits = (
            (at.shoulder, EDGE_DISTANCE, 4),
            (at.elbow, EDGE_DISTANCE, 2),
            (at.wrist, EDGE_ANGLE, _WRIST),
        )
        left_open = 0
    return AbbConfiguration(
        cf1,
        cf4,
        cf6,
        cfx=usual + sum(bit for value, _, bit in bits if value < 0),
        edges=(edges[0], edges[1], edges[2]),
        undecided=left_open + sum(bit for value, edge, bit in bits if abs(value) <= edge),
        seven=seven,
        cut=cut,
    )


def _cut(quarter: float) -> tuple[int, ...]:
    """The quadrants of an angle in quarter turns: two where it is about where they meet."""
    edge = EDGE_ANGLE / _QUADRANT
    return tuple(sorted({math.floor(quarter - edge), math.floor(quarter + edge)}))
