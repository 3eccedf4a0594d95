"""Reverse of `path`: a gradient with respect to samples, carried back to the route."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...arrays import FloatArray
from ...errors import FaultCause, MotionError
from ...robot.kinematics.chain_kernels import jacobians
from ..geometry.corners import POSITION, STOP, Corners, ZoneGradient
from ..geometry.curves import Samples, TcpCurves
from ..geometry.joint_curves import CornerEdges, pull_joint_curves, pull_joint_legs
from ..geometry.layout import LayoutGradient, pull_layout
from ..geometry.segments import EndsGradient, SegmentsGradient, pull_segments
from ..geometry.tcp_curves import pull_tcp_curves
from ..model.blend import BlendGradient
from ..path.building import edge_runs, stretches
from ..path.joint_samples import pull_joint
from ..path.path import Path
from ..path.tcp_samples import States, pull_tcp
from ..timing.timed_zones import TimedGradient

SINGULAR_TARGET = 1e8
"""Condition number (m and rad) of the Jacobian from which on a target counts as singular."""


@dataclass
class RouteGradient:
    """Gradient with respect to a route and to the blend laws."""

    ends: EndsGradient
    zones: ZoneGradient
    tcp: BlendGradient
    joint: BlendGradient
    orientation: BlendGradient = field(repr=False)


def pull_path(
    path: Path,
    states_bar: States,
    sigma_bar: FloatArray,
    turn_bar: tuple[FloatArray, FloatArray],
    kept_bar: FloatArray,
    timed_bar: TimedGradient,
) -> RouteGradient:
    """Carry a gradient with respect to the samples back to the route.

    Args:
        path: the path.
        states_bar: gradient with respect to ``path.states``; used up.
        sigma_bar: (S,), gradient with respect to σ of the samples where it enters directly (the
            spacing of intervals); added to.
        turn_bar: (M, 3) each, gradients with respect to the turns a and b of segments where they
            enter directly (limits of their parts).
        kept_bar: (M − 1,), gradient with respect to what corners keep of their blends where that
            enters directly (speeds of arcs).
        timed_bar: gradient with respect to corners that are blended in time, where they enter
            directly (ceilings of speed); added to.

    Raises:
        MotionError: a line begins or ends on a singular configuration.
    """
    _check_regular(path)
    route, layout, pieces = path.route, path.layout, path.pieces
    model = path.model
    layout_bar = LayoutGradient.zeros(layout)
    segments_bar = SegmentsGradient.zeros(layout.segments)
    segments_bar.turn_a += turn_bar[0]
    segments_bar.turn_b += turn_bar[1]
    reach_bar = np.zeros_like(layout.corners.reach)
    gradient = RouteGradient(
        EndsGradient.zeros(route.ends),
        ZoneGradient.zeros(len(route.zones)),
        BlendGradient.zeros(model.tcp),
        BlendGradient.zeros(model.joint),
        BlendGradient.zeros(model.orientation),
    )
    joint_bar = path.joint.zeros_like()
    joint_bar.window[len(route.moves) :] += timed_bar.window
    sigma_bar += timed_bar.sigma
    curves = path.tcp.curves
    # On paths of joint moves alone nothing is added to it.
    tcp_bar = curves if layout.segments.joint_moves_alone else curves.zeros_like()
    sample_piece = pieces.sample_pieces
    for stretch in stretches(route, layout, pieces):
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
    pieces.pull_sigma(sigma_bar, layout_bar.waypoint, layout_bar.extent)
    edges_bar = pull_joint_curves(
        layout,
        model.joint,
        path.edges,
        joint_bar,
        layout_bar,
        segments_bar,
        gradient.ends,
        gradient.joint,
        timed_bar.blends,
    )
    pull_joint_legs(layout, edges_bar, reach_bar, segments_bar, gradient.ends)
    if not layout.segments.joint_moves_alone:
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
    pull_corners(
        layout.corners, reach_bar, kept_bar, timed_bar, segments_bar, gradient.ends, gradient.zones
    )
    pull_segments(layout.segments, segments_bar, gradient.ends)
    return gradient


def pull_corners(
    corners: Corners,
    reach_bar: FloatArray,
    kept_bar: FloatArray,
    timed_bar: TimedGradient,
    segments_bar: SegmentsGradient,
    ends_bar: EndsGradient,
    zones_bar: ZoneGradient,
) -> None:
    """Reverse of `ZonePlanner.corners`: carry the gradients (M − 1, 3, 2) of the reaches,
    (M − 1,) of what is kept of them, and of blends in time back."""
    targets: dict[str, FloatArray] = {
        "length": segments_bar.length,
        "angle": zones_bar.angle,
        "arc": segments_bar.angle,
        "turn": segments_bar.turn,
        "q0": ends_bar.q[:, 0],
        "q1": ends_bar.q[:, 1],
        "tcp": zones_bar.tcp,
        "reorientation": zones_bar.reorientation,
        "external": zones_bar.external,
        "position0": ends_bar.position[:, 0],
        "position1": ends_bar.position[:, 1],
        "speed": ends_bar.speed,
        "acceleration": ends_bar.acceleration,
        "joint_speed": ends_bar.joint_speed,
        "joint_acceleration": ends_bar.joint_acceleration,
        "joint_fraction": ends_bar.joint_fraction,
        "joint_acceleration_fraction": ends_bar.joint_acceleration_fraction,
    }
    for i, blend in corners.timed.items():
        bars = timed_bar.duration[i], *timed_bar.blends[i]
        for reach, bar in zip((blend.duration, *blend.parts), bars, strict=True):
            for name, index, part in reach.parts:
                targets[name][index] += bar * part
    for i, kept in corners.kept.items():
        for name, index, part in kept.parts:
            targets[name][index] += kept_bar[i] * part
    for i, pairs in enumerate(corners.sources):
        if corners.kind[i] == STOP:
            continue
        for channel, pair in enumerate(pairs):
            for side, reach in enumerate(pair):
                bar = reach_bar[i, channel, side]
                if bar == 0.0:
                    continue
                for name, index, part in reach.parts:
                    targets[name][index] += bar * part


def _check_regular(path: Path) -> None:
    """Refuse a path with singular samples, where q has no derivative by the pose."""
    if path.segments.joint_moves_alone:
        return
    pieces, solved = path.pieces, path.route.solved
    for stretch in stretches(path.route, path.layout, pieces):
        if stretch.joint_space:
            continue
        met = stretch.start + np.flatnonzero(path.conditioning[stretch.start : stretch.stop] == 0.0)
        J = jacobians(stretch.chain, np.ascontiguousarray(path.states.q[met]))[:, :, solved]
        for row in met[~(np.linalg.cond(J) < SINGULAR_TARGET)]:
            segment = int(pieces.segment[pieces.sample_pieces[row]])
            raise MotionError(
                "the move begins or ends where the arm is singular, where derivatives do not "
                "exist; begin and end lines where the wrist is bent",
                path.route.moves[segment],
                cause=FaultCause.SINGULARITY,
            )


def _pull_edges(
    path: Path, bar: CornerEdges, tcp_bar: TcpCurves, layout_bar: LayoutGradient
) -> None:
    """Reverse of the edges that inverse kinematics found on TCP legs."""
    route, layout = path.route, path.layout
    for run in edge_runs(route, layout):
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
