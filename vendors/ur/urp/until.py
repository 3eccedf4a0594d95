"""Moves in a direction, until something happens.

Where a distance ends the move the robot is driven as far. Where nothing but a contact, a signal or
an expression does, only the real robot knows how far it goes: the move's target is asked for.
"""

from __future__ import annotations

from .emission import Emission
from .frames import feature_text
from .xml_file import Element, child, number

_TOWARDS = "point_in_direction"
_FUNCTION = f"""  def {_TOWARDS}(feature, direction, distance):
    local size = sqrt(direction[0]*direction[0]+direction[1]*direction[1]+direction[2]*direction[2])
    if size < 0.000001:
      return get_target_tcp_pose()
    end
    local k = distance / size
    local shift = p[k*direction[0], k*direction[1], k*direction[2], 0, 0, 0]
    return pose_add(get_target_tcp_pose(), pose_sub(pose_trans(feature, shift), feature))
  end"""
_BASE = "p[0, 0, 0, 0, 0, 0]"
_DISTANCES = "distance", "Distance", "untilDistance", "value"
_ALONG = {
    f"{axis}{sign}": f"[{', '.join(way if k == own else '0' for k in range(3))}]"
    for own, axis in enumerate("XYZ")
    for sign, way in (("Plus", "1"), ("Minus", "-1"))
}
"""``selectedDirection`` by the axes of the feature: ``XPlus`` to ``ZMinus``."""


def direction(out: Emission, node: Element, step: Element, speed: str) -> None:
    """A move of a ``Move`` in a direction.

    Args:
        node: the ``Move``.
        step: the node of the direction.
        speed: arguments of the call.
    """
    with out.node("Direction"):
        towards = _ALONG.get(step.get("selectedDirection", "")) or out.expression(
            child(step, "expression", "direction", "directionExpression")
        )
        own = child(step, "feature")
        frame = feature_text(out, child(node, "feature") if own is None else own) or _BASE
        if not towards:
            out.note("the direction is not stored in a known form: the move is left out")
            return
        distance, others = _distance(out, step)
        if distance is not None:
            if others:
                out.note("driven over the whole distance, as if nothing ended the move before")
            if _FUNCTION not in out.preamble:
                out.preamble.append(_FUNCTION)
            out.write(f"movel({_TOWARDS}({frame}, {towards}, {distance}), {speed})")
            return
        what = " or ".join(others) or "it is stopped"
        out.note(f"how far it goes until {what} only the robot knows")
        out.write(f"movel(get_pose_where_move_{out.number}_ends(), {speed})")


def _distance(out: Emission, step: Element) -> tuple[str | None, list[str]]:
    """The distance, m, at which the move ends, and what else ends it."""
    below = child(step, "children")
    distance: str | None = None
    others: list[str] = []
    for one in [] if below is None else below:
        if not (isinstance(one.tag, str) and one.tag.endswith(("Until", "UntilNode"))):
            continue
        kind = one.get("type", "EXPRESSION")
        if kind.upper() == "NONE":
            continue
        if "DISTANCE" not in kind.upper():
            others.append(kind.lower().replace("_", " "))
            continue
        distance = _stated(out, one)
    return distance, others


def _stated(out: Emission, until: Element) -> str | None:
    for name in _DISTANCES:
        inside = child(until, name)
        text = until.get(name) if inside is None else inside.get("value") or inside.text
        value = number(text)
        if value is not None:
            return repr(value)
    return out.expression(child(until, "expression")) or None
