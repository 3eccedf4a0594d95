"""Archives are unpacked where nothing leaves the folder and nothing grows without bound."""

from __future__ import annotations

import io
import stat
import zipfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.files import archive
from flyby.core.files.archive import is_archive, unpack


def zipped(files: dict[str, bytes]) -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as made:
        for name, content in files.items():
            made.writestr(name, content)
    return data.getvalue()


@pytest.fixture
def saved(tmp_path: Path):
    def save(data: bytes, name: str = "station.zip") -> Path:
        path = tmp_path / name
        path.write_bytes(data)
        return path

    return save


def test_files_come_out_as_they_went_in(saved) -> None:
    files = {"a/b.mod": b"MODULE", "c.txt": b"", "d\\e.mod": b"from Windows"}
    folder, notes = unpack(saved(zipped(files)))
    assert notes == ()
    assert folder.name == "station"
    found = {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*.*")}
    assert found == {name.replace("\\", "/"): data for name, data in files.items()}


@pytest.mark.parametrize("name", ["../out.mod", "/etc/out", "a/../../out", "..\\out", "C:\\x"])
def test_nothing_leaves_the_folder(saved, name: str) -> None:
    path = saved(zipped({"good.mod": b"", name: b"evil"}))
    with pytest.raises(InputError, match=r"station\.zip: its file .* outside of the folder"):
        unpack(path)


def test_links_are_refused(saved) -> None:
    info = zipfile.ZipInfo("link")
    info.external_attr = (stat.S_IFLNK | 0o777) << 16
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as made:
        made.writestr(info, "/etc/passwd")
    with pytest.raises(InputError, match="'link' is a link"):
        unpack(saved(data.getvalue()))


def test_encrypted_archives_are_refused(saved) -> None:
    data = bytearray(zipped({"a.mod": b"x" * 50}))
    data[6] |= 1  # in the file's own head
    data[data.index(b"PK\x01\x02") + 8] |= 1  # and in the directory
    with pytest.raises(InputError, match="is encrypted: unpack it with its password"):
        unpack(saved(bytes(data)))


def test_bombs_are_refused(saved, monkeypatch: pytest.MonkeyPatch) -> None:
    path = saved(zipped({"a": b"0" * 3_000_000}))
    monkeypatch.setattr(archive, "MOST_BYTES", 1_000_000)
    with pytest.raises(InputError, match=r"unpacks to 3,000,000 bytes; at most 1,000,000"):
        unpack(path)
    monkeypatch.setattr(archive, "MOST_FILES", 1)
    with pytest.raises(InputError, match="holds 2 files; at most 1"):
        unpack(saved(zipped({"a": b"", "b": b""})))


def test_a_file_that_states_less_than_it_holds_writes_no_more(saved) -> None:
    data = bytearray(zipped({"a": b"0" * 100_000}))
    at = data.index(b"PK\x01\x02")
    data[at + 24 : at + 28] = (10).to_bytes(4, "little")
    folder, notes = unpack(saved(bytes(data)))
    assert "1 file cannot be unpacked: a" in str(notes[0])
    assert list(folder.iterdir()) == []


def test_of_a_damaged_file_the_others_are_unpacked(saved) -> None:
    data = bytearray(zipped({"bad.mod": bytes(range(256)) * 20, "good.mod": b"MODULE"}))
    data[60:80] = b"?" * 20
    folder, notes = unpack(saved(bytes(data)))
    assert "1 file cannot be unpacked: bad.mod" in str(notes[0])
    assert [p.name for p in folder.iterdir()] == ["good.mod"]


def test_what_is_cut_short_says_so(saved) -> None:
    data = zipped({"a.mod": b"x" * 5000, "b.mod": b"y"})
    with pytest.raises(InputError, match="is cut short"):
        unpack(saved(data[: len(data) // 2]))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.data())
def test_damage_never_crashes(saved, data: st.DataObject) -> None:
    good = zipped({"a.mod": b"MODULE a\nENDMODULE", "b/c.mod": b"x" * 300})
    at = data.draw(st.integers(0, len(good) - 1))
    length = data.draw(st.integers(0, 20))
    damaged = good[:at] + data.draw(st.binary(max_size=20)) + good[at + length :]
    path = saved(damaged)
    if not is_archive(path):
        return
    try:
        folder, _ = unpack(path)
    except InputError:
        return
    assert all(p.resolve().is_relative_to(folder.resolve()) for p in folder.rglob("*"))


def test_what_is_no_archive_is_told_by_how_it_begins(saved, tmp_path: Path) -> None:
    assert is_archive(saved(zipped({"a": b""}), "backup.rspag"))
    assert not is_archive(saved(b"MODULE a", "a.zip"))
    assert not is_archive(tmp_path)
