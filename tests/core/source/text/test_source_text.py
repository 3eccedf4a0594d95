"""Files as text and back, byte for byte; places in texts."""

from __future__ import annotations

import codecs
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError, SourceError
from flyby.core.source.text import files as module
from flyby.core.source.text.files import SourceFile, SourceText, decode, read_source, wide_file

LINES = st.text(st.sampled_from("a;\n\r\tß"), max_size=40)
MARKS = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


@given(
    st.binary(max_size=60)
    | st.text().map(lambda t: codecs.BOM_UTF8 + t.encode("utf-8"))
    | st.text().map(lambda t: codecs.BOM_UTF16_LE + t.encode("utf-16-le"))
    | st.text().map(lambda t: codecs.BOM_UTF16_BE + t.encode("utf-16-be"))
)
def test_bytes_come_back(data: bytes) -> None:
    try:
        text, codec = decode(data, "a.src")
    except SourceError as error:
        assert data.startswith(MARKS)
        assert "begins as UTF-16 does" in str(error)
        return
    assert SourceFile("a.src", text, codec).data == data
    note = wide_file(SourceFile("a.src", text, codec))
    assert (note is not None) == data.startswith(MARKS)


@given(st.text())
def test_texts_are_found_again(text: str) -> None:
    data = text.encode("utf-8")
    if not data.startswith((codecs.BOM_UTF8, *MARKS)):
        assert decode(data, "a") == (text, "utf-8")
    assert decode(codecs.BOM_UTF8 + data, "a") == (text, "utf-8-sig")
    assert decode(text, "a") == (text, "utf-8")


def test_code_pages_are_recognised() -> None:
    assert decode("Größe €".encode("cp1252"), "a") == ("Größe €", "cp1252")
    assert decode(b"\x81\x8d", "a") == ("\x81\x8d", "latin-1")


@pytest.mark.parametrize("codec", ["cp1252", "latin-1", "utf-8"])
def test_what_a_codec_has_not_is_refused(codec: str) -> None:
    with pytest.raises(InputError, match=rf"a\.mod: .*{codec}"):
        _ = SourceFile("a.mod", "ok \ud800 程", codec).data


def test_files_are_read_whole(tmp_path: Path) -> None:
    path = tmp_path / "a.mod"
    path.write_bytes(b"one\r\ntwo\rthree\n\x00")
    assert read_source(path) == SourceFile(str(path), "one\r\ntwo\rthree\n\x00")


def test_what_cannot_be_read_is_said_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for path in (tmp_path / "absent.mod", tmp_path, tmp_path / "a\0b"):
        with pytest.raises(InputError, match="cannot be read"):
            read_source(path)
    monkeypatch.setattr(module, "LARGEST_FILE", 3)
    (tmp_path / "long.mod").write_text("four")
    with pytest.raises(InputError, match="larger than 3 bytes"):
        read_source(tmp_path / "long.mod")


@pytest.mark.parametrize("end", ["\n", "\r", "\r\n"])
def test_files_of_nothing_but_lines_are_refused(tmp_path: Path, end: str) -> None:
    path = tmp_path / "lines.mod"
    path.write_bytes(end.encode() * module.MOST_LINES)
    assert len(read_source(path).text) == len(end) * module.MOST_LINES
    path.write_bytes(end.encode() * (module.MOST_LINES + 1))
    with pytest.raises(InputError, match="more than 500,000 lines"):
        read_source(path)


@given(LINES, st.lists(st.integers(0, 40), min_size=1, max_size=10))
def test_lines_and_columns_count_as_an_editor_does(text: str, offsets: list[int]) -> None:
    source = SourceText(text, "a.src")
    for offset in offsets:
        start = min(offset, len(text))
        before = re.split("\r\n|\r|\n", text[:start])
        if text[start - 1 : start] == "\r" and text[start : start + 1] == "\n":
            continue  # inside an end of line
        span = source.span(start, len(text))
        assert (span.line, span.column) == (len(before), len(before[-1]) + 1)
        assert (span.start, span.end, span.file) == (start, len(text), "a.src")


def test_errors_carry_their_place() -> None:
    error = SourceText("ab\ncd", "a.src").error("no such name", 4)
    assert str(error) == "a.src:2:2: no such name"
    assert error.span is not None and (error.span.start, error.span.end) == (4, 4)
