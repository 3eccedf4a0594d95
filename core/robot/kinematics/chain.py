"""The serial chain from a work object to the TCP, whoever moves: the one form all kinematics use.

A work object that stands still, one on a turntable, a track under the base and a tool that
stands still while the robot carries the part differ only in the chain: joints that are passed
from tip to base count with ``sign`` -1 and reversed placements.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray


class Chain(NamedTuple):
    """Arrays of a serial chain with K joints over a configuration of N values.

    T(q) = Π_k [P_k · exp(sign_k · axis_k · q[joint_k])] · E

    Args:
        rotation: (K, 3, 3), rotation of placement P_k in the frame after joint k - 1.
        translation: (K, 3) m, translation of P_k.
        axis: (K, 3), unit axis in the joint's frame.
        prismatic: (K,) bool, whether the joint slides.
        joint: (K,) int64, index of the joint's value in the configuration.
        sign: (K,), -1 where the chain passes the joint from its moving side.
        end_rotation: (3, 3), rotation of E.
        end_translation: (3,) m, translation of E.
    """

    rotation: FloatArray
    translation: FloatArray
    axis: FloatArray
    prismatic: NDArray[np.bool_]
    joint: NDArray[np.int64]
    sign: FloatArray
    end_rotation: FloatArray
    end_translation: FloatArray
