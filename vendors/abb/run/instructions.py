"""Every instruction that the reader knows by name: interpreted, kept as it stands, or refused.

An instruction that is in none of the tables, and no routine of the program, is stepped over with a
note: what it does is not known.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from ....core.errors import SourceError
from ....core.source.execution.scopes import alike
from ....core.source.text.lexer import words
from ..motion.move_arguments import MovesRun
from ..motion.moves import MOVES
from ..motion.settings_instructions import SETTINGS, SettingsRun
from ..motion.special_moves import SPECIAL_MOVES
from ..motion.triggers import TRIGGER_DEFINITIONS, TRIGGER_MOVES
from ..syntax.tree import Call, Expression, Invoke, Name
from ..values.arguments import bind
from ..values.data import Globals
from ..values.errors import ProgramError
from ..values.evaluator import Evaluator
from ..values.operators import OperandError, apply
from ..values.scope import Scope, unknown_name
from ..values.text_functions import with_bit
from ..values.types import (
    NUM,
    STRING,
    TOOLDATA,
    WOBJDATA,
    Unknown,
    Value,
    find_unknown,
    mismatch,
)
from .handlers import Keeping, Running
from .kept import REFUSED
from .signals import SIGNALS
from .waits import WAIT_UNTIL, wait_until


class InstructionRun(MovesRun, SettingsRun, Keeping, Running, Protocol):
    """What all of them need of a run."""


Handler = Callable[[InstructionRun, Invoke, Scope], None]


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
    run.out.wait(value, "WaitTime", "the least that it takes is 0 s", invoke.span)


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
            run.evaluator.fill(given, Unknown(reason, invoke.span, given.text), scope, invoke.name)
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
    number = run.evaluator.evaluate(bound.value(1), scope)
    unknown = number if isinstance(number, Unknown) else None
    whole = f"{name}{bound.number(run.evaluator, 1, scope):g}"
    run.call_named(whole, (), scope, invoke.span, unknown)


def _calibrate(run: Running, invoke: Invoke, scope: Scope) -> None:
    """``MToolTCPCalib Pos1, …, Tool, MaxErr, MeanErr`` and its like: the tool stays as it is."""
    why = "the tool keeps the value that it has, and how large the errors are is not known"
    run.out.keep(invoke.span, invoke.text, why)
    given = [a.value for a in invoke.arguments if a.option is None]
    for error in given[-2:]:
        if isinstance(error, Name) and scope.find(error.name) is not None:
            reason = f"what {invoke.text} gave {error.text}"
            run.evaluator.fill(error, Unknown(reason, invoke.span, error.text), scope, invoke.name)


def _book_error(run: Running, invoke: Invoke, scope: Scope) -> None:
    """``BookErrNo error``: the datum gets a number that no other error has."""
    datum = bind(invoke, ("ErrorName",), ()).value(0)
    if not isinstance(datum, Name):
        raise SourceError("BookErrNo takes an errnum", datum.span)
    run.evaluator.assign(datum, run.book_error(), scope)


def _raise_error(run: Running, invoke: Invoke, scope: Scope) -> None:
    """``ErrRaise "error", …`` and ``RaiseToUser \\ErrorNumber := error``"""
    datum = invoke.arguments[0].value if invoke.arguments else None
    named = None if datum is None else run.evaluator.evaluate(datum, scope)
    if isinstance(named, str):
        named = run.evaluator.evaluate(Name(invoke.span, named.lower(), named), scope)
    number = named if isinstance(named, float) else 0.0
    message = f"{invoke.text}: no ERROR handler takes this error, and the program stops"
    raise ProgramError(message, invoke.span, number)


def _system_data(run: Running, invoke: Invoke, scope: Scope) -> None:
    """``GetSysData datum``: the tool or the work object in force, as CTool and CWObj give them."""
    datum = bind(invoke, ("DestObject",), ("objectname",)).value(0)
    cell = scope.find(datum.name) if isinstance(datum, Name) else None
    kind = cell.type.name if cell is not None else ""
    call = {TOOLDATA.name: "CTool", WOBJDATA.name: "CWObj"}.get(kind)
    if call is None or not isinstance(datum, Name):
        run.out.keep(invoke.span, invoke.text, "what is in force is not known")
        return
    present = Call(invoke.span, call.lower(), call, ())
    run.evaluator.assign(datum, run.evaluator.evaluate(present, scope), scope)


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
    **dict.fromkeys(words("mtooltcpcalib mtoolrotcalib stooltcpcalib stoolrotcalib"), _calibrate),
    WAIT_UNTIL: wait_until,
    **SIGNALS,
    "incr": _step,
    "decr": _step,
    "clear": _step,
    "add": _step,
    "bookerrno": _book_error,
    "errraise": _raise_error,
    "raisetouser": _raise_error,
    "getsysdata": _system_data,
    "exitcycle": _exit_cycle,
}


MOVING = frozenset({*MOVES, *TRIGGER_MOVES, *SPECIAL_MOVES})
"""Names of instructions that move the robot."""


_MOVING = tuple(sorted(MOVING))
_ALIKE = 0.85
"""Share of its letters in which the name of a routine is like that of a move by mistake."""


def refusal(statement: Invoke, data: Globals) -> str:
    """That a routine whose text is not at hand is stepped over.

    Raises:
        SourceError: it is an instruction that is refused, or looks like a move that is mistyped.
    """
    name = statement.name
    reason = REFUSED.get(name)
    if reason is not None:
        raise SourceError(f"{statement.text} is refused: {reason}", statement.span)
    answer = f"answer '{statement.text} = \"skip\"' in the table [calls] of the answers"
    mistyped = alike(name, _MOVING, 1, _ALIKE)
    if mistyped:
        raise SourceError(
            f"unknown instruction or routine '{statement.text}': did you mean {mistyped[0]}? If it "
            f"is a routine that does not move the robot, {answer}",
            statement.span,
        )
    own = data.routines.get(name)
    if own is not None and own.kind == "func":
        return (
            f"'{statement.text}' is a FUNC, which no controller calls as an instruction: it is "
            f"stepped over; take what it returns (:=), or {answer}"
        )
    hint = data.hint(name) or "its text is not at hand"
    known = data.routine_names("proc")
    message = unknown_name("instruction or routine", statement.text, known, hint)
    return (
        f"{message}: it is stepped over; name the module that declares it if it moves the robot, "
        f"or {answer}"
    )
