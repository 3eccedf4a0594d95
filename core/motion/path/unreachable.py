"""Says why an arm cannot follow a path of the TCP any further, and what helps."""

from __future__ import annotations

from ...arrays import FloatArray
from ...errors import FaultCause
from ...robot.model import Robot
from ...robot.singularities import nearest_singularity
from .tcp_samples import CONVERGED


def why_stranded(
    robot: Robot, q: FloatArray, share: float, length: float, short: float
) -> tuple[str, FaultCause]:
    """Why an arm stays at q: what helps, and in one word.

    Args:
        robot: whose arm.
        q: (N,), the last configuration on the path.
        share: how much of the move was driven by then.
        length: m, of the move's TCP path.
        short: m or rad by which the arm misses the path a little further on.
    """
    way = f", {1e3 * share * length:.1f} mm from its beginning" if length > 0.0 else ""
    where = f"{100 * share:.0f} % of the way along{way}"
    if short > CONVERGED:
        return (
            f"the arm leaves its reach {where}: a little further on it is {1e3 * short:.3g} mm "
            "short of the path; bring the points nearer, or use a joint move",
            FaultCause.REACH,
        )
    near = nearest_singularity(robot, q)
    if near is None:
        return (
            f"the path runs into a singular configuration {where}, where controllers stop: go "
            "round it, turn the tool differently, or use a joint move",
            FaultCause.SINGULARITY,
        )
    return (
        f"the path runs into a singular configuration of the {near.name} {where} ({near.meaning}), "
        f"where controllers stop: {near.remedy}",
        FaultCause.SINGULARITY,
    )
