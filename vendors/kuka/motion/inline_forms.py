"""Functions of KUKA's own files that programs call for spline inline forms.

``SPTP XP1 WITH $VEL_AXIS[1]=SVEL_JOINT(50.0),$TOOL=STOOL2(FP1),… C_SPL``: what each function gives
follows from its name and the datum that it takes (see `basis` for what is assumed).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ....core.errors import SourceError, Span
from ..syntax.tree import Call
from ..values.data import Data
from ..values.scope import Scope
from ..values.values import Choice, Struct, Unknown, Value, shown, supposed
from .bas import Basis, plain

Function = Callable[[Call, list[Value | None], Scope], Value]
"""A function's value, of a call and its arguments; None is an argument left out."""


class InlineForms:
    """The functions."""

    def __init__(self, basis: Basis, data: Data) -> None:
        self._basis = basis
        self._data = data

    def functions(self) -> Mapping[str, Function]:
        """By lower-case name."""
        return {
            "svel_joint": self._velocity_joint,
            "sacc_joint": self._acceleration_joint,
            "svel_cp": self._velocity_path,
            "sacc_cp": self._acceleration_path,
            "sapo": self._zone_path,
            "sapo_ptp": self._zone_joint,
            "sload": self._numbered("tool_no", "load", lambda n, span: self._basis.load(n)),
            "sipo_mode": self._mode,
            "sori_typ": self._chosen("ori_typ", "var"),
            "scirc_typ": self._chosen("circ_typ", "base"),
            "varstate": self._state,
            **dict.fromkeys(("stool", "stool2"), self._item("tool")),
            **dict.fromkeys(("sbase", "k_offs"), self._item("base")),
            **dict.fromkeys(("sjerk", "sgear_jerk"), lambda call, arguments, scope: 100.0),
            **dict.fromkeys(_NOTHING, lambda call, arguments, scope: 0),
        }

    # ------------------------------------------------------------------ spline forms

    def _velocity_joint(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SVEL_JOINT(percent)``: for all axes, though it stands at axis 1."""
        value = self._first(call, arguments)
        self._basis.all_axes("$vel_axis", value)
        return value

    def _acceleration_joint(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SACC_JOINT(PDAT)``"""
        value = self._fields(call, arguments).get("acc", 100.0)
        self._basis.all_axes("$acc_axis", value)
        return value

    def _velocity_path(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SVEL_CP(v, , LDAT)``: turning goes at the splines' own default."""
        speed = self._basis.path_limit(self._first(call, arguments), call.span)
        turning = plain(self._basis.default("DEF_VEL_ORIS"))
        return Struct("", {"cp": speed, "ori1": turning, "ori2": turning})

    def _acceleration_path(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SACC_CP(LDAT)``: its AXIS_ACC counts, for the path too."""
        fields = self._fields(call, arguments)
        percent = fields.get("axis_acc", fields.get("acc"))
        turning = self._basis.share(percent, "DEF_ACC_ORIS")
        path = self._basis.share(percent, "DEF_ACC_CP")
        return Struct("", {"cp": path, "ori1": turning, "ori2": turning})

    def _zone_path(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SAPO(LDAT)``"""
        distance = self._fields(call, arguments).get("apo_dist")
        return Struct("", {} if distance is None else {"cdis": distance})

    def _zone_joint(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SAPO_PTP(PDAT)``: mm, or with ``APO_MODE #CPTP`` percent."""
        fields = self._fields(call, arguments)
        distance, mode = fields.get("apo_dist"), fields.get("apo_mode")
        share = isinstance(mode, Choice) and mode.name == "cptp"
        made: dict[str, Value] = {"ptp_mode": Choice("cptp" if share else "cdis")}
        if distance is not None:
            made["cptp" if share else "cdis"] = distance
        return Struct("", made)

    def _item(self, kind: str) -> Function:
        """``STOOL2(FDAT)``, ``STOOL(number)``, ``SBASE(number)``, ``K_OFFS(number)``"""
        return self._numbered(
            f"{kind}_no", kind, lambda number, span: self._basis.frame(f"{kind}_data", number, span)
        )

    def _numbered(self, component: str, kind: str, made: Callable[[int, Span], Value]) -> Function:
        """What has a number in ``$CONFIG.DAT``; the number may stand in an FDAT."""

        def value(call: Call, arguments: list[Value | None], scope: Scope) -> Value:
            given = arguments[0] if arguments else None
            whole = isinstance(given, Unknown) and "." not in given.key
            self._basis.evaluator.used_as(given, "fdat" if whole else "int")
            number = given.fields.get(component) if isinstance(given, Struct) else given
            return made(self._basis.index(number, f"the number of a {kind}", call.span), call.span)

        return value

    def _chosen(self, component: str, otherwise: str) -> Function:
        """``SORI_TYP(LDAT)``, ``SCIRC_TYP(LDAT)``"""

        def value(call: Call, arguments: list[Value | None], scope: Scope) -> Value:
            found = self._fields(call, arguments).get(component)
            return found if isinstance(found, Choice) else Choice(otherwise)

        return value

    def _mode(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SIPO_MODE(#BASE)``"""
        value = arguments[0] if arguments else None
        self._basis.evaluator.used_as(value, "ipo_m_t")
        return value if isinstance(value, Choice) else Choice("base")

    def _state(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``VARSTATE("name")``: whether a datum has a value; not known of one that no file at
        hand declares."""
        name = arguments[0] if arguments else None
        cell = self._data.find(name.lower(), scope) if isinstance(name, str) else None
        if cell is None:
            return Unknown(f"{call.text} of what is declared in no file at hand", call.span)
        return Choice("declared" if cell.value is None else "initialized")

    # --------------------------------------------------------------------- arguments

    @staticmethod
    def _first(call: Call, arguments: list[Value | None]) -> Value:
        value = arguments[0] if arguments else None
        if value is None:
            raise SourceError(f"{call.text} needs a value", call.span)
        return value

    def _fields(self, call: Call, arguments: list[Value | None]) -> dict[str, Value]:
        value = arguments[0] if arguments else None
        joint = call.name in ("sacc_joint", "sapo_ptp", "sgear_jerk")
        self._basis.evaluator.used_as(value, "pdat" if joint else "ldat")
        if isinstance(value, Unknown):
            unknown, value = value, supposed(value)
            if not isinstance(value, Struct):
                self._basis.notes.count(
                    f"{call.text} takes the motion's data (a PDAT or LDAT), and {unknown.reason} "
                    "is not known: 100 % and an approximation as set before are taken; name the "
                    ".dat that declares them",
                    call.span,
                )
                return {}
        if isinstance(value, Struct):
            return value.fields
        reason = shown(value) if value is not None else "nothing"
        raise SourceError(
            f"{call.text} takes the motion's data (a PDAT or LDAT), not {reason}: name the .dat "
            "that declares them",
            call.span,
        )


_NOTHING = (
    *("use_cm_pro_values", "s_exax_ign", "s_exax_ign2", "scirc_m", "k_name", "k_shift", "sps"),
    *("k_root", "k_type"),
)
"""Functions whose values motion does not depend on."""
