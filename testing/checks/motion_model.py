"""Checks of a vendor's motion model: it loads, and every figure says where it is from."""

from __future__ import annotations

from ...core.motion.model.motion_model import MotionModel
from .subject import Subject


class MotionModelChecks(Subject):
    """The file of blend and stamping parameters is whole."""

    def test_the_motion_model_loads_once(self) -> None:
        model = self.vendor.motion()
        assert isinstance(model, MotionModel)
        assert self.vendor.motion() is model

    def test_every_figure_has_a_provenance(self) -> None:
        for model in self._models():
            assert set(model.provenance) == model.figures

    def _models(self) -> list[MotionModel]:
        """Of the controller, and of the robots of which more is known."""
        robots = [self.vendor.robot(name) for name in self.vendor.robot_motion]
        return [self.vendor.motion(), *map(self.vendor.motion_of, robots)]
