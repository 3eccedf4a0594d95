"""What a patch hands out goes only into the folder it is written to, and runs there alone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.patch.edits import difference
from flyby.core.source.reading import named_apart
from flyby.core.source.text.files import SourceFile
from flyby.tasks.files.places import FilePlaces

KUKA, ROBOT = find_vendor("kuka"), find_robot("kuka/kr30-3")
SRC = """DEF job()
$VEL_AXIS[1]=50
$APO.CDIS=20
PTP XP1
PTP XP2 C_DIS
PTP XP3
UNUSED()
END
DEF UNUSED()
END
"""
DAT = "DEFDAT job\n{}ENDDAT\n".format(
    "".join(f"DECL E6AXIS XP{k}={{A1 {10 * k},A2 -90,A3 90,A4 0,A5 30,A6 0}}\n" for k in (1, 2, 3))
)


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Program:
    """A program of two files, named by a path with ``..`` in it."""
    (tmp_path / "here").mkdir()
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "job.src").write_text(SRC)
    (tmp_path / "there" / "job.dat").write_text(DAT)
    monkeypatch.chdir(tmp_path / "here")
    return KUKA.read_file("../there/job.src", robot=ROBOT)


def other_target(program: Program) -> Program:
    """A change of the ``.dat`` alone."""
    first, *rest = program.moves
    assert isinstance(first.target, JointTarget)
    target = replace(first.target, joints=(0.2, *first.target.joints[1:]))
    return program.with_moves((replace(first, target=target), *rest))


def other_zone(program: Program) -> Program:
    """A change of the ``.src`` alone."""
    moves = list(program.moves)
    moves[1] = replace(moves[1], zone=Radius(0.01, 0.01, 0.01))
    return program.with_moves(tuple(moves))


@pytest.mark.parametrize("change", [other_target, other_zone])
def test_what_is_written_to_a_folder_runs_there_alone(job: Program, change, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    wanted = change(job)
    files = KUKA.patch(wanted, ROBOT)
    assert len(files) == 1 and set(files) < {"job.src", "job.dat"}
    for name, file in files.items():
        (tmp_path / "here" / name).write_bytes(file.data)
    assert (tmp_path / "there" / "job.src").read_text() == SRC
    assert (tmp_path / "there" / "job.dat").read_text() == DAT
    out = tmp_path / "out"
    places = FilePlaces(out, False, [tmp_path / "there" / "job.src"], False)
    assert {path.name for path in places.write(files, job)} == {"job.src", "job.dat"}
    alone = KUKA.read_file(out / "job.src", robot=ROBOT)
    assert difference(wanted, alone) is None


def test_in_place_only_what_changed_is_written(job: Program, tmp_path: Path) -> None:
    places = FilePlaces(None, True, [Path("../there/job.src")], False)
    assert places.write(KUKA.patch(other_target(job), ROBOT), job) == [Path("../there/job.dat")]
    assert (tmp_path / "there" / "job.src").read_text() == SRC
    assert difference(other_target(job), KUKA.read_file("../there/job.src", robot=ROBOT)) is None


def test_files_called_alike_keep_apart() -> None:
    def named(*names: str) -> list[str]:
        return list(named_apart({name: SourceFile(name, "") for name in names}))

    assert named("/a/b/x.mod") == ["x.mod"] and named("../../x.mod") == ["x.mod"]
    assert named("../a/x.mod", "../b/x.mod", "../y.mod") == ["a/x.mod", "b/x.mod", "y.mod"]
