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

from . import hookspec
from .door import called, given
from .errors import FlybyError, InputError, UnknownNameError
from .language import Recogniser
from .plugins.guard import guarded
from .plugins.loading import (
    OWN_DISTRIBUTION,
    BrokenPlugin,
    Offers,
    distribution,
    offers_of,
    order,
    with_version,
)
from .robot.arm_list import Listed
from .robot.model_names import described, matching, meant, near
from .vendor import Vendor

if TYPE_CHECKING:
    from .plugins.parts import Exporter
    from .robot.model import Robot

_OFFERED = 12
"""Robots that a message offers at most."""
_PLAIN_TEXT = ".txt"
_BEGINNING = 20_000
"""Characters of a file that show its language."""
_NEAR = 6
"""Of them those whose names are only like what was written."""


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
        self.near = tuple(near)
        offered = [f"near it are {', '.join(map(described, near))}"] if near else known
        told = "; ".join((*offered, f"{called('robots')} lists all", *more))
        self.args = (f"unknown robot {name!r}: {told}",)


@dataclass(frozen=True)
class Registry:
    """The vendors at hand.

    Args:
        vendors: by name.
        broken: plugins that could not be taken in.
        distributions: what each vendor, robot, form of logs, exporter and rule of a plugin was
            installed with, its version included, by its name.
        offers: what plugins have handed over, beside vendors: robots, readers of logs, exporters,
            rules of ``flyby check``.
    """

    vendors: Mapping[str, Vendor]
    broken: tuple[BrokenPlugin, ...] = ()
    distributions: Mapping[str, str] = field(default_factory=dict)
    offers: Offers = field(default_factory=Offers)

    @classmethod
    def discover(cls, entry_points: Iterable[metadata.EntryPoint] | None = None) -> Registry:
        """Load every plugin of ``entry_points``, by default all that are installed."""
        if entry_points is None:
            entry_points = metadata.entry_points(group=hookspec.GROUP)
        known = Offers()
        distributions: dict[str, str] = {}
        broken: list[BrokenPlugin] = []
        for entry_point in sorted(entry_points, key=order):
            try:
                found = offers_of(entry_point.load(), entry_point.name, known)
            except KeyboardInterrupt:
                raise
            except BaseException as error:
                plugin = BrokenPlugin(entry_point.name, distribution(entry_point), error)
                broken.append(plugin)
                continue
            if distribution(entry_point) != OWN_DISTRIBUTION:
                found = guarded(found, with_version(entry_point))
            known.add(found)
            for parts in found.parts().values():
                distributions |= dict.fromkeys(parts, with_version(entry_point))
        vendors = dict(known.vendors)
        for name, load in known.robots.items():
            vendor, _, robot = name.partition("/")
            own = vendors[vendor]
            vendors[vendor] = replace(own, robots={**own.robots, robot: load})
        return cls(MappingProxyType(vendors), tuple(broken), MappingProxyType(distributions), known)

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
        """The vendor whose reader takes the file, by its suffix, and where files of several end
        alike, by what stands in it.

        Raises:
            InputError: no vendor's reader, or more than one, takes such a file.
        """
        found = self.readers_of(path)
        if len(found) > 1:
            names = " and ".join(v.name for v in found)
            raise InputError(
                f"{path}: it may be of {names}, and nothing in it tells: choose a robot "
                f"({given('robot', f'{found[0].name}/…')}), which says whose it is"
            )
        return found[0]

    def readers_of(self, path: str | Path) -> list[Vendor]:
        """The vendors whose program a file may be: one, unless nothing in it tells.

        Programs of all languages are saved as plain text: there what stands in it tells as well.

        Raises:
            InputError: no vendor's reader takes such files.
        """
        suffix = Path(path).suffix.lower()
        found = [v for v in self.vendors.values() if suffix in v.suffixes]
        if found and suffix == _PLAIN_TEXT:
            return by_content(Path(path), found, list(self.vendors.values()))
        if found:
            return found if len(found) == 1 else by_content(Path(path), found)
        known = ", ".join(
            f"{' '.join(v.suffixes)} ({v.name})" for v in self.vendors.values() if v.suffixes
        )
        if not suffix:
            raise InputError(
                f"{path}: the name has no suffix, which tells a program's language: copy it to a "
                f"name with one; known: {known or 'none'}"
            )
        for vendor in self.vendors.values():
            if suffix in vendor.companions:
                raise InputError(f"{path}: {vendor.companions[suffix]}")
        raise InputError(f"{path}: no vendor reads {suffix!r} files; known: {known or 'none'}")

    def exporter_of(self, path: str | Path) -> Exporter:
        """The exporter whose files end as this one.

        Raises:
            InputError: there is none.
        """
        suffix = Path(path).suffix.lower()
        for exporter in self.offers.exporters.values():
            if suffix in exporter.suffixes:
                return exporter
        known = ", ".join(
            f"{' '.join(one.suffixes)} ({one.name})" for one in self.offers.exporters.values()
        )
        raise InputError(
            f"{path}: no exporter writes {suffix!r} files; installed: {known or 'none'} "
            f"({called('vendors')} lists plugins)"
        )

    def _unknown(self, kind: str, name: str, vendor: str, known: Iterable[str]) -> NoReturn:
        error = UnknownNameError(kind, name, known)
        error.args = ("; ".join((str(error), *self._broken(vendor))),)
        raise error

    def _broken(self, vendor: str) -> list[str]:
        return [str(plugin) for plugin in self.broken if plugin.plugin == vendor]


def by_content(
    path: Path, vendors: Sequence[Vendor], others: Sequence[Vendor] = ()
) -> list[Vendor]:
    """Those of several vendors whose language the beginning of a file is in.

    If none knows it for its own, those are left of ``others`` that do; if none does, those that
    cannot tell; if all can, all of them.
    """
    from .source.text.files import read_source

    try:
        text = read_source(path).text[:_BEGINNING]
    except FlybyError:
        return list(vendors)
    sure: list[Vendor] = []
    silent: list[Vendor] = []
    for vendor in vendors:
        if not isinstance(vendor.reader, Recogniser):
            silent.append(vendor)
        elif vendor.reader.recognises(text):
            sure.append(vendor)
    if not sure:
        readers = ((vendor, vendor.reader) for vendor in others)
        sure = [v for v, r in readers if isinstance(r, Recogniser) and r.recognises(text)]
    return sure or silent or list(vendors)


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
