"""Modules that stand beside a program and are taken in when one of their names is missed.

On a controller all modules of a task share one name space. A folder on disk may hold the modules
of one program, of several, and old copies; so a module is taken in only if it alone declares a
name that the program lacks, and if a controller could load it beside what is there already.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PureWindowsPath

from ....core.errors import Note, SourceError, Span
from ....core.source.text.damage import Damage
from ....core.source.text.files import SourceFile, SourceText, unbroken
from ..syntax.parser import parse
from ..syntax.tree import Module

_DECLARED = re.compile(
    r"""![^\r\n]*|"[^"\r\n]*"
      | (?<![\w.]) (?: (?P<end> END(?:PROC|FUNC|TRAP) )
      | (?: PROC | TRAP | RECORD | FUNC\s+\w+ | ALIAS\s+\w+ ) \s+ (?P<routine> \w+ )
      | (?: CONST | VAR | PERS ) \s+ \w+ \s+ (?P<datum> \w+ ) )""",
    re.VERBOSE | re.IGNORECASE,
)


@dataclass
class _Shelved:
    """A file that may be taken in."""

    file: SourceFile
    damage: Damage | None = None
    modules: tuple[Module, ...] | None = None
    error: SourceError | None = None

    def parsed(self) -> tuple[Module, ...]:
        if self.modules is None and self.error is None:
            try:
                self.modules = parse(SourceText(self.file.text, self.file.name, self.damage))
            except SourceError as error:
                self.error = error
        return self.modules or ()


class Library:
    """Files that are parsed only if they may declare a name that is missed.

    Args:
        files: by name.
        loaded: whether the controller has all of them loaded, as a backup says: taking one in is
            then nothing to speak of.
        mended: whether what is no statement is stepped over.
    """

    def __init__(
        self, files: Mapping[str, SourceFile], *, loaded: bool = False, mended: bool = False
    ) -> None:
        self._loaded = loaded
        self._shelf = {
            name: _Shelved(file, Damage() if mended else None) for name, file in files.items()
        }
        self._index: dict[str, list[str]] | None = None
        self._reasons: dict[str, str] = {}

    def take(
        self, name: str, span: Span, modules: set[str], taken: set[str]
    ) -> tuple[tuple[Module, ...], Note | None] | None:
        """The modules of the only file that declares a name, and what to say about it, if anything.

        Args:
            name: lower case.
            span: where it is missed.
            modules, taken: lower-case names of the modules and of their global declarations that
                are there already.

        Raises:
            SourceError: several files declare it, or the only one cannot be parsed.
        """
        if not self._shelf:
            return None
        candidates = self._names().get(name, [])
        fitting = [file for file in candidates if self._fits(file, name, modules, taken)]
        if len(fitting) > 1:
            fitting = self._called_so(fitting)
        if len(fitting) > 1:
            raise SourceError(
                f"'{name}' is declared in {' and in '.join(fitting)}: name the file that belongs "
                "to this program, or move the other one away",
                span,
            )
        if not fitting:
            for file in candidates:
                error = self._shelf[file].error
                if error is not None and name not in self._reasons:
                    raise error
            return None
        shelved = self._shelf.pop(fitting[0])
        names = ", ".join(module.text for module in shelved.parsed())
        message = f"module {names} of {fitting[0]} is taken in: it declares '{name}'"
        return shelved.parsed(), None if self._loaded else Note(message, span=span)

    def hint(self, name: str) -> str | None:
        """Why a file that declares a name was not taken in."""
        return self._reasons.get(name)

    def _fits(self, file: str, name: str, modules: set[str], taken: set[str]) -> bool:
        shelved = self._shelf.get(file)
        found = shelved.parsed() if shelved is not None else ()
        own = global_names(found)
        if name not in own:
            return False
        double = sorted(own & taken)
        again = [module.text for module in found if module.name in modules]
        if again:
            self._reasons[name] = f"{file} declares it, but is another module {again[0]}"
        elif double:
            self._reasons[name] = f"{file} declares it, but also declares {double[0]} anew"
        return not again and not double

    def _called_so(self, files: list[str]) -> list[str]:
        """Of several states of one module the one whose file is called like it; else all."""
        declared = {tuple(m.name for m in self._shelf[file].parsed()) for file in files}
        if len(declared) > 1:
            return files
        (names,) = declared
        own = [file for file in files if PureWindowsPath(file).stem.lower() in names]
        return own if len(own) == 1 else files

    def _names(self) -> dict[str, list[str]]:
        if self._index is None:
            self._index = {}
            for file, shelved in self._shelf.items():
                for name in _declared(shelved.file.text):
                    self._index.setdefault(name, []).append(file)
        return self._index


def global_names(modules: tuple[Module, ...]) -> set[str]:
    """Lower-case names that modules declare for all."""
    return {
        item.name
        for module in modules
        for item in (*module.routines, *module.declarations, *module.types)
        if not item.local
    }


def _declared(text: str) -> set[str]:
    """Names that a text seems to declare outside its routines, without parsing it."""
    names: set[str] = set()
    inside = False
    for found in _DECLARED.finditer(unbroken(text)):
        kind = found.lastgroup
        if kind == "end":
            inside = False
        elif kind == "routine":
            names.add(found["routine"].lower())
            inside = found[0][:4].lower() in ("proc", "func", "trap")
        elif kind == "datum" and not inside:
            names.add(found["datum"].lower())
    return names
