"""What a vendor supplies: robots, a motion model, labels of configurations, its language."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from .display import counted, in_line
from .errors import InputError, UnknownNameError
from .language import BackupOpener, Patcher, Reader, Recorder, Sources, Writer

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .dialect import Dialect
    from .motion.model.motion_model import MotionModel
    from .program.program import Program
    from .program.target import Configuration, JointTarget
    from .recording import Recording
    from .robot.arm_list import Listed
    from .robot.model import Robot
    from .source.execution.answers import Answers
    from .source.reading import Files, ReadOptions

NAME = re.compile(r"[a-z0-9][a-z0-9_.-]*")
LANGUAGE_PARTS = ("reader", "writer", "patcher", "recorder")

Part = TypeVar("Part")
MotionLayer = Callable[["MotionModel"], "MotionModel"]
"""Lays what is known of one robot on the motion model of its vendor's controllers."""


@dataclass(frozen=True, eq=False)
class Vendor:
    """One vendor. What takes time is a callable, called when it is needed, and cached.

    Args:
        name: lower case, the first part of its robots' names (``abb`` in ``abb/irb1200-5-090``).
        robots: each robot's name and what loads it.
        motion: loads the motion model of the vendor's controllers: the parameters of blending and
            stamping.
        robot_motion: what lays on top of it what is known of single robots, by their names.
        label: the configuration label of joint values (N,) rad of a robot, None where the vendor
            labels none.
        reader, writer, patcher, recorder: of the vendor's language; None if there is none.
        suffixes: of the files that the reader takes, with the dot, in lower case.
        companions: suffixes of files that stand beside programs and hold none, with what to name in
            their place.
        emulation_only: robots that the vendor's language does not drive, with the reason.
        speaks: what the language can say, for programs that are translated into it; None if it
            says everything that a `Program` holds.
        machine_data: a robot as a file of its own controller describes it; None if none is read.
        stated: figures of the motion model that such a file states, see `with_stated`; None if none
            are read.
        described: a robot as a file of its own controller alone describes it; None if no such file
            is read.
        listed: what is said of each arm that the vendor lists, drivable or not, by its name
            (`core.robot.arm_list`); none if nothing is known but names.
        backups: loads what opens backups of the vendor's controllers; None if none are read.
        nearest: whether a target whose configuration data contradict it is driven to in the
            solution nearest to where the robot comes from, instead of being a fault.

    Raises:
        InputError: a part is missing, or of a wrong kind.
    """

    name: str
    robots: Mapping[str, Callable[[], Robot]]
    motion: Callable[[], MotionModel]
    label: Callable[[Robot, NDArray[np.float64]], Configuration | None]
    reader: Reader | None = None
    writer: Writer | None = None
    patcher: Patcher | None = None
    recorder: Recorder | None = None
    suffixes: tuple[str, ...] = ()
    companions: Mapping[str, str] = field(default_factory=dict)
    robot_motion: Mapping[str, MotionLayer] = field(default_factory=dict)
    emulation_only: Mapping[str, str] = field(default_factory=dict)
    speaks: Dialect | None = None
    machine_data: Callable[[Robot, Path], Robot] | None = None
    stated: Callable[[Path], Mapping[str, tuple[Any, str]]] | None = None
    described: Callable[[Path], Robot] | None = None
    listed: Callable[[], Mapping[str, Listed]] = dict
    backups: Callable[[], BackupOpener] | None = None
    nearest: bool = False

    def __post_init__(self) -> None:
        _check_name("a vendor", self.name)
        _check_parts(self)
        object.__setattr__(self, "robots", MappingProxyType({**self.robots}))
        object.__setattr__(self, "companions", MappingProxyType({**self.companions}))
        object.__setattr__(self, "emulation_only", MappingProxyType({**self.emulation_only}))
        object.__setattr__(self, "motion", cache(self.motion))
        object.__setattr__(self, "robot_motion", MappingProxyType({**self.robot_motion}))

    def __repr__(self) -> str:
        reads = f", reads {' '.join(self.suffixes)}" if self.suffixes else ""
        return in_line(f"Vendor {self.name}: {counted(self.robots, 'robot')}{reads}")

    def robot(self, name: str) -> Robot:
        """The robot ``name``, with or without the vendor's own name before it.

        Raises:
            UnknownNameError: the vendor has no such robot.
        """
        own = name.removeprefix(f"{self.name}/")
        if own not in self.robots:
            raise UnknownNameError(f"robot of {self.name}", own, self.robots)
        return self.robots[own]()

    def motion_of(self, robot: Robot) -> MotionModel:
        """How the vendor's controller drives this robot."""
        layer = self.robot_motion.get(robot.name.removeprefix(f"{self.name}/"))
        return self.motion() if layer is None else layer(self.motion())

    def driven_by(self, file: Path, robot: Robot) -> Vendor:
        """The same vendor with a motion file of the user's on top of what it states of a robot.

        Raises:
            InputError: the file cannot be read, states nonsense, or is another robot's.
        """
        from .motion.model.motion_file import load_motion_model

        model = load_motion_model(file, self.motion_of(robot), robot.name)
        own = robot.name.removeprefix(f"{self.name}/")
        return replace(self, robot_motion={**self.robot_motion, own: lambda _: model})

    def with_stated(self, robot: Robot, stated: Mapping[str, tuple[Any, str]]) -> Vendor:
        """The same vendor with figures that the robot's own controller states.

        Args:
            robot: that it drives so; one that the vendor does not list is added.
            stated: value and source by key, see `core.motion.model.motion_file.with_stated`.

        Raises:
            InputError: a figure is unknown, or its value makes no sense.
        """
        from .motion.model.motion_file import with_stated

        own = robot.name.removeprefix(f"{self.name}/")
        known = self if own in self.robots else self.with_robot(robot)
        if not stated:
            return known
        model = with_stated(known.motion_of(robot), stated)
        return replace(known, robot_motion={**self.robot_motion, own: lambda _: model})

    def with_robot(self, robot: Robot) -> Vendor:
        """The same vendor with a robot of its name more."""
        own = robot.name.removeprefix(f"{self.name}/")
        return replace(self, robots={**self.robots, own: lambda: robot})

    def as_described(self, robot: Robot, file: Path) -> Robot:
        """A robot as a file of its own controller describes it.

        Raises:
            InputError: none is read of this vendor, or the file cannot be, or is another robot's.
        """
        if self.machine_data is None:
            raise InputError(f"{file}: no machine data are read of robots of {self.name}")
        return self.machine_data(robot, file)

    def as_stated(self, robot: Robot, file: Path) -> Vendor:
        """The same vendor, driving a robot as a file of its own controller says.

        Raises:
            InputError: the file cannot be read.
        """
        return self if self.stated is None else self.with_stated(robot, self.stated(file))

    def read(
        self,
        text: str,
        file: str,
        entry: str | None = None,
        robot: Robot | None = None,
        answers: Answers | None = None,
        start: JointTarget | None = None,
    ) -> Program:
        """The program in a source text; see `Reader.read` and `ReadOptions`.

        Raises:
            InputError: the vendor has no reader.
        """
        reader = self._part(self.reader, "reader")
        return reader.read(text, file, _read_options(entry, robot, answers, start=start))

    def read_file(
        self,
        path: str | Path,
        entry: str | None = None,
        robot: Robot | None = None,
        answers: Answers | None = None,
        others: Iterable[str | Path] = (),
        start: JointTarget | None = None,
        beside: Iterable[str | Path] | None = None,
        signals: Mapping[str, str] = MappingProxyType({}),
    ) -> Program:
        """The program in a source file; see `Reader.read_file` and `ReadOptions`.

        Raises:
            InputError: the vendor has no reader.
        """
        from .files.reading import settle

        reader = self._part(self.reader, "reader")
        others = tuple(others)
        for file in (path, *others):  # before anything looks for what else there is
            settle(file)
        options = replace(_read_options(entry, robot, answers, others, start), signals=signals)
        if beside is not None:
            options = replace(options, beside=tuple(map(Path, beside)))
        return reader.read_file(Path(path), options)

    def write(
        self, program: Program, robot: Robot, options: Mapping[str, str] | None = None
    ) -> Sources:
        """The program as source files for ``robot``; see `Writer.write`.

        A start that the program states and does not drive to is its first move
        (`core.source.write.approach`). The texts are read again without any other file.

        Raises:
            InputError: the vendor has no writer, its language does not drive the robot, or the
                texts cannot be read.
            SourceError: a kept statement names what only the program's own files have.
            MotionError: the texts drive something else; the move is named.
        """
        self.check_written(robot)
        writer = self._part(self.writer, "writer")
        said = self._approached(program, robot)
        sources = writer.write(said, robot, options or {})
        wording = None if self.speaks is None else self.speaks.wording
        comments = (options or {}).get("opaque") == "comment"
        if wording is not None and not comments:
            from .source.write.kept import check_kept

            check_kept(said, sources, wording)
        self._check_alone(said, robot, sources, comments=comments)
        return sources

    def patch(
        self, program: Program, robot: Robot, options: Mapping[str, str] | None = None
    ) -> Files:
        """The program's own source files with its numbers; see `Patcher.patch`.

        Returns:
            The files that changed, by names that stay inside the folder that they are written to,
            wherever the user's own files are (`core.source.reading.named_apart`); their own
            ``name`` is the one that they were read by.

        Raises:
            InputError: the vendor has no patcher.
        """
        from .source.reading import named_apart

        return named_apart(self._part(self.patcher, "patcher").patch(program, robot, options or {}))

    def record(self, program: Program, robot: Robot, period: float) -> Sources:
        """Source that drives ``robot`` and logs itself; see `Recorder.record`.

        Raises:
            InputError: the vendor has no recorder, or its language does not drive the robot.
        """
        from .recording import Recording

        return self.record_runs(Recording.of(program), robot, period)

    def record_runs(self, recording: Recording, robot: Robot, period: float) -> Sources:
        """The same of several programs, which are loaded at once.

        Raises:
            InputError, MotionError: as `record`.
        """
        if not 0 < period < float("inf"):
            raise InputError(f"{period:g} s are no period: samples are some milliseconds apart")
        self.check_written(robot)
        recorder = self._part(self.recorder, "recorder")
        runs = tuple(
            replace(run, program=self._approached(run.program, robot)) for run in recording.runs
        )
        said = replace(recording, runs=runs)
        sources = recorder.record(said, robot, period)
        # The same runs from one start, which is what can be read from beginning to end.
        through = replace(said, runs=tuple(replace(run, by_hand=False) for run in runs))
        read = sources if said == through else recorder.record(through, robot, period)
        self._check_alone(said.program, robot, read, waits=False)
        return sources

    def _check_alone(
        self,
        program: Program,
        robot: Robot,
        sources: Sources,
        waits: bool = True,
        comments: bool = False,
    ) -> None:
        if self.reader is not None:
            from .read_back import check_alone

            check_alone(program, robot, sources, self.reader, self.suffixes, waits, comments)

    def _approached(self, program: Program, robot: Robot) -> Program:
        from .source.write.approach import with_approach

        return with_approach(program, self.speaks, robot)

    def check_written(self, robot: Robot) -> None:
        """Refuse robots that the vendor's language does not drive.

        Raises:
            InputError: it can be emulated only.
        """
        reason = self.emulation_only.get(robot.name.removeprefix(f"{self.name}/"))
        if reason is not None:
            raise InputError(
                f"no program can be written for {robot.name}: {reason}; it can be emulated only"
            )

    def _part(self, part: Part | None, name: str) -> Part:
        if part is None:
            have = [p for p in LANGUAGE_PARTS if getattr(self, p) is not None]
            raise InputError(
                f"{self.name} has no {name}: it supplies "
                f"{', '.join(('robots', 'a motion model', 'labels', *have))}"
                + ("" if name != "reader" else "; build the program in Python instead")
            )
        return part


def _read_options(
    entry: str | None,
    robot: Robot | None,
    answers: Answers | None,
    others: Iterable[str | Path] = (),
    start: JointTarget | None = None,
) -> ReadOptions:
    from .source.execution.answers import Answers
    from .source.reading import ReadOptions

    return ReadOptions(
        entry, robot, answers or Answers(), others=tuple(map(Path, others)), start=start
    )


def lazy_robots(files: Iterable[Path]) -> dict[str, Callable[[], Robot]]:
    """A catalogue of robot files: each is read when its robot is asked for, and only once.

    Args:
        files: TOML files (`core.robot.catalogue`); a robot is called as its file, without suffix.
    """
    return {path.stem: _once(path) for path in sorted(files)}


def motion_layers(files: Iterable[Path]) -> dict[str, MotionLayer]:
    """What is known of how single robots are driven, each read when it is asked for, and only once.

    Args:
        files: TOML files (see `flyby.core.motion.model.motion_file`); a robot is called as its
            file, without suffix.
    """
    return {path.stem: _layer(path) for path in sorted(files)}


def _layer(path: Path) -> MotionLayer:
    laid: list[tuple[MotionModel, MotionModel]] = []

    def lay(base: MotionModel) -> MotionModel:
        from .motion.model.motion_file import load_motion_model

        if not laid or laid[0][0] is not base:
            laid[:] = [(base, load_motion_model(path, base))]
        return laid[0][1]

    return lay


def lazy_motion(path: Path) -> Callable[[], MotionModel]:
    """The motion model of a TOML file, read when it is asked for, and only once."""

    @cache
    def load() -> MotionModel:
        from .motion.model.motion_file import load_motion_model

        return load_motion_model(path)

    return load


def _once(path: Path) -> Callable[[], Robot]:
    @cache
    def load() -> Robot:
        from .robot.catalogue import load_robot

        return load_robot(path)

    return load


def _check_name(owner: str, name: str) -> None:
    if not (isinstance(name, str) and NAME.fullmatch(name)):
        raise InputError(
            f"{owner} is called by lower-case letters, digits, '.', '_' and '-', not {name!r}"
        )


def _check_parts(vendor: Vendor) -> None:
    if not isinstance(vendor.robots, Mapping) or not vendor.robots:
        raise InputError(f"vendor {vendor.name!r}: 'robots' maps at least one name to a loader")
    for name, load in vendor.robots.items():
        _check_name(f"vendor {vendor.name!r}: a robot", name)
        if not callable(load):
            raise InputError(f"vendor {vendor.name!r}: robot {name!r} needs a loader, not {load!r}")
    for part in ("motion", "label"):
        if not callable(getattr(vendor, part)):
            raise InputError(f"vendor {vendor.name!r}: {part!r} is missing, or cannot be called")
    kinds = (Reader, Writer, Patcher, Recorder)
    for part, kind in zip(LANGUAGE_PARTS, kinds, strict=True):
        value = getattr(vendor, part)
        if value is not None and not isinstance(value, kind):
            raise InputError(f"vendor {vendor.name!r}: {part!r} is no {kind.__name__}: {value!r}")
    _check_suffixes(vendor)
    for what, names in (
        ("emulation-only robot", vendor.emulation_only),
        ("robot with a motion file", vendor.robot_motion),
    ):
        for name in names:
            if name not in vendor.robots:
                raise UnknownNameError(f"{what} of {vendor.name}", name, vendor.robots)


def _check_suffixes(vendor: Vendor) -> None:
    given = (*vendor.suffixes, *vendor.companions)
    wrong = [s for s in given if not s.startswith(".") or s != s.lower()]
    if wrong or isinstance(vendor.suffixes, str):
        raise InputError(
            f"vendor {vendor.name!r}: 'suffixes' is a tuple like ('.mod',), not {vendor.suffixes!r}"
        )
    both = sorted(set(vendor.suffixes) & set(vendor.companions))
    if both:
        raise InputError(
            f"vendor {vendor.name!r}: {both[0]!r} is among 'suffixes' and 'companions'"
        )
    if (vendor.reader is None) != (not vendor.suffixes):
        raise InputError(f"vendor {vendor.name!r}: a reader and its 'suffixes' come together")
