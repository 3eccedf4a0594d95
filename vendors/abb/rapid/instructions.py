"""Every instruction that the reader knows by name: interpreted, kept as it stands, or refused.

An instruction that is in none of the tables, and no routine of the program, is refused: it might
move the robot.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ....core.errors import InputError, SourceError
from ....core.program.move import Wait
from .arguments import bind
from .lexer import words
from .motion import MOVES
from .scope import Scope
from .settings import SETTINGS, Handler
from .syntax import Invoke
from .types import NUM, find_unknown, mismatch

if TYPE_CHECKING:
    from .interpreter import Interpreter


@dataclass(frozen=True, slots=True)
class Kept:
    """An instruction that stays in the program as it stands and is stepped over.

    Args:
        why: what it does, for the note; empty if nothing needs to be said.
        stops: the robot comes to rest before it, or waits in it.
        writes: data that it names get values that only the running controller has.
    """

    why: str
    stops: bool = False
    writes: bool = False


_IO = Kept("I/O does not move the robot")
_MESSAGE = Kept("messages and files do not move the robot")
_INPUT = Kept("what it brings is not known", stops=True, writes=True)
_CLOCK = Kept("clocks do not move the robot")
_INTERRUPT = Kept("interrupts are not emulated: their trap routines do not run")
_WAITING = Kept("taken as satisfied at once: waiting takes no time here", stops=True)
_HALT = Kept("taken as continued at once: waiting takes no time here", stops=True)
_SUPERVISION = Kept("supervision does not change the programmed motion")
_FILL = Kept("what it computes is not known", writes=True)


def _kept(kept: Kept, names: str) -> dict[str, Kept]:
    return dict.fromkeys(words(names), kept)


KEPT: dict[str, Kept] = {
    **_kept(_IO, "set reset setdo setao setgo pulsedo invertdo ioenable iodisable"),
    **_kept(_IO, "aliasio aliasioreset"),
    **_kept(_MESSAGE, "tpwrite tperase tpshow errwrite errlog uishow uimsgwrite open close write"),
    **_kept(_MESSAGE, "uimsgwriteabort writebin writestrbin writeanybin writerawbytes rewind"),
    **_kept(_MESSAGE, "removefile renamefile copyfile makedir removedir opendir closedir"),
    **_kept(_MESSAGE, "spywrite spystart spystop load unload save erasemodule"),
    **_kept(_MESSAGE, "socketcreate socketbind socketlisten socketclose socketsend"),
    **_kept(_MESSAGE, "rmqsendmessage rmqemptyqueue rmqfindslot"),
    **_kept(_INPUT, "tpreadfk tpreadnum tpreaddnum uimsgbox readanybin readrawbytes readblock"),
    **_kept(_INPUT, "socketaccept socketconnect socketreceive rmqreadwait"),
    **_kept(_CLOCK, "clkstart clkstop clkreset"),
    **_kept(_INTERRUPT, "connect idelete idisable ienable isleep iwatch itimer ierror ipers"),
    **_kept(_INTERRUPT, "irmqmessage isignaldi isignaldo isignalai isignalao isignalgi isignalgo"),
    **_kept(_WAITING, "waituntil waitdi waitdo waitai waitao waitgi waitgo waittestandset"),
    **_kept(_WAITING, "waitload"),
    **_kept(Kept("", stops=True), "waitrob"),
    **_kept(_HALT, "stop break"),
    **_kept(_SUPERVISION, "motionsup cornerpathwarning bookerrno seterrno skipwarn setsysdata"),
    **_kept(_SUPERVISION, "tunereset softdeact eoffsoff corrclear corrdiscon clearpath"),
    **_kept(_SUPERVISION, "resetretrycount procerrrecovery"),
    **_kept(_FILL, "getsysdata gettrapdata getdataval setdatasearch packrawbytes unpackrawbytes"),
    **_kept(_FILL, "clearrawbytes copyrawbytes readcfgdata bitset bitclear readerrdata"),
    "actunit": Kept("switching a mechanical unit on does not move it", stops=True),
}
"""name → why and how it is kept."""

_AT_RUN_TIME = "its course is decided by sensors or signals at run time"
_SHIFT = "it shifts all targets by what the robot measures, or shifts external axes"
_TASKS = "several robots or tasks are not read yet"
_NOT_EMULATED = "it changes the motion in a way that is not emulated"
_STOPPING = "stopping and resuming a path is not read yet"
_SIGNAL_MOVE = "signals on the way of a move are not read yet; use MoveL, MoveJ or MoveC"


def _refused(why: str, names: str) -> dict[str, str]:
    return dict.fromkeys(words(names), why)


REFUSED: dict[str, str] = {
    **_refused(_AT_RUN_TIME, "searchl searchc searchextj searchj corrcon corrwrite contactl"),
    **_refused(_AT_RUN_TIME, "indcmove indamove indrmove inddmove egmactjoint egmactpose"),
    **_refused(_AT_RUN_TIME, "egmrunjoint egmrunpose egmmovel egmmovec egmsetupuc egmsetupai"),
    **_refused(_AT_RUN_TIME, "egmsetupgi egmsetupao egmreset egmgetid egmstop egmstreamstart"),
    **_refused(_SHIFT, "pdispon eoffson eoffsset"),
    **_refused(_TASKS, "syncmoveon syncmoveoff syncmoveundo waitsynctask syncmovesuspend"),
    **_refused(_TASKS, "syncmoveresume waitwobj dropwobj"),
    **_refused(_NOT_EMULATED, "softact tuneservo pathresol mechunitload deactunit"),
    **_refused(_NOT_EMULATED, "motionprocessmodeset"),
    **_refused(_STOPPING, "stopmove startmove stopmovereset startmoveretry storepath restopath"),
    **_refused(_STOPPING, "pathrecstart pathrecstop pathrecmovebwd pathrecmovefwd"),
    **_refused(_SIGNAL_MOVE, "moveldo movejdo movecdo movelao movejao movecao movelgo movejgo"),
    **_refused(_SIGNAL_MOVE, "movecgo movelsync movejsync movecsync triggl triggj triggc"),
    **_refused(_SIGNAL_MOVE, "triggabsj trigglios triggjios triggio triggequip triggint"),
    **_refused(_SIGNAL_MOVE, "triggrampao triggspeed triggcheckio triggdataset triggstopproc"),
    "moveextj": "moves of external axes alone are not read yet",
    "movepnp": "pick-and-place moves are not read yet",
    "systemstopaction": "it stops the controller",
}
"""name → why it is refused."""


def _wait_time(run: Interpreter, invoke: Invoke, scope: Scope) -> None:
    bound = bind(invoke, ("Time",), ("inpos",))
    value = run.evaluator.evaluate(bound.value(0), scope)
    unknown = find_unknown(value)
    if unknown is not None:
        run.keep(invoke, f"its time depends on {unknown.reason} and is taken as zero", stops=True)
        return
    wrong = mismatch(value, NUM)
    if wrong is not None or not isinstance(value, float):
        raise SourceError(f"WaitTime: {wrong}", invoke.span)
    try:
        run.emit(Wait(value, invoke.span))
    except InputError as error:
        raise SourceError(f"WaitTime: {error}", invoke.span) from None


def _step(run: Interpreter, invoke: Invoke, scope: Scope) -> None:
    """``Incr n``, ``Decr n``, ``Clear n`` and ``Add n, m``."""
    if invoke.name == "add":
        bound = bind(invoke, ("Name", "AddValue"), ())
        run.change(bound.value(0), bound.value(1), 1.0, scope)
        return
    bound = bind(invoke, ("Name",), ())
    amount = {"incr": 1.0, "decr": -1.0, "clear": None}[invoke.name]
    run.change(bound.value(0), None, amount, scope)


def _exit_cycle(run: Interpreter, invoke: Invoke, scope: Scope) -> None:
    bind(invoke, (), ())
    run.finish("ExitCycle ends the cycle: one cycle is read", invoke.span)


INTERPRETED: dict[str, Handler] = {
    **MOVES,
    **SETTINGS,
    "waittime": _wait_time,
    "incr": _step,
    "decr": _step,
    "clear": _step,
    "add": _step,
    "exitcycle": _exit_cycle,
}


def known_names() -> set[str]:
    """Lower-case names of all instructions in the tables."""
    return {*INTERPRETED, *KEPT, *REFUSED}
