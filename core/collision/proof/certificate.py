"""Proof that a driven program keeps a clearance, between samples too.

See docs/reference/certificate.md for what is proven and how.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...cell.cell import Cell
from ...errors import InputError
from ...motion.emulator.controller import Controller
from ...motion.emulator.run import Run
from ...motion.path.tcp_walk import JOINED
from ...program.tool import Tool
from ..deviation.bounds import Deviation, parts_of
from ..scene.scene import CollisionScene, TouchingPairs
from .enclosure import Enclosure, Span
from .findings import Budget, FailureCause, UnprovenStretch
from .subdivision import Prover
from .verdict import CONTACT, MM, Certificate, Met, VerdictReader, nearest_of

TOLERANCE = 1e-5
"""m by which what is proven may stay below the clearance asked for."""
BUDGET = 2_000_000
_FINEST = 4e-6
_SLACK = (1e-3, 4e-3, 0.016)
"""m beyond what is proven, from which pairs that touched count as apart; the first that does."""
Finding = tuple[CollisionScene, UnprovenStretch]
"""What is not proven, and of which bodies."""


class SceneOf(Protocol):
    """The scenes of a program's moves."""

    def __call__(self, tool: Tool, move: int = 0, /) -> CollisionScene:
        """The scene with a tool mounted.

        Args:
            tool: of the move.
            move: its index in the program, which tells where parts are.
        """
        ...


def scenes_of(cell: Cell) -> SceneOf:
    """The scenes of a cell without parts, made when a tool is first asked for.

    Raises:
        InputError: of a scene that cannot be made, when it is asked for.
    """
    known: dict[Tool, CollisionScene] = {}

    def scene(tool: Tool, move: int = 0, /) -> CollisionScene:
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
        scenes: the scene of each move; see `scenes_of` and `handled_scenes`.
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
    enclosure, deviation = Enclosure.of(run.path), Deviation.of(controller, run)
    proof = _Proof(run, scenes, residual, spans, enclosure, deviation, Budget(budget))
    reader, left = VerdictReader(run), proof.left
    wanted = max(clearance - TOLERANCE, CONTACT)
    torn = _first_tear(run, spans)
    if torn is not None:
        move = run.path.route.moves[int(run.path.pieces.segment[torn.piece])]
        scene = scenes(run.program.moves[move].tool, move)
        return reader.refused(scene, torn, None, wanted, left.used)
    met: list[Met] = []
    findings: list[Finding] = []
    for provers in proof.provers():
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
    if not findings:
        findings = proof.of_left_out(wanted)
    if findings:
        scene, finding = min(findings, key=lambda found: _rank(found[1]))
        return reader.refused(scene, finding, nearest_of(met), wanted, left.used)
    near = proof.never_apart(wanted)
    return reader.proven(met, resolution or 0.0, left.used, wanted, near)


def _check(clearance: float, residual: float, resolution: float | None) -> None:
    for name, value in (("clearance", clearance), ("residual", residual)):
        if not 0.0 <= value < math.inf:
            raise InputError(f"the {name} must be zero or more metres and finite, not {value:g}")
    if resolution is not None and not _FINEST <= resolution < math.inf:
        raise InputError(
            f"clearances are found to {_FINEST * MM:g} mm at best, not to {resolution * MM:g} mm"
        )


@dataclass(frozen=True)
class _Proof:
    """What the provers of one certificate share.

    Args:
        run, scenes, residual: see `certify`.
        spans: of the path.
        enclosure, deviation: of the path, and of the run from it.
        left: what may still be measured.
    """

    run: Run
    scenes: SceneOf
    residual: float
    spans: Sequence[Span]
    enclosure: Enclosure
    deviation: Deviation
    left: Budget

    def provers(self) -> Iterator[list[tuple[Prover, list[int]]]]:
        """Those of one part of the path after the other, with their pieces."""
        for part in parts_of(self.run.path):
            if owned := self._owners(part):
                yield self._of_part(part, owned)

    def of_left_out(self, wanted: float) -> list[Finding]:
        """What is wrong with pairs that touch at an end of a move, from where they are apart.

        Args:
            wanted: m that they have to keep from there on.
        """
        return [
            finding
            for part in parts_of(self.run.path)
            for scene, pieces in self._owners(part)
            if scene.left_out is not None
            for finding in self._of_touching(scene.left_out, part, pieces, wanted)
        ]

    def never_apart(self, wanted: float) -> tuple[int, ...]:
        """Indices of the moves all along which such pairs are near: nothing is proven of them."""
        path, found = self.run.path, dict[int, None]()
        for part in parts_of(path):
            for scene, pieces in self._owners(part):
                limit = wanted + self.residual + _SLACK[0]
                if scene.left_out and not self._apart(scene.left_out, pieces[0], limit):
                    found[path.route.moves[int(path.pieces.segment[pieces[0]])]] = None
        return tuple(found)

    def _of_touching(
        self, touching: TouchingPairs, part: tuple[int, int], pieces: list[int], wanted: float
    ) -> list[Finding]:
        """The same of the pairs of one move."""
        found: list[Finding] = []
        for slack in _SLACK:
            apart = self._apart(touching, pieces[0], wanted + self.residual + slack)
            if not apart:
                break
            met = [
                (prover.scene, prover.prove(apart, pieces, wanted))
                for prover, _ in self._of_part(part, [(touching.scene, pieces)])
            ]
            found = [(scene, finding) for scene, finding in met if finding is not None]
            # What is near again once it was apart is so, wherever apart is said to begin.
            if not found or any(finding.cause is FailureCause.NEAR for _, finding in found):
                break
        return found

    def _apart(self, touching: TouchingPairs, piece: int, limit: float) -> list[Span]:
        """The spans on the move that a piece belongs to, less its ends: where bodies touch, until
        all of them are apart by ``limit`` m for the first time."""
        path = self.run.path
        segment = path.pieces.segment
        rows = np.flatnonzero(segment[path.pieces.sample_pieces] == segment[piece])
        free = np.flatnonzero(touching.scene.clearance(path.q[rows], limit) >= limit)
        if not free.size:
            return []
        begin = float(path.sigma[rows[free[0] if touching.before else 0]])
        end = float(path.sigma[rows[free[-1] if touching.behind else -1]])
        return [
            (max(first, begin), min(last, end))
            for first, last in self.spans
            if first < end and last > begin
        ]

    def _of_part(
        self, part: tuple[int, int], owned: Sequence[tuple[CollisionScene, list[int]]]
    ) -> list[tuple[Prover, list[int]]]:
        first, last = self.run.path.pieces.first_interval[list(part)]
        return [
            (Prover(self.enclosure, scene, deviations, self.residual, self.left), pieces)
            for deviations in self.deviation.over(int(first), int(last))
            for scene, pieces in owned
        ]

    def _owners(self, part: tuple[int, int]) -> list[tuple[CollisionScene, list[int]]]:
        """The scenes in the order of their first use, and the pieces of a part of the path in each.

        Only pieces that the spans touch.
        """
        path, moves = self.run.path, self.run.program.moves
        edge = path.pieces.edge
        touched = np.zeros(len(edge) - 1, dtype=np.bool_)
        for first, last in self.spans:
            touched |= (edge[1:] >= first) & (edge[:-1] <= last)
        owned: dict[int, tuple[CollisionScene, list[int]]] = {}
        for piece in part[0] + np.flatnonzero(touched[slice(*part)]):
            move = path.route.moves[int(path.pieces.segment[piece])]
            scene = self.scenes(moves[move].tool, move)
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
