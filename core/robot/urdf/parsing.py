"""URDF files as yourdfpy reads them; what is none is refused by what it is."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...files.reading import read_bytes

XACRO = ".xacro"
MOST_BYTES = 20_000_000
_TEMPLATE = (b"${", b"$(", b"<xacro:include", b"<xacro:macro")


def parsed(path: Path) -> Any:
    """The robot of a file, as yourdfpy has it.

    Raises:
        InputError: it is no URDF; the message says what it is instead, where that is known.
    """
    import yourdfpy
    from lxml import etree

    data = read_bytes(path, MOST_BYTES)
    if b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        raise InputError(f"{path}: is not a URDF file: it declares a document type; remove that")
    if path.suffix.lower() == XACRO or any(mark in data for mark in _TEMPLATE):
        plain = path.name.partition(".")[0]
        raise InputError(
            f"{path}: is a template of xacro, whose values are yet to be filled in: write the URDF "
            f"by `xacro {path.name} > {plain}_plain.urdf`"
        )
    try:
        # What is no XML would be mended by guessing.
        root = etree.fromstring(data, etree.XMLParser(resolve_entities=False, no_network=True))
    except etree.XMLSyntaxError as error:
        raise InputError(f"{path}: is not a URDF file: {error}") from error
    if root.tag != "robot":
        raise InputError(f"{path}: is not a URDF file: it begins with <{root.tag}>, not <robot>")
    if root.find("link") is None:
        what = "an SRDF, which belongs to a URDF" if root.find("group") is not None else "none"
        raise InputError(f"{path}: is not a URDF file: it has no <link>, it is {what}")
    try:
        with np.errstate(all="ignore"):
            urdf = yourdfpy.URDF.load(
                io.BytesIO(data),
                build_scene_graph=False,
                load_meshes=False,
                mesh_dir=str(path.parent),
            )
    except Exception as error:  # the parser raises whatever its XML library does
        raise InputError(f"{path}: is not a URDF file: {error}") from error
    return urdf.robot
