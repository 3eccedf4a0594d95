"""Program → URScript: exact text, names, speeds, refusals."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError, MotionError, UnknownNameError
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.event import Event
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Load, Tool, WorkObject
from flyby.core.program.zone import FINE, Angle, ContourFraction, Radius, VendorZone
from flyby.core.registry import find_vendor
from flyby.core.robot.inertia import carried_inertia
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.source.text.names import Names
from flyby.core.spatial.pose import Pose
from flyby.vendors.kuka.zone_kinds import C_VEL
from flyby.vendors.ur.motion.configuration import UrConfiguration
from flyby.vendors.ur.syntax.names import NAME_RULES, RESERVED
from flyby.vendors.ur.write.formatting import number
from flyby.vendors.ur.write.payload import payload
from flyby.vendors.ur.write.writer import write

UR5E = find_vendor("ur").robot("ur5e")
UR10E = find_vendor("ur").robot("ur10e")

JOINT = Speed(joint=1.05, joint_acceleration=1.4)
LINEAR = Speed(tcp=0.25, tcp_acceleration=1.2)
HOME = (0.0, -1.5, 1.25, -1.3, -1.57, 0.5)
ABOVE = (0.5, -1.5, 1.25, -1.3, -1.57, 0.5)


def at(x: float, y: float, z: float, **more: object) -> PoseTarget:
    """A target in m, turned by half a turn about x."""
    return PoseTarget(Pose((x, y, z), (0.0, 1.0, 0.0, 0.0)), **more)  # type: ignore[arg-type]


def program(*statements: Move | Wait | Opaque, name: str = "job") -> Program:
    return Program(statements, name)


def text(written: Program, **options: str) -> str:
    (only,) = write(written, UR5E, options).values()
    return only


def body(written: Program, **options: str) -> list[str]:
    """The lines between ``def`` and ``end``, without the TCP that all begin with."""
    lines = [line.strip() for line in text(written, **options).splitlines()[2:-1]]
    return [line for line in lines if line != "set_tcp(p[0, 0, 0, 0, 0, 0])"]


GUN = Tool("gun", Pose((0.0, 0.0, 0.15)), Load(1.5, (0.0, 0.01, 0.05), (0.01, 0.01, 0.02)))
TABLE = WorkObject("täble", Pose((0.5, 0.0, 0.0)), Pose((0.0, 0.25, 0.0)))
PI = "3.14159265358979"

GOLDEN = [
    pytest.param(
        program(
            MoveJ(JointTarget(HOME, name="home"), JOINT),
            MoveJ(at(0.5, 0.25, 0.3, configuration=UrConfiguration(ABOVE)), JOINT, Radius(0.05)),
            MoveJ(at(0.5, 0.25, 0.2, name="pick"), JOINT),
            Wait(0.5),
            MoveL(at(0.5, -0.25, 0.2), LINEAR, Radius(0.0125)),
            MoveL(at(0.5, 0.25, 0.2, name="pick"), Speed(duration=2.5)),
        ),
        {},
        f"""# Written by flyby.
def job():
  global home = [0, -1.5, 1.25, -1.3, -1.57, 0.5]
  global pick = p[0.5, 0.25, 0.2, {PI}, 0, 0]
  set_tcp(p[0, 0, 0, 0, 0, 0])
  movej(home, a=1.4, v=1.05)
  movej(get_inverse_kin(p[0.5, 0.25, 0.3, {PI}, 0, 0], \
qnear=[0.5, -1.5, 1.25, -1.3, -1.57, 0.5]), a=1.4, v=1.05, r=0.05)
  movej(pick, a=1.4, v=1.05)
  sleep(0.5)
  movel(p[0.5, -0.25, 0.2, {PI}, 0, 0], a=1.2, v=0.25, r=0.0125)
  movel(pick, t=2.5)
end
""",
        id="moves",
    ),
    pytest.param(
        program(
            MoveL(at(0.1, 0.0, 0.2), LINEAR, FINE, GUN),
            MoveC(
                at(0.3, 0.0, 0.2),
                LINEAR,
                Radius(0.01),
                GUN,
                via=at(0.2, 0.1, 0.2),
                orientation=ArcOrientation.FIXED_FRAME,
            ),
            Opaque("set_digital_out(0, True)"),
            MoveC(
                PoseTarget(Pose((0.1, 0.0, 0.2), (0.0, 0.0, 1.0, 0.0)), name="end"),
                LINEAR,
                FINE,
                GUN,
                load=Load(0.5, (0.0, 0.0, 0.1)),
                via=at(0.2, -0.1, 0.2),
            ),
            MoveL(at(-0.25, 0.5, 0.25), LINEAR, FINE, replace(GUN, load=None), TABLE),
            MoveL(at(0.1, 0.0, 0.2), LINEAR, FINE, GUN),
            name="while",
        ),
        {},
        f"""# Written by flyby.
def while_2():
  global end_2 = p[0.1, 0, 0.2, 0, {PI}, 0]
  set_tcp(p[0, 0, 0.15, 0, 0, 0])
  set_target_payload(1.5, [0, 0.01, 0.05], [0.01, 0.01, 0.02, 0, 0, 0])
  movel(p[0.1, 0, 0.2, {PI}, 0, 0], a=1.2, v=0.25)
  movec(p[0.2, 0.1, 0.2, {PI}, 0, 0], p[0.3, 0, 0.2, {PI}, 0, 0], a=1.2, v=0.25, r=0.01)
  set_digital_out(0, True)
  set_target_payload(2, [0, 0.0075, 0.1], [0.0250375, 0.025, 0.0200375, 0, 0, 0.00075])
  movec(p[0.2, -0.1, 0.2, {PI}, 0, 0], end_2, a=1.2, v=0.25, mode=1)
  # targets of work object t\\xe4ble, in the robot's base
  set_target_payload(0, [0, 0, 0])
  movel(p[0.25, 0.75, 0.25, {PI}, 0, 0], a=1.2, v=0.25)
  # targets of the robot's base
  set_target_payload(1.5, [0, 0.01, 0.05], [0.01, 0.01, 0.02, 0, 0, 0])
  movel(p[0.1, 0, 0.2, {PI}, 0, 0], a=1.2, v=0.25)
end
""",
        id="settings",
    ),
    pytest.param(
        program(
            Opaque('PulseDO doGün;\nTPWrite "x";'),
            MoveL(at(0.5, 0.0, 0.2), LINEAR, events=(Event("SetDO doGlue,1;"),)),
        ),
        {"opaque": "comment"},
        f"""# Written by flyby.
def job():
  # PulseDO doG\\xfcn;
  # TPWrite "x";
  # on the way: SetDO doGlue,1;
  set_tcp(p[0, 0, 0, 0, 0, 0])
  movel(p[0.5, 0, 0.2, {PI}, 0, 0], a=1.2, v=0.25)
end
""",
        id="comments",
    ),
]


@pytest.mark.parametrize(("written", "options", "expected"), GOLDEN)
def test_exact_text(written: Program, options: dict[str, str], expected: str) -> None:
    assert text(written, **options) == expected


def test_the_file_is_called_as_its_function() -> None:
    (file,) = write(program(MoveL(at(0.5, 0, 0), LINEAR), name="Job-1"), UR5E, {})
    assert file == "Job_1.script"


def test_targets_are_in_the_base_of_a_robot_that_stands_elsewhere() -> None:
    moved = UR5E.with_base(Pose((0.25, 0.0, 0.5)))
    (only,) = write(program(MoveL(at(0.5, 0.0, 0.75), LINEAR)), moved, {}).values()
    assert f"movel(p[0.25, 0, 0.25, {PI}, 0, 0], " in only


# Names


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["pA", "pA"], ["pA", "pA_2"]),
        (["pA", "PA"], ["pA", "PA"]),
        (["for", "end", "movej", "p", "True"], ["for", "end_2", "movej_2", "p_2", "True_2"]),
        (["Größe", "ü", "3D"], ["Gr_e", "target", "target_3D"]),
        (["job", "_job"], ["job_2", "_job"]),
    ],
)
def test_names_are_kept_where_legal_and_unique(names: list[str], expected: list[str]) -> None:
    moves = [MoveL(at(k, 0, 0, name=name), LINEAR) for k, name in enumerate(names)]
    assert re.findall(r"global (\w+) =", text(program(*moves))) == expected


@given(st.lists(st.text(max_size=40), max_size=8))
def test_every_name_given_out_is_legal_and_unique(wanted: list[str]) -> None:
    names = Names(NAME_RULES, ["main"])
    given_out = [names.claim(name, "point") for name in wanted]
    assert len(set(given_out)) == len(given_out)
    for name in given_out:
        assert re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name, re.ASCII)
        assert name not in RESERVED | {"main"}


@given(st.text(), st.text())
def test_comments_hide_any_text(name: str, opaque: str) -> None:
    frame = WorkObject(name, Pose((0.1, 0.0, 0.0)))
    move = MoveL(at(0.5, 0, 0), LINEAR, work_object=frame, events=(Event(opaque),))
    lines = text(program(Opaque(opaque), move), opaque="comment").splitlines()
    assert next(line for line in lines if not line.lstrip().startswith("#")) == "def job():"
    assert len([line for line in lines if not line.lstrip().startswith("#")]) == 4
    assert all(line.isascii() for line in lines)


# Numbers


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_are_doubles_without_exponent(value: float) -> None:
    written = number(value)
    assert float(written) == (value if abs(value) >= 1e-12 else 0)
    assert re.fullmatch(r"-?\d+(\.\d+)?", written)
    assert "." in written or abs(value) < 2**31


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_is_refused(value: float) -> None:
    with pytest.raises(InputError, match="no number"):
        number(value)


# Speeds of the leading joint


def joint_arguments(*moves: MoveJ, start: JointTarget | None = None) -> list[tuple[float, float]]:
    """a and v of each movej of a UR10e, whose first two joints are slower than the others."""
    (only,) = write(Program(moves, start=start), UR10E, {}).values()
    return [(float(a), float(v)) for a, v in re.findall(r"movej\(.*, a=([\d.]+), v=([\d.]+)", only)]


def to(*degrees: float) -> JointTarget:
    return JointTarget(tuple(np.radians(degrees)))


ZERO = to(0, -90, 90, 0, 90, 0)


def test_what_differs_next_to_nothing_is_set_once() -> None:
    nearly = replace(GUN, tcp=Pose((1e-13, -2.2e-308, 0.15)))
    loaded = replace(nearly, load=Load(1.5, (1e-13, 0.01, 0.05), (0.01, 0.01, 0.02)))
    tools = (GUN, nearly, loaded)
    lines = body(program(*(MoveL(at(0.4, 0, 0.3), LINEAR, tool=tool) for tool in tools)))
    assert sum(line.startswith("set_tcp(p[0, 0, 0.15,") for line in lines) == 1
    assert sum(line.startswith("set_target_payload(1.5,") for line in lines) == 1


def test_a_share_of_the_joints_own_speed_is_that_of_the_leading_joint() -> None:
    limits = UR10E.limits
    elbow = limits.acceleration[2], limits.velocity[2]
    base = limits.acceleration[0], limits.velocity[0]
    found = joint_arguments(
        MoveJ(to(30, -90, 30, 0, 90, 0), Speed()),  # the elbow leads and takes longest
        MoveJ(to(80, -90, 30 + 60, 0, 90, 0), Speed(joint_fraction=0.5)),  # 50° of base, 60° elbow
        MoveJ(to(80, -90, 30 + 60, 0, 90, 0), Speed()),  # nothing moves
        MoveJ(to(80, -90, 30 + 60, 0, 90, 20), Speed(joint=0.5, joint_acceleration=2.0)),
        MoveJ(to(80, -90, 30 + 60, 0, 90, 0), replace(JOINT, joint_fraction=0.1)),
        start=ZERO,
    )
    base_bound = 60 / 50 * base[0], 0.5 * 60 / 50 * base[1]
    assert found[0] == pytest.approx(elbow)
    assert found[1] == pytest.approx(base_bound) and base_bound[1] < 0.5 * elbow[1]
    assert found[2] == pytest.approx((limits.acceleration.min(), limits.velocity.min()))
    assert found[3] == (2.0, 0.5)
    assert found[4] == pytest.approx((1.4, 0.1 * limits.velocity[5]))


def test_the_leading_joint_of_a_pose_is_found_by_inverse_kinematics() -> None:
    q = np.radians([0, -90, 90, -90, -90, 0])
    there = q + np.radians([40, 10, 0, 0, 0, 0])
    pose = UR10E.flange_pose(there)
    ((acceleration, speed),) = joint_arguments(
        MoveJ(PoseTarget(pose), Speed(joint_acceleration_fraction=0.5)),
        start=JointTarget(tuple(q)),
    )
    assert speed == pytest.approx(UR10E.limits.velocity[0])
    assert acceleration == pytest.approx(0.5 * UR10E.limits.acceleration[0])


# Payloads


@given(
    st.floats(0.1, 10), st.tuples(*[st.floats(-0.2, 0.2)] * 3), st.tuples(*[st.floats(0, 1)] * 3)
)
def test_a_single_body_keeps_its_numbers(
    mass: float, centre: tuple[float, float, float], inertia: tuple[float, float, float]
) -> None:
    tool = Tool("t", Pose((0.1, 0.2, 0.3)), Load(mass, centre, inertia))
    assert payload(tool, None) == (mass, centre, (*inertia, 0.0, 0.0, 0.0))


def test_tool_and_load_are_one_body() -> None:
    turned = (math.cos(0.4), 0.0, math.sin(0.4), 0.0)
    load = Load(0.5, (0.0, 0.02, 0.1), (0.01, 0.02, 0.025), turned)
    mass, centre, tensor = payload(GUN, load)
    body = carried_inertia(GUN, load)
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.tensor
    assert mass == 2.0
    assert centre == body.centre
    assert tensor == pytest.approx((xx, yy, zz, xy, xz, yz), abs=1e-12)


# What URScript cannot say

FOREIGN = type("Foreign", (), {"exact": True, "mismatch": lambda self, label: 0.0})()
POSE = at(0.5, 0, 0.2)
VIA = at(0.45, 0.1, 0.2)

REFUSED = [
    (MoveL(POSE, LINEAR, Angle(0.1)), "no zone by Angle"),
    (MoveL(POSE, LINEAR, ContourFraction(0.5)), "no zone by ContourFraction"),
    (MoveL(POSE, LINEAR, VendorZone(C_VEL, 0.5)), "no zone by C_VEL"),
    (MoveL(POSE, LINEAR, Radius(0.0)), "a blend radius of 0 is a stop point"),
    (MoveL(POSE, LINEAR, Radius(0.01, 0.02)), "Radius.reorientation is 0.02 m"),
    (MoveL(POSE, LINEAR, Radius(0.01, 0.01, 0.02)), "Radius.external is 0.02 m"),
    (MoveL(POSE, LINEAR, Radius(0.01, angle=0.1)), "no Radius.angle"),
    (MoveL(POSE, Speed(tcp=0.25)), "needs Speed.tcp_acceleration"),
    (MoveL(POSE, Speed(tcp_acceleration=1.2)), "needs Speed.tcp:"),
    (MoveL(POSE, replace(LINEAR, reorientation=1.0)), "a speed of reorientation"),
    (MoveL(POSE, replace(LINEAR, reorientation_acceleration=1.0)), "acceleration of reorient"),
    (MoveL(POSE, replace(LINEAR, jerk_fraction=0.5)), "share of the jerk"),
    (MoveL(POSE, replace(LINEAR, joint_fraction=0.5)), "a share of the joints' speed"),
    (MoveL(POSE, replace(LINEAR, joint_acceleration_fraction=0.5)), "joints' acceleration"),
    (MoveC(POSE, LINEAR, via=at(0.3, 0.2, 0.4)), "which movec cannot say in mode 1"),
    (MoveJ(POSE, replace(JOINT, tcp=0.25)), "no limit on the speed of the TCP"),
    (MoveC(POSE, Speed(duration=2.0), via=VIA), "movec takes no time"),
    (MoveC(JointTarget(HOME), LINEAR, via=VIA), "ends at a pose"),
    (MoveJ(JointTarget((0.0,) * 7), JOINT), "6 joint values, but the target has 7"),
    (MoveJ(JointTarget(HOME, (1.0,)), JOINT), "no external axes"),
    (MoveJ(at(0, 0, 0, external=(1.0,)), JOINT), "no external axes"),
    (MoveJ(at(0.5, 0, 0, configuration=FOREIGN), JOINT), "is no qnear"),
    (MoveJ(at(0.5, 0, 0, configuration=UrConfiguration((0.0,) * 5)), JOINT), "qnear has 6"),
    (MoveL(POSE, LINEAR, tool=Tool("fixed", robot_held=False)), "tool fixed stands still"),
    (MoveL(POSE, LINEAR, work_object=WorkObject("held", robot_held=True)), "held moves"),
    (MoveL(POSE, LINEAR, work_object=WorkObject("table", moved_by="STN1")), "table moves"),
    (MoveL(POSE, LINEAR, events=(Event("SetDO doGlue,1"),)), "no actions along a move"),
]


@pytest.mark.parametrize(("move", "message"), REFUSED, ids=[m for _, m in REFUSED])
def test_what_urscript_cannot_say_is_refused_by_move(move: Move, message: str) -> None:
    with pytest.raises(MotionError, match=re.escape(message)) as caught:
        text(program(MoveJ(JointTarget(HOME), JOINT), Wait(1), move))
    assert str(caught.value).startswith("move 2: ")
    assert caught.value.move == 1


def test_an_unknown_start_is_named() -> None:
    with pytest.raises(MotionError, match=r"move 1: .*where the robot starts"):
        text(program(MoveJ(JointTarget(HOME), Speed())))


def test_an_arc_whose_start_is_not_known_is_refused_in_mode_1() -> None:
    with pytest.raises(MotionError, match=r"move 1: .*where the arc begins"):
        text(program(MoveC(POSE, LINEAR, via=VIA)))
    fixed = MoveC(POSE, LINEAR, via=VIA, orientation=ArcOrientation.FIXED_FRAME)
    assert "movec" in text(program(fixed))


def test_shares_may_be_written_as_such() -> None:
    speed = Speed(joint_fraction=0.4, joint_acceleration_fraction=0.3)
    moves = [MoveJ(JointTarget(HOME), speed), MoveL(POSE, speed, Radius(0.01))]
    found = re.findall(r"optimove.*", text(program(*moves), shares="optimove"))
    assert [line[:10] for line in found] == ["optimovej(", "optimovel("]
    assert [line.partition("], ")[2] for line in found] == [
        "a=0.3, v=0.4)",
        "a=0.3, v=0.4, r=0.01)",
    ]
    with pytest.raises(MotionError, match=r"move 2: .*shares=optimove"):
        text(replace(program(*moves), start=JointTarget(ABOVE)))


def test_other_arms_are_refused() -> None:
    rail = Joint("rail", Pose(), (1.0, 0.0, 0.0), -1, 1, 1, 1, kind=JointKind.PRISMATIC)
    track = ExternalAxis(rail, ExternalRole.TRACK)
    with pytest.raises(InputError, match="1 external axes"):
        write(program(), UR5E.with_external_axes([track]), {})


@pytest.mark.parametrize("options", [{"zones": "own"}, {"shared": "own"}])
def test_unknown_options_are_refused(options: dict[str, str]) -> None:
    with pytest.raises(UnknownNameError, match="option of the URScript writer"):
        text(program(), **options)


@pytest.mark.parametrize("options", [{"shares": "own"}, {"opaque": "drop"}])
def test_unknown_choices_are_refused(options: dict[str, str]) -> None:
    with pytest.raises(InputError, match="one of"):
        text(program(), **options)
