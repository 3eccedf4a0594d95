"""Program → a script that drives it and logs the joints while it does."""

from __future__ import annotations

import math

from ...core.errors import InputError
from ...core.language import Sources
from ...core.program.program import Program
from ...core.robot.model import Robot
from ...core.source.write.options import OpaqueStyle
from .write.formatting import number
from .write.options import ScriptOptions
from .write.writer import SUFFIX, Script, body, indented

CYCLE = 0.002
"""s, of e-Series controllers ("e-Series Script Directory", servoj)."""
CB3_CYCLE = 0.008
"""s, of CB3 controllers ("CB-Series Script Manual", servoj)."""
_CB3 = ("ur3", "ur5", "ur10")
_WHOLE = 1e-6
"""How near a period must come to a whole number of cycles."""

HOST = "192.168.1.100"
PORT = 50010
SOCKET = "flyby_log"
_NAMES = (
    *("flyby_host", "flyby_port", "flyby_cycles", "flyby_logging", "flyby_recorder"),
    *("flyby_thread", "flyby_q", "flyby_line", "flyby_count", "flyby_k"),
)

_HEAD = """\
# Written by flyby: drives a program and logs its joints.
#
# Set flyby_host to the computer that takes the log, and start a listener there before the
# program, for instance: nc -l 50010 > run.csv
# The log has a header t,q1,q2,q3,q4,q5,q6, in s and rad. The time counts controller cycles; where
# the network cannot follow, record actual_q over RTDE instead and give it this header.
# Statements that do not move the robot are comments here."""

_RECORDER = """\
global flyby_logging = True
global flyby_line = ""
thread flyby_recorder():
  local flyby_count = 0
  while flyby_logging:
    local flyby_q = get_actual_joint_positions()
    flyby_line = to_str(flyby_count * {cycle})
    local flyby_k = 0
    while flyby_k < 6:
      flyby_line = str_cat(flyby_line, str_cat(",", to_str(flyby_q[flyby_k])))
      flyby_k = flyby_k + 1
    end
    socket_send_line(flyby_line, "{socket}")
    flyby_k = 0
    while flyby_k < flyby_cycles:
      sync()
      flyby_k = flyby_k + 1
    end
    flyby_count = flyby_count + flyby_cycles
  end
end"""

_BEGIN = """\
while (socket_open(flyby_host, flyby_port, "{socket}") == False):
  sleep(0.5)
end
socket_send_line("t,q1,q2,q3,q4,q5,q6", "{socket}")
flyby_thread = run flyby_recorder()
sleep(0.2)"""

_END = """\
sleep(0.5)
flyby_logging = False
join flyby_thread
socket_close("{socket}")"""


def record(program: Program, robot: Robot, period: float) -> Sources:
    """A script that drives a program and sends time and joints to a computer every ``period`` s.

    What arrives there is a log as `flyby.identification.logs` reads it. Statements that were kept
    as text become comments: the variables and threads that they name need not exist in the new
    script.

    Args:
        period: s between samples.

    Raises:
        InputError: the period is no whole number of controller cycles, or URScript does not drive
            the robot.
        MotionError: URScript cannot say a move.
    """
    cycle = CB3_CYCLE if robot.name.rpartition("/")[2] in _CB3 else CYCLE
    cycles = _cycles(period, cycle, robot.name)
    script = body(program, robot, ScriptOptions(opaque=OpaqueStyle.COMMENT), *_NAMES)
    return {script.name + SUFFIX: _text(script, cycles, cycle)}


def _cycles(period: float, cycle: float, name: str) -> int:
    cycles = period / cycle if math.isfinite(period) else 0.0
    if round(cycles) < 1 or abs(cycles - round(cycles)) > _WHOLE * cycles:
        raise InputError(
            f"{name} runs in cycles of {cycle:g} s: a log has a period of {cycle:g} s or a whole "
            f"multiple of it, not {period:g} s"
        )
    return round(cycles)


def _text(script: Script, cycles: int, cycle: float) -> str:
    constants = [
        f'flyby_host = "{HOST}"',
        f"flyby_port = {PORT}",
        f"global flyby_cycles = {cycles}",
    ]
    parts = (_RECORDER, _BEGIN, _END)
    recorder, begin, end = (p.format(socket=SOCKET, cycle=number(cycle)).split("\n") for p in parts)
    lines = [
        *(*constants, *recorder, *script.declarations, *begin),
        *(*script.statements, *end),
    ]
    return "\n".join([_HEAD, f"def {script.name}():", *indented(lines), "end", ""])
