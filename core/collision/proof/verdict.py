"""The certificate as a value, and how findings of a proof become one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from ...motion.emulator.run import Run
from ...motion.path.building import NEAR_SINGULAR
from ...robot.model import Robot
from ..scene.scene import CollisionScene
from .enclosure import Span
from .findings import FailureCause, NearestPair, UnprovenStretch

CONTACT = 2e-6
"""m that bodies keep at least, even where no clearance is asked for: measured distances may be
off by half of it, and a mesh that got inside another would read as free."""
_TINY = 1e-5
"""m; of a clearance below it is said what it means."""
MM = 1e3


class Verdict(StrEnum):
    """What a certificate says."""

    PROVEN = "proven"
    VIOLATED = "violated"
    UNPROVEN = "unproven"


@dataclass(frozen=True)
class Certificate:
    """What is proven of a run.

    Args:
        verdict: proven, violated, or neither.
        clearance: m. Proven: what is proven to be kept. Else: the least distance met.
        message: one sentence for people.
        move: index in the program of the move concerned: of the first violation, of the first
            stretch that is not proven, or where the least distance was met; None if none was.
        sigma: first and last σ of that stretch of the path.
        time: s, when the emulated motion passes ``configuration``, or what is on the path there.
        pair: names of the two bodies concerned; None if no pair is to blame.
        distance: m between them at ``configuration``; None if it was not measured.
        configuration: (N,), on the stretch.
        measured: how many distances and enclosures it took.
    """

    verdict: Verdict
    clearance: float
    message: str
    move: int | None = None
    sigma: Span | None = None
    time: float | None = None
    pair: tuple[str, str] | None = None
    distance: float | None = None
    configuration: tuple[float, ...] | None = None
    measured: int = 0

    @property
    def proven(self) -> bool:
        """Whether the clearance asked for is proven."""
        return self.verdict is Verdict.PROVEN

    def __str__(self) -> str:
        return self.message


class Met(NamedTuple):
    """What came of a stretch of the path.

    Args:
        scene: the bodies.
        nearest: where the least was met.
        proven: m, what is proven.
    """

    scene: CollisionScene
    nearest: NearestPair
    proven: float


@dataclass(frozen=True)
class VerdictReader:
    """Puts what provers found into words and places of the program.

    Args:
        run: what was driven.
    """

    run: Run

    def refused(
        self,
        scene: CollisionScene,
        finding: UnprovenStretch,
        nearest: Met | None,
        wanted: float,
        measured: int,
    ) -> Certificate:
        """The certificate of a stretch that is not proven."""
        pair = None if finding.pair is None else scene.pair_names(finding.pair)
        move, time = self._move(finding.piece), self._time(finding.sigma)
        violated = finding.cause is FailureCause.NEAR
        least = math.inf if nearest is None else nearest.nearest.distance
        if finding.distance is not None:
            least = min(least, finding.distance)
        return Certificate(
            Verdict.VIOLATED if violated else Verdict.UNPROVEN,
            least,
            f"move {move + 1}, at {time:.3f} s: " + self._reason(finding, pair, wanted),
            move,
            (finding.begin, finding.end),
            time,
            pair,
            finding.distance,
            tuple(map(float, finding.q)),
            measured,
        )

    def proven(
        self,
        known: Sequence[Met],
        resolution: float,
        measured: int,
        wanted: float,
        near: Sequence[int] = (),
    ) -> Certificate:
        """The certificate of a proof to within ``resolution`` m, of ``wanted`` m at least.

        Args:
            known: what was found.
            resolution, wanted: see there.
            measured: how much it took.
            near: moves along which what touches at an end is never apart.
        """
        clearance = min((part.proven for part in known), default=math.inf)
        parts = _of_parts(wanted, near, any(part.scene.left_out for part in known))
        if clearance == math.inf:
            message = "nothing is near that it could touch" + parts
            return Certificate(Verdict.PROVEN, clearance, message, measured=measured)
        message = in_words(clearance) + _rests_on(known[0].scene.robot) + parts
        nearest = nearest_of(known)
        if nearest is None or nearest.nearest.kept > clearance + resolution:
            # Nothing was measured where it matters: what was met is not what is nearest.
            return Certificate(Verdict.PROVEN, clearance, message, measured=measured)
        met = nearest.nearest
        pair = nearest.scene.pair_names(met.pair)
        move, time = self._move(met.piece), self._time(met.sigma)
        message += (
            f"; the least distance met is {met.distance * MM:.3f} mm, between {pair[0]} and "
            f"{pair[1]} on move {move + 1}, at {time:.3f} s"
        )
        return Certificate(
            Verdict.PROVEN,
            clearance,
            message,
            move,
            (met.sigma, met.sigma),
            time,
            pair,
            met.distance,
            None if met.q is None else tuple(map(float, met.q)),
            measured,
        )

    def _reason(self, finding: UnprovenStretch, pair: tuple[str, str] | None, wanted: float) -> str:
        bodies = "" if pair is None else f"{pair[0]} and {pair[1]}"
        distance = 0.0 if finding.distance is None else finding.distance
        match finding.cause:
            case FailureCause.NEAR if wanted < 0.0:
                # Of a mesh it is only known that it is too deep.
                depth = "" if distance > wanted else f" by {-distance * MM:.3f} mm"
                return (
                    f"{bodies} overlap{depth}; where a part is taken or released, "
                    f"{_shown(-wanted)} are allowed"
                )
            case FailureCause.DEVIATION | FailureCause.STALLED if wanted < 0.0:
                return (
                    f"not proven: {bodies} are as deep in each other as they may be where a part "
                    f"is taken or released ({_shown(-wanted)}), or nearly so"
                )
            case FailureCause.NEAR if distance <= 0.0:
                # Where a mesh is cut there is no depth.
                depth = f" by {-distance * MM:.3f} mm" if distance < -CONTACT else ""
                return f"{bodies} overlap{depth}"
            case FailureCause.NEAR:
                return (
                    f"{bodies} come within {distance * MM:.3f} mm, {_shown(wanted)} have to be kept"
                )
            case FailureCause.DEVIATION:
                return (
                    f"not proven: {bodies} are {distance * MM:.3f} mm apart on the path, but the "
                    "controller's smoothing in time and the motion model's residual may bring "
                    f"them within the {_shown(wanted)} to be kept"
                )
            case FailureCause.UNVERIFIED if finding.conditioning > NEAR_SINGULAR:
                return (
                    "not proven: from one sample of the path to the next the joints cannot be "
                    "followed on one configuration of the arm; sample the path more densely"
                )
            case FailureCause.UNVERIFIED:
                return (
                    "not proven: the joints cannot be enclosed where the path of the TCP runs "
                    "through a singular configuration of the arm or very near to it "
                    f"(conditioning {finding.conditioning:.1e}); go round it with a joint move, or "
                    "turn the tool differently"
                )
            case FailureCause.STALLED:
                return (
                    f"not proven: {bodies} are {distance * MM:.4f} mm apart, within rounding of "
                    f"the {_shown(wanted)} to be kept"
                )
            case FailureCause.TORN:
                return (
                    "not proven: the joints jump from one piece of the path to the next; go round "
                    "singular configurations with a joint move, or use a stop point"
                )
        return "not proven: the budget of measured distances is used up; raise it"

    def _move(self, piece: int) -> int:
        path = self.run.path
        return path.route.moves[int(path.pieces.segment[piece])]

    def _time(self, sigma: float) -> float:
        """s, as trajectories have it; between samples as if the speed over σ were constant."""
        path, timing = self.run.path, self.run.timing
        left = path.pieces.interval_samples
        knots = np.stack([path.sigma[left], path.sigma[left + 1]], 1).ravel()
        times = np.stack([timing.begin, timing.end], 1).ravel()
        stamped = np.interp(np.array([sigma]), knots, times)
        return float(timing.start.driven(stamped)[0] + timing.lag)


def _shown(distance: float) -> str:
    """A distance in mm, rounded down: what is proven is not rounded up."""
    return f"{math.floor(distance * MM * 1e3) / 1e3:.3f} mm"


def _rests_on(robot: Robot) -> str:
    """What a proof takes for granted of the arm: shapes that are assumed, links that may touch."""
    told = ""
    if robot.origins.get("shape", "").startswith("assumed"):
        told += " (shape assumed)"
    files = dict.fromkeys(pair.file for pair in robot.may_touch)
    return told + "".join(f" (pairs allowed to touch by {file})" for file in files)


def _of_parts(wanted: float, near: Sequence[int], handled: bool) -> str:
    """What is proven of pairs that touch where parts are handled; nothing where none are."""
    if not (handled or near):
        return ""
    said = (
        f"; a part, and what takes it or what it rests on, keep {_shown(wanted)} from where they "
        "are apart, and go no deeper into each other before than they may"
    )
    moves = ", ".join(str(move + 1) for move in near)
    return f"{said}; on move {moves} they never are apart" if near else said


def in_words(clearance: float) -> str:
    """What it means that a clearance is proven."""
    if clearance < _TINY:
        return f"it is proven that nothing touches: at least {_shown(clearance)} are left"
    return f"a clearance of at least {_shown(clearance)} is proven"


def nearest_of(known: Sequence[Met]) -> Met | None:
    """Where the least was met."""
    found = [part for part in known if part.nearest.q is not None]
    return min(found, key=lambda part: part.nearest.kept, default=None)
