"""Carries a program from one vendor's robot to another's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..dialect import Dialect
from ..display import counted, in_line
from ..errors import MotionError, Note
from ..motion.emulator.controller import Controller
from ..motion.geometry.segments import make_segments
from ..motion.model.rules import Overlap
from ..motion.path.path import Path, Route
from ..notebook import PictureCurve, page, picture, table
from ..program.arc_orientation import ArcOrientation
from ..program.folding import Folding, usable, with_one_cycle
from ..program.move import MoveC, MoveJ, MoveL, Statement
from ..program.program import Program
from ..program.question import QuestionKind
from ..program.section import moved
from ..program.target import JointTarget
from ..program.zone import FINE, Radius, Zone
from ..robot.model import Robot
from ..source.write.options import StructureStyle
from ..spatial.pose import IDENTITY, Pose
from ..vendor import Vendor
from .bases import with_bases
from .corners import EmulatedCorner, corners_of, fit_zones
from .emulation import EmulatedProgram, Party
from .frames import Frames
from .half_turns import decided
from .loads import without_loads
from .losses import Losses, LossesOfPart
from .overrides import without_override
from .pacing import Pacer
from .rewording import Rewording
from .signals import SignalMap
from .targets import Placer
from .ties import Ties, groups_of_hints, with_first_hints

LOSSES = (("line", "left"), ("what could not be carried over", "left"))
"""Columns of a table of losses."""
_CUT_TOLD = 0.05
"""Share of a corner's cut from which on a difference is reported."""
_CUT_SMALL = 5e-5
"""m of difference between cuts that is not told."""
_TURN_TOLD = 1e-2
"""rad of turn beside a waypoint from which on the zone of reorientation matters."""
_NO_FURTHER = "zones reach no further here"
_HINTS_TRIED = 4
"""Times that hints are shared by fewer lines, until the robot drives as it did."""
_SOLUTION = 1e-6
"""rad and m within which two solutions are one."""
_RIGID = 1e-6
"""rad by which a tool that follows an arc rigidly may miss the orientation of its end."""
_RIGID_TOLD = 1e-3
"""rad, likewise, from which on the difference is reported."""


@dataclass(frozen=True)
class Translation:
    """A program in another robot's terms.

    Args:
        program: what the target vendor's writer takes.
        losses: what could not be carried over, in the order of the source; moves and lines are
            the source's.
        start: where the new robot stands at first.
        unmapped: signals of which nobody says what they are called on the new robot, each with an
            example of such a name.
        keep: whether it has its loops and routines.
    """

    program: Program
    losses: tuple[Note, ...]
    start: JointTarget
    original: Program = field(repr=False)
    unmapped: Mapping[str, str] = field(default_factory=dict)
    keep: bool = False

    @property
    def options(self) -> dict[str, str]:
        """The options of the writer with which it is written."""
        return {"structure": StructureStyle.KEEP} if self.keep else {}

    def __repr__(self) -> str:
        lost = counted(self.losses, "loss", "losses")
        return in_line(f"Translation: {repr(self.program)[1:-1]}, {lost}")

    def _repr_html_(self) -> str:
        points = [(name, p.waypoints()) for name, p in self._programs()]
        curves = [PictureCurve(name, at, at) for name, at in points if at is not None]
        rows = [("" if n.span is None else str(n.span.line), n.message) for n in self.losses]
        lost = table(LOSSES, rows) if rows else ""
        return page(repr(self)[1:-1], lost, picture(curves) if curves else "")

    def _programs(self) -> tuple[tuple[str, Program], ...]:
        return ("before", self.original), ("after", self.program)


def translate(
    program: Program,
    source: tuple[Vendor, Robot],
    target: tuple[Vendor, Robot],
    base: Pose = IDENTITY,
    keep: bool = False,
    signals: SignalMap | None = None,
    start: JointTarget | None = None,
) -> Translation:
    """A program for another robot, by the rules of ``docs/guides/translation.md``.

    Args:
        program: for the source robot.
        source, target: vendor and robot of either side.
        base: the new robot's world (for a robot of the catalogue: its base) in the old robot's.
        keep: whether moves of one line have one speed and one zone in all passes and calls that
            are alike, for a program that is written with its loops and routines.
        signals: what the old robot's signals are called on the new one.
        start: where the old robot stands at first; None for the program's own start, else where
            the emulator takes it to stand.

    Raises:
        MotionError: the old robot cannot drive the program, the new one cannot reach a target or
            follow a line, or the new language has no such frames; the message names move and line.
    """
    sides = Party(*source), Party(*target)
    spoken = target[0].speaks
    keep = keep and spoken is not None and spoken.structure
    return _Translator(program, *sides, base, keep, signals or SignalMap(), start).run()


@dataclass
class _Translator:
    source_program: Program
    source: Party
    target: Party
    base: Pose
    keep: bool
    signals: SignalMap
    start: JointTarget | None
    losses: Losses = field(init=False)
    _ties: Ties = field(init=False)
    _shared: set[int] = field(init=False)

    def __post_init__(self) -> None:
        self.losses = Losses(self.source_program)

    @property
    def dialect(self) -> Dialect | None:
        return self.target.vendor.speaks

    def run(self) -> Translation:
        """The steps, one after the other."""
        drivable, kept = self._drivable()
        losses = self.losses.through(kept)
        if self.start is not None:
            drivable = replace(drivable, start=self.start)
        begin = self.source.start(drivable)
        route = self.source.route(drivable, begin)
        program = decided(drivable, route, losses)
        if self.dialect is not None:
            program = without_override(program, self.source.model, self.dialect, losses)
        if program is not drivable:
            route = self.source.route(program, begin)
        path = self.source.path(route, program)
        driven = EmulatedProgram.of(self.source, program, path)
        frames = Frames(self.base, self.dialect)
        placer = Placer(self.source, self.target, self.dialect, frames)
        placed, start = placer.place(program, route, losses)
        new_route = self.target.route(placed, start)
        said = self._with_said_arcs(without_loads(placed, self.dialect, losses), new_route, losses)
        if said is not placed:
            new_route = self.target.route(said, start)
        said = with_bases(said, self.source_program)
        said, new_route = self._with_one_hint(said, new_route, start)
        ties = self._ties = Ties(said.statements, usable(said))
        self._shared = {move for moves in ties.moves() for move in moves}
        wanted = self._wanted(new_route, path)
        made, new_path = self._zoned(said, new_route, wanted, start)
        if self.dialect is not None:
            pacer = Pacer(driven, self.target, self.dialect, losses, ties.moves())
            made = pacer.pace(made, new_path)
            if self.target.model.centripetal is not None:  # how corners are cut depends on speeds
                again = self.target.route(made, start)
                made, new_path = self._zoned(made, again, wanted, start)
                made = pacer.again(made, new_path)
                new_path = self.target.repaced(new_path, made)
            pacer.tell_times(made, new_path)
        self._tell_zones(new_path, wanted, losses)
        worded = self._worded(made)
        self._tell_structure(worded)
        worded = with_one_cycle(worded)
        return Translation(
            replace(worded, start=None if self.source_program.start is None else start),
            self.losses.sorted(),
            start,
            self.source_program,
            self.losses.signals_to_map(),
            self.keep,
        )

    # ------------------------------------------------------------- what is driven at all

    def _drivable(self) -> tuple[Program, list[int]]:
        """The program without what the old robot leaves out, and which of its moves are kept."""
        program = self.source_program
        left_out = self._left_out(program)
        kept = [i for i in range(len(program.moves)) if i not in left_out]
        for i in left_out:
            self.losses.at(
                i,
                f"left out, as the controller of {self.source.robot.name} leaves it out: its blend "
                "overlaps a neighbouring one",
            )
        statements: list[Statement] = []
        places, index = [], 0
        for statement in program.statements:
            places.append(len(statements))
            if isinstance(statement, MoveJ | MoveL | MoveC):
                index += 1
                if index - 1 in left_out:
                    continue
            statements.append(statement)
        sections = moved(usable(program), [*places, len(statements)]) if self.keep else ()
        return replace(program, statements=tuple(statements), sections=sections), kept

    def _left_out(self, program: Program) -> set[int]:
        """Moves that the old robot's controller skips because blends overlap."""
        if self.source.model.overlap is not Overlap.SKIP:
            return set()
        path = Controller(self.source.vendor, self.source.robot).plan(program)
        return set(path.route.left_out)

    # ---------------------------------------------------------------------------- arcs

    def _with_said_arcs(self, program: Program, route: Route, losses: LossesOfPart) -> Program:
        """Arcs on which the tool turns beside following them, where the language has none."""
        if self.dialect is None:
            return program
        if ArcOrientation.FOLLOWS_ARC not in self.dialect.arc_orientations:
            return self._with_fixed_arcs(program, route, losses)
        if not self.dialect.rigid_arcs:
            return program
        moves, changed = list(program.moves), False
        segments = make_segments(route.ends)
        for k, i in enumerate(route.moves):
            move = moves[i]
            if not isinstance(move, MoveC) or move.orientation is ArcOrientation.FIXED_FRAME:
                continue
            rest = float(segments.turn[k])
            if rest <= _RIGID:
                continue
            # Up to half a circle, following and turning from pose to pose are nearly the same.
            if rest > _RIGID_TOLD or segments.angle[k] > np.pi:
                losses.at(
                    i,
                    "the tool turns evenly from pose to pose: the language knows arcs that the "
                    "tool follows rigidly, not such that it turns along as well",
                )
            moves[i] = replace(move, orientation=ArcOrientation.FIXED_FRAME)
            changed = True
        return program.with_moves(tuple(moves)) if changed else program

    def _with_fixed_arcs(self, program: Program, route: Route, losses: LossesOfPart) -> Program:
        """Arcs on which the tool turns evenly from pose to pose, where it follows none."""
        moves = list(program.moves)
        for k, i in enumerate(route.moves):
            move = moves[i]
            if isinstance(move, MoveC) and move.orientation is ArcOrientation.FOLLOWS_ARC:
                if make_segments(route.ends).angle[k] > np.pi:
                    losses.at(i, "the tool turns evenly from pose to pose: it follows no arcs")
                moves[i] = replace(move, orientation=ArcOrientation.FIXED_FRAME)
        return program.with_moves(tuple(moves))

    # ----------------------------------------------------------- lines that drive several moves

    def _with_one_hint(
        self, program: Program, route: Route, start: JointTarget
    ) -> tuple[Program, Route]:
        """The program in which the moves of one line begin the search for their solution at one
        place, as a line has one, as far as they find the same solutions there; and its route."""
        groups = groups_of_hints(program.statements, usable(program))
        for _ in range(_HINTS_TRIED):
            if not groups:
                break
            tried = with_first_hints(program, groups)
            try:
                again = self.target.route(tried, start)
            except MotionError as error:
                wrong = set() if error.move is None else {error.move}
            else:
                apart = np.abs(again.ends.q[:, 1] - route.ends.q[:, 1]).max(axis=1)
                wrong = {route.moves[k] for k in np.flatnonzero(apart > _SOLUTION)}
                if again.moves == route.moves and not wrong:
                    return tried, again
            left = [moves for moves in groups if wrong.isdisjoint(moves)]
            groups = left if len(left) < len(groups) else []
        return program, route

    # --------------------------------------------------------------------------- zones

    def _zoned(
        self,
        program: Program,
        route: Route,
        wanted: Sequence[EmulatedCorner],
        start: JointTarget,
    ) -> tuple[Program, Path]:
        """The program with zones that cut its corners as wanted, and its path."""
        path = fit_zones(self.target, self.dialect, program, route, wanted)
        zones: list[Zone] = [FINE] * len(program.moves)
        for i, zone in enumerate(path.route.zones):
            for move in range(route.moves[i], route.moves[i + 1]):
                zones[move] = zone
        moves = [replace(move, zone=zones[i]) for i, move in enumerate(program.moves)]
        zoned = program.with_moves(tuple(moves))
        tied = self._ties.with_one_zone(zoned, route.moves)
        if tied == zoned:
            return zoned, path
        return tied, self.target.path(self.target.route(tied, start), tied)

    def _wanted(self, route: Route, old: Path) -> list[EmulatedCorner]:
        """What the old controller makes of each corner of the new route."""
        known: dict[int, EmulatedCorner] = {}
        corners = corners_of(old)
        for i, corner in enumerate(corners):
            for move in range(old.route.moves[i], old.route.moves[i + 1]):
                known[move] = corner
        stop = EmulatedCorner(False, 0.0, 0.0, 0.0, FINE)
        return [known.get(move, stop) for move in route.moves[:-1]]

    def _tell_zones(
        self, path: Path, wanted: Sequence[EmulatedCorner], losses: LossesOfPart
    ) -> None:
        for move, one, other in zip(path.route.zone_moves, wanted, corners_of(path), strict=True):
            self._tell_zone(move, one, other, losses)

    def _tell_zone(
        self, move: int, wanted: EmulatedCorner, found: EmulatedCorner, losses: LossesOfPart
    ) -> None:
        """What the corner at the end of a move loses."""
        if not wanted.passed:
            return
        if not found.passed:
            losses.at(
                move, "the robot stops here: the language, or its controller, has no such zone"
            )
            return
        apart = abs(found.cut - wanted.cut)
        if apart > max(_CUT_SMALL, _CUT_TOLD * wanted.cut):
            shared = move in self._shared
            why = "one zone serves all that this line drives" if shared else _NO_FURTHER
            losses.at(
                move,
                f"passes the waypoint at {1e3 * found.cut:.2f} mm instead of "
                f"{1e3 * wanted.cut:.2f} mm: {why}",
                "cut",
                apart,
            )
        zone = wanted.zone
        parts = self.dialect is None or self.dialect.zone_parts
        wider = isinstance(zone, Radius) and zone.reorientation > 1.001 * zone.tcp
        if wider and not parts and wanted.turn > _TURN_TOLD:
            losses.at(
                move,
                "the wider zone of reorientation has no words: the tool turns within the zone of "
                "the TCP",
            )

    # ---------------------------------------------------------------------- statements

    def _worded(self, program: Program) -> Program:
        """The program with what belongs to another language in words of its own, or as comments."""
        if self.source.vendor.name == self.target.vendor.name:
            return program
        sides = self.source, self.target
        return Rewording(*sides, self.signals, self.losses, self._ties).of(program)

    def _tell_structure(self, program: Program) -> None:
        """Loops and routines that cannot be written as such."""
        statements, sections = program.statements, usable(program)
        folding = Folding(statements, sections)
        for section in sections:
            moves = any(
                isinstance(s, MoveJ | MoveL | MoveC)
                for s in statements[section.begin : section.end]
            )
            if moves and section in folding.written_out:
                self.losses.statement(
                    section.span,
                    f"{section.name}: its passes differ, and are written one after the other",
                )
            elif moves and section.endless and section.tested:
                self.losses.statement(
                    section.span, f"{section.name}: becomes a loop without an end"
                )
        for asked in program.questions:
            if asked.kind in (QuestionKind.BRANCH, QuestionKind.LOOP):
                branch = asked.kind is QuestionKind.BRANCH
                what = "the branch that is" if branch else "the passes that are"
                self.losses.statement(
                    asked.span, f"{what} driven alone can be written: it {asked.meanwhile}"
                )
        for calls in folding.variants():
            name = calls[0].name
            names = (name, *(f"{name}_{k + 2}" for k in range(len(calls) - 1)))
            self.losses.statement(
                calls[1].span,
                f"{name} does something else here than at first: it is written as "
                f"{', '.join(names[:-1])} and {names[-1]}",
            )
