"""Robots from URDF files, read by yourdfpy.

What URDF cannot say is assumed, and the robot's origins say so: accelerations always; ranges of
continuous joints; velocities and efforts that are missing or zero.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError, UnknownNameError
from ...spatial.pose import IDENTITY, Pose
from ..inertia import Inertia
from ..joint import ExternalAxis, ExternalRole, Joint, JointKind
from ..model import Robot
from .parsing import parsed
from .shapes import UrdfShapes
from .srdf import TouchRules, find_srdf, read_srdf

ACCELERATION_TIMES = (0.65, 0.65, 0.65, 0.21)
"""s in which joints are assumed to reach their top speed, from the base on; the last counts for all
further ones. Geometric means of the 42 six-axis arms of the catalogue whose accelerations are
published or identified."""
ACCELERATION_SPREAD = 2.6
"""Factor by which these miss single joints of those arms (one standard deviation)."""
VELOCITY = math.pi
VELOCITY_SPREAD = 1.8
"""rad/s that is assumed of a joint of which none is stated; factor by which it misses single joints
of the 169 six-axis arms of the catalogue of which speeds are (one standard deviation: 1.75)."""
CONTINUOUS_RANGE = 2 * math.pi
"""rad either way that a continuous joint is assumed to turn."""
BASE = "base"
"""Link in the controller's own frame (ROS-Industrial, REP 199)."""
RAILED = 7
"""Joints of an arm of six that a rail carries."""
FEWEST = 3
"""Joints of an arm, behind which fingers are a gripper's."""
FLANGES = ("tool0", "flange")
"""Links that flanges are called by; the first is the controller's own (REP 199)."""
LONGEST_RANGE = 1e4
"""rad or m."""
KINDS = {
    "revolute": JointKind.REVOLUTE,
    "continuous": JointKind.REVOLUTE,
    "prismatic": JointKind.PRISMATIC,
}


def load_urdf(
    path: str | Path,
    base: str | None = None,
    tip: str | None = None,
    srdf: str | Path | None = None,
) -> Robot:
    """The serial arm between two links of a URDF file.

    Fixed joints on the way are merged into placements, bodies fixed to the arm into its links.
    Meshes are read for the shapes that enclose them (`shapes`); where one is not at hand the
    robot has no shapes, and says why.

    Args:
        path: the file.
        base: name of the base's link; None for ``base``, the controller's own frame by the
            conventions of ROS-Industrial, if it is fixed to the root, else for the root.
        tip: name of the flange's link; None for ``tool0``, the controller's flange by the same
            conventions, else for ``flange``, else for the leaf behind most joints.
        srdf: file of the pairs of links that may touch; None for the one beside the URDF or in
            the package's folders (`find_srdf`), if there is one.

    Raises:
        InputError: the file is no URDF, or the SRDF none; the arm branches or depends on other
            joints; a joint's kind or velocity cannot be used.
        UnknownNameError: there is no link of that name.
    """
    path = Path(path)
    reader = _Reader(path, parsed(path), None if srdf is None else Path(srdf))
    try:
        reader.check()
        if base is not None:
            return reader.robot(base, tip)
        robot = reader.robot(reader.root(), tip)
        return _moved(robot, reader.from_controller())
    except UnknownNameError:
        raise
    except InputError as error:
        told = str(error)
        known = told.startswith(tuple(f"{one}:" for one in (path, reader.srdf)))
        raise InputError(told if known else f"{path}: {told}") from None


@dataclass
class _Reader:
    """One parsed file."""

    path: Path
    model: Any
    srdf: Path | None = None
    left_out: dict[str, None] = field(default_factory=dict)
    """Joints behind the flange."""

    def error(self, message: str) -> InputError:
        return InputError(f"{self.path}: {message}")

    @property
    def links(self) -> dict[str, Any]:
        return {link.name: link for link in self.model.links}

    def check(self) -> None:
        """Refuse joints between links that there are not, or names that stand for two."""
        if len(self.links) != len(self.model.links):
            raise self.error("two links have one name")
        for joint in self.model.joints:
            for name in (joint.parent, joint.child):
                if name not in self.links:
                    raise self.error(f"joint {joint.name!r} names {name!r}, which is no link")

    def root(self) -> str:
        children = {joint.child for joint in self.model.joints}
        roots = [name for name in self.links if name not in children]
        if len(roots) != 1:
            raise self.error(
                f"has {len(roots)} root links ({', '.join(roots)}): add fixed joints from one link "
                "to them, or name the base"
            )
        return roots[0]

    def robot(self, base: str, tip: str | None) -> Robot:
        for name in (base, tip):
            if name is not None and name not in self.links:
                raise UnknownNameError(f"link in {self.path}", name, self.links)
        tip = tip or self.leaf(base)
        way = self.way(base, tip)
        moving = [element for element in way if element.type != "fixed"]
        slides = [element.type == "prismatic" for element in moving]
        if len(moving) == RAILED and slides[0] and not any(slides[1:]):
            return self.on_rail(base, moving[0], tip)
        assumed: dict[str, list[str]] = {
            "range": [],
            "velocity": [],
            "effort": [],
            "inertia": [],
        }
        joints: list[Joint] = []
        bodies: list[Inertia | None] = []
        pending = IDENTITY
        for element in way:
            placement = pending @ _pose(element.origin)
            if element.type == "fixed":
                pending = placement
                continue
            rise = ACCELERATION_TIMES[min(len(joints), len(ACCELERATION_TIMES) - 1)]
            joints.append(self.joint(element, placement, rise, assumed))
            bodies.append(self.body(element.child, way))
            if bodies[-1] is None:
                assumed["inertia"].append(element.child)
            pending = IDENTITY
        if not joints:
            raise self.error("there is no moving joint between base and tip")
        known = [body for body in bodies if body is not None]
        found = self.shapes(base, way)
        rules = self.touch_rules()
        return Robot(
            name=self.model.name or self.path.stem,
            joints=tuple(joints),
            flange=pending,
            links=tuple(known) if len(known) == len(joints) else (),
            shapes=() if found.unread else tuple(found.shapes),
            origins=self.origins(assumed) | ({"shape": found.origin} if found.stated else {}),
            doubts=(*found.unread, *(() if rules is None else rules.doubts), *self.hands(tip)),
            spread=self.spread(assumed),
            may_touch=() if rules is None else rules.touching(self.drawn(base, way)),
        )

    def on_rail(self, base: str, rail: Any, tip: str) -> Robot:
        """An arm of six joints on what carries it along: an external axis of its controller."""
        arm = self.robot(rail.child, tip)
        assumed: dict[str, list[str]] = {"range": [], "velocity": [], "effort": [], "inertia": []}
        placement = IDENTITY
        for element in self.way(base, rail.child):
            placement = placement @ _pose(element.origin)
        track = ExternalAxis(
            self.joint(rail, placement, ACCELERATION_TIMES[0], assumed), ExternalRole.TRACK
        )
        origin = f"published: {self.path.name}; acceleration assumed as of the arm's first joints"
        doubt = f"the bed of its rail {rail.name} has no shape here"
        return replace(
            arm,
            external_axes=(track,),
            origins={**arm.origins, "external axes": origin},
            doubts=(*arm.doubts, doubt) if self.links[base].collisions else arm.doubts,
        )

    def spread(self, assumed: dict[str, list[str]]) -> dict[str, float]:
        """By what factors assumed figures may be off."""
        known = {"acceleration": ACCELERATION_SPREAD}
        return known | ({"velocity": VELOCITY_SPREAD} if assumed["velocity"] else {})

    def hands(self, tip: str) -> tuple[str, ...]:
        """What is said of joints behind the flange."""
        if not self.left_out:
            return ()
        said = f"joints behind the flange, a gripper's, are left out: {', '.join(self.left_out)}"
        return (f"{said}; the flange is link {tip}, and their links have no shape here",)

    def touch_rules(self) -> TouchRules | None:
        """What the SRDF says; None where there is none."""
        if self.srdf is None:
            self.srdf = find_srdf(self.path, self.model.name or "")
        if self.srdf is None:
            return None
        return read_srdf(self.srdf, self.model.name or "", self.links)

    def leaf(self, base: str) -> str:
        """Where the arm ends: what is called as flanges are, else the leaf behind most joints."""
        leaves: dict[str, tuple[str, ...]] = {}
        stack: list[tuple[str, tuple[str, ...]]] = [(base, ())]
        while stack:
            name, moved_by = stack.pop()
            below = [joint for joint in self.model.joints if joint.parent == name]
            if len(moved_by) >= FEWEST and self.holds(below):
                leaves[name] = moved_by
                continue
            for joint in below:
                moves = () if joint.type == "fixed" else (joint.name,)
                stack.append((joint.child, (*moved_by, *moves)))
            if not below or name in FLANGES:
                leaves[name] = moved_by
        for name in FLANGES:
            if name in leaves:
                return name
        most = max(map(len, leaves.values()))
        ends = [name for name, moved_by in leaves.items() if len(moved_by) == most]
        if len(ends) == 1:
            return ends[0]
        raise self.error(
            f"ends in several links ({', '.join(sorted(ends))}): add a link {FLANGES[0]!r}, fixed "
            "where the flange is, or name the tip"
        )

    def holds(self, below: list[Any]) -> bool:
        """Whether joints are those of a gripper: fingers that one another mimic, or that part."""
        moving = [joint for joint in below if joint.type != "fixed"]
        return any(joint.mimic is not None for joint in moving) or (
            len(moving) > 1 and all(joint.type == "prismatic" for joint in moving)
        )

    def from_controller(self) -> Pose:
        """The root's frame in the controller's own one; none other where the file has no such."""
        if BASE not in self.links:
            return IDENTITY
        way = self.way(self.root(), BASE)
        if any(element.type != "fixed" for element in way):
            return IDENTITY
        own = IDENTITY
        for element in way:
            own = own @ _pose(element.origin)
        return own.inverse()

    def way(self, base: str, tip: str) -> list[Any]:
        """The joints from base to tip."""
        above = {joint.child: joint for joint in self.model.joints}
        way: list[Any] = []
        name = tip
        while name != base:
            if name not in above:
                raise self.error(f"link {tip!r} does not hang on {base!r}")
            way.insert(0, above[name])
            name = above[name].parent
        return way

    def joint(
        self, element: Any, placement: Pose, rise: float, assumed: dict[str, list[str]]
    ) -> Joint:
        name = element.name
        if element.mimic is not None:
            raise self.error(
                f"joint {name!r} mimics {element.mimic.joint!r}; "
                "only arms whose joints move independently can be used"
            )
        if element.type not in KINDS:
            raise self.error(
                f"joint {name!r} is {element.type}; known: {', '.join(KINDS)}, fixed: make it one"
            )
        kind, limit = KINDS[element.type], element.limit
        axis = np.array([1.0, 0.0, 0.0] if element.axis is None else element.axis, dtype=float)
        if axis.shape != (3,) or not 1e-9 < np.abs(axis).max() < 1e9:
            raise self.error(f"joint {name!r} has no axis: {axis.tolist()}")
        x, y, z = (float(v) for v in axis / np.linalg.norm(axis))
        lower, upper = -CONTINUOUS_RANGE, CONTINUOUS_RANGE
        if element.type == "continuous":
            assumed["range"].append(name)
        elif limit is None or limit.lower is None or limit.upper is None:
            raise self.error(f"joint {name!r} needs <limit lower= upper= velocity=>")
        else:
            lower, upper = float(limit.lower), float(limit.upper)
            if not max(abs(lower), abs(upper)) <= LONGEST_RANGE:
                raise self.error(
                    f"joint {name!r} ranges from {lower:g} to {upper:g}; at most "
                    f"{LONGEST_RANGE:g} either way is taken"
                )
        velocity = limit.velocity if limit is not None else None
        if not velocity:
            if kind is JointKind.PRISMATIC:
                raise self.error(f"joint {name!r} needs <limit velocity=>")
            velocity = VELOCITY
            assumed["velocity"].append(name)
        effort = limit.effort if limit is not None else None
        if not effort:
            assumed["effort"].append(name)
        return Joint(
            name=name,
            placement=placement,
            axis=(x, y, z),
            lower=lower,
            upper=upper,
            velocity=float(velocity),
            acceleration=float(velocity) / rise,
            effort=float(effort) if effort else None,
            kind=kind,
        )

    def body(self, link: str, way: list[Any]) -> Inertia | None:
        """The link's body with all that is fixed to it; None if there is no inertial at all."""
        bodies = [
            _inertia(inertial).placed(placement)
            for name, placement in self.rigid(link, way)
            if (inertial := self.links[name].inertial) is not None
        ]
        if not bodies:
            return None
        total = bodies[0]
        for body in bodies[1:]:
            total = total + body
        return total

    def rigid(self, link: str, way: list[Any]) -> Iterator[tuple[str, Pose]]:
        """A link and all that is fixed to it, each with its frame in the link's."""
        stack = [(link, IDENTITY)]
        while stack:
            name, placement = stack.pop()
            yield name, placement
            for joint in self.model.joints:
                if joint.parent != name:
                    continue
                if joint.type == "fixed":
                    stack.append((joint.child, placement @ _pose(joint.origin)))
                elif joint not in way and link == self.bodies("", way)[-1]:
                    self.left_out.setdefault(joint.name, None)  # behind the flange: a tool's
                elif joint not in way:
                    raise self.error(
                        f"the arm branches at link {name!r}: joint {joint.name!r} moves too; "
                        "only serial arms can be used, so remove it or make it fixed"
                    )

    def shapes(self, base: str, way: list[Any]) -> UrdfShapes:
        """The shapes of base and links; the visual geometry of those without collision geometry."""
        found = UrdfShapes(self.path)
        for index, link in enumerate(self.bodies(base, way)):
            rigid = list(self.rigid(link, way))
            elements = [
                (element, frame)
                for name, frame in rigid
                for element in self.links[name].collisions or self.links[name].visuals
            ]
            found.add(index, link, elements)
        return found

    def drawn(self, base: str, way: list[Any]) -> list[list[str]]:
        """The links with geometry of the base and of each link of the arm."""
        return [
            [
                name
                for name, _ in self.rigid(link, way)
                if self.links[name].collisions or self.links[name].visuals
            ]
            for link in self.bodies(base, way)
        ]

    def bodies(self, base: str, way: list[Any]) -> list[str]:
        """The base, and the link behind each joint that moves."""
        return [base, *(element.child for element in way if element.type != "fixed")]

    def origins(self, assumed: dict[str, list[str]]) -> dict[str, str]:
        file = f"published: {self.path.name}"
        rules = {
            "range": f"assumed: ±{math.degrees(CONTINUOUS_RANGE):.0f}° for continuous joints",
            "velocity": "assumed: 180 °/s where not given",
            "effort": "unknown: not given",
            "inertia": "unknown: links without <inertial>",
        }
        origins = {
            "geometry": file,
            "acceleration": f"assumed: maximum speed in {ACCELERATION_TIMES[0]} s of the first "
            f"three joints, in {ACCELERATION_TIMES[-1]} s of others, within a factor "
            f"{ACCELERATION_SPREAD}",
        }
        for group, rule in rules.items():
            names = assumed[group]
            origins[group] = f"{rule} ({', '.join(names)}); else {file}" if names else file
        return origins


def _moved(robot: Robot, root: Pose) -> Robot:
    """The robot in a frame in which the root of its file lies so."""
    first = replace(robot.joints[0], placement=root @ robot.joints[0].placement)
    shapes = tuple(
        replace(shape, placement=root @ shape.placement) if shape.link == 0 else shape
        for shape in robot.shapes
    )
    return replace(robot, joints=(first, *robot.joints[1:]), shapes=shapes)


def _pose(origin: Any) -> Pose:
    return IDENTITY if origin is None else Pose.from_matrix(np.asarray(origin, dtype=float))


def _inertia(inertial: Any) -> Inertia:
    tensor = np.zeros((3, 3)) if inertial.inertia is None else np.asarray(inertial.inertia)
    a, b, c = (tuple(float(v) for v in row) for row in tensor)
    body = Inertia(
        float(inertial.mass or 0.0),
        tensor=((a[0], a[1], a[2]), (b[0], b[1], b[2]), (c[0], c[1], c[2])),
    )
    return body.placed(_pose(inertial.origin))
