"""Where the branches that are taken lead to no known move, others are tried, within bounds."""

from __future__ import annotations

from flyby.core.errors import Span
from flyby.core.program.program import Program
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.limits import Executed
from flyby.core.source.reading import Files, ReadOptions, read_with
from flyby.core.source.text.files import SourceFile
from flyby.vendors.abb.run.reader import read_sources

HEAD = """MODULE m
VAR num n:=0;
CONST robtarget p:=[[900,0,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
  FOR i FROM 1 TO %d DO
    n:=n+i;
  ENDFOR
%s
ENDPROC
PROC pick(num k)
  MoveJ p,v100,fine,tool0;
ENDPROC
ENDMODULE
"""


def readings(text: str, executed: Executed | None = None) -> tuple[Program, int]:
    count = 0
    options = ReadOptions(answers=Answers(goes_on=True), executed=executed)

    def read(files: Files, main: str, options: ReadOptions) -> Program:
        nonlocal count
        count += 1
        return read_sources(files, main, options)

    return read_with({"m.mod": SourceFile("m.mod", text)}, "m.mod", options, read), count


def test_a_long_program_is_not_read_for_every_branch() -> None:
    branches = "".join(f"  IF di{k}=1 THEN\n    n:={k};\n  ENDIF\n" for k in range(12))
    short, many = readings(HEAD % (10, branches))
    long, few = readings(HEAD % (30_000, branches))
    assert many > 12 and few <= 5
    assert not short.moves and not long.moves


def test_statements_of_branches_that_were_only_tried_are_not_executed() -> None:
    branches = (
        "  IF di1=1 THEN\n    n:=1;\n  ENDIF\n"
        "  IF di2=1 THEN\n    n:=2;\n  ELSEIF di3=1 THEN\n    n:=3;\n  ENDIF\n"
    )
    told: list[Span] = []
    text = HEAD % (1, branches)
    readings(text, told.append)
    lines = {text.split("\n")[span.line - 1].strip() for span in told}
    assert "n:=n+i;" in lines and not {"n:=3;", "n:=2;"} <= lines
