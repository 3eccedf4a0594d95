"""The vendors' languages: how fast they are read, and what breaks readers and writers.

    python benchmarks/languages.py [--json] [--case rapid] [--inputs 20000] [--workers 2]

- ``read_ms_per_1000_lines``: CPU time of reading a module of 4000 lines into a program, entry run
  and moves listed; ``peer_value`` is that of lark making a tree of the same text with the
  language's grammar in ``tests/vendors/grammars``, in the same process.
- ``fuzz_inputs``, ``fuzz_failures``: damaged programs, each read within a second and 500 MB, and
  how many of them a reader did not answer with a program or an error of its own; see `fuzzing`.
- ``roundtrip_failures``: drawn programs (``--programs``) and those of the corpus that do not come
  back from writing and reading as they were, or are written otherwise the second time.
- ``own_corpus_run_fraction``: the share of the corpus in ``tests/corpus`` that is emulated to the
  end.
- ``own_corpus_first_command_fraction``: the share that is emulated to the end by the first command
  that a user would give, ``flyby emulate FILE --robot NAME``, without answers or other files;
  programs of which parts are missing count too, and those that move nothing, if the index says so.

Needs the project's tests beside it: pip install flyby[testing]
"""

from __future__ import annotations

import sys
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory

from fuzzing import Seeds, failures, told
from report import Figure, cpu_seconds, main

import flyby
from flyby.core.errors import FlybyError
from flyby.core.language import Sources
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import Move, Opaque
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.model import Robot
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.answers_file import load_answers
from flyby.core.source.patch.edits import TOLERANCE, difference, reading_of
from flyby.core.vendor import Vendor
from flyby.testing.checks.subject import said

TESTS = Path(__file__).parents[1] / "tests"
CORPUS = TESTS / "corpus"
LINES = 4000
SHORT = 6
"""Statements of the short programs that are damaged beside the whole ones."""


@dataclass(frozen=True)
class Language:
    """A case.

    Args:
        vendor: whose language it is.
        sources: a long program, by file name; the first is the main one.
        grammars: of the peer, by the suffix of the files.
        words: name of the class that says what the language can say.
        precision: how near its numbers come back.
    """

    vendor: str
    sources: Callable[[], Sources]
    grammars: Mapping[str, str]
    words: str
    precision: float = TOLERANCE


def _points(count: int) -> Iterator[tuple[int, float, float]]:
    """Numbers and coordinates (mm) of points on a grid."""
    for k in range(count):
        yield k, 800 + 0.25 * (k % 400), -200 + 0.5 * (k // 40)


def rapid_module() -> Sources:
    """Targets, and a move to each."""
    count = (LINES - 10) // 2
    axes = "[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]"
    data = [
        f"  CONST robtarget p{k}:=[[{x},{y},600.5],[0,0,1,0],[0,0,0,0],{axes}];"
        for k, x, y in _points(count)
    ]
    moves = [f"    MoveL p{k},v200,z10,tool0\\WObj:=wobj0;" for k in range(1, count)]
    start = "    MoveJ p0,v1000,fine,tool0;"
    lines = ["MODULE Long", *data, "", "  PROC main()", start, *moves, "  ENDPROC", "ENDMODULE"]
    return {"Long.mod": "\n".join(lines) + "\n"}


def krl_module() -> Sources:
    """A source file and its data list."""
    count = (LINES - 20) // 2
    frame = "A 0.0,B 90.0,C 0.0"
    data = [
        f"DECL E6POS XP{k}={{X {x},Y {y},Z 600.5,{frame},S 2,T 10,E1 0.0}}"
        for k, x, y in _points(count)
    ]
    settings = ["$BASE=$NULLFRAME", "$TOOL=$NULLFRAME", "$VEL.CP=0.2", "$APO.CDIS=10"]
    ini = [";FOLD INI", "BAS (#INITMOV,0 )", ";ENDFOLD (INI)", *settings]
    moves = ["PTP XP0", *(f"LIN XP{k} C_DIS" for k in range(1, count))]
    source = ["&ACCESS RVP", "DEF long( )", *ini, *moves, "END"]
    return {
        "long.src": "\n".join(source) + "\n",
        "long.dat": "\n".join(["&ACCESS RVP", "DEFDAT long", *data, "ENDDAT"]) + "\n",
    }


def urscript() -> Sources:
    """A script with a target and a move on each pair of lines."""
    moves = [
        line
        for k, x, y in _points((LINES - 4) // 2)
        for line in (
            f"  p{k} = p[{x / 1000:.6f}, {y / 1000:.6f}, 0.2, 0.0, 3.1416, 0.0]",
            f"  movel(p{k}, a=1.2, v=0.25, r=0.001)",
        )
    ]
    start = "  movej([0.1, -1.2, 1.3, -1.6, -1.57, 0.4], a=1.4, v=1.05)"
    return {"long.script": "\n".join(["def long():", start, *moves, "end"]) + "\n"}


LANGUAGES = {
    "rapid": Language("abb", rapid_module, {".mod": "rapid"}, "AbbWords", 1.2e-7),
    "krl": Language("kuka", krl_module, {".src": "krl_src", ".dat": "krl_dat"}, "KukaWords"),
    "urscript": Language("ur", urscript, {".script": "urscript"}, "UrWords"),
}


@dataclass(frozen=True)
class Entry:
    """A program of the corpus: where it is, and what it is read with."""

    path: Path
    robot: Robot
    answers: Answers | None
    others: tuple[Path, ...]

    def read(self, vendor: Vendor) -> Program:
        """The program."""
        return vendor.read_file(
            self.path, robot=self.robot, answers=self.answers, others=self.others
        )


def corpus(case: str) -> list[Entry]:
    """The programs that the folder's index names."""
    folder = CORPUS / case
    return [
        Entry(
            folder / entry["file"],
            find_robot(entry["robot"]),
            load_answers(folder / entry["answers"]) if "answers" in entry else None,
            tuple(folder / other for other in entry.get("others", ())),
        )
        for entry in tomllib.loads((folder / "index.toml").read_text("utf-8"))["program"]
    ]


def reading_times(language: Language) -> tuple[float, float]:
    """CPU time of our reader and of the peer's for the long program, s."""
    from lark import Lark

    vendor, sources = find_vendor(language.vendor), language.sources()
    parsers = {
        suffix: Lark(
            (TESTS / "vendors" / "grammars" / f"{grammar}.lark").read_text("utf-8"),
            parser="lalr",
            lexer="basic",
        )
        for suffix, grammar in language.grammars.items()
    }

    def theirs() -> None:
        for file, text in sources.items():
            parsers[Path(file).suffix].parse(text)

    with TemporaryDirectory() as folder:
        reading = reading_of(vendor.read_file(stored(sources, Path(folder))))
        seconds = cpu_seconds({"ours": lambda: reading.again({}), "theirs": theirs})
    return seconds["ours"], seconds["theirs"]


def seeds(case: str) -> Seeds:
    """What is damaged: the programs of the corpus, and a few moves of each, newly written."""
    vendor = find_vendor(LANGUAGES[case].vendor)
    entries = corpus(case)
    programs = [entry.read(vendor) for entry in entries]
    pairs = zip(programs, entries, strict=True)
    return Seeds.of([*programs, *(rewritten(vendor, p, e.robot) for p, e in pairs)])


def rewritten(vendor: Vendor, program: Program, robot: Robot) -> Program:
    """The first moves of a program, read from files that our writer has written."""
    with TemporaryDirectory() as folder:
        sources = vendor.write(Program(plain(program).statements[:SHORT]), robot)
        return vendor.read_file(stored(sources, Path(folder)), robot=robot)


def plain(program: Program) -> Program:
    """The moves and waits of a program, which any language has words for."""
    return replace(
        program,
        statements=tuple(
            replace(s, events=()) if isinstance(s, Move) else s
            for s in program.statements
            if not isinstance(s, Opaque)
        ),
    )


def stored(sources: Sources, folder: Path) -> Path:
    """The main file, after all have been stored as they are."""
    for file, text in sources.items():
        (folder / file).write_text(text, "utf-8", newline="")
    suffixes = (".mod", ".src", ".script")
    return folder / next(file for file in sources if file.lower().endswith(suffixes))


def comes_back(program: Program, robot: Robot, language: Language) -> bool:
    """Whether a program is written, read as it was, and written alike again."""
    vendor = find_vendor(language.vendor)
    try:
        sources = vendor.write(program, robot)
        with TemporaryDirectory() as folder:
            again = vendor.read_file(stored(sources, Path(folder)), robot=robot)
        # What is no move may name routines and signals that the new files do not declare.
        moves = Program(said(program, vendor, robot, again).moves), Program(again.moves)
        return (
            difference(*moves, language.precision) is None and vendor.write(again, robot) == sources
        )
    except FlybyError as error:
        print(f"{language.vendor}: {error}", file=sys.stderr)
        return False


def drawn(language: Language, count: int) -> Iterator[tuple[Program, Robot]]:
    """Programs that the language can say, the same at every call."""
    from hypothesis import HealthCheck, Phase, given, seed, settings
    from hypothesis import strategies as st

    sys.path.insert(0, str(TESTS / "vendors"))
    import words

    subject = getattr(words, language.words)()
    found: list[tuple[Program, Robot]] = []

    @settings(
        max_examples=count,
        deadline=None,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @seed(1)
    @given(data=st.data())
    def draw(data: st.DataObject) -> None:
        robot = subject.vendor.robot(data.draw(st.sampled_from(subject.driven_robots())))
        found.append((data.draw(subject.programs(robot)), robot))

    draw()
    yield from found


def roundtrip_failures(case: str, count: int) -> int:
    """How many programs do not come back."""
    language = LANGUAGES[case]
    vendor = find_vendor(language.vendor)
    failed = sum(
        not comes_back(program, robot, language) for program, robot in drawn(language, count)
    )
    for entry in corpus(case):
        program = entry.read(vendor)
        if not comes_back(plain(program), entry.robot, language):
            print(f"{entry.path.name} does not come back", file=sys.stderr)
            failed += 1
    return failed


def run_fraction(case: str) -> float:
    """The share of the corpus that is emulated to the end."""
    vendor = find_vendor(LANGUAGES[case].vendor)
    entries, done = corpus(case), 0
    for entry in entries:
        try:
            run = Controller(vendor, entry.robot).run(entry.read(vendor))
        except FlybyError as error:
            print(f"{entry.path.name}: {error}", file=sys.stderr)
            continue
        done += run.duration > 0
    return done / len(entries)


def first_command_fraction(case: str) -> float:
    """The share of the corpus that is emulated to the end with nothing but the robot's name."""
    programs = [
        (index.parent / entry["file"], entry["robot"], entry.get("moves") == 0)
        for index in sorted((CORPUS / case).rglob("index.toml"))
        for entry in tomllib.loads(index.read_text("utf-8"))["program"]
    ]
    done = 0
    for path, robot, stands in programs:
        try:
            emulation = flyby.emulate(flyby.read(path, robot=robot), robot=robot)
        except FlybyError as error:
            print(f"{path.name}: {error}", file=sys.stderr)
            continue
        for fault in emulation.faults:
            print(f"{path.name}: {fault}", file=sys.stderr)
        done += not emulation.faults and (stands or emulation.duration > 0)
    return done / len(programs)


def measure(case: str, inputs: int, workers: int, programs: int) -> Iterator[Figure]:
    """All figures of one language."""
    ours, theirs = reading_times(LANGUAGES[case])
    per = 1e3 / (LINES / 1000)
    peer = f"lark {version('lark')}, grammar of the tests"
    yield Figure(case, "read_ms_per_1000_lines", ours * per, "ms", peer, theirs * per)
    yield Figure(case, "fuzz_inputs", inputs, "")
    yield Figure(case, "fuzz_failures", told(failures(seeds, case, inputs, workers), case), "")
    yield Figure(case, "roundtrip_failures", roundtrip_failures(case, programs), "")
    yield Figure(case, "own_corpus_run_fraction", run_fraction(case), "")
    yield Figure(case, "own_corpus_first_command_fraction", first_command_fraction(case), "")


if __name__ == "__main__":
    main(__doc__ or "", measure, LANGUAGES, inputs=20_000, workers=2, programs=200)
