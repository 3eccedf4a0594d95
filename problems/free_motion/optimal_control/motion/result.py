"""What an optimisation hands out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .....core.arrays import FloatArray
from .....core.collision.proof.verdict import Certificate
from .....core.errors import InputError, Note
from .....core.motion.command.trajectory import Trajectory, sample_times
from .....core.motion.model.consumption import SQUARED_TORQUE, Consumption
from .....core.program.tool import WORLD, Tool
from .....core.robot.kinematics.chain_kernels import poses
from .....core.robot.work_chain import work_chain
from .....core.spatial.rotation import quaternion_from_matrix
from ..task.limits import MotionLimits
from ..task.sampled import Plant, State
from ..task.task import MotionTask
from .audit import Audit
from .motion import Motion

_DENSE = 16
"""Parts of a piece for integrals, by Simpson's rule."""


@dataclass(frozen=True)
class SearchStep:
    """One outer iteration.

    Args:
        time: s, of the motion so far.
        objective: f of it.
        candidate: s, of the motion that was tried; NaN if there was none.
        accepted: whether it became the motion.
        iterations: of the SQP solver.
        rows: linearised distances.
        box: rad or m by which joints could move.
        what: for people.
    """

    time: float
    objective: float
    candidate: float
    accepted: bool
    iterations: int
    rows: int
    box: float
    what: str


@dataclass(frozen=True)
class Optimum:
    """An optimised motion.

    Args:
        task: what was asked.
        motion: the answer.
        first: the motion that the search began with; where there are surroundings, it is proven
            free. Torque limits that cannot hold the arm on the way may not hold in it.
        audit: shares of the limits that it uses, between nodes too.
        certificate: that it keeps the clearance; None where there is nothing to keep clear of.
        steps: of the search.
        converged: whether the search ended by itself.
        notes: what a user should know.
    """

    task: MotionTask
    motion: Motion
    first: Motion
    audit: Audit
    certificate: Certificate | None
    steps: tuple[SearchStep, ...]
    converged: bool
    notes: tuple[Note, ...] = ()

    @property
    def time(self) -> float:
        """s."""
        return self.motion.duration

    @property
    def proven(self) -> bool:
        """Whether the clearance is proven, if there is one to keep."""
        return self.certificate is None or self.certificate.proven

    @cached_property
    def limits(self) -> MotionLimits:
        """That counted."""
        return MotionLimits.of(self.task)

    def energy(self, consumption: Consumption = SQUARED_TORQUE) -> float:
        """What all axes consume together, without smoothing."""
        return energy_of(self.task, self.motion, consumption)

    def energy_by_joint(self, consumption: Consumption = SQUARED_TORQUE) -> FloatArray:
        """(N,), what each axis takes; of squared torques it adds up to the whole."""
        return energy_by_joint(self.task, self.motion, consumption)

    def torque(self, t: FloatArray) -> FloatArray:
        """(T, N) of all axes at times (T,) s."""
        plant = Plant(self.task)
        q, dq, ddq = (self.motion.at(t, k) for k in range(3))
        return plant.torques(State(q, dq, ddq, self.motion.leg[self.motion.pieces(t)]))

    def trajectory(self, period: float = 0.004) -> Trajectory:
        """Samples of all N joints and the TCP in the world; σ is the time, moves are legs."""
        return sampled_trajectory(self.task, self.motion, period)


def energy_of(task: MotionTask, motion: Motion, consumption: Consumption = SQUARED_TORQUE) -> float:
    """What all axes consume together, as `flyby.core.motion.timing.energy` has it of a program."""
    weights, torque, rate = _driven(task, motion)
    return float(weights @ consumption.total(consumption.powers(torque, rate)))


def energy_by_joint(
    task: MotionTask, motion: Motion, consumption: Consumption = SQUARED_TORQUE
) -> FloatArray:
    """(N,), what each axis takes."""
    weights, torque, rate = _driven(task, motion)
    return np.asarray(weights @ consumption.powers(torque, rate))


def _driven(task: MotionTask, motion: Motion) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Samples: weights (Z,) s of integrals over time, torques and velocities (Z, N)."""
    plant = Plant(task)
    shares = np.linspace(0.0, 1.0, _DENSE + 1)
    size = motion.coefficients.shape[2]
    q, dq, ddq = (motion.on_pieces(shares, k).reshape(-1, size) for k in range(3))
    state = State(q, dq, ddq, np.repeat(motion.leg, _DENSE + 1))
    weights = np.tile([2.0, 4.0], _DENSE // 2 + 1)[: _DENSE + 1] / (3 * _DENSE)
    weights[[0, -1]] = 1.0 / (3 * _DENSE)
    whole = np.multiply.outer(motion.durations, weights).ravel()
    return whole, plant.torques(state), plant.rates(state)


def sampled_trajectory(task: MotionTask, motion: Motion, period: float) -> Trajectory:
    """See `Optimum.trajectory`."""
    t = sample_times(0.0, motion.duration, period)
    parts = [np.zeros((len(t), task.robot.size)) for _ in range(3)]
    parts[0][:] = np.asarray(task.start)
    for order, part in enumerate(parts):
        part[:, task.moving] = motion.at(t, order)
    chain = work_chain(task.robot, Tool("tcp", task.tcp), WORLD)
    R, p = poses(chain, np.ascontiguousarray(parts[0]))
    quaternion = quaternion_from_matrix(R)
    leg = motion.leg[motion.pieces(t)].astype(np.int64)
    q, dq, ddq = parts
    return Trajectory(t, q, dq, ddq, p, quaternion, t.copy(), leg)


def joined(parts: list[Optimum]) -> Motion:
    """Motions one after the other, as one; each from rest to rest where the last one ended."""
    if not parts:
        raise InputError("there are no motions to join")
    knots, coefficients, legs, begin, leg = [np.zeros(1)], [], [], 0.0, 0
    for part in parts:
        motion = part.motion
        knots.append(begin + motion.knots[1:])
        coefficients.append(motion.coefficients)
        legs.append(leg + motion.leg)
        begin, leg = begin + motion.duration, leg + part.task.legs
    return replace(
        parts[0].motion,
        knots=np.concatenate(knots),
        coefficients=np.concatenate(coefficients),
        leg=np.concatenate(legs),
    )
