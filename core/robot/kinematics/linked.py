"""What numba's compiler needs so that code is made for other kernels alone; see `lean.inner`.

It builds on the inside of one version of numba (`numba_version.LINKED`), and is imported with that
one only.
"""

from __future__ import annotations

from typing import Any

from numba import _dynfunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.typed_passes import AnnotateTypes, NativeLowering


class _Intermediate(JITCodeLibrary):  # type: ignore[misc]
    """Code that is optimised and made into machine code in its callers only."""

    def _optimize_functions(self, module: Any) -> None:
        module.data_layout = self._codegen._data_layout

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


class _Once(JITCodeLibrary):  # type: ignore[misc]
    """Code that is optimised once.

    numba does so twice, to prune counts of references in between, of which there are none here.
    """

    def _optimize_final_module(self) -> None:
        passes, builder = self._codegen._module_pass_manager()
        passes.run(self._final_module, builder)


class LeanCompiler(Compiler):  # type: ignore[misc]
    """Compiles kernels that Python calls and that count no references."""

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
        library = _Once(targetctx.codegen(), "lean")
        library.enable_object_caching()
        super().__init__(typingctx, targetctx, library, args, return_type, flags, locals)


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
        state.targetctx.insert_user_function(key, found.fndesc, [state.library])
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


class LinkedCompiler(Compiler):  # type: ignore[misc]
    """Compiles as far as callers need it: to code that can be linked."""

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
        library = _Intermediate(targetctx.codegen(), "inner")
        super().__init__(typingctx, targetctx, library, args, return_type, flags, locals)

    def define_pipelines(self) -> Any:
        made = super().define_pipelines()
        for passes in made:
            passes.add_pass_after(_Unwrapped, AnnotateTypes)
            passes.add_pass_after(_Linkable, NativeLowering)
            passes.finalize()
        return made
