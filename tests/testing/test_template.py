"""The template's plugin: what its golden texts leave out, or deny, is found; it is translated."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.zone import ZoneKind
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import dialect_of
from flyby.core.source.lines.expressions import Spelling
from flyby.core.translation.corners import corners_of
from flyby.core.translation.hand_out import check_driven
from flyby.core.translation.translate import translate
from flyby.tasks.files.new_vendor import new_vendor
from flyby.testing.conformance import VendorConformance

from ..vendors.words import AbbWords

ABB = Path(__file__).parents[1] / "vendors" / "abb" / "golden.toml"

TRAY = Path(__file__).parents[2] / "examples" / "tray.mod"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The template's plugin, and its golden file."""
    folder = tmp_path_factory.mktemp("made") / "flyby-omega"
    new_vendor("omega", folder)
    sys.path.insert(0, str(folder / "src"))
    try:
        from flyby_omega.plugin import vendor
    finally:
        sys.path.remove(str(folder / "src"))
    return vendor(), folder / "tests" / "golden.toml"


@pytest.fixture
def suite(made: Any, tmp_path: Path) -> Callable[[str, str], VendorConformance]:
    """The suite of the plugin whose golden file says something else."""

    def suite(old: str, new: str) -> VendorConformance:
        text = made[1].read_text("utf-8")
        assert old in text
        (tmp_path / "golden.toml").write_text(text.replace(old, new), "utf-8")

        class Suite(VendorConformance):
            name = "omega"
            vendor = made[0]
            golden = tmp_path / "golden.toml"

        return Suite()

    return suite


def test_joints_whose_sign_no_pose_shows_are_named(suite: Any) -> None:
    check = "test_golden_poses_show_which_way_each_joint_counts"
    getattr(suite("none", "none"), check)()
    turned = ", quaternion = [0.4812856, 0.3888906, 0.3069376, 0.7231304]"
    with pytest.raises(AssertionError, match="would if A6 counted the other way"):
        getattr(suite(turned, ""), check)()
    place = "[318.2711, 149.696, 889.5726]"
    whole = f"  {{ joints_deg = [30, -20, 15, 40, -35, 60], position_mm = {place}{turned} }},\n"
    with pytest.raises(AssertionError, match="would if A1, A4, A6 counted the other way"):
        getattr(suite(whole, ""), check)()


def test_a_form_that_no_golden_text_has_is_named(suite: Any) -> None:
    suite("none", "none").test_every_form_of_line_counts_in_a_golden_text()
    row = '[[texts.statements]]\nkind = "Wait"\nduration_s = 0.25\n'
    shorter = suite("WAIT 0.25\n", "")
    said = shorter.golden.read_text("utf-8")
    assert row in said
    shorter.golden.write_text(said.replace(row, ""), "utf-8")
    with pytest.raises(AssertionError, match="is read otherwise without the form wait\n"):
        shorter.test_every_form_of_line_counts_in_a_golden_text()


def speaking(suite: Any, changes: dict[str, str], **parts: Any) -> VendorConformance:
    """The suite of the plugin with another golden file, and with another grammar."""
    found: VendorConformance = suite("none", "none")
    assert isinstance(found.golden, Path)
    text = found.golden.read_text("utf-8")
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    found.golden.write_text(text, "utf-8")
    language = copy(found.vendor.reader)
    language.grammar = type("Other", (language.grammar,), parts)  # type: ignore[union-attr]
    found.__dict__["vendor"] = replace(found.vendor, reader=language)
    return found


TURN = """
[[refused]]
about = "a turn"
says = "may move the robot"
files."main.omega" = "TURN P[1]"
"""


def test_each_word_of_driving_is_in_a_text_that_is_refused(suite: Any) -> None:
    driving, last = re.compile("MOVE|TURN"), "# What must not be"
    with pytest.raises(AssertionError, match="otherwise without 'TURN' of `driving`\n"):
        speaking(suite, {}, driving=driving).test_every_form_of_line_counts_in_a_golden_text()
    more = speaking(suite, {last: f"{TURN}{last}"}, driving=driving)
    more.test_every_form_of_line_counts_in_a_golden_text()


def test_each_sign_decides_something(suite: Any) -> None:
    spelling = Spelling(signs={"!=": "<>", "==": "="})
    both = "otherwise without the sign '!=', the sign '=='\n"
    for changes, unseen in (
        ({}, both),
        ({"R[1] < 1": "R[1] != 1 AND R[1] == 0"}, None),
        ({"R[1] < 1": "R[1] != 1 OR R[1] == 0"}, both),
    ):
        made = speaking(suite, changes, spelling=spelling)
        made.test_golden_texts_mean_what_their_author_says()
        if unseen is None:
            made.test_every_form_of_line_counts_in_a_golden_text()
            continue
        with pytest.raises(AssertionError, match=unseen):
            made.test_every_form_of_line_counts_in_a_golden_text()


def test_numbers_of_two_digits_are_asked_for(suite: Any) -> None:
    check = "test_golden_texts_have_numbers_of_two_digits"
    getattr(suite("none", "none"), check)()
    short = speaking(suite, {"P[12]": "P[3]", "P[14]": "P[4]"})
    short.test_golden_texts_mean_what_their_author_says()
    with pytest.raises(AssertionError, match="for point of the form motion, via of the form"):
        getattr(short, check)()


def test_what_a_line_says_and_nobody_looks_at_is_named(suite: Any) -> None:
    check = "test_each_part_of_a_golden_line_is_asked_for"
    forms = dict(suite("none", "none").vendor.reader.grammar.forms)
    forms["motion"] += r"(?:\s+T=(?P<gun>\d+))?"
    silent = speaking(suite, {"50 PASS 30": "50 PASS 30 T=12"}, forms=forms)
    with pytest.raises(AssertionError, match=r"\s+gun \(12\) of MOVEJ P\[1\] 50 PASS 30 T=12\n"):
        getattr(silent, check)()
    getattr(suite("none", "none"), check)()


def test_each_size_that_has_a_name_is_asked_for(suite: Any) -> None:
    levels = ZoneKind("PASS", None, 0.05, sizes=(0.01, 0.02, 0.05))
    reader = suite("none", "none").vendor.reader
    words = replace(reader.grammar.words, zones={"PASS": levels})
    made = speaking(suite, {"PASS 30": "PASS 1", "PASS 40": "PASS 3"}, words=words)
    spoken = dialect_of(made.vendor.reader.grammar, "; ", tools=False, work_objects=False)  # type: ignore[union-attr]
    made.__dict__["vendor"] = replace(made.vendor, speaks=spoken)
    with pytest.raises(AssertionError, match="no golden text has: zone PASS of 20 mm\n"):
        made.test_golden_texts_cover_the_language()


@pytest.mark.parametrize("word", ["MoveC", "joint target"])
def test_what_is_there_is_not_denied(suite: Any, word: str) -> None:
    wrong = suite('none = ["tool"', f'none = ["{word}", "tool"')
    with pytest.raises(AssertionError, match=rf"none = \['{word}'\] denies what the golden texts"):
        wrong.test_golden_texts_cover_the_language()


@pytest.mark.parametrize(
    ("vendor", "robot"),
    [("abb", "irb120-3-058"), ("kuka", "kr6-r700-sixx"), ("ur", "ur3e")],
)
def test_a_program_for_small_arms_is_translated_both_ways(
    made: Any, vendor: str, robot: str
) -> None:
    """As the page on plugins has it, on arms from 0.5 m on."""
    abb, small, own = find_vendor("abb"), find_robot("abb/irb120-3-058"), made[0]
    arm, other = own.robot("arm-1"), find_vendor(vendor)
    program = abb.read_file(TRAY, robot=small)
    there = translate(program, (abb, small), (own, arm))
    sources = own.write(there.program, arm, {"opaque": "comment"})
    check_driven(there, sources, own, arm)
    again = own.read(sources["Tray.omega"], "tray.omega", robot=arm)
    back = translate(again, (own, arm), (other, other.robot(robot)))
    written = other.write(back.program, other.robot(robot), {"opaque": "comment"})
    check_driven(back, written, other, other.robot(robot))
    assert len(back.program.moves) == len(program.moves) == 14


@pytest.mark.parametrize("radius", [2.0, 6.0])
def test_a_straight_corner_keeps_the_reach_of_its_zone(made: Any, radius: float) -> None:
    """Of a kind by speed nobody knows it before it is driven."""
    abb, small, own = find_vendor("abb"), find_robot("abb/irb120-3-058"), made[0]
    arm = own.robot("arm-1")
    rest = "[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]"
    points = "".join(f"CONST robtarget p{k} := [[320,{60 * k},300],{rest}];\n" for k in range(3))
    zone = f"[FALSE,{radius},{radius},{radius},1,{radius},1]"
    lines = f"MoveJ p0,v200,fine,tool0;\nMoveL p1,v400,{zone},tool0;\nMoveL p2,v400,fine,tool0;\n"
    program = abb.read(f"MODULE M\n{points}PROC main()\n{lines}ENDPROC\nENDMODULE\n", "m.mod")
    there = translate(program, (abb, small), (own, arm)).program
    path = Controller(own, arm).plan(there)
    (reach,) = [one.reach for one in corners_of(path) if one.passed]
    assert reach == pytest.approx(radius / 1000, rel=0.15)


def test_speeds_may_be_shares_of_what_an_arm_can_do(made: Any) -> None:
    """The suite reads for the arm then, as writers do."""
    language = copy(made[0].reader)
    words = replace(language.grammar.words, line={"": Amount("tcp", lambda robot: 2.0 / 100)})
    language.grammar = type("Grammar", (language.grammar,), {"words": words})
    parts = dict.fromkeys(("reader", "writer", "patcher"), language)

    class Suite(VendorConformance):
        name = "omega"
        vendor = replace(made[0], **parts)
        golden = made[1]

    Suite().test_what_is_written_is_read_again()
    Suite().test_files_keep_their_bytes()
    with pytest.raises(AssertionError, match=r"speed\.tcp: 0\.25 stated, 5 read"):
        Suite().test_golden_texts_mean_what_their_author_says()


def test_a_recorder_without_a_golden_recording_is_named(tmp_path: Path) -> None:
    text = ABB.read_text("utf-8")
    line = next(line for line in text.splitlines() if line.startswith("recorded"))
    (tmp_path / "golden.toml").write_text(text.replace(line, ""), "utf-8")

    class Suite(AbbWords, VendorConformance):
        golden = tmp_path / "golden.toml"

    with pytest.raises(AssertionError, match="no golden text has: recording"):
        Suite().test_golden_texts_cover_the_language()
    (tmp_path / "golden.toml").write_text(text.replace("24, lines", "12, lines"), "utf-8")
    with pytest.raises(AssertionError, match="recorded every 12 ms, has no 'ITimer"):
        Suite().test_golden_recordings_log_as_their_author_says()
