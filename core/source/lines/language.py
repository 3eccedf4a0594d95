"""Reader, writer and patcher of a language of one statement a line."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import replace
from pathlib import Path

from ...dialect import Dialect
from ...errors import FlybyError, InputError, PluginFault, Span
from ...language import Sources
from ...program.move import Move, Opaque, Wait
from ...program.program import Program
from ...program.target import JointTarget, PoseTarget, Target
from ...program.zone import Fine
from ...robot.model import Robot
from ...spatial.pose import IDENTITY, Pose
from ..patch.edits import Edit
from ..patch.uses import MovePart, Use, UseKind
from ..reading import Files, ReadOptions, read_with
from ..text.files import SourceFile, SourceText
from ..text.numerals import nine_decimals
from ..write.numbering import Numbering, PointNumbers
from ..write.options import OpaqueStyle, PatcherOptions, WriterOptions
from ..write.refusals import check_said
from ..write.statements import lines_of_statements
from .driving import MotionGrammar
from .files import with_called
from .interpreter import run_lines
from .motions import MotionWords
from .moves import said
from .patcher import patch_lines
from .program import LineProgram, mostly_said, pieces, plain_lines, read_lines
from .statements import Line


class LineWriter:
    """Writes one program; a new one for each.

    Attributes:
        grammar: of the language that it writes; set by that.
        called: a point as motions name it, of its ``number``, and ``kind``: ``J`` of joint values,
            ``P`` of a pose.
        first: number of the first point.
        pause: the line of a wait, of its ``time``.
        points: those that motions name; a language declares them by `point`.
        setup: lines that stand before all others.
    """

    grammar: type[MotionGrammar]
    called: str = "P[{number}]"
    first: int = 1
    pause: str = "WAIT {time}"

    def __init__(self) -> None:
        self.points = PointNumbers(self.point, self.first)
        self.setup: list[str] = []
        self.said: dict[str, str] = {}
        self._frames: dict[str, Numbering[Pose]] = {}

    def point(self, number: int, target: Target, *beside: str) -> str:
        """The declaration of a point."""
        raise NotImplementedError

    def text(self, name: str, lines: list[str]) -> str:
        """The whole file of the lines of all statements."""
        raise NotImplementedError

    def move(self, move: Move) -> Iterable[str]:
        """The lines of a move, and what must be said before it."""
        words = self.grammar.words
        kinds = [kind for kind in UseKind if words is None or not words.says(kind)]
        yield from self.frames(move)
        yield from self.grammar.settings.lines(move, self.said, kinds)
        yield from self.motion(move).splitlines()

    def frames(self, move: Move) -> Iterator[str]:
        """What sets the tool and the frame of a move, where that is data (`FrameRegisters`)."""
        held = self.grammar.frames
        if held is None or not held.said:
            return
        for word, pose in ((held.tool, move.tool.tcp), (held.frame, move.work_object.pose)):
            if word and pose == IDENTITY:
                yield from self.changed(word, held.none.format(word=word))
            elif word:
                point = self.name(PoseTarget(pose))
                yield from self.changed(word, held.said.format(word=word, point=point))

    def wait(self, wait: Wait) -> str:
        """The line of a wait."""
        return self.pause.format(time=nine_decimals(wait.duration * self.grammar.second))

    # ------------------------------------------------------------- of which moves are made

    def motion(self, move: Move, *beside: str, **others: object) -> str:
        """The line, or lines, of a motion to its points; ``beside``: what else these say;
        ``others``: what else `MotionWords.motion` has a place for."""
        assert self.grammar.words is not None
        letter, targets = said(move)
        word = next((word for word, one in self.grammar.kinds.items() if one == letter), letter)
        points = (self.name(one, *beside) for one in targets)
        return self.grammar.words.text(move, *points, kind=word, **others)

    def name(self, target: Target, *beside: str) -> str:
        """What a point is called, which is declared if it is new."""
        kind = "J" if isinstance(target, JointTarget) else "P"
        return self.called.format(number=self.points.of(target, *beside), kind=kind)

    def changed(self, word: str, *lines: str) -> Iterator[str]:
        """Lines, unless they are those that were said last of a word."""
        if self.said.get(word) != "\n".join(lines):
            self.said[word] = "\n".join(lines)
            yield from lines

    def numbered(
        self, word: str, most: int, pose: Pose, name: str, declared: Callable[[int], Iterable[str]]
    ) -> int:
        """The number of a tool or frame, 0 for none.

        Args:
            word: of its kind.
            most: greatest number that there is.
            name: as it is called in the program.
            declared: the lines that declare the one of a number; they come into the `setup`.
        """
        if pose == IDENTITY:
            return 0
        numbers = self._frames.setdefault(word, Numbering(word, most))
        new = pose not in numbers.numbers
        found = numbers.of(pose, name)
        self.setup += declared(found) if new else ()
        return found


class LineLanguage:
    """A language; its own file says what is peculiar to it.

    Attributes:
        name: for messages.
        suffix: of the files that it writes.
        dialect: what it has words for.
        grammar: what a line of one file means.
        writer: writes one program.
        trailing: what begins a comment behind a statement; ``""`` for none.
        longest_name: signs of a program's name at most; 0 for any number.
        capitals: whether it is in capitals.
        longest_comment: signs of a comment at most; 0 for any number.
        pieces: what of a text is one statement each, in the group ``text``, and what says nothing
            between them, where that is not its lines.
        called: in a text, names of the programs that it calls, whose files stand beside; None for
            programs in one file.
        always: names of files, in lower case, that are read wherever they stand beside.
    """

    name: str
    suffix: str
    dialect: Dialect
    grammar: type[MotionGrammar]
    writer: type[LineWriter]
    trailing: str = ""
    longest_name: int = 0
    capitals: bool = False
    longest_comment: int = 0
    pieces: re.Pattern[str] | None = None
    called: re.Pattern[str] | None = None
    always: tuple[str, ...] = ()

    # ------------------------------------------------------------ what a language says

    def lines(self, source: SourceText) -> Iterable[Line]:
        """What of a text is one statement each."""
        if self.pieces is not None:
            return pieces(source, self.pieces)
        return plain_lines(source, self.trailing)

    def program(self, text: str, file: str) -> LineProgram:
        """The routines, points and data of one file."""
        return read_lines(text, file, self.grammar(), self.name, self.lines)

    def comment(self, text: str) -> Iterator[str]:
        """Lines of comment."""
        longest = self.longest_comment or max(1, len(text))
        for at in range(0, max(1, len(text)), longest):
            yield f"{self.dialect.comment}{text[at : at + longest]}"

    def named(self, name: str) -> str:
        """A name that programs and files may have: letters, digits, ``_``; a letter comes first."""
        name = re.sub(r"\W+", "_", name, flags=re.ASCII) or "main"
        name = name if name[0].isalpha() else f"P_{name}"
        return (name.upper() if self.capitals else name)[: self.longest_name or None]

    def _words(self, kind: UseKind, move: Move) -> MotionWords | None:
        """The words with which a motion says a part itself; None where settings say it."""
        settings, at = self.grammar.settings, getattr(move.origin, kind, None)
        if not settings.sets(kind):
            return self.grammar.words
        if at is None or (kind is UseKind.ZONE and settings.flying):
            return None
        return None if at.span == move.statement else self.grammar.words

    def own(self, use: Use, later: Sequence[Move]) -> Iterator[Edit]:
        """What is put at a move that gets numbers, or words, of its own; ``later``: the moves
        behind it."""
        words, settings = self._words(use.kind, use.move), self.grammar.settings
        if not self.gives(use):
            raise InputError(
                "there is no number of its own to change, and a position of its own is not put "
                "in: change it for all that use it, or write the program anew"
            )
        if isinstance(use.new, JointTarget | PoseTarget):
            numbers = ", ".join(map(nine_decimals, self.grammar.form.numbers(use.new)))
            yield Edit(use.origin.span, self._inline(use).format(numbers=numbers), use.index)
            return
        yield from settings.own(use, later) if words is None else words.own(use)

    def gives(self, use: Use) -> bool:
        """Whether a part of a move can get numbers, or words, of its own."""
        if isinstance(use.new, JointTarget | PoseTarget):
            return bool(self._inline(use)) and use.origin.span != use.statement
        return bool(self._words(use.kind, use.move) or self.grammar.settings.sets(use.kind))

    def _inline(self, use: Use) -> str:
        return self.grammar.written_inline[isinstance(use.new, JointTarget)]

    def reworded(self, use: Use) -> bool:
        """Whether a word at the motion, and no number, says what is to change."""
        stops = {isinstance(part, Fine) for part in (use.old, use.new)}
        return use.kind is UseKind.ZONE and bool(self.grammar.settings.flying) and len(stops) == 2

    def rewritten(self, use: Use, text: Callable[[Span], str]) -> Mapping[Span, str]:
        """What literals must say that are no single number."""
        held = self.grammar.settings.sets(use.kind) and self._words(use.kind, use.move) is None
        return self.grammar.settings.rewritten(use, text) if held else {}

    @property
    def depends(self) -> bool:
        """Whether what numbers mean depends on the arm."""
        return any(callable(amount.scale) for amount in self.grammar.amounts())

    def of_arm(self, robot: Robot | None) -> LineLanguage:
        """The same for an arm; None where nobody knows which."""
        if robot is None or not self.depends:
            return self
        made, words, settings = copy(self), self.grammar.words, self.grammar.settings
        parts = {"words": words and words.of(robot), "settings": settings.of(robot)}
        made.grammar = type(self.grammar.__name__, (self.grammar,), parts)
        return made

    # --------------------------------------------------------------------- its parts

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `core.language.Reader`."""
        return read_with({file: SourceFile(file, text)}, file, options, self._read)

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """The same of a file, and of those beside it that belong to it."""
        names = (lambda text: ()) if self.called is None else self.called.findall
        files = with_called(path, options, (path.suffix.lower(),), names, self.always)
        return read_with(files, str(path), options, self._read)

    def recognises(self, text: str) -> bool:
        """Whether most lines are of the language (`core.language.Recogniser`)."""
        return mostly_said(text, self.grammar(), self.lines)

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """See `core.language.Patcher`."""
        chosen = PatcherOptions.of(options, f"{self.name} patcher")
        return patch_lines(program, chosen, self.of_arm(robot))

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `core.language.Writer`; the option is ``opaque``."""
        name = self.named(program.name)
        chosen = WriterOptions.of(options, f"{self.name} writer")
        text = self.of_arm(robot).written(program, name, chosen)
        return {f"{name}{self.suffix}": text}

    def written(
        self,
        program: Program,
        name: str,
        options: WriterOptions,
        writer: LineWriter | None = None,
    ) -> str:
        """The text of a program.

        Args:
            writer: that writes it; None for the language's own.
        """
        writer = writer or self.writer()
        writer.grammar = self.grammar

        def move(move: Move, *_: object) -> Iterable[str]:
            if options.opaque is OpaqueStyle.COMMENT:
                for event in move.events:
                    yield from self.comment(event.text)
                move = replace(move, events=())
            check_said(move, self.dialect, self.name)
            try:
                yield from writer.move(move)
            except FlybyError:
                raise
            except Exception as error:
                what = f"{type(writer).__qualname__}.move"
                raise PluginFault.of(what, error, move.statement) from error

        def wait(wait: Wait) -> Iterable[str]:
            return (writer.wait(wait),)

        def opaque(kept: Opaque) -> Iterable[str]:
            if options.opaque is OpaqueStyle.KEEP:
                return (kept.text,)
            return self.comment(kept.text)

        return writer.text(name, lines_of_statements(program, wait, opaque, move))

    def numbers(self, kind: UseKind, part: MovePart, move: Move) -> tuple[float | None, ...]:
        """The numbers of a part of a move, in the order in which a line has them.

        Raises:
            InputError: the language cannot say the move.
        """
        check_said(replace(move, events=()), self.dialect, self.name)
        if isinstance(part, JointTarget | PoseTarget):
            return self.grammar.form.numbers(part)
        words = self._words(kind, move)
        if words is not None:
            return words.numbers(part, move)
        return self.grammar.settings.numbers(kind, part, move)

    def _read(self, files: Files, main: str, options: ReadOptions) -> Program:
        own = self.of_arm(options.robot)
        first, *others = (own.program(source.text, file) for file, source in files.items())
        for other in others:
            first = first.with_file(other)
        return run_lines(first, own.grammar(), options)
