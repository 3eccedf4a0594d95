"""Robots from catalogue files (TOML).

Units stand at the end of each key: ``_mm`` or ``_m``, ``_deg`` or ``_rad``, ``_deg_s``, ``_rad_s2``
and so on, ``_kg``, ``_kgm2``, ``_nm`` (torque N m, force N); linear joints use lengths instead of
angles.

    name = "abb/irb6640-180-255"
    payload_kg = 180                     # optional
    base_height_mm = 0                   # optional: of the base's frame, from which places count,
                                         # above the plane that the arm is mounted on

    [origin]                             # what each group of numbers rests on
    geometry = "published: …"
    range = "published: …"
    velocity = "published: …"
    acceleration = "identified: …"
    effort = "unknown"                   # needed if a joint gives effort_nm
    inertia = "unknown"                  # needed if there are links
    shape = "assumed: …"                 # needed if there are shapes

An origin starts with one of published, identified, measured, computed, assumed, unknown.

    [[joint]]                            # from base to flange
    name = "J2"
    kind = "revolute"                    # or "prismatic"; revolute if left out
    xyz_mm = [320, 0, 780]               # the joint's frame in the frame of the joint before, at
    rpy_deg = [0, 0, 0]                  # zero; see below for other forms; zero if left out
    axis = [0, 1, 0]                     # in the joint's own frame, right-hand rule
    lower_deg = -65
    upper_deg = 85
    velocity_deg_s = 90
    acceleration_rad_s2 = 4.98           # or none, and at the top of the file:
    effort_nm = 1000                     # optional

    held = true                          # optional, in the place of limits: there is no motor, the
                                         # joint stands at zero (joints 4 and 5 of a palletiser)

    [[joint.follower]]                   # optional: a turn right behind that joint, by the value of
    driver = "J2"                        # another one; rods or gears make it
    axis = [0, -1, 0]                    # the opposite axis turns it against its driver
    xyz_mm = [0, 0, 0]                   # in the frame behind the joint, or the follower before

    [assumed]
    acceleration_time_s = 0.25           # joints without acceleration: top speed in this time

    [spread]                             # optional: by what factor what is assumed may be off,
    acceleration = 1.9                   # either way; also velocity

    doubts = ["…"]                       # optional: what speaks against single figures
    order = ["A1", "A2", "A3", "A5", "A4", "A6"]   # optional: the joints from base to flange, where
                                         # the controller counts them otherwise

    arm_angle_reference = [0, 1, 0]      # optional, of seven axes: what arm angles of targets count
                                         # from, in the base's frame
    [flange]                             # in the frame behind the last joint
    xyz_mm = [200, 0, 0]
    rpy_deg = [0, 90, 0]

An orientation is ``quat_wxyz``, ``rpy_deg``, ``abc_deg`` or ``rotvec_rad`` (`pose_table`);
only one of them, none for no turn.

Instead of placements and axes, the geometry may be given in standard Denavit–Hartenberg form, one
row a joint and the last one to the flange: T = Rz(q + theta) Tz(d) Tx(a) Rx(alpha).

    dh = [{ d_mm = 162.5, a_mm = 0, alpha_deg = 90 }, …]

    [[coupled_range]]                    # optional: a range of several joints' values together
    joints = ["J3", "J2"]
    factors = [1, -1]                    # of these values in their sum
    lower_deg = -80
    upper_deg = 70
    reason = "the rod meets the upper arm"

    [[link]]                             # none, or one behind each joint, in their order
    mass_kg = 3.761
    centre_mm = [0, -25.61, 1.93]        # in the frame behind the joint, parallel to the joint's
    inertia_kgm2 = [ixx, iyy, izz, ixy, ixz, iyz]   # about the centre of mass

With ``dh``, bodies and shapes of link k are in Denavit–Hartenberg frame k, as usually published.

    [[shape]]
    link = 1                             # 0 the base, k behind joint k
    kind = "capsule"                     # sphere, capsule, cylinder (both with ends), box
    radius_mm = 150
    from_mm = [0, 0, 0]                  # capsule and cylinder: ends of the middle line
    to_mm = [0, 0, 1075]
    # sphere: radius_mm, centre_mm; box: size_mm, xyz_mm and an orientation
    # mesh: mesh = "J1.stl", units = "mm", xyz_mm and an orientation: the bodies that enclose it

    [[may_touch]]                        # optional: links that may touch each other
    links = [1, 3]                       # as in [[shape]], the lower one first
    file = "arm.srdf"                    # who says so
    reason = "Never"                     # and why
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..files.tables import ANGLE, LENGTH, TomlTable
from ..spatial.pose import IDENTITY, Pose, Vector3
from ..spatial.rotation import matrix_from_rotation_vector
from .inertia import Inertia
from .joint import CoupledRange, Follower, Joint, JointKind, held_joint
from .model import Robot
from .pose_table import pose_at, read_pose
from .shape import LinkShape, TouchingLinks
from .shape_table import read_shapes

TRUST = ("published", "identified", "measured", "computed", "assumed", "unknown")
"""The words that an origin starts with."""
SPREAD = ("velocity", "acceleration")
"""Groups of figures that may state by what factor they may be off."""
UNITS = {JointKind.REVOLUTE: ANGLE, JointKind.PRISMATIC: LENGTH}


def load_robot(path: str | Path) -> Robot:
    """The robot of a catalogue file.

    Raises:
        InputError: the file cannot be read, or a key is missing, unknown or wrong; the message
            names file and key.
    """
    return robot_of(TomlTable.read(path))


def robot_of(table: TomlTable) -> Robot:
    """The robot of a table with the keys of a catalogue file.

    Raises:
        InputError: a key is missing, unknown or wrong; the message names file and key.
    """
    try:
        robot = _robot(table)
    except InputError as error:
        if str(error).startswith(str(table.file)):
            raise
        raise InputError(f"{table.file}: {error}") from None
    table.finish()
    return robot


def _robot(table: TomlTable) -> Robot:
    rows = table.listed_tables("joint")
    if not rows:
        raise table.error("joint", "is missing; give one [[joint]] for each joint")
    if table.has("dh"):
        frames = _dh_frames(table, len(rows))
        placements, flange = [IDENTITY, *frames[:-1]], frames[-1]
    else:
        frames = [IDENTITY] * len(rows)
        placements, flange = [read_pose(row) for row in rows], pose_at(table, "flange")
    assumed = table.table("assumed")
    seconds = assumed.number("acceleration_time_s") if assumed.data else None
    assumed.finish()
    joints = tuple(
        _joint(row, placement, table.has("dh"), seconds)
        for row, placement in zip(rows, placements, strict=True)
    )
    order = table.texts("order") if table.has("order") else ()
    links = tuple(
        _inertia(row).placed(frame)
        for row, frame in zip(_link_rows(table, len(rows)), frames, strict=False)
    )
    made = [_link_shapes(row, [IDENTITY, *frames]) for row in table.listed_tables("shape")]
    shapes = tuple(shape for of_row, _ in made for shape in of_row)
    odd = tuple(doubt for _, doubts in made for doubt in doubts)
    needed = ["geometry", "range", "velocity", "acceleration"]
    needed += ["arm_angle"] if table.has("arm_angle_reference") else []
    needed += ["effort"] if any(joint.effort for joint in joints) else []
    needed += ["inertia"] if links else []
    needed += ["shape"] if shapes else []
    return Robot(
        name=table.text("name"),
        joints=joints,
        flange=flange,
        links=links,
        shapes=shapes,
        payload=table.number("payload_kg") if table.has("payload_kg") else None,
        origins=_origins(table.table("origin"), needed),
        spread=_spread(table.table("spread")),
        doubts=(*(table.texts("doubts") if table.has("doubts") else ()), *odd),
        may_touch=tuple(_touching(row, len(joints)) for row in table.listed_tables("may_touch")),
        order=order,
        arm_angle_reference=_reference(table),
        base_height=table.quantity("base_height", LENGTH, 0.0),
        coupled_ranges=tuple(map(_coupled, table.listed_tables("coupled_range"))),
    )


def _reference(table: TomlTable) -> Vector3 | None:
    if not table.has("arm_angle_reference"):
        return None
    x, y, z = table.numbers("arm_angle_reference", 3)
    if not (x or y or z):
        raise table.error("arm_angle_reference", "has no direction")
    return (x, y, z)


def _spread(table: TomlTable) -> dict[str, float]:
    found = {}
    for group in SPREAD:
        if table.has(group):
            found[group] = table.number(group)
            if not found[group] >= 1.0:
                raise table.error(group, f"is a factor of one or more, not {found[group]:g}")
    table.finish()
    return found


def _origins(table: TomlTable, needed: list[str]) -> Mapping[str, str]:
    origins = {}
    for group in (*needed, *(key for key in table.data if key not in needed)):
        origin = table.text(group)
        if origin.split(":")[0] not in TRUST:
            raise table.error(group, f"must start with one of {', '.join(TRUST)}, not {origin!r}")
        origins[group] = origin
    return origins


def _joint(row: TomlTable, placement: Pose, dh: bool, acceleration_time: float | None) -> Joint:
    kind = JointKind(row.choice("kind", list(JointKind), JointKind.REVOLUTE))
    units = UNITS[kind]
    x, y, z = (0.0, 0.0, 1.0) if dh else row.numbers("axis", 3)
    followers = tuple(_follower(entry) for entry in row.listed_tables("follower"))
    if row.flag("held", False):
        joint = held_joint(row.text("name"), placement, (x, y, z), followers)
        row.finish()
        return joint
    if dh and kind is JointKind.PRISMATIC:
        raise row.error("kind", "joints of a dh table are revolute; give placements and axes")
    speeds = {f"{unit}_s": factor for unit, factor in units.items()}
    rises = {f"{unit}_s2": factor for unit, factor in units.items()}
    velocity = _rate(row, "velocity", speeds)
    acceleration = _rate(row, "acceleration", rises)
    if velocity is None:
        raise row.error(f"velocity_{next(iter(speeds))}", "is missing")
    if acceleration is None:
        if acceleration_time is None:
            raise row.error(
                f"acceleration_{next(iter(rises))}",
                "is missing; give it, or [assumed] acceleration_time_s for all joints",
            )
        acceleration = velocity / acceleration_time
    joint = Joint(
        name=row.text("name"),
        placement=placement,
        axis=(x, y, z),
        lower=row.quantity("lower", units),
        upper=row.quantity("upper", units),
        velocity=velocity,
        acceleration=acceleration,
        effort=row.number("effort_nm") if row.has("effort_nm") else None,
        kind=kind,
        followers=followers,
    )
    row.finish()
    return joint


def _coupled(row: TomlTable) -> CoupledRange:
    names = row.texts("joints")
    terms = tuple(zip(names, row.numbers("factors", len(names)), strict=True))
    ends = (row.quantity("lower", ANGLE), row.quantity("upper", ANGLE))
    coupled = CoupledRange(terms, *ends, row.text("reason"))
    row.finish()
    return coupled


def _follower(row: TomlTable) -> Follower:
    x, y, z = row.numbers("axis", 3)
    follower = Follower(row.text("driver"), (x, y, z), read_pose(row))
    row.finish()
    return follower


def _rate(row: TomlTable, key: str, units: Mapping[str, float]) -> float | None:
    """A speed or acceleration in SI, by whichever of its unit keys is given."""
    given = [unit for unit in units if row.has(f"{key}_{unit}")]
    if len(given) > 1:
        raise row.error(f"{key}_{given[1]}", f"is given by {key}_{given[0]} already")
    return row.number(f"{key}_{given[0]}") * units[given[0]] if given else None


def _dh_frames(table: TomlTable, count: int) -> list[Pose]:
    """The fixed parts Rz(theta) Tz(d) Tx(a) Rx(alpha) of each row."""
    rows = table.listed_tables("dh")
    if len(rows) != count:
        raise table.error("dh", f"has {len(rows)} rows for {count} joints")
    frames = []
    for row in rows:
        about_z, about_x = np.eye(4), np.eye(4)
        theta, alpha = row.quantity("theta", ANGLE, 0.0), row.quantity("alpha", ANGLE)
        about_z[:3, :3] = matrix_from_rotation_vector(np.array([0.0, 0.0, theta]))
        about_z[2, 3] = row.quantity("d", LENGTH)
        about_x[:3, :3] = matrix_from_rotation_vector(np.array([alpha, 0.0, 0.0]))
        about_x[0, 3] = row.quantity("a", LENGTH)
        row.finish()
        frames.append(Pose.from_matrix(about_z @ about_x))
    return frames


def _link_rows(table: TomlTable, count: int) -> tuple[TomlTable, ...]:
    rows = table.listed_tables("link")
    if rows and len(rows) != count:
        raise table.error("link", f"there are {len(rows)} links for {count} joints")
    return rows


def _inertia(row: TomlTable) -> Inertia:
    xx, yy, zz, xy, xz, yz = row.numbers("inertia_kgm2", 6)
    x, y, z = row.quantities("centre", LENGTH, 3)
    body = Inertia(row.number("mass_kg"), (x, y, z), ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))
    row.finish()
    return body


def _link_shapes(row: TomlTable, frames: list[Pose]) -> tuple[list[LinkShape], list[str]]:
    """Shapes, moved from the frame they are given in to the frame behind their joint; doubts."""
    link = row.number("link")
    if link not in range(len(frames)):
        raise row.error("link", f"must be a whole number from 0 to {len(frames) - 1}")
    frame, made = frames[int(link)], read_shapes(row)
    row.finish()
    shapes = [LinkShape(int(link), shape, frame @ placement) for shape, placement in made.bodies]
    return shapes, made.doubts


def _touching(row: TomlTable, count: int) -> TouchingLinks:
    first, second = row.numbers("links", 2)
    if first not in range(count + 1) or second not in range(count + 1) or not first < second:
        raise row.error("links", f"must be two whole numbers from 0 to {count}, the lower first")
    pair = TouchingLinks(int(first), int(second), row.text("file"), row.text("reason"))
    row.finish()
    return pair
