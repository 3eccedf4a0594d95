"""What URScript takes for a name of a program's own data, and the words that are none.

"The URScript Programming Language", chapters "Identifiers", "Flow of Control" and "Threads"; the
functions are those of the modules motion, internals, urmath and interfaces.
"""

from __future__ import annotations

import re

from ....core.source.text.names import NameRules
from .lexer import KEYWORDS

_FUNCTIONS = """
    conveyor_pulse_decode encoder_get_tick_count encoder_set_tick_count end_force_mode
    end_freedrive_mode end_teach_mode force_mode force_mode_set_damping freedrive_mode
    get_conveyor_tick_count get_freedrive_status movec movej movel movep optimovej optimovel
    position_deviation_warning reset_revolution_counter servoc servoj servol
    set_conveyor_tick_count set_pos speedj speedl stop_conveyor_tracking stopj stopl teach_mode
    track_conveyor_circular track_conveyor_linear screw_driving force get_actual_joint_positions
    get_actual_joint_positions_history get_actual_joint_speeds get_actual_tcp_pose
    get_actual_tcp_speed get_actual_tool_flange_pose get_controller_temp get_coordinate_in
    get_forward_kin get_inverse_kin get_inverse_kin_has_solution get_joint_temp
    get_joint_torques get_target_joint_positions get_target_joint_speeds get_target_payload
    get_target_payload_cog get_target_payload_inertia get_target_tcp_pose get_target_tcp_speed
    get_target_waypoint get_tcp_force get_tcp_offset get_tool_accelerometer_reading
    get_tool_current get_steptime is_steady is_within_safety_limits popup powerdown
    set_gravity set_payload set_payload_cog set_payload_mass set_target_payload set_tcp sleep
    str_at str_cat str_empty str_find str_len str_sub sync textmsg to_num to_str acos asin atan
    atan2 binary_list_to_integer ceil cos d2r floor get_list_length integer_to_binary_list
    interpolate_pose inv length log norm normalize point_dist pose_add pose_dist pose_inv
    pose_sub pose_trans pow r2d random rotvec2rpy rpy2rotvec sin size sqrt tan wrench_trans
    transpose make_list get_analog_in get_analog_out get_configurable_digital_in
    get_configurable_digital_out get_digital_in get_digital_out get_flag
    get_standard_analog_in get_standard_analog_out get_standard_digital_in
    get_standard_digital_out get_tool_analog_in get_tool_digital_in get_tool_digital_out
    modbus_add_signal modbus_delete_signal modbus_get_signal_status modbus_set_output_register
    modbus_set_output_signal modbus_set_signal_update_frequency read_input_boolean_register
    read_input_float_register read_input_integer_register read_output_boolean_register
    read_output_float_register read_output_integer_register read_port_bit read_port_register
    rpc_factory rtde_set_watchdog set_analog_out set_analog_outputdomain
    set_configurable_digital_out set_digital_out set_flag set_standard_analog_out
    set_standard_digital_out set_tool_communication set_tool_digital_out set_tool_voltage
    socket_close socket_get_var socket_open socket_read_ascii_float socket_read_binary_integer
    socket_read_byte_list socket_read_line socket_read_string socket_send_byte socket_send_int
    socket_send_line socket_send_string socket_set_var write_output_boolean_register
    write_output_float_register write_output_integer_register write_port_bit
    write_port_register zero_ftsensor time assert abs min max sign round exp mean dot cross
"""
_OTHERS = "mod struct p pi"

RESERVED = KEYWORDS | frozenset((_FUNCTIONS + _OTHERS).split())
NAME_RULES = NameRules(RESERVED, fold=str, legal=re.compile(r"[A-Za-z_][A-Za-z0-9_]*"))
"""Upper and lower case differ."""
