"""Compiled kernels find a place that can be written, and damaged ones are compiled anew."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numba
import pytest
from numba.core import caching, event

from flyby.core import kernel_cache

TEXT = """
from numba import njit

@njit(cache=True)
def doubled(x):
    return 2 * x
"""


@pytest.fixture
def places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A module of the package that cannot be written beside, without home and temporary folder.

    A file stands where each folder would; permissions do not bind root.
    """
    module = tmp_path / "package" / "fake.py"
    module.parent.mkdir()
    module.write_text(TEXT)
    (module.parent / "__pycache__").write_text("no folder")
    nowhere = tmp_path / "nowhere"
    nowhere.write_text("no folder")
    monkeypatch.setenv("HOME", str(nowhere))
    monkeypatch.setenv("XDG_CACHE_HOME", str(nowhere))
    monkeypatch.delenv("FLYBY_CACHE", raising=False)
    monkeypatch.setattr(tempfile, "tempdir", str(nowhere))
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    monkeypatch.setattr(numba.config, "CACHE_LOCATOR_CLASSES", "", raising=False)
    kernel_cache._say.cache_clear()
    return tmp_path


def kernel(places: Path, name: str = "flyby.fake") -> Any:
    """The kernel, as a process that begins loads it."""
    spec = importlib.util.spec_from_file_location(name, places / "package" / "fake.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.doubled


def compiled(places: Path) -> bool:
    """Whether it had to be compiled."""
    doubled = kernel(places)
    assert doubled(3) == 6
    return not doubled.stats.cache_hits


def test_without_any_place_kernels_are_compiled_and_it_is_said(
    places: Path, caplog: pytest.LogCaptureFixture
) -> None:
    assert compiled(places) and compiled(places)
    assert caplog.text.count("name one by FLYBY_CACHE") == 1
    with pytest.raises(RuntimeError, match="no locator"):
        kernel(places, "another.package")  # numba's own way with modules of others


@pytest.mark.parametrize("place", ["FLYBY_CACHE", "XDG_CACHE_HOME", "temporary", "beside"])
def test_a_place_that_can_be_written_is_found(
    places: Path, place: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if place == "temporary":
        monkeypatch.setattr(tempfile, "tempdir", str(places))
    elif place == "beside":
        (places / "package" / "__pycache__").unlink()
    else:
        monkeypatch.setenv(place, str(places / "cache"))
    assert compiled(places)
    assert not compiled(places)


def test_what_lies_beside_a_module_that_cannot_be_written_is_read(
    places: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    beside = places / "package" / "__pycache__"
    beside.unlink()
    assert compiled(places)
    refused = tempfile.TemporaryFile

    def read_only(*args: Any, **kwargs: Any) -> Any:
        if str(kwargs.get("dir")) == str(beside):
            raise PermissionError("read-only file system")
        return refused(*args, **kwargs)

    monkeypatch.setattr(tempfile, "TemporaryFile", read_only)
    monkeypatch.setenv("XDG_CACHE_HOME", str(places / "cache"))
    assert kernel(places)._cache.cache_path.startswith(str(places / "cache"))
    assert not compiled(places)


def test_a_named_folder_that_cannot_be_written_is_said(
    places: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("FLYBY_CACHE", str(places / "nowhere"))
    monkeypatch.setattr(tempfile, "tempdir", str(places))
    assert compiled(places) and not compiled(places)
    assert "FLYBY_CACHE=" in caplog.text and "cannot be written" in caplog.text


def test_temporary_folders_of_others_are_not_trusted(
    places: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(places))
    folder = places / f"flyby-{os.getuid()}"
    folder.mkdir()
    folder.chmod(0o777)
    assert compiled(places) and compiled(places)
    folder.chmod(0o700)
    assert compiled(places) and not compiled(places)


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", ["empty", "cut", "short", "flipped", "other"])
def test_a_damaged_cache_is_compiled_anew(
    places: Path, suffix: str, damage: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = places / "cache"
    monkeypatch.setenv("FLYBY_CACHE", str(cache))
    assert compiled(places) and not compiled(places)
    (file,) = cache.rglob(f"*.{suffix}")
    data = file.read_bytes()
    middle = len(data) // 2
    file.write_bytes(
        {
            "empty": b"",
            "cut": data[:middle],
            "short": data[:-1],
            "flipped": data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1 :],
            "other": b"\x80\x04]\x94.",
        }[damage]
    )
    assert compiled(places) or (suffix == "nbi" and damage in ("short", "flipped"))
    assert not compiled(places)


def test_a_full_disk_does_not_stop_a_kernel(
    places: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("FLYBY_CACHE", str(places / "cache"))

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(caching.IndexDataCacheFile, "_save_data", full)
    assert compiled(places)
    assert "No space left on device" in caplog.text


@pytest.mark.parametrize("name", ["flyby.fake", "another.package"])
@pytest.mark.parametrize("patience", [0.0, 1e3])
def test_compiling_that_takes_long_is_said_once(
    places: Path, name: str, patience: float, caplog: pytest.LogCaptureFixture
) -> None:
    (places / "package" / "__pycache__").unlink()
    with event.install_listener("numba:compile", kernel_cache.Announcer(patience)):
        for x in (3, 3.0):
            kernel(places, name)(x)
    said = name == "flyby.fake" and patience == 0.0
    assert caplog.text.count("kernels are compiled, which is done once") == said


@pytest.mark.parametrize("first", ["import numba", "import flyby", "import flyby.cli.main"])
def test_it_is_installed_however_the_package_is_imported(first: str) -> None:
    code = (
        f"{first}\nimport sys\n"
        "import flyby\n"
        "from flyby.core.robot.kinematics import chain_kernels\n"
        "found = [v for v in vars(chain_kernels).values() if hasattr(v, '_cache')]\n"
        "print({type(v._cache).__name__ for v in found})\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "{'KernelCache'}"


def test_numba_is_not_imported_for_nothing() -> None:
    code = "import sys, flyby.cli.main; print('numba' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
