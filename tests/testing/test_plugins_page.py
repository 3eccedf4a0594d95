"""Every block of docs/guides/plugins.md is executed, in its order, as one plugin."""

from __future__ import annotations

import re
import sys
import tomllib
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

from flyby.core import hookspec, vendor
from flyby.core.errors import InputError, SourceError
from flyby.core.motion.model.provenance import read_provenance
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.speed import Speed
from flyby.core.program.target import PoseTarget
from flyby.core.registry import Registry
from flyby.core.source.reading import ReadOptions
from flyby.core.source.write.refusals import check_said
from flyby.core.spatial.pose import Pose
from flyby.testing.conformance import VendorConformance

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "guides" / "plugins.md").read_text("utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    """The page as a module that stands beside the template's robot."""
    folder = tmp_path_factory.mktemp("acme")
    arm = (ROOT / "testing" / "skeleton" / "arm-1.toml.txt").read_text("utf-8")
    (folder / "arm-1.toml").write_text(arm.replace("@name@", "acme"), "utf-8")
    module = ModuleType("flyby_acme")
    module.__file__ = str(folder / "page.py")
    sys.modules[module.__name__] = module  # where dataclasses look for it
    for block in blocks("python"):
        exec(compile(block, "docs/guides/plugins.md", "exec"), vars(module))
    return module


def test_every_block_is_of_a_language_that_is_tested() -> None:
    assert len(re.findall(r"^```\w*$", PAGE, re.MULTILINE)) == 2 * (
        len(blocks("python")) + len(blocks("toml")) + len(blocks("text"))
    )
    assert len(blocks("python")) >= 7


def test_the_page_is_a_plugin(page: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    entry = next(data for data in map(tomllib.loads, blocks("toml")) if "project" in data)
    ((group, points),) = entry["project"]["entry-points"].items()
    assert group == hookspec.GROUP
    ((name, module),) = points.items()
    monkeypatch.setitem(sys.modules, module, page)
    point = metadata.EntryPoint(name, module, group)
    vars(point).update(dist=SimpleNamespace(name="flyby-acme"))
    registry = Registry.discover([point])
    assert registry.broken == ()
    assert registry.robot_names == ("acme/arm-1",)


def test_the_provenance_of_the_page_is_read() -> None:
    data = next(data for data in map(tomllib.loads, blocks("toml")) if "fits" in data)
    found = read_provenance(data["fits"], data["provenance"])
    assert [origin.status for origin in found.values()] == ["assumed", "published", "fitted"]


def test_the_suite_of_the_page_is_the_suite(page: ModuleType) -> None:
    assert issubclass(page.TestAcme, VendorConformance)
    assert page.TestAcme.name == "acme"


def test_the_golden_texts_of_the_page_are_what_its_plugin_reads(
    page: ModuleType, tmp_path: Path
) -> None:
    golden = next(text for text in blocks("toml") if "[[texts]]" in text)
    (tmp_path / "golden.toml").write_text(golden, "utf-8")

    class Suite(page.TestAcme):  # type: ignore[name-defined, misc]
        vendor = page.acme()

    suite = Suite()
    suite.golden = tmp_path / "golden.toml"
    suite.test_golden_texts_mean_what_their_author_says()
    suite.test_golden_moves_stand_where_their_author_says()
    suite.test_golden_robots_are_those_of_their_data_sheets()
    suite.test_golden_poses_show_which_way_each_joint_counts()
    suite.test_golden_texts_cover_the_language()
    (tmp_path / "golden.toml").write_text(golden.replace("0.25 }", "0.2 }"), "utf-8")
    suite = Suite()
    suite.golden = tmp_path / "golden.toml"
    with pytest.raises(AssertionError, match=r"speed\.tcp: 0\.2 stated, 0\.25 read"):
        suite.test_golden_texts_mean_what_their_author_says()


def test_a_language_without_arcs_passes_the_suite(page: ModuleType, tmp_path: Path) -> None:
    golden = next(text for text in blocks("toml") if "[[texts]]" in text)
    golden, _, arc = golden.rpartition("\n[[texts.statements]]")
    assert "MoveC" in arc
    golden = golden.replace("MOVEC P[12] P[14] 100 STOP\n", "").replace(
        "none = [", 'none = ["MoveC", '
    )
    (tmp_path / "golden.toml").write_text(golden, "utf-8")
    speaks = replace(page.SPEAKS, arc_orientations=frozenset())
    page.SPEAKS, kept = speaks, page.SPEAKS
    try:

        class Suite(page.TestAcme):  # type: ignore[name-defined, misc]
            vendor = replace(page.acme(), speaks=speaks)

        suite = Suite()
        suite.golden = tmp_path / "golden.toml"
        assert suite.kinds == (MoveJ, MoveL)
        suite.test_golden_texts_cover_the_language()
        suite.test_every_word_of_the_dialect_is_written_and_read()
        suite.test_speeds_that_are_not_needed_may_be_left_out()
        suite.test_what_is_written_is_read_again()
        suite.test_a_patch_gives_the_changed_program()
        suite.test_what_is_written_moves_alike()
        here = PoseTarget(Pose((0.5, 0.0, 0.5)))
        arc = MoveC(here, Speed(tcp=0.1), via=here, orientation=ArcOrientation.FIXED_FRAME)
        with pytest.raises(InputError, match="ACME has no arcs: use lines"):
            check_said(arc, speaks, "ACME")
    finally:
        page.SPEAKS = kept


def test_the_language_of_the_page_keeps_its_promises(page: ModuleType) -> None:
    acme = page.acme()
    robot = acme.robot("arm-1")
    text = "POINT P[1] 0 10 20 0 50 0\nMOVEJ P[1] 50 STOP\n"
    program = acme.read(text, "a.acme")
    assert dict(acme.write(program, robot)) == {"main.acme": text}
    (move,) = program.moves
    changed = program.with_moves((replace(move, zone=page.PASS.sized(0.3)),))
    (file,) = acme.patch(changed, robot).values()
    assert file.text == text.replace("STOP", "PASS 30")
    with pytest.raises(SourceError, match=r"a\.acme:3:1"):
        acme.read(text + "MOVEX P[1]\n", "a.acme")
    with pytest.raises(InputError, match="absent"):
        acme.read_file("absent.acme")
    assert page.Elbow(True).mismatch(page.Elbow(False)) == 1.0


def test_the_special_motions_of_the_page_drive(page: ModuleType) -> None:
    language = page.Language()
    language.grammar = page.Special
    point = "POSE P[2] 400 0 300 180 0 90\n"
    text = f"{point}RAISED 50 MOVEL P[2] 200 STOP\nLIFT 10\n"
    raised, lifted = language.read(text, "a.acme", ReadOptions()).moves
    heights = [move.target.pose.position[2] for move in (raised, lifted)]
    assert heights == pytest.approx([0.35, 0.36])
    with pytest.raises(SourceError, match="no pose that the text states"):
        language.read(f"{point}LIFT 10\n", "a.acme", ReadOptions())


def test_the_language_of_the_page_is_that_of_the_skeleton() -> None:
    skeleton = (ROOT / "testing" / "skeleton" / "language.py.txt").read_text("utf-8")
    skeleton = skeleton.replace("@NAME@", "ACME").replace("@name@", "acme")
    own = [block for block in blocks("python") if block in skeleton]
    assert len(own) >= 5
    _, _, code = skeleton.split('"""', 2)  # what it says of itself is not on the page
    assert sum(map(len, own)) > 0.9 * len(code)


def test_every_part_and_every_method_of_the_suite_is_told() -> None:
    for part in vendor.Vendor.__dataclass_fields__:
        assert f"`{part}`" in PAGE or f"{part}=" in PAGE, part
    for name in ("flyby_register_vendors", "register.add"):
        assert name in PAGE
