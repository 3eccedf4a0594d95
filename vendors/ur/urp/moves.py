"""Moves: ``Move`` with its waypoints, circles and directions, and the way to the safe home.

What is written is what PolyScope writes (seen in 368 programs beside their scripts):

    movej(get_inverse_kin(Waypoint_1_p, qnear=Waypoint_1_q), a=1.396, v=1.047)   a pose
    movej(Waypoint_1_q, a=…, v=…)                                               joints
    movel(Waypoint_1_p, a=…, v=…, r=…)   movep(…, r=…), the last one r=0        lines
    movel(pose_trans(Plane_1, target), …)                                       variables
    movel(pose_add(get_target_tcp_pose(), pose_sub(to, from)), …)               relative
    movec(via, to, a=…, v=…, r=…, mode=1)                                       circles

``nextMotionTime`` of a waypoint is written as ``t=`` in the place of a and v.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from .emission import Emission, list_text, pose_text
from .expressions import variable_name
from .frames import feature_text, set_tcp
from .kinematics import DhTable
from .positions import Taught, feature_was, taught_at
from .until import direction
from .xml_file import Element, child, number, resolved

Children = Callable[[Emission, Element], None]
"""Writes the nodes below an element."""
_SPEEDS = {"MoveJ": ("jointSpeed", "jointAcceleration"), "MoveL": (), "MoveP": ()}
_CARTESIAN = "cartesianSpeed", "cartesianAcceleration"
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
    last = max((i for i, one in enumerate(steps) if _is_waypoint(one)), default=-1)
    for index, step in enumerate(steps):
        if _is_waypoint(step):
            _waypoint(out, node, step, table, index == last)
            _until_below(out, step, others)
        elif step.tag == "CircleMove":
            _circle(out, node, step, table, index == len(steps) - 1)
        elif "Direction" in step.tag:
            direction(out, node, step, _speed(node, child(step, "motionParameters"), "MoveL"))
            _until_below(out, step, others)
        else:
            others(out, step)


def safe_home(out: Emission, node: Element) -> None:
    """``SafeHome``: to the joints that the installation names."""
    with out.node("Home"):
        timed = "SPEED" not in node.get("positionOptionType", "SPEED_AND_ACCELERATION")
        time = number(node.get("nextMotionTime"))
        home = out.installation.home
        if timed and time:
            speed = f"t={time!r}"
        else:
            speed = _arguments(number(node.get("acceleration")), number(node.get("speed")))
        target = "safe_home_position" if home is None else list_text(home)
        out.write(_call("movej", target, speed))


def _is_waypoint(node: Element) -> bool:
    return bool(node.tag == "Waypoint")


def _call(function: str, target: str, *arguments: str) -> str:
    return f"{function}({', '.join([target, *filter(None, arguments)])})"


def _arguments(acceleration: float | None, speed: float | None) -> str:
    stated = (("a", acceleration), ("v", speed))
    return ", ".join(f"{name}={value!r}" for name, value in stated if value is not None)


def _speed(node: Element, own: Element | None, kind: str) -> str:
    """The speed of a move: the waypoint's own, or the node's."""
    if own is not None and kind != "MoveP":  # movep and movec take no time
        time = number(own.get("nextMotionTime"))
        if time:
            return f"t={time!r}"
    speed_name, acceleration_name = _SPEEDS[kind] or _CARTESIAN
    speed = None if own is None else number(own.get(speed_name))
    acceleration = None if own is None else number(own.get(acceleration_name))
    return _arguments(
        number(node.get("acceleration")) if acceleration is None else acceleration,
        number(node.get("speed")) if speed is None else speed,
    )


def _radius(node: Element, own: Element | None, kind: str, last: bool) -> str:
    if kind == "MoveP":
        return f"r={0.0 if last else number(node.get('blendRadius')) or 0.0!r}"
    radius = None if own is None else number(own.get("blendRadius"))
    return f"r={radius!r}" if radius else ""


def _waypoint(
    out: Emission, node: Element, waypoint: Element, table: DhTable | None, last: bool
) -> None:
    found = resolved(waypoint)
    name = waypoint.get("name") or (None if found is None else found.get("name"))
    variable = None if found is None else variable_name(child(found, "variable"))
    with out.node(variable or name or "Waypoint"):
        if found is None:
            out.note("the waypoint stands for another one that is not in the file: it is left out")
            return
        kind = node.get("motionType", "MoveJ")
        target = _target(out, node, found, variable, table, kind)
        if target is None:
            return
        own = child(found, "motionParameters")
        out.write(
            _call(_FUNCTIONS[kind], target, _speed(node, own, kind), _radius(node, own, kind, last))
        )


def _target(
    out: Emission,
    node: Element,
    waypoint: Element,
    variable: str | None,
    table: DhTable | None,
    kind: str,
) -> str | None:
    """Where a waypoint is, as an argument; None if that is not known, which is noted."""
    sort = waypoint.get("type", "Fixed")
    if sort == "Variable":
        if variable is None:
            out.note("no variable was chosen for the waypoint: it is left out")
            return None
        frame = feature_text(out, child(node, "feature"))
        return variable if frame is None else f"pose_trans({frame}, {variable})"
    if sort == "Relative":
        return _relative(out, waypoint, table)
    if sort != "Fixed":
        out.note(f"a waypoint of type {sort} is not known: it is left out")
        return None
    taught = taught_at(waypoint, table)
    if not taught.known:
        out.note("the waypoint was never taught: it is left out")
        return None
    if feature_was(waypoint) is not None:
        out.note("taught in a feature that has its own place: driven to where it was taught")
    by_joints = kind == "MoveJ" and node.get("positionType") != "CartesianPose"
    return _taught_text(out, waypoint.get("name", "Waypoint"), taught, kind, by_joints)


def _taught_text(out: Emission, name: str, taught: Taught, kind: str, by_joints: bool) -> str:
    data: dict[str, str] = {}
    if taught.pose is not None:
        data["_p"] = pose_text(taught.pose)
    if taught.joints is not None:
        data["_q"] = list_text(taught.joints)
    stem = out.declared(name, data)
    if taught.pose is None or (by_joints and taught.joints is not None):
        return f"{stem}_q"
    if kind != "MoveJ":
        return f"{stem}_p"
    near = "" if taught.joints is None else f", qnear={stem}_q"
    return f"get_inverse_kin({stem}_p{near})"


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


def _circle(
    out: Emission, node: Element, circle: Element, table: DhTable | None, last: bool
) -> None:
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
            text = _target(
                out, node, found, variable_name(child(found, "variable")), table, "MoveP"
            )
            if text is not None:
                texts.append(text)
        if len(texts) != 2:
            out.note("a point of the circle is not stored: the circle is left out")
            return
        fixed = "FIXED" in circle.get("orientationMode", circle.get("OrientationMode", "")).upper()
        own = child(circle, "motionParameters")
        out.write(
            _call(
                "movec",
                ", ".join(texts),
                _speed(node, own, "MoveP"),
                _radius(node, own, "MoveP", last),
                f"mode={int(fixed)}",
            )
        )


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
