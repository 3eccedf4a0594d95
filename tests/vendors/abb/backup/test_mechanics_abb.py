"""System parameters, and what of them comes back in robots."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.backup.contents import BackupNotes
from flyby.core.registry import find_robot
from flyby.core.robot.model import Robot
from flyby.vendors.abb.backup.arms import find_arm
from flyby.vendors.abb.backup.backinfo import parse_backinfo
from flyby.vendors.abb.backup.cfg import parse_parameters
from flyby.vendors.abb.backup.mechanics import Mechanics, mechanics_of
from flyby.vendors.abb.backup.planner import motion_figures

from .station import arm_records, cfg, on_track, one_robot, robot_record


def made(
    sections: dict[str, list[str]] | dict[str, object], notes: BackupNotes | None = None
) -> Mechanics:
    moc = parse_parameters(cfg("MOC", sections), "SYSPAR/MOC.cfg")  # type: ignore[arg-type]
    return mechanics_of(moc, (), {}, find_robot, notes or BackupNotes())


def robot_of(sections: dict[str, object]) -> Robot:
    (found,) = made(sections).robots
    assert found.robot is not None
    return found.robot


def words(text: str) -> str:
    return "".join(character for character in text if character not in '"\\\n\r')


NAMES = st.text("abcdefgh_XYZ", min_size=1, max_size=8).map(lambda name: f"a{name}")
VALUES = st.one_of(
    st.floats(-1e6, 1e6).map(repr),
    st.text("abc -./:#\\äöé", max_size=12).map(lambda text: f'"{words(text)}"'),
    st.just(""),
)


@given(
    st.lists(st.dictionaries(NAMES, VALUES, min_size=1, max_size=6), max_size=8),
    st.sampled_from(["\r\n", "\n", "\r"]),
    st.booleans(),
)
def test_records_come_back(records: list[dict[str, str]], end: str, broken: bool) -> None:
    go_on = f"\\{end}   " if broken else " "
    lines = [go_on.join(f"-{k} {v}".rstrip() for k, v in one.items()) for one in records]
    text = end.join(["MOC:CFG_1.0:6:0::", "#", "", "ROBOT:", "", *lines, ""])
    read = parse_parameters(text, "MOC.cfg").section("ROBOT")
    expected = []
    for one in records:
        values: dict[str, str] = {}
        for key, value in one.items():
            before = values.get(key.lower(), "")
            values[key.lower()] = " ".join(filter(None, (before, value.strip('"'))))
        expected.append(values)
    assert [dict(record.values) for record in read] == expected


@given(st.text())
def test_any_text_is_parsed_or_noted(text: str) -> None:
    parameters = parse_parameters(text, "SYSPAR/MOC.cfg")
    assert parameters.records or parameters.notes
    mechanics_of(parameters, (), {}, find_robot, BackupNotes())
    parse_backinfo(text)


def test_wrong_lines_are_said_once() -> None:
    text = 'MOC:CFG_1.0:6:0::\n#\nARM:\n -name "a"\n<<<< HEAD\n=====\n -name "b"\n'
    parameters = parse_parameters(text, "MOC.cfg")
    assert [record.name for record in parameters.section("ARM")] == ["a", "b"]
    (note,) = parameters.notes
    assert str(note).startswith("MOC.cfg:5:1: this is no record")
    assert "and 1 more lines" in note.message


ANGLE = st.integers(-400, 399)


@settings(deadline=None)
@given(
    st.lists(
        st.tuples(ANGLE, st.integers(1, 300)).map(lambda pair: (pair[0], pair[0] + pair[1])),
        min_size=6,
        max_size=6,
    )
)
def test_ranges_come_back(ranges: list[tuple[int, int]]) -> None:
    robot = robot_of(one_robot(ranges=ranges))
    own = find_robot("abb/irb4600-40-255")
    assert np.allclose(np.degrees(robot.limits.lower), [lower for lower, _ in ranges])
    assert np.allclose(np.degrees(robot.limits.upper), [upper for _, upper in ranges])
    assert np.array_equal(robot.limits.velocity, own.limits.velocity)


@settings(deadline=None)
@given(
    st.lists(st.floats(-20, 20), min_size=3, max_size=3),
    st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1),
)
def test_bases_come_back(position: list[float], turn: list[float]) -> None:
    unit = np.array(turn) / np.linalg.norm(turn)
    parts = [
        f"-base_frame_pos_{axis} {value!r}" for axis, value in zip("xyz", position, strict=True)
    ]
    parts += [f"-base_frame_orient_u{k} {float(value)!r}" for k, value in enumerate(unit)]
    base = robot_of(one_robot(" ".join(parts))).base
    assert np.allclose(base.position, position)
    assert abs(np.dot(base.quaternion, unit)) == pytest.approx(1.0, abs=1e-5)


@pytest.mark.parametrize(
    ("written", "quaternion"),
    [
        ("", (1, 0, 0, 0)),
        ("-base_frame_orient_u2 1", (0, 0, 1, 0)),
        (
            "-base_frame_orient_u0 0.707107 -base_frame_orient_u3 -0.707107",
            (0.5**0.5, 0, 0, -(0.5**0.5)),
        ),
        ("-base_frame_orient_u3 0.707107", (0.5**0.5, 0, 0, 0.5**0.5)),
    ],
)
def test_defaults_of_quaternions_are_left_out(written: str, quaternion: tuple[float, ...]) -> None:
    assert robot_of(one_robot(written)).base.quaternion == pytest.approx(quaternion, abs=1e-6)


@given(st.floats(-math.pi, math.pi), st.floats(-math.pi, math.pi))
def test_gravity_agrees_with_the_base_of_a_tilted_robot(beta: float, around: float) -> None:
    turn = np.array([math.cos(around / 2), 0, 0, math.sin(around / 2)])
    tilt = np.array([math.cos(beta / 2), 0, math.sin(beta / 2), 0])
    w, x, y, z = (
        turn[0] * tilt[0],
        -turn[3] * tilt[2],
        turn[0] * tilt[2],
        turn[3] * tilt[0],
    )
    parts = [f"-base_frame_orient_u{k} {float(v)!r}" for k, v in enumerate((w, x, y, z))]
    notes = BackupNotes()
    (found,) = made(one_robot(f"{' '.join(parts)} -gravity_beta {beta!r}"), notes).robots
    assert found.robot is not None
    assert found.robot.gravity == (0.0, 0.0, -9.80665)
    assert not notes.all()


def test_a_track_with_a_base_of_its_own() -> None:
    notes = BackupNotes()
    turned = "-base_frame_orient_u0 0 -base_frame_orient_u3 1"
    (found,) = made(on_track(base=turned, single="-base_frame_pos_z 0.5"), notes).robots
    assert found.robot is not None
    there = found.robot.base_chain.end_translation
    assert np.allclose(found.robot.external_axes[0].joint.placement.position, (0, 0, 0.5))
    assert np.allclose(there, 0)
    (note,) = notes.all()
    assert "ROB_1 stands on TRACK_1, and both have a base frame" in note.message


def test_axes_of_which_nothing_is_stated() -> None:
    sections = {key: value for key, value in on_track().items() if key not in ("ACC_DATA",)}
    sections["STRESS_DUTY_CYCLE"] = []
    (found,) = made(sections).robots
    assert found.robot is not None and len(found.robot.external_axes) == 2
    lacks = " / ".join(found.lacks)
    assert "does not state of unit TRACK_1: speed 1 m/s, acceleration 2 m/s² assumed" in lacks
    assert "does not state of unit STN1: speed 90 °/s, acceleration 180 °/s² assumed" in lacks
    assert "assumed" in found.robot.origins["external axes"]


def test_axes_whose_place_in_targets_is_not_known() -> None:
    sections = dict(on_track())
    sections["JOINT"] = [one.replace("-logical_axis 7", "") for one in sections["JOINT"]]
    (found,) = made(sections).robots
    assert found.robot is not None
    (station,) = found.robot.external_axes
    assert (station.name, station.number) == ("STN1", 2)
    assert "the axis of unit TRACK_1 is not known" in " / ".join(found.lacks)


def test_two_units_at_one_place_of_targets() -> None:
    sections = dict(on_track())
    sections["JOINT"] = [one.replace("axis 8", "axis 7") for one in sections["JOINT"]]
    (found,) = made(sections).robots
    assert found.robot is not None and len(found.robot.external_axes) == 1
    assert "is eax_a of robtargets, and so is another one: it is left out" in found.lacks[-1]


def test_coupled_and_calibrated_arms_and_their_loads() -> None:
    sections = dict(one_robot('-use_robot_calib "r1_calib"'))
    sections["ARM"] = [f"{one} -upper_joint_coupl_bound 1.2" for one in sections["ARM"][:1]] + list(
        sections["ARM"][1:]
    )
    sections["ARM_LOAD"] = ['-name "r1_load_1"', '-name "r1_load_3" -mass 20']
    (found,) = made(sections).robots
    assert found.robot is not None
    coupled, calibrated = found.robot.doubts[-2:]
    assert coupled.startswith("J1: the range") and calibrated.startswith("calibrated")
    assert "r1_load_3 20 kg" in found.lacks[-1]


def test_of_an_arm_with_rods_the_angle_between_the_arms_is_bounded() -> None:
    """J3 counts from the horizontal: its neighbour's bounds are those of J3 - J2."""
    ranges = ((-180, 180), (-42, 85), (-20, 120), (-300, 300), (-120, 120), (-360, 360))
    sections = dict(one_robot(ranges=ranges, kind="6660_1.90_205"))
    third = sections["ARM"][2]
    bounds = "-upper_joint_coupl_bound 1.22173 -lower_joint_coupl_bound -1.22173"
    sections["ARM"] = [*sections["ARM"][:2], f"{third} {bounds}", *sections["ARM"][3:]]
    (found,) = made(sections).robots
    robot = found.robot
    assert robot is not None and not any("between upper arm" in one for one in robot.doubts)
    (coupled,) = robot.coupled_ranges
    assert coupled.sum == "J3 - J2" and coupled.upper == -coupled.lower == 1.22173
    folded = np.radians([0.0, 80.0, 0.0, 0.0, 30.0, 0.0])
    free = replace(robot, coupled_ranges=())
    pose = robot.flange_pose(folded)
    assert min(np.abs(one.q - folded).max() for one in free.inverse(pose)) < 1e-6
    for one in robot.inverse(pose):
        assert abs(one.q[2] - one.q[1]) <= 1.22173 + 1e-9
    sections["ARM"][2] = f"{third} -upper_joint_coupl_bound wide -lower_joint_coupl_bound -1.2"
    (found,) = made(sections).robots
    assert found.robot is not None and found.robot.coupled_ranges == ()
    assert any(doubt.startswith("J3: the range") for doubt in found.robot.doubts)


def test_joints_by_their_links() -> None:
    sections = dict(one_robot(" ".join(f'-use_joint_{k} "axis{k}"' for k in range(6))))
    sections["JOINT"] = [f'-name "axis{k}" -use_arm "arm{k}"' for k in range(6)]
    sections["ARM"] = [
        f'-name "arm{k}" -lower_joint_bound -{k + 1} -upper_joint_bound 1' for k in range(6)
    ]
    assert np.allclose(robot_of(sections).limits.lower, [-1, -2, -3, -4, -5, -6])


ARMS = {
    ("ROB1_4600_2.55_40", ()): "abb/irb4600-40-255",
    ("ROB2_120_0.58_3", ("IRB 120T-3/0.6",)): "abb/irb120t-3-058",
    ("ROB2_120_0.58_3", ("IRB 120T-3/0.6", "IRB 120-3/0.6")): "abb/irb120-3-058",
    ("ROB1_120T_0.58_3", ("IRB 120T-3/0.6",)): "abb/irb120t-3-058",
    ("ROB1_4600_2.55_40", ("IRB 4600-40/2.55 Type C",)): "abb/irb4600-40-255",
    ("ROB1_1300_1.15_10", ("CRB 1300-10/1.15",)): "abb/crb1300-10-115",
    ("ROB1_1300_1.15_10", ("IRB 1300-10/1.15",)): "abb/irb1300-10-115",
    ("ROB1_15000_0.95_5", ()): "abb/crb15000-5-095",
    ("ROB1_6640_2.55_180_TypeA", ()): "abb/irb6640-180-255",
    ("", ("IRB 6700-235/2.65",)): "abb/irb6700-235-265",
    ("ROB1_6700_LeanID_2.65_220", ("IRB 6700-235/2.65",)): None,
    ("ROB1_9999_2.65_220", ()): None,
    ("IRBP_A250", ()): None,
    ("", ()): None,
}


@pytest.mark.parametrize(("written", "options"), ARMS)
def test_arms_by_what_controllers_write(written: str, options: tuple[str, ...]) -> None:
    found = find_arm(written, options, find_robot)
    wanted = ARMS[written, options]
    assert (None if found.robot is None else found.robot.name) == wanted
    assert bool(found.lack) == (wanted is None)


@pytest.mark.parametrize(
    ("times", "period"),
    [((0.193536, 0.064512), 0.004032), ((0.032, 0.016), 0.004), ((0.0171, 0.05), None), ((), None)],
)
def test_periods(times: tuple[float, ...], period: float | None) -> None:
    planner = " ".join(f"-queue_time_{k} {time}" for k, time in enumerate(times))
    moc = parse_parameters(cfg("MOC", {"MOTION_PLANNER": [f'-name "p" {planner}']}), "MOC.cfg")
    figures = motion_figures(moc, BackupNotes())
    assert (figures["period_s"][0] if figures else None) == period


def test_a_low_cap_of_the_speed_is_said() -> None:
    notes = BackupNotes()
    text = cfg("MOC", {"MOTION_PLANNER": ['-name "p" -linear_max_speed 1.5']})
    assert not motion_figures(parse_parameters(text, "SYSPAR/MOC.cfg"), notes)
    (note,) = notes.all()
    assert "1.5 m/s at most" in note.message


def test_each_robot_has_its_own_records() -> None:
    narrow = [(-10, 10)] * 6
    one, two = arm_records(1), arm_records(2, narrow)
    sections = {key: [*one[key], *two[key]] for key in one}
    sections["ROBOT"] = [robot_record(1), robot_record(2, "120_0.58_3")]
    first, second = made(sections).robots
    assert first.robot is not None and second.robot is not None
    assert math.degrees(first.robot.limits.upper[0]) == pytest.approx(180)
    assert np.allclose(np.degrees(second.robot.limits.upper), 10)


def test_names_and_paths(tmp_path: Path) -> None:
    info = parse_backinfo(
        "# c\n>>SYSTEM_ID:\n My Cell \n>>PRODUCTS_ID:\nRobotWare Version: 6.1\nIRB 120-3/0.6\n"
        ">>TASK12:\n(T_ROB1,,)\nPROGMOD/My Part.v2.mod @ my part\nSYSMOD\\a.sys HIDDEN @\n"
        "SYSMOD/a.SYS @\nrubbish\n>>EOF:\n"
    )
    assert (info.system, info.version, info.arms) == (
        "My Cell",
        "RobotWare 6.1",
        ("IRB 120-3/0.6",),
    )
    (task,) = info.tasks
    assert (task.folder, task.name, task.program) == ("TASK12", "T_ROB1", "")
    assert [module.file for module in task.modules] == ["PROGMOD/My Part.v2.mod", "SYSMOD/a.sys"]


def test_a_gantry_and_a_table_that_tilts() -> None:
    sections = {key: list(value) for key, value in on_track().items()}
    sections["JOINT"] += ['-name "gan_1" -logical_axis 9', '-name "turn" -logical_axis 10']
    bounds = "-lower_joint_bound -2 -upper_joint_bound 2"
    sections["ARM"] += [f'-name "gan_1" {bounds}', f'-name "turn" {bounds}']
    sections["ROBOT"] = [robot_record(1, more='-base_frame_coordinated "GAN"')]
    sections["SINGLE"] += [
        '-name "GAN" -use_single_type "TRK" -use_joint "gan_1" -base_frame_coordinated "track_1" '
        "-base_frame_orient_u0 0.7071068 -base_frame_orient_u3 0.7071068",
        '-name "STN_2" -use_single_type "ROT" -use_joint "turn" -base_frame_coordinated "STN_1"',
    ]
    sections["MECHANICAL_UNIT"] = [
        '-name "TRACK_1" -use_single_0 "TRACK_1"',
        '-name "GAN" -use_single_0 "GAN"',
        '-name "POS" -use_single_0 "STN_1" -use_single_1 "STN_2"',
    ]
    robot = robot_of(sections)
    carried = {axis.name: (axis.role, axis.carried_by) for axis in robot.external_axes}
    assert carried == {
        "TRACK_1": ("track", None),
        "STN_1": ("table", None),
        "GAN": ("track", "TRACK_1"),
        "POS": ("table", "STN_1"),
    }
    here = robot.flange_pose([0.0] * 10).position
    there = robot.flange_pose([0.0] * 6 + [1.0, 0.4, 0.5, 0.4]).position
    assert np.allclose(np.subtract(there, here), (1.0, 0.5, 0.0), atol=1e-6)


@pytest.mark.parametrize("on", ["NOWHERE", "GAN", "TRACK_1"])
def test_units_that_stand_on_nothing_known(on: str) -> None:
    sections = {key: list(value) for key, value in on_track().items()}
    sections["SINGLE"][0] += f' -base_frame_coordinated "{on}"'
    (found,) = made(sections).robots
    assert found.robot is not None and len(found.robot.external_axes) == 2
    assert f"unit TRACK_1 stands on {on}, which is not known" in " / ".join(found.lacks)


def test_an_arm_of_four_motors_lacks_no_ranges() -> None:
    ranges = ((-140, 140), (-150, 150), (0, 0), (-400, 400), (0, 0), (0, 0))
    sections = dict(one_robot(ranges=ranges, kind="910SC_0.55_3"))
    slides = '-name "rob1_3" -upper_joint_bound 0 -lower_joint_bound -0.18'
    sections["ARM"] = [*sections["ARM"][:2], slides, sections["ARM"][3]]
    (found,) = made(sections).robots
    assert found.robot is not None and found.robot.name == "abb/irb910sc-3-055"
    assert not any("states the ranges" in lack for lack in found.lacks)
    assert found.robot.joints[2].lower == -0.18


@pytest.mark.parametrize(
    ("kind", "why"),
    [
        ("360_1.6_6", "IRB 360-6/1600 cannot be driven: it is a delta robot"),
        ("14000_0.5_0.5", "abb/irb14000-05-056-left (0.5 kg"),
        ("6700_3.20_150", "no arm ROB1_6700_3.20_150 is known; near it are"),
    ],
)
def test_an_arm_that_is_not_driven_says_why(kind: str, why: str) -> None:
    (found,) = made(one_robot(kind=kind)).robots
    assert found.robot is None
    assert any(why in lack for lack in found.lacks)


def test_types_of_old_lists_stand_without_their_series() -> None:
    """RobotWare 5 lists the series, and the type alone below it and in a section of its own."""
    info = parse_backinfo(
        ">>PRODUCTS_ID:\nRobotWare Version: 5.15.5001.05\n\n  ABB standard manipulator\n"
        "  IRB 2600\n  2600ID-8/2.00\n  No motor fan\n\n>>ROBOT_TYPE:\n2600ID-8/2.00\n"
    )
    assert info.arms == ("IRB 2600ID-8/2.00",)
    two = parse_backinfo(">>ROBOT_TYPE:\n1600-5/1.2\n4400-60/1.96\n")
    assert two.arms == ("IRB 1600-5/1.2", "IRB 4400-60/1.96")


@pytest.mark.parametrize(
    ("written", "name"),
    [
        ("ROB1_6660_1.93_205", "abb/irb6660-205-190"),  # a product called 205/1.9
        ("ROB1_4600_2.51_20", "abb/irb4600-20-250"),
        ("ROB1_1410_1.44_5", "abb/irb1410-5-145"),
        ("ROB1_6640_2.8_205", "abb/irb6640-205-275"),
        ("ROB1_4600_2.6_60", None),  # no sister that reaches so far carries as much
        ("ROB1_6700_LeanID_2.65_235", None),
    ],
)
def test_a_reach_may_be_rounded_otherwise_than_in_the_products_name(
    written: str, name: str | None
) -> None:
    found = find_arm(written, (), find_robot)
    assert (found.robot and found.robot.name) == name
    if name is None:
        assert f"near it are abb/irb{written.split('_')[1]}-" in found.lack


def test_near_an_unknown_type_are_those_of_its_model() -> None:
    for written in ("ROB1_1600_1.2_X", "ROB1_5500_22"):
        assert (
            f"near it are abb/irb{written.split('_')[1]}-" in find_arm(written, (), find_robot).lack
        )
    assert "near" not in find_arm("ROB1_7710_2.6_430", (), find_robot).lack
