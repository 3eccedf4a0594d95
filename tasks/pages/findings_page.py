"""The page of a check: findings beside the source, and the program driven as far as it can be."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ...core.errors import FlybyError
from ...core.lint.finding import Severity
from ...drawing.page.content import (
    Page,
    PageColumn,
    PageRow,
    PageTable,
)
from ..emulate import EmulateOptions, emulate_with
from ..results.findings import Findings
from .run_page import made_by, run_page
from .sources import SourceList

if TYPE_CHECKING:
    from ...core.program.program import Program
    from ..results.runs import Run

_COLUMNS = (
    PageColumn("line"),
    PageColumn(""),
    PageColumn("rule"),
    PageColumn("finding"),
    PageColumn("what to do"),
)
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}


def findings_page(found: Findings, program: Program | None = None) -> Page:
    """The page of a check.

    Args:
        found: by the check.
        program: that was checked; without it the page is the table alone.
    """
    if program is None:
        rows = findings_table(found, SourceList(), None)
        return Page("check", "check", _facts(found), tables=[rows], made_by=made_by())
    try:
        run = emulate_with(program, EmulateOptions())
    except FlybyError:
        sources = SourceList()
        sources.add(program, 0, [finding.span for finding in found])
        return Page(
            program.name,
            "check",
            _facts(found),
            sources=sources.made,
            tables=[findings_table(found, sources, None)],
            made_by=made_by(),
        )
    page = run_page(run, "check", spans=[finding.span for finding in found])
    sources = SourceList()
    sources.add(run.program, 0, [move.span for move in run.report.moves])
    sources.add(run.program, 0, [finding.span for finding in found])
    facts = {**_facts(found), **page.facts}
    return replace(page, facts=facts, tables=[findings_table(found, sources, run), *page.tables])


def findings_table(found: Findings, sources: SourceList, run: Run | None) -> PageTable:
    """A row a finding, the worst first."""
    order = list(Severity)
    rows = []
    for finding in sorted(found, key=lambda one: order.index(one.severity)):
        source, line = sources.place(0, finding.span)
        t = None
        if run is not None and finding.move is not None:
            move = run.report.moves[finding.move]
            t = move.begin if move.driven else None
        shown = finding.span.line if finding.span is not None else None
        cells = (
            None if shown is None else float(shown),
            str(finding.severity),
            finding.rule,
            finding.message,
            finding.fix,
        )
        level = _LEVELS[finding.severity]
        rows.append(PageRow(cells, level, 0, t, finding.move, source, line))
    return PageTable("Findings", _COLUMNS, rows, "" if rows else "Nothing was found.")


def _facts(found: Findings) -> dict[str, str]:
    return {"found": found.said}
