"""The package's own KRL programs, as untidy as real ones: read, driven, patched."""

import tomllib
from collections.abc import Callable
from dataclasses import dataclass, replace
from difflib import SequenceMatcher
from pathlib import Path

import pytest

from flyby.core.errors import FlybyError, SourceError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import Move, MoveJ
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.zone import Angle, ContourFraction, Radius
from flyby.core.registry import find_vendor
from flyby.core.robot.model import Robot
from flyby.core.source.patch.edits import difference, reading_of
from flyby.core.source.reading import Files
from flyby.core.source.text.files import SourceFile

CORPUS = Path(__file__).parents[2] / "corpus" / "krl"
INDEX = tomllib.loads((CORPUS / "index.toml").read_text("utf-8"))["program"]
KUKA = find_vendor("kuka")


@dataclass(frozen=True)
class Example:
    program: Program
    robot: Robot


@pytest.fixture(scope="module", params=INDEX, ids=lambda entry: entry["file"])
def example(request: pytest.FixtureRequest) -> Example:
    robot = KUKA.robot(request.param["robot"])
    return Example(KUKA.read_file(CORPUS / request.param["file"], robot=robot), robot)


def sources() -> dict[str, bytes]:
    """Every file of the folder."""
    return {
        str(path.relative_to(CORPUS)): path.read_bytes()
        for path in CORPUS.rglob("*")
        if path.suffix in (".src", ".dat") and "incomplete" not in path.parts
    }


def test_there_are_enough_and_all_are_listed() -> None:
    files = sources()
    listed = {entry["file"] for entry in INDEX}
    assert len(listed) >= 12 and listed <= set(files)
    assert listed == {name for name in files if name.endswith(".src")} - {
        "zelle/holen.src",
        "zelle/ablegen.src",
    }
    for name in listed:
        folder = name.rpartition("/")[0]
        data = name.replace(".src", ".dat")
        parts = [n for n in files if n in (name, data) or (folder and n.startswith(folder))]
        assert 100 <= sum(files[part].count(b"\n") + 1 for part in parts) <= 1100


def test_they_are_as_untidy_as_real_ones() -> None:
    files = list(sources().values())
    everything = b"\n".join(files)
    assert sum(data.startswith(b"\xef\xbb\xbf") for data in files) >= 2
    assert sum(not data.endswith(b"\n") for data in files) >= 4
    assert sum(b"\r\n" in data for data in files) >= 6
    assert sum(b"\r\n" not in data for data in files) >= 4
    assert sum(not _is_utf8(data) for data in files) >= 3
    for word in (
        *(b"%MKUKATPBASIS", b"IlfProvider", b"USERSPOT", b"SET_CD_PARAMS", b"SVEL_CP", b"C_SPL"),
        *(b"SWITCH", b"LOOP", b"WHILE", b"REPEAT", b"GOTO", b"DEFFCT", b"INTERRUPT DECL", b"ENUM"),
        *(b"STRUC", b"SIGNAL", b"WAIT FOR", b"TRIGGER", b"CIRC", b"LIN_REL", b"PTP_REL", b"SCIRC"),
        *(b"$LOAD", b"$CIRC_TYPE", b"$VEL_AXIS[1]", b"BAS (#INITMOV", b":{X 0", b"C_ORI"),
        *(b"Gr\xf6\xdfe", b"DEFDAT  $CONFIG", b"$BWDSTART=FALSE", b"LIN XP", b"{FRAME: X", b"\t"),
    ):
        assert word in everything, word


def _is_utf8(data: bytes) -> bool:
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True


def test_each_is_driven_to_its_end(example: Example) -> None:
    run = Controller(KUKA, example.robot).run(example.program)
    assert run.duration > 5
    assert len(example.program.moves) >= 20


def test_each_survives_being_written(example: Example, tmp_path: Path) -> None:
    """Statements that name signals and data of the old files become comments."""
    moves = example.program.moves
    try:
        written = KUKA.write(example.program, example.robot)
    except SourceError as error:
        assert "which the new program does not have" in str(error)
        written = KUKA.write(example.program, example.robot, {"opaque": "comment"})
        moves = tuple(replace(move, events=()) for move in moves)
    for name, text in written.items():
        (tmp_path / name).write_text(text, "utf-8", newline="")
    main = next(name for name in written if name.endswith(".src"))
    again = KUKA.read_file(tmp_path / main, robot=example.robot)
    assert difference(Program(moves), Program(again.moves)) is None


def shifted(move: Move) -> Move:
    return replace(move, target=_further(move.target))


def _further(target: Target) -> Target:
    if isinstance(target, JointTarget):
        return replace(target, joints=(target.joints[0] + 0.00125, *target.joints[1:]))
    x, y, z = target.pose.position
    return replace(target, pose=replace(target.pose, position=(x + 0.00125, y, z)))


def tightened(move: Move) -> Move:
    zone = move.zone
    if isinstance(zone, Radius):
        half = 0.5 * zone.tcp
        return replace(move, zone=Radius(half, half, half))
    if isinstance(zone, ContourFraction):
        return replace(move, zone=ContourFraction(0.5 * zone.fraction))
    return replace(move, zone=Angle(0.5 * zone.angle)) if isinstance(zone, Angle) else move


def slowed(move: Move) -> Move:
    speed = move.speed
    if isinstance(move, MoveJ):
        return replace(move, speed=replace(speed, joint_fraction=0.5 * speed.joint_fraction))
    assert speed.tcp is not None
    return replace(move, speed=replace(speed, tcp=0.5 * speed.tcp))


@pytest.mark.parametrize("change", [shifted, tightened, slowed])
def test_each_is_patched_byte_by_byte(example: Example, change: Callable[[Move], Move]) -> None:
    before = reading_of(example.program).files
    files, wanted = _first_patch(example, change)
    assert files and set(files) <= set(before)
    assert difference(wanted, reading_of(example.program).again(files)) is None
    for name, file in files.items():
        assert file.codec == before[name].codec
        assert_only_a_line_changed(before[name], file)


def _first_patch(example: Example, change: Callable[[Move], Move]) -> tuple[Files, Program]:
    """The patch of the first instruction that takes it, and the program that it must give."""
    moves = example.program.moves
    refusals = []
    for chosen in dict.fromkeys(m.origin.statement for m in moves if m.origin is not None):
        new = tuple(change(m) if m.origin and m.origin.statement == chosen else m for m in moves)
        if new == moves:
            continue
        wanted = example.program.with_moves(new)
        for options in ({}, {"shared": "own", "derived": "own"}):
            try:
                files = KUKA.patch(wanted, example.robot, options)
                return {file.name: file for file in files.values()}, wanted
            except FlybyError as error:
                refusals.append(str(error))
    raise AssertionError("\n".join(refusals))


def assert_only_a_line_changed(before: SourceFile, after: SourceFile) -> None:
    """At most the instruction's own lines are others; ends of line are those of the file."""
    old, new = (file.data.splitlines(keepends=True) for file in (before, after))
    blocks = [c for c in SequenceMatcher(None, old, new, False).get_opcodes() if c[0] != "equal"]
    assert 1 <= len(blocks) <= 4
    for _, i, j, k, m in blocks:
        assert j - i <= 1 and m - k <= 2
        for line in new[k:m]:
            assert line.endswith(b"\r\n") == (b"\r\n" in before.data) or line is new[-1]
