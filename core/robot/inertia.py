"""Mass, centre and inertia of a rigid body as a value."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np

from ..arrays import FloatArray
from ..errors import InputError
from ..spatial.pose import IDENTITY, Pose, Quaternion, Vector3
from ..spatial.rotation import matrix_from_quaternion, skew

Matrix3 = tuple[Vector3, Vector3, Vector3]


class PrincipalLoad(Protocol):
    """A load as controllers declare it: see `flyby.core.program.tool.Load`."""

    @property
    def mass(self) -> float: ...
    @property
    def centre(self) -> Vector3: ...
    @property
    def inertia(self) -> Vector3: ...
    @property
    def axes(self) -> Quaternion: ...


class LoadedTool(Protocol):
    """A tool with its own mass: see `flyby.core.program.tool.Tool`."""

    @property
    def tcp(self) -> Pose: ...
    @property
    def load(self) -> PrincipalLoad | None: ...
    @property
    def robot_held(self) -> bool: ...


@dataclass(frozen=True, slots=True)
class Inertia:
    """A rigid body in some frame.

    Args:
        mass: kg.
        centre: centre of mass, m.
        tensor: inertia about the centre of mass in the frame's axes, kg m², symmetric.

    Raises:
        InputError: a number is not finite, the mass is negative, or the tensor is not symmetric
            or has a negative principal moment.
    """

    mass: float
    centre: Vector3 = (0.0, 0.0, 0.0)
    tensor: Matrix3 = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    def __post_init__(self) -> None:
        tensor = np.array(self.tensor)
        numbers = (self.mass, *self.centre, *tensor.ravel())
        if not all(map(math.isfinite, numbers)) or self.mass < 0.0:
            raise InputError(f"a body needs finite numbers and a mass not negative: {self}")
        size = float(np.abs(tensor).max())
        if float(np.abs(tensor - tensor.T).max()) > 1e-9 * size:
            raise InputError(f"an inertia tensor must be symmetric: {self.tensor}")
        if float(np.linalg.eigvalsh(tensor).min()) < -1e-6 * size:
            raise InputError(f"an inertia tensor needs principal moments >= 0: {self.tensor}")

    @classmethod
    def _from_arrays(cls, mass: float, centre: FloatArray, tensor: FloatArray) -> Self:
        x, y, z = (float(v) for v in centre)
        rows = [tuple(float(v) for v in row) for row in 0.5 * (tensor + tensor.T)]
        a, b, c = rows
        return cls(mass, (x, y, z), ((a[0], a[1], a[2]), (b[0], b[1], b[2]), (c[0], c[1], c[2])))

    @classmethod
    def of_load(cls, load: PrincipalLoad, placement: Pose = IDENTITY) -> Self:
        """The body of a load that is declared in the frame ``placement``."""
        axes = matrix_from_quaternion(np.array(load.axes))
        axes = axes / np.linalg.norm(axes, axis=0)
        tensor = axes @ np.diag(load.inertia) @ axes.T
        return cls._from_arrays(load.mass, np.array(load.centre), tensor).placed(placement)

    def placed(self, placement: Pose) -> Self:
        """The same body, its frame standing at ``placement``, seen from the outer frame."""
        T = placement.matrix()
        centre = T[:3, :3] @ np.array(self.centre) + T[:3, 3]
        tensor = T[:3, :3] @ np.array(self.tensor) @ T[:3, :3].T
        return self._from_arrays(self.mass, centre, tensor)

    def __add__(self, other: Inertia) -> Inertia:
        """Both bodies joined rigidly (Steiner's theorem)."""
        mass = self.mass + other.mass
        if mass == 0.0:
            return self._from_arrays(
                0.0, np.array(self.centre), np.array(self.tensor) + np.array(other.tensor)
            )
        pair = [(self, np.array(self.centre)), (other, np.array(other.centre))]
        centre = sum((body.mass * at for body, at in pair), np.zeros(3)) / mass
        tensor = np.zeros((3, 3))
        for body, at in pair:
            arm = skew(at - centre)
            tensor += np.array(body.tensor) - body.mass * arm @ arm
        return self._from_arrays(mass, centre, tensor)


def carried_inertia(tool: LoadedTool, payload: PrincipalLoad | None = None) -> Inertia:
    """What the flange carries, in the flange's frame.

    Args:
        tool: its load counts only if the robot holds it.
        payload: in the tool's frame at its centre point; in the flange's frame if the tool stands
            still, since then the robot holds the payload itself.
    """
    carried = Inertia(0.0)
    if tool.robot_held and tool.load is not None:
        carried = carried + Inertia.of_load(tool.load)
    if payload is not None:
        carried = carried + Inertia.of_load(payload, tool.tcp if tool.robot_held else IDENTITY)
    return carried
