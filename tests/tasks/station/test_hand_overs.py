"""Parts that one robot hands to another: proven in all orders, and never where sampling disagrees.

What happens is followed by itself (`flyby.validation.stations.samples`), with the robots begun at
any times.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.collision.mutual.conflict import ConflictCause
from flyby.core.errors import InputError
from flyby.core.station.clearances import StationProver
from flyby.core.station.hand_over import check_hand_overs
from flyby.tasks.results.stations import DrivenStation
from flyby.validation.stations.random_stations import RandomStation
from flyby.validation.stations.samples import Samples, trials_begun

from .hand_over_scene import hand_over

CLEARANCE = 0.005


def causes(made: DrivenStation) -> set[ConflictCause]:
    (pair,) = made.clearances
    assert pair.interlocked is not None
    return {conflict.cause for conflict in pair.interlocked.conflicts.values()}


def with_table(folder: Path) -> None:
    """Under the bar where it changes hands."""
    table = '[[obstacle]]\nname = "table"\nbox_mm = [300, 200, 20]\n'
    table += "pose = { xyz_mm = [-800, 0, 329.5] }\n"
    for cell in ("left.toml", "right.toml"):
        text = (folder / cell).read_text("utf-8")
        (folder / cell).write_text(text + table, "utf-8")


def test_two_arms_hold_one_part_and_one_lets_go(tmp_path: Path) -> None:
    made = flyby.station(hand_over(tmp_path))
    (pair,) = made.clearances
    assert made.clear and pair.interlocked is not None and pair.interlocked.proven
    assert not pair.any_time.proven and pair.least >= CLEARANCE
    assert not made.findings()


@pytest.mark.parametrize(
    ("without", "early", "cause", "said"),
    [
        (["brought"], False, ConflictCause.EARLY, "right may come for left.bar before left stands"),
        (["held"], False, ConflictCause.DROPPED, "left may let go of left.bar before right has it"),
        # It lifts the bar into the gripper that holds it, or has just let go.
        (["away"], False, ConflictCause.NEAR, "left's tcp and right's bar"),
        ([], True, ConflictCause.NEAR, "left's tcp and right's bar"),
    ],
)
def test_each_signal_is_needed(
    tmp_path: Path, without: list[str], early: bool, cause: ConflictCause, said: str
) -> None:
    made = flyby.station(hand_over(tmp_path, without, early=early))
    (pair,) = made.clearances
    assert pair.interlocked is not None and not pair.interlocked.proven
    told = [made.conflict_said(pair, c) for c in pair.interlocked.conflicts.values()]
    assert cause in causes(made)
    assert any(said in text and "giver.script" in text for text in told)


def test_who_drives_off_before_the_other_has_let_go_tears_the_part(tmp_path: Path) -> None:
    """The giver has no shape that could touch: only its holding is in the way."""
    file = hand_over(tmp_path, ["away"])
    cell = (tmp_path / "left.toml").read_text("utf-8")
    bare = cell.replace("cylinder_mm = [30.0, 110]\npose = { xyz_mm = [0, 0, 55] }\n", "")
    assert bare != cell
    (tmp_path / "left.toml").write_text(bare, "utf-8")
    assert ConflictCause.TORN in causes(flyby.station(file))


def test_a_part_put_down_may_be_taken_later(tmp_path: Path) -> None:
    file = hand_over(tmp_path, ["held"])
    assert causes(flyby.station(file)) == {ConflictCause.DROPPED}
    with_table(tmp_path)
    assert flyby.station(file).clear


def test_who_has_put_a_part_down_keeps_off_it(tmp_path: Path) -> None:
    """The giver comes back for nothing before the taker may come: neither has it then."""
    file = hand_over(tmp_path, ["held"])
    with_table(tmp_path)
    text = (tmp_path / "giver.script").read_text("utf-8")
    brought, last = "  set_standard_digital_out(1, True)\n", text.strip().splitlines()[-2:]
    again = "  movel(p[-0.65, 0, {}, 0, 3.1416, 0], a=0.8, v=0.4)\n"
    for height, clear in ((0.396, True), (0.394, False)):
        back = again.format(0.5) + again.format(height) + again.format(0.5)
        back += f"{last[0]}\n{brought}end\n"
        (tmp_path / "giver.script").write_text(text.replace(brought, "")[:-4] + back, "utf-8")
        made = flyby.station(file)
        assert made.clear == clear
        assert causes(made) == (set() if clear else {ConflictCause.NEAR})


def test_for_third_robots_it_is_the_takers_once_that_has_it(tmp_path: Path) -> None:
    file = hand_over(tmp_path)
    (tmp_path / "third.script").write_text("def third():\n  movej([0, -1.6, 1.6, 0, 0, 0])\nend\n")
    (tmp_path / "third.toml").write_text('robot = "ur/ur10e"\nbase = { xyz_mm = [0, 9000, 0] }\n')
    third = '[robot.third]\nprogram = "third.script"\ncell = "third.toml"\n[[hand_over]]'
    file.write_text(file.read_text("utf-8").replace("[[hand_over]]", third), "utf-8")
    made = flyby.station(file)
    assert made.clear
    prover = StationProver(made.station, made.actions).prover("right", "third")
    rows, pairs = np.arange(len(prover.one.moves)), np.arange(len(prover.pairs))
    items = np.stack(np.meshgrid(rows, [0], pairs, indexing="ij"), -1).reshape(-1, 3)
    of_bar = np.array(["bar" in prover.names(pair) for pair in pairs])[items[:, 2]]
    before = prover.one.moves[items[:, 0]] <= 3
    np.testing.assert_array_equal(prover.skipped(items), of_bar & before)


def test_what_two_cells_say_of_one_part_must_agree(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"50\.0 mm and 0\.0° from .*\[-800\.000, 0\.000, 370"):
        flyby.station(hand_over(tmp_path, at="-800, 50, 370"), no_proof=True)
    file = hand_over(tmp_path)
    text = (tmp_path / "right.toml").read_text("utf-8")
    (tmp_path / "right.toml").write_text(text.replace("[400.0, 60", "[401, 60"), "utf-8")
    with pytest.raises(InputError, match="its shape is another one"):
        flyby.station(file, no_proof=True)
    (tmp_path / "right.toml").write_text(text.replace("mass_kg = 2", "mass_kg = 3"), "utf-8")
    with pytest.raises(InputError, match=r"weighs 2 kg, and 3 kg as right.bar: give both"):
        flyby.station(file, no_proof=True)
    (tmp_path / "right.toml").write_text(text, "utf-8")
    whole = file.read_text("utf-8")
    file.write_text(whole.replace('"right.bar"', '"right.bear"'), "utf-8")
    with pytest.raises(
        InputError, match=r"hand_over of left.bar: unknown part of the cell of right 'bear'"
    ):
        flyby.station(file, no_proof=True)
    file.write_text(whole.replace('"left.bar"', '"right.bar"'), "utf-8")
    with pytest.raises(InputError, match="a part of another robot's cell"):
        flyby.station(file, no_proof=True)
    file.write_text(whole + '[[hand_over]]\npart = "left.bar"\nto = "right.bar"\n', "utf-8")
    with pytest.raises(InputError, match=r"left.bar stands in two \[\[hand_over\]\]"):
        flyby.station(file, no_proof=True)
    cut = whole.replace("[[hand_over]]", "[[other]]")
    file.write_text(cut.split("[[other]]")[0] + "[links]" + cut.split("[links]")[1], "utf-8")
    with pytest.raises(InputError, match=r"if one robot hands it to the other.*\[\[hand_over\]\]"):
        flyby.station(file, no_proof=True)


def test_a_part_does_not_change_hands_in_a_zone_that_a_robot_may_pass(tmp_path: Path) -> None:
    """What the taker waits for behind it may be there already: then it takes the bar on its way."""
    file = hand_over(tmp_path)
    text = (tmp_path / "taker.script").read_text("utf-8")
    zone = text.replace("v=0.15)", "v=0.15, r=0.03)")
    assert zone != text
    (tmp_path / "taker.script").write_text(zone, "utf-8")
    with pytest.raises(InputError, match=r"taker.script:\d+.*right hands 'bar' over where it does"):
        flyby.station(file)


def test_who_hands_a_part_on_has_it_as_it_was_taken(tmp_path: Path) -> None:
    """The second cell has the bar 1.5 mm off; the third where that one lets go of it."""
    file = hand_over(tmp_path, at="-800, 1.5, 370")
    taker, cell = ((tmp_path / name).read_text("utf-8") for name in ("taker.script", "right.toml"))
    whole, end = taker.rsplit("end\n", 1)[0], "  set_standard_digital_out(0, {})\nend\n"
    (tmp_path / "taker.script").write_text(whole + end.format("False"), "utf-8")
    bare = whole.replace("  set_standard_digital_out(0, True)\n", "")
    (tmp_path / "third.script").write_text(bare + end.format("True"), "utf-8")
    there = cell.replace("-800, 1.5, 370", "-800, 451.5, 470")
    (tmp_path / "third.toml").write_text(there.replace("[-1600, 0, 0]", "[-1600, 0, 5]"), "utf-8")
    third = '[robot.third]\nprogram = "third.script"\ncell = "third.toml"\n'
    onward = '[[hand_over]]\npart = "right.bar"\nto = "third.bar"\n'
    text = file.read_text("utf-8").replace("[[hand_over]]", f"{third}{onward}[[hand_over]]")
    file.write_text(text, "utf-8")
    station = flyby.station(file, no_proof=True).station
    first, second = check_hand_overs(station)
    assert [met.declared.giver for met in (first, second)] == ["left", "right"]
    for met in (first, second):
        assert abs(met.fix.position[1]) == pytest.approx(1.5e-3, abs=1e-5)


# Sampled


@settings(max_examples=6, deadline=None)
@given(
    without=st.sets(st.sampled_from(["brought", "held", "away"]), max_size=1),
    early=st.booleans(),
    height=st.floats(0.3, 0.5),
    back=st.floats(-0.75, -0.4),
    radius=st.floats(20.0, 152.0),
    begins=st.tuples(st.floats(0.0, 12.0), st.floats(0.0, 12.0)),
)
def test_what_is_proven_no_sampling_refutes(
    tmp_path_factory: pytest.TempPathFactory,
    without: set[str],
    early: bool,
    height: float,
    back: float,
    radius: float,
    begins: tuple[float, float],
) -> None:
    file = hand_over(
        tmp_path_factory.mktemp("station"),
        without,
        early=early,
        height=round(height, 4),
        back=round(back, 4),
        radius=round(radius, 1),
    )
    try:
        made = flyby.station(file)
    except InputError:
        return
    (pair,) = made.clearances
    if pair.interlocked is not None and pair.interlocked.proven:
        samples = Samples(RandomStation(file, ("ur", "ur"), (2, 4, 3)), made)
        for trial in trials_begun(made, begins):
            assert samples.least(trial) >= CLEARANCE - 2e-5
