"""Where the time of a run goes, by source line and by cause."""

from __future__ import annotations

from pathlib import Path

import pytest

import flyby
from flyby.tasks.results.report import move_row

ROOT = Path(__file__).parents[2]
LOOP = """MODULE Loop
  CONST robtarget p1:=[[1500,0,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ p1, v500, fine, tool0;
    FOR i FROM 1 TO 12 DO
      MoveL Offs(p1,100,0,0), v50, fine, tool0;
      WaitTime 0.5;
      MoveL p1, v500, fine, tool0;
    ENDFOR
  ENDPROC
ENDMODULE
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> flyby.Run:
    path = tmp_path_factory.mktemp("loop") / "loop.mod"
    path.write_text(LOOP)
    return flyby.emulate(flyby.read(path, robot="abb/irb6640-180-255"))


def test_a_line_in_a_loop_is_one_row_with_its_total(run: flyby.Run) -> None:
    lines = {line.span.line: line for line in run.lines if line.span is not None}
    assert sorted(lines) == [6, 7, 8]
    slow = lines[6]
    assert slow.times == len(slow.moves) == 12 and slow.target != "several"
    assert slow.wait == 0.0
    assert slow.time == pytest.approx(sum(run.moves[n - 1].time for n in slow.moves))
    assert sum(line.total for line in run.lines) == pytest.approx(run.duration)
    assert slow.limits[0].name == "programmed TCP speed"


def test_a_wait_has_a_line_of_its_own(run: flyby.Run) -> None:
    waits = next(line for line in run.lines if line.span is not None and line.span.line == 7)
    assert (waits.kind, waits.target, waits.times) == ("wait", "0.5 s", 12)
    assert waits.wait == waits.total == pytest.approx(6.0)
    told = {cause.name: cause.span for cause in run.causes}["waits of the program"]
    assert told is not None and told.line == 7


def test_waits_before_all_and_behind_faults(tmp_path: Path) -> None:
    """What nobody waits for is in no line; what two lines wait at one stop is in both."""
    path = tmp_path / "waits.mod"
    text = LOOP.replace("    MoveJ p1", "    WaitTime 0.25;\n    MoveJ p1")
    text = text.replace("FOR i FROM 1 TO 12", "FOR i FROM 1 TO 2")
    text = text.replace("WaitTime 0.5;", "WaitTime 0.5; WaitTime 0.125;\n      WaitTime 1;")
    path.write_text(text)
    run = flyby.emulate(flyby.read(path, robot="abb/irb6640-180-255"))
    waits = {line.span.line: line.wait for line in run.lines if line.span and line.wait}
    assert waits == pytest.approx({4: 0.25, 8: 1.25, 9: 2.0})
    assert sum(line.total for line in run.lines) == pytest.approx(run.duration)
    moves = [f"MoveL Offs(p1,{x},0,0), v500, fine, tool0;" for x in (9000, 50, 0)]
    path.write_text(text.replace("ENDFOR", "ENDFOR\n" + "\nWaitTime 3;\n".join(moves)))
    run = flyby.emulate(flyby.read(path, robot="abb/irb6640-180-255"))
    report = run.report
    assert run.faults
    assert sum(line.total for line in run.lines) == pytest.approx(report.driven_time)
    # It waits where it is taken to stand behind the fault, and not where it cannot stand.
    assert (report.first_wait, report.waiting) == (0.25, pytest.approx(0.25 + 2 * 1.625 + 3.0))
    fault = run.faults[0].move
    assert [row.wait for row in report.moves[fault:]] == [0.0, 3.0, 0.0]
    assert report.first_wait + sum(row.wait for row in report.moves) == report.waiting
    told = {cause.name: cause for cause in run.causes}["waits of the program"]
    assert told.time == told.gain == pytest.approx(report.waiting)
    assert move_row(report.moves[fault + 1])[6] == "3.000"
    path.write_text(text.replace("    MoveJ p1", f"    {moves[0]}\n    WaitTime 5;\n    MoveJ p1"))
    run = flyby.emulate(flyby.read(path, robot="abb/irb6640-180-255"))
    assert run.faults and not run.moves[0].driven
    waits = next(cause.time for cause in run.causes if cause.name == "waits of the program")
    assert waits == run.report.first_wait + sum(move.wait for move in run.moves) < 5.0


def test_causes_sum_up_to_the_time_and_say_what_they_give_back(run: flyby.Run) -> None:
    causes = {cause.name: cause for cause in run.causes}
    assert sum(cause.time or 0.0 for cause in run.causes) == pytest.approx(run.duration, rel=0.03)
    assert causes["waits of the program"].gain == pytest.approx(6.0)
    speed = causes["programmed TCP speed"]
    assert speed.gain is not None and speed.gain > 15.0
    assert speed.span is not None and speed.span.line == 6
    stops = causes["stops, if passed in zones of 10 mm"]
    # Those before a wait stay.
    assert stops.gain is not None and 0.0 < stops.gain < run.duration
    assert not set(stops.moves) & {n for line in run.lines for n in line.moves if line.wait}
    gains = [cause.gain or 0.0 for cause in run.causes]
    assert gains == sorted(gains, reverse=True)


def test_what_to_change_first_is_a_sentence(run: flyby.Run) -> None:
    said = run.first_to_change()
    assert said.startswith("Look first at programmed TCP speed,")
    assert "most of it at line 6, which runs 12 times: without it" in said
    assert "Then at waits of the program, 6.00 s of" in said
    gain = next(cause.gain for cause in run.causes if cause.name == "programmed TCP speed")
    assert f"the cycle would be {gain:.2f} s shorter" in said


def test_devices_are_no_waits_of_the_program(tmp_path: Path) -> None:
    path = tmp_path / "loop.mod"
    path.write_text(LOOP.replace("WaitTime 0.5", "WaitDI diDone, 1"))
    answers = tmp_path / "answers.toml"
    answers.write_text("[durations]\ndiDone = 0.25\n")
    program = flyby.read(path, robot="abb/irb6640-180-255", answers=answers)
    causes = {cause.name: cause.time for cause in flyby.emulate(program).causes}
    assert "waits of the program" not in causes
    assert causes["devices"] == pytest.approx(3.0)


def test_a_line_that_goes_to_items_of_an_array_says_so(tmp_path: Path) -> None:
    path = tmp_path / "a.src"
    points = "\n".join(f"P[{i}]={{X 1500,Y {200 * i},Z 900,A 0,B 90,C 0}}" for i in (1, 2, 3))
    path.write_text(
        "DEF a()\nDECL E6POS P[3]\nDECL INT i\nBAS(#INITMOV,0)\n"
        f"{points}\nFOR i=1 TO 3\nPTP P[i]\nENDFOR\nEND\n"
    )
    (line,) = flyby.emulate(flyby.read(path, robot="kuka/kr210-r2700-2")).lines
    assert line.target in ("P[1] to P[3]", "P[2] to P[3]")  # to the first it may be taken to go
