"""Solvers as users call them: they take the same arguments, and give results with their methods."""

from collections.abc import Callable
from functools import update_wrapper
from inspect import signature
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from tehl import solver
from tehl.api.problem import check_call
from tehl.api.results import Result, TransientResult, failures_with_results
from tehl.base.lazy import lazy
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution
from tehl.solver import with_work

if TYPE_CHECKING:
    from tehl.post.stress import below
else:
    below = lazy("tehl.post.stress.below")

__all__ = [
    "certify",
    "certify_transient",
    "solve",
    "solve_passes",
    "solve_transient",
    "with_work",
]

P = ParamSpec("P")
Plain = TypeVar("Plain")
Whole = TypeVar("Whole")


def _giving(result_of: Callable[[Plain], Whole], solve: Callable[P, Plain]) -> Callable[P, Whole]:
    """Return a solver whose solutions, those of failures included, are results."""

    def solved(*args: P.args, **kwargs: P.kwargs) -> Whole:
        call = given.bind(*args, **kwargs).arguments
        check_call(call["problem"], call.get("options"))
        with failures_with_results():
            return result_of(solve(*args, **kwargs))

    update_wrapper(solved, solve, assigned=("__name__", "__qualname__"))
    solved.__doc__ = (solve.__doc__ or "").replace("Solution", "Result")
    given, kind = signature(solve), signature(result_of).return_annotation
    solved.__signature__ = given.replace(return_annotation=kind)  # type: ignore[attr-defined]
    return solved


def _with_stress(solution: Solution) -> Solution:
    """Return a solution with the stress that its case asks for."""
    if solution.problem.stress is None or solution.stress is not None:
        return solution
    return solution.but(stress=below.stress_below(solution))


def _steady(solution: Solution) -> Result:
    return Result.of(_with_stress(solution))


def _transient(solution: TransientSolution) -> TransientResult:
    start = _with_stress(solution.start)
    return TransientResult.of(solution if start is solution.start else solution.but(start=start))


solve = _giving(_steady, solver.solve)
solve_passes = _giving(_steady, solver.solve_passes)
certify = _giving(_steady, solver.certify)
solve_transient = _giving(_transient, solver.solve_transient)
certify_transient = _giving(_transient, solver.certify_transient)
