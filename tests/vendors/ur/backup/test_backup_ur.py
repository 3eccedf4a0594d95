"""Folders of UR controllers: tasks, the arm itself, tools, frames, signals."""

from __future__ import annotations

import json
import math
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.backup.backup import Backup, SignalKind
from flyby.core.errors import FlybyError, InputError, OptionError
from flyby.core.registry import find_robot
from flyby.drawing.geometry import tcp_speed
from flyby.vendors.ur.backup.opener import OPENER
from flyby.vendors.ur.calibration import apart, calibrated, nominal_table, type_of
from flyby.vendors.ur.urp.kinematics import DhTable

from ..conftest import HOME, TCP, UR5E, Build, listed

A, B = (0.1, -1.4, 1.6, -1.8, -1.5, 0.2), (0.3, -1.2, 1.5, -1.9, -1.6, 0.1)
SAFETY = """<SafetySettings>
[SafetyLimits Normal Values]
maxTcpSpeed = 1.5

[SafetyLimits Normal Joints]
maxJointSpeed = [1.0, 3.0, 3.3, 3.3, 3.3, 9.0]
minJointPosition = [0.0, 6.230825, 6.230825, 6.230825, 6.230825, 6.230825]
maxJointPosition = [1.0, 0.05236, 0.05236, 0.05236, 0.05236, 0.05236]
minJointRevolutions = [-1, -2, -2, -2, -2, -2]
maxJointRevolutions = [0, 1, 1, 1, 1, 1]
</SafetySettings>"""


def opened(folder: Path) -> Backup:
    return flyby.open_backup(folder)


def move(build: Build) -> str:
    return build.move(build.fixed("A", A), build.fixed("B", B))


def test_a_folder_is_read_without_a_robot(build: Build, tmp_path: Path) -> None:
    names = (
        '<IOs><DigitalOutputNames value=", valve, , "/><AnalogInputNames value="force, "/></IOs>'
    )
    home = f'<SafeHomeSettings enabled="true" position="{listed(HOME)}"/>'
    payload = (
        '<PayloadSettings><Payload name="P" mass="1.5" defaultPayload="true" '
        'centerOfGravity="0, 0, 0.05" inertiaParameters="0.01, 0.01, 0.01, 0, 0, 0"/>'
        "</PayloadSettings>"
    )
    feature = (
        '<Features><GeomPlaneNode><GeomPlaneNode name="Bench" isVariable="true"><firstPoint>'
        '<GeomPoseNode name="hidden" hiddenSubFeature="true"><toolPosition value="0.4, 0, 0.1"/>'
        '<toolAxisAngle value="0, 0, 0"/></GeomPoseNode></firstPoint></GeomPlaneNode>'
        "</GeomPlaneNode></Features>"
    )
    folder = tmp_path / "work" / "programs"
    build.packed(
        folder / "default.installation", build.installation(names, home, payload, feature, SAFETY)
    )
    build.packed(folder / "pick.urp", build.program(move(build)))
    build.packed(folder / "lamp.urp", build.program(build.node("Halt")))
    for name in ("pick.script", "pick.txt", "default.variables", "pick.urp.old0", "README.md"):
        (folder / name).write_text("anything")
    backup = opened(tmp_path / "work")
    assert backup.root == folder and backup.version == "5.12.0"
    assert [(task.name, task.robot, task.main, task.entry) for task in backup.tasks] == [
        ("lamp", None, "lamp.urp", None),
        ("pick", 0, "pick.urp", None),
    ]
    (known,) = backup.robots
    assert (known.unit, known.written) == ("20205500001", "UR5e 20205500001")
    assert known.robot is not None and known.robot.name == "ur/ur5e"
    first = known.robot.joints[0]
    assert (first.lower, first.upper, first.velocity) == (-math.tau, 1.0, 1.0)
    assert known.robot.joints[5].velocity == find_robot("ur/ur5e").joints[5].velocity
    assert known.robot.joints[1].upper == pytest.approx(math.tau + 0.05236)
    tool = backup.tools["gripper"]
    assert tool.tcp.position == TCP[:3] and tool.load is not None and tool.load.mass == 1.5
    assert backup.frames["Bench"].pose.position == (0.4, 0.0, 0.1)
    assert backup.homes["SafeHome"].joints == HOME
    assert [(one.name, one.kind, one.address) for one in backup.signals] == [
        ("valve", SignalKind.DIGITAL_OUTPUT, "digital_out[1]"),
        ("force", SignalKind.ANALOG_INPUT, "analog_in[0]"),
    ]
    assert not backup.notes
    assert backup.motion["limit.tcp_speed"][0] == 1.5
    program = flyby.read(tmp_path / "work")
    assert len(program.moves) == 2 and program.setup is not None
    assert program.setup.robot == known.robot


def test_a_greatest_speed_of_the_tcp_is_held_where_it_is_one(build: Build, tmp_path: Path) -> None:
    slow = SAFETY.replace("maxTcpSpeed = 1.5", "maxTcpSpeed = 0.1")
    build.packed(tmp_path / "default.installation", build.installation(slow))
    build.packed(tmp_path / "a.urp", build.program(move(build)))
    run = flyby.emulate(flyby.read(tmp_path, task="a"))
    assert float(tcp_speed(run).max()) == pytest.approx(0.1, rel=1e-3)
    build.packed(tmp_path / "fast.installation", build.installation(SAFETY))
    build.packed(tmp_path / "b.urp", build.program(move(build), installation="fast"))
    backup = opened(tmp_path)
    assert not backup.motion
    assert any("installations say 0.1 m/s and 1.5 m/s" in note.message for note in backup.notes)


def test_one_file_is_opened_alone_with_its_installation(build: Build, tmp_path: Path) -> None:
    build.packed(tmp_path / "default.installation", build.installation())
    build.packed(tmp_path / "a.urp", build.program(move(build)))
    build.packed(tmp_path / "b.urp", build.program(move(build)))
    assert [task.name for task in opened(tmp_path / "a.urp").tasks] == ["a"]
    assert "gripper" in opened(tmp_path / "a.urp").tools
    assert opened(tmp_path / "default.installation").tasks == ()
    with pytest.raises(OptionError, match="which task"):
        flyby.read(tmp_path)
    assert len(flyby.read(tmp_path, task="b").moves) == 2
    # What is asked for is found by its file's name, too, which no routine may have.
    build.packed(tmp_path / "Pick & Place 2.urp", build.program(move(build)))
    assert len(flyby.read(tmp_path, entry="pick & place 2").moves) == 2
    with pytest.raises(OptionError, match=r"none of .* has a routine Gone 1\. Choose with entry"):
        flyby.read(tmp_path, entry="Gone 1")


@pytest.mark.parametrize("robot", [None, "ur/ur5e"])
@pytest.mark.parametrize("place", ["default.installation", "../cell.installation"])
def test_the_copy_of_one_file_has_what_it_is_read_with(
    build: Build, tmp_path: Path, place: str, robot: str | None
) -> None:
    folder = tmp_path / "programs"
    beside = build.packed(folder / place, build.installation())
    named = place.removesuffix(".installation")
    build.packed(folder / "job.urp", build.program(move(build), installation=named))
    build.packed(folder / "other.urp", build.program(move(build)))
    program = flyby.read(folder / "job.urp", robot=robot)
    slower = [replace(one, speed=replace(one.speed, joint=0.5)) for one in program.moves]
    (made,) = flyby.patch(program.with_moves(tuple(slower)), out=tmp_path / "copy")
    assert made == tmp_path / "copy/job.urp"
    names = sorted(one.name for one in (tmp_path / "copy").iterdir())
    assert names == sorted([Path(place).name, "job.urp"])
    assert (tmp_path / "copy" / Path(place).name).read_bytes() == beside.read_bytes()
    again = flyby.read(tmp_path / "copy" / "job.urp")
    assert again.moves[0].tool.tcp == program.moves[0].tool.tcp
    assert again.moves[0].speed.joint == 0.5


def test_an_archive_is_the_folder_in_it(build: Build, tmp_path: Path) -> None:
    path = build.packed(tmp_path / "job.urp", build.program(move(build)))
    with zipfile.ZipFile(tmp_path / "robot.zip", "w") as archive:
        archive.write(path, "usb/programs/job.urp")
    assert [task.name for task in opened(tmp_path / "robot.zip").tasks] == ["job"]


def test_a_program_names_its_installation(build: Build, tmp_path: Path) -> None:
    for name, z in (("left", 0.1), ("right", 0.3)):
        tcp = f'<tcp name="gripper" offset="0, 0, {z}, 0, 0, 0"/>'
        build.packed(tmp_path / f"{name}.installation", build.installation(tcps=tcp))
        build.packed(tmp_path / f"{name}.urp", build.program(move(build), installation=name))
    build.packed(tmp_path / "sub/far.urp", build.program(move(build), installation="../right"))
    build.packed(tmp_path / "lost.urp", build.program(move(build), installation="gone"))
    backup = opened(tmp_path)
    assert len(backup.robots) == 1
    told = " ".join(str(note) for note in backup.notes)
    assert "are those of right.installation" in told and "gone.installation" in told
    for task, z in (("left", 0.1), ("right", 0.3), ("far", 0.3), ("lost", 0.12)):
        program = flyby.read(tmp_path, task=task)
        assert program.moves[0].tool.tcp.position[2] == z


small = st.lists(st.floats(-1.0, 1.0), min_size=24, max_size=24).map(
    lambda values: np.reshape(values, (6, 4)) * (5e-4, 2e-4, 2e-4, 5e-4)
)
TYPES = ["ur3", "ur5", "ur10", "ur3e", "ur5e", "ur10e", "ur20", "ur30", "ur15", "ur18", "ur8long"]


@settings(max_examples=15, deadline=None)
@given(st.sampled_from(TYPES), small)
def test_an_arm_is_known_by_where_its_flange_is(name: str, deltas: np.ndarray) -> None:
    nominal = find_robot(f"ur/{name}")
    rows = np.array(nominal_table(nominal).rows) + deltas
    table = DhTable(tuple((a, b, c, d) for a, b, c, d in rows.tolist()), "LINEARIZED")
    near = type_of(table, [find_robot(f"ur/{one}") for one in TYPES])
    assert [one.name for one in near] == [nominal.name]
    arm = calibrated(nominal, table, "x.urp")
    assert apart(arm, table) < 1e-9
    q = np.zeros(6)
    for one, other in zip(arm.joints, nominal.joints, strict=True):
        assert math.dist(one.placement.position, other.placement.position) < 0.01
    assert math.dist(arm.flange_pose(q).position, nominal.flange_pose(q).position) < 0.01


def test_frames_stay_at_the_arm_where_the_table_has_them_far_off() -> None:
    """Axes 3 and 4 along their own lines by hundreds of metres, and turned: the same arm."""
    nominal = find_robot("ur/ur5e")
    rows = [list(row) for row in nominal_table(nominal).rows]
    rows[1][2], rows[2][2], rows[3][2] = 400.0, -1000.0, rows[3][2] + 600.0
    arm = calibrated(nominal, DhTable(tuple(map(tuple, rows)), "LINEARIZED"), "x.urp")
    for one, other in zip(arm.joints, nominal.joints, strict=True):
        assert math.dist(one.placement.position, other.placement.position) < 1e-9


@pytest.mark.parametrize(
    ("serial", "arm", "told"),
    [
        ("20205500001", "ur/ur5e", None),
        ("", "ur/ur5e", "ur/ur7e has the same kinematics"),
        ("20205200001", "ur/ur5e", "its serial number 20205200001 is one of a UR10E"),
        ("20205599999", "ur/ur5e", None),
        ("nonsense", "ur/ur5e", "ur/ur7e has the same kinematics"),
    ],
)
def test_the_serial_number_is_a_second_witness(
    build: Build, tmp_path: Path, serial: str, arm: str, told: str | None
) -> None:
    build.packed(tmp_path / "default.installation", build.installation())
    path = build.packed(tmp_path / "job.urp", build.program(move(build), serial=serial))
    backup = opened(path)
    assert backup.robots[0].robot is not None and backup.robots[0].robot.name == arm
    assert (told is None) == (not backup.notes)
    assert told is None or told in str(backup.notes[0])


def test_an_arm_of_no_known_type_is_told(build: Build, tmp_path: Path) -> None:
    rows = [list(row) for row in UR5E]
    rows[1][1] -= 0.04
    build.packed(tmp_path / "default.installation", build.installation())
    path = build.packed(tmp_path / "job.urp", build.program(move(build), rows=rows))
    known = opened(path).robots[0]
    assert known.robot is None and "those of no arm that is known" in known.lacks[0]
    with pytest.raises(OptionError, match=r"no arm that is known.*robot"):
        flyby.read(path)
    assert len(flyby.read(path, robot="ur/ur5e").moves) == 2


def test_without_kinematics_the_serial_number_decides(build: Build, tmp_path: Path) -> None:
    zeros = [(0.0, 0.0, 0.0, 0.0)] * 6
    text = build.program(move(build), rows=zeros, serial="20195300001")
    known = opened(build.packed(tmp_path / "job.urp", text)).robots[0]
    assert known.robot is not None and known.robot.name == "ur/ur3e"
    text = build.program(move(build), rows=zeros, serial="")
    known = opened(build.packed(tmp_path / "none.urp", text)).robots[0]
    assert known.robot is None and known.lacks == (
        "nothing says which arm it is: name one, robot=NAME",
    )


def test_programs_of_two_arms_are_two_robots(build: Build, tmp_path: Path) -> None:
    ur10e = nominal_table(find_robot("ur/ur10e")).rows
    build.packed(tmp_path / "default.installation", build.installation())
    build.packed(tmp_path / "a.urp", build.program(move(build)))
    text = build.program(move(build), rows=ur10e, serial="20205200001")
    build.packed(tmp_path / "b.urp", text)
    (tmp_path / "c.urp").write_text("def c():\n  movej([0, -1, 1, 0, 1, 0])\nend\n")
    backup = opened(tmp_path)
    assert [one.robot and one.robot.name for one in backup.robots] == ["ur/ur5e", "ur/ur10e"]
    assert [task.robot for task in backup.tasks] == [0, 1, 0]


def test_the_mounting_turns_the_base(build: Build, tmp_path: Path) -> None:
    """On a wall up is the base's axis y: ``set_gravity([0, 9.82, 0])`` ("Script Directory")."""
    tilted = (
        '<Features><CameraView><worldTransform class="WorldTransform"><WorldtoMarshal '
        f'baseAngle="0.0" tiltAngle="{math.pi / 2}"/></worldTransform></CameraView></Features>'
    )
    build.packed(tmp_path / "default.installation", build.installation(tilted))
    backup = opened(build.packed(tmp_path / "job.urp", build.program(move(build))))
    robot = backup.robots[0].robot
    assert robot is not None
    up = robot.base.matrix()[:3, :3].T @ (0.0, 0.0, 1.0)
    np.testing.assert_allclose(up, (0.0, 1.0, 0.0), atol=1e-12)


def test_one_of_several_scripts_is_chosen_beside_a_robot_that_is_named(tmp_path: Path) -> None:
    for name, count in (("pick", 1), ("put", 2)):
        moves = f"  movej({list(A)})\n" * count
        (tmp_path / f"{name}.script").write_text(f"def {name}():\n{moves}end\n")
    assert len(flyby.read(tmp_path, robot="ur/ur5e", entry="put").moves) == 2
    with pytest.raises(InputError, match=r"name a program file in it: pick\.script, put\.script"):
        flyby.read(tmp_path, robot="ur/ur5e")


def test_scripts_beside_trees_are_not_left_out_silently(build: Build, tmp_path: Path) -> None:
    runs = (
        '<Script type="File"><cachedContents/><file resolves-to="file">grip.script</file></Script>'
    )
    build.packed(tmp_path / "job.urp", build.program(move(build) + runs))
    for name in ("job", "grip", "main"):
        (tmp_path / f"{name}.script").write_text(f"def {name}():\n  movej({list(A)})\nend\n")
    backup = opened(tmp_path)
    assert [task.name for task in backup.tasks] == ["job"]
    (note,) = [str(note) for note in backup.notes if "left out" in str(note)]
    assert note.startswith("main.script: left out, as no program is called so")


def test_the_script_beside_stands_in_for_a_tree_that_cannot_be_read(
    build: Build, tmp_path: Path
) -> None:
    build.packed(tmp_path / "good.urp", build.program(move(build)))
    (tmp_path / "job.urp").write_bytes(bytes(range(64)) * 4)
    (tmp_path / "job.script").write_text(f"def job():\n  movej({list(A)})\nend\n")
    backup = opened(tmp_path)
    assert [task.main for task in backup.tasks] == ["good.urp", "job.script"]
    assert any("job.script beside it is read in its place" in str(note) for note in backup.notes)
    assert len(flyby.read(tmp_path, entry="job").moves) == 1
    assert [task.name for task in opened(tmp_path / "job.urp").tasks] == ["job"]


def test_damaged_files_are_passed_over(build: Build, tmp_path: Path) -> None:
    build.packed(tmp_path / "default.installation", build.installation())
    good = build.packed(tmp_path / "good.urp", build.program(move(build)))
    (tmp_path / "cut.urp").write_bytes(good.read_bytes()[:200])
    (tmp_path / "old.urp").write_text("<gui.program.ProgramRootNode/>")
    (tmp_path / "other.installation").write_text("<Installation")
    backup = opened(tmp_path)
    assert [task.name for task in backup.tasks] == ["good"]
    told = [str(note) for note in backup.notes]
    assert [note.partition(":")[0] for note in told[:3]] == ["passed over"] * 3
    assert not any(str(tmp_path) in note for note in told)
    with pytest.raises(InputError, match="damaged or cut short"):
        opened(tmp_path / "cut.urp")


@pytest.mark.parametrize(
    ("names", "root"),
    [
        (["a.script", "b.txt"], None),
        (["x/a.urp", "b.script"], "x"),
        (["x/y/a.urp", "x/default.INSTALLATION"], "x"),
        (["a.urpx"], ""),
        (["a.urp.old0", "default.variables"], None),
    ],
)
def test_programs_and_installations_mark_a_backup(names: list[str], root: str | None) -> None:
    assert OPENER.root_in(names) == root


def urpx(script: str) -> dict[str, object]:
    def value(number: float, unit: str) -> dict[str, object]:
        return {"value": number, "unit": unit}

    tcp = {"id": "t", "name": "Gripper", **{k: value(0, "rad") for k in ("rx", "ry", "rz")}}
    tcp |= {"x": value(0, "m"), "y": value(0, "m"), "z": value(120, "mm")}
    effector = {
        "id": "e",
        "name": "Hand",
        "payload": {"weight": value(2, "kg")},
        "cog": {"cx": value(0, "m"), "cy": value(0, "m"), "cz": value(5, "cm")},
        "tcps": [tcp],
    }
    frame = {"name": "bench", "parent": "base", "pose": {"position": [0.4, 0, 0.1]}}
    frame["pose"]["orientation"] = [0, 0, 0]  # type: ignore[index]
    contributions = {
        "ur-mounting": {
            "type": "ur-mounting",
            "mounting": {"baseAngle": value(0, "deg"), "tiltAngle": value(180, "deg")},
        },
        "ur-frames": {"type": "ur-frames", "framesList": [{"name": "base"}, frame]},
        "ur-end-effector": {
            "type": "ur-end-effector",
            "endEffectors": [effector],
            "defaultTcp": {"endEffectorId": "e", "tcpId": "t"},
        },
    }
    application = {"applicationContent": {"applicationContributions": contributions}}
    application["urscript"] = {"script": "set_tcp(p[0, 0, 0.12, 0, 0, 0])"}  # type: ignore[assignment]
    return {"application": application, "program": {"urscript": {"script": script}}}


def test_programs_of_polyscope_x(tmp_path: Path) -> None:
    path = tmp_path / "job.urpx"
    path.write_text(json.dumps(urpx("movej([0, -1, 1, 0, 1, 0])\nmovej([0, -1, 1, 0, 1, 1])")))
    backup = opened(path)
    assert backup.tools["Gripper"].tcp.position == (0.0, 0.0, 0.12)
    load = backup.tools["Gripper"].load
    assert load is not None and (load.mass, load.centre) == (2.0, (0.0, 0.0, 0.05))
    assert backup.frames["bench"].pose.position == (0.4, 0.0, 0.1)
    assert backup.robots[0].robot is None
    program = flyby.read(path, robot="ur/ur15")
    assert len(program.moves) == 2 and program.moves[0].tool.tcp.position == (0.0, 0.0, 0.12)
    for text in ("{", "[]", "{}", '{"program": {}}', "[" * 100_000):
        path.write_text(text)
        with pytest.raises(FlybyError):
            opened(path)


def test_programs_are_entries_with_their_number_of_moves(build: Build, tmp_path: Path) -> None:
    hidden = build.node("SuppressedNode", build.move(build.fixed("C", A)))
    unknown = build.node("Pallet", build.move(build.fixed("D", A)), name="Pallet_1")
    cap = build.node("Contributed", strategyURCapName="Gripper", strategyProgramNodeType="Grip")
    build.packed(tmp_path / "pick 1.urp", build.program(move(build), hidden, unknown, cap))
    build.packed(tmp_path / "place.urp", build.program(move(build), build.script("sync()")))
    build.packed(tmp_path / "io.urp", build.program(build.script("sync()")))
    backup = opened(tmp_path)
    counted = {entry.name: entry.moves for task in backup.tasks for entry in task.entries}
    assert counted == {"io": None, "pick_1": 2, "place": 2}
    told = "pick 1.urp: nodes of which nothing is carried out: Pallet (1), URCap Gripper (1)"
    assert any(note.message.startswith(f"{told}; their code is in") for note in backup.notes)
    # The entry tells which of several programs is meant.
    assert len(flyby.read(tmp_path, entry="pick_1").moves) == 2


def test_a_folder_of_scripts_is_one_of_programs(tmp_path: Path) -> None:
    lines = "  movej([0, -1, 1, 0, 1, 0])\n  movel(p[-0.4, -0.2, 0.3, 0, 3.1, 0])\n"
    for name in ("a", "b"):
        (tmp_path / f"{name}.script").write_text(f"def {name}():\n{lines}end\n")
    (tmp_path / "README.md").write_text("x")
    backup = opened(tmp_path)
    assert [task.name for task in backup.tasks] == ["a", "b"]
    assert [entry.moves for task in backup.tasks for entry in task.entries] == [2, 2]
    assert len(flyby.read(tmp_path, robot="ur/ur5e", task="b").moves) == 2
    # Beside programs of another vendor scripts mark nothing.
    (tmp_path / "main.mod").write_text("MODULE m\nENDMODULE\n")
    with pytest.raises(InputError, match="programs of abb and ur are in this folder"):
        opened(tmp_path)


def test_programs_of_before_polyscope_3_are_read_by_the_script_beside(
    build: Build, tmp_path: Path
) -> None:
    old = build.packed(tmp_path / "old.urp", "<gui.program.ProgramRootNode/>")
    with pytest.raises(InputError, match=r"before 3\.0"):
        opened(tmp_path)
    (tmp_path / "old.script").write_text("def old():\n  movej([0, -1, 1, 0, 1, 0])\nend\n")
    backup = opened(tmp_path)
    assert [task.main for task in backup.tasks] == ["old.script"]
    assert any(f"{old.name}: is of before PolyScope 3.0" in n.message for n in backup.notes)


@settings(max_examples=40, deadline=None)
@given(st.data())
def test_damaged_installations_do_no_harm(
    build: Build, tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    folder = tmp_path_factory.getbasetemp() / "harmed"
    text = build.installation(SAFETY).encode()
    start = data.draw(st.integers(0, len(text)))
    length = data.draw(st.integers(0, 60))
    harm = data.draw(st.binary(max_size=20))
    build.packed(folder / "job.urp", build.program(move(build)))
    (folder / "default.installation").write_bytes(text[:start] + harm + text[start + length :])
    backup = opened(folder)
    assert [task.name for task in backup.tasks] == ["job"]
    assert len(flyby.read(folder).moves) == 2


@pytest.mark.parametrize(
    ("data", "why"),
    [(b"", "is empty"), (bytes(range(64)) * 4, "is neither a program's tree nor a script")],
)
def test_files_that_hold_no_program_are_named(
    build: Build, tmp_path: Path, data: bytes, why: str
) -> None:
    (tmp_path / "job.urp").write_bytes(data)
    with pytest.raises(InputError, match=why):
        opened(tmp_path)
    build.packed(tmp_path / "other.urp", build.program(move(build)))
    backup = opened(tmp_path)
    assert any(f"job.urp: {why}" in note.message for note in backup.notes)
    assert [task.name for task in backup.tasks] == ["other"]
