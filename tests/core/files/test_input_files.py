"""Files that are read cost no more than they may, and say so."""

from __future__ import annotations

import ast
import io
import os
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.cell.geometry import Mesh
from flyby.core.errors import InputError
from flyby.core.files import mesh_file
from flyby.core.files.arrays import read_npz
from flyby.core.files.mesh_file import read_scene
from flyby.core.files.reading import read_bytes, read_json, read_text, read_toml
from flyby.core.files.tables import TomlTable
from flyby.core.motion.command.trajectory import Trajectory
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.source.execution.answers_file import load_answers

DEEP = 100_000


def _saved(folder: Path, data: bytes, name: str = "file.toml") -> Path:
    path = folder / name
    path.write_bytes(data)
    return path


def test_no_more_is_read_than_may_be(tmp_path: Path) -> None:
    path = _saved(tmp_path, b"x" * 11)
    assert read_bytes(path, 11) == b"x" * 11
    with pytest.raises(InputError, match=r"file\.toml: is larger than 10 bytes"):
        read_bytes(path, 10)
    sparse = tmp_path / "sparse"
    with sparse.open("wb") as file:
        file.truncate(1 << 42)
    with pytest.raises(InputError, match="is larger than"):
        read_bytes(sparse, 1_000_000_000)
    assert read_bytes("/proc/self/status", 1_000_000).startswith(b"Name:")


def test_pipes_devices_and_folders_are_refused(tmp_path: Path) -> None:
    fifo, link = tmp_path / "fifo", tmp_path / "link"
    os.mkfifo(fifo)
    link.symlink_to("/dev/zero")
    for path in (fifo, link, Path("/dev/zero"), Path("/dev/null")):
        with pytest.raises(InputError, match="is no regular file but a pipe, a device"):
            read_bytes(path, 10)
    with pytest.raises(InputError, match="Is a directory"):
        read_bytes(tmp_path, 10)


@pytest.mark.parametrize("name", ["n" * 256, "n" * 5000, "a\0b", "absent", "\ud800"])
def test_names_that_stand_for_nothing_are_refused_shortly(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="cannot be read") as caught:
        read_bytes(tmp_path / name, 10)
    assert len(str(caught.value)) < 500


TOML = {
    "a = " + "[" * 900 + "]" * 900: "nested more than 30 deep",
    "a = " + "{b=" * 900 + "1" + "}" * 900: "nested more than 30 deep",
    "[" + "a." * 90 + "a]": "nested more than 30 deep",
    "a = " + "[" * DEEP: "nested more than 30 deep",
    f"a = {10**400}": "integer of more than 64 bits",
    f"a = {2**63}": "integer of more than 64 bits",
    "a = " + "9" * 5000: "integer of more than 64 bits",
    "a" + ".a" * 50_000 + " = 1": "more than 100 dots",
    "[" + "a." * 50_000 + "a]": "more than 100 dots",
    '"a"' + ' . "a"' * 50_000 + " = 1": "more than 100 dots",
    "x = { " + "a." * 50_000 + "a = 1 }": "more than 100 dots",
    "#" * 2_000_001: "larger than 2,000,000 bytes",
    "a = ": "is not TOML",
    "a = '\ud800'": "no UTF-8",
}


@pytest.mark.parametrize("text", TOML, ids=range(len(TOML)))
def test_hostile_toml_is_refused_by_every_reader(tmp_path: Path, text: str) -> None:
    path = _saved(tmp_path, text.encode("utf-8", "surrogatepass"))
    for read in (read_toml, load_answers, load_motion_model, TomlTable.read):
        with pytest.raises(InputError, match=TOML[text]) as caught:
            read(path)
        assert "file.toml" in str(caught.value)


def test_toml_with_dots_in_texts_is_read(tmp_path: Path) -> None:
    text = f"a = '{'.' * 90}'\n# {'.' * 500}\nb.c = 1.5\n"
    assert read_toml(_saved(tmp_path, text.encode())) == {"a": "." * 90, "b": {"c": 1.5}}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[" * DEEP, "nested more than 30 deep"),
        ("[" * 31 + "]" * 31, "nested more than 30 deep"),
        ('{"a":' * DEEP, "nested more than 30 deep"),
        ("9" * 5000, "integer of more than 64 bits"),
        (str(-(10**30)), "integer of more than 64 bits"),
        ("{", "is not JSON"),
    ],
)
def test_hostile_json_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_json(_saved(tmp_path, text.encode()))


def _npy(header: bytes, data: bytes = b"") -> bytes:
    padded = header + b" " * (-(len(header) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(padded)) + padded + data


@pytest.mark.parametrize(
    ("member", "message"),
    [
        (_npy(b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000,), }"), "is to"),
        (_npy(b"{'descr': '<f8', 'fortran_order': False, 'shape': (10, 10**20), }"), "damaged"),
        (_npy(b"{'descr': '|O', 'fortran_order': False, 'shape': (1,), }", b"\x80"), "not numbers"),
        (_npy(b"{'descr': '<U9', 'fortran_order': False, 'shape': (1,), }"), "not numbers"),
        (_npy(b"{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }"), "is to"),
        (_npy(b"[" * 60_000), "damaged"),
        (b"", "damaged"),
        (b"\x93NUMPY\x09\x00", "damaged"),
    ],
)
def test_arrays_that_claim_too_much_are_refused(
    tmp_path: Path, member: bytes, message: str
) -> None:
    path = tmp_path / "file.npz"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("t.npy", member)
    with pytest.raises(InputError, match=message):
        read_npz(path, ("t",), 1_000_000)
    with pytest.raises(InputError, match=r"file\.npz: not a saved trajectory"):
        Trajectory.load_npz(path)


def test_what_unpacks_to_too_much_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "file.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("t.npy", b"\0" * 5_000_000)
    assert path.stat().st_size < 10_000
    with pytest.raises(InputError, match="unpacks to 5,000,000 bytes; at most 1,000,000"):
        read_npz(path, ("t",), 1_000_000)


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cut=st.integers(0, 400), byte=st.integers(0, 255), place=st.integers(0, 400))
def test_damaged_archives_end_in_an_error_of_ours_or_in_numbers(
    tmp_path: Path, cut: int, byte: int, place: int
) -> None:
    buffer = io.BytesIO()
    np.savez(buffer, t=np.arange(5.0))
    data = bytearray(buffer.getvalue())
    data[place % len(data)] = byte
    path = _saved(tmp_path, bytes(data[: max(len(data) - cut, 0)]), "file.npz")
    try:
        read_npz(path, ("t",), 10_000)
    except InputError as error:
        assert "file.npz" in str(error)


def test_long_fields_of_a_trajectory_are_refused(tmp_path: Path) -> None:
    head = "t,q1,x,y,z,qw,qx,qy,qz,move\n"
    path = _saved(tmp_path, (head + "1" * 200_000 + ",0" * 9).encode(), "file.csv")
    with pytest.raises(InputError, match=r"file\.csv: not a readable trajectory: field larger"):
        Trajectory.load_csv(path)


def _stl(triangles: list[list[tuple[float, float, float]]]) -> bytes:
    rows = [struct.pack("<12fH", 0, 0, 0, *sum(t, ()), 0) for t in triangles]
    return b"\0" * 80 + struct.pack("<I", len(rows)) + b"".join(rows)


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("a.stl", _stl([[(0, 0, 0), (1, 1, 1), (2, 2, 2)]] * 4), "corners .* lie on a line"),
        ("a.stl", _stl([[(1, 1, 1)] * 3]), "corners .* lie on a line"),
        ("a.stl", _stl([[(0, 0, 0), (3e35, 0, 0), (0, 3e35, 0)]]), "at most 10000 m"),
        ("a.stl", _stl([[(float("nan"), 0, 0), (1, 0, 0), (0, 1, 0)]]), "not finite"),
        ("a.stl", b"\0" * 80 + struct.pack("<I", 4_000_000_000) + b"\0" * 100, "no triangles"),
        ("a.glb", b'glTF{"accessors": [{"count": 1000000000000}]}', "at most 50,000,000"),
        ("a.gltf", b'{"accessors": [{"count": ' + b"9" * 5000 + b"}]}", "at most 50,000,000"),
        ("a.off", b"OFF\n1000000000000 1000000000000 0\n0 0 0\n", "cannot be read as a mesh"),
        ("a.dae", b"<a>" * 100_000, "cannot be read as a mesh"),
        ("a.3mf", b"PK", "cannot be read as a mesh"),
        ("a.txt", b"", "is no mesh file by its name"),
    ],
)
def test_hostile_meshes_are_refused(tmp_path: Path, name: str, data: bytes, message: str) -> None:
    with pytest.raises(InputError, match=rf"{name}: .*{message}"):
        _ = Mesh(_saved(tmp_path, data, name), "m").vertices


def test_a_compressed_mesh_that_unpacks_to_too_much_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.3mf"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", b" " * 2_000_000)
    monkeypatch.setattr(mesh_file, "MOST_BYTES", 1_000_000)
    with pytest.raises(InputError, match="unpacks to 2,000,000 bytes"):
        read_scene(path)


def test_a_mesh_takes_no_files_of_other_folders(tmp_path: Path) -> None:
    text = '{"asset": {"version": "2.0"}, "buffers": [{"uri": "%s", "byteLength": 9}]}'
    for uri in ("../secret.bin", "/dev/zero"):
        path = _saved(tmp_path, (text % uri).encode(), "a.gltf")
        with pytest.raises(InputError, match="of its own folder alone"):
            read_scene(path)


def test_numbers_that_would_overflow_are_refused(tmp_path: Path) -> None:
    path = _saved(tmp_path, b"[elasticity]\nown_s2 = [1e300]")
    with pytest.raises(InputError, match=r"file\.toml: holds the number 1e\+300; at most 1e\+12"):
        load_motion_model(path)


@pytest.mark.parametrize(
    "text",
    [
        "[time]\nsmoothing_s = [" + "0.01, " * 5000 + "]",
        "[time]\nsmoothing_s = 1e9",
        "[time]\nramp_s = 1e6",
        "[limit]\njoint_acceleration_scale = [1e-300]",
        "[limit]\njoint_acceleration_scale = [" + "1, " * 5000 + "]",
    ],
)
def test_motion_models_that_would_take_for_ever_are_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(InputError, match=r"file\.toml: (time|limit)\..*(at most|from .* to)"):
        load_motion_model(_saved(tmp_path, text.encode()))


def test_a_number_beyond_all_quantities_is_refused(tmp_path: Path) -> None:
    table = TomlTable.read(_saved(tmp_path, b"a = 1e308\nb = [1e13]\nc = 1e12"))
    with pytest.raises(InputError, match=r"a: must lie within ±1e\+12"):
        table.number("a")
    with pytest.raises(InputError, match="b: must lie within"):
        table.numbers("b")
    assert table.number("c") == 1e12


def test_texts_that_are_not_utf8_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no UTF-8 text"):
        read_text(_saved(tmp_path, b"\xff"), 10)


def test_there_is_one_door_for_files() -> None:
    """What reads or writes files of users elsewhere would do so without the bounds."""
    root = Path(next(iter(flyby.__path__)))
    written = {"core/files/disk.py", "core/files/journal.py"}
    doors = {"core/files/reading.py", "core/files/archive.py", *written, "core/kernel_cache.py"}
    own = {
        "vendors/kuka/values/library.py",  # a file of this package
        "tasks/backup/finding.py",  # a vendor opens a backup, no file
        "tasks/files/texts.py",  # a temporary folder, read back at once
        "core/read_back.py",  # likewise
        "core/translation/hand_out.py",  # likewise
        "core/files/arrays.py",  # a member of what came in by the door
        "identification/experiment/design.py",
        "drawing/page/html.py",  # a file of this package
        "tasks/diff/state.py",  # bytes that came in by the door
        "tasks/pages/show.py",  # a browser
        "vendors/ur/record.py",  # a file of this package
        "vendors/ur/flyby_listen.py",  # run by the user, without this package
    }
    calls = {"read_text", "read_bytes", "write_text", "write_bytes", "open"}
    found = set()
    for room in ("cli", "core", "drawing", "identification", "problems", "tasks", "vendors"):
        for file in (root / room).rglob("*.py"):
            text = file.read_text("utf-8")
            if not any(f"{call}(" in text for call in calls):
                continue
            for node in ast.walk(ast.parse(text)):
                if not isinstance(node, ast.Call):
                    continue
                of_object = isinstance(node.func, ast.Attribute) and node.func.attr in calls
                if (of_object and ast.unparse(node.func) != "Image.open") or (
                    isinstance(node.func, ast.Name) and node.func.id == "open"
                ):
                    found.add(file.relative_to(root).as_posix())
    assert found - doors - own <= set()
