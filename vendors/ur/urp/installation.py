"""A ``.installation``: what PolyScope knows beside its programs.

Root ``Installation``; read are ``TCPSettings``, ``PayloadSettings``, ``Features``,
``SafeHomeSettings``, ``IOs``, ``SafetySettings`` and ``kinematics``. Lengths in m, angles in rad,
poses as position and rotation vector.
"""

from __future__ import annotations

import configparser
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ....core.errors import InputError
from .kinematics import JOINTS, DhTable, table_of
from .xml_file import Element, child, number, numbers, read_xml

Six = tuple[float, ...]
"""A pose: position m, rotation vector rad."""
BASE_FEATURE, TOOL_FEATURE = "Joint_0_name", "Joint_6_name"
_POSE_NODES = "GeomPoseNode", "GeomPointNode"
_PLANE_NODES = "GeomPlaneNode", "GeomLineNode"
_REVOLUTION = 2 * math.pi
SIGNAL_LISTS = {
    "DigitalInputNames": "digital_in",
    "DigitalOutputNames": "digital_out",
    "ToolDigitalInputNames": "tool_in",
    "ToolDigitalOutputNames": "tool_out",
    "ConfigurableInputNames": "config_in",
    "ConfigurableOutputNames": "config_out",
    "AnalogInputNames": "analog_in",
    "AnalogOutputNames": "analog_out",
    "GeneralPurposeBooleanRegisterInputNames": "GP_bool_in",
    "GeneralPurposeBooleanRegisterOutputNames": "GP_bool_out",
    "GeneralPurposeIntRegisterInputNames": "GP_int_in",
    "GeneralPurposeIntRegisterOutputNames": "GP_int_out",
    "GeneralPurposeFloatRegisterInputNames": "GP_float_in",
    "GeneralPurposeFloatRegisterOutputNames": "GP_float_out",
}


@dataclass(frozen=True)
class Payload:
    """What the flange carries: kg, m in the flange's frame, kg m² (xx, yy, zz, xy, xz, yz)."""

    mass: float
    centre: tuple[float, ...] = (0.0, 0.0, 0.0)
    inertia: tuple[float, ...] | None = None


@dataclass(frozen=True)
class Feature:
    """A frame in the base's frame.

    Args:
        pose: of it.
        variable: whether scripts know it by its name.
    """

    pose: Six
    variable: bool


@dataclass(frozen=True)
class JointLimits:
    """Normal limits of safety of the six joints: rad, rad/s."""

    lower: tuple[float, ...]
    upper: tuple[float, ...]
    speed: tuple[float, ...]


@dataclass(frozen=True)
class Installation:
    """What an installation states; what it does not is empty or None.

    Args:
        tcps: by name.
        active: name of the TCP that programs begin with.
        payloads: by name.
        payload: name of the one that programs begin with.
        features: by name, without base and tool.
        home: joints of the safe home, rad.
        signals: the controller's names (``digital_in[0]``) by the operator's.
        tilt, turn: of the base when it is mounted, rad: about the base's axis x after the turn
            about z.
        limits: of safety.
        tcp_speed: of safety, m/s.
        table: of this arm.
        serial: of the robot, as far as it is stated.
    """

    tcps: Mapping[str, Six] = field(default_factory=dict)
    active: str | None = None
    payloads: Mapping[str, Payload] = field(default_factory=dict)
    payload: str | None = None
    features: Mapping[str, Feature] = field(default_factory=dict)
    home: tuple[float, ...] | None = None
    signals: Mapping[str, str] = field(default_factory=dict)
    tilt: float = 0.0
    turn: float = 0.0
    limits: JointLimits | None = None
    tcp_speed: float | None = None
    table: DhTable | None = None
    serial: str = ""
    version: str = ""


def read_installation(path: Path) -> Installation:
    """An installation.

    Raises:
        InputError: the file cannot be read, or is none.
    """
    root = read_xml(path)
    if root.tag != "Installation":
        raise InputError(f"{path}: is no installation of PolyScope: it begins with <{root.tag}>")
    return installation_of(root)


def installation_of(root: Element) -> Installation:
    """What an element ``Installation`` states."""
    tcps = child(root, "TCPSettings")
    payloads, payload = _payloads(root, tcps)
    limits, tcp_speed = _safety(child(root, "SafetySettings"))
    home = child(root, "SafeHomeSettings")
    features = child(root, "Features")
    mounting = None if features is None else next(features.iter("WorldtoMarshal"), None)
    known = dict(_tcps(tcps))
    active = None if tcps is None else tcps.get("activePose")
    return Installation(
        tcps=known,
        active=active if active in known else next(iter(known), None) if len(known) == 1 else None,
        payloads=payloads,
        payload=payload,
        features={} if features is None else dict(_features(features)),
        home=None if home is None else numbers(home.get("position"), JOINTS),
        signals=_signals(child(root, "IOs")),
        tilt=_attribute(mounting, "tiltAngle"),
        turn=_attribute(mounting, "baseAngle"),
        limits=limits,
        tcp_speed=tcp_speed,
        table=table_of(child(root, "kinematics", "Kinematics")),
        serial=root.get("robotSerialNumber", ""),
        version=_version(child(root, "LastSavedInVersion", "Version")),
    )


def _attribute(element: Element | None, name: str) -> float:
    return 0.0 if element is None else number(element.get(name)) or 0.0


def _version(element: Element | None) -> str:
    if element is None:
        return ""
    parts = [element.get(name) for name in ("major", "minor", "bugfix")]
    return ".".join(part for part in parts if part)


def _tcps(settings: Element | None) -> Iterator[tuple[str, Six]]:
    for one in () if settings is None else settings.iter("tcp"):
        offset = numbers(one.get("offset") or one.get("pose"), 6)
        if one.get("name") and offset is not None:
            yield one.get("name"), offset


def _payloads(root: Element, tcps: Element | None) -> tuple[dict[str, Payload], str | None]:
    """By name, and which programs begin with; before 5.10 there is one, beside the TCPs."""
    found: dict[str, Payload] = {}
    first: str | None = None
    for one in root.iter("Payload"):
        payload = _payload(one, "mass", "centerOfGravity", "inertiaParameters")
        if payload is not None and one.get("name"):
            found[one.get("name")] = payload
            if one.get("defaultPayload") == "true":
                first = one.get("name")
    if not found and tcps is not None:
        for one in (tcps, *tcps.iter("payload")):
            for mass in ("mass", "payload", "payloadMass"):
                payload = _payload(one, mass, "centerOfGravity", "inertia")
                if payload is not None:
                    return {"payload": payload}, "payload"
    return found, first


def _payload(element: Element, mass: str, centre: str, inertia: str) -> Payload | None:
    stated = number(element.get(mass))
    if stated is None or stated < 0.0:
        return None
    at = numbers(element.get(centre), 3) or (0.0, 0.0, 0.0)
    return Payload(stated, at, numbers(element.get(inertia), 6))


def _features(features: Element) -> Iterator[tuple[str, Feature]]:
    for node in features.iter():
        name = node.get("name") if isinstance(node.tag, str) else None
        if not name or node.get("hiddenSubFeature") == "true":
            continue
        if node.tag in _POSE_NODES:
            pose = _pose(node)
        elif node.tag in _PLANE_NODES:
            first = child(node, "firstPoint")
            pose = None if first is None else _pose(next(first.iter(*_POSE_NODES), None))
        else:
            continue
        if pose is not None:
            yield name, Feature(pose, node.get("isVariable", "").casefold() == "true")


def _pose(node: Element | None) -> Six | None:
    position, turn = child(node, "toolPosition"), child(node, "toolAxisAngle")
    if position is None or turn is None:
        return None
    p, r = numbers(position.get("value"), 3), numbers(turn.get("value"), 3)
    return None if p is None or r is None else (*p, *r)


def _signals(lists: Element | None) -> dict[str, str]:
    """The controller's names by the operator's; of a name given twice the first."""
    found: dict[str, str] = {}
    for tag, kind in SIGNAL_LISTS.items():
        one = child(lists, tag)
        for index, name in enumerate([] if one is None else one.get("value", "").split(",")):
            if name.strip():
                found.setdefault(name.strip(), f"{kind}[{index}]")
    return found


def _safety(settings: Element | None) -> tuple[JointLimits | None, float | None]:
    """Limits of the joints, and the speed of the TCP, of an INI text."""
    parser = configparser.ConfigParser(interpolation=None, strict=False, allow_no_value=True)
    try:
        parser.read_string((settings.text or "") if settings is not None else "")
    except configparser.Error:
        return None, None

    def six(name: str) -> tuple[float, ...] | None:
        return numbers(parser.get("SafetyLimits Normal Joints", name, fallback=None), JOINTS)

    speed = number(parser.get("SafetyLimits Normal Values", "maxTcpSpeed", fallback=None))
    parts = [
        six(name)
        for name in (
            "minJointPosition",
            "minJointRevolutions",
            "maxJointPosition",
            "maxJointRevolutions",
            "maxJointSpeed",
        )
    ]
    known = [part for part in parts if part is not None]
    if len(known) != len(parts):
        return None, speed
    lowest, below, highest, above, fastest = known
    lower = tuple(q + _REVOLUTION * n for q, n in zip(lowest, below, strict=True))
    upper = tuple(q + _REVOLUTION * n for q, n in zip(highest, above, strict=True))
    if not all(low < high for low, high in zip(lower, upper, strict=True)) or min(fastest) <= 0.0:
        return None, speed
    return JointLimits(lower, upper, fastest), speed
