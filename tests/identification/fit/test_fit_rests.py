"""How stops end comes back from logs in which they are approached at several speeds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from flyby.core.motion.model.motion_file import load_motion_model
from flyby.identification.fit import ParameterSet, fit, motion_file
from flyby.identification.logs.synthetic import Faults

from .known_truth import ROBOT, TRUTH, logged, ready

TRUE = {
    "time.settling_s": 0.06,
    "time.in_position_rad": 4e-3,
    "time.in_position_time_s": 0.09,
}
BEGUN = ("time.settling_s = 0.05", "time.in_position_rad = 3e-3", "time.in_position_time_s = 0.08")


def test_how_stops_end_is_found(tmp_path: Path) -> None:
    truth = replace(TRUTH, settling=0.06, in_position=4e-3, in_position_time=0.09)
    base = replace(truth, settling=0.05, in_position=0.0, in_position_time=None)
    faults = Faults(noise=1e-5)
    runs = [
        ready(logged(0.0, speed, seed, faults, truth), base)
        for seed, speed in enumerate((0.8, 0.12, 0.06))
    ]
    found = fit(ParameterSet.named(base, BEGUN), runs)
    assert found.converged and not found.unseen
    for one in found.intervals:
        assert one.lower <= TRUE[one.name] <= one.upper, one
        assert one.value == pytest.approx(TRUE[one.name], rel=0.1)
    assert found.after < 0.02 * found.before
    path = tmp_path / "fitted.toml"
    path.write_text(motion_file(found, "flyby identify"), "utf-8")
    again = load_motion_model(path, base, ROBOT.name)
    assert again.in_position == pytest.approx(found.model.in_position, rel=1e-5)
    assert again.in_position_time == pytest.approx(found.model.in_position_time, rel=1e-5)
