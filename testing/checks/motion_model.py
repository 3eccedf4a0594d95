"""Checks of a vendor's motion model: it loads, and every figure says where it is from."""

from __future__ import annotations

from ...core.motion.model import MotionModel
from .subject import Subject

STATUSES = {"published", "assumed", "fitted"}
BLENDS = ("tcp", "joint", "orientation")
ZONE_RULES = (
    "overlap",
    "neighbour_fraction",
    "orientation",
    "mixed_space",
    "stops_at_pure_reorientation",
)


def figures(model: MotionModel) -> set[str]:
    """The dotted keys of all that a motion model states."""
    keys = {"period_s", "time.smoothing_s", "time.jerk"}
    keys |= {f"blend.{name}.{key}" for name in BLENDS for key in ("kind", "alpha", "beta")}
    keys |= {f"zone.{rule}" for rule in ZONE_RULES}
    for limit in ("tcp_acceleration", "reorientation_acceleration"):
        if getattr(model, limit) is not None:
            keys.add(f"limit.{limit}")
    return keys


class MotionModelChecks(Subject):
    """The file of blend and stamping parameters is whole."""

    def test_the_motion_model_loads_once(self) -> None:
        model = self.vendor.motion()
        assert isinstance(model, MotionModel)
        assert self.vendor.motion() is model

    def test_every_figure_has_a_provenance(self) -> None:
        model = self.vendor.motion()
        assert set(model.provenance) == figures(model)

    def test_a_provenance_can_be_followed(self) -> None:
        for key, entry in self.vendor.motion().provenance.items():
            assert entry.status in STATUSES, key
            if entry.status == "fitted":
                assert "command" in entry.details, f"{key}: a fit states the command that made it"
            else:
                assert entry.source, f"{key}: {entry.status} by whom?"
