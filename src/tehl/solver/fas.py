"""Full approximation scheme: one cycle, written as the textbook writes it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from tehl.grid import Grid
from tehl.options import Options
from tehl.solver.level import Level

UNRESOLVED = 0.5
"""Mesh width of the coarsest grid, in Hertz half-widths, beyond which it hardly sees the contact.
One visit then overshoots the load balance (by its own size at M = 5); a second one, through the
level above it, cures that and costs next to nothing."""
THICK = 0.25
"""Expected central film from which that is so: of a thinner one such a grid has no sound discrete
solution, and going there more often does harm (M = 200 and more on wide domains)."""
ENOUGH = 4
"""Most cycles on a grid that only gives the start for the next finer one."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Cycle:
    """What one cycle does.

    Attributes
    ----------
    kind : {"V", "W", "F"}
        Order of visits.
    pre_sweeps, post_sweeps : int
        Relaxation sweeps on the finest level of the cycle.
    extra_sweeps : int
        Sweeps added on coarser levels: a V-cycle leaves error there, and sweeps there are cheap.
    twice : bool
        A V-cycle goes down twice from the level next but one to the coarsest.
    """

    kind: str
    pre_sweeps: int
    post_sweeps: int
    extra_sweeps: int = 1
    twice: bool = False

    @classmethod
    def of(cls, options: Options, coarsest: Grid, film: float) -> "Cycle":
        """Return the cycle that the options ask for, down to ``coarsest``, for an expected film."""
        return cls(
            kind=options.cycle,
            pre_sweeps=options.pre_sweeps,
            post_sweeps=options.post_sweeps,
            twice=coarsest.dx > UNRESOLVED and film > THICK,
        )

    def coarse_visits(self, coarser: int) -> tuple["Cycle", ...]:
        """Return the cycles to run on the next of ``coarser`` levels that are left below."""
        kinds = {"V": "V", "W": "WW", "F": "FV"}[self.kind]
        if self.kind == "V" and self.twice and coarser == 2:
            kinds = "VV"
        return tuple(replace(self, kind=kind) for kind in kinds)


class Cycles:
    """Cycles on some levels, as a method to solve the finest of them.

    Parameters
    ----------
    levels : sequence of Level
        Coarsest first.
    solve_coarsest : callable
        What is done there.
    shape : Cycle
        What one cycle does.
    ramp : int
        Cycles over which heights are raised.
    """

    enough = ENOUGH

    def __init__(
        self, levels: Sequence[Level], solve_coarsest: Callable[[], None], shape: Cycle, ramp: int
    ) -> None:
        self.levels, self.solve_coarsest, self.shape = levels, solve_coarsest, shape
        self.ramp = ramp

    def step(self) -> None:
        """Run one cycle."""
        cycle(self.levels, self.solve_coarsest, self.shape)

    def raise_heights(self, once: Callable[[], float], *, last: bool) -> None:
        """Raise the heights in equal parts, one per cycle, up to the last part."""
        del last
        for number in range(1, self.ramp):
            self.levels[-1].roughen(number / self.ramp)
            once()


def cycle(
    levels: Sequence[Level], solve_coarsest: Callable[[], None], shape: Cycle, extra: int = 0
) -> None:
    """Run one multigrid cycle on ``levels``, coarsest first, in place."""
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
