"""Checks of a vendor's language: reading, writing, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ...core.errors import FlybyError, InputError
from ...core.language import Sources
from ...core.program.program import Program
from ...core.robot.model import Robot
from ...core.vendor import LANGUAGE_PARTS
from .subject import PROGRAM_EXAMPLES, Subject


class LanguageChecks(Subject):
    """What is written is read again, number by number."""

    def test_what_is_missing_is_refused_by_name(self) -> None:
        vendor = self.vendor
        robot = vendor.robot(self.driven_robots()[0])
        uses: dict[str, Callable[[], object]] = {
            "reader": lambda: vendor.read("", "program"),
            "writer": lambda: vendor.write(Program(()), robot),
            "patcher": lambda: vendor.patch(Program(()), robot),
            "recorder": lambda: vendor.record(Program(()), robot, 0.01),
        }
        for part in LANGUAGE_PARTS:
            if getattr(vendor, part) is None:
                with pytest.raises(InputError, match=f"{self.name} has no {part}"):
                    uses[part]()

    def test_robots_of_another_language_are_refused(self) -> None:
        for name, reason in self.vendor.emulation_only.items():
            with pytest.raises(InputError) as caught:
                self.vendor.write(Program(()), self.vendor.robot(name))
            assert reason in str(caught.value)

    def test_a_missing_file_is_said_so(self, tmp_path: Path) -> None:
        self.need("reader")
        for suffix in self.vendor.suffixes:
            with pytest.raises(FlybyError, match="absent"):
                self.vendor.read_file(tmp_path / f"absent{suffix}")

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_what_is_written_is_read_again(self, data: st.DataObject) -> None:
        self.need("reader", "writer")
        robot, program, sources = self._written(data)
        again = self.read_written(sources, robot)
        self.check_same(program, again, sources, robot)

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_writing_again_changes_nothing(self, data: st.DataObject) -> None:
        self.need("reader", "writer")
        robot, _, sources = self._written(data)
        assert dict(self.vendor.write(self.read_back(sources, robot), robot)) == dict(sources)

    def _written(self, data: st.DataObject) -> tuple[Robot, Program, Sources]:
        robot = self.vendor.robot(data.draw(st.sampled_from(self.driven_robots())))
        program = data.draw(self.programs(robot))
        return robot, program, self.written(program, robot)
