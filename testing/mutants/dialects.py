"""Faults of what a vendor says of its language."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

from ...core.dialect import Dialect, MoveWords, Orientation, Wording
from ...core.program.signal import Level, SetSignal, SignalAction, WaitSignal
from ...core.program.speed import Speed
from ...core.program.zone import ContourFraction
from ...core.source.lines.language import LineLanguage
from ...core.vendor import Vendor
from ..checks.subject import Subject
from .mutant import Mutant, has, is_searched, knows_signals, names_targets, sets_outputs, speaks
from .statements import GOLDEN, WORDS
from .wrapping import Plant

WITHIN = ("test_golden_texts_stay_within_the_dialect",)
WORDING = ("test_the_wording_finds_what_texts_say",)
NOT_DRIVEN = ("test_code_that_is_not_driven_stops_a_patch",)
_ALL_SPEEDS = frozenset(one.name for one in fields(Speed)) - {"name"}
_NOTHING = re.compile(r"(?!)(?P<names>)")


def _spoken(change: Callable[[Dialect], Dialect]) -> Plant:
    def plant(vendor: Vendor) -> Vendor:
        return vendor if vendor.speaks is None else replace(vendor, speaks=change(vendor.speaks))

    return plant


def _moves(change: Callable[[MoveWords], MoveWords]) -> Plant:
    def changed(spoken: Dialect) -> Dialect:
        kinds: dict[str, Any] = {
            kind: change(getattr(spoken, kind)) for kind in ("joint", "line", "arc")
        }
        return replace(spoken, **kinds)

    return _spoken(changed)


def _flag(name: str, value: Any) -> Plant:
    changes = {name: value}
    return _spoken(lambda spoken: replace(spoken, **changes))


def _lacks(name: str) -> Callable[[Subject], bool]:
    return lambda suite: suite.vendor.speaks is not None and not getattr(suite.vendor.speaks, name)


def _says(name: str) -> Callable[[Subject], bool]:
    return lambda suite: suite.vendor.speaks is not None and getattr(suite.vendor.speaks, name)


def _lacks_user_frames(suite: Subject) -> bool:
    return _says("work_objects")(suite) and _lacks("user_frames")(suite)


def _lacks_shares(suite: Subject) -> bool:
    return suite.vendor.speaks is not None and ContourFraction not in suite.vendor.speaks.line.zones


def _more_speeds(suite: Subject) -> bool:
    return (
        speaks(suite)
        and suite.vendor.speaks is not None
        and any(
            words.speeds != words.needs
            for words in (suite.vendor.speaks.joint, suite.vendor.speaks.line)
        )
    )


def _outputs_and_signals(suite: Subject) -> bool:
    return sets_outputs(suite) and knows_signals(suite)


def _switched_otherwise(spoken: Dialect) -> Dialect:
    if spoken.outputs is None:
        return spoken
    switch = spoken.outputs.switch
    return replace(spoken, outputs=replace(spoken.outputs, switch=lambda n, on: switch(n, not on)))


def _inverted(action: SignalAction | None) -> SignalAction | None:
    if isinstance(action, SetSignal) and isinstance(action.value, bool):
        return replace(action, value=not action.value)
    if isinstance(action, WaitSignal) and isinstance(action.condition, Level):
        level = action.condition
        return replace(action, condition=Level(level.name, not level.on))
    return action


def _signals_inverted(read: bool, said: bool) -> Plant:
    def changed(spoken: Dialect) -> Dialect:
        words = spoken.signals
        if words is None:
            return spoken
        made = words
        if read:
            made = replace(made, read=lambda text: _inverted(words.read(text)))
        if said:
            made = replace(made, said=lambda action: words.said(_inverted(action) or action))
        return replace(spoken, signals=made)

    return _spoken(changed)


def _wording(change: Callable[[Wording], Wording]) -> Plant:
    def changed(spoken: Dialect) -> Dialect:
        wording = spoken.wording
        return spoken if wording is None else replace(spoken, wording=change(wording))

    return _spoken(changed)


def _needs_a_speed(suite: Subject) -> bool:
    """Whether what is left out becomes a default: not of shares, which are all of the speed then,
    nor of lines where their reader leaves the speed open."""
    spoken = suite.vendor.speaks
    if spoken is None:
        return False
    defaults = isinstance(suite.vendor.reader, LineLanguage) and "tcp" in spoken.line.needs
    return spoken.pace != "joint_fraction" or defaults


def _other_orientation(spoken: Dialect) -> Dialect:
    forms = list(Orientation)
    return replace(spoken, orientation=forms[(forms.index(spoken.orientation) + 1) % len(forms)])


MUTANTS = (
    Mutant(
        "all speeds said to have words",
        _moves(lambda w: replace(w, speeds=_ALL_SPEEDS)),
        WORDS,
        speaks,
    ),
    Mutant(
        "a kind of zone said to have words",
        _moves(lambda w: replace(w, zones=tuple({*w.zones, ContourFraction}))),
        WORDS,
        _lacks_shares,
    ),
    Mutant("zones said to have no words", _moves(lambda w: replace(w, zones=())), WITHIN, speaks),
    Mutant(
        "speeds said to have no words",
        _moves(lambda w: replace(w, speeds=w.needs, exclusive=w.exclusive & w.needs)),
        WITHIN,
        _more_speeds,
    ),
    Mutant("frames said to have words", _flag("work_objects", True), WORDS, _lacks("work_objects")),
    Mutant(
        "frames said to have no words", _flag("work_objects", False), WITHIN, _says("work_objects")
    ),
    Mutant("user frames said to have words", _flag("user_frames", True), WORDS, _lacks_user_frames),
    Mutant(
        "parts of zones said to have words", _flag("zone_parts", True), WORDS, _lacks("zone_parts")
    ),
    Mutant(
        "parts of zones said to have no words",
        _flag("zone_parts", False),
        WITHIN,
        _says("zone_parts"),
    ),
    Mutant(
        "stationary tools said to have words",
        _flag("stationary_tools", True),
        WORDS,
        _lacks("stationary_tools"),
    ),
    Mutant(
        "no speed said to be needed",
        _moves(lambda words: replace(words, needs=frozenset())),
        ("test_speeds_that_are_not_needed_may_be_left_out",),
        _needs_a_speed,
    ),
    Mutant(
        "lengths said in another unit",
        _spoken(lambda spoken: replace(spoken, in_si=not spoken.in_si)),
        WITHIN,
        speaks,
    ),
    Mutant("rotations said in another form", _spoken(_other_orientation), WITHIN, speaks),
    Mutant(
        "configurations said to have no words",
        _moves(lambda words: replace(words, configurations=False)),
        WITHIN,
        has("configuration"),
    ),
    Mutant("greatest speed too low", _flag("fastest", 0.01), WITHIN, speaks),
    Mutant(
        "another sign for comments", _flag("comment", "?? "), ("test_comments_say_nothing",), speaks
    ),
    Mutant(
        "outputs on the way switched the other way",
        _spoken(_switched_otherwise),
        ("test_events_are_written_and_read",),
        _outputs_and_signals,
    ),
    Mutant(
        "signals said the other way",
        _signals_inverted(False, True),
        ("test_signals_are_said_and_understood",),
        knows_signals,
    ),
    Mutant(
        "signals understood and said the other way",
        _signals_inverted(True, True),
        GOLDEN,
        knows_signals,
    ),
    Mutant(
        "motions count as comments",
        _wording(lambda w: replace(w, silent=re.compile(r"[^\n]+"))),
        (*WORDING, *NOT_DRIVEN),
        is_searched,
    ),
    Mutant(
        "comments count as text",
        _wording(lambda w: replace(w, silent=_NOTHING)),
        WORDING,
        is_searched,
    ),
    Mutant(
        "declarations are not found",
        _wording(lambda w: replace(w, targets=_NOTHING)),
        WORDING,
        names_targets,
    ),
    Mutant(
        "names are cut",
        _wording(lambda w: replace(w, name=re.compile(r"[^\W\d]\w?"), named=None)),
        WORDING,
        names_targets,
    ),
)
