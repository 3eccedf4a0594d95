"""Whether a flow can reach a target at all within the limits of the speed."""

from __future__ import annotations

from ....core.errors import InputError, Note
from ..spray.trajectory import PaintTrajectory
from .deposition import Deposition

NEARLY = 0.98
"""Ratio of mean and target down to which nothing is said."""
HOPELESS = 0.9
"""Ratio of mean and target below which no optimisation shall try: it would win what is missing by
driving to and fro."""


def reach_notes(
    deposition: Deposition,
    trajectory: PaintTrajectory,
    target: float,
    speed: tuple[float, float],
) -> tuple[Note, ...]:
    """What a user should know where no speed along the path gives the target on average.

    Args:
        target: wanted thickness, m.
        speed: least and largest speed of the TCP, m/s.
    """
    missed = _missed(deposition, trajectory, target, speed, NEARLY)
    return () if missed is None else (Note(missed),)


def check_reach(
    deposition: Deposition,
    trajectory: PaintTrajectory,
    target: float,
    speed: tuple[float, float],
) -> None:
    """Refuse a target that no speed along the path comes near to.

    Args:
        target, speed: as in `reach_notes`.

    Raises:
        InputError: the mean is off by more than `HOPELESS` says, whatever the speed.
    """
    missed = _missed(deposition, trajectory, target, speed, HOPELESS)
    if missed is not None:
        raise InputError(missed)


def _missed(
    deposition: Deposition,
    trajectory: PaintTrajectory,
    target: float,
    speed: tuple[float, float],
    share: float,
) -> str | None:
    """How the target is missed at either limit by more than a share of it; None where it is not."""
    samples = deposition.samples
    thickest, thinnest = (
        float(
            samples.areas
            @ deposition.thickness(trajectory.with_durations(trajectory.lengths / limit))
        )
        / samples.area
        for limit in speed
    )
    if thickest < share * target:
        return (
            f"at the least speed of {1e3 * speed[0]:g} mm/s along the first curve the coat is "
            f"{thickest * 1e6:.4g} µm on average, less than the target of {target * 1e6:.4g} µm: "
            "more flow, closer sweeps, crossed coats or a lower speed would reach it"
        )
    if thinnest * share > target:
        return (
            f"at the largest speed of {1e3 * speed[1]:g} mm/s along the first curve the coat is "
            f"{thinnest * 1e6:.4g} µm on average, more than the target of {target * 1e6:.4g} µm: "
            "less flow, wider sweeps or a higher speed would reach it"
        )
    return None
