"""The grids of a contact, coarsest first, on which the multigrid cycles run."""

from collections.abc import Sequence
from dataclasses import dataclass

from tehl.film_formulas import expected_central_film
from tehl.grid import Grid, hierarchy
from tehl.operators.flow import flow_table
from tehl.options import Options
from tehl.scaling import ScaledProblem
from tehl.solver.coarsest import CoarsestSolver
from tehl.solver.fas import Cycle, cycle
from tehl.solver.level import Equations, Level
from tehl.solver.relaxation import Relaxation

FLOOR = 0.02
"""Least film in the conductance, over the expected central film."""


@dataclass(frozen=True, slots=True)
class Hierarchy:
    """The levels of a contact, coarsest first, and the solver of the coarsest.

    Attributes
    ----------
    scaled : ScaledProblem
        The contact.
    options : Options
        Numerical choices.
    levels : list of Level
        Coarsest first.
    coarsest : CoarsestSolver
        Newton's method on ``levels[0]``.
    expected_film : float
        Central film by formula [-].
    """

    scaled: ScaledProblem
    options: Options
    levels: list[Level]
    coarsest: CoarsestSolver
    expected_film: float

    @classmethod
    def on(
        cls,
        finest: Grid,
        scaled: ScaledProblem,
        options: Options,
        relaxation: Relaxation,
        load: float = 1.0,
    ) -> "Hierarchy":
        """Discretise a contact on ``finest`` and its coarser grids.

        Parameters
        ----------
        finest : Grid
            The grid of the result.
        scaled : ScaledProblem
            The contact.
        options : Options
            Wedge order and deformation.
        relaxation : Relaxation
            Settings of the smoother.
        load : float
            Load that the film carries, over that of the contact [-].
        """
        groups, flow = scaled.groups, flow_table(scaled)
        film = expected_central_film(groups)
        levels = [
            Level(
                Equations.on(grid, groups, flow, options, load=load, floor=FLOOR * film), relaxation
            )
            for grid in hierarchy(finest)
        ]
        return cls(scaled, options, levels, CoarsestSolver(levels[0]), film)

    @property
    def finest(self) -> Level:
        """The level of the result."""
        return self.levels[-1]

    def cycle(self, levels: Sequence[Level]) -> None:
        """Perform one multigrid cycle on ``levels``."""
        shape = Cycle.of(self.options, levels[0].grid, self.expected_film)
        cycle(levels, self.coarsest.step, shape)
