"""The viewer in the package is what `viewer/` builds: by the digest in its first line, without
Node."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

from flyby.drawing.page.html import viewer

VIEWER = Path(__file__).parents[3] / "viewer"


def text(path: Path) -> str:
    return path.read_bytes().decode("utf-8").replace("\r\n", "\n")


def digest() -> str:
    inputs = ["build.mjs", "package.json", "package-lock.json"]
    inputs += [f"src/{path.name}" for path in (VIEWER / "src").iterdir()]
    found = hashlib.sha256()
    for name in sorted(inputs):
        found.update(f"{name}\0{text(VIEWER / name)}\0".encode())
    return found.hexdigest()


def test_the_viewer_is_not_stale() -> None:
    said = re.match(r"/\*! flyby viewer, built from viewer/ sha256:([0-9a-f]{64})\n", viewer())
    assert said is not None
    assert said[1] == digest(), "viewer/ has changed: cd viewer && npm ci && npm run build"


def test_it_carries_the_licences_of_what_is_in_it() -> None:
    head = viewer().split("*/", 1)[0]
    wanted = json.loads(text(VIEWER / "package.json"))["dependencies"]
    assert set(wanted) == {"three", "uplot"}
    for name, version in wanted.items():
        assert f"{name} {version}" in head
        assert re.fullmatch(r"\d+\.\d+\.\d+", version), "versions are pinned"
    assert head.count("Permission is hereby granted, free of charge") == len(wanted)


def test_nothing_in_it_ends_its_script() -> None:
    assert "</script" not in viewer().lower()
    assert "<!--" not in viewer()


def test_it_asks_for_no_other_place() -> None:
    """Addresses in it are names of XML and in licences and comments, never fetched."""
    script = viewer().split("*/", 1)[1]
    assert "sourceMappingURL" not in script
    assert not re.search(r"\bimport\(", script)
