"""The one door through which vendors come in.

A plugin is a module or an object that an entry point of the group ``flyby`` names::

    [project.entry-points.flyby]
    acme = "flyby_acme.plugin"

and that implements the hook below::

    from flyby.core.hookspec import VendorRegister, hookimpl

    @hookimpl
    def flyby_register_vendors(register: VendorRegister) -> None:
        register.add(Vendor(name="acme", ...))
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import pluggy

if TYPE_CHECKING:
    from .vendor import Vendor

GROUP = "flyby"

hookspec = pluggy.HookspecMarker(GROUP)
hookimpl = pluggy.HookimplMarker(GROUP)


class VendorRegister(Protocol):
    """Takes what a plugin has to offer."""

    def add(self, vendor: Vendor) -> None:
        """Take ``vendor`` in.

        Raises:
            InputError: a part is missing or of a wrong kind, or the name is taken.
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
