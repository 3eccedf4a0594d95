"""The scripts of the corpus: read, driven to the end, and patched byte for byte."""

import codecs
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import Move, MoveC, Opaque
from flyby.core.program.origin import Origin, Ownership
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import Radius
from flyby.core.registry import find_vendor
from flyby.core.robot.model import Robot
from flyby.core.source.patch.edits import difference
from flyby.core.source.reading import Reading
from flyby.core.spatial.pose import Pose

CORPUS = Path(__file__).parents[2] / "corpus" / "urscript"
INDEX = tomllib.loads((CORPUS / "index.toml").read_text("utf-8"))["program"]
VENDOR = find_vendor("ur")
OWN = {"shared": "own", "derived": "own"}


@pytest.fixture(scope="module", params=INDEX, ids=lambda entry: entry["file"])
def script(request: pytest.FixtureRequest) -> tuple[Program, Robot, bytes]:
    path = CORPUS / request.param["file"]
    robot = VENDOR.robot(request.param["robot"])
    return VENDOR.read_file(path, robot=robot), robot, path.read_bytes()


def test_the_index_names_every_script() -> None:
    assert {entry["file"] for entry in INDEX} == {path.name for path in CORPUS.glob("*.script")}
    assert len(INDEX) >= 12


def test_the_scripts_are_as_messy_as_real_ones() -> None:
    data = {path.stem: path.read_bytes() for path in CORPUS.glob("*.script")}
    assert all(100 <= d.count(b"\n") <= 1000 for d in data.values())
    assert data["takt_zeit"].startswith(codecs.BOM_UTF8)
    assert not data["kleberaupe"].endswith(b"\n")
    assert sum(b"\r\n" in d for d in data.values()) >= 3
    assert sum(b"\t" in d for d in data.values()) >= 2
    with pytest.raises(UnicodeDecodeError):
        data["plateflyt"].decode()
    exports = [d for d in data.values() if b'  $ 3 "' in d]
    assert len(exports) >= 3 and any("ß≔".encode() in d or "≔".encode() in d for d in exports)
    for words in (b"get_inverse_kin(", b"qnear=", b"thread ", b"movec(", b"movep(", b"socket_open"):
        assert any(words in d for d in data.values()), words
    for words in (b"modbus_", b"while (True)", b"elif", b"pose_trans(", b"set_payload", b", t="):
        assert any(words in d for d in data.values()), words


def test_every_script_drives_to_its_end(script: tuple[Program, Robot, bytes]) -> None:
    program, robot, _ = script
    run = Controller(VENDOR, robot).run(program)
    assert run.duration > 10
    assert len(program.moves) > 20
    last = program.moves[-1].target
    if isinstance(last, JointTarget):
        assert run.trajectory.q[-1] == pytest.approx(last.joints, abs=1e-6)


def test_reading_keeps_every_byte(script: tuple[Program, Robot, bytes]) -> None:
    program, _, data = script
    assert isinstance(program.reading, Reading)
    assert [file.data for file in program.reading.files.values()] == [data]


def test_what_is_written_drives_alike(script: tuple[Program, Robot, bytes]) -> None:
    program, robot, _ = script
    ((file, text),) = VENDOR.write(program, robot, {"opaque": "comment"}).items()
    assert text.isascii()
    again = VENDOR.read(text, file, robot=robot)
    own = tuple(s for s in program.statements if not isinstance(s, Opaque))
    assert difference(replace(program, statements=own), again) is None
    code = [line for line in text.splitlines() if not line.startswith("  #")]
    assert VENDOR.write(again, robot)[file].splitlines() == code


def retargeted(move: Move) -> Move:
    target = move.target
    if isinstance(target, JointTarget):
        first, *rest = target.joints
        return replace(move, target=replace(target, joints=(first + 0.0123, *rest)))
    x, y, z = target.pose.position
    pose = Pose((x + 0.00125, y, z), target.pose.quaternion)
    return replace(move, target=replace(target, pose=pose))


def rezoned(move: Move) -> Move:
    tcp = 0.5 * move.zone.tcp if isinstance(move.zone, Radius) else 0.0015
    return replace(move, zone=Radius(tcp, tcp, tcp))


def slowed(move: Move) -> Move:
    speed = move.speed
    if speed.duration is not None:
        return replace(move, speed=replace(speed, duration=speed.duration + 0.25))
    if speed.joint is not None:
        return replace(move, speed=replace(speed, joint=0.875 * speed.joint))
    assert speed.tcp is not None
    return replace(move, speed=replace(speed, tcp=0.875 * speed.tcp))


CHANGES = {"target": retargeted, "zone": rezoned, "speed": slowed}


def executed_once(program: Program) -> Iterator[int]:
    """The moves whose call stands in no loop, and in no function that is called again."""
    statements = [move.origin.statement for move in program.moves if move.origin]
    return (k for k, statement in enumerate(statements) if statements.count(statement) == 1)


def patched(
    program: Program, robot: Robot, change: Callable[[Move], Move]
) -> tuple[int, Program, bytes]:
    """One move changed: its index, the program that was asked for, and what came out."""
    index = next(executed_once(program))
    moves = list(program.moves)
    moves[index] = change(moves[index])
    after = program.with_moves(tuple(moves))
    (file,) = VENDOR.patch(after, robot, OWN).values()
    return index, after, file.data


@pytest.mark.parametrize("kind", CHANGES)
def test_one_change_changes_its_own_bytes_alone(
    script: tuple[Program, Robot, bytes], kind: str, tmp_path: Path
) -> None:
    program, robot, data = script
    index, after, made = patched(program, robot, CHANGES[kind])
    origin = program.moves[index].origin
    assert origin is not None
    part: Origin = getattr(origin, kind)
    lines = {span.line for span in (*part.numbers, part.span, origin.statement) if span}
    old, new = data.split(b"\n"), made.split(b"\n")
    assert len(old) == len(new)
    changed = [number for number, (a, b) in enumerate(zip(old, new, strict=True), 1) if a != b]
    assert changed and set(changed) <= lines
    if part.ownership is Ownership.OWNED:
        assert len(changed) == 1
    path = tmp_path / "patched.script"
    path.write_bytes(made)
    assert difference(VENDOR.read_file(path, robot=robot), after) is None


def test_a_patch_and_its_opposite_give_the_file_back(
    script: tuple[Program, Robot, bytes], tmp_path: Path
) -> None:
    """But for the spelling of the numbers that were changed."""
    program, robot, data = script
    *_, made = patched(program, robot, retargeted)
    path = tmp_path / "patched.script"
    path.write_bytes(made)
    there = VENDOR.read_file(path, robot=robot)
    back = there.with_moves(
        tuple(replace(m, target=o.target) for m, o in zip(there.moves, program.moves, strict=True))
    )
    (file,) = VENDOR.patch(back, robot).values()
    path.write_bytes(file.data)
    assert difference(VENDOR.read_file(path, robot=robot), program) is None
    assert abs(len(file.data) - len(data)) < 200


def test_a_call_in_a_loop_has_no_literal_of_its_own_for_one_pass() -> None:
    robot = VENDOR.robot("ur5e")
    program = VENDOR.read_file(CORPUS / "sorter.script", robot=robot)
    moves = list(program.moves)
    moves[2] = retargeted(moves[2])
    with pytest.raises(MotionError, match="is executed several times") as caught:
        VENDOR.patch(program.with_moves(tuple(moves)), robot, OWN)
    assert caught.value.move == 2


def test_arcs_change_their_auxiliary_point() -> None:
    path = CORPUS / "kleberaupe.script"
    robot = VENDOR.robot("ur10e")
    program = VENDOR.read_file(path, robot=robot)
    index = next(i for i, move in enumerate(program.moves) if isinstance(move, MoveC))
    move = program.moves[index]
    assert isinstance(move, MoveC)
    x, y, z = move.via.pose.position
    via = replace(move.via, pose=Pose((x, y, z + 0.0005), move.via.pose.quaternion))
    moves = list(program.moves)
    moves[index] = replace(move, via=via)
    (file,) = VENDOR.patch(program.with_moves(tuple(moves)), robot).values()
    old, new = path.read_bytes(), file.data
    assert len(new) - len(old) <= 12
    assert sum(a != b for a, b in zip(old.split(), new.split(), strict=True)) == 1
