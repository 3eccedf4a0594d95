"""A vendor in one file and one TOML, found through an entry point, passes the suite."""

from __future__ import annotations

import runpy
import sys
from collections.abc import Iterator
from importlib import metadata, util
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import strategies as st

from flyby.core.errors import InputError, SourceError
from flyby.core.program.move import ArcOrientation, Move, MoveJ, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, Target
from flyby.core.program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.registry import Registry
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


def test_an_error_says_where() -> None:
    with pytest.raises(SourceError, match=r"job\.acme:2:1: 'JUMP 1' is no ACME statement"):
        ACME.read("WAIT 1\nJUMP 1\n", "job.acme")
