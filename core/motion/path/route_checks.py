"""What is refused or noted of single moves, before their route is made."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...errors import Note
from ...program.move import Move, MoveC
from ...program.target import JointTarget, PoseTarget
from ...spatial.rotation import arc_angle, cross_length
from ..configurations.targets import located
from ..geometry.segments import LINE_SEGMENT, Segments

if TYPE_CHECKING:
    from ...dialect import ArcRules
    from ...program.program import Program
    from ...robot.model import Robot

_FURTHEST = 1e3
"""m from the frame that it is given in beyond which a target, tool or work object is a mistake."""
_HALF_TURN = np.radians(179.9)
"""A turn about one axis from which on rounding decides the way round."""
_COLLINEAR = 1e-4
_ROUNDING = 1e-6
"""rad by which an arc may be longer than controllers drive it: programs round their points."""

_THIRD_EVENLY = (
    "assumed: the arm's third axis turns evenly along moves of the TCP, from where it stands to "
    "where the target's arm angle has it; how the controller leads it there is not published"
)
_NOT_BETWEEN = (
    "assumed: the arm angle of the point on the arc is not used, as external axes' positions of "
    "such points are not; the third axis turns evenly from the arc's beginning to its end"
)


def check_near(move: Move, i: int, before: Move | None) -> None:
    """Refuse what no robot reaches, before lengths are computed that no number holds.

    Args:
        move: the move.
        i: its index.
        before: another that has been checked, of which the same tool and work object are known.
    """
    places = {}
    if before is None or move.tool is not before.tool:
        places["tool"] = move.tool.tcp.position
    if before is None or move.work_object is not before.work_object:
        places["work object"] = move.work_object.pose.position
    if not isinstance(move.target, JointTarget):
        places["target"] = move.target.pose.position
    if isinstance(move, MoveC):
        places["auxiliary point"] = move.via.pose.position
    for name, position in places.items():
        furthest = max(map(abs, position))
        if not furthest <= _FURTHEST:
            raise located(
                move,
                i,
                f"the {name} lies {furthest:.3g} m away, beyond any robot's reach (at most "
                f"{_FURTHEST:g} m are taken): check its coordinates and their unit",
            )


def is_arc(
    move: Move, i: int, points: tuple[FloatArray, FloatArray, FloatArray], rules: ArcRules | None
) -> bool:
    """Whether start, auxiliary point and end (3,) make an arc, and no line.

    Raises:
        MotionError: they make neither, or an arc that the vendor's controllers do not drive.
    """
    start, via, end = points
    a, b = via - start, end - start
    sizes = float(np.linalg.norm(a)), float(np.linalg.norm(b)), float(np.linalg.norm(end - via))
    if min(sizes) < 1e-6:
        raise located(
            move,
            i,
            "two of the three points of the arc are the same (nearer than 0.001 mm): an arc needs "
            "three different points",
        )
    if rules is not None and min(sizes[:2]) < rules.least_chord:
        raise located(
            move,
            i,
            f"the controller stops at {rules.name}: a point of the arc is less than "
            f"{1e3 * rules.least_chord:g} mm from its start; move the point, or take the arc out",
        )
    if cross_length(a, b) < _COLLINEAR * sizes[0] * sizes[1]:
        if 0.0 < float(a @ b) < sizes[1] ** 2:
            return False
        raise located(
            move,
            i,
            "the three points of the arc lie on a line, and the auxiliary point not between the "
            "others: move it, or use a linear move",
        )
    swept = arc_angle(start, via, end)
    if rules is not None and swept > rules.longest + _ROUNDING:
        raise located(
            move,
            i,
            f"the controller stops at {rules.name}: an arc of {math.degrees(swept):.0f}° is above "
            f"the {math.degrees(rules.longest):.0f}° that it drives; split it in two",
        )
    return True


def half_turns(
    segments: Segments, keep: NDArray[np.bool_], moves: Sequence[int], turned: Collection[int]
) -> list[Note]:
    """Notes of the linear moves that turn the tool by half a turn.

    Args:
        turned: indices of the moves on which the programmed configuration decides.
    """
    if segments.joint_moves_alone:
        return []
    turns = np.linalg.norm(np.stack([segments.turn_a, segments.turn_b]), axis=2).max(axis=0)
    half = (segments.ends.kind == LINE_SEGMENT) & keep & (turns > _HALF_TURN)
    return [
        Note(
            "turns the tool by half a turn: "
            + ("the programmed configuration" if moves[k] in turned else "rounding")
            + " decides the way round; put a target between",
            moves[k],
        )
        for k in map(int, np.flatnonzero(half))
    ]


def arm_angle_notes(
    robot: Robot, program: Program, led: Sequence[int], uneven: Mapping[int, float]
) -> list[Note]:
    """What is assumed where targets state arm angles.

    Args:
        led: indices of the moves of the TCP to one.
        uneven: see `Remarks`.
    """
    notes = [Note(_THIRD_EVENLY + _apart(program, uneven), move) for move in led[:1]]
    through = (
        i
        for i, move in enumerate(program.moves)
        if isinstance(move, MoveC) and move.via.arm_angle is not None
    )
    notes += [Note(_NOT_BETWEEN, move) for move in islice(through, 1)]
    origin = robot.origins.get("arm_angle", "")
    first = next((i for i, move in enumerate(program.moves) if _states_one(move)), None)
    if first is not None and origin.startswith("assumed"):
        notes.append(Note(f"what arm angles of {robot.name} count from is {origin}", first))
    return notes


def _apart(program: Program, uneven: Mapping[int, float]) -> str:
    """By how much it would be elsewhere if the arm angle turned evenly instead."""
    worst = max(uneven, key=lambda i: uneven[i], default=None)
    if worst is None:
        return ""
    at = program.moves[worst].statement
    where = "" if at is None or len(uneven) == 1 else f" in line {at.line}"
    return (
        f"; if the arm angle turned evenly, it would be up to {math.degrees(uneven[worst]):.1f}° "
        f"elsewhere on the way{where}"
    )


def _states_one(move: Move) -> bool:
    return isinstance(move.target, PoseTarget) and move.target.arm_angle is not None
