"""Places in the files of a program: lines, and the inline forms that statements belong to."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass

from ....core.errors import InputError, Span
from ....core.source.reading import Files
from ....core.source.text.files import SourceText

_FOLD = re.compile(r"(?im)^[ \t]*;[ \t]*(?P<close>END)?FOLD\b(?P<rest>[^\r\n]*)")
_MOTION = re.compile(r"(?i)[ \t]*S?(?:PTP|LIN|CIRC)\b")
_DATUM = re.compile(
    r"(?i)\b(?:PDAT_ACT|LDAT_ACT)[ \t]*=[ \t]*(?P<act>\w+)"
    r"|\bSAPO(?:_PTP)?[ \t]*\([ \t]*(?P<apo>\w+)"
)
_NUMBER = r"[-+]?[\d.]+(?:E[-+]?\d+)?"


@dataclass(frozen=True, slots=True)
class Form:
    """An inline form: a fold that the teach pendant wrote for one motion.

    Args:
        span: from ``;FOLD`` to the end of its ``;ENDFOLD``.
        head: the rest of its first line.
    """

    span: Span
    head: Span


class Places:
    """The texts of a program's files."""

    def __init__(self, files: Files) -> None:
        self._texts = {name: SourceText(file.text, name) for name, file in files.items()}
        self._forms: dict[str, list[Form]] = {}

    def text(self, span: Span) -> str:
        """What stands at a place.

        Raises:
            InputError: it is in no file of the program.
        """
        return self._source(span).text[span.start : span.end]

    def span(self, file: str, start: int, end: int) -> Span:
        """A place."""
        return self._texts[file].span(start, end)

    def line(self, at: Span) -> tuple[Span, str, str]:
        """The line of a place with its end, its indentation, and how lines end there."""
        text = self._source(at).text
        start = max(text.rfind("\n", 0, at.start), text.rfind("\r", 0, at.start)) + 1
        found = re.compile(r"[^\r\n]*(\r\n|\r|\n|$)").match(text, start)
        assert found is not None
        indent = text[start : at.start]
        ending = found[1] or ("\r\n" if "\r\n" in text else "\n")
        return self.span(at.file, start, found.end()), indent[: _blank(indent)], ending

    def form(self, at: Span) -> Form | None:
        """The inline form of motion that a place is in."""
        self._source(at)
        if at.file not in self._forms:
            self._forms[at.file] = self._find_forms(at.file)
        forms = self._forms[at.file]
        k = bisect_right([form.span.start for form in forms], at.start) - 1
        return forms[k] if k >= 0 and at.start < forms[k].span.end else None

    def approximation_datum(self, form: Form) -> Span | None:
        """The number ``APO_DIST`` of the PDAT or LDAT that an inline form reads."""
        found = list(_DATUM.finditer(self.text(form.span)))
        if not found:
            return None
        name = found[-1]["apo"] or found[-1]["act"]
        pattern = re.compile(
            rf"(?i)\b[PL]DAT[ \t]+{name}[ \t]*=[ \t]*\{{[^}}]*?\bAPO_DIST[ \t]+({_NUMBER})"
        )
        for file, source in self._texts.items():
            declared = pattern.search(source.text)
            if declared is not None:
                return self.span(file, *declared.span(1))
        return None

    def _source(self, span: Span) -> SourceText:
        if span.file not in self._texts:
            raise InputError(
                f"{span.file} is not among the files of the program: what it says cannot be changed"
            )
        return self._texts[span.file]

    def _find_forms(self, file: str) -> list[Form]:
        forms: list[Form] = []
        opened: list[re.Match[str]] = []
        for found in _FOLD.finditer(self._texts[file].text):
            if not found["close"]:
                opened.append(found)
            elif opened:
                head = opened.pop()
                if _MOTION.match(head["rest"]):
                    span = self.span(file, head.start(), found.end())
                    forms.append(Form(span, self.span(file, *head.span("rest"))))
        return sorted(forms, key=lambda form: form.span.start)


def _blank(indent: str) -> int:
    return len(indent) - len(indent.lstrip())
