"""Kept kernels, loaded without what numba needs to compile others.

Before it loads its first kernel, numba by itself imports all that it can compile, SciPy's linear
algebra with it, and of each kernel it parses the code that goes into its callers: a second or two
for those of an emulation. Here machine code alone is loaded. The rest follows when something is
compiled: the imports by numba's compiler, the code for callers by a caller.

This builds on the inside of one version of numba (`numba_version.LINKED`), and is imported with
that one only.
"""

from __future__ import annotations

from typing import Any

import llvmlite.binding as llvm
from numba import _dynfunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompileResult
from numba.core.runtime import rtsys

_COUNTED = b"NRT_"
"""Begins the names of what a kernel calls that makes arrays, or counts references to them."""


class _Loaded(JITCodeLibrary):  # type: ignore[misc]
    """Machine code, with the code for callers as it was kept."""

    _disable_inspection = True

    def __init__(self, codegen: Any, name: str, machine_code: bytes, for_callers: bytes) -> None:
        super().__init__(codegen, name)
        self._shared_module: Any = None
        self._for_callers = for_callers
        codegen._engine._ee.add_object_file(llvm.ObjectFileRef.from_data(machine_code))
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        if self._shared_module is None:
            self._shared_module = llvm.parse_bitcode(self._for_callers)
            self._codegen._engine._load_defined_symbols(self._shared_module)
        return self._shared_module

    def get_pointer_to_function(self, name: str) -> Any:
        """The address of a function; 0 if there is none of that name."""
        self._get_module_for_linking()  # tells which there are
        return super().get_pointer_to_function(name)


def load(target: Any, kept: tuple[Any, ...]) -> Any:
    """A kernel as numba's compiler hands it out.

    Args:
        target: numba's context of the processor.
        kept: what `CompileResult._reduce` made of it.
    """
    code, described, environment, signature, object_mode, lifted, note, begin, others = kept
    name, _, (machine_code, for_callers) = code
    for function in begin:
        function()
    if _COUNTED in machine_code:
        rtsys.initialize(target)
    codegen = target.codegen()
    library = _Loaded(codegen, name, machine_code, for_callers)
    entry = _dynfunc.make_function(
        described.lookup_module(),
        described.qualname.split(".")[-1],
        f"compiled wrapper for {described.qualname!r}",
        codegen._engine.get_function_address(described.llvm_cpython_wrapper_name),
        environment,
        (library,),
    )
    codegen.set_env(target.get_env_name(described), environment)
    for other in others:
        codegen.set_env(other.env_name, other)
    return CompileResult(
        target_context=target,
        typing_context=target.typing_context,
        library=library,
        environment=environment,
        entry_point=entry,
        fndesc=described,
        type_annotation=note,
        signature=signature,
        objectmode=object_mode,
        lifted=lifted,
        typing_error=None,
        call_helper=None,
        metadata=None,
        reload_init=begin,
        referenced_envs=others,
    )
