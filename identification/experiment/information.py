"""What a run would tell of the motion model: the Fisher information of its log.

With S = ∂q/∂θ the sensitivities of the logged joints by the figures θ of the motion model, and
noise of standard deviation σ on every sample, the information of a log is F = Sᵀ S / σ². A log's
clock has an offset and a drift that nobody knows; what they could explain as well is taken off S.

The figures are scaled by what is thought of them beforehand, so that F counts against the identity.
No model holds exactly: the figures that suit one run best are a little off those that suit another.
With such a scatter of standard deviation κ from run to run, a run tells F (1 + κ² F)⁻¹ of what they
have in common, and many different runs tell more than one long one. ½ log det (1 + ΣF) is what runs
tell, in nats (Chaloner and Verdinelli, "Bayesian experimental design: a review", Statistical
Science 10, 1995); a design by the determinant is called D-optimal.

Sensitivities are difference quotients of the emulation at the vendor's own model. Figures that the
model leaves out are looked at where they might be (`studied`). The lead of elastic joints counts by
the joints' own accelerations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.motion.blend import Blend
from ...core.motion.controller import Controller
from ...core.motion.elasticity import RIGID
from ...core.motion.model import MotionModel
from ...core.motion.path import Path
from ...core.motion.ramped import stamped_motion
from ...core.motion.timing import Timing
from ...core.program.move import Move, MoveC, MoveJ, MoveL
from ...core.program.program import Program
from ...core.program.target import JointTarget
from ...core.robot.model import Robot
from ...core.vendor import Vendor
from .plan import Candidate, Precision

FloatArray = NDArray[np.float64]
Change = Callable[[MotionModel, float], MotionModel]

NOISE = 1e-4
"""rad (or m), by which logs of robots scatter about the best emulation: not their resolution."""
SCATTER = 0.1
"""κ: of figures from run to run, as a share of what is thought of them beforehand."""
BETAS = 2
"""Coefficients β of a polynomial blend that are looked at."""
SMOOTHING = (0.05, 0.02)
"""s, moving averages that are looked at where a model has none."""
SETTLED = 0.7
"""Settling, as a share of all averages, that is looked at where a model waits for all of them."""
SPREAD_BETA, SPREAD_WIDTH, SPREAD_SETTLING = 0.5, 0.02, 0.03
SPREAD_SCALE, SPREAD_LEAD = 0.2, 2e-4
"""Standard deviations beforehand: of β, of widths and settling in s, of accelerations as a share,
of leads in s²."""
_STEP = 0.02
"""Of a difference quotient, in standard deviations."""


@dataclass(frozen=True)
class Figure:
    """A figure of the motion model.

    Args:
        key: dotted key of the model's file.
        value: in the studied model.
        spread: standard deviation beforehand.
        change: gives the model with another value.
        bends: the moves whose corners change with it; none if timing alone does.
    """

    key: str
    value: float
    spread: float
    change: Change
    bends: tuple[type[Move], ...] = ()

    def shows_in(self, program: Program) -> bool:
        """Whether a program has moves that it acts upon."""
        passed = program.moves[1:]
        return not self.bends or any(isinstance(move, self.bends) for move in passed)


def studied(model: MotionModel) -> MotionModel:
    """The model that sensitivities are taken at: rigid, with averages and settling."""
    widths = tuple(width for width in model.smoothing if width > 0) or SMOOTHING
    settling = SETTLED * sum(widths) if model.settling is None else model.settling
    return replace(model, smoothing=widths, settling=settling, elasticity=RIGID)


def figures_of(model: MotionModel, robot: Robot) -> list[Figure]:
    """What a log can tell of the model, but for the leads of elastic joints."""
    found: list[Figure] = []
    for name in ("tcp", "joint", "orientation"):
        blend: Blend = getattr(model, name)
        if blend.kind == "polynomial":
            found += [_beta(name, blend, k) for k in range(BETAS)]
    for k, width in enumerate(model.smoothing):
        found.append(_width(k, width))
    assert model.settling is not None
    found.append(Figure("time.settling_s", model.settling, SPREAD_SETTLING, _set("settling")))
    for name in ("tcp_acceleration", "reorientation_acceleration"):
        value = getattr(model, name)
        if value is not None:
            found.append(Figure(f"limit.{name}", value, SPREAD_SCALE * value, _set(name)))
    for joint in range(robot.arm_size):
        scale = model.acceleration_scale(joint)
        key = f"limit.joint_acceleration_scale[{joint}]"
        change = _scale(joint, robot.arm_size)
        found.append(Figure(key, scale, SPREAD_SCALE * scale, change))
    return found


def _set(name: str) -> Change:
    return lambda model, value: replace(model, **{name: max(value, 0.0)})  # type: ignore[arg-type]


def _beta(name: str, blend: Blend, k: int) -> Figure:
    padded = (*blend.beta, *(0.0,) * (BETAS - len(blend.beta)))

    def change(model: MotionModel, value: float) -> MotionModel:
        beta = (*padded[:k], value, *padded[k + 1 :])
        return replace(model, **{name: replace(blend, beta=beta)})  # type: ignore[arg-type]

    bends = (MoveJ,) if name == "joint" else (MoveL, MoveC)
    return Figure(f"blend.{name}.beta[{k}]", padded[k], SPREAD_BETA, change, bends)


def _width(k: int, width: float) -> Figure:
    def change(model: MotionModel, value: float) -> MotionModel:
        widths = model.smoothing
        return replace(model, smoothing=(*widths[:k], value, *widths[k + 1 :]))

    return Figure(f"time.smoothing_s[{k}]", width, SPREAD_WIDTH, change)


def _scale(joint: int, size: int) -> Change:
    def change(model: MotionModel, value: float) -> MotionModel:
        scales = [model.acceleration_scale(k) for k in range(size)]
        scales[joint] = value
        return replace(model, joint_acceleration_scale=tuple(scales))

    return change


@dataclass(frozen=True)
class Informer:
    """Works out what runs tell.

    Args:
        vendor: whose motion model.
        robot: that is driven.
        model: studied.
        figures: those of `figures_of`.
        period: s between the samples of a log.
    """

    vendor: Vendor
    robot: Robot
    model: MotionModel
    figures: tuple[Figure, ...]
    period: float

    @classmethod
    def of(cls, vendor: Vendor, robot: Robot, period: float) -> Informer:
        """For the vendor's own model of the robot."""
        model = studied(vendor.motion_of(robot))
        return cls(vendor, robot, model, tuple(figures_of(model, robot)), period)

    @property
    def keys(self) -> tuple[str, ...]:
        """Of all figures, leads included."""
        leads = (f"elasticity.own_s2[{joint}]" for joint in range(self.robot.arm_size))
        return (*(figure.key for figure in self.figures), *leads)

    @property
    def size(self) -> int:
        """How many figures there are."""
        return len(self.figures) + self.robot.arm_size

    def information(self, candidate: Candidate) -> FloatArray:
        """(K, K), of the figures as shares of their spread.

        Raises:
            MotionError: the run cannot be driven by the studied model.
        """
        start = JointTarget(tuple(map(float, candidate.start)))
        program = candidate.program
        controller = Controller(self.vendor, self.robot, self.model)
        path = controller.plan(program, start)
        timing = controller.stamp(program, path)
        t = np.arange(0.0, timing.duration, self.period)
        q, dq, ddq = _commanded(controller, program, path, timing, t)
        columns = [
            (self._shifted(figure, program, path, start, t) - q).ravel() / _STEP
            if figure.shows_in(program)
            else np.zeros(q.size)
            for figure in self.figures
        ]
        for joint in range(self.robot.arm_size):
            lead = np.zeros_like(q)
            lead[:, joint] = SPREAD_LEAD * ddq[:, joint]
            columns.append(lead.ravel())
        clock = np.stack([dq.ravel(), (t[:, None] * dq).ravel()], axis=1)
        return _information(np.stack(columns, axis=1), clock)

    def _shifted(
        self, figure: Figure, program: Program, path: Path, start: JointTarget, t: FloatArray
    ) -> FloatArray:
        """(T, N), the command where a figure is a step larger."""
        value = figure.value + _STEP * figure.spread
        controller = Controller(self.vendor, self.robot, figure.change(self.model, value))
        if figure.bends:
            path = controller.plan(program, start)
        return _commanded(controller, program, path, controller.stamp(program, path), t)[0]

    def precision(self, information: FloatArray) -> tuple[Precision, ...]:
        """What is known of each figure after runs with this information, (K, K)."""
        covariance = np.linalg.inv(np.eye(self.size) + information)
        spreads = [*(f.spread for f in self.figures), *[SPREAD_LEAD] * self.robot.arm_size]
        values = [*(f.value for f in self.figures), *[0.0] * self.robot.arm_size]
        after = np.sqrt(np.diag(covariance)) * spreads
        rows = zip(self.keys, values, spreads, after, strict=True)
        return tuple(Precision(key, value, spread, float(a)) for key, value, spread, a in rows)


def nats(information: FloatArray) -> float:
    """What runs with this information (K, K) tell."""
    return 0.5 * float(np.linalg.slogdet(np.eye(len(information)) + information)[1])


def _commanded(
    controller: Controller, program: Program, path: Path, timing: Timing, t: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    return controller.smoothing(program, path).command(stamped_motion(timing), t)


def _information(S: FloatArray, clock: FloatArray) -> FloatArray:
    Q, _ = np.linalg.qr(clock)
    S = S - Q @ (Q.T @ S)
    F = S.T @ S / NOISE**2
    told = np.linalg.solve(np.eye(len(F)) + SCATTER**2 * F, F)
    return np.asarray(0.5 * (told + told.T))
