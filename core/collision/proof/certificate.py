"""Proof that a driven program keeps a clearance, between samples too.

See docs/reference/certificate.md for what is proven and how.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from ...cell.cell import Cell
from ...errors import InputError
from ...motion.emulator.controller import Controller
from ...motion.emulator.run import Run
from ...motion.path.tcp_walk import JOINED
from ...program.tool import Tool
from ..deviation.bounds import Deviation, parts_of
from ..scene.scene import CollisionScene
from .enclosure import Enclosure, Span
from .findings import Budget, FailureCause, UnprovenStretch
from .subdivision import Prover
from .verdict import CONTACT, MM, Certificate, Met, VerdictReader, nearest_of

SceneOf = Callable[[Tool], CollisionScene]
"""The scene with a tool mounted."""

TOLERANCE = 1e-5
"""m by which what is proven may stay below the clearance asked for."""
BUDGET = 2_000_000
_FINEST = 4e-6


def scenes_of(cell: Cell) -> SceneOf:
    """The scenes of a cell, made when a tool is first asked for."""
    known: dict[Tool, CollisionScene] = {}

    def scene(tool: Tool) -> CollisionScene:
        if tool not in known:
            known[tool] = CollisionScene(cell, tool)
        return known[tool]

    return scene


def certify(
    controller: Controller,
    run: Run,
    scenes: SceneOf,
    clearance: float,
    residual: float = 0.0,
    *,
    resolution: float | None = None,
    budget: int = BUDGET,
) -> Certificate:
    """Prove that a run keeps a clearance, at every speed override in (0, 1].

    Args:
        controller: that drove it.
        run: path and timing.
        scenes: the scene of each move's tool; see `scenes_of`.
        clearance: m, wanted between all pairs that the scenes look at; what is proven may stay
            `TOLERANCE` below.
        residual: m by which a moving body may be elsewhere than the emulated motion says.
        resolution: m; if given, the clearance that there is is proven to within it, for the
            report. None proves just what was asked for, which is quicker.
        budget: how many distances may be measured and enclosures made.

    Raises:
        InputError: a number is negative or not finite, or the resolution finer than distances
            are known.
    """
    whole = [(0.0, float(run.path.sigma[-1]))]
    return certify_stretch(
        controller, run, scenes, clearance, whole, residual, resolution=resolution, budget=budget
    )


def certify_stretch(
    controller: Controller,
    run: Run,
    scenes: SceneOf,
    clearance: float,
    spans: Sequence[Span],
    residual: float = 0.0,
    *,
    resolution: float | None = None,
    budget: int = BUDGET,
) -> Certificate:
    """As `certify`, for stretches of the path alone.

    Args:
        controller, run, scenes, clearance, residual, resolution, budget: as there.
        spans: first and last σ of each stretch.

    Raises:
        InputError: as there.
    """
    _check(clearance, residual, resolution)
    for first, last in spans:
        if not first <= last:
            raise InputError(f"a stretch runs from a first to a last σ, not from {first} to {last}")
    enclosure = Enclosure.of(run.path)
    left = Budget(budget)
    deviation_of_run, reader = Deviation.of(controller, run), VerdictReader(run)
    wanted = max(clearance - TOLERANCE, CONTACT)
    torn = _first_tear(run, spans)
    if torn is not None:
        segment = int(run.path.pieces.segment[torn.piece])
        scene = scenes(run.program.moves[run.path.route.moves[segment]].tool)
        return reader.refused(scene, torn, None, wanted, left.used)
    met: list[Met] = []
    findings: list[tuple[CollisionScene, UnprovenStretch]] = []
    for part in parts_of(run.path):
        owned = _owners(run, scenes, spans, part)
        if not owned:
            continue
        intervals = run.path.pieces.first_interval[list(part)]
        provers = [
            (Prover(enclosure, scene, deviations, residual, left), pieces)
            for deviations in deviation_of_run.over(int(intervals[0]), int(intervals[1]))
            for scene, pieces in owned
        ]
        for prover, pieces in provers:
            finding = prover.prove(spans, pieces, wanted)
            if finding is not None:
                findings.append((prover.scene, finding))
        if resolution is not None and not findings:
            for prover, pieces in provers:
                prover.tighten(spans, pieces, resolution)
        met += [Met(prover.scene, prover.nearest, prover.proven) for prover, _ in provers]
        if any(finding.cause is FailureCause.NEAR for _, finding in findings):
            break
    if findings:
        scene, finding = min(findings, key=lambda found: _rank(found[1]))
        return reader.refused(scene, finding, nearest_of(met), wanted, left.used)
    return reader.proven(met, resolution or 0.0, left.used)


def _check(clearance: float, residual: float, resolution: float | None) -> None:
    for name, value in (("clearance", clearance), ("residual", residual)):
        if not 0.0 <= value < math.inf:
            raise InputError(f"the {name} must be zero or more metres and finite, not {value:g}")
    if resolution is not None and not _FINEST <= resolution < math.inf:
        raise InputError(
            f"clearances are found to {_FINEST * MM:g} mm at best, not to {resolution * MM:g} mm"
        )


def _owners(
    run: Run, scenes: SceneOf, spans: Sequence[Span], part: tuple[int, int]
) -> list[tuple[CollisionScene, list[int]]]:
    """The scenes in the order of their first use, and the pieces of a part of the path in each.

    Only pieces that the spans touch.
    """
    path = run.path
    edge = path.pieces.edge
    touched = np.zeros(len(edge) - 1, dtype=np.bool_)
    for first, last in spans:
        touched |= (edge[1:] >= first) & (edge[:-1] <= last)
    owned: dict[int, tuple[CollisionScene, list[int]]] = {}
    for piece in part[0] + np.flatnonzero(touched[slice(*part)]):
        move = run.program.moves[path.route.moves[int(path.pieces.segment[piece])]]
        scene = scenes(move.tool)
        owned.setdefault(id(scene), (scene, []))[1].append(int(piece))
    return list(owned.values())


def _first_tear(run: Run, spans: Sequence[Span]) -> UnprovenStretch | None:
    """Where joints first jump from one piece of the path to the next, on a stretch's inside.

    Within pieces, enclosures hold the joints together.
    """
    path = run.path
    right = path.pieces.first_sample[1:-1]
    # A comparison that holds for what is not a number, too.
    torn = ~(np.abs(path.q[right] - path.q[right - 1]).max(axis=1) <= JOINED)
    for piece in np.flatnonzero(torn):
        sigma = float(path.pieces.edge[piece + 1])
        if any(first < sigma < last for first, last in spans):
            q = path.q[right[piece]]
            return UnprovenStretch(
                FailureCause.TORN, int(piece), sigma, sigma, sigma, q, None, None, 1.0
            )
    return None


def _rank(finding: UnprovenStretch) -> tuple[bool, float]:
    return finding.cause is not FailureCause.NEAR, finding.begin
