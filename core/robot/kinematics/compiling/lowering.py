"""What kernels do most, in few instructions: elements of arrays, variables that stay, loops, calls.

numba keeps what more than one block uses in memory, arrays and tuples of them whole, writes out two
dozen instructions to find an element and a hundred for a loop, and takes a tuple of arrays apart
for each call: hundreds of numbers for what a kernel works on. Most of the time that compiling takes
goes into making these instructions, and into taking them out again.

It builds on the inside of one version of numba; see `linked`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from llvmlite.ir import IRBuilder
from numba import types
from numba.core import ir
from numba.core.cgutils import alloca_once
from numba.core.compiler_machinery import register_pass
from numba.core.lowering import Lower
from numba.core.typed_passes import BaseNativeLowering

from .arrays import ITEMS, SHAPE, element, part, row
from .calls import WholeCalls, never_raises
from .numbers import operation
from .typing import EXTREMES, NUMBERS
from .usage import VariableUse, is_element, is_row
from .wrapper import make_wrapper


class _Lower(Lower):  # type: ignore[misc]
    """Of a function that counts no references."""

    def _find_singly_assigned_variable(self) -> None:
        """Find the variables that stay."""
        self._use = VariableUse(self.func_ir.blocks, self.typeof)
        self._kept: dict[str, Any] = {}
        self._singly_assigned_vars: set[str] = set()
        self._blk_local_varmap: dict[str, Any] = {}

    def _alloca_var(self, name: str, fetype: Any) -> None:
        if name not in self._use.kept:
            super()._alloca_var(name, fetype)

    def loadvar(self, name: str) -> Any:
        """The value of a variable."""
        return self._kept[name] if name in self._use.kept else super().loadvar(name)

    def storevar(self, value: Any, name: str, argidx: int | None = None) -> None:
        """Give a variable its value."""
        if name in self._use.kept:
            self._kept[name] = value
        else:
            self.builder.store(value, self.getvar(name))

    def lower_assign(self, ty: Any, inst: Any) -> Any:
        """What a variable is given."""
        value = inst.value
        if isinstance(value, ir.Expr) and inst.target.name in self._use.places:
            return [self._index(one) for one in value.items]
        if isinstance(value, ir.Var) and value.name in self._use.loops:
            return self.loadvar(value.name)
        return super().lower_assign(ty, inst)

    def lower_expr(self, resty: Any, expr: Any) -> Any:
        """One expression."""
        lower = self._LOOPS.get(expr.op)
        if lower is not None and expr.value.name in self._use.loops:
            return lower(self, self.loadvar(expr.value.name))
        if expr.op == "getattr":
            held = self.typeof(expr.value.name)
            if isinstance(held, types.NamedTuple | types.NamedUniTuple):
                return self._within(expr, held.fields.index(expr.attr))
            if isinstance(held, types.Array) and expr.attr in ("size", "shape"):
                return self._within(expr, ITEMS if expr.attr == "size" else SHAPE)
        return super().lower_expr(resty, expr)

    def _within(self, expr: Any, index: int) -> Any:
        return part(self.builder, self.loadvar(expr.value.name), index)

    def lower_call(self, resty: Any, expr: Any) -> Any:
        """A call."""
        if isinstance(resty, types.RangeType) and self._use.loops:
            return self._range(expr)
        called = getattr(self.typeof(expr.func.name), "typing_key", None)
        if called is bool and self.typeof(expr.args[0].name) == types.boolean:
            return self.loadvar(expr.args[0].name)
        if called is int and len(expr.args) == 1 and self.typeof(expr.args[0].name) in NUMBERS:
            return self._cast(expr.args[0], resty)
        if called in EXTREMES and resty in (types.float64, types.intp):
            return self._extreme(resty, called, expr.args)
        return super().lower_call(resty, expr)

    def lower_binop(self, resty: Any, expr: Any, op: Any) -> Any:
        """An operation on two values."""
        signature = self.fndesc.calltypes[expr]
        kinds = *signature.args, signature.return_type
        made = operation(op, kinds, self.typeof(expr.rhs.name))
        if made is None:
            return super().lower_binop(resty, expr, op)
        left, right = map(self._cast, (expr.lhs, expr.rhs), signature.args)
        found = made(self.builder, left, right)
        return self.context.cast(self.builder, found, signature.return_type, resty)

    def _extreme(self, kind: Any, called: Any, args: Any) -> Any:
        """The greatest or least of some numbers, as Python finds it where some are none."""
        builder, found = self.builder, None
        for one in args:
            value = self._cast(one, kind)
            if found is None:
                found = value
                continue
            compare = builder.icmp_signed if kind is types.intp else builder.fcmp_ordered
            beyond = compare(">" if called is max else "<", value, found)
            found = builder.select(beyond, value, found)
        return found

    def _range(self, call: Any) -> tuple[Any, Any, Any]:
        """Begin, end and step."""
        numbers = [self._cast(one, types.intp) for one in call.args[:2]]
        whole = numbers[0].type
        begin = whole(0) if len(numbers) == 1 else numbers[0]
        return begin, numbers[-1], whole(self._use.step_of(call))

    def _begin(self, given: tuple[Any, Any, Any]) -> tuple[Any, Any, Any]:
        """Where a loop stands, its end and its step."""
        begin, end, step = given
        place = alloca_once(self.builder, begin.type)
        self.builder.store(begin, place)
        return place, end, step

    def _next(self, loop: tuple[Any, Any, Any]) -> tuple[Any, Any]:
        """The number where a loop stands, and whether it goes on."""
        place, end, step = loop
        at = self.builder.load(place)
        on = self.builder.icmp_signed("<" if step.constant > 0 else ">", at, end)
        self.builder.store(self.builder.add(at, step, flags=("nsw",)), place)
        return at, on

    _LOOPS: ClassVar[dict[str, Callable[..., Any]]] = {
        "getiter": _begin,
        "iternext": _next,
        "pair_first": lambda self, pair: pair[0],
        "pair_second": lambda self, pair: pair[1],
    }

    def _cast(self, variable: Any, kind: Any) -> Any:
        value, own = self.loadvar(variable.name), self.typeof(variable.name)
        return self.context.cast(self.builder, value, own, kind)

    def _index(self, variable: Any) -> tuple[Any, bool]:
        """A number that says where an element is, and whether it is known not to be negative."""
        return self._cast(variable, types.intp), variable.name in self._use.never_negative

    def lower_getitem(self, resty: Any, expr: Any, value: Any, index: Any, signature: Any) -> Any:
        """Read an element, or describe a row."""
        held = self.typeof(value.name)
        if is_row(held, self.typeof(index.name)) and resty.layout == "C":
            whole, at = self.loadvar(value.name), [self._index(index)]
            return row(self.builder, whole, at, self.context.get_value_type(resty))
        place = self._element(value, index)
        if place is None:
            return super().lower_getitem(resty, expr, value, index, signature)
        found = self.context.unpack_value(self.builder, held.dtype, place)
        return self.context.cast(self.builder, found, held.dtype, resty)

    def lower_setitem(self, target_var: Any, index_var: Any, value_var: Any, signature: Any) -> Any:
        """Write an element."""
        place = self._element(target_var, index_var)
        if place is None:
            return super().lower_setitem(target_var, index_var, value_var, signature)
        own = self.typeof(target_var.name).dtype
        self.context.pack_value(self.builder, own, self._cast(value_var, own), place)

    def _element(self, array: Any, index: Any) -> Any:
        """The address of an element; None for all that is not one number of a compact array."""
        by = self.typeof(index.name)
        if not is_element(self.typeof(array.name), by):
            return None
        if index.name in self._use.places:
            indices = self.loadvar(index.name)
        elif isinstance(by, types.BaseTuple):
            whole = self.loadvar(index.name)
            indices = [
                (
                    self.context.cast(
                        self.builder, self.builder.extract_value(whole, d), kind, types.intp
                    ),
                    isinstance(kind, types.IntegerLiteral) and kind.literal_value >= 0,
                )
                for d, kind in enumerate(by)
            ]
        else:
            indices = [self._index(index)]
        return element(self.builder, self.loadvar(array.name), indices)


class _InnerLower(_Lower):
    """Of a function that kernels alone call."""

    @property
    def call_conv(self) -> WholeCalls:
        """How it is called."""
        return WholeCalls(self.context)

    def setup_function(self, fndesc: Any) -> None:
        """Begin."""
        self.function = self.call_conv.declare(self.module, fndesc)
        self.entry_block = self.function.append_basic_block("entry")
        self.builder = IRBuilder(self.entry_block)
        self.call_helper = self.call_conv.init_call_helper(self.builder)

    def lower(self) -> None:
        """Make the code, and note what callers may leave out."""
        super().lower()
        self.library.never_raises = never_raises(self.function)


class _LeanLower(_InnerLower):
    """Of a function that Python calls."""

    def create_cpython_wrapper(self, release_gil: bool = False) -> None:
        """Add what Python calls."""
        make_wrapper(self.context, self.call_conv, self.library, self.fndesc)


class _Lowering(BaseNativeLowering):  # type: ignore[misc]
    """numba's making of code."""

    lowering_class: type[Lower] = _LeanLower


@register_pass(mutates_CFG=True, analysis_only=False)
class LeanLowering(_Lowering):
    """Of kernels that Python calls."""

    _name = "flyby_lean_lowering"


@register_pass(mutates_CFG=True, analysis_only=False)
class InnerLowering(_Lowering):
    """Of those that kernels alone call."""

    _name = "flyby_inner_lowering"
    lowering_class = _InnerLower
