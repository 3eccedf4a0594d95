"""How a path changes along directions: its segments, zones, curves, and configurations on it.

Forward mode of `building`, step by step beside the reverse of `path_gradient`: ends → segments →
reaches → layout → curves → edges → joint curves → configurations.
"""

from __future__ import annotations

from itertools import groupby

import numpy as np

from ...arrays import FloatArray, IntArray
from ..geometry.corners import JOINT_CORNER, POSITION
from ..geometry.curves import Samples
from ..geometry.cutting import curves_at
from ..geometry.joint_curves import CornerEdges
from ..geometry.segments import JOINT_SEGMENT
from ..path.building import edge_runs
from ..path.path import Path
from ..path.tcp_samples import States
from .curve_tangents import push_joint_curves, push_joint_legs, push_layout, push_tcp_curves
from .segment_tangents import Directions, ReachTangents, push_ends, push_segments
from .tcp_tangents import push_state, push_tcp, push_values


class PathTangents:
    """Derivatives of one path along K directions; active rules, branches and samples are held.

    Args:
        path: the path.
        directions: of its waypoints and zones.

    Attributes:
        reaches: how those of the zones change.
        layout: how σ of everything changes.
    """

    def __init__(self, path: Path, directions: Directions) -> None:
        self._path = path
        route = path.route
        ends = push_ends(route.ends, route.chains, route.prescribed, directions.waypoints)
        segments = push_segments(path.segments, ends)
        self.reaches = ReachTangents(directions, ends, segments)
        self.layout = push_layout(path.layout, self.reaches, segments)
        self._tcp = push_tcp_curves(path.tcp, ends, segments, self.layout)
        edges = push_joint_legs(path.layout, directions.waypoints, segments, self.layout)
        self._push_edges(edges)
        self._joint = push_joint_curves(
            path.layout,
            path.model.joint,
            path.edges,
            edges,
            path.joint,
            directions.waypoints,
            segments,
            self.layout,
            self.reaches,
        )

    def configurations(self, sigma: FloatArray, q: FloatArray, sigma_dot: FloatArray) -> FloatArray:
        """(L, N, K), how configurations change at places that move along the path.

        Args:
            sigma: (L,), of the places.
            q: (L, N), there.
            sigma_dot: (L, K), how σ of the places changes.
        """
        path, layout = self._path, self._path.layout
        last = len(path.segments.scale) - 1
        segment = np.clip(np.searchsorted(layout.waypoint, sigma, "right") - 1, 0, last)
        curve, corner, inside = curves_at(layout, sigma, segment)
        kind = np.append(path.corners.kind, 0)[corner]
        joint = path.segments.ends.kind[segment] == JOINT_SEGMENT
        joint |= inside[:, POSITION] & (kind == JOINT_CORNER)
        out = np.zeros((*q.shape, sigma_dot.shape[1]))
        rows = np.flatnonzero(joint)
        if rows.size:
            found = np.empty((len(rows), *out.shape[1:]))
            piece = np.ascontiguousarray(curve[rows, POSITION])
            push_values(path.joint, piece, sigma[rows], self._joint, sigma_dot[rows], found)
            out[rows] = found
        for rows in self._by_chain(np.flatnonzero(~joint), segment):
            found = np.zeros((len(rows), *out.shape[1:]))
            samples = Samples(sigma[rows], *(np.ascontiguousarray(c) for c in curve[rows].T))
            push_tcp(
                path.route.chains[segment[rows[0]]],
                path.route.solved,
                path.route.prescribed,
                path.tcp.curves,
                samples,
                np.ascontiguousarray(q[rows]),
                self._tcp,
                np.ascontiguousarray(sigma_dot[rows]),
                found,
            )
            out[rows] = found
        return out

    def _by_chain(self, rows: IntArray, segment: IntArray) -> list[IntArray]:
        """Rows in groups of one chain."""
        chains = self._path.route.chains
        ordered = sorted(rows.tolist(), key=lambda row: id(chains[segment[row]]))
        groups = groupby(ordered, key=lambda row: id(chains[segment[row]]))
        return [np.array(list(group)) for _, group in groups]

    def _push_edges(self, edges_dot: CornerEdges) -> None:
        """How the edges change that inverse kinematics found on TCP legs."""
        path = self._path
        route, layout = path.route, path.layout
        for run in edge_runs(route, layout):
            at = run.corner, run.side
            size = len(run.seed)
            state = States.zeros(1, size)
            state.q[0], state.dq[0], state.ddq[0] = (
                array[at] for array in (path.edges.q, path.edges.dq, path.edges.ddq)
            )
            sign = -1.0 if run.side == 0 else 1.0
            extent_dot = self.layout.extent[run.corner, POSITION, run.side]
            sigma_dot = self.layout.waypoint[run.corner + 1] + sign * extent_dot
            found = np.zeros((3, size, len(sigma_dot)))
            push_state(
                run.chain,
                route.solved,
                route.prescribed,
                path.tcp.curves,
                run.samples.last(),
                state,
                self._tcp,
                sigma_dot,
                found,
            )
            edges_dot.q[at], edges_dot.dq[at], edges_dot.ddq[at] = found
