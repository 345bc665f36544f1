"""The grids of a contact, coarsest first, and the cycle on them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from tehl.contact.options import Options
from tehl.estimate.grid import Grid, long_grids
from tehl.estimate.in_time import first_gap
from tehl.estimate.levels import levels_of
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.flow import flow_table
from tehl.solver.cycle.coarsest import CoarsestSolver
from tehl.solver.cycle.equations import Equations
from tehl.solver.cycle.fas import Cycle, cycle
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.relaxation import Relaxation
from tehl.solver.cycle.start import from_coarser, from_dry_pressure, pose_problem
from tehl.solver.cycle.transfers import TRANSFERS
from tehl.solver.judging.convergence import RUNAWAY

UNRESOLVED = 0.5
"""Mesh width of the coarsest grid, in Hertz half-widths, beyond which it does not resolve the
contact. One visit then overshoots the load balance (by 100 % at M = 5); a second one, through the
next finer level, corrects this at negligible cost."""
LEAST_FILM_OF_W_CYCLE = 0.25
"""Expected central film above which two visits help: for a thinner film such a grid has no valid
discrete solution, and more visits do harm (M = 200 and more on wide domains)."""


@dataclass(frozen=True, slots=True)
class Hierarchy:
    """The levels of a contact, coarsest first, and the solver of the coarsest.

    ``expected_film`` is the central film by formula [-]. Where cells are long, cycles halve columns
    before lines, to levels in ``between``; ``chains`` are the levels of the cycles on each grid.
    """

    scaled: ScaledProblem
    options: Options
    levels: list[Level]
    coarsest: CoarsestSolver
    expected_film: float
    is_long: bool = False
    between: dict[Grid, Level] = field(default_factory=dict)
    chains: dict[Grid, list[Level]] = field(default_factory=dict)

    def chain(self, levels: Sequence[Level]) -> Sequence[Level]:
        """Return the levels of a cycle on the last of ``levels``, coarsest first.

        Where cells are long, these are not those of full multigrid, which differ by halving columns
        and lines so that they show the order of the errors.
        """
        if not self.is_long or len(levels) < 2:
            return levels
        fine = levels[-1]
        found = self.chains.get(fine.grid, [])
        if found and found[-1] is fine:
            return found
        known = {one.grid: one for one in self.levels} | self.between
        grids = long_grids(fine.grid, self.levels[0].grid, self.scaled.groups.ellipticity)
        for grid in grids:
            if grid not in known:
                made = Level(self._equations(grid), fine.smoother.relaxation)
                known[grid] = self.between[grid] = made
        self.chains[fine.grid] = [known[grid] for grid in grids]
        return self.chains[fine.grid]

    def _equations(self, grid: Grid) -> Equations:
        flow = self.levels[0].equations.flow
        return Equations.on(grid, self.scaled, flow, self.options)

    @classmethod
    def on(
        cls,
        finest: Grid,
        scaled: ScaledProblem,
        options: Options,
        relaxation: Relaxation,
    ) -> "Hierarchy":
        """Discretise a contact on ``finest`` and its coarser grids.

        Parameters
        ----------
        finest, scaled : Grid, ScaledProblem
            The grid of the result, and the contact.
        options, relaxation : Options, Relaxation
            Wedge order and deformation; settings of the smoother.
        """
        flow, film = flow_table(scaled), first_gap(scaled)
        grids, is_long = levels_of(finest, scaled)
        levels = [Level(Equations.on(g, scaled, flow, options), relaxation) for g in grids]
        return cls(scaled, options, levels, CoarsestSolver(levels[0]), film, is_long)

    def refine(self, relaxation: Relaxation) -> None:
        """Append a level of half the mesh width."""
        self.levels.append(Level(self._equations(self.finest.grid.finer()), relaxation))

    def free_coarser(self) -> None:
        """Keep the finest level alone."""
        del self.levels[:-1]
        self.between.clear()
        self.chains.clear()

    @property
    def finest(self) -> Level:
        """The level of the result."""
        return self.levels[-1]

    def cycle(self, levels: Sequence[Level]) -> None:
        """Perform one multigrid cycle on ``levels``."""
        levels = self.chain(levels)
        options, mesh_width = self.options, levels[0].grid.dx
        conserves = levels[0].cavity.is_balanced
        shape = Cycle(
            kind=options.cycle,
            pre_sweeps=options.pre_sweeps,
            post_sweeps=options.post_sweeps,
            # where oil is conserved the second visit would undo the first
            twice=mesh_width > UNRESOLVED
            and self.expected_film > LEAST_FILM_OF_W_CYCLE
            and not conserves,
        )
        # cheap on coarser grids; with 2 + 2 sweeps the film of M = 200, r = 0.2 oscillates
        extra = int(conserves and levels[-1] is not self.finest)
        cycle(levels, self.coarsest.step, TRANSFERS, shape, extra)

    def salvage(self) -> None:
        """Interpolate the finest valid state of a coarser grid to the finest grid."""
        start = -1
        for number, level in enumerate(self.levels):
            if 0.0 < level.film.p.max() < RUNAWAY and np.isfinite(level.rigid).all():
                start = number
        if start < 0:
            start = 0
            from_dry_pressure(self.levels[0], self.expected_film)
        for coarse, fine in pairwise(self.levels[start:]):
            from_coarser(coarse, fine)
        pose_problem(self.finest)
        self.finest.update()
