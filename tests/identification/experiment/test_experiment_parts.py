"""Stars, information, and the choice among runs: what must hold of any."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.target import JointTarget
from flyby.core.program.tool import FLANGE
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.experiment import information
from flyby.identification.experiment.information import SCATTER, Informer, nats
from flyby.identification.experiment.kinds import Kind
from flyby.identification.experiment.plan import (
    CandidateRun,
    Plan,
    PlannedCorner,
    usual_radii,
)
from flyby.identification.experiment.selection import Option, RunChoice
from flyby.identification.experiment.star import Leg, Star
from flyby.testing.strategies import regular_configurations

from .designs import SMALL, designed

quick = settings(
    deadline=None, max_examples=30, suppress_health_check=[HealthCheck.filter_too_much]
)
ROBOT = find_robot("kuka/kr30-3")
TURNS = st.floats(0.1, 3.0).flatmap(lambda turn: st.sampled_from([turn, -turn]))


@quick
@given(
    q=regular_configurations(ROBOT, 0.2),
    corners=st.lists(st.tuples(TURNS, st.floats(0.01, 0.05)), min_size=1, max_size=6),
    leg=st.sampled_from(Leg),
    first=st.floats(0, 6.28),
    data=st.data(),
)
def test_a_walk_turns_by_what_is_asked(q, corners, leg, first, data) -> None:
    normal = data.draw(st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1))
    across = np.linalg.svd(np.array([normal]))[2]
    plane = np.column_stack([across[1], across[2], np.cross(across[1], across[2])])
    star = Star(find_vendor("kuka"), ROBOT, FLANGE, q, plane)
    turns, lengths = zip(*corners, strict=True)
    spokes = star.walk([leg], turns, lengths, first)
    assert len(spokes) == len(corners) + 1
    centre = star.place[1]
    for k, (turn, length) in enumerate(corners):
        into, out = spokes[k], spokes[k + 1]
        assert min(into.length, out.length) >= length
        ways = [star.direction(spoke.angle) for spoke in (into, out)]
        assert -ways[0] @ ways[1] == pytest.approx(math.cos(turn), abs=1e-9)
        # The legs do leave the centre that way: a thousandth of each.
        for spoke, way in zip((into, out), ways, strict=True):
            step = np.array(star._pose(spoke, 1e-3).position) - centre
            if leg is Leg.JOINT:
                step = ROBOT.forward(q + 1e-3 * spoke.length * star.slope(spoke.angle))[1] - centre
            else:
                assume(np.linalg.norm(step) > 1e-5)
            assert np.linalg.norm(step / spoke.length - 1e-3 * way) < 1e-5 / spoke.length + 1e-4


@given(st.floats(0.3, 4.0))
def test_usual_zones_suit_the_reach(reach: float) -> None:
    radii = usual_radii(reach)
    assert 1 <= len(radii) <= 4 and list(radii) == sorted(set(radii))
    assert 0.001 * reach < radii[0] and radii[-1] <= 0.081 * reach


MATRICES = st.integers(0, 2**32 - 1).map(np.random.default_rng)


def told(random: np.random.Generator, size: int = 4) -> np.ndarray:
    S = random.normal(size=(20, size)) * 10.0 ** random.uniform(-6, 0, size)
    return information._information(S, random.normal(size=(20, 2)))


@quick
@given(random=MATRICES)
def test_information_is_bounded_and_free_of_the_clock(random: np.random.Generator) -> None:
    S = random.normal(size=(30, 5)) * 10.0 ** random.uniform(-7, 0, 5)
    clock = random.normal(size=(30, 2))
    F = information._information(S, clock)
    values = np.linalg.eigvalsh(F)
    assert values.min() > -1e-9 / SCATTER**2 and values.max() < 1.0001 / SCATTER**2
    shifted = S + clock @ random.normal(size=(2, 5)) * np.linalg.norm(S, axis=0)
    np.testing.assert_allclose(information._information(shifted, clock), F, atol=1e-4 / SCATTER**2)


def option(random: np.random.Generator, number: int) -> Option:
    kind = list(Kind)[random.integers(len(Kind))]
    speed = float(random.choice([0.1, 0.5]))
    corner = PlannedCorner(1.0, float(random.choice([0.01, 0.05])))
    candidate = CandidateRun(
        f"run{number}", kind, int(random.integers(3)), speed, (corner,), None, np.zeros(6)
    )
    return Option(candidate, told(random), float(random.uniform(2, 50)))


@quick
@given(random=MATRICES, count=st.integers(1, 12), minutes=st.floats(0.5, 12))
def test_a_choice_keeps_its_time_and_takes_what_tells_most(random, count, minutes) -> None:
    options = [option(random, k) for k in range(count)]
    plan = Plan(minutes=minutes, overhead=30.0)
    choice, spent, had = RunChoice(options, plan), 0.0, set()
    rest = list(options)
    before = np.zeros((4, 4))
    while (taken := choice.best()) is not None:
        fit = [o for o in rest if spent + o.duration + 30.0 <= 60.0 * minutes]
        fresh = {o.candidate.name: len(o.levels - had) for o in fit}
        assert fresh[taken.candidate.name] == max(fresh.values())
        rivals = [o for o in fit if fresh[o.candidate.name] == max(fresh.values())]

        def rate(o: Option, before: np.ndarray = before) -> float:
            return (nats(before + o.information) - nats(before)) / (o.duration + 30.0)

        assert rate(taken) >= max(map(rate, rivals)) - 1e-12
        gain = choice.take(taken)
        assert gain == pytest.approx(rate(taken) * (taken.duration + 30.0)) and gain >= -1e-9
        spent += taken.duration + 30.0
        had |= taken.levels
        rest.remove(taken)
        before = before + taken.information
    assert spent <= 60.0 * minutes
    assert len(choice.left_over()) == len(rest)
    assert {level for o in rest for level in o.levels} - had == set(choice.missing())


def test_sensitivities_are_those_of_the_emulation() -> None:
    """The information of β alone, from two emulations by the controller itself."""
    made = designed("kuka/kr30-3", SMALL)
    candidate = next(run.candidate for run in made.runs if run.candidate.kind is Kind.JOINTS)
    vendor = find_vendor("kuka")
    informer = Informer.of(vendor, made.robot, 0.02)
    F = informer.information(candidate)
    k = informer.keys.index("blend.joint.beta[0]")
    start = JointTarget(tuple(candidate.start))
    step = 0.01

    def joints(beta: float) -> np.ndarray:
        model = replace(informer.model, joint=replace(informer.model.joint, beta=(beta,)))
        controller = Controller(vendor, made.robot, model)
        q = controller.run(candidate.program, start, 0.02).trajectory
        return q

    base, more = joints(0.0), joints(step)
    count = min(len(base.t), len(more.t))
    slope = 0.5 * (more.q[:count] - base.q[:count]) / step
    rows = [
        slope.ravel(),
        base.dq[:count].ravel(),
        (base.t[:count, None] * base.dq[:count]).ravel(),
    ]
    own = (
        rows[0]
        - np.column_stack(rows[1:])
        @ np.linalg.lstsq(np.column_stack(rows[1:]), rows[0], rcond=None)[0]
    )
    alone = own @ own / information.NOISE**2
    # By the others' scatter F holds back more than β's own; without them it is this.
    single = informer.figures
    only = replace(informer, figures=tuple(f for f in single if f.key == "blend.joint.beta[0]"))
    found = only.information(candidate)[0, 0]
    assert found == pytest.approx(alone / (1 + SCATTER**2 * alone), rel=0.05)
    assert 0 < F[k, k] < 1 / SCATTER**2
    for one in informer.precision(F):
        assert 0 < one.after <= one.before * (1 + 1e-9)
