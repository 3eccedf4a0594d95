"""Every figure of a motion model, off the table: read, refused, written, emulated and fitted."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flyby.core.errors import InputError, MotionError
from flyby.core.motion.command.commanded_motion import stamped_motion
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.elasticity import Carried, Coupled
from flyby.core.motion.model.figures import Figure, Tables, with_figures
from flyby.core.motion.model.kinds import Choice, RealNumber, Row, TruthValue
from flyby.core.motion.model.motion_file import figures_text, load_motion_model
from flyby.core.motion.model.motion_model import FIGURES, MotionModel, first_change
from flyby.core.motion.model.torque import Borne
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector
from flyby.identification.fit.emulation import STEP, Nuisance, RunEmulator, commanded
from flyby.identification.fit.keys import fit_of, with_value
from flyby.identification.fit.parameters import ParameterSet, parameter
from flyby.identification.fit.runs import PreparedRun, prepare
from flyby.identification.logs.synthetic import SOUND, synthetic_run

from .known_truth import HOME, ROBOT, VENDOR

COARSE = Sampling(step=0.05, joint=0.1)
RICH = {
    "limit.tcp_acceleration": 2.0,
    "limit.reorientation_acceleration": 3.0,
    "limit.joint_acceleration_scale": (1.0, 1.0, 1.0, 0.3, 0.3, 0.3),
    "torque.own_s2": (0.8, 4.0, 0.8),
    "torque.carried": (Borne(3, (0.05, 0.05)),),
    "torque.weight": (0.0, 0.1, 0.1),
    "torque.fade_s2": (0.1, 0.1, 0.1),
    "time.start_ramp_s": 0.1,
    "time.ramp_s": 0.02,
    "time.smoothing_s": (0.03, 0.02),
    "time.settling_s": 0.04,
    "time.in_position_rad": 4e-3,
    "time.in_position_time_s": 0.05,
    "elasticity.own_s2": (1e-4, 1e-4),
    "elasticity.carried": (Carried(5, (2e-5, 2e-5)),),
    "elasticity.coupled": (Coupled(3, 2, 0.1),),
    "elasticity.slack_rad": (1e-3, 1e-3),
    "elasticity.lag_s": (0.0, 2e-3),
    "elasticity.weight": (0.0, 1.0),
    "elasticity.spring_rad": (1e-4,),
    "servo.friction_rad": (0.0, 1e-3),
    "servo.drag_s": (0.0, 1e-3),
}
"""What others need to show."""
CORNERS = {"blend.tcp.kind": "arc", "zone.pace": "superposed", "limit.centripetal": 1.2}
"""Where corners that are too sharp for their speed are cut."""
JERK = {"time.jerk": 30.0}
SWIFT = {"torque.own_s2": (0.8, 0.8, 0.8)}
"""Where axes have not been in position for long when they stop."""
EXAMPLES: dict[str, tuple[Any, dict[str, Any]]] = {
    "period_s": (0.01, {}),
    "blend.tcp.kind": ("arc", {}),
    "blend.tcp.alpha": ((0.0, 0.0, 3.0, -2.0), {}),
    "blend.tcp.beta": ((-0.5,), {}),
    "blend.joint.kind": ("arc", {}),
    "blend.joint.alpha": ((0.0, 0.0, 3.0, -2.0), {}),
    "blend.joint.beta": ((-0.5,), {}),
    "blend.orientation.kind": ("arc", {}),
    "blend.orientation.alpha": ((0.0, 0.0, 3.0, -2.0), {}),
    "blend.orientation.beta": ((-0.5,), {}),
    "line.turn": ("swivel", {}),
    "arc.turn": ("axis", {}),
    "zone.overlap": ("shrink", {}),
    "zone.neighbour_fraction": (0.3, {}),
    "zone.orientation": ("own", {}),
    "zone.mixed_space": ("tcp", {}),
    "zone.stops_at_pure_reorientation": (True, {}),
    "zone.pace": ("superposed", {"blend.tcp.kind": "arc", "limit.centripetal": 1.2}),
    "zone.least_time_s": (0.45, {"zone.least_time_s": 0.4}),
    "time.duration": ("thirds", {}),
    "time.start_ramp_s": (0.15, {}),
    "time.ramp_s": (0.03, {}),
    "time.smoothing_s": ((0.04, 0.02), {}),
    "time.joint_smoothing_s": ((0.04, 0.02), {"time.joint_smoothing_s": (0.03, 0.02)}),
    "time.settling_s": (0.03, {"time.in_position_rad": 0.0}),
    "time.in_position_rad": (3e-3, SWIFT),
    "time.in_position_time_s": (0.06, SWIFT),
    "time.jerk": (25.0, JERK),
    "limit.tcp_speed": (0.1, {}),
    "limit.tcp_acceleration": (3.5, CORNERS),
    "limit.reorientation_acceleration": (2.0, {}),
    "limit.centripetal": (1.5, CORNERS),
    "limit.blend_acceleration": (2.0, {"blend.joint.kind": "quintic"}),
    "limit.joint_acceleration_scale": ((1.0, 1.0, 1.0, 0.25, 0.25, 0.25), {}),
    "torque.own_s2": ((0.9, 4.0, 0.8), {}),
    "torque.carried": ((Borne(3, (0.06, 0.05)),), {}),
    "torque.weight": ((0.0, 0.5, 0.1), {}),
    "torque.fade_s2": ((0.2, 0.1, 0.1), {}),
    "elasticity.own_s2": ((2e-4, 1e-4), {}),
    "elasticity.carried": ((Carried(5, (3e-5, 2e-5)),), {}),
    "elasticity.coupled": ((Coupled(3, 2, 0.2),), {}),
    "elasticity.slack_rad": ((2e-3, 1e-3), {}),
    "elasticity.slack_averaged": (True, {}),
    "elasticity.lag_s": ((0.0, 1e-3), {}),
    "elasticity.weight": ((0.0, 2.0), {}),
    "elasticity.spring_rad": ((2e-4,), {}),
    "servo.friction_rad": ((0.0, 5e-4), {}),
    "servo.friction_rise_rad": (1e-3, {}),
    "servo.friction_fade_s": (0.2, {}),
    "servo.drag_s": ((0.0, 2e-3), {}),
    "servo.rest_s": (0.02, {"time.in_position_rad": 0.0}),
    "servo.drag_speed_radps": (1.0, {}),
    "servo.drag_delay_s": (0.05, {}),
}
"""Another value of every figure, and what it needs beside it to show."""
WITHOUT_EFFECT = {"blend.joint.kind", "blend.orientation.kind"}
"""Only positions of the TCP follow arcs."""


def model(values: dict[str, Any]) -> MotionModel:
    """A model of values as files have words, and Python all else."""
    read = {
        FIGURES[key]: FIGURES[key].kind.read(key, value) if isinstance(value, str) else value
        for key, value in values.items()
    }
    return with_figures(MotionModel(), read)


def pair(key: str) -> tuple[MotionModel, MotionModel]:
    """A model in which the figure counts, and the same with another value of it."""
    value, beside = EXAMPLES[key]
    return model(RICH | beside), model(RICH | beside | {key: value})


def everything() -> Program:
    """Lines with corners, a turn on the spot, an arc, a stop, joint moves, a programmed time."""
    at = ROBOT.flange_pose(HOME).matrix()

    def there(x: float, y: float, z: float, *turn: float) -> PoseTarget:
        made = at.copy()
        made[:3, 3] += x, y, z
        made[:3, :3] = matrix_from_rotation_vector(np.array(turn or (0.0,) * 3)) @ made[:3, :3]
        return PoseTarget(Pose.from_matrix(made))

    def near(*change: float) -> JointTarget:
        return JointTarget(tuple(map(float, HOME + np.array(change))))

    told = Speed(tcp=0.6, reorientation=1.5)
    swift = replace(told, joint=2.0, joint_acceleration=20.0)
    wide = Radius(0.06, 0.1, 0.1, 0.1)
    moves = (
        MoveL(there(0.0, -0.25, 0.0, 0.2, 0.1, 0.0), told, wide),
        MoveL(there(0.15, -0.15, 0.05, 0.2, 0.2, 0.1), told, Radius(0.12, 0.12, 0.12, 0.1)),
        MoveL(there(0.15, 0.0, 0.05), told, wide),
        MoveL(there(0.15, 0.0, 0.05, 0.2, 0.0, 0.2), told, wide),
        MoveC(
            there(0.15, 0.2, 0.05, 0.0, 0.2, 0.2),
            told,
            FINE,
            via=there(0.25, 0.1, 0.05),
            orientation=ArcOrientation.FOLLOWS_ARC,
        ),
        MoveJ(near(0.1, 0.1, -0.1, 0.1, 0.1, 0.1), swift, wide),
        MoveJ(near(-0.1, 0.0, 0.1, 0.1, 0.2, 0.1), swift, wide),
        MoveL(there(0.1, -0.1, 0.0), told, FINE),
        MoveL(there(0.1, 0.1, 0.0), Speed(duration=1.5), FINE),
        MoveJ(JointTarget(tuple(HOME)), told, FINE),
    )
    return Program(moves, start=JointTarget(tuple(HOME)))


PROGRAM = everything()
JOINT_MOVES = Program(
    tuple(one for one in PROGRAM.moves if isinstance(one, MoveJ)), start=PROGRAM.start
)
Result = list[np.ndarray] | str


def program(key: str) -> Program:
    """One in which a figure counts."""
    return JOINT_MOVES if key == "time.joint_smoothing_s" else PROGRAM


@cache
def stages(key: str, changed: bool) -> tuple[Result, ...]:
    """What each stage of an emulation gives; what it says where it gives none."""
    one = pair(key)[changed]
    controller = Controller(VENDOR, ROBOT, one, COARSE)
    driven = program(key)
    try:
        path = controller.plan(driven)
    except MotionError as error:
        return (str(error),)
    timing, smoothing = controller.stamp(driven, path), controller.smoothing(driven, path)
    t = np.arange(0.0, timing.duration, 0.02)
    states = smoothing.command(stamped_motion(timing), t)
    return (
        [path.q, path.sigma],
        [timing.begin, timing.end, np.array([timing.duration, *smoothing.widths]), states[0]],
        [commanded(controller, smoothing, stamped_motion(timing), t)],
        [controller.sample(driven, timing).t],
    )


def same(one: Result, other: Result) -> bool:
    """Whether two results are."""
    if isinstance(one, str) or isinstance(other, str):
        return one == other
    return all(map(np.array_equal, one, other))


def test_every_figure_has_an_example() -> None:
    assert set(EXAMPLES) == set(FIGURES)
    for key, one in FIGURES.items():
        assert one.help and (one.unit or not isinstance(one.kind, RealNumber | Row)), key


@pytest.mark.parametrize("key", FIGURES)
def test_it_is_written_and_read(key: str, tmp_path: Path) -> None:
    before, after = pair(key)
    path = tmp_path / "motion.toml"
    path.write_text(figures_text(after, [key]), "utf-8")
    assert load_motion_model(path, before) == after
    path.write_text(figures_text(before, [key]), "utf-8")
    assert load_motion_model(path, after) == before
    # Nothing can be stated as well: what a layer takes away.
    path.write_text(figures_text(MotionModel(), [key]), "utf-8")
    assert FIGURES[key].of(load_motion_model(path)) == FIGURES[key].neutral


@pytest.mark.parametrize("key", FIGURES)
def test_it_needs_a_provenance_where_it_is_stated(key: str) -> None:
    assert key in pair(key)[1].figures
    assert (key in MotionModel().figures) == FIGURES[key].always


@pytest.mark.parametrize("key", FIGURES)
def test_what_makes_no_sense_is_refused_with_file_and_key(key: str, tmp_path: Path) -> None:
    path = tmp_path / "motion.toml"
    table, _, name = key.rpartition(".")
    for entry in refused(FIGURES[key]):
        path.write_text((f"[{table}]\n" if table else "") + f"{name} = {entry}\n", "utf-8")
        with pytest.raises(InputError) as caught:
            load_motion_model(path)
        assert str(caught.value).startswith(f"{path}: {key}"), entry


def refused(one: Figure) -> list[str]:
    """Entries of a file that a figure does not take."""
    kind = one.kind
    if isinstance(kind, Choice):
        return ['"no such word"', "3"]
    if isinstance(kind, TruthValue):
        return ['"false"', "1"]
    if isinstance(kind, Tables):
        return ["3", "[3]", "[{ joint = 3 }]"]
    assert isinstance(kind, RealNumber | Row)
    numbers = ["nan", "inf", "true", '"a"']
    if np.isfinite(kind.within.lower):
        numbers.append(repr(kind.within.lower - (0.0 if kind.within.above else 1.0)))
    if np.isfinite(kind.within.upper):
        numbers.append(repr(2.0 * kind.within.upper))
    return numbers if isinstance(kind, RealNumber) else [f"[{one}]" for one in numbers]


@pytest.mark.parametrize("key", FIGURES)
def test_its_stage_is_the_first_that_it_changes(key: str) -> None:
    """What is kept of an emulation while it is fitted is what does not change."""
    before, after = stages(key, False), stages(key, True)
    stage = FIGURES[key].stage
    assert first_change(*pair(key)) is stage
    alike = [same(*results) for results in zip(before, after, strict=False)]
    assert all(alike[: stage - 1])
    assert alike[stage - 1] == (key in WITHOUT_EFFECT)


def numbers_of(key: str) -> list[str]:
    """A key of each number of a figure that says it is fitted."""
    one = FIGURES[key]
    if isinstance(one.kind, Tables):
        rows = [(m.key, isinstance(m.kind, Row)) for m in one.kind.members if m.fit is not None]
        return [f"{key}[0].{name}{'[0]' * row}" for name, row in rows]
    if one.fit is None:
        return []
    value = one.of(pair(key)[1])
    # Of a row, an entry that the example changes.
    before = one.of(pair(key)[0])
    if not isinstance(one.kind, Row):
        return [key]
    entries = range(len(value))
    changed = [k for k in entries if k >= len(before) or before[k] != value[k]]
    return [f"{key}[{changed[0]}]"]


FITTED = {number: key for key in FIGURES for number in numbers_of(key)}


@pytest.mark.parametrize("key", [key for key in FIGURES if not numbers_of(key)])
def test_what_does_not_say_so_is_not_fitted(key: str) -> None:
    with pytest.raises(InputError, match=f"{key}.*(not fitted|no number)"):
        parameter(pair(key)[1], f"{key} = 1")


@cache
def prepared(corners: bool, jerk: bool, joints: bool) -> PreparedRun:
    """A log of the whole program, or of its joint moves."""
    one = model(RICH | (CORNERS if corners else {}) | (JERK if jerk else {}))
    driven = JOINT_MOVES if joints else PROGRAM
    run = synthetic_run(Controller(VENDOR, ROBOT, one), driven, "everything", SOUND, 0)
    return prepare(run, VENDOR, ROBOT, one)


@pytest.mark.parametrize("number", FITTED)
def test_it_is_fitted_with_what_is_kept_of_other_emulations(number: str) -> None:
    """Derivatives with stages that are kept are differences of emulations made anew."""
    key = FITTED[number]
    beside = EXAMPLES[key][1]
    base = pair(key)[1]
    run = prepared(beside is CORNERS, beside is JERK, program(key) is JOINT_MOVES)
    named = ParameterSet.named(base, [number])
    (one,) = named.parameters
    usual = fit_of(number)
    assert usual.lower <= one.lower <= one.start <= one.upper <= usual.upper
    middle = Nuisance(run.offset)
    rows = RunEmulator(run).rows(named.stepped(named.start, STEP), middle)
    step = 1e-3 * one.scale
    if one.upper < one.start + step:
        step = -step
    fresh = RunEmulator(run).residuals(with_value(base, number, one.start + step), middle)
    made = rows.values + step * rows.by_parameter[..., 0]
    np.testing.assert_allclose(made, fresh, atol=1e-9 * max(1.0, float(np.abs(fresh).max())))
    assert np.abs(rows.by_parameter).max() > 0.0
