"""Proof that a driven program keeps a clearance, between samples too.

See docs/certificate.md for what is proven and how.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..cell.cell import Cell
from ..errors import InputError
from ..motion.controller import Controller, Run
from ..program.tool import Tool
from .enclosure import Enclosure, Span
from .findings import Budget, Cause, Finding
from .scene import CollisionScene
from .strays import strays_of
from .subdivision import Prover
from .verdict import CONTACT, MM, Certificate, Reader, nearest_of

FloatArray = NDArray[np.float64]
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
            can be told.
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
    owned, bands = _owners(run, scenes, spans), strays_of(controller, run)
    owners = [owner for _ in bands for owner in owned]
    provers = [
        Prover(enclosure, scene, strays, residual, left) for strays in bands for scene, _ in owned
    ]
    reader = Reader(run)
    wanted = max(clearance - TOLERANCE, CONTACT)
    findings = [
        (prover, finding)
        for prover, (_, pieces) in zip(provers, owners, strict=True)
        if (finding := prover.prove(spans, pieces, wanted)) is not None
    ]
    if findings:
        prover, finding = min(findings, key=lambda found: _rank(found[1]))
        return reader.refused(prover, finding, nearest_of(provers), wanted, left.used)
    if resolution is not None:
        for prover, (_, pieces) in zip(provers, owners, strict=True):
            prover.tighten(spans, pieces, resolution)
    return reader.proven(provers, resolution or 0.0, left.used)


def _check(clearance: float, residual: float, resolution: float | None) -> None:
    for name, value in (("clearance", clearance), ("residual", residual)):
        if not 0.0 <= value < math.inf:
            raise InputError(f"the {name} must be zero or more metres and finite, not {value:g}")
    if resolution is not None and not _FINEST <= resolution < math.inf:
        raise InputError(
            f"clearances can be told to {_FINEST * MM:g} mm at best, not to {resolution * MM:g} mm"
        )


def _owners(
    run: Run, scenes: SceneOf, spans: Sequence[Span]
) -> list[tuple[CollisionScene, list[int]]]:
    """The scenes in the order of their first use, and the pieces of the path in each.

    Only pieces that the spans touch.
    """
    path = run.path
    edge = path.pieces.edge
    touched = np.zeros(len(edge) - 1, dtype=np.bool_)
    for first, last in spans:
        touched |= (edge[1:] >= first) & (edge[:-1] <= last)
    owned: dict[int, tuple[CollisionScene, list[int]]] = {}
    for piece in np.flatnonzero(touched):
        move = run.program.moves[path.route.moves[int(path.pieces.segment[piece])]]
        scene = scenes(move.tool)
        owned.setdefault(id(scene), (scene, []))[1].append(int(piece))
    return list(owned.values())


def _rank(finding: Finding) -> tuple[bool, float]:
    return finding.cause is not Cause.NEAR, finding.begin
