"""A robot: one immutable description from which kinematics, limits and dynamics are derived."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray
from ..display import counted, in_line
from ..errors import InputError, UnknownNameError
from ..notebook import PictureCurve, page, picture, table
from ..spatial.pose import IDENTITY, Pose, Vector3
from .assembly import Stage, Turn, assemble
from .dynamics import Dynamics, JointTree, TreeNode
from .inertia import Inertia
from .inverse.arm_inverse import ArmInverse
from .inverse.solution import InverseSolution
from .joint import (
    COLUMNS,
    CoupledRange,
    ExternalAxis,
    ExternalRole,
    Joint,
    JointLimits,
    beyond_coupled,
)
from .joint_checks import check_joints
from .kinematics.arm_geometry import Recognised, recognise
from .kinematics.chain import Chain
from .kinematics.chain_derivatives import hessians
from .kinematics.chain_kernels import jacobians, poses
from .seven_axes.arm_angle import ArmAngle, arm_angle_at, arm_angle_of
from .shape import LinkShape, TouchingLinks

STANDARD_GRAVITY: Vector3 = (0.0, 0.0, -9.80665)
"""m/s² (3rd General Conference on Weights and Measures, 1901)."""


@dataclass(frozen=True)
class Robot:
    """An arm with its external axes.

    A configuration holds N values: the arm's n joints from base to flange, then the external
    axes. All methods work over leading axes: ``q`` is (..., N).

    Args:
        name: ``vendor/model``.
        joints: the arm's joints as the controller counts them; each placement is in the frame
            behind the joint before, the first one in the base's frame.
        base: the base's frame in the world, or in the frame behind the track that carries it.
        flange: the flange's frame in the frame behind the last joint.
        links: the bodies behind each joint, in that joint's frame; empty if not known.
        external_axes: tracks and tables.
        shapes: the links' shapes.
        payload: rated payload, kg; None if not known.
        gravity: m/s², in the world.
        origins: what each group of numbers rests on, e.g. ``"velocity": "published: …"``.
        spread: by what factor, either way, a group of assumed numbers may be off; one or more.
        doubts: what speaks against single numbers.
        may_touch: pairs of the arm's own links that may touch.
        order: names of the joints from base to flange, if not those of ``joints``.
        coupled_ranges: ranges of sums of joints' values.
        arm_angle_reference: of an arm with seven axes whose targets state an arm angle, the
            direction that it counts from, in the base's frame.
        base_height: m, of the base's frame above the plane that the arm is mounted on.

    Raises:
        InputError: two axes share a name, the links are not one a joint, a shape or a pair that
            may touch belongs to no link, or an external axis stands on one that does not exist.
    """

    name: str
    joints: tuple[Joint, ...]
    base: Pose = IDENTITY
    flange: Pose = IDENTITY
    links: tuple[Inertia, ...] = ()
    external_axes: tuple[ExternalAxis, ...] = ()
    shapes: tuple[LinkShape, ...] = ()
    payload: float | None = None
    gravity: Vector3 = STANDARD_GRAVITY
    origins: Mapping[str, str] = field(default_factory=dict, hash=False)
    spread: Mapping[str, float] = field(default_factory=dict, hash=False)
    doubts: tuple[str, ...] = ()
    may_touch: tuple[TouchingLinks, ...] = ()
    order: tuple[str, ...] = ()
    coupled_ranges: tuple[CoupledRange, ...] = ()
    arm_angle_reference: Vector3 | None = None
    base_height: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "origins", MappingProxyType(dict(self.origins)))
        object.__setattr__(self, "spread", MappingProxyType(dict(self.spread)))
        if not self.joints:
            raise InputError(f"robot {self.name} has no joint")
        names = self.axis_names
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise InputError(f"robot {self.name}: several axes are called {twice[0]!r}")
        if self.links and len(self.links) != self.arm_size:
            raise InputError(
                f"robot {self.name} has {self.arm_size} joints but inertias of "
                f"{len(self.links)} links; give one behind each joint, or none"
            )
        check_joints(
            self.name,
            self.joints,
            self.order,
            self.coupled_ranges,
            counts_arm_angle=self.arm_angle_reference is not None,
        )
        for shape in self.shapes:
            if not 0 <= shape.link <= self.arm_size:
                raise InputError(f"robot {self.name}: a shape belongs to link {shape.link}")
        for pair in self.may_touch:
            if not 0 <= pair.first < pair.second <= self.arm_size:
                raise InputError(
                    f"robot {self.name}: links {pair.first} and {pair.second} may touch by "
                    f"{pair.file}, but links are counted from 0 to {self.arm_size}, the lower first"
                )
        for axis in self.external_axes:
            self.frame_stages(axis.name)
        self._carrying_track()

    @property
    def has_held(self) -> bool:
        """Whether the arm has no motor for some of its joints."""
        return any(joint.held for joint in self.joints)

    @property
    def has_arm(self) -> bool:
        """Whether it has motors beside its external axes, which are all that a positioner has."""
        return not all(joint.held for joint in self.joints)

    def __repr__(self) -> str:
        carries = "payload not known" if self.payload is None else f"payload {self.payload:g} kg"
        axes = counted(self.external_axes, "external axis", "external axes")
        return in_line(f"Robot {self.name}: {counted(self.joints, 'joint')}, {carries}, {axes}")

    def _repr_html_(self) -> str:
        rows = [j.cells() for j in (*self.joints, *(axis.joint for axis in self.external_axes))]
        at = self.outline()
        return page(
            repr(self)[1:-1], table(COLUMNS, rows), picture([PictureCurve("robot", at, at)])
        )

    def outline(self) -> FloatArray:
        """Base, joints and flange (n + 2, 3) m in the world, all axes as near to zero as can be."""
        q = np.clip(np.zeros((1, self.size)), self.limits.lower, self.limits.upper)
        base = self.base_stages()
        ends = [base, *([*base, *self.arm_stages(index)] for index in self.along)]
        return np.concatenate([poses(assemble(s), q)[1] for s in [*ends, self.flange_stages()]])

    @cached_property
    def arm_size(self) -> int:
        """n, the number of the arm's own joints."""
        return len(self.joints)

    @cached_property
    def along(self) -> tuple[int, ...]:
        """Indices of the arm's joints from base to flange."""
        names = [joint.name for joint in self.joints]
        return tuple(map(names.index, self.order)) or tuple(range(len(names)))

    @property
    def flange_link(self) -> int:
        """The link that carries the flange: behind joint k is link k, counted from one."""
        return self.along[-1] + 1

    @cached_property
    def size(self) -> int:
        """N, the number of values of a configuration."""
        return len(self.joints) + len(self.external_axes)

    @property
    def axis_names(self) -> tuple[str, ...]:
        """Names of all N axes."""
        return (
            *(joint.name for joint in self.joints),
            *(axis.name for axis in self.external_axes),
        )

    @cached_property
    def limits(self) -> JointLimits:
        """JointLimits of all N values."""
        return JointLimits.of([*self.joints, *(axis.joint for axis in self.external_axes)])

    def beyond_coupled(self, q: FloatArray) -> FloatArray:
        """(..., C) rad by which configurations (..., N) are beyond each coupled range; not above
        zero within."""
        return beyond_coupled(self.coupled_ranges, self.axis_names, q)

    def external_axis(self, name: str) -> ExternalAxis:
        """The external axis of that name.

        Raises:
            UnknownNameError: there is none.
        """
        for axis in self.external_axes:
            if axis.name == name:
                return axis
        known = [axis.name for axis in self.external_axes]
        raise UnknownNameError(f"external axis of {self.name}", name, known)

    def with_base(self, base: Pose) -> Robot:
        """The same robot standing elsewhere."""
        return replace(self, base=base)

    def with_external_axes(self, axes: Sequence[ExternalAxis]) -> Robot:
        """The same arm with these external axes instead of those it had."""
        return replace(self, external_axes=tuple(axes))

    def with_gravity(self, gravity: Vector3) -> Robot:
        """The same robot under another gravity, m/s² in the world."""
        return replace(self, gravity=gravity)

    # Chains

    def frame_stages(self, axis: str | None) -> list[Stage]:
        """The stages from the world to the frame behind an external axis (None: the world)."""
        stages: list[Stage] = []
        names = [known.name for known in self.external_axes]
        seen: list[str] = []
        while axis is not None:
            if axis in seen:
                raise InputError(f"external axes carry each other in a ring: {seen}")
            seen.append(axis)
            carrier = self.external_axis(axis)
            stages.insert(0, (carrier.joint, self.arm_size + names.index(axis)))
            axis = carrier.carried_by
        return stages

    def _carrying_track(self) -> str | None:
        """The track that the base stands on."""
        tracks = [axis for axis in self.external_axes if axis.role is ExternalRole.TRACK]
        below = {axis.carried_by for axis in tracks}
        carrying = [axis.name for axis in tracks if axis.name not in below]
        if len(carrying) > 1:
            raise InputError(
                f"robot {self.name} stands on several tracks: {', '.join(carrying)}; "
                "say with carried_by which one stands on which"
            )
        return carrying[0] if carrying else None

    def base_stages(self) -> list[Stage]:
        """The stages from the world to the base's frame."""
        return [*self.frame_stages(self._carrying_track()), self.base]

    def flange_stages(self) -> list[Stage]:
        """The stages from the world to the flange."""
        return [*self.base_stages(), *self.arm_stages(), self.flange]

    def arm_stages(self, last: int | None = None) -> list[Turn]:
        """The stages from the base's frame to that behind the joint of index ``last`` (None: all).

        What follows a joint is a stage of its own, with the index of the joint that drives it.
        """
        end = None if last is None else self.along.index(last) + 1
        return [stage for index in self.along[:end] for stage in self.joint_stages(index)]

    def joint_stages(self, index: int) -> list[Turn]:
        """A joint and what follows it, each with the index of its value."""
        joint = self.joints[index]
        followers = ((one, self.axis_names.index(one.driver)) for one in joint.followers)
        return [(joint, index), *followers]

    def link_stages(self, link: int) -> list[Turn]:
        """The stages from the base's frame to that of a link (0: the base)."""
        return self.arm_stages(link - 1) if link else []

    @cached_property
    def chain(self) -> Chain:
        """The chain from the world to the flange."""
        return assemble(self.flange_stages())

    @cached_property
    def base_chain(self) -> Chain:
        """The chain from the world to the base's frame."""
        return assemble(self.base_stages())

    @cached_property
    def arm_chain(self) -> Chain:
        """The chain from the base's frame to the flange, over the arm's n values."""
        return assemble([*self.arm_stages(), self.flange])

    # Kinematics

    def _rows(self, *arrays: ArrayLike) -> tuple[tuple[int, ...], list[FloatArray]]:
        """The leading shape, and the arrays (..., N) as contiguous (M, N)."""
        given = np.broadcast_arrays(*(np.asarray(array, dtype=float) for array in arrays))
        shape = given[0].shape
        if not shape or shape[-1] != self.size:
            raise InputError(
                f"robot {self.name} has {self.size} axes ({', '.join(self.axis_names)}); "
                f"an array of shape {shape} does not fit"
            )
        return shape[:-1], [np.ascontiguousarray(a.reshape(-1, self.size)) for a in given]

    def forward(self, q: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """The flange in the world: rotations (..., 3, 3) and positions (..., 3) m."""
        lead, (rows,) = self._rows(q)
        R, p = poses(self.chain, rows)
        return R.reshape(*lead, 3, 3), p.reshape(*lead, 3)

    def flange_pose(self, q: ArrayLike) -> Pose:
        """The flange in the world for one configuration (N,)."""
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = self.forward(q)
        return Pose.from_matrix(matrix)

    def jacobian(self, q: ArrayLike) -> FloatArray:
        """Jacobians (..., 6, N) of the flange's linear, then angular velocity, world axes."""
        lead, (rows,) = self._rows(q)
        return np.asarray(jacobians(self.chain, rows)).reshape(*lead, 6, self.size)

    def hessian(self, q: ArrayLike) -> FloatArray:
        """Derivatives ∂J[:, j]/∂q[k] of the Jacobian, (..., 6, N, N) with j before k."""
        lead, (rows,) = self._rows(q)
        return np.asarray(hessians(self.chain, rows)).reshape(*lead, 6, self.size, self.size)

    @cached_property
    def recognised(self) -> Recognised | None:
        """The closed form of inverse kinematics that fits the arm, None if none does."""
        return recognise(self.arm_chain)

    @cached_property
    def measured_arm_angle(self) -> ArmAngle | None:
        """What the arm angle is measured by; None of an arm that counts none."""
        reference = self.arm_angle_reference
        if reference is None:
            return None
        return arm_angle_of(self.joints, self.along, self.flange, reference)

    def arm_angle(self, q: ArrayLike) -> float | None:
        """The arm angle, rad, of a configuration (N,); None of an arm that counts none."""
        measured = self.measured_arm_angle
        if measured is None:
            return None
        return arm_angle_at(self.arm_chain, measured, self._arm_values(q), np.empty(0))

    def arm_angle_slope(self, q: ArrayLike) -> FloatArray:
        """The derivative (n,) of the arm angle with respect to the arm's joints.

        Raises:
            InputError: the arm counts none.
        """
        if self.measured_arm_angle is None:
            raise InputError(f"robot {self.name} has no arm angle")
        slope = np.empty(self.arm_size)
        arm_angle_at(self.arm_chain, self.measured_arm_angle, self._arm_values(q), slope)
        return slope

    def _arm_values(self, q: ArrayLike) -> FloatArray:
        _, (rows,) = self._rows(q)
        return rows[0, : self.arm_size]

    @cached_property
    def _inverse(self) -> ArmInverse:
        return ArmInverse(
            self.arm_chain,
            self.joints,
            self.coupled_ranges,
            self.recognised,
            self.measured_arm_angle,
        )

    def inverse(
        self,
        pose: Pose | FloatArray,
        external: Sequence[float] = (),
        arm_angle: float | None = None,
    ) -> tuple[InverseSolution, ...]:
        """All configurations of the arm within limits that bring the flange to a pose.

        Args:
            pose: of the flange in the world, as a pose or a matrix (4, 4).
            external: values of all external axes.
            arm_angle: rad; None if any will do.

        Raises:
            UnreachableError: there is none; it says by how much.
            InputError: an arm angle is asked of an arm that counts none.
        """
        if arm_angle is not None and self.measured_arm_angle is None:
            raise InputError(f"robot {self.name} has no arm angle")
        if len(external) != len(self.external_axes):
            raise InputError(
                f"robot {self.name} has {len(self.external_axes)} external axes; "
                f"{len(external)} values were given"
            )
        matrix = pose.matrix() if isinstance(pose, Pose) else np.asarray(pose, dtype=float)
        (R,), (p,) = self._in_base(matrix[None], np.array([external], dtype=float))
        return self._inverse.at(R, p, arm_angle)

    def inverse_at_each(self, flanges: FloatArray, external: FloatArray) -> list[FloatArray | None]:
        """What `inverse` finds at each of many poses, configurations (K, n), at once.

        Args:
            flanges: (M, 4, 4), in the world.
            external: (M, …), values of all external axes.

        Returns:
            None where `inverse` has to be asked.
        """
        return self._inverse.at_each(*self._in_base(flanges, external))

    def _in_base(self, flanges: FloatArray, external: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rotations (M, 3, 3) and positions (M, 3) m of flanges (M, 4, 4) in the base's frame."""
        values = np.zeros((len(flanges), self.size))
        values[:, self.arm_size :] = external
        R, p = poses(self.base_chain, values)
        back = R.swapaxes(1, 2)
        apart = flanges[:, :3, 3] - p
        return back @ flanges[:, :3, :3], (back @ apart[..., None])[..., 0]

    def turns(self, q: ArrayLike) -> FloatArray:
        """Arm configurations (T, n) within limits, whole turns away from q (n,), nearest first."""
        return self._inverse.ranges.turns(np.asarray(q, dtype=float))

    # Dynamics

    def dynamics(self, load: Inertia | None = None) -> Dynamics:
        """The equations of motion with a load in the flange's frame.

        Raises:
            InputError: the links' inertias are not known.
        """
        if not self.links:
            origin = self.origins.get("inertia", "")
            which = f" ({origin})" if origin.startswith("unknown") else ""
            raise InputError(
                f"the dynamics of {self.name} need the inertias of its links, which are not known"
                f"{which}; add them to its description ([[link]] in a catalogue file, <inertial> "
                "in URDF)"
            )
        return Dynamics.of(self._tree(load or Inertia(0.0)))

    def _tree(self, load: Inertia) -> JointTree:
        """All axes as a tree of joints with a body behind each."""
        nodes: list[TreeNode] = []
        places: dict[str | None, int] = {None: -1}

        def plant(axis: ExternalAxis) -> None:
            if axis.name in places:
                return
            if axis.carried_by is not None:
                plant(self.external_axis(axis.carried_by))
            index = self.axis_names.index(axis.name)
            parent = places[axis.carried_by]
            nodes.append(TreeNode(axis.joint, parent, IDENTITY, index, axis.inertia))
            places[axis.name] = len(nodes) - 1

        for axis in self.external_axes:
            plant(axis)
        parent, step = places[self._carrying_track()], self.base
        for index in self.along:
            body = self.links[index]
            if index == self.along[-1]:
                body = body + load.placed(self.flange)
            *between, last = self.joint_stages(index)
            for turn, driver in [*between, last]:
                carried = body if turn is last[0] else Inertia(0.0)
                nodes.append(TreeNode(turn, parent, step, driver, carried))
                parent, step = len(nodes) - 1, IDENTITY
        return JointTree(self.name, tuple(nodes), self.gravity)

    def inverse_dynamics(
        self, q: ArrayLike, dq: ArrayLike, ddq: ArrayLike, load: Inertia | None = None
    ) -> FloatArray:
        """Torques (..., N) N m (N if prismatic) of a motion; see `Dynamics.torques`.

        Args:
            q, dq, ddq: (..., N).
            load: carried by the flange, in the flange's frame; see `carried_inertia`.
        """
        lead, rows = self._rows(q, dq, ddq)
        return self.dynamics(load).torques(*rows).reshape(*lead, self.size)

    def pull_inverse_dynamics(
        self, q: ArrayLike, dq: ArrayLike, ddq: ArrayLike, bar: ArrayLike, load: Inertia | None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Reverse of `inverse_dynamics`: gradients (..., N) with respect to q, q̇ and q̈.

        Args:
            q, dq, ddq, load: as there.
            bar: (..., N), gradient with respect to the torques.
        """
        lead, (*states, weight) = self._rows(q, dq, ddq, bar)
        parts = self.dynamics(load).pull_torques((states[0], states[1], states[2]), weight)
        a, b, c = (part.reshape(*lead, self.size) for part in parts)
        return a, b, c

    def inverse_dynamics_derivatives(
        self, q: ArrayLike, dq: ArrayLike, ddq: ArrayLike, load: Inertia | None = None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """∂τ/∂q, ∂τ/∂q̇ and ∂τ/∂q̈, each (..., N, N) with τ before the variable."""
        lead, rows = self._rows(q, dq, ddq)
        parts = self.dynamics(load).torque_derivatives(*rows)
        a, b, c = (part.reshape(*lead, self.size, self.size) for part in parts)
        return a, b, c
