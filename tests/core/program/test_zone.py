"""Zones: what they refuse, and how they are resized."""

import ast
import math
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.program.zone import Radius
from flyby.core.source.patch.edits import alike
from flyby.vendors.abb.values import predefined

ROOT = Path(__file__).parents[3]
SHELVES = sorted(path.name for path in (ROOT / ".typing" / "flyby").iterdir() if path.is_dir())
RADII = st.floats(1e-4, 0.3)
PARTS = ("tcp", "reorientation", "external", "angle", "external_linear", "external_angular")


@given(RADII, RADII)
def test_one_distance_for_all_stays_one(old: float, new: float) -> None:
    assert Radius(old, old, old, name="r").resized(new) == Radius(new, new, new)
    assert Radius(old).resized(new) == Radius(new)


@given(st.builds(Radius, RADII, RADII, RADII, RADII, RADII, RADII), RADII)
def test_growing_and_shrinking_undo_each_other(zone: Radius, tcp: float) -> None:
    other = zone.resized(tcp)
    back = other.resized(zone.tcp)
    assert other.tcp == tcp and back.tcp == zone.tcp
    for part in PARTS:
        ratio = getattr(other, part) / getattr(zone, part)
        assert ratio == pytest.approx(tcp / zone.tcp)
        assert getattr(back, part) == pytest.approx(getattr(zone, part))


def test_predefined_zones_are_in_proportion() -> None:
    first, second = predefined.zone("z10"), predefined.zone("z50")
    assert isinstance(first, Radius)
    assert isinstance(second, Radius)
    assert alike(first.resized(second.tcp), replace(second, name=None))


@pytest.mark.parametrize("wrong", [-0.01, math.nan, math.inf])
def test_no_radius_is_refused(wrong: float) -> None:
    with pytest.raises(InputError, match=r"Radius\.tcp must be zero or more"):
        Radius(0.01).resized(wrong)


def test_a_radius_of_zero_has_no_proportions() -> None:
    with pytest.raises(InputError, match="no proportions"):
        Radius(0.0, 0.01).resized(0.02)


@given(RADII)
def test_parts_that_are_not_stated_are_those_of_the_tcp(tcp: float) -> None:
    whole = Radius(tcp, tcp, tcp, name="r")
    for zone in (Radius(tcp, name="r"), Radius(tcp, tcp, name="r"), whole):
        assert zone.with_one_distance() == whole


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_one_distance_is_refused_to_parts_of_their_own(factor: float) -> None:
    """Whether the TCP's radius was made smaller or larger than the others."""
    for parts in ((0.02, 0.0), (0.0, 0.02), (0.02, 0.02)):
        with pytest.raises(InputError, match=r"make them equal \(zone.resized"):
            Radius(0.02 * factor, *parts).with_one_distance()


@pytest.mark.parametrize("shelf", [*SHELVES, "benchmarks", "examples"])
def test_no_stop_is_told_from_a_zone_by_one_of_the_stops(shelf: str) -> None:
    """`FINE` is a stop that a program says; one that no program says is a stop as well."""
    for path in (ROOT / shelf).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not isinstance(node, ast.Compare):
                continue
            sides = [node.left, *node.comparators]
            stops = [one for one in sides if isinstance(one, ast.Name) and one.id == "FINE"]
            assert not stops, f"{path}:{node.lineno}: isinstance(zone, Fine)"
