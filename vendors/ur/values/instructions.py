"""Functions of the controller that the reader does not carry out, and what it does with them.

Source of names: "The URScript Programming Language" (modules motion, internals, urmath,
interfaces) for PolyScope 3.x to 5.x, and the manuals of the add-ons named below.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from ....core.door import spelt
from ....core.errors import LeftOpenError, Span
from ....core.source.execution.answers import stands_in
from ....core.source.text.lexer import words

_PLACE = re.compile(r":\d+$")
"""The end of a key that is the place of a statement, ``file:line``."""


@dataclass(frozen=True, slots=True)
class Kept:
    """Calls of one kind that are kept as they stand.

    Args:
        kind: for the note: what they do.
        families: beginnings of further names of the kind.
        stops: whether the robot comes to rest before them.
        device: whether they are taken as a device's, and stepped over.
    """

    kind: str
    names: frozenset[str] = frozenset()
    families: tuple[str, ...] = ()
    stops: bool = False
    device: bool = False


MOVES = words("movej movel movep movec optimovej optimovel")
"""The moves that are carried out."""

STREAMS = Kept(
    "drive the robot by streams, forces or hand (it is taken to stay where it is)",
    words("servoj servoc servol speedj speedl force_mode force_mode_example freedrive_mode")
    | words("teach_mode direct_torque torque_command screw_driving interpreter_mode"),
    stops=True,
)
"""Where the robot is behind them is only known at run time."""
_SHIFTED = Kept(
    "shift the path at run time; it is driven without",
    words("path_offset_set path_offset_enable track_conveyor_linear track_conveyor_circular"),
)

ADD_ONS = Kept(
    "work grippers and other add-ons",
    words("RG2 RG6 rg2 rg6 VG10 vg10 grip release"),
    (
        # Robotiq grippers, wrist cameras, force sensors and EPick
        *("rq_", "gripper_", "GripperSocket", "cam_", "rq2_"),
        # OnRobot
        *("rg_", "rg2_", "rg6_", "RG2_", "vg_", "vgp", "vg10_", "vgc", "on_", "twofg_"),
        *("twofgp_", "threefg_", "tfg_", "fg2_", "fg3_", "sg_", "mg_", "mg10_", "gecko_"),
        *("msg_", "softgripper_", "sd_", "lift100_", "or_", "qc_", "hex_"),
        # Schunk, Zimmer, Weiss, Schmalz, piab, Festo
        *("schunk_", "egp_", "egh_", "zimmer_", "ieg_", "wsg_", "gripkit_", "schmalz_"),
        *("ecbpi_", "cobotpump_", "piab_", "festo_", "dh_gripper_"),
    ),
    device=True,
)
"""They may set outputs."""

KEPT: tuple[Kept, ...] = (
    STREAMS,
    _SHIFTED,
    Kept("stop the robot", words("stopj stopl stop"), stops=True),
    Kept(
        "set outputs and registers",
        words(
            """set_digital_out set_standard_digital_out set_configurable_digital_out
            set_tool_digital_out set_analog_out set_standard_analog_out set_flag
            set_euromap_output write_port_bit write_port_register write_output_boolean_register
            write_output_integer_register write_output_float_register"""
        ),
        ("write_", "rtde_set_", "set_euromap", "set_output"),
    ),
    Kept("show or log messages", words("textmsg varmsg print log_msg assert")),
    Kept(
        "wait for an operator; taken as answered at once",
        words("popup request_boolean_from_primary_client request_float_from_primary_client")
        | words("request_integer_from_primary_client request_string_from_primary_client"),
        ("request_",),
        stops=True,
    ),
    Kept("talk to other computers", families=("socket_", "rpc_", "rtde_", "ftp_", "ros_")),
    Kept("talk to fieldbuses", families=("modbus_", "profinet_", "ethernetip_", "eip_")),
    Kept("synchronise threads", words("sync")),
    Kept(
        "configure the controller",
        words(
            """set_gravity set_target_payload_transition zero_ftsensor end_force_mode
            end_freedrive_mode end_teach_mode stop_conveyor_tracking path_offset_disable
            force_mode_set_damping force_mode_set_gain_scaling position_deviation_warning
            protective_stop enable_external_ft_sensor ft_rtde_input_enable end_interpreter
            end_screw_driving tool_wrench_limit_set tool_wrench_limit_disable motion_version_set
            powerdown tool_contact_examples high_holding_torque_enable
            high_holding_torque_disable clear_interpreter abort skipbuffer pause pause_on_error_code
            signal_async_progress reset_revolution_counter set_pos"""
        ),
        ("set_", "encoder_", "conveyor_", "path_offset_", "force_mode_", "freedrive_mode_"),
    ),
    ADD_ONS,
)

QUERIES = words(
    """get_digital_in get_standard_digital_in get_configurable_digital_in get_tool_digital_in
    get_digital_out get_standard_digital_out get_configurable_digital_out get_tool_digital_out
    get_analog_in get_standard_analog_in get_tool_analog_in get_analog_out
    get_standard_analog_out get_euromap_input get_euromap_output get_flag force joint_torques
    tool_current random steptime time is_within_safety_limits pose_dist tool_contact
    wrench_trans"""
)
"""Functions that only ask; what they answer is not in the text."""

QUERY_FAMILIES = ("get_", "is_", "read_", "modbus_get_", "encoder_get_", "str_", "has_", "rtde_get")
"""Beginnings of further names of that kind."""


def kept(name: str) -> Kept | None:
    """How calls of a function are kept; None if it is not known to leave the robot alone."""
    for entry in KEPT:
        if name in entry.names:
            return entry
    if asks(name):
        return None
    return next((entry for entry in KEPT if name.startswith(entry.families)), None)


def asks(name: str) -> bool:
    """Whether a function only asks for something."""
    return name in QUERIES or name.startswith(QUERY_FAMILIES)


def known_names() -> set[str]:
    """All names in these tables."""
    return set(QUERIES) | {name for entry in KEPT for name in entry.names}


def driven_by(streams: Iterable[str]) -> frozenset[str]:
    """The functions by which a computer drives the robot where the user says what it sends.

    Args:
        streams: the keys of the answers: statements, or the places of statements.
    """
    keys = list(streams)
    if any(_PLACE.search(key) for key in keys):
        return STREAMS.names
    return frozenset(name for name in STREAMS.names if any(stands_in(name, key) for key in keys))


def streamed(name: str, span: Span) -> LeftOpenError:
    """The error that a program drives by a stream alone.

    Args:
        name: of the function that takes it.
    """
    how = (
        "lets forces of contact move the robot"
        if name.startswith(("force", "freedrive", "teach"))
        else "drives the robot in steps of a control loop"
    )
    return LeftOpenError(
        f"{name} {how}, which is not emulated, and there is nothing else to drive: say where it "
        "drives in a file of joints over time "
        f'({spelt("answers")}: [streams] {name} = "joints.csv", whose first line is '
        "time,j1,j2,j3,j4,j5,j6, in s and degrees), or write the motion as movej, movel or movep",
        span,
    )
