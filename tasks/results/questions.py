"""What `flyby.ask` returns."""

from __future__ import annotations

from ...core.display import counted, in_line
from ...core.notebook import table
from ...core.program.question import Question
from ...core.source.execution.answers_text import answers_text, grouped

COLUMNS = (("line", "right"), ("what", "left"), ("name", "left"), ("answer", "left"))


class Questions(tuple[Question, ...]):
    """What a program asks that no file says.

    Attributes:
        name: of the program's file.
        robot: that it was read for, if it has to be named.
    """

    name: str
    robot: str

    @classmethod
    def of(cls, questions: tuple[Question, ...], name: str, robot: str = "") -> Questions:
        """The questions of a program."""
        made = cls(questions)
        made.name = name
        made.robot = robot
        return made

    @property
    def toml(self) -> str:
        """They as a file of answers, which changes nothing until it is edited."""
        return answers_text(self, self.name)

    @property
    def said(self) -> list[str]:
        """A line a kind."""
        return grouped(self)

    def rows(self) -> list[tuple[str, ...]]:
        """Cells of a table, a line for each."""
        return [(str(q.span.line), q.kind.value, q.key, q.type or "any") for q in self]

    def __repr__(self) -> str:
        return in_line(f"Questions of {self.name}: {counted(self, 'question')}")

    def _repr_html_(self) -> str:
        return table(COLUMNS, self.rows())
