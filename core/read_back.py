"""What a writer has made of a program, read again without any other file and compared with it.

A text may say another motion than its program: a kept statement drives, a setting that is kept
holds for what follows, a name means something else. Whatever the language, moves that come back
otherwise are refused before anybody gets the text.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import FlybyError, InputError, MotionError
from .program.folding import usable
from .program.move import Move, Opaque, Statement, Wait
from .program.program import Program
from .program.target import JointTarget, PoseTarget
from .source.execution.answers import Answers
from .source.execution.limits import ExecutionLimits
from .source.patch.edits import alike
from .source.reading import Reading, ReadOptions
from .source.write.options import as_comments
from .spatial.pose import Pose

if TYPE_CHECKING:
    from .language import Reader
    from .robot.model import Robot

_NEAR = 1e-5
"""m and rad: ten times what single precision leaves of metres."""
_UNLIMITED = ExecutionLimits(10**9, 10**9, 10**9)


def check_alone(
    program: Program,
    robot: Robot,
    sources: Mapping[str, str],
    reader: Reader,
    suffixes: tuple[str, ...],
    waits: bool = True,
    comments: bool = False,
) -> None:
    """Refuse texts that do not drive the moves of their program.

    Kind, place, zone and way of every move are compared, and how long it is waited; speeds are
    not, where languages say them in other terms.

    Args:
        program: as it was given to the writer.
        robot: that is driven.
        sources: its texts by file name.
        reader, suffixes: of their language.
        waits: whether the texts wait no longer than the program.
        comments: whether kept statements are comments in them.

    Raises:
        InputError: the texts cannot be read, or not without the user's other files.
        MotionError: a move comes back otherwise; it is named.
    """
    main = next((name for name in sources if name.lower().endswith(suffixes)), None)
    if main is None or not program.moves:
        return
    reading, kept = program.reading, not comments and _kept(program)
    answers = reading.options.answers if isinstance(reading, Reading) else Answers()
    # What was decided at lines of the old files means nothing in the new ones.
    passes = max((len(s.passes) for s in usable(program) if s.endless), default=1)
    answers = replace(answers, branches={}, passes={}, cycles=passes)
    options = ReadOptions(None, robot, answers, _UNLIMITED)
    with tempfile.TemporaryDirectory() as folder:
        for name, text in sources.items():
            (Path(folder) / name).write_bytes(text.encode())
        try:
            again = reader.read_file(Path(folder) / main, options)
        except FlybyError as error:
            raise InputError(
                f"program {program.name!r} cannot be written anew: its text would not be read "
                f"again ({str(error).replace(folder, '')}); patch its own files{_mended(kept)}"
            ) from None
    _compare_moves(program, again, kept)
    if waits:
        _compare_waits(program, again)


def _compare_moves(program: Program, again: Program, kept: bool) -> None:
    for index, (move, other) in enumerate(zip(program.moves, again.moves, strict=False)):
        part = _differing(move, other)
        if part is not None:
            raise _refusal(program, index, f"another {part}", kept)
    counts = len(program.moves), len(again.moves)
    if counts[0] != counts[1]:
        raise _refusal(program, min(counts) - 1, f"{counts[1]} moves instead of {counts[0]}", kept)


def _compare_waits(program: Program, again: Program) -> None:
    waits = [sum(_waited(s) for s in p.statements) for p in (program, again)]
    if not math.isclose(*waits, rel_tol=1e-6, abs_tol=1e-6):
        raise InputError(
            f"program {program.name!r} cannot be written anew: it waits {waits[0]:g} s, and as "
            f"written {waits[1]:g} s; patch its own files"
        )


def _kept(program: Program) -> bool:
    return any(isinstance(statement, Opaque) for statement in program.statements)


def _mended(kept: bool) -> str:
    """What to do beside patching, where statements are kept; nothing where none are."""
    return f", or make kept statements comments ({as_comments()})" if kept else ""


def _refusal(program: Program, index: int, what: str, kept: bool) -> MotionError:
    index = max(index, 0)
    origin = program.moves[index].origin
    return MotionError(
        f"written anew, the program has {what} here than it has been driven with: "
        f"{_reason(kept)}; patch the program's own files{_mended(kept)}",
        index,
        None if origin is None else origin.statement,
    )


def _reason(kept: bool) -> str:
    if kept:
        return "a statement that is kept moves the robot, or sets what moves depend on"
    return "the language's writer does not say what its reader reads"


def _differing(move: Move, other: Move) -> str | None:
    if type(move) is not type(other):
        return "kind of move"
    if not _same_place(move, other, "target"):
        return "target"
    if hasattr(move, "via") and not _same_place(move, other, "via"):
        return "auxiliary point"
    if type(move.zone) is not type(other.zone):
        return "zone"
    return None


def _same_place(move: Move, other: Move, part: str) -> bool:
    first, second = getattr(move, part), getattr(other, part)
    if isinstance(first, JointTarget) or isinstance(second, JointTarget):
        return type(first) is type(second) and alike(first.joints, second.joints, _NEAR)
    poses = _flange(move, first), _flange(other, second)
    return None in poses or alike(*poses, _NEAR)


def _flange(move: Move, target: PoseTarget) -> Pose | None:
    """Where the flange goes in the world; None where that depends on more than the target."""
    tool, frame = move.tool, move.work_object
    if not tool.robot_held or frame.robot_held or frame.moved_by is not None:
        return None
    return frame.pose @ target.pose @ tool.tcp.inverse()


def _waited(statement: Statement) -> float:
    """s that a program itself waits in a statement."""
    return statement.duration if isinstance(statement, Wait) and not statement.device else 0.0
