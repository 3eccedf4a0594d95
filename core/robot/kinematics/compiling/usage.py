"""What can be read off a kernel's typed code before it is lowered: variables and what they hold.

It builds on the inside of one version of numba; see `linked`.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from typing import Any

from numba import types
from numba.core import ir
from numba.core.analysis import compute_cfg_from_blocks


class VariableUse:
    """Of one kernel.

    Args:
        blocks: its code, by label.
        types_of: types of its variables.

    Attributes:
        kept: variables that are written once, before all places where they are read.
        loops: what numba makes of loops over ranges (ranges, iterators, and pairs of a number and
            whether it counts), if their steps are written as literals.
        places: tuples of integers that are elements' indices and nothing else.
        never_negative: integers that are never negative.
    """

    def __init__(self, blocks: dict[int, Any], types_of: Callable[[str], Any]) -> None:
        self._type = types_of
        self._written: dict[str, list[Any]] = defaultdict(list)
        self._read: dict[str, list[Any]] = defaultdict(list)
        self.kept = self._find_kept(blocks)
        self.loops = self._find_loops()
        self.places = {name for name in self.kept if self._is_place(name)}
        self.never_negative = self._find_never_negative()

    def range_of(self, name: str) -> Any:
        """The call of `range` that a range, its iterator or a pair of it comes from."""
        value = self._written[name][0]
        while not (isinstance(value, ir.Expr) and value.op == "call"):
            name = value.name if isinstance(value, ir.Var) else value.value.name
            value = self._written[name][0]
        return value

    def step_of(self, call: Any) -> int:
        """The step of a range, by its call."""
        return int(self._type(call.args[2].name).literal_value) if len(call.args) > 2 else 1

    def _find_kept(self, blocks: dict[int, Any]) -> set[str]:
        """Note what is written and read where, and find the variables to keep."""
        written, read = defaultdict(list), defaultdict(set)
        for label, block in blocks.items():
            here = set()
            for statement in block.body:
                reader = statement.value if isinstance(statement, ir.Assign) else statement
                for name in _names(reader):
                    self._read[name].append(reader)
                    if name not in here:
                        read[name].add(label)
                if reader is not statement:
                    name = statement.target.name
                    self._written[name].append(reader)
                    written[name].append(label)
                    here.add(name)
        before = compute_cfg_from_blocks(blocks).dominators()
        return {
            name
            for name, (label, *more) in written.items()
            # Blocks are lowered in the order of their labels.
            if not more and all(label < other and label in before[other] for other in read[name])
        }

    def _find_loops(self) -> set[str]:
        """All variables that hold parts of loops over ranges; none if one is of another kind."""
        parts = {name for name in self._written if self._is_part(name)}
        return parts if all(self._counts(name) for name in parts) else set()

    def _is_part(self, name: str) -> bool:
        kind = self._type(name)
        if not isinstance(kind, types.Pair):
            return isinstance(kind, types.RangeType | types.RangeIteratorType)
        value = self._written[name][0]
        goes_on = isinstance(value, ir.Expr) and value.op == "iternext"
        return goes_on and isinstance(self._type(value.value.name), types.RangeIteratorType)

    def _counts(self, name: str) -> bool:
        """Whether a part of a loop comes about as `range_of` has it."""
        value = self._written[name][0]
        if name not in self.kept or not isinstance(value, ir.Var | ir.Expr):
            return False
        if isinstance(value, ir.Var):
            return True
        if not isinstance(self._type(name), types.RangeType):
            return value.op in ("getiter", "iternext")
        read = self._read[name]
        return self._is_range(value) and all(
            isinstance(one, ir.Expr) and one.op == "getiter" for one in read
        )

    def _is_range(self, value: Any) -> bool:
        if value.op != "call" or value.kws or value.vararg is not None:
            return False
        step = self._type(value.args[2].name) if len(value.args) > 2 else types.literal(1)
        return isinstance(step, types.IntegerLiteral) and step.literal_value != 0

    def _is_place(self, name: str) -> bool:
        value = self._written[name][0]
        if not (isinstance(value, ir.Expr) and value.op == "build_tuple"):
            return False
        if not all(isinstance(self._type(one.name), types.Integer) for one in value.items):
            return False
        return all(self._indexes(one, name) for one in self._read[name])

    def _indexes(self, reader: Any, name: str) -> bool:
        """Whether a variable is read as an element's index alone."""
        if isinstance(reader, ir.SetItem):
            return bool(
                reader.index.name == name
                and is_element(self._type(reader.target.name), self._type(name))
            )
        if isinstance(reader, ir.Expr) and reader.op == "getitem":
            return is_element(self._type(reader.value.name), self._type(name))
        return False

    def _find_never_negative(self) -> set[str]:
        integers = {name for name in self._written if isinstance(self._type(name), types.Integer)}
        # Those that are left are not negative as long as those before them are not.
        while True:
            left = {
                name
                for name in integers
                if all(self._stays(value, integers) for value in self._written[name])
            }
            if left == integers:
                return left
            integers = left

    def _stays(self, value: Any, integers: set[str]) -> bool:
        """Whether a value is not negative if none of some integers is."""
        if isinstance(value, ir.Const | ir.Global | ir.FreeVar):
            return isinstance(value.value, int) and value.value >= 0
        if isinstance(value, ir.Var):
            return value.name in integers
        if not isinstance(value, ir.Expr):
            return False
        if value.op in ("binop", "inplace_binop"):
            fn = value.fn if value.op == "binop" else value.immutable_fn
            return fn.__name__ in ("add", "mul") and {value.lhs.name, value.rhs.name} <= integers
        if value.op == "cast":
            return value.value.name in integers
        if value.op == "pair_first" and value.value.name in self.loops:
            return self._range_stays(self.range_of(value.value.name), integers)
        if value.op == "getattr":
            return value.attr == "size" and isinstance(self._type(value.value.name), types.Array)
        if value.op == "static_getitem":
            return self._is_shape(value.value.name)
        return False

    def _range_stays(self, call: Any, integers: set[str]) -> bool:
        begin, end = (None, call.args[0]) if len(call.args) == 1 else call.args[:2]
        if self.step_of(call) > 0:
            return begin is None or begin.name in integers
        kind = self._type(end.name)
        return isinstance(kind, types.IntegerLiteral) and kind.literal_value >= -1

    def _is_shape(self, name: str) -> bool:
        values = self._written[name]
        return all(
            isinstance(one, ir.Expr)
            and (
                (one.op == "getattr" and one.attr == "shape")
                or (one.op == "exhaust_iter" and self._is_shape(one.value.name))
            )
            for one in values
        )


def _names(reader: Any) -> Iterator[str]:
    """The variables that a statement or an expression reads."""
    if isinstance(reader, ir.Var):
        yield reader.name
    elif isinstance(reader, ir.Expr):
        yield from _names(list(reader._kws.values()))
    elif isinstance(reader, list | tuple):
        for one in reader:
            yield from _names(one)
    elif isinstance(reader, ir.Stmt):
        for variable in reader.list_vars():
            yield variable.name


def is_element(held: Any, by: Any) -> bool:
    """Whether an index of one type names one number of a compact array of another."""
    if not (isinstance(held, types.Array) and held.layout == "C" and held.aligned):
        return False
    if not isinstance(held.dtype, types.Float | types.Integer | types.Boolean):
        return False
    kinds = tuple(by) if isinstance(by, types.BaseTuple) else (by,)
    return len(kinds) == held.ndim and all(isinstance(one, types.Integer) for one in kinds)


def is_row(held: Any, by: Any) -> bool:
    """Whether an index of one type takes the first axis off a compact array of another."""
    return (
        isinstance(held, types.Array)
        and held.layout == "C"
        and held.aligned
        and held.ndim > 1
        and isinstance(by, types.Integer)
    )
