"""Functions of KUKA's own files that programs call: spline inline forms, coupled bases, kinematics.

``SPTP XP1 WITH $VEL_AXIS[1]=SVEL_JOINT(50.0),$TOOL=STOOL2(FP1),… C_SPL``: what each function gives
follows from its name and the datum that it takes (see `basis` for what is assumed).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from ....core.errors import SourceError
from ....core.program.move import MoveJ
from ....core.program.speed import Speed
from ....core.program.target import JointTarget
from ....core.robot.joint import ExternalRole
from .basis import plain
from .frames import frame_of
from .scope import Scope
from .terms import Call, Name
from .values import Choice, Struct, Unknown, Value, find_unknown, shown

if TYPE_CHECKING:
    from .interpreter import Interpreter

Function = Callable[["Inline", Call, list[Value | None], Scope], Value]


class Inline:
    """The functions.

    Args:
        run: the program run.
    """

    def __init__(self, run: Interpreter) -> None:
        self.run = run

    def value(self, call: Call, scope: Scope) -> Value | None:
        """The value of a call; None if the function is none of these."""
        function = _FUNCTIONS.get(call.name)
        if function is None:
            return None
        evaluate = self.run.evaluator.evaluate
        arguments = [None if a is None else evaluate(a, scope) for a in call.arguments]
        return function(self, call, arguments, scope)

    # ------------------------------------------------------------------ spline forms

    def velocity_joint(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SVEL_JOINT(percent)``: for all axes, though it stands at axis 1."""
        value = self._first(call, arguments)
        self.run.basis.all_axes("$vel_axis", value)
        return value

    def acceleration_joint(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SACC_JOINT(PDAT)``"""
        value = self._fields(call, arguments).get("acc", 100.0)
        self.run.basis.all_axes("$acc_axis", value)
        return value

    def velocity_path(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SVEL_CP(v, , LDAT)``: turning goes at the splines' own default."""
        speed = self.run.basis.path_limit(self._first(call, arguments), call.span)
        turning = plain(self.run.basis.default("DEF_VEL_ORIS"))
        return Struct("", {"cp": speed, "ori1": turning, "ori2": turning})

    def acceleration_path(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SACC_CP(LDAT)``: its AXIS_ACC counts, for the path too."""
        fields = self._fields(call, arguments)
        percent = fields.get("axis_acc", fields.get("acc"))
        turning = self.run.basis.share(percent, "DEF_ACC_ORIS")
        path = self.run.basis.share(percent, "DEF_ACC_CP")
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
        index = self.run.basis.index(value, "the number of a tool", call.span)
        return self.run.basis.frame("tool_data", index, call.span)

    def base(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SBASE(number)``"""
        value = self._number(call, arguments, "base_no")
        index = self.run.basis.index(value, "the number of a base", call.span)
        return self.run.basis.frame("base_data", index, call.span)

    def load(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``SLOAD(number)``"""
        value = self._number(call, arguments, "tool_no")
        return self.run.basis.load(self.run.basis.index(value, "the number of a load", call.span))

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

    # ----------------------------------------------------------------- coupled bases

    def coupled(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``EK(root, type, offset)``: a base on the robot's table.

        Raises:
            SourceError: the robot has no table, or several that this may mean.
        """
        robot = self.run.robot
        tables = (
            []
            if robot is None
            else [axis.name for axis in robot.external_axes if axis.role is ExternalRole.TABLE]
        )
        if robot is not None:
            carriers = {axis.carried_by for axis in robot.external_axes}
            tables = [name for name in tables if name not in carriers]
        if len(tables) != 1:
            have = "no robot is named" if robot is None else f"the robot has {len(tables)} tables"
            raise SourceError(
                f"{call.text} couples the base to an external kinematic system, but {have}: name "
                "a robot whose external axes hold the one table that is meant",
                call.span,
            )
        offset = arguments[2] if len(arguments) > 2 else None
        made = offset.copy() if isinstance(offset, Struct) else Struct("frame")
        made.moved_by = tables[0]
        self.run.note_once(
            "EK",
            f"{call.text}: the base is on {tables[0]}, at its place in the robot's cell",
            call.span,
        )
        return made

    def base_offset(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``K_OFFS(number)``"""
        return self.base(call, arguments, scope)

    def state(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``VARSTATE("name")``: whether a datum has a value; not known of one that no file at
        hand declares."""
        name = arguments[0] if arguments else None
        cell = self.run.data.find(name.lower(), scope) if isinstance(name, str) else None
        if cell is None:
            return Unknown(f"{call.text} of what is declared in no file at hand", call.span)
        return Choice("declared" if cell.value is None else "initialized")

    def nothing(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """A value that motion does not depend on."""
        return 0

    # -------------------------------------------------------------------- kinematics

    def forward(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``FORWARD(axes, error)``: the pose of ``$TOOL`` in ``$BASE``."""
        robot, axes = self.run.robot, arguments[0] if arguments else None
        if robot is None or not isinstance(axes, Struct):
            return Unknown(f"the value of {call.text} (name the robot)", call.span)
        placement = self.run.placements.current(call.span)
        found = self.run.targets.joints(axes, call.span)
        assert isinstance(found.target, JointTarget)
        from ....core.motion.standing import Standing
        from ..configuration import label

        standing = Standing(robot, label, found.target)
        made = frame_of(standing.pose(placement.tool, placement.work_object), "e6pos")
        self._no_error(call, scope)
        return made

    def inverse(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``INVERSE(position, near, error)``"""
        run = self.run
        position = arguments[0] if arguments else None
        if run.robot is None or not isinstance(position, Struct):
            return Unknown(f"the value of {call.text} (name the robot)", call.span)
        placement = run.placements.current(call.span)
        found = run.targets.pose(position, placement, True, False, call.span)
        near = arguments[1] if len(arguments) > 1 else None
        start = None
        if isinstance(near, Struct) and find_unknown(near) is None:
            joints = run.targets.joints(near, call.span).target
            from ....core.motion.standing import Standing
            from ..configuration import label

            assert isinstance(joints, JointTarget)
            start = Standing(run.robot, label, joints).joints()
        move = MoveJ(found.target, Speed(), tool=placement.tool, work_object=placement.work_object)
        q = run.position.solve(move, start, call.span)
        self._no_error(call, scope)
        return run.position.axis_struct(q)

    def _no_error(self, call: Call, scope: Scope) -> None:
        """The last argument takes the number of an error: none."""
        last = call.arguments[-1] if call.arguments else None
        if isinstance(last, Name) and len(call.arguments) > 1:
            self.run.evaluator.assign(last, 0, scope, call.span)

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


_FUNCTIONS: dict[str, Function] = {
    "svel_joint": Inline.velocity_joint,
    "sacc_joint": Inline.acceleration_joint,
    "svel_cp": Inline.velocity_path,
    "sacc_cp": Inline.acceleration_path,
    "sapo": Inline.zone_path,
    "sapo_ptp": Inline.zone_joint,
    "stool": Inline.tool,
    "stool2": Inline.tool,
    "sbase": Inline.base,
    "sload": Inline.load,
    "sipo_mode": Inline.mode,
    "sori_typ": Inline.orientation,
    "scirc_typ": Inline.circle,
    "sjerk": Inline.jerk,
    "sgear_jerk": Inline.jerk,
    "use_cm_pro_values": Inline.nothing,
    "s_exax_ign": Inline.nothing,
    "s_exax_ign2": Inline.nothing,
    "scirc_m": Inline.nothing,
    "k_name": Inline.nothing,
    "k_shift": Inline.nothing,
    "sps": Inline.nothing,
    "ek": Inline.coupled,
    "eb": Inline.coupled,
    "k_root": Inline.nothing,
    "k_type": Inline.nothing,
    "k_offs": Inline.base_offset,
    "forward": Inline.forward,
    "inverse": Inline.inverse,
    "varstate": Inline.state,
}
