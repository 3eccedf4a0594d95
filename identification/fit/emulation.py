"""The emulated joints at the samples of a run, and how they change with parameters.

What a parameter does not touch is not done again, as the stages of the figures say: a blend's
coefficient changes the path and all that follows, a limit the stamp, an elasticity only the leads.
Leads are linear in their coefficients, so that their derivatives by differences are exact; those
of the rest are differences to one side.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from ...core.arrays import FloatArray
from ...core.motion.command.commanded_motion import stamped_motion
from ...core.motion.command.elasticity import leads_at
from ...core.motion.command.servo import offsets_at
from ...core.motion.command.smoothing import JointMotion, Smoothing, States
from ...core.motion.emulator.controller import Controller
from ...core.motion.geometry.pieces import Sampling
from ...core.motion.model.elasticity import RIGID
from ...core.motion.model.figures import Stage
from ...core.motion.model.motion_model import MotionModel, first_change
from ...core.motion.path.path import Path
from ..matching import Match, match
from ..prediction import PERIOD, start_of
from .parameters import SteppedModel, SteppedModels
from .runs import PreparedRun

STEP = 1e-3
"""Share of a parameter's scale that differences step by."""
_MOMENT = 1e-4
"""s, the same of time."""
_SIZE = 1e-3
"""Share of the zones' size, likewise."""
_SPEED = 1e-3
"""Share of the speeds, likewise."""


@dataclass(frozen=True)
class Nuisance:
    """What a run has of its own.

    Args:
        offset: s, the log's time less the emulated at the log's zero; the emulated time is that in
            the middle of what smoothing looks at, so that more smoothing is no delay.
        clock: s that pass while the log counts one.
        size: of the zones, as a factor on what the program says.
        override: share of all speeds that the run was driven at.
    """

    offset: float = 0.0
    clock: float = 1.0
    size: float = 1.0
    override: float = 1.0

    def emulated(self, t: FloatArray, window: float) -> FloatArray:
        """The emulation's time at stamps, where smoothing looks at a window in s."""
        return self.clock * (t - self.offset) + 0.5 * window


@dataclass(frozen=True)
class _Stages:
    """What was made on the way to a command."""

    model: MotionModel
    size: float
    override: float
    sampling: Sampling
    path: Path
    stamped: JointMotion
    smoothing: Smoothing
    window: float
    duration: float


@dataclass(frozen=True, eq=False)
class _Base:
    """Where derivatives are taken."""

    model: MotionModel
    stages: _Stages
    nuisance: Nuisance
    off: FloatArray
    moments: States | None


@dataclass(frozen=True, eq=False)
class Rows:
    """Weighted residuals of a run.

    Args:
        values: (K, M).
        by_parameter: (K, M, P).
        by_offset, by_clock, by_size, by_override: (K, M).
    """

    values: FloatArray
    by_parameter: FloatArray
    by_offset: FloatArray
    by_clock: FloatArray
    by_size: FloatArray
    by_override: FloatArray

    def only(self, samples: NDArray[np.bool_]) -> Rows:
        """The same with some of the samples (K,)."""
        return Rows(*(getattr(self, one.name)[samples] for one in fields(self)))


class RunEmulator:
    """Emulates one run again and again; what the model asked for last has in common with the next
    is not done again.

    Args:
        prepared: the run.
    """

    def __init__(self, prepared: PreparedRun) -> None:
        self.prepared = prepared
        self._latest: _Stages | None = None

    def residuals(self, model: MotionModel, nuisance: Nuisance) -> FloatArray:
        """(K, M), weighted.

        Raises:
            FlybyError: the program cannot be driven so.
        """
        return self._weighted(self._off(self._emulated(model, nuisance), model, nuisance))

    def rows(self, models: SteppedModels, nuisance: Nuisance) -> Rows:
        """Residuals and derivatives.

        Args:
            models: of the parameters whose derivatives are wanted, by steps of `STEP`.
            nuisance: of the run.

        Raises:
            FlybyError: the program cannot be driven so.
        """
        model = models.model
        stages = self._emulated(model, nuisance)
        off = self._off(stages, model, nuisance)
        base = _Base(model, stages, nuisance, off, self._moments(stages, nuisance))
        columns = [self._by_parameter(step, base) for step in models.steps]
        shape = (*off.shape, 0)
        by_parameter = np.stack(columns, -1) if columns else np.zeros(shape)
        by_time = self._by_time(stages, model, nuisance)
        stamps = self.prepared.t - nuisance.offset
        return Rows(
            self._weighted(off),
            np.einsum("kmn,knp->kmp", self.prepared.weight, by_parameter),
            self._weighted(-nuisance.clock * by_time),
            self._weighted(stamps[:, None] * by_time),
            self._weighted(self._by_size(model, nuisance)),
            self._weighted(self._by_override(base)),
        )

    def _weighted(self, off: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("kmn,kn->km", self.prepared.weight, off))

    def _by_parameter(self, step: SteppedModel, base: _Base) -> FloatArray:
        """(K, N), by a step to another model."""
        made = self._stages(step.model, base.nuisance, base.stages, step.stage)
        if made is base.stages and base.moments is not None:
            off = self.prepared.q - self._led(step.model, base, base.moments)
        else:
            off = self._off(made, step.model, base.nuisance)
        return np.asarray((off - base.off) / step.length)

    def _moments(self, stages: _Stages, nuisance: Nuisance) -> States | None:
        """The smoothed motion at the samples' times; None where only places count."""
        if self.prepared.by_place:
            return None
        t = nuisance.emulated(self.prepared.t, stages.window)
        return stages.smoothing.command(stages.stamped, t)

    def _led(self, model: MotionModel, base: _Base, states: States) -> FloatArray:
        """(K, N), commanded for a smoothed motion."""
        stages = base.stages
        t = base.nuisance.emulated(self.prepared.t, stages.window)
        controller = self.prepared.controller(model)
        return led(controller, stages.smoothing, stages.stamped, t, states)

    def _by_time(self, stages: _Stages, model: MotionModel, nuisance: Nuisance) -> FloatArray:
        """(K, N), by the emulation's time."""
        if self.prepared.by_place:
            return np.zeros_like(self.prepared.q)
        t = nuisance.emulated(self.prepared.t, stages.window)
        ahead, behind = (self._joints(stages, model, t + by) for by in (_MOMENT, -_MOMENT))
        return np.asarray((behind - ahead) / (2 * _MOMENT))

    def _by_size(self, model: MotionModel, nuisance: Nuisance) -> FloatArray:
        """(K, N)."""
        if self.prepared.run.zones_known:
            return np.zeros_like(self.prepared.q)
        sizes = nuisance.size * (1 + _SIZE), nuisance.size * (1 - _SIZE)
        ends = []
        for size in sizes:
            changed = replace(nuisance, size=size)
            ends.append(self._off(self._stages(model, changed), model, changed))
        return np.asarray((ends[0] - ends[1]) / (sizes[0] - sizes[1]))

    def _by_override(self, base: _Base) -> FloatArray:
        """(K, N), by a step down: nothing is driven faster than at full speed."""
        if self.prepared.override is None:
            return np.zeros_like(self.prepared.q)
        step = _SPEED * base.nuisance.override
        changed = replace(base.nuisance, override=base.nuisance.override - step)
        made = self._stages(base.model, changed, base.stages)
        return np.asarray((base.off - self._off(made, base.model, changed)) / step)

    def _emulated(self, model: MotionModel, own: Nuisance) -> _Stages:
        """What a command needs, kept for the next."""
        known = self._latest
        changed = None if known is None else first_change(model, known.model)
        self._latest = self._stages(model, own, known, changed)
        return self._latest

    def _stages(
        self,
        model: MotionModel,
        own: Nuisance,
        known: _Stages | None = None,
        changed: Stage | None = None,
    ) -> _Stages:
        """What a command needs, taken from what is known as far as the models agree: from which
        stage on they do not."""
        if known is not None and known.size != own.size:
            known = None
        if known is not None and known.override == own.override and _begins(changed, Stage.LEAD):
            return known
        controller = self.prepared.controller(model)
        program = self.prepared.program(own.size)
        alike = known is not None and controller.sampling == known.sampling
        if known is not None and alike and _begins(changed, Stage.TIMING):
            path = replace(known.path, model=model)
        else:
            path = controller.plan(program, start_of(program, self.prepared.log, controller.robot))
        timing = controller.stamp(program, path)
        if own.override != 1.0:
            timing = controller.stamp_slower(program, timing, own.override)
        smoothing = controller.smoothing(program, path)
        stamped = stamped_motion(timing)
        window = smoothing.window + timing.ramp
        duration = timing.duration
        return _Stages(
            model,
            own.size,
            own.override,
            controller.sampling,
            path,
            stamped,
            smoothing,
            window,
            duration,
        )

    def _joints(self, stages: _Stages, model: MotionModel, t: FloatArray) -> FloatArray:
        """(K, N), commanded at times."""
        return commanded(self.prepared.controller(model), stages.smoothing, stages.stamped, t)

    def _off(self, stages: _Stages, model: MotionModel, nuisance: Nuisance) -> FloatArray:
        """(K, N), log less emulation."""
        if not self.prepared.by_place:
            t = nuisance.emulated(self.prepared.t, stages.window)
            return self.prepared.q - self._joints(stages, model, t)
        return self._match(stages, model).off

    def _match(self, stages: _Stages, model: MotionModel) -> Match:
        count = int(np.ceil(stages.duration / PERIOD)) + 1
        t = np.linspace(0.0, stages.duration, count)
        return match(t, self._joints(stages, model, t), self.prepared.q, 1e-4)


def commanded(
    controller: Controller, smoothing: Smoothing, stamped: JointMotion, t: FloatArray
) -> FloatArray:
    """Commanded joints (K, N) of a stamped motion at times that do not decrease."""
    return led(controller, smoothing, stamped, t, smoothing.command(stamped, t))


def led(
    controller: Controller,
    smoothing: Smoothing,
    stamped: JointMotion,
    t: FloatArray,
    states: States,
) -> FloatArray:
    """The same where the smoothed motion has states then (K, N)."""
    servo = controller.model.servo
    q = states[0] + offsets_at(servo, smoothing, stamped, t, states)
    if controller.model.elasticity == RIGID:
        return q
    elasticity, robot = controller.model.elasticity, controller.robot
    return q + leads_at(elasticity, robot, smoothing, stamped, t, states)


def _begins(changed: Stage | None, stage: Stage) -> bool:
    """Whether nothing that comes before a stage has changed."""
    return changed is None or changed >= stage
