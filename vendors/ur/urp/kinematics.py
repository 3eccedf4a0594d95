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
from .xml_file import Element, child, numbers

_COLUMNS = "deltaTheta", "a", "d", "alpha"
JOINTS = 6


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
        table = np.array(self.rows)
        T = np.broadcast_to(np.eye(4), (len(q), 4, 4))
        for i, (theta, a, d, alpha) in enumerate(table):
            c, s = np.cos(q[:, i] + theta), np.sin(q[:, i] + theta)
            ca, sa = np.cos(alpha), np.sin(alpha)
            step = np.zeros((len(q), 4, 4))
            step[:, 0, 0], step[:, 0, 1], step[:, 0, 2], step[:, 0, 3] = c, -s * ca, s * sa, a * c
            step[:, 1, 0], step[:, 1, 1], step[:, 1, 2], step[:, 1, 3] = s, c * ca, -c * sa, a * s
            step[:, 2, 1], step[:, 2, 2], step[:, 2, 3] = sa, ca, d
            step[:, 3, 3] = 1.0
            T = T @ step
        return np.asarray(T)


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
