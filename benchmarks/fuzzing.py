"""Damaged programs for readers, each read in a process with bounds on time and memory.

An input is a program of the corpus in which one file has been damaged: bytes flipped, lines
shuffled, tokens swapped or taken from another program, numbers made huge, brackets and blocks
nested deeply. It follows from its number alone, so that a failure can be had again. A reader passes
if it gives a program or a `FlybyError`; what else it does is a failure:

- any other exception, and a process that dies;
- more than `SECONDS` of CPU time;
- more than `MEGABYTES` of memory beyond what the process had after it had read the corpus once.
"""

from __future__ import annotations

import multiprocessing
import re
import resource
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from random import Random
from typing import Any

from flyby.core.errors import FlybyError
from flyby.core.program.program import Program
from flyby.core.source.patch.edits import reading_of
from flyby.core.source.reading import Reading
from flyby.core.source.text.files import SourceFile, decode
from flyby.testing.hostile import HUGE, NUMBER, ODD, OPENERS

SECONDS = 1.0
HANGS = 20.0
"""s of CPU time after which a reader is ended. Before, it is not disturbed: what it uses for the
first time (a kernel that is compiled) may be in the midst of loading."""
MEGABYTES = 500
LOADING = 900.0
"""s of wall time in which a process reads the corpus."""
SILENCE = 60.0
"""s of wall time without a word from a process before it is ended: it hangs where no signal is
heard."""

Load = Callable[[str], "Seeds"]


@dataclass(frozen=True)
class Seeds:
    """The programs of a case, read; the short ones are damaged more often, as they are read faster.

    Args:
        readings: of the programs.
        weights: how often each is chosen, relative to the others.
    """

    readings: tuple[Reading, ...]
    weights: tuple[float, ...]

    @classmethod
    def of(cls, programs: Iterable[Program]) -> Seeds:
        """Seeds of programs that were read from files."""
        readings = tuple(_alone(program) for program in programs)
        sizes = (sum(file.text.count("\n") for file in r.files.values()) for r in readings)
        return cls(readings, tuple((50 + size) ** -1.5 for size in sizes))

    def choose(self, chance: Random) -> Reading:
        """One program."""
        return chance.choices(self.readings, self.weights)[0]


def _alone(program: Program) -> Reading:
    """How a program was read, without the files that only stand in the same folder."""
    reading = reading_of(program)
    for name in reading.files:
        fewer = {file: text for file, text in reading.files.items() if file != name}
        if name != reading.main and _reads(replace(reading, files=fewer), program):
            reading = replace(reading, files=fewer)
    return reading


def _reads(reading: Reading, program: Program) -> bool:
    try:
        return reading.again({}).statements == program.statements
    except FlybyError:
        return False


@dataclass(frozen=True)
class Failure:
    """An input that a reader did not answer, and what it did."""

    number: int
    what: str


def damaged(seeds: Seeds, case: str, number: int) -> tuple[Reading, str, SourceFile]:
    """The input of a number: a reading, the name of its damaged file, and that file."""
    chance = Random(f"{case} {number}")
    reading = seeds.choose(chance)
    name = reading.main if chance.random() < 0.7 else chance.choice(sorted(reading.files))
    data = _bytes(reading.files[name])
    other = seeds.choose(chance)
    source = _bytes(other.files[other.main])
    for _ in range(chance.choice((1, 1, 1, 2, 2, 3, 6))):
        data = chance.choice(_DAMAGES)(chance, data, source)
    return reading, name, SourceFile(name, *_decoded(data, name))


def _bytes(file: SourceFile) -> bytes:
    return file.text.encode(file.codec)


def _decoded(data: bytes, name: str) -> tuple[str, str]:
    try:
        return decode(data, name)
    except FlybyError:  # what begins with a mark and is damaged does not come to the reader
        return data.decode("latin-1"), "latin-1"


_TOKEN = re.compile(rb"[A-Za-z_$]\w*|\d+\.?\d*|[^\s\w]")


def _flip(chance: Random, data: bytes, _: bytes) -> bytes:
    changed = bytearray(data)
    for _k in range(chance.randint(1, 8)):
        if changed:
            changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def _cut(chance: Random, data: bytes, _: bytes) -> bytes:
    start = chance.randint(0, len(data))
    return data[:start] + data[start + chance.randint(1, 200) :]


def _end(chance: Random, data: bytes, _: bytes) -> bytes:
    return data[: chance.randint(0, len(data))]


def _shuffle(chance: Random, data: bytes, _: bytes) -> bytes:
    lines = data.splitlines(keepends=True)
    start = chance.randint(0, len(lines))
    stop = start + chance.randint(2, 20)
    window = lines[start:stop]
    chance.shuffle(window)
    return b"".join(lines[:start] + window + lines[stop:])


def _repeat(chance: Random, data: bytes, _: bytes) -> bytes:
    lines = data.splitlines(keepends=True)
    start = chance.randint(0, len(lines))
    window = lines[start : start + chance.randint(1, 10)]
    # A text that is long takes long: that is no failure.
    often = 50 if sum(map(len, window)) < 2000 else 2
    return b"".join(lines[:start] + window * chance.choice((1, 2, often)) + lines[start:])


def _tokens(chance: Random, data: bytes, count: int) -> list[re.Match[bytes]]:
    """Tokens in order; all of them are looked for in one stretch, which is faster."""
    start = chance.randint(0, max(0, len(data) - 2000))
    found = list(_TOKEN.finditer(data, start, start + 2000))
    return sorted(chance.sample(found, min(count, len(found))), key=lambda m: m.start())


def _swap(chance: Random, data: bytes, _: bytes) -> bytes:
    pair = _tokens(chance, data, 2)
    if len(pair) < 2:
        return data
    (a, b), (c, d) = pair[0].span(), pair[1].span()
    return data[:a] + data[c:d] + data[b:c] + data[a:b] + data[d:]


def _foreign(chance: Random, data: bytes, other: bytes) -> bytes:
    """A token becomes one of another program."""
    here, there = _tokens(chance, data, 1), _tokens(chance, other, 1)
    if not here or not there:
        return data
    return data[: here[0].start()] + there[0].group() + data[here[0].end() :]


def _splice(chance: Random, data: bytes, other: bytes) -> bytes:
    at, start = chance.randint(0, len(data)), chance.randint(0, len(other))
    return data[:at] + other[start : start + chance.randint(1, 2000)] + data[at:]


def _nest(chance: Random, data: bytes, _: bytes) -> bytes:
    opener = chance.choice(OPENERS).encode()
    found = _tokens(chance, data, 1)
    at = found[0].start() if found else 0
    return data[:at] + opener * chance.choice((1, 2, 30, 1000, 10_000)) + data[at:]


def _number(chance: Random, data: bytes, _: bytes) -> bytes:
    """A number becomes another: zero, huge, one that counts too far."""
    start = chance.randint(0, max(0, len(data) - 2000))
    text = data[start : start + 2000].decode("latin-1")
    found = list(NUMBER.finditer(text))
    if not found:
        return data
    hit = chance.choice(found)
    small = ("0", "-1", "1", "2", "0.0", "1e-30", "65536", "999999999", "2147483648", "1e9", "1e38")
    new = chance.choice((*small, *small, *HUGE)).encode()
    return data[: start + hit.start()] + new + data[start + hit.end() :]


def _odd(chance: Random, data: bytes, _: bytes) -> bytes:
    at = chance.randint(0, len(data))
    return data[:at] + chance.choice(ODD).encode("utf-8", "surrogatepass") + data[at:]


_DAMAGES = (
    *(_flip, _cut, _end, _shuffle, _repeat, _swap, _swap, _foreign, _foreign, _splice),
    *(_nest, _number, _number, _odd),
)


_TOO_SLOW = f"took more than {SECONDS:g} s"


class Slow(BaseException):
    """The time for an input is over; no reader catches it."""


def _over(*_: object) -> None:
    raise Slow


def attempt(seeds: Seeds, case: str, number: int) -> Failure | None:
    """Read one input within the bounds of this process.

    What took too long is read once more: a machine that stalled, or what is loaded at the first
    use, is no failure of the reader.
    """
    reading, name, file = damaged(seeds, case, number)
    what = _in_time(reading, name, file)
    if what == _TOO_SLOW:
        what = _in_time(reading, name, file)
    return Failure(number, what) if what else None


def _in_time(reading: Reading, name: str, file: SourceFile) -> str:
    """As `_read`, where the time may also be over when the reader has just ended."""
    try:
        return _read(reading, name, file)
    except Slow:
        return _TOO_SLOW


def _read(reading: Reading, name: str, file: SourceFile) -> str:
    """What a reader did wrong; empty if nothing."""
    signal.setitimer(signal.ITIMER_PROF, HANGS)
    begun = time.process_time()
    try:
        program = reading.again({name: file})
        what = "" if isinstance(program, Program) else f"gave {type(program).__name__}"
    except FlybyError:
        what = ""
    except Slow:
        what = _TOO_SLOW
    except BaseException as error:
        place = error.__traceback__
        while place is not None and place.tb_next is not None:
            place = place.tb_next
        where = f"{place.tb_frame.f_code.co_filename}:{place.tb_lineno}" if place else "?"
        what = f"{type(error).__name__} at {where}: {str(error)[:200]}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return what or (_TOO_SLOW if time.process_time() - begun > SECONDS else "")


def bounded() -> None:
    """Bound this process; to be called when what it needs anyhow is loaded."""
    signal.signal(signal.SIGPROF, _over)
    with open("/proc/self/status") as status:
        used = next(int(line.split()[1]) for line in status if line.startswith("VmData:"))
    most = used * 1024 + MEGABYTES * 1024 * 1024
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))


def _work(load: Load, case: str, numbers: range, at: Any, pipe: Connection) -> None:
    seeds = load(case)
    bounded()
    for number in numbers:
        at.value = number
        failure = attempt(seeds, case, number)
        if failure is not None:
            pipe.send(failure)
        elif number % 100 == 0:
            pipe.send(None)  # a sign of life
    pipe.close()


@dataclass
class _Worker:
    """A process and the numbers that it reads."""

    process: SpawnProcess
    pipe: Connection
    at: Any
    numbers: range
    heard: float


def failures(load: Load, case: str, inputs: int, workers: int) -> Iterator[Failure]:
    """Read ``inputs`` damaged programs in ``workers`` processes; the failures as they come."""
    running = [_started(load, case, range(k, inputs, workers)) for k in range(workers)]
    while running:
        wait([worker.pipe for worker in running], timeout=1.0)
        for worker in list(running):
            alive, found = _heard(worker)
            yield from found
            patience = SILENCE if worker.at.value >= 0 else LOADING
            if alive and time.monotonic() - worker.heard < patience:
                continue
            running.remove(worker)
            rest = _ended(worker)
            if rest is not None:
                yield Failure(worker.at.value, f"the process died, exit {worker.process.exitcode}")
                running.append(_started(load, case, rest))


def _started(load: Load, case: str, numbers: range) -> _Worker:
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    at = context.Value("q", -1)
    process = context.Process(target=_work, args=(load, case, numbers, at, theirs), daemon=True)
    process.start()
    theirs.close()
    return _Worker(process, ours, at, numbers, time.monotonic())


def _heard(worker: _Worker) -> tuple[bool, Sequence[Failure]]:
    """Whether the process still speaks, and the failures that it told."""
    found = []
    try:
        while worker.pipe.poll():
            message = worker.pipe.recv()
            worker.heard = time.monotonic()
            if message is not None:
                found.append(message)
    except EOFError:
        return False, found
    return True, found


def _ended(worker: _Worker) -> range | None:
    """End a process; the numbers that it has not read, None if it has read all."""
    worker.process.join(timeout=5.0)
    if worker.process.is_alive():
        worker.process.kill()
        worker.process.join()
    elif worker.process.exitcode == 0:
        return None
    if worker.at.value < 0:
        raise RuntimeError("a process ended before it had read anything: see its message above")
    return range(worker.at.value + worker.numbers.step, worker.numbers.stop, worker.numbers.step)


def told(found: Iterator[Failure], case: str) -> int:
    """Count failures, and say each on the error stream."""
    count = 0
    for failure in found:
        count += 1
        print(f"{case} input {failure.number}: {failure.what}", file=sys.stderr, flush=True)
    return count
