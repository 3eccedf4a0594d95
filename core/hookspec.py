"""The one door through which vendors come in.

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

from typing import TYPE_CHECKING, Protocol

import pluggy

if TYPE_CHECKING:
    from .vendor import Vendor

GROUP = "flyby"
API = 1
"""Version of all that plugins are built on: this hook, `Vendor` and what its parts get and give,
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
