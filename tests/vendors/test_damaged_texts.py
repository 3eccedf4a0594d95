"""Texts that no controller takes, in every language: what can be read is driven, and it is said."""

from __future__ import annotations

import pytest

from flyby.core.driving.past_faults import drive
from flyby.core.errors import FaultCause, ParseError, SourceError
from flyby.core.lint.check import check
from flyby.core.lint.finding import Severity
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import Opaque
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers

ROBOTS = {"abb": "abb/irb1200-5-090", "kuka": "kuka/kr30-3", "ur": "ur/ur5e"}
FRAME = {
    "abb": "MODULE demo\nVAR num n;\nPROC main()\n{}\nENDPROC\nENDMODULE\n",
    "kuka": "DEF demo( )\nBAS(#INITMOV,0)\n{}\nEND\n",
    "ur": "def demo():\n{}\nend\n",
}
HOME = {
    "abb": "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;",
    "kuka": "PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}",
    "ur": "movej([0,-1.57,1.57,-1.57,-1.57,0])",
}
LOW = {
    "abb": "MoveJ [[450,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;",
    "kuka": "PTP {X 1300,Y 0,Z 900,A 0,B 90,C 0}",
    "ur": "movej(p[-0.45,0.1,0.3,2.2214,2.2214,0])",
}
STILL = {
    "abb": ("n = n + 1;", "TPWrite \"it's;", "n:=;", "Set do1 do2;"),
    "kuka": ('TPWrite "hello"', "PRINT “done”", "n = 3 +", '$OUT[1] == TRUE = "a'),
    "ur": ("n += 1", 'print "hello"', "n = {{START}}", "set_digital_out(1, True"),
}
"""Statements that are none, and no motions."""
MOTION = {
    "abb": "MoveJ [[450,0,600],v100,fine,tool0;",
    "kuka": "PTP {X 1300,Y 0 Z,900}",
    "ur": "movej(p[-0.45,0.1,0.3,2.2214,2.2214,0]",
}
OPEN = {"abb": "IF n=1 THEN", "kuka": "IF n==1 THEN", "ur": "if n == 1:"}
SUFFIX = {"abb": "demo.mod", "kuka": "demo.src", "ur": "demo.script"}
LANGUAGES = tuple(ROBOTS)


def read(language: str, *lines: str, text: str = "{}", goes_on: bool = True) -> Program:
    frame = FRAME[language] if text == "{}" else text
    whole = frame.replace("{}", "\n".join(lines))
    return find_vendor(language).read(
        whole,
        SUFFIX[language],
        robot=find_robot(ROBOTS[language]),
        answers=Answers(goes_on=goes_on, mends=goes_on),
    )


@pytest.mark.parametrize(("language", "line"), [(v, line) for v in LANGUAGES for line in STILL[v]])
def test_what_is_no_statement_is_stepped_over_and_said(language, line) -> None:
    made = read(language, HOME[language], line, LOW[language])
    assert len(made.moves) == 2
    assert not any(move.open for move in made.moves)
    assert any(isinstance(s, Opaque) and s.text == line for s in made.statements)
    (note,) = (n for n in made.notes if "no controller takes this; it is stepped over" in n.message)
    head = FRAME[language].partition("{}")[0].count("\n")
    assert note.span is not None
    assert note.span.line == head + 2


@pytest.mark.parametrize(("language", "line"), [(v, line) for v in LANGUAGES for line in STILL[v]])
def test_a_strict_reader_refuses_it(language, line) -> None:
    with pytest.raises(ParseError):
        read(language, HOME[language], line, LOW[language], goes_on=False)


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_damaged_motion_goes_where_nobody_knows(language) -> None:
    made = read(language, HOME[language], MOTION[language], LOW[language])
    assert [bool(move.open) for move in made.moves] == [False, True, False]
    span = made.moves[1].statement
    assert span is not None
    assert span.line == FRAME[language].partition("{}")[0].count("\n") + 2


MORE_MOTIONS = {
    "abb": ("GlueL pA v100, glue1, fine, tool0;", "MoveExtJ jA v1;", "ArcLStart pA v100, s, w;"),
    "kuka": ("SPTP_REL {A1 1 A2 2}", "SLIN XP1 WITH $VEL=2 {", "SPL XP1"),
    "ur": ("optimovel(p[0,0,0", "servoj([0,0,0,0,0,0]"),
}
"""Motions that have other words than the everyday ones."""
CALLED = {
    "abb": (
        "MODULE demo\nPROC main()\n{}\nENDPROC\nPROC away()\n%s\nENDPROC\nENDMODULE\n",
        "away 1 2;",
    ),
    "kuka": ("DEF demo( )\nBAS(#INITMOV,0)\n{}\nEND\nDEF away( )\n%s\nEND\n", "away(1 2)"),
    "ur": ("def demo():\n  def away():\n%s\nend\n{}\nend\n", "away(1 2"),
}
"""A routine that moves, and a call of it that is damaged."""
SETS = {
    "abb": "p10:=[[450,0,600],[0,0,1,0][0,0,0,0]];",
    "kuka": "XP1={X 1300,Y 0 Z,900}",
    "ur": "p10 = p[-0.45,0.1,0.4,2.2214,2.2214,0",
}
USED = {
    "abb": "MoveJ p10,v100,fine,tool0;",
    "kuka": "PTP XP1",
    "ur": "movej(p10)",
}


@pytest.mark.parametrize(
    ("language", "line"), [(v, line) for v in LANGUAGES for line in MORE_MOTIONS[v]]
)
def test_no_damaged_motion_is_lost(language, line) -> None:
    made = read(language, HOME[language], line, LOW[language])
    assert [bool(move.open) for move in made.moves] == [False, True, False]


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_damaged_call_of_what_moves_goes_where_nobody_knows(language) -> None:
    text, call = CALLED[language]
    made = read(language, HOME[language], call, LOW[language], text=text % LOW[language])
    assert [bool(move.open) for move in made.moves] == [False, True, False]


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_a_damaged_line_sets_is_not_known_any_more(language) -> None:
    given = {
        "abb": "p10:=[[450,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];",
        "kuka": "XP1={X 1300,Y 0,Z 900,A 0,B 90,C 0}",
        "ur": "p10 = p[-0.45,0.1,0.3,2.2214,2.2214,0]",
    }[language]
    text = {
        "abb": FRAME["abb"].replace("VAR num n;", "VAR robtarget p10;"),
        "kuka": FRAME["kuka"].replace("BAS", "DECL E6POS XP1\nBAS", 1),
        "ur": FRAME["ur"],
    }[language]
    lines = (HOME[language], given, USED[language], SETS[language], USED[language])
    made = read(language, *lines, text=text)
    assert [bool(move.open) for move in made.moves] == [False, False, True]


def test_a_damaged_declaration_hides_others_of_its_name() -> None:
    place = "[[450,0,500],[0,0,1,0],[0,0,0,0]%s[9E9,9E9,9E9,9E9,9E9,9E9]]"
    text = (
        f"MODULE other\nCONST robtarget p10:={place % ','};\nENDMODULE\n"
        f"MODULE demo\nLOCAL CONST robtarget p10:={place % ''};\nPROC main()\n{{}}\nENDPROC\n"
        "ENDMODULE\n"
    )
    made = read("abb", HOME["abb"], USED["abb"], text=text)
    assert [bool(move.open) for move in made.moves] == [False, True]


@pytest.mark.parametrize("language", LANGUAGES)
def test_nothing_to_drive_and_blocks_that_nobody_closes_are_refused_for_the_first_damage(
    language,
) -> None:
    line = STILL[language][0]
    place = f":{FRAME[language].partition('{}')[0].count(chr(10)) + 1}:"
    with pytest.raises(SourceError, match=place):
        read(language, line)
    if language == "ur":  # the 'end' of the function closes it
        return
    with pytest.raises(SourceError, match=place):
        read(language, line, HOME[language], OPEN[language])


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_is_damaged_all_over_is_no_program(language) -> None:
    lines = [line for line in STILL[language] for _ in range(12)]
    with pytest.raises(ParseError):
        read(language, HOME[language], *lines, LOW[language])


def test_a_semicolon_that_is_missing_is_read_as_if_it_stood_there() -> None:
    made = read("abb", HOME["abb"].rstrip(";"), "n:=n+1", "WaitTime 1", LOW["abb"])
    assert len(made.moves) == 2
    assert (
        "it is read as if it stood there (and 2 like it)" in told(made)
        or told(made).count("it is read as if it stood there") == 3
    )


def test_arguments_go_on_in_the_next_line() -> None:
    made = read("abb", HOME["abb"], "n:=;", LOW["abb"].replace(",v100,", "\n,v100,\n"))
    assert not made.moves[1].open


@pytest.mark.parametrize(
    ("language", "text"),
    [
        ("abb", "VAR num n;\nPROC main()\n{}\nENDPROC\n"),
        ("kuka", "$VEL.CP=0.1\n{}\n"),
        ("ur", "{}\n"),
    ],
)
def test_a_part_of_a_program_is_read_as_all_of_it(language, text) -> None:
    made = read(language, HOME[language], LOW[language], text=text)
    assert len(made.moves) == 2
    if language != "ur":
        assert "is read as" in told(made)
        with pytest.raises(ParseError):
            read(language, HOME[language], LOW[language], text=text, goes_on=False)


def told(made: Program) -> str:
    return " ".join(note.message for note in made.notes)


def test_comments_of_other_languages_in_rapid_are_comments() -> None:
    made = read(
        "abb",
        'TPWrite "http://plc\\\\a"; ! as it should be',
        f"{HOME['abb']}// first; home",
        "n:=2;\\\\ and so on, (",
        f"{LOW['abb']} // down",
    )
    assert [bool(move.open) for move in made.moves] == [False, False]
    (note,) = (n for n in made.notes if "begins no comment in RAPID" in n.message)
    assert note.span is not None
    assert note.span.line == 5


def test_a_module_without_its_end_is_read() -> None:
    text = "MODULE demo\nPROC main()\n{}\nENDPROC\n"
    made = read("abb", HOME["abb"], LOW["abb"], text=text)
    assert len(made.moves) == 2
    assert any("ENDMODULE is missing" in note.message for note in made.notes)
    with pytest.raises(ParseError):
        read("abb", HOME["abb"], LOW["abb"], text=text, goes_on=False)


TWICE = (
    "MODULE demo\nPERS num high:=100;\nPERS num high:={again};\nCONST robtarget p:="
    "[[450,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC main()\n{}\nENDPROC\n"
    "PROC main()\nStop;\nENDPROC\nENDMODULE\n"
)


@pytest.mark.parametrize(("again", "known"), [(" 100", True), ("120", False)])
def test_a_datum_that_is_declared_twice_is_known_if_both_agree(again: str, known: bool) -> None:
    line = "MoveL Offs(p,0,0,high),v100,fine,tool0;"
    made = read("abb", HOME["abb"], line, text=TWICE.replace("{again}", again))
    assert [bool(move.open) for move in made.moves] == [False, not known]
    said = [note.message for note in made.notes if "is declared twice" in note.message]
    assert len(said) == 2
    assert "main is declared twice: first at line 5: no controller takes this" in said[0]
    with pytest.raises(SourceError, match="is declared twice"):
        read("abb", line, text=TWICE.replace("{again}", again), goes_on=False)


SETTINGS = (
    ("VelSet 10 100;", "VelSet 100,5000;"),
    ("VelSet 0,100;", "VelSet 100,5000;"),
    ("VelSet n,;", "VelSet 50,5000;"),
    ("AccSet 50 50;", "AccSet 100,100;"),
    ("AccSet;", "AccSet 100,100;"),
    ("ConfL \\Of;", "ConfL \\Off;"),
    ("GripLoad load0 load0;", "GripLoad load0;"),
    ("PathAccLim TRUE;", "PathAccLim FALSE,FALSE;"),
    ("SpeedRefresh 150;", "SpeedRefresh 100;"),
)
"""A damaged setting, and one that makes it known again."""


@pytest.mark.parametrize(("damaged", "whole"), SETTINGS)
def test_a_damaged_setting_leaves_open_how_moves_behind_it_are_driven(damaged, whole) -> None:
    line = LOW["abb"].replace("MoveJ", "MoveL")
    made = read("abb", HOME["abb"], damaged, line, line, whole, line)
    assert [bool(move.unsettled) for move in made.moves] == [False, True, True, False]
    assert not any(move.open for move in made.moves)
    assert f"{damaged.partition(' ')[0].rstrip(';')}" in made.moves[1].unsettled
    with pytest.raises(SourceError):
        read("abb", HOME["abb"], damaged, line, goes_on=False)


@pytest.mark.parametrize("damaged", ["PDispSet;", "PDispSet [[0,0,0],[1,0,0,0];", "EOffsSet 1;"])
def test_a_damaged_displacement_leaves_open_where_moves_go(damaged: str) -> None:
    end = "EOffsOff;" if damaged.startswith("E") else "PDispOff;"
    made = read("abb", HOME["abb"], damaged, LOW["abb"], end, LOW["abb"])
    assert [bool(move.open) for move in made.moves] == [False, True, False]


def test_no_time_is_claimed_across_a_damaged_setting() -> None:
    robot = find_robot(ROBOTS["abb"])
    controller = Controller(find_vendor("abb"), robot)
    up = LOW["abb"].replace("500]", "600]")
    made = read("abb", LOW["abb"], up, "VelSet 10 100;", LOW["abb"], "VelSet 100,5000;", up)
    driven = drive(controller, made)
    assert [(fault.move, fault.cause) for fault in driven.faults] == [(2, FaultCause.OPEN)]
    assert [part.first for part in driven.parts] == [0, 3]


def test_no_default_is_taken_for_what_is_damaged() -> None:
    text = FRAME["abb"].replace("VAR num n;", "VAR num n:=3+;\nCONST speeddata v:=[1,2,3 4];")
    lines = (
        "MoveJ Offs([[450,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],0,0,1+n),v100,"
        "fine,tool0;",
        LOW["abb"].replace("v100", "v"),
        "WaitTime n;",
        LOW["abb"],
    )
    made = read("abb", HOME["abb"], *lines, text=text)
    assert [bool(move.open) for move in made.moves] == [False, True, False, False]
    assert [bool(move.unsettled) for move in made.moves] == [False, False, True, False]


_LINE = {
    "kuka": "LIN {X 1300,Y 0,Z 900,A 0,B 90,C 0}",
    "ur": "movel(p[-0.45,0.1,0.3,2.2214,2.2214,0])",
}
_SETTINGS = {
    "$VEL.CP=0.2": "$VEL.CP = ",
    "BAS(#VEL_CP,0.2)": "BAS(#VEL_CP,",
    "BAS(#TOOL,1)": "BAS(#TOOL",
    "BAS(#BASE,1)": "BAS(#BASE 1)",
    "$TOOL=TOOL_DATA[2]": "$TOOL=TOOL_DATA[",
    "LDAT_ACT={VEL 0.2,ACC 50}\nBAS(#CP_DAT)": "LDAT_ACT={VEL 0.2,ACC\nBAS(#CP_DAT)",
    "slow(0.2)": "slow(0.2",
    "set_tcp(p[0,0,0.1,0,0,0])": "set_tcp(p[0,0,]",
    "set_payload(2)": "set_payload()) 2",
    "grip(1)": "grip(1",
}
_PLACES = ("TOOL", "BASE", "LDAT", "tcp", "grip")
"""In the settings that say where moves go: frames, and how they turn the tool."""
_ROUTINES = {
    "slow": "DEF demo( )\nBAS(#INITMOV,0)\n{}\nEND\nDEF slow(v:IN)\nREAL v\n$VEL.CP=v\nEND\n",
    "grip": "def demo():\n  def grip(n):\n    set_tcp(p[0,0,0.1*n,0,0,0])\n  end\n{}\nend\n",
}


@pytest.mark.parametrize("whole", _SETTINGS)
def test_moves_behind_a_damaged_setting_are_faults_until_it_is_set_again(whole) -> None:
    """A speed, a tool or a payload from before would give a time that nobody can vouch for."""
    language = "ur" if whole.startswith(("set_", "grip")) else "kuka"
    line, text = _LINE[language], _ROUTINES.get(whole.partition("(")[0], "{}")
    made = read(language, HOME[language], line, _SETTINGS[whole], line, whole, line, text=text)
    lost = [move.open or move.unsettled for move in made.moves]
    assert list(map(bool, lost)) == [False, False, True, False]
    assert "mend that line" in lost[2]
    # Behind a move whose target is known the robot stands there.
    assert bool(made.moves[2].open) == any(word in whole for word in _PLACES)


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_time_is_claimed_for_one_move_alone(language) -> None:
    """The robot stands at the target of a move of which nobody knows how it is driven."""
    lines = {
        "abb": ("VelSet 10 100;", "VelSet 100,5000;", LOW["abb"].replace("MoveJ", "MoveL")),
        "kuka": ("$VEL.CP = ", "$VEL.CP=0.2", _LINE["kuka"]),
        "ur": ("set_payload()) 2", "set_payload(2)", _LINE["ur"]),
    }
    damaged, whole, line = lines[language]
    controller = Controller(find_vendor(language), find_robot(ROBOTS[language]))
    back = {"abb": LOW["abb"].replace("500]", "600]"), **HOME}[language]
    driven = drive(controller, read(language, HOME[language], damaged, line, whole, back))
    assert [(fault.move, fault.cause) for fault in driven.faults] == [(1, FaultCause.OPEN)]
    assert not driven.program.moves[1].open


def test_a_damaged_call_of_what_sets_a_load_loses_it() -> None:
    text = FRAME["abb"].replace("PROC main", "PROC hold()\nGripLoad load1;\nENDPROC\nPROC main")
    made = read("abb", HOME["abb"], "hold load1 load2;", LOW["abb"], text=text)
    assert "line" in made.moves[1].unsettled


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_check_finds_damaged_lines(language: str) -> None:
    made = read(language, HOME[language], STILL[language][0], LOW[language])
    found = check(made, find_vendor(language), find_robot(ROBOTS[language]))
    (finding,) = (f for f in found if f.rule == "damaged-text")
    assert finding.severity is Severity.ERROR
    assert finding.span is not None
    assert finding.span.line == FRAME[language].partition("{}")[0].count("\n") + 2
    assert not [f for f in found if f.rule == "reader" and f.span == finding.span]


@pytest.mark.parametrize(
    ("setting", "whole"),
    [
        ("VelSet n,500;", "VelSet 100,5000;"),
        ("AccSet 50,n;", "AccSet 100,100;"),
        ("SpeedRefresh n;", "SpeedRefresh 100;"),
        ("PathAccLim TRUE\\AccMax:=n,FALSE;", "PathAccLim FALSE,FALSE;"),
    ],
)
def test_a_setting_made_of_what_is_damaged_is_not_known(setting: str, whole: str) -> None:
    text = FRAME["abb"].replace("VAR num n;", "VAR num n:=3+;")
    made = read("abb", HOME["abb"], setting, LOW["abb"], whole, LOW["abb"], text=text)
    assert [bool(move.unsettled) for move in made.moves] == [False, True, False]
    assert "line 2" in made.moves[1].unsettled


def test_a_function_in_a_setting_runs_once() -> None:
    text = (
        f"MODULE demo\nFUNC num share()\n{LOW['abb']}\nRETURN 50;\nENDFUNC\nPROC main()\n{{}}\n"
        "ENDPROC\nENDMODULE\n"
    )
    made = read("abb", HOME["abb"], "VelSet share(),5000;", LOW["abb"], text=text)
    assert len(made.moves) == 3


def test_a_speed_made_of_what_is_damaged_is_not_known() -> None:
    text = FRAME["abb"].replace("VAR num n;", "VAR num n:=3+;")
    made = read("abb", HOME["abb"], LOW["abb"].replace("v100", "v100\\V:=n"), text=text)
    assert [bool(move.unsettled) for move in made.moves] == [False, True]


_PICKS = """def cell():
  def home():
    movej([0,-1.57,1.57,-1.57,-1.57,0])
  {end_of_home}
  def pick():
    if True:
      movel(p[-0.45,0.1,0.3,2.2214,2.2214,0])
    {end_of_if}
  end
  home()
  pick()
{last}
"""


@pytest.mark.parametrize("last", ["end", ""])
def test_a_function_without_its_end_ends_where_the_next_begins(last: str) -> None:
    whole = _PICKS.format(end_of_home="end", end_of_if="end", last="end")
    made = read("ur", text=_PICKS.format(end_of_home="", end_of_if="end", last=last))
    assert [m.target for m in made.moves] == [m.target for m in read("ur", text=whole).moves]
    if not last:  # the last one that a file lacks is no riddle
        assert any("the 'end' of this 'def' is missing" in n.message for n in made.notes)
        assert any("is taken to end before line 5" in n.message for n in made.notes)


def test_lines_that_do_not_show_where_a_block_ends_are_refused() -> None:
    flat = "\n".join(line.strip() for line in _PICKS.splitlines())
    with pytest.raises(SourceError, match="the file ends where 'end'"):
        read("ur", text=flat.format(end_of_home="", end_of_if="", last=""))


def test_an_end_too_many_is_left_out_where_nothing_follows() -> None:
    whole = _PICKS.format(end_of_home="end", end_of_if="end", last="end")
    made = read("ur", text=whole + "end\n\nend\n")
    assert made.moves == read("ur", text=whole).moves
    assert any("closes nothing" in note.message and note.damage for note in made.notes)
    with pytest.raises(SourceError, match="closes nothing"):
        read("ur", text=whole + "end\nhome()\n")
