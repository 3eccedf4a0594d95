"""Where the arm arrives that follows the nominal paths of moves of the TCP, without zones.

A line that turns the tool by half a turn is as short either way round, and rounding decides. Where
the arm arrives with another configuration than is programmed, and turning the tool the other way
round leads to that, it is taken to go there: who taught the target saw the controller do so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import FaultCause, MotionError
from ...program.move import Move
from ...robot.kinematics.chain import Chain
from ...robot.model import Robot
from ...spatial.rotation import matrix_from_rotation_vector
from ..configurations.finder import ConfigurationFinder
from ..configurations.targets import located
from ..geometry.corners import Corners
from ..geometry.curves import Samples, TcpCurves
from ..geometry.layout import Layout
from ..geometry.segments import LINE_SEGMENT, Ends, Segments, make_segments
from ..geometry.tcp_curves import make_tcp_curves
from ..model.blend import PARABOLA
from .tcp_samples import CONVERGED, States
from .tcp_walk import sample_tcp
from .unreachable import why_stranded

_HALF = np.pi - 2e-5
"""rad from which a turn is half a turn: many times what the digits of any language leave open."""
_SHORT = 1e-7
"""rad by which a turn the other way round is shorter than half a turn."""


class Nominal:
    """Paths of moves that share a tool and a work object.

    Args:
        chain: the kinematics.
        moves: their indices.
        ends: poses and prescribed axes at their ends.

    Attributes:
        segments, curves: on which segment k spans σ from k to k + 1.
        samples: on the way, one segment after the other.
        first: (M + 1,), the first of each segment's samples, and how many there are.
    """

    def __init__(self, chain: Chain, moves: Sequence[int], ends: Ends) -> None:
        self.chain = chain
        self.moves = moves
        self._ends = ends
        self.segments: Segments
        self.curves: TcpCurves
        self.samples: Samples
        self.first: IntArray
        self._lead()

    def _lead(self) -> None:
        """Lead the segments from end to end."""
        self.segments = make_segments(self._ends)
        self.curves = _curves(self.segments)
        self.samples, self.first = _steps(self.segments)

    def turn_round(self, k: int) -> bool:
        """Turn the tool the other way round on a segment; False where that is another way."""
        ends, turn = self._ends, self.segments.turn_b[k]
        size = float(np.linalg.norm(turn))
        if ends.kind[k] != LINE_SEGMENT or size < _HALF or self.segments.turn_a[k].any():
            return False
        other = matrix_from_rotation_vector(-turn / size * (np.pi - _SHORT))
        ends.rotation[k, 1] = ends.rotation[k, 0] @ other
        if k + 1 < len(ends.kind):
            ends.rotation[k + 1, 0] = ends.rotation[k, 1]
        self._lead()
        return True


class PathFollower:
    """Follows paths of one robot.

    Args:
        robot: the robot.
        finder: holds what is arrived with against what is programmed.

    Attributes:
        turned: indices of the moves on which the tool turns the other way round than rounding has
            it.
    """

    def __init__(self, robot: Robot, finder: ConfigurationFinder) -> None:
        self._robot = robot
        self._finder = finder
        self._targets = finder.targets
        self.turned: set[int] = set()

    def follow(
        self, moves: Sequence[Move], nominal: Nominal, which: range, q: FloatArray
    ) -> FloatArray:
        """Where the arm arrives that follows segments in a row from q.

        Writes the configurations at the ends of each.

        Raises:
            MotionError: it cannot be followed, or the arm arrives with another configuration.
        """
        refused: dict[int, MotionError] = {}
        while True:
            try:
                return self._walk(moves, nominal, which, q)
            except MotionError as error:
                i = error.move
                if i in refused:
                    raise refused[i] from None
                wrong = error.cause is FaultCause.CONFIGURATION and i in nominal.moves
                if i is None or not wrong or not nominal.turn_round(nominal.moves.index(i)):
                    raise
                refused[i] = error
                self.turned.add(i)

    def _walk(
        self, moves: Sequence[Move], nominal: Nominal, which: range, q: FloatArray
    ) -> FloatArray:
        if len(self._targets.solved) != 6:
            i = nominal.moves[which[0]]
            raise located(
                moves[i],
                i,
                f"{self._robot.name} has {self._robot.arm_size} joints; only arms with six or "
                "seven can follow a path of the TCP",
            )
        segments, begin, end = nominal.segments, which.start, which.stop
        samples = nominal.samples.rows(int(nominal.first[begin]), int(nominal.first[end]))
        last = (nominal.first[begin + 1 : end + 1] - nominal.first[begin] - 1).tolist()
        states = States.zeros(len(samples.sigma), self._robot.size)
        failed, short, reached = sample_tcp(
            nominal.chain,
            self._targets.solved,
            self._targets.prescribed,
            nominal.curves,
            samples,
            np.array([0, len(samples.sigma)]),
            q[None],
            states,
            np.ones(len(samples.sigma)),
        )
        for k, at in zip(which, last, strict=True):
            i = nominal.moves[k]
            segments.ends.q[k, 0] = q
            if 0 <= failed <= at:
                near = states.q[failed]
                length = float(segments.length[k])
                reason = self._targets.why_unreachable(moves[i], q) if short > CONVERGED else None
                if reason is not None:
                    why = f"target cannot be reached: {reason}"
                    raise located(moves[i], i, why, reason.cause)
                raise located(
                    moves[i], i, *why_stranded(self._robot, near, reached - k, length, short)
                )
            q = segments.ends.q[k, 1] = states.q[at].copy()
            self._finder.check_arrival(moves[i], i, q)
        return q


def _curves(segments: Segments) -> TcpCurves:
    count = len(segments.scale)
    corners = Corners(np.zeros(count - 1, dtype=np.int64), np.zeros((count - 1, 3, 2)), [])
    unit = replace(segments, scale=np.ones(count))
    return make_tcp_curves(Layout.of(unit, corners), PARABOLA, PARABOLA).curves


def _steps(segments: Segments) -> tuple[Samples, IntArray]:
    """Samples on the nominal paths of segments; see `Nominal`."""
    turns = np.linalg.norm([segments.turn_a, segments.turn_b], axis=2).sum(axis=0)
    finest = np.maximum(segments.length / 0.1, segments.angle / 0.2)
    steps = 1 + np.maximum(finest, turns / 0.2).astype(np.int64)
    counts = steps + 1
    first = np.concatenate([[0], np.cumsum(counts)])
    owner = np.repeat(np.arange(len(counts)), counts)
    own = np.arange(first[-1]) - np.repeat(first[:-1], counts)
    sigma = owner + own / np.repeat(steps, counts)
    return Samples(sigma, owner, owner, owner), first
