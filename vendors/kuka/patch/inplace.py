"""Literal numbers changed where they stand."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from ....core.errors import Span
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.zone import Angle, ContourFraction, Radius, VendorZone, Zone
from ....core.robot.joint import JointKind
from ....core.robot.model import Robot
from ....core.source.patch.edits import TOLERANCE, alike
from ....core.source.patch.plan import Texts, Wish
from ....core.source.patch.uses import Use, UseKind
from ....core.source.text.numerals import shortest
from ..motion.configuration import KukaConfiguration
from ..values.angles import written_angles
from ..values.types import EXTERNAL_FIELDS, external_fields
from ..write.formatting import MM
from ..write.numbers import number
from ..write.speeds import zone_settings
from .places import Places


@dataclass(frozen=True, slots=True)
class Component:
    """A number of a part of a move.

    Args:
        name: as an aggregate calls it.
        changes: whether it becomes another one.
        text: what it becomes, from the text that stands there.
    """

    name: str
    changes: bool
    text: Callable[[str], str]


class KrlLiterals:
    """What the literals of a program would have to say."""

    def __init__(self, places: Places, robot: Robot) -> None:
        self._places = places
        self._robot = robot

    def text(self, span: Span) -> str:
        """What stands at a place."""
        return self._places.text(span)

    def wish(self, use: Use) -> Wish:
        """See `core.source.patch.plan.Literals.wish`."""
        texts, missing = self._find(use)
        return Wish(texts, complete=not missing)

    def missing(self, use: Use) -> Sequence[Component]:
        """The components that change and that no literal states."""
        return self._find(use)[1]

    def _find(self, use: Use) -> tuple[Texts, Sequence[Component]]:
        numbers = use.origin.numbers
        found = list(self._components(use))
        if len(found) != len(numbers):
            present = {s: self._places.text(s) for s in numbers if s is not None}
            return present, [c for c in found if c.changes]
        texts: dict[Span, str] = {}
        missing: list[Component] = []
        for component, span in zip(found, numbers, strict=True):
            if span is None:
                missing += [component] if component.changes else []
                continue
            text = self._places.text(span)
            new = component.text(text) if component.changes else text
            if texts.get(span, new) != new:
                missing.append(component)  # one literal for two numbers that part
            texts[span] = new
        return texts, missing

    def _components(self, use: Use) -> Iterator[Component]:
        old, new = use.old, use.new
        if isinstance(old, PoseTarget) and isinstance(new, PoseTarget):
            yield from _pose(old, new)
            yield from self._external(old.external, new.external)
        elif isinstance(old, JointTarget) and isinstance(new, JointTarget):
            joints = zip(old.joints, new.joints, self._robot.joints, strict=True)
            for k, (a, b, joint) in enumerate(joints, 1):
                component = _length if joint.kind is JointKind.PRISMATIC else _angle
                yield component(f"A{k}", a, b)
            yield from self._external(old.external, new.external)
        elif isinstance(old, Speed) and isinstance(new, Speed):
            yield from _speed(old, new, len(use.origin.numbers))
        elif type(old) is type(new):
            (a, unit), (b, _) = _size(old), _size(new)  # type: ignore[arg-type]
            yield Component("APO", not _same(a, b), _scaled(a, b, unit))

    def _external(self, old: Sequence[float], new: Sequence[float]) -> Iterator[Component]:
        axes = self._robot.external_axes
        names = external_fields(self._robot)
        for name in EXTERNAL_FIELDS:
            k = names.index(name) if name in names else len(axes)
            a = old[k] if k < len(old) else 0.0
            b = new[k] if k < len(new) else a
            linear = k < len(axes) and axes[k].joint.kind is JointKind.PRISMATIC
            yield _length(name.upper(), a, b) if linear else _angle(name.upper(), a, b)


def literals_of(use: Use) -> dict[str, frozenset[Span]]:
    """Where the numbers of each variable stand that a speed or zone reads.

    Those of all axes stand under ``$VEL_AXIS`` and ``$ACC_AXIS``.
    """
    found: dict[str, frozenset[Span]] = {}
    for name, span in zip(_variables(use), use.origin.numbers, strict=False):
        if span is not None:
            found[name] = found.get(name, frozenset()) | {span}
    return found


def _variables(use: Use) -> list[str]:
    if use.kind is UseKind.ZONE:
        return [variable for variable, _ in zone_settings(use.old)]  # type: ignore[arg-type]
    if len(use.origin.numbers) == _OF_AXES:
        return ["$VEL_AXIS"] * 6 + ["$ACC_AXIS"] * 6
    return [f"${name}" for name, _, _ in _OF_PATH]


def _pose(old: PoseTarget, new: PoseTarget) -> Iterator[Component]:
    for name, a, b in zip("XYZ", old.pose.position, new.pose.position, strict=True):
        yield _length(name, a, b)
    turned = not alike(old.pose.quaternion, new.pose.quaternion)
    for name, angle in zip("ABC", written_angles(new.pose.quaternion), strict=True):
        yield Component(name, turned, _fixed(number(angle)))
    stated = new.configuration if isinstance(new.configuration, KukaConfiguration) else None
    before = old.configuration if isinstance(old.configuration, KukaConfiguration) else None
    for name, attribute in (("S", "status"), ("T", "turn")):
        was, wanted = getattr(before, attribute, None), getattr(stated, attribute, None)
        yield Component(name, wanted is not None and was != wanted, _fixed(str(wanted)))


_OF_AXES = 12
_DEGREES = math.degrees(1.0)
_OF_PATH = (
    ("VEL.CP", "tcp", 1.0),
    ("VEL.ORI1", "reorientation", _DEGREES),
    ("VEL.ORI2", "reorientation", _DEGREES),
    ("ACC.CP", "tcp_acceleration", 1.0),
    ("ACC.ORI1", "reorientation_acceleration", _DEGREES),
    ("ACC.ORI2", "reorientation_acceleration", _DEGREES),
)
"""The numbers of a TCP move's speed: variable, attribute of `Speed`, KRL's unit in an SI unit."""


def _speed(old: Speed, new: Speed, count: int) -> Iterator[Component]:
    """Twelve percentages of a joint move's, or the six numbers of a TCP move's."""
    if count == _OF_AXES:
        for name, attribute in (("VEL", "joint_fraction"), ("ACC", "joint_acceleration_fraction")):
            a, b = getattr(old, attribute), getattr(new, attribute)
            for k in range(6):
                yield Component(f"{name}_AXIS[{k + 1}]", not _same(a, b), _scaled(a, b, 100.0))
        return
    for name, attribute, unit in _OF_PATH:
        a, b = getattr(old, attribute), getattr(new, attribute)
        yield Component(name, not _same(a, b), _scaled(a, b, unit))


def _size(zone: Zone) -> tuple[float, float]:
    """The size of a zone, and KRL's unit in an SI unit."""
    if isinstance(zone, Radius):
        return zone.tcp, 1 / MM
    if isinstance(zone, Angle):
        return zone.angle, _DEGREES
    if isinstance(zone, VendorZone):
        return zone.size, 100.0
    return (zone.fraction if isinstance(zone, ContourFraction) else 0.0), 100.0


def _same(old: float | None, new: float | None) -> bool:
    return old is new or (old is not None and new is not None and alike(old, new))


def _length(name: str, old: float, new: float) -> Component:
    text = shortest(new, new / MM, lambda mm: mm / 1000)
    return Component(name, not _same(old, new), _fixed(text))


def _angle(name: str, old: float, new: float) -> Component:
    text = shortest(new, math.degrees(new), math.radians)
    return Component(name, not _same(old, new), _fixed(text))


def _fixed(text: str) -> Callable[[str], str]:
    return lambda _: text


def _scaled(old: float | None, new: float | None, unit: float) -> Callable[[str], str]:
    """What a number becomes that stands in the text for ``old``.

    A literal need not state the value itself: percentages are of maxima that stand elsewhere.
    """

    def text(standing: str) -> str:
        if new is None:
            return standing
        said = float(standing)
        if old is not None and said != 0 and not math.isclose(said, old * unit, rel_tol=TOLERANCE):
            return number(said * new / old)
        return number(new * unit)

    return text
