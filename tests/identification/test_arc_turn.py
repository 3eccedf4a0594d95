"""How the tool turns along arcs is a figure of the motion model, which logs show."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import ArcTurn
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import MoveC, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector
from flyby.identification.fit import ParameterSet, fit, motion_file, prepare
from flyby.identification.logs import LoggedRun, clean
from flyby.identification.logs.synthetic import Faults, synthetic_run
from flyby.identification.prediction import predict

VENDOR = find_vendor("abb")
ROBOT = find_robot("abb/irb6640-180-255")
HOME = (0.3, 0.3, 0.4, 0.6, -0.5, -0.5)
MODEL = replace(MotionModel(), settling=0.05, smoothing=(0.03,))
FOLLOWS, FIXED = ArcOrientation.FOLLOWS_ARC, ArcOrientation.FIXED_FRAME


def program(told: ArcOrientation) -> Program:
    """A quarter of a circle, on which the tool turns about another axis, and back."""
    at = ROBOT.flange_pose(np.array(HOME)).matrix()

    def there(x: float, y: float, z: float, turn: float) -> PoseTarget:
        matrix = at.copy()
        matrix[:3, 3] += (x, y, z)
        matrix[:3, :3] @= matrix_from_rotation_vector(np.array([0.3, 0.2, 1.0]) * turn)
        return PoseTarget(Pose.from_matrix(matrix))

    speed, r, s = Speed(tcp=0.3), 0.25, np.sqrt(0.5)
    via = there(0.0, -r * s, -r * (1 - s), 0.3)
    moves = (
        MoveC(there(0.0, -r, -r, 0.6), speed, FINE, via=via, orientation=told),
        MoveL(there(0.0, 0.0, 0.0, 0.0), speed, FINE),
    )
    return Program(moves, start=JointTarget(HOME))


def logged(turn: ArcTurn, told: ArcOrientation) -> LoggedRun:
    controller = Controller(VENDOR, ROBOT, replace(MODEL, arc_turn=turn))
    return synthetic_run(controller, program(told), f"{turn}-{told}", Faults(), 1)


def joints(turn: ArcTurn, told: ArcOrientation) -> np.ndarray:
    """(T, 6), half way along the path's lengths."""
    controller = Controller(VENDOR, ROBOT, replace(MODEL, arc_turn=turn))
    driven = controller.run(program(told), period=0.01).trajectory
    at = np.linspace(0.0, driven.sigma[-1], 50)
    return np.stack([np.interp(at, driven.sigma, column) for column in driven.q.T], -1)


def test_a_motion_model_turns_the_tool_whatever_programs_say(tmp_path: Path) -> None:
    file = tmp_path / "turn.toml"
    follows, fixed = (joints(ArcTurn.PROGRAMMED, told) for told in (FOLLOWS, FIXED))
    assert np.abs(follows - fixed).max() > 0.02
    for turn, wanted in (("path", follows), ("axis", fixed)):
        file.write_text(f'[arc]\nturn = "{turn}"\n', "utf-8")
        model = load_motion_model(file, MODEL)
        for told in (FOLLOWS, FIXED):
            np.testing.assert_allclose(joints(model.arc_turn, told), wanted, atol=1e-3)
    file.write_text('[arc]\nturn = "tangent"\n', "utf-8")
    with pytest.raises(InputError, match=r"arc\.turn"):
        load_motion_model(file)


@pytest.mark.parametrize(
    ("turn", "told"),
    [(ArcTurn.AXIS, FOLLOWS), (ArcTurn.PATH, FIXED), (ArcTurn.PROGRAMMED, FOLLOWS)],
)
def test_a_log_shows_how_the_tool_turned(turn: ArcTurn, told: ArcOrientation) -> None:
    run = logged(turn, told)
    found = predict(Controller(VENDOR, ROBOT, MODEL), run.name, run.program, clean(run), 1e-3)
    assert found.turn is turn
    assert found.figures.joint_path_max < 1e-3


def test_lines_show_nothing_of_arcs() -> None:
    arc = program(FOLLOWS).moves[0]
    line = Program((MoveL(arc.target, arc.speed, FINE),), start=JointTarget(HOME))
    controller = Controller(VENDOR, ROBOT, MODEL)
    run = synthetic_run(controller, line, "line", Faults(), 1)
    assert predict(controller, "line", line, clean(run), 1e-3).turn is None


def test_a_fit_writes_how_the_tool_turned(tmp_path: Path) -> None:
    runs = [prepare(logged(ArcTurn.AXIS, FOLLOWS), VENDOR, ROBOT, MODEL)]
    found = fit(ParameterSet.named(MODEL, ["time.smoothing_s[0] = 0.02"]), runs)
    assert found.model.arc_turn is ArcTurn.AXIS
    file = tmp_path / "fitted.toml"
    file.write_text(motion_file(found, "x", reference=MODEL), "utf-8")
    made = load_motion_model(file, MODEL)
    assert made.arc_turn is ArcTurn.AXIS
    origin = made.provenance["arc.turn"]
    assert origin.status == "fitted" and origin.details["shown_by"] == [runs[0].name]


def test_a_robots_log_counts_more_than_a_virtual_one() -> None:
    real = prepare(logged(ArcTurn.PROGRAMMED, FOLLOWS), VENDOR, ROBOT, MODEL)
    virtual = replace(logged(ArcTurn.AXIS, FOLLOWS), real=False)
    runs = [prepare(virtual, VENDOR, ROBOT, MODEL)] * 2
    found = fit(ParameterSet.named(MODEL, ["time.smoothing_s[0] = 0.02"]), [*runs, real])
    assert found.turn is ArcTurn.PROGRAMMED
    # Each run is fitted as its own log shows: the others' figures do not suffer.
    assert found.after < 0.1
