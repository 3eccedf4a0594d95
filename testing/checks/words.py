"""Checks that a language's dialect is true: what it has words for is written and read."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ...core.arrays import FloatArray
from ...core.dialect import Dialect, MoveWords, Orientation
from ...core.program.arc_orientation import ArcOrientation
from ...core.program.event import Event
from ...core.program.move import Move, MoveC, MoveJ, MoveL, Opaque, Statement
from ...core.program.origin import Ownership
from ...core.program.program import Program
from ...core.program.signal import Level, SetSignal, SignalAction, WaitSignal
from ...core.program.speed import Speed
from ...core.program.target import PoseTarget
from ...core.program.tool import WORLD, Tool, WorkObject
from ...core.program.zone import FINE, Fine, Radius, VendorZone, Zone, ZoneKind, kind_of, zone_word
from ...core.source.patch.edits import alike, reading_of
from ...core.spatial.pose import Pose
from ...core.spatial.rotation import euler_zyx, euler_zyz
from ..said import words_of
from ..strategies import joint_target
from .golden import stated_speeds
from .subject import Subject
from .telling import line_of, text_of, told

VALUES: Mapping[str, Any] = {
    "tcp": 0.3,
    "reorientation": 0.7,
    "external_linear": 0.4,
    "external_angular": 0.6,
    "joint": 0.5,
    "joint_fraction": 0.45,
    "tcp_acceleration": 1.5,
    "reorientation_acceleration": 2.0,
    "joint_acceleration": 1.1,
    "joint_acceleration_fraction": 0.55,
    "jerk_fraction": 0.65,
    "acceleration_override": 0.85,
    "duration": 2.5,
}
"""Numbers of `Speed`, none of them a usual default."""
_NEAR = 1e-4
"""mm, degrees or a share by which literals and the numbers made of them may differ."""
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_SQUARE = 0.5**0.5
_FRAME = WorkObject("table", Pose((0.2, -0.1, 0.3), (_SQUARE, 0.0, 0.0, _SQUARE)))
_TOOL = Tool("gun", Pose((0.01, 0.02, 0.1), (_SQUARE, 0.0, _SQUARE, 0.0)))
_LOOK = "the writer and the reader, or Dialect: it speaks of a word that they do not have"


@dataclass(frozen=True)
class _Word:
    """A word, the move that says it, and what must come back of the move."""

    name: str
    move: Move
    of: Callable[[Move], Any]


class WordsChecks(Subject):
    """What the dialect says there are words for is written and read, and golden texts say no
    more."""

    def test_every_word_of_the_dialect_is_written_and_read(self) -> None:
        self.need("reader", "writer")
        for word in self._said_by_moves(self.dialect):
            program = self._around(word.move)
            sources = self.written(program, self.usual_robot)
            again = self.read_written(sources, self.usual_robot)
            assert len(again.moves) == len(program.moves), told(
                f"{self.name}: {word.name} comes back as {len(again.moves)} moves",
                written=text_of(sources),
                look="statements",
            )
            wanted, found = word.of(word.move), word.of(again.moves[1])
            assert alike(wanted, found, max(self.precision, 1e-6)), told(
                f"{self.name}: {word.name} is in the dialect, and does not come back",
                written=wanted,
                read=f"{found}\nfrom {line_of(sources, again.moves[1])}",
                look=_LOOK,
            )

    def test_events_are_written_and_read(self) -> None:
        self.need("reader", "writer")
        outputs, signals = self.dialect.outputs, self.signals
        if outputs is None:
            pytest.skip(f"{self.name} sets no outputs on the way of moves")
        for on in (True, False):
            name = self.signal_name(SetSignal("", on))
            for event in _places(Event(outputs.switch(name, on))):
                move = self._plain(MoveL)
                if not outputs.takes(event, move):
                    continue
                program = self._around(replace(move, events=(event,)))
                sources = self.written(program, self.usual_robot)
                again = self.read_written(sources, self.usual_robot)
                read = [e for m in again.moves for e in m.events]
                assert alike([event], read, 1e-6) and again.moves[1].events, told(
                    f"{self.name}: an event on the way does not come back",
                    written=f"{event}\nin {text_of(sources)}",
                    read=read,
                    look="events",
                )
                if signals is not None:
                    done = signals.read(signals.event(read[0].text))
                    assert done == SetSignal(name, on), told(
                        f"{self.name}: an event that switches {name} is understood otherwise",
                        written=f"{read[0].text!r}: {SetSignal(name, on)}",
                        read=done,
                        look="OutputWords.switch, SignalWords.event and SignalWords.read",
                    )

    def test_signals_are_said_and_understood(self) -> None:
        self.need("reader", "writer")
        signals = self.signals
        if signals is None:
            pytest.skip(f"{self.name} does not say how signals are set")
        for action in self._actions():
            text = signals.said(action)
            assert text is not None, f"{self.name} has no statement for {action}"
            assert signals.read(text) == action, told(
                f"{self.name}: a statement on signals is understood otherwise than it is said",
                written=f"{action}: {text!r}",
                read=signals.read(text),
                look="SignalWords.said and SignalWords.read",
            )
            program = self._around(self._plain(MoveL), Opaque(text))
            sources = self.written(program, self.usual_robot)
            again = self.read_written(sources, self.usual_robot)
            kept = [s.text for s in again.statements if isinstance(s, Opaque)]
            assert [signals.read(one) for one in kept] == [action], told(
                f"{self.name}: a kept statement on signals does not come back",
                written=f"{text!r}\nin {text_of(sources)}",
                read=kept,
                look="statements",
            )

    def test_kept_statements_come_back_as_they_are(self) -> None:
        """Once each: what stands in a golden text, written and read."""
        self.need("reader", "writer")
        programs = map(self.read_golden, self.golden_texts)
        said = [s for p in programs for s in p.statements if isinstance(s, Opaque)]
        kept = list({one.text: replace(one, span=None) for one in said}.values())
        if not kept:
            pytest.skip(f"{self.name}: no golden text has a statement that is kept")
        sources = self.written(self._around(self._plain(MoveJ), *kept), self.usual_robot)
        again = self.read_written(sources, self.usual_robot)
        read = [s for s in again.statements if isinstance(s, Opaque)]
        assert read == kept, told(
            f"{self.name}: kept statements do not come back as they are",
            written=[one.text for one in kept],
            read=f"{[one.text for one in read]}\nfrom {text_of(sources)}",
            look="statements: what a line says that is kept",
        )

    def test_comments_say_nothing(self) -> None:
        self.need("reader", "writer")
        spoken = self.dialect
        program = self._around(self._plain(MoveL))
        sources = self.written(program, self.usual_robot)
        main = next(iter(sources))
        lines = sources[main].splitlines(keepends=True)
        motion = next(
            s.statement for s in self.read_written(sources, self.usual_robot).moves if s.statement
        )
        words = f"{spoken.comment}{lines[motion.line - 1].strip()}\n"
        lines.insert(motion.line - 1, words)
        again = self.read_written({**sources, main: "".join(lines)}, self.usual_robot)
        self.check_same(self.read_written(sources, self.usual_robot), again, sources)

    def test_speeds_that_are_not_needed_may_be_left_out(self) -> None:
        """What must be stated, since the language's own default would be taken, is needed."""
        self.need("reader", "writer")
        for kind in self.kinds:
            words = words_of(self.dialect, kind)
            for name in sorted({"tcp", self.dialect.pace} & words.speeds - words.needs):
                program = self._around(self._plain(kind))
                sources = self.written(program, self.usual_robot)
                again = self.read_written(sources, self.usual_robot)
                (left,) = {getattr(Speed(), name)}
                found = getattr(again.moves[1].speed, name)
                assert alike(found, left), told(
                    f"{self.name}: a {kind.__name__} without {name} is driven by a default",
                    written=text_of(sources),
                    read=f"{name} of {found}",
                    look="MoveWords.needs: what must be stated",
                )

    def test_golden_texts_stay_within_the_dialect(self) -> None:
        """What a text says, the dialect has words for: translations would not use them."""
        spoken = self.dialect
        for text in self.golden_texts:
            program = self.read_golden(text)
            for move in program.moves:
                unlike = _said_otherwise(spoken, move, literals_of(program, move))
                for what in (*_beyond(spoken, move), *unlike):
                    raise AssertionError(
                        told(
                            f"{self.name}: the dialect has no words for {what}",
                            read=line_of(text.files, move),
                            look="Dialect and its MoveWords, or the unit that this is read with",
                        )
                    )

    @property
    def dialect(self) -> Dialect:
        """What the language has words for; skips the check if it is not said."""
        if self.vendor.speaks is None:
            pytest.skip(f"{self.name} does not say what its language has words for")
        return self.vendor.speaks

    # ------------------------------------------------------------------ programs

    def _around(self, move: Move, *others: Statement) -> Program:
        """A program of a move to a stop, the move, other statements, and a stop."""
        first, last = self._plain(MoveJ), self._plain(MoveJ)
        return Program((first, move, *others, last), "words")

    def _plain(self, kind: type[Move]) -> Move:
        """A stop with as few words as the language needs."""
        robot, q = self.usual_robot, np.array(self.stand)
        needs = words_of(self.dialect, kind).needs
        speed = Speed(**{name: VALUES[name] for name in needs})
        if kind is MoveJ:
            return MoveJ(joint_target(robot, q), speed, FINE)
        home = robot.flange_pose(q)
        external = tuple(float(value) for value in q[robot.arm_size :])
        via, end = (_shifted(home, step) for step in ((0.01, 0.01), (0.02, 0.0)))
        if kind is MoveL:
            return MoveL(PoseTarget(end, None, external), speed, FINE)
        through = PoseTarget(via, None, external)
        # A tool that follows an arc rigidly would have to end turned.
        spoken, turning = self.dialect, ArcOrientation.FOLLOWS_ARC
        if spoken.rigid_arcs or turning not in spoken.arc_orientations:
            turning = ArcOrientation.FIXED_FRAME
        target = PoseTarget(end, None, external)
        return MoveC(target, speed, FINE, via=through, orientation=turning)

    def _said_by_moves(self, spoken: Dialect) -> Iterator[_Word]:
        for kind in self.kinds:
            plain, words = self._plain(kind), words_of(self.dialect, kind)
            called = f"of {kind.__name__}"
            for zone in (FINE, *(a_zone(one) for one in words.zones)):
                move = replace(plain, zone=zone)
                yield _Word(f"zone {zone_word(zone)} {called}", move, _zone)
            for name in sorted(words.speeds):
                speed = replace(plain.speed, **_alone(words, name), **{name: VALUES[name]})
                move = replace(plain, speed=speed)
                yield _Word(f"speed {name} {called}", move, _number(name))
        line = self._plain(MoveL)
        if spoken.zone_parts:
            parts = Radius(0.01, 0.015, 0.02, 0.03, 0.025, 0.04)
            yield _Word("zones with parts", replace(line, zone=parts), lambda move: move.zone)
        if spoken.work_objects:
            frame = _FRAME
            if spoken.user_frames:
                frame = replace(frame, frame=Pose((0.01, 0.02, 0.03)))
            move = replace(line, work_object=frame)
            yield _Word("a work object", move, lambda move: move.work_object.pose)
            held = replace(self._plain(MoveJ), work_object=frame)
            name = "a work object of a move to joint values"
            yield _Word(name, held, lambda move: move.work_object.pose)
        if spoken.user_frames:
            yield _Word("a user frame", move, lambda move: move.work_object.user)
        if spoken.tools and "tool" not in self.golden_none:
            move = replace(line, tool=_TOOL)
            yield _Word("a tool", move, lambda move: move.tool.tcp)
        if spoken.stationary_tools:
            still = replace(_TOOL, robot_held=False)
            part = replace(_FRAME if spoken.work_objects else WORLD, name="part", robot_held=True)
            move = replace(line, tool=still, work_object=part)
            yield _Word(
                "a stationary tool",
                move,
                lambda move: (move.tool.robot_held, move.tool.tcp, move.work_object.robot_held),
            )

    # ------------------------------------------------------------------- signals

    def _actions(self) -> Iterator[SignalAction]:
        for on in (True, False):
            yield SetSignal(self.signal_name(SetSignal("", on)), on)
            wait = WaitSignal(Level("", on))
            yield WaitSignal(Level(self.signal_name(wait), on))


def literals_of(program: Program, move: Move) -> list[float]:
    """The numbers that stand in the text for the move's target."""
    origin = None if move.origin is None else move.origin.target
    if origin is None or origin.ownership is Ownership.DERIVED:
        return []
    files = reading_of(program).files
    spans = [span for span in origin.numbers if span is not None]
    texts = [files[span.file].text[span.start : span.end] for span in spans]
    return [float(text) for text in texts if _NUMBER.fullmatch(text)]


def _said_otherwise(spoken: Dialect, move: Move, literals: Sequence[float]) -> Iterator[str]:
    """What stands in the text in another unit or form than the dialect says."""
    turned = move.orientation is ArcOrientation.FOLLOWS_ARC if isinstance(move, MoveC) else False
    if not literals or not isinstance(move.target, PoseTarget) or (turned and spoken.rigid_arcs):
        return
    pose = move.target.pose
    length, angle = (1.0, 1.0) if spoken.in_si else (1e3, 180.0 / np.pi)
    if not _among([length * value for value in pose.position], literals):
        yield f"lengths that are not in {'m' if spoken.in_si else 'mm'}"
    forms = _turns(spoken.orientation, pose, angle)
    if forms and not any(_among(form, literals) for form in forms):
        yield f"rotations whose form is not {spoken.orientation}"


def _turns(form: Orientation, pose: Pose, angle: float) -> list[FloatArray]:
    """How numbers say a rotation; the two quaternions of one, and the rotation vectors; none where
    two of three angles are about one axis, and their sum alone counts."""
    w, x, y, z = pose.quaternion
    if form is Orientation.QUATERNION:
        return [np.array([w, x, y, z]), -np.array([w, x, y, z])]
    rotation = Rotation.from_quat([x, y, z, w])
    if form is Orientation.ROTATION_VECTOR:
        short = rotation.as_rotvec()
        size = float(np.linalg.norm(short))
        return [short, short * (1 - 2 * np.pi / size)] if size > 0 else [short]
    matrix = rotation.as_matrix()
    if form is Orientation.EULER_ZYX:
        turns, same_axes = euler_zyx(matrix), np.hypot(matrix[0, 0], matrix[1, 0])
    else:
        turns, same_axes = euler_zyz(matrix), np.hypot(matrix[0, 2], matrix[1, 2])
    return [] if same_axes < _NEAR else [angle * np.array(turns)]


def _among(wanted: Sequence[float] | FloatArray, literals: Sequence[float]) -> bool:
    return all(min(abs(one - other) for other in literals) < _NEAR for one in wanted)


def a_zone(kind: type[Zone] | ZoneKind) -> Zone:
    """A zone of a kind: of one that is a share 40 %, of one with a radius 13 mm."""
    if isinstance(kind, ZoneKind):
        size = 0.013 if kind.reach is None else 0.4 * kind.largest
        return kind.sized(kind.rounded(size))
    return Radius(0.013) if kind is Radius else kind(0.4)  # type: ignore[call-arg, arg-type]


def _alone(words: MoveWords, name: str) -> dict[str, Any]:
    """What is left out where a number stands that is stated alone."""
    others = words.exclusive - {name} if name in words.exclusive else frozenset[str]()
    return {one: getattr(Speed(), one) for one in others}


def _zone(move: Move) -> Any:
    """Kind and size of a zone; where it says one distance, that is all that is said."""
    zone = move.zone
    if isinstance(zone, Fine):
        return "Fine"
    size = zone.size if isinstance(zone, VendorZone) else getattr(zone, zone.__slots__[0])
    return zone_word(zone), [size]


def _number(name: str) -> Callable[[Move], Any]:
    return lambda move: getattr(move.speed, name)


def _shifted(pose: Pose, step: tuple[float, float]) -> Pose:
    x, y, z = pose.position
    return replace(pose, position=(x, y + step[0], z + step[1]))


def _places(event: Event) -> Iterator[Event]:
    yield event
    yield replace(event, distance=0.01)
    yield replace(event, time=0.05)


def _beyond(spoken: Dialect, move: Move) -> Iterator[str]:
    """What a move says that the dialect has no words for."""
    words, kind = spoken.words(move), type(move).__name__
    if kind_of(move.zone) not in {Fine, *words.zones}:
        yield f"the zone {zone_word(move.zone)} of {kind}"
    stated = set(stated_speeds(move))
    for name in sorted(stated - words.speeds):
        yield f"the speed {name} of {kind}"
    if "duration" not in stated:
        for name in sorted(n for n in words.needs if getattr(move.speed, n) is None):
            yield f"a {kind} without {name}, which it says is needed"
    if (move.speed.tcp or 0.0) > spoken.fastest:
        yield f"{move.speed.tcp} m/s, beyond the fastest ({spoken.fastest} m/s)"
    for name, most in spoken.most.items():
        if (getattr(move.speed, name) or 0.0) > most:
            yield f"{name} of {getattr(move.speed, name)}, beyond the most ({most})"
    labelled = getattr(move.target, "configuration", None) is not None
    if labelled and not words.configurations:
        yield f"a configuration of {kind}"
    if not spoken.work_objects and move.work_object != WORLD:
        yield "a frame of targets"
    if not spoken.external_axes and move.target.external:
        yield "external axes"
    if not spoken.stationary_tools and not move.tool.robot_held:
        yield "a stationary tool"
    zone = move.zone
    wider = isinstance(zone, Radius) and zone.reorientation > zone.tcp
    if wider and not spoken.zone_parts:
        yield "a zone whose parts differ"
    for event in move.events:
        if spoken.outputs is None or not spoken.outputs.takes(event, move):
            yield f"the event {event.text!r} at its place"
