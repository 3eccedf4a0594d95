"""docs/reference/commands.md and python.md hold what commands and calls say of themselves.

`python tests/testing/test_commands_pages.py` writes them anew.
"""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

import flyby
from flyby.cli.main import COMMANDS, app

REFERENCE = Path(__file__).parents[2] / "docs" / "reference"
DISTINCTLY = str.maketrans({"|": "\\|", "<": "&lt;", "*": "\\*", "[": "\\[", "_": "\\_"})
OPTIONS = "\nOptions:\n"


def commands() -> Iterator[str]:
    """The commands in the order of the help, each with its arguments and options."""
    known = get_command(app).commands  # type: ignore[attr-defined]
    assert set(known) == set(COMMANDS)
    for name in COMMANDS:
        command = known[name]
        arguments = [p for p in command.params if p.param_type_name == "argument"]
        options = [p for p in command.params if p not in arguments and "--help" not in p.opts]
        words = " ".join(
            ([p.metavar or p.name.upper() for p in arguments]) + (["[options]"] if options else [])
        )
        yield f"## flyby {name}\n"
        yield f"`flyby {name} {words}`\n"
        yield " ".join(inspect.cleandoc(command.help or "").split()).translate(DISTINCTLY) + "\n"
        yield "| option | meaning |\n|---|---|"
        for parameter in (*arguments, *options):
            yield row(parameter)
        yield ""


def row(parameter: Any) -> str:
    """An argument or option of a command."""
    flags = ", ".join(f"`{flag}`" for flag in parameter.opts if flag.startswith("-"))
    told = (parameter.help or "").translate(DISTINCTLY)
    if parameter.param_type_name == "option" and parameter.required:
        told += " Must be given."
    usual = parameter.default
    if isinstance(usual, int | float | str) and not isinstance(usual, bool) and usual != "":
        told += f" Default: {usual:g}." if isinstance(usual, int | float) else f" Default: {usual}."
    return f"| {flags or '`' + (parameter.metavar or parameter.name.upper()) + '`'} | {told} |"


def calls() -> Iterator[str]:
    """The calls of the front door with their arguments, in alphabetical order."""
    for name in flyby.__all__:
        call = getattr(flyby, name)
        text = inspect.getdoc(call) or ""
        own, _, options = text.partition(OPTIONS)
        given = list(inspect.signature(call).parameters) if callable(call) else []
        named = names_of(options)
        first = ", ".join(word for word in given if word not in named and word != "report")
        more = ", …" if named and first else "…" if named else ""
        yield f"## flyby.{name}\n"
        yield f"`flyby.{name}({first}{more})`\n"
        yield from prose(own)
        if named:
            yield "\n| keyword | meaning |\n|---|---|"
            for word, meaning in named.items():
                yield f"| `{word}` | {meaning.translate(DISTINCTLY)} |"
        yield ""


def names_of(options: str) -> dict[str, str]:
    """Keywords and what they mean, of the last part of a docstring."""
    found: dict[str, str] = {}
    for line in options.splitlines():
        if match := re.match(r"    (\w+): (.*)", line):
            word = match[1]
            found[word] = match[2]
        elif line.strip():
            found[word] += " " + line.strip()
    return found


def prose(text: str) -> Iterator[str]:
    """A docstring as Markdown: its parts become lists."""
    for block in re.split(r"\n\n+", text.strip()):
        head, _, rest = block.partition("\n")
        if head.endswith(":") and rest.startswith("    "):
            yield f"\n*{head[:-1]}*\n"
            items = re.split(r"\n    (?! )", "\n" + rest)[1:]
            for item in items:
                yield f"- {' '.join(item.split())}".translate(DISTINCTLY)
        else:
            yield f"\n{' '.join(block.split())}".translate(DISTINCTLY)


PAGES: dict[str, Callable[[], Iterator[str]]] = {"commands.md": commands, "python.md": calls}


def beginning(page: str) -> str:
    """What is written by hand, before the first heading of a command."""
    return (REFERENCE / page).read_text("utf-8").partition("\n## ")[0].rstrip("\n")


def made(page: str) -> str:
    text = beginning(page) + "\n\n" + "\n".join(PAGES[page]())
    return re.sub(r"\n{3,}", "\n\n", text).rstrip("\n") + "\n"


@pytest.mark.parametrize("page", PAGES)
def test_the_page_says_what_the_code_says(page: str) -> None:
    # In a process of its own: what texts call options depends on who imports them first.
    fresh = subprocess.run(
        [sys.executable, __file__, page], check=True, capture_output=True, encoding="utf-8"
    )
    assert (REFERENCE / page).read_text("utf-8") == fresh.stdout


def test_every_option_of_a_call_is_on_the_page() -> None:
    page = (REFERENCE / "python.md").read_text("utf-8")
    for name in flyby.__all__:
        (section,) = re.findall(rf"(?ms)^## flyby\.{name}$(.*?)(?=^## |\Z)", page)
        call = getattr(flyby, name)
        given = inspect.signature(call).parameters.values() if callable(call) else ()
        options = {p.name for p in given if p.kind is p.KEYWORD_ONLY and "Options:" in call.__doc__}
        options -= {"report", "found"}  # are called with what is being done and found
        assert options <= set(re.findall(r"(?m)^\| `(\w+)`", section)), name


if __name__ == "__main__":
    if sys.argv[1:]:
        sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
        sys.stdout.write(made(sys.argv[1]))
    else:
        for page in PAGES:
            (REFERENCE / page).write_text(made(page), "utf-8")
