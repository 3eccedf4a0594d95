"""What `flyby ask` proposes drives: as it stands it leads to moves, and it names what the program
compares what it receives with."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import flyby

EXTERNAL = "[9E9,9E9,9E9,9E9,9E9,9E9]"
RAPID = f"""MODULE m
  VAR socketdev s;
  VAR string got;
  VAR num n;
  VAR bool ok;
  CONST jointtarget home:=[[0,0,0,0,30,0],{EXTERNAL}];
  CONST jointtarget away:=[[30,0,0,0,30,0],{EXTERNAL}];
  PROC main()
    SocketReceive s\\Str:=got;
    BODY
  ENDPROC
ENDMODULE
"""
KRL = """DEF m()
DECL EKI_STATUS ret
DECL INT n
DECL CHAR got[20]
BAS(#INITMOV,0)
PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
BODY
PTP {A1 20,A2 -90,A3 90,A4 0,A5 30,A6 0}
END
"""
UR = """def m():
  socket_open("10.0.0.1", 30000)
  BODY
end
"""
MOVE, OTHER = (f"MoveAbsJ {name},v1000,fine,tool0;" for name in ("home", "away"))
PTP = "PTP {A1 10,A2 -90,A3 90,A4 0,A5 30,A6 0}"
MOVEJ = "movej([0,-1.5,1.5,0,1,0])\nmovej([0.3,-1.5,1.5,0,1,0])"
CASES = {
    "a text": (
        "m.mod",
        f'IF got="" THEN EXIT; ELSEIF got="PICK" THEN {MOVE} {OTHER} ELSE RETURN; ENDIF',
        "got",
        '"PICK"',
        '"", "PICK"',
    ),
    "cases": (
        "m.mod",
        f'TEST got CASE "STOP": EXIT; CASE "A","B": {MOVE} {OTHER} DEFAULT: EXIT; ENDTEST',
        "got",
        '"A"',
        '"STOP", "A", "B"',
    ),
    "a number in a text": (
        "m.mod",
        f"ok:=StrToVal(got,n); IF NOT ok THEN EXIT; ENDIF IF n>=3 THEN {MOVE} {OTHER} ENDIF",
        "got",
        '"3"',
        "3",
    ),
    "a text that drives as it is": ("m.mod", f"{MOVE} {OTHER}\nTPWrite got;", None, "", ""),
    "status": (
        "m.src",
        f'ret=EKI_Open("c")\nIF NOT ret.CONNECTED THEN\nHALT\nRETURN\nENDIF\n{PTP}',
        r"EKI_Open(\"c\")",
        "{ MSG_NO = 0, READ = 1, BUFF = 0, CONNECTED = true }",
        "",
    ),
    "a count": (
        "m.src",
        f'n=EKI_Check("c")\nSWITCH n\nCASE 2,5\n{PTP}\nDEFAULT\nRETURN\nENDSWITCH',
        r"EKI_Check(\"c\")",
        "2",
        "2, 5",
    ),
    "characters": (
        "m.src",
        'ret=EKI_GetString("c","x",got[])\n'
        f'IF StrComp(got[],"GO",#CASE_SENS) THEN\n{PTP}\n{PTP}\nELSE\nRETURN\nENDIF',
        "got[]",
        '"GO"',
        '"GO"',
    ),
    "a message": (
        "m.script",
        f'got = socket_read_string()\nif got == "":\nhalt\nelif got == "go":\n{MOVEJ}\nend',
        "socket_read_string()",
        '"go"',
        '"", "go"',
    ),
    "whether it is open": (
        "m.script",
        f'if socket_open("10.0.0.2") == False:\nhalt\nend\n{MOVEJ}',
        r"socket_open(\"10.0.0.2\")",
        "true",
        "false",
    ),
    "numbers": (
        "m.script",
        f"got = socket_read_ascii_float(3)\nif got[0] != 3:\nhalt\nend\n{MOVEJ}",
        "socket_read_ascii_float(3)",
        "[3, 0, 0, 0]",
        "",
    ),
}
ROBOTS = {".mod": "abb/irb2600-12-165", ".src": "kuka/kr16-2", ".script": "ur/ur10e"}
TEXTS = {".mod": RAPID, ".src": KRL, ".script": UR}


@pytest.mark.parametrize("case", CASES)
def test_what_is_proposed_leads_to_moves(case: str, tmp_path: Path) -> None:
    name, body, key, example, compared = CASES[case]
    path = tmp_path / name
    path.write_text(TEXTS[path.suffix].replace("BODY", body), "utf-8")
    asked = flyby.ask(path, robot=ROBOTS[path.suffix]).toml
    before = flyby.read(path, robot=ROBOTS[path.suffix])
    if key is not None:
        written = key if key.isidentifier() else f'"{key}"'
        (about, line) = re.search(r"(#.*)\n#" + re.escape(written) + " = (.*)", asked).groups()
        assert line == example
        assert (re.findall("compared with ([^;]*)", about) or [""]) == [compared]
    answers = tmp_path / "answers.toml"
    answers.write_text(re.sub(r'(?m)^#("[^\n]*"|\w+) = ', r"\1 = ", asked), "utf-8")
    after = flyby.read(path, robot=ROBOTS[path.suffix], answers=answers)
    assert len(after.moves) >= len(before.moves) >= 2
