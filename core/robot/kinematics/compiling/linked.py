"""What numba's compiler needs so that code is made for other kernels alone; see `lean.inner`.

It builds on the inside of one version of numba (`numba_version.LINKED`), and is imported with that
one only.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cached_property
from typing import Any

from llvmlite.binding import create_pass_builder, create_pipeline_tuning_options
from numba import _dynfunc, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import LoweringPass, PassManager, register_pass
from numba.core.interpreter import (
    Interpreter,
    peep_hole_delete_with_exit,
    peep_hole_fuse_dict_add_updates,
)
from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.registry import CPUDispatcher
from numba.core.transforms import canonicalize_cfg
from numba.core.typed_passes import NoPythonBackend, PreLowerStripPhis
from numba.core.untyped_passes import (
    FixupArgs,
    GenericRewrites,
    IRProcessing,
    ReconstructSSA,
    TranslateByteCode,
)

from .calls import WholeCalls
from .lowering import InnerLowering, LeanLowering
from .typing import LeanTyping

_FOREIGN = peep_hole_delete_with_exit, peep_hole_fuse_dict_add_updates


class _Unoptimised(JITCodeLibrary):  # type: ignore[misc]
    """Code whose functions are not optimised one by one, before they are put together."""

    def _optimize_functions(self, module: Any) -> None:
        module.data_layout = self._codegen._data_layout


class _Intermediate(_Unoptimised):
    """Code that is optimised and made into machine code in its callers only.

    What it calls is not put into it: machine code is made of all that it needs, once.
    """

    never_raises: bool
    _shared_module: Any

    def finalize(self) -> None:
        """Nothing can be added any more."""
        self._finalize_dynamic_globals()
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage.name == "external":
                function.linkage = "linkonce_odr"
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        """With all that it needs, for kernels that are no `_Once`."""
        if self._shared_module is None:
            self._shared_module = self._final_module.clone()
            _link(self._shared_module, _needed(self))
        return self._shared_module


class _Once(_Unoptimised):
    """Code that is optimised once.

    numba does so twice, to prune counts of references in between, of which there are none here.
    """

    def finalize(self) -> None:
        """Put together what it needs, and make machine code."""
        needed = _needed(self)
        for library in needed:
            self._reload_init.update(library._reload_init)
        _link(self._final_module, needed)
        self._linking_libraries: list[Any] = []
        super().finalize()

    def _optimize_final_module(self) -> None:
        options = create_pipeline_tuning_options(3)
        # Loops run over six joints or three axes: unrolled and vectorised they take half as long
        # again to make, and no less to run.
        options.loop_vectorization = options.slp_vectorization = options.loop_unrolling = False
        builder = create_pass_builder(self._codegen._tm, options)
        builder.getModulePassManager().run(self._final_module, builder)


def _needed(library: Any) -> dict[Any, None]:
    """All that code calls, and what that calls."""
    found: dict[Any, None] = {}
    ahead = list(reversed(library._linking_libraries))
    while ahead:
        one = ahead.pop()
        if one not in found:
            found[one] = None
            if isinstance(one, _Intermediate):
                ahead += reversed(one._linking_libraries)
    return found


def _link(module: Any, needed: Iterable[Any]) -> None:
    """Put code together.

    A function is taken over when something calls it. Where one of the same name stands already that
    calls nothing, as what it called is part of it, a function may be called only later.
    """
    parts = [
        one._final_module if isinstance(one, _Intermediate) else one._get_module_for_linking()
        for one in needed
    ]
    while parts:
        for part in parts:
            module.link_in(part, preserve=True)
        missing = {one.name for one in module.functions if one.is_declaration}
        late = [
            part
            for part in parts
            if any(one.name in missing for one in part.functions if not one.is_declaration)
        ]
        parts = late if len(late) < len(parts) else []


def _called(described: Any, library: Any) -> Any:
    """What numba wants to know of a function that can be called."""

    def call(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return WholeCalls(context).call(builder, described, args, library.never_raises)

    call.signature, call.libs = described.argtypes, (library,)  # type: ignore[attr-defined]
    return call


@register_pass(mutates_CFG=False, analysis_only=False)
class _Linkable(LoweringPass):  # type: ignore[misc]
    """Lets other kernels call what was lowered; it has no address, and Python never calls it."""

    _name = "flyby_linkable"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        found = state["cr"]
        name = found.fndesc.qualname.split(".")[-1]
        key = _dynfunc.make_function(
            found.fndesc.lookup_module(), name, "inner", 0, found.env, (state.library,)
        )
        called = _called(found.fndesc, state.library)
        state.targetctx._defns[key].append(called, found.fndesc.argtypes)
        state["cr"] = found._replace(cfunc=key)
        return True


@register_pass(mutates_CFG=False, analysis_only=False)
class _Unwrapped(LoweringPass):  # type: ignore[misc]
    """Has no wrapper made for Python, and no machine code.

    Only now: what a kernel calls is compiled once more for a caller with other flags.
    """

    _name = "flyby_unwrapped"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        state.flags.no_cpython_wrapper = True
        state.flags.no_compile = True
        return True


@contextmanager
def _with_less() -> Iterator[None]:
    """While it compiles, numba leaves out what such functions have no need of.

    After each pass it works out where variables live, which only generators and what counts
    references need to know; and it looks for remains of `with` and of dictionaries.
    """
    whole, mend = PostProcessor.run, Interpreter.post_process

    def run(processor: Any, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
        made = processor.func_ir
        if emit_dels or made.is_generator:
            whole(processor, emit_dels, extend_lifetimes)
            return
        made.blocks = canonicalize_cfg(made.blocks)
        made.variable_lifetime, made.generator_info = VariableLifetime(made.blocks), None

    def post_process(interpreter: Any, peepholes: Any, made: Any) -> Any:
        return mend(interpreter, [one for one in peepholes if one not in _FOREIGN], made)

    PostProcessor.run, Interpreter.post_process = run, post_process
    try:
        yield
    finally:
        PostProcessor.run, Interpreter.post_process = whole, mend


class _Compiler(Compiler):  # type: ignore[misc]
    """Compiles functions that make no array, and so hold nothing that has to be rewritten."""

    library: type[JITCodeLibrary]
    last: tuple[Any, ...]

    def __init__(
        self,
        typingctx: Any,
        targetctx: Any,
        library: Any,
        args: Any,
        return_type: Any,
        flags: Any,
        locals: Any,
    ) -> None:
        library = self.library(targetctx.codegen(), "lean")
        library.enable_object_caching()
        super().__init__(typingctx, targetctx, library, args, return_type, flags, locals)

    def define_pipelines(self) -> Any:
        passes = PassManager("lean")
        # Else each is followed by a look at which variables live where.
        passes._ENFORCING = False
        for one in (
            TranslateByteCode,
            FixupArgs,
            IRProcessing,
            GenericRewrites,
            ReconstructSSA,
            LeanTyping,
            PreLowerStripPhis,
            *self.last,
        ):
            passes.add_pass(one, one._name)
        passes.finalize()
        return [passes]

    def _compile_core(self) -> Any:
        with _with_less():
            return super()._compile_core()


class LeanCompiler(_Compiler):
    """Compiles kernels that Python calls and that count no references."""

    library = _Once
    last = (LeanLowering, NoPythonBackend)


class LeanDispatcher(CPUDispatcher):  # type: ignore[misc]
    """A kernel that Python calls; where kernels call it, it is compiled into them alone."""

    @cached_property
    def _within(self) -> Any:
        options = {**self.targetoptions, "no_cpython_wrapper": False}
        return CPUDispatcher(self.py_func, targetoptions=options, pipeline_class=LinkedCompiler)

    @property
    def _numba_type_(self) -> Any:
        return types.Dispatcher(self._within)


class LinkedCompiler(_Compiler):
    """Compiles as far as callers need it: to code that can be linked."""

    library = _Intermediate
    last = (_Unwrapped, InnerLowering, _Linkable, NoPythonBackend)
