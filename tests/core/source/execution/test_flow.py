"""The rules for branches and loops, on a language of five statements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NoReturn

import pytest

from flyby.core.errors import SourceError, Span
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.control_flow.analysis import Analysis
from flyby.core.source.execution.control_flow.flow import Flow
from flyby.core.source.execution.control_flow.loops import Loop
from flyby.core.source.execution.control_flow.states import FOLLOWED
from flyby.core.source.execution.control_flow.steps import PLACE, Exit, Step
from flyby.core.source.execution.course import Course
from flyby.core.source.execution.host import Undecided
from flyby.core.source.execution.limits import ExecutionLimits, Meter
from flyby.core.source.execution.outputs import Outputs

UNKNOWN = object()
Value = object
Data = dict[str, Value]
Rule = Callable[[Data], Value]


@dataclass(frozen=True)
class Asked:
    """A condition or value: the names that it reads, and what it is."""

    names: tuple[str, ...]
    rule: Rule

    def __call__(self, data: Data) -> Value:
        values = [data.get(name) for name in self.names]
        return UNKNOWN if any(v is UNKNOWN for v in values) else self.rule(data)


@dataclass(frozen=True, eq=False)
class Move:
    name: str


@dataclass(frozen=True, eq=False)
class Set:
    name: str
    value: Asked


@dataclass(frozen=True, eq=False)
class If:
    condition: Asked
    body: Block
    otherwise: Block | None = None


@dataclass(frozen=True, eq=False)
class While:
    condition: Asked
    body: Block


@dataclass(frozen=True, eq=False)
class Leave:
    exit: Exit


Statement = Move | Set | If | While | Leave


@dataclass(frozen=True, eq=False)
class Block:
    statements: tuple[Statement, ...]


def block(*statements: Statement) -> Block:
    return Block(statements)


SIGNAL = Asked(("signal",), lambda data: data["signal"])
ALWAYS = Asked((), lambda data: True)
BREAK, RETURN, END = Leave(Exit.LOOP), Leave(Exit.ROUTINE), Leave(Exit.PROGRAM)


def below(name: str, most: int) -> Asked:
    return Asked((name,), lambda data: data[name] < most)  # type: ignore[operator]


def reached(name: str, most: int) -> Asked:
    return Asked((name,), lambda data: data[name] >= most)  # type: ignore[operator]


def counted(name: str) -> Set:
    return Set(name, Asked((name,), lambda data: data[name] + 1))  # type: ignore[operator]


class Tree:
    def own(self, block: Block) -> frozenset[str]:
        return frozenset()

    def steps(self, block: Block) -> Sequence[Step[Block]]:
        return [self._step(statement) for statement in block.statements]

    def _step(self, statement: Statement) -> Step[Block]:
        if isinstance(statement, Move):
            return Step(moves=True)
        if isinstance(statement, Set):
            made_of = frozenset(statement.value.names)
            return Step(writes=frozenset([statement.name]), made_of=made_of)
        if isinstance(statement, Leave):
            return Step(exit=statement.exit)
        reads = frozenset(statement.condition.names)
        if isinstance(statement, While):
            return Step(reads=reads, inner=(statement.body,), loop=True)
        inner = [statement.body, statement.otherwise]
        whole = statement.otherwise is not None
        return Step(reads=reads, inner=tuple(b for b in inner if b is not None), exhaustive=whole)


class Left(Exception):
    pass


class Returned(Exception):
    pass


class Ended(Exception):
    pass


@dataclass
class Held:
    run: Run
    names: frozenset[str] | None
    before: Data = field(init=False)

    def __post_init__(self) -> None:
        self.before = self._now()

    def _now(self) -> Data:
        data = self.run.data
        return {n: data.get(n) for n in (data if self.names is None else self.names)}

    def changed(self) -> bool:
        return self._now() != self.before


class Run:
    """Executes blocks."""

    def __init__(self, answers: Answers | None = None, **data: Value) -> None:
        self.data: Data = {"signal": UNKNOWN, "other": UNKNOWN, **data}
        self.course = Course(answers or Answers())
        self.meter = Meter(ExecutionLimits(statements=5000))
        self.outputs = Outputs()
        self.position_asked = 0
        self.place: object = None
        self.flow = Flow(Analysis(Tree()), self)
        self.driven: list[str] = []
        self.said: list[str] = []
        self.supposed: frozenset[str] = frozenset()
        self._lines: dict[int, int] = {}

    def leave_supposed(
        self,
        names: frozenset[str],
        settings: frozenset[str],
        reason: str,
        called: frozenset[str] = frozenset(),
    ) -> None:
        self.supposed |= names | called

    def leave_to_others(self, names: frozenset[str], span: Span) -> list[str]:
        return []

    def snapshot(self, names: frozenset[str] | None, written: frozenset[str]) -> Held:
        return Held(self, names)

    def note_once(self, kind: str, message: str, span: Span) -> None:
        self.said.append(message)

    def pause(self, text: str, span: Span) -> None:
        pass

    def finish(self, message: str, span: Span) -> NoReturn:
        self.said.append(message)
        raise Ended

    def execute(self, *statements: Statement) -> str:
        """The names of the moves that are driven, and what is said."""
        try:
            with self.flow.routine("main", Span("a", 1, 1, 0, 0)):
                self.block(block(*statements))
        except (Ended, Returned):
            pass
        self.said += [note.message for note in self.course.notes()]
        return " ".join(self.driven)

    def block(self, body: Block) -> None:
        for statement in body.statements:
            self.meter.statement(self.span(statement))
            self.statement(statement)

    def span(self, statement: Statement) -> Span:
        line = self._lines.setdefault(id(statement), len(self._lines) + 1)
        return Span("toy", line, 1, line * 10, line * 10 + 5)

    def statement(self, statement: Statement) -> None:
        if isinstance(statement, Move):
            self.driven.append(statement.name)
            self.meter.move(self.span(statement))
            self.place = object()
        elif isinstance(statement, Set):
            self.data[statement.name] = statement.value(self.data)
        elif isinstance(statement, If):
            self.branch(statement)
        elif isinstance(statement, While):
            loop = Loop(
                statement.body,
                self.span(statement),
                "while",
                frozenset(statement.condition.names),
                endless=statement.condition is ALWAYS,
            )
            self.flow.loop(loop, lambda: self.holds(statement.condition), self.inside)
        else:
            raise {Exit.LOOP: Left, Exit.ROUTINE: Returned, Exit.PROGRAM: Ended}[statement.exit]

    def inside(self, body: Block) -> bool:
        try:
            self.block(body)
        except Left:
            return False
        return True

    def holds(self, condition: Asked) -> bool | Undecided:
        value = condition(self.data)
        return Undecided("a signal") if value is UNKNOWN else bool(value)

    def branch(self, statement: If) -> None:
        value = self.holds(statement.condition)
        chosen = statement.body if value else statement.otherwise
        if isinstance(value, Undecided):
            choice = self.flow.choose(
                self.span(statement), value.reason, [statement.body], statement.otherwise
            )
            chosen = choice.block
        if chosen is not None:
            self.block(chosen)


A, B, C = Move("A"), Move("B"), Move("C")
FLAG = Set("flag", Asked((), lambda data: False))
ENDLESS = "the program is an endless loop (while)"
WAITS = "the loop (while) only waits for what the program does not change itself"
ONCE = "the end of the loop depends on a signal: its body runs once"

BRANCHES: dict[str, tuple[list[Statement], str, str]] = {
    "moves": ([If(SIGNAL, block(A)), B], "A B", "branch 1 of 1, the first that moves"),
    "does not move": ([If(SIGNAL, block(FLAG)), B], "B", "moves the robot: taken as not fulfilled"),
    "only ELSE moves": ([If(SIGNAL, block(FLAG), block(A)), B], "A B", "branch 2 of 2, the first"),
    "neither moves": ([If(SIGNAL, block(FLAG), block(FLAG)), B], "B", "taken as not fulfilled"),
    "moves and returns": (
        [If(SIGNAL, block(A, RETURN)), B],
        "B",
        "branch 1 of 1 leads elsewhere: taken as not fulfilled, and other moves may be driven if",
    ),
    "ELSE ends": ([If(SIGNAL, block(FLAG), block(END)), B], "B", "the first that comes back"),
    "all end": ([If(SIGNAL, block(A, END), block(B, RETURN)), C], "B", "all lead elsewhere"),
    "ends inside": (
        [If(SIGNAL, block(A, If(SIGNAL, block(END)))), B],
        "A B",
        "branch 1 of 1, the first that moves",
    ),
}


@pytest.mark.parametrize("name", BRANCHES)
def test_a_branch_is_taken_that_moves_and_comes_back(name: str) -> None:
    statements, driven, said = BRANCHES[name]
    run = Run()
    assert run.execute(*statements) == driven
    assert any(said in message for message in run.said), run.said


LOOPS: dict[str, tuple[list[Statement], Data, str, str | None]] = {
    "unknown condition": ([While(SIGNAL, block(A)), B], {}, "A B", ONCE),
    "unknown condition, no motion": ([While(SIGNAL, block(FLAG)), B], {}, "B", "left at once"),
    "counter": ([While(below("n", 3), block(A, counted("n"))), B], {"n": 0}, "A A A B", None),
    "no way out": ([While(ALWAYS, block(A)), B], {}, "A", f"{ENDLESS}: one pass is read"),
    "idle": ([While(ALWAYS, block(FLAG)), B], {}, "", f"{ENDLESS}: the program ends there"),
    "counter that ends nothing": (
        [While(ALWAYS, block(A, counted("n"))), B],
        {"n": 0},
        "A",
        f"{ENDLESS}: one pass is read",
    ),
    "nothing changes": ([While(below("n", 3), block(A)), B], {"n": 0}, "A", ENDLESS),
    "nothing changes, no motion": ([While(below("n", 3), block(FLAG)), B], {"n": 0}, "B", WAITS),
    "way out": (
        [While(ALWAYS, block(A, If(SIGNAL, block(B, BREAK)), C)), Move("D")],
        {},
        "A C B D",
        f"{ONCE}, and then this way out is taken",
    ),
    "way out of the routine": (
        [While(ALWAYS, block(A, If(SIGNAL, block(B, RETURN)))), C],
        {},
        "A B",
        "and then this way out is taken",
    ),
    "way out by a flag": (
        [While(Asked(("flag",), lambda d: d["flag"]), block(A, If(SIGNAL, block(FLAG)))), B],
        {"flag": True},
        "A B",
        "and then this way out is taken",
    ),
    "way out of a wait": (
        [While(ALWAYS, block(FLAG, If(SIGNAL, block(BREAK)))), B],
        {},
        "B",
        "and then this way out is taken",
    ),
    "counter beside a way out": (
        [
            While(
                ALWAYS,
                block(
                    A,
                    counted("n"),
                    If(reached("n", 3), block(BREAK)),
                    If(SIGNAL, block(BREAK)),
                ),
            ),
            B,
        ],
        {"n": 0},
        "A A A B",
        None,
    ),
    "counter of the way out itself": (
        [
            While(
                ALWAYS,
                block(
                    A,
                    counted("n"),
                    If(Asked(("n", "signal"), lambda d: d["n"] == d["signal"]), block(BREAK)),
                ),
            ),
            B,
        ],
        {"n": 0},
        "A B",
        "and then this way out is taken",
    ),
    "way out of the inner loop only": (
        [
            While(
                below("n", 2),
                block(While(ALWAYS, block(A, If(SIGNAL, block(BREAK)))), counted("n")),
            )
        ],
        {"n": 0},
        "A A",
        "(2 times)",
    ),
    "inner way out of both": (
        [
            While(
                ALWAYS,
                block(A, While(ALWAYS, block(B, If(SIGNAL, block(RETURN)))), C),
            ),
        ],
        {},
        "A B",
        "and then this way out is taken",
    ),
    "computed through another": (
        [
            While(
                Asked(("go",), lambda d: d["go"]),
                block(A, counted("n"), Set("go", below("n", 3))),
            ),
            B,
        ],
        {"n": 0, "go": True},
        "A A A B",
        None,
    ),
}


@pytest.mark.parametrize("name", LOOPS)
def test_a_loop_ends(name: str) -> None:
    statements, data, driven, said = LOOPS[name]
    run = Run()
    run.data.update(data)
    assert run.execute(*statements) == driven
    if said is None:
        assert run.said == [] or "condition depends" in run.said[0]
    else:
        assert any(said in message for message in run.said), run.said


def test_a_loop_that_gets_on_is_followed_past_an_open_way_out_for_so_long() -> None:
    run = Run(n=0)
    late = If(reached("n", 1000), block(BREAK))
    body = block(A, counted("n"), late, If(SIGNAL, block(BREAK)))
    assert run.execute(While(ALWAYS, body), B).split() == ["A"] * FOLLOWED + ["B"]


def test_answers_go_before_the_rules() -> None:
    answers = Answers(branches={"toy:1": 0}, passes={"toy:3": 4})
    run = Run(answers)
    assert run.execute(If(SIGNAL, block(A), block(B)), While(SIGNAL, block(C))) == "B C C C C"
    assert run.said == []


def test_answers_say_how_often_an_endless_loop_is_read() -> None:
    run = Run(Answers(passes={"toy:1": 3}))
    assert run.execute(While(ALWAYS, block(A)), B) == "A A A"
    assert run.said[-1] == f"{ENDLESS}: 3 passes are read"


def test_answers_say_when_an_open_way_out_is_taken() -> None:
    run = Run(Answers(passes={"toy:1": 2}))
    assert run.execute(While(ALWAYS, block(A, If(SIGNAL, block(BREAK)))), B) == "A A B"


def test_an_answer_that_names_no_branch_is_refused() -> None:
    run = Run(Answers(branches={"toy:1": 2}, file="io.toml"))
    with pytest.raises(SourceError, match=r"toy:1.*there is 1 branch, not 2"):
        run.execute(If(SIGNAL, block(A)))


def test_what_is_ruled_out_is_not_taken() -> None:
    run = Run()
    one, two = block(A), block(B)
    span = Span("toy", 1, 1, 0, 1)
    assert run.flow.choose(span, "x", [one, two], None, [False, True, True]).block is two
    assert run.flow.choose(span, "x", [one, two], None, [False, False, True]).block is None


def test_a_position_that_is_asked_for_lets_a_loop_get_on() -> None:
    class Asking(Run):
        def holds(self, condition: Asked) -> bool | Undecided:
            self.position_asked += 1
            return len(self.driven) < 3

    here = Asked((PLACE,), lambda data: True)
    assert Asking().execute(While(here, block(A)), B) == "A A A B"
    elsewhere = Asked(("n",), lambda data: True)
    assert Asking().execute(While(elsewhere, block(A)), B) == "A", "it does not decide"


def test_outputs_that_only_others_change_end_a_loop() -> None:
    class Reading(Run):
        def holds(self, condition: Asked) -> bool | Undecided:
            held = self.outputs.value("do1")
            return Undecided("do1") if held is None else bool(held)

    run = Reading()
    run.outputs.write("do1", True)
    assert run.execute(While(below("n", 3), block(A)), B) == "A B"
    assert run.outputs.held() == {}
