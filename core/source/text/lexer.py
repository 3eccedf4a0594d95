"""What the lexers of all languages do alike."""

from __future__ import annotations

UNCLOSED = "this string has no closing quote on its line"


def words(text: str) -> frozenset[str]:
    """The words of a text, for tables of names."""
    return frozenset(text.split())


def stray(character: str, text: str, instead: str = "") -> str:
    """The message for a character that no token begins with.

    Args:
        character: as it stands in the file.
        text: what the file should be: "a RAPID text".
        instead: what may help with a file that is binary.
    """
    if character == "\0" or not character.isprintable():
        where = f"character {ord(character):#04x} does not belong in {text}"
        return f"{where}: the file is binary or damaged{instead}"
    return f"{character!r} does not belong here"
