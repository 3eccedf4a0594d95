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

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import FloatArray
from ...core.motion.command.commanded_motion import stamped_motion
from ...core.motion.command.servo import offsets_at
from ...core.motion.command.smoothing import States
from ...core.motion.emulator.controller import Controller
from ...core.motion.model.blend import Blend
from ...core.motion.model.elasticity import RIGID
from ...core.motion.model.figures import Stage
from ...core.motion.model.motion_model import MotionModel, first_change
from ...core.motion.path.path import Path
from ...core.motion.timing.timing import Timing
from ...core.program.move import Move, MoveC, MoveJ, MoveL
from ...core.program.program import Program
from ...core.program.target import JointTarget
from ...core.robot.model import Robot
from ...core.vendor import Vendor
from ..fit.keys import with_value
from .kinds import DRAGGING, Topic
from .plan import CandidateRun, Precision

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
SPREAD_SCALE, SPREAD_LEAD, SPREAD_NEARNESS, SPREAD_LEAST_TIME = 0.2, 2e-4, 2e-3, 2e-3
"""Standard deviations beforehand: of β, of widths and settling in s, of accelerations as a share,
of leads in s², of how near axes are to be to stops in rad, of least times of zones in s."""
REORIENTATION, FRICTION, DRAG = 20.0, 1e-4, -5e-4
"""rad/s², rad and s that are looked at where a model has none."""
SPREAD_DRAG, SPREAD_DELAY = 5e-4, 0.05
"""s, standard deviations beforehand of drag, and of how much later it shows."""
_STEP = 0.02
"""Of a difference quotient, in standard deviations."""


_Base = tuple[Path, Timing, States]


@dataclass(frozen=True)
class StudiedFigure:
    """A figure of the motion model.

    Args:
        key: dotted key of the model's file.
        value: in the studied model.
        spread: standard deviation beforehand.
        bends: the moves whose corners change with it; none if it acts upon all moves.
    """

    key: str
    value: float
    spread: float
    bends: tuple[type[Move], ...] = ()

    def shows_in(self, program: Program) -> bool:
        """Whether a program has moves that it acts upon."""
        passed = program.moves[1:]
        return not self.bends or any(isinstance(move, self.bends) for move in passed)


def studied(model: MotionModel, robot: Robot, about: Sequence[Topic] = ()) -> MotionModel:
    """The model that sensitivities are taken at: rigid, with averages and settling, and with all
    figures of `figures_of`."""
    if Topic.SHORT_LEGS in about:
        model = replace(model, zone_time=max(model.zone_time, model.period))
    if Topic.TURNS in about and model.reorientation_acceleration is None:
        model = replace(model, reorientation_acceleration=REORIENTATION)
    rubs = (FRICTION,) * robot.arm_size if Topic.REVERSALS in about else ()
    drags = (DRAG,) * min(DRAGGING, robot.arm_size) if Topic.DRAG in about else ()
    widths = tuple(width for width in model.smoothing if width > 0) or SMOOTHING
    settling = SETTLED * sum(widths) if model.settling is None else model.settling
    return replace(
        model,
        tcp=_padded(model.tcp),
        joint=_padded(model.joint),
        orientation=_padded(model.orientation),
        smoothing=widths,
        settling=settling,
        joint_acceleration_scale=tuple(map(model.acceleration_scale, range(robot.arm_size))),
        elasticity=RIGID,
        servo=replace(model.servo, friction=rubs, drag=drags),
    )


def figures_of(model: MotionModel, about: Sequence[Topic] = ()) -> list[StudiedFigure]:
    """What a log can tell of a studied model, but for the leads of elastic joints; of what only
    runs about open questions show, as far as there are such."""
    found: list[StudiedFigure] = []
    for name, blend in (
        ("tcp", model.tcp),
        ("joint", model.joint),
        ("orientation", model.orientation),
    ):
        bends = (MoveJ,) if name == "joint" else (MoveL, MoveC)
        for k, beta in enumerate(blend.beta if blend.kind == "polynomial" else ()):
            found.append(StudiedFigure(f"blend.{name}.beta[{k}]", beta, SPREAD_BETA, bends))
    for k, width in enumerate(model.smoothing):
        found.append(StudiedFigure(f"time.smoothing_s[{k}]", width, SPREAD_WIDTH))
    assert model.settling is not None
    found.append(StudiedFigure("time.settling_s", model.settling, SPREAD_SETTLING))
    if model.in_position > 0.0:
        found.append(StudiedFigure("time.in_position_rad", model.in_position, SPREAD_NEARNESS))
        if model.in_position_time is not None:
            time = model.in_position_time
            found.append(StudiedFigure("time.in_position_time_s", time, SPREAD_SETTLING))
    for key, limit in (
        ("limit.tcp_acceleration", model.tcp_acceleration),
        ("limit.reorientation_acceleration", model.reorientation_acceleration),
    ):
        if limit is not None:
            found.append(StudiedFigure(key, limit, SPREAD_SCALE * limit))
    for joint, scale in enumerate(model.joint_acceleration_scale):
        key = f"limit.joint_acceleration_scale[{joint}]"
        found.append(StudiedFigure(key, scale, SPREAD_SCALE * scale))
    if Topic.SHORT_LEGS in about:
        found.append(StudiedFigure("zone.least_time_s", model.zone_time, SPREAD_LEAST_TIME))
    if Topic.POSTURES in about:
        for joint, share in enumerate(model.torque.own):
            found.append(StudiedFigure(f"torque.own_s2[{joint}]", share, SPREAD_SCALE * share))
        for joint, share in enumerate(model.torque.weight):
            if share > 0.0:
                found.append(StudiedFigure(f"torque.weight[{joint}]", share, SPREAD_SCALE))
    if Topic.REVERSALS in about:
        for joint, rubs in enumerate(model.servo.friction):
            found.append(StudiedFigure(f"servo.friction_rad[{joint}]", rubs, FRICTION))
        for key, within in (("rise_rad", model.servo.rise), ("fade_s", model.servo.fade)):
            found.append(StudiedFigure(f"servo.friction_{key}", within, 0.5 * within))
    if Topic.DRAG in about:
        speed, delay = model.servo.drag_speed, model.servo.drag_delay
        for joint, drags in enumerate(model.servo.drag):
            found.append(StudiedFigure(f"servo.drag_s[{joint}]", drags, SPREAD_DRAG))
        found.append(StudiedFigure("servo.drag_speed_radps", speed, 0.5 * speed))
        found.append(StudiedFigure("servo.drag_delay_s", delay, SPREAD_DELAY))
    return found


def _padded(blend: Blend) -> Blend:
    """With at least so many coefficients."""
    return replace(blend, beta=(*blend.beta, *(0.0,) * (BETAS - len(blend.beta))))


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
    figures: tuple[StudiedFigure, ...]
    period: float

    @classmethod
    def of(
        cls, vendor: Vendor, robot: Robot, period: float, about: Sequence[Topic] = ()
    ) -> Informer:
        """For the vendor's own model of the robot, and what runs are about."""
        model = studied(vendor.motion_of(robot), robot, about)
        return cls(vendor, robot, model, tuple(figures_of(model, about)), period)

    @property
    def keys(self) -> tuple[str, ...]:
        """Of all figures, leads included."""
        leads = (f"elasticity.own_s2[{joint}]" for joint in range(self.robot.arm_size))
        return (*(figure.key for figure in self.figures), *leads)

    @property
    def size(self) -> int:
        """How many figures there are."""
        return len(self.figures) + self.robot.arm_size

    def information(self, candidate: CandidateRun) -> FloatArray:
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
        q, dq, ddq = states = _commanded(controller, program, path, timing, t)
        base = path, timing, states
        rubbed = _off_command(controller, program, *base, t)
        columns = [
            (self._shifted(figure, program, base, start, t) - q - rubbed).ravel() / _STEP
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
        self,
        figure: StudiedFigure,
        program: Program,
        base: _Base,
        start: JointTarget,
        t: FloatArray,
    ) -> FloatArray:
        """(T, N), the joints where a figure is a step larger."""
        value = figure.value + _STEP * figure.spread
        model = with_value(self.model, figure.key, value)
        controller = Controller(self.vendor, self.robot, model)
        path, timing, states = base
        stage = first_change(self.model, model)
        path = (
            controller.plan(program, start) if stage is Stage.PATH else replace(path, model=model)
        )
        if stage in (Stage.PATH, Stage.TIMING):
            timing = controller.stamp(program, path)
            states = _commanded(controller, program, path, timing, t)
        return states[0] + _off_command(controller, program, path, timing, states, t)

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
) -> States:
    return controller.smoothing(program, path).command(stamped_motion(timing), t)


def _off_command(
    controller: Controller,
    program: Program,
    path: Path,
    timing: Timing,
    states: States,
    t: FloatArray,
) -> FloatArray:
    """(T, N), how far servos let the joints be off."""
    smoothing = controller.smoothing(program, path)
    return offsets_at(controller.model.servo, smoothing, stamped_motion(timing), t, states)


def _information(S: FloatArray, clock: FloatArray) -> FloatArray:
    Q, _ = np.linalg.qr(clock)
    S = S - Q @ (Q.T @ S)
    F = S.T @ S / NOISE**2
    told = np.linalg.solve(np.eye(len(F)) + SCATTER**2 * F, F)
    return np.asarray(0.5 * (told + told.T))
