"""What ``BAS(…)`` and the functions of inline forms do, carried out natively.

What is set, and from which default of ``$CONFIG.DAT``, follows a published ``BAS.SRC`` (KSS 8). Its
corrections of tool and base (``TOOL_CORR`` and the like) are left out; with adaptive accelerations,
which the controllers have switched on, a percentage of a PTP is ``$ACC_AXIS`` itself.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass

from ....core.errors import SourceError, Span
from ....core.source.execution.transcript import Notes
from ..syntax.tree import Call, Constant, Expression
from ..values.config_data import ConfigData
from ..values.data import Data
from ..values.evaluator import Evaluator
from ..values.frames import null_frame
from ..values.scope import Scope
from ..values.types import convert
from ..values.values import Array, Choice, Struct, Unknown, Value, find_unknown, shown, supposed
from .tables import Tables

AXES = 6
Command = Callable[["Basis", Value | None, Span], None]


@dataclass(frozen=True, slots=True)
class Basis:
    """The commands of ``BAS``.

    Args:
        changed: called when system variables have other values.
    """

    data: Data
    evaluator: Evaluator
    config: ConfigData
    tables: Tables
    notes: Notes
    changed: Callable[[], None]

    def invoke(self, call: Call, scope: Scope) -> None:
        """``BAS(#COMMAND, value)``

        Raises:
            SourceError: the command is not known, or its value is missing.
        """
        arguments = call.arguments
        first = arguments[0] if arguments else None
        command = None if first is None else self._command(first, scope)
        if command is None:
            raise SourceError(f"{call.text} begins with a command, as #INITMOV", call.span)
        handler = _COMMANDS.get(command)
        if handler is None:
            self.notes.once(
                f"bas {command}",
                f"{call.text}(#{command.upper()}) is stepped over: it sets nothing that is "
                "emulated",
                call.span,
            )
            return
        second = arguments[1] if len(arguments) > 1 else None
        value = None if second is None else self.evaluator.evaluate(second, scope)
        damaged = self._damaged(command, value)
        if damaged is None:
            handler(self, value, call.span)
        else:
            self.spoil(set_by({command or ""}), damaged)
        self.changed()

    def _damaged(self, command: str | None, value: Value | None) -> Unknown | None:
        """What a damaged line would have set, and a command makes settings of."""
        names = _DATA_OF.get(command or "", ())
        made_of = [value, *(self.config.value(name) for name in names)]
        found = [find_unknown(part) for part in made_of if part is not None]
        return next((one for one in found if one is not None and one.damaged), None)

    def spoil(self, names: Iterable[str], unknown: Unknown) -> None:
        """What would have set these system variables is not known."""
        for name in names:
            self.set(name, unknown)

    def _command(self, first: Expression, scope: Scope) -> str | None:
        if isinstance(first, Constant):
            return first.name
        value = self.evaluator.known(first, scope, "the command of BAS")
        return value.name if isinstance(value, Choice) else None

    # --------------------------------------------------------------------- variables

    def default(self, name: str) -> Value:
        """A datum of ``$CONFIG.DAT``."""
        return self.config.value(name)

    def datum(self, name: str, span: Span) -> Struct:
        """``PDAT_ACT``, ``LDAT_ACT`` or ``FDAT_ACT``.

        Raises:
            SourceError: it is not known.
        """
        value = supposed(self.config.value(name))
        self.evaluator.used_as(value, name.partition("_")[0].lower())
        if isinstance(value, Unknown):
            self.notes.once(
                f"{name} {value.reason}",
                f"{name} depends on {value.reason}, which the text does not say: nothing is set "
                "by it, and percentages are taken as 100",
                span,
            )
            return Struct("")
        if not isinstance(value, Struct):
            raise SourceError(f"{name} is {shown(value)} and no structure", span)
        return value

    def set(self, name: str, value: Value) -> None:
        """A system variable."""
        cell = self.data.system[name]
        cell.assigned = True
        cell.value = value
        self.evaluator.course.sets(cell)

    def component(self, name: str, component: str, value: Value) -> None:
        """A component of a system variable."""
        cell = self.data.system[name]
        if not isinstance(cell.value, Struct):
            cell.value = Struct(cell.type)
        cell.value.fields[component] = value

    def all_axes(self, name: str, value: Value) -> None:
        """An axis variable, the same for every axis."""
        items: dict[tuple[int, ...], Value] = {(k,): value for k in range(1, AXES + 1)}
        self.set(name, Array("real", (AXES,), dict(items)))

    def share(self, percent: Value | None, default: str) -> Value:
        """A percentage of a default; the default itself for 100 and more, and if it is open."""
        full = self.default(default)
        if isinstance(full, int | float) and isinstance(percent, int | float) and percent < 100:
            return float(percent) * full / 100
        return percent if isinstance(percent, Unknown) else plain(full)

    def path_limit(self, value: Value, span: Span) -> Value:
        """A speed of the TCP, cut to ``DEF_VEL_CP``."""
        most = self.default("DEF_VEL_CP")
        if isinstance(value, int | float) and isinstance(most, int | float) and value > most:
            self.notes.once(
                "DEF_VEL_CP",
                f"a path speed of {value:g} m/s is cut to DEF_VEL_CP={most:g} m/s",
                span,
            )
            return plain(most)
        return value

    # ------------------------------------------------------------------------ frames

    def use_tool(self, number: Value | None, span: Span) -> None:
        """``BAS(#TOOL,n)``: ``$TOOL`` and ``$LOAD``."""
        index = self.index(number, "the number of a tool", span)
        self.set("$act_tool", index)
        self.set("$tool", self.frame("tool_data", index, span))
        self.set("$load", self.load(index))

    def use_base(self, number: Value | None, span: Span) -> None:
        """``BAS(#BASE,n)``"""
        index = self.index(number, "the number of a base", span)
        self.set("$act_base", index)
        base = self.frame("base_data", index, span)
        machine = self.machine_under(index)
        if machine is not None and isinstance(base, Struct):
            root = machine.fields.get("root")
            known = root if isinstance(root, Struct) and find_unknown(root) is None else None
            base = self.tables.base_on(known, base, f"MACHINE_FRAME_DAT[{index}]", span)
        self.set("$base", base)

    def machine_under(self, index: int) -> Struct | None:
        """The table that a base stands on, as ``MACHINE_FRAME_DAT`` says; None for the world."""
        link = self.config.item("machine_frame_dat", index) if index > 0 else None
        number = link.fields.get("mach_def_index") if isinstance(link, Struct) else None
        if isinstance(number, bool) or not isinstance(number, int | float) or number < 1:
            return None
        machine = self.config.item("machine_def", int(number))
        kind = machine.fields.get("mech_type") if isinstance(machine, Struct) else None
        tabled = isinstance(kind, Choice) and kind.name not in ("robot", "none", "ersys")
        return machine if tabled and isinstance(machine, Struct) else None

    def use_frames(self, value: Value | None, span: Span) -> None:
        """``BAS(#FRAMES)``: what FDAT_ACT says."""
        fdat = self.datum("FDAT_ACT", span)
        mode = fdat.fields.get("ipo_frame")
        self.set("$ipo_mode", mode if isinstance(mode, Choice) else Choice("base"))
        if "tool_no" in fdat.fields:
            self.use_tool(fdat.fields["tool_no"], span)
        if "base_no" in fdat.fields:
            self.use_base(fdat.fields["base_no"], span)

    def frame(self, table: str, index: int, span: Span) -> Value:
        """An item of ``TOOL_DATA`` or ``BASE_DATA``; item 0, and -1 for none, is the null frame.

        Raises:
            SourceError: the table has no such item.
        """
        if index <= 0:
            return null_frame()
        value = self.config.item(table, index)
        if value is None:
            return self.config.unset_frame(f"{table.upper()}[{index}]")
        return value.copy() if isinstance(value, Struct) else value

    def load(self, index: int) -> Value:
        """An item of ``LOAD_DATA``."""
        value = self.config.item("load_data", index) if index > 0 else None
        return value.copy() if isinstance(value, Struct) else Struct("load")

    def index(self, number: Value | None, what: str, span: Span) -> int:
        """A whole number; 0 for one that is not known.

        Raises:
            SourceError: it is none.
        """
        if isinstance(number, Unknown):
            unknown, number = number, supposed(number)
            number = 0 if isinstance(number, Unknown) else number
            self.notes.once(
                f"{what} {unknown.reason}",
                f"{what} depends on {unknown.reason}, which the text does not say: "
                f"{shown(number)} is taken",
                span,
            )
        if isinstance(number, bool) or not isinstance(number, int | float) or number != int(number):
            raise SourceError(f"{what} is a whole number", span)
        return int(number)

    # ------------------------------------------------------------------------ motion

    def initialise(self, value: Value | None, span: Span) -> None:
        """``BAS(#INITMOV,0)``: speeds, accelerations and approximation as ``$CONFIG.DAT`` says."""
        self.all_axes("$vel_axis", 100.0)
        self.all_axes("$acc_axis", 100.0)
        for variable in ("vel", "acc"):
            for name in ("cp", "ori1", "ori2"):
                default = self.default(f"DEF_{variable.upper()}_{name.upper()}")
                self.component(f"${variable}", name, plain(default))
        for name in ("cptp", "cdis", "cori", "cvel"):
            self.component("$apo", name, plain(self.default(f"DEF_APO_{name.upper()}")))
        self.component("$apo", "ptp_mode", Choice(""))
        self.set("$ori_type", Choice("var"))
        self.set("$circ_type", self._circle())
        self.set("$ipo_mode", Choice("base"))
        self.set("$tool", self.frame("tool_data", 1, span))
        self.set("$base", null_frame())
        self.set("$act_tool", 1)
        self.set("$act_base", 0)
        self.set("$advance", 3)

    def _circle(self) -> Choice:
        kind = self.default("DEF_CIRC_TYP")
        return kind if isinstance(kind, Choice) else Choice("base")

    def joint_data(self, value: Value | None, span: Span) -> None:
        """``BAS(#PTP_DAT)``: what PDAT_ACT says."""
        pdat = self.datum("PDAT_ACT", span).fields
        self.joint_speed(pdat.get("vel", 100.0), span)
        self._joint_data(span)

    def _joint_data(self, span: Span) -> None:
        """Acceleration and approximation: percent, or mm with ``APO_MODE #CDIS``."""
        pdat = self.datum("PDAT_ACT", span).fields
        self.joint_acceleration(pdat.get("acc", 100.0), span)
        distance, mode = pdat.get("apo_dist"), pdat.get("apo_mode")
        by_distance = isinstance(mode, Choice) and mode.name == "cdis"
        if distance is not None:
            self.component("$apo", "cdis" if by_distance else "cptp", distance)
        self.component("$apo", "ptp_mode", Choice(""))

    def joint_parameters(self, value: Value | None, span: Span) -> None:
        """``BAS(#PTP_PARAMS,n)``: PDAT_ACT and FDAT_ACT at n percent."""
        self._joint_data(span)
        self.use_frames(None, span)
        self.joint_speed(value, span)

    def joint_speed(self, value: Value | None, span: Span) -> None:
        """``BAS(#VEL_PTP,n)``"""
        self.all_axes("$vel_axis", _percent(self.given(value, "VEL_PTP", span)))

    def joint_acceleration(self, value: Value | None, span: Span) -> None:
        """``BAS(#ACC_PTP,n)``"""
        self.all_axes("$acc_axis", _percent(self.given(value, "ACC_PTP", span)))

    def path_speed(self, value: Value | None, span: Span) -> None:
        """``BAS(#VEL_CP,v)`` in m/s."""
        speed = self.path_limit(self.given(value, "VEL_CP", span), span)
        self.component("$vel", "cp", speed)

    def path_acceleration(self, value: Value | None, span: Span) -> None:
        """``BAS(#ACC_CP,n)`` in percent of the defaults, of the path and of turning."""
        percent = self.given(value, "ACC_CP", span)
        for name in ("cp", "ori1", "ori2"):
            self.component("$acc", name, self.share(percent, f"DEF_ACC_{name.upper()}"))

    def path_data(self, value: Value | None, span: Span) -> None:
        """``BAS(#CP_DAT)``: what LDAT_ACT says."""
        speed = self.datum("LDAT_ACT", span).fields.get("vel")
        if speed is not None:
            self.path_speed(speed, span)
        self._path_data(span)

    def _path_data(self, span: Span) -> None:
        """Acceleration, approximation in mm, orientation."""
        ldat = self.datum("LDAT_ACT", span).fields
        self.path_acceleration(ldat.get("acc", 100.0), span)
        if "apo_dist" in ldat:
            self.component("$apo", "cdis", ldat["apo_dist"])
        orientation, circle = ldat.get("ori_typ"), ldat.get("circ_typ")
        self.set("$ori_type", orientation if isinstance(orientation, Choice) else Choice("var"))
        self.set("$circ_type", circle if isinstance(circle, Choice) else self._circle())

    def path_parameters(self, value: Value | None, span: Span) -> None:
        """``BAS(#CP_PARAMS,v)``: LDAT_ACT and FDAT_ACT at v m/s."""
        self._path_data(span)
        self.use_frames(None, span)
        self.path_speed(value, span)

    @staticmethod
    def given(value: Value | None, command: str, span: Span) -> Value:
        """The value that a command needs.

        Raises:
            SourceError: it was left out.
        """
        if value is None:
            raise SourceError(f"BAS(#{command},…) needs a value", span)
        if isinstance(value, int) and not isinstance(value, bool):
            return convert(value, "real", {})
        return value


_COMMANDS: dict[str, Command] = {
    "initmov": Basis.initialise,
    "vel_ptp": Basis.joint_speed,
    "acc_ptp": Basis.joint_acceleration,
    "vel_cp": Basis.path_speed,
    "acc_cp": Basis.path_acceleration,
    "ptp_dat": Basis.joint_data,
    "cp_dat": Basis.path_data,
    "ptp_params": Basis.joint_parameters,
    "cp_params": Basis.path_parameters,
    "frames": Basis.use_frames,
    "tool": Basis.use_tool,
    "base": Basis.use_base,
    # Motion does not depend on them.
    **dict.fromkeys(("out_sync", "out_async", "group", "ex_bas"), lambda basis, value, span: None),
}


_JOINT, _PATH = ("$vel_axis", "$acc_axis"), ("$vel", "$acc")
_FRAMES = ("$ipo_mode", "$tool", "$base", "$load")
_CIRCLE = ("$ori_type", "$circ_type")
_ALL = (*_JOINT, *_PATH, "$apo", *_FRAMES, *_CIRCLE)
_SETS: dict[str, tuple[str, ...]] = {
    "vel_ptp": ("$vel_axis",),
    "acc_ptp": ("$acc_axis",),
    "vel_cp": ("$vel",),
    "acc_cp": ("$acc",),
    "ptp_dat": (*_JOINT, "$apo"),
    "ptp_params": (*_JOINT, "$apo", *_FRAMES),
    "cp_dat": (*_PATH, "$apo", *_CIRCLE),
    "cp_params": (*_PATH, "$apo", *_CIRCLE, *_FRAMES),
    "frames": _FRAMES,
    "tool": ("$tool", "$load"),
    "base": ("$base",),
    **dict.fromkeys(("out_sync", "out_async", "group", "ex_bas"), ()),
}
"""The system variables that a command sets; the others set all of them."""


def set_by(words: Collection[str]) -> frozenset[str]:
    """The system variables that a call of BAS sets, by the words in it; all if no command is."""
    command = next((word for word in sorted(words) if word in _COMMANDS), "")
    return frozenset(_SETS.get(command, _ALL))


_DATA_OF = {
    **dict.fromkeys(("ptp_dat",), ("PDAT_ACT",)),
    **dict.fromkeys(("cp_dat",), ("LDAT_ACT",)),
    "ptp_params": ("PDAT_ACT", "FDAT_ACT"),
    "cp_params": ("LDAT_ACT", "FDAT_ACT"),
    "frames": ("FDAT_ACT",),
}
"""The data that a command reads beside its value."""


def plain(value: Value) -> Value:
    """A default, which is nobody's to change."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    return value


def _percent(value: Value) -> Value:
    """At most 100."""
    return 100.0 if isinstance(value, int | float) and value > 100 else value
