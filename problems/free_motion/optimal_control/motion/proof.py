"""Proof that a motion keeps a clearance everywhere, by the certificate's own machinery.

The pieces of a motion are polynomials in each joint, which `flyby.core.collision` encloses on
intervals by their Taylor coefficients; σ is the time here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .....core.collision.deviation.bounds import DeviationBounds
from .....core.collision.proof.certificate import BUDGET
from .....core.collision.proof.enclosure import Enclosure
from .....core.collision.proof.findings import Budget, FailureCause, UnprovenStretch
from .....core.collision.proof.subdivision import Prover
from .....core.collision.proof.verdict import CONTACT, MM, Certificate, Verdict, in_words
from .....core.collision.scene.scene import CollisionScene
from .....core.motion.geometry.curves import POLYNOMIAL, Curves
from .....core.motion.model.blend import BASIS
from ..task.task import MotionTask
from .motion import Motion


@dataclass(frozen=True)
class Proof:
    """A certificate, and where the motion is to blame if it is none.

    Args:
        certificate: what is proven.
        pair: row of the scene's pairs; None if no pair is to blame.
    """

    certificate: Certificate
    pair: int | None = None


def prove(
    task: MotionTask,
    motion: Motion,
    scene: CollisionScene,
    clearance: float,
    resolution: float | None = None,
) -> Proof:
    """Prove that a motion keeps a clearance.

    Args:
        task: whose joints move.
        motion: of them.
        scene: the cell with its tool.
        clearance: m; all of it is proven.
        resolution: m to which the clearance that there is is proven; None for just the one asked
            for.
    """
    enclosure = enclosure_of(task, motion)
    left = Budget(BUDGET)
    prover = Prover(enclosure, scene, DeviationBounds.within(np.zeros(task.robot.size)), 0.0, left)
    wanted = max(clearance, CONTACT)
    spans, pieces = [(0.0, motion.duration)], range(len(motion))
    finding = prover.prove(spans, pieces, wanted)
    if finding is not None:
        return _refused(scene, finding, wanted, left.used)
    if resolution is not None:
        prover.tighten(spans, pieces, resolution)
    proven = prover.proven
    message = "nothing is near that it could touch"
    if proven < math.inf:
        message = in_words(proven)
    return Proof(Certificate(Verdict.PROVEN, proven, message, measured=left.used))


def enclosure_of(task: MotionTask, motion: Motion) -> Enclosure:
    """Enclosures of the configurations on intervals of time."""
    count, degrees = motion.coefficients.shape[:2]
    size = task.robot.size
    control = np.zeros((count, BASIS, size))
    control[:, 0] = np.asarray(task.start)
    control[:, :degrees, task.moving] = motion.coefficients
    one = np.ones(count)
    window = np.stack([motion.knots[:-1], motion.durations, one, one], axis=1)
    kind = np.full(count, POLYNOMIAL, dtype=np.int64)
    curves = Curves(kind, window, control, np.zeros(count), np.eye(BASIS))
    return Enclosure(motion.knots, window, curves, np.arange(count))


def _refused(
    scene: CollisionScene, finding: UnprovenStretch, wanted: float, measured: int
) -> Proof:
    pair = None if finding.pair is None else scene.pair_names(finding.pair)
    violated = finding.cause is FailureCause.NEAR
    where = f"at {finding.sigma:.3f} s"
    if finding.cause is FailureCause.EXHAUSTED or pair is None or finding.distance is None:
        message = f"{where}: not proven, the budget of measured distances is used up"
    else:
        message = (
            f"{where}: {'' if violated else 'not proven: '}{pair[0]} and {pair[1]} are "
            f"{finding.distance * MM:.3f} mm apart, {wanted * MM:.3f} mm have to be kept"
        )
    certificate = Certificate(
        Verdict.VIOLATED if violated else Verdict.UNPROVEN,
        math.inf if finding.distance is None else finding.distance,
        message,
        sigma=(finding.begin, finding.end),
        time=finding.sigma,
        pair=pair,
        distance=finding.distance,
        configuration=tuple(map(float, finding.q)),
        measured=measured,
    )
    return Proof(certificate, finding.pair)
