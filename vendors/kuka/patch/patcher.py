"""A changed program → the user's own KRL files with its numbers, every other byte kept.

What is changed where:

- Numbers of targets, of ``$VEL``, ``$ACC``, ``$APO`` and of the PDAT and LDAT of inline forms are
  changed where they stand, if every move that reads them is to have the same new value. S and T
  change only if the move's configuration does.
- A component that an aggregate leaves out (``{X 10,Z 5}``) is put in.
- Else the change is refused, or, under ``shared=own`` (literals that other moves read) and
  ``derived=own`` (what expressions compute), the move gets numbers of its own: an aggregate in the
  place of its target, or settings in lines of their own before the motion, which are taken back
  behind it for the moves that follow.
- A stop becomes a fly-by point by ``C_DIS``, ``C_PTP``, … behind the motion, and back again.
- The visible line of an inline form follows (``CONT``, ``Vel=``).
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from ....core.errors import InputError, Span
from ....core.program.move import Move
from ....core.program.origin import Ownership
from ....core.program.program import Program
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.zone import Fine, Zone
from ....core.robot.model import Robot
from ....core.source.patch.edits import Edit, listed, reading_of, with_one_distance
from ....core.source.patch.plan import PatchPlan, Texts, patch_program
from ....core.source.patch.uses import Use, UseKind
from ....core.source.reading import Files
from ....core.source.write.options import PatcherOptions
from ..write.formatting import e6axis, e6pos
from ..write.speeds import approximation, zone_settings
from .additions import Additions, PlacedMove, settings_of
from .inline_forms import shown_approximation, shown_velocity, words_of
from .inplace import KrlLiterals, literals_of
from .places import Places

_WORDS = re.compile(r"(?i)(?:[ \t]+C_(?:PTP|DIS|ORI|VEL|SPL))+[ \t]*$")


def patch(program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
    """The program's files with its numbers; see `core.source.patch.plan.patch_program`.

    Args:
        options: ``shared`` and ``derived``, each ``refuse`` or ``own``; see `PatcherOptions`.
    """
    reading = reading_of(program)
    places = Places(reading.files)
    literals = KrlLiterals(places, reading.options.robot or robot)

    def edits(plan: PatchPlan) -> list[Edit]:
        return _Edits(plan, literals, places, reading.options.robot or robot).all()

    chosen = PatcherOptions.of(options, "KRL patcher")
    return patch_program(with_one_distance(program), chosen, literals, edits, _other_change)


class _Edits:
    """Finds the edits."""

    def __init__(
        self, plan: PatchPlan, literals: KrlLiterals, places: Places, robot: Robot
    ) -> None:
        self._plan = plan
        self._literals = literals
        self._places = places
        self._robot = robot
        self._additions = Additions(places, _motions(plan.parts))

    def all(self) -> list[Edit]:
        """All edits.

        Raises:
            FlybyError: a change has no place.
        """
        found = [edit for use in self._plan.changes for edit in self._edits_for(use)]
        return [*found, *self._additions.edits()]

    def _edits_for(self, use: Use) -> list[Edit]:
        plan = self._plan
        try:
            if isinstance(use.new, Zone):
                list(zone_settings(use.new))  # refuses what KRL cannot say
            if use.kind is UseKind.ZONE and type(use.old) is not type(use.new):
                return list(self._another_approximation(use))
            against = plan.against(use)
            if plan.changeable(use) and not against:
                if plan.wish(use).complete:
                    return list(self._in_place(use, plan.texts(use)))
                completed = self._completed(use)
                if completed is not None:
                    return [*self._in_place(use, plan.texts(use)), completed]
            if use.origin.ownership is Ownership.DERIVED or not any(use.origin.numbers):
                plan.check_computed()
            else:
                plan.check_shared(use, against)
            plan.check_executions(use)
            return list(self._own(use))
        except InputError as error:
            raise use.error(str(error)) from None

    # ------------------------------------------------------------------ numbers in place

    def _in_place(self, use: Use, texts: Texts) -> Iterator[Edit]:
        for span, text in texts.items():
            yield Edit(span, text, use.index)
            form = self._places.form(span)
            if use.kind is UseKind.SPEED and form is not None:
                for place, shown in shown_velocity(self._places, form, text):
                    if place != span:
                        yield Edit(place, shown, use.index)

    def _completed(self, use: Use) -> Edit | None:
        """Components put into the aggregate that leaves them out; None if there is none."""
        known = [span for span in use.origin.numbers if span is not None]
        if use.kind not in (UseKind.TARGET, UseKind.VIA) or not known:
            return None
        last = max(known, key=lambda span: span.end)
        rest = self._rest_of_aggregate(last)
        missing = self._literals.missing(use)
        names = {c.name for c in missing}
        if rest is None or len(known) + len(names) > len(use.origin.numbers):
            return None
        items = "".join(f",{c.name} {c.text('')}" for c in missing)
        place = self._places.span(last.file, last.end + rest, last.end + rest)
        return Edit(place, items, use.index)

    def _rest_of_aggregate(self, last: Span) -> int | None:
        """Characters from a number to the brace that ends its aggregate."""
        line, _, _ = self._places.line(last)
        rest = self._places.text(line)[last.end - line.start :]
        closing = rest.find("}")
        return closing if closing >= 0 and not rest[:closing].strip() else None

    # ------------------------------------------------------------- numbers of their own

    def _own(self, use: Use) -> Iterator[Edit]:
        if use.kind in (UseKind.TARGET, UseKind.VIA):
            yield self._own_target(use)
        else:
            self._set(use)

    def _own_target(self, use: Use) -> Edit:
        """An aggregate in the place of the expression."""
        if self._places.form(use.statement) is not None:
            raise InputError(
                "the motion stands in an inline form, whose point has its name: give it a point of "
                "its own on the teach pendant"
            )
        new = use.new
        if isinstance(new, PoseTarget):
            text = e6pos(new, self._robot)
        else:
            assert isinstance(new, JointTarget)
            text = e6axis(new, self._robot)
        return Edit(use.origin.span, text, use.index)

    def _set(self, use: Use) -> None:
        """Settings of its own for a speed or zone that differs."""
        own = settings_of(use.move)
        if use.kind is UseKind.SPEED:
            own = {k: text for k, text in own.items() if not k.startswith("$APO")}
            before = settings_of(replace(use.move, speed=use.old))  # type: ignore[arg-type]
            own = {k: text for k, text in own.items() if before.get(k) != text}
        else:
            own = {k: text for k, text in own.items() if k.startswith("$APO")}
        self._additions.set(use.index, own)

    # ------------------------------------------------------------------- approximation

    def _another_approximation(self, use: Use) -> Iterator[Edit]:
        """Stop → fly-by point, back, or another kind of approximation."""
        self._plan.check_executions(use)
        words = "" if isinstance(use.new, Fine) else approximation(use.move).strip()
        form = self._places.form(use.statement)
        if form is not None:
            if words:
                words = words_of(self._places, form, self._keyword(use))
                yield self._form_distance(use)
            for place, text in shown_approximation(self._places, form, words):
                yield Edit(place, text, use.index)
        elif words:
            self._set(use)
        yield self._worded(use, words)

    def _worded(self, use: Use, words: str) -> Edit:
        """The words behind the motion."""
        text = self._places.text(use.statement)
        found = _WORDS.search(text)
        start = use.statement.start + (found.start() if found else len(text.rstrip()))
        place = self._places.span(use.statement.file, start, use.statement.end)
        return Edit(place, f" {words}" if words else "", use.index)

    def _keyword(self, use: Use) -> str:
        found = re.match(r"\w+", self._places.text(use.statement))
        return found[0] if found else ""

    def _form_distance(self, use: Use) -> Edit:
        """The ``APO_DIST`` that an inline form will read."""
        form = self._places.form(use.statement)
        assert form is not None
        span = self._places.approximation_datum(form)
        if span is None:
            raise InputError(
                "the inline form's move data (PDAT, LDAT) are in no file of the program, so that "
                "it cannot get an approximation distance"
            )
        (statement,) = (v for k, v in settings_of(use.move).items() if k.startswith("$APO"))
        text = statement.partition("=")[2]
        others = [other.index for other in self._plan.readers(span)]
        standing = self._places.text(span)
        if others and float(standing) != float(text):
            raise InputError(
                f"the inline form's approximation distance, {standing}, is read by "
                f"{listed(others)} as well: give it move data of its own on the teach pendant"
            )
        return Edit(span, standing if float(standing) == float(text) else text, use.index)


def _other_change(old: Move, new: Move) -> str | None:
    return None if type(old.target) is type(new.target) else "kind of target"


def _motions(parts: Sequence[Use]) -> list[PlacedMove]:
    """All moves in the order of execution."""
    literals: defaultdict[int, dict[str, frozenset[Span]]] = defaultdict(dict)
    for use in parts:
        if use.kind in (UseKind.SPEED, UseKind.ZONE):
            literals[use.index].update(literals_of(use))
    found = {
        use.index: PlacedMove(use.index, use.move, use.statement, literals[use.index])
        for use in parts
    }
    return [found[index] for index in sorted(found)]
