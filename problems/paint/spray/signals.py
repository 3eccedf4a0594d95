"""The gun as part of the program: outputs that are set where the TCP passes a waypoint.

A signal is sent ahead of the place by as long as paint takes from the signal to the part, so that
the coat begins and ends where it should. The controller looks that far ahead by itself: the event
has a place and a time (RAPID ``TriggIO``, KRL ``TRIGGER WHEN … DELAY``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ....core.dialect import OutputWords
from ....core.errors import InputError
from ....core.program.event import Event
from ....core.vendor import Vendor
from ...checks import not_negative, positive
from .trajectory import PaintTrajectory

_SAME_FLOW = 1e-6


@dataclass(frozen=True, slots=True)
class GunSignals:
    """Outputs of the controller that drive a gun.

    Args:
        switch: output that turns it on and off, by the name that the user's controller has for
            it (``doGun`` in RAPID, a number or a declared name in KRL).
        flow: output that sets the paint flow; None where the flow is constant.
        nominal_flow: value of ``flow`` at the nominal flow.
        delay: s from the signal until paint arrives or ends; what is compensated.

    Raises:
        InputError: an empty name, or a number out of its range.
    """

    switch: str
    flow: str | None = None
    nominal_flow: float = 1.0
    delay: float = 0.0

    def __post_init__(self) -> None:
        if not self.switch.strip() or (self.flow is not None and not self.flow.strip()):
            raise InputError("GunSignals: an output needs a name")
        positive("GunSignals.nominal_flow", self.nominal_flow)
        not_negative("GunSignals.delay", self.delay)


def gun_events(
    trajectory: PaintTrajectory, signals: GunSignals, vendor: Vendor
) -> tuple[tuple[Event, ...], ...]:
    """What happens where the TCP passes each waypoint: (W,) tuples, most of them empty.

    Args:
        trajectory: whose flow it is; before and after it the gun is off.
        signals: the outputs.
        vendor: in whose language the program is written.

    Raises:
        InputError: the language has no actions on the way, the delay is longer than it takes, or
            the flow changes and there is no output for it.
    """
    words = output_words(signals, vendor)
    flow = np.concatenate(([0.0], trajectory.flow, [0.0]))
    return tuple(
        tuple(Event(text, time=signals.delay) for text in _actions(before, after, signals, words))
        for before, after in pairwise(flow)
    )


def _actions(before: float, after: float, signals: GunSignals, words: OutputWords) -> Sequence[str]:
    """Texts of the events where the flow changes from one value to another; flow before on."""
    texts = []
    changed = abs(after - before) > _SAME_FLOW
    if changed and after > 0.0:
        if signals.flow is not None:
            texts.append(words.level(signals.flow, after * signals.nominal_flow))
        elif before > 0.0 or abs(after - 1.0) > _SAME_FLOW:
            raise InputError(
                f"the flow changes to {after:g} of the nominal one, and the gun has no output for "
                "it: name one, or keep the flow at 1"
            )
    if (after > 0.0) != (before > 0.0):
        texts.append(words.switch(signals.switch, after > 0.0))
    return texts


def output_words(signals: GunSignals, vendor: Vendor) -> OutputWords:
    """How a vendor's language sets the gun's outputs on the way.

    Raises:
        InputError: it has no actions on the way, or the delay is longer than it takes.
    """
    words = None if vendor.speaks is None else vendor.speaks.outputs
    if words is None:
        raise InputError(
            f"the language of {vendor.name} has no actions at a place of the path, so the gun "
            "cannot be switched where it should: leave its signals out and have the gun switched "
            "by other means, or take a robot of another vendor"
        )
    if signals.delay > words.longest_lead:
        raise InputError(
            f"{vendor.name} sets outputs up to {words.longest_lead:g} s ahead, the gun's delay is "
            f"{signals.delay:g} s: let the gun's own controller take the rest"
        )
    return words
