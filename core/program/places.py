"""Where the moves of folded programs go: targets that counters and arguments move on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from .move import Move, MoveC, MoveJ, MoveL, Statement
from .target import Configuration, PoseTarget, Target

Vector = tuple[float, float, float]
Steps = tuple[tuple[tuple[int, int], Vector], ...]
"""By loop, how far a target moves on in each pass, m. A loop is known by the calls between it and
the target, and by its level among the loops of its routine."""

NEAR = 1e-8
"""m within which places are one: a hundredth of a micrometre."""
_NOWHERE: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Argument:
    """A target that a routine is given.

    Args:
        number: of the argument, from 0.
        joints: whether it is joint values.
    """

    number: int
    joints: bool = False


@dataclass(frozen=True, slots=True)
class Destination:
    """Where a line of a program goes.

    Args:
        base: a target, or an argument.
        offset: from there, m in the axes of the work object.
        steps: by the level of a loop that counts, how far it moves on in each of its passes.
    """

    base: Target | Argument
    offset: Vector = _NOWHERE
    steps: tuple[tuple[int, Vector], ...] = ()

    @property
    def plain(self) -> bool:
        """Whether it is its base."""
        return self.offset == _NOWHERE and not self.steps

    @property
    def fixed(self) -> bool:
        """Whether it is a target of its own."""
        return self.plain and not isinstance(self.base, Argument)


@dataclass(frozen=True, slots=True)
class Slot:
    """A target of a statement, in the first pass of all loops.

    Args:
        target: there.
        steps: of the loops round it.
        base: the named target from which it was computed, and from which it is written.
    """

    target: Target
    steps: Steps = ()
    base: Target | None = None

    @property
    def own(self) -> Destination:
        """The place in the first pass."""
        if self.base is None:
            return Destination(self.target)
        return Destination(self.base, rounded(between(self.base, self.target)))

    def kin(self, other: Slot) -> bool:
        """Whether both may be said by one line, given other arguments."""
        one, two = self.target, other.target
        if type(one) is not type(two) or not _same_steps(self.steps, other.steps):
            return False
        if not isinstance(one, PoseTarget) or not isinstance(two, PoseTarget):
            return True
        # A hint of where to look first is written at the move, not with its target.
        mine, yours = one.configuration, two.configuration
        if mine is None or yours is None:
            return mine is yours
        return mine.hint == yours.hint and (not mine.hint or mine == yours)

    def from_outside(self) -> Slot:
        """As it is seen from where the routine is called."""
        steps = tuple(((calls - 1, level), by) for (calls, level), by in self.steps if calls)
        return replace(self, steps=steps)

    def place(self, base: Destination | None, levels: Mapping[int, int]) -> Destination:
        """Where the line goes that says it.

        Args:
            base: what its routine makes of it; None where it stands as it is.
            levels: of the loops that count round it, as they are written.
        """
        steps = tuple((levels[level], by) for (calls, level), by in self.steps if not calls)
        made = self.own if base is None else base
        return replace(made, steps=steps)


def blanked(statement: Statement) -> Statement:
    """A statement without its targets."""
    if not isinstance(statement, MoveJ | MoveL | MoveC):
        return statement
    if isinstance(statement, MoveC):
        return replace(statement, target=_BLANK, via=_BLANK, origin=None)
    return replace(statement, target=_BLANK, origin=None)


_BLANK = PoseTarget(pose=None)  # type: ignore[arg-type]


Named = Mapping[str, Sequence[Move]]
"""Moves to targets that have a name, by this, folded."""


def slots_of(statement: Statement, named: Named) -> tuple[Slot, ...]:
    """The targets of a statement: where it goes to, and through."""
    if not isinstance(statement, MoveJ | MoveL | MoveC):
        return ()
    goal = Slot(statement.target, base=_base(statement, named))
    return (goal, Slot(statement.via)) if isinstance(statement, MoveC) else (goal,)


def _base(move: Move, named: Named) -> Target | None:
    """The named target that a move's was computed from, if only its position differs."""
    name = None if move.origin is None else move.origin.target.base
    for other in named.get(name or "", ()):
        line = not isinstance(move, MoveJ)
        same = other.work_object == move.work_object
        if same and turned_alike(other.target, move.target, unstated=line):
            return other.target
    return None


def unnamed(target: Target) -> Target:
    """A target without its name."""
    return replace(target, name=None)


def turned_alike(one: Target, other: Target, unstated: bool = False) -> bool:
    """Whether two targets are poses that differ in their position alone.

    Args:
        unstated: whether the configuration of the first also does for another that states none.
    """
    if not isinstance(one, PoseTarget) or not isinstance(other, PoseTarget):
        return False
    mine, yours = stated(one), stated(other)
    return (
        one.pose.quaternion == other.pose.quaternion
        and (mine == yours or (unstated and yours is None))
        and one.external == other.external
        and one.arm_angle == other.arm_angle
    )


def stated(target: PoseTarget) -> Configuration | None:
    """The configuration that is written with a target."""
    found = target.configuration
    return None if found is None or found.hint else found


def between(one: Target, other: Target) -> Vector:
    """From a pose's position to another's, m."""
    assert isinstance(one, PoseTarget)
    assert isinstance(other, PoseTarget)
    x, y, z = (b - a for a, b in zip(one.pose.position, other.pose.position, strict=True))
    return x, y, z


def near(one: Vector, other: Vector) -> bool:
    """Whether two stretches are one."""
    return all(abs(a - b) < NEAR for a, b in zip(one, other, strict=True))


def rounded(vector: Vector) -> Vector:
    """A stretch without the rounding of sums and differences."""
    x, y, z = (round(value, 10) + 0.0 for value in vector)
    return x, y, z


def constant(slots: Sequence[Slot]) -> bool:
    """Whether all go to one target, whatever it is called."""
    first = unnamed(slots[0].target)
    return all(unnamed(slot.target) == first for slot in slots)


def moved_on(slots: Sequence[Slot], loop: tuple[int, int], exact: bool) -> Slot | None:
    """The slot of all passes of a loop; None if it does not move on evenly.

    Args:
        slots: of each pass.
        loop: see `Steps`.
        exact: whether it may not move on.
    """
    first = slots[0]
    if constant(slots):
        return first
    if exact or not all(turned_alike(first.target, slot.target) for slot in slots):
        return None
    step = between(first.target, slots[1].target)
    for number, slot in enumerate(slots):
        x, y, z = (number * value for value in step)
        if not near((x, y, z), between(first.target, slot.target)):
            return None
    return replace(first, steps=(*first.steps, (loop, rounded(step))))


def _same_steps(one: Steps, other: Steps) -> bool:
    return len(one) == len(other) and all(
        a == b and near(by, far) for (a, by), (b, far) in zip(one, other, strict=True)
    )
