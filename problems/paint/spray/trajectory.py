"""The motion of a paint gun: waypoints, durations and flow, straight between the waypoints."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from ....core.arrays import BoolArray, FloatArray
from ....core.errors import InputError
from ....core.spatial.pose import Pose

_UNIT = 1e-6
_ROUNDING = 1e-15


@dataclass(frozen=True, eq=False)
class PaintTrajectory:
    """Waypoints joined by straight segments, each driven at its own constant speed.

    Along a segment the position is linear in time, and the nozzle's direction turns along the chord
    between its ends: it is the normalised linear interpolation. Rotation about the nozzle's axis
    is left open unless ``fan`` says where the long axis of an elliptic footprint points.

    Args:
        position: (W, 3) of the TCP in the part's frame, m; W >= 2.
        nozzle: (W, 3) unit vectors in which the paint leaves the gun, from the gun to the part.
        duration: (W-1,) of each segment, s > 0.
        flow: (W-1,) paint flow along each segment as a share of the nominal one, >= 0; 0 where the
            gun is off.
        fan: (W, 3) unit vectors along the long axis of an elliptic footprint, not along the nozzle;
            None for footprints that are symmetric about the nozzle.

    Raises:
        InputError: a wrong shape, a number that is not finite, a duration that is not positive, a
            negative flow, a direction that is not of unit length (1e-6), or neighbouring
            directions that are opposite to each other.
    """

    position: FloatArray
    nozzle: FloatArray
    duration: FloatArray
    flow: FloatArray
    fan: FloatArray | None = None

    def __post_init__(self) -> None:
        position = _numbers("position", self.position)
        if position.ndim != 2 or position.shape[1] != 3 or len(position) < 2:
            raise InputError(f"position: expected (W, 3) with W >= 2, not {position.shape}")
        nozzle = _directions("nozzle", self.nozzle, position.shape)
        duration = _numbers("duration", self.duration)
        flow = _numbers("flow", self.flow)
        for name, value in (("duration", duration), ("flow", flow)):
            if value.shape != (len(position) - 1,):
                raise InputError(f"{name}: expected ({len(position) - 1},), not {value.shape}")
        _refuse("duration", duration <= 0.0, "is not above zero")
        _refuse("flow", flow < 0.0, "is negative")
        values = {"position": position, "nozzle": nozzle, "duration": duration, "flow": flow}
        if self.fan is not None:
            fan = values["fan"] = _directions("fan", self.fan, position.shape)
            along = np.abs(np.einsum("ij,ij->i", fan, nozzle)) > 1.0 - _UNIT
            _refuse("fan", along, "points along the nozzle")
        for name, value in values.items():
            value.flags.writeable = False
            object.__setattr__(self, name, value)

    @classmethod
    def at_speed(
        cls,
        position: ArrayLike,
        nozzle: ArrayLike,
        speed: ArrayLike,
        flow: ArrayLike = 1.0,
    ) -> Self:
        """The trajectory through waypoints at a speed of the TCP in m/s and a flow, one or (W-1,).

        Raises:
            InputError: as the class; segments without length need a duration, not a speed.
        """
        points = _numbers("position", position)
        speeds = _numbers("speed", speed)
        if not (speeds > 0.0).all():
            raise InputError("speed: a number above zero is needed")
        lengths = np.linalg.norm(np.diff(points, axis=0), axis=-1)
        _refuse("position", lengths <= 0.0, "is repeated by the next waypoint: give durations")
        flows = np.broadcast_to(_numbers("flow", flow), lengths.shape)
        return cls(points, _numbers("nozzle", nozzle), lengths / speeds, flows)

    @property
    def segments(self) -> int:
        """Number of segments, W - 1."""
        return len(self.duration)

    @property
    def lengths(self) -> FloatArray:
        """(W-1,) length of each segment, m."""
        return np.asarray(np.linalg.norm(np.diff(self.position, axis=0), axis=1))

    @property
    def speeds(self) -> FloatArray:
        """(W-1,) speed of the TCP on each segment, m/s."""
        return self.lengths / self.duration

    @property
    def times(self) -> FloatArray:
        """(W,) time of each waypoint from the first one, s."""
        return np.concatenate(([0.0], np.cumsum(self.duration)))

    @property
    def painting(self) -> BoolArray:
        """(W-1,) whether the gun is on."""
        return np.asarray(self.flow > 0.0)

    @property
    def total_length(self) -> float:
        """Length of the path of the TCP, m."""
        return float(self.lengths.sum())

    @property
    def total_duration(self) -> float:
        """Duration of all segments, s."""
        return float(self.duration.sum())

    def with_durations(self, duration: ArrayLike) -> Self:
        """The same path driven with other durations (W-1,), s."""
        return replace(self, duration=_numbers("duration", duration))

    def with_flow(self, flow: ArrayLike) -> Self:
        """The same motion with another flow: a number or (W-1,)."""
        values = np.broadcast_to(_numbers("flow", flow), (self.segments,))
        return replace(self, flow=values.copy())

    def moved(self, pose: Pose) -> Self:
        """The trajectory in a frame in which its own one stands at ``pose``."""
        matrix = pose.matrix()
        rotation = matrix[:3, :3]
        return replace(
            self,
            position=self.position @ rotation.T + matrix[:3, 3],
            nozzle=_unit(self.nozzle @ rotation.T),
            fan=None if self.fan is None else _unit(self.fan @ rotation.T),
        )


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def _numbers(name: str, value: ArrayLike) -> FloatArray:
    """A copy as an array of finite numbers."""
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected an array of numbers, not {value!r}") from None
    if not np.isfinite(array).all():
        raise InputError(f"{name}: {int((~np.isfinite(array)).sum())} numbers are not finite")
    return array


def _directions(name: str, value: ArrayLike, shape: tuple[int, ...]) -> FloatArray:
    """Unit vectors of which no two neighbours are opposite to each other."""
    vectors = _numbers(name, value)
    if vectors.shape != shape:
        raise InputError(f"{name}: expected {shape}, not {vectors.shape}")
    lengths = np.linalg.norm(vectors, axis=1)
    off = np.abs(lengths - 1.0)
    _refuse(name, off > _UNIT, "is not of unit length")
    vectors[off > _ROUNDING] /= lengths[off > _ROUNDING, None]  # the others stay what they are
    opposite = np.einsum("ij,ij->i", vectors[1:], vectors[:-1]) < -1.0 + _UNIT
    _refuse(name, opposite, "turns by half a turn to the next waypoint: put one between")
    return vectors


def _refuse(name: str, wrong: BoolArray, what: str) -> None:
    if wrong.any():
        raise InputError(f"{name}[{int(np.flatnonzero(wrong)[0])}] {what}")
