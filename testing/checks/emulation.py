"""Checks of the motion that comes of a vendor's motion model, robots and labels.

Programs are driven and looked at from outside: through the arm's own kinematics, between the
samples that the emulator itself looked at, against geometry that is worked out here anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from ...core.arrays import FloatArray
from ...core.errors import MotionError
from ...core.motion.command.trajectory import Trajectory
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run
from ...core.motion.geometry.pieces import Sampling
from ...core.motion.gradients.derivatives import Derivatives
from ...core.motion.model.motion_model import MotionModel
from ...core.motion.model.rules import LineTurn
from ...core.motion.path.tcp_walk import JOINED
from ...core.program.move import Move, MoveJ, Wait
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget
from ...core.program.zone import FINE, Fine, Radius, Zone
from ...core.robot.model import Robot
from ..observation import Observed, at_speed, away_from_legs, outside_zones, turned_away
from ..strategies import OfKind, Parts, fly_by_zones, lines_near_singularities, programs
from .subject import PROGRAM_EXAMPLES, Subject

ON_PATH = 1e-6
"""m or rad by which a path may miss what is programmed outside its zones."""
SAME = 1e-7
"""m, rad, and their rates as a share of the largest: what rounding of inverse kinematics leaves."""
SLACK = 1.005
"""By how much a limit may be passed between samples."""
FINE_SAMPLING = Sampling(
    step=0.005, turn=0.02, joint=0.015, blend=200, least=32, most=400, halvings=4
)
"""Dense enough for `SLACK` even in corners that turn back, where the TCP all but stops."""
ROBOTS = 2
"""So many robots of a vendor are driven."""
MOVES = 3
PERIOD = 0.1
"""s between samples of trajectories: the checks look at the stamp itself."""
DRIVES = settings(PROGRAM_EXAMPLES, max_examples=20)


class EmulationChecks(Subject):
    """What is driven is what was programmed, within the limits, and its derivatives are right."""

    def controller(self, robot: Robot, model: MotionModel | None = None) -> Controller:
        """The emulator under test."""
        return Controller(self.vendor, robot, model, FINE_SAMPLING)

    @DRIVES
    @given(data=st.data())
    def test_the_path_leaves_the_programmed_one_inside_zones_only(
        self, data: st.DataObject
    ) -> None:
        robot, run = self._drive(data, fly_by_zones(self.zones))
        seen, model = Observed.of(robot, run), self.vendor.motion_of(robot)
        for away, turning in ((away_from_legs(seen), False), (turned_away(seen, model), True)):
            outside = outside_zones(seen, model, turning)
            assert away[outside].max(initial=0.0) < ON_PATH

    @DRIVES
    @given(data=st.data())
    def test_targets_are_the_corners_of_the_path(self, data: st.DataObject) -> None:
        robot, run = self._drive(data, self.zones)
        seen = Observed.of(robot, run)
        for move, q in zip(seen.moves, seen.corners[1:], strict=True):
            if isinstance(move.target, JointTarget):
                assert np.abs(q - [*move.target.joints, *move.target.external]).max() < SAME
            else:
                gap = robot.flange_pose(q).matrix() - move.target.pose.matrix()
                assert np.abs(gap).max() < SAME
            if isinstance(move.zone, Fine):
                nearest = np.abs(seen.q - q).max(axis=1)
                assert nearest.min() < SAME, "a stop point is cut"
                assert np.abs(seen.dq[nearest.argmin()]).max() < SAME, "no stop at a stop point"

    @DRIVES
    @given(data=st.data())
    def test_the_path_has_a_continuous_tangent(self, data: st.DataObject) -> None:
        _, run = self._drive(data, fly_by_zones(self.zones))
        path = run.path
        right = path.pieces.first_sample[1:-1]
        jump = path.states.dq[right] - path.states.dq[right - 1]
        flying = ~path.pieces.stop[1:-1]
        assert np.abs(path.q[right] - path.q[right - 1]).max(initial=0.0) < SAME
        assert np.abs(jump[flying]).max(initial=0.0) < SAME * np.abs(path.states.dq).max()

    @DRIVES
    @given(data=st.data())
    def test_joints_never_jump_near_singular_postures(self, data: st.DataObject) -> None:
        """Lines are followed on one branch of inverse kinematics, or refused by their move."""
        robot = self._robot(data)
        program = data.draw(lines_near_singularities(robot))
        try:
            run = self.controller(robot).run(program, period=PERIOD)
        except MotionError as error:
            assert error.move is not None, "the refusal names no move"
            return
        seen = Observed.of(robot, run)
        rate = np.maximum(np.abs(seen.dq[1:]), np.abs(seen.dq[:-1]))
        moved, step = np.abs(np.diff(seen.q, axis=0)), np.diff(seen.t)[:, None]
        assert (moved <= 4 * rate * step + JOINED).all(), "joints go farther than they are fast"

    @DRIVES
    @given(data=st.data())
    def test_limits_hold_between_samples(self, data: st.DataObject) -> None:
        robot, run = self._drive(data, self.zones)
        assert (self._shares(robot, run) <= SLACK).all()

    @DRIVES
    @given(data=st.data(), singular=st.booleans())
    def test_limits_hold_between_usual_samples_or_are_noted(
        self, data: st.DataObject, singular: bool
    ) -> None:
        """At the density that everybody drives with, near singular postures too."""
        robot = self._robot(data)
        controller = self.controller(robot)
        controller.sampling = Controller(self.vendor, robot).sampling
        if singular:
            program = data.draw(lines_near_singularities(robot))
        else:
            parts = self._parts(self.zones)
            drawn = programs(robot, self.vendor.label, parts, MOVES, self.kinds)
            program = data.draw(drawn)
        try:
            run = controller.run(program, period=PERIOD)
        except MotionError:
            assume(False)
            raise
        noted = {note.move for note in run.notes if "between samples" in note.message}
        passed = np.flatnonzero(self._shares(robot, run) > SLACK)
        assert {run.path.route.moves[k] for k in passed} <= noted

    @DRIVES
    @given(data=st.data())
    def test_the_motion_starts_and_ends_as_programmed(self, data: st.DataObject) -> None:
        robot, run = self._drive(data, self.zones)
        start, made = run.program.start, run.trajectory
        assert start is not None
        assert np.abs(made.q[0] - [*start.joints, *start.external]).max() < SAME
        assert np.abs(made.q[-1] - Observed.of(robot, run).corners[-1]).max() < SAME
        # The last sample may miss the end by a thousandth of a period.
        coast = 1e-3 * PERIOD * robot.limits.acceleration
        assert (np.abs(made.dq[[0, -1]]) <= coast).all()
        waits = sum(s.duration for s in run.program.statements if isinstance(s, Wait))
        assert run.duration >= waits + sum(self.vendor.motion_of(robot).smoothing)

    @DRIVES
    @given(data=st.data(), factor=st.floats(0.1, 0.9))
    def test_half_the_speed_takes_twice_the_time(self, data: st.DataObject, factor: float) -> None:
        robot, run = self._drive(data, self.zones)
        model = self.vendor.motion_of(robot)
        for own in ("tcp_acceleration", "reorientation_acceleration"):
            if (limit := getattr(model, own)) is not None:
                model = replace(model, **{own: limit * factor**2})
        model = replace(model, zone_time=model.zone_time / factor)
        slower = self.controller(robot, model)
        timing = slower.run(at_speed(run.program, factor), period=PERIOD).timing
        assert np.isclose(
            timing.stamp.duration * factor, run.timing.stamp.duration, rtol=SAME, atol=0
        )

    @DRIVES
    @given(data=st.data())
    def test_zones_between_joint_moves_save_time(self, data: st.DataObject) -> None:
        """At the joints' own speeds: under limits of the TCP the shorter way may be the slower."""
        robot, run = self._drive(data, fly_by_zones(self.zones), [MoveJ])
        assume(len(run.path.route.moves) == len(run.program.moves))
        durations = []
        for changes in ({"speed": Speed()}, {"speed": Speed(), "zone": FINE}):
            moves = tuple(replace(move, **changes) for move in run.program.moves)
            changed = run.program.with_moves(moves)
            durations.append(self.controller(robot).run(changed, period=PERIOD).timing.duration)
        assert durations[0] <= (1 + SAME) * durations[1]

    @DRIVES
    @given(data=st.data())
    def test_samples_do_not_depend_on_the_period(self, data: st.DataObject) -> None:
        robot, run = self._drive(data, self.zones)
        sample, period = self.controller(robot).sample, run.duration / 200
        coarse = sample(run.program, run.timing, period)
        fine = sample(run.program, run.timing, 0.5 * period)
        assert np.isclose(fine.duration, coarse.duration)
        every = slice(0, 2 * (len(coarse.t) - 1), 2)
        assert np.abs(fine.q[every] - coarse.q[:-1]).max() < SAME
        assert np.abs(fine.q[-1] - coarse.q[-1]).max() < SAME
        # A cubic misses a motion of bounded acceleration by at most a T² / 16.
        again = on_times(coarse.resampled(0.5 * period), fine.t)
        bound = robot.limits.acceleration * period**2 / 16
        assert (np.abs(again - fine.q) <= 2 * bound + SAME).all()

    @DRIVES
    @given(data=st.data(), share=st.floats(0, 1), axis=st.integers(0, 2))
    def test_the_derivative_of_duration_is_its_slope(
        self, data: st.DataObject, share: float, axis: int
    ) -> None:
        robot, run = self._drive(data, fly_by_zones(self.zones))
        controller, program = self.controller(robot), run.program
        gradient = Derivatives(program, run.timing).duration()
        i = round(share * (len(program.moves) - 1))
        move = program.moves[i]
        if isinstance(move.target, JointTarget):
            slope = gradient.joints[i, axis]
        else:
            slope = gradient.position[i, axis]
        _check_slope(controller, run, lambda h: with_target_moved(program, i, axis, h), slope)
        if move.speed.tcp is not None:
            tcp = move.speed.tcp
            _check_slope(
                controller,
                run,
                lambda h: with_move(program, i, speed=replace(move.speed, tcp=tcp + h)),
                gradient.speed.tcp[i],
            )
        if isinstance(move.zone, Radius):
            zone = move.zone
            _check_slope(
                controller,
                run,
                lambda h: with_move(program, i, zone=replace(zone, tcp=zone.tcp + h)),
                gradient.zone[i],
            )

    @DRIVES
    @given(data=st.data())
    def test_what_is_written_moves_alike(self, data: st.DataObject) -> None:
        self.need("reader", "writer")
        robot, run = self._drive(data, self.zones)
        assume(robot.name.partition("/")[2] in self.driven_robots())
        again = self.read_back(self.vendor.write(run.program, robot), robot)
        try:
            copy = self.controller(robot).run(again, period=PERIOD)
        except MotionError as error:
            raise AssertionError(f"the written program cannot be driven: {error}") from error
        first, second = run.timing, copy.timing
        assert np.isclose(second.duration, first.duration, rtol=1e-3)
        share = np.linspace(0.0, 1.0, 50)
        apart = [timing.states_at(share * timing.duration)[0] for timing in (first, second)]
        fastest = np.abs(Observed.of(robot, run).dq).max()
        late = 1e-3 * first.duration
        assert np.abs(apart[0] - apart[1]).max() < 1e-3 + fastest * late

    def _shares(self, robot: Robot, run: Run) -> FloatArray:
        """(M,), the greatest share of a limit that is taken on each leg, between samples too."""
        seen = Observed.of(robot, run)
        twist = seen.twist()
        # Of two parts that are limited, each for itself, the whole may take √2 times as much.
        split = self.vendor.motion_of(robot).line_turn is LineTurn.SWIVEL
        turning = math.sqrt(2.0) if split else 1.0
        most = np.zeros(len(seen.moves))
        for k, move in enumerate(seen.moves):
            rows = seen.segment == k
            dq, ddq = np.abs(seen.dq[rows]), np.abs(seen.ddq[rows])
            most_ddq = move.speed.acceleration_override * robot.limits.acceleration
            shares = [dq / robot.limits.velocity, ddq / most_ddq]
            for part, limit, room in (
                (slice(3), move.speed.tcp, 1.0),
                (slice(3, 6), move.speed.reorientation, turning),
            ):
                if limit is not None:
                    shares.append(np.linalg.norm(twist[rows, part], axis=1) / (room * limit))
            if isinstance(move, MoveJ) and move.speed.joint is not None:
                shares.append(dq / move.speed.joint)
            most[k] = max(float(share.max(initial=0.0)) for share in shares)
        return most

    def _parts(self, zone: OfKind[Zone]) -> Parts:
        return Parts(zone, self.speeds, arc=self.arcs())

    def _drive(
        self,
        data: st.DataObject,
        zone: OfKind[Zone],
        kinds: Sequence[type[Move]] = (),
    ) -> tuple[Robot, Run]:
        """A robot, and what came of a program that it can drive."""
        robot = self._robot(data)
        parts = self._parts(zone)
        kinds = kinds or self.kinds
        program = data.draw(programs(robot, self.vendor.label, parts, MOVES, kinds))
        try:
            return robot, self.controller(robot).run(program, period=PERIOD)
        except MotionError:
            assume(False)
            raise

    def _robot(self, data: st.DataObject) -> Robot:
        """One of the vendor's arms of six axes."""
        names = [n for n in sorted(self.vendor.robots) if self.vendor.robot(n).arm_size == 6]
        if not names:
            pytest.skip(f"{self.name} has no arm of six axes")
        return self.vendor.robot(data.draw(st.sampled_from(names[:ROBOTS])))


def on_times(trajectory: Trajectory, t: FloatArray) -> FloatArray:
    """Joints (T, N) of a trajectory whose own times are t up to rounding."""
    assert np.allclose(trajectory.t, t, atol=1e-9)
    return trajectory.q


def with_move(program: Program, i: int, **changes: object) -> Program:
    """The program with parts of move ``i`` replaced."""
    moves = list(program.moves)
    moves[i] = replace(moves[i], **changes)  # type: ignore[arg-type]
    return program.with_moves(tuple(moves))


def with_target_moved(program: Program, i: int, axis: int, h: float) -> Program:
    """The program with coordinate or joint ``axis`` of target ``i`` increased by ``h``."""
    target = program.moves[i].target
    if isinstance(target, JointTarget):
        joints = list(target.joints)
        joints[axis] += h
        return with_move(program, i, target=replace(target, joints=tuple(joints)))
    step = h * np.eye(3)[axis]
    x, y, z = (float(value) for value in np.add(target.pose.position, step))
    pose = replace(target.pose, position=(x, y, z))
    return with_move(program, i, target=replace(target, pose=pose))


def _check_slope(
    controller: Controller, run: Run, changed: Callable[[float], Program], slope: float
) -> None:
    """Compare a derivative of the duration with differences on both sides.

    Near a tie of two limits they differ, and the derivative is only known as well as they agree;
    where the path falls into other pieces or samples there is none, and nothing is compared.
    """
    h = 1e-5
    try:
        timings = [controller.run(changed(step), period=PERIOD).timing for step in (-h, h)]
    except MotionError:
        return
    pieces = run.path.pieces
    for timing in timings:
        other = timing.path
        if other.route.moves != run.path.route.moves:
            return
        if not np.array_equal(other.pieces.sample_shares, pieces.sample_shares):
            return
        if not np.array_equal(other.pieces.source, pieces.source):
            return
    before, after = (timing.duration for timing in timings)
    sides = ((run.timing.duration - before) / h, (after - run.timing.duration) / h)
    room = 2e-3 * abs(slope) + 1e-3 + abs(sides[1] - sides[0])
    assert min(sides) - room <= slope <= max(sides) + room
