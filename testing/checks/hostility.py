"""Checks that a reader answers any text: with a program, or with an error that says where."""

from __future__ import annotations

import codecs
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread

from hypothesis import given
from hypothesis import strategies as st

from ...core.errors import FlybyError, PluginFault, SourceError
from ...core.program.program import Program
from ...core.source.patch.edits import difference
from ...core.source.reading import Reading
from ..hostile import SIGNS, hostile_texts, hostile_variants
from .subject import EXAMPLES, PROGRAM_EXAMPLES, Subject

LONGEST = 20.0
"""s of the processor that a text may be read for. In the languages that come with flyby the longest
takes .2 s, of a million signs."""
_SHOWN = 60


class HostilityChecks(Subject):
    """The reader survives any text, and takes the encodings that files come in."""

    @EXAMPLES
    @given(text=st.text() | st.text(SIGNS))
    def test_the_reader_survives_any_text(self, text: str) -> None:
        self.need("reader")
        for suffix in self.vendor.suffixes:
            self._read_or_refuse(text, f"hostile{suffix}")

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_the_reader_survives_damage(self, data: st.DataObject) -> None:
        self.need("reader", "writer")
        robot = self.vendor.robot(self.driven_robots()[0])
        for file, text in self.vendor.write(data.draw(self.programs(robot)), robot).items():
            at, cut = data.draw(st.integers(0, len(text))), data.draw(st.integers(0, 20))
            patch = data.draw(st.text(SIGNS, max_size=3))
            self._read_or_refuse(text[:at] + patch + text[at + cut :], file)

    def test_the_reader_survives_hostile_texts(self) -> None:
        self.need("reader")
        for text in hostile_texts():
            self._read_or_refuse(text, f"hostile{self.vendor.suffixes[0]}")

    def test_the_reader_survives_hostile_programs(self) -> None:
        self.need("reader", "writer")
        _, sources = self.sample()
        for file, text in sources.items():
            for variant in hostile_variants(text):
                self._read_or_refuse(variant, file)

    def test_files_keep_their_bytes(self) -> None:
        """Ends of line, byte-order marks and code pages are read, and nothing of them is lost."""
        self.need("reader", "writer")
        robot, sources = self.sample()
        plain = self.read_back(sources, robot)
        for name, encoded in self._encodings(dict(sources)).items():
            program = self.read_bytes(encoded, robot)
            assert difference(program, plain) is None, name
            if isinstance(program.reading, Reading):
                kept = [file.data for file in program.reading.files.values()]
                for data in encoded.values():
                    assert data in kept, f"{name}: the file's bytes are not kept"

    def _encodings(self, sources: dict[str, str]) -> dict[str, dict[str, bytes]]:
        """The same program in other bytes, by what is peculiar about them."""
        found = {"CR LF": {f: t.replace("\n", "\r\n").encode() for f, t in sources.items()}}
        for codec, mark in (
            ("utf-16-le", codecs.BOM_UTF16_LE),
            ("utf-16-be", codecs.BOM_UTF16_BE),
        ):
            found[codec] = {f: mark + text.encode(codec) for f, text in sources.items()}
        if self.comment_sign is None:
            return found
        for codec, words in (
            ("cp1252", b"Gr\xf6\xdfe \x80"),
            ("utf-8-sig", "Größe".encode()),
            ("gbk", b"\x81\x8d\xb3\xcc"),
        ):
            mark = codecs.BOM_UTF8 if codec == "utf-8-sig" else b""
            comment = self.comment_sign.encode() + b" " + words + b"\n"
            found[codec] = {f: mark + _after_first_line(t, comment) for f, t in sources.items()}
        return found

    def _read_or_refuse(self, text: str, file: str) -> None:
        try:
            with _at_most(LONGEST, f"{self.name}: {_shown(text)} is read for"):
                program = self.vendor.read(text, file)
        except PluginFault as error:
            raise AssertionError(f"{self.name}: {_shown(text)}: {error}") from error
        except SourceError as error:
            assert str(error)
            assert error.span is None or error.span.line >= 1
        except FlybyError as error:
            assert str(error)
        else:
            assert isinstance(program, Program)


@contextmanager
def _at_most(seconds: float, what: str) -> Iterator[None]:
    """Fail what takes more of the processor than this: a pattern that tries everything never ends.

    Where the system counts no time of processes, or elsewhere than in the main thread, nothing is
    bounded.
    """
    if not hasattr(signal, "setitimer") or current_thread() is not main_thread():
        yield
        return

    def stop(*_: object) -> None:
        raise AssertionError(
            f"{what} more than {seconds:g} s of the processor: bound the lengths of lines, and "
            "what patterns may try"
        )

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)


def _shown(text: str) -> str:
    said = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}… ({len(text)} signs)"
    return repr(said)


def _after_first_line(text: str, line: bytes) -> bytes:
    """The text's bytes with a line after the first, where every language takes a comment."""
    first, rest = text.encode().split(b"\n", 1)
    return first + b"\n" + line + rest
