"""Whether a flow can reach a target at all within the limits of the speed."""

from __future__ import annotations

from ...core.errors import Note
from .deposition import Deposition
from .trajectory import PaintTrajectory

_NEARLY = 0.98


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
    samples = deposition.samples
    thickest, thinnest = (
        float(
            samples.areas
            @ deposition.thickness(trajectory.with_durations(trajectory.lengths / limit))
        )
        / samples.area
        for limit in speed
    )
    if thickest < _NEARLY * target:
        return (
            Note(
                f"at the least speed of {speed[0]:g} m/s the coat is {thickest * 1e6:.4g} µm on "
                f"average, less than the target of {target * 1e6:.4g} µm: more flow, a second "
                "coat, closer sweeps or a lower speed would reach it"
            ),
        )
    if thinnest * _NEARLY > target:
        return (
            Note(
                f"at the largest speed of {speed[1]:g} m/s the coat is {thinnest * 1e6:.4g} µm on "
                f"average, more than the target of {target * 1e6:.4g} µm: less flow, wider sweeps "
                "or a higher speed would reach it"
            ),
        )
    return ()
