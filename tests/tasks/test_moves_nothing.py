"""Programs that move nothing are driven to their end; of others it is said why none is reached."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

import flyby
from flyby.cli.main import app
from flyby.core.errors import MotionError

KRL = "DEF main( )\n{}\nEND\n"
TEXTS = {
    "ur/ur5e": ("main.script", "set_tcp(p[0,0,0.1,0,0,0])\nset_digital_out(1, True)\nsleep(1.5)\n"),
    "kuka/kr30-3": ("main.src", KRL.format("INT I\nI=3\nPULSE($OUT[2],TRUE,0.2)\nWAIT SEC 1.5")),
    "abb/irb1200-5-090": (
        "main.mod",
        "MODULE m\nPROC main()\nSetDO do1,1;\nWaitTime 1.5;\nENDPROC\nENDMODULE\n",
    ),
}


@pytest.mark.parametrize("robot", TEXTS)
def test_a_program_that_moves_nothing_takes_the_time_of_its_waits(robot, tmp_path) -> None:
    name, text = TEXTS[robot]
    path = tmp_path / name
    path.write_text(text, "utf-8")
    run = flyby.emulate(flyby.read(path, robot=robot), robot=robot)
    assert run.duration == pytest.approx(1.5)
    assert run.report.cycle_time == run.report.waiting == pytest.approx(1.5)
    assert not run.parts
    assert not run.causes
    with pytest.raises(MotionError, match="moves nothing: there is no trajectory"):
        _ = run.trajectory
    with pytest.raises(MotionError, match="moves nothing"):
        run.picture()
    done = CliRunner().invoke(app, ["emulate", str(path), "--robot", robot])
    assert done.exit_code == 0
    assert "moves nothing; its waits take 1.500 s" in " ".join(done.output.split())
    assert (
        CliRunner().invoke(app, ["emulate", str(path), "--robot", robot, "--json"]).exit_code == 0
    )
    assert CliRunner().invoke(app, ["check", str(path), "--robot", robot]).exit_code == 0
    refused = CliRunner().invoke(
        app, ["emulate", str(path), "--robot", robot, "--csv", str(tmp_path / "a.csv")]
    )
    assert refused.exit_code == 1


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("Station1( )\nStation2( )", "Station1 and Station2 are not at hand: put the files beside"),
        ("IF way( )>0 THEN\nRETURN\nENDIF\nIF $IN[1] THEN\nHALT\nENDIF", "nothing in it moves"),
    ],
)
def test_why_a_program_has_no_move(text, why, tmp_path) -> None:
    path = tmp_path / "main.src"
    path.write_text(KRL.format(text), "utf-8")
    program = flyby.read(path, robot="kuka/kr30-3")
    if why.startswith("nothing"):
        assert not flyby.emulate(program, robot="kuka/kr30-3").parts
        return
    with pytest.raises(MotionError, match=why):
        flyby.emulate(program, robot="kuka/kr30-3")


_DECIDED = """def main():
  go = False
  c = socket_read_line()
  if c == "a":
    go = True
  end
  if go:
    movej([0,-1,1,-1,-1,0])
    movej([0,-1,1,-1,-1,1])
  end
end
main()
"""


def test_what_decides_that_no_move_is_reached_is_named(tmp_path) -> None:
    path = tmp_path / "main.script"
    path.write_text(_DECIDED, "utf-8")
    read = flyby.read(path, robot="ur/ur5e")
    assert any("leads to no move: branch 1, whose moves" in note.message for note in read.notes)
    assert flyby.emulate(read, robot="ur/ur5e").duration > 0
    answers = tmp_path / "answers.toml"
    answers.write_text('[values]\n"socket_read_line()" = "b"\n', "utf-8")
    with pytest.raises(MotionError, match=r"reaches no move: the answers to socket_read_line"):
        flyby.emulate(flyby.read(path, robot="ur/ur5e", answers=answers), robot="ur/ur5e")


def test_what_decides_of_a_program_that_goes_nowhere_is_named(tmp_path) -> None:
    """It drives to where it stands, and then waits for orders."""
    path = tmp_path / "main.src"
    lines = "at=$AXIS_ACT\nPTP at\nLOOP\nIF next(at)>0 THEN\nPTP at\nENDIF\nENDLOOP"
    path.write_text(KRL.format(lines), "utf-8")
    program = flyby.read(path, robot="kuka/kr30-3")
    with pytest.raises(MotionError, match=r"goes nowhere: .*, or say which way it goes in line "):
        flyby.emulate(program, robot="kuka/kr30-3")


@pytest.mark.parametrize("start", [None, "0,-90,90,0,90,0"])
def test_a_start_is_named_where_another_one_leads_somewhere_else(start, tmp_path) -> None:
    """A text that says none has been tried from another one."""
    path = tmp_path / "main.script"
    goes = "movej([0,-1.5707963,1.5707963,0,1.5707963,0])" if start else "movel(at)"
    path.write_text(f"at = get_actual_tcp_pose()\n{goes}\n{goes}\n", "utf-8")
    program = flyby.read(path, robot="ur/ur5e", start=start)
    with pytest.raises(MotionError, match="goes nowhere") as refused:
        flyby.emulate(program, robot="ur/ur5e")
    assert ("(start)" in str(refused.value)) == bool(start)


SERVERS = {
    "ur/ur5e": (
        "main.script",
        "def main():\n  while True:\n    sleep(1)\n  end\n  home()\nend\n"
        "def home():\n  movej([0,-1,1,-1,-1,0])\n  movej([0,-1,1,-1,-1,1])\nend\nmain()\n",
    ),
    "kuka/kr30-3": (
        "main.src",
        "DEF main( )\nLOOP\nWAIT SEC 1\nENDLOOP\nhome( )\nEND\nDEF home( )\n"
        "PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}\nPTP {A1 9,A2 -90,A3 90,A4 0,A5 30,A6 0}\nEND\n",
    ),
    "abb/irb1200-5-090": (
        "main.mod",
        "MODULE m\nPROC main()\nWHILE TRUE DO\nWaitTime 1;\nENDWHILE\nhome;\nENDPROC\n"
        "PROC home()\nMoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\n"
        "MoveAbsJ [[9,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\nENDPROC\n"
        "ENDMODULE\n",
    ),
}


@pytest.mark.parametrize("robot", SERVERS)
def test_where_the_beginning_reaches_no_move_the_others_are_driven(robot, tmp_path) -> None:
    name, text = SERVERS[robot]
    path = tmp_path / name
    path.write_text(text, "utf-8")
    for named in (["--robot", robot], []):
        done = CliRunner().invoke(app, ["emulate", str(path), *named])
        assert done.exit_code == 0, done.output
        said = " ".join(done.stderr.split())
        assert "reaches no move: each routine that moves the robot is driven by itself" in said
        assert "1 of 1 routine driven to the end" in " ".join(done.stdout.split())
    # Whoever wants one program has to name it.
    csv = CliRunner().invoke(
        app, ["emulate", str(path), "--robot", robot, "--csv", str(tmp_path / "a.csv")]
    )
    assert csv.exit_code == 1
    assert "choose as the entry the routine that drives: home (2 moves)" in csv.stderr


def test_where_a_computer_sends_the_motion_the_message_says_what_drives_it(tmp_path) -> None:
    """And that does, without a robot that is named."""
    path, answers = tmp_path / "main.src", tmp_path / "answers.toml"
    tests = "IF RSI_ON(#ABSOLUTE)<>0 THEN\nHALT\nENDIF"
    path.write_text(KRL.format(f"PTP $POS_ACT\n{tests}\nRSI_MOVECORR( )"), "utf-8")
    done = CliRunner().invoke(app, ["emulate", str(path)])
    said = " ".join(done.output.split())
    assert done.exit_code == 1 and "line" in said and "nobody says which way" not in said
    remedy = '[streams] RSI_MOVECORR = "joints.csv", whose first line is time,j1,j2,…'
    assert f"a computer sends its motion at RSI_MOVECORR in line 6: say that in {remedy}" in (
        said.replace("a file of joints over time (--io: ", "")
    )
    answers.write_text('[streams]\nRSI_MOVECORR = "joints.csv"\n', "utf-8")
    rows = ["time,j1,j2,j3,j4,j5,j6", "0,0,-90,90,0,10,0", "1,5,-90,90,0,10,0"]
    (tmp_path / "joints.csv").write_text("\n".join(rows), "utf-8")
    done = CliRunner().invoke(app, ["emulate", str(path), "--io", str(answers)])
    assert done.exit_code == 0 and "cycle time" in done.output


HERE = {
    "m.mod": "MODULE m\nVAR jointtarget j;\nVAR robtarget p;\nVAR num n;\nPROC main()\n{}\n"
    "ENDPROC\nENDMODULE\n",
    "m.script": "def m():\n{}\nend\n",
}
ROBOTS = {"m.mod": "abb/irb2600-12-165", "m.script": "ur/ur10e"}


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        ("m.mod", "p:=CRobT();\nMoveL p,v200,fine,tool0;\nMoveJ p,v200,fine,tool0;"),
        ("m.mod", 'p:=CRobT();\nTPReadNum n,"up";\nMoveL Offs(p,0,0,n),v200,fine,tool0;'),
        ("m.script", "p = get_actual_tcp_pose()\nmovel(p)\nmovej(p)"),
    ],
)
def test_where_another_start_alone_does_not_help_that_is_said(name, lines, tmp_path) -> None:
    path = tmp_path / name
    path.write_text(HERE[name].format(lines), "utf-8")
    with pytest.raises(MotionError, match="goes nowhere") as caught:
        flyby.emulate(flyby.read(path, robot=ROBOTS[name]))
    message = str(caught.value)
    assert ("nobody says" in message) == ("TPReadNum" in lines)
    if "nobody says" not in message:
        assert "targets are made of where it stands" in message
        assert "let it begin elsewhere" not in message


def test_one_axis_set_to_where_the_ready_posture_has_it_is_driven(tmp_path) -> None:
    path = tmp_path / "m.mod"
    lines = "j:=CJointT();\nj.robax.rax_6:=0;\nMoveAbsJ j,v200,fine,tool0;"
    path.write_text(HERE["m.mod"].format(lines), "utf-8")
    run = flyby.emulate(flyby.read(path, robot=ROBOTS["m.mod"]))
    assert not run.faults and run.duration > 0
    assert any("is taken to stand at -7°" in note.message for note in run.program.notes)


MET = {
    "ur/ur5e": (
        ("  while True:", "  serve()\nend\ndef serve():\n  while True:"),
        ("def home", "def other():\n  movej([0,-1,1,-1,-1,2])\nend\ndef home"),
    ),
    "kuka/kr30-3": (
        ("LOOP\nWAIT", "serve( )\nEND\nDEF serve( )\nLOOP\nWAIT"),
        ("DEF home", "DEF other( )\nPTP {A1 1,A2 -90,A3 90,A4 0,A5 30,A6 0}\nEND\nDEF home"),
    ),
    "abb/irb1200-5-090": (
        ("WHILE", "serve;\nENDPROC\nPROC serve()\nWHILE"),
        ("PROC home", "PROC other()\nMoveAbsJ p,v100,fine,tool0;\nENDPROC\nPROC home"),
    ),
}


@pytest.mark.parametrize("robot", MET)
def test_a_routine_that_the_beginning_has_met_is_not_driven_by_itself(robot, tmp_path) -> None:
    name, text = SERVERS[robot]
    for old, new in MET[robot]:
        text = text.replace(old, new, 1)
    path = tmp_path / name
    path.write_text(text, "utf-8")
    done = CliRunner().invoke(app, ["emulate", str(path), "--robot", robot])
    assert "reaches no move" in done.stderr
    driven = [line.split("(")[0].strip() for line in done.stdout.splitlines() if "move" in line]
    assert {"other", "home"} <= set(driven) and "serve" not in driven
