"""docs/reference/kit.md lists what plugins of line languages are made of, by import path.

`python tests/testing/test_kit_page.py` writes it anew.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from enum import Enum
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Protocol

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "kit.md"
GUIDE = Path(__file__).parents[2] / "docs" / "guides" / "plugins.md"
MODULES = (
    *(
        f"flyby.core.source.lines.{name}"
        for name in (
            *("language", "driving", "forms", "statements", "program", "expressions"),
            *("positions", "postures", "motions", "settings", "amounts", "moves", "signals"),
        )
    ),
    *("flyby.core.source.text.files", "flyby.core.source.text.numerals"),
    *("flyby.core.source.patch.uses", "flyby.core.dialect", "flyby.core.plugins.speaking"),
    *("flyby.core.program.zone", "flyby.core.program.speed", "flyby.core.program.move"),
    *("flyby.core.program.target", "flyby.core.program.tool", "flyby.core.program.signal"),
    *("flyby.core.spatial.pose", "flyby.core.vendor", "flyby.core.hookspec"),
)
HEAD = """\
# The kit's names

What plugins of line languages are made of ([plugins.md](../guides/plugins.md)), by the module that
it is imported from; written by `tests/testing/test_kit_page.py`. Each name's own docstring says
more. Types of functions and tables stand beside them: `Build` in `statements`, `Moved` in
`driving`, `Said` and `Initial` in `program`, `Units` in `amounts`.
"""


def lines() -> Iterator[str]:
    yield from HEAD.splitlines()
    for name in MODULES:
        module = import_module(name)
        yield from ("", f"## `{name}`", "", _first(module.__doc__), "", "| name | what it is |")
        yield "|---|---|"
        for own, one in public(module):
            yield f"| `{own}{_taken(one)}` | {_first(one.__doc__)} |"
            for method, said in _methods(one):
                yield f"| `{own}.{method}` | {said} |"


def public(module: ModuleType) -> Iterator[tuple[str, object]]:
    """Classes and functions of a module's own, in its order."""
    for name, one in vars(module).items():
        own = getattr(one, "__module__", "") == module.__name__
        if own and not name.startswith("_") and (inspect.isclass(one) or inspect.isfunction(one)):
            yield name, one


def _methods(one: object) -> Iterator[tuple[str, str]]:
    for name, method in vars(one).items() if inspect.isclass(one) else ():
        given = getattr(method, "fget", None) or getattr(method, "func", None) or method
        given = getattr(given, "__func__", given)
        if not name.startswith("_") and inspect.isfunction(given) and given.__doc__:
            taken = (
                "" if given is not method and not isinstance(method, classmethod) else _taken(given)
            )
            yield f"{name}{taken}", _first(given.__doc__)


def _taken(one: object) -> str:
    """What is handed over, by name; of enumerations nothing."""
    if inspect.isclass(one) and (issubclass(one, Enum) or Protocol in one.__mro__):
        return ""
    names = inspect.signature(one).parameters.values()
    stars = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    shown = (f"{stars.get(p.kind, '')}{p.name}" for p in names if p.name not in ("self", "cls"))
    return f"({', '.join(shown)})"


def _first(said: str | None) -> str:
    """The first sentence, or sentences, before a blank line, fit for a table."""
    text = " ".join(inspect.cleandoc(said or "").split("\n\n")[0].split())
    return text.replace("|", r"\|")


def test_the_page_lists_them() -> None:
    assert PAGE.read_text("utf-8") == "\n".join([*lines(), ""])


def test_names_of_the_guide_are_on_it() -> None:
    """Those that its sentences use without an import of theirs."""
    text = PAGE.read_text("utf-8")
    for name in ("UseKind", "Placed", "Operand", "PostureLetters", "ZoneKind", "counted_on"):
        assert f"`{name}" in GUIDE.read_text("utf-8") or name == "UseKind"
        assert f"| `{name}" in text, name
    for name in ("Build", "Moved", "Said", "Units"):
        assert f"`{name}`" in text, name


if __name__ == "__main__":
    PAGE.write_text("\n".join([*lines(), ""]), "utf-8")
