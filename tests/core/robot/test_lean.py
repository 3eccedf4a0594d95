"""Kernels that other kernels call, compiled into them."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from numba import njit

import flyby
from flyby.core.numba_version import LINKED
from flyby.core.robot.kinematics import lean


@pytest.mark.parametrize("linked", [LINKED, (0, 0)], ids=["as installed", "another numba"])
def test_inner_kernels_serve_with_any_numba(linked, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lean, "LINKED", linked)

    @lean.inner
    def squared(x: float) -> float:
        return x * x

    @njit(error_model="numpy")
    def summed(count: int) -> float:
        total = 0.0
        for k in range(count):
            total += squared(float(k))
        return total

    assert squared(3.0) == 9.0
    assert summed(4) == 14.0


COMPILED = {"inlined", "inner", "lean", "njit", "register_jitable", "overload", "generated_jit"}


def _decorators(function: ast.FunctionDef) -> set[str]:
    calls = (d.func if isinstance(d, ast.Call) else d for d in function.decorator_list)
    return {d.attr if isinstance(d, ast.Attribute) else getattr(d, "id", "") for d in calls}


def test_inner_kernels_are_called_by_kernels_alone() -> None:
    """From Python they would run as they are written, a hundred times as slowly."""
    root = Path(flyby.__file__).parent
    texts = {
        path: path.read_text(encoding="utf-8")
        for room in ("core", "problems/improve", "identification", "tasks", "drawing")
        for path in sorted((root / room).rglob("*.py"))
    }
    inside = {
        (path, node.name)
        for path, text in texts.items()
        if "@inner" in text or "@inlined" in text
        for node in ast.parse(text).body
        if isinstance(node, ast.FunctionDef) and {"inlined", "inner"} & _decorators(node)
    }
    assert len(inside) > 50
    said = {name for _, name in inside}
    wrong = []
    for path, text in texts.items():
        if said.isdisjoint(re.findall(r"\w+", text)):
            continue
        tree = ast.parse(text)
        names = {name for own, name in inside if own == path}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.level:
                above = path.parents[node.level - 1]
                source = above.joinpath(*(node.module or "").split(".")).with_suffix(".py")
                names |= {a.asname or a.name for a in node.names if (source, a.name) in inside}
        for function in tree.body:
            plain = isinstance(function, ast.FunctionDef) and not _decorators(function) & COMPILED
            if plain or isinstance(function, ast.ClassDef):
                wrong += [
                    f"{path.relative_to(root)}: {function.name} calls {call.func.id}"
                    for call in ast.walk(function)
                    if isinstance(call, ast.Call)
                    and isinstance(call.func, ast.Name)
                    and call.func.id in names
                ]
    assert wrong == [], wrong
