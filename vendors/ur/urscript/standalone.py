"""Whether statements that were kept as text can stand in a script of their own.

They may name variables, functions and threads of the script that they were read from, which a
written one does not have: a controller would not load it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ....core.errors import SourceError
from ....core.program.move import Opaque
from ....core.program.program import Program
from ....core.source.options import AS_COMMENTS
from ....core.source.reading import Files, Reading
from ....core.source.text import SourceFile
from .lexer import NAME, Tokens, tokenize
from .texts import Texts

_DEFINING = ("def", "sec", "thread", "global", "local")


def check_kept(program: Program, declared: Iterable[str]) -> None:
    """Refuse statements that name what only their own script has.

    Args:
        program: whose kept statements are to be written.
        declared: names that the new script has.

    Raises:
        SourceError: naming the statement and the name.
    """
    if not isinstance(program.reading, Reading):
        return
    missing = _defined(program.reading.files) - set(declared)
    for statement in program.statements:
        if isinstance(statement, Opaque):
            missing -= _check(statement, missing)


def _check(statement: Opaque, missing: set[str]) -> set[str]:
    """The names that the statement defines itself."""
    try:
        names = list(_names(SourceFile("kept", statement.text)))
    except SourceError:
        return set()  # of another language: it is not for us to judge
    own: set[str] = set()
    for name, defines in names:
        if defines:
            own.add(name)
        elif name in missing - own:
            raise SourceError(
                f"this statement is kept as it stands, and names {name!r}, which the new script "
                "does not have: patch the script that was read, or make kept statements comments "
                f"({AS_COMMENTS})",
                statement.span,
            )
    return own


def _defined(files: Files) -> set[str]:
    """All that the files give a name to."""
    return {name for file in files.values() for name, defines in _names(file) if defines}


def _names(file: SourceFile) -> Iterator[tuple[str, bool]]:
    """Names in order, and whether each is defined there; names of arguments are left out."""
    tokens = tokenize(Texts([file]), 0)
    kinds = tokens.kinds
    depth = head = 0
    for index, kind in enumerate(kinds):
        if kind in ("(", "["):
            depth += 1
        elif kind in (")", "]"):
            depth -= 1
            head = min(head, depth)
        elif kind == NAME:
            before = kinds[index - 1] if index else ""
            assigned = kinds[index + 1] == "="
            if before in _DEFINING:
                head = depth + 1 if before in _DEFINING[:3] else head
                yield _text(tokens, index), True
            elif head and depth == head:
                yield _text(tokens, index), before in ("(", ",")  # a parameter
            elif depth == 0 or not assigned:
                yield _text(tokens, index), assigned


def _text(tokens: Tokens, index: int) -> str:
    return tokens.text[tokens.starts[index] - tokens.base : tokens.ends[index] - tokens.base]
