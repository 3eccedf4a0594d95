"""The conformance suite finds what is wrong with a vendor."""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from flyby.core.dialect import Dialect
from flyby.core.errors import MotionError
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.program import Program
from flyby.core.registry import find_vendor
from flyby.core.robot.joint import JointLimits
from flyby.core.vendor import Vendor
from flyby.testing.checks import hostility
from flyby.testing.conformance import VendorConformance

from ..vendors.words import AbbWords

SOUND = find_vendor("abb")


class Suite(AbbWords, VendorConformance):
    """The suite about any vendor value; pytest does not collect it by this name."""

    def __init__(self, vendor: Vendor) -> None:
        self.name = vendor.name
        self._vendor = vendor

    @property
    def vendor(self) -> Vendor:
        return self._vendor


def run(vendor: Vendor, check: str) -> None:
    getattr(Suite(vendor), check)()


def robots(**changes: Any) -> dict[str, Any]:
    robot = replace(SOUND.robot("irb1600-6-145"), **changes)
    return {"irb1600-6-145": lambda: robot}


class BrokenLimits:
    """A robot whose first joint cannot move."""

    limits = JointLimits(
        *(SOUND.robot("irb1600-6-145").limits.upper * 0 + x for x in (1, 1, 1, 1, 1))
    )


class Reader:
    """A reader that answers every text in one way."""

    def __init__(self, answer: Any) -> None:
        self._answer = answer

    def read(self, text: str, file: str, options: Any) -> Any:
        if isinstance(self._answer, Exception):
            raise self._answer
        return self._answer

    def read_file(self, path: Any, options: Any) -> Any:
        return self.read("", str(path), options)


class WrongLabel:
    """A label that matches nothing."""

    hint = False

    def admits(self, label: Any) -> bool:
        return False

    def mismatch(self, label: Any) -> float:
        return 1.0


class SameLabel:
    """A label that matches everything."""

    hint = False

    def admits(self, label: Any) -> bool:
        return True

    def mismatch(self, label: Any) -> float:
        return 0.0


def no_provenance() -> MotionModel:
    return replace(SOUND.motion(), provenance={})


def deaf() -> Dialect:
    """A language in whose texts no motion is found: they all count as comments."""
    assert SOUND.speaks is not None and SOUND.speaks.wording is not None
    motions = re.compile(r"\b(?:Move|Trigg)[^;]*;")
    return replace(SOUND.speaks, wording=replace(SOUND.speaks.wording, silent=motions))


@pytest.mark.parametrize(
    ("change", "check"),
    [
        ({"robots": robots(name="abb/other")}, "test_the_robots_load_under_their_names"),
        ({"robots": {"irb": lambda: SimpleNamespace()}}, "test_a_robot_is_loaded_once"),
        ({"robots": {"irb": BrokenLimits}}, "test_limits_are_ordered"),
        ({"robots": robots(origins={})}, "test_figures_state_their_origins"),
        ({"label": lambda robot, q: WrongLabel()}, "test_a_label_matches_itself"),
        ({"label": lambda robot, q: SameLabel()}, "test_a_label_names_one_solution"),
        ({"motion": no_provenance}, "test_every_figure_has_a_provenance"),
        ({"reader": Reader(KeyError("token"))}, "test_the_reader_survives_any_text"),
        ({"reader": Reader(None)}, "test_the_reader_survives_any_text"),
        ({"reader": Reader(Program(()))}, "test_what_is_written_is_read_again"),
        ({"reader": Reader(Program(()))}, "test_writing_again_changes_nothing"),
        ({"speaks": deaf()}, "test_no_use_of_a_changed_datum_escapes"),
    ],
)
def test_a_fault_is_found(change: dict[str, Any], check: str) -> None:
    # As it is, the vendor passes them all (tests/vendors/abb/test_conformance_abb.py).
    # Vendor.write itself refuses texts that are read as another program.
    with pytest.raises((AssertionError, KeyError, ExceptionGroup, MotionError)):
        run(replace(SOUND, **{"robot_motion": {}, "emulation_only": {}, **change}), check)


def test_importing_the_plugins_is_light() -> None:
    """No plugin pulls in what it needs later: numba, pinocchio, trimesh, lark."""
    code = (
        "import sys\n"
        "import flyby.vendors.abb.plugin, flyby.vendors.kuka.plugin, flyby.vendors.ur.plugin\n"
        "print(*{'numba', 'pinocchio', 'trimesh', 'lark', 'scipy', 'numpy'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


class Endless(Reader):
    """A reader whose pattern tries everything."""

    def read(self, text: str, file: str, options: Any) -> Program:
        re.fullmatch(r"(a+)+b", "a" * 60)
        raise AssertionError("nobody waits for this")


def test_a_reader_that_never_ends_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hostility, "LONGEST", 0.2)
    vendor = replace(SOUND, reader=Endless(None), speaks=None)
    with pytest.raises(AssertionError, match=r"is read for more than 0\.2 s of the processor"):
        run(vendor, "test_the_reader_survives_hostile_texts")
