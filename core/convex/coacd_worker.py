"""CoACD in a process of its own: it can be stopped, and takes nothing with it where it crashes.

Reads a mesh from standard input and writes parts to standard output, both as NumPy saves arrays.
"""

from __future__ import annotations

import io
import os
import sys

import numpy as np

THRESHOLD = 0.05
"""Concavity, as CoACD measures it of a mesh of size 2, at which a part is convex enough."""
MOST_PARTS = 24
SEARCH = {"mcts_iterations": 60, "mcts_nodes": 10, "preprocess_resolution": 30}
"""How far CoACD looks ahead for a cut, and cells across a mesh that is not closed: a seventh
of the time that its own settings take for a box without a lid, with as many parts."""
NAMES = ("points", "counts")
"""Corners (V, 3) of all parts one after the other, and how many each has."""


def main() -> None:
    """Split the mesh."""
    given = np.load(io.BytesIO(sys.stdin.buffer.read()), allow_pickle=False)
    out = os.dup(1)
    os.dup2(2, 1)  # What the library prints is none of the answer.
    import coacd

    coacd.set_log_level("error")
    mesh = coacd.Mesh(given["vertices"], given["faces"])
    parts = coacd.run_coacd(mesh, threshold=THRESHOLD, max_convex_hull=MOST_PARTS, seed=0, **SEARCH)
    corners = [np.asarray(vertices, dtype=float).reshape(-1, 3) for vertices, _ in parts]
    buffer = io.BytesIO()
    counts = np.array([len(one) for one in corners], dtype=np.int64)
    points = np.concatenate([np.zeros((0, 3)), *corners])
    np.savez(buffer, points=points, counts=counts)
    with os.fdopen(out, "wb") as answer:
        answer.write(buffer.getvalue())


if __name__ == "__main__":
    main()
