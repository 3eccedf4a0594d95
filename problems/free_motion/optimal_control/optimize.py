"""Optimal control of a robot from a task to a motion that is proven."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from numpy.typing import ArrayLike

from ....core.errors import MotionError, Note
from ...checks import of_kind
from .motion.audit import audit
from .motion.first_guess import Guess, first_guess
from .motion.proof import prove
from .motion.result import Optimum
from .motion.scheme import Scheme
from .refusal import check_corners, check_task
from .search.effort import MotionEffort
from .search.opening import opening
from .search.search import MotionSearch, Report
from .search.surroundings import Surroundings
from .task.limits import MotionLimits
from .task.sampled import Plant
from .task.task import MotionTask


def optimize(
    task: MotionTask,
    around: Surroundings | None = None,
    effort: MotionEffort | None = None,
    vias: Sequence[ArrayLike] | None = None,
    report: Report | None = None,
) -> Optimum:
    """The best motion found for a task.

    Args:
        task: what is asked.
        around: what to keep clear of; None for nothing.
        effort: how hard to try.
        vias: corners (c, N) of a path of joint lines that is free, for each leg between
            waypoints; None for straight lines where they are free, and planned ones elsewhere
            (OMPL, the extra ``planning``).
        report: called after every outer iteration; True ends the search, as Ctrl-C does, with the
            best motion so far.

    Raises:
        InputError: what is asked does not fit the robot or its limits; the joint is named.
        MotionError: the robot collides at a station or on the path to begin with, or no motion
            within the limits was found.
    """
    of_kind("task", task, MotionTask)
    of_kind("around", around, Surroundings | None)
    of_kind("effort", effort, MotionEffort | None)
    effort = effort or MotionEffort()
    limits = MotionLimits.of(task)
    needed = limits.dynamic or task.objective.time_weight < 1.0
    plant = Plant(task) if needed else None
    check_task(task, limits, plant, around, effort.scheme)
    line = opening(task, around, vias)
    check_corners(task, line.points)
    scheme = Scheme(effort.scheme)
    guess = first_guess(task, limits, plant, line, scheme, effort.intervals, effort.group)
    if around is not None:
        _check_first(task, guess, around)
    ask = partial(
        MotionSearch, limits=limits, plant=plant, around=around, guess=guess, report=report
    )
    searches = []
    if around is not None and task.objective.time_weight < 1.0:
        searches.append(ask(_hurried(task), effort=replace(effort, trials=0)))
        searches[0].run()
    if not (searches and searches[0].interrupted):
        begin = searches[0].base if searches else guess
        searches.append(ask(task, effort=effort, begin=begin))
        searches[-1].run()
    return _optimum(task, guess, searches)


def _hurried(task: MotionTask) -> MotionTask:
    """The task for time alone.

    Where energy counts among obstacles it is done first. From a stop at every corner, slow motions
    get stuck on long ways round: what they gain by a shorter way is little against what they lose
    by hurrying. The fastest motion's way is short.
    """
    return replace(task, objective=replace(task.objective, time_weight=1.0))


def _check_first(task: MotionTask, guess: Guess, around: Surroundings) -> None:
    found = prove(task, guess.motion, around.scene, around.clearance)
    if not found.certificate.proven:
        raise MotionError(
            "the path to begin with does not keep the clearance: "
            f"{found.certificate}; give corners of a free path (vias)"
        )


def _optimum(task: MotionTask, guess: Guess, searches: Sequence[MotionSearch]) -> Optimum:
    """What the last search has found."""
    search = searches[-1]
    steps = tuple(step for each in searches for step in each.steps)
    if search.best is None:
        seen = audit(task, search.limits, search.plant, search.base.motion, search.effort.tolerance)
        reason = steps[-1].what if steps else "the search was ended"
        longest = task.objective.longest
        within = "" if longest is None else f" that takes {longest:g} s at most"
        raise MotionError(
            f"no motion within the limits{within} was found: the best one takes "
            f"{search.base.motion.duration:.4g} s and uses {100 * seen.used:.1f} % of a limit "
            f"({reason}); allow more {'time or ' if within else ''}intervals, or begin with "
            "another path"
        )
    _, motion, seen, proof = search.best
    converged = search.converged and search.task is task
    notes = []
    if not converged:
        notes.append(Note("the search was ended early: a longer one may find better"))
    certificate = None if proof is None else proof.certificate
    return Optimum(task, motion, guess.motion, seen, certificate, steps, converged, tuple(notes))
