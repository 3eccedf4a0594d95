"""What `flyby.place` returns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...core.cell.cell import Cell
from ...core.display import in_line
from ...core.errors import Note
from ...core.notebook import page, table
from ...core.program.program import Program
from ...core.spatial.pose import Pose
from ...problems.placement.place import PlacedBase, Placement

COLUMNS = (
    ("base", "left"),
    ("x, mm", "right"),
    ("y, mm", "right"),
    ("z, mm", "right"),
    ("turned, °", "right"),
    ("cycle time, s", "right"),
    ("energy, %", "right"),
    ("clearance", "left"),
)
_REFUSED = 5
"""Bases that are faster and not proven, at most, which are shown."""


@dataclass(frozen=True, repr=False)
class PlacedRobot:
    """A base for a robot.

    Args:
        program: that it drives.
        cell: as it was given.
        clearance: m that was to be kept.
        found: what the search found.
        notes: what a user should know.
        order: in which tasks are carried out, where that was looked for, each with its line.
    """

    program: Program
    cell: Cell
    clearance: float
    found: Placement
    notes: tuple[Note, ...] = ()
    order: tuple[str, ...] = ()

    def __repr__(self) -> str:
        if self.found.best is None:
            return in_line(f"Base for {self.program.name}: none is proven")
        return in_line(f"Base for {self.program.name}: {self.found.best.run.duration:.3f} s")

    @property
    def base(self) -> Pose | None:
        """The best base in the world; None if none is proven."""
        return None if self.found.best is None else self.found.best.base

    @property
    def proven(self) -> bool:
        """Whether a base was found from which the clearance is proven."""
        return self.found.best is not None

    @property
    def line(self) -> str:
        """The base as a cell file says it; empty if none is proven."""
        if self.base is None:
            return ""
        xyz = ", ".join(f"{1e3 * v + 0.0:.9g}" for v in self.base.position)
        quaternion = ", ".join(f"{v + 0.0:.9g}" for v in self.base.quaternion)
        return f"base = {{ xyz_mm = [{xyz}], quat_wxyz = [{quaternion}] }}"

    def rows(self) -> list[tuple[str, ...]]:
        """The base as it is, the best, and faster ones that are not proven; energy (torque²) in
        percent of that from the base as it is."""
        found = self.found
        whole = None if found.before is None else found.before.energy
        rows = []
        if found.before is not None:
            rows.append(_row("as it is", found.before, whole))
        if found.best is not None:
            rows.append(_row("best", found.best, whole))
        return [*rows, *(_row("not proven", one, whole) for one in found.refused[:_REFUSED])]

    def as_json(self) -> dict[str, Any]:
        """All figures; times in s, lengths in mm."""
        found = self.found
        return {
            "proven": self.proven,
            "base": self.line or None,
            "clearance_mm": 1e3 * self.clearance,
            "before": None if found.before is None else _json(found.before),
            "best": None if found.best is None else _json(found.best),
            "order": list(self.order),
            "bases_looked_at": found.looked,
            "bases_in_reach": found.reached,
            "bases_emulated": found.emulated,
            "notes": [str(note) for note in self.notes],
        }

    def _repr_html_(self) -> str:
        return page(repr(self), table(COLUMNS, self.rows()), notes=self.notes)


def _row(what: str, placed: PlacedBase, whole: float | None) -> tuple[str, ...]:
    proof = placed.certificate
    said = "" if proof is None else proof.message
    if proof is not None and proof.proven:
        near = math.isfinite(proof.clearance)
        said = f"{1e3 * proof.clearance:.1f} mm proven" if near else "nothing is near"
    place = [f"{1e3 * v:.1f}" for v in placed.base.position]
    turned = f"{math.degrees(placed.shift[3]):.1f}"
    energy = "" if not whole or placed.energy is None else f"{100 * placed.energy / whole:.1f}"
    return (what, *place, turned, f"{placed.run.duration:.3f}", energy, said)


def _json(placed: PlacedBase) -> dict[str, Any]:
    proof = placed.certificate
    return {
        "position_mm": [1e3 * v for v in placed.base.position],
        "quaternion_wxyz": list(placed.base.quaternion),
        "cycle_time_s": placed.run.duration,
        "energy_n2m2s": placed.energy,
        "certificate": None if proof is None else proof.message,
    }
