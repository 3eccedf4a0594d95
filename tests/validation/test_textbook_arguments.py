"""Wrong arguments of the textbook problems are refused by name."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from flyby.core.errors import InputError
from flyby.validation.textbook import MAZE, DoubleIntegrator, PointMass, barrier_path, minimum_time

PICTURES = Path(__file__).parents[2] / "docs" / "pictures"


@pytest.mark.parametrize("nodes", [1, 0, 2.5, True, "9"])
def test_wrong_numbers_of_nodes_are_refused(nodes: object) -> None:
    with pytest.raises(InputError, match="nodes"):
        DoubleIntegrator(nodes)
    with pytest.raises(InputError, match="nodes"):
        PointMass(MAZE, nodes)


@pytest.mark.parametrize("force", [0, -1.0, float("nan"), float("inf")])
def test_forces_are_above_zero(force: float) -> None:
    for refused in (
        lambda: DoubleIntegrator(5, force=force),
        lambda: PointMass(MAZE, 5, force=force),
        lambda: minimum_time(4, 1, force),
    ):
        with pytest.raises(InputError, match="force"):
            refused()


def test_other_wrong_arguments_are_refused() -> None:
    with pytest.raises(InputError, match="start"):
        DoubleIntegrator(5, start=(float("nan"), 0.0))
    for corners in ([], [(0.0, 0.0)], [1.0, 2.0], [(0.0, 0.0, 0.0), (1.0, 1.0, 1.0)]):
        with pytest.raises(InputError, match="corners"):
            PointMass(MAZE, 5).through(corners)
    with pytest.raises(InputError, match="weights"):
        barrier_path([-1.0])


@pytest.mark.parametrize("name", ["cubic", "double_integrator", "point_mass"])
def test_examples_tell_how_they_are_run(name: str) -> None:
    script = PICTURES / f"plot_{name}.py"
    found = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False)
    assert found.returncode != 0
    assert f"usage: python docs/pictures/plot_{name}.py" in found.stderr
