"""Changes written back into trees of PolyScope: which bytes, and what is refused."""

from __future__ import annotations

import difflib
import gzip
import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError, MotionError
from flyby.core.program.move import Move
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_vendor
from flyby.core.source.patch.edits import difference, with_one_distance
from flyby.core.source.reading import Files
from flyby.core.spatial.pose import Pose
from flyby.vendors.ur.motion.configuration import UrConfiguration
from flyby.vendors.ur.patch.patcher import patch
from flyby.vendors.ur.run.reader import read, read_file
from flyby.vendors.ur.urp.kinematics import DhTable
from flyby.vendors.ur.values.poses import quaternion_of

from ..conftest import HOME, TCP, UR5E, Build, listed

ROBOT = find_vendor("ur").robot("ur5e")
A, B, C = (0.1, -1.4, 1.6, -1.8, -1.5, 0.2), (0.3, -1.2, 1.5, -1.9, -1.6, 0.1), HOME
Change = Callable[[Move], Move]


def shifted(x: float = 0.0, y: float = 0.0, z: float = 0.0, turn: float = 0.0) -> Change:
    def change(move: Move) -> Move:
        assert isinstance(move.target, PoseTarget)
        by = Pose((x, y, z), quaternion_of(0.0, 0.0, turn))
        return replace(move, target=replace(move.target, pose=by @ move.target.pose))

    return change


def zone(radius: float) -> Change:
    return lambda move: replace(move, zone=Radius(radius) if radius else FINE)


def speed(**changes: float) -> Change:
    return lambda move: replace(move, speed=replace(move.speed, **changes))


def joints(*values: float) -> Change:
    return lambda move: replace(move, target=JointTarget(values))


def opened(build: Build, folder: Path, *steps: str, parts: str = "", **how: object) -> Program:
    build.packed(folder / "default.installation", build.installation(parts))
    return read_file(build.packed(folder / "job.urp", build.program(*steps, **how)))  # type: ignore[arg-type]


def patched(program: Program, changes: dict[int, Change], **options: str) -> tuple[Files, Program]:
    moves = [changes.get(k, lambda m: m)(move) for k, move in enumerate(program.moves)]
    wanted = program.with_moves(tuple(moves))
    return patch(wanted, ROBOT, options), wanted


def stretches(before: bytes, after: bytes) -> list[tuple[str, str]]:
    """What of the XML has become what."""
    one, other = (gzip.decompress(data).decode() for data in (before, after))
    split = re.compile(r"[^\s\"<>,/]+|.", re.DOTALL)
    left, right = split.findall(one), split.findall(other)
    matcher = difflib.SequenceMatcher(None, left, right, autojunk=False)
    return [
        ("".join(left[a:b]), "".join(right[c:d]))
        for tag, a, b, c, d in matcher.get_opcodes()
        if tag != "equal"
    ]


def read_again(files: Files, folder: Path) -> Program:
    """What the user would read from the files, written over the old ones."""
    for file in files.values():
        Path(file.name).write_bytes(file.data)
    return read_file(folder / "job.urp")


def same(one: Program, other: Program) -> None:
    """The same moves; a ``qnear`` may be another one of the same posture."""
    bare = [
        Program(
            tuple(
                replace(move, target=replace(move.target, configuration=None))
                if isinstance(move.target, PoseTarget)
                else move
                for move in with_one_distance(program).moves
            )
        )
        for program in (one, other)
    ]
    assert difference(*bare) is None


def test_a_blend_radius_is_one_attribute(build: Build, tmp_path: Path) -> None:
    steps = build.fixed("A", A), build.fixed("B", B, 'blendRadius="0.01"'), build.fixed("C", C)
    program = opened(build, tmp_path, build.move(*steps, kind="MoveL"))
    before = (tmp_path / "job.urp").read_bytes()
    files, wanted = patched(program, {1: zone(0.025)})
    (file,) = files.values()
    assert stretches(before, file.data) == [("0.01", "0.025")]
    same(read_again(files, tmp_path), wanted)


def test_a_blend_radius_that_was_not_there_is_put_in(build: Build, tmp_path: Path) -> None:
    bare = build.fixed("A", A).replace("<motionParameters />", "")
    none = build.fixed("B", B).replace("<motionParameters />", "<motionParameters/>")
    program = opened(build, tmp_path, build.move(bare, none, build.fixed("C", C), kind="MoveL"))
    before = (tmp_path / "job.urp").read_bytes()
    files, wanted = patched(program, {0: zone(0.01), 1: zone(0.02)})
    (file,) = files.values()
    xml = gzip.decompress(file.data).decode()
    assert '<motionParameters blendRadius="0.01"/>' in xml
    assert '<motionParameters blendRadius="0.02"/>' in xml
    assert len(xml) - len(gzip.decompress(before)) == len(
        '<motionParameters blendRadius="0.01"/>' + ' blendRadius="0.02"'
    )
    same(read_again(files, tmp_path), wanted)


def test_a_waypoint_moves_by_its_joints(build: Build, tmp_path: Path) -> None:
    """Another table than the type's, and a tool that is turned: the TCP goes where it shall."""
    rows = [list(row) for row in UR5E]
    rows[1][1] -= 0.002
    tcp = (0.01, 0.02, 0.2, 0.3, -0.4, 0.5)
    steps = [build.fixed(name, q, tcp=tcp, rows=rows) for name, q in (("A", A), ("B", B))]
    program = opened(build, tmp_path, build.move(*steps, kind="MoveL"))
    files, wanted = patched(program, {1: shifted(0.03, -0.02, 0.01, 0.1)})
    (file,) = files.values()
    before = (tmp_path / "job.urp").read_bytes()
    made = stretches(before, file.data)
    assert len(made) == 6  # the joints, and nothing else
    q = tuple(float(new) for _, new in made)
    assert np.abs(np.array(q) - B).max() < 0.2
    reached = DhTable(tuple(map(tuple, rows))).flange(q)  # type: ignore[arg-type]
    target = wanted.moves[1].target
    assert isinstance(target, PoseTarget)
    goal = target.pose @ Pose(tcp[:3], quaternion_of(*tcp[3:])).inverse()
    assert math.dist(reached.position, goal.position) < 1e-9
    same(read_again(files, tmp_path), wanted)


def test_joints_of_a_move_by_joints_are_written(build: Build, tmp_path: Path) -> None:
    step = build.move(build.fixed("A", A), build.fixed("B", B), attributes='positionType="Joint"')
    program = opened(build, tmp_path, step)
    new = (*B[:2], 1.45, *B[3:])
    files, wanted = patched(program, {1: joints(*new)})
    before = (tmp_path / "job.urp").read_bytes()
    (file,) = files.values()
    assert stretches(before, file.data) == [("1.5", "1.45")]
    same(read_again(files, tmp_path), wanted)


def test_what_a_move_states_is_changed_for_all_of_its_waypoints(
    build: Build, tmp_path: Path
) -> None:
    step = build.move(build.fixed("A", A), build.fixed("B", B), kind="MoveL", speed=0.25)
    program = opened(build, tmp_path, step, build.move(build.fixed("C", C), speed=0.5))
    before = (tmp_path / "job.urp").read_bytes()
    files, wanted = patched(program, {0: speed(tcp=0.4), 1: speed(tcp=0.4)})
    (file,) = files.values()
    assert stretches(before, file.data) == [("0.25", "0.4")]
    same(read_again(files, tmp_path), wanted)
    with pytest.raises(MotionError, match="is read by move 2 as well"):
        patched(read_file(tmp_path / "job.urp"), {0: speed(tcp=0.3)})


def test_one_waypoint_gets_a_speed_of_its_own(build: Build, tmp_path: Path) -> None:
    step = build.move(build.fixed("A", A), build.fixed("B", B), kind="MoveL", speed=0.25)
    program = opened(build, tmp_path, step)
    files, wanted = patched(program, {0: speed(tcp=0.1)}, shared="own")
    xml = gzip.decompress(next(iter(files.values())).data).decode()
    assert '<motionParameters cartesianSpeed="0.1" cartesianAcceleration="1.4" />' in xml
    assert 'speed="0.25"' in xml
    same(read_again(files, tmp_path), wanted)


def test_a_time_is_changed_where_it_stands(build: Build, tmp_path: Path) -> None:
    program = opened(build, tmp_path, build.move(build.fixed("A", A, 'nextMotionTime="2.5"')))
    files, wanted = patched(program, {0: speed(duration=3.0)})
    before = (tmp_path / "job.urp").read_bytes()
    assert stretches(before, next(iter(files.values())).data) == [("2.5", "3")]
    same(read_again(files, tmp_path), wanted)


def test_a_waypoint_that_several_moves_go_to_moves_for_all(build: Build, tmp_path: Path) -> None:
    again = '<Waypoint reference="../../../Move/children/Waypoint"/>'
    moves = (
        build.move(build.fixed("A", A), build.fixed("B", B), kind="MoveL"),
        build.move(again, kind="MoveL"),
    )
    program = opened(build, tmp_path, *moves)
    assert len(program.moves) == 3
    with pytest.raises(FlybyError):
        patched(program, {0: shifted(0.01)})
    files, wanted = patched(program, {0: shifted(0.01), 2: shifted(0.01)})
    same(read_again(files, tmp_path), wanted)


def test_a_pose_that_joints_do_not_reach_is_refused(build: Build, tmp_path: Path) -> None:
    program = opened(build, tmp_path, build.move(build.fixed("A", A), kind="MoveL"))
    with pytest.raises(InputError, match=r"job\.urp: A: no joints near .* out of reach"):
        patched(program, {0: shifted(2.0)})


CODE = (
    "def part():\r\n  # größer & <schneller>\r\n"
    "  movel(p[-0.4, -0.2, 0.3, 0, 3.1, 0], a=1.2, v=0.25)\r\n\r\n"
    "  movel(p[-0.4, 0, 0.3, 0, 3.1, 0], a=1, v=0.2, r=0.01)\r\nend\r\npart()\r\n"
)


def test_code_of_a_script_file_is_changed_there_and_in_the_program(
    build: Build, tmp_path: Path
) -> None:
    """PolyScope reads the file again; the copy in the program says the same."""
    (tmp_path / "part.script").write_bytes(CODE.encode())
    program = opened(build, tmp_path, build.script(CODE))
    before = (tmp_path / "job.urp").read_bytes()
    files, wanted = patched(program, {0: zone(0.02), 1: speed(tcp=0.1)})
    named = {Path(file.name).name: file for file in files.values()}
    expected = CODE.replace("v=0.25)", "v=0.25, r=0.02)").replace("v=0.2,", "v=0.1,")
    assert set(named) == {"job.urp", "part.script"}
    assert named["part.script"].data == expected.encode()
    old, new = (gzip.decompress(data).decode() for data in (before, named["job.urp"].data))
    assert new == old.replace("v=0.25)", "v=0.25, r=0.02)").replace("v=0.2,", "v=0.1,")
    same(read_again(files, tmp_path), wanted)


def test_code_whose_file_is_not_at_hand_or_another_is_refused(build: Build, tmp_path: Path) -> None:
    program = opened(build, tmp_path, build.script(CODE))
    with pytest.raises(InputError, match=r"put the file beside the program"):
        patched(program, {1: speed(tcp=0.1)})
    (tmp_path / "part.script").write_text(CODE.replace("0.25", "0.3"))
    with pytest.raises(InputError, match=r"part\.script beside it is not as the copy"):
        patched(read_file(tmp_path / "job.urp"), {1: speed(tcp=0.1)})


def test_what_stands_in_an_expression_is_refused(build: Build, tmp_path: Path) -> None:
    line = build.expression("movel(p[-0.4, -0.2, 0.3, 0, 3.1, 0], a=1.2, v=0.25)")
    steps = [f'<Script type="Line">{line}</Script>'] * 2
    program = opened(build, tmp_path, build.move(build.fixed("A", A)), *steps)
    with pytest.raises(InputError, match=r"Script: nothing can be written there"):
        patched(program, {1: speed(tcp=0.1)})


def test_programs_of_before_polyscope_5_keep_their_poses_in_step(
    build: Build, tmp_path: Path
) -> None:
    table = DhTable(UR5E)
    pose = table.flange(A) @ Pose(TCP[:3])
    flange = table.flange(A)

    def six(one: Pose) -> str:
        from flyby.vendors.ur.values.poses import value_of

        return listed(float(part) for part in value_of(one))  # type: ignore[arg-type]

    waypoint = (
        f'<Waypoint type="Fixed" name="W"><position joints="{listed(A)}" pose="{six(pose)}"/>'
        f'<poseInFeatureCoordinates pose="{six(pose)}"/><outputFlangePose pose="{six(flange)}"/>'
        "</Waypoint>"
    )
    program = opened(build, tmp_path, build.move(waypoint, kind="MoveL"), saved_in="3.3.0")
    files, wanted = patched(program, {0: shifted(0.02, 0.01)})
    same(read_again(files, tmp_path), wanted)
    xml = gzip.decompress((tmp_path / "job.urp").read_bytes()).decode()
    found = dict(re.findall(r'(joints|outputFlangePose pose|Coordinates pose)="([^"]*)"', xml))
    q, out, inside = (
        tuple(map(float, found[key].split(",")))
        for key in ("joints", "outputFlangePose pose", "Coordinates pose")
    )
    reached = table.flange(q)
    assert math.dist(out[:3], reached.position) < 1e-9
    assert math.dist(inside[:3], (reached @ Pose(TCP[:3])).position) < 1e-9


def test_a_plain_file_stays_plain_and_gzip_keeps_its_head(build: Build, tmp_path: Path) -> None:
    text = build.program(build.move(build.fixed("A", A), build.fixed("B", B), kind="MoveL"))
    path = tmp_path / "job.urp"
    path.write_bytes(text.encode())
    files, _ = patched(read_file(path), {0: zone(0.01)})
    assert next(iter(files.values())).data.startswith(b"<URProgram")
    with path.open("wb") as raw, gzip.GzipFile("own name.urp", "wb", 1, raw, 12345) as packed:
        packed.write(text.encode())
    before = path.read_bytes()
    files, _ = patched(read_file(path), {0: zone(0.01)})
    after = next(iter(files.values())).data
    assert after[:23] == before[:23] and b"own name" in after[:23]
    assert b'blendRadius="0.01"' in gzip.decompress(after)


def test_the_script_beside_is_changed_if_it_is_of_the_same_state(
    build: Build, tmp_path: Path
) -> None:
    step = build.move(build.fixed("A", A), build.fixed("B", B), kind="MoveL", speed=0.25)
    program = opened(build, tmp_path, step)
    poses = [m.target.pose for m in program.moves if isinstance(m.target, PoseTarget)]
    from flyby.vendors.ur.values.poses import value_of

    text = (
        "def job():\n  set_gravity([0, 0, 9.82])\n  set_tcp(p[0.0, 0.0, 0.12, 0.0, 0.0, 0.0])\n"
        + "".join(
            f"  global {name}_p=p{list(value_of(pose))}\n"
            for name, pose in zip("AB", poses, strict=True)
        )
        + '  $ 1 "Robot Program"\n  movel(A_p, a=1.4, v=0.25)\n  movel(B_p, a=1.4, v=0.25)\nend\n'
    )
    script = tmp_path / "job.script"
    script.write_text(text)
    files, _ = patched(read_file(tmp_path / "job.urp"), {0: zone(0.01)})
    named = {Path(file.name).name: file for file in files.values()}
    assert set(named) == {"job.urp", "job.script"}
    assert named["job.script"].text == text.replace(
        "A_p, a=1.4, v=0.25", "A_p, a=1.4, v=0.25, r=0.01"
    )
    script.write_text(text.replace("v=0.25", "v=0.2"))
    files, _ = patched(read_file(tmp_path / "job.urp"), {0: zone(0.01)})
    assert [Path(file.name).name for file in files.values()] == ["job.urp"]


def test_the_posture_of_a_moved_waypoint_is_the_one_that_was_asked_for(
    build: Build, tmp_path: Path
) -> None:
    """``movej`` to a pose: the joints are those nearest to ``qnear``, also when that is new."""
    program = opened(build, tmp_path, build.move(build.fixed("A", A), build.fixed("B", B)))
    target = program.moves[1].target
    assert isinstance(target, PoseTarget)
    tool = program.moves[1].tool.tcp
    moved = Pose((0.01, 0.02, 0.0)) @ target.pose
    others = ROBOT.inverse(moved @ tool.inverse())
    far = max(others, key=lambda one: float(np.linalg.norm(one.q - np.array(B))))
    near = UrConfiguration(tuple(round(float(v), 2) for v in far.q))

    def change(move: Move) -> Move:
        return replace(move, target=replace(target, pose=moved, configuration=near))

    files, _ = patched(program, {1: change})
    read_back = read_again(files, tmp_path).moves[1].target
    assert isinstance(read_back, PoseTarget)
    assert isinstance(read_back.configuration, UrConfiguration)
    assert np.abs(np.array(read_back.configuration.joints) - far.q).max() < 1e-6


names = st.sampled_from(["Waypoint_1", "Über 2", "3", "end"])
near_home = st.tuples(*(st.floats(q - 0.3, q + 0.3) for q in A))
waypoints = st.lists(
    st.tuples(names, near_home, st.sampled_from([0.0, 0.01]), st.booleans()), min_size=1, max_size=3
)
nodes = st.lists(
    st.tuples(st.sampled_from(["MoveJ", "MoveL", "MoveP"]), st.booleans(), waypoints),
    min_size=1,
    max_size=3,
)


WRITTEN: list[Callable[[str], str]] = [
    str,
    lambda xml: "<?xml version='1.0' encoding='UTF-8'?>\r\n" + xml.replace("><", ">\r\n\t<"),
    lambda xml: re.sub(r'(\w)="([^"\']*)"', r"\1 = '\2'", xml),
    lambda xml: xml.replace("<children>", '<!-- <Waypoint name="x"/> --><children>'),
]
"""Ways to write the same XML."""


@settings(max_examples=60, deadline=None)
@given(nodes, st.data())
def test_what_is_read_back_is_what_was_wanted(
    build: Build, nodes: list[tuple[str, bool, list[object]]], data: st.DataObject
) -> None:
    """Any changes: the file says them, or the reason why it cannot."""
    steps = []
    for kind, cartesian, points in nodes:
        inside = [
            build.fixed(
                name,
                q,
                (f'blendRadius="{r}"' if r and kind != "MoveP" else "")
                + (' jointSpeed="0.7" cartesianSpeed="0.2"' if own else ""),
            )
            for name, q, r, own in points  # type: ignore[misc]
        ]
        sort = "CartesianPose" if cartesian else "JointAngles"
        steps.append(
            build.move(*inside, kind=kind, attributes=f'blendRadius="0.005" positionType="{sort}"')
        )
    xml = data.draw(st.sampled_from(WRITTEN))(build.program(*steps))
    program = read(xml, "job.urp")
    small = st.floats(-0.02, 0.02).map(lambda value: round(value, 6))
    moves = []
    for move in program.moves:
        if data.draw(st.booleans()):
            if isinstance(move.target, PoseTarget):
                move = shifted(*data.draw(st.tuples(small, small, small, small)))(move)
            else:
                assert isinstance(move.target, JointTarget)
                move = joints(*(q + data.draw(small) for q in move.target.joints))(move)
        if data.draw(st.booleans()):
            move = zone(data.draw(st.sampled_from([0.0, 0.002, 0.0125])))(move)
        if data.draw(st.booleans()) and move.speed.tcp is not None:
            move = speed(tcp=data.draw(st.sampled_from([0.11, 0.5])))(move)
        moves.append(move)
    wanted = program.with_moves(tuple(moves))
    shared = data.draw(st.sampled_from(["refuse", "own"]))
    try:
        files = patch(wanted, ROBOT, {"shared": shared, "derived": shared})
    except FlybyError as error:
        assert str(error)
        return
    if not files:
        assert difference(program, wanted) is None
        return
    (file,) = files.values()
    again = read(file.data.decode(), "job.urp")
    same(again, wanted)
    kept = re.compile(r'[\w.+-]*\d[\w.+-]*| \w+="[^"]*"|<motionParameters[^>]*/>')
    assert kept.sub("", file.data.decode()) == kept.sub("", xml)  # numbers alone have changed
    for old, new in zip(wanted.moves, again.moves, strict=True):
        if isinstance(old.target, PoseTarget) and old.target.configuration is not None:
            assert isinstance(new.target, PoseTarget) and new.target.configuration is not None
            assert old.target.configuration.mismatch(new.target.configuration) < 0.5


def test_the_tests_above_change_something(build: Build) -> None:
    """Of such programs most changes are carried out, not refused."""
    step = build.move(build.fixed("A", A), build.fixed("B", B), kind="MoveL")
    program = read(build.program(step, build.move(build.fixed("C", C))), "job.urp")
    files, _ = patched(program, {0: shifted(0.01), 1: zone(0.01), 2: shifted(0.0, 0.01)})
    assert len(files) == 1
