"""Checks of a vendor's language: reading, writing, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ...core.errors import FlybyError, InputError
from ...core.program.program import Program
from ...core.program.target import JointTarget, Target
from ...core.robot.model import Robot
from ...core.spatial.rotation import rotation_vector
from ...core.vendor import LANGUAGE_PARTS, Sources
from ..strategies import programs
from .subject import EXAMPLES, PROGRAM_EXAMPLES, Subject

ROUNDING = 1e-5
"""m and rad within which a written target is read again (0.01 mm)."""
SIGNS = " \n;:=,.()[]{}\"'!&#%+-*/\\<>09azAZ_\x00\ufeff"


class LanguageChecks(Subject):
    """What is written is read again, and the reader survives any text."""

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

    @EXAMPLES
    @given(text=st.text() | st.text(SIGNS))
    def test_the_reader_survives_any_text(self, text: str) -> None:
        self.need("reader")
        for suffix in self.vendor.suffixes:
            self._read_or_refuse(text, f"hostile{suffix}")

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_the_reader_survives_damage(self, data: st.DataObject) -> None:
        self.need("reader", "writer")
        *_, sources = self._written(data)
        for file, text in sources.items():
            at, cut = data.draw(st.integers(0, len(text))), data.draw(st.integers(0, 20))
            patch = data.draw(st.text(SIGNS, max_size=3))
            self._read_or_refuse(text[:at] + patch + text[at + cut :], file)

    def test_a_missing_file_is_said_so(self, tmp_path: Path) -> None:
        self.need("reader")
        for suffix in self.vendor.suffixes:
            with pytest.raises(FlybyError, match="absent"):
                self.vendor.read_file(tmp_path / f"absent{suffix}")

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_what_is_written_is_read_again(self, data: st.DataObject) -> None:
        self.need("reader", "writer")
        _, program, sources = self._written(data)
        again = self.read_back(sources)
        assert len(again.moves) == len(program.moves)
        for move, copy in zip(program.moves, again.moves, strict=True):
            assert type(copy) is type(move)
            assert type(copy.zone) is type(move.zone)
            assert apart(copy.target, move.target) < ROUNDING

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_writing_again_changes_nothing(self, data: st.DataObject) -> None:
        self.need("reader", "writer")
        robot, _, sources = self._written(data)
        assert dict(self.vendor.write(self.read_back(sources), robot)) == dict(sources)

    def _written(self, data: st.DataObject) -> tuple[Robot, Program, Sources]:
        robot = self.vendor.robot(data.draw(st.sampled_from(self.driven_robots())))
        program = data.draw(programs(robot, self.vendor.label, self.zones(), self.speeds()))
        return robot, program, self.vendor.write(program, robot)

    def _read_or_refuse(self, text: str, file: str) -> None:
        try:
            program = self.vendor.read(text, file)
        except FlybyError as error:
            assert str(error)
        else:
            assert isinstance(program, Program)


def apart(first: Target, second: Target) -> float:
    """Largest difference of two targets in m and rad; infinite between different kinds."""
    if type(first) is not type(second):
        return float("inf")
    outer = np.subtract(first.external, second.external)
    if isinstance(first, JointTarget):
        assert isinstance(second, JointTarget)
        inner = np.subtract(first.joints, second.joints)
    else:
        assert not isinstance(second, JointTarget)
        step = (first.pose.inverse() @ second.pose).matrix()
        inner = np.concatenate([step[:3, 3], rotation_vector(step[:3, :3])])
    return float(np.abs([*inner, *outer]).max())
