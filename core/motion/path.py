"""The geometry of a driven program: q(σ) with zones, sampled, with its reverse.

A path is built in one direction (ends → segments → corners → layout → curves → samples) and
pulled back in the other.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..errors import MotionError, Note
from ..program.zone import Zone
from ..robot.chain import Chain
from .curves import Curves
from .joint_curves import (
    Edges,
    make_joint_curves,
    pull_joint_curves,
    pull_joint_legs,
)
from .joint_samples import pull_joint, sample_joint
from .layout import Layout, LayoutGradient, flat_corners, pull_layout
from .model import MotionModel
from .pieces import Pieces, Sampling, cut
from .segments import (
    JOINT_SEGMENT,
    Ends,
    EndsGradient,
    Segments,
    SegmentsGradient,
    make_segments,
    pull_segments,
)
from .tcp_curves import BlendGradient, TcpGeometry, make_tcp_curves, pull_tcp_curves
from .tcp_samples import SINGULAR, Samples, States, TcpCurves, pull_tcp, sample_tcp
from .zones import (
    JOINT_CORNER,
    POSITION,
    Corners,
    ZoneGradient,
    ZonePlanner,
    pull_corners,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_LEAD = 8
"""Steps in which inverse kinematics walks from a waypoint to the edge of its zone."""
NEAR_SINGULAR = 1e-3
"""Ratio of pivots of the Jacobian below which a stretch is reported as near a singularity."""


@dataclass(frozen=True)
class Route:
    """The waypoints of a program, resolved: what a path is built from.

    Args:
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
        notes: zones cut short, near-singular stretches.
    """

    route: Route
    model: MotionModel
    layout: Layout
    tcp: TcpGeometry
    joint: Curves
    edges: Edges
    pieces: Pieces
    sigma: FloatArray
    states: States
    conditioning: FloatArray
    notes: tuple[Note, ...] = ()

    @property
    def q(self) -> FloatArray:
        """(S, N), the configurations."""
        return self.states.q

    @property
    def segments(self) -> Segments:
        """The nominal segments."""
        return self.layout.segments

    @property
    def corners(self) -> Corners:
        """The zones."""
        return self.layout.corners

    def sample_moves(self) -> IntArray:
        """(S,), index of the move that each sample belongs to."""
        moves = np.array(self.route.moves, dtype=np.int64)
        return moves[self.pieces.segment[self.pieces.sample_pieces]]


def zone_pieces(path: Path, corners: IntArray) -> IntArray:
    """(C, 3), the first piece, the first behind the waypoint and the last piece of C zones of the
    TCP (of the joints, where joints are blended)."""
    layout, edge = path.layout, path.pieces.edge
    middle = 0.5 * (edge[1:] + edge[:-1])
    at = layout.waypoint[corners + 1]
    before, after = layout.extent[corners, POSITION].T
    places = np.stack([at - before, at, at + after], -1)
    return np.asarray(np.searchsorted(middle, places) - np.array([0, 0, 1]))


def build_path(route: Route, model: MotionModel, sampling: Sampling) -> Path:
    """The path along a route of at least one segment.

    Raises:
        MotionError: a zone that cannot be emulated, or a stretch that the arm cannot follow.
    """
    segments = make_segments(route.ends)
    planner = ZonePlanner(segments, route.chains, model, route.moves)
    corners = planner.corners(route.zones)
    layout = Layout.of(segments, corners)
    tcp = make_tcp_curves(layout, model)
    edges = Edges.of_joint_legs(layout)
    for run in _edge_runs(route, layout):
        states, _ = _follow(route, tcp.curves, run)
        for array, part in ((edges.q, states.q), (edges.dq, states.dq), (edges.ddq, states.ddq)):
            array[run.corner, run.side] = part[-1]
    joint = make_joint_curves(layout, model, edges)
    flat = flat_corners(layout, model)
    pieces = cut(layout, tcp.curves, joint, route.paces, flat, sampling)
    sigma = pieces.sigma()
    states = States.zeros(len(sigma), route.ends.q.shape[2])
    conditioning = np.ones(len(sigma))
    for stretch in _stretches(route, layout, pieces):
        view = states.rows(stretch.start, stretch.stop)
        piece = pieces.sample_pieces[stretch.start : stretch.stop]
        at = sigma[stretch.start : stretch.stop]
        if stretch.joint_space:
            sample_joint(stretch.chain, joint, pieces.curve[piece, POSITION], at, view)
            continue
        run = _tcp_run(route, layout, edges, pieces, stretch, piece, at)
        found, pivots = _follow(route, tcp.curves, run)
        lead = len(run.samples.sigma) - len(at)
        for target, source in zip(view, found, strict=True):
            target[:] = source[lead:]
        conditioning[stretch.start : stretch.stop] = pivots[lead:]
    notes = (*route.notes, *corners.notes, *_singular_notes(route, pieces, conditioning))
    return Path(route, model, layout, tcp, joint, edges, pieces, sigma, states, conditioning, notes)


@dataclass(frozen=True)
class _Run:
    """Samples for inverse kinematics to follow, from a configuration near the first one."""

    chain: Chain
    samples: Samples
    seed: FloatArray
    segment: IntArray
    corner: int = -1
    side: int = 0


def _nominal(chain: Chain, sigma: FloatArray, segment: int, seed: FloatArray) -> _Run:
    index = np.full(len(sigma), segment, dtype=np.int64)
    return _Run(chain, Samples(sigma, index, index, index), seed, index)


def _edge_runs(route: Route, layout: Layout) -> Iterator[_Run]:
    """From the waypoint to the edge of its zone, wherever a TCP leg is blended in joint space."""
    for i in np.flatnonzero(layout.corners.kind == JOINT_CORNER):
        for side, near, sign in ((0, 1, -1.0), (1, 0, 1.0)):
            segment = int(i) + side
            if route.ends.kind[segment] == JOINT_SEGMENT:
                continue
            at = layout.waypoint[i + 1]
            edge = at + sign * layout.extent[i, POSITION, side]
            run = _nominal(
                route.chains[segment],
                np.linspace(at, edge, _LEAD + 1),
                segment,
                route.ends.q[segment, near],
            )
            yield _Run(run.chain, run.samples, run.seed, run.segment, int(i), side)


@dataclass(frozen=True)
class _Stretch:
    """Consecutive samples of one space and one chain."""

    chain: Chain
    joint_space: bool
    first_piece: int
    start: int
    stop: int


def _stretches(route: Route, layout: Layout, pieces: Pieces) -> Iterator[_Stretch]:
    first = pieces.first_sample
    begin = 0
    count = len(pieces.segment)
    for p in range(1, count + 1):
        chain = route.chains[pieces.segment[begin]]
        if p < count:
            same_space = pieces.joint_space[p] == pieces.joint_space[begin]
            if same_space and route.chains[pieces.segment[p]] is chain:
                continue
        space = bool(pieces.joint_space[begin])
        yield _Stretch(chain, space, begin, int(first[begin]), int(first[p]))
        begin = p


def _tcp_run(
    route: Route,
    layout: Layout,
    edges: Edges,
    pieces: Pieces,
    stretch: _Stretch,
    piece: IntArray,
    sigma: FloatArray,
) -> _Run:
    """A stretch with what leads to its first sample."""
    segment = int(pieces.segment[stretch.first_piece])
    curve = pieces.curve[piece]
    samples = [sigma, *(curve[:, channel] for channel in range(3))]
    start = layout.waypoint[segment]
    seed = route.ends.q[segment, 0]
    if sigma[0] > start:
        # The stretch follows a corner blended in joint space, which ends at its own edge.
        if segment > 0 and layout.corners.kind[segment - 1] == JOINT_CORNER:
            seed = edges.q[segment - 1, 1]
        else:
            lead = np.linspace(start, sigma[0], _LEAD, endpoint=False)
            index = np.full(_LEAD, segment, dtype=np.int64)
            samples = [
                np.concatenate([lead, sigma]),
                *(np.concatenate([index, channel]) for channel in samples[1:]),
            ]
    arrays = [np.ascontiguousarray(array) for array in samples]
    owners = np.concatenate([np.full(len(arrays[0]) - len(sigma), segment), pieces.segment[piece]])
    return _Run(stretch.chain, Samples(*arrays), seed, owners)


def _follow(route: Route, curves: TcpCurves, run: _Run) -> tuple[States, FloatArray]:
    """Inverse kinematics along a run: states and conditioning."""
    count = len(run.samples.sigma)
    states = States.zeros(count, len(run.seed))
    pivots = np.ones(count)
    if len(route.solved) != 6:
        raise MotionError(
            f"inverse kinematics needs six axes to solve for, this arm offers {len(route.solved)}; "
            "only joint moves can be driven",
            route.moves[int(run.segment[0])],
        )
    failed, error = sample_tcp(
        run.chain,
        route.solved,
        route.prescribed,
        curves,
        run.samples,
        np.ascontiguousarray(run.seed),
        states,
        pivots,
    )
    if failed >= 0:
        _refuse(route, run, failed, error, pivots[failed])
    return states, pivots


def _refuse(route: Route, run: _Run, failed: int, error: float, pivots: float) -> None:
    move = route.moves[int(run.segment[failed])]
    if pivots < SINGULAR:
        raise MotionError(
            "the path of the TCP runs through a singular configuration of the arm; go round it "
            "with a joint move, or turn the tool differently",
            move,
        )
    raise MotionError(
        f"the arm cannot follow the path of the TCP: it stays {1e3 * error:.3g} mm (or mrad) "
        "short of it; bring the points nearer or use a joint move",
        move,
    )


def _singular_notes(route: Route, pieces: Pieces, conditioning: FloatArray) -> list[Note]:
    """One note for every move with a stretch near a singularity."""
    segment = pieces.segment[pieces.sample_pieces]
    notes = []
    for k in np.unique(segment[conditioning < NEAR_SINGULAR]):
        worst = conditioning[segment == k].min()
        notes.append(
            Note(
                f"near a singular configuration (conditioning {worst:.1e}): joints move fast here",
                route.moves[int(k)],
            )
        )
    return notes


@dataclass
class RouteGradient:
    """Gradient with respect to a route and to the blend laws."""

    ends: EndsGradient
    zones: ZoneGradient
    tcp: BlendGradient
    joint: BlendGradient
    orientation: BlendGradient = field(repr=False)


def pull_path(
    path: Path, states_bar: States, sigma_bar: FloatArray, turn_bar: FloatArray
) -> RouteGradient:
    """Carry a gradient with respect to the samples back to the route.

    Args:
        path: the path.
        states_bar: gradient with respect to ``path.states``; used up.
        sigma_bar: (S,), gradient with respect to σ of the samples where it enters directly (the
            spacing of intervals); added to.
        turn_bar: (M, 3), gradient with respect to the turns of segments where they enter directly
            (limits of their parts).
    """
    route, layout, pieces = path.route, path.layout, path.pieces
    model = path.model
    layout_bar = LayoutGradient.zeros(layout)
    segments_bar = SegmentsGradient.zeros(layout.segments)
    segments_bar.turn_b += turn_bar
    reach_bar = np.zeros_like(layout.corners.reach)
    gradient = RouteGradient(
        EndsGradient.zeros(route.ends),
        ZoneGradient.zeros(len(route.zones)),
        BlendGradient.zeros(model.tcp),
        BlendGradient.zeros(model.joint),
        BlendGradient.zeros(model.orientation),
    )
    joint_bar = path.joint.zeros_like()
    curves = path.tcp.curves
    tcp_bar = TcpCurves(
        curves.position.zeros_like(),
        curves.turning.zeros_like(),
        np.zeros_like(curves.reference),
        curves.prescribed.zeros_like(),
    )
    sample_piece = pieces.sample_pieces
    for stretch in _stretches(route, layout, pieces):
        rows = slice(stretch.start, stretch.stop)
        view, view_bar = (s.rows(rows.start, rows.stop) for s in (path.states, states_bar))
        curve = pieces.curve[sample_piece[rows]]
        if stretch.joint_space:
            index = np.ascontiguousarray(curve[:, POSITION])
            pull_joint(
                stretch.chain,
                path.joint,
                index,
                path.sigma[rows],
                view,
                view_bar,
                joint_bar,
                sigma_bar[rows],
            )
            continue
        position, turning, prescribed = (np.ascontiguousarray(c) for c in curve.T)
        samples = Samples(path.sigma[rows], position, turning, prescribed)
        pull_tcp(
            stretch.chain,
            route.solved,
            route.prescribed,
            curves,
            samples,
            view,
            view_bar,
            tcp_bar,
            sigma_bar[rows],
        )
    pieces.pull_sigma(sigma_bar, layout_bar)
    edges_bar = pull_joint_curves(
        layout,
        model,
        path.edges,
        joint_bar,
        layout_bar,
        segments_bar,
        gradient.ends,
        gradient.joint,
    )
    pull_joint_legs(layout, edges_bar, reach_bar, segments_bar, gradient.ends)
    _pull_edges(path, edges_bar, tcp_bar, layout_bar)
    pull_tcp_curves(
        path.tcp,
        tcp_bar,
        layout_bar,
        reach_bar,
        segments_bar,
        gradient.ends,
        gradient.tcp,
        gradient.orientation,
    )
    reach_bar += pull_layout(layout, layout_bar, segments_bar)
    pull_corners(layout.corners, reach_bar, segments_bar, gradient.ends, gradient.zones)
    pull_segments(layout.segments, segments_bar, gradient.ends)
    return gradient


def _pull_edges(path: Path, bar: Edges, tcp_bar: TcpCurves, layout_bar: LayoutGradient) -> None:
    """Reverse of the edges that inverse kinematics found on TCP legs."""
    route, layout = path.route, path.layout
    for run in _edge_runs(route, layout):
        last = run.samples.last()
        at = run.corner, run.side
        size = len(run.seed)
        states = States.zeros(1, size)
        states.q[0], states.dq[0] = path.edges.q[at], path.edges.dq[at]
        states.ddq[0] = path.edges.ddq[at]
        states_bar = States.zeros(1, size)
        states_bar.q[0], states_bar.dq[0], states_bar.ddq[0] = bar.q[at], bar.dq[at], bar.ddq[at]
        sigma_bar = np.zeros(1)
        pull_tcp(
            run.chain,
            route.solved,
            route.prescribed,
            path.tcp.curves,
            last,
            states,
            states_bar,
            tcp_bar,
            sigma_bar,
        )
        layout_bar.waypoint[run.corner + 1] += sigma_bar[0]
        sign = -1.0 if run.side == 0 else 1.0
        layout_bar.extent[run.corner, POSITION, run.side] += sign * sigma_bar[0]
