"""The geometry of a driven program as values: its route, and q(σ) with zones, sampled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...display import counted, in_line
from ...errors import MotionError, Note
from ...program.zone import Zone
from ...robot.kinematics.chain import Chain
from ...robot.model import Robot
from ..geometry.corners import Corners, Room
from ..geometry.curves import Curves
from ..geometry.joint_curves import CornerEdges
from ..geometry.layout import Layout, flat_corners
from ..geometry.pieces import Pieces
from ..geometry.segments import Ends, Segments
from ..geometry.tcp_curves import TcpGeometry
from ..model.motion_model import MotionModel
from .tcp_samples import States


class OverlapError(MotionError):
    """Blends overlap that the controller does not shrink: it leaves waypoints out.

    Args:
        move: index of the first move concerned.
        corners: which of the route's corners go.
    """

    def __init__(self, move: int, corners: tuple[int, ...]) -> None:
        super().__init__("its blend overlaps a neighbouring one: make the blend smaller", move)
        self.corners = corners


@dataclass(frozen=True)
class Route:
    """The waypoints of a program, resolved: what a path is built from.

    Args:
        robot: what drives it.
        ends: of the M segments; a move that goes nowhere has none.
        chains: one chain object per segment, shared by segments of one tool and work object.
        moves: index in the program of each segment's move.
        zones: M − 1, at the inner waypoints; `Fine` at stops of any kind.
        zone_moves: M − 1, index of the move that programs each zone.
        dwell: (M + 1,) s, waits at the waypoints.
        paces: (M + 1,) bool, waypoints at which the programmed speed changes.
        solved: (6,) axes that inverse kinematics solves for; empty if no segment needs it.
        prescribed: (m,) the other axes.
        notes: what was found on the way.
        left_out: indices of moves whose waypoint the controller leaves out.
    """

    robot: Robot
    ends: Ends
    chains: tuple[Chain, ...]
    moves: tuple[int, ...]
    zones: tuple[Zone, ...]
    zone_moves: tuple[int, ...]
    dwell: FloatArray
    paces: NDArray[np.bool_]
    solved: IntArray
    prescribed: IntArray
    notes: tuple[Note, ...] = ()
    left_out: tuple[int, ...] = ()

    def __repr__(self) -> str:
        return in_line(
            f"Route of {self.robot.name}: {counted(self.moves, 'segment')}, "
            f"{self.dwell.sum():.3f} s of waits, {counted(self.notes, 'note')}"
        )


@dataclass(frozen=True)
class Path:
    """A path and everything it was made of.

    Samples stand at both ends of every piece, so that derivatives are one-sided there.

    Args:
        route: the waypoints.
        model: the vendor's rules.
        layout: where segments and zones lie on σ.
        tcp: TCP-space curves.
        joint: joint-space curves.
        edges: joint states at the edges of corners blended in joint space.
        pieces: the pieces.
        sigma: (S,), σ of the samples.
        states: the samples; derivatives are with respect to σ.
        conditioning: (S,), of the Jacobian at TCP-space samples (smallest over largest pivot),
            1 elsewhere.
        rooms: tells what room the vendor's rules leave between neighbouring zones.
        notes: zones cut short, near-singular stretches.
    """

    route: Route
    model: MotionModel
    layout: Layout
    tcp: TcpGeometry
    joint: Curves
    edges: CornerEdges
    pieces: Pieces
    sigma: FloatArray
    states: States
    conditioning: FloatArray
    rooms: Callable[[], list[Room]]
    notes: tuple[Note, ...] = ()

    def __repr__(self) -> str:
        return in_line(
            f"Path of {self.route.robot.name}: {counted(self.route.moves, 'segment')}, "
            f"{counted(self.sigma, 'sample')}, {counted(self.notes, 'note')}"
        )

    @property
    def q(self) -> FloatArray:
        """(S, N), the configurations."""
        return self.states.q

    @property
    def segments(self) -> Segments:
        """The nominal segments."""
        return self.layout.segments

    @property
    def flat_corners(self) -> NDArray[np.bool_]:
        """(M − 1,), corners whose blend law is flat at its ends."""
        model = self.model
        return flat_corners(self.corners.kind, model.tcp.flat, model.joint.meets_curvature)

    @property
    def corners(self) -> Corners:
        """The zones."""
        return self.layout.corners

    def sample_moves(self) -> IntArray:
        """(S,), index of the move that each sample belongs to."""
        moves = np.array(self.route.moves, dtype=np.int64)
        return moves[self.pieces.segment[self.pieces.sample_pieces]]
