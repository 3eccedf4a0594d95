"""Programs between time and energy, with their files and how they show themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ...core.display import counted
from ...core.notebook import PictureCurve, page, picture, table
from ...core.program.program import Program
from ...core.source.patch.runnable import runnable_files
from ...problems.improve.energy import Front, FrontPoint
from ..files.texts import ProgramTexts
from ..setup import Setup, like

JOULE = "J"
"""Unit of what motors take; squared torques mean something beside each other alone."""


@dataclass(frozen=True, eq=False, repr=False)
class ProgramFront(Front):
    """A front whose programs have texts.

    Args:
        folders: the files of each point's program.
        robot_axes: names of the axes.
    """

    folders: tuple[dict[str, bytes], ...] = field(kw_only=True)
    axes: tuple[str, ...] = field(kw_only=True)

    @classmethod
    def of(cls, front: Front, original: Program, texts: ProgramTexts, setup: Setup) -> ProgramFront:
        """A front with the texts that its programs were read back from."""
        folders = tuple(runnable_files(original, texts.of(p.program)) for p in front.points)
        points = tuple(replace(p, program=like(p.program, original, setup)) for p in front.points)
        return cls(
            front.given,
            points,
            front.unit,
            front.notes,
            folders=folders,
            axes=tuple(setup.robot.axis_names),
        )

    @property
    def files(self) -> dict[str, bytes]:
        """The files of all programs, those of each in a folder: point-1 is the fastest."""
        return {
            f"point-{k}/{name}": data
            for k, folder in enumerate(self.folders, 1)
            for name, data in folder.items()
        }

    def picture(self, kind: str = "svg") -> bytes:
        """Energy over time, and of each joint, as a file: ``png``, ``pdf`` or ``svg``."""
        from .plot_front import draw_front

        return draw_front(self, self.axes, kind)

    def rows(self) -> list[tuple[str, ...]]:
        """The given program and each point: time, energy, and of each joint that moves."""
        joints = [j for j, value in enumerate(self.given.by_joint) if abs(value) > 0.0]
        named = [("given", self.given), *((str(k), p) for k, p in enumerate(self.points, 1))]
        return [(name, *_row(self.given, p, joints, self.unit)) for name, p in named]

    def columns(self) -> list[tuple[str, str]]:
        """Headings of `rows`."""
        joints = [j for j, value in enumerate(self.given.by_joint) if abs(value) > 0.0]
        return [
            ("point", "right"),
            ("time s", "right"),
            ("%", "right"),
            *energy_columns(self.unit),
            *((f"{self.axes[j]} %", "right") for j in joints),
            ("clearance", "left"),
        ]

    def __repr__(self) -> str:
        if not self.points:
            return "<Front: no programs>"
        first, last = self.points[0], self.points[-1]
        return (
            f"<Front: {counted(self.points, 'program')}, {first.duration:.3f} s to "
            f"{last.duration:.3f} s, {100 * first.energy / self.given.energy:.0f} to "
            f"{100 * last.energy / self.given.energy:.0f} % of the energy>"
        )

    def _repr_html_(self) -> str:
        import numpy as np

        parts = [table(self.columns(), self.rows())]
        if len(self.points) > 1:
            given = self.given.energy
            at = np.array([(p.duration, 100 * p.energy / given) for p in self.points])
            parts.append(
                picture([PictureCurve("energy, % of the given program's, over s", at, at)], "s, …")
            )
        return page(repr(self)[1:-1], *parts, notes=self.notes)


def energy_columns(unit: str) -> list[tuple[str, str]]:
    """Headings of energy: what motors take in kJ, squared torques in shares of the given ones."""
    if unit == JOULE:
        return [("energy kJ", "right"), ("%", "right")]
    return [("torque² % of given", "right")]


def _row(given: FrontPoint, point: FrontPoint, joints: Sequence[int], unit: str) -> tuple[str, ...]:
    def change(value: float, before: float) -> str:
        # What motors take is negative where more comes back.
        return "" if point is given else f"{100.0 * (value - before) / abs(before):+.1f}"

    proof = point.certificate
    energy = [f"{100.0 * point.energy / given.energy:.1f}"]
    if unit == JOULE:
        energy = [f"{1e-3 * point.energy:.4g}", change(point.energy, given.energy)]
    return (
        f"{point.duration:.4f}",
        change(point.duration, given.duration),
        *energy,
        *(change(point.by_joint[j], given.by_joint[j]) for j in joints),
        "" if proof is None else ("proven" if proof.proven else "not proven"),
    )
