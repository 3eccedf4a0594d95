"""Which configurations, and which straight joint motions, keep a clearance.

A straight motion by Δq moves no point of one body against another by more than

    Σ_j |Δq_j| Λ_j,    Λ_j = the farthest that anything behind joint j can get from its axis,

so a motion is free if at its middle all distances exceed the clearance by that sum over its half,
or if both its halves are free.
"""

from __future__ import annotations

import numpy as np

from ....core.arrays import FloatArray, IntArray
from ....core.collision.distance.solid import extent
from ....core.collision.scene.scene import CollisionScene
from ....core.robot.joint import JointKind

LONGEST = 0.05
"""m of motion up to which distances are measured; longer stretches are halved at once."""
AT_ONCE = 16
"""Stretches looked at before any is looked at more closely."""
FINEST = 5e-4
"""m of motion at which a stretch that is still not proven counts as not free."""


class FreeSpace:
    """The configurations of an arm that keep a clearance; external axes stand still.

    Args:
        scene: the cell with the tool.
        clearance: m.
        external: values of the external axes.
    """

    def __init__(
        self, scene: CollisionScene, clearance: float, external: tuple[float, ...]
    ) -> None:
        self.scene = scene
        self.clearance = clearance
        self._external = np.array(external, dtype=float)
        self._levers = _levers(scene)

    def configurations(self, arm: FloatArray) -> FloatArray:
        """All values (M, N) of configurations of the arm (M, n)."""
        return np.hstack([arm, np.broadcast_to(self._external, (len(arm), self._external.size))])

    def keeps(self, arm: FloatArray) -> bool:
        """Whether a configuration of the arm (n,) keeps the clearance."""
        return bool(self._distances(arm[None], 0.0)[0] >= self.clearance)

    def joins(self, first: FloatArray, last: FloatArray) -> bool:
        """Whether the straight motion between two configurations (n,) is proven to keep it."""
        motion = 0.5 * float(np.abs(last - first) @ self._levers)
        count = int(np.ceil(motion / LONGEST)) or 1
        half = 0.5 * (last - first) / count
        middles = first + (2 * _spread(count)[:, None] + 1) * half
        motion /= count
        while len(middles):
            left = []
            for part in np.array_split(middles, int(np.ceil(len(middles) / AT_ONCE))):
                distance = self._distances(part, motion)
                if (distance < self.clearance).any():
                    return False
                left.append(part[distance < self.clearance + motion])
            if motion < FINEST and any(map(len, left)):
                return False
            half, motion = 0.5 * half, 0.5 * motion
            middles = np.concatenate([part + side * half for part in left for side in (-1, 1)])
        return True

    def _distances(self, arm: FloatArray, motion: float) -> FloatArray:
        return self.scene.clearance(self.configurations(arm), self.clearance + motion)


def _spread(count: int) -> IntArray:
    """The numbers from 0 to ``count`` - 1, each far from those before: a wall is met early."""
    bits = max(count - 1, 1).bit_length()
    numbers = np.arange(1 << bits)
    mirrored = sum(((numbers >> k) & 1) << (bits - 1 - k) for k in range(bits))
    order = np.asarray(mirrored, dtype=np.int64)
    return order[order < count]


def _levers(scene: CollisionScene) -> FloatArray:
    """(n,) Λ: m per rad, 1 for a joint that slides; whatever the configuration.

    A sliding joint lengthens the levers of those before it by as much as its value can be.
    """
    robot = scene.robot
    size = robot.arm_size
    levers = np.zeros(size)
    for body in scene.bodies:
        if not 1 <= body.frame <= size:
            continue
        box = extent(body.solid)
        centre = body.placement.matrix()[:3] @ [*box.centre, 1.0]
        reach = float(np.linalg.norm(centre)) + box.radius
        own = np.zeros(size)
        for joint, j in reversed(robot.link_stages(body.frame)):
            slides = joint.kind is JointKind.PRISMATIC
            own[j] += 1.0 if slides else reach
            reach += float(np.linalg.norm(joint.placement.position))
            if slides:
                reach += max(abs(robot.joints[j].lower), abs(robot.joints[j].upper))
        levers = np.maximum(levers, own)
    return levers
