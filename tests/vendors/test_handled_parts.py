"""Parts that are picked and placed, in every language: by signals, routines, calls of devices,
and on the way."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from flyby.core.cell.cell import Cell
from flyby.core.cell.geometry import Geometry
from flyby.core.cell.workpiece import Workpiece
from flyby.core.handling.handling import Handling, handling_of
from flyby.core.handling.loads import with_loads
from flyby.core.lint.check import check
from flyby.core.program.program import Program
from flyby.core.program.tool import Load
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.shape import Box
from flyby.core.source.execution.answers import Answers
from flyby.core.spatial.pose import Pose

ROBOTS = {"abb": "abb/irb1200-5-090", "kuka": "kuka/kr30-3", "ur": "ur/ur5e"}
FRAME = {
    "abb": "MODULE demo\nPROC main()\n{}\nENDPROC\n{}\nENDMODULE\n",
    "kuka": "DEF demo( )\nBAS(#INITMOV,0)\n{}\nEND\n{}\n",
    "ur": "{1}\n{0}\n",
}
SUFFIX = {"abb": "demo.mod", "kuka": "demo.src", "ur": "demo.script"}
AT = {"abb": (0.45, 0.0), "kuka": (1.3, 0.0), "ur": (-0.45, 0.1)}
LOW, HIGH = {"abb": 0.5, "kuka": 0.9, "ur": 0.3}, {"abb": 0.6, "kuka": 1.0, "ur": 0.4}
SIGNAL = {
    "abb": ("Set doGrip;", "Reset doGrip;"),
    "kuka": ("$OUT[3]=TRUE", "$OUT[3]=FALSE"),
    "ur": ("set_standard_digital_out(3, True)", "set_standard_digital_out(3, False)"),
}
VALUE = {
    "abb": ("SetDO doGrip, 1;", "SetDO doGrip, 0;"),
    "kuka": ("PULSE($OUT[3],TRUE,0.2)", "PULSE($OUT[4],TRUE,0.2)"),
    "ur": ("set_tool_digital_out(0,True)", "set_tool_digital_out(0,False)"),
}
CALL = {
    "abb": ("Grip 1;", "Grip 0;"),
    "kuka": ("Grip(1)", "Grip(0)"),
    "ur": ("grip(1)", "grip(0)"),
}
ROUTINE = {
    "abb": "PROC Grip(num n)\nIF n=1 THEN\nSet doGrip;\nELSE\nReset doGrip;\nENDIF\nENDPROC",
    "kuka": "DEF Grip(n:IN)\nINT n\nIF n==1 THEN\n$OUT[3]=TRUE\nELSE\n$OUT[3]=FALSE\nENDIF\nEND",
    "ur": "def grip(n):\n  if n == 1:\n    set_standard_digital_out(3, True)\n  else:\n"
    "    set_standard_digital_out(3, False)\n  end\nend",
}
ON_THE_WAY = {
    "abb": "MoveLDO {},v100,fine,tool0,doGrip,{};",
    "kuka": "TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[3]={}\nLIN {}",
}


def point(language: str, height: float) -> str:
    x, y = AT[language]
    if language == "abb":
        far = ",".join(["9E9"] * 6)
        return f"[[{1e3 * x},{1e3 * y},{1e3 * height}],[0,0,1,0],[0,0,0,0],[{far}]]"
    if language == "kuka":
        return f"{{X {1e3 * x},Y {1e3 * y},Z {1e3 * height},A 0,B 90,C 0}}"
    return f"p[{x},{y},{height},2.2214,2.2214,0]"


def to(language: str, height: float) -> str:
    words = {"abb": "MoveJ {},v100,fine,tool0;", "kuka": "PTP {}", "ur": "movej({})"}
    return words[language].format(point(language, height))


def program(language: str, take: str, give: str, routine: str = "") -> Program:
    """Down, take, up, give, down."""
    low, high = to(language, LOW[language]), to(language, HIGH[language])
    body = "\n".join([high, low, take, high, give, low])
    text = FRAME[language].format(body, routine)
    robot = find_robot(ROBOTS[language])
    answers = Answers(goes_on=True)
    return find_vendor(language).read(text, SUFFIX[language], robot=robot, answers=answers)


def cell_of(language: str, attach: str, release: str) -> Cell:
    x, y = AT[language]
    place = Geometry(Box((0.05, 0.05, 0.05)), Pose((x, y, LOW[language])))
    part = Workpiece("crate", place, (attach,), (release,), Load(2.0))
    return Cell(find_robot(ROBOTS[language]), language, parts=(part,), file=Path("cell.toml"))


def handled(language: str, made: Program, attach: str, release: str) -> Handling:
    return handling_of(made, cell_of(language, attach, release))


def held(found: Handling) -> list[bool]:
    return [arrangement[0].held for arrangement in found.arrangements]


@pytest.fixture(params=["abb", "kuka", "ur"])
def language(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def test_signals_take_and_release(language: str) -> None:
    for take, give in (SIGNAL[language], VALUE[language]):
        made = program(language, take, give)
        found = handled(language, made, take.rstrip(";"), give.rstrip(";"))
        assert held(found) == [False, False, True, False]
        assert not found.notes
        # Blanks and case do not count.
        loose = handled(language, made, take.replace(" ", "").upper(), f" {give.lower()}")
        assert held(loose) == held(found)


def test_routines_of_the_program_take_and_release(language: str) -> None:
    take, give = CALL[language]
    made = program(language, take, give, ROUTINE[language])
    found = handled(language, made, take.rstrip(";"), give.rstrip(";"))
    assert held(found) == [False, False, True, False]
    # So do the signals that they set.
    within = handled(language, made, *(text.rstrip(";") for text in SIGNAL[language]))
    assert held(within) == held(found)


def test_calls_of_devices_whose_text_is_missing_take_and_release(language: str) -> None:
    take, give = CALL[language]
    found = handled(language, program(language, take, give), take.rstrip(";"), give.rstrip(";"))
    assert held(found) == [False, False, True, False]


def test_a_line_takes_and_releases(language: str) -> None:
    made = program(language, *SIGNAL[language])
    text = made.reading.files[SUFFIX[language]].text  # type: ignore[union-attr]
    lines = [text[: text.index(words)].count("\n") + 1 for words in SIGNAL[language]]
    at = [f"{SUFFIX[language]}:{line}" for line in lines]
    assert held(handled(language, made, *at)) == [False, False, True, False]


def test_a_load_that_is_declared_meanwhile_is_not_counted_twice(language: str) -> None:
    declared = {
        "abb": "Set doGrip;\nGripLoad [2,[0,0,50],[1,0,0,0],0,0,0];",
        "kuka": "$OUT[3]=TRUE\n$LOAD={M 2.0,CM {X 0,Y 0,Z 50,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}",
        "ur": "set_standard_digital_out(3, True)\nset_target_payload(2.0, [0,0,0.05])",
    }
    attach, release = SIGNAL[language][0].rstrip(";"), SIGNAL[language][1].rstrip(";")
    for take, mass in ((SIGNAL[language][0], 2.0), (declared[language], 2.0)):
        made = program(language, take, SIGNAL[language][1])
        loaded, notes = with_loads(made, handled(language, made, attach, release))
        move = loaded.moves[2]
        loads = [load for load in (move.tool.load, move.load) if load is not None]
        assert sum(load.mass for load in loads) == pytest.approx(mass)
        assert not notes


@pytest.mark.parametrize("language", list(ON_THE_WAY))
def test_what_happens_on_the_way_takes_at_the_target(language: str) -> None:
    low, high = point(language, LOW[language]), point(language, HIGH[language])
    words = ON_THE_WAY[language]
    on, off = ((low, "1"), (high, "0")) if language == "abb" else (("TRUE", low), ("FALSE", high))
    body = "\n".join([to(language, HIGH[language]), words.format(*on), words.format(*off)])
    text = FRAME[language].format(f"{body}\n{to(language, LOW[language])}", "")
    robot = find_robot(ROBOTS[language])
    made = find_vendor(language).read(text, SUFFIX[language], robot=robot)
    cues = {"abb": ("doGrip, 1", "doGrip, 0"), "kuka": ("$OUT[3]=TRUE", "$OUT[3]=FALSE")}
    assert held(handled(language, made, *cues[language])) == [False, False, True, False]
    # The same words stand in statements between moves.
    between = program(language, *(VALUE if language == "abb" else SIGNAL)[language])
    assert held(handled(language, between, *cues[language])) == [False, False, True, False]


DECLARED = {
    "abb": "GripLoad [7,[0,0,50],[1,0,0,0],0,0,0];",
    "kuka": "$LOAD={M 40.0,CM {X 0,Y 0,Z 50,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}",
    "ur": "set_target_payload(7.0, [0,0,0.05])",
}
RATED = {"abb": "7 kg from here on", "kuka": "40 kg from here on", "ur": "7 kg from here on"}


def test_loads_that_a_program_declares_are_held_to_what_the_robot_is_rated_for(
    language: str,
) -> None:
    made = program(language, DECLARED[language], "")
    robot, vendor = find_robot(ROBOTS[language]), find_vendor(language)
    (heavy,) = [f for f in check(made, vendor, robot) if f.rule == "payload-exceeded"]
    assert RATED[language] in heavy.message
    assert f"rated for {robot.payload:g} kg" in heavy.message
    assert heavy.span == made.moves[2].statement
    strong = replace(robot, payload=41.0)
    assert "payload-exceeded" not in {f.rule for f in check(made, vendor, strong)}
