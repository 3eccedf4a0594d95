"""Proof that a driven program keeps a clearance, between samples too.

See docs/reference/certificate.md for what is proven and how.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
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
from .touching import SceneFinding, TouchingProof
from .verdict import CONTACT, MM, Certificate, Met, VerdictReader, nearest_of

TOLERANCE = 1e-5
"""m by which what is proven may stay below the clearance asked for."""
BUDGET = 2_000_000
_FINEST = 4e-6


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


def renumbered(scenes: SceneOf, moves: Sequence[int]) -> SceneOf:
    """The scenes of a program whose moves have other indices.

    Args:
        scenes: of the one that they come from.
        moves: index of each move in that one.
    """
    return lambda tool, move=0, /: scenes(tool, moves[move])


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
        scenes: the scene of each move; see `scenes_of` and `HandledScenes`.
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
    findings: list[SceneFinding] = []
    for provers in proof.provers():
        for prover, pieces in provers:
            finding = prover.prove(spans, pieces, wanted)
            if finding is not None:
                findings.append(SceneFinding(prover.scene, finding, wanted))
        if resolution is not None and not findings:
            for prover, pieces in provers:
                prover.tighten(spans, pieces, resolution)
        met += [Met(prover.scene, prover.nearest, prover.proven) for prover, _ in provers]
        if any(found.stretch.cause is FailureCause.NEAR for found in findings):
            break
    if not findings:
        findings = proof.of_left_out(wanted)
    if findings:
        scene, finding, kept = min(findings, key=lambda found: _rank(found.stretch))
        return reader.refused(scene, finding, nearest_of(met), kept, left.used)
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
                yield self._of_part(part, owned, self.residual)

    def of_left_out(self, wanted: float) -> list[SceneFinding]:
        """What is wrong with pairs that touch at an end of a way.

        Args:
            wanted: m that they have to keep where they are apart.
        """
        return [finding for proof in self._touching(wanted) for finding in proof.findings()]

    def never_apart(self, wanted: float) -> tuple[int, ...]:
        """Indices of the moves of ways all along which such pairs are near."""
        proofs = self._touching(wanted)
        return tuple(sorted({i for proof in proofs if proof.never_apart() for i in proof.moves}))

    def _touching(self, wanted: float) -> Iterator[TouchingProof]:
        """Proofs of the pairs that touch at the ends of each way."""
        moves, segment = self.run.path.route.moves, self.run.path.pieces.segment
        ways: dict[int, tuple[TouchingPairs, list[tuple[tuple[int, int], list[int]]]]] = {}
        for part in parts_of(self.run.path):
            for scene, pieces in self._owners(part):
                for touching in scene.left_out:
                    ways.setdefault(id(touching), (touching, []))[1].append((part, pieces))
        for touching, places in ways.values():
            of_way = {moves[int(segment[piece])] for _, pieces in places for piece in pieces}
            yield TouchingProof(
                touching,
                self.run.path,
                of_way,
                self.spans,
                self._provers_at(places),
                self.residual,
                wanted,
            )

    def _provers_at(
        self, places: Sequence[tuple[tuple[int, int], list[int]]]
    ) -> Callable[[CollisionScene, float], list[tuple[Prover, list[int]]]]:
        """Makes the provers of a scene at pieces of parts of the path."""

        def made(scene: CollisionScene, residual: float) -> list[tuple[Prover, list[int]]]:
            return [
                prover
                for part, pieces in places
                for prover in self._of_part(part, [(scene, pieces)], residual)
            ]

        return made

    def _of_part(
        self,
        part: tuple[int, int],
        owned: Sequence[tuple[CollisionScene, list[int]]],
        residual: float,
    ) -> list[tuple[Prover, list[int]]]:
        first, last = self.run.path.pieces.first_interval[list(part)]
        return [
            (Prover(self.enclosure, scene, deviations, residual, self.left), pieces)
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
