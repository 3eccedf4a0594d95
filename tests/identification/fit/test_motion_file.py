"""What a fit writes is a motion file that gives its model back."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from flyby.core.errors import InputError
from flyby.core.motion.model.blend import Blend
from flyby.core.motion.model.elasticity import Carried, Coupled, Elasticity
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import (
    ArcTurn,
    DurationRule,
    LineTurn,
    OrientationZone,
    Overlap,
    Pace,
    Space,
)
from flyby.core.motion.model.servo import Servo
from flyby.core.motion.model.torque import Borne, Torque
from flyby.identification.fit import (
    Fit,
    Interval,
    ParameterSet,
    Unseen,
    motion_file,
    usual_parameters,
)
from flyby.identification.fit.parameters import fitted_before
from flyby.identification.logs.synthetic import SOUND

from .known_truth import ROBOT, START, TRUE_VALUES, logged, ready


@pytest.fixture(scope="module")
def fitted() -> Fit:
    named = ParameterSet.named(START, TRUE_VALUES)
    values = np.array(list(TRUE_VALUES.values()))
    known = tuple(
        Interval(name, value, abs(value) / 50, value - abs(value) / 20, value + abs(value) / 20)
        for name, value in TRUE_VALUES.items()
    )
    runs = (ready(logged(faults=SOUND)),)
    lost = (Unseen("time.settling_s", "no stop"),)
    return Fit(named, values, runs, (), known, lost, 2.0, 0.123456, 5, True)


def test_the_file_holds_the_model(fitted: Fit, tmp_path: Path) -> None:
    path = tmp_path / "fitted.toml"
    path.write_text(motion_file(fitted, 'flyby identify "x"\n', "one\ntwo"), "utf-8")
    assert path.read_text().startswith("# one\n# two\nrobot = ")
    made = load_motion_model(path, START, ROBOT.name)
    for name in ("tcp", "smoothing", "elasticity", "joint_acceleration_scale"):
        assert getattr(made, name) == getattr(fitted.model, name), name
    assert made.settling == START.settling
    for figure in ("blend.tcp.beta", "time.smoothing_s", "elasticity.carried"):
        origin = made.provenance[figure]
        assert origin.status == "fitted" and origin.fit is not None
        assert origin.fit.source == "1 logged run"
        assert origin.fit.command == 'flyby identify "x"\n'
        assert origin.fit.details == {"runs": 1, "confidence": 0.95, "loss": 0.1235}
        assert len(origin.interval) == len(origin.fitted) > 0
    assert path.read_text().count("flyby identify") == 1
    assert "time.settling_s" not in made.provenance


def test_the_file_says_what_it_was_fitted_by(fitted: Fit, tmp_path: Path) -> None:
    path = tmp_path / "fitted.toml"
    path.write_text(motion_file(fitted, "x"), "utf-8")
    made = load_motion_model(path, START, ROBOT.name)
    again = ParameterSet.named(made, usual_parameters(made, ROBOT))
    assert {one.name for one in again.parameters} == set(TRUE_VALUES)
    for one in again.parameters:
        assert one.start == pytest.approx(TRUE_VALUES[one.name])
        before = next(p for p in fitted.parameters.parameters if p.name == one.name)
        assert (one.lower, one.upper) == (before.lower, before.upper)
    assert made.provenance["blend.tcp.beta"].interval == ((-0.525, -0.475),)


def test_other_robots_refuse_the_file(fitted: Fit, tmp_path: Path) -> None:
    path = tmp_path / "fitted.toml"
    path.write_text(motion_file(fitted, "x"), "utf-8")
    with pytest.raises(InputError, match="irb6640"):
        load_motion_model(path, START, "abb/irb1200-5-090")


OTHER = MotionModel(
    period=0.01,
    tcp=Blend(kind="arc", alpha=(0.0, 0.0, 3.0, -2.0), beta=(0.25,)),
    joint=Blend(beta=(-0.5,)),
    orientation=Blend(beta=(0.125,)),
    overlap=Overlap.SKIP,
    neighbour_fraction=0.25,
    orientation_zone=OrientationZone.OWN,
    mixed_space=Space.TCP,
    stops_at_pure_reorientation=True,
    pace=Pace.SUPERPOSED,
    tcp_speed=1.75,
    tcp_acceleration=3.5,
    reorientation_acceleration=2.5,
    line_turn=LineTurn.SWIVEL,
    arc_turn=ArcTurn.AXIS,
    centripetal=1.5,
    joint_acceleration_scale=(1.5, 0.5),
    torque=Torque((0.5, 0.25), (Borne(3, (0.125, 0.25)),), (0.5,), (0.75,)),
    duration=DurationRule.THIRDS,
    start_ramp=0.125,
    zone_time=0.125,
    blend_acceleration=1.25,
    ramp=0.0625,
    smoothing=(0.5, 0.25),
    joint_smoothing=(0.25, 0.125),
    settling=0.375,
    in_position=0.25,
    in_position_time=0.0625,
    elasticity=Elasticity(
        (1e-4,),
        (Carried(4, (2e-4, 3e-4)),),
        (1e-3,),
        True,
        (2e-3,),
        (2.0,),
        (0.5,),
        (Coupled(3, 2, 0.125),),
    ),
    servo=Servo((1e-4,), 1e-4, 0.3, (2e-3,), 0.4, 0.2),
    jerk=12.0,
)


def one_fit(base: MotionModel, text: str, value: float) -> Fit:
    """A fit of one parameter."""
    named = ParameterSet.named(base, [text])
    known = (Interval(named.parameters[0].name, value, 1e-3, value - 2e-3, value + 2e-3),)
    runs = (ready(logged(faults=SOUND)),)
    return Fit(named, np.array([value]), runs, (), known, (), 2.0, 1.0, 5, True)


def test_whatever_the_fit_began_with_is_written(tmp_path: Path) -> None:
    """Every field of a motion model, though but one is fitted."""
    plain = MotionModel()
    for field in fields(MotionModel):
        if field.name != "provenance":
            assert getattr(OTHER, field.name) != getattr(plain, field.name), field.name
    path = tmp_path / "fitted.toml"
    path.write_text(motion_file(one_fit(OTHER, "time.settling_s", 0.5), "x", reference=plain))
    made = load_motion_model(path, plain)
    assert replace(made, provenance={}) == replace(OTHER, settling=0.5)
    assert set(made.provenance) <= made.figures
    assert made.provenance["zone.pace"].source == "stated where the fit began"


def test_what_was_taken_away_is_written(tmp_path: Path) -> None:
    path = tmp_path / "fitted.toml"
    without = replace(OTHER, jerk=None, smoothing=(), start_ramp=0.0)
    path.write_text(motion_file(one_fit(without, "time.ramp_s", 0.0), "x", reference=OTHER))
    made = load_motion_model(path, OTHER)
    assert replace(made, provenance={}) == replace(without, ramp=0.0)


def test_a_fit_on_top_of_another(tmp_path: Path) -> None:
    """Both stay in the file, and with them what they were fitted by."""
    below, above = tmp_path / "below.toml", tmp_path / "above.toml"
    below.write_text(motion_file(one_fit(START, "time.settling_s", 0.1), "first"))
    base = load_motion_model(below, START)
    second = one_fit(base, "blend.tcp.beta[0]", -0.5)
    above.write_text(motion_file(second, "second", reference=START))
    for lower in (base, START):
        made = load_motion_model(above, lower)
        fits = {key: origin.fit.command for key, origin in made.provenance.items() if origin.fit}
        assert fits == {"time.settling_s": "first", "blend.tcp.beta": "second"}
        assert (made.settling, made.tcp.beta) == (0.1, (-0.5,))
        assert sorted(fitted_before(made)) == [
            "blend.tcp.beta[0] in -8 .. 8",
            "time.settling_s in 0 .. 1",
        ]
