"""External axes E1…E6 of a ``$machine.dat``: the tracks and tables that its kinematic chains are.

Of chain n, ``$ETn_AX`` names up to three axes, and with z of each joint's frame as its axis

    root · $ETn_TA1KR · joint 1 · $ETn_TA2A1 · joint 2 · $ETn_TA3A2 · joint 3 · $ETn_TFLA3

is its flange. ``$EX_KIN``.ETn says what stands on that: the robot (``#ERSYS``, the root is
``$ERSYSROOT``), or a base (``#EASYS`` … ``#EFSYS``, the root is that of the ``MACHINE_DEF`` of this
type in ``$config.dat``). Sources: KUKA, *Machine Data* for KR C2; a forum of the maker's staff for
the order of the chain; inferred for controllers that came later.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ....core.errors import InputError
from ....core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from ....core.spatial.pose import IDENTITY, Pose
from ..data_list import DataList
from .axis_limits import axis_limits, axis_name, is_linear
from .geometry import AXES, frame

MOST = 6
_CARRIES_ROBOT = "#ERSYS"
_STARTING = 0.5
"""s to full speed, where nothing is stated. Assumed."""
_ASIDE = 1e-6
"""m."""


@dataclass(frozen=True, slots=True)
class External:
    """What external axes a controller drives.

    Args:
        axes: E1, E2, …
        base: the robot's base behind the track that carries it; None if none does.
        doubts: what is not known of them.
    """

    axes: tuple[ExternalAxis, ...] = ()
    base: Pose | None = None
    doubts: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class _Chain:
    """Axes one behind the other, by their numbers from 1, and the frames before and behind them."""

    number: int
    kind: str
    axes: tuple[int, ...]
    frames: tuple[Pose, ...]
    flange: Pose


def external_axes(data: DataList, roots: Mapping[str, Pose]) -> External:
    """Those of a robot.

    Args:
        data: of ``$machine.dat``.
        roots: of tables in the world, by their type (``#EASYS``).

    Raises:
        InputError: an axis lacks its range or speed, or the chains contradict each other.
    """
    count = data.number("$EX_AX_NUM") if data.has("$EX_AX_NUM") else 0.0
    if not (count == int(count) and 0 <= count <= MOST):
        raise InputError(f"{data.name}: $EX_AX_NUM is 0 to {MOST}, not {count:g}")
    chains = _chains(data, int(count))
    made: dict[int, ExternalAxis] = {}
    doubts: list[str] = []
    base = None
    for chain in chains:
        if set(chain.axes) & set(made):
            raise InputError(f"{data.name}: $ET{chain.number}_AX has an axis of another chain")
        if chain.kind == _CARRIES_ROBOT:
            root = frame(data, "$ERSYSROOT") if data.has("$ERSYSROOT") else IDENTITY
            base = chain.flange
        elif chain.kind in roots:
            root = roots[chain.kind]
        else:
            root = IDENTITY
            doubts.append(
                f"where the table of {axis_name(AXES + chain.axes[0])} stands is not known (ROOT "
                "of its MACHINE_DEF in $config.dat): it is taken to stand in the world's origin"
            )
        made |= _carriers(data, chain, root, doubts)
    for number in range(1, int(count) + 1):
        if number not in made:
            name = axis_name(AXES + number)
            made[number] = _axis(data, number, IDENTITY, Pose(), ExternalRole.TABLE, None, doubts)
            doubts.append(f"{name} belongs to no kinematic chain ($ETn_AX): it carries nothing")
    return External(tuple(made[number] for number in sorted(made)), base, tuple(doubts))


def tables_of(data: DataList) -> dict[str, str]:
    """The axis whose frame is the flange of each table, by the table's type (``#EASYS``).

    Raises:
        InputError: as `external_axes`.
    """
    count = data.number("$EX_AX_NUM") if data.has("$EX_AX_NUM") else 0.0
    chains = _chains(data, int(count) if 0.0 <= count <= MOST else 0)
    return {
        chain.kind: axis_name(AXES + chain.axes[-1])
        for chain in chains
        if chain.kind != _CARRIES_ROBOT
    }


def _chains(data: DataList, count: int) -> list[_Chain]:
    """The chains that carry something."""
    kinds = data.struct("$EX_KIN") if data.has("$EX_KIN") else {}
    found = []
    for n in range(1, MOST + 1):
        kind = kinds.get(f"ET{n}", "#NONE")
        if not isinstance(kind, str) or kind == "#NONE" or not data.has(f"$ET{n}_AX"):
            continue
        named = data.struct(f"$ET{n}_AX")
        numbers = []
        for key in ("TR_A1", "TR_A2", "TR_A3"):
            name = named.get(key, "#NONE")
            if isinstance(name, str) and name in (f"#E{k}" for k in range(1, count + 1)):
                numbers.append(int(name[2:]))
        if len(set(numbers)) != len(numbers):
            raise InputError(f"{data.name}: $ET{n}_AX names an axis twice")
        if numbers:
            steps = [_step(data, f"$ET{n}_{step}") for step in ("TA1KR", "TA2A1", "TA3A2", "TFLA3")]
            behind = IDENTITY
            for step in steps[len(numbers) :]:
                behind = behind @ step
            found.append(_Chain(n, kind, tuple(numbers), tuple(steps[: len(numbers)]), behind))
    return found


def _step(data: DataList, name: str) -> Pose:
    return frame(data, name) if data.has(name) else IDENTITY


def _carriers(
    data: DataList, chain: _Chain, root: Pose, doubts: list[str]
) -> dict[int, ExternalAxis]:
    """The axes of a chain. What a table's flange is turned against its axis goes into the joint."""
    track = chain.kind == _CARRIES_ROBOT
    role = ExternalRole.TRACK if track else ExternalRole.TABLE
    made: dict[int, ExternalAxis] = {}
    carrier = None
    for number, step in zip(chain.axes, chain.frames, strict=True):
        last = number == chain.axes[-1]
        behind = chain.flange if last and not track else IDENTITY
        before = root @ step if carrier is None else step
        made[number] = _axis(data, number, before, behind, role, carrier, doubts)
        carrier = axis_name(AXES + number)
    return made


def _axis(
    data: DataList,
    number: int,
    before: Pose,
    behind: Pose,
    role: ExternalRole,
    carrier: str | None,
    doubts: list[str],
) -> ExternalAxis:
    """An axis about, or along, z of the frame ``before``, whose moving frame stands ``behind``."""
    i = AXES + number
    linear, limits = is_linear(data, i), axis_limits(data, i)
    aside = math.hypot(*behind.position[:2])
    if not linear and aside > _ASIDE:
        doubts.append(
            f"the flange of {axis_name(i)} stands {1e3 * aside:.3f} mm beside its axis, which is "
            "left out: bases on it are off by that"
        )
        behind = Pose((0.0, 0.0, behind.position[2]), behind.quaternion)
    if limits.acceleration is None:
        doubts.append(
            f"no acceleration of {axis_name(i)} is stated: full speed in {_STARTING:g} s is assumed"
        )
    sign = data.number("$AXIS_DIR", i) if data.has("$AXIS_DIR", i) else 1.0
    x, y, z = (
        float(v) for v in np.round(math.copysign(1.0, sign) * behind.matrix()[2, :3], 12) + 0.0
    )
    joint = Joint(
        name=axis_name(i),
        placement=before @ behind,
        axis=(x, y, z),
        lower=limits.lower,
        upper=limits.upper,
        velocity=limits.velocity,
        acceleration=limits.acceleration or limits.velocity / _STARTING,
        kind=JointKind.PRISMATIC if linear else JointKind.REVOLUTE,
    )
    return ExternalAxis(joint, role, carrier)
