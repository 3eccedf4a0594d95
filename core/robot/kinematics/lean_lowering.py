"""What kernels do most, in few instructions: elements of arrays, variables that stay, calls.

numba keeps what more than one block uses in memory, arrays and tuples of them whole, writes out two
dozen instructions to find an element, and takes a tuple of arrays apart for each call: hundreds of
numbers for what a kernel works on. Most of the time that compiling takes goes into making these
instructions, and into taking them out again. Here kernels hand on where arrays and tuples of them
are described. As nothing ever changes a description, it is read where it is needed.

It builds on the inside of one version of numba; see `linked`.
"""

from __future__ import annotations

from collections import defaultdict
from typing import Any

from llvmlite.ir import IntType, IRBuilder
from numba import types
from numba.core import ir
from numba.core.analysis import compute_cfg_from_blocks, compute_use_defs
from numba.core.callconv import CPUCallConv
from numba.core.cgutils import alloca_once, get_or_insert_function
from numba.core.compiler_machinery import register_pass
from numba.core.lowering import Lower
from numba.core.typed_passes import BaseNativeLowering

from .lean_wrapper import make_wrapper


class _Lower(Lower):  # type: ignore[misc]
    """Of a function that counts no references."""

    def _find_singly_assigned_variable(self) -> None:
        """Find the variables that are written once, before all places where they are read."""
        blocks = self.func_ir.blocks
        written, read = defaultdict(list), defaultdict(set)
        for label, block in blocks.items():
            for statement in block.find_insts(ir.Assign):
                written[statement.target.name].append(label)
        for label, names in compute_use_defs(blocks).usemap.items():
            for name in names:
                read[name].add(label)
        before = compute_cfg_from_blocks(blocks).dominators()
        self._kept: dict[str, Any] = {}
        self._to_keep = {
            name
            for name, (label, *more) in written.items()
            if not more and all(label < other and label in before[other] for other in read[name])
        }
        self._singly_assigned_vars: set[str] = set()
        self._blk_local_varmap: dict[str, Any] = {}

    def _alloca_var(self, name: str, fetype: Any) -> None:
        if name not in self._to_keep:
            super()._alloca_var(name, fetype)

    def loadvar(self, name: str) -> Any:
        """The value of a variable."""
        return self._kept[name] if name in self._to_keep else super().loadvar(name)

    def storevar(self, value: Any, name: str, argidx: int | None = None) -> None:
        """Give a variable its value."""
        if name in self._to_keep:
            self._kept[name] = value
        else:
            self.builder.store(value, self.getvar(name))

    def delvar(self, name: str) -> None:
        """Nothing: nothing is counted."""

    def lower_expr(self, resty: Any, expr: Any) -> Any:
        """One expression."""
        if expr.op == "getattr":
            held = self.typeof(expr.value.name)
            if isinstance(held, types.NamedTuple | types.NamedUniTuple):
                return self._within(expr, held.fields.index(expr.attr))
            if isinstance(held, types.Array) and expr.attr in ("size", "shape"):
                return self._within(expr, _ITEMS if expr.attr == "size" else _SHAPE)
        return super().lower_expr(resty, expr)

    def _within(self, expr: Any, index: int) -> Any:
        return _part(self.builder, self.loadvar(expr.value.name), index)

    def lower_getitem(self, resty: Any, expr: Any, value: Any, index: Any, signature: Any) -> Any:
        """Read an element."""
        place = self._element(value, index)
        if place is None:
            return super().lower_getitem(resty, expr, value, index, signature)
        own = self.typeof(value.name).dtype
        found = self.context.unpack_value(self.builder, own, place)
        return self.context.cast(self.builder, found, own, resty)

    def lower_setitem(self, target_var: Any, index_var: Any, value_var: Any, signature: Any) -> Any:
        """Write an element."""
        place = self._element(target_var, index_var)
        if place is None:
            return super().lower_setitem(target_var, index_var, value_var, signature)
        own, given = self.typeof(target_var.name).dtype, self.typeof(value_var.name)
        value = self.context.cast(self.builder, self.loadvar(value_var.name), given, own)
        self.context.pack_value(self.builder, own, value, place)

    def _element(self, array: Any, index: Any) -> Any:
        """The address of an element; None for all that is not one number of a compact array."""
        held, by = self.typeof(array.name), self.typeof(index.name)
        if not (isinstance(held, types.Array) and held.layout == "C" and held.aligned):
            return None
        if not isinstance(held.dtype, types.Float | types.Integer | types.Boolean):
            return None
        several = isinstance(by, types.BaseTuple)
        kinds = tuple(by) if several else (by,)
        if len(kinds) != held.ndim or not all(isinstance(one, types.Integer) for one in kinds):
            return None
        builder, given = self.builder, self.loadvar(index.name)
        whole, offset = self.loadvar(array.name), None
        for d, kind in enumerate(kinds):
            at = builder.extract_value(given, d) if several else given
            at = self.context.cast(builder, at, kind, types.intp)
            from_start = isinstance(kind, types.IntegerLiteral) and kind.literal_value >= 0
            if d > 0 or not from_start:
                size = _part(builder, whole, _SHAPE, d)
            if not from_start:
                negative = builder.icmp_signed("<", at, at.type(0))
                at = builder.select(negative, builder.add(at, size), at)
            if offset is not None:
                at = builder.add(builder.mul(offset, size, flags=("nsw",)), at, flags=("nsw",))
            offset = at
        return builder.gep(_part(builder, whole, _DATA), [offset])


_ITEMS, _DATA, _SHAPE = 2, 4, 5
"""Where numba's description of an array holds how many elements there are, their address, and how
many along each axis."""


def _described(kind: Any) -> bool:
    """Whether values are arrays or tuples that may hold some."""
    return isinstance(kind, types.Array | types.NamedTuple | types.NamedUniTuple)


def _places(builder: Any) -> dict[int, tuple[Any, Any]]:
    """Values that were read from memory that does not change, by their `id`; and from where."""
    if not hasattr(builder, "flyby_places"):
        builder.flyby_places = {}
    found: dict[int, tuple[Any, Any]] = builder.flyby_places
    return found


def _read(builder: Any, place: Any) -> Any:
    """What stands at a place that does not change."""
    value = builder.load(place)
    _places(builder)[id(value)] = value, place
    return value


def _part(builder: Any, whole: Any, *path: int) -> Any:
    """A part of a description, read from where it stands."""
    known = _places(builder).get(id(whole))
    if known is None:
        return builder.extract_value(whole, path)
    return _read(builder, builder.gep(known[1], [_INDEX(0), *map(_INDEX, path)], inbounds=True))


_INDEX = IntType(32)


class _Whole:
    """Arguments handed over as they are; see `numba.core.datamodel.ArgPacker`."""

    def __init__(self, context: Any, kinds: Any) -> None:
        self._described = [_described(kind) for kind in kinds]
        wholes = (context.get_value_type(kind) for kind in kinds)
        self.argument_types = [
            whole.as_pointer() if described else whole
            for whole, described in zip(wholes, self._described, strict=True)
        ]

    def as_arguments(self, builder: Any, values: Any) -> Any:
        """What is handed over for values."""
        return [
            self._place(builder, value) if described else value
            for value, described in zip(values, self._described, strict=True)
        ]

    def from_arguments(self, builder: Any, arguments: Any) -> Any:
        """The values of what is handed over."""
        return [
            _read(builder, argument) if described else argument
            for argument, described in zip(arguments, self._described, strict=True)
        ]

    def assign_names(self, arguments: Any, names: Any) -> None:
        """Say of descriptions that nothing changes them."""
        for argument, described in zip(arguments, self._described, strict=True):
            if described:
                argument.add_attribute("noalias")
                argument.add_attribute("captures(none)")

    def _place(self, builder: Any, value: Any) -> Any:
        known = _places(builder).get(id(value))
        if known is not None:
            return known[1]
        place = alloca_once(builder, value.type)
        builder.store(value, place)
        return place


class WholeCalls(CPUCallConv):  # type: ignore[misc]
    """How functions are called that kernels alone call."""

    def _get_arg_packer(self, argtypes: Any) -> _Whole:
        return _Whole(self.context, argtypes)

    def declare(self, module: Any, described: Any) -> Any:
        """A function, in the code of one that calls it."""
        kind = self.get_function_type(described.restype, described.argtypes)
        # Kernels that an older version has kept hold functions that are called in numba's way.
        name = f"{described.mangled_name}.whole"
        function = get_or_insert_function(module, kind, name)
        self.decorate_function(function, described.args, described.argtypes)
        if described.inline:
            function.attributes.add("alwaysinline")
        return function

    def standing_at(self, builder: Any, place: Any) -> Any:
        """The value at a place that does not change, as it is handed over."""
        return _read(builder, place)


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


class _LeanLower(_InnerLower):
    """Of a function that Python calls."""

    def create_cpython_wrapper(self, release_gil: bool = False) -> None:
        """Add what Python calls."""
        make_wrapper(self.context, self.call_conv, self.library, self.fndesc, self.env)


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
