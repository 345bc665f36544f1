"""The decorators of all kernels: how numba compiles them, and where it stores the machine code.

A function called from Python is a `kernel`. One called from kernels only is a `helper`: its code is
compiled into each kernel that calls it. Division by zero gives inf or NaN, not an exception.
Products and sums may be fused (``contract``); nothing else is reordered, so that NaN and inf keep
their meaning. Reference counts are off (``_nrt``): kernels allocate nothing.
"""

from collections.abc import Callable
from typing import Any, TypeVar

from numba import config, njit
from numba.core import event
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompilerBase, DefaultPassBuilder

from tehl.kernels import cache

Function = TypeVar("Function", bound=Callable[..., Any])
HOOKS = ("_optimize_final_module", "_finalize_final_module", "_finalize_dynamic_globals")
"""Methods of numba's class that `_LeftToCallers` overrides or calls."""

_COMPILING = event.TimingListener()
event.register("numba:compile", _COMPILING)


def seconds_compiling() -> float:
    """Return the time for which this process has compiled kernels and helpers so far [s]."""
    return _COMPILING.duration if _COMPILING.done else 0.0


def kernel(function: Function) -> Function:
    """Compile a function that is called from Python, and store its machine code.

    Numba reads the folder of its cache when it decorates a function, so it is set meanwhile.
    """
    folder, configured = cache.folder(), config.CACHE_DIR
    compiler = njit(
        cache=folder is not None,
        no_cfunc_wrapper=True,
        error_model="numpy",
        fastmath={"contract"},
        _nrt=False,
    )
    config.CACHE_DIR = str(folder)
    try:
        return compiler(function)
    finally:
        config.CACHE_DIR = configured


def helper(function: Function) -> Function:
    """Compile a function that is called from kernels only."""
    return _helper(function, {"contract"})


def summing_helper(function: Function) -> Function:
    """Compile a helper that sums over many numbers, in several accumulators (``reassoc``)."""
    return _helper(function, {"contract", "reassoc"})


def _helper(function: Function, flags: set[str]) -> Function:
    return njit(
        no_cpython_wrapper=True,
        no_cfunc_wrapper=True,
        error_model="numpy",
        fastmath=flags,
        _nrt=False,
        pipeline_class=_HelperCompiler if can_leave_to_callers() else Compiler,
    )(function)


def can_leave_to_callers() -> bool:
    """Return whether this numba has the internals that `_LeftToCallers` relies on.

    Without them helpers are compiled as usual: the same machine code in 1.5 times the time.
    """
    return all(hasattr(JITCodeLibrary, name) for name in HOOKS)


class _LeftToCallers(JITCodeLibrary):
    """LLVM code of a helper, neither optimised nor assembled.

    Numba would do both for each helper, and again for each kernel that contains it: 30 % of the
    time of compilation (docs/dev/kernels.md).
    """

    class codegen:  # noqa: N801 (an attribute of numba's class)
        """Replaces the code generator, which would look for machine code."""

        @staticmethod
        def set_env(name: str, environment: object) -> None:
            """Do nothing."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return a null pointer."""
        del name
        return 0


class _HelperCompiler(CompilerBase):
    """Numba's compiler, with another library for the output."""

    def define_pipelines(self) -> list[Any]:
        """Return the standard pipeline."""
        generator = self.state.targetctx.codegen()
        self.state["library"] = _LeftToCallers(generator, self.state.func_id.func_qualname)
        return [DefaultPassBuilder.define_nopython_pipeline(self.state)]
