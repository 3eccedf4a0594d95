"""A KAREL program that logs the joints while another program runs."""

from __future__ import annotations

import math

from flyby.core.errors import InputError
from flyby.core.robot.model import Robot

STEP = 0.008
"""s between positions that the controller computes."""
_KAREL = """\
PROGRAM flyby_log
-- Logs the joints every {ms} ms to UD1:flyby_log.csv: t in s, q1 to q6 in rad, J3 as displayed.
-- Translate it (ktrans) and load it beside the program, which starts it and ends it by FLG[1].
%NOLOCKGROUP
%NOPAUSE = ERROR + COMMAND + TPENABLE
VAR
  log_file : FILE
  joints : JOINTPOS
  values : ARRAY[9] OF REAL
  status, clock, k : INTEGER
BEGIN
  OPEN FILE log_file ('RW', 'UD1:flyby_log.csv')
  WRITE log_file ('t,q1,q2,q3,q4,q5,q6', CR)
  clock = 0
  CONNECT TIMER TO clock
  FLG[1] = ON
  WHILE FLG[1] DO
    joints = CURJPOS(0, 0, 1)
    CNV_JPOS_REL(joints, values, status)
    WRITE log_file (clock / 1000.0::8::3)
    FOR k = 1 TO 6 DO
      WRITE log_file (',', values[k] * 0.01745329252::10::6)
    ENDFOR
    WRITE log_file (CR)
    DELAY {ms}
  ENDWHILE
  CLOSE FILE log_file
  DISCONNECT TIMER clock
END flyby_log
"""


def logger(robot: Robot, period: float) -> str:
    """The KAREL program.

    Raises:
        InputError: the period is no whole number of steps of the controller.
    """
    steps = period / STEP if math.isfinite(period) else 0.0
    if round(steps) < 1 or abs(steps - round(steps)) > 1e-6 * steps:
        raise InputError(
            f"{robot.name} has new positions every {STEP:g} s: a log has that period or a whole "
            f"multiple of it, not {period:g} s"
        )
    return _KAREL.format(ms=round(1000 * period))
