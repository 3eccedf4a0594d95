"""Damaged and odd archives: whatever is in them, an archive or a FlybyError."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import FlybyError
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.text.files import SourceFile
from flyby.vendors.kuka.backup.opener import OPENER
from flyby.vendors.kuka.backup.routines import Routines, routines_in

from .archives import archive, kr_c2, written

JUNK = [
    b"",
    b"\x00",
    b"{",
    b"}",
    b"[0]",
    b"9" * 30,
    b"1e308",
    b"\xff\xfe",
    b"\r",
    b"DEF ",
    b"END\r\n",
    b'"',
    b"$config.dat",
    b"#TCP",
]


@given(data=st.data())
def test_damaged_files(tmp_path_factory, data) -> None:
    """Bytes go, or others come, in any file: what is left is opened, or it is said why not."""
    files = dict(data.draw(st.sampled_from([archive, kr_c2]))())
    for _ in range(data.draw(st.integers(1, 4))):
        name = data.draw(st.sampled_from(sorted(files)))
        content = files[name]
        raw = content if isinstance(content, bytes) else content.encode("latin-1")
        start = data.draw(st.integers(0, len(raw)))
        end = data.draw(st.integers(start, min(len(raw), start + 200)))
        files[name] = raw[:start] + data.draw(st.sampled_from(JUNK)) + raw[end:]
        if data.draw(st.integers(0, 4)) == 0:
            del files[name]
    folder = written(tmp_path_factory.mktemp("damaged"), files)
    root = OPENER.root_in(sorted(files))
    if root is None:
        return
    try:
        backup = OPENER.open(folder, folder / root, find_robot)
    except FlybyError:
        return
    assert len(backup.robots) == 1
    robot = backup.robots[0]
    assert robot.robot is not None or robot.lacks
    for task in backup.tasks:
        assert task.main is None or task.main in task.files
        assert len(set(task.files)) == len(task.files)
        for entry in task.entries[:2]:
            beside = [backup.root / name for name in task.files if name != entry.file]
            try:
                find_vendor("kuka").read_file(
                    backup.root / entry.file, entry.name, robot.robot, beside=beside
                )
            except FlybyError as error:
                assert str(error)


names = st.lists(
    st.lists(
        st.sampled_from(["R1", "r1", "KRC", "STEU", "Mada", "System", "Program", "x", "C"]),
        max_size=4,
    ).map("/".join),
    max_size=6,
)
leaves = st.sampled_from(["$machine.dat", "$config.dat", "cell.src", "a.src", "am.ini", "$x", ""])


@given(folders=names, leaf=leaves)
def test_any_folders(folders: list[str], leaf: str) -> None:
    """The root is a folder that holds some of the files."""
    files = [f"{folder}/{leaf}" if folder else leaf for folder in folders]
    root = OPENER.root_in(files)
    assert root is None or not root or any(file.startswith(f"{root}/") for file in files)


@given(text=st.text(alphabet=st.sampled_from("DEF END()GLOBAL PTPLIN\n ;,:abFCT[]"), max_size=120))
def test_any_text_has_routines(text: str) -> None:
    found = Routines(routines_in(SourceFile("x.src", text)))
    for routine in found.all:
        assert (found.moves(routine) or 0) >= routine.moves
        assert found.moves_robot(routine) == bool(found.moves(routine))


def test_what_moves_the_robot() -> None:
    text = """DEF A()
PTP{A1 0}
  lin XP1 C_DIS ; PTP XP2
SPLINE
 SPL XP3
ENDSPLINE
PTP_REL {A1 5}
LINE=3
PTP_SPEED=1
;LIN XP4
GOTO LIN1
END
"""
    (routine,) = routines_in(SourceFile("a.src", text))
    assert routine.moves == 4


def test_routines_that_call_each_other_in_a_ring() -> None:
    text = (
        "".join(f"DEF R{k}()\nR{(k + 1) % 3000}()\nEND\n" for k in range(3000))
        + "DEF M()\nPTP P\nEND\n"
    )
    found = Routines(routines_in(SourceFile("r0.src", text)))
    assert found.moves(found.all[0]) is None
    assert not found.moves_robot(found.all[0]) and found.moves_robot(found.all[-1])
