"""How Python hands arrays to a kernel: described where the kernel reads them.

numba has each array of each tuple described, taken apart, put together into its tuple, taken apart
again and handed over number by number, with a way out after each: sixty instructions an array, for
most kernels more than what they do. Here one loop describes arrays that follow each other, in their
place, and all are looked at once, when they are there. numba has made sure before that arguments
are of the types it compiled.

It builds on the inside of one version of numba; see `linked`.
"""

from __future__ import annotations

from itertools import groupby
from typing import Any

from llvmlite.ir import (
    ArrayType,
    Constant,
    Function,
    FunctionType,
    IntType,
    IRBuilder,
    LiteralStructType,
)
from numba import types
from numba.core import cgutils
from numba.core.callwrapper import PyCallWrapper
from numba.np import numpy_support

_WORD, _WORD_BYTES = IntType(types.intp.bitwidth), types.intp.bitwidth // 8
_ITEM_BYTES, _SHAPE = 3, 5
"""Where numba's description of an array, one word after the other, holds the size of an element,
and from where on how many there are along each axis and bytes from one to the next."""


def make_wrapper(context: Any, calls: Any, library: Any, described: Any) -> None:
    """Add the function to a kernel's code that Python calls.

    Args:
        context: numba's, of the target.
        calls: how the kernel is called (`calls.WholeCalls`).
        library: the kernel's code.
        described: what numba knows of the kernel's function.
    """
    module = context.create_module("wrapper")
    callee = calls.declare(module, described)
    _Wrapper(context, module, callee, described, calls, library.never_raises).build()
    library.add_ir_module(module)


def _is_array(item: tuple[int, Any]) -> bool:
    return isinstance(item[1], types.Array)


class _Wrapper(PyCallWrapper):  # type: ignore[misc]
    def __init__(
        self, context: Any, module: Any, callee: Any, described: Any, calls: Any, safe: bool
    ) -> None:
        super().__init__(context, module, callee, described, None, None, release_gil=False)
        self._calls, self._safe = calls, safe
        self._wrong: Any = None

    def build_wrapper(self, api: Any, builder: Any, closure: Any, args: Any, kws: Any) -> None:
        """Describe the arguments, call the kernel, and hand back the numbers that it returns."""
        kinds = self.fndesc.argtypes
        whole = LiteralStructType([self.context.get_value_type(kind) for kind in kinds])
        place = cgutils.alloca_once(builder, whole)
        self._wrong = cgutils.false_bit
        self._describe(api, builder, args, kinds, place)
        with cgutils.if_unlikely(builder, self._wrong):
            with builder.if_then(cgutils.is_null(builder, api.err_occurred())):
                api.err_set_string("PyExc_TypeError", "an argument is not of its type")
            builder.ret(api.get_null_object())
        given = [
            self._calls.standing_at(builder, cgutils.gep_inbounds(builder, place, 0, k))
            for k in range(len(kinds))
        ]
        apart = ("noinline",)
        if self._safe:
            value = self._calls.call_safe(builder, self.func, self.fndesc, given, apart)
            builder.ret(api.from_native_return(self.fndesc.restype, value, None))
            return
        status, value = self._calls.call_function(
            builder, self.func, self.fndesc.restype, kinds, given, attrs=apart
        )
        with builder.if_then(status.is_ok, likely=True):
            with builder.if_then(status.is_none):
                api.return_none()
            builder.ret(api.from_native_return(self.fndesc.restype, value, None))
        self._calls.raise_error(builder, api, status)
        builder.ret(api.get_null_object())

    def _describe(self, api: Any, builder: Any, held: Any, kinds: Any, place: Any) -> None:
        """Write what the kernel wants to know of the items of a Python tuple to a place."""
        for are_arrays, run in groupby(enumerate(kinds), _is_array):
            items = list(run)
            if are_arrays:
                wrong = self._describe_arrays(builder, held, items, place)
                self._wrong = builder.or_(self._wrong, wrong)
                continue
            for k, kind in items:
                item, own = api.tuple_getitem(held, k), cgutils.gep_inbounds(builder, place, 0, k)
                if isinstance(kind, types.BaseTuple):
                    self._describe(api, builder, item, kind, own)
                    continue
                native = api.to_native_value(kind, item)
                builder.store(native.value, own)
                self._wrong = builder.or_(self._wrong, native.is_error)

    def _describe_arrays(self, builder: Any, held: Any, items: Any, place: Any) -> Any:
        """Describe arrays that follow each other in a tuple; whether one is of another type."""
        table, offset = [], 0
        for _, kind in items:
            table.append([offset, numpy_support.as_dtype(kind.dtype).itemsize])
            offset += _WORD_BYTES * (_SHAPE + 2 * kind.ndim)
        known = Constant(ArrayType(ArrayType(_WORD, 2), len(table)), table)
        sizes = cgutils.global_constant(builder, f"sizes.{len(self.module.globals)}", known)
        first = items[0][0]
        given = [
            held,
            _WORD(first),
            _WORD(len(items)),
            builder.bitcast(cgutils.gep_inbounds(builder, place, 0, first), cgutils.voidptr_t),
            builder.bitcast(sizes, known.type.element.as_pointer()),
        ]
        return builder.call(self._loop([one.type for one in given]), given)

    def _loop(self, kinds: Any) -> Any:
        """The function that describes some items of a tuple; whether one is of another type."""
        name = "flyby_describe"
        if name in self.module.globals:
            return self.module.globals[name]
        made = Function(self.module, FunctionType(cgutils.bool_t, kinds), name)
        made.linkage = "internal"
        made.attributes.add("noinline")
        held, first, count, place, sizes = made.args
        builder = IRBuilder(made.append_basic_block())
        api = self.context.get_python_api(builder)
        item = FunctionType(held.type, [held.type, _WORD])
        item_of = cgutils.get_or_insert_function(self.module, item, "PyTuple_GetItem")
        with cgutils.for_range(builder, count) as loop:
            offset, size = (
                builder.load(cgutils.gep_inbounds(builder, sizes, loop.index, d)) for d in range(2)
            )
            one = builder.call(item_of, [held, builder.add(first, loop.index)])
            own = builder.gep(place, [offset], inbounds=True)
            failed = cgutils.is_not_null(builder, api.numba_array_adaptor(one, own))
            words = builder.bitcast(own, _WORD.as_pointer())
            found = builder.load(cgutils.gep_inbounds(builder, words, _ITEM_BYTES))
            other = builder.icmp_unsigned("!=", found, size)
            with cgutils.if_unlikely(builder, builder.or_(failed, other)):
                builder.ret(cgutils.true_bit)
        builder.ret(cgutils.false_bit)
        return made
