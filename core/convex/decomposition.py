"""Approximate convex parts of a mesh by CoACD (Wei et al. 2022), kept in the user's cache.

Nothing is proven of them: `cover` makes parts of them that enclose the mesh, whatever they are.
"""

from __future__ import annotations

import contextlib
import io
import os
import subprocess
import sys
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..errors import FlybyError
from ..files.arrays import read_npz
from ..files.writing import write_files
from .coacd_worker import MOST_PARTS, NAMES, SEARCH, THRESHOLD

REMEDY = "pip install 'flyby[shapes]'"
VARIABLE = "FLYBY_CACHE"
"""Environment variable of a folder for what is kept between runs."""
MOST_TRIANGLES = 200_000
LONGEST = 60.0
"""s that CoACD may take."""
_LATE = (
    f"CoACD does not split it into convex parts within {LONGEST:.0f} s: make it coarser, or save "
    "it as convex solids"
)
_MOST_BYTES = 50_000_000


class NotSplitError(Exception):
    """Why a mesh cannot be split, and what helps."""


def approximate_parts(vertices: FloatArray, faces: NDArray[np.int64]) -> list[FloatArray]:
    """Corners (V, 3) of convex parts that fill a mesh about.

    Args:
        vertices: (V, 3).
        faces: (F, 3).

    Raises:
        NotSplitError: the library is not installed, fails, or takes too long.
    """
    try:
        library = version("coacd")
    except PackageNotFoundError:
        raise NotSplitError(f"{REMEDY} adds what splits it into convex parts") from None
    if len(faces) > MOST_TRIANGLES:
        raise NotSplitError(
            f"its {len(faces):,} triangles are too many to split it into convex parts (at most "
            f"{MOST_TRIANGLES:,}): make it coarser"
        )
    settings = f"{library} {THRESHOLD} {MOST_PARTS} {SEARCH} {LONGEST}".encode()
    content = np.ascontiguousarray(vertices).tobytes() + np.ascontiguousarray(faces).tobytes()
    file = cache_folder() / f"{sha256(settings + content).hexdigest()}.npz"
    with contextlib.suppress(FlybyError, OSError):
        return _parts(read_npz(file, NAMES, _MOST_BYTES))
    given_up = file.with_suffix(".late")
    if given_up.exists():
        raise NotSplitError(_LATE)
    try:
        answer = _asked(vertices, faces)
    except subprocess.TimeoutExpired:
        with contextlib.suppress(FlybyError, OSError):
            write_files({given_up: _LATE.encode()}, file.parent)
        raise NotSplitError(_LATE) from None
    try:
        with contextlib.suppress(FlybyError, OSError):
            write_files({file: answer}, file.parent)
            return _parts(read_npz(file, NAMES, _MOST_BYTES))
        with TemporaryDirectory() as folder:
            made = Path(folder) / file.name
            write_files({made: answer})
            return _parts(read_npz(made, NAMES, _MOST_BYTES))
    except (FlybyError, OSError) as error:
        raise NotSplitError(f"CoACD cannot split it: {error}") from None


def cache_folder() -> Path:
    """Where parts are kept between runs, by the content of their meshes."""
    named = os.environ.get(VARIABLE)
    if named:
        return Path(named) / "convex"
    from platformdirs import user_cache_path

    return user_cache_path("flyby", appauthor=False) / "convex"


def _asked(vertices: FloatArray, faces: NDArray[np.int64]) -> bytes:
    question = io.BytesIO()
    np.savez(question, vertices=vertices, faces=faces)
    command = [sys.executable, "-m", f"{__package__}.coacd_worker"]
    try:
        done = subprocess.run(
            command, input=question.getvalue(), capture_output=True, timeout=LONGEST, check=False
        )
    except OSError as error:
        raise NotSplitError(f"CoACD cannot be started: {error}") from None
    if done.returncode != 0:
        last = done.stderr.decode("utf-8", "replace").strip().splitlines()[-1:] or ["it crashed"]
        raise NotSplitError(f"CoACD cannot split it into convex parts: {last[0][:200]}")
    return done.stdout


def _parts(held: dict[str, NDArray[Any]]) -> list[FloatArray]:
    """The parts out of arrays of `NAMES`; none of what is damaged."""
    points, counts = (held[name] for name in NAMES)
    fits = points.ndim == 2 and points.shape[1] == 3 and counts.ndim == 1
    if not fits or counts.min(initial=0) < 0 or counts.sum() != len(points):
        raise FlybyError("the arrays of parts do not fit each other")
    if not np.isfinite(points).all():
        raise FlybyError("corners of parts are not finite")
    return np.split(points.astype(float), np.cumsum(counts.astype(np.int64))[:-1])
