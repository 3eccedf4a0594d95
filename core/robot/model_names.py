"""Robots by the names that people and controllers write: ``IRB 120``, ``#KR210R2700_2 C4 FLR``."""

from __future__ import annotations

import re
from collections.abc import Iterable

from .arm_list import Listed

_NEAR = 0.051
"""m by which reaches may differ that names round: an IRB 120-3/0.6 reaches 0.58 m."""
_LONGEST = 6.0
"""m, above which a number of a name is no reach."""
_MOUNTED = re.compile(r"\b(c[245]|sr|flr|clg|wll|floor|ceiling|wall|abb|kuka|ur(?=/)|fanuc)\b")
"""Words of controllers and makers that are no part of a model's name."""
_WORD = re.compile(r"\d+(?:\.\d+)?[a-z]*|[a-z]+")


def words_of(name: str) -> tuple[str, ...]:
    """What a name consists of: ``IRB 120T-3/0.58`` is irb, 120t, 3 and 0.58."""
    spaced = re.sub(r"(?<=\d)r(?=\d{3,4})", " r ", name.lower().replace(",", "."))
    return tuple(_WORD.findall(_MOUNTED.sub(" ", re.sub(r"[#_/\-]", " ", spaced))))


def matching(name: str, arms: Iterable[Listed]) -> list[Listed]:
    """The arms that a name may mean: called so; else those whose names begin so, or hold its words.

    What stands before the first number (IRB, KR) need not be said.
    """
    asked = words_of(name)
    if not asked:
        return []
    ranked = [(rank, arm) for arm in arms if (rank := _rank(asked, arm)) is not None]
    best = min((rank for rank, _ in ranked), default=None)
    return [arm for rank, arm in ranked if rank == best]


_CALLED, _BEGINS, _HOLDS = range(3)


def _rank(asked: tuple[str, ...], arm: Listed) -> int | None:
    if asked == words_of(arm.name.partition("/")[2]):
        return _CALLED
    found = []
    for model in (arm.model, *arm.aliases):
        said = words_of(model)
        number = next((k for k, word in enumerate(said) if word[0].isdigit()), 0)
        for words in (said, said[number:]):
            begins = len(asked) <= len(words) and all(map(_same, asked, words))
            if begins:
                found.append(_CALLED if len(asked) == len(words) else _BEGINS)
        rest = iter(said)
        if all(any(_same(word, other) for other in rest) for word in asked):
            found.append(_HOLDS)
    return min(found, default=None)


def _same(asked: str, said: str) -> bool:
    if asked == said:
        return True
    try:
        a, b = float(asked), float(said)
    except ValueError:
        return False
    lengths = "." in asked and "." in said and max(a, b) < _LONGEST
    return a == b or (lengths and abs(a - b) < _NEAR)


def described(arm: Listed) -> str:
    """An arm with what tells it from its sisters."""
    facts = [f"{arm.payload:g} kg"] if arm.payload is not None else []
    facts += [f"{arm.reach:g} m"] if arm.reach is not None else []
    return f"{arm.name} ({', '.join(facts)})" if facts else arm.name
