"""Where a program begins."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import PurePath

from ....core.door import spelt
from ....core.errors import EntryError, SourceError, StopError
from ....core.program.entry_point import ALL, EntryPoint, listed, without_caller
from ....core.program.program import Program
from ....core.program.question import QuestionKind
from ....core.source.execution.course import About
from ....core.source.execution.transcript import Transcript
from ....core.source.text.damage import nothing_driven
from ..motion.settings import CALLS
from ..syntax.traversal import all_calls, all_statements, run_in
from ..syntax.tree import Argument, Assign, Block, Call, Define, Evaluate, Name, Statement
from ..values.answers import answered
from ..values.scope import Scope, Variable
from ..values.values import Unknown
from .analysis import SENT
from .exits import Finished
from .interpreter import Interpreter

_USUAL = ("main", "program", "Program", "prog", "myprog", "unnamed")


def run_program(
    run: Interpreter,
    blocks: Sequence[Block],
    main: str,
    entry: str | None,
    call: Block = (),
) -> Program:
    """Run a program from its beginning to its end.

    Args:
        run: that nothing was executed in yet.
        blocks: statements of all files, the main one's last.
        main: name of the main file.
        entry: name of the function to start with, None for the program's own beginning.
        call: of that function, with arguments; empty if the user gives none.

    Raises:
        SourceError: there is no such function, or none that is clearly the first.
    """
    for block in blocks:
        run.root.define(block)
    name = PurePath(main.replace("\\", "/")).stem
    points = partial(_points, run, blocks)
    if entry == ALL and run.root.function(ALL) is None:
        return Program((), name, entries=points())
    with suppress(Finished), _stopped(run.out):
        if entry is not None:
            define, around = _named(blocks, entry, run)
            for block in blocks:
                run.run_top(tuple(s for s in block if isinstance(s, Assign)))
            for outer in around:
                run.root.define(outer.body)
                run.run_top(tuple(filter(_sets, outer.body)))
            name = define.name
            if call:
                run.run_top(call)
            else:
                _start(run, define)
        else:
            name = _run_top(run, blocks, name)
    for called, span in run.guided:
        if called in SENT or not run.out.move_index:
            run.course.sent(called, span)
    run.out.check_driven()
    if run.texts.damage is not None:
        nothing_driven([run.texts.damage], run.out.move_index > 0)
    return Program(
        run.statements(),
        name,
        notes=run.notes(),
        questions=run.course.questions(),
        entries=() if run.out.move_index else points(begun=name),
        calls=tuple(run.out.calls),
        cycle=run.course.cycle,
        sections=run.course.sections.found(run.course.cycle),
    )


@contextmanager
def _stopped(out: Transcript) -> Iterator[None]:
    """What runs inside may end with an error of the controller."""
    try:
        yield
    except StopError as error:
        if not out.stops(error):
            raise


def _run_top(run: Interpreter, blocks: Sequence[Block], stem: str) -> str:
    """Statements outside of functions, or else the function that is the program."""
    defines = [s for s in blocks[-1] if isinstance(s, Define)]
    for block in blocks:
        run.run_top(tuple(s for s in block if not isinstance(s, Define)))
    if (
        run.out.move_index
        or run.out.left_out
        or not defines
        or any(d.name in run.entered for d in defines)
    ):
        return stem
    define = _first(defines, stem, run)
    _start(run, define)
    return define.name


def _sets(statement: Statement) -> bool:
    """Whether a statement of the function round a thread makes what the thread works with."""
    if isinstance(statement, Evaluate) and isinstance(statement.expression, Call):
        return statement.expression.name in CALLS
    return isinstance(statement, Assign)


def _points(
    run: Interpreter, blocks: Sequence[Block], begun: str | None = None
) -> tuple[EntryPoint, ...]:
    """The functions that the files define; ``begun`` is the name of the one that was run."""
    return tuple(
        _point(run, d, d.name == begun)
        for block in blocks
        for d in block
        if isinstance(d, Define) and d.kind != "thread"
    )


def _point(run: Interpreter, define: Define, begun: bool = False) -> EntryPoint:
    return EntryPoint(define.name, _needed_by(define), run.analysis.move_count(define.body), begun)


def _needed_by(define: Define) -> tuple[str, ...]:
    """Names of the parameters that must be given."""
    return tuple(p.name for p in define.parameters if p.default is None)


def _inside(define: Define, name: str) -> tuple[Define, ...]:
    """The way to a function or thread that is defined in another one; empty if it is not."""
    for statement in run_in(define.body):
        if isinstance(statement, Define):
            found = (statement,) if statement.name == name else _inside(statement, name)
            if found:
                return (define, *found)
    return ()


def _start(run: Interpreter, define: Define) -> None:
    """Run a function; where programs go on, what it needs as arguments is asked."""
    start, end = define.head
    span = run.texts.span(start, end)
    caller = Scope("the caller", outer=run.root)
    needed = _needed_by(define) if run.course.answers.goes_on else ()
    for name in needed:
        told = run.course.value(name, About(span, QuestionKind.DATUM))
        unknown = Unknown(f"the argument '{name}' of {define.name}", span, key=name)
        caller.cells[name] = Variable(unknown if told is None else answered(told))
    if needed:
        run.note_once("entry", without_caller(define.name, needed), span)
    arguments = tuple(Argument(start, end, name, Name(start, end, name)) for name in needed)
    run.call(Call(start, end, define.name, arguments), caller)


def _first(defines: Sequence[Define], stem: str, run: Interpreter) -> Define:
    """The function that is the program."""
    able = [d for d in defines if not _needed_by(d)]
    if len(defines) == 1 and (able or run.course.answers.goes_on):
        return defines[0]
    called = {name for d in defines for name in all_calls(d.body) if name != d.name}
    first = [d for d in able if d.name not in called and d.kind != "thread"]
    if len(first) == 1:
        return first[0]
    for name in (stem, *_USUAL):
        for define in first:
            if define.name == name:
                return define
    driving = [d for d in first if run.analysis.moves(d.body)]
    if len(driving) == 1:
        return driving[0]
    span = run.texts.span(*defines[0].head)
    if not any(run.analysis.moves(d.body) for d in defines):
        raise SourceError(
            "the file defines functions that move nothing, and calls none of them: it is a library "
            f"of others; read the program that calls them, and name it as well ({spelt('others')})",
            span,
        )
    known = listed(_points(run, [tuple(defines)]))
    if not first:
        raise EntryError(
            "the file defines functions and calls none of them, and all take arguments or are "
            "called by others: choose as the entry one of "
            f"{known}, with arguments as pick(1, p_home); all drives each of them",
            span,
        )
    raise EntryError(
        "the file defines several functions and calls none of them: choose as the entry one of "
        f"{known}; all drives each of them",
        span,
    )


def _named(
    blocks: Sequence[Block], entry: str, run: Interpreter
) -> tuple[Define, tuple[Define, ...]]:
    """The function or thread of a name, and those that it stands in, the outermost first."""
    defines = [s for block in reversed(blocks) for s in block if isinstance(s, Define)]
    for define in defines:
        if define.name == entry:
            return define, ()
    for define in defines:
        found = _inside(define, entry)
        if found:
            return found[-1], found[:-1]
    threads = [d for b in blocks for d in all_statements(b) if isinstance(d, Define)]
    moving = [d for d in threads if d.kind == "thread" and run.analysis.moves(d.body)]
    known = listed([*_points(run, blocks), *map(partial(_point, run), moving)]) or "none"
    raise SourceError(
        f"there is no function '{entry}' to start with; the files define {known}",
        run.texts.span(0, 0),
    )
