"""How Python hands arrays to a kernel: described where the kernel reads them.

numba has each array of each tuple described, taken apart, put together into its tuple, taken apart
again and handed over number by number, with a way out after each: sixty instructions an array, for
most kernels more than what they do. Here descriptions are written in their place, and looked at
once, when all are there. numba has made sure before that arguments are of the types it compiled.

It builds on the inside of one version of numba; see `linked`.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant
from numba import types
from numba.core import cgutils
from numba.core.callwrapper import PyCallWrapper
from numba.np import numpy_support

_ITEM_BYTES = 3
"""Where numba's description of an array holds the size of an element."""


def make_wrapper(context: Any, calls: Any, library: Any, described: Any, env: Any) -> None:
    """Add the function to a kernel's code that Python calls.

    Args:
        context: numba's, of the target.
        calls: how the kernel is called (`lean_lowering.WholeCalls`).
        library: the kernel's code.
        described: what numba knows of the kernel's function.
        env: its environment.
    """
    module = context.create_module("wrapper")
    callee = calls.declare(module, described)
    _Wrapper(context, module, callee, described, env, calls).build()
    library.add_ir_module(module)


class _Wrapper(PyCallWrapper):  # type: ignore[misc]
    def __init__(
        self, context: Any, module: Any, callee: Any, described: Any, env: Any, calls: Any
    ) -> None:
        super().__init__(context, module, callee, described, env, None, release_gil=False)
        self._calls = calls
        self._wrong: Any = None

    def build_wrapper(self, api: Any, builder: Any, closure: Any, args: Any, kws: Any) -> None:
        """Describe the arguments, call the kernel, and hand back what it returns."""
        kinds = self.fndesc.argtypes
        objects = [api.alloca_obj() for _ in kinds]
        count = len(kinds)
        parsed = api.unpack_tuple(args, self.fndesc.qualname, count, count, *objects)
        with cgutils.if_unlikely(builder, cgutils.is_null(builder, parsed)):
            builder.ret(api.get_null_object())
        environment = self.get_env(api, builder)
        self._wrong = cgutils.false_bit
        given = []
        for one, kind in zip(objects, kinds, strict=True):
            place = cgutils.alloca_once(builder, self.context.get_value_type(kind))
            self._describe(api, builder, builder.load(one), kind, place)
            given.append(self._calls.standing_at(builder, place))
        with cgutils.if_unlikely(builder, self._wrong):
            with builder.if_then(cgutils.is_null(builder, api.err_occurred())):
                api.err_set_string("PyExc_TypeError", "an argument is not of its type")
            builder.ret(api.get_null_object())
        status, value = self._calls.call_function(
            builder, self.func, self.fndesc.restype, kinds, given, attrs=("noinline",)
        )
        with builder.if_then(status.is_ok, likely=True):
            with builder.if_then(status.is_none):
                api.return_none()
            builder.ret(api.from_native_return(self.fndesc.restype, value, environment))
        self._calls.raise_error(builder, api, status)
        builder.ret(api.get_null_object())

    def _describe(self, api: Any, builder: Any, held: Any, kind: Any, place: Any) -> None:
        """Write what the kernel wants to know of a Python object to a place."""
        if isinstance(kind, types.Array):
            failed = api.numba_array_adaptor(held, builder.bitcast(place, api.voidptr))
            size = builder.load(cgutils.gep_inbounds(builder, place, 0, _ITEM_BYTES))
            other = Constant(size.type, numpy_support.as_dtype(kind.dtype).itemsize)
            wrong = builder.or_(
                cgutils.is_not_null(builder, failed), builder.icmp_unsigned("!=", size, other)
            )
        elif isinstance(kind, types.BaseTuple):
            for k, part in enumerate(kind):
                item = api.tuple_getitem(held, k)
                own = cgutils.gep_inbounds(builder, place, 0, k)
                self._describe(api, builder, item, part, own)
            return
        else:
            native = api.to_native_value(kind, held)
            builder.store(native.value, place)
            wrong = native.is_error
        self._wrong = builder.or_(self._wrong, wrong)
