"""What a run about an open question is for: figures that it shows, and what its log decides.

A log decides between motion models under which the run is driven otherwise. So the run is emulated
with what may be so instead: how much longer it takes then, and how far apart it runs, says what to
look for.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...core.errors import FlybyError, InputError
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run
from ...core.motion.model.blend import Blend
from ...core.motion.model.motion_model import MotionModel
from ...core.motion.model.rules import Pace, Space
from ...core.motion.model.servo import Servo
from ...core.program.target import JointTarget
from ...core.program.tool import WORLD
from ...core.robot.kinematics.chain_kernels import jacobians
from ...core.robot.model import Robot
from ...core.robot.work_chain import work_chain
from ..fit.keys import fit_of, value_of
from ..tcp_path import distance_to_polyline, tcp_positions
from .kinds import Kind, Topic
from .plan import Alternative, CandidateRun, Purpose

WRIST = 3
"""Joints, counted from 0, from which on the tool is turned."""
SLOWER, HALF = 0.8, 0.5
"""Shares of accelerations that runs tell from the emulated ones."""
RUB, BACKLASH = 1e-4, 1e4
"""rad that friction sets joints off by, and s that no run takes."""
DRAG = 1e-3
"""s of their velocity that fast joints may be behind by."""
BULGE = 1.0
"""β₀ by which corners may run otherwise."""
_EVERY, _SAME = 2e-3, 1e-6
"""s between the samples that are compared, and by which runs take the same time."""
_NOTHING = 1e-6
"""m and rad that no log shows."""
_JOINTS = (Kind.JOINTS, Kind.UNEQUAL_JOINTS, Kind.CONTOURS)
_MIXED = (Kind.LINES_AND_JOINTS, Kind.JOINTS_AND_ARCS)

QUESTIONS = {
    Topic.SHORT_LEGS: """What caps the speed where legs are short: the length of the leg, or the
        least time of its zone?""",
    Topic.TURNS: """What limits how fast the tool begins to turn, at a point and in corners: its own
        angular acceleration, or that of the wrist's joints?""",
    Topic.POSTURES: "How do accelerations change with the posture, by inertia and by weight?",
    Topic.REVERSALS: "What do friction and backlash make of a joint that turns back?",
    Topic.BLENDS: "How do corners between such moves run, and how fast are they passed?",
    Topic.DRAG: "How far are joints behind where they run fast, and how long after a stop?",
}
DECISIONS = {
    Topic.SHORT_LEGS: """Legs of other lengths that take the same time with the same zone show that
        zones take a least time: zone.least_time_s. A time that grows with the root of the length,
        at all zones alike, shows that the length caps the speed, for which the model has no figure
        yet.""",
    Topic.TURNS: """A limit of the tool gives one angular acceleration about all axes, at a point
        and in corners. A limit of the joints gives another about each axis and at each posture.""",
    Topic.POSTURES: """If one factor on accelerations serves all postures and directions,
        limit.joint_acceleration_scale holds it. If up and down are alike, but postures far out ask
        for another one than those near by, it is inertia (torque.own_s2, torque.carried); if up and
        down differ, weight (torque.weight). Drive these runs with the flange bare and with the load
        mounted and declared, in a folder each, if the robot is to carry one.""",
    Topic.REVERSALS: """A stop without turning back shows what is the stop's own. What comes up
        behind a reversal alone, within a small part of the way, and fades within a second or so is
        friction: servo. What stays until the joint turns back again is backlash, for which a long
        servo.friction_fade_s stands. What lasts as long a way at both rates fades by the way, for
        which the model has no figure.""",
    Topic.BLENDS: """The rule with which the emulation runs nearest to the log, and takes its time,
        is the controller's. It is one for all only if it serves all angles, zones and speeds; of
        corners between two speeds it shows which of them counts.""",
    Topic.DRAG: """The last joint, which turns slowly while the others rest, tells the time of each
        sample. A joint that is behind by the same time at all speeds lags: elasticity.lag_s. What
        is hardly there at the slow speed, and by that time at the fast one, is drag: servo.drag_s,
        servo.drag_speed_radps. How long after the end of the motion it is gone is
        servo.drag_delay_s. Drag that differs one way and the other is weight or cold grease, for
        which the model has no figure.""",
}


def purpose(controller: Controller, candidate: CandidateRun, run: Run) -> Purpose | None:
    """What a run is for; None of the usual runs.

    Args:
        controller: that drives, as far as it is known.
        candidate: the run as it was designed.
        run: its emulation.
    """
    study = candidate.study
    if study is None:
        return None
    model, robot = controller.model, controller.robot
    return Purpose(
        " ".join(QUESTIONS[study.topic].split()),
        tuple(_figures(study.topic, candidate, model, robot)),
        tuple(_compared(controller, candidate, run)),
    )


def fit_text(model: MotionModel, key: str) -> str | None:
    """A figure as ``--fit`` takes it, with a start where the model states none; None of a rule,
    which is not fitted."""
    try:
        fit_of(key)
    except InputError:
        return None
    if value_of(model, key) is not None:
        return key
    return f"{key} = {_STARTS.get(key.partition('[')[0], 0.0):.4g}"


_STARTS = {
    "limit.reorientation_acceleration": 20.0,
    "limit.tcp_acceleration": 5.0,
    "limit.centripetal": 1.0,
    "limit.joint_acceleration_scale": 1.0,
    "servo.drag_s": -0.5 * DRAG,
}
"""Where a fit may begin whose figure nobody states, but for zero."""


def _figures(
    topic: Topic, candidate: CandidateRun, model: MotionModel, robot: Robot
) -> Iterator[str]:
    size = robot.arm_size
    study = candidate.study
    assert study is not None
    match topic:
        case Topic.SHORT_LEGS:
            yield "zone.least_time_s"
        case Topic.TURNS:
            yield "limit.reorientation_acceleration"
            for joint in range(WRIST, size):
                yield f"limit.joint_acceleration_scale[{joint}]"
        case Topic.POSTURES:
            limited = len(model.torque.own)
            yield from (f"torque.own_s2[{joint}]" for joint in range(limited))
            yield from (f"torque.weight[{joint}]" for joint in range(1, limited))
            for joint in range(limited, size):
                yield f"limit.joint_acceleration_scale[{joint}]"
        case Topic.REVERSALS:
            yield from (f"servo.friction_rad[{joint}]" for joint in study.joints)
            yield from ("servo.friction_rise_rad", "servo.friction_fade_s")
        case Topic.DRAG:
            yield from (f"servo.drag_s[{joint}]" for joint in study.joints)
            yield from (f"elasticity.lag_s[{joint}]" for joint in study.joints)
            yield from ("servo.drag_speed_radps", "servo.drag_delay_s")
        case Topic.BLENDS:
            yield from _blend_figures(candidate.kind, model)


def _blend_figures(kind: Kind, model: MotionModel) -> Iterator[str]:
    in_joints = kind in (*_JOINTS, *_MIXED)
    name, blend = ("joint", model.joint) if in_joints else ("tcp", model.tcp)
    if kind in _MIXED:
        yield "zone.mixed_space"
    if blend.kind == "quintic":
        yield "limit.blend_acceleration"
    elif blend.kind == "arc":
        yield "limit.centripetal"
    else:
        yield f"blend.{name}.beta[0]"
    yield "zone.pace"


def _compared(controller: Controller, candidate: CandidateRun, run: Run) -> Iterator[Alternative]:
    start = JointTarget(tuple(map(float, candidate.start)))
    tool = candidate.program.moves[0].tool

    def driven(model: MotionModel) -> Run:
        return controller.with_model(model).run(run.program, start, _EVERY)

    base = driven(controller.model)
    line = tcp_positions(controller.robot, tool, base.trajectory.q_motor)
    for what, model in _alternatives(controller, candidate, base):
        try:
            other = driven(model)
        except FlybyError:
            continue
        points = tcp_positions(controller.robot, tool, other.trajectory.q_motor)
        apart = float(distance_to_polyline(points, line).max())
        longer, turned = other.duration - base.duration, None
        if abs(longer) < _SAME:
            count = min(len(base.trajectory.t), len(other.trajectory.t))
            off = other.trajectory.q_motor[:count] - base.trajectory.q_motor[:count]
            turned = float(np.abs(off).max())
            if max(apart, turned) < _NOTHING:
                continue
        yield Alternative(what, longer, apart, turned)


def _alternatives(
    controller: Controller, candidate: CandidateRun, run: Run
) -> Iterator[tuple[str, MotionModel]]:
    """What may be so instead, in words, and the motion model that says so."""
    model, study = controller.model, candidate.study
    assert study is not None
    match study.topic:
        case Topic.SHORT_LEGS:
            for periods in range(3):
                time = periods * model.period
                if abs(time - model.zone_time) > 1e-9:
                    least = f"zones take {1e3 * time:.4g} ms at least"
                    what = "zones take no least time" if not time else least
                    yield what, replace(model, zone_time=time)
        case Topic.TURNS:
            most = HALF * _angular_acceleration(controller.robot, run)
            yield (
                f"the tool turns with {most:.3g} rad/s² at most",
                replace(model, reorientation_acceleration=most),
            )
            share = [HALF if joint >= WRIST else 1.0 for joint in range(controller.robot.arm_size)]
            yield "the wrist's joints have half of their accelerations", _scaled(model, share)
        case Topic.POSTURES:
            share = [SLOWER] * controller.robot.arm_size
            yield (
                f"all joints have {100 * SLOWER:.0f} % of their accelerations",
                _scaled(model, share),
            )
            if any(model.torque.weight):
                torque = replace(model.torque, weight=())
                yield "no motor holds weight", replace(model, torque=torque)
        case Topic.REVERSALS:
            joints = (-RUB,) * controller.robot.arm_size
            fading = f"fades within {model.servo.fade:.3g} s"
            for what, fade in (
                (f"friction that {fading}", model.servo.fade),
                ("backlash, which stays", BACKLASH),
            ):
                rubs = Servo(joints, rise=model.servo.rise, fade=fade)
                yield f"{1e3 * RUB:.3g} mrad of {what}", replace(model, servo=rubs)
        case Topic.DRAG:
            behind, servo = (-DRAG,) * controller.robot.arm_size, model.servo
            by = f"joints are behind by {1e3 * DRAG:.3g} ms of their velocity"
            for how, other in (
                (f"where they run fast, shown {servo.drag_delay:.3g} s later", servo),
                ("where they run fast, at once", replace(servo, drag_delay=0.0)),
            ):
                yield f"{by} {how}", replace(model, servo=replace(other, drag=behind))
        case Topic.BLENDS:
            yield from _other_blends(candidate.kind, model)


def _other_blends(kind: Kind, model: MotionModel) -> Iterator[tuple[str, MotionModel]]:
    in_joints = kind in (*_JOINTS, *_MIXED)
    what, blend = ("joints blend", model.joint) if in_joints else ("the TCP blends", model.tcp)
    if blend.kind == "polynomial":
        beta = (sum(blend.beta[:1]) + BULGE, *blend.beta[1:])
        others = [(f"{what} with a β₀ of {beta[0]:.3g}", replace(blend, beta=beta))]
        if not in_joints:
            others.append((f"{what} by circles", replace(blend, kind="arc")))
    else:
        others = [(f"{what} by parabolas", Blend())]
    for told, other in others:
        yield told, replace(model, joint=other) if in_joints else replace(model, tcp=other)
    if kind in _MIXED:
        space = Space.TCP if model.mixed_space is Space.JOINT else Space.JOINT
        where = "space" if space is Space.TCP else "joints"
        yield f"these corners are blended in {where}", replace(model, mixed_space=space)
    pace = Pace.LIMITS if model.pace is Pace.SUPERPOSED else Pace.SUPERPOSED
    how = "as the limits allow" if pace is Pace.LIMITS else "as superposed moves"
    yield f"zones are driven {how}", replace(model, pace=pace)


def _scaled(model: MotionModel, share: list[float]) -> MotionModel:
    """The model with shares of the accelerations of each joint."""
    scales = tuple(model.acceleration_scale(joint) * value for joint, value in enumerate(share))
    own = tuple(value / share[joint] for joint, value in enumerate(model.torque.own))
    carried = tuple(
        replace(one, share=tuple(value / share[joint] for joint, value in enumerate(one.share)))
        for one in model.torque.carried
    )
    torque = replace(model.torque, own=own, carried=carried)
    return replace(model, joint_acceleration_scale=scales, torque=torque)


def _angular_acceleration(robot: Robot, run: Run) -> float:
    """rad/s² of the tool at most."""
    made = run.trajectory
    chain = work_chain(robot, run.program.moves[0].tool, WORLD)
    J = jacobians(chain, np.ascontiguousarray(made.q))[:, 3:]
    turning = np.einsum("tij,tj->ti", J, made.dq)
    return float(np.linalg.norm(np.gradient(turning, made.t, axis=0), axis=1).max())
