"""The emulation checks find emulators and models that are wrong."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import strategies as st
from hypothesis.errors import Unsatisfiable

from flyby.core.language import Sources
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.gradients.derivatives import Derivatives
from flyby.core.motion.model.blend import Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.program import Program
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_vendor
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import Pose
from flyby.core.vendor import Vendor
from flyby.testing.checks import emulation
from flyby.testing.checks.emulation import FINE_SAMPLING, EmulationChecks

ABB = find_vendor("abb")


class Suite(EmulationChecks):
    """The checks about any emulator; pytest does not collect it by this name."""

    name = "abb"

    def __init__(self, controller: type[Controller], vendor: Vendor = ABB) -> None:
        self._controller = controller
        self._vendor = vendor

    @property
    def vendor(self) -> Vendor:
        return self._vendor

    def controller(self, robot: Robot, model: MotionModel | None = None) -> Controller:
        return self._controller(self.vendor, robot, model, FINE_SAMPLING)


def check(name: str, controller: type[Controller], vendor: Vendor = ABB) -> None:
    with pytest.raises((AssertionError, ExceptionGroup)):
        getattr(Suite(controller, vendor), f"test_{name}")()


class WithRobot(Controller):
    """Drives another robot than it is asked to."""

    def __init__(
        self, vendor: Vendor, robot: Robot, model: MotionModel | None, sampling: Sampling
    ) -> None:
        super().__init__(vendor, self.changed(robot), model, sampling)

    def changed(self, robot: Robot) -> Robot:
        raise NotImplementedError


class Hasty(WithRobot):
    def changed(self, robot: Robot) -> Robot:
        joints = tuple(replace(j, acceleration=1.1 * j.acceleration) for j in robot.joints)
        return replace(robot, joints=joints)


class Misplaced(WithRobot):
    def changed(self, robot: Robot) -> Robot:
        return robot.with_base(Pose((0.0, 0.0, 1e-3)))


class WithModel(Controller):
    """Drives by another model than the vendor's."""

    changes: Mapping[str, Any]

    def __init__(
        self, vendor: Vendor, robot: Robot, model: MotionModel | None, sampling: Sampling
    ) -> None:
        model = replace(model or vendor.motion_of(robot), **self.changes)
        super().__init__(vendor, robot, model, sampling)


class Bulging(WithModel):
    changes = {"tcp": Blend(beta=(60.0,)), "joint": Blend(beta=(60.0,))}  # noqa: RUF012


class Wandering(WithModel):
    changes = {"joint": Blend(beta=(-40.0,))}  # noqa: RUF012


class Sluggish(WithModel):
    changes = {"tcp_acceleration": 0.1}  # noqa: RUF012


class WithProgram(Controller):
    """Drives another program than it is asked to."""

    def plan(self, program: Program, start: Any = None) -> Any:
        changed = [replace(move, zone=self.zone(move.zone)) for move in program.moves]
        return super().plan(program.with_moves(tuple(changed)), start)

    def zone(self, zone: Any) -> Any:
        raise NotImplementedError


class CutsStops(WithProgram):
    def zone(self, zone: Any) -> Any:
        return Radius(0.02) if zone == FINE else zone


class WidensZones(WithProgram):
    def zone(self, zone: Any) -> Any:
        return zone if zone == FINE else Radius(1.2 * zone.tcp)


class Kinked(Controller):
    def run(self, program: Program, start: Any = None, period: float | None = None) -> Run:
        run = super().run(program, start, period)
        run.path.states.dq[run.path.pieces.first_sample[1:-1]] *= 1.001
        return run


class Late(Controller):
    def run(self, program: Program, start: Any = None, period: float | None = None) -> Run:
        run = super().run(program, start, period)
        return replace(run, trajectory=replace(run.trajectory, q=run.trajectory.q + 1e-6))


class OffPeriod(Controller):
    def sample(
        self, program: Program, timing: Any, period: float | None = None, beyond: float = 0.0
    ) -> Any:
        made = super().sample(program, timing, period, beyond)
        return replace(made, q=made.q + (period or 0.0) * made.dq)


@pytest.mark.parametrize(
    ("name", "controller"),
    [
        ("the_path_leaves_the_programmed_one_inside_zones_only", Bulging),
        ("the_path_leaves_the_programmed_one_inside_zones_only", WidensZones),
        ("targets_are_the_corners_of_the_path", Misplaced),
        ("targets_are_the_corners_of_the_path", CutsStops),
        ("the_path_has_a_continuous_tangent", Kinked),
        ("limits_hold_between_samples", Hasty),
        ("limits_hold_between_usual_samples_or_are_noted", Hasty),
        ("the_motion_starts_and_ends_as_programmed", Late),
        ("half_the_speed_takes_twice_the_time", Sluggish),
        ("zones_between_joint_moves_save_time", Wandering),
        ("samples_do_not_depend_on_the_period", OffPeriod),
    ],
)
def test_a_wrong_emulation_is_found(name: str, controller: type[Controller]) -> None:
    check(name, controller)


@pytest.mark.parametrize("part", ["zone", "position", "joints"])
def test_a_wrong_derivative_is_found(part: str, monkeypatch: pytest.MonkeyPatch) -> None:
    class Wrong(Derivatives):
        def duration(self) -> Any:
            made = super().duration()
            return replace(made, **{part: 1.1 * getattr(made, part) + 0.1})

    monkeypatch.setattr(emulation, "Derivatives", Wrong)
    check("the_derivative_of_duration_is_its_slope", Controller)


def slower(write: Callable[..., Sources]) -> Callable[..., Sources]:
    def written(program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        moves = (replace(m, speed=replace(m.speed, tcp=0.5 * m.speed.tcp)) for m in program.moves)
        return write(program.with_moves(tuple(moves)), robot, options)

    return written


def test_a_writer_that_changes_the_motion_is_found() -> None:
    class Writer:
        write = staticmethod(slower(ABB.writer.write))  # type: ignore[union-attr]

    check("what_is_written_moves_alike", Controller, replace(ABB, writer=Writer()))


def test_an_emulator_that_drives_nothing_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(emulation, "programs", lambda *_: st.just(Program(())))
    with pytest.raises(Unsatisfiable):
        Suite(Controller).test_limits_hold_between_samples()
