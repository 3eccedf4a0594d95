"""What a fit writes is a motion file that gives its model back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from flyby.core.motion.model import load_motion_model
from flyby.identification.fit import Fit, Interval, ParameterSet, Unseen, motion_file
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
        assert origin.status == "fitted" and origin.source == "1 logged run"
        assert origin.details["command"] == 'flyby identify "x"\n'
        assert origin.details["runs"] == 1
        assert len(origin.details["interval"]) == len(origin.details["fitted"])
    assert "time.settling_s" not in made.provenance


def test_the_file_says_what_it_was_fitted_by(fitted: Fit, tmp_path: Path) -> None:
    from flyby.identification.fit import usual_parameters

    path = tmp_path / "fitted.toml"
    path.write_text(motion_file(fitted, "x"), "utf-8")
    made = load_motion_model(path, START, ROBOT.name)
    again = ParameterSet.named(made, usual_parameters(made, ROBOT))
    assert {one.name for one in again.parameters} == set(TRUE_VALUES)
    for one in again.parameters:
        assert one.start == pytest.approx(TRUE_VALUES[one.name])
        before = next(p for p in fitted.parameters.parameters if p.name == one.name)
        assert (one.lower, one.upper) == (before.lower, before.upper)
    assert made.provenance["blend.tcp.beta"].details["interval"] == [[-0.525, -0.475]]


def test_other_robots_refuse_the_file(fitted: Fit, tmp_path: Path) -> None:
    from flyby.core.errors import InputError

    path = tmp_path / "fitted.toml"
    path.write_text(motion_file(fitted, "x"), "utf-8")
    with pytest.raises(InputError, match="irb6640"):
        load_motion_model(path, START, "abb/irb1200-5-090")
