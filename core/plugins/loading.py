"""Takes one plugin in: what it registers counts once it has finished without an error."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import metadata
from typing import TYPE_CHECKING, Any

import pluggy

from .. import hookspec
from ..errors import InputError
from ..vendor import NAME, Vendor
from .parts import Exporter, LogForm

if TYPE_CHECKING:
    from ..robot.model import Robot

OWN_DISTRIBUTION = "flyby"


@dataclass(frozen=True, slots=True)
class BrokenPlugin:
    """A plugin that could not be taken in.

    Args:
        plugin: name of its entry point.
        distribution: the installed distribution that it belongs to.
        error: what it raised.
    """

    plugin: str
    distribution: str
    error: BaseException

    def __str__(self) -> str:
        kind = type(self.error).__name__
        return f"plugin {self.plugin!r} of {self.distribution} is broken: {kind}: {self.error}"


@dataclass(frozen=True)
class Offers:
    """What plugins hand over, each by its name.

    Args:
        robots: loaders of robots that plugins add to vendors, by ``vendor/robot``.
        program_rules, run_rules: of ``flyby check`` (`core.lint.finding.Rule`).
    """

    vendors: dict[str, Vendor] = field(default_factory=dict)
    robots: dict[str, Callable[[], Robot]] = field(default_factory=dict)
    logs: dict[str, LogForm] = field(default_factory=dict)
    exporters: dict[str, Exporter] = field(default_factory=dict)
    program_rules: dict[str, Any] = field(default_factory=dict)
    run_rules: dict[str, Any] = field(default_factory=dict)

    def parts(self) -> dict[str, dict[str, Any]]:
        """Everything, by what it is and its name."""
        return dict(vars(self))

    def add(self, other: Offers) -> None:
        """Take in what another plugin has."""
        for kind, parts in other.parts().items():
            getattr(self, kind).update(parts)


class _Register:
    """Takes what one plugin has, beside what others have handed over."""

    def __init__(self, known: Offers) -> None:
        self._known = known
        self.made = Offers()

    def _take(self, kind: str, what: str, name: str, part: Any, api: int) -> None:
        if api != hookspec.API:
            raise InputError(
                f"it was built for version {api} of flyby's plugin interface, and this flyby has "
                f"{hookspec.API}: install a newer {'plugin' if api < hookspec.API else 'flyby'}"
            )
        if name in getattr(self._known, kind) or name in getattr(self.made, kind):
            raise InputError(f"{what} called {name!r} is registered already")
        getattr(self.made, kind)[name] = part


class _Vendors(_Register):
    def add(self, vendor: Vendor, api: int = hookspec.API) -> None:
        """See `hookspec.VendorRegister`."""
        if not isinstance(vendor, Vendor):
            raise InputError(f"register.add takes a Vendor, not {vendor!r}")
        self._take("vendors", "a vendor", vendor.name, vendor, api)


class _Robots(_Register):
    def add(
        self, vendor: str, robots: Mapping[str, Callable[[], Robot]], api: int = hookspec.API
    ) -> None:
        """See `hookspec.RobotRegister`."""
        own = self._known.vendors.get(vendor) or self.made.vendors.get(vendor)
        if own is None:
            raise InputError(f"its robots are of vendor {vendor!r}, which is not installed")
        for name, load in robots.items():
            _check_name("a robot", name)
            if name in own.robots:
                raise InputError(f"a robot called {vendor}/{name} is registered already")
            if not callable(load):
                raise InputError(f"robot {vendor}/{name} needs a loader, not {load!r}")
            self._take("robots", "a robot", f"{vendor}/{name}", load, api)


class _Logs(_Register):
    def add(self, form: LogForm, api: int = hookspec.API) -> None:
        """See `hookspec.LogRegister`."""
        if not isinstance(form, LogForm):
            raise InputError(f"register.add takes a LogForm, not {form!r}")
        _check_name("a form of logs", form.name)
        self._take("logs", "a form of logs", form.name, form, api)


class _Exporters(_Register):
    def add(self, exporter: Exporter, api: int = hookspec.API) -> None:
        """See `hookspec.ExporterRegister`."""
        if not isinstance(exporter, Exporter):
            raise InputError(f"register.add takes an Exporter, not {exporter!r}")
        _check_name("an exporter", exporter.name)
        wrong = [s for s in exporter.suffixes if not s.startswith(".") or s != s.lower()]
        if wrong or not exporter.suffixes or isinstance(exporter.suffixes, str):
            raise InputError(
                f"exporter {exporter.name!r}: 'suffixes' is a tuple like ('.sim',), not "
                f"{exporter.suffixes!r}"
            )
        for other in (*self._known.exporters.values(), *self.made.exporters.values()):
            both = sorted(set(exporter.suffixes) & set(other.suffixes))
            if both:
                raise InputError(
                    f"exporter {exporter.name!r}: {both[0]!r} is a suffix of {other.name!r} already"
                )
        self._take("exporters", "an exporter", exporter.name, exporter, api)


class _Rules(_Register):
    def add_program_rule(self, rule: Any, api: int = hookspec.API) -> None:
        """See `hookspec.RuleRegister`."""
        self._add("program_rules", rule, api)

    def add_run_rule(self, rule: Any, api: int = hookspec.API) -> None:
        """See `hookspec.RuleRegister`."""
        self._add("run_rules", rule, api)

    def _add(self, kind: str, rule: Any, api: int) -> None:
        parts = [getattr(rule, name, None) for name in ("id", "severity", "summary")]
        if not (all(isinstance(part, str) for part in parts) and callable(rule.hits)):
            raise InputError(f"a rule is a Rule of flyby.core.lint.finding, not {rule!r}")
        _check_name("a rule", rule.id)
        if not all(rule.id.partition(".")):
            raise InputError(
                f"rules of plugins are called by the plugin and a dot, as acme.{rule.id}: flyby's "
                "own have no dot"
            )
        if rule.id in {**self._known.program_rules, **self._known.run_rules}:
            raise InputError(f"a rule called {rule.id!r} is registered already")
        self._take(kind, "a rule", rule.id, rule, api)


_HOOKS: dict[str, type[_Register]] = {
    "flyby_register_vendors": _Vendors,
    "flyby_register_robots": _Robots,
    "flyby_register_logs": _Logs,
    "flyby_register_exporters": _Exporters,
    "flyby_register_rules": _Rules,
}


def offers_of(plugin: object, name: str, known: Offers) -> Offers:
    """What one plugin hands over; its manager dies with this call.

    Args:
        known: what others have handed over.

    Raises:
        pluggy.PluginValidationError: a hook of the plugin has no specification, or another
            signature.
        InputError: the plugin implements no hook, or registers nothing that is sound.
    """
    manager = pluggy.PluginManager(hookspec.GROUP)
    manager.add_hookspecs(hookspec)
    manager.register(plugin, name)
    manager.check_pending()
    hooks = [caller.name for caller in manager.get_hookcallers(plugin) or ()]
    if not hooks:
        raise InputError(f"it implements no {', '.join(_HOOKS)}; is @hookimpl missing?")
    made = Offers()
    for hook, kind in _HOOKS.items():
        if hook not in hooks:
            continue
        register = kind(known)
        register.made.vendors.update(made.vendors)  # its own robots may be of its own vendor
        getattr(manager.hook, hook)(register=register)
        if register.made == Offers(vendors=made.vendors):
            raise InputError(f"its {hook} adds nothing")
        made.add(register.made)
    return made


def order(entry_point: metadata.EntryPoint) -> tuple[bool, str, str]:
    """The project's own first, so that no stranger takes a shipped name by its spelling."""
    owner = distribution(entry_point)
    return owner != OWN_DISTRIBUTION, owner, entry_point.name


def distribution(entry_point: metadata.EntryPoint) -> str:
    """The name of what a plugin was installed with."""
    return entry_point.dist.name if entry_point.dist is not None else "an unnamed distribution"


def with_version(entry_point: metadata.EntryPoint) -> str:
    """The same and its version."""
    version = getattr(entry_point.dist, "version", None)
    return f"{distribution(entry_point)}{f' {version}' if version else ''}"


def _check_name(owner: str, name: str) -> None:
    if not (isinstance(name, str) and NAME.fullmatch(name)):
        raise InputError(
            f"{owner} is called by lower-case letters, digits, '.', '_' and '-', not {name!r}"
        )
