"""XML files of PolyScope: packed by gzip, or plain where a tool or a version control unpacked them.

An element may stand for another one of the same file, ``reference="../../Move[2]/feature"``: a
path that starts at the element itself, with places counted from 1 (XStream's relative references).
"""

from __future__ import annotations

import gzip
import io
import math
import zlib
from pathlib import Path
from typing import Any

from ....core.errors import InputError
from ....core.files.reading import read_bytes
from ....core.source.text.files import LARGEST_FILE, decode

Element = Any
"""An lxml element."""
GZIP = b"\x1f\x8b"
MOST_UNPACKED = 100_000_000
"""Bytes. The largest programs seen have some ten million unpacked."""
_MOST_STEPS = 64
"""References that lead to references."""


def unpacked(data: bytes, name: str) -> bytes:
    """A file's bytes without their compression.

    Raises:
        InputError: they are damaged, or more than `MOST_UNPACKED`.
    """
    if not data.startswith(GZIP):
        return data
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as file:
            plain = file.read(MOST_UNPACKED + 1)
    except (OSError, EOFError, zlib.error):
        raise InputError(
            f"{name}: its compressed data are damaged or cut short; copy it from the controller "
            "again"
        ) from None
    if len(plain) > MOST_UNPACKED:
        raise InputError(f"{name}: unpacks to more than {MOST_UNPACKED:,} bytes: no robot program")
    return plain


def is_xml(plain: bytes) -> bool:
    """Whether unpacked bytes are XML, by how they begin."""
    return plain[:200].lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")


def parsed(plain: bytes, name: str) -> Element:
    """The root of an XML text.

    Raises:
        InputError: it is damaged, or declares types or entities, which PolyScope never does.
    """
    if b"<!DOCTYPE" in plain or b"<!ENTITY" in plain:
        raise _declares(name)
    from lxml import etree

    parser = etree.XMLParser(resolve_entities=False, no_network=True, remove_comments=True)
    try:
        try:
            root = etree.fromstring(plain, parser)
        except etree.XMLSyntaxError:
            if plain.startswith(b"<?xml") or decode(plain, name)[1].startswith("utf-8"):
                raise
            # Tools that unpack files save them in the code page of their system.
            root = etree.fromstring(decode(plain, name)[0].encode(), parser)
    except (etree.XMLSyntaxError, ValueError, LookupError) as error:
        reason = getattr(error, "msg", None) or str(error) or "it is empty"
        raise InputError(
            f"{name}: its XML is damaged ({reason}); copy it from the controller again"
        ) from None
    if root.getroottree().docinfo.internalDTD is not None:
        raise _declares(name)
    return root


def read_xml(path: Path) -> Element:
    """The root of an XML file of PolyScope.

    Raises:
        InputError: it cannot be read, or is none.
    """
    plain = unpacked(read_bytes(path, LARGEST_FILE), str(path))
    if not is_xml(plain):
        raise InputError(f"{path}: is no XML, as files of PolyScope are")
    return parsed(plain, str(path))


def _declares(name: str) -> InputError:
    return InputError(f"{name}: declares document types or entities, as no file of PolyScope does")


def resolved(element: Element) -> Element | None:
    """What an element stands for: itself, or the one that it refers to; None if there is none."""
    for _ in range(_MOST_STEPS):
        reference = element.get("reference")
        if reference is None:
            return element
        found = _at(element, reference)
        if found is None or found is element:
            return None
        element = found
    return None


def _at(element: Element, path: str) -> Element | None:
    steps = path.split("/")
    if steps[0] == "":
        element = element.getroottree().getroot()
        steps = steps[2:]
    for step in steps:
        if step in ("", "."):
            continue
        found = element.getparent() if step == ".." else _child_at(element, step)
        if found is None:
            return None
        element = found
    return element


def _child_at(element: Element, step: str) -> Element | None:
    tag, _, place = step.partition("[")
    number = place.rstrip("]")
    index = int(number) - 1 if number.isascii() and number.isdigit() else 0 if not place else -1
    alike = [one for one in element if one.tag == tag]
    return alike[index] if 0 <= index < len(alike) else None


def child(element: Element | None, *tags: str) -> Element | None:
    """The first child of one of these tags, resolved; None if there is none."""
    if element is None:
        return None
    for one in element:
        if one.tag in tags:
            return resolved(one)
    return None


def numbers(text: str | None, count: int | None = None) -> tuple[float, ...] | None:
    """Finite numbers with commas between them; None if the text is not so many of them."""
    if text is None:
        return None
    try:
        values = tuple(float(part) for part in text.strip().strip("[]").split(","))
    except ValueError:
        return None
    if (count is not None and len(values) != count) or not all(map(math.isfinite, values)):
        return None
    return values


def number(text: str | None) -> float | None:
    """One finite number; None if the text is none."""
    values = numbers(text, 1)
    return None if values is None else values[0]
