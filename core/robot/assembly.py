"""Chains put together link by link."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..spatial.pose import Pose
from .joint import Follower, Joint, JointKind
from .kinematics.chain import Chain

Turn = tuple[Joint | Follower, int]
"""A joint, or what follows one, with the index of its value."""
Stage = Pose | Turn
"""A fixed step, or a joint."""


def assemble(stages: list[Stage]) -> Chain:
    """The chain of the stages from the first frame to the last.

    A joint's own placement is part of its stage.
    """
    rotations, translations, axes, prismatic, indices = [], [], [], [], []
    pending = np.eye(4)
    for stage in stages:
        if isinstance(stage, Pose):
            pending = pending @ stage.matrix()
            continue
        joint, index = stage
        placement = pending @ joint.placement.matrix()
        axis = np.array(joint.axis)
        rotations.append(placement[:3, :3])
        translations.append(placement[:3, 3])
        axes.append(axis / np.linalg.norm(axis))
        prismatic.append(joint.kind is JointKind.PRISMATIC)
        indices.append(index)
        pending = np.eye(4)
    size = len(indices)
    return Chain(
        rotation=np.array(rotations).reshape(size, 3, 3),
        translation=np.array(translations).reshape(size, 3),
        axis=np.array(axes).reshape(size, 3),
        prismatic=np.array(prismatic, dtype=np.bool_),
        joint=np.array(indices, dtype=np.int64),
        sign=np.ones(size),
        end_rotation=np.ascontiguousarray(pending[:3, :3]),
        end_translation=np.ascontiguousarray(pending[:3, 3]),
    )


def _matrix(rotation: FloatArray, translation: FloatArray) -> FloatArray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, translation
    return matrix


def _inverse(matrix: FloatArray) -> FloatArray:
    rotation = matrix[:3, :3].T
    return _matrix(rotation, -rotation @ matrix[:3, 3])


def reversed_chain(chain: Chain) -> Chain:
    """The chain from the end of ``chain`` back to its start: T⁻¹.

    Joints come in reverse order with their signs turned, and the placements are the inverses of
    the steps between them.
    """
    size = chain.joint.size
    ends = (chain.end_rotation, chain.end_translation)
    steps = [_matrix(chain.rotation[k], chain.translation[k]) for k in range(size)]
    inverses = [_inverse(step) for step in [*steps, _matrix(*ends)]][::-1]
    return Chain(
        rotation=np.array([step[:3, :3] for step in inverses[:-1]]).reshape(size, 3, 3),
        translation=np.array([step[:3, 3] for step in inverses[:-1]]).reshape(size, 3),
        axis=np.ascontiguousarray(chain.axis[::-1]),
        prismatic=np.ascontiguousarray(chain.prismatic[::-1]),
        joint=np.ascontiguousarray(chain.joint[::-1]),
        sign=np.ascontiguousarray(-chain.sign[::-1]),
        end_rotation=np.ascontiguousarray(inverses[-1][:3, :3]),
        end_translation=np.ascontiguousarray(inverses[-1][:3, 3]),
    )


def joined(first: Chain, second: Chain) -> Chain:
    """The chain ``first`` followed by ``second``, over the same configuration."""
    link = _matrix(first.end_rotation, first.end_translation)
    if second.joint.size == 0:
        end = link @ _matrix(second.end_rotation, second.end_translation)
        return first._replace(
            end_rotation=np.ascontiguousarray(end[:3, :3]),
            end_translation=np.ascontiguousarray(end[:3, 3]),
        )
    start = link @ _matrix(second.rotation[0], second.translation[0])
    return Chain(
        rotation=np.concatenate([first.rotation, start[None, :3, :3], second.rotation[1:]]),
        translation=np.concatenate([first.translation, start[None, :3, 3], second.translation[1:]]),
        axis=np.concatenate([first.axis, second.axis]),
        prismatic=np.concatenate([first.prismatic, second.prismatic]),
        joint=np.concatenate([first.joint, second.joint]),
        sign=np.concatenate([first.sign, second.sign]),
        end_rotation=second.end_rotation,
        end_translation=second.end_translation,
    )
