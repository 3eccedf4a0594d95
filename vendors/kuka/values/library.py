"""The files of a program: which routines and data they hold, found by name when asked for.

A ``.src`` and the ``.dat`` of the same name are one module: its data are seen by its routines. From
elsewhere a module's routine is found if it is called like its file or declared ``GLOBAL``, and a
datum if it is declared ``GLOBAL``. ``$CONFIG.DAT`` is seen from everywhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import resources

from ....core.errors import Note, SourceError
from ....core.source.reading import Files
from ....core.source.text.damage import Damage
from ....core.source.text.files import SourceText
from ..syntax.parser import parse
from ..syntax.tree import Declaration, Routine, Unit
from .scope import Module

CONFIG = "$config"
SHIPPED = "flyby:config.dat"
"""Name of the configuration that comes with this package, for spans."""
_GLOBAL_ROUTINE = re.compile(r"(?im)^[ \t]*global[ \t]+def(?:fct[ \t]+\S+)?[ \t]+([\w$]+)")
_GLOBAL_DATA = re.compile(r"(?im)^[ \t]*(?:decl[ \t]+)?(?:const[ \t]+)?global[ \t]+(?!def)")


def stem_of(name: str) -> str:
    """File name without folder and suffix, nor the brackets of a call, lower case."""
    return (
        _without_text(name.replace("\\", "/").rpartition("/")[2])
        .rpartition(".")[0]
        .removesuffix("()")
    )


def _without_text(name: str) -> str:
    """A name in lower case; of a file that was saved as text (``main.src.txt``) its own."""
    lower = name.lower()
    own = lower.removesuffix(".txt")
    return own if own.endswith((".src", ".dat", ".sub")) else lower


def _folder(name: str) -> str:
    return name.replace("\\", "/").rpartition("/")[0]


def suffix_of(name: str) -> str:
    """Suffix of a file name with its dot, lower case."""
    return "." + _without_text(name).rpartition(".")[2]


class Library:
    """All modules within reach.

    Args:
        main: name of the file with the entry.
        mended: whether what is no statement is stepped over.

    Attributes:
        damages: of the files that have been read, where they are mended.

    Raises:
        SourceError: the main file or its data list is no KRL.
    """

    def __init__(self, files: Files, main: str, mended: bool = False) -> None:
        self._files = files
        self._mended = mended
        self.damages: list[Damage] = []
        self._modules: dict[str, Module] = {}
        self._sources: dict[str, list[str]] = {}
        for name in files:
            if suffix_of(name) in (".src", ".dat", ".sub") and name != main:
                self._sources.setdefault(stem_of(name), []).append(name)
        self._held: dict[tuple[str, re.Pattern[str]], bool] = {}
        self.notes: list[Note] = []
        self.texts: dict[str, str] = {}
        self.main_unit = self._parse(main)
        self.main = self._main_module(main)
        self.config = self._config(main)

    # ---------------------------------------------------------------------- modules

    def module(self, stem: str) -> Module | None:
        """The module of a name; a file of it that cannot be read is left out with a note."""
        stem = stem.lower()
        if stem not in self._modules and stem in self._sources:
            module = self._modules[stem] = Module(stem)
            for name in self._beside_main(self._sources[stem]):
                try:
                    self._add(module, self._parse(name))
                except SourceError as error:
                    self.notes.append(Note(f"{name} cannot be read and is left out: {error}"))
        return self._modules.get(stem)

    def modules(self) -> Iterator[Module]:
        """All that have been read."""
        return iter(self._modules.values())

    def home(self, stem: str) -> Module:
        """A module that has been read."""
        return self._modules[stem]

    def _main_module(self, main: str) -> Module:
        stem = stem_of(main)
        module = self._modules[stem] = Module(stem)
        self._add(module, self.main_unit)
        data = [n for n in self._sources.get(stem, ()) if suffix_of(n) == ".dat"]
        for name in self._beside(main, data)[:1]:
            self._add(module, self._parse(name))
        return module

    @staticmethod
    def _beside(main: str, names: list[str]) -> list[str]:
        """Those in the main file's own folder first."""
        return sorted(names, key=lambda name: _folder(name) != _folder(main))

    @staticmethod
    def _beside_main(names: list[str]) -> list[str]:
        """One .src and one .dat of a module, the first of each."""
        found: dict[str, str] = {}
        for name in names:
            found.setdefault(suffix_of(name), name)
        return list(found.values())

    def _add(self, module: Module, unit: Unit) -> None:
        for routine in unit.routines:
            module.routines.setdefault(routine.name, routine)
        module.lists += unit.lists
        self.notes += unit.notes

    def _parse(self, name: str) -> Unit:
        file = self._files[name]
        self.texts[name] = file.text
        damage = Damage() if self._mended else None
        try:
            unit = parse(SourceText(file.text, name, damage))
        except RecursionError:
            source = SourceText(file.text, name)
            raise source.error("expressions and blocks are nested too deeply", 0) from None
        if damage is not None:
            self.damages.append(damage)
        return unit

    def _config(self, main: str) -> list[Module]:
        """The user's ``$CONFIG.DAT``, if there is one, and the one that is shipped."""
        modules = []
        users = self.module(CONFIG)
        if users is not None:
            modules.append(users)
            self._tell_config(main)
        text = resources.files(__package__).joinpath("../data/config.dat").read_text("utf-8")
        shipped = self._modules[SHIPPED] = Module(SHIPPED)
        self._add(shipped, parse(SourceText(text, SHIPPED)))
        self.texts[SHIPPED] = text
        return [*modules, shipped]

    def _tell_config(self, main: str) -> None:
        """Which of several ``$CONFIG.DAT`` is taken: that of another cell has other bases."""
        found = [name for name in self._sources[CONFIG] if suffix_of(name) == ".dat"]
        others = [n for n in found[1:] if self._files[n].text != self._files[found[0]].text]
        if others and _folder(found[0]) != _folder(main):
            self.notes.append(
                Note(
                    f"{len(others) + 1} differing $config.dat lie around the program: tools and "
                    f"bases are those of {found[0]}, not of {', '.join(others)}; put the right one "
                    "beside the program"
                )
            )

    # ------------------------------------------------------------------------ look-ups

    def routine(self, name: str, module: Module) -> tuple[Routine, Module] | None:
        """The routine that a call in a module means."""
        own = module.routines.get(name)
        if own is not None:
            return own, module
        if module is not self.main and (name == self.main.stem):
            found = self.main.routines.get(name)
            if found is not None:
                return found, self.main
        other = self.module(name)
        if other is not None and name in other.routines:
            return other.routines[name], other
        for candidate in self._candidates(_GLOBAL_ROUTINE):
            found = candidate.routines.get(name)
            if found is not None and found.shared:
                return found, candidate
        return None

    def global_modules(self) -> Iterator[Module]:
        """Modules that declare data for everybody."""
        return self._candidates(_GLOBAL_DATA)

    def keeper_of(self, name: str) -> str | None:
        """The file that declares a datum for its own program alone; for messages."""
        declared = re.compile(rf"(?im)^[^;\r\n]*\b{re.escape(name)}\b")
        for module in self._candidates(declared):
            for data_list in module.lists:
                for statement in data_list.body.statements:
                    if isinstance(statement, Declaration) and statement.name == name.lower():
                        return data_list.span.file
        return None

    def routine_names(self, module: Module) -> set[str]:
        """Names of routines that can be called from a module, for messages."""
        names = {r.text for r in module.routines.values()}
        return names | {stem for stem in self._sources if not stem.startswith("$")}

    def _candidates(self, pattern: re.Pattern[str]) -> Iterator[Module]:
        yield self.main
        for stem, names in list(self._sources.items()):
            if any(self._holds(name, pattern) for name in names):
                module = self.module(stem)
                if module is not None and module is not self.main:
                    yield module

    def _holds(self, name: str, pattern: re.Pattern[str]) -> bool:
        key = (name, pattern)
        if key not in self._held:
            self._held[key] = pattern.search(self._files[name].text) is not None
        return self._held[key]
