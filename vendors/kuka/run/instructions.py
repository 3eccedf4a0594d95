"""Routines of the controller and of KUKA's technology packages, by name, and how they are kept."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ..syntax.lexer import CLOSED


@dataclass(frozen=True, slots=True)
class Kept:
    """A call that stays in the program as it stands and is stepped over.

    Args:
        why: what it does, for the note; empty if nothing needs to be said.
        stops: the robot comes to rest before it, or waits in it.
        writes: data that it names get values that only the running controller has.
        outputs: it may write outputs.
        brings: lower-case names of further data that get such values.
        sent: a computer sends the robot's motion while it runs.
    """

    why: str
    stops: bool = False
    writes: bool = False
    outputs: bool = False
    brings: tuple[str, ...] = ()
    sent: bool = False


_SETUP = Kept("it prepares a technology package and does not move the robot")
_MESSAGE = Kept("messages and files do not move the robot", writes=True)
_OUTPUT = Kept("outputs do not move the robot", stops=True, outputs=True)
_TOOL = Kept("grippers, guns and processes are not emulated", stops=True, outputs=True)
_CHANNEL = Kept("what it brings is not known", stops=True, writes=True)
_SENDING = Kept("other computers are not emulated", stops=True)
_SENSOR = Kept("corrections by sensors are not emulated")
_CLOCK = Kept("supervision does not change the programmed motion")

_MOVES = r"(?!\w*(change|pick|place|move|home|pos|wechsel|greifen|ablegen|fahr))"
"""Not in the name of a routine that is stepped over without its text: it might drive there."""

_TABLE: tuple[tuple[str, Kept], ...] = (
    (r"user_?spot\w*|user_?grp\w*|user_?grip\w*|user_?lib|user_?abort|ir_stopm|h50", _SETUP),
    (r"a10\w*|a20\w*|a50\w*|(bas|grp|grip|gripper|spot|tm|tq|weld|glue)_?ini\w*", _SETUP),
    (r"set_(cd|tq)_\w+|collmon\w*|torqmon\w*|(re)?set_torque\w*|tm_\w+|tmon\w*", _CLOCK),
    (r"pulse|set_?out\w*", _OUTPUT),
    (r"grp|grip|gripper|spot", _TOOL),
    (rf"{_MOVES}(grpg?|grip|gripper|gt|esg|eqx?|spot|atb|mig)_\w+", _TOOL),
    (r"kp_?gun\w*|servogun\w*|user_?gun\w*|(laser|glue|weld)_?(on|off|start|stop)", _TOOL),
    (r"arc_?(on|off|swi|set|main\w*|ini\w*)?", _TOOL),
    (r"cwrite|cread|copen|cclose|sread|swrite|cast_from|cast_to|cioctl", _CHANNEL),
    (r"eki_(set|send|init|open|close|clear|lock|unlock|checkbuffer)\w*", _SENDING),
    (r"krl_f\w+|eki_\w+|eth_\w+|xml_\w+", _CHANNEL),
    (r"(set|get|exists|clear)_krl\w*|msg\w+|dialog\w*|logtext\w*", _MESSAGE),
    (r"strclear|stradd|strcopy|strtoint|strtoreal|inttostr|realtostr", _MESSAGE),
    (r"sync_?cmd|mbx_rec|chk_home|err_(clear|raise)", _MESSAGE),
    (r"rsi_(?!movecorr)\w+|ts_(corroff|setcorrdata|bc6dcalc)", _SENSOR),
    (r"st_(on1?|off|reset|ethernet|\w+corr|(new|del)link|[gs]etparam|(new|del)obj)", _SENSOR),
    (r"p00", Kept("the program number comes from outside", stops=True, brings=("pgno",))),
    (r"lock|unlock", _CLOCK),
    (
        r"rsi_movecorr|st_movesens|st_skipsens",
        Kept(
            "sensors decide its course at run time: the robot is taken to stay where it is",
            stops=True,
            writes=True,
            sent=True,
        ),
    ),
    (
        r"ts_(?!corroff|setcorrdata|bc6dcalc)\w+|h70\w*|touch\w*|search\w*",
        Kept(
            "a search decides its course at run time: the robot is taken to stay where it is, "
            "and to find nothing that differs",
            stops=True,
            writes=True,
            outputs=True,
        ),
    ),
    (
        r"syncstart|syncend|progsync|syncmove|mot_?coop\w*|roboteam\w*",
        Kept("other robots are not emulated: they are taken to be ready at once", stops=True),
    ),
    (r"conv_\w+|tracking\w*", Kept("conveyors are taken to stand still", stops=True, writes=True)),
    (
        r"asy(ptp|cont|stop|cancel)",
        Kept("external axes that move beside the program are not emulated"),
    ),
)


def _compiled(pattern: str) -> re.Pattern[str]:
    return re.compile(pattern, re.IGNORECASE)


_KEPT = tuple((_compiled(pattern), kept) for pattern, kept in _TABLE)


def kept(name: str) -> Kept | None:
    """How the call of a routine is kept; None if it is in no table."""
    return next((entry for pattern, entry in _KEPT if pattern.fullmatch(name)), None)


KEYWORDS: dict[str, Kept | None] = {
    "global": Kept("interrupts are not emulated: their routines do not run"),
    "interrupt": Kept("interrupts are not emulated: their routines do not run"),
    "anout": Kept("analog outputs do not move the robot"),
    "anin": Kept("analog inputs are not known", stops=True),
    "digin": Kept("digital inputs are not known", stops=True),
    "brake": Kept("BRAKE belongs to an interrupt and does not run", stops=True),
    "resume": Kept("RESUME belongs to an interrupt and does not run", stops=True),
    "ext": None,
    "extfct": None,
    "import": None,
    "channel": None,
    "sema": None,
    "on_error_proceed": None,
    CLOSED: Kept("a closed fold does not show what is in it"),
    "init": Kept("a closed fold does not show what is in it"),
    "declarations": Kept("a closed fold does not show what is in it"),
    "confirm": Kept("messages do not move the robot"),
    "time_block": Kept("the times of spline blocks follow from their speeds here"),
    "const_vel": Kept("the speeds of spline blocks are those of their segments here"),
    "stop": Kept("conditional stops are not emulated"),
}
"""First word of a statement → how it is kept; None for declarations, which need no word."""
