"""How kernels call each other.

It builds on the inside of one version of numba; see `linked`.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant
from llvmlite.ir.instructions import Ret
from numba.core.callconv import CPUCallConv
from numba.core.cgutils import alloca_once, get_or_insert_function, if_unlikely

from .arrays import is_described, place_of, read


def never_raises(function: Any) -> bool:
    """Whether a function's code returns without an error wherever it does."""
    ends = [block.terminator for block in function.blocks]
    codes = [end.operands[0] for end in ends if isinstance(end, Ret)]
    return all(isinstance(code, Constant) and code.constant == 0 for code in codes)


class _Whole:
    """Arguments handed over as they are; see `numba.core.datamodel.ArgPacker`."""

    def __init__(self, context: Any, kinds: Any) -> None:
        self._described = [is_described(kind) for kind in kinds]
        wholes = (context.get_value_type(kind) for kind in kinds)
        self.argument_types = [
            whole.as_pointer() if described else whole
            for whole, described in zip(wholes, self._described, strict=True)
        ]

    def as_arguments(self, builder: Any, values: Any) -> Any:
        """What is handed over for values."""
        return [
            place_of(builder, value) if described else value
            for value, described in zip(values, self._described, strict=True)
        ]

    def from_arguments(self, builder: Any, arguments: Any) -> Any:
        """The values of what is handed over."""
        return [
            read(builder, argument) if described else argument
            for argument, described in zip(arguments, self._described, strict=True)
        ]

    def assign_names(self, arguments: Any, names: Any) -> None:
        """Say of descriptions that nothing changes them."""
        for argument, described in zip(arguments, self._described, strict=True):
            if described:
                argument.add_attribute("noalias")
                argument.add_attribute("captures(none)")


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
        return read(builder, place)

    def call(self, builder: Any, described: Any, args: Any, safe: bool) -> Any:
        """Call a function; what it returns.

        Args:
            builder: makes the code of the caller, which returns the error where there is one.
            described: what numba knows of the function.
            args: what it is given.
            safe: whether it never raises.
        """
        function = self.declare(builder.module, described)
        if safe:
            return self.call_safe(builder, function, described, args)
        status, found = self.call_function(
            builder, function, described.restype, described.argtypes, args
        )
        with if_unlikely(builder, status.is_error):
            self.context.call_conv.return_status_propagate(builder, status)
        return found

    def call_safe(
        self, builder: Any, function: Any, described: Any, args: Any, attrs: tuple[str, ...] = ()
    ) -> Any:
        """Call a function that never raises; what it returns."""
        results = function.function_type.args[:2]
        place = alloca_once(builder, results[0].pointee)
        given = self._get_arg_packer(described.argtypes).as_arguments(builder, args)
        builder.call(function, [place, Constant(results[1], None), *given], attrs=attrs)
        return self.context.get_returned_value(builder, described.restype, builder.load(place))
