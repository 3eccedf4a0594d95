"""A plugin for another vendor, to begin with."""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path

from ...core.errors import InputError
from ...core.files.reading import MOST_TOML_BYTES, read_text
from ...core.files.writing import write_files
from ...core.hookspec import API
from ...core.registry import installed
from ...core.vendor import NAME

SKELETON = Path(__file__).parents[2] / "testing" / "skeleton"
_PLACES = {
    "plugin.py": "src/@module@/plugin.py",
    "language.py": "src/@module@/language.py",
    "arm-1.toml": "src/@module@/data/robots/arm-1.toml",
    "motion.toml": "src/@module@/data/motion.toml",
    "test_conformance.py": "tests/test_conformance.py",
    "golden.toml": "tests/golden.toml",
}
"""Where the files of the skeleton go; the others stand beside the sources."""


def new_vendor(name: str, folder: str | Path | None = None) -> tuple[Path, ...]:
    """Write a plugin for a vendor: one made-up arm, a small language, and its tests.

    Args:
        name: of the vendor, in lower case, as its robots' names begin.
        folder: what to make; None for ``flyby-NAME`` here.

    Returns:
        The files.

    Raises:
        InputError: the name is none or taken, or the folder is not empty.
    """
    if not (NAME.fullmatch(name) and name.replace("-", "_").isidentifier()):
        raise InputError(
            f"a vendor is called by lower-case letters, digits and '-', a letter first, not "
            f"{name!r}"
        )
    if name in installed().vendors:
        raise InputError(f"a vendor called {name!r} is installed already: choose another name")
    place = Path(f"flyby-{name}" if folder is None else folder)
    if place.exists() and (not place.is_dir() or any(place.iterdir())):
        raise InputError(f"{place}: exists, and is no empty folder: name another one")
    module = f"flyby_{name.replace('-', '_')}"
    words = {
        "@name@": name,
        "@Name@": name.replace("-", " ").title().replace(" ", ""),
        "@NAME@": name.upper(),
        "@module@": module,
        "@api@": str(API),
        "@version@": version("flyby"),
    }
    made: dict[Path, bytes] = {}
    for source in sorted(SKELETON.glob("*.txt")):
        plain = source.name.removesuffix(".txt")
        target = place / _said(_PLACES.get(plain, plain), words)
        made[target] = _said(read_text(source, MOST_TOML_BYTES), words).encode()
    made[place / "src" / module / "__init__.py"] = f'"""{name.upper()} for flyby."""\n'.encode()
    write_files(made, place)
    return tuple(made)


def _said(text: str, words: dict[str, str]) -> str:
    for mark, word in words.items():
        text = text.replace(mark, word)
    return text
