"""The numbers of a program's moves as they stand in the arguments of its calls."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from ....core.errors import InputError, MotionError, Span
from ....core.program.move import Move, MoveC, MoveJ
from ....core.program.origin import MoveOrigin, Origin
from ....core.program.speed import Speed
from ....core.program.target import Configuration, PoseTarget, Target
from ....core.program.zone import Fine, Radius, Zone
from ....core.spatial.pose import Pose
from ..motion.configuration import UrConfiguration
from ..syntax.lexer import number_value
from ..values.poses import rotation_vector_of
from ..values.rotations import DECIMALS, nearest_rotation_vector
from ..write.formatting import listing, number
from ..write.operands import blend, gives_shares, shares, speed_arguments
from .places import POSE, QNEAR, TARGET, VIA

Present = Callable[[Span], str]
"""The text at a place."""


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a move's call: what it says and what it shall say.

    Args:
        move: index.
        name: as `calls.MoveCall.written` takes it.
        statement: the call's.
        spans: of its numbers; None for one that no literal states.
        old, new: their values; None for one that is not given.
        pose: the new pose, if it is one.
        turned: whether the pose's rotation changed.
    """

    move: int
    name: str
    statement: Span
    spans: tuple[Span | None, ...]
    old: tuple[float | None, ...]
    new: tuple[float | None, ...]
    pose: Pose | None = None
    turned: bool = False

    @property
    def changed(self) -> bool:
        """Whether any number did."""
        return self.old != self.new or self.turned

    def error(self, message: str) -> MotionError:
        """An error that names move and argument."""
        return MotionError(f"{_WORDS[self.name]}: {message}", self.move, self.statement)

    def texts(self, present: Present) -> tuple[str | None, ...]:
        """What is to stand in the place of each number: what is there, where it says so already.

        None for a number that no literal states and that does not change.
        """
        new = self.values(present)
        texts: list[str | None] = []
        for span, old, value in zip(self.spans, self.old, new, strict=True):
            if value == old:
                texts.append(None if span is None else present(span))
            else:
                texts.append(number(0.0 if value is None else value))
        return tuple(texts)

    def literal(self, present: Present) -> str:
        """The whole argument as a literal."""
        values = [0.0 if value is None else value for value in self.values(present)]
        if len(values) == 1:
            return number(values[0])
        return ("p" if self.pose is not None else "") + listing(values)

    def values(self, present: Present) -> tuple[float | None, ...]:
        """The new values; a rotation vector is the one nearest to that which stands there."""
        if self.pose is None or not self.turned:
            return self.new
        near = [number_value(present(span)) for span in self.spans[3:6] if span is not None]
        if len(near) < 3:
            return self.new
        turned = nearest_rotation_vector(self.pose.quaternion, near)
        return (*self.new[:3], *(round(value, DECIMALS) for value in turned))


_WORDS = {
    POSE: "target",
    TARGET: "target",
    QNEAR: "configuration of the target (qnear)",
    VIA: "auxiliary point",
    "a": "acceleration (a)",
    "v": "speed (v)",
    "t": "duration (t)",
    "r": "blend radius (r)",
}
_CHANGEABLE = ("target", "via", "speed", "zone")


def arguments(index: int, old: Move, new: Move) -> Iterator[Argument]:
    """The arguments of a move that could change.

    Args:
        index: of the move.
        old: as it was read.
        new: as it shall be read.

    Raises:
        MotionError: something changed that has no place in the call.
    """
    origin = old.origin
    if origin is None:
        raise MotionError("it is not known where the move stands in its source", index)
    try:
        if new != old:
            _check(old, new)
        yield from _goal(index, origin, origin.target, old.target, new.target)
        if isinstance(old, MoveC) and isinstance(new, MoveC) and origin.via is not None:
            spans = _spans(origin.via, 6)
            yield _pose(index, VIA, origin, spans, old.via.pose, new.via.pose)
        yield from _speed(index, origin, old, new)
        radii = (_radius(old.zone),), (_radius(new.zone),)
        yield Argument(index, "r", origin.statement, _spans(origin.zone, 1), *radii)
    except InputError as error:
        raise MotionError(str(error), index, origin.statement) from None


def _check(old: Move, new: Move) -> None:
    same = {name: getattr(old, name) for name in _CHANGEABLE if hasattr(old, name)}
    if replace(new, **same) != old:
        raise InputError(
            "a patch changes targets, zones and speeds; here something else changed: write the "
            "program as a new file"
        )
    blend(new.zone)
    if new.speed != old.speed:
        arguments_of = shares if gives_shares(old.speed) else speed_arguments
        arguments_of(new)


def _spans(origin: Origin, count: int) -> tuple[Span | None, ...]:
    return origin.numbers if len(origin.numbers) == count else (None,) * count


def _goal(
    index: int, origin: MoveOrigin, at: Origin, old: Target, new: Target
) -> Iterator[Argument]:
    if type(old) is not type(new) or old.external != new.external:
        raise InputError("a patch makes no pose of joint values or the other way round")
    if not (isinstance(old, PoseTarget) and isinstance(new, PoseTarget)):
        assert not isinstance(old, PoseTarget) and not isinstance(new, PoseTarget)
        if len(old.joints) != len(new.joints):
            raise InputError(f"the target has {len(new.joints)} joints instead of 6")
        spans = _spans(at, len(old.joints))
        yield Argument(index, TARGET, origin.statement, spans, old.joints, new.joints)
        return
    near = _near(old.configuration), _near(new.configuration)
    spans = _spans(at, 12) if len(at.numbers) > 6 else (*_spans(at, 6), *[None] * 6)
    yield _pose(index, POSE, origin, spans[:6], old.pose, new.pose)
    if near[0] is None and near[1] is None:
        return
    if near[0] is None or near[1] is None:
        raise InputError("a patch neither adds nor takes away a qnear")
    yield Argument(index, QNEAR, origin.statement, spans[6:], near[0], near[1])


def _near(configuration: Configuration | None) -> tuple[float, ...] | None:
    if configuration is None:
        return None
    if not isinstance(configuration, UrConfiguration):
        raise InputError(f"{configuration} is no qnear: label the target for this robot")
    return configuration.joints


def _pose(
    index: int,
    name: str,
    origin: MoveOrigin,
    spans: tuple[Span | None, ...],
    old: Pose,
    new: Pose,
) -> Argument:
    turned = old.quaternion != new.quaternion
    before = (*old.position, *rotation_vector_of(old.quaternion))
    after = (*new.position, *rotation_vector_of(new.quaternion))
    return Argument(index, name, origin.statement, spans, before, after, new, turned)


def _speed(index: int, origin: MoveOrigin, old: Move, new: Move) -> Iterator[Argument]:
    spans = _spans(origin.speed, 3)
    values = zip(_speeds(old, old.speed), _speeds(old, new.speed), strict=True)
    for name, span, (before, after) in zip(("a", "v", "t"), spans, values, strict=True):
        # Where a duration takes their place, speed and acceleration may say what they like.
        wanted = before if after is None and name != "t" else after
        yield Argument(index, name, origin.statement, (span,), (before,), (wanted,))


def _speeds(move: Move, speed: Speed) -> tuple[float | None, float | None, float | None]:
    """a, v and t as the move's call gives them."""
    if gives_shares(move.speed):
        return speed.joint_acceleration_fraction, speed.joint_fraction, speed.duration
    if isinstance(move, MoveJ):
        return speed.joint_acceleration, speed.joint, speed.duration
    return speed.tcp_acceleration, speed.tcp, speed.duration


def _radius(zone: Zone) -> float:
    assert isinstance(zone, Fine | Radius)
    return 0.0 if isinstance(zone, Fine) else zone.tcp
