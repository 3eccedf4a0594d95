"""Conformance of what distributions add beside vendors; an author subclasses what they have::

from flyby.testing.extensions import RobotPackConformance

class TestRobots(RobotPackConformance):
    plugin = flyby_acme.robots      # the module that the entry point names
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import find, given, settings
from hypothesis import strategies as st

from ..core.errors import InputError, MotionError
from ..core.lint.check import OtherRules, check
from ..core.motion.emulator.controller import Controller
from ..core.motion.emulator.run import Run
from ..core.plugins.loading import Offers, offers_of
from ..core.program.program import Program
from ..core.registry import find_robot, find_vendor, installed
from ..core.robot.model import Robot
from ..core.vendor import Vendor
from .checks.catalogue import CatalogueChecks
from .checks.subject import PROGRAM_EXAMPLES
from .strategies import programs

ROBOT = "abb/irb1200-5-090"
"""Whose programs are driven where it does not matter."""
OTHER_LOGS: Mapping[str, bytes] = {
    "plain.csv": b"t,q1,q2,q3,q4,q5,q6\n0,0,0,0,0,0,0\n0.01,0,0,0,0,0,0\n",
    "rtde.csv": b"timestamp,actual_q_0,actual_q_1\n0,0,0\n0.01,0,0\n",
    "egm.csv": b"TIMESTAMP,R_FB_POS_RJ1\n0,0\n4,0\n",
    "rsi.csv": b"IPOC;A1;A2\n0;0;0\n4;0;0\n",
    "empty": b"",
    "binary": bytes(range(256)),
}
"""What is no stranger's log: beginnings of flyby's own forms, and files of nothing."""


class _Offered:
    """What a plugin hands over where all others are installed.

    Attributes:
        plugin: the module or object that the entry point names.
    """

    plugin: Any

    @cached_property
    def offers(self) -> Offers:
        """What it registers."""
        own = installed()
        return offers_of(self.plugin, "plugin", Offers(vendors=dict(own.vendors)))


class RobotPackConformance(_Offered, CatalogueChecks):
    """Robots that a distribution adds to a vendor are sound, as those of a vendor are."""

    def _packed(self) -> Vendor:
        packs = {name.partition("/")[0] for name in self.offers.robots}
        assert len(packs) == 1, f"robots of one vendor are checked at a time, not {packs or 'none'}"
        (vendor,) = packs
        own = {name.partition("/")[2]: load for name, load in self.offers.robots.items()}
        return replace(find_vendor(vendor), robots=own, robot_motion={}, emulation_only={})

    @cached_property
    def vendor(self) -> Vendor:
        """The vendor with these robots alone."""
        return self._packed()

    @cached_property
    def name(self) -> str:  # type: ignore[override]
        """The vendor's."""
        return self.vendor.name

    def test_its_robots_are_driven(self) -> None:
        for robot in map(self.vendor.robot, self.vendor.robots):
            assert Controller(self.vendor, robot).run(_short(self.vendor, robot)).duration > 0


@dataclass(frozen=True)
class GoldenLog:
    """A file as its recorder writes it, beside what its author knows it says.

    Args:
        form: name of the `LogForm`.
        file: name of the file.
        data: its bytes.
        robot: whose log it is.
        t: times, s.
        q: of each time the axes, rad and m.
    """

    form: str
    file: str
    data: bytes
    robot: str
    t: Sequence[float]
    q: Sequence[Sequence[float]]


class LogConformance(_Offered):
    """Logs are read as their author knows them, and other files left alone.

    Attributes:
        logs: one of each form at least.
    """

    logs: Sequence[GoldenLog]

    def test_every_form_has_a_golden_log(self) -> None:
        assert {log.form for log in self.logs} == set(self.offers.logs)

    def test_golden_logs_say_what_their_author_knows(self, tmp_path: Path) -> None:
        for log in self.logs:
            path = _written(tmp_path / log.file, log.data)
            found = [n for n, form in self.offers.logs.items() if form.recognises(path)]
            assert found == [log.form], log.file
            samples = self.offers.logs[log.form].read(path, find_robot(log.robot))
            assert samples.t == pytest.approx(np.array(log.t), abs=1e-9), log.file
            assert samples.q == pytest.approx(np.array(log.q), abs=1e-9), log.file

    def test_other_files_are_left_alone(self, tmp_path: Path) -> None:
        for name, data in OTHER_LOGS.items():
            path = _written(tmp_path / name, data)
            for form in self.offers.logs.values():
                assert not form.recognises(path), f"{form.name} takes {name}, which is another's"

    def test_damaged_logs_are_refused_or_read(self, tmp_path: Path) -> None:
        for log in self.logs:
            read = self.offers.logs[log.form].read
            for number, data in enumerate(_damaged(log.data)):
                path = _written(tmp_path / f"{number}-{log.file}", data)
                try:
                    samples = read(path, find_robot(log.robot))
                except InputError:
                    continue
                assert len(samples.t) == len(samples.q)


class ExporterConformance(_Offered):
    """Runs become bytes, the same every time."""

    def test_a_run_is_exported(self) -> None:
        run = _run()
        for exporter in self.offers.exporters.values():
            made = exporter.export(run)
            assert isinstance(made, bytes) and made, exporter.name
            assert exporter.export(run) == made, f"{exporter.name} writes something else each time"


class RuleConformance(_Offered):
    """Rules find what their author knows, in the moves that there are.

    Attributes:
        found: ids of the rules' findings and the lines that they are on, by texts of RAPID.
    """

    found: Mapping[str, Sequence[tuple[str, int]]]

    @cached_property
    def rules(self) -> OtherRules:
        """The plugin's."""
        own = self.offers
        return OtherRules(tuple(own.program_rules.values()), tuple(own.run_rules.values()))

    def test_rules_find_what_their_author_knows(self) -> None:
        vendor, robot = find_vendor("abb"), find_robot(ROBOT)
        own = {**self.offers.program_rules, **self.offers.run_rules}
        seen = set()
        for text, wanted in self.found.items():
            program = vendor.read(text, "text.mod", robot=robot)
            findings = check(program, vendor, robot, others=self.rules)
            told = [(one.rule, one.span.line) for one in findings if one.rule in own and one.span]
            assert sorted(told) == sorted(wanted), f"{text}\nfound: {told}"
            seen |= {rule for rule, _ in wanted}
        assert seen == set(own), "no text shows what these rules find"

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_rules_survive_any_program(self, data: st.DataObject) -> None:
        vendor, robot = find_vendor("abb"), find_robot(ROBOT)
        program = data.draw(programs(robot, vendor.label))
        own = {**self.offers.program_rules, **self.offers.run_rules}
        for finding in check(program, vendor, robot, program.start, others=self.rules):
            if finding.rule in own and finding.move is not None:
                assert 0 <= finding.move < len(program.moves)


def _written(path: Path, data: bytes) -> Path:
    path.write_bytes(data)
    return path


def _damaged(data: bytes) -> Iterator[bytes]:
    """Files as full disks and cut lines leave them."""
    for share in (0.3, 0.6, 0.9):
        yield data[: int(share * len(data))]
    lines = data.splitlines(keepends=True)
    yield b"".join(lines[:-1]) + b"\x00" * 20
    yield b"".join(reversed(lines))
    yield data.replace(b"1", b"x")
    yield data.replace(b"0", b"nan")


def _short(vendor: Vendor, robot: Robot) -> Program:
    quiet = settings(PROGRAM_EXAMPLES, database=None)
    return find(
        programs(robot, vendor.label),
        lambda p: _drives(vendor, robot, p),
        settings=quiet,
        random=Random(1),
    )


def _drives(vendor: Vendor, robot: Robot, program: Program) -> bool:
    try:
        Controller(vendor, robot).run(program)
    except MotionError:
        return False
    return True


def _run() -> Run:
    vendor, robot = find_vendor("abb"), find_robot(ROBOT)
    return Controller(vendor, robot).run(_short(vendor, robot))
