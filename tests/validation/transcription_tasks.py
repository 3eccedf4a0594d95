"""The two-joint scene as tasks of the transcription, for several test files."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flyby.core.motion.model.blend import Blend
from flyby.core.program.target import JointTarget
from flyby.validation.scenes.scene import SECOND_ORDER
from flyby.validation.scenes.two_joints import two_joints
from flyby.validation.transcription import Overlap, TranscriptionTask

SCENE = two_joints()


def joint_values(target: object) -> NDArray[np.float64]:
    assert isinstance(target, JointTarget)
    return np.array(target.joints)


def waypoints() -> NDArray[np.float64]:
    """Start, the three crude via points, end (5, 6)."""
    program = SCENE.programs[0]
    return np.array([joint_values(t) for t in (program.start, *(m.target for m in program.moves))])


def make_task(
    vias: int = 3, blend: Blend = SECOND_ORDER, overlap: Overlap = Overlap.HALF
) -> TranscriptionTask:
    """Through the first so many via points."""
    points = waypoints()
    return TranscriptionTask(SCENE.cell, points[[*range(vias + 1), -1]], blend, SCENE.tool, overlap)
