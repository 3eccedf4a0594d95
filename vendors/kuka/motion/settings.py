"""System variables → speeds, zones, tools and frames of a move.

How KUKA's words map:

- PTP: ``$VEL_AXIS`` and ``$ACC_AXIS`` in percent are shares of every joint's own maximum; where
  axes differ, the smallest counts for all.
- LIN and CIRC: ``$VEL`` and ``$ACC``; of swivel (ORI1) and rotation (ORI2) the smaller one.
- ``$OV_PRO`` scales speeds, not accelerations.
- C_PTP begins at ``$APO.CPTP`` percent of half the contour, C_DIS at ``$APO.CDIS`` mm, for the
  position, the orientation and external axes alike; an approximation of 0 is a zone of no size.
- With ``$ADVANCE=0`` nothing is approximated.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ....core.errors import SourceError, Span
from ....core.program.speed import Speed
from ....core.program.zone import FINE, Angle, ContourFraction, Radius, VendorZone, Zone
from ..values.predefined import AXES
from ..values.provenance import Sources
from ..values.scope import Variable
from ..values.values import (
    Array,
    Choice,
    Pending,
    Struct,
    Unknown,
    Value,
    find_unknown,
    left_open,
    supposed,
)
from ..zone_kinds import C_VEL

Note = Callable[[str, str, Span], None]
_FULL = 100.0
_USUAL = {"$advance": 3.0, "$ov_pro": 100.0}
_KIND = {"$ori_type": "var", "$circ_type": "base"}
"""What is taken for those that are not known."""
_KINDS = {"c_dis": "cdis", "c_spl": "cdis", "c_ori": "cori", "c_vel": "cvel", "c_ptp": "cptp"}


@dataclass(frozen=True, slots=True)
class Set:
    """A speed or a zone with the literals of its numbers.

    Args:
        supposed: what a zone depends on that the text does not say.
    """

    value: Speed | Zone
    sources: Sources
    supposed: str = ""


_NOTHING = Sources(())


class Settings:
    """The system variables that speeds and zones are made of.

    Args:
        defaults: a datum of ``$CONFIG.DAT``, for what a program never sets.
    """

    def __init__(
        self, system: Mapping[str, Variable], defaults: Callable[[str], Value], note: Note
    ) -> None:
        self._system = system
        self._defaults = defaults
        self._note = note
        self._cache: dict[object, Set] = {}
        self._opened = ""

    def changed(self) -> None:
        """A system variable has another value now."""
        self._cache.clear()

    # ------------------------------------------------------------------------ values

    def _value(self, name: str) -> Value:
        cell = self._system[name]
        value = cell.value
        assert value is not None and not isinstance(value, Pending)
        if cell.supposed:
            self._opened = self._opened or f"{name.upper()} depends on {cell.supposed}"
        return value

    def number(self, name: str, span: Span) -> float:
        """A system variable that is one number.

        Raises:
            SourceError: it is not known.
        """
        value = supposed(self._value(name))
        if isinstance(value, Unknown):
            usual = _USUAL[name]
            self._open(name.upper(), value, f"{usual:g}", span)
            return usual
        return self._number(value, name.upper(), span)

    def _open(self, what: str, unknown: Unknown, taken: str, span: Span) -> None:
        """Say what is taken for a value that is not known.

        Raises:
            LeftOpenError: it is one that a damaged line would have set.
        """
        if unknown.damaged:
            raise left_open(what, unknown, span)
        self._opened = f"{what} depends on {unknown.reason}"
        self._note(
            f"{what} {unknown.reason}",
            f"{self._opened}, which the text does not say: {taken} is taken",
            span,
        )

    def choice(self, name: str, span: Span) -> str:
        """A system variable that is a constant, lower case.

        Raises:
            SourceError: it is not known, or no constant.
        """
        value = supposed(self._value(name))
        if isinstance(value, Unknown):
            self._open(name.upper(), value, _KIND[name].upper(), span)
            return _KIND[name]
        if not isinstance(value, Choice):
            raise SourceError(f"{name.upper()} is not known here", span)
        return value.name

    @staticmethod
    def _number(value: Value, what: str, span: Span) -> float:
        unknown = find_unknown(value)
        if unknown is not None:
            raise left_open(what, unknown, span)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise SourceError(f"{what} is no number", span)
        return float(value)

    def _component(self, name: str, component: str, default: str, span: Span) -> Value:
        """A component, or its default where nothing was set."""
        holder = supposed(self._value(name))
        found: Value | None = holder if isinstance(holder, Unknown) else None
        if isinstance(holder, Struct):
            found = holder.fields.get(component)
        value = self._defaults(default)
        if isinstance(found, Unknown):
            taken = supposed(found)
            unknown, found = found, None if isinstance(taken, Unknown) else taken
            number = self._number(value if found is None else found, default, span)
            self._open(f"{name.upper()}.{component.upper()}", unknown, f"{number:g}", span)
            return number
        if found is not None:
            return found
        shown = self._number(value, default, span)
        self._note(
            default,
            f"{name.upper()}.{component.upper()} is never set: {default}={shown:g} is assumed",
            span,
        )
        return float(shown)

    def _axes(self, name: str, default: str, span: Span) -> list[Value]:
        holder = supposed(self._value(name))
        values: list[Value] = []
        for k in range(1, AXES + 1):
            found: Value | Pending | None = holder if isinstance(holder, Unknown) else None
            if isinstance(holder, Array):
                found = holder.items.get((k,))
            if isinstance(found, Unknown):
                unknown, found = found, supposed(found)
                if isinstance(found, Unknown):
                    found = self._number(self._defaults(default), default, span)
                self._open(name.upper(), unknown, f"{found:g}", span)
            if found is None or isinstance(found, Pending):
                found = float(self._number(self._defaults(default), default, span))
                self._note(
                    default,
                    f"{name.upper()} is never set: {default}={found:g} is assumed",
                    span,
                )
            values.append(found)
        return values

    # ------------------------------------------------------------------------ speeds

    def joint_speed(self, span: Span) -> Set:
        """Of a PTP.

        Raises:
            SourceError: a share is not known, or not above zero.
        """
        return self._cached("joint speed", lambda: self._joint_speed(span))

    def _joint_speed(self, span: Span) -> Set:
        velocities = self._axes("$vel_axis", "DEF_VEL_PTP", span)
        accelerations = self._axes("$acc_axis", "DEF_ACC_PTP", span)
        override = self._override(span)
        velocity = self._least(velocities, "$VEL_AXIS", span)
        acceleration = self._least(accelerations, "$ACC_AXIS", span)
        speed = Speed(
            joint_fraction=override * velocity / 100, joint_acceleration_fraction=acceleration / 100
        )
        values = [*velocities, *accelerations]
        return Set(speed, _NOTHING if override != 1 else Sources.each(values))

    def _least(self, values: list[Value], name: str, span: Span) -> float:
        """The smallest percentage of the axes."""
        numbers = [self._number(v, f"{name}[{k}]", span) for k, v in enumerate(values, 1)]
        if min(numbers) <= 0:
            axis = numbers.index(min(numbers)) + 1
            raise SourceError(
                f"{name}[{axis}] is {min(numbers):g}: a percentage above 0 is wanted", span
            )
        if min(numbers) != max(numbers):
            self._note(
                name, f"{name} differs between axes: the smallest, {min(numbers):g} %, counts", span
            )
        return min(_FULL, *numbers)

    def _override(self, span: Span) -> float:
        override = self.number("$ov_pro", span)
        if not 0 < override <= _FULL:
            raise SourceError(f"$OV_PRO is {override:g}: 1 to 100 is wanted", span)
        if override != _FULL:
            self._note("$OV_PRO", f"$OV_PRO={override:g} scales the speeds", span)
        return override / 100

    def path_speed(self, span: Span) -> Set:
        """Of LIN and CIRC.

        Raises:
            SourceError: a speed is not known, or not above zero.
        """
        return self._cached("path speed", lambda: self._path_speed(span))

    def _path_speed(self, span: Span) -> Set:
        names = ("cp", "ori1", "ori2")
        values = [
            self._component(variable, name, f"DEF_{variable[1:].upper()}_{name.upper()}", span)
            for variable in ("$vel", "$acc")
            for name in names
        ]
        whats = [f"{v}.{name.upper()}" for v in ("$VEL", "$ACC") for name in names]
        numbers = [self._number(v, w, span) for v, w in zip(values, whats, strict=True)]
        for number, what in zip(numbers, whats, strict=True):
            if number <= 0:
                raise SourceError(f"{what} is {number:g}: a value above 0 is wanted", span)
        override = self._override(span)
        tcp, ori1, ori2, tcp_up, ori1_up, ori2_up = numbers
        speed = Speed(
            tcp=_finite(override * tcp),
            reorientation=_turn(override * min(ori1, ori2)),
            tcp_acceleration=_finite(tcp_up),
            reorientation_acceleration=_turn(min(ori1_up, ori2_up)),
        )
        return Set(speed, _NOTHING if override != 1 else Sources.each(values))

    # ------------------------------------------------------------------------- zones

    def zone(self, words: tuple[str, ...], joint: bool, spline: bool, span: Span) -> Set:
        """What the words behind a motion ask for.

        Args:
            words: ``c_dis`` and so on.
            joint: of a PTP or SPTP.
            spline: of SPTP, SLIN or SCIRC.

        Raises:
            SourceError: the motion takes no such approximation, or its size is not known.
        """
        if not words:
            return Set(FINE, _NOTHING)
        if self.number("$advance", span) < 1:
            self._note("$ADVANCE", "$ADVANCE=0: nothing is approximated", span)
            return Set(FINE, _NOTHING)
        kind = self._criterion(words, joint, spline, span)
        return self._cached(("zone", kind), lambda: self._zone(kind, span))

    def passing(self, joint: bool, room: Radius) -> Set:
        """Of a point at which another segment of a spline block or of a circle follows."""
        return Set(ContourFraction(1.0) if joint else room, _NOTHING)

    def _criterion(self, words: tuple[str, ...], joint: bool, spline: bool, span: Span) -> str:
        """The component of ``$APO`` that counts."""
        if joint:
            if "c_ptp" in words:
                return "cptp"
            if words[0] == "c_spl" and spline and self._mode("ptp_mode") == "cptp":
                return "cptp"
            if words[0] in ("c_dis", "c_spl"):
                return "cdis"
            raise SourceError(
                f"{words[0].upper()} is no approximation of a PTP: C_PTP and C_DIS are", span
            )
        if words[0] == "c_ptp":
            others = [word for word in words if word != "c_ptp"]
            if not others:
                raise SourceError(
                    "C_PTP is no approximation of LIN and CIRC: C_DIS, C_ORI and C_VEL are", span
                )
            return _KINDS[others[0]]
        return _KINDS[words[0]]

    def _mode(self, name: str) -> str:
        apo = self._value("$apo")
        mode = apo.fields.get(name) if isinstance(apo, Struct) else None
        return mode.name if isinstance(mode, Choice) else ""

    def _zone(self, kind: str, span: Span) -> Set:
        self._opened = ""
        value = self._component("$apo", kind, f"DEF_APO_{kind.upper()}", span)
        number = self._number(value, f"$APO.{kind.upper()}", span)
        if number < 0:
            raise SourceError(f"$APO.{kind.upper()} is {number:g}: 0 or more is wanted", span)
        if kind in ("cptp", "cvel") and number > _FULL:
            self._note(kind, f"$APO.{kind.upper()} is {number:g} %: 100 % counts", span)
            number = _FULL
        zone: Zone
        if kind == "cdis":
            zone = Radius(number / 1000, number / 1000, number / 1000)
        elif kind == "cori":
            zone = Angle(math.radians(number))
        elif kind == "cvel":
            zone = VendorZone(C_VEL, number / 100)
        else:
            zone = ContourFraction(number / 100)
        return Set(zone, Sources.each([value]), self._opened)

    def _cached(self, key: object, make: Callable[[], Set]) -> Set:
        if key not in self._cache:
            self._cache[key] = make()
        return self._cache[key]


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _turn(degrees: float) -> float | None:
    return math.radians(degrees) if math.isfinite(degrees) else None
