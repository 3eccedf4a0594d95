"""Stations of two robots at random, that cross, under interlocks or not, or hand over a part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .files import MAKES, Await, Go, Grip, Member, Rest, Say, Step, Turn, write_station

CLEARANCE = 0.01
REACH = np.array([0.3, 0.35, 0.35, 0.8, 0.5, 1.0])
"""rad by which joints are turned from where the arm reaches to its front."""
ACROSS = 1.6
"""m between robots that hand over a part, and its length."""
LENGTH = 0.4
PART = """[[part]]
name = "bar"
box_mm = [400, 60, 60]
pose = {{ xyz_mm = [{place}] }}
mass_kg = 2
attach = '{attach}'
release = '{release}'
"""
HAND_OVER = '[[hand_over]]\npart = "one.bar"\nto = "two.bar"\n'


@dataclass(frozen=True)
class RandomStation:
    """A station as files.

    Args:
        file: the station file.
        makes: of its robots.
        hands: the moves of the giver behind which it takes the part and lets go of it, and the
            taker's behind which that takes it; None where nothing is handed over.
    """

    file: Path
    makes: tuple[str, str]
    hands: tuple[int, int, int] | None = None


def random_station(folder: Path, seed: int) -> RandomStation:
    """One station; of every fourth seed it is one in which a part is handed over.

    Args:
        folder: that gets its files.
        seed: of all that is random.
    """
    rng = np.random.default_rng(seed)
    makes = tuple(str(name) for name in rng.choice(list(MAKES), 2))
    write = _handing if seed % 4 == 0 else _crossing
    return write(folder, rng, makes)


def _delays(rng: np.random.Generator) -> tuple[float, float]:
    low, more = rng.uniform(0.0, 0.03), rng.uniform(0.0, 0.05)
    return round(float(low), 4), round(float(low + more), 4)


# Crossing


def _crossing(folder: Path, rng: np.random.Generator, makes: Sequence[str]) -> RandomStation:
    """The one reaches over and gives the space free, now and then too early; the other comes, and
    may give it back."""
    one, two = (_Mover(rng, make) for make in makes)
    kind = rng.choice(["free", "after", "and back"], p=[0.35, 0.35, 0.3])
    first = [one.out(), *one.ins(), one.out(), one.out()]
    second = [two.out(), two.out(), *two.ins(), two.out()]
    begins = 0.0
    if kind == "free":
        begins = round(float(rng.uniform(0.0, 6.0)), 3)
    else:
        _put(first, Say(1), 1 + int(rng.integers(1 if rng.random() < 0.3 else 2, 3)))
        _put(second, Await(1), 1 + int(rng.random() < 0.9))
    if kind == "and back":
        early = rng.random() < 0.3
        second += [two.ins()[0]] * early + [Say(2), two.out()]
        first += [Await(2), *one.ins(), one.out()]
    file = write_station(
        folder,
        Member(makes[0], first),
        Member(makes[1], second),
        round(float(rng.uniform(1.3, 2.2)), 3),
        clearance=CLEARANCE,
        delays=_delays(rng),
        begins=begins,
    )
    return RandomStation(file, (makes[0], makes[1]))


def _put(steps: list[Step], step: Step, behind: int) -> None:
    """Put a step behind some moves."""
    moves = [k for k, known in enumerate(steps) if isinstance(known, Turn | Go)]
    steps.insert(moves[min(behind, len(moves)) - 1] + 1, step)


@dataclass
class _Mover:
    rng: np.random.Generator
    make: str

    def _zone(self) -> float:
        return round(float(self.rng.uniform(0.01, 0.12)), 4) * (self.rng.random() < 0.65)

    def _turned(self, first: float) -> Turn:
        q = np.array(MAKES[self.make].home) + REACH * self.rng.uniform(-1.0, 1.0, 6)
        q[0] = first
        return Turn(tuple(q.tolist()), self._zone())

    def out(self) -> Turn:
        """Turned to a side."""
        return self._turned(float(self.rng.choice([-1.0, 1.0]) * self.rng.uniform(0.8, 1.6)))

    def ins(self) -> list[Step]:
        """One move to the front or two, the second on a line."""
        first = self._turned(float(self.rng.uniform(-0.4, 0.4)))
        if self.rng.random() < 0.4:
            return [first]
        x, y, z = self.rng.uniform([0.6, -0.4, 0.25], [1.0, 0.4, 0.6]).round(4).tolist()
        begin = Go((x, y, z), self._zone(), straight=False)
        end = Go((x, round(y - 0.2 * np.sign(y), 4), round(z + 0.1, 4)), self._zone())
        return [begin, end]


# Handing over


def _handing(folder: Path, rng: np.random.Generator, makes: Sequence[str]) -> RandomStation:
    """A bar that the one holds up to the other, which takes it at its other end."""
    left_out = str(rng.choice(["none", "brought", "held", "away"], p=[0.7, 0.1, 0.1, 0.1]))
    early = rng.random() < 0.15
    z = round(float(rng.uniform(0.3, 0.5)), 4)
    back = round(float(rng.uniform(0.45, 0.75)), 4)
    side = round(float(rng.uniform(0.55, 0.75)), 4)
    rests = [Rest(round(float(rng.uniform(0.0, 0.4)), 3)) for _ in range(4)]
    until: dict[str, Step] = {
        name: Await(k) if name != left_out else Rest(0.01)
        for k, name in enumerate(("brought", "away", "held"), 1)
    }
    up, far = round(z + 0.1, 4), -0.45
    away: list[Step] = [Go((back, 0.0, up), speed=0.4)]
    away.insert(0 if early else 1, Say(2))
    giver: list[Step] = [
        Turn(_aside(makes[0], -1.0)),
        Go((0.65, far, 0.25), straight=False),
        Go((0.65, far, 0.12), speed=0.15),
        Grip(True),
        Go((0.65, far, z), speed=0.4),
        Go((0.65, 0.0, z), speed=0.4),
        Say(1),
        until["held"],
        rests[0],
        Grip(False),
        rests[1],
        *away,
        Go((0.65, far, up), speed=0.4),
    ]
    taker: list[Step] = [
        Turn(_aside(makes[1], -1.2)),
        Go((0.65, far, up), straight=False),
        until["brought"],
        rests[2],
        Go((side, 0.0, up), speed=0.4),
        Go((0.65, 0.0, z), speed=0.15),
        Grip(True),
        Say(3),
        until["away"],
        rests[3],
        Go((0.65, 0.0, up), speed=0.4),
        Go((0.65, far, up), speed=0.4),
    ]
    one, two = (
        Member(
            make,
            steps,
            PART.format(place=place, attach=MAKES[make].grip[0], release=MAKES[make].grip[1]),
        )
        for make, steps, place in (
            (makes[0], giver, f"800, {1e3 * far}, 90"),
            (makes[1], taker, f"800, 0, {1e3 * z - 30:g}"),
        )
    )
    file = write_station(
        folder,
        one,
        two,
        ACROSS,
        clearance=CLEARANCE / 2,
        delays=_delays(rng),
        radius=round(float(rng.choice([0.03, rng.uniform(0.02, 0.15)])), 4),
        rest=HAND_OVER,
    )
    return RandomStation(file, (makes[0], makes[1]), (2, 4, 3))


def _aside(make: str, first: float) -> tuple[float, ...]:
    return (first, *MAKES[make].drawn_back[1:])
