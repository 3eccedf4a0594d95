"""Motion models: what is refused, and how it is named."""

from __future__ import annotations

import math

import pytest

from flyby.core.errors import InputError
from flyby.core.motion.command.smoothing import Smoothing, smoothing_at
from flyby.core.motion.model.elasticity import Carried, Elasticity
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel

BROKEN = {
    'period_s = "fast"': "period_s",
    "period_s = inf": "period_s",
    "[time]\nsmoothing_s = nan": "time.smoothing_s",
    "[time]\nsmoothing_s = [0.04, -1]": "time.smoothing_s",
    "[time]\nsmoothing_s = [0.04, 'a']": "time.smoothing_s",
    "[time]\nsettling_s = nan": "time.settling_s",
    "[time]\nin_position_rad = nan": "time.in_position_rad",
    "[time]\nin_position_rad = 'near'": "time.in_position_rad",
    "[time]\nin_position_time_s = -0.1": "time.in_position_time_s",
    "[time]\njerk = nan": "time.jerk",
    "elasticity = 1": "elasticity",
    "[limit]\njoint_acceleration_scale = 2": "limit.joint_acceleration_scale",
    "[limit]\njoint_acceleration_scale = [1, 0]": "limit.joint_acceleration_scale",
    "[elasticity]\nown = [1]": "elasticity.own",
    "[elasticity]\nown_s2 = 1": "elasticity.own_s2",
    "[elasticity]\nown_s2 = [nan]": "elasticity.own_s2",
    "[elasticity]\nslack_rad = [-1e-4]": "elasticity.slack_rad",
    "[elasticity]\ncarried = 3": "elasticity.carried",
    "[elasticity]\ncarried = [{ joint = 3 }]": "elasticity.carried",
    "[elasticity]\ncarried = [{ joint = 3.5, lead_s2_per_m2 = [] }]": "elasticity.carried",
    "[elasticity]\ncarried = [{ joint = 2, lead_s2_per_m2 = [0, 1] }]": "elasticity.carried",
    "[elasticity]\ncarried = [{ joint = 2, lead_s2_per_m2 = [nan] }]": "elasticity.carried",
    "[limit]\ntcp_acceleration = -1": "limit.tcp_acceleration",
    "[limit]\nreorientation_acceleration = nan": "limit.reorientation_acceleration",
    '[zone]\nstops_at_pure_reorientation = "false"': "zone.stops_at_pure_reorientation",
    "[zone]\nneighbour_fraction = true": "zone.neighbour_fraction",
    "zone = 1": "zone",
    "time = []": "time",
    "[blend]\ntcp = 3": "blend.tcp",
    '[blend.tcp]\nalpha = ["a"]': r"blend\.tcp\.alpha\[0\]: a number is expected",
    "[blend.tcp]\nbeta = 'x'": "blend.tcp.beta: a list of numbers is expected",
    "[blend.tcp]\ngamma = [1]": "unknown key of a motion model 'blend.tcp.gamma'",
    "[blend.tcp]\nkind = 3": 'blend.tcp.kind: "polynomial", "arc" or "quintic" is expected',
    "provenance = 1": "provenance",
    "[provenance]\nperiod_s = 1": "provenance.period_s",
    "[provenance.period_s]\nsource = 'a book'": "provenance.period_s: the status is missing",
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
        {"smoothing": (math.nan,)},
        {"smoothing": (-0.1,)},
        {"settling": -0.1},
        {"in_position": -1e-3},
        {"in_position": math.nan},
        {"in_position_time": math.inf},
        {"jerk": math.nan},
        {"jerk": 0.0},
        {"jerk": -3.0},
        {"tcp_acceleration": -1.0},
        {"reorientation_acceleration": math.inf},
        {"stops_at_pure_reorientation": "false"},
    ],
)
def test_figures_without_meaning_are_refused(change) -> None:
    (name,) = change
    with pytest.raises(InputError, match=rf"\b{name}(?:_s|_rad)?\b"):
        MotionModel(**change)


def test_a_sound_file_is_read(tmp_path) -> None:
    path = tmp_path / "motion.toml"
    path.write_text(
        "period_s = 0.002\n[time]\njerk = 'none'\n[zone]\nstops_at_pure_reorientation = true\n"
        "[blend.tcp]\nalpha = [0, 1]\n[provenance.period_s]\n"
        "status = 'assumed'\nsource = 'a'\nruns = 3\n",
        "utf-8",
    )
    model = load_motion_model(path)
    assert (model.period, model.jerk, model.stops_at_pure_reorientation) == (0.002, None, True)
    assert model.tcp.alpha == (0.0, 1.0)
    assert model.provenance["period_s"].details == {"runs": 3}


def test_what_is_done_in_time_is_read(tmp_path) -> None:
    path = tmp_path / "motion.toml"
    path.write_text(
        "[time]\nsmoothing_s = [0.04, 0, 0.02]\nsettling_s = 0.1\n"
        "in_position_rad = 6e-3\nin_position_time_s = 0.15\n"
        "[elasticity]\nown_s2 = [1e-4, 0]\n"
        "carried = [{ joint = 3, lead_s2_per_m2 = [2e-4, 1e-4] }]\n"
        "[limit]\njoint_acceleration_scale = [1.5, 0.5]\n",
        "utf-8",
    )
    model = load_motion_model(path)
    assert smoothing_at(model, 1.0) == Smoothing((0.04, 0.02)) and model.settling == 0.1
    assert (model.in_position, model.in_position_time) == (6e-3, 0.15)
    assert model.elasticity == Elasticity((1e-4, 0.0), (Carried(3, (2e-4, 1e-4)),))
    assert [model.acceleration_scale(j) for j in range(3)] == [1.5, 0.5, 1.0]
    keys = {
        "limit.joint_acceleration_scale",
        "time.settling_s",
        "time.in_position_rad",
        "time.in_position_time_s",
        "elasticity.own_s2",
        "elasticity.carried",
    }
    assert keys <= model.figures and not keys & MotionModel().figures
    path.write_text("[time]\nsmoothing_s = 0.06\n", "utf-8")
    assert load_motion_model(path).smoothing == (0.06,)


def test_a_file_lies_on_a_base(tmp_path) -> None:
    base, layer = tmp_path / "motion.toml", tmp_path / "own.toml"
    base.write_text(
        "period_s = 0.002\n[blend.tcp]\nkind = 'arc'\n[elasticity]\nown_s2 = [1e-4]\n"
        "carried = [{ joint = 3, lead_s2_per_m2 = [2e-4] }]\n"
        "[provenance]\nperiod_s = { status = 'assumed', source = 'a' }\n",
        "utf-8",
    )
    layer.write_text(
        "robot = 'acme/one'\n[blend.tcp]\nbeta = [0.5]\n[elasticity]\nown_s2 = [2e-4]\n"
        "[fits.b]\nsource = 'b'\ncommand = 'c'\n"
        "[provenance]\n'blend.tcp.beta' = { status = 'fitted', by = 'b' }\n",
        "utf-8",
    )
    model = load_motion_model(layer, load_motion_model(base), "acme/one")
    assert (model.period, model.tcp.kind, model.tcp.beta) == (0.002, "arc", (0.5,))
    assert model.elasticity == Elasticity((2e-4,), (Carried(3, (2e-4,)),))
    assert set(model.provenance) == {"period_s", "blend.tcp.beta"}
    assert load_motion_model(layer).period == MotionModel().period
    with pytest.raises(InputError, match="it says how acme/one is driven, not acme/two"):
        load_motion_model(layer, robot="acme/two")
