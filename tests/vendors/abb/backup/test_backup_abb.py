"""Whole backups of ABB controllers, opened, read and driven."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flyby
from flyby.core.backup.backup import Backup, SignalKind
from flyby.core.language import BackupOpener
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.program import Program
from flyby.core.program.tool import Load
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.vendors.abb.backup.cfg import parse_parameters
from flyby.vendors.abb.backup.opener import OPENER
from flyby.vendors.abb.backup.planner import stated_speeds

from .station import MAIN, USER, Station, cfg, multimove, on_track, one_robot, with_positioner

ABB = find_vendor("abb")


def opened(station: Station, folder: Path) -> Backup:
    root = station.write(folder)
    return OPENER.open(root, root, find_robot)


def read(backup: Backup, task: int = 0) -> Program:
    """The program of a task, as the commands read it."""
    one = backup.tasks[task]
    assert one.main is not None and one.robot is not None
    others = [backup.root / file for file in one.files if file != one.main]
    robot = backup.robots[one.robot].robot
    return ABB.read_file(backup.root / one.main, one.entry, robot, others=others)


def texts(backup: Backup) -> list[str]:
    return [str(note) for note in backup.notes]


def test_the_vendor_opens_backups() -> None:
    assert ABB.backups is not None
    assert isinstance(ABB.backups(), BackupOpener)


def test_one_robot(tmp_path: Path) -> None:
    backup = opened(Station(), tmp_path)
    assert (backup.vendor, backup.controller) == ("abb", "Cell7, IRC5")
    assert backup.version == "RobotWare 6.08.0134"
    (task,) = backup.tasks
    assert (task.name, task.robot, task.entry) == ("T_ROB1", 0, "Main")
    assert task.files == ("RAPID/TASK1/PROGMOD/MainModule.mod", "RAPID/TASK1/SYSMOD/user.sys")
    assert task.main == task.files[0]
    assert [entry.name for entry in task.entries] == ["Main", "Pick", "At", "Service"]
    assert [entry.moves for entry in task.entries] == [3, 2, 1, 2]
    assert task.entries[2].parameters == ("p",)
    assert task.entries[3].file == task.files[1]
    assert not texts(backup)
    (robot,) = backup.robots
    assert robot.robot is not None
    assert (robot.unit, robot.written) == ("ROB_1", "ROB1_4600_2.55_40")
    assert robot.robot.name == "abb/irb4600-40-255"
    assert robot.robot.origins["range"].startswith("published: ARM rob1_1 to rob1_6")
    assert backup.motion["period_s"][0] == 0.004032
    assert "assumed" in backup.motion["period_s"][1]


def test_data_and_signals(tmp_path: Path) -> None:
    backup = opened(Station(), tmp_path)
    tool = backup.tools["tGripper"]
    assert tool.tcp.position == (0.0125, 0.0, 0.18)
    assert tool.load == Load(4.5, (0.0, 0.0, 0.06), (0.1, 0.2, 0.3))
    assert backup.frames["wTable"].user.position == (0.9, 0.0, 0.4)
    assert np.allclose(np.degrees(backup.homes["jHome"].joints), [0, -20, 20, 0, 60, 0])
    assert [(s.name, s.kind, s.address) for s in backup.signals] == [
        ("diStart", SignalKind.DIGITAL_INPUT, "PN 0"),
        ("doGrip", SignalKind.DIGITAL_OUTPUT, "BOARD10 3"),
        ("giPart", SignalKind.GROUP_INPUT, None),
    ]


VERSIONS = {
    "S4C+": ("RobotWare Version: 4.0.0100", "RobotWare 4.0.0100", "S4C+"),
    "RW5": ("RobotWare Version: 5.15.0184", "RobotWare 5.15.0184", "IRC5"),
    "RW6": ("RobotWare Version: 6.14.00.01", "RobotWare 6.14.00.01", "IRC5"),
    "RW7": ("RobotControl Version: 7.19.0", "RobotControl 7.19.0", "OmniCore"),
}


@pytest.mark.parametrize("version", VERSIONS)
def test_versions(version: str, tmp_path: Path) -> None:
    written, said, controller = VERSIONS[version]
    modules = {"PROGMOD/MainModule.mod": MAIN, "SYSMOD/user.sys": USER}
    products = ["RobotOS Version: 2.1", "IRB 4600-40/2.55"]
    cab_tasks = ['-Name "T_ROB1" -Type "NORMAL" -MotionTask']
    folder = "TASK1"
    if version == "RW7":
        modules = {f"{name}x": text for name, text in modules.items()}
    if version == "S4C+":
        folder, cab_tasks = "TASK0", ['-Name "T_ROB1"']
    station = Station(
        version=written,
        products=products,
        tasks={folder: ("T_ROB1", modules)},
        cab_tasks=cab_tasks,
    )
    backup = opened(station, tmp_path)
    assert (backup.version, backup.controller) == (said, f"Cell7, {controller}")
    assert backup.tasks[0].robot == 0
    assert len(read(backup).moves) == 3
    assert not texts(backup)


@pytest.mark.parametrize("codec", ["latin-1", "utf-8", "utf-8-sig"])
@pytest.mark.parametrize("end", ["\r\n", "\n"])
def test_encodings(codec: str, end: str, tmp_path: Path) -> None:
    station = Station(end=end)
    root = station.write(tmp_path)
    path = root / "RAPID/TASK1/PROGMOD/MainModule.mod"
    path.write_bytes(MAIN.replace("PROC Main()", "PROC Main() ! für öl").encode(codec))
    for name in ("BACKINFO/backinfo.txt", "SYSPAR/MOC.cfg"):
        path = root / name
        path.write_bytes(path.read_bytes().decode("latin-1").encode(codec))
    backup = OPENER.open(root, root, find_robot)
    assert not texts(backup)
    assert backup.controller == "Cell7, IRC5"
    assert len(read(backup).moves) == 3


def test_the_program_is_driven_by_the_robot_of_the_backup(tmp_path: Path) -> None:
    backup = opened(Station(), tmp_path)
    robot = backup.robots[0].robot
    assert robot is not None
    run = Controller(ABB, robot).run(read(backup))
    assert 1.0 < run.duration < 20.0
    limits = robot.limits
    q = run.trajectory.q
    assert bool(np.all((q > limits.lower - 1e-9) & (q < limits.upper + 1e-9)))


def test_a_robot_on_a_track_beside_a_table(tmp_path: Path) -> None:
    moved = MAIN.replace(
        "[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];", "[0,0,0,0],[800,90,9E9,9E9,9E9,9E9]];"
    ).replace("[900,0,400]", "[1700,0,400]")
    station = Station(
        moc=on_track(), tasks={"TASK1": ("T_ROB1", {"PROGMOD/MainModule.mod": moved})}
    )
    backup = opened(station, tmp_path)
    assert not texts(backup)
    robot = backup.robots[0].robot
    assert robot is not None
    track, table = robot.external_axes
    assert (track.name, track.role, table.name, table.role) == (
        "TRACK_1",
        "track",
        "STN1",
        "table",
    )
    assert track.joint.velocity == pytest.approx(314.1 / 294.57)
    assert (track.joint.acceleration, track.joint.lower, track.joint.upper) == (2.38, -0.1, 5.9)
    assert table.joint.velocity == pytest.approx(2.0)
    assert table.joint.placement.position == (1.5, 0.0, 0.0)
    there = robot.flange_pose([0.0] * 6 + [0.8, 0.3])
    here = robot.flange_pose([0.0] * 8)
    assert np.allclose(np.subtract(there.position, here.position), (0.8, 0, 0))
    run = Controller(ABB, robot).run(read(backup))
    assert np.allclose(run.trajectory.q[-1, 6:], [0.8, np.pi / 2], atol=1e-6)


def test_several_robots(tmp_path: Path) -> None:
    backup = opened(multimove(), tmp_path)
    assert [robot.unit for robot in backup.robots] == ["ROB_1", "ROB_2"]
    first, second = (robot.robot for robot in backup.robots)
    assert first is not None and second is not None
    assert (first.name, second.name) == ("abb/irb4600-40-255", "abb/irb120-3-058")
    assert (first.base.position, second.base.position) == ((0.0, 1.2, 0.0), (0.0, -1.2, 0.0))
    assert [axis.name for axis in first.external_axes] == []
    assert [axis.name for axis in second.external_axes] == ["STN1"]
    by_name = {task.name: task for task in backup.tasks}
    assert {name: task.robot for name, task in by_name.items()} == {
        "T_ROB1": 0,
        "T_ROB2": 1,
        "T_WATCH": None,
        "PSC_CBC": None,
    }
    assert by_name["T_ROB2"].entry == "Start2"
    assert by_name["T_WATCH"].main is None
    assert all("RAPID/TASK0/SYSMOD/common.sys" in task.files for task in backup.tasks)
    assert backup.tools["tGripper"].tcp.position == (0.0125, 0.0, 0.18)
    assert backup.tools["T_ROB2/tGripper"].tcp.position == (0.0, 0.0, 0.09)
    assert len(read(backup, 0).moves) == len(read(backup, 1).moves) == 3
    assert not texts(backup)


def test_a_task_of_its_own_turns_a_positioner(tmp_path: Path) -> None:
    """The arm has no such axis then, though it is the only arm."""
    backup = opened(with_positioner(Station()), tmp_path)
    arm, table = backup.robots
    assert arm.robot is not None and table.robot is not None
    assert not arm.robot.external_axes and not table.robot.has_arm
    assert [axis.name for axis in table.robot.external_axes] == ["STN1"]
    assert [task.robot for task in backup.tasks] == [0, 1]
    turned = read(backup, 1).moves
    assert [move.target.external for move in turned] == [(0.0,), (pytest.approx(math.pi / 2),)]
    made = flyby.station(tmp_path)
    assert set(made.run.schedules) == {"T_ROB1", "T_POS1"} and not made.clearances
    assert any("T_POS1: its cell has no shape" in str(note) for note in made.notes)


def test_event_routines_and_add_ins_are_said(tmp_path: Path) -> None:
    station = Station(
        sys={
            "CAB_EXEC_HOOKS": (
                '-Routine "service" -Shelf "POWER_ON" -Task "T_ROB1"',
                '-Routine "Log" -Shelf "START"',
                '-Routine "ArcPowerOn" -Shelf "POWER_ON"',
            ),
            "CAB_TASK_MODULES": (
                '-File "RELEASE:/options/arc/arc.sys" -AllTask',
                '-File "BASE_ADDIN:/code/Weld.sys" -Task "T_ROB1"',
                '-File "HOME:/user.sys" -Task "T_ROB1"',
            ),
        }
    )
    backup = opened(station, tmp_path)
    said = texts(backup)
    assert len(said) == 2
    assert "Service, event routine (POWER_ON)" in said[0]
    assert "Weld.sys" in said[1] and "arc.sys" not in said[1] and "user.sys" not in said[1]
    assert backup.tasks[0].entries[-1].comment == "event routine (POWER_ON)"


def test_a_ceiling_robot(tmp_path: Path) -> None:
    turned = "-base_frame_pos_z 2.5 -base_frame_orient_u0 0 -base_frame_orient_u2 1"
    backup = opened(Station(moc=one_robot(f"{turned} -gravity_beta 3.141593")), tmp_path)
    robot = backup.robots[0].robot
    assert robot is not None
    assert robot.base.quaternion == (0.0, 0.0, 1.0, 0.0)
    assert robot.gravity == find_robot("abb/irb4600-40-255").gravity
    assert not texts(backup)


def test_gravity_that_contradicts_the_base_is_said(tmp_path: Path) -> None:
    backup = opened(Station(moc=one_robot("-gravity_beta 3.141593")), tmp_path)
    robot = backup.robots[0].robot
    assert robot is not None
    assert robot.gravity == pytest.approx((0.0, 0.0, 9.80665), abs=1e-4)
    (note,) = texts(backup)
    assert "180° off a level floor" in note


def test_how_fast_the_arm_is_is_what_its_backup_states(tmp_path: Path) -> None:
    asking = MAIN.replace("PROC Main()", "VAR speeddata vShare:=v100;\n  PROC Main()", 1).replace(
        "    Pick;\n",
        "    vShare.v_tcp:=MaxRobSpeed()/2;\n    vShare.v_ori:=MaxRobReorientSpeed();\n"
        "    MoveL p10, vShare, fine, tGripper\\WObj:=wTable;\n",
        1,
    )
    tasks = {"TASK1": ("T_ROB1", {"PROGMOD/MainModule.mod": asking, "SYSMOD/user.sys": USER})}
    own = "-linear_max_speed 7.2 "
    moc = one_robot()
    moc["MOTION_PLANNER"] = [
        moc["MOTION_PLANNER"][0].replace(own, f"{own}-reorient_max_speed 900 ")
    ]
    root = Station(tasks=tasks, moc=moc).write(tmp_path)

    def share(**options: Any) -> tuple[float, float]:
        moves = flyby.read(root, **options).moves
        speed = moves[-1].speed
        return round(speed.tcp or 0.0, 6), round(math.degrees(speed.reorientation or 0.0), 3)

    assert share() == (3.6, 900.0)
    assert not any("MaxRob" in str(one) for one in flyby.read(root).questions)
    assert share(answers=Answers({"maxrobspeed()": 6000.0})) == (3.0, 900.0)
    assert share(robot="abb/irb4600-60-205") == (5.0, 500.0)


def test_of_several_planners_that_of_the_arm_is_asked() -> None:
    planners = [
        '-name "p1" -linear_max_speed 6 -use_motion_sup "rob1"',
        '-name "p2" -linear_max_speed 7 -use_motion_sup "rob2"',
    ]
    moc = parse_parameters(cfg("MOC", {"MOTION_PLANNER": planners}), "MOC.cfg")
    assert stated_speeds(moc, "ROB_2") == {"maxrobspeed()": 7000.0}
    assert stated_speeds(moc, "ROB_3") == {}


def test_signals_of_the_backup_are_called_so(tmp_path: Path) -> None:
    main = MAIN.replace(
        "    Pick;\n", "    IF diStart=1 AND giPart>2 Pick;\n    IF diGone=1 Pick;\n"
    )
    tasks = {"TASK1": ("T_ROB1", {"PROGMOD/MainModule.mod": main, "SYSMOD/user.sys": USER})}
    notes = [str(note) for note in flyby.read(Station(tasks=tasks).write(tmp_path)).notes]
    assert any("depends on 'diStart', a digital input:" in note for note in notes)
    assert any("'diGone', which is not declared in what is at hand (a signal?)" in n for n in notes)
