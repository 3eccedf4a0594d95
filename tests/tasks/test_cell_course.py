"""Programs in their cells: clearances and parts, as `flyby.check` and `flyby.emulate` tell them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import flyby
from flyby.core.cell.lying_parts import with_parts_lying
from flyby.core.errors import InputError
from flyby.core.lint.check import CLEARANCE, COLLISION, NEAREST, PART
from flyby.core.lint.finding import Finding
from flyby.core.program.move import Move
from flyby.core.program.zone import Fine
from flyby.problems.improve.nonsmooth_sqp import SearchEffort
from flyby.problems.improve.waypoints import Effort
from flyby.tasks.results.cell_course import CellCourse
from flyby.tasks.setup import controller_of, setup_of_program

ROOT = Path(__file__).parents[2]
PICK = ROOT / "examples" / "pick.script"
CELL = (ROOT / "examples" / "cell" / "pick.toml").read_text("utf-8")


@pytest.fixture
def cell(tmp_path: Path):
    def made(*changes: tuple[str, str]) -> Path:
        text = CELL
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "cell.toml"
        path.write_text(text, "utf-8")
        return path

    return made


def found(path: Path) -> dict[str, list[Finding]]:
    rules: dict[str, list[Finding]] = {}
    for finding in flyby.check(flyby.read(PICK, cell=path)):
        rules.setdefault(finding.rule, []).append(finding)
    return rules


def test_the_example_is_clear_and_both_figures_are_told(cell) -> None:
    rules = found(cell())
    assert not {COLLISION, CLEARANCE, PART, "payload-exceeded"} & rules.keys()
    nearest = {finding.message for finding in rules[NEAREST]}
    assert "clearance to the cell: 40.0 mm between bottle 1 and bottle 2" in nearest
    assert any(message.startswith("clearance between the arm's own parts") for message in nearest)
    run = flyby.emulate(flyby.read(PICK, cell=cell()))
    assert run.report.to_cell is not None and run.report.own is not None
    assert run.report.to_cell.distance == pytest.approx(0.04, abs=1e-4)
    # What the bottles weigh is nothing that the program states.
    assert all(move.load is None for move in run.program.moves)
    assert [move.load is not None for move in run.parts[0].run.program.moves[2:6]] == [
        False,
        True,
        True,
        True,
    ]


def test_a_part_that_stays_where_it_is_released_is_hit_by_the_next(cell) -> None:
    (hit,) = found(cell(("leaves = true", "leaves = false")))[COLLISION]
    assert "bottle 1 and bottle 2 overlap by" in hit.message
    assert hit.span is not None and hit.span.line == 20


def test_less_than_the_clearance_is_a_warning(cell) -> None:
    warned = found(cell(("clearance_mm = 5", "clearance_mm = 45")))[CLEARANCE]
    assert any("come within 40.0 mm, 45 mm are to be kept" in f.message for f in warned)
    assert {f.span.line for f in warned if f.span is not None} >= {18}


def test_parts_that_are_not_met_are_found_with_their_line(cell) -> None:
    (none,) = found(cell(("count = [2]", "count = [1]"), ("[-100]", "[0]")))[PART][:1]
    assert "none is left to take" in none.message
    assert none.span is not None and none.span.line == 16
    (never,) = found(cell(("(0, True)", "(7, True)")))[PART]
    assert "cell.toml" in never.message
    assert "set_standard_digital_out(7, True)" in never.message


def test_a_part_too_heavy_is_found_where_it_is_lifted(cell) -> None:
    (heavy,) = found(cell(("mass_kg = 0.6", "mass_kg = 20")))["payload-exceeded"]
    assert "carries 20.8 kg" in heavy.message
    assert "bottle 1 of 20 kg" in heavy.message
    assert "rated for 12.5 kg" in heavy.message
    assert heavy.span is not None and heavy.span.line == 18


def test_what_acceleration_owes_to_load_is_said(cell) -> None:
    run = flyby.emulate(flyby.read(PICK, cell=cell()))
    (note,) = [note for note in run.notes if "owes to load" in note.message]
    assert "0.6 kg is carried on 6 moves" in note.message
    bare = flyby.emulate(flyby.read(PICK, cell=cell(("mass_kg = 0.6", ""))))
    assert not [note for note in bare.notes if "owes to load" in note.message]


def test_a_tool_that_the_cell_does_not_know_is_said_and_nothing_refused(cell) -> None:
    path = cell(("[tool.tcp]", "[tool.other]"))
    run = flyby.emulate(flyby.read(PICK, cell=path))
    assert run.report.to_cell is None
    assert [note for note in run.notes if "clearances are not known" in note.message]


def test_a_program_without_a_cell_has_no_clearance() -> None:
    run = flyby.emulate(flyby.read(PICK, robot="ur/ur10e"))
    assert run.report.to_cell is None
    assert run.clearances == ()


def test_the_base_of_a_robot_that_carries_parts(cell, tmp_path: Path) -> None:
    """A joint target at which the bottle is taken moves with the base, and the bottle does not: it
    would be held elsewhere."""
    short = tmp_path / "pick.script"
    short.write_text(_SHORT, "utf-8")
    made = flyby.place(flyby.read(short, cell=cell()), room="40,0")
    found = made.found
    assert found.before is not None and found.best is not None
    assert found.best.run.duration < found.before.run.duration and found.best.certificate.proven
    assert "what takes it" in found.best.certificate.message
    assert any(move.load is not None for move in found.best.run.program.moves)
    joints = flyby.emulate(flyby.read(short, cell=cell())).parts[0].run.path.route.ends.q
    by_joints = ", ".join(f"{q:.6f}" for q in joints[1, 1])
    short.write_text(
        _SHORT.replace("movel(p[-0.45, -0.25, 0.12, 0, 3.1416, 0]", f"movej([{by_joints}]"), "utf-8"
    )
    found = flyby.place(flyby.read(short, cell=cell()), room="40,0").found
    assert found.before is not None
    assert found.best is None or found.best.shift == (0.0, 0.0, 0.0, 0.0)


def test_the_front_of_a_program_that_carries_parts(
    cell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the bottle weighs counts, and is nothing that the programs state."""
    monkeypatch.setattr("flyby.tasks.pareto.effort_of", lambda *_: Effort(iterations=1, proofs=0))
    for effort in ("_REFINING", "_SETTLING"):
        search = "flyby.problems.improve.energy.paced_search"
        monkeypatch.setattr(f"{search}.{effort}", SearchEffort(1, 0.1))
    short = tmp_path / "pick.script"
    short.write_text(_SHORT, "utf-8")
    program = flyby.read(short, cell=cell(("mass_kg = 0.6", "mass_kg = 3")))
    front = flyby.pareto(program, points=2, change="zones")
    controller = controller_of(program, setup_of_program(program))
    bare = controller.energy(program, controller.run(program).timing).value
    assert front.given.energy > 1.02 * bare
    assert front.points and front.proven
    assert front.points[0].duration < 0.97 * front.given.duration
    for k, point in enumerate(front.points, 1):
        assert point.certificate is not None and "what takes it" in point.certificate.message
        assert all(move.load is None for move in point.program.moves)
        assert isinstance(point.program.moves[2].zone, Fine)
        again = tmp_path / f"again-{k}.script"
        again.write_bytes(front.files[f"point-{k}/pick.script"])
        assert flyby.read(again, cell=cell()).moves[3].zone == point.program.moves[3].zone
    with pytest.raises(InputError, match="a part of the cell is taken or released there"):
        flyby.pareto(program, free=[3])


_SHORT = """def pick():
  set_tcp(p[0, 0, 0.12, 0, 0, 0])
  set_target_payload(0.8, [0, 0, 0.05])
  movej([0, -1.6, -1.6, -1.5, 1.5708, 0], a=1.4, v=1.05)
  movej(p[-0.45, -0.25, 0.27, 0, 3.1416, 0], a=1.4, v=1.05, r=0.01)
  movel(p[-0.45, -0.25, 0.12, 0, 3.1416, 0], a=0.8, v=0.15)
  set_standard_digital_out(0, True)
  movel(p[-0.45, -0.25, 0.27, 0, 3.1416, 0], a=1.2, v=0.4, r=0.01)
  movel(p[-0.45, 0.25, 0.35, 0, 3.1416, 0], a=1.2, v=0.5)
end
"""


def test_where_no_program_takes_them_parts_lie_where_they_are(cell) -> None:
    """A free motion keeps off the bottles that stand in its way."""
    way = {
        "start": "-185.0,-124.1,-95.9,-49.9,90,-5.0",
        "goal": "-240.0,-124.1,-95.9,-49.9,90,-60.0",
    }
    tall = (("cylinder_mm = [30, 60]", "cylinder_mm = [30, 400]"),)
    made = flyby.free_motion(cell=cell(*tall), tool="tcp", **way)
    assert made.proven and any("lie where they are at first" in n.message for n in made.notes)
    around = {o.name: o for o in with_parts_lying(flyby.cell(cell()))[0].obstacles}
    assert around["bottle 2"].geometry.placement.position == pytest.approx((-0.55, -0.25, 0.09))
    assert with_parts_lying(flyby.cell(cell()))[0].parts == ()


def test_joints_are_shown_with_the_parts_of_their_move(cell) -> None:
    """Where the bottle is carried it takes room beside the gripper."""
    program = flyby.read(PICK, cell=cell())
    free = [
        flyby.cspace(program, axes="2,3", move=move, steps=41, whole=True).plane.free
        for move in (2, 5)
    ]
    assert free[1] < free[0]


def test_stops_at_parts_are_not_freed(cell) -> None:
    for task in (flyby.zones, flyby.optimize):
        with pytest.raises(InputError, match="a part of the cell is taken or released there"):
            task(flyby.read(PICK, cell=cell()), free=[3])


def test_a_program_that_carries_parts_becomes_faster(cell, tmp_path: Path) -> None:
    """Zones alone. What bottles weigh stands nowhere in it."""
    once = tmp_path / "once.script"
    once.write_text(PICK.read_text("utf-8").replace("part < 2", "part < 1"), "utf-8")
    program = flyby.read(once, cell=cell())
    made = flyby.optimize(program, zones_only=True, starts=1, generations=0)
    assert made.proven and made.after.time < 0.95 * made.before.time
    assert made.certificate is not None and "what takes it" in made.certificate.message
    assert [move.load for move in made.program.moves] == [move.load for move in program.moves]
    assert "set_target_payload(0.8" in next(iter(made.texts.values())).text


def test_moves_that_come_and_go_leave_loads_as_they_were(cell) -> None:
    program = flyby.read(PICK, cell=cell())
    course = replace(CellCourse.of(program, setup_of_program(program)), counted=True)
    assert course.unloaded(course.program) == program and course.loaded(program) == course.program
    statements = list(course.program.statements)
    carried = next(k for k, s in enumerate(statements) if getattr(s, "load", None) is not None)
    more = replace(course.program, statements=(*statements, statements[carried]))
    assert all(move.load is None for move in course.unloaded(more).moves)
    again = course.loaded(course.unloaded(more))
    assert len(again.moves) == len(program.moves) + 1
    assert again.moves[3].load is not None


def test_zones_grow_as_far_as_what_is_carried_lets_them(cell) -> None:
    """The bottle would meet a low post in a larger zone behind the tray, the bare gripper not."""
    post = '[[obstacle]]\nname = "post"\nbox_mm = [30, 30, 40]\n'
    post += "pose = { xyz_mm = [-450, -185, 185] }\n"
    zones = []
    for change in ((), (('attach = "set', 'attach = "never" # "set'),)):
        path = cell(*change)
        path.write_text(path.read_text("utf-8") + post, "utf-8")
        made = flyby.zones(flyby.read(PICK, cell=path), free=["all"])
        assert made.proven and made.after.time < made.before.time
        assert made.certificate is not None
        assert ("what takes it" in made.certificate.message) is not bool(change)
        moves = made.program.moves
        assert all(move.load is None for move in moves)
        # Where bottles are taken and let go it stops, whatever is free.
        assert change or [isinstance(moves[k].zone, Fine) for k in (2, 5, 8, 11)] == [True] * 4
        zones.append(moves[3].zone.tcp)
    assert zones[0] < 0.6 * zones[1]


def test_as_many_moves_are_not_the_same_moves(cell) -> None:
    """One has gone before the bottle is taken, and one has come behind: all between are shifted."""
    program = flyby.read(PICK, cell=cell())
    course = CellCourse.of(program, setup_of_program(program))
    statements = list(program.statements)
    places = [k for k, statement in enumerate(statements) if isinstance(statement, Move)]
    statements.insert(places[6], program.moves[6])
    del statements[places[1]]
    other = replace(program, statements=tuple(statements))
    assert len(other.moves) == len(program.moves)

    counted = replace(course, counted=True)
    wanted = CellCourse.of(other, counted.setup).program
    assert [move.load is not None for move in wanted.moves[1:5]] == [False, True, True, True]
    assert counted.loaded(other) == wanted != course.loaded(other)
    assert counted.unloaded(wanted) == other


def test_what_takes_parts_must_be_said_in_what_is_written_anew(cell) -> None:
    """Its lines are others: before anything is searched that is refused, with what helps."""
    by_line = cell(
        ('attach = "set_standard_digital_out(0, True)"', 'attach = "pick.script:16"'),
    )
    with pytest.raises(InputError, match=r"does not say any more where bottle 1.*and no line"):
        flyby.optimize(flyby.read(PICK, cell=by_line), vias="change")


def test_what_holds_a_part_is_no_process(cell, tmp_path: Path) -> None:
    """The bottle is carried along lines at one speed, as a bead would be laid."""
    program = tmp_path / "pick.script"
    text = PICK.read_text("utf-8").replace("a=1.2, v=0.5", "a=1.2, v=0.4")
    program.write_text(text, "utf-8")
    carried = flyby.zones(flyby.read(program, cell=cell()))
    assert not any("digital_out" in note.message for note in carried.notes)
    unknown = flyby.zones(flyby.read(program, robot="ur/ur10e"), no_floor=True)
    assert any("digital_out[0] is on there" in note.message for note in unknown.notes)
