"""Zip archives of users, unpacked where nothing leaves the folder and nothing grows without bound.

What would be written outside of the folder, links and encrypted files are refused, and so is an
archive that states more files or bytes than a station has. Of a single file that is damaged the
others are unpacked all the same.
"""

from __future__ import annotations

import atexit
import io
import re
import shutil
import stat
import tempfile
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from ..display import counted
from ..errors import InputError, Note
from .reading import check_unpacked, read_bytes

MOST_BYTES = 1_000_000_000
"""Packed or unpacked. The largest backups seen have some 100 million, most of them licences."""
MOST_FILES = 100_000
_BEGINS = b"PK\x03\x04"
_ENCRYPTED = 0x1
_DRIVE = re.compile(r"[A-Za-z]:")


def is_archive(path: Path) -> bool:
    """Whether a file is a zip archive, by how it begins."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(len(_BEGINS)) == _BEGINS


_unpacked_here: dict[Path, Path] = {}


def named_as_packed(text: str) -> str:
    """A text with the archives' own names for what this process has unpacked."""
    for folder, path in _unpacked_here.items():
        text = text.replace(str(folder), str(path))
    return text


def unpack(path: Path) -> tuple[Path, tuple[Note, ...]]:
    """Unpack an archive into a folder that is removed when the process ends.

    Returns:
        The folder, which is called as the archive without its suffix, and what of it was left out.

    Raises:
        InputError: it is no archive, is cut short, grows beyond bounds, is encrypted, or holds
            links or names that lead out of the folder.
    """
    data = read_bytes(path, MOST_BYTES)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            files = list(_files(path, archive))
            check_unpacked(path, [info for info, _ in files], MOST_BYTES)
            above = Path(tempfile.mkdtemp(prefix="flyby-"))
            atexit.register(shutil.rmtree, above, ignore_errors=True)
            folder = above / (path.stem or "archive")
            folder.mkdir()
            _unpacked_here[folder] = path
            return folder, tuple(_unpacked(path, archive, files, folder))
    except (zipfile.BadZipFile, ValueError) as error:
        raise InputError(
            f"{path}: is no zip archive, or is cut short ({error}): copy it anew from where it "
            "was made"
        ) from None


def _files(path: Path, archive: zipfile.ZipFile) -> Iterator[tuple[zipfile.ZipInfo, PurePosixPath]]:
    """Its files, each with its place below the folder.

    Raises:
        InputError: see `unpack`.
    """
    infos = archive.infolist()
    if len(infos) > MOST_FILES:
        raise InputError(f"{path}: holds {len(infos):,} files; at most {MOST_FILES:,} are read")
    for info in infos:
        name = info.filename.replace("\\", "/")
        place = PurePosixPath(name)
        if place.is_absolute() or ".." in place.parts or _DRIVE.match(name):
            raise InputError(
                f"{path}: its file {name!r} would be written outside of the folder that it is "
                "unpacked to: no controller writes such an archive"
            )
        if stat.S_ISLNK(info.external_attr >> 16):
            raise InputError(
                f"{path}: its file {name!r} is a link: unpack it yourself where you trust it, and "
                "name the folder"
            )
        if info.flag_bits & _ENCRYPTED:
            raise InputError(
                f"{path}: is encrypted: unpack it with its password, and name the folder"
            )
        if not name.endswith("/") and place.parts:
            yield info, place


def _unpacked(
    path: Path,
    archive: zipfile.ZipFile,
    files: list[tuple[zipfile.ZipInfo, PurePosixPath]],
    folder: Path,
) -> Iterator[Note]:
    """Write the files; those that cannot be are said."""
    lost: list[str] = []
    for info, place in files:
        target = folder / place
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            with archive.open(info) as source, target.open("xb") as file:
                shutil.copyfileobj(source, file)
        except FileExistsError:
            continue  # a second version of a file: the first one counts
        except (OSError, ValueError, zipfile.BadZipFile, zlib.error, NotImplementedError) as error:
            target.unlink(missing_ok=True) if target.is_file() else None
            lost.append(f"{place} ({getattr(error, 'strerror', None) or error})")
    if lost:
        shown = ", ".join(lost[:3]) + ("" if len(lost) <= 3 else ", …")
        yield Note(f"{path.name}: {counted(lost, 'file')} cannot be unpacked: {shown}")
