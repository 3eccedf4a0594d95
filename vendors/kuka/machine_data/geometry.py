"""Lengths of a ``$machine.dat`` → the joints' frames.

With θᵢ = $AXIS_DIR[i] Aᵢ the flange stands in the world at

    $ROBROOT · $TIRORO · Rz(θ₁) · Tx($LENGTH_A) · Ry(θ₂) · Tx($LENGTH_B) · Ry(θ₃) · $TX3P3 ·
    Rz(θ₄) · $DH_4 · Rz(θ₅) · $DH_5 · Rz(θ₆) · $TFLWP,

frames {X, Y, Z, A, B, C} in mm and degrees, rows of the wrist {DHART_D, DHART_A, DHART_ALPHA} =
Tz(D) Tx(A) Rx(α). Mastering angles (``$MAMES``) are no part of it. Checked against public models of
three arms: within 0.03 mm. Joint frames are laid parallel to the base's, as the lists of arms have
them, so that bodies and shapes of a listed arm fit the same arm of a file.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ....core.spatial.pose import IDENTITY, Pose, Vector3
from ..data_list import DataList, Value, numbers_of
from ..values.angles import quaternion

AXES = 6
_X, _Y, _Z = np.eye(3)


@dataclass(frozen=True, slots=True)
class ArmGeometry:
    """Where the six axes are at zero.

    Args:
        origins: of the joint frames in the base's, m; the frames are parallel to it.
        axes: unit directions, positive as the axes are counted.
        flange: in the base's frame.
    """

    origins: tuple[Vector3, ...]
    axes: tuple[Vector3, ...]
    flange: Pose

    def placements(self) -> tuple[Pose, ...]:
        """Each joint's frame in the one before."""
        before = ((0.0, 0.0, 0.0), *self.origins)
        return tuple(
            Pose(_vector(np.subtract(own, last)))
            for own, last in zip(self.origins, before, strict=False)
        )

    def flange_placement(self) -> Pose:
        """The flange in the frame behind the last joint."""
        return Pose(_vector(np.subtract(self.flange.position, self.origins[-1]))) @ Pose(
            quaternion=self.flange.quaternion
        )


def geometry(data: DataList) -> ArmGeometry:
    """The arm's.

    Raises:
        InputError: a length is missing, or makes no sense.
    """
    check_six_axes(data)
    directions = [data.number("$AXIS_DIR", i) for i in range(1, AXES + 1)]
    if any(abs(one) != 1.0 for one in directions):
        raise InputError(f"{data.name}: $AXIS_DIR is 1 or -1 of each axis, not {directions}")
    first = frame(data, "$TIRORO")
    second = first @ _along(data.number("$LENGTH_A"))
    third = second @ _along(data.number("$LENGTH_B"))
    fourth = third @ frame(data, "$TX3P3")
    fifth = fourth @ _row(data, "$DH_4")
    sixth = fifth @ _row(data, "$DH_5")
    frames = [one.matrix() for one in (first, second, third, fourth, fifth, sixth)]
    turned_about = (_Z, _Y, _Y, _Z, _Z, _Z)
    axes = [
        sign * (T[:3, :3] @ axis)
        for T, axis, sign in zip(frames, turned_about, directions, strict=True)
    ]
    at = [T[:3, 3] for T in frames]
    # Anywhere on its axis will do: as the lists of arms have it, at the floor, and beside axis 3.
    at[0] = at[0] - axes[0] * (axes[0] @ at[0])
    at[3] = at[3] - axes[3] * (axes[3] @ (at[3] - at[2]))
    return ArmGeometry(
        tuple(map(_vector, at)), tuple(map(_vector, axes)), sixth @ frame(data, "$TFLWP")
    )


def check_six_axes(data: DataList) -> None:
    """Refuse data of an arm that has not six free turning axes.

    Raises:
        InputError: with the reason.
    """
    if data.has("$NUM_AX") and data.number("$NUM_AX") != AXES:
        raise _refused(data, f"it has {data.number('$NUM_AX'):g} axes; arms of six are modelled")
    if data.flag("$DEF_A4FIX"):
        raise _refused(
            data,
            "its controller holds A4 at 0 ($DEF_A4FIX), and its name is that of no palletiser that "
            "is known",
        )
    if data.flag("$DEF_A5LINK"):
        raise _refused(data, "its controller links A5 to other axes ($DEF_A5LINK)")
    for i in range(1, AXES + 1):
        if data.has("$AXIS_TYPE", i) and data.number("$AXIS_TYPE", i) == LINEAR:
            raise _refused(data, f"its A{i} is linear; arms of six turning axes are modelled")


LINEAR = 1.0
"""``$AXIS_TYPE`` of an axis in mm; 3 is rotary, 5 endless."""


def frame(data: DataList, name: str) -> Pose:
    """A frame {X, Y, Z mm, A, B, C degrees}.

    Raises:
        InputError: there is none.
    """
    return pose_of(data.struct(name))


def pose_of(struct: Mapping[str, Value]) -> Pose:
    """The pose of a struct; components that are left out are 0."""
    own = numbers_of(struct)
    x, y, z, a, b, c = (own.get(key, 0.0) for key in "XYZABC")
    return Pose((1e-3 * x, 1e-3 * y, 1e-3 * z), quaternion(a, b, c))


def _row(data: DataList, name: str) -> Pose:
    """Tz(D) Tx(A) Rx(α) of a row of the wrist."""
    row = numbers_of(data.struct(name))
    turn = quaternion(0.0, 0.0, row.get("DHART_ALPHA", 0.0))
    return Pose((1e-3 * row.get("DHART_A", 0.0), 0.0, 1e-3 * row.get("DHART_D", 0.0)), turn)


def _along(length: float) -> Pose:
    return Pose((1e-3 * length, 0.0, 0.0)) if length else IDENTITY


def _vector(values: FloatArray) -> Vector3:
    x, y, z = (float(v) for v in np.round(values, 12) + 0.0)
    return x, y, z


def _refused(data: DataList, reason: str) -> InputError:
    model = data.text("$TRAFONAME").lstrip("#")
    return InputError(f"{data.name}: {model or 'the arm'} cannot be driven: {reason}")
