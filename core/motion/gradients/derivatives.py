"""Exact derivatives of a driven program with respect to its own numbers.

Reverse mode by hand: rests → stamp → rows and ceilings → samples → inverse kinematics → curves →
zones → waypoints → targets. Active limits, clipped zones, which axis ends a rest, branches and
sample counts are held, so that at a tie between two of them the derivative is one-sided.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ...errors import InputError
from ...program.program import Program
from ...program.target import JointTarget, PoseTarget
from ..configurations.targets import located
from ..geometry.corners import ZoneGradient
from ..model.consumption import SQUARED_TORQUE, Consumption
from ..path.path import Path
from ..timing.energy import energy, loads_of, pull_energy
from ..timing.timing import Timing
from ..timing.torque import pull_torque_shares
from .limits_gradient import SpeedGradient, pull_path_limits, pull_turning
from .path_gradient import SINGULAR_TARGET, RouteGradient, pull_path
from .segment_tangents import end_jacobians
from .stamping_adjoint import stamp_adjoint
from .timing_gradient import Seeds, pull_rests, seed_configuration


@dataclass(frozen=True)
class BlendDerivative:
    """Derivative with respect to the coefficients of a blend's α and β, in their order.

    α's coefficients count as free; a change that keeps α(1) = 1 sums to zero.
    """

    alpha: FloatArray
    beta: FloatArray


@dataclass(frozen=True)
class ProgramGradient:
    """Derivative of one number with respect to a program's continuous parameters.

    Rows belong to the P moves of the program; what a move does not have is zero.

    Args:
        start: (N,), the configuration before the first move.
        position: (P, 3) per m, pose targets, in their work object.
        turn: (P, 3) per rad, small turns of pose targets about the axes of their work object.
        joints: (P, N) per rad or m, joint targets; external axes of all targets.
        via: (P, 3) per m, auxiliary points of arcs.
        zone: (P,) per m, TCP radius of zones (per 1 of a share).
        zone_reorientation, zone_external: (P,) per m, the other radii.
        zone_angle: (P,) per rad.
        speed: the numbers of `Speed`, (P,) each.
        tcp_blend, joint_blend, orientation_blend: the vendor's blend laws.
    """

    start: FloatArray
    position: FloatArray
    turn: FloatArray
    joints: FloatArray
    via: FloatArray
    zone: FloatArray
    zone_reorientation: FloatArray
    zone_external: FloatArray
    zone_angle: FloatArray
    speed: SpeedGradient
    tcp_blend: BlendDerivative
    joint_blend: BlendDerivative
    orientation_blend: BlendDerivative


class Derivatives:
    """Derivatives of one driven program.

    Args:
        program: what was driven.
        timing: its stamp, from ``Controller.stamp``.

    Raises:
        InputError: a move has a fixed duration, whose derivative is not available.
    """

    def __init__(self, program: Program, timing: Timing) -> None:
        for i in timing.path.route.moves:
            if program.moves[i].speed.duration is not None:
                raise InputError(
                    f"move {i + 1} has a fixed duration; derivatives of such programs are not "
                    "available: give it a speed"
                )
        self._program = program
        self._timing = timing
        self._path: Path = timing.path
        self._robot = timing.path.route.robot

    def duration(self) -> ProgramGradient:
        """Derivative of the cycle time, s."""
        seeds = Seeds.zeros(self._timing)
        seeds.t[-1] = 1.0
        seeds.rests[:] = 1.0
        return self._pull(seeds)

    def energy(self, consumption: Consumption = SQUARED_TORQUE) -> ProgramGradient:
        """Derivative of the energy, that of squared torques (N² m² s) if not said otherwise."""
        seeds = Seeds.zeros(self._timing)
        loads = loads_of(self._program, self._path)
        made = energy(self._robot, self._timing, loads, consumption)
        seeds.x[:], seeds.t[:], seeds.spacing[:] = pull_energy(
            self._robot, self._timing, made, seeds.states
        )
        return self._pull(seeds)

    def configuration(self, sample: int, weights: FloatArray) -> ProgramGradient:
        """Derivative of weights · q at a sample of the path, which keeps its share of its piece.

        Args:
            sample: index in ``path.q``.
            weights: (N,); a unit vector for one joint.
        """
        seeds = Seeds.zeros(self._timing)
        seeds.states.q[sample] = weights
        return self._pull(seeds)

    def configuration_at(self, t: float, weights: FloatArray) -> ProgramGradient:
        """Derivative of weights · q at time t (s), before any smoothing in time."""
        seeds = Seeds.zeros(self._timing)
        seed_configuration(self._timing, t, np.asarray(weights, dtype=float), seeds)
        return self._pull(seeds)

    def _pull(self, seeds: Seeds) -> ProgramGradient:
        timing, path = self._timing, self._path
        speeds = SpeedGradient.zeros(len(path.route.moves))
        pull_rests(timing, seeds)
        bar = stamp_adjoint(timing.stamp, seeds.x, seeds.t)
        bar.spacing[:] += seeds.spacing
        shares_bar, turning_bar, kept_bar, timed_bar = pull_path_limits(
            timing.along.states,
            path.pieces,
            timing.limits,
            timing.path_limits,
            bar,
            seeds.states,
            speeds,
        )
        if shares_bar is not None:
            pull_torque_shares(
                path.model.torque,
                self._robot,
                timing.along.states[:3],
                shares_bar,
                seeds.states[:3],
            )
        sigma_bar = np.zeros(len(path.sigma))
        states_bar = timing.along.pull(
            path.pieces, path.sigma, path.states, seeds.states, bar.spacing, sigma_bar
        )
        turn_bar = pull_turning(path.segments, turning_bar)
        route_bar = pull_path(path, states_bar, sigma_bar, turn_bar, kept_bar, timed_bar)
        return self._gather(route_bar, speeds)

    def _gather(self, route_bar: RouteGradient, speeds: SpeedGradient) -> ProgramGradient:
        """From segments and waypoints to the moves of the program, one of each at most."""
        path, model = self._path, self._path.model
        count, size = len(self._program.moves), path.q.shape[1]
        moves = np.array(path.route.moves)
        owners = np.array(path.route.zone_moves, dtype=np.int64)
        zone = ZoneGradient.zeros(count)
        for name in ZoneGradient.__dataclass_fields__:
            getattr(zone, name)[owners] = getattr(route_bar.zones, name)
        ends = route_bar.ends
        speeds.tcp += ends.speed
        speeds.tcp_acceleration += ends.acceleration
        speeds.joint += ends.joint_speed
        speeds.joint_acceleration += ends.joint_acceleration
        speeds.joint_fraction += ends.joint_fraction
        speeds.joint_acceleration_fraction += ends.joint_acceleration_fraction
        by_move, via = speeds, ends.via
        if len(moves) < count:
            by_move, via = SpeedGradient.zeros(count), np.zeros((count, 3))
            for name in SpeedGradient.__dataclass_fields__:
                getattr(by_move, name)[moves] = getattr(speeds, name)
            via[moves] = ends.via
        position, turn, joints = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, size))
        start = self._pull_targets(route_bar, position, turn, joints)
        return ProgramGradient(
            start,
            position,
            turn,
            joints,
            via,
            zone.tcp,
            zone.reorientation,
            zone.external,
            zone.angle,
            by_move,
            BlendDerivative(*route_bar.tcp.alpha_beta(model.tcp)),
            BlendDerivative(*route_bar.joint.alpha_beta(model.joint)),
            BlendDerivative(*route_bar.orientation.alpha_beta(model.orientation)),
        )

    def _pull_targets(
        self, bar: RouteGradient, position: FloatArray, turn: FloatArray, joints: FloatArray
    ) -> FloatArray:
        """From the segments' ends, last waypoint first, to the targets; returns the start's."""
        route = self._path.route
        if self._path.segments.joint_moves_alone and self._name_all_joints():
            # Where TCPs are counts for nothing then.
            own = bar.ends.q.copy()
            own[..., route.prescribed] += bar.ends.prescribed
            own[:-1, 1] += own[1:, 0]
            joints[list(route.moves)] = own[:, 1]
            return np.asarray(own[0, 0])
        twist = np.concatenate([bar.ends.position, bar.ends.turn], axis=-1)
        J = end_jacobians(route.ends.q, route.chains)
        posed = any(isinstance(self._program.moves[i].target, PoseTarget) for i in route.moves)
        back = _inverses(J[:, 1][..., route.solved]) if posed else None
        inherited = np.zeros(joints.shape[1])
        for k in range(len(route.moves) - 1, -1, -1):
            q_bar = bar.ends.q[k, 1] + inherited
            q_bar[route.prescribed] += bar.ends.prescribed[k, 1]
            pose_bar = twist[k, 1].copy()
            if k + 1 < len(route.moves):
                self._leave(k + 1, bar, twist, J, q_bar, pose_bar, route.chains[k])
            move = self._program.moves[route.moves[k]]
            inherited = self._arrive(
                move.target,
                route.moves[k],
                q_bar,
                pose_bar,
                J[k, 1],
                route.ends.q[k, 1],
                None if back is None else back[k],
                position,
                turn,
                joints,
            )
        q_bar = bar.ends.q[0, 0] + inherited + J[0, 0].T @ twist[0, 0]
        q_bar[route.prescribed] += bar.ends.prescribed[0, 0]
        return np.asarray(q_bar)

    def _name_all_joints(self) -> bool:
        """Whether every target names the values of all axes."""
        targets = [self._program.moves[i].target for i in self._path.route.moves]
        external = self._robot.size - self._robot.arm_size
        return all(isinstance(t, JointTarget) and len(t.external) == external for t in targets)

    def _leave(
        self,
        k: int,
        bar: RouteGradient,
        twist: FloatArray,
        J: FloatArray,
        q_bar: FloatArray,
        pose_bar: FloatArray,
        before: object,
    ) -> None:
        """Add what the segment after a waypoint, k, says of its start."""
        q_bar += bar.ends.q[k, 0]
        q_bar[self._path.route.prescribed] += bar.ends.prescribed[k, 0]
        if self._path.route.chains[k] is before:
            pose_bar += twist[k, 0]
        else:
            q_bar += J[k, 0].T @ twist[k, 0]

    def _arrive(
        self,
        target: PoseTarget | JointTarget,
        index: int,
        q_bar: FloatArray,
        pose_bar: FloatArray,
        J: FloatArray,
        q: FloatArray,
        back: FloatArray | None,
        position: FloatArray,
        turn: FloatArray,
        joints: FloatArray,
    ) -> FloatArray:
        """Give a waypoint's gradient to its target; returns what the waypoint before gets.

        Axes that a target does not name keep the value that they had there.
        """
        route = self._path.route
        arm = self._robot.arm_size
        named = arm + len(target.external)
        passed = np.zeros_like(q_bar)
        if isinstance(target, JointTarget):
            q_bar = q_bar + J.T @ pose_bar
            joints[index, :named] += q_bar[:named]
        else:
            angled = target.arm_angle is not None
            if angled:
                w = self._led(index, J, q, q_bar)
            else:
                w = self._solved(index, back, q_bar[route.solved])
            pose_bar = pose_bar + w
            held = q_bar.copy()
            held[route.prescribed] -= J[:, route.prescribed].T @ w
            position[index] += pose_bar[:3]
            turn[index] += pose_bar[3:]
            joints[index, arm:named] += held[arm:named]
            q_bar = held
            redundant = route.prescribed[route.prescribed < arm]
            if not angled:
                passed[redundant] = q_bar[redundant]
        passed[named:] = q_bar[named:]
        return passed

    def _led(self, index: int, J: FloatArray, q: FloatArray, q_bar: FloatArray) -> FloatArray:
        """As `_solved`, where the target states an arm angle, which stays."""
        arm = self._robot.arm_size
        whole = np.vstack([J[:, :arm], self._robot.arm_angle_slope(q)])
        if not np.linalg.cond(whole) < SINGULAR_TARGET:
            return self._solved(index, np.full((6, 6), np.nan), q_bar)
        return np.asarray(np.linalg.solve(whole.T, q_bar[:arm])[:6])

    def _solved(self, index: int, back: FloatArray | None, q_bar: FloatArray) -> FloatArray:
        """Reverse of inverse kinematics at a move's pose target, by what `_inverses` says of it.

        Raises:
            MotionError: the arm is singular there, so that the derivative does not exist.
        """
        if back is None:
            name, size = self._robot.name, self._robot.arm_size
            problem = (
                f"derivatives of pose targets need an arm of six or seven joints, {name} has {size}"
            )
        elif not np.isfinite(back[0, 0]):
            problem = (
                "the arm is singular at the target, where derivatives do not exist; use a joint "
                "target, or another pose"
            )
        else:
            return q_bar @ back
        raise located(self._program.moves[index], index, problem)


def _inverses(J: FloatArray) -> FloatArray | None:
    """(M, 6, 6), of Jacobians (M, 6, n); NaN of singular ones, None if n is not six."""
    if J.shape[2] != 6:
        return None
    singular = ~(np.linalg.cond(J) < SINGULAR_TARGET)
    back = np.linalg.inv(np.where(singular[:, None, None], np.eye(6), J))
    back[singular] = np.nan
    return np.asarray(back)
