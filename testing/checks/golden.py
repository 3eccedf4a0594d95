"""Checks of golden texts: what an author knows of a language and robots, beside the plugin."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import zip_longest
from typing import Any

import numpy as np
import pytest

from ...core.arrays import FloatArray
from ...core.errors import FaultCause, FlybyError, PluginFault
from ...core.motion.emulator.controller import Controller
from ...core.program.move import Move, MoveC, MoveJ, MoveL, Opaque, Statement
from ...core.program.origin import Ownership
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget, PoseTarget
from ...core.program.tool import FLANGE
from ...core.program.zone import VendorZone, ZoneKind, kind_word, zone_word
from ...core.robot.model import Robot
from ...core.source.write.options import OpaqueStyle
from ...core.spatial.pose import IDENTITY, Pose
from ..golden import LANGUAGE, GoldenText, differences, terms_of
from .subject import Subject
from .telling import line_of, text_of, told

_STANDS = 0.02
"""degrees by which joints may be off: data sheets give 0.1 mm, texts 0.0001 mm."""
_NOWHERE = "the golden text: the robot is taken to stand where its first move ends; add a move"
_PLACE = 2e-4
"""m and dimensionless, of the flange on data sheets."""
_UNLIMITED = {name: getattr(Speed(), name) for name in Speed.__slots__}
_OWNED = {Ownership.DERIVED: "computed target", Ownership.SHARED: "shared datum"}
_HINT = """golden texts are missing: the checks cannot tell mm from m without them. Write
texts as the controller runs them, with what they mean, into a TOML file (`flyby.testing.golden`
says how) and name it: golden = Path(__file__).parent / "golden.toml\""""


class GoldenChecks(Subject):
    """The plugin says what its author knows."""

    def test_there_are_golden_texts(self) -> None:
        if self.vendor.reader is not None:
            assert self.golden is not None, f"{self.name}: {_HINT}"

    def test_golden_texts_mean_what_their_author_says(self) -> None:
        for text in self.golden_texts:
            program = self.read_golden(text)
            pairs = zip_longest(text.statements, program.statements)
            for number, (stated, statement) in enumerate(pairs, 1):
                if stated is None or statement is None:
                    raise AssertionError(_other_statements(text, program))
                wrong = differences(stated, statement, self.signals)
                assert not wrong, told(
                    f"{_place(text, number, statement)} is read otherwise than its author says",
                    lines=[*wrong, f"from {line_of(text.files, statement)}"],
                    look=_first_wrong(wrong),
                )

    def test_golden_texts_are_refused_where_their_author_says(self) -> None:
        """What a plugin would take for something else it does not read."""
        for text in self.golden_refused:
            try:
                program = self.read_files(text)
            except PluginFault:
                raise
            except FlybyError as error:
                said, whole = str(error), text.says.lower() in str(error).lower()
                assert whole, told(
                    f"text {text.about!r} is refused for something else",
                    written=f"{text.says!r}, a part of the message, by the author",
                    read=said,
                    look="what is raised for this line, and what for the lines before",
                )
                continue
            raise AssertionError(
                told(
                    f"text {text.about!r} is read, and refused by its author",
                    written=text.says,
                    read=" ".join(type(s).__name__ for s in program.statements),
                    look="`driving`, the forms, and the options of motions",
                )
            )

    def test_golden_moves_stand_where_their_author_says(self) -> None:
        """Joints at the ends of moves: through tool, frame, label and inverse kinematics."""
        for text in self.golden_texts:
            rows = [row for row in text.statements if row["kind"] in ("MoveJ", "MoveL", "MoveC")]
            if text.robot is None:
                assert not any("stands" in row for row in rows), f"{text.about}: with which robot?"
                continue
            robot = self.vendor.robot(text.robot)
            program = self.read_golden(text)
            if len(rows) != len(program.moves):
                raise AssertionError(_other_statements(text, program))
            try:
                route = Controller(self.vendor, robot).plan(program).route
            except FlybyError as error:
                what = f"{text.about!r} cannot be driven by {text.robot}: {error}"
                nowhere = getattr(error, "cause", None) is FaultCause.NOWHERE
                raise AssertionError(told(what, look=_NOWHERE if nowhere else "stands")) from error
            q = dict(zip(route.moves, route.ends.q[:, 1], strict=True))
            q.setdefault(0, route.ends.q[0, 0])
            for index, (row, move) in enumerate(zip(rows, program.moves, strict=True)):
                if "stands" not in row or index not in q:
                    continue
                wanted, found = np.degrees(row["stands"]), np.degrees(q[index][: robot.arm_size])
                assert np.abs(wanted - found).max() < _STANDS, told(
                    f"{text.about!r}, move {index + 1}: {text.robot} stands elsewhere at its end",
                    written=f"{np.round(wanted, 3)}°, by the author",
                    read=f"{np.round(found, 3)}°, from {line_of(text.files, move)}",
                    look="stands",
                )

    def test_golden_robots_are_those_of_their_data_sheets(self) -> None:
        for one in self.golden_robots:
            robot = self.vendor.robot(one.name)
            for term in ("lower", "upper", "velocity"):
                if term not in one.numbers:
                    continue
                wanted = np.degrees(one.numbers[term])
                found = np.degrees(getattr(robot.limits, term))
                assert np.allclose(wanted, found[: robot.arm_size], atol=1e-6), told(
                    f"{one.name}: {term} of the joints is not that of the data sheet",
                    written=f"{wanted} by the author",
                    read=f"{found} of the plugin, degrees",
                    look="the robot's file: ranges and speeds, joint by joint",
                )
            for pose in one.numbers["poses"]:
                flange = robot.flange_pose(_joints_at(robot, pose))
                assert _stands(flange, pose), told(
                    f"{one.name}: the flange stands elsewhere at {np.degrees(pose['joints'])}°",
                    written=f"{pose['position']} m, {pose.get('quaternion', '')} by the author",
                    read=f"{flange.position} m, {flange.quaternion}",
                    look="the robot's file: lengths, senses and zeros of joints, the flange",
                )

    def test_golden_poses_show_which_way_each_joint_counts(self) -> None:
        """A joint that counted the other way would put the flange elsewhere in one of them."""
        for one in self.golden_robots:
            robot, poses = self.vendor.robot(one.name), one.numbers["poses"]
            unseen = []
            for index, joint in enumerate(robot.joints[: robot.arm_size]):
                sense = np.ones(robot.size)
                sense[index] = -1.0
                others = (robot.flange_pose(sense * _joints_at(robot, pose)) for pose in poses)
                if not joint.held and all(map(_stands, others, poses)):
                    unseen.append(joint.name or str(index + 1))
            assert not unseen, told(
                f"{one.name}: the flange stands at each of its poses where it would if "
                f"{', '.join(unseen)} counted the other way",
                look="[[robots]] of the golden file: a pose with its quaternion, each joint of "
                "which is at another angle, and none at 0",
            )

    def test_golden_texts_cover_the_language(self) -> None:
        """What no golden text says, no check compares with what its author knows."""
        if self.golden is None:
            pytest.skip(f"{self.name} has no golden texts")
        seen: set[str] = set()
        for text in self.golden_texts:
            program = self.read_golden(text)
            seen |= {*_seen(text, program), *self._words_in(program)}
            if self.comment_sign and any(self.comment_sign in one for one in text.files.values()):
                seen.add("comment")
            seen |= {"recording"} if text.recorded else set()
        denied = sorted(self.golden_none & (seen | set(self._has())))
        assert not denied, told(
            f"{self.name}: none = {denied} denies what the golden texts, or the dialect, have",
            look="the golden file, or the dialect: tools=False, work_objects=False, …",
        )
        missing = sorted({*LANGUAGE, *self._words()} - seen - self.golden_none)
        offers = []
        if left := [word for word in missing if word in LANGUAGE]:
            offers.append(f'of {", ".join(left)}: put it among none = ["…"] if there is none of it')
        if said := [word for word in missing if word not in LANGUAGE]:
            offers.append(f"of {', '.join(said)}: the vendor, or its dialect, says that it has it")
        assert not missing, told(
            f"{self.name}: no golden text has: {', '.join(missing)}",
            lines=offers,
            look="the golden file: add a text that says it",
        )

    def test_golden_texts_are_written_and_read_again(self) -> None:
        self.need("reader", "writer")
        for text in self._driven_texts():
            robot = self.vendor.robot(str(text.robot))
            program = self.read_golden(text)
            sources = self.written(program, robot)
            again = self.read_written(sources, robot)
            self.check_same(program, again, sources)

    def test_kept_statements_become_comments(self) -> None:
        """With the option ``opaque`` they are no statements any more, and nothing of them goes."""
        self.need("reader", "writer")
        for text in self._driven_texts():
            robot = self.vendor.robot(str(text.robot))
            program = self.read_golden(text)
            kept = [s.text for s in program.statements if isinstance(s, Opaque)]
            kept += [event.text for move in program.moves for event in move.events]
            options = {"opaque": OpaqueStyle.COMMENT.value}
            try:
                sources = self.vendor.write(program, robot, options)
            except FlybyError as error:
                pytest.skip(f"{self.name} writes no comments: {error}")
            again = self.read_written(sources, robot)
            left = [s.text for s in again.statements if isinstance(s, Opaque)]
            written = " ".join("\n".join(sources.values()).split())
            for one in kept:
                words = [line.strip() for line in one.splitlines() if line.strip()]
                assert all(" ".join(w.split()) in written for w in words) and one not in left, told(
                    f"the kept statement {one!r} has not become a comment",
                    written=text_of(sources),
                    look="the option `opaque` of the writer, and Dialect.comment",
                )
            bare = tuple(replace(move, events=()) for move in program.moves)
            self.check_same(Program(bare), Program(again.moves), sources)

    def _driven_texts(self) -> list[GoldenText]:
        driven = set(self.driven_robots())
        return [text for text in self.golden_texts if text.robot in driven]

    def _has(self) -> Iterator[str]:
        """What of `LANGUAGE` the dialect says that there is."""
        spoken = self.vendor.speaks
        if spoken is None:
            return
        yield from ("tool" for _ in range(spoken.tools))
        yield from ("frame" for _ in range(spoken.work_objects))
        yield from ("load" for _ in range(spoken.loads))
        yield from ("MoveC" for _ in spoken.arc_orientations)
        moves = (spoken.joint, spoken.line)
        yield from ("configuration" for words in moves if words.configurations)

    def _words(self) -> Iterator[str]:
        """What the dialect says that there are words for."""
        spoken = self.vendor.speaks
        if spoken is None:
            return
        for words in (spoken.joint, spoken.line, spoken.arc):
            for kind in words.zones:
                sizes = kind.sizes if isinstance(kind, ZoneKind) else ()
                yield from (f"zone {name}" for name in _said_of(kind_word(kind), sizes))
            yield from (f"speed {name}" for name in words.speeds)
        if self.vendor.recorder is not None:
            yield "recording"
        if spoken.outputs is not None:
            yield "event"
        if spoken.signals is not None:
            yield from ("signal set", "signal waited for")

    def _words_in(self, program: Program) -> Iterator[str]:
        for statement in program.statements:
            terms = terms_of(statement, self.signals)
            yield from ("signal set" for term in terms if term == "sets")
            yield from ("signal waited for" for term in terms if term == "waits")
            if isinstance(statement, Move):
                zone, word = statement.zone, zone_word(statement.zone)
                size = zone.size if isinstance(zone, VendorZone) and zone.kind.sizes else None
                sizes = () if size is None else (size,)
                yield from (f"zone {name}" for name in _said_of(word, sizes))
                yield from (f"speed {name}" for name in stated_speeds(statement))
                yield from ("event" for _ in statement.events)


def stated_speeds(move: Move) -> list[str]:
    """Names of the numbers of `Speed` that a move states."""
    speed = move.speed
    numbers = {name: getattr(speed, name) for name in speed.__slots__ if name != "name"}
    return [name for name, value in numbers.items() if value != _UNLIMITED[name]]


def _seen(text: GoldenText, program: Program) -> Iterator[str]:
    for statement in program.statements:
        yield type(statement).__name__
        if not isinstance(statement, MoveJ | MoveL | MoveC):
            continue
        yield "joint target" if isinstance(statement.target, JointTarget) else "pose target"
        if isinstance(statement.target, PoseTarget) and statement.target.configuration is not None:
            yield "configuration"
        if statement.tool.tcp != FLANGE.tcp:
            yield "tool"
        if statement.work_object.pose != IDENTITY:
            yield "frame"
        if statement.load is not None or statement.tool.load is not None:
            yield "load"
        if statement.origin is not None:
            yield _OWNED.get(statement.origin.target.ownership, "datum of its own")
    if any(row.get("not_driven") for row in text.statements):
        yield "code that is not driven"


def _said_of(word: str, sizes: Sequence[float]) -> list[str]:
    """A kind of zone; of one whose sizes have names, each of them."""
    return [f"{word} of {1000 * size:g} mm" for size in sizes] or [word]


def _joints_at(robot: Robot, pose: Mapping[str, Any]) -> FloatArray:
    """All axes at a pose of a data sheet."""
    return np.array([*pose["joints"], *[0.0] * (robot.size - robot.arm_size)])


def _stands(flange: Pose, pose: Mapping[str, Any]) -> bool:
    """Whether a flange is where a data sheet has it."""
    place = np.abs(np.subtract(flange.position, pose["position"])).max()
    turn = abs(np.dot(flange.quaternion, pose.get("quaternion", flange.quaternion)))
    return bool(place < _PLACE and turn > 1 - _PLACE**2)


def _place(text: GoldenText, number: int, statement: Statement) -> str:
    return f"golden text {text.about!r}: statement {number}, {type(statement).__name__},"


def _first_wrong(wrong: list[str]) -> str:
    return wrong[0].split(":")[0].split(".")[0]


def _other_statements(text: GoldenText, program: Program) -> str:
    return told(
        f"golden text {text.about!r} has {len(text.statements)} statements by its author, and "
        f"{len(program.statements)} as it is read",
        written=" ".join(str(row["kind"]) for row in text.statements),
        read=" ".join(type(s).__name__ for s in program.statements),
        look="statements",
    )
