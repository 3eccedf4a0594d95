"""Stations of two robots that face each other, of any makes, written from lists of steps.

Places are in front of the robot: x forward, y to its left, z up from its base.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

_UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
TCP = 0.12
"""m from the flange."""
_SIGNALS = 10
"""Added to numbers of signals, so that none is the gripper's."""


@dataclass(frozen=True)
class Turn:
    """A move of the joints to angles q in rad; ``zone`` in m, zero for a stop."""

    q: Sequence[float]
    zone: float = 0.0


@dataclass(frozen=True)
class Go:
    """A move of the tool that points down to a place in m, straight or of the joints."""

    place: tuple[float, float, float]
    zone: float = 0.0
    straight: bool = True
    speed: float = 0.3


@dataclass(frozen=True)
class Say:
    """A signal that is set."""

    number: int
    on: bool = True


@dataclass(frozen=True)
class Await:
    """A signal of the other robot that is waited for."""

    number: int


@dataclass(frozen=True)
class Grip:
    """A gripper that closes or opens."""

    closed: bool


@dataclass(frozen=True)
class Rest:
    """s in which nothing happens."""

    seconds: float


Step = Turn | Go | Say | Await | Grip | Rest


class Make:
    """How programs of a make are written.

    Args:
        robot: name of the arm.
        home: rad, at which its tool is in front of it and points down.
        drawn_back: rad, the same near to it.
        ending: of program files.
        output, input: names of signals, with their number.
        grip: statement that closes the gripper, and opens it.
        tool: what its program calls the tool.
    """

    robot: str
    home: tuple[float, ...]
    drawn_back: tuple[float, ...]
    ending: str
    output: str
    input: str
    grip: tuple[str, str]
    turned = False
    tool = "tcp"

    def write(self, name: str, steps: Iterable[Step], far: float | None) -> str:
        """The text of a program.

        Args:
            name: of it.
            steps: what it does.
            far: m from the world's zero to a robot that stands turned round there; None for one
                that stands at zero.
        """
        raise NotImplementedError


class Abb(Make):
    """RAPID."""

    robot, ending = "abb/irb1600-6-145", "mod"
    home = (0.0, 0.1, 0.2, 0.0, 1.2, 0.0)
    drawn_back = (0.0, -0.5, 0.6, 0.0, 1.4, 0.0)
    output, input = "do{}", "di{}"
    grip = "SetDO grip, 1", "SetDO grip, 0"

    def write(self, name: str, steps: Iterable[Step], far: float | None) -> str:
        said = (self._said(step, far) for step in steps)
        body = ";\n    ".join(["ConfJ \\Off", "ConfL \\Off", *said])
        tool = f"[TRUE,[[0,0,{1e3 * TCP:g}],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]]"
        return (
            f"MODULE {name}\n  PERS tooldata tcp := {tool};\n"
            f"  PROC main()\n    {body};\n  ENDPROC\nENDMODULE\n"
        )

    def _said(self, step: Step, far: float | None) -> str:
        match step:
            case Turn(q, zone):
                angles = ",".join(f"{math.degrees(v):.4f}" for v in q)
                return f"MoveAbsJ [[{angles}],{_UNUSED}], v1000, {_rapid(zone)}, tcp"
            case Go(place, zone, straight, speed):
                turned = "0,0,1,0" if far is None else "0,1,0,0"
                target = f"[{_mm(_world(place, far))}],[{turned}],[0,0,0,0],{_UNUSED}"
                word = "MoveL" if straight else "MoveJ"
                return f"{word} [{target}], v{1e3 * speed:.0f}, {_rapid(zone)}, tcp"
            case Say(number, on):
                return f"SetDO do{number + _SIGNALS}, {int(on)}"
            case Await(number):
                return f"WaitDI di{number + _SIGNALS}, 1"
            case Grip(closed):
                return self.grip[not closed]
            case Rest(seconds):
                return f"WaitTime {seconds:.3f}"


class Kuka(Make):
    """KRL."""

    robot, ending = "kuka/kr16-2", "src"
    home = (0.0, -1.4, 1.7, 0.0, 1.2, 0.0)
    drawn_back = (0.0, -2.2, 2.3, 0.0, 1.4, 0.0)
    output, input = "$OUT[{}]", "$IN[{}]"
    grip = "$OUT[1]=TRUE", "$OUT[1]=FALSE"
    tool = "tool"

    def write(self, name: str, steps: Iterable[Step], far: float | None) -> str:
        body = "\n".join(self._said(step, far) for step in steps)
        tool = f"$TOOL={{X 0,Y 0,Z {1e3 * TCP:g},A 0,B 0,C 0}}"
        return f"DEF {name}()\n$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}\n{tool}\n{body}\nEND\n"

    def _said(self, step: Step, far: float | None) -> str:
        match step:
            case Turn(q, zone):
                angles = ",".join(f"A{k} {math.degrees(v):.4f}" for k, v in enumerate(q, 1))
                return f"{self._near(zone)}PTP {{{angles}}}{' C_PTP' if zone else ''}"
            case Go(place, zone, straight, speed):
                x, y, z = (1e3 * v for v in _world(place, far))
                turned = 180 if far is None else 0
                target = f"{{X {x:.3f},Y {y:.3f},Z {z:.3f},A {turned},B 0,C 180}}"
                word, end = ("LIN", " C_DIS") if straight else ("PTP", " C_PTP")
                near = f"{self._near(zone)}$VEL.CP={speed:.3f}\n"
                return f"{near}{word} {target}{end if zone else ''}"
            case Say(number, on):
                return f"CONTINUE\n$OUT[{number + _SIGNALS}]={'TRUE' if on else 'FALSE'}"
            case Await(number):
                return f"CONTINUE\nWAIT FOR $IN[{number + _SIGNALS}]"
            case Grip(closed):
                return self.grip[not closed]
            case Rest(seconds):
                return f"WAIT SEC {seconds:.3f}"

    def _near(self, zone: float) -> str:
        return f"$APO.CPTP=50\n$APO.CDIS={1e3 * zone:.1f}\n" if zone else ""


class Ur(Make):
    """URScript; the arm stands turned round, so that what is in front of it has a negative x."""

    robot, ending = "ur/ur10e", "script"
    home = (0.0, -1.6, -1.6, -1.5, 1.5708, 0.0)
    drawn_back = (0.0, -1.2, -2.2, -1.3, 1.5708, 0.0)
    output, input = "digital_out[{}]", "digital_in[{}]"
    grip = "set_standard_digital_out(0, True)", "set_standard_digital_out(0, False)"
    turned = True

    def write(self, name: str, steps: Iterable[Step], far: float | None) -> str:
        body = "\n  ".join([f"set_tcp(p[0, 0, {TCP}, 0, 0, 0])", *map(self._said, steps)])
        return f"def {name}():\n  {body}\nend\n"

    def _said(self, step: Step) -> str:
        match step:
            case Turn(q, zone):
                return f"movej([{', '.join(f'{v:.6f}' for v in q)}]{self._near(zone)})"
            case Go((x, y, z), zone, straight, speed):
                target = f"p[{-x:.6f}, {-y:.6f}, {z:.6f}, 0, {math.pi:.6f}, 0]"
                if not straight:
                    return f"movej({target}{self._near(zone)})"
                return f"movel({target}, a=0.8, v={speed:.3f}{self._near(zone)})"
            case Say(number, on):
                return f"set_standard_digital_out({number}, {on})"
            case Await(number):
                asked = f"get_standard_digital_in({number}) == False"
                return f"while ({asked}):\n    sync()\n  end"
            case Grip(closed):
                return self.grip[not closed]
            case Rest(seconds):
                return f"sleep({seconds:.3f})"

    def _near(self, zone: float) -> str:
        return f", r={zone:.4f}" if zone else ""


MAKES = {"abb": Abb(), "kuka": Kuka(), "ur": Ur()}


def _rapid(zone: float) -> str:
    if not zone:
        return "fine"
    mm = 1e3 * zone
    return f"[FALSE,{mm:.1f},{1.5 * mm:.1f},{1.5 * mm:.1f},{0.15 * mm:.2f},{mm:.1f},{mm:.1f}]"


def _world(place: tuple[float, float, float], far: float | None) -> tuple[float, float, float]:
    x, y, z = place
    return (x, y, z) if far is None else (far - x, -y, z)


def _mm(place: Iterable[float]) -> str:
    return ",".join(f"{1e3 * v:.3f}" for v in place)


@dataclass(frozen=True)
class Member:
    """A robot of a station.

    Args:
        make: key of `MAKES`.
        steps: of its program.
        rest: of its cell file.
    """

    make: str
    steps: Sequence[Step]
    rest: str = ""


def write_station(
    folder: Path,
    one: Member,
    two: Member,
    gap: float,
    *,
    clearance: float = 0.01,
    delays: tuple[float, float] = (0.0, 0.0),
    radius: float = 0.03,
    begins: float = 0.0,
    rest: str = "",
) -> Path:
    """Two robots that face each other, with all outputs joined to inputs of the same number.

    Args:
        folder: that gets the files.
        one, two: the robots, called so.
        gap: m between their bases.
        clearance: m.
        delays: s, the least and the greatest, of links.
        radius: m, of their tools.
        begins: s after the one at which the other begins.
        rest: of the station file.
    """
    folder.mkdir(parents=True, exist_ok=True)
    text = f"clearance_mm = {1e3 * clearance:g}\n"
    links = ""
    for name, member, other, far in (("one", one, two, None), ("two", two, one, gap)):
        make = MAKES[member.make]
        file = f"{name}.{make.ending}"
        (folder / file).write_text(make.write(name, member.steps, far), "utf-8")
        turned = 180.0 if (name == "two") != make.turned else 0.0
        (folder / f"{name}.toml").write_text(
            f'robot = "{make.robot}"\nclearance_mm = {1e3 * clearance:g}\n'
            f"base = {{ xyz_mm = [{1e3 * (far or 0.0):.3f}, 0, 0], rpy_deg = [0, 0, {turned}] }}\n"
            f"[tool.{make.tool}]\ntcp = {{ xyz_mm = [0, 0, {1e3 * TCP:g}] }}\n"
            f"cylinder_mm = [{1e3 * radius:.1f}, 110]\npose = {{ xyz_mm = [0, 0, 55] }}\n"
            f"{member.rest}",
            "utf-8",
        )
        text += f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{file}"\n'
        text += f"begins_s = {begins if far else 0.0}\n"
        said = {step.number for step in member.steps if isinstance(step, Say)}
        heard = {step.number for step in other.steps if isinstance(step, Await)}
        for number in sorted(said & heard):
            end = "two" if name == "one" else "one"
            source, target = (
                signal.format(number + (0 if key == "ur" else _SIGNALS))
                for signal, key in (
                    (make.output, member.make),
                    (MAKES[other.make].input, other.make),
                )
            )
            low, high = (1e3 * d for d in delays)
            links += f'"{name}.{source}" = {{ to = "{end}.{target}", '
            links += f"delay_ms = [{low:g}, {high:g}] }}\n"
    if links:
        text += f"[links]\n{links}"
    station = folder / "station.toml"
    station.write_text(text + rest, "utf-8")
    return station
