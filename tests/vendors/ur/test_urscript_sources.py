"""URScript texts as files hold them, and texts that are damaged."""

import gzip
import os
import random
import re
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError, SourceError
from flyby.core.program.move import MoveL
from flyby.core.program.question import QuestionKind
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_vendor
from flyby.core.source.reading import Reading, ReadOptions
from flyby.core.source.text.files import SourceFile
from flyby.vendors.ur.run.reader import read, read_file

PROGRAM = """def prog():
  # Größe
  set_tcp(p[0.0,0.0,0.1,0.0,0.0,0.0])
  global Waypoint_1_p=p[-.144, -.436, .202, -.001, 3.116, .039]
  global Waypoint_1_q=[-1.6, -1.727, -2.203, -0.808, 1.595, -0.031]
  thread Step_Counter():
    while (True):
      count = count + 1.0
      sync()
    end
  end
  count = 0.0
  run Step_Counter()
  while (True):
    $ 1 "Robot Program"
    $ 2 "Waypoint_1" "breakAfter"
    movej(get_inverse_kin(Waypoint_1_p, qnear=Waypoint_1_q), a=1.3962634, v=1.0471975)
    if (get_standard_digital_in(0) == True):
      movel(pose_trans(Waypoint_1_p, p[0,0,-0.1,0,0,0]), a=1.2, v=0.25, r=0.01)
    end
  end
end
"""


def refusal(text: str) -> str:
    with pytest.raises(SourceError) as caught:
        read(text, "t.script")
    return str(caught.value)


@pytest.mark.parametrize("codec", ["utf-8", "utf-8-sig", "cp1252", "latin-1"])
@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_files_in_all_encodings(tmp_path: Path, codec: str, ending: str) -> None:
    path = tmp_path / "prog.script"
    path.write_bytes(PROGRAM.replace("\n", ending).encode(codec))
    program = find_vendor("ur").read_file(path)
    assert len(program.moves) == 2
    assert program.name == "prog"
    assert isinstance(program.reading, Reading)
    assert program.reading.files[str(path)].data == path.read_bytes()
    assert program.reading.again({}) == program


def test_files_are_read_again_with_changes(tmp_path: Path) -> None:
    path = tmp_path / "prog.script"
    path.write_text(PROGRAM, "utf-8")
    program = read_file(path)
    assert isinstance(program.reading, Reading)
    changed = SourceFile(str(path), PROGRAM.replace("v=0.25", "v=0.5"))
    assert program.reading.again({str(path): changed}).moves[1].speed.tcp == 0.5


def test_other_files_are_executed_before(tmp_path: Path) -> None:
    library, main = tmp_path / "lib.script", tmp_path / "main.script"
    library.write_text("height = 0.25\ndef go(x):\n  movej([x, 0, 0, 0, 0, 0])\nend\n")
    main.write_text("def prog():\n  go(height)\n  movej([1, 0, 0, 0, 0])\nend\n")
    with pytest.raises(SourceError) as caught:
        read_file(main, ReadOptions(others=(library,)))
    assert str(caught.value).startswith(f"{main}:3:9: ")
    main.write_text("def prog():\n  go(height)\nend\n")
    (move,) = read_file(main, ReadOptions(others=(library,))).moves
    assert move.origin is not None
    assert (move.origin.statement.file, move.origin.statement.line) == (str(library), 3)
    assert move.origin.target.numbers[0] is not None
    assert move.origin.target.numbers[0].line == 1


def test_what_a_file_holds_shows_not_its_suffix(tmp_path: Path) -> None:
    text = "def prog():\n  movej([0, -1, 1, 0, 1, 0])\nend\n"
    for name, data in (
        ("plain.urp", text.encode()),
        ("packed.script", gzip.compress(text.encode())),
        ("packed.urp", gzip.compress(text.encode())),
    ):
        path = tmp_path / name
        path.write_bytes(data)
        (move,) = read_file(path).moves
        assert move.target == JointTarget((0, -1, 1, 0, 1, 0))
    with pytest.raises(InputError, match="cannot be read"):
        read_file(tmp_path / "none.script")


@pytest.mark.parametrize(
    ("text", "place", "complaint"),
    [
        ("def f():\n  movej(Q\nend", "3:1", "the keyword 'end' stands where ',' or ')'"),
        ("def f():\n  if x:\n", "3:1", "the file ends where 'end' of 'if' in line 2"),
        ("if True:\n  x = 1\n", "3:1", "'end' of 'if' in line 1"),
        ("x = 1\nend", "2:1", "this 'end' closes nothing"),
        ("else:\nend", "1:1", "this 'else' closes nothing"),
        ("def f()\nend", "1:8", "the line ends where ':'"),
        ("def (x):\nend", "1:5", "stands where a name after 'def'"),
        ("while True\nend", "1:11", "where ':' after the condition"),
        ("x = [1, 2", "1:10", "',' or ']' of a list begun in line 1"),
        ("x = (1 + 2", "1:11", "')' for the bracket opened in line 1"),
        ("x = 1 2", "1:7", "the number 2 stands where the end of the line"),
        ("x = ", "1:5", "the file ends where a value"),
        ("x = * 2", "1:5", "'*' stands where a value"),
        ('x = "abc', "1:5", "no closing quote"),
        ("x = “abc”", "1:5", "is no quote of URScript"),
        ("movej({{ q }})", "1:7", "a template whose placeholders"),
        ("f() = 1", "1:1", "only a variable"),
        ("x = 1e999", "1:5", "is too large"),
        ("x = [1, 1e999]", "1:5", "a number in this list is too large"),
        ("x = " + "9" * 5000, "1:5", "is too large"),
        ("x = 1\0", "1:6", "0x00 does not belong"),
        ("<?xml version='1.0'?>", "1:2", "'?' does not belong here"),
        ("x = " + "(" * 80 + "1" + ")" * 80, "1:66", "more than 60 brackets and blocks"),
        ("if True:\n" * 80 + "end\n" * 80, "61:9", "more than 60 brackets and blocks"),
        ("Loop 3 times:\nend", "1:6", "stands where the end of the line"),
        ("break", "1:1", "'break' stands outside of a loop"),
        ("while 1:\ndef f():\ncontinue\nend\nend", "3:1", "stands outside of a loop"),
        ("x += 1", "1:4", "stands where a value"),
    ],
)
def test_texts_that_are_no_urscript(text: str, place: str, complaint: str) -> None:
    message = refusal(text)
    assert complaint in message
    assert message.startswith(f"t.script:{place}: ")


def test_sums_and_chains_of_any_length_are_no_deep_trees() -> None:
    (move,) = read(f"movej([{'+'.join(['0.001'] * 2000)}, 0, 0, 0, 0, 0])", "t.script").moves
    assert move.target.joints[0] == pytest.approx(2.0)  # type: ignore[union-attr]
    assert "too deeply" in refusal("a = [0]\nx = a" + "[0]" * 5000)


def test_large_values_are_refused_before_they_cost_time() -> None:
    started = time.process_time()
    counting = "x = make_list(9999, 0)\ni = 0\nwhile i < 9000000:\n  x[1] = i\n  i = i + 1\nend"
    read(counting, "t.script")
    refusal("x = 3\nwhile x > 0:\n  x = x * x\nend")
    assert time.process_time() - started < 10


ALPHABET = [
    "movej(",
    "movel(",
    "p[0,0,0,0,0,0]",
    "[0,0,0,0,0,0]",
    ")",
    "(",
    "[",
    "]",
    ",",
    "=",
    "end",
]
ALPHABET += ["def f():", "if x:", "else:", "while True:", "thread t():", "run t()", "kill", "join"]
ALPHABET += [
    "get_digital_in(1)",
    "x",
    "x[0]",
    "1",
    "-2.5",
    '"s"',
    "\n",
    "\n",
    "\n",
    "return",
    "halt",
]
ALPHABET += [
    "get_inverse_kin(",
    "struct(a=1)",
    ".a",
    "and",
    "not",
    "global",
    "True",
    "None",
    "break",
]


@settings(max_examples=300)
@given(st.lists(st.sampled_from(ALPHABET), max_size=40))
def test_any_words_are_read_or_refused(words: list[str]) -> None:
    try:
        read(" ".join(words), "t.script")
    except FlybyError as error:
        assert str(error)


@settings(max_examples=200)
@given(st.randoms(use_true_random=False), st.text(max_size=8))
def test_damaged_programs_are_read_or_refused(chance: random.Random, noise: str) -> None:
    start = chance.randrange(len(PROGRAM))
    end = min(start + chance.randrange(12), len(PROGRAM))
    try:
        read(PROGRAM[:start] + noise + PROGRAM[end:], "t.script")
    except FlybyError as error:
        assert str(error)


LIBRARIES = {
    "lift.script": "z = 0.1\ndef lift(n):\n  movel(p[0.3, 0.1 * n, z, 0, 3, 0])\n  squeeze(1)\nend",
    "hand.script": "def squeeze(width):\n  set_digital_out(0, width > 0)\nend",
    "driving.script": "def park():\n  sleep(1)\nend\nmovej([0, -1, 1, -1, -1, 0])",
    "old.script": "def lift_2():\nend",
    "older.script": "def lift_2():\n  sleep(1)\nend",
    "older_copy.script": "def lift_2():\n  sleep(1)\nend",
}


@pytest.mark.parametrize(
    ("text", "missing", "taken"),
    [
        ("lift(1)\nlift(2)", [], ["lift.script", "hand.script"]),
        ("squeeze(0)\nmovej([0, -1, 1, -1, -1, 0])", [], ["hand.script"]),
        ("park()\nlift(2)", ["park"], ["lift.script", "hand.script"]),
        ("lift_2()", ["lift_2"], []),
        ("def squeeze(n):\n  sleep(n)\nend\nsqueeze(1)", [], []),
    ],
)
def test_files_beside_it_that_define_what_a_script_calls(text, missing, taken, tmp_path) -> None:
    """Those that would drive by themselves are not taken, nor one of several that define it."""
    for name, other in LIBRARIES.items():
        (tmp_path / name).write_text(other, "utf-8")
    path = tmp_path / "main.script"
    path.write_text(text, "utf-8")
    program = read_file(path)
    away = [q.key for q in program.questions if q.kind is QuestionKind.ROUTINE]
    told = [n.message.partition(" defines functions that")[::2] for n in program.notes]
    assert away == missing
    assert [file for file, rest in told if rest] == taken
    doubt = "'lift_2' is defined in old.script, older.script: nobody knows which"
    assert any(doubt in note.message for note in program.notes) == ("lift_2" in missing)
    drives = [move.target.pose.position[1] for move in program.moves if isinstance(move, MoveL)]
    assert drives == [0.1 * int(n) for n in re.findall(r"lift\((\d)\)", text)]


PLACE = "def place_at(n):\n  movel(p[0.3, 0.1 * n, 0.1, 0, 3, 0])\nend"
OTHER = "def place_at(n):\n  sleep(n)\nend"


@pytest.mark.parametrize(
    ("files", "taken"),
    [
        ({"cell/lib/hand.script": PLACE}, "lib/hand.script"),
        ({"hand.script": PLACE}, "../hand.script"),
        ({"lib/hand.script": PLACE}, None),  # nothing tells that both are of one project
        ({"lib/hand.script": PLACE, "README.md": "a cell"}, "../lib/hand.script"),
        ({"a/b/c/hand.script": PLACE, ".git/config": ""}, "../a/b/c/hand.script"),
        ({".old/hand.script": PLACE, "README.md": ""}, None),
        (
            {"lib/hand.script": PLACE, "copy/hand.script": PLACE, "README": ""},
            "../copy/hand.script",
        ),
        ({"lib/hand.script": PLACE, "old/hand.script": OTHER, "README": ""}, None),
        (
            {"lib/place_at.script": PLACE, "old/hand.script": OTHER, "README": ""},
            "../lib/place_at.script",
        ),
        ({"cell/hand.script": PLACE, "lib/hand.script": OTHER, "README": ""}, "hand.script"),
    ],
)
def test_files_of_the_project_that_define_what_a_script_calls(files, taken, tmp_path) -> None:
    root = tmp_path / "project"
    for name, text in {**files, "cell/main.script": "place_at(1)\nplace_at(2)\n"}.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, "utf-8")
    program = read_file(root / "cell" / "main.script")
    told = [n.message.partition(" defines functions that")[::2] for n in program.notes]
    assert [file for file, rest in told if rest] == ([taken] if taken else [])
    assert len(program.moves) == (2 if taken else 0)
    several = OTHER in files.values() and not taken
    said = "'place_at' is defined in ../lib/hand.script, ../old/hand.script"
    assert any(said in note.message for note in program.notes) == several


def test_of_a_huge_tree_a_part_is_looked_at(tmp_path, monkeypatch) -> None:
    looked: list[Path] = []
    scandir = os.scandir
    monkeypatch.setattr(os, "scandir", lambda path: (looked.append(Path(path)), scandir(path))[1])
    for number in range(900):
        (tmp_path / "README" / str(number)).mkdir(parents=True)
    (tmp_path / "README" / "main.script").write_text("place_at(1)\nmovej([0, -1, 1, -1, -1, 0])\n")
    program = read_file(tmp_path / "README" / "main.script")
    assert len(program.moves) == 1 and 500 < len(looked) < 1100
