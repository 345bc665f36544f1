"""What an iteration on one grid does: cycles or Newton steps, with contact or without.

A method says how a step is done, how many of them a grid gets that only provides the start for the
next finer one, which change ends them, and how the heights of rough surfaces are raised.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from tehl.estimate.grid import Grid
from tehl.solver.cycle.anderson import Anderson
from tehl.solver.cycle.continuation import (
    MOST_NEWTON_STEPS,
    SMOOTH_CYCLES,
    Homotopy,
    Roughness,
)
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import Strategy
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.linearised import set_unknowns, unknowns
from tehl.solver.cycle.newton import Newton
from tehl.solver.judging.convergence import LARGEST_CYCLE_CHANGE, LARGEST_ROUGH_CHANGE
from tehl.solver.physics.boundary_contact import (
    BALANCED_OVER_TOLERANCE,
    BALANCED_RESIDUAL,
    ContactHomotopy,
    TouchingNewton,
)
from tehl.solver.physics.boundary_cycle import TouchingCycle
from tehl.solver.physics.solid_shares import contact_of

MOST_CYCLES = 4
"""Most cycles on a grid that only provides the start for the next finer one."""
MOST_TOUCHING = 30
"""The same where surfaces may touch, also in Newton steps: the nodes that do change for some."""
MOST_COMBINED = 20
"""The same where cycles are combined between asperities finer than the grid: it takes some."""
STEADY, LARGEST_STEADY = 1e-3, 0.01
"""Mean change of the pressure that ends the cycles on a grid where surfaces may touch and that has
no comparable coarser grid, and beyond which it is not converging on any."""
FIRST_ORDER = 64
"""Nodes along x below which grids of surfaces that may touch have a wedge of first order: they only
provide the start, and thin films have no solution of second order there."""
COARSE_NODES, COARSE_TOUCHING = 33, 17
"""Least nodes along x of the coarse grid in the preconditioner of Newton's method, and where
surfaces may touch: dense equations of more take longer than the iterations they save."""
DAMPED_MEMORY = 3
"""Most earlier cycles combined if heat and thinning are damped: older ones had another flow."""
FIRST_STEPS, TOUCHING_STEPS, SMALL_STEP = 20, 20, 0.03
"""Most Newton steps on the coarsest grid at the start, and where surfaces may touch, and the change
at which the first ones have converged. Steps are limited in length: of 55 random contacts 18 take
more than 6, and four of these more than 20. Without convergence bars compare with the start."""

Iterate = Callable[[Callable[[], object]], float]
"""Performs a step with all that follows it, and returns the residual."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Visit:
    """A grid of full multigrid on which a method iterates."""

    hierarchy: Hierarchy
    levels: Sequence[Level]
    """Coarsest first; the last one is the grid."""
    strategy: Strategy
    roughness: Roughness
    damping: float
    """Of heat and shear thinning [-]."""
    is_damped: bool
    """Whether changes of heat or shear thinning are damped, and have begun."""

    @property
    def fine(self) -> Level:
        """The level of the grid."""
        return self.levels[-1]

    @property
    def is_last(self) -> bool:
        """Whether it is the grid of the result."""
        return len(self.levels) == len(self.hierarchy.levels)

    @property
    def is_rough(self) -> bool:
        """Whether the grid has the heights."""
        return len(self.levels) > self.roughness.first

    @property
    def balanced_below(self) -> float:
        """Residual below which a tight solve balances the oil; zero at other accuracies."""
        options = self.hierarchy.options
        exactly = options.accuracy == "tight" and not self.fine.cavity.is_balanced
        return BALANCED_OVER_TOLERANCE * options.tolerance if exactly else 0.0


class Cycles:
    """Multigrid cycles, combined with earlier ones where they converge slowly."""

    steady = 0.0
    """Mean change of the pressure that ends the cycles without a comparable coarser grid [-]."""

    def __init__(self, visit: Visit) -> None:
        self.visit, fine, memory = visit, visit.fine, visit.strategy.memory
        self.largest_change = LARGEST_ROUGH_CHANGE if visit.is_rough else LARGEST_CYCLE_CHANGE
        self.cycle = partial(visit.hierarchy.cycle, visit.levels)
        self.step: Callable[[], object] = self.cycle
        if visit.damping < 1.0:
            memory = min(memory, DAMPED_MEMORY)
        # before heat or thinning begin, the flow is another one
        begun = visit.damping == 1.0 or visit.is_damped
        is_smooth = begun and not visit.roughness.is_rough
        combines = visit.is_rough or (
            (fine.share.is_steep or is_smooth) and not fine.cavity.is_balanced
        )
        self.anderson = Anderson(memory) if memory and combines else None
        self.before = np.zeros(0)

    def most(self, doublings: int) -> int:
        """Return the most steps on a grid that only provides the start.

        ``doublings``: of the cycles, where temperatures converge slowly.
        """
        most = max(MOST_CYCLES << doublings, self.visit.fine.cavity.most_cycles)
        return MOST_COMBINED if self.anderson and self.visit.fine.share.is_steep else most

    def begin(self) -> None:
        """Note the state before a step."""
        if self.anderson is not None:
            self.before = unknowns(self.visit.fine)

    def touching_share(self) -> float:
        """Return the part of the load where surfaces touch [-]."""
        return 0.0

    def combine(self) -> None:
        """Replace the state by a combination with earlier ones."""
        if self.anderson is None:
            return
        fine = self.visit.fine
        combined = self.anderson.combine(self.before, unknowns(fine))
        if not fine.share.is_steep:
            # a combination must not wet the nodes that the last cycle cavitated
            combined[: fine.film.p.size][fine.film.p.ravel() <= 0.0] = 0.0
        set_unknowns(fine, combined)

    def raise_heights(self, iterate: Iterate) -> None:
        """Raise the heights on the first grid that has them, from the smooth film on."""
        fine, ramp = self.visit.fine, self.visit.strategy.continuation.ramp
        self._smooth(iterate, self.step)
        for part in range(1, ramp):
            fine.apply_heights(part / ramp)
            iterate(self.step)

    def _smooth(self, iterate: Iterate, cycle: Callable[[], object]) -> None:
        """Start from the smooth film, to which a restart on a finer grid returns."""
        fine = self.visit.fine
        fine.apply_heights(0.0)
        for _ in range(SMOOTH_CYCLES):
            iterate(cycle)
        self.visit.roughness.smooth = (len(self.visit.levels) - 1, *fine.state())


class NewtonSteps(Cycles):
    """Newton's method between rough surfaces."""

    def __init__(self, visit: Visit) -> None:
        super().__init__(visit)
        self.newton = Newton(visit.fine, coarse_grid(visit.levels, COARSE_NODES))
        self.step = self.newton.step

    def most(self, doublings: int) -> int:
        """Return the most steps on a grid that only provides the start."""
        del doublings
        return MOST_NEWTON_STEPS

    def raise_heights(self, iterate: Iterate) -> None:
        """Raise the heights by increments that Newton's method can take."""
        self._smooth(iterate, self.cycle)
        homotopy = Homotopy(self.visit.fine, self.newton.refresh, finest=self.visit.is_last)
        homotopy.run(partial(iterate, self.step))


class ContactCycles(Cycles):
    """Cycles with the contact of surfaces that touch through a boundary film."""

    steady = STEADY

    def __init__(self, visit: Visit) -> None:
        super().__init__(visit)
        self.largest_change = LARGEST_STEADY  # a node that parts changes more
        # a grid that does not resolve the heights is smoother than stated: nothing touches there
        self.is_smoother = visit.roughness.is_rough and not visit.is_rough
        visit.fine.share.stays = self.is_smoother
        contact_of(visit.fine.share).answers = visit.strategy.answers
        if not self.is_smoother:
            closing = visit.balanced_below if visit.is_last else 0.0
            self.touching = TouchingCycle(visit.hierarchy.chain(visit.levels), self.cycle, closing)
            self.step = self.touching.step

    def touching_share(self) -> float:
        """Return the part of the load where surfaces touch [-]."""
        fine = self.visit.fine
        return fine.share.parts(fine)["contact_share"]

    def raise_heights(self, iterate: Iterate) -> None:
        """Raise the heights; the orders of the fluxes are chosen again with all of them."""
        super().raise_heights(iterate)
        self.touching.begin()

    def most(self, doublings: int) -> int:
        """Return the most steps on a grid that only provides the start."""
        return super().most(doublings) if self.is_smoother else MOST_TOUCHING << doublings


class ContactNewton(Cycles):
    """Newton's method with contact, on smooth grids too."""

    def __init__(self, visit: Visit) -> None:
        super().__init__(visit)
        is_start = visit.fine.grid.nx < FIRST_ORDER and not visit.is_last
        self.newton = TouchingNewton(
            visit.fine,
            coarse_grid(visit.levels, COARSE_TOUCHING),
            order=1 if is_start else 2,
            closing=(visit.balanced_below or BALANCED_RESIDUAL) if visit.is_last else 0.0,
        )
        self.step = self.newton.step

    def most(self, doublings: int) -> int:
        """Return the most steps on a grid that only provides the start."""
        del doublings
        return MOST_TOUCHING

    def raise_heights(self, iterate: Iterate) -> None:
        """Raise the heights by increments in which the nodes that touch can settle."""
        fine = self.visit.fine
        fine.apply_heights(0.0)

        def solve_part() -> float:
            iterate(self.step)
            return self.newton.residual()

        ContactHomotopy(self.newton).run(solve_part)


def method_of(visit: Visit) -> Cycles:
    """Return the method of a grid."""
    newton = visit.strategy.newton
    if visit.fine.share.bounds_film:
        return ContactNewton(visit) if newton else ContactCycles(visit)
    return NewtonSteps(visit) if newton and visit.is_rough else Cycles(visit)


def solve_coarsest(hierarchy: Hierarchy, *, newton: bool) -> bool:
    """Solve on the coarsest grid, from its present state, by Newton's method.

    Parameters
    ----------
    hierarchy : Hierarchy
        Its first level changes in place.
    newton : bool
        Whether the strategy has Newton's method where surfaces may touch.

    Returns
    -------
    bool
        Whether it converged, so that the next grid may start from it; where surfaces may touch
        single nodes go on changing.
    """
    coarsest, converged = hierarchy.levels[0], False
    if not coarsest.film.p.any():  # a dry contact has no oil to solve for
        return True
    if not (newton and coarsest.share.bounds_film):
        for _ in range(FIRST_STEPS):
            converged = hierarchy.coarsest.newton_step() < SMALL_STEP
            if converged:
                break
    else:
        touching = TouchingNewton(coarsest, coarsest.grid, order=1)
        for _ in range(TOUCHING_STEPS):
            touching.step()
        converged = True
    coarsest.update()
    return converged


def coarse_grid(levels: Sequence[Level], nodes: int) -> Grid:
    """Return the coarsest grid with enough nodes along x, else the finest one.

    Parameters
    ----------
    levels : sequence of Level
        The coarsest first.
    nodes : int
        Least number along x.
    """
    return next((one.grid for one in levels if one.grid.nx >= nodes), levels[-1].grid)
