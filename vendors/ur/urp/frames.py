"""TCPs and features of the installation, as nodes of a program name them."""

from __future__ import annotations

from .emission import Emission, pose_text
from .expressions import identifier
from .installation import BASE_FEATURE, TOOL_FEATURE
from .positions import taught_tcps
from .xml_file import Element, resolved


def installation(out: Emission) -> str:
    """The installation, for messages."""
    return f"the installation '{out.named}'"


def set_tcp(out: Emission, tcp: Element | None, node: Element) -> None:
    """The call that sets the TCP that a node names.

    One that no installation at hand has is that with which the waypoints below and behind the node
    were taught.

    Args:
        tcp: the element that names it.
        node: the one that sets it.
    """
    found = None if tcp is None else resolved(tcp)
    name = "" if found is None else found.get("referencedName") or found.get("name") or ""
    known = out.installation.tcps.get(name)
    if known is None:
        known = next(taught_tcps(node), None)
        for behind in node.itersiblings():
            known = next(taught_tcps(behind), None) if known is None else known
        lacks = f"{installation(out)} has no TCP '{name}'"
        if not out.with_installation:
            lacks = f"the TCP '{name}' is not known, as {installation(out)} is not at hand"
        if known is None:
            out.note(f"{lacks}: the one before stays in force")
            return
        out.note(f"{lacks}: it is taken to be the one that the waypoints behind were taught with")
    out.write(f"set_tcp({pose_text(known)})")


def feature_text(out: Emission, feature: Element | None) -> str | None:
    """The frame that a move's variables are in, as an expression; None for the base's."""
    found = None if feature is None else resolved(feature)
    name = None if found is None else found.get("referencedName") or found.get("name")
    if not name or name == BASE_FEATURE or name.casefold() in ("base", "baseview"):
        return None
    if name == TOOL_FEATURE or name.casefold() in ("tool", "toolview"):
        return "get_target_tcp_pose()"
    known = out.installation.features.get(name)
    if known is None:
        lacks = "has it not" if out.with_installation else "is not at hand"
        out.note(f"where the feature '{name}' is is not known: {installation(out)} {lacks}")
        return identifier(name)
    return identifier(name) if known.variable else pose_text(known.pose)
