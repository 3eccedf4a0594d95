"""Tokens → statements."""

from __future__ import annotations

from collections.abc import Callable

from ....core.errors import Span
from ....core.source.text.lexer import words
from .cursor import Cursor
from .declarations import parse_declaration, parse_enum, parse_signal, parse_struc
from .expression_tree import Call, Expression
from .expressions import parse_expression, parse_name, parse_name_or_call
from .lexer import END, ENUM, NAME, NEWLINE
from .tree import (
    Assign,
    Block,
    Case,
    Continue,
    Exit,
    For,
    Goto,
    Halt,
    If,
    Invoke,
    Keyword,
    Label,
    Loop,
    MotionInstruction,
    Repeat,
    Return,
    SplineBlock,
    Statement,
    Switch,
    Trigger,
    WaitFor,
    WaitSec,
    While,
)

CLOSING = words("else endif endfor endwhile until endloop case default endswitch end endfct enddat")
APPROXIMATIONS = frozenset({"c_ptp", "c_dis", "c_ori", "c_vel", "c_spl"})
MOTIONS = words("ptp ptp_rel lin lin_rel circ circ_rel sptp sptp_rel slin slin_rel scirc scirc_rel")
ASYNCHRONOUS = frozenset({"asyptp", "asycont", "asystop", "asycancel"})
"""First words of statements that drive axes beside the program: ``ASYPTP {E1 30}``."""
ARCS = frozenset({"circ", "circ_rel", "scirc", "scirc_rel"})


def parse_block(cursor: Cursor, ends: frozenset[str], opened_by: str, start: int) -> Block:
    """Statements up to one of the keywords ``ends``, which is left to be read.

    Raises:
        SourceError: another block's end, or the end of the file, comes first.
    """
    statements: list[Statement] = []
    with cursor.nested():
        while (kind := cursor.kind) not in ends:
            if kind == NEWLINE:
                cursor.advance()
            elif kind == END or kind in CLOSING:
                line = cursor.source.span(start, start).line
                wanted = " or ".join(sorted(end.upper() for end in ends))
                raise cursor.unexpected(f"{wanted}, to close {opened_by} of line {line},")
            else:
                statements.extend(parse_statement(cursor))
    return Block(tuple(statements))


def parse_statement(cursor: Cursor) -> tuple[Statement, ...]:
    """The statement that starts at the cursor; a declaration of several names gives several."""
    parse = _BY_KEYWORD.get(cursor.kind)
    if parse is None:
        raise cursor.unexpected("a statement")
    found = parse(cursor)
    return found if isinstance(found, tuple) else (found,)


def _name_statement(cursor: Cursor) -> Statement | tuple[Statement, ...]:
    following = cursor.peek()
    if cursor.text.lower() in ASYNCHRONOUS and following not in ("(", "="):
        return _kept(cursor)
    if following == NAME:
        return _named(cursor)
    start = cursor.start
    if following == ":" and cursor.peek(2) in (NEWLINE, END):
        name = cursor.name("a label").lower()
        cursor.advance()
        cursor.end_of_line("the label")
        return Label(cursor.span_from(start), name)
    target = parse_name_or_call(cursor)
    if isinstance(target, Call):
        span = cursor.span_from(start)
        cursor.end_of_line("the call", CLOSING)
        return Invoke(span, target)
    if target.name == "on_error_proceed" and cursor.at_end_of_line:
        cursor.accept(NEWLINE)
        return Keyword(target.span, target.name)
    if cursor.kind != "=":
        raise cursor.unexpected(f"'=', or '(' for a call, after {target.text}")
    cursor.advance()
    value = parse_expression(cursor)
    span = cursor.span_from(start)
    cursor.end_of_line("the assignment", CLOSING)
    return Assign(span, target, value)


def _named(cursor: Cursor) -> Statement | tuple[Statement, ...]:
    """A name behind a name: a declaration of that type, or ``CONFIRM x``, ``CHANNEL …``."""
    word = cursor.text.lower()
    if word == "const":
        return parse_declaration(cursor)
    if word in ("channel", "import", "confirm", "sema", "time_block", "const_vel"):
        return _kept(cursor)
    return parse_declaration(cursor)


def _kept(cursor: Cursor) -> Keyword:
    start, word = cursor.start, cursor.text.lower()
    cursor.skip_line()
    span = cursor.span_from(start)
    cursor.accept(NEWLINE)
    return Keyword(span, word)


def _global(cursor: Cursor) -> Statement | tuple[Statement, ...]:
    """``GLOBAL INTERRUPT DECL …`` and ``GLOBAL INT X``."""
    if cursor.peek() == "interrupt":
        return _kept(cursor)
    return parse_declaration(cursor)


def _continue(cursor: Cursor) -> Continue:
    return Continue(_single_word(cursor))


def _exit(cursor: Cursor) -> Exit:
    return Exit(_single_word(cursor))


def _halt(cursor: Cursor) -> Halt:
    return Halt(_single_word(cursor))


def _single_word(cursor: Cursor) -> Span:
    start, word = cursor.start, cursor.kind
    cursor.advance()
    span = cursor.span_from(start)
    cursor.end_of_line(word.upper(), CLOSING)
    return span


def _if(cursor: Cursor) -> If:
    start = cursor.start
    cursor.advance()
    condition = parse_expression(cursor)
    cursor.accept(NEWLINE)
    cursor.expect("then", "after the condition of IF")
    body = parse_block(cursor, frozenset({"else", "endif"}), "the IF", start)
    otherwise = Block()
    if cursor.accept("else"):
        otherwise = parse_block(cursor, frozenset({"endif"}), "the IF", start)
    return If(_end(cursor, start), condition, body, otherwise)


def _for(cursor: Cursor) -> For:
    start = cursor.start
    cursor.advance()
    counter = parse_name(cursor)
    cursor.expect("=", "after the counter of FOR")
    first = parse_expression(cursor)
    cursor.expect("to", "after the first value of FOR")
    last = parse_expression(cursor)
    step = parse_expression(cursor) if cursor.accept("step") else None
    cursor.end_of_line("the head of FOR")
    body = parse_block(cursor, frozenset({"endfor"}), "the FOR", start)
    return For(_end(cursor, start), counter, first, last, step, body)


def _while(cursor: Cursor) -> While:
    start = cursor.start
    cursor.advance()
    condition = parse_expression(cursor)
    cursor.end_of_line("the condition of WHILE")
    body = parse_block(cursor, frozenset({"endwhile"}), "the WHILE", start)
    return While(_end(cursor, start), condition, body)


def _repeat(cursor: Cursor) -> Repeat:
    start = cursor.start
    cursor.advance()
    body = parse_block(cursor, frozenset({"until"}), "the REPEAT", start)
    cursor.advance()
    condition = parse_expression(cursor)
    span = cursor.span_from(start)
    cursor.end_of_line("the condition of UNTIL", CLOSING)
    return Repeat(span, condition, body)


def _loop(cursor: Cursor) -> Loop:
    start = cursor.start
    cursor.advance()
    body = parse_block(cursor, frozenset({"endloop"}), "the LOOP", start)
    return Loop(_end(cursor, start), body)


def _switch(cursor: Cursor) -> Switch:
    start = cursor.start
    cursor.advance()
    subject = parse_expression(cursor)
    cursor.accept(NEWLINE)
    ends = frozenset({"case", "default", "endswitch"})
    cases = []
    otherwise = None
    while cursor.kind in ("case", "default"):
        if cursor.accept("default"):
            otherwise = parse_block(cursor, ends, "the SWITCH", start)
            continue
        cursor.advance()
        values = [parse_expression(cursor)]
        while cursor.accept(","):
            values.append(parse_expression(cursor))
        cases.append(Case(tuple(values), parse_block(cursor, ends, "the SWITCH", start)))
    if cursor.kind != "endswitch":
        raise cursor.unexpected("CASE, DEFAULT or ENDSWITCH")
    return Switch(_end(cursor, start), subject, tuple(cases), otherwise)


def _end(cursor: Cursor, start: int) -> Span:
    """Past the keyword that closes a block."""
    word = cursor.kind.upper()
    cursor.advance()
    span = cursor.span_from(start)
    cursor.end_of_line(word, CLOSING)
    return span


def _goto(cursor: Cursor) -> Goto:
    start = cursor.start
    cursor.advance()
    name = cursor.name("a label").lower()
    span = cursor.span_from(start)
    cursor.end_of_line("GOTO", CLOSING)
    return Goto(span, name)


def _return(cursor: Cursor) -> Return:
    start = cursor.start
    cursor.advance()
    value = None if cursor.at_end_of_line else parse_expression(cursor)
    span = cursor.span_from(start)
    cursor.end_of_line("RETURN", CLOSING)
    return Return(span, value)


def _wait(cursor: Cursor) -> Statement:
    start = cursor.start
    cursor.advance()
    if cursor.accept("for"):
        condition = parse_expression(cursor)
        span = cursor.span_from(start)
        cursor.end_of_line("WAIT FOR", CLOSING)
        return WaitFor(span, condition)
    cursor.expect_word("sec", "or FOR after WAIT")
    time = parse_expression(cursor)
    span = cursor.span_from(start)
    cursor.end_of_line("WAIT SEC", CLOSING)
    return WaitSec(span, time)


def _trigger(cursor: Cursor) -> Trigger:
    start = cursor.start
    cursor.advance()
    cursor.expect_word("when", "after TRIGGER")
    path = cursor.accept_word("path")
    if not path:
        cursor.expect_word("distance", "or PATH after TRIGGER WHEN")
    cursor.expect("=", "after DISTANCE or PATH")
    place = parse_expression(cursor)
    on_start = cursor.accept_word("onstart")
    delay = None
    if cursor.accept_word("delay"):
        cursor.expect("=", "after DELAY")
        delay = parse_expression(cursor)
    cursor.expect_word("do", "in TRIGGER")
    begin = cursor.start
    cursor.skip_line()
    action = cursor.source.text[begin : cursor.end]
    span = cursor.span_from(start)
    cursor.accept(NEWLINE)
    return Trigger(span, path, on_start, place, delay, action)


def _motion(cursor: Cursor) -> MotionInstruction:
    start, word = cursor.start, cursor.kind
    cursor.advance()
    if cursor.at_end_of_line or cursor.kind in ("?", "!"):
        raise cursor.source.error(
            f"{word.upper()} has no target: teach the point, or take the line out",
            start,
            cursor.ends[cursor.index],
        )
    targets = [parse_expression(cursor)]
    angle = None
    if word in ARCS:
        cursor.expect(",", f"between the auxiliary and the end point of {word.upper()}")
        targets.append(parse_expression(cursor))
        if cursor.accept(","):
            cursor.expect_word("ca", f"after the end point of {word.upper()}")
            angle = parse_expression(cursor)
    words = _MotionWords()
    words.read(cursor)
    settings: tuple[Assign, ...] = ()
    if cursor.accept_word("with"):
        settings = _motion_settings(cursor)
        words.read(cursor)
    span = cursor.span_from(start)
    cursor.end_of_line("the motion", CLOSING)
    return MotionInstruction(
        span,
        word,
        tuple(targets),
        angle,
        words.frame,
        tuple(words.approximation),
        cursor.source.span(*(words.place or (span.end, span.end))),
        settings,
    )


class _MotionWords:
    """``C_PTP C_DIS``, ``#TOOL`` behind a motion; commas between them are met in programs."""

    def __init__(self) -> None:
        self.frame: str | None = None
        self.approximation: list[str] = []
        self.place: tuple[int, int] | None = None

    def read(self, cursor: Cursor) -> None:
        """The words from the cursor on."""
        while True:
            if cursor.kind == ENUM:
                self.frame = cursor.text[1:].strip().lower()
            elif cursor.kind == NAME and cursor.text.lower() in APPROXIMATIONS:
                self.approximation.append(cursor.text.lower())
                start = cursor.start if self.place is None else self.place[0]
                self.place = (start, cursor.ends[cursor.index])
            elif cursor.kind != ",":
                return
            cursor.advance()


def _motion_settings(cursor: Cursor) -> tuple[Assign, ...]:
    settings: list[Assign] = []
    while not settings or cursor.accept(","):
        start = cursor.start
        target = parse_name(cursor)
        cursor.expect("=", f"after {target.text}")
        value: Expression = parse_expression(cursor)
        settings.append(Assign(cursor.span_from(start), target, value))
    return tuple(settings)


def _spline(cursor: Cursor) -> SplineBlock:
    start, word = cursor.start, cursor.kind
    while cursor.kind not in ("endspline", END):
        cursor.advance()
    if cursor.kind == END:
        raise cursor.unexpected(f"ENDSPLINE, to close {word.upper()},")
    cursor.skip_line()
    span = cursor.span_from(start)
    cursor.accept(NEWLINE)
    return SplineBlock(span, word)


_BY_KEYWORD: dict[str, Callable[[Cursor], Statement | tuple[Statement, ...]]] = {
    NAME: _name_statement,
    "if": _if,
    "for": _for,
    "while": _while,
    "repeat": _repeat,
    "loop": _loop,
    "switch": _switch,
    "goto": _goto,
    "return": _return,
    "exit": _exit,
    "halt": _halt,
    "continue": _continue,
    "wait": _wait,
    "trigger": _trigger,
    "global": _global,
    "decl": parse_declaration,
    "struc": parse_struc,
    "enum": parse_enum,
    "signal": parse_signal,
    "spline": _spline,
    "ptp_spline": _spline,
    **dict.fromkeys(MOTIONS, _motion),
    **dict.fromkeys(words("ext extfct import interrupt anout anin digin brake resume"), _kept),
}
