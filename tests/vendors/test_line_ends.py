"""What ends a line, in all three languages: LF and CR LF; CR in a text without LF; nothing else."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from flyby.core.errors import SourceError
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.text.files import SourceFile, SourceText, lines_of


@dataclass(frozen=True)
class Language:
    """A program of two moves in a vendor's language, line by line, and what a comment begins with.

    Args:
        second: a move that may stand behind a comment.
    """

    robot: str
    file: str
    comment: str
    lines: tuple[str, ...]
    second: str

    def read(self, text: str) -> Program:
        robot = find_robot(self.robot)
        return find_vendor(self.robot.split("/")[0]).read(text, self.file, robot=robot)


RAPID = Language(
    "abb/irb6640-180-255",
    "a.mod",
    "!",
    (
        "MODULE a",
        "PROC main()",
        "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;",
        "MoveAbsJ [[9,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;",
        "ENDPROC",
        "ENDMODULE",
    ),
    "MoveAbsJ [[5,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;",
)
KRL = Language(
    "kuka/kr30-3",
    "a.src",
    ";",
    ("DEF a()", "INT i", "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}", "PTP {A1 9}", "i=1", "END"),
    "PTP {A1 5}",
)
URSCRIPT = Language(
    "ur/ur5e",
    "a.script",
    "#",
    ("def a():", "  x = 1", "  movej([0,-1,1,0,1,0])", "  movej([1,-1,1,0,1,0])", "end", "a()"),
    "movej([2,-1,1,0,1,0])",
)
LANGUAGES = pytest.mark.parametrize("language", [RAPID, KRL, URSCRIPT], ids=lambda one: one.file)


def lines(program: Program) -> list[int]:
    return [move.origin.statement.line for move in program.moves]


@LANGUAGES
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", "\r\r\n"])
def test_lines_end_alike(language, end) -> None:
    shown = len(end.replace("\r\n", "\n"))
    assert lines(language.read(end.join((*language.lines, "")))) == [1 + 2 * shown, 1 + 3 * shown]


@LANGUAGES
@pytest.mark.parametrize("mark", ["\r", "\f", "\v", "\x85", "\u2028", "\u2029", "\x1c", "\r\r"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_nothing_else_ends_a_comment(language, mark, end) -> None:
    """What stands behind it is not driven; lines are counted as editors count them."""
    comment = f"{language.comment} old{mark}{language.second}"
    text = end.join((*language.lines[:3], comment, *language.lines[3:], ""))
    program = language.read(text)
    assert lines(program) == [3, 5 + mark.count("\r")]
    told = [note for note in program.notes if "carriage return" in note.message]
    assert [note.span.line for note in told] == ([4] if "\r" in mark else [])


def test_of_files_beside_a_program_nothing_is_said(tmp_path) -> None:
    """Only of those that it is made of."""
    joints = "[[9,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    for name in ("one", "other"):
        data = f"MODULE {name}\nCONST jointtarget j{name}:={joints};\n! x\ry\nENDMODULE\n"
        (tmp_path / f"{name}.mod").write_bytes(data.encode())
    (tmp_path / "a.mod").write_text("\n".join(RAPID.lines).replace(joints, "jone"))
    program = find_vendor("abb").read_file(tmp_path / "a.mod", robot=find_robot(RAPID.robot))
    told = [note.span.file for note in program.notes if "carriage return" in note.message]
    assert [Path(file).name for file in told] == ["one.mod"]


@LANGUAGES
def test_a_patch_leaves_every_other_byte_alone(language) -> None:
    comment = f"{language.comment} old\r{language.second}\x85\u2028\f"
    text = "\r\n".join((*language.lines[:3], comment, *language.lines[3:], ""))
    program = language.read(text)
    target = program.moves[1].target
    moved = replace(target, joints=(0.5, *target.joints[1:]), name=None)
    changed = replace(
        program,
        statements=tuple(
            replace(s, target=moved) if s is program.moves[1] else s for s in program.statements
        ),
    )
    vendor = find_vendor(language.robot.split("/")[0])
    (patched,) = vendor.patch(changed, find_robot(language.robot)).values()
    before, after = text.split("\r\n"), patched.text.split("\r\n")
    assert [k for k, (a, b) in enumerate(zip(before, after, strict=True)) if a != b] == [4]
    assert language.read(patched.text).moves[1].target.joints[0] == pytest.approx(0.5)


def test_code_behind_a_lone_return_is_no_line_of_its_own() -> None:
    with pytest.raises(SourceError):
        URSCRIPT.read("\n".join(URSCRIPT.lines[:3]) + "\r" + "\n".join(URSCRIPT.lines[3:]))


def test_lines_of_a_text() -> None:
    assert lines_of("a\r\nb\x85\u2028\fc\nd\re") == ["a", "b\x85\u2028\fc", "d e"]
    assert lines_of("a\rb") == ["a", "b"]
    source = SourceText("a\rb\r\nc\r\r\nd", "x")
    assert [source.span(at, at).line for at in (0, 2, 5, 9)] == [1, 2, 3, 5]
    assert SourceFile("x", "a\rb").data == b"a\rb"
