"""A controller's log beside the emulation of its program."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.notebook import PictureCurve, page, picture, table
from ...identification.logs import LoggedRun
from ...identification.move_times import MoveTime, move_times
from ...identification.prediction import Prediction
from ...identification.residuals import Figures
from ...identification.time_scale import TimeScale

COLUMNS = (("", "left"), ("greatest", "right"), ("99 %", "right"), ("RMS", "right"))

_WORTH_SAYING = 0.002
"""Share of the time in motion that a move is off by before it is named."""


@dataclass(frozen=True)
class Comparison:
    """How well the emulator predicts a log.

    Args:
        run: that was logged.
        prediction: its emulation laid on the log: `figures`, `alignment`, `residuals`.
        scale: what alone explains the log's times; None if nothing does.
        notes: what the user should know.
    """

    run: LoggedRun
    prediction: Prediction
    scale: TimeScale | None
    notes: tuple[str, ...]

    @property
    def figures(self) -> Figures:
        """What is left between log and emulation."""
        return self.prediction.figures

    @property
    def longer(self) -> str:
        """How much longer the robot took than the emulation: ``2.0 % longer than``."""
        aligned = self.prediction.alignment
        share = 100.0 * (aligned.logged_moving / aligned.moving - 1.0) if aligned.moving else 0.0
        if abs(share) < 0.05:
            return "as long as"
        return f"{abs(share):.1f} % {'longer' if share > 0 else 'less time'} than"

    @property
    def moves(self) -> list[MoveTime]:
        """What each move took, in the log and emulated."""
        return move_times(self.prediction)

    @property
    def times_said(self) -> str:
        """How long the robot took, in a sentence; and at which move it differs most."""
        aligned = self.prediction.alignment
        both = f"{aligned.logged_moving:.3f} s logged, {aligned.moving:.3f} s emulated"
        if not self.run.timed:
            return (
                "how fast the robot was asked to drive is not known, so times say nothing of the "
                f"emulation ({both})"
            )
        said = (
            f"the robot took {self.longer} emulated: {both} in motion "
            f"(ratio {self.figures.cycle_time_ratio:.4f})"
        )
        moves = self.moves
        if len(moves) < 2:
            return said
        most = max(moves, key=lambda one: abs(one.longer))
        if abs(most.longer) < _WORTH_SAYING * aligned.moving:
            return said
        span = self.run.program.moves[most.move].statement
        line = "" if span is None else f", line {span.line}"
        how = "longer" if most.longer > 0.0 else "less"
        return f"{said}; the most at move {most.move + 1}{line}: {abs(most.longer):.3f} s {how}"

    def rows(self) -> list[tuple[str, ...]]:
        """What is left in space and in time, and the same as the log was read."""
        found = _rows(self.figures)
        if self.prediction.read is not None:
            found += [(f"{name}, as read", *told) for name, *told in _rows(self.prediction.read)]
        return found

    def picture(self, kind: str = "svg") -> bytes:
        """Corners, deviation and speed, as a file of the kind ``png``, ``pdf`` or ``svg``."""
        from ...identification.report.picture import draw_prediction

        return draw_prediction(self.prediction, kind)

    def __repr__(self) -> str:
        f = self.figures
        return (
            f"<Comparison of {self.run.name} on {self.prediction.robot.name}: path "
            f"{1e3 * f.path_max:.2f} mm at most, cycle time ratio {f.cycle_time_ratio:.4f}>"
        )

    def _repr_html_(self) -> str:
        robot, log = self.prediction.robot, self.prediction.log
        step = max(1, len(log.q) // 400)
        at = np.array([robot.flange_pose(q).position for q in log.q[::step]])
        drawn = picture([PictureCurve("flange as logged", at)])
        return page(repr(self)[1:-1], table(COLUMNS, self.rows()), drawn, notes=self.notes)


def _rows(f: Figures) -> list[tuple[str, ...]]:
    return [
        (
            "path of the TCP, mm",
            f"{1e3 * f.path_max:.3f}",
            f"{1e3 * f.path_p99:.3f}",
            f"{1e3 * f.path_rms:.3f}",
        ),
        (
            "path of the joints, °",
            f"{np.degrees(f.joint_path_max):.4f}",
            f"{np.degrees(f.joint_path_p99):.4f}",
            f"{np.degrees(f.joint_path_rms):.4f}",
        ),
        (
            "joints at their time, °",
            f"{np.degrees(f.joint_time_max):.4f}",
            f"{np.degrees(f.joint_time_p99):.4f}",
            f"{np.degrees(f.joint_time_rms):.4f}",
        ),
        (
            "the same, less drift, °",
            f"{np.degrees(f.joint_clock_max):.4f}",
            f"{np.degrees(f.joint_clock_p99):.4f}",
            f"{np.degrees(f.joint_clock_rms):.4f}",
        ),
    ]
