"""Types of what kernels compute, asked of numba once for each operation and not at each place.

For each `a * b` numba tries what it knows of multiplication, one after the other, until one takes
the types of a and b, and does so again each time that something becomes known of the function.

It builds on the inside of one version of numba; see `linked`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from numba import types
from numba.core import errors
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import BaseTypeInference
from numba.core.typing import signature

EXTREMES = (max, min)
"""What is lowered as a comparison, where numba compiles a function of Python for each signature."""
NUMBERS = (types.float64, types.intp, types.boolean)
"""What `int` is lowered of as it is cast, where numba does so in a function of its own."""
_known: dict[tuple[Any, ...], tuple[Any, Any]] = {}
"""What was found, by what was asked for; with the types asked for, which thereby live on."""


@register_pass(mutates_CFG=True, analysis_only=False)
class LeanTyping(BaseTypeInference):  # type: ignore[misc]
    """numba's inference of types."""

    _name = "flyby_typing"

    def run_pass(self, state: Any) -> bool:
        """Find the types of a kernel's variables."""
        with _remembering(state.typingctx):
            return bool(super().run_pass(state))


def _are_plain(kinds: Any) -> bool:
    """Whether these are types of two numbers or more, of 64 bits."""
    plain = all(types.unliteral(kind) in (types.float64, types.intp) for kind in kinds)
    return len(kinds) > 1 and plain


@contextmanager
def _remembering(context: Any) -> Iterator[None]:
    """While a kernel is typed, and those that it calls."""
    if "resolve_function_type" in vars(context):
        yield
        return
    # numba colours a message for each operation that it tries in vain.
    colours: Any = errors.termcolor()
    colours._markup = lambda text, *_: text
    call, attribute, store, constant = (
        context.resolve_function_type,
        context.resolve_getattr,
        context.resolve_setitem,
        context.resolve_value_type,
    )

    def resolve_function_type(function: Any, args: Any, keywords: Any) -> Any:
        if keywords or not isinstance(function, types.Function | str):
            return call(function, args, keywords)
        called = getattr(function, "typing_key", None)
        if called is int and len(args) == 1 and args[0] in NUMBERS:
            return signature(types.intp, *args)
        if called in EXTREMES and _are_plain(args):
            kind = types.float64 if types.float64 in args else types.intp
            return signature(kind, *[kind] * len(args))
        return _recall(call, (function, *args), function, args, keywords)

    def resolve_value_type(value: Any) -> Any:
        # Numbers that are equal may be of several types.
        return _recall(constant, (value,), value) if callable(value) else constant(value)

    context.resolve_function_type = resolve_function_type
    context.resolve_value_type = resolve_value_type
    context.resolve_getattr = lambda held, name: _recall(attribute, (held, name), held, name)
    context.resolve_setitem = lambda *args: _recall(store, args, *args)
    try:
        yield
    finally:
        del colours._markup, context.resolve_value_type
        del context.resolve_function_type, context.resolve_getattr, context.resolve_setitem


def _recall(find: Callable[..., Any], asked: tuple[Any, ...], *args: Any) -> Any:
    # Types are one object each; their own comparison goes through all that they are made of.
    key = (find.__name__, *(id(one) if isinstance(one, types.Type) else (one,) for one in asked))
    try:
        known = _known.get(key)
    except TypeError:  # slices cannot be looked up
        return find(*args)
    if known is None:
        known = find(*args), asked
        if known[0] is not None:
            _known[key] = known
    return known[0]
