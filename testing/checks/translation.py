"""Checks of translations: to every other vendor and back, written, read, emulated, compared.

Both sides drive the same arm, so that any program can be carried, and what differs is the
languages' and the motion models' doing: corners are cut alike, and times are alike, or the
translation says that they are not.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import pytest

from ...core.arrays import FloatArray
from ...core.errors import FlybyError
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run
from ...core.program.move import Move, MoveJ, MoveL
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import PoseTarget
from ...core.program.zone import FINE
from ...core.registry import vendors
from ...core.robot.model import Robot
from ...core.translation.overrides import accelerates_by
from ...core.translation.translate import Translation, translate
from ...core.vendor import Vendor
from ..observation import Observed
from ..strategies import joint_target
from .subject import Subject
from .telling import text_of, told

SAME_PLACE = 1e-5
"""m by which ends of moves may be off: languages round to 0.001 mm."""
SAME_PATH = 5e-5
"""m by which the TCP's paths may differ, corners included."""
SAME_TIME = 0.03
"""Share by which times may differ."""
_SHARE, _LINE = 0.2, 0.05
"""Of acceleration, and m of lines that are too short to reach their speed with it."""
_SHORT = 1e-5
"""s between samples; differences over less say nothing of speeds."""
_OFTEN = 4
"""Of so many samples one is looked at."""


@dataclass(frozen=True)
class _Side:
    """A vendor and its robot, with a program and what came of it."""

    vendor: Vendor
    robot: Robot
    program: Program
    run: Run

    def __str__(self) -> str:
        return self.vendor.name

    @cached_property
    def seen(self) -> Observed:
        """What was driven."""
        return Observed.of(self.robot, self.run)

    @cached_property
    def ends(self) -> FloatArray:
        """(M, 3) m in the world, where the flange stands at the ends of legs."""
        return self.robot.forward(self.run.path.route.ends.q[:, 1])[1]

    @cached_property
    def path(self) -> FloatArray:
        """(S, 3) m in the world, the TCP's."""
        seen = self.seen
        tools = np.array([move.tool.tcp.position for move in seen.moves])
        held = np.array([move.tool.robot_held for move in seen.moves])
        offset = np.where(held[:, None], tools, 0.0)[seen.segment]
        return np.asarray(seen.position + np.einsum("sij,sj->si", seen.rotation, offset))

    @cached_property
    def fastest(self) -> FloatArray:
        """(M,) m/s, the TCP's greatest speed on each leg."""
        step = np.linalg.norm(np.diff(self.path, axis=0), axis=1)
        time = np.diff(self.seen.t)
        found = np.zeros(len(self.seen.moves))
        leg = self.seen.segment
        # From one leg to the next the tool may be another, and its TCP elsewhere without a way.
        counts = (time > _SHORT) & (leg[:-1] == leg[1:])
        speed = np.where(counts, step / np.maximum(time, _SHORT), 0.0)
        np.maximum.at(found, leg[:-1], speed)
        return found


class TranslationChecks(Subject):
    """What is carried to another language and back drives the same way, or says where not."""

    def test_programs_are_carried_to_other_vendors_and_back(self) -> None:
        self.need("reader", "writer")
        if self.vendor.speaks is None:
            pytest.skip(f"{self.name} does not say what its language has words for")
        for text in self.golden_texts:
            if text.robot not in self.driven_robots():
                continue
            robot = self.vendor.robot(str(text.robot))
            program = self.read_golden(text)
            own = _Side(self.vendor, robot, program, _driven(self.vendor, robot, program))
            for other in self.other_vendors():
                same_arm = replace(robot, name=f"{other.name}/{text.robot}")
                there = self._carried(own, other.with_robot(same_arm), same_arm)
                self._carried(there, self.vendor, robot)

    def test_reduced_accelerations_are_carried_or_told(self) -> None:
        """Whether or not a golden text has them: other languages' programs do."""
        self.need("reader", "writer")
        if self.vendor.speaks is None:
            pytest.skip(f"{self.name} does not say what its language has words for")
        for source, target in self._pairs_with_shares():
            robot = self.usual_robot
            arm = self.driven_robots()[0]
            arms = [replace(robot, name=f"{one.name}/{arm}") for one in (source, target)]
            program = _with_share(source, arms[0], self.stand)
            source, target = (v.with_robot(a) for v, a in zip((source, target), arms, strict=True))
            run = _driven(source, arms[0], program)
            self._carried(_Side(source, arms[0], program, run), target, arms[1], faster=False)

    def _pairs_with_shares(self) -> Iterator[tuple[Vendor, Vendor]]:
        """From another language that has shares of acceleration, and to another one."""
        others = list(self.other_vendors())
        yield from [(one, self.vendor) for one in others if _share(one) is not None][:1]
        yield from [(self.vendor, one) for one in others if _share(self.vendor) is not None][:1]

    def other_vendors(self) -> Iterator[Vendor]:
        """The installed vendors with a language, but this one."""
        for other in vendors():
            if other.name != self.name and other.writer and other.reader and other.speaks:
                yield other

    def _carried(self, source: _Side, vendor: Vendor, robot: Robot, faster: bool = True) -> _Side:
        """The program on the other side, after a comparison; ``faster``: whether it may be, where
        the other controller or its settings held the robot."""
        what = f"translated from {source} into {vendor.name}"
        try:
            made = translate(source.program, (source.vendor, source.robot), (vendor, robot))
            sources = vendor.write(made.program, robot, made.options)
            again = self.read_back(sources, robot, vendor)
            carried = _Side(vendor, robot, again, _driven(vendor, robot, again))
        except FlybyError as error:
            look = "Dialect: what it says there are words for is used by translations"
            shown = "\n".join(map(repr, source.program.statements))
            raise AssertionError(told(f"{what}: {error}", written=shown, look=look)) from error
        _compare(what, source, carried, made, text_of(sources), faster)
        return carried


def _driven(vendor: Vendor, robot: Robot, program: Program) -> Run:
    return Controller(vendor, robot).run(program)


def _share(vendor: Vendor) -> str | None:
    """The number by which a language has lines accelerated less."""
    return None if vendor.speaks is None else accelerates_by(vendor.speaks.line)


def _with_share(vendor: Vendor, robot: Robot, stand: tuple[float, ...]) -> Program:
    """Joint moves and lines so short that accelerations decide on their times."""
    spoken, share = vendor.speaks, _share(vendor)
    assert spoken is not None and share is not None
    tcp = min(1.0, spoken.fastest)
    numbers: dict[str, Any] = {"tcp": tcp, spoken.pace: tcp, share: _SHARE}
    line = Speed(**{name: numbers[name] for name in ("tcp", share)})
    joint = Speed(**{name: numbers[name] for name in (spoken.pace, share)})
    first, home = joint_target(robot, np.array(stand)), robot.flange_pose(np.array(stand))
    turned = (np.clip(stand[0] + 0.3, None, robot.limits.upper[0]), *stand[1:])
    external = first.external
    x, y, z = home.position
    nearer = 1 - _LINE / max(math.hypot(x, y), _LINE)  # to the base: farther may be out of reach
    away = PoseTarget(replace(home, position=(nearer * x, nearer * y, z)), None, external)
    moves = (
        MoveJ(first, joint, FINE),
        MoveJ(joint_target(robot, np.array(turned)), joint, FINE),
        MoveJ(first, joint, FINE),
        MoveL(away, line, FINE),
        MoveL(PoseTarget(home, None, external), line, FINE),
    )
    return Program(moves, "shares")


def _compare(
    what: str, one: _Side, other: _Side, made: Translation, text: str, faster: bool
) -> None:
    lost = [note.message for note in made.losses]
    ends = [side.ends for side in (one, other)]
    same = ends[0].shape == ends[1].shape and np.abs(ends[0] - ends[1]).max() < SAME_PLACE
    assert same, told(
        f"{what}, moves end elsewhere",
        written=f"{ends[0].tolist()} m",
        read=f"{ends[1].tolist()} m\n{text}",
        look="targets, frames and tools, and the form of orientations in Dialect",
    )
    away = 0.0 if _says(lost, "passes", "stops") else _apart(one, other)
    assert away < SAME_PATH, told(
        f"{what}, the TCP leaves the path by {1e3 * away:.3f} mm, and no loss says so",
        read=text,
        look="zones: kinds in Dialect, and the unit that the language says them in",
        lines=lost,
    )
    times = [side.run.duration for side in (one, other)]
    least = 0.0 if faster else (1 - SAME_TIME) * times[0]
    as_long = least < times[1] < (1 + SAME_TIME) * times[0]
    assert as_long or _says(lost, "takes", "slower"), told(
        f"{what}, it takes {times[1]:.3f} s instead of {times[0]:.3f} s, and no loss says so",
        read=text,
        look="speeds: pace, speeds, needs and share_step in Dialect, and their units",
        lines=lost,
    )
    programmed = np.array([_programmed(move) for move in one.seen.moves])
    most = np.where(np.isfinite(programmed), np.maximum(one.fastest, programmed), np.inf)
    over = np.flatnonzero(other.fastest > (1 + SAME_TIME) * most)
    assert not len(over), told(
        f"{what}, the TCP is driven faster than was programmed on leg {over[0] + 1}",
        written=f"{most[over[0]]:.4f} m/s",
        read=f"{other.fastest[over[0]]:.4f} m/s\n{text}",
        look="speeds: pace, speeds and needs in Dialect, and their units",
    )


def _programmed(move: Move) -> float:
    """m/s that a line or an arc states; infinite where it states none, or a time."""
    tcp = None if isinstance(move, MoveJ) or move.speed.duration else move.speed.tcp
    return math.inf if tcp is None else tcp


def _says(lost: list[str], *words: str) -> bool:
    return any(word in one for one in lost for word in words)


def _apart(one: _Side, other: _Side) -> float:
    """m, how far the TCP's path on either side is from the other's at most."""
    return max(_away(one.path, other.path), _away(other.path, one.path))


def _away(points: FloatArray, line: FloatArray) -> float:
    """Greatest distance of points (S, 3) from a polyline (T, 3)."""
    start, step = line[:-1], np.diff(line, axis=0)
    square = np.maximum((step**2).sum(axis=1), 1e-18)
    most = 0.0
    for point in points[::_OFTEN]:
        share = np.clip(((point - start) * step).sum(axis=1) / square, 0.0, 1.0)
        nearest = start + share[:, None] * step
        most = max(most, float(np.linalg.norm(nearest - point, axis=1).min()))
    return most
