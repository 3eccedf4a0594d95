"""ACME: a made-up vendor whose plugin is this file and one robot's TOML beside it.

Its language has one statement a line, numbers in m, rad and s::

    MOVEJ 0.1 -0.3 0.4 0.0 0.9 0.0 SPEED 0.5 - ZONE 0.01
    MOVEL x y z qw qx qy qz SPEED 0.5 1.0 ZONE 0
    MOVEC x y z qw qx qy qz x y z qw qx qy qz SPEED 0.5 1.0 ZONE 0
    WAIT 0.5

``SPEED`` is that of the TCP and its rate of turn, ``-`` for none; ``ZONE`` the blend's radius, 0
for a stop; of the two poses of ``MOVEC`` the auxiliary one is the first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from flyby.core.errors import InputError, SourceError, Span
from flyby.core.hookspec import VendorRegister, hookimpl
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.provenance import Provenance
from flyby.core.motion.model.rules import Overlap
from flyby.core.program.move import ArcOrientation, Move, MoveC, MoveJ, MoveL, Statement, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.program.tool import FLANGE, WORLD
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.robot.model import Robot
from flyby.core.source.reading import ReadOptions
from flyby.core.spatial.pose import Pose
from flyby.core.vendor import Sources, Vendor, lazy_robots

HERE = Path(__file__).parent


def motion() -> MotionModel:
    """Parabolas as everywhere; neighbouring blends shrink until they touch."""
    model = MotionModel(period=0.008, overlap=Overlap.SHRINK)
    made_up = Provenance("assumed", "made up for this example")
    return replace(model, provenance=dict.fromkeys(model.figures, made_up))


class Language:
    """Reads and writes ACME programs."""

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `flyby.core.vendor.Reader`; there is one routine in a file."""
        statements, start = [], 0
        for number, line in enumerate(text.split("\n"), 1):
            words = line.split()
            if words:
                try:
                    statements.append(_statement(words))
                except (InputError, ValueError) as error:
                    span = Span(file, number, 1, start, start + len(line))
                    raise SourceError(
                        f"{line.strip()!r} is no ACME statement: {error}", span
                    ) from None
            start += len(line) + 1
        return Program(tuple(statements), options.entry or "main")

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """The same of a file."""
        try:
            return self.read(path.read_text("utf-8"), str(path), options)
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{path}: not a readable program: {error}") from error

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `flyby.core.vendor.Writer`; there are no options."""
        if options:
            raise InputError(f"ACME knows no option {sorted(options)[0]!r}")
        return {f"{program.name}.acme": "".join(f"{_line(s)}\n" for s in program.statements)}


def _statement(words: list[str]) -> Statement:
    kind, *rest = words
    if kind == "WAIT":
        (seconds,) = rest
        return Wait(float(seconds))
    at = rest.index("SPEED")
    numbers, (_, tcp, turn, keyword, radius) = [*map(float, rest[:at])], rest[at:]
    if keyword != "ZONE":
        raise ValueError("ZONE expected after the two speeds")
    speed = Speed(_optional(tcp), _optional(turn))
    zone: Zone = FINE if float(radius) == 0 else Radius(float(radius))
    if kind == "MOVEJ":
        return MoveJ(JointTarget(tuple(numbers)), speed, zone)
    if kind == "MOVEL":
        return MoveL(_pose(numbers), speed, zone)
    if kind == "MOVEC":
        return MoveC(_pose(numbers[7:]), speed, zone, via=_pose(numbers[:7]))
    raise ValueError(f"unknown word {kind}")


def _optional(word: str) -> float | None:
    return None if word == "-" else float(word)


def _pose(numbers: list[float]) -> PoseTarget:
    x, y, z, *quaternion = numbers
    w, i, j, k = quaternion
    return PoseTarget(Pose((x, y, z), (w, i, j, k)))


def _line(statement: Statement) -> str:
    if isinstance(statement, Wait):
        return f"WAIT {statement.duration!r}"
    if not isinstance(statement, Move):
        raise InputError("ACME has moves and waits only")
    _refuse_what_cannot_be_said(statement)
    poses = (
        [statement.via, statement.target] if isinstance(statement, MoveC) else [statement.target]
    )
    numbers = " ".join(repr(number) for pose in poses for number in _numbers(pose))
    speeds = (statement.speed.tcp, statement.speed.reorientation)
    tcp, turn = ("-" if speed is None else repr(speed) for speed in speeds)
    radius = statement.zone.tcp if isinstance(statement.zone, Radius) else 0
    return f"{type(statement).__name__.upper()} {numbers} SPEED {tcp} {turn} ZONE {radius!r}"


def _numbers(target: Target) -> tuple[float, ...]:
    if isinstance(target, JointTarget):
        return target.joints
    return (*target.pose.position, *target.pose.quaternion)


def _refuse_what_cannot_be_said(move: Move) -> None:
    if replace(move, tool=FLANGE, work_object=WORLD, load=None) != move:
        raise InputError("ACME knows no tools, work objects or loads")
    if isinstance(move, MoveC) and move.orientation is not ArcOrientation.FOLLOWS_ARC:
        raise InputError("along ACME's arcs the tool follows the arc")
    if isinstance(move, MoveJ) != isinstance(move.target, JointTarget):
        raise InputError("ACME's MOVEJ goes to joint values, the others to poses")
    if move.target.external:
        raise InputError("ACME has no external axes")
    if move.zone not in (FINE, Radius(getattr(move.zone, "tcp", 0.0))):
        raise InputError(f"ACME's zones are a radius and nothing else, not {move.zone}")
    if move.speed != Speed(move.speed.tcp, move.speed.reorientation):
        raise InputError("ACME's speeds are those of the TCP and of its turn, nothing else")


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over ACME."""
    language = Language()
    register.add(
        Vendor(
            name="acme",
            robots=lazy_robots(HERE.glob("*.toml")),
            motion=motion,
            label=lambda robot, q: None,
            reader=language,
            writer=language,
            suffixes=(".acme",),
        )
    )
