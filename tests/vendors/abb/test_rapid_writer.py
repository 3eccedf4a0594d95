"""Program → RAPID: exact text, names, refusals; and the same text when it is read again."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError, MotionError
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Load, Tool, WorkObject
from flyby.core.program.zone import FINE, Angle, ContourFraction, Radius, VendorZone, Zone
from flyby.core.registry import find_robot
from flyby.core.source.text.names import Names
from flyby.core.source.write.options import OpaqueStyle
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import arc_angle
from flyby.vendors.abb.language import Rapid
from flyby.vendors.abb.motion.configuration import AbbConfiguration
from flyby.vendors.abb.run.reader import read
from flyby.vendors.abb.values import predefined
from flyby.vendors.abb.values.records import MM
from flyby.vendors.abb.write.formatting import MAX_NAME, NAME_RULES
from flyby.vendors.abb.write.numbers import number
from flyby.vendors.abb.write.operands import predefined_within
from flyby.vendors.abb.write.options import RapidOptions, ZoneStyle
from flyby.vendors.abb.write.writer import write
from flyby.vendors.kuka.zone_kinds import C_VEL

OPTIONS = RapidOptions()
DOWN = (0.0, 0.0, 1.0, 0.0)
V500 = predefined.speed("v500")
Z10 = predefined.zone("z10")
assert V500 is not None and Z10 is not None


def at(x: float, y: float, z: float, **more: object) -> PoseTarget:
    """A target in mm, flange down."""
    return PoseTarget(Pose((x * MM, y * MM, z * MM), DOWN), **more)  # type: ignore[arg-type]


def program(*statements: Move | Wait | Opaque, name: str = "Job") -> Program:
    return Program(statements, name)


def body(text: str) -> list[str]:
    """The instructions of PROC main."""
    lines = [line.strip() for line in text.splitlines()]
    return lines[lines.index("PROC main()") + 1 : lines.index("ENDPROC")]


def data(text: str, type_: str) -> dict[str, str]:
    """name → literal of the declarations of one type."""
    return dict(re.findall(rf"(?:CONST|PERS) {type_} (\w+) := (.*);", text))


FRONT = AbbConfiguration(0, -1, 0, 1)
GUN = Tool("tGun", Pose((0.0, 0.0, 0.25)), Load(12.5, (0.0, 0.0, 0.1), (0.1, 0.2, 0.3)))
TABLE = WorkObject("wTable", Pose((1.0, 0.0, 0.5)), Pose((0.0, 0.1, 0.0)))
TRACK = "[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]"

GOLDEN = [
    pytest.param(
        program(
            MoveJ(JointTarget(tuple(np.radians([0, -10, 20.5, 0, 45, 0])), name="jHome"), V500),
            MoveJ(at(1200, 0, 900, configuration=FRONT, name="pStart"), V500, Z10),
            MoveL(at(1300, 0, 900, configuration=FRONT), V500),
        ),
        OPTIONS,
        rf"""MODULE Job
  ! Written by flyby.
  CONST jointtarget jHome := [[0,-10,20.5,0,45,0],{TRACK}];
  CONST robtarget pStart := [[1200,0,900],[0,0,1,0],[0,-1,0,1],{TRACK}];
  CONST robtarget p10 := [[1300,0,900],[0,0,1,0],[0,-1,0,1],{TRACK}];

  PROC main()
    MoveAbsJ jHome,v500,fine,tool0;
    MoveJ pStart,v500,z10,tool0;
    SingArea \Off;
    MoveL p10,v500,fine,tool0;
  ENDPROC
ENDMODULE
""",
        id="moves",
    ),
    pytest.param(
        program(
            MoveL(
                at(100, 0, 50),
                Speed(0.0125, 1.0, 5.0, 10.0, tcp_acceleration=2.5),
                Radius(0.0075, 0.0075, 0.01),
                GUN,
                TABLE,
                Load(3.25, (0.0, 0.0, 0.05)),
            ),
            Opaque("SetDO doGun,1;"),
            Wait(0.5),
            MoveC(
                at(200, 0, 50),
                replace(
                    V500,
                    joint_acceleration_fraction=0.6,
                    jerk_fraction=0.5,
                    duration=2.5,
                    name=None,
                ),
                Z10,
                GUN,
                TABLE,
                via=at(150, 50, 50),
                orientation=ArcOrientation.FIXED_FRAME,
            ),
            name="main",
        ),
        OPTIONS,
        rf"""MODULE MainModule
  ! Written by flyby.
  PERS tooldata tGun := [TRUE,[[0,0,250],[1,0,0,0]],[12.5,[0,0,100],[1,0,0,0],0.1,0.2,0.3]];
  PERS wobjdata wTable := [FALSE,TRUE,"",[[1000,0,500],[1,0,0,0]],[[0,100,0],[1,0,0,0]]];
  PERS loaddata load1 := [3.25,[0,0,50],[1,0,0,0],0,0,0];
  CONST speeddata v12_5 := [12.5,57.29578,5000,572.9578];
  CONST zonedata z7_5 := [FALSE,7.5,7.5,10,0,0,0];
  CONST robtarget p10 := [[100,0,50],[0,0,1,0],[0,0,0,0],{TRACK}];
  CONST robtarget p20 := [[150,50,50],[0,0,1,0],[0,0,0,0],{TRACK}];
  CONST robtarget p30 := [[200,0,50],[0,0,1,0],[0,0,0,0],{TRACK}];

  PROC main()
    ConfL \Off;
    SingArea \Off;
    PathAccLim TRUE\AccMax:=2.5,TRUE\DecelMax:=2.5;
    GripLoad load1;
    MoveL p10,v12_5,z7_5,tGun\WObj:=wTable;
    SetDO doGun,1;
    WaitTime 0.5;
    CirPathMode \ObjectFrame;
    AccSet 60,50;
    PathAccLim FALSE,FALSE;
    GripLoad load0;
    MoveC p20,p30,v500\T:=2.5,z10,tGun\WObj:=wTable;
  ENDPROC
ENDMODULE
""",
        id="settings",
    ),
    pytest.param(
        program(
            MoveL(
                at(0, 0, 0, external=(1.25, math.pi / 2)),
                V500,
                Radius(0.012, 0.1),
                Tool("tFixed", Pose((1.0, 2.0, 3.0)), robot_held=False),
                WorkObject("wHeld", robot_held=True),
            ),
            MoveL(at(1, 0, 0, external=(-0.5,)), V500, Radius(0.0001)),
        ),
        RapidOptions(zones=ZoneStyle.PREDEFINED, external_axes=("linear", "rotating")),
        r"""MODULE Job
  ! Written by flyby.
  ! Zones are the largest predefined ones within the program's own radii.
  PERS tooldata tFixed := [FALSE,[[1000,2000,3000],[1,0,0,0]],[0.001,[0,0,0.001],[1,0,0,0],0,0,0]];
  PERS wobjdata wHeld := [TRUE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget p10 := [[0,0,0],[0,0,1,0],[0,0,0,0],[1250,90,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget p20 := [[1,0,0],[0,0,1,0],[0,0,0,0],[-500,9E+09,9E+09,9E+09,9E+09,9E+09]];

  PROC main()
    ConfL \Off;
    SingArea \Off;
    MoveL p10,v500,z10,tFixed\WObj:=wHeld;
    MoveL p20,v500,fine,tool0;
  ENDPROC
ENDMODULE
""",
        id="stationary tool, external axes, predefined zones",
    ),
]


@pytest.mark.parametrize(("written", "options", "text"), GOLDEN)
def test_exact_text_in_both_directions(written: Program, options: RapidOptions, text: str) -> None:
    assert write(written, options) == text
    back = read(text, "golden.mod", external_axes=options.external_axes or None)
    assert write(back, options) == text


def test_the_writer_names_the_file_after_the_module() -> None:
    written = program(MoveJ(at(0, 0, 0), V500), name="Job-1")
    robot = find_robot("abb/irb6640-180-255")
    (item,) = Rapid().write(written, robot, {}).items()
    assert item == ("Job_1.mod", write(written, OPTIONS))


# Names


def test_equal_values_share_a_datum_and_others_do_not() -> None:
    own = Speed(tcp=0.33)
    text = write(
        program(
            *(MoveL(at(x, 0, 0), own, Radius(0.007)) for x in (0, 100, 0)),
            MoveL(at(200, 0, 0), Speed(tcp=0.33, reorientation=1.0), Radius(0.007)),
        ),
        OPTIONS,
    )
    assert list(data(text, "speeddata")) == ["v330", "v330_2"]
    assert list(data(text, "zonedata")) == ["z7"]
    assert list(data(text, "robtarget")) == ["p10", "p20", "p30"]


def test_a_load_under_another_name_is_no_change() -> None:
    load = Load(2.0, (0.0, 0.0, 0.1))
    loads = (load, replace(load, name="loPart"), None)
    text = write(program(*(MoveJ(at(0, 0, 0), V500, load=one) for one in loads)), OPTIONS)
    assert [s for s in body(text) if "Grip" in s] == ["GripLoad load1;", "GripLoad load0;"]


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["pA", "pA"], ["pA", "pA_2"]),
        (["pA", "PA"], ["pA", "PA_2"]),
        ([None, "p10"], ["p20", "p10"]),
        (["pHole{3}", "p.trans"], ["pHole_3", "p_trans"]),
        (["for", "Robtarget"], ["for_2", "Robtarget_2"]),
        (["v100", "TOOL0"], ["v100_2", "TOOL0_2"]),
        (["main", "job"], ["main_2", "job_2"]),
        (["3D", "Größe", "übrig"], ["p_3D", "Gr_e", "brig"]),
        (["p" * 40, "p" * 33], ["p" * 32, "p" * 30 + "_2"]),
        (["", "{}"], ["p10", "p"]),
    ],
)
def test_names_are_kept_where_legal_and_unique(
    names: list[str | None], expected: list[str]
) -> None:
    moves = [MoveL(at(k, 0, 0, name=name), V500) for k, name in enumerate(names)]
    assert list(data(write(program(*moves), OPTIONS), "robtarget")) == expected


@given(st.lists(st.text(max_size=40), max_size=8))
def test_every_name_given_out_is_legal_and_unique(wanted: list[str]) -> None:
    names = Names(NAME_RULES, ["main"])
    given_out = [names.claim(name, "p") for name in wanted]
    assert len({name.casefold() for name in given_out}) == len(given_out)
    for name in given_out:
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) and len(name) <= MAX_NAME
        assert name.casefold() not in predefined.NAMES | {"main", "for", "robtarget"}


# Predefined data


def test_predefined_data_are_found_in_any_case() -> None:
    assert predefined.speed("V500") == predefined.speed("v500") == V500
    assert predefined.zone("FINE") == FINE
    assert predefined.zone("Z10") == Radius(
        0.01, 0.015, 0.015, math.radians(1.5), 0.015, math.radians(1.5), "z10"
    )
    assert predefined.speed("v25") is None and predefined.zone("z25") is None


@pytest.mark.parametrize("name", predefined.SPEEDS)
def test_predefined_speeds_need_no_declaration(name: str) -> None:
    speed = predefined.speed(name)
    assert speed is not None
    for given_name in (name, None):
        text = write(program(MoveL(at(0, 0, 0), replace(speed, name=given_name))), OPTIONS)
        assert body(text)[-1] == f"MoveL p10,{name},fine,tool0;"
        assert not data(text, "speeddata")


@pytest.mark.parametrize("name", predefined.ZONES)
def test_predefined_zones_need_no_declaration(name: str) -> None:
    zone = predefined.zone(name)
    assert zone is not None
    text = write(program(MoveL(at(0, 0, 0), V500, zone)), OPTIONS)
    assert body(text)[-1] == f"MoveL p10,v500,{name},tool0;"
    assert not data(text, "zonedata")
    assert predefined_within(zone) == name  # type: ignore[arg-type]


def test_a_predefined_name_with_other_numbers_is_not_believed() -> None:
    text = write(program(MoveL(at(0, 0, 0), Speed(tcp=0.33, name="v500"))), OPTIONS)
    assert data(text, "speeddata") == {"v330": "[330,500,5000,1000]"}


def test_a_speed_left_to_the_robot_is_vmax() -> None:
    assert (
        body(write(program(MoveJ(at(0, 0, 0), Speed())), OPTIONS))[-1]
        == "MoveJ p10,vmax,fine,tool0;"
    )


@given(st.floats(0, 0.5))
@example(0.01)
@example(0.0003)
def test_predefined_zones_are_the_largest_within(radius: float) -> None:
    chosen = predefined.ZONES[predefined_within(Radius(radius))]
    limit = radius / MM
    assert chosen[1] <= limit * (1 + 1e-6)
    assert not any(chosen[1] < r[1] <= limit * (1 - 1e-6) for r in predefined.ZONES.values())


# What RAPID cannot say

REFUSED = [
    (MoveL(at(0, 0, 0), V500, Angle(0.1)), "no zone by Angle"),
    (MoveL(at(0, 0, 0), V500, ContourFraction(0.5)), "no zone by ContourFraction"),
    (MoveL(at(0, 0, 0), V500, VendorZone(C_VEL, 0.5)), "no zone by C_VEL"),
    (MoveJ(at(0, 0, 0), Speed(joint=1.0)), "a joint speed in rad/s"),
    (MoveJ(at(0, 0, 0), Speed(joint_acceleration=1.0)), "a joint acceleration"),
    (MoveJ(at(0, 0, 0), Speed(reorientation_acceleration=1.0)), "acceleration of reorientation"),
    (MoveJ(at(0, 0, 0), Speed(joint_fraction=0.3)), "30% of their speed"),
    (MoveJ(at(0, 0, 0), Speed(joint_acceleration_fraction=0.1)), "20% of the acceleration"),
    (MoveJ(at(0, 0, 0), Speed(jerk_fraction=0.05)), "10% of the jerk"),
    (MoveL(JointTarget((0.0,) * 6), V500), "takes a robtarget"),
    (MoveJ(JointTarget((0.0,) * 7), V500), "has 6 arm axes, but the target has 7"),
    (MoveJ(at(0, 0, 0, external=(1.0,)), V500), "external_axes="),
    (MoveL(at(1e42, 0, 0), V500), "IEEE single"),
    (MoveL(at(0, 0, 0), V500, tool=Tool("t", robot_held=False)), "both are alike"),
]


@pytest.mark.parametrize(("move", "message"), REFUSED, ids=[m for _, m in REFUSED])
def test_what_rapid_cannot_say_is_refused_by_move(move: Move, message: str) -> None:
    with pytest.raises(MotionError, match=re.escape(message)) as caught:
        write(program(MoveJ(at(9, 9, 9), V500), Wait(1), move), OPTIONS)
    assert str(caught.value).startswith("move 2: ")
    assert caught.value.move == 1


def test_another_vendors_configuration_is_refused() -> None:
    class Foreign:
        exact = True

        def mismatch(self, label: object) -> float:
            return 0.0

    with pytest.raises(MotionError, match="is no confdata"):
        write(program(MoveJ(at(0, 0, 0, configuration=Foreign()), V500)), OPTIONS)


def arc(sweep: float, radius: float = 100.0, aside: float = 0.0) -> Program:
    """A move to the start of an arc about the origin, and the arc (degrees, mm).

    The start is given in a work object that stands ``aside`` along y, for a tool as much longer.
    """
    start, via, end = (
        at(radius * math.cos(a), radius * math.sin(a), 0) for a in np.radians([0, sweep / 2, sweep])
    )
    frame = WorkObject("aside", Pose((0.0, aside * MM, 0.0)))
    longer = Tool("longer", Pose((0.0, aside * MM, 0.0)))
    return program(MoveL(start, V500, FINE, longer, frame), MoveC(end, V500, via=via))


def test_long_arcs_and_small_arcs_are_refused() -> None:
    assert write(arc(239), OPTIONS)
    with pytest.raises(MotionError, match="move 2: MoveC: an arc of 241° is above the 240°"):
        write(arc(241), OPTIONS)
    with pytest.raises(MotionError, match=r"less than 0.1 mm"):
        write(arc(90, radius=0.05), OPTIONS)
    with pytest.raises(MotionError, match="less than 1° apart"):
        write(arc(3), OPTIONS)


def test_the_start_of_an_arc_is_seen_from_its_own_frame_and_tool() -> None:
    """Frame and tool aside cancel for a flange whose y is the world's, as it is here."""
    assert write(arc(239, aside=50), OPTIONS)
    with pytest.raises(MotionError, match="an arc of 241° is above"):
        write(arc(241, aside=50), OPTIONS)


def test_an_arc_from_joint_values_is_taken_as_it_comes() -> None:
    first, second = arc(241).moves
    start = MoveJ(JointTarget((0.0,) * 6), V500)
    assert write(program(start, second), OPTIONS)
    turned = replace(first, work_object=WorkObject("table", moved_by="STN1"))
    assert write(program(turned, second), OPTIONS)


@given(st.floats(1, 359), st.floats(0.05, 0.95), st.floats(0.01, 3))
def test_the_angle_of_an_arc(sweep: float, share: float, radius: float) -> None:
    a, b, c = (
        radius * np.array([math.cos(t), math.sin(t), 0.5])
        for t in np.radians([0, share * sweep, sweep])
    )
    assert math.degrees(arc_angle(a, b, c)) == pytest.approx(sweep, abs=1e-5)


def test_options_are_checked() -> None:
    with pytest.raises(InputError, match="'linear' or 'rotating'"):
        RapidOptions(external_axes=("sliding",))
    with pytest.raises(InputError, match="six external axes"):
        RapidOptions(external_axes=("linear",) * 7)


# Opaque statements


def test_statements_of_another_language_become_comments() -> None:
    foreign = program(Opaque("$OUT[3]=TRUE\nHALT"), MoveJ(at(0, 0, 0), V500))
    text = write(foreign, RapidOptions(opaque=OpaqueStyle.COMMENT))
    assert body(text)[:2] == ["! $OUT[3]=TRUE", "! HALT"]
    assert len(read(text, "x.mod").moves) == 1


def test_a_statement_of_several_lines_stays_as_it_is() -> None:
    source = "MODULE m\r\nPROC main()\r\n  SetDO\r\n      doA,\r\n   1;\r\nENDPROC\r\nENDMODULE"
    text = write(read(source, "x.mod"), OPTIONS)
    assert "    SetDO\n      doA,\n   1;\n" in text
    assert write(read(text, "y.mod"), OPTIONS) == text


# Numbers


@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_a_number_is_the_shortest_that_gives_the_single_back(value: float) -> None:
    text = number(value)
    assert re.fullmatch(r"-?\d+(\.\d+)?(E[+-]\d\d)?", text)
    assert np.float32(float(text)) == np.float32(value)
    assert number(float(text)) == text
    assert len(text.lstrip("-").replace(".", "").split("E")[0].strip("0")) <= 9


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0"),
        (-0.0, "0"),
        (12.5, "12.5"),
        (1 / 3, "0.33333334"),
        (1e-5, "1E-05"),
        (-2e9, "-2E+09"),
    ],
)
def test_spelling_of_numbers(value: float, text: str) -> None:
    assert number(value) == text


@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan, 1e39])
def test_numbers_beyond_single_precision_are_refused(value: float) -> None:
    with pytest.raises(InputError, match="IEEE single"):
        number(value)


def unit_quaternions() -> st.SearchStrategy[tuple[float, float, float, float]]:
    part = st.one_of(st.just(0.0), st.floats(-1, 1))

    def unit(q: tuple[float, ...]) -> tuple[float, float, float, float]:
        w, x, y, z = np.array(q) / np.linalg.norm(q)
        return float(w), float(x), float(y), float(z)

    return st.tuples(part, part, part, part).filter(lambda q: math.hypot(*q) > 1e-3).map(unit)


# Any program

names = st.one_of(st.none(), st.sampled_from(["p1", "P1", "v500", "z10", "a b", "pHole{2}", "for"]))
lengths = st.floats(-3, 3)
positions = st.tuples(lengths, lengths, lengths)
poses = st.builds(Pose, positions, unit_quaternions())
quadrants = st.integers(-4, 3)
configurations = st.one_of(
    st.none(), st.builds(AbbConfiguration, quadrants, quadrants, quadrants, st.integers(0, 7))
)
externals = st.lists(st.floats(-5, 5), max_size=2).map(tuple)
pose_targets = st.builds(PoseTarget, poses, configurations, externals, names)
joint_targets = st.builds(JointTarget, st.tuples(*[st.floats(-6, 6)] * 6), externals, names)
positive = st.floats(1e-3, 100)
maybe = st.one_of(st.none(), positive)
fraction = st.floats(0.2, 1)
predefined_speeds = st.sampled_from(sorted(predefined.SPEEDS)).map(predefined.speed)
speeds = st.one_of(
    predefined_speeds,
    st.builds(
        Speed,
        tcp=maybe,
        reorientation=maybe,
        external_linear=maybe,
        external_angular=maybe,
        tcp_acceleration=maybe,
        joint_acceleration_fraction=fraction,
        jerk_fraction=st.floats(0.1, 1),
        duration=maybe,
        name=names,
    ),
)
radius = st.floats(0, 0.3)
zones: st.SearchStrategy[Zone | None] = st.one_of(
    st.just(FINE),
    st.sampled_from(sorted(predefined.ZONES)).map(predefined.zone),
    st.builds(Radius, radius, radius, radius, radius, radius, radius, names),
)
moments = st.floats(0, 5)
loads = st.builds(
    Load,
    st.floats(0.01, 200),
    positions,
    st.tuples(moments, moments, moments),
    unit_quaternions(),
    names,
)
tool_loads = loads.map(lambda load: replace(load, name=None))
tool_names = st.sampled_from(["tGun", "tool0", "gripper 2", "pers"])
held_frames = st.one_of(
    st.tuples(st.just(Tool()), st.just(WorkObject())),
    st.tuples(
        st.builds(Tool, tool_names, poses, st.one_of(st.none(), tool_loads)),
        st.builds(
            WorkObject,
            st.sampled_from(["wobj0", "wTable"]),
            poses,
            poses,
        ),
    ),
    st.tuples(
        st.builds(Tool, tool_names, poses),
        st.builds(WorkObject, st.just("wTurned"), frame=poses, moved_by=st.just("STN1")),
    ),
    st.tuples(
        st.builds(Tool, tool_names, poses, robot_held=st.just(False)),
        st.builds(WorkObject, st.just("wHeld"), poses, poses, st.just(True)),
    ),
)


@st.composite
def moves(draw: st.DrawFn, before: Move | None) -> Move:
    tool, work_object = draw(held_frames)
    rest = (draw(speeds), draw(zones), tool, work_object, draw(st.one_of(st.none(), loads)))
    kind = draw(st.sampled_from(["absolute", "joint", "line", "arc"]))
    if kind == "absolute":
        return MoveJ(draw(joint_targets), *rest)
    target = draw(pose_targets)
    if kind == "joint":
        return MoveJ(target, *rest)
    if kind == "line" or before is None or not isinstance(before.target, PoseTarget):
        return MoveL(target, *rest)
    sweep, radius_ = draw(st.floats(0.1, 4.1)), draw(st.floats(0.01, 1))
    start = before.target.pose
    turned = [
        start.matrix()[:3, :3] @ (radius_ * np.array([math.sin(a), 1 - math.cos(a), 0]))
        for a in (sweep / 2, sweep)
    ]
    via, end = (tuple(map(float, np.add(start.position, step))) for step in turned)
    return MoveC(
        replace(target, pose=replace(target.pose, position=end)),
        *rest[:2],
        before.tool,
        before.work_object,
        rest[4],
        via=replace(draw(pose_targets), pose=Pose(via, draw(unit_quaternions()))),  # type: ignore[arg-type]
        orientation=draw(st.sampled_from(ArcOrientation)),
    )


@st.composite
def programs(draw: st.DrawFn) -> Program:
    statements: list[Move | Wait | Opaque] = []
    before: Move | None = None
    for _ in range(draw(st.integers(1, 5))):
        kind = draw(st.sampled_from(["move", "move", "move", "wait", "opaque"]))
        if kind == "wait":
            statements.append(Wait(draw(st.floats(0, 100))))
        elif kind == "opaque":
            statements.append(Opaque(draw(st.sampled_from(["SetDO do1,1;", 'TPWrite "a";']))))
        else:
            before = draw(moves(before))
            statements.append(before)
    return program(*statements, name=draw(st.sampled_from(["Job", "main", "a-b", "module"])))


AXES = ("linear", "rotating")


@given(programs())
def test_reading_gives_the_program_and_writing_it_the_same_text(written: Program) -> None:
    options = RapidOptions(external_axes=AXES)
    text = write(written, options)
    back = read(text, "x.mod", external_axes=AXES)
    assert write(back, options) == text
    assert len(back.statements) == len(written.statements)
    for one, other in zip(written.statements, back.statements, strict=True):
        assert_alike(one, other)


@given(programs())
def test_predefined_zones_are_a_fixed_point(written: Program) -> None:
    options = RapidOptions(zones=ZoneStyle.PREDEFINED, external_axes=AXES)
    text = write(written, options)
    assert not data(text, "zonedata")
    assert write(read(text, "x.mod", external_axes=AXES), options) == text


@given(programs(), st.data())
def test_errors_are_flybys_own(written: Program, draw: st.DataObject) -> None:
    """A zone, speed or configuration that RAPID lacks never comes out as anything else."""
    hurt = [
        replace(move, zone=draw.draw(st.sampled_from([Angle(0.1), move.zone])))
        for move in written.moves
    ]
    try:
        write(written.with_moves(tuple(hurt)), RapidOptions(external_axes=AXES))
    except FlybyError as error:
        assert str(error).startswith("move ")


def near(a: object, b: object) -> bool:
    """Equal but for one rounding to single precision."""
    return bool(np.allclose(np.array(a), np.array(b), rtol=1.3e-7, atol=4e-10))


def same_pose(a: Pose, b: Pose) -> bool:
    return near(a.position, b.position) and bool(
        np.allclose(a.quaternion, b.quaternion, rtol=0, atol=4e-7)
    )


def assert_alike(one: Move | Wait | Opaque, other: Move | Wait | Opaque) -> None:
    assert type(one) is type(other)
    if isinstance(one, Wait) and isinstance(other, Wait):
        assert near(one.duration, other.duration)
    if isinstance(one, Opaque) and isinstance(other, Opaque):
        assert one.text == other.text
    if isinstance(one, Wait | Opaque) or isinstance(other, Wait | Opaque):
        return
    assert_same_target(one.target, other.target)
    assert_same_speed(one.speed, other.speed)
    assert_same_zone(one.zone, other.zone)
    assert same_pose(one.tool.tcp, other.tool.tcp)
    assert one.tool.robot_held == other.tool.robot_held
    assert same_pose(one.work_object.user, other.work_object.user)
    assert same_pose(one.work_object.frame, other.work_object.frame)
    assert one.work_object.robot_held == other.work_object.robot_held
    assert one.work_object.moved_by == other.work_object.moved_by
    assert_same_load(one.load, other.load)
    assert_same_load(one.tool.load, other.tool.load)
    if isinstance(one, MoveC) and isinstance(other, MoveC):
        assert same_pose(one.via.pose, other.via.pose)
        assert one.orientation is other.orientation


def assert_same_target(one: object, other: object) -> None:
    if isinstance(one, JointTarget) and isinstance(other, JointTarget):
        assert near(one.joints, other.joints) and near(one.external, other.external)
        return
    assert isinstance(one, PoseTarget) and isinstance(other, PoseTarget)
    assert same_pose(one.pose, other.pose) and near(one.external, other.external)
    assert one.configuration == other.configuration


def assert_same_speed(one: Speed, other: Speed) -> None:
    for field in ("tcp", "reorientation", "external_linear", "external_angular"):
        if getattr(one, field) is not None:
            assert near(getattr(one, field), getattr(other, field)), field
    for field in ("tcp_acceleration", "duration"):
        a, b = getattr(one, field), getattr(other, field)
        assert a is b is None or near(a, b)
    assert near(one.joint_acceleration_fraction, other.joint_acceleration_fraction)
    assert near(one.jerk_fraction, other.jerk_fraction)


def assert_same_zone(one: Zone, other: Zone) -> None:
    if not isinstance(one, Radius) or not isinstance(other, Radius):
        assert one == other
        return
    wide = (max(one.tcp, one.reorientation), max(one.tcp, one.external))
    assert near((one.tcp, *wide), (other.tcp, other.reorientation, other.external))
    for field in ("angle", "external_linear", "external_angular"):
        assert near(getattr(one, field), getattr(other, field))


def assert_same_load(one: Load | None, other: Load | None) -> None:
    if one is None or other is None:
        assert one is other
        return
    assert near((one.mass, *one.centre, *one.inertia), (other.mass, *other.centre, *other.inertia))
    assert np.allclose(one.axes, other.axes, rtol=0, atol=4e-7)
