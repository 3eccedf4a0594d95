"""What every optimisation of a program hands back: the new program, what it gained and cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core.errors import InputError, Note
from ..core.motion.controller import Controller, Run
from ..core.motion.limits import interval_samples
from ..core.motion.timing import Timing
from ..core.program.program import Program

if TYPE_CHECKING:
    from ..core.collision.certificate import SceneOf
    from ..core.collision.verdict import Certificate

FloatArray = NDArray[np.float64]

RESOLUTION = 1e-5
"""m to which the clearance that there is is proven, for the table before and after."""


@dataclass(frozen=True)
class Measures:
    """Figures of one driven program.

    Args:
        time: cycle time, s.
        path_length: of the TCP, m.
        peak_acceleration: largest acceleration of the TCP, m/s², before any smoothing in time.
        energy: (N,) ∫ τⱼ² dt of each joint in N² m² s, before any smoothing in time; None where
            the robot's inertias are not known.
        clearance: proven to be kept, m; None where nothing is proven.
    """

    time: float
    path_length: float
    peak_acceleration: float
    energy: FloatArray | None = None
    clearance: float | None = None


@dataclass(frozen=True, slots=True)
class Row:
    """A line of the before/after table.

    Args:
        what: the figure.
        unit: of both values.
        before, after: None where not known.
    """

    what: str
    unit: str
    before: float | None
    after: float | None

    @property
    def change(self) -> float | None:
        """In percent of the value before; None where there is none to compare with."""
        if self.before is None or self.after is None or self.before == 0.0:
            return None
        return 100.0 * (self.after - self.before) / self.before


@dataclass(frozen=True)
class Solution:
    """What an optimisation made of a program.

    Args:
        original: the program that was given.
        program: the new one; the same object where nothing better was found.
        before, after: their figures.
        certificate: of the new program; None where no proof was asked for.
        notes: what was found on the way.
    """

    original: Program
    program: Program
    before: Measures
    after: Measures
    certificate: Certificate | None = None
    notes: tuple[Note, ...] = ()

    @property
    def changed(self) -> bool:
        """Whether the new program is another one than was given."""
        return self.program is not self.original

    @property
    def proven(self) -> bool:
        """Whether the new program is proven to keep its clearance."""
        return self.certificate is not None and self.certificate.proven

    def table(self, joints: Sequence[str] = ()) -> tuple[Row, ...]:
        """Figures before and after.

        Args:
            joints: names of the axes, for the lines of energy; their numbers if left out.
        """
        before, after = self.before, self.after
        rows = [
            Row("cycle time", "s", before.time, after.time),
            Row("TCP path length", "m", before.path_length, after.path_length),
            Row("peak TCP acceleration", "m/s²", before.peak_acceleration, after.peak_acceleration),
        ]
        if before.energy is not None and after.energy is not None:
            names = joints or [str(j + 1) for j in range(len(before.energy))]
            rows += [
                Row(f"energy, joint {name}", "N² m² s", float(one), float(other))
                for name, one, other in zip(names, before.energy, after.energy, strict=True)
            ]
        clearances = [None if m.clearance is None else 1e3 * m.clearance for m in (before, after)]
        rows.append(Row("proven clearance", "mm", *clearances))
        return tuple(rows)


def scene_notes(scenes: SceneOf, program: Program) -> tuple[Note, ...]:
    """What a user should know of the shapes that a program has been looked at with.

    Args:
        scenes: the cell with each tool.
        program: whose tools count.
    """
    tools = dict.fromkeys(move.tool for move in program.moves)
    return tuple(dict.fromkeys(note for tool in tools for note in scenes(tool).notes))


def measure(controller: Controller, run: Run, certificate: Certificate | None = None) -> Measures:
    """The figures of a driven program.

    Args:
        controller: that drove it.
        run: what came of it.
        certificate: of the run, if there is one.
    """
    steps = np.diff(run.trajectory.position, axis=0)
    return Measures(
        run.duration,
        float(np.linalg.norm(steps, axis=1).sum()),
        _peak_acceleration(run.timing),
        _energy(controller, run),
        certificate.clearance if certificate is not None and certificate.proven else None,
    )


def _peak_acceleration(timing: Timing) -> float:
    """p' σ̈ + p'' σ̇² at both ends of every interval."""
    states, stamp = timing.along.states, timing.stamp
    left = interval_samples(timing.path.pieces)
    ends = np.stack([left, left + 1], -1)
    x = np.stack([stamp.x[:-1], stamp.x[1:]], -1)[..., None]
    rate, bend = states.v[ends, :3], states.a[ends, :3]
    return float(np.linalg.norm(rate * stamp.u[:, None, None] + bend * x, axis=-1).max())


def _energy(controller: Controller, run: Run) -> FloatArray | None:
    try:
        made = controller.energy(run.program, run.timing)
    except InputError:
        return None
    steps = run.timing.end - run.timing.begin
    return np.asarray(0.5 * np.einsum("k,kej->j", steps, made.torque**2))
