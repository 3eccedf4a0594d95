"""Builds the path along a route: ends → segments → corners → layout → curves → samples.

It is pulled back in the other direction by `flyby.core.motion.gradients.path_gradient`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby, pairwise

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...errors import FaultCause, MotionError, Note
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.lean import lean
from ...robot.singularities import nearest_singularity
from ..geometry.corners import JOINT_CORNER, POSITION
from ..geometry.curves import Curves, Samples, TcpCurves
from ..geometry.cutting import cut
from ..geometry.joint_curves import CornerEdges, make_joint_curves
from ..geometry.layout import Layout, flat_corners
from ..geometry.pieces import Pieces, Sampling
from ..geometry.segments import JOINT_SEGMENT, make_segments
from ..geometry.tcp_curves import make_tcp_curves
from ..geometry.zones import ZonePlanner
from ..model.motion_model import MotionModel
from .joint_samples import sample_joint
from .path import OverlapError, Path, Route
from .tcp_samples import States
from .tcp_walk import JOINED, sample_tcp
from .unreachable import why_stranded

_LEAD = 8
"""Steps in which inverse kinematics walks from a waypoint to the edge of its zone."""
NEAR_SINGULAR = 1e-3
"""Ratio of pivots of the Jacobian below which a stretch is reported as near a singularity."""
_MISSED = 0.01
"""rad or m by which joints may go on between samples otherwise than these tell."""
_FINER, _FINEST = 4, 8000
"""How many times finer samples are made that miss something; most even intervals of a piece."""


def build_path(route: Route, model: MotionModel, sampling: Sampling) -> Path:
    """The path along a route of at least one segment.

    Raises:
        OverlapError: blends overlap.
        MotionError: a zone that cannot be emulated, or a stretch that the arm cannot follow.
    """
    segments = make_segments(route.ends)
    planner = ZonePlanner(segments, route.chains, model, route.moves, route.robot.limits)
    corners = planner.corners(route.zones)
    if corners.overlapping:
        raise OverlapError(route.moves[corners.overlapping[0]], corners.overlapping)
    layout = Layout.of(segments, corners)
    tcp = make_tcp_curves(layout, model.tcp, model.orientation)
    edges = CornerEdges.of_joint_legs(layout)
    runs = [] if segments.joint_moves_alone else list(edge_runs(route, layout))
    for run, states, _ in _followed(route, layout, tcp.curves, runs):
        for array, part in ((edges.q, states.q), (edges.dq, states.dq), (edges.ddq, states.ddq)):
            array[run.corner, run.side] = part[-1]
    joint = make_joint_curves(layout, model.joint, edges)
    flat = flat_corners(corners.kind, model.tcp.flat, model.joint.meets_curvature)
    pieces = cut(layout, tcp.curves, joint, route.paces, flat, sampling)
    sigma, states, conditioning = _sampled(route, layout, tcp.curves, joint, edges, pieces)
    while (coarse := _coarse(pieces, sigma, states)).any():
        _check_fine_enough(route, layout, pieces, sigma, states, coarse)
        pieces = pieces.refined(coarse, _FINER)
        sigma, states, conditioning = _sampled(route, layout, tcp.curves, joint, edges, pieces)
    _check_joined(route, pieces, states.q)
    notes = (*route.notes, *corners.notes, *_singular_notes(route, pieces, states.q, conditioning))
    sampled = sigma, states, conditioning
    rooms = partial(planner.rooms, route.zones)
    return Path(route, model, layout, tcp, joint, edges, pieces, *sampled, rooms, notes)


def _sampled(
    route: Route,
    layout: Layout,
    curves: TcpCurves,
    joint: Curves,
    edges: CornerEdges,
    pieces: Pieces,
) -> tuple[FloatArray, States, FloatArray]:
    """σ (S,), states and conditioning (S,) of the samples."""
    sigma = pieces.sigma()
    states = States.zeros(len(sigma), route.ends.q.shape[2])
    conditioning = np.ones(len(sigma))
    runs: list[TcpRun] = []
    ends: list[int] = []
    for stretch in stretches(route, layout, pieces):
        piece = pieces.sample_pieces[stretch.start : stretch.stop]
        at = sigma[stretch.start : stretch.stop]
        if stretch.joint_space:
            view = states.rows(stretch.start, stretch.stop)
            sample_joint(stretch.chain, joint, pieces.curve[piece, POSITION], at, view)
            continue
        runs.append(_tcp_run(route, layout, edges, pieces, stretch, piece, at))
        ends.append(stretch.stop)
    followed = _followed(route, layout, curves, runs)
    for (run, found, pivots), stop in zip(followed, ends, strict=True):
        start = stop - len(pivots) + run.lead
        for target, source in zip(states, found, strict=True):
            target[start:stop] = source[run.lead :]
        conditioning[start:stop] = pivots[run.lead :]
    return sigma, states, conditioning


def _coarse(pieces: Pieces, sigma: FloatArray, states: States) -> NDArray[np.bool_]:
    """(P,), pieces on which joints turn between samples in a way that the samples do not show.

    Next to a singular configuration axes turn by half a turn within a fraction of a millimetre;
    timing and motion between samples are made of what samples tell.
    """
    if pieces.joint_space.all():
        return np.zeros(len(pieces.segment), dtype=np.bool_)
    h = np.diff(sigma)[:, None]
    told = (h**2 / 12) * (states.ddq[:-1] - states.ddq[1:])
    told += (0.5 * h) * (states.dq[:-1] + states.dq[1:])
    told -= states.q[1:]
    told += states.q[:-1]
    missed = (told > _MISSED) | (told < -_MISSED)
    # From one piece to the next is no way.
    missed[pieces.first_sample[1:-1] - 1] = False
    coarse = np.zeros(len(pieces.segment), dtype=np.bool_)
    coarse[pieces.sample_pieces[np.flatnonzero(missed.any(axis=1))]] = True
    return coarse & ~pieces.joint_space


def _check_fine_enough(
    route: Route,
    layout: Layout,
    pieces: Pieces,
    sigma: FloatArray,
    states: States,
    coarse: NDArray[np.bool_],
) -> None:
    """Refuse a path on which joints turn within less than the finest samples show."""
    worst = np.flatnonzero(coarse & (_FINER * pieces.even > _FINEST))
    if not len(worst):
        return
    first = pieces.first_sample[worst[0] : worst[0] + 2]
    q = states.q[first[0] : first[1]]
    apart = np.abs(np.diff(q, axis=0))
    row, axis = np.unravel_index(np.argmax(apart), apart.shape)
    k, at = int(pieces.segment[worst[0]]), sigma[first[0] + row : first[0] + row + 2]
    share, length = (at - layout.waypoint[k]) / layout.segments.scale[k], layout.segments.length[k]
    kind = nearest_singularity(route.robot, q[row])
    of, remedy = ("", "use a joint move") if kind is None else (f" of the {kind.name}", kind.remedy)
    raise MotionError(
        f"joint {route.robot.axis_names[axis]} would have to turn by {apart[row, axis]:.3g} (rad "
        f"or m) within {1e3 * float(np.diff(share)[0]) * length:.2g} mm, after "
        f"{100 * share[0]:.0f} % of the move: the path passes a singular configuration{of} too "
        f"near to be driven; {remedy}",
        route.moves[k],
        cause=FaultCause.SINGULARITY,
    )


@dataclass(frozen=True)
class TcpRun:
    """Samples for inverse kinematics to follow, from a configuration near the first one.

    Args:
        chain: the kinematics.
        samples: that follow each other along σ.
        seed: (N,), the configuration.
        segment: (S,), whose the samples are.
        lead: how many of them only lead to the first that is wanted.
        corner, side: of a run to the edge of a zone.
    """

    chain: Chain
    samples: Samples
    seed: FloatArray
    segment: IntArray
    lead: int = 0
    corner: int = -1
    side: int = 0


def _nominal(chain: Chain, sigma: FloatArray, segment: int, seed: FloatArray) -> TcpRun:
    index = np.full(len(sigma), segment, dtype=np.int64)
    return TcpRun(chain, Samples(sigma, index, index, index), seed, index)


def edge_runs(route: Route, layout: Layout) -> Iterator[TcpRun]:
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
            yield TcpRun(run.chain, run.samples, run.seed, run.segment, _LEAD, int(i), side)


@dataclass(frozen=True)
class SampledStretch:
    """Consecutive samples of one space and one chain."""

    chain: Chain
    joint_space: bool
    first_piece: int
    start: int
    stop: int


def stretches(route: Route, layout: Layout, pieces: Pieces) -> Iterator[SampledStretch]:
    """The stretches of a path, in its order."""
    first = pieces.first_sample
    if pieces.joint_space.all() and all(chain is route.chains[0] for chain in route.chains):
        yield SampledStretch(route.chains[0], True, 0, 0, int(first[-1]))
        return
    begin = 0
    count = len(pieces.segment)
    for p in range(1, count + 1):
        chain = route.chains[pieces.segment[begin]]
        if p < count:
            same_space = pieces.joint_space[p] == pieces.joint_space[begin]
            if same_space and route.chains[pieces.segment[p]] is chain:
                continue
        space = bool(pieces.joint_space[begin])
        yield SampledStretch(chain, space, begin, int(first[begin]), int(first[p]))
        begin = p


def _tcp_run(
    route: Route,
    layout: Layout,
    edges: CornerEdges,
    pieces: Pieces,
    stretch: SampledStretch,
    piece: IntArray,
    sigma: FloatArray,
) -> TcpRun:
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
            lead = np.linspace(start, sigma[0], _LEAD + 1)
            index = np.full(len(lead), segment, dtype=np.int64)
            samples = [
                np.concatenate([lead, sigma]),
                *(np.concatenate([index, channel]) for channel in samples[1:]),
            ]
    arrays = [np.ascontiguousarray(array) for array in samples]
    ahead = len(arrays[0]) - len(sigma)
    owners = np.concatenate([np.full(ahead, segment), pieces.segment[piece]])
    return TcpRun(stretch.chain, Samples(*arrays), seed, owners, ahead)


def _followed(
    route: Route, layout: Layout, curves: TcpCurves, runs: Sequence[TcpRun]
) -> Iterator[tuple[TcpRun, States, FloatArray]]:
    """Inverse kinematics along runs: states and conditioning of each; see `sample_tcp`."""
    for _, same in groupby(runs, key=lambda run: id(run.chain)):
        yield from _follow(route, layout, curves, list(same))


def _follow(
    route: Route, layout: Layout, curves: TcpCurves, runs: Sequence[TcpRun]
) -> Iterator[tuple[TcpRun, States, FloatArray]]:
    """`_followed` for runs of one chain."""
    if len(route.solved) != 6:
        raise MotionError(
            f"inverse kinematics needs six axes to solve for, this arm offers {len(route.solved)}; "
            "only joint moves can be driven",
            route.moves[int(runs[0].segment[0])],
        )
    first = np.cumsum([0, *(len(run.samples.sigma) for run in runs)])
    count, seeds = int(first[-1]), np.array([run.seed for run in runs])
    states, pivots = States.zeros(count, seeds.shape[1]), np.ones(count)
    samples = Samples(*map(np.concatenate, zip(*(run.samples for run in runs), strict=True)))
    failed, short, reached = sample_tcp(
        runs[0].chain,
        route.solved,
        route.prescribed,
        curves,
        samples,
        first,
        seeds,
        states,
        pivots,
    )
    if failed >= 0:
        k = int(np.concatenate([run.segment for run in runs])[failed])
        share = (reached - layout.waypoint[k]) / layout.segments.scale[k]
        length = float(layout.segments.length[k])
        message, cause = why_stranded(route.robot, states.q[failed], float(share), length, short)
        raise MotionError(message, route.moves[k], cause=cause)
    for run, (start, stop) in zip(runs, pairwise(first), strict=True):
        yield run, states.rows(start, stop), pivots[start:stop]


def _check_joined(route: Route, pieces: Pieces, q: FloatArray) -> None:
    """Refuse a path on which the joints jump from one piece to the next, or at its stops."""
    first, ends = pieces.first_sample, route.ends.q
    if _joined(ends, pieces.stop, pieces.source, first, q):
        return
    arrive = np.concatenate([ends[:1, 0], ends[:, 1]])
    leave = np.concatenate([ends[:, 0], ends[-1:, 1]])
    left = np.concatenate([arrive[:1], q[first[1:] - 1]])
    right = np.concatenate([q[first[:-1]], leave[-1:]])
    apart = np.abs(right - left)
    # At stops a route may join what lies apart (see `flyby.problems.improve.zones.neighbourhood`).
    stops = np.flatnonzero(pieces.stop)
    waypoint = pieces.source[stops, 0]
    apart[stops] = np.maximum(
        np.abs(left[stops] - arrive[waypoint]), np.abs(right[stops] - leave[waypoint])
    )
    # A comparison that holds for what is not a number, too.
    torn = np.flatnonzero(~(apart.max(axis=1) <= JOINED))
    if not len(torn):
        return
    here = int(torn[0])
    axis = int(np.argmax(apart[here]))
    raise MotionError(
        f"joint {route.robot.axis_names[axis]} would have to jump by {apart[here, axis]:.3g} (rad "
        "or m) at its end: rounded by its zone, the path passes a singular configuration on "
        "another side than without; make the zone smaller, a stop point, or use a joint move",
        route.moves[int(pieces.segment[max(here - 1, 0)])],
        cause=FaultCause.SINGULARITY,
    )


@lean
def _joined(
    ends: FloatArray, stop: NDArray[np.bool_], source: IntArray, first: IntArray, q: FloatArray
) -> bool:
    """Whether the joints go on where they are, from piece to piece and at stops."""
    last = ends.shape[0]
    for k in range(stop.size):
        at = source[k, 0]
        for j in range(q.shape[1]):
            arrive = ends[at - 1, 1, j] if at > 0 else ends[0, 0, j]
            leave = ends[at, 0, j] if at < last else ends[last - 1, 1, j]
            left = q[first[k] - 1, j] if k > 0 else ends[0, 0, j]
            right = q[first[k], j] if k + 1 < stop.size else ends[last - 1, 1, j]
            # Comparisons that fail for what is not a number, too.
            if stop[k]:
                if not (abs(left - arrive) <= JOINED and abs(right - leave) <= JOINED):
                    return False
            elif not abs(right - left) <= JOINED:
                return False
    return True


def _singular_notes(
    route: Route, pieces: Pieces, q: FloatArray, conditioning: FloatArray
) -> list[Note]:
    """One note for every move with a stretch near a singularity."""
    near = conditioning < NEAR_SINGULAR
    if not near.any():
        return []
    segment = pieces.segment[pieces.sample_pieces]
    notes = []
    for k in np.unique(segment[near]):
        rows = np.flatnonzero(segment == k)
        worst = rows[np.argmin(conditioning[rows])]
        kind = nearest_singularity(route.robot, q[worst])
        of = "" if kind is None else f" of the {kind.name}"
        notes.append(
            Note(
                f"near a singular configuration{of} (conditioning {conditioning[worst]:.1e}): "
                "joints move fast here, and the controller may stop",
                route.moves[int(k)],
            )
        )
    return notes
