"""Branches and loops that cannot be decided: one idea in three languages has one outcome.

In the texts ``<A>`` to ``<D>`` are joint moves that differ in the first axis, ``<IN>`` is a
condition on an input that nobody knows, ``<IN2>`` another one.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

import pytest

from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.limits import ExecutionLimits
from flyby.core.source.reading import ReadOptions

EXTERNAL = ",".join(["9E9"] * 6)
FIRST_LINE = 4
"""Of a body in its file."""


@dataclass(frozen=True)
class Dialect:
    """How a language says what the texts leave out."""

    file: str
    whole: str
    move: str
    inputs: tuple[str, str]

    def text(self, body: str) -> str:
        for k, letter in enumerate("ABCD", 1):
            body = body.replace(f"<{letter}>", self.move.replace("#", str(10 * k)))
        body = body.replace("<IN>", self.inputs[0]).replace("<IN2>", self.inputs[1])
        return self.whole.replace("BODY", body)

    def plain(self, message: str) -> str:
        """A message without the language's own words."""
        message = message.split(" (in PROC")[0].replace("the value of ", "")
        message = message.replace(", which is not declared in what is at hand (a signal?)", "")
        for name in self.inputs:
            message = message.replace(f"'{name.split('=')[0]}'", "<IN>").replace(name, "<IN>")
        return re.sub(r"the (program is an endless loop|loop) \(.*?\)(?=[: ])", r"the \1", message)


LANGUAGES = {
    "abb": Dialect(
        "m.mod",
        "MODULE m\nPROC main()\nVAR num n:=0; VAR num k; VAR bool go:=TRUE; VAR jointtarget j;\n"
        "BODY\nENDPROC\nENDMODULE\n",
        f"MoveAbsJ [[#,0,0,0,0,0],[{EXTERNAL}]],v100,fine,tool0;",
        ("di1=1", "di2=1"),
    ),
    "kuka": Dialect(
        "m.src",
        "DEF m()\nDECL INT N,I,K\nDECL BOOL GO\nBODY\nEND\n",
        "PTP {A1 #,A2 -90,A3 90,A4 0,A5 0,A6 0}",
        ("$IN[1]", "$IN[2]"),
    ),
    "ur": Dialect(
        "m.script",
        "def m():\nn = 0\ngo = True\nBODY\nend\n",
        "movej([d2r(#),0,0,0,0,0], a=1, v=1)",
        ("get_digital_in(1)", "get_digital_in(2)"),
    ),
}


@dataclass(frozen=True)
class Case:
    """One idea.

    Args:
        abb, kuka, ur: bodies.
        driven: the moves, in order.
        said: a note, without the language's own words; None for no note.
        branches, passes: answers, by the line of the body, from 1.
    """

    abb: str
    kuka: str
    ur: str
    driven: str
    said: str | None = None
    branches: dict[int, int] = field(default_factory=dict)
    passes: dict[int, int] = field(default_factory=dict)


IS_TAKEN = (
    "the condition depends on <IN>: branch {} of {}, the first that moves the robot, is taken"
)
NOT_FULFILLED = (
    "the condition depends on <IN>: no branch that moves the robot: taken as not fulfilled"
)
NOT_LED_ELSEWHERE = (
    "the condition depends on <IN>: branch 1 of 1 leads elsewhere: taken as not fulfilled, and "
    "other moves may be driven if it is"
)
ONCE = "the end of the loop depends on <IN>: its body runs once"
AT_ONCE = "the end of the loop depends on <IN>: it does not move the robot and is left at once"
WAY_OUT = f"{ONCE}, and then this way out is taken"
ENDLESS = "the program is an endless loop: one pass is read"
IDLE = "the program is an endless loop: the program ends there"
WAITS = (
    "the loop only waits for what the program does not change itself: it is taken as satisfied "
    "at once"
)
UNMOVED = "does not move the robot, as nothing fulfils the conditions of its motion"
STANDS = f"the program is an endless loop that {UNMOVED}: the program ends there"
WAITS_UNMOVED = WAITS.replace("only waits", f"{UNMOVED}, and only waits")

LONG = (
    "the loop has run 100 times without a move and goes on: it is left, as one that only passes "
    "time"
)

UNDECIDED_IF = Case(
    "IF <IN> THEN\n<A>\nELSE\n<B>\nENDIF\n<C>",
    "IF <IN> THEN\n<A>\nELSE\n<B>\nENDIF\n<C>",
    "if <IN>:\n<A>\nelse:\n<B>\nend\n<C>",
    "A C",
    IS_TAKEN.format(1, 2),
)
UNDECIDED_WHILE = Case(
    "WHILE <IN> DO\n<A>\nENDWHILE\n<B>",
    "WHILE <IN>\n<A>\nENDWHILE\n<B>",
    "while <IN>:\n<A>\nend\n<B>",
    "A B",
    ONCE,
)
LOOP = Case(
    "WHILE TRUE DO\n<A>\nENDWHILE\n<B>",
    "LOOP\n<A>\nENDLOOP\n<B>",
    "while True:\n<A>\nend\n<B>",
    "A",
    ENDLESS,
)
LEFT = Case(
    "WHILE TRUE DO\n<A>\nIF <IN> THEN\n<B>\nGOTO out;\nENDIF\n<C>\nENDWHILE\nout:\n<D>",
    "LOOP\n<A>\nIF <IN> THEN\n<B>\nEXIT\nENDIF\n<C>\nENDLOOP\n<D>",
    "while True:\n<A>\nif <IN>:\n<B>\nbreak\nend\n<C>\nend\n<D>",
    "A C B D",
    WAY_OUT,
)

CASES = {
    "IF": UNDECIDED_IF,
    "IF, only ELSE moves": Case(
        "IF <IN> THEN\nn:=1;\nELSE\n<B>\nENDIF\n<C>",
        "IF <IN> THEN\nN=1\nELSE\n<B>\nENDIF\n<C>",
        "if <IN>:\nn = 1\nelse:\n<B>\nend\n<C>",
        "B C",
        IS_TAKEN.format(2, 2),
    ),
    "IF without ELSE, no motion": Case(
        "IF <IN> THEN\nn:=1;\nENDIF\n<C>",
        "IF <IN> THEN\nN=1\nENDIF\n<C>",
        "if <IN>:\nn = 1\nend\n<C>",
        "C",
        NOT_FULFILLED,
    ),
    "IF, no motion: ELSE is carried out": Case(
        "IF <IN> THEN\nn:=1;\nELSE\nn:=2;\nENDIF\nIF n=2 THEN\n<A>\nENDIF\n<C>",
        "IF <IN> THEN\nN=1\nELSE\nN=2\nENDIF\nIF N==2 THEN\n<A>\nENDIF\n<C>",
        "if <IN>:\nn = 1\nelse:\nn = 2\nend\nif n == 2:\n<A>\nend\n<C>",
        "A C",
        NOT_FULFILLED,
    ),
    "IF that ends the program": Case(
        "IF <IN> THEN\n<A>\nRETURN;\nENDIF\n<C>",
        "IF <IN> THEN\n<A>\nRETURN\nENDIF\n<C>",
        "if <IN>:\n<A>\nhalt\nend\n<C>",
        "C",
        NOT_LED_ELSEWHERE,
    ),
    "ELSE that ends the program": Case(
        "IF <IN> THEN\nn:=1;\nELSE\nRETURN;\nENDIF\n<C>",
        "IF <IN> THEN\nN=1\nELSE\nRETURN\nENDIF\n<C>",
        "if <IN>:\nn = 1\nelse:\nhalt\nend\n<C>",
        "C",
        "the condition depends on <IN>: branch 1 of 2, the first that comes back, is taken",
    ),
    "ELSEIF": Case(
        "IF <IN> THEN\nn:=1;\nELSEIF <IN2> THEN\n<A>\nELSE\n<B>\nENDIF\n<C>",
        "IF <IN> THEN\nN=1\nELSE\nIF <IN2> THEN\n<A>\nELSE\n<B>\nENDIF\nENDIF\n<C>",
        "if <IN>:\nn = 1\nelif <IN2>:\n<A>\nelse:\n<B>\nend\n<C>",
        "A C",
    ),
    "IF answered": replace(UNDECIDED_IF, driven="B C", said=None, branches={1: 2}),
    "IF answered with none": replace(UNDECIDED_IF, driven="B C", said=None, branches={1: 0}),
    "WHILE": UNDECIDED_WHILE,
    "WHILE without motion": Case(
        "WHILE <IN> DO\nn:=n+1;\nENDWHILE\n<B>",
        "WHILE <IN>\nN=1\nENDWHILE\n<B>",
        "while <IN>:\nn = n + 1\nend\n<B>",
        "B",
        AT_ONCE,
    ),
    "WHILE answered": replace(UNDECIDED_WHILE, driven="A A A B", said=None, passes={1: 3}),
    "WHILE with a counter": Case(
        "WHILE n<3 DO\n<A>\nn:=n+1;\nENDWHILE\n<B>",
        "N=0\nWHILE N<3\n<A>\nN=N+1\nENDWHILE\n<B>",
        "while n < 3:\n<A>\nn = n + 1\nend\n<B>",
        "A A A B",
    ),
    "WHILE that nothing changes": Case(
        "WHILE n<3 DO\n<A>\nENDWHILE\n<B>",
        "N=0\nWHILE N<3\n<A>\nENDWHILE\n<B>",
        "while n < 3:\n<A>\nend\n<B>",
        "A",
        ENDLESS,
    ),
    "WHILE that nothing changes and that does not move": Case(
        "WHILE n<3 DO\nWaitTime 0.1;\nENDWHILE\n<B>",
        "N=0\nWHILE N<3\nWAIT SEC 0.1\nENDWHILE\n<B>",
        "while n < 3:\nsleep(0.1)\nend\n<B>",
        "B",
        WAITS,
    ),
    "WHILE that moves otherwise in each pass and never ends": Case(
        "WHILE go DO\nn:=n+1;\nIF n=1 THEN\n<A>\nELSE\n<B>\nENDIF\nENDWHILE\n<C>",
        "N=0\nGO=TRUE\nWHILE GO\nN=N+1\nIF N==1 THEN\n<A>\nELSE\n<B>\nENDIF\nENDWHILE\n<C>",
        "while go:\nn = n + 1\nif n == 1:\n<A>\nelse:\n<B>\nend\nend\n<C>",
        "A B B",
        ENDLESS.replace("one pass is", "3 passes are"),
    ),
    "LOOP": LOOP,
    "LOOP with a counter that ends nothing": Case(
        "WHILE TRUE DO\n<A>\nn:=n+1;\nENDWHILE\n<B>",
        "N=0\nLOOP\n<A>\nN=N+1\nENDLOOP\n<B>",
        "while True:\n<A>\nn = n + 1\nend\n<B>",
        "A",
        ENDLESS,
    ),
    "LOOP that does nothing": Case(
        "<A>\nWHILE TRUE DO\nWaitTime 0.1;\nENDWHILE\n<B>",
        "<A>\nLOOP\nWAIT SEC 0.1\nENDLOOP\n<B>",
        "<A>\nwhile True:\nsleep(0.1)\nend\n<B>",
        "A",
        IDLE,
    ),
    "LOOP whose motion nothing lets come": Case(
        "<A>\nWHILE TRUE DO\nIF n=5 THEN\n<B>\nENDIF\nWaitTime 0.1;\nENDWHILE\n<C>",
        "N=0\n<A>\nLOOP\nIF N==5 THEN\n<B>\nENDIF\nWAIT SEC 0.1\nENDLOOP\n<C>",
        "<A>\nwhile True:\nif n == 5:\n<B>\nend\nsleep(0.1)\nend\n<C>",
        "A",
        STANDS,
    ),
    "a jump back over motion that nothing lets come": Case(
        "again:\nIF n=5 THEN\n<B>\nENDIF\nGOTO again;",
        "N=0\nAGAIN:\nIF N==5 THEN\n<B>\nENDIF\nGOTO AGAIN",
        "while True:\nif n == 5:\n<B>\nend\nend",
        "",
        STANDS,
    ),
    "LOOP whose motion comes in a later pass": Case(
        "WHILE TRUE DO\nn:=n+1;\nIF n=5 THEN\n<B>\nENDIF\nENDWHILE\n<C>",
        "N=0\nLOOP\nN=N+1\nIF N==5 THEN\n<B>\nENDIF\nENDLOOP\n<C>",
        "while True:\nn = n + 1\nif n == 5:\n<B>\nend\nend\n<C>",
        "B",
        ENDLESS.replace("one pass is", "5 passes are"),
    ),
    "WHILE that waits for its motion, too": Case(
        "WHILE go DO\nIF n=5 THEN\n<A>\nENDIF\nENDWHILE\n<B>",
        "N=0\nGO=TRUE\nWHILE GO\nIF N==5 THEN\n<A>\nENDIF\nENDWHILE\n<B>",
        "while go:\nif n == 5:\n<A>\nend\nend\n<B>",
        "B",
        WAITS_UNMOVED,
    ),
    "LOOP answered": replace(
        LOOP,
        driven="A A A",
        said=ENDLESS.replace("one pass is", "3 passes are"),
        passes={1: 3},
    ),
    "LOOP with a counter": Case(
        "WHILE TRUE DO\n<A>\nn:=n+1;\nIF n>=3 GOTO out;\nENDWHILE\nout:\n<B>",
        "N=0\nLOOP\n<A>\nN=N+1\nIF N>=3 THEN\nEXIT\nENDIF\nENDLOOP\n<B>",
        "while True:\n<A>\nn = n + 1\nif n >= 3:\nbreak\nend\nend\n<B>",
        "A A A B",
    ),
    "LOOP with a way out": LEFT,
    "LOOP with a way out, answered": replace(
        LEFT, driven="A C A C B D", said=None, passes={1: 2}
    ),
    "LOOP with a way out beside a counter": Case(
        "WHILE TRUE DO\n<A>\nn:=n+1;\nIF n>=3 GOTO out;\nIF <IN> GOTO out;\nENDWHILE\nout:\n<B>",
        "N=0\nLOOP\n<A>\nN=N+1\nIF N>=3 THEN\nEXIT\nENDIF\nIF <IN> THEN\nEXIT\nENDIF\nENDLOOP\n<B>",
        "while True:\n<A>\nn = n + 1\nif n >= 3:\nbreak\nend\nif <IN>:\nbreak\nend\nend\n<B>",
        "A A A B",
    ),
    "LOOP whose way out asks an input and a counter": Case(
        "WHILE TRUE DO\n<A>\nn:=n+1;\nIF <IN> AND n>0 GOTO out;\nENDWHILE\nout:\n<B>",
        "N=0\nLOOP\n<A>\nN=N+1\nIF <IN> AND (N>0) THEN\nEXIT\nENDIF\nENDLOOP\n<B>",
        "while True:\n<A>\nn = n + 1\nif <IN> and n > 0:\nbreak\nend\nend\n<B>",
        "A B",
        WAY_OUT,
    ),
    "a place that is asked and decides nothing": Case(
        "WHILE TRUE DO\n<A>\nj:=CJointT();\n<B>\nIF <IN> GOTO out;\nENDWHILE\nout:\n<C>",
        "LOOP\n<A>\nI=$AXIS_ACT.A1\n<B>\nIF <IN> THEN\nEXIT\nENDIF\nENDLOOP\n<C>",
        "while True:\n<A>\nj = get_actual_joint_positions()\n<B>\nif <IN>:\nbreak\nend\nend\n<C>",
        "A B C",
        WAY_OUT,
    ),
    "a way out that is taken late": Case(
        "WHILE TRUE DO\n<A>\nn:=n+1;\nIF n>200 GOTO out;\nIF <IN> GOTO out;\nENDWHILE\n"
        "out:\n<B>",
        "N=0\nLOOP\n<A>\nN=N+1\nIF N>200 THEN\nEXIT\nENDIF\nIF <IN> THEN\nEXIT\nENDIF\n"
        "ENDLOOP\n<B>",
        "while True:\n<A>\nn = n + 1\nif n > 200:\nbreak\nend\nif <IN>:\nbreak\nend\nend\n<B>",
        "A " * 100 + "B",
        WAY_OUT.replace("once", "100 times"),
    ),
    "a condition that comes to be unknown": Case(
        "WHILE n<3 OR <IN> DO\n<A>\nn:=n+1;\nENDWHILE\n<B>",
        "N=0\nWHILE (N<3) OR <IN>\n<A>\nN=N+1\nENDWHILE\n<B>",
        "while n < 3 or <IN>:\n<A>\nn = n + 1\nend\n<B>",
        "A A A B",
        ONCE.replace("once", "3 times"),
    ),
    "a flag set in a branch": Case(
        "WHILE go DO\n<A>\nIF <IN> THEN\ngo:=FALSE;\nENDIF\nENDWHILE\n<B>",
        "GO=TRUE\nWHILE GO\n<A>\nIF <IN> THEN\nGO=FALSE\nENDIF\nENDWHILE\n<B>",
        "while go:\n<A>\nif <IN>:\ngo = False\nend\nend\n<B>",
        "A B",
        WAY_OUT,
    ),
    "a flag set in a branch holds afterwards": Case(
        "WHILE go DO\n<A>\nIF <IN> THEN\ngo:=FALSE;\nENDIF\nENDWHILE\nIF go THEN\n<B>\nENDIF\n<C>",
        "GO=TRUE\nWHILE GO\n<A>\nIF <IN> THEN\nGO=FALSE\nENDIF\nENDWHILE\n"
        "IF GO THEN\n<B>\nENDIF\n<C>",
        "while go:\n<A>\nif <IN>:\ngo = False\nend\nend\nif go:\n<B>\nend\n<C>",
        "A C",
        WAY_OUT,
    ),
    "a way out of the program": Case(
        "WHILE TRUE DO\n<A>\nIF <IN> THEN\n<B>\nRETURN;\nENDIF\nENDWHILE\n<C>",
        "LOOP\n<A>\nIF <IN> THEN\n<B>\nRETURN\nENDIF\nENDLOOP\n<C>",
        "while True:\n<A>\nif <IN>:\n<B>\nhalt\nend\nend\n<C>",
        "A B",
        WAY_OUT,
    ),
    "a wait with a way out": Case(
        "WHILE TRUE DO\nIF <IN> GOTO out;\nWaitTime 0.1;\nENDWHILE\nout:\n<B>",
        "LOOP\nIF <IN> THEN\nEXIT\nENDIF\nWAIT SEC 0.1\nENDLOOP\n<B>",
        "while True:\nif <IN>:\nbreak\nend\nsleep(0.1)\nend\n<B>",
        "B",
        WAY_OUT,
    ),
    "a loop that only passes time": Case(
        "WHILE n<500000 DO\nn:=n+1;\nENDWHILE\n<A>",
        "N=0\nWHILE N<500000\nN=N+1\nENDWHILE\n<A>",
        "while n < 500000:\nn = n + 1\nend\n<A>",
        "A",
        LONG,
    ),
    "passes of a loop whose end is known": Case(
        "FOR i FROM 1 TO 9 DO\n<A>\nENDFOR\n<B>",
        "FOR I=1 TO 9\n<A>\nENDFOR\n<B>",
        "while n < 9:\n<A>\nn = n + 1\nend\n<B>",
        "A A B",
        passes={1: 2},
    ),
    "no passes of a loop whose end is known": Case(
        "\nWHILE n<9 DO\n<A>\nn:=n+1;\nENDWHILE\n<B>",
        "N=0\nWHILE N<9\n<A>\nN=N+1\nENDWHILE\n<B>",
        "\nwhile n < 9:\n<A>\nn = n + 1\nend\n<B>",
        "B",
        passes={2: 0},
    ),
    "nested": Case(
        "WHILE n<2 DO\nn:=n+1;\nWHILE <IN> DO\n<A>\nENDWHILE\n<B>\nENDWHILE\n<C>",
        "N=0\nWHILE N<2\nN=N+1\nWHILE <IN>\n<A>\nENDWHILE\n<B>\nENDWHILE\n<C>",
        "while n < 2:\nn = n + 1\nwhile <IN>:\n<A>\nend\n<B>\nend\n<C>",
        "A B A B C",
        f"{ONCE} (2 times)",
    ),
    "a way out of two loops": Case(
        "WHILE TRUE DO\n<A>\nWHILE TRUE DO\n<B>\nIF <IN> RETURN;\nENDWHILE\n<C>\nENDWHILE\n<D>",
        "LOOP\n<A>\nLOOP\n<B>\nIF <IN> THEN\nRETURN\nENDIF\nENDLOOP\n<C>\nENDLOOP\n<D>",
        "while True:\n<A>\nwhile True:\n<B>\nif <IN>:\nhalt\nend\nend\n<C>\nend\n<D>",
        "A B",
        WAY_OUT,
    ),
    "FOR to what nobody knows": Case(
        "FOR i FROM 1 TO AInput(ai1) DO\n<A>\nENDFOR\n<B>",
        "FOR N=1 TO $ANIN[1]\n<A>\nENDFOR\n<B>",
        "while n < get_standard_analog_in(1):\n<A>\nn = n + 1\nend\n<B>",
        "A B",
    ),
    "FOR with a way out": Case(
        "FOR i FROM 1 TO 3 DO\n<A>\nIF <IN> GOTO out;\nENDFOR\nout:\n<B>",
        "FOR N=1 TO 3\n<A>\nIF <IN> THEN\nEXIT\nENDIF\nENDFOR\n<B>",
        "while n < 3:\n<A>\nif <IN>:\nbreak\nend\nn = n + 1\nend\n<B>",
        "A A A B",
        NOT_LED_ELSEWHERE + " (3 times)",
    ),
    "a body that runs before it is asked": Case(
        "again:\n<A>\nIF NOT (<IN>) GOTO again;\n<B>",
        "REPEAT\n<A>\nUNTIL <IN>\n<B>",
        "while True:\n<A>\nif <IN>:\nbreak\nend\nend\n<B>",
        "A B",
    ),
    "a jump back that counts": Case(
        "again:\n<A>\nn:=n+1;\nIF n<3 GOTO again;\n<B>",
        "N=0\nAGAIN:\n<A>\nN=N+1\nIF N<3 THEN\nGOTO AGAIN\nENDIF\n<B>",
        "while True:\n<A>\nn = n + 1\nif not (n < 3):\nbreak\nend\nend\n<B>",
        "A A A B",
    ),
    "a jump back that nothing ends": Case(
        "again:\n<A>\nGOTO again;",
        "AGAIN:\n<A>\nGOTO AGAIN",
        "while True:\n<A>\nend",
        "A",
        ENDLESS,
    ),
    "a jump back with a way out": Case(
        "again:\n<A>\nIF <IN> GOTO out;\n<B>\nGOTO again;\nout:\n<C>",
        "AGAIN:\n<A>\nIF <IN> THEN\nGOTO OUT\nENDIF\n<B>\nGOTO AGAIN\nOUT:\n<C>",
        "while True:\n<A>\nif <IN>:\nbreak\nend\n<B>\nend\n<C>",
        "A B C",
        WAY_OUT,
    ),
    "a jump back in a loop, which closes a loop anew in each of its passes": Case(
        "FOR i FROM 1 TO 2 DO\nn:=0;\nagain:\n<A>\nn:=n+1;\nIF n<2 GOTO again;\nENDFOR\n<B>",
        "FOR I=1 TO 2\nN=0\nAGAIN:\n<A>\nN=N+1\nIF N<2 THEN\nGOTO AGAIN\nENDIF\nENDFOR\n<B>",
        "i = 0\nwhile i < 2:\nn = 0\nwhile n < 2:\n<A>\nn = n + 1\nend\ni = i + 1\nend\n<B>",
        "A A A A B",
    ),
    "a jump back that an output ends": Case(
        "SetDO do9,0;\nagain:\nIF DOutput(do9)=0 THEN\n<A>\nSetDO do9,1;\nGOTO again;\nENDIF\n<B>",
        "$OUT[9]=FALSE\nAGAIN:\nIF NOT $OUT[9] THEN\n<A>\n$OUT[9]=TRUE\nGOTO AGAIN\nENDIF\n<B>",
        "set_digital_out(2, False)\nwhile not get_digital_out(2):\n<A>\n"
        "set_digital_out(2, True)\nend\n<B>",
        "A B",
    ),
    "two jumps back to one label": Case(
        "k:=0;\nagain:\n<A>\nn:=n+1;\nIF n<2 GOTO again;\n"
        "n:=0;\nk:=k+1;\nIF k<2 GOTO again;\n<B>",
        "N=0\nK=0\nAGAIN:\n<A>\nN=N+1\nIF N<2 THEN\nGOTO AGAIN\nENDIF\n"
        "N=0\nK=K+1\nIF K<2 THEN\nGOTO AGAIN\nENDIF\n<B>",
        "k = 0\nwhile k < 2:\nn = 0\nwhile n < 2:\n<A>\nn = n + 1\nend\nk = k + 1\nend\n<B>",
        "A A A A B",
    ),
    "what a loop has waited for holds behind it": Case(
        "WHILE go DO\nWaitTime 0.1;\nENDWHILE\nIF go THEN\n<A>\nELSE\n<B>\nENDIF",
        "GO=TRUE\nWHILE GO\nWAIT SEC 0.1\nENDWHILE\nIF GO THEN\n<A>\nELSE\n<B>\nENDIF",
        "while go:\nsync()\nend\nif go:\n<A>\nelse:\n<B>\nend",
        "B",
        WAITS,
    ),
    "a wait in a loop without a condition goes where its way out leads": Case(
        "WHILE TRUE DO\nIF NOT go GOTO out;\nENDWHILE\n<A>\nout:\n<B>",
        "GO=TRUE\nLOOP\nIF NOT GO THEN\nGOTO OUT\nENDIF\nWAIT SEC 0.1\nENDLOOP\n<A>\nOUT:\n<B>",
        "while True:\nif not go:\nbreak\nend\nsync()\nend\n<B>",
        "B",
        WAITS,
    ),
    "a count that a branch not taken ends is not known behind its loop": Case(
        "WHILE n<3 DO\n<A>\nIF <IN> n:=n+1;\nENDWHILE\nIF n>=3 THEN\n<B>\nENDIF\n<C>",
        "N=0\nWHILE N<3\n<A>\nIF <IN> THEN\nN=N+1\nENDIF\nENDWHILE\n"
        "IF N>=3 THEN\n<B>\nENDIF\n<C>",
        "while n < 3:\n<A>\nif <IN>:\nn = n + 1\nend\nend\nif n >= 3:\n<B>\nend\n<C>",
        "A B C",
    ),
    "a counted loop runs to its end beside a way out": Case(
        "WHILE n<110 DO\n<A>\nIF <IN> GOTO out;\nn:=n+1;\nENDWHILE\n<B>\nout:\n<C>",
        "FOR I=1 TO 110\n<A>\nIF <IN> THEN\nGOTO OUT\nENDIF\nENDFOR\n<B>\nOUT:\n<C>",
        "while n < 110:\n<A>\nif <IN>:\nreturn 0\nend\nn = n + 1\nend\n<B>\n<C>",
        "A " * 110 + "B C",
    ),
    "an output that only others change": Case(
        "SetDO do9,1;\nWHILE DOutput(do9)=1 DO\n<A>\nENDWHILE\n<B>",
        "$OUT[9]=TRUE\nWHILE $OUT[9]\n<A>\nENDWHILE\n<B>",
        "set_digital_out(2, True)\nwhile get_digital_out(2):\n<A>\nend\n<B>",
        "A B",
    ),
}  # fmt: skip


def read(vendor: str, case: Case) -> Program:
    dialect = LANGUAGES[vendor]
    shift = FIRST_LINE - 1
    body = getattr(case, vendor)
    answers = Answers(
        branches={f"{dialect.file}:{line + shift}": k for line, k in case.branches.items()},
        passes={f"{dialect.file}:{line + shift}": k for line, k in case.passes.items()},
    )
    reader = find_vendor(vendor).reader
    assert reader is not None
    options = ReadOptions(answers=answers, limits=ExecutionLimits(statements=2000, moves=500))
    return reader.read(dialect.text(body), dialect.file, options)


def driven(program: Program) -> str:
    letters = []
    for move in program.moves:
        assert isinstance(move.target, JointTarget)
        letters.append("ABCD"[round(move.target.joints[0] * 18 / 3.14159265) - 1])
    return " ".join(letters)


@pytest.mark.parametrize("vendor", LANGUAGES)
@pytest.mark.parametrize("name", CASES)
def test_one_idea_has_one_outcome(name: str, vendor: str) -> None:
    case = CASES[name]
    program = read(vendor, case)
    notes = [LANGUAGES[vendor].plain(note.message) for note in program.notes]
    assert driven(program) == case.driven, notes
    if case.said is not None:
        assert case.said in notes
