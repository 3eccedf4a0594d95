"""The functions of URScript.

Source: Universal Robots, The URScript Programming Language (Script Manual, 3.5 to 5.x), modules
motion, internals, urmath and interfaces: names, parameters in their order, defaults.
"""

from __future__ import annotations

SIGNATURES = """
movej(q, a=1.4, v=1.05, t=0, r=0)
movel(pose, a=1.2, v=0.25, t=0, r=0)
movep(pose, a=1.2, v=0.25, r=0)
movec(pose_via, pose_to, a=1.2, v=0.25, r=0, mode=0)
optimovej(goal, a=0.3, v=0.3, r=0)
optimovel(goal, a=0.3, v=0.3, r=0)
servoj(q, a, v, t=0.002, lookahead_time=0.1, gain=300)
servoc(pose, a=1.2, v=0.25, r=0)
speedj(qd, a=40, t=0)
speedl(xd, a=0.25, t=0, aRot=0)
stopj(a)
stopl(a, aRot=0)
set_tcp(pose)
set_payload(m, cog=0)
set_payload_mass(m)
set_payload_cog(CoG)
set_target_payload(m, cog=0, inertia=0, transition_time=0)
set_gravity(d)
get_inverse_kin(x, qnear=0, maxPositionError=1e-10, maxOrientationError=1e-10, tcp=0)
get_forward_kin(q=0, tcp=0)
get_actual_joint_positions()
get_actual_joint_speeds()
get_actual_joint_positions_history(steps=0)
get_target_joint_positions()
get_target_joint_speeds()
get_actual_tcp_pose()
get_target_tcp_pose()
get_tcp_offset()
get_controller_temp()
get_steptime()
get_joint_torques()
is_steady()
is_within_safety_limits(pose)
pose_trans(p_from, p_from_to)
pose_inv(p_from)
pose_add(p_1, p_2)
pose_sub(p_to, p_from)
pose_dist(p_from, p_to)
interpolate_pose(p_from, p_to, alpha)
point_dist(p_from, p_to)
rotvec2rpy(rotation_vector)
rpy2rotvec(rpy_vector)
sleep(t)
sync()
popup(s, title="", warning=False, error=False, blocking=False)
textmsg(s1, s2="")
request_integer_from_primary_client(message)
to_num(str)
to_str(val)
str_cat(op1, op2)
str_len(str)
length(v)
set_digital_out(n, b)
set_standard_digital_out(n, b)
set_configurable_digital_out(n, b)
set_tool_digital_out(n, b)
set_analog_out(n, f)
set_standard_analog_out(n, f)
get_digital_in(n)
get_standard_digital_in(n)
get_configurable_digital_in(n)
get_tool_digital_in(n)
get_analog_in(n)
get_standard_analog_in(n)
get_digital_out(n)
socket_open(address, port, socket_name="socket_0")
socket_close(socket_name="socket_0")
socket_send_string(str, socket_name="socket_0")
socket_send_line(str, socket_name="socket_0")
write_output_float_register(address, value)
write_output_integer_register(address, value)
write_output_boolean_register(address, value)
read_input_float_register(address)
read_input_integer_register(address)
read_input_boolean_register(address)
abs(f)
ceil(f)
floor(f)
sqrt(f)
sin(f)
cos(f)
tan(f)
asin(f)
acos(f)
atan(f)
atan2(x, y)
pow(base, exponent)
log(b, f)
norm(a)
random()
d2r(d)
r2d(r)
integer_to_binary_list(x)
binary_list_to_integer(l)
"""
POSITIVE = {
    "movej": ("a", "v"),
    "movel": ("a", "v"),
    "movep": ("a", "v"),
    "movec": ("a", "v"),
}
NOT_NEGATIVE = {
    "movej": ("t", "r"),
    "movel": ("t", "r"),
    "movep": ("r",),
    "movec": ("r",),
    "sleep": ("t",),
}
LISTS = {  # arguments that are lists or poses of six, if written out
    "movej": ("q",),
    "movel": ("pose",),
    "movep": ("pose",),
    "movec": ("pose_via", "pose_to"),
    "set_tcp": ("pose",),
    "get_inverse_kin": ("x", "qnear"),
}
POSES = {"set_tcp": ("pose",), "get_inverse_kin": ("x",), "movec": ("pose_via", "pose_to")}
"""Arguments that must be poses; a list is none."""
