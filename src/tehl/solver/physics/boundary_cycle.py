"""Multigrid cycles for films between surfaces that touch through a boundary film.

A cycle relaxes the pressures where the surfaces are apart, while the nodes that touch stay: there
the film is the boundary film, and the oil keeps its pressure. Two small problems follow on the
finest grid (docs/theory/contact.md):

1. contact, at fixed oil pressure: P_c >= 0 and H >= H_c with the dense influence of the nodes that
   touch on each other, by the primal-dual active set (Hintermüller, Ito and Kunisch 2002);
2. oil between surfaces that touch, at fixed film: relaxation by lines; the sum of both pressures
   stays.

A last sweep over the finest grid relaxes what both have changed.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve, lu_factor, lu_solve

from tehl.base.typing import Array, IntArray
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.newton import one_thread
from tehl.solver.cycle.relaxation import LineSmoother, Relaxation
from tehl.solver.judging.convergence import DivergedError
from tehl.solver.physics.boundary_contact import choose_orders, close_balance, lower_orders
from tehl.solver.physics.boundary_system import OPENING

FIXED_FILM = Relaxation(name="fixed film", threshold=0.0, point=1.0, dipole=0.0)
SWEEPS = 3
"""Sweeps over the oil between surfaces that touch: patches are some nodes wide."""
CHOOSING = (0, 2, 4)
"""Cycles on a grid that choose the orders of the fluxes, as the contact settles. The others only
lower them: nodes that touch may else follow the orders, and the orders them."""
MOST_CHANGES = 12
"""Most changes of the nodes that touch, at fixed oil pressure, after a cycle. Before its last sweep
one is enough: more of them touch where they will not."""
MOST_NODES = 1200
"""Most nodes that touch: with dense systems of more, cycles take as long as Newton's method."""

Nodes = tuple[IntArray, ...]
"""Rows and columns, (n,) each."""


class TouchingCycle:
    """Cycles on the hierarchy below ``level``, which has the contact.

    Parameters
    ----------
    level : Level
        The finest one in use; its unknowns change in place.
    cycle : callable
        Performs one cycle.
    closing : float
        Residual below which the oil is balanced; zero if it need not be to the last digits.
    """

    def __init__(self, level: Level, cycle: Callable[[], None], closing: float = 0.0) -> None:
        grid, influence = level.grid, level.equations.influence
        self.level, self.cycle, self.closing = level, cycle, closing
        self.number, self.is_balanced = 0, False
        self.factored = np.zeros(grid.shape, bool)  # the nodes of the last factors
        self.factors: Any = None
        # with the images of the nodes the influence is not symmetric
        by_lu, by_cholesky = (lu_factor, lu_solve), (cho_factor, cho_solve)
        self.factorise, self.solve = by_lu if grid.mirror else by_cholesky
        self.influence = influence.table(grid.shape[0] * (1 + grid.mirror), grid.shape[1])
        self.oil = LineSmoother(grid, influence, FIXED_FILM)
        for film in (self.oil.workspace.point, self.oil.workspace.dipole):
            film[:] = 0.0

    def step(self) -> None:
        """Perform a cycle, then solve for the contact, and relax what it has changed.

        Raises DivergedError when the nodes that touch do not settle, or are too many.
        """
        if self.is_balanced:
            return
        self.level.update()
        self._at_fixed_contact(self.cycle)
        self._settle(1)
        self._set_orders()
        self._relax_oil()
        self._at_fixed_contact(partial(self.level.relax, 1))
        self._settle(MOST_CHANGES)
        self._set_orders()
        self.number += 1
        if self.closing and self.level.evaluate_residual() < self.closing:
            self.is_balanced = close_balance(self.level)

    def _at_fixed_contact(self, change: Callable[[], None]) -> None:
        """Let ``change`` act on the pressures while the nodes that touch stay.

        There it is a change of both pressures together: the contact takes it.
        """
        level, film = self.level, self.level.film
        oil, touching = film.p.copy(), level.touching
        level.smoother.frozen[:] = touching
        level.keeps_contact = True
        change()
        level.keeps_contact = False
        film.asperity[touching] += (film.p - oil)[touching]
        film.p[touching] = oil[touching]

    def _set_orders(self) -> None:
        if self.number in CHOOSING:
            choose_orders(self.level)
        else:
            lower_orders(self.level)

    def _settle(self, passes: int) -> None:
        """Solve for the contact pressure at fixed oil pressure, in one pass or until it settles.

        Raises DivergedError when it does not.
        """
        level, film = self.level, self.level.film
        level.set_state(film.p, level.rigid_approach, film.asperity)
        level.update()
        for _ in range(passes):
            change = self._missing_contact()
            if not change.any():
                return
            touching = level.touching.copy()
            level.set_state(film.p, level.rigid_approach, film.asperity + change)
            level.update()
            if np.array_equal(touching, level.touching):
                return
        if passes > 1:
            raise DivergedError

    def _missing_contact(self) -> Array:
        """Return the change of the contact pressure for H = H_c at the present nodes, P_c = 0 else.

        Raises DivergedError when there are too many, or the film is not finite.
        """
        level, film = self.level, self.level.film
        change = np.where(level.touching, 0.0, -film.asperity)
        opened, here = np.nonzero(change), np.nonzero(level.touching)
        if not here[0].size:
            return change
        if here[0].size > MOST_NODES:
            raise DivergedError
        gap = (level.equations.contact_film or 0.0) - level.separation[here]
        if opened[0].size:
            gap -= self._between(here, opened) @ change[opened]
        if not np.isfinite(gap).all():
            raise DivergedError
        with one_thread():
            if not np.array_equal(level.touching, self.factored):
                self.factored = level.touching.copy()
                self.factors = self.factorise(self._between(here, here), overwrite_a=True)
            change[here] = self.solve(self.factors, gap)
        return change

    def _between(self, here: Nodes, there: Nodes) -> Array:
        """Return the influence of some nodes, ``there``, on others, (m, n)."""
        (rows, columns), (other_rows, other_columns) = here, there
        nx, apart = self.level.grid.nx, np.abs(columns[:, None] - other_columns)
        matrix: Array = self.influence.take(nx * np.abs(rows[:, None] - other_rows) + apart)
        if self.level.grid.mirror:  # and of their images
            images = self.influence.take(nx * (rows[:, None] + other_rows) + apart)
            matrix += np.where(other_rows > 0, images, 0.0)
        return matrix

    def _relax_oil(self) -> None:
        """Relax the pressure of oil between surfaces that touch; the sum of both pressures stays.

        It may exceed the sum by `OPENING`: then the node opens.
        """
        level, film, touching = self.level, self.level.film, self.level.touching
        if not touching.any():
            return
        both = film.p + film.asperity
        self.oil.frozen[:] = ~touching
        self.oil.ends[:] = np.where(touching.any(axis=1), touching.shape[1] - 1, 1)
        for _ in range(SWEEPS):
            self.oil.sweep(film, level.balance, level.sources.reynolds, level.equations.flow)
            np.minimum(film.p, both + OPENING, out=film.p, where=touching)
            level.update_properties()
        film.asperity[:] = np.where(touching, both - film.p, film.asperity)
