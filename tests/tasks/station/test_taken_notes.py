"""What a station says of programs whose course nobody knows, or that no controller takes."""

from __future__ import annotations

import flyby

from .stations import HOMES, UNUSED, Write

BRANCH = "IF diLong=1 THEN\n SetDO doLong,1;\n ENDIF\n rGripper"


def test_a_branch_and_a_routine_that_nobody_knows_are_told(write: Write) -> None:
    programs = {"one": ["go 0", BRANCH, "go 1", "SetDO doDone,1"], "two": ["WaitDI diGo,1", "go 0"]}
    made = flyby.station(write(programs, '[links]\n"one.doDone" = "two.diGo"\n'), no_proof=True)
    (note,) = (str(note) for note in made.notes if "not known:" in str(note))
    assert note.startswith("one: not known: routines that are not at hand: rGripper (")
    assert "branches of unknown condition: " in note and "answers = of the station file" in note


def test_what_no_controller_takes_keeps_interlocks_from_being_proven(write: Write) -> None:
    """It may have set a signal; two robots of which nothing is damaged are proven."""
    programs = {"one": ["go 0", "go 1", "SetDO doDone,1"], "two": ["WaitDI diGo,1", "go 0"]}
    links = '[links]\n"one.doDone" = "two.diGo"\n'
    assert flyby.station(write(programs, links), no_proof=True).orders is not None
    programs["one"].insert(1, ",1")
    made = flyby.station(write(programs, links), no_proof=True)
    assert made.orders is None
    assert any("one: " in str(note) and "stepped over" in str(note) for note in made.notes)


def test_the_passes_of_an_endless_loop_that_are_read_are_told(write: Write) -> None:
    there = f"MoveAbsJ [{HOMES[1]},{UNUSED}], v1000, fine, tool0"
    loop = f"WHILE TRUE DO\n {there};\n ENDWHILE\n WaitTime 0"
    made = flyby.station(write({"one": ["go 0", loop], "two": ["go 0", "go 1"]}), no_proof=True)
    assert any("one: " in str(note) and "2 passes are read" in str(note) for note in made.notes)
