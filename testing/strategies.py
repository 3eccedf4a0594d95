"""Hypothesis strategies: configurations, targets, speeds, zones and programs of a robot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from ..core.arrays import FloatArray
from ..core.program.arc_orientation import ArcOrientation
from ..core.program.move import Move, MoveC, MoveJ, MoveL, Opaque, Statement, Wait
from ..core.program.program import Program
from ..core.program.speed import Speed
from ..core.program.target import Configuration, JointTarget, PoseTarget, Target
from ..core.program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from ..core.program.zone import FINE, Fine, Radius, Zone
from ..core.robot.model import Robot
from ..core.spatial.pose import IDENTITY, Pose
from ..core.spatial.rotation import matrix_from_rotation_vector

if TYPE_CHECKING:
    from ..core.vendor import Vendor

Label = Callable[[Robot, FloatArray], Configuration | None]
Value = TypeVar("Value")
OfKind = Callable[[type[Move]], st.SearchStrategy[Value]]
"""A strategy for each kind of move."""

LEAST_SINGULAR_VALUE = 0.03
"""Of the Jacobian with lengths as shares of the arm's own; below, a posture counts as singular."""
STEP = 0.2
"""rad; largest change of a joint over one linear or circular move."""
_STEPS = st.floats(-STEP, STEP, allow_subnormal=False)
_TRIES = 3


def robots(vendor: Vendor) -> st.SearchStrategy[Robot]:
    """Robots of the vendor's catalogue."""
    return st.sampled_from(sorted(vendor.robots)).map(vendor.robot)


def configurations(robot: Robot, margin: float = 0.05) -> st.SearchStrategy[FloatArray]:
    """Values (N,) of all axes, ``margin`` of each range away from its limits."""
    limits = robot.limits
    gap = margin * (limits.upper - limits.lower)
    ranges = zip(limits.lower + gap, limits.upper - gap, strict=True)
    axes = [st.floats(low, high, allow_subnormal=False) for low, high in ranges]
    drawn = st.tuples(*axes).map(lambda values: allowed(robot, np.array(values)))
    if not robot.coupled_ranges:
        return drawn
    return drawn.filter(lambda q: bool(((limits.lower <= q) & (q <= limits.upper)).all()))


def allowed(robot: Robot, q: FloatArray) -> FloatArray:
    """The configuration (N,) with the joints that have no motor at zero, and the last joint of each
    coupled range so that it holds."""
    found = q.copy()
    found[[j for j, joint in enumerate(robot.joints) if joint.held]] = 0.0
    for coupled in robot.coupled_ranges:
        row = coupled.row(robot.axis_names)
        value = float(row @ found)
        last = robot.axis_names.index(coupled.terms[-1][0])
        middle = 0.5 * (coupled.lower + coupled.upper)
        wanted = middle if coupled.fixed else np.clip(value, coupled.lower, coupled.upper)
        found[last] += (wanted - value) / row[last]
    return found


def regular_configurations(robot: Robot, margin: float = 0.05) -> st.SearchStrategy[FloatArray]:
    """The same, not singular either."""
    return configurations(robot, margin).filter(lambda q: is_regular(robot, q))


def is_regular(robot: Robot, q: FloatArray) -> bool:
    """Whether the arm's Jacobian at ``q`` (N,) keeps all six degrees of freedom by a margin."""
    jacobian = robot.jacobian(q)[:, : robot.arm_size]
    length = sum(float(np.linalg.norm(step)) for step in robot.arm_chain.translation[1:])
    scaled = jacobian / np.array([length] * 3 + [1.0] * 3)[:, None]
    return bool(np.linalg.svd(scaled, compute_uv=False)[-1] > LEAST_SINGULAR_VALUE)


def reachable_poses(robot: Robot) -> st.SearchStrategy[Pose]:
    """Poses of the flange in the world that the robot can take."""
    return configurations(robot).map(robot.flange_pose)


def joint_targets(robot: Robot) -> st.SearchStrategy[JointTarget]:
    """Targets in joint values."""
    return configurations(robot).map(lambda q: joint_target(robot, q))


def pose_targets(
    robot: Robot, label: Label | None = None, tool: Tool = FLANGE
) -> st.SearchStrategy[PoseTarget]:
    """Targets in poses of the tool in the world, with a configuration label if there is one."""
    return regular_configurations(robot).map(lambda q: pose_target(robot, q, label, tool))


def speeds() -> st.SearchStrategy[Speed]:
    """Speeds by the TCP, rounded to mm/s and degrees/s as people write them."""
    return st.builds(
        Speed,
        tcp=st.integers(5, 3000).map(lambda mm: mm / 1000),
        reorientation=st.integers(5, 500).map(lambda deg: float(np.radians(deg))),
    )


def radii(largest: float = 0.05) -> st.SearchStrategy[Radius]:
    """Zones up to ``largest`` m, to 0.1 mm, with an orientation zone half as large again."""

    def zone(tenths: int) -> Radius:
        tcp = tenths * 1e-4
        return Radius(tcp, 1.5 * tcp, 1.5 * tcp, angle=0.15e3 * tcp * float(np.radians(1)))

    return st.integers(1, max(1, round(largest * 1e4))).map(zone)


def zones(largest: float = 0.05) -> st.SearchStrategy[Zone]:
    """Stop points and radii."""
    return st.one_of(st.just(FINE), radii(largest))


def fly_by_zones(zone: OfKind[Zone]) -> OfKind[Zone]:
    """Those of ``zone`` that let the robot pass without stopping."""
    return lambda kind: zone(kind).filter(lambda found: not isinstance(found, Fine))


def poses(reach: float = 0.4) -> st.SearchStrategy[Pose]:
    """Frames at most ``reach`` m away along each axis, turned in any way."""
    lengths = st.floats(-reach, reach, allow_subnormal=False)
    turns = st.floats(-1.8, 1.8, allow_subnormal=False)
    return st.builds(_pose, st.tuples(*[lengths] * 3), st.tuples(*[turns] * 3))


def loads() -> st.SearchStrategy[Load]:
    """Rigid bodies of up to 20 kg."""
    positive = st.floats(0.001, 1.0)
    return st.builds(
        Load,
        mass=st.floats(0.1, 20.0),
        centre=st.tuples(*[st.floats(-0.2, 0.2, allow_subnormal=False)] * 3),
        inertia=st.tuples(*[st.just(0.0) | positive] * 3),
        axes=poses().map(lambda pose: pose.quaternion),
        name=st.sampled_from(["part", "blank"]),
    )


def tools() -> st.SearchStrategy[Tool]:
    """The flange, and tools with names, weighed or not."""
    names = st.sampled_from(["gun", "torch", "gripper_2", "tool_12"])
    load = st.none() | loads().map(lambda found: replace(found, name=None))
    return st.just(FLANGE) | st.builds(Tool, name=names, tcp=poses(), load=load)


def work_objects() -> st.SearchStrategy[WorkObject]:
    """The world, and frames with names that stand still."""
    names = st.sampled_from(["table", "fixture", "fixture_11"])
    return st.just(WORLD) | st.builds(WorkObject, name=names, user=poses(1.0), frame=poses())


_JOINTS: st.SearchStrategy[type[Target]] = st.just(JointTarget)
_FLANGE = st.just(FLANGE)
_WORLD = st.just(WORLD)
_NOTHING = st.none()
_FOLLOWS_ARC = st.just(ArcOrientation.FOLLOWS_ARC)


@dataclass(frozen=True)
class Parts:
    """What programs are made of.

    Args:
        zone, speed: for each kind of move.
        aim: what joint moves end at, `JointTarget` or `PoseTarget`.
        tool, work_object: of a program's moves; of one name there is one.
        load: that the tool carries.
        labelled: whether targets of a kind of move have a label of configuration.
        arc: how the tool turns along arcs.
        acting: what a move does on its way: the move with its events.
        kept: statements that are kept as text, between moves that stop.
    """

    zone: OfKind[Zone]
    speed: OfKind[Speed]
    aim: st.SearchStrategy[type[Target]] = _JOINTS
    tool: st.SearchStrategy[Tool] = _FLANGE
    work_object: st.SearchStrategy[WorkObject] = _WORLD
    load: st.SearchStrategy[Load | None] = _NOTHING
    labelled: Callable[[type[Move]], bool] = lambda _: True
    arc: st.SearchStrategy[ArcOrientation] = _FOLLOWS_ARC
    acting: Callable[[Move], st.SearchStrategy[Move]] = st.just
    kept: st.SearchStrategy[Opaque] | None = None


@dataclass(frozen=True)
class _Choice:
    """Tools, work objects and loads that one program has."""

    tools: Sequence[Tool]
    work_objects: Sequence[WorkObject]
    loads: Sequence[Load | None]


@st.composite
def programs(
    draw: st.DrawFn,
    robot: Robot,
    label: Label | None = None,
    parts: Parts | None = None,
    max_moves: int = 6,
    kinds: Sequence[type[Move]] = (MoveJ, MoveL, MoveC),
) -> Program:
    """Programs of moves, waits and kept statements that the robot can drive.

    They begin with a joint move to a stop; linear and circular moves are short and keep away
    from singular postures, so that the configuration can be held.
    """
    parts = parts or Parts(lambda _: zones(), lambda _: speeds())
    choice = _Choice(
        draw(_few(parts.tool, lambda tool: tool.name)),
        draw(_few(parts.work_object, lambda frame: frame.name)),
        draw(_few(parts.load, lambda load: load.name if load else None)),
    )
    start = draw(joint_targets(robot))
    q = draw(regular_configurations(robot, margin=0.15))
    first = MoveJ(joint_target(robot, q), draw(parts.speed(MoveJ)), FINE)
    statements: list[Statement] = [_carrying(draw, first, choice)]
    for _ in range(draw(st.integers(1, max_moves))):
        move, q = _move(draw, kinds, robot, q, label, parts, choice)
        statements.append(draw(parts.acting(move)))
        if not isinstance(move.zone, Fine):
            continue
        if parts.kept is not None and draw(st.booleans()):
            statements.append(draw(parts.kept))
        if draw(st.booleans()):
            statements.append(Wait(draw(st.integers(0, 20)) / 10))
    return Program(tuple(statements), start=start)


@st.composite
def lines_near_singularities(draw: st.DrawFn, robot: Robot) -> Program:
    """A line, stopped at or flown through, whose ends lie near a singular posture of an arm.

    One joint stands near where the Jacobian's determinant changes its sign, on either side of it.
    """
    gap = 0.01
    lower = robot.limits.lower + gap
    upper = robot.limits.upper - gap
    q = draw(configurations(robot))
    axis = draw(st.sampled_from([j for j in (2, 4) if j < robot.arm_size]))
    values = np.linspace(lower[axis], upper[axis], 200)
    grid = np.tile(q, (len(values), 1))
    grid[:, axis] = values
    signs = np.sign(np.linalg.det(robot.jacobian(grid)[:, :, : robot.arm_size]))
    changes = np.flatnonzero(np.diff(signs))
    assume(len(changes))
    middle = values[draw(st.sampled_from(list(map(int, changes))))]

    def near(base: FloatArray) -> FloatArray:
        moved = base + np.array([draw(st.floats(-0.3, 0.3)) for _ in base])
        moved[axis] = middle + draw(st.floats(0.02, 0.4)) * draw(st.sampled_from([-1, 1]))
        return allowed(robot, np.clip(moved, lower, upper))

    start = near(q)
    end, last = near(start), near(start)
    stop: Zone = FINE
    zone = draw(st.sampled_from([stop, Radius(0.01, 0.01, 0.01, 0.1)]))
    speed = Speed(tcp=0.25)
    moves = (
        MoveL(PoseTarget(robot.flange_pose(end)), speed, zone),
        MoveJ(joint_target(robot, last), speed, FINE),
    )
    return Program(moves, start=joint_target(robot, start))


def _few(
    values: st.SearchStrategy[Value], name: Callable[[Value], str | None]
) -> st.SearchStrategy[list[Value]]:
    return st.lists(values, min_size=1, max_size=2, unique_by=name)


def _carrying(draw: st.DrawFn, move: Move, choice: _Choice) -> Move:
    """The move with a tool, a work object and a load; one that is held has a name of its own."""
    tool = draw(st.sampled_from(choice.tools))
    work_object = draw(st.sampled_from(choice.work_objects))
    if not tool.robot_held:
        name = f"held_{work_object.name}"
        work_object = replace(work_object, name=name, robot_held=True)
    load = draw(st.sampled_from(choice.loads))
    return replace(move, tool=tool, work_object=work_object, load=load)


def _move(
    draw: st.DrawFn,
    kinds: Sequence[type[Move]],
    robot: Robot,
    q: FloatArray,
    label: Label | None,
    parts: Parts,
    choice: _Choice,
) -> tuple[Move, FloatArray]:
    """A move from ``q``, and where it ends: a joint move where no line or arc was found."""
    kind = draw(st.sampled_from(kinds))
    ends = [] if kind is MoveJ else [draw(_near(robot, q)) for _ in range(1 + (kind is MoveC))]
    if kind is MoveJ or any(end is None for end in ends):
        assume(MoveJ in kinds)
        return _joint_move(draw, robot, label, parts, choice)
    *through, end = (x for x in ends if x is not None)
    line = _said(draw, MoveL, robot, end, parts, choice)
    poses = [_target_of(line, robot, x).pose for x in (q, *through, end)]
    kind = MoveC if through and make_an_arc(*poses) else MoveL
    label = label if parts.labelled(kind) else None
    *via, target = (_target_of(line, robot, x, label) for x in (*through, end))
    if kind is MoveL:
        return replace(line, target=target), end
    speed, zone, turning = draw(parts.speed(MoveC)), draw(parts.zone(MoveC)), draw(parts.arc)
    frames = {part: getattr(line, part) for part in ("tool", "work_object", "load")}
    return MoveC(target, speed, zone, via=via[0], orientation=turning, **frames), end


def _joint_move(
    draw: st.DrawFn, robot: Robot, label: Label | None, parts: Parts, choice: _Choice
) -> tuple[Move, FloatArray]:
    end = draw(regular_configurations(robot, margin=0.15))
    move = _said(draw, MoveJ, robot, end, parts, choice)
    if draw(parts.aim) is PoseTarget:
        label = label if parts.labelled(MoveJ) else None
        move = replace(move, target=_target_of(move, robot, end, label))
    return move, end


def _said(
    draw: st.DrawFn,
    kind: type[MoveJ | MoveL],
    robot: Robot,
    q: FloatArray,
    parts: Parts,
    choice: _Choice,
) -> Move:
    """A move to joint values with everything else that a language says of it."""
    move = kind(joint_target(robot, q), draw(parts.speed(kind)), draw(parts.zone(kind)))
    return _carrying(draw, move, choice)


def _target_of(move: Move, robot: Robot, q: FloatArray, label: Label | None = None) -> PoseTarget:
    return pose_target(robot, q, label, move.tool, move.work_object)


@st.composite
def _near(draw: st.DrawFn, robot: Robot, q: FloatArray) -> FloatArray | None:
    """A regular configuration at most `STEP` away that moves the flange noticeably.

    None if none was found in a few tries.
    """
    steps = st.lists(_STEPS, min_size=robot.size, max_size=robot.size)
    start = np.array(robot.flange_pose(q).position)
    for _ in range(_TRIES):
        end = allowed(robot, np.clip(q + draw(steps), robot.limits.lower, robot.limits.upper))
        if (end > robot.limits.upper).any() or (end < robot.limits.lower).any():
            continue
        apart = np.linalg.norm(np.array(robot.flange_pose(end).position) - start)
        if apart > 1e-2 and is_regular(robot, end) and is_regular(robot, 0.5 * (q + end)):
            return end
    return None


def make_an_arc(start: Pose, via: Pose, end: Pose) -> bool:
    """Whether three points lie apart and off a line, the second one between the others."""
    a, b, c = (np.array(pose.position) for pose in (start, via, end))
    first, second = b - a, c - b
    lengths = float(np.linalg.norm(first)), float(np.linalg.norm(second))
    if min(lengths) < 5e-3:
        return False
    turn = np.arccos(np.clip(first @ second / (lengths[0] * lengths[1]), -1, 1))
    return bool(0.1 < turn < 2.0)


def joint_target(robot: Robot, q: FloatArray) -> JointTarget:
    """The configuration (N,) as a target."""
    values = tuple(float(value) for value in q)
    return JointTarget(values[: robot.arm_size], values[robot.arm_size :])


def pose_target(
    robot: Robot,
    q: FloatArray,
    label: Label | None = None,
    tool: Tool = FLANGE,
    work_object: WorkObject = WORLD,
) -> PoseTarget:
    """Where the tool stands in the work object at the configuration (N,)."""
    configuration = label(robot, q) if label is not None else None
    external = tuple(float(value) for value in q[robot.arm_size :])
    flange = robot.flange_pose(q)
    frame = flange @ work_object.pose if work_object.robot_held else work_object.pose
    tcp = flange @ tool.tcp if tool.robot_held else tool.tcp
    # Where there is no frame, the numbers stay as they are.
    pose = tcp if frame == IDENTITY else frame.inverse() @ tcp
    return PoseTarget(pose, configuration, external)


def _pose(position: tuple[float, float, float], turn: tuple[float, float, float]) -> Pose:
    """A frame at a position (m), turned by a rotation vector (rad)."""
    matrix = np.eye(4)
    matrix[:3, :3] = matrix_from_rotation_vector(np.array(turn))
    matrix[:3, 3] = position
    return Pose.from_matrix(matrix)
