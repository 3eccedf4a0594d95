"""Orders of tasks whose answers are known."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import flyby
from flyby.core.errors import FlybyError
from flyby.core.program.program import Program
from flyby.problems.placement.task_orders import TaskOrders, quickest_order

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"


def write(folder: Path, places: list[float], rest: str = "") -> Path:
    """Tasks t0, t1, … each at its angle round the robot, one after the other."""
    calls, bodies = [], []
    for k, degrees in enumerate(places):
        x, y = (420 * f(math.radians(degrees)) for f in (math.cos, math.sin))
        moves = [
            f"MoveJ [[{x},{y},{z}],[0,0,1,0],[0,0,0,0],{UNUSED}], v1000, fine, tool0;"
            for z in (420, 330, 420)
        ]
        calls.append(f"t{k};")
        bodies.append(f"  PROC t{k}()\n    SetDO weld{k}, 1;\n    {' '.join(moves)}\n  ENDPROC\n")
    (folder / "cell.toml").write_text(f'robot = "abb/irb120-3-058"\nclearance_mm = 5\n{rest}')
    home = f"MoveAbsJ [[0,0,0,0,60,0],{UNUSED}], v1000, fine, tool0;"
    program = folder / "p.mod"
    program.write_text(
        f"MODULE p\n  PROC main()\n    ConfJ \\Off;\n    {home}\n    {' '.join(calls)}\n"
        f"    {home}\n  ENDPROC\n{''.join(bodies)}ENDMODULE\n"
    )
    return program


@given(order=st.permutations(range(4)))
def test_every_order_carries_out_the_same(order: list[int], tmp_path_factory) -> None:
    folder = tmp_path_factory.mktemp("order")
    program = flyby.read(write(folder, [0, 20, 40, 60]), cell=folder / "cell.toml")
    orders = TaskOrders.of(program, ["t0", "T1", "t2", "t3"])
    made = orders.program_in(tuple(order))
    assert sorted(map(repr, made.statements)) == sorted(map(repr, program.statements))
    told = [s.text for s in made.statements if hasattr(s, "text") and "SetDO" in s.text]
    assert told == [f"SetDO weld{k}, 1;" for k in order]
    assert (made.moves[0], made.moves[-1]) == (program.moves[0], program.moves[-1])


def test_base_and_order_are_found_together(tmp_path: Path) -> None:
    """The quickest of all orders from the base found, which is proven."""
    places = [60.0, -60.0, 30.0, -30.0]
    program = flyby.read(write(tmp_path, places), cell=tmp_path / "cell.toml")
    names = [f"t{k}" for k in range(4)]
    made = flyby.place(program, order=names, room=(0.02, 0.02, 0.0, 0.0))
    assert made.proven and made.found.before is not None
    assert made.found.best.run.duration < made.found.before.run.duration - 0.3
    orders = TaskOrders.of(program, names)
    robot = program.setup.robot.with_base(made.base)

    def seconds(one: Program) -> float:
        cell = replace(one.setup.cell, robot=robot)
        setup = replace(one.setup, robot=robot, cell=cell)
        return float(flyby.emulate(replace(one, setup=setup), strict=True).duration)

    every = [seconds(orders.program_in(o)) for o in itertools.permutations(range(4))]
    assert made.found.best.run.duration == pytest.approx(min(every), abs=2e-3)


@pytest.mark.parametrize(
    ("order", "words"), [(["t0", "t9"], "routine .*'t9'"), (["t0"], "carries out 1")]
)
def test_tasks_that_are_none_are_refused(tmp_path: Path, order: list[str], words: str) -> None:
    program = flyby.read(write(tmp_path, [0.0, 40.0]), cell=tmp_path / "cell.toml")
    with pytest.raises(FlybyError, match=words):
        flyby.place(program, order=order)


@given(st.lists(st.floats(0.0, 100.0), min_size=2, max_size=7, unique=True))
def test_exchanges_find_no_worse_order(places: list[float]) -> None:
    """Of many tasks orders are exchanged: never slower than as it is."""

    class Line(TaskOrders):
        def program_in(self, order):  # type: ignore[override]
            return order

    orders = Line(None, tuple(places))  # type: ignore[arg-type]

    def way(order) -> float:
        return sum(abs(places[a] - places[b]) for a, b in itertools.pairwise(order))

    best = quickest_order(orders, way)
    assert way(best) <= way(orders.given)
    if len(places) <= 5:
        assert way(best) <= max(places) - min(places) + 1.1e-3
