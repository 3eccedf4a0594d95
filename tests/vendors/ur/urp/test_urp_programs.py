"""Program trees of PolyScope are driven as the scripts beside them are."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.errors import FlybyError, InputError, SourceError
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.target import PoseTarget
from flyby.core.source.reading import ReadOptions
from flyby.vendors.ur.run.reader import read, read_file
from flyby.vendors.ur.urp.kinematics import DhTable

from ..conftest import HOME, TCP, UR5E, Build

A, B, C = (0.1, -1.4, 1.6, -1.8, -1.5, 0.2), (0.3, -1.2, 1.5, -1.9, -1.6, 0.1), HOME
D = (0.2, -1.3, 1.5, -1.8, -1.5, 0.3)
NAMES = "Waypoint_1", "Über 2", "3", "end", "p 'q'"


def opened(build: Build, folder: Path, *steps: str, parts: str = "", **how: object) -> Program:
    build.packed(folder / "default.installation", build.installation(parts))
    return read_file(build.packed(folder / "job.urp", build.program(*steps, **how)))  # type: ignore[arg-type]


def test_a_program_is_driven_by_the_command(build: Build, tmp_path: Path) -> None:
    step = build.move(build.fixed("Waypoint_1", A), build.fixed("Waypoint_2", B))
    build.packed(tmp_path / "default.installation", build.installation())
    path = build.packed(tmp_path / "job.urp", build.program(step))
    program = flyby.read(path, robot="ur/ur5e")
    assert [type(move) for move in program.moves] == [MoveJ, MoveJ]
    run = flyby.emulate(program)
    flange = DhTable(UR5E).flange(B)
    reached = np.array(run.trajectory.q[-1])
    assert np.abs(reached - B).max() < 1e-6
    assert program.moves[1].origin is not None
    assert program.moves[1].origin.statement.file == str(path)
    assert math.dist(flange.position, run.robot.flange_pose(reached).position) < 1e-6


def test_waypoints_are_where_their_own_table_puts_their_own_tcp(
    build: Build, tmp_path: Path
) -> None:
    """An arm with 2 mm more in a, and a turned tool."""
    rows = [list(row) for row in UR5E]
    rows[1][1] -= 0.002
    tcp = (0.01, 0.02, 0.2, 0.3, -0.4, 0.5)
    step = build.move(build.fixed("W", A, tcp=tcp, rows=rows), kind="MoveL", speed=0.2)
    (move,) = opened(build, tmp_path, step).moves
    flange = DhTable(tuple(map(tuple, rows))).flange(A)
    script = "def f():\n  movel(pose_trans({}, {}), v=0.2, a=1.4)\nend"
    text = script.format(*(f"p{list(pose)}" for pose in (_six(flange), tcp)))
    (same,) = read(text, "f.script").moves
    assert isinstance(move.target, PoseTarget) and isinstance(same.target, PoseTarget)
    assert math.dist(move.target.pose.position, same.target.pose.position) < 1e-12
    between = np.dot(move.target.pose.quaternion, same.target.pose.quaternion)
    assert abs(abs(between) - 1) < 1e-12


def _six(pose: object) -> tuple[float, ...]:
    from flyby.vendors.ur.values.poses import value_of

    return tuple(value_of(pose))  # type: ignore[arg-type]


joints = st.tuples(
    *(
        st.floats(low, high)
        for low, high in ((-2, 2), (-2, -0.8), (0.6, 2), (-2, -1), (-2, -1), (-2, 2))
    )
)
speeds = st.floats(0.01, 1.0).map(lambda value: round(value, 4))
steps = st.tuples(
    st.sampled_from(["MoveJ", "MoveL", "MoveP"]),
    speeds,
    speeds,
    st.booleans(),
    st.lists(
        st.tuples(st.sampled_from(NAMES), joints, st.sampled_from([0.0, 0.01]), st.booleans()),
        min_size=1,
        max_size=3,
    ),
)


@settings(max_examples=40, deadline=None)
@given(st.lists(steps, min_size=1, max_size=4))
def test_a_tree_of_moves_is_the_script_of_it(build: Build, moves: list) -> None:  # type: ignore[type-arg]
    table = DhTable(UR5E)
    from flyby.core.spatial.pose import Pose

    nodes, lines = [], [f"set_tcp(p{list(TCP)})"]
    for kind, speed, acceleration, cartesian, waypoints in moves:
        inside = []
        for index, (name, q, radius, timed) in enumerate(waypoints):
            own = f'nextMotionTime="{3.5}"' if timed else ""
            if kind != "MoveP" and radius:
                own += f' blendRadius="{radius}"'
            inside.append(build.fixed(name, q, own))
            pose = f"p{list(_six(table.flange(q) @ Pose(TCP[:3], (1.0, 0.0, 0.0, 0.0))))}"
            target = pose if kind != "MoveJ" else f"get_inverse_kin({pose}, qnear={list(q)})"
            target = target if kind != "MoveJ" or cartesian else f"{list(q)}"
            arguments = "t=3.5" if timed else f"a={acceleration}, v={speed}"
            if kind == "MoveP":
                arguments += f", r={0.005 if index < len(waypoints) - 1 else 0}"
            elif radius:
                arguments += f", r={radius}"
            if kind == "MoveP" and timed:
                arguments = arguments.replace("t=3.5", f"a={acceleration}, v={speed}")
            lines.append(f"{kind.lower()}({target}, {arguments})")
        sort = "CartesianPose" if cartesian else "JointAngles"
        attributes = f'blendRadius="0.005" useActiveTCP="true" positionType="{sort}"'
        nodes.append(
            build.move(
                *inside, kind=kind, speed=speed, acceleration=acceleration, attributes=attributes
            )
        )
    tree = read(build.program(*nodes), "tree.urp")
    script = read("\n".join(["def tree():", *lines, "end"]), "tree.script")
    assert len(tree.moves) == len(script.moves)
    for one, other in zip(tree.moves, script.moves, strict=True):
        assert type(one) is type(other)
        assert (one.speed, one.zone) == (other.speed, other.zone)
        assert one.tool.tcp == other.tool.tcp
        assert _shown(one.target) == _shown(other.target)


def _shown(target: object) -> object:
    if isinstance(target, PoseTarget):
        return target.pose, target.configuration
    return getattr(target, "joints", None)


def test_what_is_suppressed_does_not_run(build: Build, tmp_path: Path) -> None:
    off = f"<SuppressedNode>{build.fixed('B', B, tag='suppressedNode')}</SuppressedNode>"
    all_off = build.node(
        "SuppressedNode",
        inside=f'<suppressedNode class="Move" motionType="MoveJ"><children>{build.fixed("C", C)}'
        "</children></suppressedNode>",
    )
    program = opened(build, tmp_path, build.move(build.fixed("A", A), off), all_off)
    assert [_name(move) for move in program.moves] == ["A_p"]
    assert not program.notes


def _name(move: MoveJ | MoveL | MoveC) -> str | None:
    return move.target.name


def test_references_lead_to_what_they_name(build: Build, tmp_path: Path) -> None:
    """``[n]`` counts from 1 among elements of the same tag."""
    variable = '<Waypoint type="Variable" name="V"><variable reference="{}"/></Waypoint>'
    again = '<Waypoint reference="../../../Move/children/Waypoint[2]"/>'
    program = opened(
        build,
        tmp_path,
        build.assignment("one", "p[-0.4, -0.2, 0.3, 2.3, 2.1, 0]"),
        build.assignment("two", "p[-0.4, -0.2, 0.4, 2.3, 2.1, 0]"),
        build.move(build.fixed("A", A), build.fixed("B", B)),
        build.move(variable.format("../../../../Assignment[2]/variable"), again, kind="MoveL"),
        build.move(variable.format("../../../../Assignment[7]/variable"), kind="MoveL"),
    )
    first, second = program.moves[2:]
    assert isinstance(first.target, PoseTarget) and first.target.pose.position[2] == 0.4
    assert _name(second) == "B_p"
    (note,) = program.notes
    assert "Robot Program > MoveL" in note.message and "no variable was chosen" in note.message


def test_a_reference_to_itself_ends(build: Build) -> None:
    ring = build.move('<Waypoint reference="../Waypoint"/>', build.fixed("A", A))
    assert len(read(build.program(ring), "ring.urp").moves) == 1


def test_programs_of_version_3_3_hold_joints(build: Build, tmp_path: Path) -> None:
    where = (
        f'<Waypoint type="Fixed" name="W"><position joints="{", ".join(map(str, A))}"/></Waypoint>'
    )
    (move,) = opened(build, tmp_path, build.move(where, attributes=""), saved_in="3.3.4").moves
    assert move.target.joints == A  # type: ignore[union-attr]


def test_the_main_program_goes_round(build: Build, tmp_path: Path) -> None:
    steps = build.move(build.fixed("A", A)), build.move(build.fixed("B", B))
    before = build.move(build.fixed("C", C))
    program = opened(build, tmp_path, *steps, once=False, before=before)
    assert [_name(move) for move in program.moves] == ["C_p", "A_p", "B_p"]
    assert program.cycle is not None or any("one pass" in note.message for note in program.notes)


def test_an_installation_says_tcp_payload_and_features(build: Build, tmp_path: Path) -> None:
    feature = (
        '<Features><GeomPoseNode><GeomPoseNode name="Table" isVariable="{}"><toolPosition '
        'value="0.1, 0.2, 0.3"/><toolAxisAngle value="0.0, 0.0, 0.0"/></GeomPoseNode>'
        "</GeomPoseNode></Features>"
    )
    payload = (
        '<PayloadSettings><Payload name="P" mass="1.5" defaultPayload="true" '
        'centerOfGravity="0.0, 0.0, 0.05" inertiaParameters="0.01, 0.01, 0.01, 0, 0, 0"/>'
        "</PayloadSettings>"
    )
    move = build.move(
        '<Waypoint type="Variable" name="V"><variable name="here"/></Waypoint>',
        kind="MoveL",
        feature='<feature class="GeomFeatureReference" referencedName="Table"/>',
    )
    for variable in ("true", "false"):
        program = opened(
            build,
            tmp_path,
            build.assignment("here", "p[-0.5, -0.4, 0.0, 0, 3, 0]"),
            move,
            parts=payload + feature.format(variable),
        )
        (driven,) = program.moves
        assert isinstance(driven.target, PoseTarget)
        assert driven.target.pose.position == pytest.approx((-0.4, -0.2, 0.3), abs=1e-12)
        assert driven.tool.tcp.position == TCP[:3]
        load = driven.load or driven.tool.load
        assert load is not None and load.mass == 1.5


def test_without_its_installation_waypoints_tell_the_tcp(build: Build, tmp_path: Path) -> None:
    tcp = (0.0, 0.05, 0.2, 0.0, 0.0, 0.0)
    path = build.packed(
        tmp_path / "job.urp", build.program(build.move(build.fixed("A", A, tcp=tcp)))
    )
    program = read_file(path)
    assert program.moves[0].tool.tcp.position == tcp[:3]
    (note,) = program.notes
    assert "'default' is not at hand" in note.message and str(path) in note.message


def test_a_move_has_its_own_tcp(build: Build, tmp_path: Path) -> None:
    own = build.move(
        build.fixed("B", B),
        attributes='useActiveTCP="false" positionType="CartesianPose"',
        head='<tcp referencedName="pen"/>',
    )
    known = '<tcp name="gripper" offset="0, 0, 0.12, 0, 0, 0"/>'
    pen = f'{known}<tcp name="pen" offset="0, 0, 0.3, 0, 0, 0"/>'
    build.packed(tmp_path / "default.installation", build.installation(tcps=pen))
    step = build.move(build.fixed("A", A))
    program = read_file(build.packed(tmp_path / "job.urp", build.program(step, own)))
    assert [move.tool.tcp.position[2] for move in program.moves] == [0.12, 0.3]


def test_a_script_before_version_3_is_told_what_to_read(build: Build, tmp_path: Path) -> None:
    path = build.packed(tmp_path / "old.urp", "<gui.program.ProgramRootNode/>")
    with pytest.raises(InputError, match=r"before 3\.0.*\.script beside it; read that"):
        read_file(path)


def test_types_and_entities_are_refused(build: Build, tmp_path: Path) -> None:
    bomb = '<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><URProgram name="&b;"/>'
    for text in (bomb, bomb.encode("utf-16").decode("latin-1")):
        with pytest.raises(FlybyError):
            read_file(build.packed(tmp_path / "bomb.urp", text))


def test_what_unpacks_without_end_is_refused(build: Build, tmp_path: Path) -> None:
    path = build.packed(tmp_path / "bomb.urp", "<URProgram>" + " " * 100_000_001)
    with pytest.raises(InputError, match="unpacks to more than"):
        read_file(path)


def test_faults_name_the_node(build: Build, tmp_path: Path) -> None:
    bad = build.node("Folder", build.assignment("x", "f()g()"), name="Setup")
    with pytest.raises(SourceError, match="Robot Program > Setup > x") as caught:
        opened(build, tmp_path, bad)
    assert caught.value.span is not None and caught.value.span.file == str(tmp_path / "job.urp")


@settings(max_examples=60, deadline=None)
@given(st.data())
def test_damaged_files_are_refused_in_words(
    build: Build, tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    import gzip

    text = build.program(build.move(build.fixed("A", A))).encode()
    packed = data.draw(st.booleans())
    whole = gzip.compress(text, mtime=0) if packed else text
    start = data.draw(st.integers(0, len(whole)))
    length = data.draw(st.integers(0, 40))
    harm = data.draw(st.binary(max_size=20))
    # In a folder of its own: beside other tests' folders it would mark them as a backup.
    folder = tmp_path_factory.getbasetemp() / "damaged"
    folder.mkdir(exist_ok=True)
    path = folder / "damaged.urp"
    path.write_bytes(whole[:start] + harm + whole[start + length :])
    try:
        read_file(path, ReadOptions())
    except FlybyError as error:
        assert str(error)


@pytest.mark.parametrize("as_backup", [False, True])
def test_a_script_of_another_state_is_told(build: Build, tmp_path: Path, as_backup: bool) -> None:
    build.packed(tmp_path / "default.installation", build.installation())
    step = build.move(build.fixed("A", A), build.fixed("B", B))
    path = build.packed(tmp_path / "job.urp", build.program(step))
    script = tmp_path / "job.script"
    robot = None if as_backup else "ur/ur5e"
    for joints, stale in ((A, False), (C, True)):
        script.write_text(f"def job():\n  global A_q={list(joints)}\n  movej(A_q)\nend\n")
        notes = [str(note) for note in flyby.read(path, robot=robot).notes]
        assert any("1 waypoint elsewhere in job.script (A)" in note for note in notes) == stale
        assert len(flyby.read(path, robot=robot).moves) == 2


def pallet(build: Build, folder: Path, script: str | None, node: str = "Pallet") -> Path:
    """A program with a node between two moves whose code the tree does not hold."""
    build.packed(folder / "default.installation", build.installation())
    inside = build.node(node, build.move(build.fixed("C", C)), name="P_1")
    steps = build.move(build.fixed("A", A)), inside, build.move(build.fixed("B", B))
    if script is not None:
        (folder / "job.script").write_text(script)
    return build.packed(folder / "job.urp", build.program(*steps))


def saved(*between: str, of: tuple[float, ...] = A) -> str:
    """What PolyScope saves with it."""
    lines = [
        f"global A_q={list(of)}",
        f"global B_q={list(B)}",
        "set_tcp(p[0,0,0.12,0,0,0])",
        '$ 2 "A"',
        "movej(A_q, a=1.4, v=1.05)",
        '$ 4 "P_1"',
        *between,
        '$ 8 "B"',
        "movej(B_q, a=1.4, v=1.05)",
    ]
    return "\n".join(["def job():", *(f"  {line}" for line in lines), "end", ""])


@pytest.mark.parametrize("robot", [None, "ur/ur5e"])
@pytest.mark.parametrize("node", ["Pallet", "Seek", "Gripper"])
def test_nodes_whose_code_the_tree_lacks_are_driven_by_the_script(
    build: Build, tmp_path: Path, robot: str | None, node: str
) -> None:
    path = pallet(build, tmp_path, saved(f"movej({list(C)})", f"movej({list(D)})"), node)
    program = flyby.read(path, robot=robot)
    assert len(program.moves) == 4
    (note,) = [str(n) for n in program.notes if f"{path}: the code" in n.message]
    assert f"nodes {node} (1) is in job.script alone, which is read" in note
    assert flyby.emulate(program).trajectory.duration > 1.0


def test_a_gripper_that_leaves_the_robot_alone_leaves_the_tree(
    build: Build, tmp_path: Path
) -> None:
    path = pallet(build, tmp_path, saved("set_tool_digital_out(0, True)"), "Gripper")
    program = flyby.read(path, robot="ur/ur5e")
    assert len(program.moves) == 2 and program.moves[0].statement.file == str(path)


@pytest.mark.parametrize(
    "script", [None, saved(f"movej({list(C)})", of=D), "def job():\n movej([0,0,0,0,0,0])\nend\n"]
)
def test_a_script_of_another_state_is_not_read_for_them(
    build: Build, tmp_path: Path, script: str | None
) -> None:
    path = pallet(build, tmp_path, script)
    program = flyby.read(path, robot="ur/ur5e")
    assert len(program.moves) == 2
    assert any("'Pallet', whose code is not in the program tree" in str(n) for n in program.notes)


def test_nothing_is_written_into_a_script_that_polyscope_makes_anew(
    build: Build, tmp_path: Path
) -> None:
    path = pallet(build, tmp_path, saved(f"movej({list(C)})"))
    program = flyby.read(path, robot="ur/ur5e")
    slower = [replace(m, speed=replace(m.speed, joint=0.5)) for m in program.moves]
    with pytest.raises(FlybyError, match=r"never loads it.*on the pendant"):
        flyby.patch(program.with_moves(tuple(slower)), out=tmp_path / "out")
    program = flyby.read(tmp_path / "job.script", robot="ur/ur5e")
    flyby.patch(program.with_moves(tuple(slower)), out=tmp_path / "out")
    assert (tmp_path / "out" / "job.script").read_text().count("v=0.5") == 3
