"""Motion models: what is refused, and how it is named."""

from __future__ import annotations

import math

import pytest

from flyby.core.errors import InputError
from flyby.core.motion.model import MotionModel, load_motion_model

BROKEN = {
    'period_s = "fast"': "period_s",
    "period_s = inf": "period_s",
    "[time]\nsmoothing_s = nan": "time.smoothing_s",
    "[time]\njerk = nan": "time.jerk",
    "[limit]\ntcp_acceleration = -1": "limit.tcp_acceleration",
    "[limit]\nreorientation_acceleration = nan": "limit.reorientation_acceleration",
    '[zone]\nstops_at_pure_reorientation = "false"': "zone.stops_at_pure_reorientation",
    "[zone]\nneighbour_fraction = true": "zone.neighbour_fraction",
    "zone = 1": "zone",
    "time = []": "time",
    "[blend]\ntcp = 3": "blend.tcp",
    '[blend.tcp]\nalpha = ["a"]': "blend.tcp",
    "provenance = 1": "provenance",
    "[provenance]\nperiod_s = 1": "provenance.period_s",
    "[provenance.period_s]\nsource = 'a book'": "provenance.period_s",
}


@pytest.mark.parametrize("text", BROKEN)
def test_a_broken_file_is_named_with_the_key(text, tmp_path) -> None:
    path = tmp_path / "motion.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match=rf"motion\.toml: .*{BROKEN[text]}"):
        load_motion_model(path)


@pytest.mark.parametrize(
    "change",
    [
        {"period": 0.0},
        {"period": math.inf},
        {"smoothing": math.nan},
        {"jerk": math.nan},
        {"jerk": 0.0},
        {"tcp_acceleration": -1.0},
        {"reorientation_acceleration": math.inf},
        {"stops_at_pure_reorientation": "false"},
    ],
)
def test_figures_without_meaning_are_refused(change) -> None:
    with pytest.raises(InputError):
        MotionModel(**change)


def test_a_sound_file_is_read(tmp_path) -> None:
    path = tmp_path / "motion.toml"
    path.write_text(
        "period_s = 0.002\n[time]\njerk = 'none'\n[zone]\nstops_at_pure_reorientation = true\n"
        "[blend.tcp]\nalpha = [0, 1]\n[provenance.period_s]\nstatus = 'fitted'\nruns = 3\n",
        "utf-8",
    )
    model = load_motion_model(path)
    assert (model.period, model.jerk, model.stops_at_pure_reorientation) == (0.002, None, True)
    assert model.tcp.alpha == (0.0, 1.0)
    assert model.provenance["period_s"].details == {"runs": 3}
