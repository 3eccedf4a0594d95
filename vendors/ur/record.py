"""Programs → a script that drives them and logs the joints while it does.

Several runs are functions of one script, whose logs a listener beside it takes: a script, too, of
the computer's Python. Which run a start begins with is asked of the operator, as a script has no
memory; before one that the robot is jogged to it halts.
"""

from __future__ import annotations

from importlib.resources import files

from ...core.language import Sources
from ...core.recording import Recording, comments, cycles_in, listed
from ...core.robot.model import Robot
from ...core.source.write.options import OpaqueStyle, StructureStyle
from .write.formatting import number
from .write.options import ScriptOptions
from .write.writer import SUFFIX, Script, body, indented

CYCLE = 0.002
"""s, of e-Series controllers ("e-Series Script Directory", servoj)."""
CB3_CYCLE = 0.008
"""s, of CB3 controllers ("CB-Series Script Manual", servoj)."""
USUAL_PERIOD = 0.008
"""s. A whole number of cycles of both."""
_CB3 = ("ur3", "ur5", "ur10")

HOST = "192.168.1.100"
PORT = 50010
SOCKET = "flyby_log"
LISTENER = "flyby_listen.py"
_NAMES = (
    *("flyby_host", "flyby_port", "flyby_cycles", "flyby_logging", "flyby_recorder"),
    *("flyby_thread", "flyby_q", "flyby_line", "flyby_count", "flyby_k", "flyby_run"),
)

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


def record(recording: Recording, robot: Robot, period: float) -> Sources:
    """A script that drives programs and sends time and joints to a computer every ``period`` s.

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
    cycles = cycles_in(period, cycle, robot.name)
    structure = StructureStyle.FLAT if recording.alone else StructureStyle.KEEP
    options = ScriptOptions(opaque=OpaqueStyle.COMMENT, structure=structure)
    script = body(recording.program, robot, options, *_NAMES)
    made = {script.name + SUFFIX: _text(recording, script, cycles, cycle)}
    if not recording.alone:
        made[LISTENER] = files(__package__).joinpath(LISTENER).read_text("utf-8")
    return made


def steps(recording: Recording, period: float) -> list[str]:
    """See `core.language.Recorder.steps`."""
    several, log = not recording.alone, recording.runs[0].log
    listen = f"python {LISTENER} (it writes each log under its name)"
    made = [
        "Set flyby_host in the script to the computer that takes the logs, and start a listener "
        f"there: {listen if several else f'nc -l {PORT} > {log}'}.",
        "Run the script (a Script node with the file, or send it), speed slider at 100 %.",
    ]
    if recording.jogged:
        made += [
            "It asks with which run to begin: 1 at first.",
            f"Before {listed(recording.jogged)} it halts: jog to where the run begins, start "
            "again, say its number.",
        ]
    return made


def _text(recording: Recording, script: Script, cycles: int, cycle: float) -> str:
    alone, runs = recording.alone, recording.runs
    head = comments(
        "#",
        [
            f"Written by flyby: drives {'a program' if alone else f'{len(runs)} runs'} and logs "
            "the joints. Statements that do not move the robot are comments here.",
            *steps(recording, cycles * cycle),
            "A log has a header t,q1,q2,q3,q4,q5,q6, in s and rad. The time counts controller "
            "cycles; where the network cannot follow, record actual_q over RTDE instead and give "
            "it this header.",
        ],
    )
    constants = [
        f'flyby_host = "{HOST}"',
        f"flyby_port = {PORT}",
        f"global flyby_cycles = {cycles}",
    ]
    recorder = _RECORDER.format(socket=SOCKET, cycle=number(cycle)).split("\n")
    main = _logged(script.statements) if alone else _main(recording, script.statements)
    lines = [*constants, *recorder, *script.declarations, *main]
    return "\n".join([*head, f"def {script.name}():", *indented(lines), "end", ""])


def _main(recording: Recording, calls: list[str]) -> list[str]:
    """The runs from the one that is asked for, up to one that the robot is jogged to."""
    runs = recording.runs
    begins = [k for k, run in enumerate(runs, 1) if k == 1 or run.by_hand]
    asked = f"Begin with run (1 to {len(runs)}): its first move goes straight to where it begins."
    made = ["flyby_run = 1"]
    if len(begins) > 1:
        made = [f'flyby_run = request_integer_from_primary_client("{asked}")']
    for index, (run, call) in enumerate(zip(runs, calls, strict=True), 1):
        made += [
            f"if flyby_run == {index}:",
            *indented(_logged([call], run.log)),
            f"  flyby_run = {index + 1}",
            *(indented(_stop(index + 1)) if index + 1 in begins else []),
            "end",
        ]
    return made


def _stop(run: int) -> list[str]:
    text = f"Jog to where run {run} begins (see the page), start again and say {run}."
    return [f'popup("{text}", title="flyby", blocking=True)', "halt"]


def _logged(lines: list[str], log: str | None = None) -> list[str]:
    """Statements while the joints are logged.

    Args:
        log: file that the listener writes; None if it knows by itself.
    """
    begin, end = (part.format(socket=SOCKET).split("\n") for part in (_BEGIN, _END))
    if log is not None:
        begin[3:3] = [f'socket_send_line("# {log}", "{SOCKET}")', "flyby_logging = True"]
    return [*begin, *lines, *end]
