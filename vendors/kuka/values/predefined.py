"""System variables: what they hold before a program sets them.

Names, types and units: KUKA "Quickguide KRL-Syntax" and published programs. The machine's own
maxima, ``$VEL_MA`` and ``$ACC_MA``, count as infinite: what is set to them is left to the robot.
"""

from __future__ import annotations

import math

from ....core.source.text.lexer import words
from .frames import null_frame
from .scope import Variable
from .values import Array, Choice, Struct, Value

AXES = 6


def _array(value: float, count: int = AXES) -> Array:
    return Array("real", (count,), {(k,): float(value) for k in range(1, count + 1)})


def _struct(type_name: str, **fields: float) -> Struct:
    return Struct(type_name, dict(fields))


def initial() -> dict[str, Variable]:
    """The system variables that motion depends on, by lower-case name."""
    most = math.inf
    values: dict[str, tuple[str, Value]] = {
        "$vel": ("cp", Struct("cp")),
        "$acc": ("cp", Struct("cp")),
        "$vel_ma": ("cp", _struct("cp", cp=most, ori1=most, ori2=most)),
        "$acc_ma": ("cp", _struct("cp", cp=most, ori1=most, ori2=most)),
        "$apo": ("apo", Struct("apo")),
        "$vel_axis": ("real", Array("real", (AXES,))),
        "$acc_axis": ("real", Array("real", (AXES,))),
        "$vel_extax": ("real", _array(100)),
        "$acc_extax": ("real", _array(100)),
        "$gear_jerk": ("real", _array(100, 12)),
        "$advance": ("int", 3),
        "$ov_pro": ("real", 100.0),
        "$ori_type": ("", Choice("var")),
        "$circ_type": ("", Choice("base")),
        "$ipo_mode": ("", Choice("base")),
        "$tool": ("frame", null_frame()),
        "$base": ("frame", null_frame()),
        "$load": ("load", Struct("load")),
        "$nullframe": ("frame", null_frame()),
        "$world": ("frame", null_frame()),
        "$act_tool": ("int", 0),
        "$act_base": ("int", 0),
    }
    return {name: Variable(name.upper(), type_, value) for name, (type_, value) in values.items()}


ALIASES = {
    "$tool_data": "tool_data",
    "$base_data": "base_data",
    "$load_data": "load_data",
    "$tool_name": "tool_name",
    "$base_name": "base_name",
}
"""Newer names of the data in ``$CONFIG.DAT``."""

CONSTANTS = frozenset({"$nullframe", "$world", "$vel_ma", "$acc_ma"})
MOTION = frozenset(initial()) - CONSTANTS
"""Variables that the emulation reads."""

OUTPUTS = {"$out": "$OUT", "$out_c": "$OUT", "$anout": "$ANOUT"}
"""Outputs → which they are: ``$OUT_C`` sets those of ``$OUT`` at the tip of the tool's motion."""

STOPS_WHEN_READ = words(
    """$in $anin $timer $pos_act $axis_act $pos_act_mes $axis_act_mes $axis_act_meas $pos_ret
    $axis_ret $pos_int $axis_int $digin $timer_flag"""
)
"""Reading them stops the advance run, and so the robot."""
NEVER_KNOWN = words("$in $anin $digin $timer $timer_flag $cycflag $rob_timer $date")
"""Values that change without the program: not known even after it has set them."""
STOPS_WHEN_SET = words("$out $anout $digout $timer $timer_stop $loop_msg")
"""So does setting them."""

SILENT = words(
    """$bwdstart $h_pos $timer $timer_stop $timer_flag $flag $cycflag $msg_t $loop_msg $loop_cont
    $bwd_start $act_tool $act_base $gear_jerk $vel_extax $acc_extax $act_ex_ax $advance
    $collmon_tol_pro $torqmon $torqmon_def $cmd $loop_msg $interrupt $seactive $warmup_curr_limit
    $jerk $ex_ax_ignore $tool_c $base_c $pos_ret $vel_extax"""
)
"""Setting them needs no word: they move nothing, or the emulation reads them."""

POSITION = {
    "$pos_act": "pose",
    "$pos_act_mes": "pose",
    "$pos_for": "pose",
    "$pos_ret": "pose",
    "$pos_int": "pose",
    "$pos_back": "pose",
    "$axis_act": "axes",
    "$axis_act_mes": "axes",
    "$axis_act_meas": "axes",
    "$axis_for": "axes",
    "$axis_ret": "axes",
    "$axis_int": "axes",
    "$axis_back": "axes",
}
"""Variables that say where the robot is."""
