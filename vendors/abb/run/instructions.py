"""Every instruction that the reader knows by name: interpreted, kept as it stands, or refused.

An instruction that is in none of the tables, and no routine of the program, is refused: it might
move the robot.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from ....core.errors import InputError, SourceError
from ....core.program.move import Wait
from ....core.source.text.lexer import words
from ..motion.moves import MOVES, MovesRun
from ..motion.settings_instructions import SETTINGS, SettingsRun
from ..motion.special_moves import SPECIAL_MOVES
from ..motion.triggers import TRIGGER_DEFINITIONS, TRIGGER_MOVES
from ..syntax.tree import Expression, Invoke, Name
from ..values.arguments import bind
from ..values.data import Globals
from ..values.evaluator import Evaluator
from ..values.operators import OperandError, apply
from ..values.scope import Scope, unknown_name
from ..values.text_functions import with_bit
from ..values.types import NUM, STRING, Unknown, Value, find_unknown, mismatch
from .handlers import Keeping, Running
from .signals import SIGNALS
from .waits import WAIT_UNTIL, wait_until


class InstructionRun(MovesRun, SettingsRun, Keeping, Running, Protocol):
    """What all of them need of a run."""


Handler = Callable[[InstructionRun, Invoke, Scope], None]


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
_CAMERA = Kept("cameras do not move the robot")
_CLOCK = Kept("clocks do not move the robot")
_INTERRUPT = Kept("interrupts are not emulated: their trap routines do not run")
_WAITING = Kept("taken as satisfied at once: waiting takes no time here", stops=True)
_HALT = Kept("taken as continued at once: waiting takes no time here", stops=True)
_SUPERVISION = Kept("supervision does not change the programmed motion")
_FILL = Kept("what it computes is not known", writes=True)


_SERVO = Kept("how stiffly the servos follow is not emulated")
_UNIT = Kept("switching a mechanical unit on or off does not move it", stops=True)
_RESUMED = Kept("the stop is taken as resumed at once", stops=True)
_TASK = Kept("other tasks are taken to be there at once", stops=True)
_SENSOR = Kept("sensor-guided motion is prepared, and refused where it begins")
_DATA = Kept("what it does to the trigger data is not carried out")
_ZONES = Kept("supervision of zones does not change the programmed motion")
_GRIPPER = Kept("a gripper's own motion is not emulated")
_WEAVE = Kept("process equipment does not change the programmed motion")


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
    **_kept(_CAMERA, "camflush camloadjob camreqimage camsetexposure camsetparameter"),
    **_kept(_CAMERA, "camsetprogrammode camsetrunmode camstartloadjob camwaitloadjob"),
    **_kept(_INPUT, "camgetparameter camgetresult"),
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
    **_kept(_FILL, "getsysdata gettrapdata setdatasearch packrawbytes unpackrawbytes"),
    **_kept(_FILL, "clearrawbytes copyrawbytes readcfgdata readerrdata"),
    **_kept(_SERVO, "softact tuneservo pathresol mechunitload motionprocessmodeset"),
    **_kept(_UNIT, "actunit deactunit"),
    **_kept(_RESUMED, "stopmove startmove stopmovereset startmoveretry"),
    **_kept(_TASK, "waitsynctask"),
    **_kept(_SENSOR, "egmsetupuc egmsetupai egmsetupgi egmsetupao egmreset egmgetid egmstop"),
    **_kept(_SENSOR, "egmstreamstart egmstreamstop"),
    **_kept(_DATA, "triggdatareset triggdatacopy triggstopproc"),
    **_kept(_MESSAGE, "tpwritednum uiclientshow textabinstall texttabinstall errraise"),
    **_kept(_ZONES, "wzboxdef wzcyldef wzspheredef wzsphdef wzlimjointdef wzhomejointdef"),
    **_kept(_GRIPPER, "g_init g_calibrate g_jogin g_jogout g_gripin g_gripout g_moveto g_stop"),
    **_kept(_GRIPPER, "g_setmaxspd g_setforce g_vacuumon1 g_vacuumoff1 g_vacuumon2 g_vacuumoff2"),
    **_kept(_GRIPPER, "g_blowon1 g_blowoff1 g_blowon2 g_blowoff2 hand_initialize hand_moveto"),
    **_kept(_GRIPPER, "hand_gripinward hand_gripoutward hand_jogin hand_jogout hand_stop"),
    **_kept(_GRIPPER, "hand_setmaxspeed hand_setforce hand_docalibration hand_turnonvacuum1"),
    **_kept(_GRIPPER, "hand_turnoffvacuum1 hand_turnonvacuum2 hand_turnoffvacuum2"),
    **_kept(_MESSAGE, "socketsendto startload cancelload checkprogref testsigndefine tryint"),
    **_kept(_MESSAGE, "testsignreset deleteobject clearioboff hotedit iomessage writevar"),
    **_kept(_FILL, "rmqgetmessage rmqgetmsgdata rmqgetmsgheader readvararr readvar"),
    **_kept(_INPUT, "socketreceivefrom readblock"),
    **_kept(_ZONES, "wzdoset wzlimsup wzenable wzdisable wzfree"),
    **_kept(_WEAVE, "arcrefresh arckill arcweldon arcweldoff spotcontrol setbrush setbrushfac"),
}
"""name → why and how it is kept."""

_AT_RUN_TIME = "its course is decided by sensors or signals at run time"
_TASKS = "motion of several robots that wait for each other (MultiMove) is not emulated"
_STOPPING = "leaving a path and coming back to it is not emulated"


def _refused(why: str, names: str) -> dict[str, str]:
    return dict.fromkeys(words(names), why)


REFUSED: dict[str, str] = {
    **_refused(_AT_RUN_TIME, "searchextj corrcon corrwrite contactl egmactjoint egmactpose"),
    **_refused(_AT_RUN_TIME, "indcmove indamove indrmove inddmove egmactmove supsyncsensoron"),
    **_refused(_AT_RUN_TIME, "egmrunjoint egmrunpose egmmovel egmmovec synctosensor waitsensor"),
    **_refused(_TASKS, "syncmoveon syncmoveoff syncmoveundo syncmovesuspend syncmoveresume"),
    **_refused("conveyors are not emulated", "waitwobj dropwobj"),
    **_refused(_STOPPING, "storepath restopath pathrecstart pathrecstop pathrecmovebwd"),
    **_refused(_STOPPING, "pathrecmovefwd stepbwdpath"),
    "movepnp": "pick-and-place moves are not read yet",
    "systemstopaction": "it stops the controller",
    "manloadidproc": "it moves the robot to measure a load",
    "loadid": "it moves the robot to measure a load",
    "paridposvalid": "it moves the robot to measure a load",
}
"""name → why it is refused."""


def _wait_time(run: Running, invoke: Invoke, scope: Scope) -> None:
    bound = bind(invoke, ("Time",), ("inpos",))
    value = run.evaluator.evaluate(bound.value(0), scope)
    unknown = find_unknown(value)
    if unknown is not None:
        why = f"its time depends on {unknown.reason} and is taken as zero"
        run.out.keep(invoke.span, invoke.text, why, stops=True)
        return
    wrong = mismatch(value, NUM)
    if wrong is not None or not isinstance(value, float):
        raise SourceError(f"WaitTime: {wrong}", invoke.span)
    try:
        run.out.emit(Wait(value, invoke.span))
    except InputError as error:
        raise SourceError(f"WaitTime: {error}", invoke.span) from None


def _change(
    evaluator: Evaluator,
    target: Expression,
    add: Expression | None,
    amount: float | None,
    scope: Scope,
) -> None:
    """Add to a num, or clear it if ``amount`` is None."""
    if not isinstance(target, Name):
        raise SourceError("a variable is wanted here", target.span)
    value: Value = 0.0
    if amount is not None:
        step = amount if add is None else evaluator.evaluate(add, scope)
        try:
            value = apply("+", evaluator.evaluate(target, scope), step)
        except OperandError as error:
            raise SourceError(str(error), target.span) from None
    evaluator.assign(target, value, scope)


def _step(run: Running, invoke: Invoke, scope: Scope) -> None:
    """``Incr n``, ``Decr n``, ``Clear n`` and ``Add n, m``."""
    if invoke.name == "add":
        bound = bind(invoke, ("Name", "AddValue"), ())
        _change(run.evaluator, bound.value(0), bound.value(1), 1.0, scope)
        return
    bound = bind(invoke, ("Name",), ())
    amount = {"incr": 1.0, "decr": -1.0, "clear": None}[invoke.name]
    _change(run.evaluator, bound.value(0), None, amount, scope)


def _set_bit(run: Running, invoke: Invoke, scope: Scope) -> None:
    """``BitSet byte, position`` and ``BitClear``."""
    bound = bind(invoke, ("BitData", "BitPos"), ())
    target = bound.value(0)
    if not isinstance(target, Name):
        raise SourceError(f"{invoke.text} takes a variable", target.span)
    values = [run.evaluator.evaluate(bound.value(index), scope) for index in (0, 1)]
    unknown = find_unknown(tuple(values))
    if unknown is not None:
        run.evaluator.assign(target, unknown, scope)
        return
    byte, position = (bound.number(run.evaluator, index, scope) for index in (0, 1))
    try:
        changed = with_bit(byte, position, invoke.name == "bitset")
    except OperandError as error:
        raise SourceError(f"{invoke.text}: {error}", invoke.span) from None
    run.evaluator.assign(target, changed, scope)


def _data_by_name(run: Running, invoke: Invoke, scope: Scope) -> None:
    """``SetDataVal "name", value`` and ``GetDataVal "name", datum``."""
    bound = bind(invoke, ("Object", "Value"), ("block", "taskref", "taskname"))
    named = run.evaluator.evaluate(bound.value(0), scope)
    given = bound.value(1)
    found = scope.find(named.lower()) if isinstance(named, str) else None
    if found is None or bound.options:
        run.out.keep(invoke.span, invoke.text, "the datum that it names is not known here")
        if invoke.name == "getdataval" and isinstance(given, Name):
            reason = f"what {invoke.text} gave {given.text}"
            run.evaluator.fill(given, Unknown(reason, invoke.span, given.text), scope)
        return
    datum = Name(invoke.span, str(named).lower(), found.name)
    if invoke.name == "setdataval":
        run.evaluator.assign(datum, run.evaluator.evaluate(given, scope), scope)
    elif isinstance(given, Name):
        run.evaluator.assign(given, run.evaluator.evaluate(datum, scope), scope)


def _call_by_var(run: Running, invoke: Invoke, scope: Scope) -> None:
    """``CallByVar "part", n``: the procedure ``part1``, …"""
    bound = bind(invoke, ("Name", "Number"), ())
    name = run.evaluator.known(bound.value(0), scope, STRING, "CallByVar")
    run.call_named(f"{name}{bound.number(run.evaluator, 1, scope):g}", (), scope, invoke.span)


def _exit_cycle(run: Running, invoke: Invoke, scope: Scope) -> None:
    bind(invoke, (), ())
    run.finish("ExitCycle ends the cycle: one cycle is read", invoke.span)


INTERPRETED: dict[str, Handler] = {
    **MOVES,
    **TRIGGER_MOVES,
    **TRIGGER_DEFINITIONS,
    **SPECIAL_MOVES,
    **SETTINGS,
    "callbyvar": _call_by_var,
    "setdataval": _data_by_name,
    "getdataval": _data_by_name,
    "bitset": _set_bit,
    "bitclear": _set_bit,
    "waittime": _wait_time,
    WAIT_UNTIL: wait_until,
    **SIGNALS,
    "incr": _step,
    "decr": _step,
    "clear": _step,
    "add": _step,
    "exitcycle": _exit_cycle,
}


MOVING = frozenset({*MOVES, *TRIGGER_MOVES, *SPECIAL_MOVES})
"""Names of instructions that move the robot."""


def refusal(statement: Invoke, data: Globals) -> SourceError:
    """Why an instruction, or a routine whose text is not at hand, is not stepped over."""
    reason = REFUSED.get(statement.name)
    if reason is not None:
        return SourceError(f"{statement.text} is refused: {reason}", statement.span)
    known = {*data.routine_names("proc"), *INTERPRETED, *KEPT, *REFUSED}
    hint = data.hint(statement.name)
    message = unknown_name(
        "instruction or routine", statement.text, known, hint or "its text is not at hand"
    )
    return SourceError(
        f"{message}; it might move the robot, so it is not stepped over: name the module that "
        f"declares it, or, if it does not move the robot, answer '{statement.text} = \"skip\"' "
        "in the table [calls] of the answers",
        statement.span,
    )
