"""The modules of a backup as syntax trees, and which of their routines move the robot."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from ....core.errors import FlybyError, SourceError
from ....core.source.collection import collection_paused
from ....core.source.text.files import SourceText
from ..run.instructions import MOVING
from ..syntax import tree
from ..syntax.parser import parse
from ..syntax.traversal import calls_in, expressions_of
from .contents import Contents, EncodedError

_BY_NAME = "callbyvar"


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
        with collection_paused():
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
        names: of what it calls, instructions included, in lower case.
        late: beginnings of the names that it calls by text, in lower case.
    """

    names: set[str] = field(default_factory=set)
    late: set[str] = field(default_factory=set)


def moving_routines(files: Sequence[ModuleFile]) -> set[int]:
    """Identities of the routines that move the robot, or call one that does.

    What is called by a text (``%"part" + n%``) may be any routine whose name begins so.
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
    callers: dict[int, list[int]] = {}
    moving: list[int] = []
    for routine, own in routines:
        calls = _calls_of(routine)
        called = [found for name in calls.names if (found := own.get(name) or shared.get(name))]
        if calls.late:
            begins = tuple(calls.late)
            called += [one for name, one in shared.items() if name.startswith(begins)]
        for one in called:
            callers.setdefault(id(one), []).append(id(routine))
        foreign = calls.names - own.keys() - shared.keys()
        if foreign & MOVING:
            moving.append(id(routine))
    all_moving = set(moving)
    while moving:
        for caller in callers.get(moving.pop(), ()):
            if caller not in all_moving:
                all_moving.add(caller)
                moving.append(caller)
    return all_moving


def _calls_of(routine: tree.Routine) -> _Calls:
    calls = _Calls()
    bodies = [routine.body, *([] if routine.handler is None else [routine.handler.body])]
    for body in bodies:
        for statement in body.walk():
            for expression in expressions_of(statement):
                calls.names.update(call.name for call in calls_in(expression))
            if isinstance(statement, tree.Invoke):
                calls.names.add(statement.name)
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


def doubled(file: ModuleFile, taken: dict[str, str]) -> tuple[str, str] | None:
    """A name that a file declares anew for all modules, and the file that has it already.

    Args:
        file: to be loaded next.
        taken: lower-case names with the files that declare them; the file's own are added if it
            declares none anew.
    """
    own: dict[str, str] = {}
    for module in file.modules:
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
