"""Changes in the bytes of an XML file; all others stay as they are.

PolyScope reads its own way of writing XML and refuses some of what means the same, so that a file
is never written anew.
"""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from html import unescape
from xml.sax.saxutils import escape

from .....core.errors import InputError
from ..xml_file import GZIP, Element

_TAG = re.compile(
    r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<(/?)([^\s/>!?]+)((?:[^<>\"']|\"[^\"]*\"|'[^']*')*)>",
    re.DOTALL,
)
_ATTRIBUTE = re.compile(r"\s([^\s=]+)\s*=\s*(\"[^\"]*\"|'[^']*')")
_SIGN = re.compile(r"&[^;]*;|\r\n|.", re.DOTALL)
"""What is read as one character."""
_BLANK = re.compile(r"\s*")
_FLAGS = struct.Struct("<2sBBIBB")
_HAS_CHECKSUM, _HAS_EXTRA, _HAS_NAME, _HAS_COMMENT = 2, 4, 8, 16


def packed_like(plain: bytes, data: bytes) -> bytes:
    """Bytes, compressed if others are, with the same head of gzip: no new date, no new name."""
    if not data.startswith(GZIP):
        return plain
    packer = zlib.compressobj(wbits=-zlib.MAX_WBITS)
    body = packer.compress(plain) + packer.flush()
    ends = struct.pack("<II", zlib.crc32(plain), len(plain) & 0xFFFFFFFF)
    return data[: _head(data)] + body + ends


def _head(data: bytes) -> int:
    """The length of gzip's head (RFC 1952)."""
    flags, at = data[3], _FLAGS.size
    if flags & _HAS_EXTRA:
        at += 2 + int.from_bytes(data[at : at + 2], "little")
    for flag in (_HAS_NAME, _HAS_COMMENT):
        if flags & flag:
            at = data.index(0, at) + 1
    return at + 2 if flags & _HAS_CHECKSUM else at


@dataclass(frozen=True)
class _Start:
    """The start tag of an element: offsets of what is behind its name, and of its end."""

    name: str
    attributes: int
    end: int


@dataclass
class XmlEdits:
    """Changes of attributes and texts of the elements of one file.

    Args:
        plain: its bytes, unpacked.
        root: its root, as `xml_file.parsed` reads it.
        name: of the file, for messages.
    """

    plain: bytes
    root: Element
    name: str
    _asked: dict[tuple[Element, str | None], str] = field(default_factory=dict)
    _made: dict[tuple[int, int], str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        # Each byte is one character: of all encodings but UTF-16 the signs of XML are the same.
        self._text = self.plain.decode("latin-1")
        found = [m for m in _TAG.finditer(self._text) if m[2] and not m[1]]
        starts = [_Start(m[2], m.start(3), m.end()) for m in found]
        elements = list(self.root.iter("*"))
        if [_plain_name(one) for one in elements] != [s.name.rpartition(":")[2] for s in starts]:
            raise InputError(f"{self.name}: its XML is written in a way that cannot be changed")
        self._starts: Mapping[Element, _Start] = dict(zip(elements, starts, strict=True))

    def set(self, element: Element, attribute: str | None, value: str) -> None:
        """Give an attribute, or the text of an element, another value; put it in if it lacks.

        Args:
            element: of this file.
            attribute: None for the text.
            value: of signs that XML has no need to escape.

        Raises:
            InputError: the place is to have two different values.
        """
        if self._asked.setdefault((element, attribute), value) != value:
            asked = self._asked[element, attribute]
            raise InputError(f"one number of the program is to become {asked} and {value}")
        start = self._starts[element]
        if attribute is None:
            first = _BLANK.match(self._text, start.end)
            assert first is not None
            text = self._text[first.end() : self._text.index("<", start.end)].rstrip()
            self._made[first.end(), first.end() + len(text)] = value
            return
        found = self._attribute(start, attribute)
        if found is not None:
            self._made[found] = value
            return
        last = start.end - (2 if self._text[start.end - 2] == "/" else 1)
        inside = self._text[start.attributes : last].rstrip()
        self._put_in(start.attributes + len(inside), f' {attribute}="{value}"')

    def set_stretch(self, element: Element, start: int, end: int, value: str) -> None:
        """Give a stretch of the text of an element, of any signs, another value.

        Args:
            start, end: characters of the text as it is read.

        Raises:
            InputError: the text is written in a way that cannot be changed.
        """
        first = self._starts[element].end
        raw = self._text[first : self._text.index("<", first)].encode("latin-1")
        try:
            signs = _SIGN.findall(raw.decode())
        except UnicodeDecodeError:
            signs = []
        if "".join(map(_read, signs)) != element.text:
            raise InputError(f"{self.name}: code in it is written in a way that cannot be changed")
        place = [first + len("".join(signs[:count]).encode()) for count in (start, end)]
        self._made[place[0], place[1]] = escape(value).encode().decode("latin-1")

    def put_first(self, element: Element, text: str) -> None:
        """Put a child before those that an element has."""
        start = self._starts[element]
        blank = _BLANK.match(self._text, start.end)
        self._put_in(start.end, f"{blank[0] if blank else ''}{text}")

    @property
    def changed(self) -> bytes:
        """The bytes with the changes."""
        parts, at = [], 0
        for (start, end), text in sorted(self._made.items()):
            parts += [self._text[at:start], text]
            at = end
        return "".join([*parts, self._text[at:]]).encode("latin-1")

    def _attribute(self, start: _Start, name: str) -> tuple[int, int] | None:
        for found in _ATTRIBUTE.finditer(self._text, start.attributes, start.end):
            if found[1] == name:
                return found.start(2) + 1, found.end(2) - 1
        return None

    def _put_in(self, at: int, text: str) -> None:
        self._made[at, at] = self._made.get((at, at), "") + text


def _read(sign: str) -> str:
    if sign.startswith("&"):
        return unescape(sign)
    return "\n" if sign.startswith("\r") else sign


def _plain_name(element: Element) -> str:
    return str(element.tag).rpartition("}")[2]
