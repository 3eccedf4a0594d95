"""Moves: ``Move`` with its waypoints, circles and directions, and the way to the safe home.

What is written is what PolyScope writes (seen in 368 programs beside their scripts):

    movej(get_inverse_kin(Waypoint_1_p, qnear=Waypoint_1_q), a=1.396, v=1.047)   a pose
    movej(Waypoint_1_q, a=…, v=…)                                               joints
    movel(Waypoint_1_p, a=…, v=…, r=…)   movep(…, r=…), the last one r=0        lines
    movel(pose_trans(Plane_1, target), …)                                       variables
    movel(pose_add(get_target_tcp_pose(), pose_sub(to, from)), …)               relative
    movec(via, to, a=…, v=…, r=…, mode=1)                                       circles

``nextMotionTime`` of a waypoint is written as ``t=`` in the place of a and v. What a ``Move``
states for all of its waypoints is a variable, ``MoveL_3_v``, which PolyScope writes out at each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from .emission import Emission, list_text, pose_text
from .expressions import variable_name
from .frames import feature_text, set_tcp
from .kinematics import DhTable
from .literals import JOINTS, PARAMETERS, POSE, Attribute, Ending
from .positions import Taught, feature_was, taught_at
from .until import direction
from .xml_file import Element, child, number, resolved

Children = Callable[[Emission, Element], None]
"""Writes the nodes below an element."""
_OWN = {
    "MoveJ": {"a": "jointAcceleration", "v": "jointSpeed", "t": "nextMotionTime"},
    "MoveL": {"a": "cartesianAcceleration", "v": "cartesianSpeed", "t": "nextMotionTime"},
    "MoveP": {"a": "cartesianAcceleration", "v": "cartesianSpeed"},  # movep, movec take no time
}
"""What a waypoint states for itself, by the argument that it becomes."""
_RADIUS = "blendRadius"
_FUNCTIONS = {"MoveJ": "movej", "MoveL": "movel", "MoveP": "movep"}
_UNTIL = "Until", "gui.program.direction.UntilNode"


def move(out: Emission, node: Element, table: DhTable | None, others: Children) -> None:
    """A ``Move`` and what stands below it."""
    kind = node.get("motionType", "MoveJ")
    if kind not in _FUNCTIONS:
        out.note(f"a motion of type {kind} is not known: it is left out")
        return
    if node.get("useActiveTCP") == "false" and child(node, "tcp") is not None:
        set_tcp(out, child(node, "tcp"), node)
    below = child(node, "children")
    steps = [one for one in ([] if below is None else below) if isinstance(one.tag, str)]
    if not steps:
        return
    last = max((i for i, one in enumerate(steps) if _is_waypoint(one)), default=-1)
    moves = _Moves(node, kind, table, _shared(out, node))
    for index, step in enumerate(steps):
        if _is_waypoint(step):
            _waypoint(out, moves, step, index == last)
            _until_below(out, step, others)
        elif step.tag == "CircleMove":
            _circle(out, moves, step, index == len(steps) - 1)
        elif "Direction" in step.tag:
            direction(out, node, step, _speed(out, moves, step, "MoveL"))
            _until_below(out, step, others)
        else:
            others(out, step)


@dataclass(frozen=True)
class _Moves:
    """What the moves of a ``Move`` have in common.

    Args:
        node: it.
        kind: ``MoveJ``, ``MoveL`` or ``MoveP``.
        table: of the program's arm.
        shared: the variables of what it states for all of its waypoints, by argument.
    """

    node: Element
    kind: str
    table: DhTable | None
    shared: Mapping[str, str] = field(default_factory=dict)


def _shared(out: Emission, node: Element) -> dict[str, str]:
    stated = {"a": "acceleration", "v": "speed", "r": _RADIUS}
    if node.get("motionType", "MoveJ") != "MoveP":
        del stated["r"]
    names = {key: out.shared(node, name, f"_{key}") for key, name in stated.items()}
    return {key: name for key, name in names.items() if name is not None}


def safe_home(out: Emission, node: Element) -> None:
    """``SafeHome``: to the joints that the installation names."""
    with out.node("Home"):
        timed = "SPEED" not in node.get("positionOptionType", "SPEED_AND_ACCELERATION")
        stated = {"t": "nextMotionTime"}
        if not (timed and number(node.get("nextMotionTime"))):
            stated = {"a": "acceleration", "v": "speed"}
        home = out.installation.home
        target = "safe_home_position" if home is None else list_text(home)
        places = {key: Attribute(node, name) for key, name in stated.items()}
        speed = [_own(out, key, node, place) for key, place in places.items()]
        out.write(_call(out, "movej", target, places, *speed))


def _is_waypoint(node: Element) -> bool:
    return bool(node.tag == "Waypoint")


def _call(
    out: Emission, function: str, target: str, own: Mapping[str, Attribute], *arguments: str
) -> str:
    """A call of a move.

    Args:
        own: where the node states arguments of its own.
    """
    written = ", ".join([target, *filter(None, arguments)])
    return f"{function}({written}{out.literals.token('', Ending(own))})"


def _own(out: Emission, key: str, stated: Element | None, place: Attribute) -> str:
    """An argument that an element states for itself; empty if it does not."""
    value = None if stated is None else number(stated.get(place.name))
    return "" if value is None else f"{key}={out.literals.token(repr(value), place)}"


def _own_places(step: Element, kind: str, *, radius: bool = False) -> dict[str, Attribute]:
    names = {**_OWN[kind], "r": _RADIUS} if radius else _OWN[kind]
    return {key: Attribute(step, name, PARAMETERS) for key, name in names.items()}


def _speed(out: Emission, moves: _Moves, step: Element, kind: str) -> str:
    """The speed of a move: the waypoint's own, or the node's."""
    own = child(step, PARAMETERS)
    places = _own_places(step, kind)
    if own is not None and "t" in places and number(own.get(places["t"].name)):
        return _own(out, "t", own, places["t"])
    stated = [(key, _own(out, key, own, places[key])) for key in ("a", "v")]
    return ", ".join(
        filter(None, (text or _of_all(out, moves, key, places[key]) for key, text in stated))
    )


def _of_all(out: Emission, moves: _Moves, key: str, place: Attribute | None) -> str:
    """An argument that the ``Move`` states; a move gets its own in the place of the variable."""
    name = moves.shared.get(key)
    if name is None:
        return ""
    return f"{key}={name if place is None else out.literals.token(name, place)}"


def _radius(out: Emission, moves: _Moves, step: Element, last: bool) -> str:
    if moves.kind == "MoveP":
        return "r=0.0" if last else _of_all(out, moves, "r", None) or "r=0.0"
    own = child(step, PARAMETERS)
    place = Attribute(step, _RADIUS, PARAMETERS)
    return _own(out, "r", own, place) if own is not None and number(own.get(_RADIUS)) else ""


def _waypoint(out: Emission, moves: _Moves, waypoint: Element, last: bool) -> None:
    found = resolved(waypoint)
    name = waypoint.get("name") or (None if found is None else found.get("name"))
    variable = None if found is None else variable_name(child(found, "variable"))
    with out.node(variable or name or "Waypoint"):
        if found is None:
            out.note("the waypoint stands for another one that is not in the file: it is left out")
            return
        target = _target(out, moves, found, variable, moves.kind)
        if target is None:
            return
        speed = _speed(out, moves, found, moves.kind)
        radius = _radius(out, moves, found, last)
        own = _own_places(found, moves.kind, radius=moves.kind != "MoveP")
        out.write(_call(out, _FUNCTIONS[moves.kind], target, own, speed, radius))


def _target(
    out: Emission, moves: _Moves, waypoint: Element, variable: str | None, kind: str
) -> str | None:
    """Where a waypoint is, as an argument; None if that is not known, which is noted."""
    node = moves.node
    sort = waypoint.get("type", "Fixed")
    if sort == "Variable":
        if variable is None:
            out.note("no variable was chosen for the waypoint: it is left out")
            return None
        frame = feature_text(out, child(node, "feature"))
        return variable if frame is None else f"pose_trans({frame}, {variable})"
    if sort == "Relative":
        return _relative(out, waypoint, moves.table)
    if sort != "Fixed":
        out.note(f"a waypoint of type {sort} is not known: it is left out")
        return None
    taught = taught_at(waypoint, moves.table)
    if not taught.known:
        out.note("the waypoint was never taught: it is left out")
        return None
    if feature_was(waypoint) is not None:
        out.note("taught in a feature that has its own place: driven to where it was taught")
    by_joints = kind == "MoveJ" and node.get("positionType") != "CartesianPose"
    return _taught_text(out, waypoint, taught, kind, by_joints)


def _taught_text(
    out: Emission, waypoint: Element, taught: Taught, kind: str, by_joints: bool
) -> str:
    data: dict[str, str] = {}
    if taught.pose is not None:
        data[POSE] = pose_text(taught.pose)
    if taught.joints is not None:
        data[JOINTS] = list_text(taught.joints)
    stem = out.declared(waypoint.get("name", "Waypoint"), data, waypoint)
    if taught.pose is None or (by_joints and taught.joints is not None):
        return f"{stem}{JOINTS}"
    if kind != "MoveJ":
        return f"{stem}{POSE}"
    near = "" if taught.joints is None else f", qnear={stem}{JOINTS}"
    return f"get_inverse_kin({stem}{POSE}{near})"


def _relative(out: Emission, waypoint: Element, table: DhTable | None) -> str | None:
    """By as much as it is from one taught position to the other."""
    ends = [taught_at(one, table).pose for one in _ends(waypoint) if one is not None]
    if len(ends) != 2 or ends[0] is None or ends[1] is None:
        out.note("the two positions of the relative waypoint are not stored: it is left out")
        return None
    stem = out.declared(
        waypoint.get("name", "Waypoint"),
        {"_from_p": pose_text(ends[0]), "_to_p": pose_text(ends[1])},
    )
    return f"pose_add(get_target_tcp_pose(), pose_sub({stem}_to_p, {stem}_from_p))"


def _ends(waypoint: Element) -> Iterator[Element | None]:
    named = child(waypoint, "from", "fromPosition"), child(waypoint, "to", "toPosition")
    if None not in named:
        yield from named
        return
    yield from [resolved(one) for one in waypoint if one.tag in ("position", "Waypoint")][:2]


def _circle(out: Emission, moves: _Moves, circle: Element, last: bool) -> None:
    with out.node("CircleMove"):
        points = [child(circle, "via", "viaPoint"), child(circle, "to", "endPoint")]
        if None in points:
            below = child(circle, "children")
            inside = circle if below is None else below
            points = [resolved(one) for one in inside if one.tag == "Waypoint"][:2]
        texts: list[str] = []
        for point in points:
            inner = None if point is None else child(point, "Waypoint")
            found = point if inner is None else inner
            if found is None:
                continue
            variable = variable_name(child(found, "variable"))
            text = _target(out, moves, found, variable, "MoveP")
            if text is not None:
                texts.append(text)
        if len(texts) != 2:
            out.note("a point of the circle is not stored: the circle is left out")
            return
        fixed = "FIXED" in circle.get("orientationMode", circle.get("OrientationMode", "")).upper()
        speed = _speed(out, moves, circle, "MoveP")
        radius = "r=0.0" if last else _of_all(out, moves, "r", None) or "r=0.0"
        own = _own_places(circle, "MoveP")
        points_text = ", ".join(texts)
        out.write(_call(out, "movec", points_text, own, speed, radius, f"mode={int(fixed)}"))


def _until_below(out: Emission, step: Element, others: Children) -> None:
    """What stands below a step of a move: conditions that end it, and what is done then."""
    below = child(step, "children")
    for one in [] if below is None else below:
        if one.tag not in _UNTIL:
            others(out, one)
            continue
        if step.tag == "Waypoint":
            out.note(f"driven to its end, whatever {until_label(one)} says on the way")
        inner = child(one, "children")
        for action in [] if inner is None else inner:
            others(out, action)


def until_label(node: Element) -> str:
    """A condition that ends a move, as the tree shows it."""
    return f"Until ({node.get('type', 'expression').lower()})"
