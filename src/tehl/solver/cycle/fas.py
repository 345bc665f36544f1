"""Full approximation scheme (FAS): one multigrid cycle.

Brandt 1977; Trottenberg, Oosterlee and Schüller 2001, section 5.3; Venner and Lubrecht 2000, ch. 4.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, Self, TypeVar


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
    """Operations of a level in the cycle."""

    def relax(self, sweeps: int) -> None:
        """Smooth the error by relaxation sweeps."""

    def restrict_to(self, coarse: Self) -> None:
        """Pose the FAS problem  A_c(u_c) = A_c(I u) + R (b - A(u))  on the next coarser level."""

    def correct_from(self, coarse: Self) -> None:
        """Add the interpolated change of the coarser level:  u += P (u_c - I u)."""


AnyLevel = TypeVar("AnyLevel", bound=CycleLevel)


def cycle(
    levels: Sequence[AnyLevel], solve_coarsest: Callable[[], None], shape: Cycle, extra: int = 0
) -> None:
    """Perform one FAS cycle on ``levels`` in place.

    Parameters
    ----------
    levels : sequence of CycleLevel
        Coarsest first; the last one holds the problem.
    solve_coarsest : callable
        Improves the coarsest level: an exact solve, or a Newton step.
    shape, extra : Cycle, int
        Order of visits and sweeps, and sweeps added on this level.
    """
    *coarser, fine = levels
    if not coarser:
        solve_coarsest()
        return
    coarse = coarser[-1]
    fine.relax(shape.pre_sweeps + extra)
    fine.restrict_to(coarse)
    for visit in shape.coarse_visits(len(coarser)):
        cycle(coarser, solve_coarsest, visit, shape.extra_sweeps)
    fine.correct_from(coarse)
    fine.relax(shape.post_sweeps + extra)
