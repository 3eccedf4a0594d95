"""Program → KRL: exact text, names, numbers, refusals; and the same text when it is read again."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError, MotionError
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.event import Event, EventAnchor
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Load, Tool, WorkObject
from flyby.core.program.zone import FINE, Angle, ContourFraction, Radius, VendorZone, Zone
from flyby.core.registry import find_vendor
from flyby.core.source.text.names import Names
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_quaternion
from flyby.vendors.abb.motion.configuration import AbbConfiguration
from flyby.vendors.kuka.motion.configuration import KukaConfiguration
from flyby.vendors.kuka.syntax.names import MAX_NAME, NAME_RULES
from flyby.vendors.kuka.values.angles import angles, quaternion, written_angles
from flyby.vendors.kuka.write.numbers import number
from flyby.vendors.kuka.write.writer import write
from flyby.vendors.kuka.zone_kinds import C_VEL

KUKA = find_vendor("kuka")
ROBOT = KUKA.robot("kr30-3")
DOWN = (0.0, 0.0, 1.0, 0.0)
UP = KukaConfiguration(2, 2)
HALF = Speed(joint_fraction=0.5, joint_acceleration_fraction=0.8)
SLOW = Speed(tcp=0.25)


def at(x: float, y: float, z: float, **more: object) -> PoseTarget:
    """A target in mm, flange down."""
    return PoseTarget(Pose((x / 1000, y / 1000, z / 1000), DOWN), **more)  # type: ignore[arg-type]


def axes(*degrees: float, **more: object) -> JointTarget:
    return JointTarget(tuple(map(math.radians, degrees)), **more)  # type: ignore[arg-type]


HOME = axes(0, -90, 90, 0, 45, 0)


def program(*statements: Move | Wait | Opaque, name: str = "Job") -> Program:
    return Program(statements, name)


def body(written: dict[str, str]) -> list[str]:
    """The statements after the INI fold."""
    source = next(text for name, text in written.items() if name.endswith(".src"))
    lines = source.splitlines()
    return lines[lines.index(";ENDFOLD (INI)") + 2 : -1]


def data(written: dict[str, str]) -> dict[str, str]:
    """name → aggregate of the data list."""
    text = next(text for name, text in written.items() if name.endswith(".dat"))
    return dict(re.findall(r"DECL (?:E6POS|E6AXIS|FRAME|LOAD) (\w+)=(.*)", text))


GUN = Tool("tGun", Pose((0.0, 0.0, 0.25)), Load(12.5, (0.0, 0.0, 0.1), (0.1, 0.2, 0.3)))
TABLE = WorkObject("bTable", Pose((1.0, 0.0, 0.5)))

GOLDEN = program(
    MoveJ(replace(HOME, name="XHOME_1"), HALF),
    MoveJ(at(1340, 0, 1200, configuration=UP, name="XStart"), HALF, ContourFraction(0.3)),
    MoveL(at(1400, 10.5, 1200), SLOW, Radius(0.0125, 0.0125, 0.0125)),
    Opaque("$OUT[3]=TRUE"),
    MoveL(
        at(100, 0, 50),
        Speed(tcp=0.1, reorientation=math.radians(90), tcp_acceleration=2.5),
        Angle(math.radians(5)),
        GUN,
        TABLE,
    ),
    Wait(0.5),
    MoveC(
        at(1500, 100, 1200),
        SLOW,
        VendorZone(C_VEL, 0.4),
        via=at(1450, 80, 1200),
        orientation=ArcOrientation.FIXED_FRAME,
        events=(
            Event("$OUT[1]=TRUE", EventAnchor.START, time=0.02),
            Event("$OUT[2]=FALSE", EventAnchor.END, distance=0.012),
        ),
    ),
    MoveL(at(1340, 0, 1200, name="XStart"), SLOW),
)
SRC = """&ACCESS RVP
&REL 1
&COMMENT Written by flyby
DEF Job( )
;FOLD INI
  ;FOLD BASISTECH INI
    BAS (#INITMOV,0 )
  ;ENDFOLD (BASISTECH INI)
  ;FOLD USER INI
    ;Make your modifications here
  ;ENDFOLD (USER INI)
;ENDFOLD (INI)

$IPO_MODE=#BASE
$BASE=$NULLFRAME
$TOOL=$NULLFRAME
$LOAD=NOLOAD
BAS(#VEL_PTP,50)
BAS(#ACC_PTP,80)
PTP XHOME_1
$APO.CPTP=30
PTP XStart C_PTP
$VEL.CP=0.25
$VEL.ORI1=$VEL_MA.ORI1
$VEL.ORI2=$VEL_MA.ORI2
$ACC.CP=$ACC_MA.CP
$ACC.ORI1=$ACC_MA.ORI1
$ACC.ORI2=$ACC_MA.ORI2
$APO.CDIS=12.5
LIN XP1 C_DIS
$OUT[3]=TRUE
$BASE=bTable
$TOOL=tGun
$LOAD=LOAD1
$VEL.CP=0.1
$VEL.ORI1=90
$VEL.ORI2=90
$ACC.CP=2.5
$APO.CORI=5
LIN XP2 C_ORI
WAIT SEC 0.5
$BASE=$NULLFRAME
$TOOL=$NULLFRAME
$LOAD=NOLOAD
$VEL.CP=0.25
$VEL.ORI1=$VEL_MA.ORI1
$VEL.ORI2=$VEL_MA.ORI2
$ACC.CP=$ACC_MA.CP
$CIRC_TYPE=#BASE
$APO.CVEL=40
TRIGGER WHEN DISTANCE=0 DELAY=-20 DO $OUT[1]=TRUE
TRIGGER WHEN PATH=-12 DELAY=0 DO $OUT[2]=FALSE
CIRC XP3,XP4 C_VEL
LIN XStart
END
"""
DAT = """&ACCESS RVP
&REL 1
DEFDAT Job
;FOLD EXTERNAL DECLARATIONS
  ;FOLD BASISTECH EXT
    EXT BAS (BAS_COMMAND :IN,REAL :IN )
    DECL INT SUCCESS
  ;ENDFOLD (BASISTECH EXT)
  ;FOLD USER EXT
    ;Make your modifications here
  ;ENDFOLD (USER EXT)
;ENDFOLD (EXTERNAL DECLARATIONS)
DECL FRAME bTable={X 1000,Y 0,Z 500,A 0,B 0,C 0}
DECL FRAME tGun={X 0,Y 0,Z 250,A 0,B 0,C 0}
DECL LOAD NOLOAD={M 0,CM {X 0,Y 0,Z 0,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}
DECL LOAD LOAD1={M 12.5,CM {X 0,Y 0,Z 100,A 0,B 0,C 0},J {X 0.1,Y 0.2,Z 0.3}}
DECL E6AXIS XHOME_1={A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
DECL E6POS XStart={X 1340,Y 0,Z 1200,A 180,B 0,C 180,S 2,T 2}
DECL E6POS XP1={X 1400,Y 10.5,Z 1200,A 180,B 0,C 180}
DECL E6POS XP2={X 100,Y 0,Z 50,A 180,B 0,C 180}
DECL E6POS XP3={X 1450,Y 80,Z 1200,A 180,B 0,C 180}
DECL E6POS XP4={X 1500,Y 100,Z 1200,A 180,B 0,C 180}
ENDDAT
"""


def read_back(written: dict[str, str], folder: Path) -> Program:
    for name, text in written.items():
        (folder / name).write_text(text, "utf-8", newline="")
    main = next(name for name in written if name.endswith(".src"))
    return KUKA.read_file(folder / main, robot=ROBOT)


def test_exact_text_in_both_directions(tmp_path: Path) -> None:
    written = write(GOLDEN, ROBOT, {})
    assert written == {"Job.src": SRC, "Job.dat": DAT}
    assert write(read_back(written, tmp_path), ROBOT, {}) == written


def test_settings_are_stated_where_they_change_only() -> None:
    moves = [MoveL(at(1300 + 10 * k, 0, 1200), SLOW, Radius(0.01)) for k in range(5)]
    lines = body(write(program(*moves), ROBOT, {}))
    assert sum("$APO.CDIS" in line for line in lines) == 1
    assert sum("$VEL.CP" in line for line in lines) == 1
    assert sum(line.endswith("C_DIS") for line in lines) == 5


def test_a_stationary_tool_exchanges_tool_and_base(tmp_path: Path) -> None:
    tool = Tool("tFixed", Pose((1.2, 0.0, 1.1)), robot_held=False)
    part = WorkObject("bPart", Pose((0.0, 0.0, 0.2)), robot_held=True)
    one = program(MoveJ(HOME, HALF), MoveL(at(10, 20, 30), SLOW, FINE, tool, part))
    written = write(one, ROBOT, {})
    lines = body(written)
    assert {"$IPO_MODE=#TCP", "$BASE=tFixed", "$TOOL=bPart"} <= set(lines)
    again = read_back(written, tmp_path).moves[1]
    assert (again.tool, again.work_object) == (tool, part)


def test_tool_and_payload_are_one_load_on_the_flange() -> None:
    bare = Tool("t", Pose((0.0, 0.0, 0.2)))
    payload = Load(3.0, (0.0, 0.0, 0.1), (0.01, 0.02, 0.03))
    alone = data(write(program(MoveJ(HOME, HALF, FINE, bare, load=payload)), ROBOT, {}))
    assert "{M 3,CM {X 0,Y 0,Z 300," in "".join(alone.values())
    heavy = replace(bare, load=Load(1.0, (0.0, 0.0, 0.1)))
    both = data(write(program(MoveJ(HOME, HALF, FINE, heavy, load=payload)), ROBOT, {}))
    assert "{M 4,CM {X 0,Y 0,Z 250," in "".join(both.values())
    # Steiner: 1 kg and 3 kg, 0.2 m apart, about their common centre.
    moments = re.search(r"J \{X ([\d.]+),Y ([\d.]+),Z ([\d.]+)\}", "".join(both.values()))
    assert moments is not None
    assert sorted(map(float, moments.groups())) == pytest.approx([0.03, 0.04, 0.05])


def test_the_first_motion_names_its_configuration(tmp_path: Path) -> None:
    q = np.radians([20, -75, 105, 10, 50, -30])
    target = PoseTarget(ROBOT.flange_pose(q))
    start = JointTarget(tuple(float(v) for v in q))
    open_target = replace(target, pose=replace(target.pose, position=(1.2, 0.3, 1.0)))
    one = Program((MoveJ(target, HALF), MoveJ(open_target, HALF)), "Job", start)
    written = write(one, ROBOT, {})
    first, second = data(written)["XP1"], data(written)["XP2"]
    assert first.endswith("S 2,T 35}") or first.endswith("S 2,T 34}")
    assert "S " not in second and "T " not in second
    found = read_back(written, tmp_path).moves[0].target
    assert isinstance(found, PoseTarget) and found.configuration is not None


def test_statements_of_another_language_become_comments() -> None:
    one = program(MoveJ(HOME, HALF, events=(Event("SetDO do1,1;"),)), Opaque("SetDO do1,1;\nx;"))
    lines = body(write(one, ROBOT, {"opaque": "comment"}))
    assert lines.count("; SetDO do1,1;") == 2 and "; x;" in lines


# Names and numbers


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["XA", "XA"], ["XA", "XA_2"]),
        (["XA", "xa"], ["XA", "xa_2"]),
        ([None, "XP1"], ["XP2", "XP1"]),
        (["P[3]", "a.b"], ["P_3", "a_b"]),
        (["for", "E6Pos", "XHOME"], ["for_2", "E6Pos_2", "XHOME_2"]),
        (["3D", "Größe"], ["XP_3D", "Gr_e"]),
        (["p" * 30, "p" * 25], ["p" * 24, "p" * 22 + "_2"]),
        (["Job", "$VEL"], ["Job_2", "VEL"]),
    ],
)
def test_names_are_kept_where_legal_and_unique(
    names: list[str | None], expected: list[str]
) -> None:
    moves = [MoveL(at(k, 0, 0, name=name), SLOW) for k, name in enumerate(names)]
    written = write(program(*moves), ROBOT, {})
    assert [name for name in data(written) if name != "NOLOAD"] == expected


@given(st.lists(st.text(max_size=30), max_size=8))
def test_every_name_given_out_is_legal_and_unique(wanted: list[str]) -> None:
    names = Names(NAME_RULES, ["main"])
    given_out = [names.claim(name, "P") for name in wanted]
    assert len({name.casefold() for name in given_out}) == len(given_out)
    for name in given_out:
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) and len(name) <= MAX_NAME
        assert name.casefold() not in {"main", "ptp", "xhome", "tool_data"}


@given(st.floats(-1e9, 1e9, allow_subnormal=False))
def test_numbers_are_plain_decimals(value: float) -> None:
    text = number(value)
    assert re.fullmatch(r"-?\d+(\.\d+)?", text)
    assert math.isclose(float(text), value, rel_tol=1e-11, abs_tol=1e-10)
    assert number(float(text)) == text


def test_numbers_beyond_real_are_refused() -> None:
    for value in (1e39, math.inf, math.nan):
        with pytest.raises(InputError, match="IEEE single"):
            number(value)


ANGLES = st.floats(-180, 180) | st.sampled_from([0.0, 90.0, -90.0, 180.0, -180.0, 89.9999999])


@given(ANGLES, ANGLES, ANGLES)
def test_angles_give_the_rotation_back(a: float, b: float, c: float) -> None:
    q = quaternion(a, b, c)
    assert q[0] >= 0 and math.isclose(math.hypot(*q), 1, rel_tol=1e-12)
    assert np.abs(matrix_from_quaternion(np.array(q)) - rotation(a, b, c)).max() < 1e-14 * 50
    for found in (angles(q), written_angles(q)):
        assert abs(found[1]) <= 90 and max(map(abs, found)) <= 180
        away = matrix_from_quaternion(np.array(quaternion(*found))) - rotation(a, b, c)
        assert np.abs(away).max() < 1e-10


def rotation(a: float, b: float, c: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Rz(A) Ry(B) Rx(C), written out."""
    (sa, ca), (sb, cb), (sc, cc) = (
        (math.sin(math.radians(v)), math.cos(math.radians(v))) for v in (a, b, c)
    )
    return np.array(
        [
            [ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc],
            [sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc],
            [-sb, cb * sc, cb * cc],
        ]
    )


@given(st.integers(-1800, 1800), st.integers(-900, 900), st.integers(-1800, 1800))
def test_angles_that_were_written_are_written_again(a: int, b: int, c: int) -> None:
    first = written_angles(quaternion(a / 10, b / 10, c / 10))
    assert written_angles(quaternion(*first)) == first
    if abs(b) < 900:
        expected = [a / 10, b / 10, c / 10]
        turns = [math.remainder(x - y, 360) for x, y in zip(first, expected, strict=True)]
        assert max(map(abs, turns)) < 1e-9


# Refusals


REFUSED: list[tuple[Move, str]] = [
    (MoveJ(HOME, Speed(tcp=1.0)), "Speed.tcp"),
    (MoveJ(HOME, Speed(joint=1.0)), "Speed.joint"),
    (MoveJ(HOME, Speed(duration=1.0)), "Speed.duration"),
    (MoveJ(HOME, Speed(jerk_fraction=0.5)), "jerk"),
    (MoveL(at(0, 0, 0), Speed(joint_fraction=0.5)), "Speed.joint_fraction"),
    (MoveL(at(0, 0, 0), Speed(tcp=1e-12)), "too small"),
    (MoveL(HOME, SLOW), "take a position, not axis values"),
    (MoveL(at(0, 0, 0), SLOW, ContourFraction(0.5)), "not by ContourFraction"),
    (MoveJ(HOME, HALF, Angle(0.1)), "not by Angle"),
    (MoveJ(HOME, HALF, VendorZone(C_VEL, 0.1)), "not by C_VEL"),
    (MoveL(at(0, 0, 0), SLOW, Radius(0.01, 0.02)), "Radius.reorientation"),
    (MoveL(at(0, 0, 0), SLOW, Radius(0.01, external=0.02)), "Radius.external"),
    (MoveL(at(0, 0, 0), SLOW, Radius(0.01, angle=0.1)), "Radius.angle"),
    (MoveJ(axes(0, 0, 0, 0, 0, 0, 0), HALF), "6 arm axes"),
    (MoveJ(axes(0, 0, 0, 0, 0, 0, external=(0.5,)), HALF), "1 external axes"),
    (MoveJ(at(0, 0, 0, configuration=AbbConfiguration(0, 0, 0, 0)), HALF), "Status and Turn"),
    (MoveL(at(0, 0, 0), SLOW, tool=Tool(robot_held=False)), "held by the robot"),
    (MoveL(at(0, 0, 0), SLOW, work_object=WorkObject("b", moved_by="E1")), "moved by E1"),
    (MoveL(at(4e41, 0, 0), SLOW), "IEEE single"),
    (
        MoveL(at(0, 0, 0), SLOW, events=(Event("x", EventAnchor.START, 0.1),)),
        "not from its start",
    ),
    (MoveJ(HOME, HALF, events=(Event("x", EventAnchor.END, 0.1),)), "along a PTP"),
]


@pytest.mark.parametrize(("move", "message"), REFUSED, ids=[message for _, message in REFUSED])
def test_what_krl_cannot_say_is_refused_by_move(move: Move, message: str) -> None:
    with pytest.raises(MotionError, match=message) as caught:
        write(program(MoveJ(HOME, HALF), move), ROBOT, {})
    assert "move 2" in str(caught.value)


@pytest.mark.parametrize("options", [{"zones": "own"}, {"opaque": "drop"}, {"style": "spline"}])
def test_unknown_options_are_refused(options: dict[str, str]) -> None:
    with pytest.raises(InputError, match=next(iter(options))):
        write(program(MoveJ(HOME, HALF)), ROBOT, options)


def test_seven_axes_are_refused() -> None:
    with pytest.raises(FlybyError, match="6 axes"):
        write(program(), KUKA.robot("iiwa7-r800"), {})


@pytest.mark.parametrize("zone", [Radius(0.02), ContourFraction(0.37), FINE])
def test_no_approximation_is_dropped(zone: Zone, tmp_path: Path) -> None:
    moves = [MoveJ(axes(k, -90, 90, 0, 45, 0), HALF, zone) for k in range(3)]
    again = read_back(write(program(*moves), ROBOT, {}), tmp_path)
    assert {type(move.zone) for move in again.moves} == {type(zone)}
