"""Figures of a benchmark: the command line, the JSON lines and the table that all of them share."""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass


@dataclass(frozen=True)
class Figure:
    """One measured number.

    Args:
        case: what was measured, e.g. ``lines-1000``.
        figure: which number, e.g. ``cpu_ratio``.
        value: ours; for a ratio or a gap, the ratio or the gap.
        unit: unit of ``value``, ``""`` for a bare ratio.
        peer: what it is compared with, with its version; ``""`` for nothing.
        peer_value: what the peer needed, in the unit that the benchmark's docstring names.
    """

    case: str
    figure: str
    value: float
    unit: str
    peer: str = ""
    peer_value: float | None = None


def cpu_seconds(calls: dict[str, Callable[[], object]], budget: float = 1.0) -> dict[str, float]:
    """Median process CPU time of one call of each, in seconds.

    The calls take turns in one process, so that a busy machine slows all of them alike. Each
    runs once before it counts (compilation, caches), then in batches of at least a millisecond
    until ``budget`` seconds have gone to each, but seven batches at least.
    """
    batches = {name: _batch_size(call) for name, call in calls.items()}
    samples: dict[str, list[float]] = {name: [] for name in calls}
    while any(_wanting(samples[name], batches[name], budget) for name in calls):
        for name, call in calls.items():
            if _wanting(samples[name], batches[name], budget):
                samples[name].append(_time(call, batches[name]))
    return {name: statistics.median(values) for name, values in samples.items()}


def _wanting(values: list[float], batch: int, budget: float) -> bool:
    return len(values) < 7 or sum(values) * batch < budget


def _batch_size(call: Callable[[], object]) -> int:
    call()
    return max(1, int(1e-3 / max(_time(call, 1), 1e-6)))


def _time(call: Callable[[], object], batch: int) -> float:
    start = time.process_time()
    for _ in range(batch):
        call()
    return (time.process_time() - start) / batch


def main(
    description: str,
    measure: Callable[..., Iterable[Figure]],
    cases: Iterable[str],
    usual: Iterable[str] | None = None,
    **counts: int,
) -> None:
    """Command line of a benchmark: measure the cases and print their figures.

    Args:
        description: the benchmark's docstring.
        measure: gives the figures of a case; it is called with the case and all ``counts``.
        cases: their names.
        usual: those measured where none is asked for; None for all.
        counts: options that are whole numbers, with their defaults.
    """
    names, wanted = list(cases), list(cases if usual is None else usual)
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    parser.add_argument("--case", action="append", choices=names, help="only this case (repeat)")
    for name, value in counts.items():
        parser.add_argument(f"--{name}", type=int, default=value, help=f"default: {value}")
    arguments = parser.parse_args()
    chosen = {name: getattr(arguments, name) for name in counts}
    figures = (f for case in arguments.case or wanted for f in measure(case, **chosen))
    for line in _json_lines(figures) if arguments.json else _table(figures):
        print(line, flush=True)


def _json_lines(figures: Iterable[Figure]) -> Iterator[str]:
    for figure in figures:
        yield json.dumps(asdict(figure))


def _table(figures: Iterable[Figure]) -> Iterator[str]:
    head = ("case", "figure", "value", "unit", "peer", "peer's value")
    layout = "{:<14} {:<24} {:>12} {:<5} {:<24} {:>12}"
    yield layout.format(*head)
    for figure in figures:
        peer_value = "" if figure.peer_value is None else f"{figure.peer_value:.5g}"
        yield layout.format(
            figure.case, figure.figure, f"{figure.value:.5g}", figure.unit, figure.peer, peer_value
        ).rstrip()
