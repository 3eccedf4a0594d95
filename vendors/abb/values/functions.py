"""RAPID's built-in functions, as far as their values follow from the program.

Functions take their values as RAPID has them (mm, degrees) and are told apart into those that are
computed here (`COMPUTED`), those that ask the running controller (`STATE`): their value is unknown,
and those that ask how it runs (`IN_PRODUCTION`).

Definitions: "RAPID Reference Manual", functions.
"""

from __future__ import annotations

import math

import numpy as np

from ....core.source.text.lexer import words
from ....core.spatial.rotation import matrix_from_quaternion, quaternion_from_matrix
from .operators import OperandError, cross, finite, hamilton
from .records import VMAX, Record
from .text_functions import TEXT_FUNCTIONS, Computed
from .types import (
    BOOL,
    JOINTTARGET,
    LOADDATA,
    NUM,
    ORIENT,
    POS,
    POSE,
    ROBTARGET,
    STRING,
    TOOLDATA,
    WOBJDATA,
    Type,
    Value,
)

Vector = tuple[float, ...]

FARTHEST = 1e9
"""mm. Coordinates beyond are no places; their products would overflow."""


def offs(point: Record, x: float, y: float, z: float) -> Record:
    """A robtarget moved along the axes of its work object, mm."""
    trans, *rest = point
    return (tuple(finite(a + b) for a, b in zip(trans, (x, y, z), strict=True)), *rest)


def rel_tool(point: Record, x: float, y: float, z: float, *turns: float) -> Record:
    """A robtarget moved (mm) and then turned (deg, about x, new y, new z) in the tool's frame."""
    rx, ry, rz = turns
    trans, rot, *rest = point
    moved = _add(trans, rotate(rot, (x, y, z)))
    turned = unit(rot)
    for axis, angle in enumerate((rx, ry, rz)):
        turned = hamilton(turned, _about(axis, angle))
    return (moved, turned if (rx or ry or rz) else rot, *rest)


def pose_mult(a: Record, b: Record) -> Record:
    """The frame ``b``, given in ``a``, seen from where ``a`` is given."""
    return (_add(a[0], rotate(a[1], b[0])), hamilton(unit(a[1]), unit(b[1])))


def pose_inv(pose: Record) -> Record:
    """The inverse of a pose."""
    inverse = _conjugate(unit(pose[1]))
    x, y, z = rotate(inverse, pose[0])
    return ((-x, -y, -z), inverse)


def pose_vect(pose: Record, vector: Vector) -> Record:
    """A position given in a pose, seen from where the pose is given."""
    return _add(pose[0], rotate(pose[1], vector))


def orient_zyx(z: float, y: float, x: float) -> Record:
    """The orient of Euler angles, deg, about z, new y, new x."""
    return hamilton(hamilton(_about(2, z), _about(1, y)), _about(0, x))


def euler_zyx(option: str, orient: Vector) -> float:
    """One of the Euler angles, deg: ``z``, ``y`` or ``x``."""
    r = matrix_from_quaternion(np.array(unit(orient)))
    sine = -float(r[2, 0])
    if abs(sine) > 1 - 1e-12:  # z and x turn about one axis: all of it is given to z
        z, x = math.atan2(-float(r[0, 1]), float(r[1, 1])), 0.0
    else:
        z = math.atan2(float(r[1, 0]), float(r[0, 0]))
        x = math.atan2(float(r[2, 1]), float(r[2, 2]))
    angles = {"z": z, "y": math.asin(max(-1.0, min(1.0, sine))), "x": x}
    return math.degrees(angles[option])


def def_frame(first: Record, second: Record, third: Record, origin: float = 0.0) -> Record:
    """The frame with x from ``first`` towards ``second`` and ``third`` on the y side.

    Args:
        origin: 0 or 1 for an origin at ``first``, 2 at ``second``, 3 where the line through
            ``third`` meets the x axis at a right angle.
    """
    points = (first[0], second[0], third[0])
    if max(abs(v) for point in points for v in point) > FARTHEST:
        raise OperandError(f"DefFrame takes points within {FARTHEST:g} mm")
    start = np.array(first[0])
    x = np.array(second[0]) - start
    z = np.cross(x, np.array(third[0]) - start)
    if np.linalg.norm(z) < 1e-9:
        raise OperandError("DefFrame needs three points that are not on one line")
    x = x / np.linalg.norm(x)
    z = z / np.linalg.norm(z)
    w, i, j, k = quaternion_from_matrix(np.column_stack([x, np.cross(z, x), z]))
    places = {0: start, 1: start, 2: np.array(second[0])}
    at = places.get(int(origin), start + x * float(x @ (np.array(third[0]) - start)))
    return (tuple(map(float, at)), (float(w), float(i), float(j), float(k)))


def displacement_frame(
    p1: Record, p2: Record, p3: Record, q1: Record, q2: Record, q3: Record, origin: float
) -> Record:
    """``DefDframe``: the displacement that takes three points to where they are now."""
    return pose_mult(def_frame(q1, q2, q3, origin), pose_inv(def_frame(p1, p2, p3, origin)))


def rotate(rot: Vector, vector: Vector) -> Vector:
    """A vector turned by an orient."""
    w, *axis = unit(rot)
    t = tuple(2.0 * v for v in cross(tuple(axis), vector))
    u = cross(tuple(axis), t)
    return tuple(finite(v + w * a + b) for v, a, b in zip(vector, t, u, strict=True))


def unit(orient: Vector) -> Vector:
    """An orient of unit length; a zero one has no direction."""
    length = math.sqrt(finite(sum(v * v for v in orient)))
    if length < 1e-3:
        raise OperandError("an orient of length zero is no orientation")
    return tuple(v / length for v in orient)


def _about(axis: int, degrees: float) -> Vector:
    half = math.radians(degrees) / 2
    parts = [math.cos(half), 0.0, 0.0, 0.0]
    parts[1 + axis] = math.sin(half)
    return tuple(parts)


def _conjugate(orient: Vector) -> Vector:
    w, x, y, z = orient
    return (w, -x, -y, -z)


def _add(a: Vector, b: Vector) -> Vector:
    return tuple(finite(u + v) for u, v in zip(a, b, strict=True))


def _rounded(value: float, decimals: float = 0.0) -> float:
    """Half away from zero, as the controller rounds."""
    scale = 10.0 ** int(max(0.0, min(decimals, 15.0)))
    return math.copysign(math.floor(abs(value) * scale + 0.5) / scale, value)


def _truncated(value: float, decimals: float = 0.0) -> float:
    scale = 10.0 ** int(max(0.0, min(decimals, 15.0)))
    return math.trunc(finite(value * scale)) / scale


def _dot(a: Vector, b: Vector) -> float:
    return sum(u * v for u, v in zip(a, b, strict=True))


COMPUTED: dict[str, Computed] = {
    "offs": (offs, (ROBTARGET, NUM, NUM, NUM), ()),
    "reltool": (rel_tool, (ROBTARGET, NUM, NUM, NUM), ("rx", "ry", "rz")),
    "posemult": (pose_mult, (POSE, POSE), ()),
    "poseinv": (pose_inv, (POSE,), ()),
    "posevect": (pose_vect, (POSE, POS), ()),
    "orientzyx": (orient_zyx, (NUM, NUM, NUM), ()),
    "norient": (unit, (ORIENT,), ()),
    "defframe": (def_frame, (ROBTARGET,) * 3, ("origin",)),
    "defdframe": (displacement_frame, (ROBTARGET,) * 6, ("origin",)),
    "crossprod": (cross, (POS, POS), ()),
    "max": (max, (NUM, NUM), ()),
    "min": (min, (NUM, NUM), ()),
    "distance": (math.dist, (POS, POS), ()),
    "dotprod": (_dot, (POS, POS), ()),
    "vectmagn": (lambda v: math.hypot(*v), (POS,), ()),
    "abs": (abs, (NUM,), ()),
    "sqrt": (math.sqrt, (NUM,), ()),
    "pow": (math.pow, (NUM, NUM), ()),
    "exp": (math.exp, (NUM,), ()),
    "sin": (lambda a: math.sin(math.radians(a)), (NUM,), ()),
    "cos": (lambda a: math.cos(math.radians(a)), (NUM,), ()),
    "tan": (lambda a: math.tan(math.radians(a)), (NUM,), ()),
    "asin": (lambda v: math.degrees(math.asin(v)), (NUM,), ()),
    "acos": (lambda v: math.degrees(math.acos(v)), (NUM,), ()),
    "atan": (lambda v: math.degrees(math.atan(v)), (NUM,), ()),
    "atan2": (lambda y, x: math.degrees(math.atan2(y, x)), (NUM, NUM), ()),
    "round": (_rounded, (NUM,), ("dec",)),
    "trunc": (_truncated, (NUM,), ("dec",)),
    **TEXT_FUNCTIONS,
}
"""name → function; these depend on their arguments alone."""

_WITH_DNUM = words("abs sqrt pow sin cos tan asin acos atan atan2 round trunc")
COMPUTED |= {f"{name}dnum": COMPUTED[name] for name in _WITH_DNUM}
COMPUTED |= dict.fromkeys(("numtodnum", "dnumtonum"), (float, (NUM,), ()))


def _asking(**kinds: str) -> dict[str, Type | None]:
    types: dict[str, Type | None] = {"num": NUM, "bool": BOOL, "string": STRING, "any": None}
    return {name: types[kind] for kind, names in kinds.items() for name in words(names)}


STATE: dict[str, Type | None] = {
    **_asking(
        num="""ainput aoutput dinput doutput ginput goutput ginputdnum goutputdnum clkread
        readmotor filesize fssize texttab readnum iounitstate pathlengthget progmemfree
        readbin uinumentry uinumtune uilistview uimessagebox uidnumentry uidnumtune gettime
        corrread socketgetstatus getaxisload getmotorconf gettorque iosignalstate getsignal
        testsignread cspeedoverride gettsptint modtime filetime modtimednum filetimednum
        egmgetstate getaxisdistance getaxismovetime getmotortorque getmaxnumberofcyclicbool
        getnumberofcyclicbool paridrobvalid paridposvalid remainingretries camgetexposure
        camnumberofresults getsignaldnum stcalcforce stcalctorque getmaxusagetime""",
        bool="""testdi ismechunitactive isfile istaskmec uiclientexist robinlimit poslimit validio
        isvarinit isrobtarget ispathplan stapresent strtoval getnextsym texttabfreetouse
        pathrecvalidbwd pathrecvalidfwd indinpos indspeed iscyclicbool
        tasksinsync hand_iscalibrated hand_isgripperopen hand_isvacuum1on triggdatavalid stiscalib
        stisclosed stisindgun stisopen cnvpredictreach getnextcyclicbool getnextmechunit
        fcisforcemode""",
        string="""cdate ctime readstr readstrbin uialphaentry
        getsysinfo strdigcalc textget texttabget socketpeek filename getserviceinfo
        getmecunitname getuasusername rmqgetslotname camgetloadedjob camgetname""",
        any="""ispersdata getsysdata readrawbytes rawbyteslen csystemparam dimension
        getuasuserdata getmodalpayloadmode readdir getsignalorigin fcgetforce fcgetprocessdata""",
    ),
    **dict.fromkeys(words("calcrotaxisframe calcrotaxframez defaccframe"), POSE),
    "fcloadid": LOADDATA,
    "crobt": ROBTARGET,
    "cpos": POS,
    "corient": ORIENT,
    "cjointt": JOINTTARGET,
    "calcjointt": JOINTTARGET,
    "calcrobt": ROBTARGET,
    "ctool": TOOLDATA,
    "cwobj": WOBJDATA,
}
"""Functions that ask the controller, the operator or the outside world, with the type of their
values, None where nothing is known of it. They move nothing."""

OF_THE_ARM: dict[str, float] = {
    "maxrobspeed": VMAX[0],
    "maxrobreorientspeed": VMAX[1],
    "maxextlinearspeed": VMAX[2],
    "maxextreorientspeed": VMAX[3],
}
"""Functions whose value differs from arm to arm, with what stands in for it. No arm's TCP goes
faster: shares of it are too fast then, so that it is asked for unless a backup states it."""

_RUN_CONT_CYCLE, _OP_AUTO = 1.0, 1.0

IN_PRODUCTION: dict[str, Value] = {
    "runmode": _RUN_CONT_CYCLE,
    "opmode": _OP_AUTO,
    "gettaskname": "T_ROB1",
    "robname": "ROB_1",
    "motionplannerno": 1.0,
    **dict.fromkeys(words("nonmotionmode eventtype execlevel exechandler pathlevel"), 0.0),
    **dict.fromkeys(words("robos taskrunmec taskrunrob taskisactive taskisexecuting"), True),
    **dict.fromkeys(
        words(
            """isstopmoveact isstopstateevent issyncmoveon isleadthrough pfrestart
            ppmovedinmanmode isbrakecheckactive"""
        ),
        False,
    ),
}
"""Functions that ask in which way the program runs, with what they say where one robot runs it in
automatic mode, cycle after cycle, and nothing has gone wrong."""
