"""The blend family: known members, order of contact, and the effect of β."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import polynomial as P

from flyby.core.errors import InputError
from flyby.core.motion.model.blend import TANGENT_ARC, Blend

SMOOTHSTEPS = {
    1: (0, 0, 3, -2),
    2: (0, 0, 0, 10, -15, 6),
    3: (0, 0, 0, 0, 35, -84, 70, -20),
}
BETAS = st.lists(st.floats(-2, 2), max_size=3).map(tuple)


def corner(blend, deflection, s, r=1.0):
    """The blend (S, 2) of a corner at 0 between legs r long at the zone's edge."""
    before = np.array([1.0, 0.0])
    after = np.array([np.cos(deflection), np.sin(deflection)])
    f, g = (P.polyval(s, row)[:, None] for row in blend.coefficients[1:3])
    return -r * before + r * before * f + r * after * g


@pytest.mark.parametrize("alpha", [(0, 1), *SMOOTHSTEPS.values()])
@settings(max_examples=20, deadline=None)
@given(deflection=st.floats(0.05, 3.0))
def test_members_without_beta_pass_the_same_apex(alpha, deflection) -> None:
    apex = corner(Blend(alpha=alpha), deflection, np.array([0.5]))[0]
    assert np.linalg.norm(apex) == pytest.approx(0.5 * np.sin(deflection / 2))


@pytest.mark.parametrize(
    ("beta", "k", "gain"),
    [
        # Constant acceleration; cubic and quintic steps of the velocity (quartic and sextic).
        ((), 1 / 2, (0, 0, 0.5)),
        ((-1,), 3 / 8, (0, 0, 0, 1, -0.5)),
        ((-1, -2, 2), 5 / 16, (0, 0, 0, 0, 2.5, -3, 1)),
    ],
)
def test_curves_with_a_stepped_velocity_are_members(beta, k, gain) -> None:
    """Of constant x₁' = 2 r d₀ to x₂' = 2 r d₁: −r d₀ + 2 r (d₀ (s − S) + d₁ S), S the gain."""
    blend, s, deflection = Blend(beta=beta), np.linspace(0, 1, 21), 1.1
    S = P.polyval(s, gain)[:, None]
    d0, d1 = np.array([1.0, 0.0]), np.array([np.cos(deflection), np.sin(deflection)])
    expected = -d0 + 2 * (d0 * (s[:, None] - S) + d1 * S)
    np.testing.assert_allclose(corner(blend, deflection, s), expected, atol=1e-14)
    apex = np.linalg.norm(corner(blend, deflection, np.array([0.5])))
    assert apex == pytest.approx(k * np.sin(deflection / 2))


def test_lloyd_and_hayward_blend_is_a_member() -> None:
    """x₁ + α (x₂ − x₁) − κ β 2τ (v₂ − v₁) on extrapolated legs, κ = 15/2 (IEEE ICRA 1991)."""
    s = np.linspace(0, 1, 33)
    alpha, bump = P.polyval(s, (0, 0, 0, 10, -15, 6)), P.polyval(s, (0, 0, 0, -1, 3, -3, 1))
    d0, d1 = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    # Legs of length r = v τ on either side; x₁ runs on beyond the corner, x₂ begins before it.
    x1, x2 = (2 * s - 1)[:, None] * d0, (2 * s - 1)[:, None] * d1
    expected = x1 + alpha[:, None] * (x2 - x1) + 7.5 * bump[:, None] * 2 * (d1 - d0) * -1
    # Coefficient of d₁ is s α' + β with α' = s: (2 s − 1) α − 2 κ b − s².
    quotient, rest = P.polydiv(
        P.polysub(
            P.polysub(
                P.polymul((-1, 2), (0, 0, 0, 10, -15, 6)),
                15.0 * np.array([0, 0, 0, -1, 3, -3, 1]),
            ),
            (0, 0, 1),
        ),
        (0, 0, 1, -2, 1),
    )
    np.testing.assert_allclose(rest, 0.0, atol=1e-12)
    np.testing.assert_allclose(
        corner(Blend(beta=tuple(quotient)), np.pi / 2, s), expected, atol=1e-12
    )


@pytest.mark.parametrize(("order", "alpha"), SMOOTHSTEPS.items())
def test_smoothsteps_meet_the_legs_to_their_order(order, alpha) -> None:
    blend = Blend(alpha=alpha)
    f, g = blend.coefficients[1], blend.coefficients[2]
    for k in range(2, order + 1):
        for end in (0.0, 1.0):
            assert P.polyval(end, P.polyder(f, k)) == pytest.approx(0.0, abs=1e-9)
            assert P.polyval(end, P.polyder(g, k)) == pytest.approx(0.0, abs=1e-9)
    assert abs(P.polyval(0.0, P.polyder(f, order + 1))) > 1.0


@settings(max_examples=40, deadline=None)
@given(alpha=st.sampled_from([(0, 1), *SMOOTHSTEPS.values()]), beta=BETAS)
def test_the_blend_touches_both_legs(alpha, beta) -> None:
    blend = Blend(alpha=alpha, beta=beta)
    f, g = blend.coefficients[1], blend.coefficients[2]
    assert (P.polyval(0.0, f), P.polyval(0.0, g)) == pytest.approx((0, 0))
    assert (P.polyval(1.0, f), P.polyval(1.0, g)) == pytest.approx((1, 1))
    assert P.polyval(0.0, P.polyder(f)) == pytest.approx(blend.entry_slope)
    assert P.polyval(0.0, P.polyder(g)) == pytest.approx(0)
    assert P.polyval(1.0, P.polyder(f)) == pytest.approx(0, abs=1e-9)
    assert P.polyval(1.0, P.polyder(g)) == pytest.approx(blend.exit_slope)


@settings(max_examples=30, deadline=None)
@given(beta=BETAS, deflection=st.floats(0.1, 3.0))
def test_beta_moves_the_apex_along_the_bisector(beta, deflection) -> None:
    apex = corner(Blend(beta=beta), deflection, np.array([0.5]))[0]
    plain = corner(Blend(), deflection, np.array([0.5]))[0]
    bump = sum(b * 0.5**i for i, b in enumerate(beta)) / 16
    np.testing.assert_allclose(apex, plain * (1 + 4 * bump), atol=1e-12)


@settings(max_examples=20, deadline=None)
@given(
    alpha=st.sampled_from([(0, 1), (0, 0, 3, -2), (0, 0.5, 0.25, 0.15, 0.1)]),
    beta=BETAS,
    seed=st.integers(0, 1000),
)
def test_the_reverse_of_the_coefficients_is_the_gradient(alpha, beta, seed) -> None:
    blend = Blend(alpha=alpha, beta=beta)
    weights = np.random.default_rng(seed).normal(size=blend.coefficients.shape)
    if not blend.meets_curvature:
        weights[3:] = 0.0  # closing the gap between curved legs then depends on neither
    by_alpha, by_beta = blend.pull_coefficients(weights)

    def total(a, b):
        table = Blend(alpha=tuple(a), beta=tuple(b)).coefficients
        return np.sum(weights * table)

    h = 1e-6
    for i in range(len(beta)):
        step = h * np.eye(len(beta))[i]
        numeric = total(alpha, beta + step) - total(alpha, beta - step)
        assert by_beta[i] == pytest.approx(numeric / (2 * h), rel=1e-6, abs=1e-6)
    # α keeps running from 0 to 1: coefficients change against each other. Where its slopes vanish
    # at both ends they cannot without the blend changing its kind.
    for i in range(2, 2 if blend.meets_curvature else len(alpha) - 1):
        step = np.zeros(len(alpha))
        step[i], step[i + 1] = h, -h
        numeric = total(alpha + step, beta) - total(alpha - step, beta)
        exact = by_alpha[i] - by_alpha[i + 1]
        assert exact == pytest.approx(numeric / (2 * h), rel=1e-6, abs=1e-6)


@pytest.mark.parametrize(
    ("broken", "word"),
    [
        ({"alpha": ()}, "from 0 to 1"),
        ({"alpha": (0.1, 0.9)}, "from 0 to 1"),
        ({"alpha": (0, 0.5)}, "from 0 to 1"),
        ({"alpha": (0, -1.5, 2.5)}, "backwards"),
        ({"alpha": (0, float("nan"))}, "finite"),
        ({"beta": (float("inf"),)}, "finite"),
        ({"kind": "spline"}, "spline"),
    ],
)
def test_what_is_no_blend_is_refused(broken, word) -> None:
    with pytest.raises(InputError, match=word):
        Blend(**broken)


def test_the_tangent_arc_is_a_kind_of_its_own() -> None:
    assert TANGENT_ARC.kind == "arc"
