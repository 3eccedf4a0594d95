"""Texts that break careless readers: deep nests, huge numbers, bytes that are no text."""

from __future__ import annotations

import re
from collections.abc import Iterator
from random import Random

DEPTH = 3_000
SIGNS = " \n;:=,.()[]{}\"'!&#%+-*/\\<>09azAZ_\x00\ufeff"

NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?")
OPENERS = (
    "(",
    "[",
    "{",
    "((",
    "-",
    "NOT ",
    "not ",
    "f(",
    "p[",
    "x[",
    "{X ",
    "IF TRUE THEN\n",
    "if True:\n",
    "WHILE TRUE DO\n",
    "WHILE TRUE\n",
    "while True:\n",
    "LOOP\n",
    "REPEAT\n",
    "FOR i FROM 1 TO 2 DO\n",
    "FOR I=1 TO 2\n",
    "TEST 1\nCASE 1:\n",
    "SWITCH 1\nCASE 1\n",
    "def f():\n",
    "thread t():\n",
    "PROC p()\n",
    "DEF p()\n",
    "MODULE m\n",
    "RECORD r\n",
    "STRUC s INT a,",
    ";FOLD\n",
    '"',
    "'",
    "!",
    "\\",
    "$",
    "#",
    "x.",
    "x:=",
    "x=",
    "1+",
    "1:",
    "f(1,",
)
HUGE = ("9" * 1_000_000, "1e999", "-1e999", "1e-999", "0." + "3" * 100_000, "0x" + "F" * 100_000)
ODD = ("\x00", "\ufeff", "\ud800", "\U0010ffff", "\x1a", "\x85", "\u2028", "١٢٣", "ﬀ", "İ")


def hostile_texts() -> Iterator[str]:
    """Texts in no language."""
    for opener in OPENERS:
        yield opener * DEPTH
    for lengthy in ("x", "1", "_", " ", "\t", "\n", "\r", ";", '"'):
        yield lengthy * 200_000
    for odd in ODD:
        yield odd
        yield odd * 1000
    chance = Random(1)
    yield "".join(chance.choices(SIGNS, k=200_000))
    yield "".join(chance.choices("+-*/<>=&|^~:.,", k=200_000))


def hostile_variants(text: str) -> Iterator[str]:
    """A program's text with one hostile stretch in it: at a number, at a line, anywhere."""
    numbers = list(NUMBER.finditer(text))
    lines = [match.end() for match in re.finditer("\n", text)]
    middle_line = lines[len(lines) // 2] if lines else len(text)
    if numbers:
        at = numbers[len(numbers) // 2]
        for number in HUGE:
            yield text[: at.start()] + number + text[at.end() :]
        for opener in OPENERS:
            yield text[: at.start()] + opener * DEPTH + text[at.start() :]
        for opening, closing in ("()", "[]", "{}"):
            nest = opening * DEPTH + at.group() + closing * DEPTH
            yield text[: at.start()] + nest + text[at.end() :]
        yield text[: at.end()] + ("+" + at.group()) * DEPTH + text[at.end() :]
        for odd in ODD:
            yield text[: at.start()] + odd + text[at.start() :]
    for opener in OPENERS:
        yield text[:middle_line] + opener * DEPTH + "\n" + text[middle_line:]
    for odd in ODD:
        yield text[:middle_line] + odd + text[middle_line:]
        yield odd + text
    for name in re.findall(r"[A-Za-z_]\w+", text)[:: max(1, len(numbers) // 20 + 1)][:20]:
        yield text.replace(name, name * 100_000, 1)
        yield text.replace(name, "", 1)
