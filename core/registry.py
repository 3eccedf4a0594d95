"""How vendors are found: entry points of the group ``flyby``, each loaded on its own.

pluggy's own loader stops at the first plugin that fails; here a broken plugin is listed with
its distribution and its exception, and hides no other.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import metadata
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NoReturn

import pluggy

from . import hookspec
from .door import called
from .errors import InputError, UnknownNameError
from .robot.arm_list import Listed
from .robot.model_names import described, matching, meant, near
from .vendor import Vendor

if TYPE_CHECKING:
    from .robot.model import Robot

OWN_DISTRIBUTION = "flyby"
_OFFERED = 12
"""Robots that a message offers at most."""
_NEAR = 6
"""Of them those whose names are only like what was written."""


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


class UnlistedRobotError(UnknownNameError):
    """A robot that no vendor lists; the message offers those of near names.

    Args:
        name: the name asked for.
        near: arms of near names.
        known: what is known instead.
        more: what else may be the reason.
    """

    def __init__(
        self,
        name: str,
        near: Sequence[Listed],
        known: Iterable[str] = (),
        more: Iterable[str] = (),
    ) -> None:
        super().__init__("robot", name, [arm.name for arm in near])
        offered = [f"near it are {', '.join(map(described, near))}"] if near else known
        told = "; ".join((*offered, f"{called('robots')} lists all", *more))
        self.args = (f"unknown robot {name!r}: {told}",)


class _Register:
    """The register of one plugin: vendors count once the plugin has finished without error."""

    def __init__(self, taken: Iterable[str]) -> None:
        self._taken = set(taken)
        self.vendors: dict[str, Vendor] = {}

    def add(self, vendor: Vendor, api: int = hookspec.API) -> None:
        """See `hookspec.VendorRegister.add`."""
        if api != hookspec.API:
            raise InputError(
                f"it was built for version {api} of flyby's plugin interface, and this flyby has "
                f"{hookspec.API}: install a newer {'plugin' if api < hookspec.API else 'flyby'}"
            )
        if not isinstance(vendor, Vendor):
            raise InputError(f"register.add takes a Vendor, not {vendor!r}")
        if vendor.name in self._taken or vendor.name in self.vendors:
            raise InputError(f"a vendor called {vendor.name!r} is registered already")
        self.vendors[vendor.name] = vendor


@dataclass(frozen=True)
class Registry:
    """The vendors at hand.

    Args:
        vendors: by name.
        broken: plugins that could not be taken in.
        distributions: what each vendor was installed with, its version included, by its name.
    """

    vendors: Mapping[str, Vendor]
    broken: tuple[BrokenPlugin, ...] = ()
    distributions: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def discover(cls, entry_points: Iterable[metadata.EntryPoint] | None = None) -> Registry:
        """Load every plugin of ``entry_points``, by default all that are installed."""
        if entry_points is None:
            entry_points = metadata.entry_points(group=hookspec.GROUP)
        vendors: dict[str, Vendor] = {}
        distributions: dict[str, str] = {}
        broken: list[BrokenPlugin] = []
        for entry_point in sorted(entry_points, key=_order):
            try:
                found = _vendors_of(entry_point.load(), entry_point.name, vendors)
                vendors |= found
                distributions |= dict.fromkeys(found, _with_version(entry_point))
            except (Exception, SystemExit) as error:
                plugin = BrokenPlugin(entry_point.name, _distribution(entry_point), error)
                broken.append(plugin)
        return cls(MappingProxyType(vendors), tuple(broken), MappingProxyType(distributions))

    def find_vendor(self, name: str) -> Vendor:
        """The vendor ``name``.

        Raises:
            UnknownNameError: there is none; says so if its plugin is broken.
        """
        if name not in self.vendors:
            self._unknown("vendor", name, name, self.vendors)
        return self.vendors[name]

    def find_robot(self, name: str) -> Robot:
        """The robot of a name like ``abb/irb6640-180-255``, or as people and controllers write it.

        Raises:
            UnknownNameError: there is none, or several may be meant; says so if its vendor's
                plugin is broken.
            InputError: it cannot be driven, with the reason.
        """
        vendor, _, robot = self.robot_called(name).partition("/")
        return self.vendors[vendor].robot(robot)

    def robot_called(self, name: str) -> str:
        """The robot's own name, ``vendor/robot``, of a name as people and controllers write it.

        Raises:
            UnknownNameError, InputError: see `find_robot`.
        """
        vendor, _, robot = name.partition("/")
        if vendor in self.vendors and robot in self.vendors[vendor].robots:
            return name
        found = self.robots_like(name)
        if len(found) == 1:
            if not meant(name, found[0]):
                raise UnlistedRobotError(name, found)
            if found[0].refused is not None:
                raise InputError(f"{found[0].model} cannot be driven: {found[0].refused}")
            return found[0].name
        if found:
            offered = ", ".join(map(described, found[:_OFFERED]))
            more = f" and {len(found) - _OFFERED} more" if len(found) > _OFFERED else ""
            raise InputError(f"robot {name!r}: which? {offered}{more}")
        known = [f"those of {', '.join(sorted(self.vendors))} are known"]
        near = self.robots_near(name)
        raise UnlistedRobotError(name, near, [] if near else known, self._broken(vendor))

    def robots_like(self, name: str) -> list[Listed]:
        """The arms that a name may mean, whether they can be driven or not."""
        vendor, slash, robot = name.partition("/")
        owners = [self.vendors[vendor]] if slash and vendor in self.vendors else None
        asked = robot if owners else name
        arms = [arm for owner in owners or self.vendors.values() for arm in all_listed(owner)]
        return matching(asked, arms)

    def with_arm(self, robot: Robot) -> Registry:
        """The same vendors, of which the robot's own knows that one by its name."""
        own = self.find_vendor(robot.name.partition("/")[0]).with_robot(robot)
        return replace(self, vendors=MappingProxyType({**self.vendors, own.name: own}))

    def robots_near(self, name: str) -> list[Listed]:
        """The arms whose names are most like one that none has; those of a vendor that it names."""
        vendor, slash, robot = name.partition("/")
        owners = [self.vendors[vendor]] if slash and vendor in self.vendors else None
        arms = [arm for owner in owners or self.vendors.values() for arm in all_listed(owner)]
        return near(robot if owners else name, arms, _NEAR)

    @property
    def robot_names(self) -> tuple[str, ...]:
        """Every robot as ``vendor/robot``, sorted."""
        return tuple(
            sorted(f"{v.name}/{robot}" for v in self.vendors.values() for robot in v.robots)
        )

    def reader_of(self, path: str | Path) -> Vendor:
        """The vendor whose reader takes the file, by its suffix.

        Raises:
            InputError: no vendor's reader, or more than one, takes such files.
        """
        suffix = Path(path).suffix.lower()
        found = [v for v in self.vendors.values() if suffix in v.suffixes]
        if len(found) == 1:
            return found[0]
        if found:
            names = " and ".join(v.name for v in found)
            raise InputError(f"{path}: {names} both read {suffix!r} files; name the vendor")
        known = ", ".join(
            f"{' '.join(v.suffixes)} ({v.name})" for v in self.vendors.values() if v.suffixes
        )
        if not suffix:
            raise InputError(
                f"{path}: the name has no suffix, which tells a program's language; known: "
                f"{known or 'none'}"
            )
        for vendor in self.vendors.values():
            if suffix in vendor.companions:
                raise InputError(f"{path}: {vendor.companions[suffix]}")
        raise InputError(f"{path}: no vendor reads {suffix!r} files; known: {known or 'none'}")

    def _unknown(self, kind: str, name: str, vendor: str, known: Iterable[str]) -> NoReturn:
        error = UnknownNameError(kind, name, known)
        error.args = ("; ".join((str(error), *self._broken(vendor))),)
        raise error

    def _broken(self, vendor: str) -> list[str]:
        return [str(plugin) for plugin in self.broken if plugin.plugin == vendor]


def all_listed(vendor: Vendor) -> list[Listed]:
    """The arms of a vendor, those included that have a name alone."""
    listed = dict(vendor.listed())
    for robot in vendor.robots:
        listed.setdefault(robot, Listed(f"{vendor.name}/{robot}", robot))
    return [listed[robot] for robot in sorted(listed)]


@cache
def installed() -> Registry:
    """The registry of all installed plugins and the user's own robots, built at the first call."""
    from .own_robots import with_own_robots

    found = Registry.discover()
    return replace(found, vendors=MappingProxyType(with_own_robots(found.vendors)))


def vendors() -> tuple[Vendor, ...]:
    """All installed vendors, by name."""
    found = installed().vendors
    return tuple(found[name] for name in sorted(found))


def find_vendor(name: str) -> Vendor:
    """`Registry.find_vendor` among all that is installed."""
    return installed().find_vendor(name)


def find_robot(name: str) -> Robot:
    """`Registry.find_robot` among all that is installed."""
    return installed().find_robot(name)


def _vendors_of(plugin: object, name: str, taken: Iterable[str]) -> dict[str, Vendor]:
    """The vendors of one plugin; its manager dies with this call.

    Raises:
        pluggy.PluginValidationError: a hook of the plugin has no specification, or another
            signature.
        InputError: the plugin implements no hook, or registers no sound vendor.
    """
    manager = pluggy.PluginManager(hookspec.GROUP)
    manager.add_hookspecs(hookspec)
    manager.register(plugin, name)
    manager.check_pending()
    if not manager.get_hookcallers(plugin):
        raise InputError("it implements no flyby_register_vendors; is @hookimpl missing?")
    register = _Register(taken)
    manager.hook.flyby_register_vendors(register=register)
    if not register.vendors:
        raise InputError("its flyby_register_vendors adds no vendor")
    return register.vendors


def _order(entry_point: metadata.EntryPoint) -> tuple[bool, str, str]:
    """The project's own first, so that no stranger takes a shipped name by its spelling."""
    owner = _distribution(entry_point)
    return owner != OWN_DISTRIBUTION, owner, entry_point.name


def _distribution(entry_point: metadata.EntryPoint) -> str:
    return entry_point.dist.name if entry_point.dist is not None else "an unnamed distribution"


def _with_version(entry_point: metadata.EntryPoint) -> str:
    version = getattr(entry_point.dist, "version", None)
    return f"{_distribution(entry_point)}{f' {version}' if version else ''}"
