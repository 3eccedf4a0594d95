"""Stated trajectory problems: derivatives, and the published optima."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.sqp import check_derivatives, solve
from flyby.validation.trajectories.cops import COPS
from flyby.validation.trajectories.mechanics import MECHANICS, cart_pole, two_link_arm

ALL = {**COPS, **MECHANICS}


@pytest.mark.parametrize("name", ALL)
def test_derivatives_are_right(name: str) -> None:
    stated = ALL[name](7)
    nlp = stated.problem.nlp()
    aside = stated.start + 1e-2 * np.cos(np.arange(nlp.n))
    assert check_derivatives(nlp, aside, tolerance=1e-4).passed


@pytest.mark.parametrize("name", [name for name in COPS if name != "hang-glider"])
def test_published_optima_are_reached(name: str) -> None:
    stated = COPS[name](101)
    result = solve(stated.problem.nlp(), stated.start)
    assert result.success
    assert result.objective == pytest.approx(stated.optimum, rel=1e-3)


def test_the_glider_needs_a_fine_grid() -> None:
    """Coarse ones fly further than physics would let it; the optimum falls to the published one."""
    coarse, fine = (COPS["hang-glider"](nodes) for nodes in (41, 101))
    ends = [solve(s.problem.nlp(), s.start) for s in (coarse, fine)]
    assert ends[0].objective < ends[1].objective < fine.optimum
    assert ends[1].method == "interior_point"  # whose multipliers do not run away


def test_kellys_cart_pole() -> None:
    """The effort that Kelly's figure shows is 58.8 N² s."""
    stated = cart_pole(31)
    result = solve(stated.problem.nlp(), stated.start)
    assert result.success
    assert result.objective == pytest.approx(58.81, abs=0.05)


@pytest.mark.parametrize("name", MECHANICS)
def test_machines_move(name: str) -> None:
    stated = MECHANICS[name](31)
    assert solve(stated.problem.nlp(), stated.start).success


def test_steps_that_creep_are_left_to_the_interior_point() -> None:
    """Sequential quadratic programming alone takes hundreds of steps of equal size here."""
    stated = two_link_arm(21)
    result = solve(stated.problem.nlp(), stated.start, method="sqp")
    assert result.success
    assert result.method == "sqp and interior_point"
    assert result.iterations < 150
