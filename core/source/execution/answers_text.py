"""What a program asks, as a file of answers that changes nothing until it is edited."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from ...files.toml_text import key_text, value_text
from ...program.question import Answer, Question, QuestionKind
from .answers import Fields

_TABLES = {
    "values": "stays so; a name or a call as it stands in the program",
    "sequences": "one answer after the other; the last one stays",
    "branches": "at a line: the branch taken, 1 for the first, 0 for ELSE or none",
    "passes": "at a line: how often a loop runs",
    "calls": "routines whose text is not at hand, and that move nothing",
    "streams": "a file of joints over time (CSV: time,j1,j2,… in s and degrees) that drives there",
    "durations": "s that the robot stands at a call, a wait or an output; a signal's name will do",
}
_HEAD = """\
# What {name} asks that no file says. This file changes nothing as it is: what is taken for
# granted stands in it, and what is not known, or decided by rule, is put behind a #. Take the #
# away and put a value in; structures may be tables {{ x = 1 }}, arrays [1, 2] or texts as the
# program writes them.
# What is read again and again has answers in turn in [sequences]: a list for each name.
"""
FOUND = "found by trying, and not measured"
"""Said of what is taken for a frame or a tool with which a program can be driven."""
_HEAD_FOUND = """\
# But what is "{found}" holds as it stands: put in what it is.
"""
_LONGEST = 90


def answers_text(questions: Sequence[Question], name: str) -> str:
    """A file of answers (TOML).

    Args:
        questions: of a program, as `Program.questions` has them.
        name: of the program, for the first line.
    """
    lines = [_HEAD.format(name=" ".join(name.split()))]
    if any(question.meanwhile.startswith(FOUND) for question in questions):
        lines = [lines[0] + _HEAD_FOUND.format(found=FOUND)]
    several = len({question.span.file for question in questions}) > 1
    for table, about in _TABLES.items():
        mine = [q for q in questions if q.table == table]
        if not mine:
            continue
        lines.append(f"[{table}]  # {about}")
        for kind in QuestionKind:
            group = [q for q in mine if q.kind is kind]
            if group and table == "values":
                lines.append(f"# -- {kind.value} --")
            for question in group:
                lines += _entry(question, several)
        lines.append("")
    if len(lines) == 1:
        lines.append("# It asks nothing.\n")
    return "\n".join(lines)


def grouped(questions: Sequence[Question]) -> list[str]:
    """A line a kind: how many, and the first of them with its place."""
    told = []
    for kind in QuestionKind:
        group = [q for q in questions if q.kind is kind and not q.answered]
        if group:
            first = group[0]
            named = first.key if len(first.key) <= _LONGEST else f"{first.key[:_LONGEST]}…"
            at = f"{first.span.file}:{first.span.line}"
            placed = first.table in _BY_RULE or at.casefold().endswith(first.key)
            shown = at if placed else f"{named} ({at})"
            more = f" and {len(group) - 1} more" if len(group) > 1 else ""
            told.append(f"{kind.value}: {shown}{more}")
    return told


_BY_RULE = ("branches", "passes")
"""Tables of what is decided by rule where nobody says it."""


def _name(question: Question) -> str:
    """Of the file in which it is asked."""
    return question.span.file.replace("\\", "/").rpartition("/")[2]


def counts(questions: Sequence[Question]) -> Counter[QuestionKind]:
    """How many of each kind nobody has answered."""
    return Counter(q.kind for q in questions if not q.answered)


def _entry(question: Question, several: bool) -> list[str]:
    """A comment and the answer: what holds, or an example behind a #.

    Args:
        question: what is asked.
        several: whether the program has several files.
    """
    where = f"{_name(question)}:{question.span.line}" if several else f"line {question.span.line}"
    times = f"asked {question.count} times" if question.count > 1 else ""
    told = [question.type, question.meanwhile, _compared(question), times]
    about = "; ".join(" ".join(part.split()) for part in told if part)
    line = f"{key_text(question.key)} = "
    if question.taken is not None:
        line += answer_text(question.taken)
        if question.table in _BY_RULE and not question.answered:
            line = f"#{line}"  # nothing is proven of a way that nobody has said
    else:
        example: Answer = 0.0 if question.example is None else question.example
        line = f"#{line}{answer_text(example)}"
    return [f"# {where}{f': {about}' if about else ''}", line]


def _compared(question: Question) -> str:
    """What the program compares it with."""
    shown = ", ".join(answer_text(one) for one in question.compared)
    return f"compared with {shown}" if shown else ""


def answer_text(answer: Answer) -> str:
    """An answer as it is put into a file."""
    return value_text(_plain(answer))


def _plain(answer: Answer) -> object:
    """An answer as TOML has it; whole numbers without a point."""
    if isinstance(answer, Fields):
        return {name: _plain(part) for name, part in answer}
    if isinstance(answer, tuple):
        return [_plain(part) for part in answer]
    if isinstance(answer, float) and answer.is_integer() and abs(answer) < 1e15:
        return int(answer)
    return answer
