"""Faults of statements and their parts: lost, swapped, taken for something else."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from ...core.language import Recorder, Sources, Writer
from ...core.program.arc_orientation import ArcOrientation
from ...core.program.event import EventAnchor
from ...core.program.move import Move, MoveC, MoveJ, Opaque, Wait
from ...core.program.origin import Ownership
from ...core.program.program import Program
from ...core.program.target import JointTarget, PoseTarget
from ...core.program.tool import FLANGE, WORLD
from ...core.program.zone import FINE, Fine, Radius
from ...core.recording import Recording
from ...core.robot.model import Robot
from ...core.source.write.options import OpaqueStyle
from ...core.vendor import Vendor
from ..checks.subject import Subject
from .mutant import Mutant, has, knows_signals, sets_outputs
from .wrapping import (
    FaultyRecorder,
    LenientReader,
    each_move,
    everywhere,
    in_reading,
    in_writing,
    with_statements,
    without,
)

GOLDEN = ("test_golden_texts_mean_what_their_author_says",)
WORDS = ("test_every_word_of_the_dialect_is_written_and_read",)
RECORDED = ("test_golden_recordings_log_as_their_author_says",)
AGAIN = ("test_golden_texts_are_written_and_read_again",)


def _with(**changes: object) -> Callable[[Move], Move]:
    return lambda move: replace(move, **changes)  # type: ignore[arg-type]


def _other_anchor(move: Move) -> Move:
    swapped = {EventAnchor.START: EventAnchor.END, EventAnchor.END: EventAnchor.START}
    events = tuple(replace(e, anchor=swapped[e.anchor]) for e in move.events)
    return replace(move, events=events)


def _at_the_target(move: Move) -> Move:
    return replace(move, events=tuple(replace(e, distance=0.0, time=0.0) for e in move.events))


def _swapped_points(move: Move) -> Move:
    if not isinstance(move, MoveC) or not isinstance(move.target, PoseTarget):
        return move
    return replace(move, via=move.target, target=move.via)


def _other_turn(move: Move) -> Move:
    if not isinstance(move, MoveC):
        return move
    follows = move.orientation is ArcOrientation.FOLLOWS_ARC
    other = ArcOrientation.FIXED_FRAME if follows else ArcOrientation.FOLLOWS_ARC
    return replace(move, orientation=other)


def _frameless_joints(move: Move) -> Move:
    return replace(move, work_object=WORLD) if isinstance(move.target, JointTarget) else move


def _without_label(move: Move) -> Move:
    if not isinstance(move.target, PoseTarget):
        return move
    return replace(move, target=replace(move.target, configuration=None))


def _without_acceleration(move: Move) -> Move:
    speed = replace(
        move.speed,
        tcp_acceleration=None,
        joint_acceleration=None,
        joint_acceleration_fraction=1.0,
        acceleration_override=1.0,
        name=None,
    )
    return replace(move, speed=speed)


def _sphere(move: Move) -> Move:
    other = not isinstance(move.zone, Fine | Radius)
    return replace(move, zone=Radius(0.01, 0.01, 0.01)) if other else move


def _subtracted(program: Program) -> Program:
    """Computed targets on the other side of the target before."""
    moves = list(program.moves)
    for index, move in enumerate(moves[1:], 1):
        before, here = program.moves[index - 1].target, move.target
        computed = move.origin is not None and move.origin.target.ownership is Ownership.DERIVED
        if computed and isinstance(before, PoseTarget) and isinstance(here, PoseTarget):
            pairs = zip(before.pose.position, here.pose.position, strict=True)
            x, y, z = (2 * a - b for a, b in pairs)
            pose = replace(here.pose, position=(x, y, z))
            moves[index] = replace(move, target=replace(here, pose=pose))
    return program.with_moves(tuple(moves))


def _one_late(part: str) -> Callable[[Program], Program]:
    """Each move with the part of the move before: a setting holds one move too late."""

    def fault(program: Program) -> Program:
        moves = program.moves
        parts = [getattr(move, part) for move in (*moves[:1], *moves)]
        late = (replace(m, **{part: p}) for m, p in zip(moves, parts, strict=False))
        return program.with_moves(tuple(late))

    return fault


def _last_first(program: Program) -> Program:
    """The last two statements in the other order."""
    *first, a, b = program.statements if len(program.statements) > 1 else (None, None)
    return program if a is None else with_statements(program, (*first, b, a))


def _doubled(program: Program) -> Program:
    """Each kept statement twice, as of a line that says two things."""
    twice = (([s] * 2 if isinstance(s, Opaque) else [s]) for s in program.statements)
    return with_statements(program, tuple(s for one in twice for s in one))


def _without_start(program: Program) -> Program:
    """Without the move to where the program starts."""
    first = program.statements[0] if program.statements else None
    if program.start is None or not isinstance(first, MoveJ) or first.target != program.start:
        return program
    return with_statements(program, program.statements[1:])


@dataclass(frozen=True)
class _Uncommented:
    """A writer that drops what is to become comments."""

    sound: Writer

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `flyby.core.language.Writer`."""
        if options.get("opaque") == OpaqueStyle.COMMENT:
            program = each_move(_with(events=()))(without(Opaque)(program))
        return self.sound.write(program, robot, options)


def _uncommented(vendor: Vendor) -> Vendor:
    writer = vendor.writer
    return vendor if writer is None else replace(vendor, writer=_Uncommented(writer))


def _unlogged(vendor: Vendor) -> Vendor:
    """Recordings that drive and log nothing."""
    recorder, writer = vendor.recorder, vendor.writer
    if recorder is None or writer is None:
        return vendor

    def write(_: Recorder, recording: Recording, robot: Robot, period: float) -> Sources:
        return writer.write(recording.program, robot, {"opaque": OpaqueStyle.COMMENT.value})

    return replace(vendor, recorder=FaultyRecorder(recorder, write))


def _rarely_logged(vendor: Vendor) -> Vendor:
    """Recordings that log half as often as asked."""

    def rarer(sound: Recorder, recording: Recording, robot: Robot, period: float) -> Sources:
        return sound.record(recording, robot, 2 * period)

    recorder = vendor.recorder
    return vendor if recorder is None else replace(vendor, recorder=FaultyRecorder(recorder, rarer))


def _lenient(vendor: Vendor) -> Vendor:
    """What is to be refused is passed over."""
    reader = vendor.reader
    if reader is None:
        return vendor
    return replace(vendor, reader=LenientReader(reader, lambda program: program))


def _records(suite: Subject) -> bool:
    return suite.vendor.recorder is not None


def _without_load(move: Move) -> Move:
    return replace(move, load=None, tool=replace(move.tool, load=None))


def _accelerates(suite: Subject) -> bool:
    spoken = suite.vendor.speaks
    if spoken is None:
        return False
    words = spoken.joint.speeds | spoken.line.speeds | spoken.arc.speeds
    return any("acceleration" in word for word in words)


def _has_other_zones(suite: Subject) -> bool:
    spoken = suite.vendor.speaks
    return spoken is not None and set(spoken.joint.zones + spoken.line.zones) != {Radius}


MUTANTS = (
    Mutant(
        "events dropped on reading", in_reading(each_move(_with(events=()))), GOLDEN, sets_outputs
    ),
    Mutant(
        "events dropped on writing",
        in_writing(each_move(_with(events=()))),
        ("test_events_are_written_and_read", *AGAIN),
        sets_outputs,
    ),
    Mutant(
        "events counted from the other end",
        in_reading(each_move(_other_anchor)),
        GOLDEN,
        sets_outputs,
    ),
    Mutant(
        "events without their place", in_reading(each_move(_at_the_target)), GOLDEN, sets_outputs
    ),
    Mutant("kept statements lost on reading", in_reading(without(Opaque)), GOLDEN, has("Opaque")),
    Mutant(
        "kept statements lost on writing",
        in_writing(without(Opaque)),
        ("test_signals_are_said_and_understood", *AGAIN),
        knows_signals,
    ),
    Mutant(
        "kept statements doubled on reading",
        in_reading(_doubled),
        ("test_kept_statements_come_back_as_they_are", *GOLDEN),
        has("Opaque"),
    ),
    Mutant(
        "comments lost",
        _uncommented,
        ("test_kept_statements_become_comments",),
        has("Opaque"),
    ),
    Mutant("waits dropped on reading", in_reading(without(Wait)), GOLDEN, has("Wait")),
    Mutant("waits dropped on writing", in_writing(without(Wait)), AGAIN, has("Wait")),
    Mutant("order of statements changed on reading", in_reading(_last_first), GOLDEN),
    Mutant("order of statements changed on writing", in_writing(_last_first), AGAIN),
    Mutant(
        "start position lost by the writer",
        in_writing(_without_start),
        ("test_what_is_written_is_read_again",),
    ),
    Mutant("increments subtracted", in_reading(_subtracted), GOLDEN, has("computed target")),
    Mutant(
        "auxiliary point of arcs swapped with the end",
        everywhere(*[each_move(_swapped_points)] * 2),
        GOLDEN,
        has("MoveC"),
    ),
    Mutant(
        "arcs turn the tool otherwise",
        everywhere(*[each_move(_other_turn)] * 2),
        GOLDEN,
        has("MoveC"),
    ),
    Mutant(
        "configuration lost on reading",
        in_reading(each_move(_without_label)),
        GOLDEN,
        has("configuration"),
    ),
    Mutant(
        "accelerations ignored on reading",
        in_reading(each_move(_without_acceleration)),
        GOLDEN,
        _accelerates,
    ),
    Mutant(
        "accelerations ignored on writing",
        in_writing(each_move(_without_acceleration)),
        WORDS,
        _accelerates,
    ),
    Mutant("zones lost on reading", in_reading(each_move(_with(zone=FINE))), GOLDEN),
    Mutant("kinds of zone lost", in_reading(each_move(_sphere)), GOLDEN, _has_other_zones),
    Mutant(
        "what is to be refused is passed over",
        _lenient,
        ("test_golden_texts_are_refused_where_their_author_says",),
    ),
    Mutant("recordings log nothing", _unlogged, RECORDED, _records),
    Mutant("recordings log at another period", _rarely_logged, RECORDED, _records),
    Mutant(
        "tools ignored on reading", in_reading(each_move(_with(tool=FLANGE))), GOLDEN, has("tool")
    ),
    Mutant(
        "tools ignored on writing", in_writing(each_move(_with(tool=FLANGE))), WORDS, has("tool")
    ),
    Mutant("tools hold one move too late", in_reading(_one_late("tool")), GOLDEN, has("tool")),
    Mutant("speeds hold one move too late", in_reading(_one_late("speed")), GOLDEN),
    Mutant(
        "frames ignored on reading",
        in_reading(each_move(_with(work_object=WORLD))),
        GOLDEN,
        has("frame"),
    ),
    Mutant(
        "frames ignored on writing",
        in_writing(each_move(_with(work_object=WORLD))),
        WORDS,
        has("frame"),
    ),
    Mutant(
        "frames of joint values ignored on reading",
        in_reading(each_move(_frameless_joints)),
        WORDS,
        has("frame"),
    ),
    Mutant("loads ignored on reading", in_reading(each_move(_without_load)), GOLDEN, has("load")),
)
