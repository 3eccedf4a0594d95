"""Messy programs of our own: read, emulated to the end, written, and patched byte for byte."""

import re
import tomllib
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from flyby.core.errors import FlybyError, MotionError, SourceError, Span
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import Move
from flyby.core.program.origin import MoveOrigin, Ownership
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers_file import load_answers
from flyby.core.source.patch.edits import difference
from flyby.core.source.reading import Files, Reading
from flyby.vendors.abb.values import predefined

ROOT = Path(__file__).parents[2] / "corpus" / "rapid"
PROGRAMS: dict[str, dict[str, Any]] = {
    entry["file"]: entry for entry in tomllib.loads((ROOT / "index.toml").read_text())["program"]
}
SOURCES = sorted(p for p in ROOT.rglob("*") if p.suffix in (".mod", ".prg", ".sys"))
VENDOR = find_vendor("abb")

each_program = pytest.mark.parametrize("file", PROGRAMS)


@cache
def program(file: str) -> Program:
    entry = PROGRAMS[file]
    return VENDOR.read_file(
        ROOT / file,
        robot=find_robot(entry["robot"]),
        answers=load_answers(ROOT / entry["answers"]) if "answers" in entry else None,
        others=[ROOT / other for other in entry.get("others", ())],
    )


def reading(file: str) -> Reading:
    found = program(file).reading
    assert isinstance(found, Reading)
    return found


def origin(move: Move) -> MoveOrigin:
    assert move.origin is not None
    return move.origin


def test_the_corpus_is_as_messy_as_real_programs() -> None:
    data = {path.name: path.read_bytes() for path in SOURCES}
    assert len(PROGRAMS) >= 30
    assert all(100 <= len(re.split(rb"\r\n|\r|\n", d)) <= 1000 for n, d in data.items()
               if n in PROGRAMS)  # fmt: skip

    def count(wanted: bytes) -> int:
        return sum(re.search(wanted, d, re.IGNORECASE | re.DOTALL) is not None
                   for d in data.values())  # fmt: skip

    assert sum(b"\r\n" in d for d in data.values()) > len(data) / 2
    assert sum(not d.endswith((b"\n", b"\r")) for d in data.values()) > len(data) / 2
    assert count(rb"[^\r]\n.*\r\n") >= 2 and count(rb"\r[^\n]") >= 1
    assert count(rb"^\xef\xbb\xbf") >= 1 and count(rb"^%%%") >= 3
    assert sum(_is_cp1252(d) for d in data.values()) >= 4
    for word in (rb"\bTRAP\b", rb"\bERROR\b", rb"\bRECORD\b", rb"\bFUNC\b", rb"\bRelTool\(",
                 rb"\\WObj:=", rb"\bWaitUntil\b", rb"\bCRobT\(", rb"\bTriggL\b", rb"\bMoveLDO\b",
                 rb"\bMoveC\b", rb"\bGOTO\b", rb"\bPDispSet\b", rb"\bUNDO\b", rb"\bBACKWARD\b",
                 rb"\bSocketReceive\b", rb"\bGInput\(", rb"%stRoutine%", rb"\\Inpos:=",
                 rb"\bTEST\b", rb"\bWHILE\b", rb"\bPERS \w+ \w+\{"):  # fmt: skip
        assert count(word), word


def _is_cp1252(data: bytes) -> bool:
    try:
        data.decode()
    except UnicodeDecodeError:
        return True
    return False


@each_program
def test_it_is_read_with_every_byte(file: str) -> None:
    assert program(file).moves
    for name, source in reading(file).files.items():
        assert source.data == Path(name).read_bytes()


@each_program
def test_it_is_emulated_to_its_end(file: str) -> None:
    run = Controller(VENDOR, find_robot(PROGRAMS[file]["robot"])).run(program(file))
    assert 5 < run.duration < 300
    assert run.trajectory.t[-1] == pytest.approx(run.duration)


@each_program
def test_it_is_written_and_read_again(file: str) -> None:
    """Most of them keep statements that name data of their own: these become comments."""
    robot = find_robot(PROGRAMS[file]["robot"])
    try:
        written = VENDOR.write(program(file), robot)
    except (SourceError, MotionError) as error:
        said = str(error)
        assert "which the new program does not have" in said or "RAPID has no words" in said
        written = VENDOR.write(program(file), robot, {"opaque": "comment"})
    ((name, text),) = written.items()
    again = VENDOR.read(text, name, robot=robot)
    assert len(again.moves) == len(program(file).moves)
    (twice,) = VENDOR.write(again, robot).values()
    assert _without_comments(twice) == _without_comments(text)


def _without_comments(text: str) -> list[str]:
    return [line for line in text.splitlines() if not line.lstrip().startswith("!")]


# ------------------------------------------------------------------------------- patches


def patch(file: str, new: dict[int, Move]) -> Files:
    moves = [new.get(i, move) for i, move in enumerate(program(file).moves)]
    after = program(file).with_moves(tuple(moves))
    files = VENDOR.patch(after, find_robot(PROGRAMS[file]["robot"]))
    assert difference(after, reading(file).again(files)) is None
    return {one.name: one for one in files.values()}


def assert_only(file: str, files: Files, stretches: list[Span], added: str = "") -> None:
    """Nothing but the stretches has another text, and nothing but ``added`` has come."""
    assert list(files) == list(dict.fromkeys(span.file for span in stretches))
    for name, after in files.items():
        before = reading(file).files[name]
        assert after.codec == before.codec
        spans = sorted((s for s in stretches if s.file == name), key=lambda s: s.start)
        at = [0, *(edge for s in spans for edge in (s.start, s.end)), len(before.text)]
        kept = [before.text[a:b] for a, b in zip(at[::2], at[1::2], strict=True)]
        pattern = r"[^\s,;]+".join(map(re.escape, kept))
        assert re.fullmatch(pattern, re.sub(added, "", after.text) if added else after.text)
        assert after.data != before.data and after.data.decode(after.codec) == after.text


def target_groups(file: str) -> Iterator[list[int]]:
    """Moves that read one and the same literal, poses before joint values."""
    groups: defaultdict[tuple[Span | None, ...], list[int]] = defaultdict(list)
    for index, move in enumerate(program(file).moves):
        at = origin(move).target
        if at.numbers:
            groups[at.numbers].append(index)

    def rank(moves: list[int]) -> tuple[bool, bool]:
        first = program(file).moves[moves[0]]
        owned = origin(first).target.ownership is Ownership.OWNED
        return isinstance(first.target, JointTarget), not owned

    yield from sorted(groups.values(), key=rank)


def another_target(move: Move) -> Move:
    target = move.target
    if isinstance(target, JointTarget):
        return replace(move, target=replace(target, joints=(0.0875, *target.joints[1:])))
    x, y, z = target.pose.position
    return replace(
        move, target=replace(target, pose=replace(target.pose, position=(x, y, z + 2e-3)))
    )


@each_program
def test_a_target_is_patched_and_no_other_byte(file: str) -> None:
    moves = program(file).moves
    for group in target_groups(file):
        try:
            files = patch(file, {i: another_target(moves[i]) for i in group})
        except FlybyError:
            continue  # an expression reads it as well
        numbers = origin(moves[group[0]]).target.numbers
        index = 0 if isinstance(moves[group[0]].target, JointTarget) else 2
        changed = numbers[index]
        assert changed is not None
        assert_only(file, files, [changed])
        return
    pytest.fail("no target could be changed")


def executions(file: str, index: int) -> list[int]:
    statement = origin(program(file).moves[index]).statement
    return [i for i, m in enumerate(program(file).moves) if origin(m).statement == statement]


@each_program
def test_a_zone_is_patched_and_no_other_byte(file: str) -> None:
    """A predefined one gives way to a datum of its own, or an own one is changed."""
    new = Radius(0.00325, 0.00425, 0.00425)
    moves = program(file).moves
    index = next(
        (i for i, m in enumerate(moves) if isinstance(m.zone, Radius) and _predefined(m.zone.name)),
        None,
    )
    if index is None:
        own = next(i for i, m in enumerate(moves) if isinstance(m.zone, Radius))
        at = origin(moves[own]).zone
        group = [i for i, m in enumerate(moves) if origin(m).zone.numbers == at.numbers]
        assert_only(file, patch(file, {i: replace(moves[i], zone=new) for i in group}),
                    [span for span in at.numbers if span is not None])  # fmt: skip
        return
    files = patch(file, {i: replace(moves[i], zone=new) for i in executions(file, index)})
    added = r"(\r\n|\r|\n)[ \t]*LOCAL CONST zonedata zFb_3_25:=\[FALSE,3\.25,4\.25,4\.25,0,0,0\];"
    assert_only(file, files, [origin(moves[index]).zone.span], added)


@each_program
def test_a_speed_is_patched_and_no_other_byte(file: str) -> None:
    moves = program(file).moves
    index = next(i for i, m in enumerate(moves) if _plain_speed(m))
    slower = {
        i: replace(moves[i], speed=replace(moves[i].speed, tcp=0.0875, name=None))
        for i in executions(file, index)
    }
    assert_only(file, patch(file, slower), [origin(moves[index]).speed.span])


def _plain_speed(move: Move) -> bool:
    """Of the controller's own, and not scaled by VelSet."""
    at = origin(move).speed
    return at.ownership is Ownership.SHARED and not at.numbers and _predefined(at.datum)


def _predefined(name: str | None) -> bool:
    return name is not None and (
        predefined.zone(name) is not None or predefined.speed(name) is not None
    )
