"""Faults of plugins, named as theirs: what fails of one hinders no other."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from ..errors import FlybyError, InputError, PluginFault
from ..robot.arm_list import Listed
from ..vendor import LANGUAGE_PARTS, Vendor
from .loading import Offers

if TYPE_CHECKING:
    from ..robot.model import Robot

_log = logging.getLogger("flyby")
Value = TypeVar("Value")
_METHODS = ("read", "read_file", "write", "patch", "record", "usual_period", "steps", "recognises")
"""Of the parts of a language (`core.language`)."""


def guarded(offers: Offers, owner: str) -> Offers:
    """What a plugin hands over, with its faults named as its own.

    What users ask of it by name raises `InputError`; what is asked of all plugins in turn (lists of
    arms, backups, forms of logs, rules) is passed over with a warning.

    Args:
        owner: the distribution, for messages.
    """
    guard = _Guard(owner)
    return Offers(
        {name: guard.vendor(one) for name, one in offers.vendors.items()},
        {name: guard.robot(name, load) for name, load in offers.robots.items()},
        {name: guard.logs(one) for name, one in offers.logs.items()},
        {
            name: replace(one, export=guard.named(f"exporter {name}", one.export))
            for name, one in offers.exporters.items()
        },
        {name: guard.rule(one) for name, one in offers.program_rules.items()},
        {name: guard.rule(one) for name, one in offers.run_rules.items()},
    )


class _Guard:
    def __init__(self, owner: str) -> None:
        self._owner = owner

    def vendor(self, vendor: Vendor) -> Vendor:
        arms = {
            name: self.robot(f"{vendor.name}/{name}", load) for name, load in vendor.robots.items()
        }
        opener = vendor.backups
        language: dict[str, Any] = {
            name: _Part(self, f"the {name} of {vendor.name}", part)
            for name in LANGUAGE_PARTS
            if (part := getattr(vendor, name)) is not None
        }
        return replace(
            vendor,
            robots=arms,
            motion=self.named(f"the motion model of {vendor.name}", vendor.motion),
            label=self.named(f"the label of {vendor.name}", vendor.label),
            **language,
            **self.files(vendor),
            listed=lambda: self.passed("its list of arms", lambda: _listed(vendor), {}),
            backups=None if opener is None else lambda: _Opener(self, opener),
        )

    def files(self, vendor: Vendor) -> dict[str, Any]:
        """What reads a controller's own files."""
        made: dict[str, Any] = {}
        for name, kind in (("machine_data", _robot), ("described", _robot), ("stated", _figures)):
            read = getattr(vendor, name)
            if read is not None:
                what = f"{name} of {vendor.name}"
                made[name] = self.named(what, partial(_checked, kind, read))
        return made

    def robot(self, name: str, load: Callable[[], Any]) -> Callable[[], Robot]:
        return self.named(f"robot {name}", partial(_checked, _robot, load))

    def logs(self, form: Any) -> Any:
        return replace(
            form,
            recognises=lambda path: self.passed(
                f"logs {form.name}", lambda: bool(form.recognises(path)), False
            ),
            read=self.named(f"logs {form.name}", form.read),
        )

    def rule(self, rule: Any) -> Any:
        def hits(subject: Any) -> Iterator[Any]:
            yield from self.passed(f"rule {rule.id}", lambda: _hits(rule, subject), ())

        return replace(rule, hits=hits)

    def named(self, what: str, call: Callable[..., Value]) -> Callable[..., Value]:
        """A call whose failure is an error that names the plugin."""

        def guarded_call(*given: Any) -> Value:
            try:
                return call(*given)
            except PluginFault as error:
                told = f"the plugin {self._owner} is at fault: {what}: {error.message}"
                raise PluginFault(told, error.span) from error.__cause__
            except FlybyError:
                raise
            except Exception as error:
                raise InputError(self._fault(what, error)) from error

        return guarded_call

    def passed(self, what: str, call: Callable[[], Value], otherwise: Value) -> Value:
        """What a call gives; ``otherwise``, with a warning, where it fails."""
        try:
            return call()
        except Exception as error:
            _log.warning(self._fault(what, error))
            return otherwise

    def _fault(self, what: str, error: Exception) -> str:
        return f"the plugin {self._owner} is at fault: {what}: {type(error).__name__}: {error}"


class _Part:
    """A part of a plugin's language, whose failures name the plugin."""

    def __init__(self, guard: _Guard, what: str, part: Any) -> None:
        self._part = part
        for name in _METHODS:  # As attributes of its own: protocols are looked up there.
            if hasattr(part, name):
                setattr(self, name, guard.named(what, getattr(part, name)))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._part, name)


class _Opener:
    """A plugin's opener, which marks nothing where it fails to look."""

    def __init__(self, guard: _Guard, load: Callable[[], Any]) -> None:
        self._guard = guard
        self._opener = guard.passed("its opener of backups", load, None)

    def root_in(self, names: Sequence[str]) -> str | None:
        """See `core.language.BackupOpener`."""
        return self._asked("root_in", names)

    def programs_in(self, names: Sequence[str]) -> str | None:
        """See `core.language.BackupOpener`."""
        return self._asked("programs_in", names)

    def _asked(self, method: str, names: Sequence[str]) -> str | None:
        if self._opener is None:
            return None

        def ask() -> str | None:
            found: str | None = getattr(self._opener, method)(names)
            return found

        return self._guard.passed("its opener of backups", ask, None)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._opener, name)


def _checked(kind: Callable[[Any], Value], call: Callable[..., Any], *given: Any) -> Value:
    return kind(call(*given))


def _robot(robot: Any) -> Any:
    if not hasattr(robot, "name"):
        raise TypeError(f"it gives no Robot, but {type(robot).__name__}")
    return robot


def _figures(found: Any) -> Mapping[str, Any]:
    """Figures of a motion file, each with its value and its origin."""
    if not isinstance(found, Mapping):
        raise TypeError(f"it gives no figures by key, but {type(found).__name__}")
    for key, one in found.items():
        if not (isinstance(one, tuple) and len(one) == 2):
            raise TypeError(f"{key}: it gives no value and origin, but {one!r}")
    return found


def _listed(vendor: Vendor) -> dict[str, Listed]:
    found = dict(vendor.listed())
    for name, one in found.items():
        if not isinstance(one, Listed):
            raise TypeError(f"{name} is no Listed, but {type(one).__name__}")
    return found


def _hits(rule: Any, subject: Any) -> tuple[Any, ...]:
    found = tuple(rule.hits(subject))
    for hit in found:
        if not hasattr(hit, "message"):
            raise TypeError(f"it gives no Hit, but {type(hit).__name__}")
    return found
