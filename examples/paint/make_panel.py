"""Writes panel.stl: a bonnet-like panel of 1.0 m x 0.7 m, bent both ways, in millimetres."""

from pathlib import Path

import numpy as np
import trimesh

COLUMNS, ROWS = 21, 15


def panel() -> trimesh.Trimesh:
    """z falls off from the middle as on arcs of 2.0 m and 1.2 m radius."""
    x, y = np.meshgrid(np.linspace(-500, 500, COLUMNS), np.linspace(-350, 350, ROWS))
    z = -(x**2) / (2 * 2000) - y**2 / (2 * 1200)
    index = np.arange(ROWS * COLUMNS).reshape(ROWS, COLUMNS)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    faces = np.concatenate(
        [np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)]
    )
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    return trimesh.Trimesh(vertices, faces, process=False)


if __name__ == "__main__":
    panel().export(Path(__file__).with_name("panel.stl"))
