"""Parts that the robot picks and places: a kind of thing, how many there are, and what takes it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..files.tables import LENGTH, TomlTable
from ..program.tool import Load
from ..robot.pose_table import pose_at
from ..spatial.pose import IDENTITY, Pose, Vector3
from .geometry import Geometry
from .tables import read_geometry, read_load

NEAR = 0.05
"""m from the TCP within which a part is taken, where the cell file does not say."""
_MOST = 1000
"""Parts of one kind."""


@dataclass(frozen=True, slots=True)
class Workpiece:
    """Parts of one kind.

    Args:
        name: unique in the cell.
        geometry: shape and place of the first, in the world or in the frame of ``carried_by``.
        attach, release: what takes one, and lets go of it: words of a statement or whole ones, as
            `flyby.core.source.execution.answers.key` gives them.
        load: mass of one, in the shape's frame; None for nothing that counts.
        carried_by: name of the external axis on which they lie at first; None if they lie still.
        released_on: the same of where they are released.
        leaves: whether one that is released leaves the cell, as on a conveyor or down a chute.
        count: how many there are along the three axes of the first one's frame.
        pitch: m from one to the next along these axes.
        near: m from the TCP to the box round a part within which it is taken.
    """

    name: str
    geometry: Geometry
    attach: tuple[str, ...]
    release: tuple[str, ...]
    load: Load | None = None
    carried_by: str | None = None
    released_on: str | None = None
    leaves: bool = False
    count: tuple[int, int, int] = (1, 1, 1)
    pitch: Vector3 = (0.0, 0.0, 0.0)
    near: float = NEAR

    def pieces(self) -> Iterator[tuple[str, Pose]]:
        """Name and first place of each, row by row: x runs first, then y, then z."""
        nx, ny, nz = self.count
        for k in range(nx * ny * nz):
            i, j, level = k % nx, k // nx % ny, k // (nx * ny)
            step = (i * self.pitch[0], j * self.pitch[1], level * self.pitch[2])
            name = self.name if self.count == (1, 1, 1) else f"{self.name} {k + 1}"
            yield name, self.geometry.placement @ Pose(step, IDENTITY.quaternion)


def read_part(table: TomlTable, axes: list[str]) -> Workpiece:
    """``[[part]]``; see ``docs/reference/cell.md``.

    Args:
        table: of the cell file.
        axes: external axes that carry things.

    Raises:
        InputError: a key is missing, unknown or of a wrong kind; the message names file and key.
    """
    geometry = read_geometry(table, pose_at(table, "pose"))
    if geometry is None:
        raise table.error("mesh", "is missing, and so are box_mm, sphere_mm and the like")
    count, pitch = _pattern(table)
    part = Workpiece(
        name=table.text("name"),
        geometry=geometry,
        attach=_cues(table, "attach"),
        release=_cues(table, "release"),
        load=read_load(table),
        carried_by=table.choice("carried_by", axes) if table.has("carried_by") else None,
        released_on=table.choice("released_on", axes) if table.has("released_on") else None,
        leaves=table.flag("leaves", False),
        count=count,
        pitch=pitch,
        near=table.quantity("near", LENGTH, NEAR),
    )
    if part.near < 0:
        raise table.error("near", "must be zero or more")
    if set(part.attach) & set(part.release):
        raise table.error("release", "is the same as attach: say the value too, or two routines")
    table.finish()
    return part


def _cues(table: TomlTable, key: str) -> tuple[str, ...]:
    value = table.value(key)
    texts = (value,) if isinstance(value, str) else table.texts(key)
    if not texts or not all(text.strip() for text in texts):
        raise table.error(key, "names a signal, a routine or a statement of the program, not none")
    return tuple(texts)


def _pattern(table: TomlTable) -> tuple[tuple[int, int, int], Vector3]:
    if not table.has("count"):
        if table.unit_key("pitch", LENGTH) is not None:
            raise table.error("pitch", "means nothing without count")
        return (1, 1, 1), (0.0, 0.0, 0.0)
    counts = table.numbers("count")
    if not 1 <= len(counts) <= 3 or not all(n >= 1 and n == int(n) for n in counts):
        raise table.error("count", "is up to three whole numbers from 1: along x, y and z")
    nx, ny, nz = (*(int(n) for n in counts), 1, 1, 1)[:3]
    if nx * ny * nz > _MOST:
        raise table.error("count", f"makes {nx * ny * nz} parts; at most {_MOST} are followed")
    x, y, z = (*table.quantities("pitch", LENGTH, len(counts)), 0.0, 0.0, 0.0)[:3]
    return (nx, ny, nz), (x, y, z)
