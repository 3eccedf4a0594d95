"""The numbers of a program's moves as they stand in the arguments of its calls."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from ....core.errors import InputError, Span
from ....core.program.move import MoveJ
from ....core.program.speed import Speed
from ....core.program.target import Configuration, PoseTarget, Target
from ....core.program.zone import Fine, Radius, Zone
from ....core.source.patch.plan import Wish
from ....core.source.patch.uses import Use, UseKind
from ....core.spatial.pose import Pose
from ..motion.configuration import UrConfiguration
from ..syntax.lexer import number_value
from ..values.poses import rotation_vector_of
from ..values.rotations import DECIMALS, nearest_rotation_vector
from ..write.formatting import listing, number
from ..write.operands import blend, gives_shares, shares, speed_arguments
from .places import POSE, QNEAR, TARGET, VIA, MoveCalls

Present = Callable[[Span], str]
"""The text at a place."""


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a move's call: what it says and what it shall say.

    Args:
        name: as `places.MoveCall.written` takes it.
        spans: of its numbers; None for one that no literal states.
        old, new: their values; None for one that is not given.
        pose: the new pose, if it is one.
        turned: whether the pose's rotation changed.
    """

    name: str
    spans: tuple[Span | None, ...]
    old: tuple[float | None, ...]
    new: tuple[float | None, ...]
    pose: Pose | None = None
    turned: bool = False

    @property
    def changed(self) -> bool:
        """Whether any number did."""
        return self.old != self.new or self.turned

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


class ScriptLiterals:
    """What the literals of a program would have to say."""

    def __init__(self, calls: MoveCalls) -> None:
        self._calls = calls

    def text(self, span: Span) -> str:
        """What stands at a place."""
        return self._calls.text(span)

    def wish(self, use: Use) -> Wish:
        """See `core.source.patch.plan.Literals.wish`."""
        call = self._calls.at(use.statement)
        texts: dict[Span, str] = {}
        complete = True
        for argument in arguments(use):
            if call.can_be_put_in(argument.name):
                continue
            for span, text in zip(argument.spans, argument.texts(self.text), strict=True):
                if span is None:
                    complete &= text is None
                elif text is not None:
                    complete &= texts.setdefault(span, text) == text
        return Wish(texts, complete)


def arguments(use: Use) -> list[Argument]:
    """The arguments that a part of a move has at its call.

    Raises:
        InputError: URScript has no words for what the part shall become.
    """
    old, new = use.old, use.new
    if isinstance(old, Speed) and isinstance(new, Speed):
        return list(_speed(use, old, new))
    if isinstance(old, Fine | Radius):
        assert isinstance(new, Zone)
        blend(new)
        return [Argument("r", _spans(use, 1), (_radius(old),), (_radius(new),))]
    assert not isinstance(old, Speed | Zone) and not isinstance(new, Speed | Zone)
    if use.kind is UseKind.VIA:
        assert isinstance(old, PoseTarget) and isinstance(new, PoseTarget)
        return [_pose(VIA, _spans(use, 6), old.pose, new.pose)]
    return list(_goal(use, old, new))


def _spans(use: Use, count: int) -> tuple[Span | None, ...]:
    spans = use.origin.numbers
    return tuple(spans) if len(spans) == count else (None,) * count


def _goal(use: Use, old: Target, new: Target) -> Iterator[Argument]:
    if type(old) is not type(new) or old.external != new.external:
        raise InputError("a patch makes no pose of joint values or the other way round")
    if not (isinstance(old, PoseTarget) and isinstance(new, PoseTarget)):
        assert not isinstance(old, PoseTarget) and not isinstance(new, PoseTarget)
        if len(old.joints) != len(new.joints):
            raise InputError(f"the target has {len(new.joints)} joints instead of 6")
        yield Argument(TARGET, _spans(use, len(old.joints)), old.joints, new.joints)
        return
    near = _near(old.configuration), _near(new.configuration)
    both = len(use.origin.numbers) > 6
    spans = _spans(use, 12) if both else (*_spans(use, 6), *[None] * 6)
    yield _pose(POSE, spans[:6], old.pose, new.pose)
    if near[0] is None and near[1] is None:
        return
    if near[0] is None or near[1] is None:
        raise InputError("a patch neither adds nor takes away a qnear")
    yield Argument(QNEAR, spans[6:], near[0], near[1])


def _near(configuration: Configuration | None) -> tuple[float, ...] | None:
    if configuration is None:
        return None
    if not isinstance(configuration, UrConfiguration):
        raise InputError(f"{configuration} is no qnear: label the target for this robot")
    return configuration.joints


def _pose(name: str, spans: tuple[Span | None, ...], old: Pose, new: Pose) -> Argument:
    turned = old.quaternion != new.quaternion
    before = (*old.position, *rotation_vector_of(old.quaternion))
    after = (*new.position, *rotation_vector_of(new.quaternion))
    return Argument(name, spans, before, after, new, turned)


def _speed(use: Use, old: Speed, new: Speed) -> Iterator[Argument]:
    if old != new:
        arguments_of = shares if gives_shares(old) else speed_arguments
        arguments_of(use.move)
    values = zip(_speeds(use, old, old), _speeds(use, old, new), strict=True)
    for name, span, (before, after) in zip(("a", "v", "t"), _spans(use, 3), values, strict=True):
        # Where a duration takes their place, speed and acceleration may say what they like.
        wanted = before if after is None and name != "t" else after
        yield Argument(name, (span,), (before,), (wanted,))


def _speeds(
    use: Use, written: Speed, speed: Speed
) -> tuple[float | None, float | None, float | None]:
    """a, v and t as the call of a move gives them that was ``written`` with a speed."""
    if gives_shares(written):
        return speed.joint_acceleration_fraction, speed.joint_fraction, speed.duration
    if isinstance(use.move, MoveJ):
        return speed.joint_acceleration, speed.joint, speed.duration
    return speed.tcp_acceleration, speed.tcp, speed.duration


def _radius(zone: Zone) -> float:
    assert isinstance(zone, Fine | Radius)
    return 0.0 if isinstance(zone, Fine) else zone.tcp
