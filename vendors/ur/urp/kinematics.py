"""The arm's own Denavit–Hartenberg table, as PolyScope writes it into programs and installations.

    <kinematics status="LINEARIZED" validChecksum="true">
      <deltaTheta value="…"/> <a value="…"/> <d value="…"/> <alpha value="…"/>

Row i is Rz(qᵢ + δθᵢ) Tz(dᵢ) Tx(aᵢ) Rx(αᵢ). A table that the controller has linearised has d of
hundreds of metres along the parallel axes 2, 3 and 4, which cancel: tables are compared by where
the flange is, never row by row.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ....core.arrays import FloatArray
from ....core.spatial.pose import Pose
from ....core.spatial.rotation import rotation_vector
from .xml_file import Element, child, numbers

_COLUMNS = "deltaTheta", "a", "d", "alpha"
JOINTS = 6
_MOST_STEPS = 60
_REACHED = 1e-11
"""m, rad."""
_LONGEST_STEP = 0.3
"""rad of a joint in one step."""


@dataclass(frozen=True)
class DhTable:
    """A table of six rows: δθ rad, a m, d m, α rad.

    Args:
        rows: (6, 4) as a tuple of tuples.
        status: as stated: ``LINEARIZED``, ``NOT_LINEARIZED``, ``NOT_INITIALIZED``.
    """

    rows: tuple[tuple[float, float, float, float], ...]
    status: str = field(default="", compare=False)

    @property
    def calibrated(self) -> bool:
        """Whether it is that of one arm, and not the nominal one of its type."""
        return self.status != "NOT_INITIALIZED"

    @property
    def known(self) -> bool:
        """Whether it describes an arm; tools that write programs leave zeros."""
        return any(abs(row[1]) > 0.0 or abs(row[2]) > 0.0 for row in self.rows)

    def flange(self, joints: Sequence[float]) -> Pose:
        """The flange in the base's frame, joint values (6,) in rad."""
        return Pose.from_matrix(self.flanges(np.array([joints], dtype=float))[0])

    def flanges(self, q: FloatArray) -> FloatArray:
        """The same of joint values (N, 6): matrices (N, 4, 4)."""
        return self._frames(q)[-1]

    def joints(self, flange: Pose, near: Sequence[float]) -> tuple[float, ...] | None:
        """Joint values (6,) rad that put the flange at a pose, by Newton's method.

        Args:
            flange: in the base's frame.
            near: values to begin from.

        Returns:
            Those that are reached from there; None if none are, within 1e-11 m and rad.
        """
        goal, q = flange.matrix(), np.array(near, dtype=float)
        for _ in range(_MOST_STEPS):
            frames = [frame[0] for frame in self._frames(q[None])]
            error = np.concatenate(
                (
                    goal[:3, 3] - frames[-1][:3, 3],
                    rotation_vector(goal[:3, :3] @ frames[-1][:3, :3].T),
                )
            )
            if np.abs(error).max() < _REACHED:
                return tuple(q.tolist())
            axes = np.array([frame[:3, 2] for frame in frames[:-1]])
            arms = frames[-1][:3, 3] - np.array([frame[:3, 3] for frame in frames[:-1]])
            jacobian = np.vstack((np.cross(axes, arms).T, axes.T))
            step = np.linalg.lstsq(jacobian, error, rcond=1e-9)[0]
            q += step * min(1.0, _LONGEST_STEP / max(np.abs(step).max(), _REACHED))
        return None

    def _frames(self, q: FloatArray) -> list[FloatArray]:
        """The base's frame and those behind each joint, of joint values (N, 6): (N, 4, 4) each."""
        table = np.array(self.rows)
        T = np.broadcast_to(np.eye(4), (len(q), 4, 4))
        frames = [T]
        for i, (theta, a, d, alpha) in enumerate(table):
            c, s = np.cos(q[:, i] + theta), np.sin(q[:, i] + theta)
            ca, sa = np.cos(alpha), np.sin(alpha)
            step = np.zeros((len(q), 4, 4))
            step[:, 0, 0], step[:, 0, 1], step[:, 0, 2], step[:, 0, 3] = c, -s * ca, s * sa, a * c
            step[:, 1, 0], step[:, 1, 1], step[:, 1, 2], step[:, 1, 3] = s, c * ca, -c * sa, a * s
            step[:, 2, 1], step[:, 2, 2], step[:, 2, 3] = sa, ca, d
            step[:, 3, 3] = 1.0
            T = T @ step
            frames.append(T)
        return frames


def table_of(element: Element | None) -> DhTable | None:
    """The table of an element ``kinematics``; None if it is none, or incomplete."""
    if element is None:
        return None
    columns = [numbers(_value(element, name), JOINTS) for name in _COLUMNS]
    known = [column for column in columns if column is not None]
    if len(known) != len(_COLUMNS):
        return None
    theta, a, d, alpha = known
    table = DhTable(tuple(zip(theta, a, d, alpha, strict=True)), element.get("status", ""))
    return table if table.known else None


def _value(element: Element, name: str) -> str | None:
    found = child(element, name)
    if found is None:
        return None
    value = found.get("value")
    return str(found.text if value is None else value)
