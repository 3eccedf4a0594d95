"""How far smoothing in time and elastic joints take a motion off its path, at most.

Between two samples the emulated motion is a quintic q(ℓ) that is driven with ℓ̇² = x linear in ℓ
(`motion.timing`). So its acceleration q'' x + q' ẍ is a polynomial of fourth degree, and lies
within the range of its Bernstein coefficients: a bound for all times, not for samples of them.
See R. T. Farouki, "The Bernstein polynomial basis: a centennial retrospective" (2012), section 4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..motion.allowed import Allowed, coefficients
from ..motion.controller import Controller, Run
from ..motion.elasticity import LEAD_STEP, RIGID
from ..motion.lead_bound import most_lead
from ..motion.ramped import stamped_motion
from ..motion.smoothing import Smoothing
from ..motion.timing import Timing
from ..motion.trajectory import sample_times

FloatArray = NDArray[np.float64]


def smoothing_strays(controller: Controller, run: Run) -> FloatArray:
    """(N,) rad or m by which smoothing in time moves the joints off the path at most.

    A mean with a symmetric kernel of variance s² over a motion with accelerations within ±a is at
    most a s² / 2 from the motion at the kernel's middle; see `motion.smoothing`. What commanded
    joints lead their links by comes on top (`motion.lead_bound`). a and leads are the greatest
    that the program's limits allow, between samples too; no override drives outside of them. Where
    accelerations are ramped besides, what this motion reaches counts if that is more.
    """
    smoothing = controller.smoothing(run.program, run.path)
    elasticity = controller.model.elasticity
    size = run.path.q.shape[1]
    if smoothing.window == 0.0 and elasticity == RIGID:
        return np.zeros(size)
    allowed, start = Allowed.of(run.timing), run.timing.start
    most = allowed.greatest(allowed.accelerations, np.abs).max(axis=0)
    strays = start.most_acceleration * most * smoothing.stray
    leads = np.zeros(size)
    if elasticity != RIGID:
        leads = most_lead(elasticity, controller.robot, allowed, smoothing, start)
    if run.timing.ramp > 0.0:
        reached = _reached(controller, run, smoothing)
        strays, leads = np.maximum(strays, reached[0]), np.maximum(leads, reached[1])
    return np.asarray(strays + leads)


def _reached(
    controller: Controller, run: Run, smoothing: Smoothing
) -> tuple[FloatArray, FloatArray]:
    """(N,) each, strays and leads of this motion.

    A ramp takes accelerations along the path to where the path bends otherwise.
    """
    motion = stamped_motion(run.timing)
    accelerations = np.abs(np.gradient(motion.dq, motion.t, axis=0)).max(axis=0)
    even = sample_times(0.0, float(motion.t[-1]), LEAD_STEP)
    states = smoothing.command(motion, even)
    leads = np.abs(controller.model.elasticity.leads(controller.robot, *states)).max(axis=0)
    return accelerations * smoothing.stray, leads


def greatest_rates(timing: Timing) -> tuple[FloatArray, FloatArray]:
    """Bounds of |dq/dt| and |d²q/dt²| (N,) over a whole motion."""
    _, slope, bend = coefficients(timing)
    x = timing.stamp.x
    before, after = x[:-1, None], x[1:, None]
    push = ((after - before) / (2.0 * timing.along.spacing[:, None]))[None]
    share = np.arange(5)[:, None, None] / 4.0
    raised = np.zeros((5, *bend.shape[1:]))
    raised[:4] += (1.0 - share[:4]) * bend * before
    raised[1:] += share[1:] * bend * after
    fastest = np.sqrt(np.maximum(before, after)) * np.abs(slope).max(axis=0)
    strongest = np.abs(raised + push * slope).max(axis=0)
    return fastest.max(axis=0, initial=0.0), strongest.max(axis=0, initial=0.0)
