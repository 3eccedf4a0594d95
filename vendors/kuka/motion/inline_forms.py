"""Functions of KUKA's own files that programs call for spline inline forms.

``SPTP XP1 WITH $VEL_AXIS[1]=SVEL_JOINT(50.0),$TOOL=STOOL2(FP1),… C_SPL``: what each function gives
follows from its name and the datum that it takes (see `basis` for what is assumed).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ....core.errors import SourceError
from ..syntax.expression_tree import Call
from ..values.data import Data
from ..values.scope import Scope
from ..values.values import Choice, Struct, Unknown, Value, shown
from .bas import Basis, plain

Function = Callable[[Call, list[Value | None], Scope], Value]
"""A function's value, of a call and its arguments; None is an argument left out."""


class InlineForms:
    """The functions.

    Args:
        basis: sets what they set.
        data: of the program.
    """

    def __init__(self, basis: Basis, data: Data) -> None:
        self._basis = basis
        self._data = data

    def functions(self) -> Mapping[str, Function]:
        """By lower-case name."""
        return {
            "svel_joint": self.velocity_joint,
            "sacc_joint": self.acceleration_joint,
            "svel_cp": self.velocity_path,
            "sacc_cp": self.acceleration_path,
            "sapo": self.zone_path,
            "sapo_ptp": self.zone_joint,
            "stool": self.tool,
            "stool2": self.tool,
            "sbase": self.base,
            "sload": self.load,
            "sipo_mode": self.mode,
            "sori_typ": self.orientation,
            "scirc_typ": self.circle,
            "sjerk": self.jerk,
            "sgear_jerk": self.jerk,
            "k_offs": self.base_offset,
            "varstate": self.state,
            **dict.fromkeys(_NOTHING, self.nothing),
        }

    # ------------------------------------------------------------------ spline forms

    def velocity_joint(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SVEL_JOINT(percent)``: for all axes, though it stands at axis 1."""
        value = self._first(call, arguments)
        self._basis.all_axes("$vel_axis", value)
        return value

    def acceleration_joint(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SACC_JOINT(PDAT)``"""
        value = self._fields(call, arguments).get("acc", 100.0)
        self._basis.all_axes("$acc_axis", value)
        return value

    def velocity_path(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SVEL_CP(v, , LDAT)``: turning goes at the splines' own default."""
        speed = self._basis.path_limit(self._first(call, arguments), call.span)
        turning = plain(self._basis.default("DEF_VEL_ORIS"))
        return Struct("", {"cp": speed, "ori1": turning, "ori2": turning})

    def acceleration_path(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SACC_CP(LDAT)``: its AXIS_ACC counts, for the path too."""
        fields = self._fields(call, arguments)
        percent = fields.get("axis_acc", fields.get("acc"))
        turning = self._basis.share(percent, "DEF_ACC_ORIS")
        path = self._basis.share(percent, "DEF_ACC_CP")
        return Struct("", {"cp": path, "ori1": turning, "ori2": turning})

    def zone_path(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SAPO(LDAT)``"""
        distance = self._fields(call, arguments).get("apo_dist")
        return Struct("", {} if distance is None else {"cdis": distance})

    def zone_joint(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SAPO_PTP(PDAT)``: mm, or with ``APO_MODE #CPTP`` percent."""
        fields = self._fields(call, arguments)
        distance, mode = fields.get("apo_dist"), fields.get("apo_mode")
        share = isinstance(mode, Choice) and mode.name == "cptp"
        made: dict[str, Value] = {"ptp_mode": Choice("cptp" if share else "cdis")}
        if distance is not None:
            made["cptp" if share else "cdis"] = distance
        return Struct("", made)

    def tool(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``STOOL2(FDAT)``, ``STOOL(number)``"""
        value = self._number(call, arguments, "tool_no")
        index = self._basis.index(value, "the number of a tool", call.span)
        return self._basis.frame("tool_data", index, call.span)

    def base(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SBASE(number)``"""
        value = self._number(call, arguments, "base_no")
        index = self._basis.index(value, "the number of a base", call.span)
        return self._basis.frame("base_data", index, call.span)

    def load(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SLOAD(number)``"""
        value = self._number(call, arguments, "tool_no")
        return self._basis.load(self._basis.index(value, "the number of a load", call.span))

    def mode(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SIPO_MODE(#BASE)``"""
        value = arguments[0] if arguments else None
        return value if isinstance(value, Choice) else Choice("base")

    def orientation(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SORI_TYP(LDAT)``"""
        value = self._fields(call, arguments).get("ori_typ")
        return value if isinstance(value, Choice) else Choice("var")

    def circle(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SCIRC_TYP(LDAT)``"""
        value = self._fields(call, arguments).get("circ_typ")
        return value if isinstance(value, Choice) else Choice("base")

    def jerk(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SJERK(LDAT)``, ``SGEAR_JERK(PDAT)``: not emulated."""
        return 100.0

    def base_offset(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``K_OFFS(number)``"""
        return self.base(call, arguments, scope)

    def state(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``VARSTATE("name")``: whether a datum has a value; not known of one that no file at
        hand declares."""
        name = arguments[0] if arguments else None
        cell = self._data.find(name.lower(), scope) if isinstance(name, str) else None
        if cell is None:
            return Unknown(f"{call.text} of what is declared in no file at hand", call.span)
        return Choice("declared" if cell.value is None else "initialized")

    def nothing(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """A value that motion does not depend on."""
        return 0

    # --------------------------------------------------------------------- arguments

    @staticmethod
    def _first(call: Call, arguments: list[Value | None]) -> Value:
        value = arguments[0] if arguments else None
        if value is None:
            raise SourceError(f"{call.text} needs a value", call.span)
        return value

    @staticmethod
    def _fields(call: Call, arguments: list[Value | None]) -> dict[str, Value]:
        value = arguments[0] if arguments else None
        if isinstance(value, Struct):
            return value.fields
        reason = shown(value) if value is not None else "nothing"
        raise SourceError(
            f"{call.text} takes the motion's data (a PDAT or LDAT), not {reason}: name the .dat "
            "that declares them",
            call.span,
        )

    @staticmethod
    def _number(call: Call, arguments: list[Value | None], component: str) -> Value | None:
        value = arguments[0] if arguments else None
        return value.fields.get(component) if isinstance(value, Struct) else value


_NOTHING = (
    *("use_cm_pro_values", "s_exax_ign", "s_exax_ign2", "scirc_m", "k_name", "k_shift", "sps"),
    *("k_root", "k_type"),
)
"""Functions whose values motion does not depend on."""
