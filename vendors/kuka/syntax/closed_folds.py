"""Lines as the teach pendant shows closed folds: ``PTP P1 CONT Vel=50 % PDAT1``.

No controller takes them, but programs are handed on so. A motion says most of what its fold holds:
the point (``XP1``), the speed, tool and base; what its PDAT or LDAT says is not known.
"""

from __future__ import annotations

import re

from ....core.errors import Span
from . import tree
from .cursor import Cursor
from .lexer import CLOSED, MOTION_WORDS

_MOTION = re.compile(
    r"""(?P<seam> ARC_? (?: ON | SWI | OFF ) [ \t]+ \w+ [ \t]+ )?
    (?: (?P<arc> S?CIRC ) [ \t]+ (?P<via> \w+ ) | (?P<word> S?PTP | S?LIN ) ) [ \t]+
    (?P<point> \w+ ) (?P<cont> [ \t]+ CONT )?
    (?(seam) (?: .*? \b Vel [ \t]* = [ \t]* (?P<welding> [.\d]+ ) )?
      | [ \t]+ Vel [ \t]* = [ \t]* (?P<speed> [.\d]+ ) )
    .*? (?: \bTool \[ [ \t]* (?P<tool> \d+ ) .*? )?
    (?: \bBase \[ [ \t]* (?P<base> \d+ ) .*? )? $""",
    re.IGNORECASE | re.VERBOSE,
)
_SEAM = re.compile(r"ARC_?(?:ON|SWI|OFF)\b", re.IGNORECASE)
_ADDED = re.compile(r"(?:\]|\bC_(?:DIS|PTP|VEL|ORI))[ \t]+(?P<speed>VEL[ \t]*=[ \t]*[.\d]+)", re.I)
"""What only looks like a closed fold: these show neither an index nor ``C_DIS``."""
_WAIT = re.compile(r"WAIT[ \t]+Time[ \t]*=[ \t]*(?P<time>[.\d]+)", re.IGNORECASE)


def parse_closed(cursor: Cursor) -> tree.Statement:
    """The statement that a line stands for; what is no motion is kept.

    Raises:
        SourceError: a motion that says too little.
    """
    start, text = cursor.start, cursor.text
    cursor.advance()
    wait = _WAIT.match(text)
    if wait is not None:
        span = cursor.source.span(start, start + len(text))
        return tree.WaitSec(span, _number(cursor, start, wait, "time"))
    moves = re.match(MOTION_WORDS, text, re.IGNORECASE | re.VERBOSE) or _SEAM.match(text)
    if moves is None:
        return tree.Keyword(cursor.source.span(start, start + len(text.rstrip())), CLOSED)
    found = _MOTION.match(text.rstrip())
    added = _ADDED.search(text)
    if found is None and added is not None:
        raise cursor.source.error(
            f"a motion takes no {added['speed']} behind its target: set $VEL.CP (m/s) or "
            "$VEL_AXIS (%) before it",
            start,
        )
    if found is None:
        raise cursor.source.error(
            "this is a closed fold that does not say where its motion goes: open the fold and "
            "save the program with its lines",
            start,
        )
    return _motion(cursor, start, found)


def _motion(cursor: Cursor, start: int, found: re.Match[str]) -> tree.MotionInstruction:
    span = cursor.source.span(start, start + found.end())
    word = (found["word"] or found["arc"]).lower()
    joint = word.endswith("ptp")

    def setting(name: str, function: str, group: str) -> tree.Assign:
        path = ((tree.Number(cursor.source, start, start, 1),),) if name == "$vel_axis" else ()
        call = tree.Call(span, function, function.upper(), (_number(cursor, start, found, group),))
        return tree.Assign(span, tree.Name(span, name, name.upper(), path), call)

    speed = "welding" if found["seam"] else "speed"
    settings = []
    if found[speed]:
        name = ("$vel_axis", "svel_joint") if joint else ("$vel", "svel_cp")
        settings.append(setting(*name, speed))
    settings += [setting(f"${kind}", f"s{kind}", kind) for kind in ("tool", "base") if found[kind]]
    points = [found["via"]] if found["via"] else []
    return tree.MotionInstruction(
        span,
        word,
        tuple(_point(span, name) for name in (*points, found["point"])),
        None,
        None,
        ("c_dis",) if found["cont"] else (),
        cursor.source.span(span.end, span.end),
        tuple(settings),
    )


def _point(span: Span, name: str) -> tree.Name:
    """``P1`` is shown where the fold says ``XP1``."""
    text = name if name[0] in "xX" else f"X{name}"
    return tree.Name(span, text.lower(), text)


def _number(cursor: Cursor, start: int, found: re.Match[str], group: str) -> tree.Number:
    at, end = found.span(group)
    return tree.Number(cursor.source, start + at, start + end, float(found[group]))
