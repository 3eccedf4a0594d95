"""Robots by the names that people and controllers write: ``IRB 120``, ``#KR210R2700_2 C4 FLR``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from difflib import SequenceMatcher
from functools import lru_cache

from .arm_list import Listed

_ROUNDED = 0.51
"""Of its last digit, by which a reach may be off that a name rounds: an IRB 120-3/0.6 reaches
0.58 m."""
_LONGEST = 6.0
"""m, above which a number of a name is no reach."""
_BESIDE = re.compile(
    r"\b(c[245](sr)?|sr|flr|clg|wll|floor|ceiling|wall|type [a-h]\d?|abb|kuka|fanuc|ur(?=/)"
    r"|universal|robots?|cb\d?|krc ?\d|irc ?\d|omnicore|agilus|quantec|cybertech|fortec|iontec)\b"
)
"""Words of controllers, mountings, makers and families that are no part of a model's name."""
_FAMILIES = {"gofa": "crb 15000", "yumi": "irb 14000"}
"""What makers call a family, and the model it is."""
_MODEL = re.compile(r"\d{5}")
"""A model of such a family, named beside it: IRB 14050 YuMi."""
_WORD = re.compile(r"\d+(?:\.\d+)?[a-z]*|[a-z]+")
_GENERATION = 9.0
"""Up to which a number that is no payload tells a generation: KR 210 R2700-2."""
_ALIKE = 0.5
"""Of two names, from 0 to 1, from which on one may be the other mistyped."""
_VARIANT = re.compile(r"(?:_+g)?_+0\d$")
"""Of the libraries of simulators: ``IRB120_3_58_01``, ``IRB4600_40_255_G_01``."""


@lru_cache(maxsize=4096)  # names of listed arms are looked at for every name that is sought
def words_of(name: str) -> tuple[str, ...]:
    """What a name consists of: ``IRB 120T-3/0.58`` is irb, 120t, 3 and 0.58."""
    said = _VARIANT.sub("", name.strip().lower().replace(",", "."))
    said = _BESIDE.sub(" ", re.sub(r"[#_/\-]", " ", said))
    said = said.replace("lean id", "lid").replace("leanid", "lid")  # as controllers write it
    for family, model in _FAMILIES.items():
        said = said.replace(family, " " if _MODEL.search(said) else model)
    said = re.sub(r"(?<=\d)r(?=\d{3,4})", " r ", said)
    said = re.sub(r"\b(r ?\d{3,4})(?=[a-z]+)", r"\1 ", said)
    said = re.sub(r"(?<=\d)(kg|mm?)\b", " ", said)
    said = re.sub(r"(?<=\d)(?=[a-z]{3})", " ", said)  # KR5ARC
    said = re.sub(r"\bur (?=\d)", "ur", said)
    said = re.sub(r"\b(ur\d+) e\b", r"\1e", said)
    words = _WORD.findall(said)
    return tuple(word for k, word in enumerate(words) if k == 0 or word != words[k - 1])


def matching(name: str, arms: Iterable[Listed]) -> list[Listed]:
    """The arms that a name may mean: called so; else those whose names begin so, or hold its words.

    What stands before the first number (IRB, KR) need not be said.
    """
    asked = words_of(name)
    if not asked:
        return []
    written = _bare(name)
    ranked = [(rank, arm) for arm in arms if (rank := _rank(written, asked, arm)) is not None]
    best = min((rank for rank, _ in ranked), default=None)
    return [arm for rank, arm in ranked if rank == best]


def meant(name: str, arm: Listed) -> bool:
    """Whether a name that matches an arm can mean no sister of it that is not listed.

    Left out may be payload and reach, and what stands before the first number. A variant
    (``LID``, ``PA``, ``-2``) is another arm than the one without it.
    """
    asked = words_of(name)
    if _rank(_bare(name), asked, arm) == _CALLED:
        return True
    return any(_only_figures(asked, words_of(model), arm) for model in (arm.model, *arm.aliases))


def _only_figures(asked: Sequence[str], said: Sequence[str], arm: Listed) -> bool:
    """Whether the words of a model that are not asked for tell payload or reach alone."""
    rest = list(asked)
    for k, word in enumerate(said):
        if rest and _same(rest[0], word):
            del rest[0]
        elif any(w[0].isdigit() for w in said[:k]) and not _is_figure(word, arm):
            return False
    return not rest


def _is_figure(word: str, arm: Listed) -> bool:
    try:
        value = float(word)
    except ValueError:
        return word == "r"  # R2700
    return "." in word or value > _GENERATION or value == arm.payload


def near(name: str, arms: Iterable[Listed], count: int) -> list[Listed]:
    """The arms whose names are most like one that none has; the model counts before its figures."""
    asked = words_of(name)
    if not asked:
        return []
    ranked = [(_likeness(asked, words_of(arm.model)), arm) for arm in arms]
    ranked = [(alike, arm) for alike, arm in ranked if alike[0] >= _ALIKE]
    ranked.sort(key=lambda one: one[0], reverse=True)
    return [arm for _, arm in ranked[:count]]


def _likeness(asked: tuple[str, ...], said: tuple[str, ...]) -> tuple[float, float]:
    """How much alike the models are, and the whole names, from 0 to 1."""
    models = (_model(asked), _model(said))
    return _ratio(*models), _ratio(" ".join(asked), " ".join(said))


def _model(words: tuple[str, ...]) -> str:
    """Family and model: what stands up to the first number."""
    number = next((k for k, word in enumerate(words) if word[-1].isdigit() or word[0].isdigit()), 0)
    return "".join(words[: number + 1])


def _ratio(one: str, other: str) -> float:
    return SequenceMatcher(None, one, other, autojunk=False).ratio()


_CALLED, _BEGINS, _HOLDS = range(3)


def _bare(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


def _rank(written: str, asked: tuple[str, ...], arm: Listed) -> int | None:
    if asked == words_of(arm.name.partition("/")[2]):
        return _CALLED
    # What is said of the controller tells arms apart whose words are the same.
    whole = written != "".join(asked).replace(".", "")
    if whole and any(_bare(alias).startswith(written) for alias in arm.aliases):
        return _CALLED
    found = []
    for model in (arm.model, *arm.aliases):
        said = words_of(model)
        number = next((k for k, word in enumerate(said) if word[0].isdigit()), 0)
        for words in (said, said[number:]):
            begins = len(asked) <= len(words) and all(map(_same, asked, words))
            if begins:
                found.append(_CALLED if len(asked) == len(words) else _BEGINS)
        if sorted(asked) == sorted(said):  # KR 210 R3300 K ultra
            found.append(_CALLED)
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
    decimals = min(_decimals(asked), _decimals(said))
    if "." in said and "." not in asked:
        a /= 100.0  # libraries of simulators have reaches in cm
        decimals = min(2, _decimals(said))
    lengths = "." in said and max(a, b) < _LONGEST
    return a == b or (lengths and abs(a - b) < _ROUNDED * 10.0**-decimals)


def _decimals(word: str) -> int:
    return len(word.partition(".")[2])


def described(arm: Listed) -> str:
    """An arm with what tells it from its sisters."""
    facts = [f"{arm.payload:g} kg"] if arm.payload is not None else []
    facts += [f"{arm.reach:g} m"] if arm.reach is not None else []
    return f"{arm.name} ({', '.join(facts)})" if facts else arm.name
