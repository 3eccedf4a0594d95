"""Tokens → statements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ....core.errors import ParseError, SourceError, Span
from ....core.source.text.damage import words_in
from ....core.source.text.lexer import words
from . import tree
from .closed_folds import parse_closed
from .cursor import Cursor
from .declarations import parse_declaration, parse_enum, parse_signal, parse_struc
from .expressions import parse_expression, parse_name, parse_name_or_call
from .lexer import CLOSED, END, ENUM, NAME, NEWLINE
from .tree import Block, Statement

CLOSING = words("else endif endfor endwhile until endloop case default endswitch end endfct enddat")
APPROXIMATIONS = frozenset({"c_ptp", "c_dis", "c_ori", "c_vel", "c_spl"})
MOTIONS = words("ptp ptp_rel lin lin_rel circ circ_rel sptp sptp_rel slin slin_rel scirc scirc_rel")
SEGMENTS = words("spl spl_rel sptp sptp_rel slin slin_rel scirc scirc_rel")
"""Motions of a spline block."""
_KEPT_NAMES = words("channel import confirm sema time_block const_vel stop")
"""First words of statements that are kept, which are no keywords."""
_ALONE = words("on_error_proceed ini init declarations")
"""Statements of one word; the last are titles of folds that were closed when the text was taken."""
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
                wanted = " or ".join(sorted(end.upper() for end in ends - {END}))
                raise cursor.torn(f"{wanted}, to close {opened_by} of line {line},")
            else:
                begin, depth = cursor.index, cursor.depth
                try:
                    statements.extend(parse_statement(cursor))
                except ParseError as error:
                    statements.append(_unread(cursor, begin, depth, error))
    return Block(tuple(statements))


def _unread(cursor: Cursor, begin: int, depth: int, error: SourceError) -> tree.Unread:
    """A line that is no statement, in a text that is read all the same.

    Raises:
        SourceError: it is not.
    """
    cursor.step_over(error)
    cursor.depth = depth
    if cursor.index == begin or not cursor.begins_line():
        cursor.skip_line()
    span = cursor.source.span(cursor.starts[begin], cursor.ends[max(begin, cursor.index - 1)])
    cursor.accept(NEWLINE)
    words = words_in(cursor.source.text[span.start : span.end].lower())
    return tree.Unread(span, error.message, words, _target(cursor, begin))


def _target(cursor: Cursor, begin: int) -> tree.Name | None:
    """What a damaged line would set: ``$VEL.CP``."""
    at, path = begin + 1, []
    while cursor.kinds[at : at + 2] == [".", NAME]:
        path.append(cursor.source.text[cursor.starts[at + 1] : cursor.ends[at + 1]].lower())
        at += 2
    if cursor.kinds[begin] != NAME or cursor.kinds[at] not in ("=", "["):
        return None
    if cursor.kinds[at] == "[" and "=" not in cursor.kinds[at : cursor.index]:
        return None
    span = cursor.source.span(cursor.starts[begin], cursor.ends[at - 1])
    name = cursor.source.text[cursor.starts[begin] : cursor.ends[begin]]
    return tree.Name(span, name.lower(), name, () if cursor.kinds[at] == "[" else tuple(path))


def parse_statement(cursor: Cursor) -> tuple[Statement, ...]:
    """The statement that starts at the cursor; a declaration of several names gives several."""
    kind, start = cursor.kind, cursor.start
    behind = _BEHIND_KEYWORD.get(kind)
    if behind is not None:
        cursor.index += 1
        return (behind(cursor, start),)
    parse = _AT_WORD.get(kind)
    if parse is None:
        raise cursor.unexpected("a statement")
    found = parse(cursor)
    return found if isinstance(found, tuple) else (found,)


def _line(cursor: Cursor, start: int, statement: str) -> Span:
    """Where a statement stands; past the end of its line."""
    span = cursor.span_from(start)
    cursor.end_of_line(statement, CLOSING)
    return span


def _name_statement(cursor: Cursor) -> Statement | tuple[Statement, ...]:
    following = cursor.peek()
    word = cursor.text.lower()
    if word in ASYNCHRONOUS and following not in ("(", "="):
        return _kept(cursor)
    if word in _KEPT_NAMES and following == "end":  # TIME_BLOCK END = 4.5
        return _kept(cursor)
    if following == NAME:
        return _named(cursor)
    start = cursor.start
    if following == ":" and cursor.peek(2) in (NEWLINE, END):
        name = cursor.name("a label").lower()
        cursor.advance()
        cursor.end_of_line("the label")
        return tree.Label(cursor.span_from(start), name)
    target = parse_name_or_call(cursor)
    if isinstance(target, tree.Call):
        return tree.Invoke(_line(cursor, start, "the call"), target)
    if target.name in _ALONE and cursor.at_end_of_line:
        cursor.accept(NEWLINE)
        if target.name == "ini":
            values = tree.Constant(target.span, "initmov"), None
            return tree.Invoke(target.span, tree.Call(target.span, "bas", "BAS", values))
        return tree.Keyword(target.span, target.name)
    if cursor.kind != "=":
        raise cursor.unexpected(f"'=', or '(' for a call, after {target.text}")
    cursor.advance()
    value = parse_expression(cursor)
    return tree.Assign(_line(cursor, start, "the assignment"), target, value)


def _named(cursor: Cursor) -> Statement | tuple[Statement, ...]:
    """A name behind a name: a declaration of that type, or ``CONFIRM x``, ``CHANNEL …``."""
    word = cursor.text.lower()
    if word == "const":
        return parse_declaration(cursor)
    if word in _KEPT_NAMES:
        return _kept(cursor)
    return parse_declaration(cursor)


def _kept(cursor: Cursor) -> tree.Keyword:
    start, word = cursor.start, cursor.text.lower()
    cursor.skip_line()
    span = cursor.span_from(start)
    cursor.accept(NEWLINE)
    return tree.Keyword(span, word)


def _global(cursor: Cursor) -> Statement | tuple[Statement, ...]:
    """``GLOBAL INTERRUPT DECL …`` and ``GLOBAL INT X``."""
    if cursor.peek() == "interrupt":
        return _kept(cursor)
    return parse_declaration(cursor)


def _single_word(cursor: Cursor, start: int) -> Statement:
    word = cursor.kinds[cursor.index - 1]
    return _SINGLE[word](_line(cursor, start, word.upper()))


def _if(cursor: Cursor, start: int) -> tree.If:
    condition = parse_expression(cursor)
    cursor.accept(NEWLINE)
    cursor.expect("then", "after the condition of IF")
    body = parse_block(cursor, frozenset({"else", "endif"}), "the IF", start)
    otherwise = Block()
    if cursor.accept("else"):
        otherwise = parse_block(cursor, frozenset({"endif"}), "the IF", start)
    return tree.If(_end(cursor, start), condition, body, otherwise)


def _for(cursor: Cursor, start: int) -> tree.For:
    counter = parse_name(cursor)
    cursor.expect("=", "after the counter of FOR")
    first = parse_expression(cursor)
    cursor.expect("to", "after the first value of FOR")
    last = parse_expression(cursor)
    step = parse_expression(cursor) if cursor.accept("step") else None
    cursor.end_of_line("the head of FOR")
    body = parse_block(cursor, frozenset({"endfor"}), "the FOR", start)
    return tree.For(_end(cursor, start), body, counter, first, last, step)


def _while(cursor: Cursor, start: int) -> tree.While:
    condition = parse_expression(cursor)
    cursor.end_of_line("the condition of WHILE")
    body = parse_block(cursor, frozenset({"endwhile"}), "the WHILE", start)
    return tree.While(_end(cursor, start), body, condition)


def _repeat(cursor: Cursor, start: int) -> tree.Repeat:
    body = parse_block(cursor, frozenset({"until"}), "the REPEAT", start)
    cursor.advance()
    condition = parse_expression(cursor)
    return tree.Repeat(_line(cursor, start, "the condition of UNTIL"), body, condition)


def _loop(cursor: Cursor, start: int) -> tree.Loop:
    body = parse_block(cursor, frozenset({"endloop"}), "the LOOP", start)
    return tree.Loop(_end(cursor, start), body)


def _switch(cursor: Cursor, start: int) -> tree.Switch:
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
        values = cursor.listed(parse_expression)
        cases.append(tree.Case(values, parse_block(cursor, ends, "the SWITCH", start)))
    if cursor.kind != "endswitch":
        raise cursor.unexpected("CASE, DEFAULT or ENDSWITCH")
    return tree.Switch(_end(cursor, start), subject, tuple(cases), otherwise)


def _end(cursor: Cursor, start: int) -> Span:
    """Past the keyword that closes a block."""
    word = cursor.kind.upper()
    cursor.advance()
    return _line(cursor, start, word)


def _goto(cursor: Cursor, start: int) -> tree.Goto:
    name = cursor.name("a label").lower()
    cursor.jumps = True
    return tree.Goto(_line(cursor, start, "GOTO"), name)


def _return(cursor: Cursor, start: int) -> tree.Return:
    value = None if cursor.at_end_of_line else parse_expression(cursor)
    return tree.Return(_line(cursor, start, "RETURN"), value)


def _wait(cursor: Cursor, start: int) -> Statement:
    if cursor.accept("for"):
        condition = parse_expression(cursor)
        return tree.WaitFor(_line(cursor, start, "WAIT FOR"), condition)
    cursor.expect_word("sec", "or FOR after WAIT")
    time = parse_expression(cursor)
    return tree.WaitSec(_line(cursor, start, "WAIT SEC"), time)


def _trigger(cursor: Cursor, start: int) -> tree.Trigger:
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
    return tree.Trigger(span, path, on_start, place, delay, action)


def _motion(cursor: Cursor) -> tree.MotionInstruction:
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
    settings = _settings(cursor)
    words.read(cursor)
    span = _line(cursor, start, "the motion")
    return tree.MotionInstruction(
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


def _settings(cursor: Cursor) -> tuple[tree.Assign, ...]:
    """``WITH $VEL.CP=0.2, …``"""
    return cursor.listed(_motion_setting) if cursor.accept_word("with") else ()


def _motion_setting(cursor: Cursor) -> tree.Assign:
    start = cursor.start
    target = parse_name(cursor)
    cursor.expect("=", f"after {target.text}")
    value = parse_expression(cursor)
    return tree.Assign(cursor.span_from(start), target, value)


def _spline(cursor: Cursor) -> tree.SplineBlock:
    start, word = cursor.start, cursor.kind
    cursor.advance()
    settings = _settings(cursor)
    cursor.end_of_line(word.upper())
    body: list[Statement] = []
    while cursor.kind != "endspline":
        if cursor.kind == NEWLINE:
            cursor.advance()
        elif cursor.kind in SEGMENTS:
            body.append(replace(_motion(cursor), passed=True))
        elif cursor.kind == "trigger" or (
            cursor.kind == NAME and cursor.text.lower() in _KEPT_NAMES
        ):
            body += parse_statement(cursor)
        else:
            line = cursor.source.span(start, start).line
            raise cursor.unexpected(
                "SPL, SLIN, SCIRC, SPTP, TRIGGER, TIME_BLOCK, CONST_VEL or ENDSPLINE, to close "
                f"{word.upper()} of line {line},"
            )
    cursor.advance()
    words = _MotionWords()
    words.read(cursor)
    span = _line(cursor, start, "ENDSPLINE")
    last = max((k for k, s in enumerate(body) if isinstance(s, tree.MotionInstruction)), default=-1)
    if last >= 0:
        segment = body[last]
        assert isinstance(segment, tree.MotionInstruction)
        body[last] = replace(
            segment,
            approximation=tuple(words.approximation),
            approximated=cursor.source.span(*(words.place or (span.end, span.end))),
            passed=False,
        )
    return tree.SplineBlock(span, word, settings, tuple(body))


_SINGLE = {"continue": tree.Continue, "exit": tree.Exit, "halt": tree.Halt}
_BEHIND_KEYWORD: dict[str, Callable[[Cursor, int], Statement]] = {
    "if": _if,
    "for": _for,
    "while": _while,
    "repeat": _repeat,
    "loop": _loop,
    "switch": _switch,
    "goto": _goto,
    "return": _return,
    "wait": _wait,
    "trigger": _trigger,
    **dict.fromkeys(_SINGLE, _single_word),
}
_AT_WORD: dict[str, Callable[[Cursor], Statement | tuple[Statement, ...]]] = {
    NAME: _name_statement,
    CLOSED: parse_closed,
    "global": _global,
    "decl": parse_declaration,
    "struc": parse_struc,
    "enum": parse_enum,
    "signal": parse_signal,
    **dict.fromkeys(("spline", "ptp_spline"), _spline),
    **dict.fromkeys(MOTIONS, _motion),
    **dict.fromkeys(words("ext extfct import interrupt anout anin digin brake resume"), _kept),
}
