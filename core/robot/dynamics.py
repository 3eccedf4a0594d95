"""Inverse dynamics of a tree of joints, by Pinocchio; their reverse is our own."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..spatial.pose import Pose, Vector3
from .inertia import Inertia
from .joint import Follower, Joint, JointKind
from .kinematics.chain import Chain
from .torque_gradient import TreeBodies, pull_torques


@dataclass(frozen=True, slots=True)
class TreeNode:
    """A joint and the body behind it.

    Args:
        joint: the joint, or what follows one.
        parent: number of the node it stands on, -1 for the world.
        step: a further placement between the parent's frame and the joint's own placement.
        index: of the joint's value in the configuration; several may share one.
        body: in the frame behind the joint; None if not known.
    """

    joint: Joint | Follower
    parent: int
    step: Pose
    index: int
    body: Inertia | None


@dataclass(frozen=True, slots=True)
class JointTree:
    """Joints, each after its parent, under gravity (m/s², in the world)."""

    name: str
    nodes: tuple[TreeNode, ...]
    gravity: Vector3


class Dynamics:
    """Equations of motion τ = M(q) q̈ + h(q, q̇) of a tree over N values.

    Friction and motor inertia are not part of them. The torque of an axis whose own body is not
    known is NaN; its motion still acts on what it carries.
    """

    def __init__(self, tree: JointTree) -> None:
        import pinocchio as pin  # takes a tenth of a second; most runs need no torques

        self._pin = pin
        self._model = _pinocchio_model(tree)
        self._data = self._model.createData()
        self._pool = pin.ModelPool(self._model, 1)
        # Pinocchio's order of values is that of the nodes.
        self._order = np.array([node.index for node in tree.nodes])
        # What a value drives in several places needs the sum of their torques.
        self._drives = np.zeros((len(tree.nodes), 1 + int(self._order.max())))
        self._drives[np.arange(len(tree.nodes)), self._order] = 1.0
        self._unknown = [node.index for node in tree.nodes if node.body is None]
        self._bodies, self._gravity = _bodies(tree), np.array(tree.gravity)

    @staticmethod
    def of(tree: JointTree) -> Dynamics:
        """The dynamics of a tree, built once for equal trees."""
        return _cached(tree)

    def torques(self, q: FloatArray, dq: FloatArray, ddq: FloatArray) -> FloatArray:
        """Torques (M, N) N m of M motions."""
        columns = [np.ascontiguousarray(x[:, self._order]).T for x in (q, dq, ddq)]
        torques = np.empty_like(q)
        if len(q):
            found = np.asarray(self._pin.rneaInParallel(1, self._pool, *columns))
            # Pinocchio drops the axis of a single joint.
            torques[:] = found.reshape(len(self._order), -1).T @ self._drives
        torques[:, self._unknown] = np.nan
        return torques

    def torque_derivatives(
        self, q: FloatArray, dq: FloatArray, ddq: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """∂τ/∂q, ∂τ/∂q̇ and ∂τ/∂q̈, each (M, N, N)."""
        count = len(q)
        nodes = len(self._order)
        parts = np.empty((3, count, nodes, nodes))
        rows = zip(*(np.ascontiguousarray(x[:, self._order]) for x in (q, dq, ddq)), strict=True)
        for m, (at, rate, rise) in enumerate(rows):
            derivatives = self._pin.computeRNEADerivatives(self._model, self._data, at, rate, rise)
            parts[0, m], parts[1, m], parts[2, m] = derivatives[:3]
        parts = self._drives.T @ parts @ self._drives
        parts[:, :, self._unknown] = np.nan
        return parts[0], parts[1], parts[2]

    def pull_torques(
        self, states: tuple[FloatArray, FloatArray, FloatArray], weight: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Gradients (M, N) of Σ_j weight_j τ_j with respect to q, q̇ and q̈, (M, N) each.

        A torque that is not known has no part in it.
        """
        return pull_torques(self._bodies, self._gravity, states, weight)


@lru_cache(maxsize=64)
def _cached(tree: JointTree) -> Dynamics:
    return Dynamics(tree)


def _pinocchio_model(tree: JointTree) -> Any:
    import pinocchio as pin

    model = pin.Model()
    model.name = tree.name
    model.gravity.linear = np.array(tree.gravity)
    ids: list[int] = []
    for number, node in enumerate(tree.nodes):
        matrix = node.step.matrix() @ node.joint.placement.matrix()
        parent = 0 if node.parent < 0 else ids[node.parent]
        identity = model.addJoint(parent, _joint_model(node.joint), pin.SE3(matrix), str(number))
        body = node.body or Inertia(0.0)
        inertia = pin.Inertia(body.mass, np.array(body.centre), np.array(body.tensor))
        model.appendBodyToJoint(identity, inertia, pin.SE3.Identity())
        ids.append(identity)
    return model


def _bodies(tree: JointTree) -> TreeBodies:
    placed = [node.step.matrix() @ node.joint.placement.matrix() for node in tree.nodes]
    bodies = [node.body or Inertia(0.0) for node in tree.nodes]
    axes = np.array([node.joint.axis for node in tree.nodes], dtype=float)
    joints = Chain(
        np.array([matrix[:3, :3] for matrix in placed]),
        np.array([matrix[:3, 3] for matrix in placed]),
        axes / np.linalg.norm(axes, axis=1, keepdims=True),
        np.array([node.joint.kind is JointKind.PRISMATIC for node in tree.nodes]),
        np.array([node.index for node in tree.nodes]),
        np.ones(len(axes)),
        np.eye(3),
        np.zeros(3),
    )
    return TreeBodies(
        joints,
        np.array([node.parent for node in tree.nodes]),
        np.array([body.mass for body in bodies], dtype=float),
        np.array([body.centre for body in bodies], dtype=float),
        np.array([body.tensor for body in bodies], dtype=float),
    )


def _joint_model(joint: Joint | Follower) -> Any:
    import pinocchio as pin

    axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
    if joint.kind is JointKind.PRISMATIC:
        return pin.JointModelPrismaticUnaligned(axis)
    return pin.JointModelRevoluteUnaligned(axis)
