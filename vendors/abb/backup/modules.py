"""The modules of a backup as syntax trees, and which of their routines move the robot."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from ....core.errors import FlybyError, SourceError
from ....core.source.text.files import SourceText
from ..run.instructions import MOVING
from ..syntax import tree
from ..syntax.parser import parse
from ..syntax.traversal import calls_in, expressions_of
from .contents import Contents, EncodedError

_BY_NAME = "callbyvar"
_LOADS = frozenset({"load", "startload"})
_MOST_STEPS = 2_000_000
"""From routine to routine, beyond which moves of routines called are not counted any more."""


@dataclass(frozen=True)
class ModuleFile:
    """A file with modules.

    Args:
        name: below the backup's root.
        modules: that it holds; none if it cannot be read.
        encoded: whether only the controller can read it.
        fault: why it cannot be read, if it is not encoded.
        line: of the fault.
    """

    name: str
    modules: tuple[tree.Module, ...] = ()
    encoded: bool = False
    fault: str = ""
    line: int = 1

    @property
    def routines(self) -> list[tree.Routine]:
        """Of all its modules."""
        return [routine for module in self.modules for routine in module.routines]


class ModuleFiles:
    """Files of a backup, each parsed once."""

    def __init__(self, contents: Contents) -> None:
        self._contents = contents
        self._files: dict[str, ModuleFile] = {}

    def read(self, names: Iterable[str]) -> list[ModuleFile]:
        """The files of these names."""
        return [self._read(name) for name in names]

    def _read(self, name: str) -> ModuleFile:
        if name not in self._files:
            self._files[name] = self._parsed(name)
        return self._files[name]

    def _parsed(self, name: str) -> ModuleFile:
        try:
            source = self._contents.source(name)
            return ModuleFile(name, parse(SourceText(source.text, name)))
        except EncodedError:
            return ModuleFile(name, encoded=True)
        except SourceError as error:
            line = 1 if error.span is None else error.span.line
            return ModuleFile(name, fault=error.message, line=line)
        except FlybyError as error:
            return ModuleFile(name, fault=str(error).rpartition(f"{name}: ")[2])
        except RecursionError:
            return ModuleFile(name, fault="expressions, blocks and calls are nested too deeply")


@dataclass
class _Calls:
    """What a routine calls.

    Args:
        names: in lower case, instructions included, with how often each is called.
        late: beginnings of the names that it calls by text, in lower case.
    """

    names: Counter[str] = field(default_factory=Counter)
    late: set[str] = field(default_factory=set)


def moving_routines(files: Sequence[ModuleFile]) -> dict[int, int]:
    """How many statements move the robot, of the routines that do or that call one that does.

    Those of a routine and of all that it calls are counted, each once. What is called by a text
    (``%"part" + n%``) may be any routine whose name begins so.

    Returns:
        Counts by the identity of the routine.
    """
    shared: dict[str, tree.Routine] = {}
    routines: list[tuple[tree.Routine, dict[str, tree.Routine]]] = []
    for file in files:
        for module in file.modules:
            own = {routine.name: routine for routine in module.routines}
            for routine in module.routines:
                if not routine.local:
                    shared.setdefault(routine.name, routine)
                routines.append((routine, own))
    called: dict[int, list[int]] = {}
    direct: dict[int, int] = {}
    for routine, own in routines:
        calls = _calls_of(routine)
        found = [one for name in calls.names if (one := own.get(name) or shared.get(name))]
        if calls.late:
            begins = tuple(calls.late)
            found += [one for name, one in shared.items() if name.startswith(begins)]
        called[id(routine)] = [id(one) for one in found]
        foreign = MOVING & calls.names.keys() - own.keys() - shared.keys()
        direct[id(routine)] = sum(calls.names[name] for name in foreign)
    return _reached(called, direct)


def _reached(called: dict[int, list[int]], direct: dict[int, int]) -> dict[int, int]:
    """The moves of each routine with those of all that it calls, where there are any."""
    callers: dict[int, list[int]] = {}
    for caller, others in called.items():
        for one in others:
            callers.setdefault(one, []).append(caller)
    moving = _from([one for one, count in direct.items() if count], callers)
    left = _MOST_STEPS
    counts: dict[int, int] = {}
    for one in moving:
        if left > 0:
            reached = _from([one], called)
            left -= len(reached)
            counts[one] = sum(direct[other] for other in reached)
        else:
            counts[one] = max(1, direct[one])
    return counts


def _from(begin: Sequence[int], ways: dict[int, list[int]]) -> list[int]:
    """All that can be reached, what it begins with included."""
    found, todo = dict.fromkeys(begin), list(begin)
    while todo:
        for one in ways.get(todo.pop(), ()):
            if one not in found:
                found[one] = None
                todo.append(one)
    return list(found)


def _calls_of(routine: tree.Routine) -> _Calls:
    calls = _Calls()
    bodies = [routine.body, *([] if routine.handler is None else [routine.handler.body])]
    for body in bodies:
        for statement in body.walk():
            for expression in expressions_of(statement):
                for call in calls_in(expression):
                    calls.names[call.name] += 1
            if isinstance(statement, tree.Invoke):
                calls.names[statement.name] += 1
                if statement.name == _BY_NAME and statement.arguments:
                    calls.late.add(_beginning(statement.arguments[0].value))
            elif isinstance(statement, tree.LateInvoke):
                calls.late.add(_beginning(statement.routine))
    return calls


def _beginning(text: tree.Expression | None) -> str:
    """What a text begins with; nothing where only a run can tell."""
    if isinstance(text, tree.Operation):
        text = text.first
    return text.value.lower() if isinstance(text, tree.Text) else ""


def loaded_at_runtime(file: ModuleFile) -> Iterator[str]:
    """Files below the backup's root that a module loads when it runs, as far as texts say which.

    ``Load "HOME:/prog" \\File:="TYPE1.MOD"``; what is on other disks no backup has.
    """
    for routine in file.routines:
        for statement in routine.body.walk():
            if isinstance(statement, tree.Invoke) and statement.name in _LOADS:
                texts = [_path(argument.value) for argument in statement.arguments]
                disk, _, path = "/".join(filter(None, texts)).replace("\\", "/").partition(":")
                folders = [part for part in path.split("/") if part]
                if disk.casefold() == "home" and folders:
                    yield "/".join(["HOME", *folders])


def _path(value: tree.Expression | None) -> str:
    """What an argument says of a file's place; nothing where only a run can tell."""
    if isinstance(value, tree.Name) and value.name == "diskhome":
        return "HOME:"
    return value.value if isinstance(value, tree.Text) else ""


def doubled(file: ModuleFile, taken: dict[str, str]) -> tuple[str, str] | None:
    """A name that a file declares anew for all modules, and the file that has it already.

    Args:
        file: to be loaded next.
        taken: lower-case names with the files that declare them; the file's own are added if it
            declares none anew.
    """
    own: dict[str, str] = {}
    for module in file.modules:
        for record in module.types:
            parts = Counter(name for _, name in getattr(record, "components", ()))
            if parts and max(parts.values()) > 1:
                return f"{record.name}.{parts.most_common(1)[0][0]}", file.name
        inner: set[str] = set()
        for item in (module, *module.routines, *module.declarations, *module.types):
            key = f"module {module.name}" if item is module else item.name
            if item is not module and getattr(item, "local", False):
                if key in inner:
                    return getattr(item, "text", item.name), file.name
                inner.add(key)
                continue
            if key in taken or key in own:
                return getattr(item, "text", item.name), taken.get(key, file.name)
            own[key] = file.name
    taken.update(own)
    return None
