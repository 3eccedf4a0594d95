"""A KUKA's ``$machine.dat``: ranges, speeds and accelerations of this arm's axes.

Of an archive it stands in ``KRC/R1/Mada``. Data are assigned one a line, ``$NAME[i]=value``;
structs stand in braces, strings in quotes. What is read of each axis i:

- range: ``$SOFTN_END[i]`` to ``$SOFTP_END[i]``, degrees;
- speed: 6 · ``$VEL_AXIS_MA[i]`` · D / |N| degrees/s, motor turns per minute through the gear
  ``$RAT_MOT_AX[i]={N …,D …}``;
- acceleration: ``$AXIS_JERK[i]`` · ``$DEF_FLT_PTP`` / 20 (degrees/s³, s), inferred: it is what is
  published of a KR 6 R900 for all axes, and within 7 % of what is of two larger arms. KR C2, which
  has no such datum, comes to full speed within ``$RAISE_TIME[i]`` ms.

Lengths are compared with those of the robot's type: a file of another arm is refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ...core.files.reading import read_bytes
from ...core.robot.joint import Joint
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose
from ...core.spatial.rotation import matrix_from_rotation_vector

Datum = float | str | bool | Mapping[str, "float | str"]
_LARGEST = 1 << 24
_LINE = re.compile(
    r"^\s*(?:DECL\s+)?(?:GLOBAL\s+)?(?:[A-Z_][A-Z0-9_]*\s+)?"
    r"(\$[A-Z0-9_]+)\s*(?:\[\s*(\d*)\s*,?\s*\])?\s*=\s*"
    r'("[^"]*"|\{[^}]*\}|[^;]*?)\s*(?:;.*)?$',
    re.IGNORECASE,
)
_FIELD = re.compile(r'([A-Z_][A-Z0-9_]*)\s+("[^"]*"|[^,{}]+)', re.IGNORECASE)
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_AXES = 6
_APART = 1e-3
"""m by which the flange of the same type may be apart, as published lengths are rounded."""


class MachineData:
    """What a ``$machine.dat`` assigns.

    Args:
        file: for messages.
        data: by name, in capitals, and index; 0 of what has none.
    """

    def __init__(self, file: Path, data: Mapping[tuple[str, int], Datum]) -> None:
        self.file = file
        self.data = data

    @classmethod
    def read(cls, file: Path) -> MachineData:
        """The data of a file.

        Raises:
            InputError: it cannot be read, or assigns nothing.
        """
        data: dict[tuple[str, int], Datum] = {}
        for line in read_bytes(file, _LARGEST).decode("latin-1").splitlines():
            found = _LINE.match(line)
            if found is not None:
                name, index, value = found.groups()
                data[name.upper(), int(index or 0)] = _datum(value)
        if not data:
            raise InputError(f"{file}: no $machine.dat: it assigns nothing")
        return cls(file, data)

    def has(self, name: str, index: int = 0) -> bool:
        """Whether it assigns a datum."""
        return (name, index) in self.data

    def number(self, name: str, index: int = 0) -> float:
        """A number.

        Raises:
            InputError: there is none.
        """
        value = self._datum(name, index)
        if isinstance(value, bool) or not isinstance(value, float):
            raise self._wrong(name, index, "a number")
        return value

    def struct(self, name: str, index: int = 0) -> Mapping[str, float]:
        """The numbers of a struct by their names, in capitals.

        Raises:
            InputError: there is none.
        """
        value = self._datum(name, index)
        if not isinstance(value, Mapping):
            raise self._wrong(name, index, "a struct in braces")
        return {key: one for key, one in value.items() if isinstance(one, float)}

    def frame(self, name: str) -> Pose:
        """A frame {X, Y, Z mm, A, B, C degrees}.

        Raises:
            InputError: there is none.
        """
        own = self.struct(name)
        matrix = np.eye(4)
        for key, axis in zip("ABC", (2, 1, 0), strict=True):
            angle = math.radians(own.get(key, 0.0))
            turn = matrix_from_rotation_vector(angle * np.eye(3)[axis])
            matrix[:3, :3] = matrix[:3, :3] @ turn
        matrix[:3, 3] = [1e-3 * own.get(key, 0.0) for key in "XYZ"]
        return Pose.from_matrix(matrix)

    def _datum(self, name: str, index: int) -> Datum:
        if not self.has(name, index):
            raise InputError(f"{self.file}: {_spelt(name, index)} is missing")
        return self.data[name, index]

    def _wrong(self, name: str, index: int, wanted: str) -> InputError:
        return InputError(f"{self.file}: {_spelt(name, index)} is not {wanted}")


def with_machine_data(robot: Robot, file: Path) -> Robot:
    """The robot with the ranges, speeds and accelerations that its controller's file states.

    Args:
        robot: of this type.
        file: ``$machine.dat``.

    Raises:
        InputError: the file cannot be read, lacks what is read of it, or is another arm's.
    """
    data = MachineData.read(file)
    if robot.arm_size != _AXES:
        raise InputError(f"{file}: machine data of six axes; {robot.name} has {robot.arm_size}")
    _check_lengths(robot, data)
    joints = tuple(_axis(joint, i + 1, data) for i, joint in enumerate(robot.joints))
    said = f"published: {file.name} of its controller"
    origins = {**robot.origins, "range": said, "velocity": said}
    if joints[0].acceleration != robot.joints[0].acceleration:
        origins["acceleration"] = f"computed: {file.name} of its controller, see machine_data"
    return replace(robot, joints=joints, origins=origins)


def _axis(joint: Joint, i: int, data: MachineData) -> Joint:
    """An axis as the data have it."""
    gear = data.struct("$RAT_MOT_AX", i)
    turns, one = gear.get("N", 0.0), gear.get("D", 0.0)
    speed = 6.0 * data.number("$VEL_AXIS_MA", i) * one / abs(turns) if turns else 0.0
    lower, upper = data.number("$SOFTN_END", i), data.number("$SOFTP_END", i)
    if not (speed > 0.0 and lower < upper):
        raise InputError(f"{data.file}: speed or range of axis {i} makes no sense")
    acceleration = joint.acceleration
    if data.has("$AXIS_JERK", i) and data.has("$DEF_FLT_PTP"):
        jerk, window = data.number("$AXIS_JERK", i), 1e-3 * data.number("$DEF_FLT_PTP")
        acceleration = math.radians(jerk * window / 20.0)
    elif data.has("$RAISE_TIME", i):
        acceleration = math.radians(speed) / (1e-3 * data.number("$RAISE_TIME", i))
    return replace(
        joint,
        lower=math.radians(lower),
        upper=math.radians(upper),
        velocity=math.radians(speed),
        acceleration=acceleration,
    )


def _check_lengths(robot: Robot, data: MachineData) -> None:
    """Refuse the data of another arm, by where their flanges are."""
    turns = np.random.default_rng(0).uniform(-1.0, 1.0, (20, _AXES))
    rest = np.zeros(robot.size - _AXES)
    off = 0.0
    for q in turns:
        own = robot.with_base(Pose()).flange_pose(np.concatenate([q, rest])).position
        off = max(off, math.dist(own, flange(data, q).position))
    if off > _APART:
        raise InputError(
            f"{data.file}: the flange of its arm is up to {1e3 * off:.1f} mm from that of a "
            f"{robot.name}: name the robot that the file is of"
        )


def flange(data: MachineData, q: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Pose:
    """The flange in the robot's root at joints q (6,) rad, by the lengths of the data.

    T = $TIRORO · Rz(θ₁) · Tx($LENGTH_A) · Ry(θ₂) · Tx($LENGTH_B) · Ry(θ₃) · $TX3P3 · Rz(θ₄) ·
    $DH_4 · Rz(θ₅) · $DH_5 · Rz(θ₆) · $TFLWP, θᵢ = $AXIS_DIR[i] qᵢ.

    Raises:
        InputError: a length is missing.
    """
    theta = [data.number("$AXIS_DIR", i + 1) * float(x) for i, x in enumerate(q)]
    wrist = [_hand(data.struct(name)) for name in ("$DH_4", "$DH_5")]
    upper = 1e-3 * data.number("$LENGTH_A"), 1e-3 * data.number("$LENGTH_B")
    made = data.frame("$TIRORO") @ _turn(2, theta[0]) @ Pose((upper[0], 0.0, 0.0))
    made = made @ _turn(1, theta[1]) @ Pose((upper[1], 0.0, 0.0)) @ _turn(1, theta[2])
    made = made @ data.frame("$TX3P3") @ _turn(2, theta[3]) @ wrist[0]
    return made @ _turn(2, theta[4]) @ wrist[1] @ _turn(2, theta[5]) @ data.frame("$TFLWP")


def _hand(row: Mapping[str, float]) -> Pose:
    """Tz(D) Tx(A) Rx(α) of a row of the wrist."""
    shift = Pose((1e-3 * row.get("DHART_A", 0.0), 0.0, 1e-3 * row.get("DHART_D", 0.0)))
    return shift @ _turn(0, math.radians(row.get("DHART_ALPHA", 0.0)))


def _turn(axis: int, angle: float) -> Pose:
    matrix = np.eye(4)
    matrix[:3, :3] = matrix_from_rotation_vector(angle * np.eye(3)[axis])
    return Pose.from_matrix(matrix)


def _datum(text: str) -> Datum:
    """A value as the file writes it."""
    text = text.strip()
    if text.startswith("{"):
        inner = text.strip("{}").partition(":")
        fields = inner[2] if inner[1] else inner[0]
        return {key.upper(): _plain(one) for key, one in _FIELD.findall(fields)}
    if text.upper() in ("TRUE", "FALSE"):
        return text.upper() == "TRUE"
    return _plain(text)


def _plain(text: str) -> float | str:
    text = text.strip()
    return float(text) if _NUMBER.fullmatch(text) else text.strip('"')


def _spelt(name: str, index: int) -> str:
    return f"{name}[{index}]" if index else name
