"""The one door through which plugins come in: vendors, and what else they add.

A plugin is a module or an object that an entry point of the group ``flyby`` names::

    [project.entry-points.flyby]
    acme = "flyby_acme.plugin"

and that implements the hook below::

    from flyby.core.hookspec import VendorRegister, hookimpl

    @hookimpl
    def flyby_register_vendors(register: VendorRegister) -> None:
        register.add(Vendor(name="acme", ...), api=1)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import pluggy

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from .plugins.parts import Exporter, LogForm
    from .robot.model import Robot
    from .vendor import Vendor

GROUP = "flyby"
API = 1
"""Version of all that plugins are built on: these hooks, `Vendor` and what its parts get and give,
`flyby.core.source.lines`. It rises with every change that a plugin must follow."""

hookspec = pluggy.HookspecMarker(GROUP)
hookimpl = pluggy.HookimplMarker(GROUP)


class VendorRegister(Protocol):
    """Takes what a plugin has to offer."""

    def add(self, vendor: Vendor, api: int = API) -> None:
        """Take ``vendor`` in.

        Args:
            api: version of flyby's plugin interface (`API`) that the plugin was built for.

        Raises:
            InputError: it was built for another one, a part is missing or of a wrong kind, or the
                name is taken.
        """
        ...


@hookspec
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over the plugin's vendors by ``register.add``.

    Called once for each plugin when a registry is built: the first time that a vendor or a robot
    is looked up. Nothing heavy belongs here: a vendor's robots, motion model, reader and writer
    are called when they are needed. If it raises, nothing of the plugin is kept and the plugin
    is listed as broken.
    """


class RobotRegister(Protocol):
    """Takes robots for vendors that are installed."""

    def add(self, vendor: str, robots: Mapping[str, Callable[[], Robot]], api: int = API) -> None:
        """Take robots in.

        Args:
            vendor: whose controllers drive them.
            robots: each one's name, without the vendor's, and what loads it
                (`flyby.core.vendor.lazy_robots`).
            api: see `VendorRegister.add`.

        Raises:
            InputError: there is no such vendor, or a name is taken.
        """
        ...


@hookspec
def flyby_register_robots(register: RobotRegister) -> None:
    """Hand over robots for a vendor that another plugin brings."""


class LogRegister(Protocol):
    """Takes readers of logs."""

    def add(self, form: LogForm, api: int = API) -> None:
        """Take a form of logs in; ``flyby identify logs`` and ``flyby compare`` read it.

        Raises:
            InputError: its name is taken, or it is none.
        """
        ...


@hookspec
def flyby_register_logs(register: LogRegister) -> None:
    """Hand over readers of logs."""


class ExporterRegister(Protocol):
    """Takes exporters."""

    def add(self, exporter: Exporter, api: int = API) -> None:
        """Take an exporter in; ``flyby emulate --export FILE`` writes by it.

        Raises:
            InputError: its name or a suffix is taken, or it is none.
        """
        ...


@hookspec
def flyby_register_exporters(register: ExporterRegister) -> None:
    """Hand over exporters of driven programs."""


class RuleRegister(Protocol):
    """Takes rules of ``flyby check``."""

    def add_program_rule(self, rule: Any, api: int = API) -> None:
        """Take a rule on what is written in.

        Args:
            rule: a `flyby.core.lint.finding.Rule` of a `ProgramSubject`, called ``plugin.rule``.
            api: see `VendorRegister.add`.

        Raises:
            InputError: its id is taken, or it is none.
        """
        ...

    def add_run_rule(self, rule: Any, api: int = API) -> None:
        """The same of a rule on the emulated motion, of a `RunSubject`."""
        ...


@hookspec
def flyby_register_rules(register: RuleRegister) -> None:
    """Hand over rules of ``flyby check``."""
