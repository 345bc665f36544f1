"""Full approximation scheme (FAS): one multigrid cycle.

Brandt 1977; Trottenberg, Oosterlee and Schüller 2001, section 5.3; Venner and Lubrecht 2000, ch. 4.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Generic, NamedTuple, Protocol, TypeVar


@dataclass(frozen=True, kw_only=True, slots=True)
class Cycle:
    """Shape of a multigrid cycle."""

    kind: str
    """Order of visits."""
    pre_sweeps: int
    post_sweeps: int
    """Relaxation sweeps on the finest level of the cycle."""
    extra_sweeps: int = 1
    """Sweeps added on coarser levels, where a V-cycle leaves errors and sweeps are cheap."""
    twice: bool = False
    """A V-cycle visits its two coarsest levels twice."""

    def coarse_visits(self, coarser: int) -> tuple["Cycle", ...]:
        """Return the cycles on ``coarser`` levels: V for V, two W for W, F and V for F."""
        kinds = {"V": "V", "W": "WW", "F": "FV"}[self.kind]
        if self.kind == "V" and self.twice and coarser == 2:
            kinds = "VV"
        return tuple(replace(self, kind=kind) for kind in kinds)


class CycleLevel(Protocol):
    """Operation of a level in the cycle."""

    def relax(self, sweeps: int) -> None:
        """Smooth the error by relaxation sweeps."""


AnyLevel = TypeVar("AnyLevel", bound=CycleLevel)


class Transfers(NamedTuple, Generic[AnyLevel]):
    """Transfers between a level u and the next coarser one u_c, called with both in this order."""

    restrict: Callable[[AnyLevel, AnyLevel], None]
    """Poses the FAS problem  A_c(u_c) = A_c(I u) + R (b - A(u))  on the coarser one."""
    correct: Callable[[AnyLevel, AnyLevel], None]
    """Adds the interpolated change of the coarser one:  u += P (u_c - I u)."""


def cycle(
    levels: Sequence[AnyLevel],
    solve_coarsest: Callable[[], None],
    transfers: Transfers[AnyLevel],
    shape: Cycle,
    extra: int = 0,
) -> None:
    """Perform one FAS cycle on ``levels`` in place.

    Parameters
    ----------
    levels : sequence of CycleLevel
        Coarsest first; the last one holds the problem.
    solve_coarsest : callable
        Improves the coarsest level: an exact solve, or a Newton step.
    transfers : Transfers
        Between two levels.
    shape, extra : Cycle, int
        Order of visits and sweeps, and sweeps added on this level.
    """
    *coarser, fine = levels
    if not coarser:
        solve_coarsest()
        return
    coarse = coarser[-1]
    fine.relax(shape.pre_sweeps + extra)
    transfers.restrict(fine, coarse)
    for visit in shape.coarse_visits(len(coarser)):
        cycle(coarser, solve_coarsest, transfers, visit, shape.extra_sweeps)
    transfers.correct(fine, coarse)
    fine.relax(shape.post_sweeps + extra)
