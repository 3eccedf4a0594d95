"""Where the robot stands before the first move, as the user says it, is what programs read."""

from __future__ import annotations

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from flyby.cli.main import app
from flyby.core.errors import SourceError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_robot, find_vendor

RAPID = "MODULE a\n{data}\nPROC main()\n{body}\nENDPROC\nENDMODULE"
POINT = "[[500,0,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
FRAMES = "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n"
KRL = "DEF a()\nE6POS p\nE6AXIS q\n" + FRAMES + "{body}\nEND"
URSCRIPT = "def a():\n  set_tcp(p[0,0,0,0,0,0])\n{body}\nend\na()\n"

STARTS = {
    "abb/irb6640-180-255": (10, 20, 5, 30, 40, 50),
    "kuka/kr30-3": (10, -80, 95, 30, 40, 50),
    "ur/ur5e": (10, -80, 95, -60, 80, 50),
}
PROGRAMS = [
    # A line that goes up from where the robot stands.
    (
        "abb/irb6640-180-255",
        "a.mod",
        RAPID.format(data="", body="MoveL Offs(CRobT(),0,0,20),v100,fine,tool0;"),
    ),
    (
        "abb/irb6640-180-255",
        "a.mod",
        RAPID.format(
            data="VAR jointtarget j;\nVAR robtarget p;",
            body="j:=CJointT();\np:=CalcRobT(j,tool0);\nMoveL Offs(p,0,0,20),v100,fine,tool0;",
        ),
    ),
    ("kuka/kr30-3", "a.src", KRL.format(body="p=$POS_ACT\np.Z=p.Z+20\nLIN p")),
    ("kuka/kr30-3", "a.src", KRL.format(body="LIN_REL {Z 20}")),
    (
        "ur/ur5e",
        "a.script",
        URSCRIPT.format(
            body="  p = get_actual_tcp_pose()\n  p[2] = p[2] + 0.02\n  movel(p, a=1, v=0.1)"
        ),
    ),
    (
        "ur/ur5e",
        "a.script",
        URSCRIPT.format(
            body="  q = get_actual_joint_positions()\n  p = get_forward_kin(q)\n"
            "  movel(pose_add(p, p[0,0,0.02,0,0,0]), a=1, v=0.1)"
        ),
    ),
]
ALL = pytest.mark.parametrize(("name", "file", "text"), PROGRAMS)


def stand(name: str) -> JointTarget:
    return JointTarget(tuple(np.radians(STARTS[name]).tolist()))


@ALL
def test_a_program_is_told_where_it_starts(name, file, text) -> None:
    vendor, robot = find_vendor(name.split("/")[0]), find_robot(name)
    start = stand(name)
    program = vendor.read(text, file, robot=robot, start=start)
    run = Controller(vendor, robot).run(program, start)
    way = run.trajectory.position[-1] - run.trajectory.position[0]
    assert way == pytest.approx([0, 0, 0.02], abs=1e-4)
    assert np.abs(np.diff(run.trajectory.q, axis=0)).max() < 0.05


@ALL
def test_without_a_start_it_is_refused(name, file, text) -> None:
    vendor, robot = find_vendor(name.split("/")[0]), find_robot(name)
    with pytest.raises(SourceError, match=r"give a start|of values that are not known"):
        vendor.read(text, file, robot=robot)


@pytest.mark.parametrize(
    ("name", "file", "text"),
    [
        (
            "abb/irb6640-180-255",
            "a.mod",
            RAPID.format(data="", body="MoveAbsJ CJointT(),v100,fine,tool0;"),
        ),
        ("kuka/kr30-3", "a.src", KRL.format(body="q=$AXIS_ACT\nPTP q")),
        ("kuka/kr30-3", "a.src", KRL.format(body="PTP {A1 10}")),
        ("kuka/kr30-3", "a.src", KRL.format(body="PTP_REL {A1 0}")),
        ("ur/ur5e", "a.script", URSCRIPT.format(body="  movej(get_actual_joint_positions())")),
        ("ur/ur5e", "a.script", URSCRIPT.format(body="  movej(get_target_joint_positions())")),
    ],
)
def test_joint_values_are_those_of_the_start(name, file, text) -> None:
    vendor, robot = find_vendor(name.split("/")[0]), find_robot(name)
    (move,) = vendor.read(text, file, robot=robot, start=stand(name)).moves
    assert isinstance(move.target, JointTarget)
    assert np.degrees(move.target.joints) == pytest.approx(STARTS[name], abs=1e-4)


def test_inverse_kinematics_begins_at_the_start() -> None:
    """Without ``qnear`` the solution nearest to where the robot stands is taken."""
    robot, start = find_robot("ur/ur5e"), stand("ur/ur5e")
    body = "  q = get_inverse_kin(get_actual_tcp_pose())\n  movej([q[0],q[1],q[2],q[3],q[4],q[5]])"
    (move,) = (
        find_vendor("ur")
        .read(URSCRIPT.format(body=body), "a.script", robot=robot, start=start)
        .moves
    )
    assert move.target.joints == pytest.approx(start.joints, abs=1e-6)


@pytest.mark.parametrize("command", ["emulate", "check"])
@ALL
def test_the_option_reaches_the_reader(tmp_path, command, name, file, text) -> None:
    path = tmp_path / file
    path.write_text(text)
    start = ",".join(map(str, STARTS[name]))
    given = [command, str(path), "--robot", name, "--start", start, "--json"]
    result = CliRunner().invoke(app, given)
    assert result.exit_code == 0, result.output
    report = json.loads(result.stdout)
    if command == "check":
        assert not [f for f in report["findings"] if f["severity"] == "error"]
