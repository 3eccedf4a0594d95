"""Whose archive it is: ``am.ini``, and ``Connections.xml`` of copies that WorkVisual makes."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ....core.source.text.files import lines_of
from ..data_list import DataList
from .contents import Contents

_ENTRY = re.compile(r"\s*([A-Za-z]\w{0,30})\s*=(.*)")
_SECTION = re.compile(r"\s*\[([^\]]{0,80})\]\s*")
_PROLOGUE = re.compile(r"<\?xml[^>]{0,200}>", re.IGNORECASE)
_XML_VERSION = re.compile(
    r"""version\w{0,20}\s{0,4}(?:=\s{0,4}["']|>)[^"'<]{0,20}?(\d{1,4}\.\d{1,4}(?:\.\d{1,6}){0,3})""",
    re.IGNORECASE,
)
_XML_TYPE = re.compile(
    r"""["'>]\s{0,20}(KR\s?C\s?[1-5][^"'<]{0,40}?)\s{0,20}["'<]""", re.IGNORECASE
)


@dataclass(frozen=True, slots=True)
class Identity:
    """What an archive says of itself; empty where it does not.

    Args:
        robot: its name.
        serial: of the robot.
        kind: of the controller.
        version: of its software.
    """

    robot: str = ""
    serial: str = ""
    kind: str = ""
    version: str = ""

    @property
    def controller(self) -> str:
        """All of it but the version, in a line."""
        serial = f"serial number {self.serial}" if self.serial.strip("0") else ""
        return ", ".join(one for one in (self.robot, self.kind, serial) if one)


def identity_of(contents: Contents, machine: DataList | None) -> Identity:
    """What an archive says.

    Args:
        machine: its ``$machine.dat``, which has the version where nothing else does.
    """
    told: dict[tuple[str, str], str] = {}
    for name in contents.called("am.ini")[:1]:
        source = contents.source(name)
        section = ""
        for line in lines_of(source.text) if source else ():
            if (head := _SECTION.fullmatch(line)) is not None:
                section = head[1].strip().lower()
            elif (entry := _ENTRY.fullmatch(line)) is not None:
                told.setdefault((section, entry[1].lower()), entry[2].strip().strip('"'))
    version, kind = told.get(("version", "version"), ""), ""
    for name in contents.called("connections.xml")[:1]:
        source = contents.source(name)
        text = _PROLOGUE.sub("", source.text) if source else ""
        version = version or _first(_XML_VERSION, text)
        kind = _first(_XML_TYPE, text)
    if not version and machine is not None and (data := machine.text("$V_R1MADA")):
        version = f"machine data {data}"
    return Identity(
        told.get(("roboter", "robname"), ""), told.get(("roboter", "irserialnr"), ""), kind, version
    )


def _first(pattern: re.Pattern[str], text: str) -> str:
    found = pattern.search(text)
    return found[1].strip() if found else ""
