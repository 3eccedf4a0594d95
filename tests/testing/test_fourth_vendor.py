"""A vendor in one file and one TOML, found through an entry point, passes the suite."""

from __future__ import annotations

import runpy
import sys
from collections.abc import Iterator
from dataclasses import replace
from importlib import metadata, util
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError, SourceError
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import Move, MoveJ, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.registry import Registry
from flyby.core.source.execution.answers import Answers
from flyby.core.vendor import Vendor
from flyby.testing.conformance import VendorConformance
from flyby.testing.strategies import zones

FOLDER = Path(__file__).parents[2] / "examples" / "fourth_vendor"
MODULE = "flyby_example_acme"


def discover() -> Registry:
    """A registry of this plugin alone, loaded as if it were installed."""
    if MODULE not in sys.modules:
        spec = util.spec_from_file_location(MODULE, FOLDER / "acme.py")
        assert spec is not None and spec.loader is not None
        module = sys.modules[MODULE] = util.module_from_spec(spec)
        spec.loader.exec_module(module)
    point = metadata.EntryPoint("acme", MODULE, "flyby")
    vars(point).update(dist=SimpleNamespace(name="flyby-acme"))
    return Registry.discover([point])


@pytest.fixture(scope="module", autouse=True)
def _forget() -> Iterator[None]:
    yield
    sys.modules.pop(MODULE, None)


ACME = discover().find_vendor("acme")


class TestAcmeConformance(VendorConformance):
    name = "acme"
    vendor: Vendor = ACME  # type: ignore[assignment]
    golden = Path(__file__).with_name("acme_golden.toml")
    comment = ";"

    def zones(self, kind: type[Move]) -> st.SearchStrategy[Zone]:
        return zones().map(lambda zone: Radius(zone.tcp) if isinstance(zone, Radius) else FINE)

    def arcs(self) -> st.SearchStrategy[ArcOrientation]:
        return st.just(ArcOrientation.FOLLOWS_ARC)

    def aims(self) -> st.SearchStrategy[type[Target]]:
        return st.just(JointTarget)

    def tools(self) -> st.SearchStrategy[Tool]:
        return st.just(FLANGE)

    def work_objects(self) -> st.SearchStrategy[WorkObject]:
        return st.just(WORLD)

    def loads(self) -> st.SearchStrategy[Load | None]:
        return st.none()


def test_the_plugin_is_one_file_and_one_toml() -> None:
    assert sorted(path.suffix for path in FOLDER.iterdir() if path.is_file()) == [".py", ".toml"]


def test_it_is_found_and_nothing_is_broken() -> None:
    registry = discover()
    assert registry.broken == ()
    assert registry.robot_names == ("acme/swift-6",)
    assert registry.reader_of("x.acme").name == "acme"
    assert registry.find_robot("acme/swift-6").recognised is not None


def test_importing_it_registers_nothing_by_itself() -> None:
    assert "flyby_register_vendors" in runpy.run_path(str(FOLDER / "acme.py"))


HOME = JointTarget((0.0, 0.1, 0.2, 0.0, 0.9, 0.0))


@pytest.mark.parametrize(
    "statement",
    [
        Opaque("SET 1"),
        MoveJ(HOME, Speed(0.5, joint_fraction=0.5)),
        MoveJ(HOME, Speed(0.5), Radius(0.01, 0.02)),
        MoveJ(HOME, Speed(0.5), FINE, Tool("gun")),
        MoveJ(JointTarget(HOME.joints, (1.0,)), Speed(0.5)),
    ],
)
def test_what_the_language_cannot_say_is_refused(statement: object) -> None:
    program = Program((statement,))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="ACME"):
        ACME.write(program, ACME.robot("swift-6"))


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("WAIT 1\nLEAP 1\n", r"job\.acme:2:1: 'LEAP 1' is no ACME statement: unknown word LEAP"),
        ("WAIT 1 +\n", r"job\.acme:1:9: a number or a datum should stand here"),
        ("JUMP 1\n", r"job\.acme:1:1: there is no label 1"),
        ("CALL pik\nROUTINE pick\n", r"unknown routine 'pik': did you mean pick\?.*skip"),
        ("MOVEJ P[2] SPEED 1 - ZONE 0\n", r"unknown point 'P\[2\]': define it"),
        ("MOVEJ DI[1] SPEED 1 - ZONE 0\n", r"a move depends on DI\[1\]: answer it in .*values"),
        ("LABEL 1\nLABEL 1\n", "two labels 1"),
    ],
)
def test_an_error_says_where(lines: str, said: str) -> None:
    with pytest.raises(SourceError, match=said):
        ACME.read(lines, "job.acme")


JOB = """\
POINT P[1] 0.0 0.1 0.2 0.0 0.9 0.0
POINT P[2] 0.1 0.1 0.2 0.0 0.9 0.0
R[1] = 0
LABEL again
MOVEJ P[1] SPEED 0.5 - ZONE 0
IF DI[1] = ON CALL pick
R[1] = R[1] + 1
IF R[1] < 3 JUMP again
WAIT DI[2] = ON
MOVEJ P[2] SPEED 0.5 - ZONE 0.01
ROUTINE pick
MOVEJ 0.0 0.1 (R[1] * 0.1) 0.0 0.9 0.0 SPEED 0.5 - ZONE 0
DO[1] = ON
RETURN
"""


def third_joints(program: Program) -> list[float]:
    return [move.target.joints[2] for move in program.moves if isinstance(move.target, JointTarget)]


def test_jumps_calls_registers_and_points_are_carried_out() -> None:
    program = ACME.read(JOB, "job.acme")
    assert third_joints(program) == [0.2, 0.0, 0.2, 0.1, 0.2, 0.2, 0.2]
    assert [o.text for o in program.statements if isinstance(o, Opaque)] == [
        *["DO[1] = ON"] * 3,
        "WAIT DI[2] = ON",
    ]
    notes = " ".join(note.message for note in program.notes)
    assert "the condition depends on DI[1]: branch 1 of 1, the first that moves" in notes


def test_answers_decide_what_the_lines_leave_open() -> None:
    answers = Answers(values={"di[1]": False})
    assert len(ACME.read(JOB, "job.acme", answers=answers).moves) == 4


ENDLESS = "LABEL again\nMOVEJ P[1] SPEED 0.5 - ZONE 0\n{}JUMP again\nPOINT P[1] 0 0 0 0 0.9 0\n"


@pytest.mark.parametrize(
    ("way_out", "said"),
    [
        ("", "the program is an endless loop (JUMP again): one pass is read"),
        ("IF DI[1] = ON END\n", "its body runs once, and then this way out is taken"),
    ],
)
def test_a_jump_back_that_nothing_known_ends_is_read_once(way_out: str, said: str) -> None:
    program = ACME.read(ENDLESS.format(way_out), "job.acme")
    assert len(program.moves) == 1
    assert any(said in note.message for note in program.notes)


def moved(program: Program, index: int, third: float) -> Program:
    moves = list(program.moves)
    target = moves[index].target
    assert isinstance(target, JointTarget)
    joints = (*target.joints[:2], third, *target.joints[3:])
    moves[index] = replace(moves[index], target=JointTarget(joints))
    return program.with_moves(tuple(moves))


def test_a_number_is_changed_where_it_stands() -> None:
    program = ACME.read(JOB, "job.acme")
    (file,) = ACME.patch(moved(program, 6, 0.3), ACME.robot("swift-6")).values()
    assert file.text == JOB.replace("P[2] 0.1 0.1 0.2", "P[2] 0.1 0.1 0.3")


def test_a_shared_point_is_changed_for_all_or_for_none() -> None:
    text = ENDLESS.format("MOVEJ P[1] SPEED 0.5 - ZONE 0.01\n")
    program = ACME.read(text, "job.acme")
    robot = ACME.robot("swift-6")
    changed = moved(program, 1, 0.3)
    with pytest.raises(FlybyError, match=r"P\[1\] is read by move 1 as well"):
        ACME.patch(changed, robot)
    (file,) = ACME.patch(changed, robot, {"shared": "own"}).values()
    own = "0.0 0.0 0.3 0.0 0.9 0.0"
    assert file.text == text.replace("P[1] SPEED 0.5 - ZONE 0.01", f"{own} SPEED 0.5 - ZONE 0.01")
