"""Files of samples as text, in the encodings that controllers write."""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from ...core.errors import InputError
from ...core.files.reading import read_bytes

MOST_BYTES = 200_000_000
"""Six joints for three hours at 250 Hz; reading them takes some ten times as much memory."""
_LINE_END = re.compile(r"\r\n|\n|\r")


def read_text(path: Path) -> str:
    """The text of a file: UTF-8, UTF-16 with its mark, else Latin-1 (degree signs of controllers).

    Raises:
        InputError: it cannot be read, or is no text.
    """
    text = _decoded(read_bytes(path, MOST_BYTES))
    if "\0" in text:
        raise InputError(f"{path}: not a readable log: a binary file; export it as text")
    return text


def lines_of(text: str) -> list[str]:
    """Lines, without their ends; only line feeds and carriage returns end one."""
    return _LINE_END.split(text)


def _decoded(data: bytes) -> str:
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", "replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")
