"""Newton's method for films between surfaces that touch through a boundary film.

Two pressures (docs/theory/contact.md): that of the oil obeys the Reynolds equation everywhere, with
the film H >= H_c, and that of the contact takes what the oil does not carry,

    L(P, H) = f,  P >= 0;   P_c >= 0,  H >= H_c,  P_c (H - H_c) = 0;   H = H00 + K (P + P_c) + g.

Which nodes touch follows from the sign of P_c - (H - H_c)/K_00 after each step (primal-dual active
set; `Level.update`). The linear equations are those of `tehl.solver.physics.boundary_system`.
"""

import warnings
from collections.abc import Callable

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import MatrixRankWarning, spsolve

from tehl.base.typing import Array, BoolArray
from tehl.estimate.grid import Grid
from tehl.operators.jacobian import Neighbours, jacobian, neighbours_of
from tehl.solver.cycle.continuation import Homotopy
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.linearised import conductance_slopes
from tehl.solver.cycle.newton import one_thread
from tehl.solver.judging.convergence import DivergedError
from tehl.solver.physics.boundary_system import (
    TouchingOperators,
    TouchingSystem,
    transport,
)
from tehl.solver.physics.cavity import set_orders
from tehl.solver.physics.solid_shares import contact_of

SUFFICIENT_DECREASE, SHORTEST_CONTACT_STEP = 0.05, 0.12
"""Least relative decrease of the residual for the whole step, and shortest part of a step, which is
taken in any case: sets of nodes that change raise the residual for some steps."""
MEMORY = 5
"""Steps of which the largest residual must decrease."""
BALANCED_RESIDUAL, BALANCED_OVER_TOLERANCE, LARGEST_CLOSING = 1e-7, 1e-4, 1e-4
"""Residual below which the oil is balanced; the same over the tolerance of a tight solve, as the
pressure, and with it the load, moves by a thousand residuals; and its largest change by that."""
NEAR_RESIDUAL = 1e-2
"""Residual below which the orders of the fluxes are chosen after `STEPS_WITH_FREE_ORDERS` more
steps. From then on they are lowered only: else they may change with the contact, and the contact
with them."""
STEPS_WITH_FREE_ORDERS = 2
CONTACT_LINEAR_RESIDUAL = 0.002
"""Relative residual of the linear equations. Those that are solved to 0.03 take a third more steps,
as the nodes that touch follow the error."""


class TouchingNewton(TouchingOperators):
    """Newton's method for both pressures and the rigid approach of a level.

    Parameters
    ----------
    level : Level
        Its unknowns change in place.
    coarse : Grid
        Of the coarse correction.
    order : {1, 2}
        Largest order of the fluxes of the wedge. At touching nodes and next to them it is one: the
        film has a kink there.
    closing : float
        Residual below which the oil is balanced; zero on a level that is not that of the result.
    """

    def __init__(self, level: Level, coarse: Grid, *, order: int = 2, closing: float = 0.0) -> None:
        super().__init__(level, coarse)
        self.past: list[float] = []
        self.free_steps = STEPS_WITH_FREE_ORDERS
        self.closing = closing
        self.is_balanced = False  # solved: a further step would only perturb the balance
        self.set_order(order)

    def set_order(self, order: int) -> None:
        """Set the largest order of the fluxes; their orders are chosen again."""
        self.order, self.free_steps, self.past = order, STEPS_WITH_FREE_ORDERS, []
        choose_orders(self.level, order)
        self.refresh()

    def refresh(self) -> None:
        """Discard the residuals of earlier steps."""
        self.past = []

    def step(self) -> float:
        """Perform one step; return the part of it that was taken.

        Raises DivergedError when the linear equations have no finite solution.
        """
        level = self.level
        if self.is_balanced and level.factors is None:
            return 1.0
        level.update()
        if self.free_steps > 0:
            choose_orders(level, self.order)
        else:
            lower_orders(level)
        system = TouchingSystem(self)
        try:
            with one_thread():
                change = system.solve(CONTACT_LINEAR_RESIDUAL)
        except (RuntimeError, ValueError) as error:  # singular or not finite
            raise DivergedError from error
        part = self._search(system, change)
        if self.residual() < self.closing:
            self.is_balanced = close_balance(level)
        return part

    def residual(self) -> float:
        """Return the mean residual of both pressures plus the error of the load [-]."""
        return self.level.evaluate_residual() + abs(self.level.missing_load())

    def _search(self, system: TouchingSystem, change: Array) -> float:
        """Take the step, or a part of it if the residual would rise above the last ones."""
        level, before = self.level, self.level.state()
        if not np.isfinite(change).all():
            raise DivergedError
        self.past = [*self.past, self.residual()][-MEMORY:]
        part, largest = 1.0, max(self.past)
        while True:
            level.set_state(*system.stepped(before, change, part, self.past[-1]))
            level.update()
            found = self.residual()
            if found < (1.0 - SUFFICIENT_DECREASE * part) * largest or part < SHORTEST_CONTACT_STEP:
                break
            part *= 0.5
        if found < NEAR_RESIDUAL and part == 1.0:
            self.free_steps -= 1
        return part


def close_balance(level: Level) -> bool:
    """Solve the Reynolds equation of a level for the oil pressure, at the present film.

    Return whether it did.

    The last digits of the balance would take several more steps, as these are inexact. The
    change of the pressure is so small that the film keeps its value; where surfaces touch, the sum
    of both pressures stays. Too large a change, in oil that is nearly incompressible, is not made.
    """
    film, before, neighbours = level.film, level.state(), neighbours_of(level.grid, level.stencil)
    for _ in range(2):
        level.evaluate_residual()
        free = (film.p > 0.0) & (neighbours.here.diagonal() > 0.0).reshape(film.p.shape)
        change = oil_step(level, neighbours, free)
        moved = film.p + change
        if not np.abs(change).max() < LARGEST_CLOSING:
            film.p[:], film.asperity[:] = before[0], before[2]
            level.update_properties()
            return False
        moved = np.maximum(moved, 0.0)
        film.asperity[:] = np.where(
            contact_of(level.share).touching,
            np.maximum(film.asperity - (moved - film.p), 0.0),
            film.asperity,
        )
        film.p[:] = moved
        level.update_properties()
    return True


def oil_step(level: Level, neighbours: Neighbours, where: BoolArray) -> Array:
    """Return a Newton step of the oil pressure at fixed film, ``grid.shape``; zero elsewhere.

    Parameters
    ----------
    level : Level
        Its residual is evaluated.
    neighbours : Neighbours
        Of its grid.
    where : array of bool
        Nodes whose pressure changes.
    """
    film, nodes = level.film, np.nonzero(where.ravel())[0]
    near, slopes = transport(level, neighbours, nodes), conductance_slopes(level)
    by_pressure, _ = jacobian(film, level.stencil, near, *slopes)
    change: Array = np.zeros(film.p.size)
    with warnings.catch_warnings(action="ignore", category=MatrixRankWarning):
        matrix = csc_matrix(by_pressure[:, nodes])
        change[nodes] = spsolve(matrix, level.sources.residual.ravel()[nodes])
    return change.reshape(film.p.shape)


def choose_orders(level: Level, order: int = 2) -> None:
    """Set the orders of the fluxes: 1 where surfaces touch and beside.

    Parameters
    ----------
    level : Level
        Its marks of second order are overwritten.
    order : int
        Order elsewhere, 1 or 2.
    """
    contact = contact_of(level.share)
    contact.lowered[:] = with_neighbours(contact.touching) if order > 1 else True
    set_orders(level)


def lower_orders(level: Level) -> None:
    """Lower the orders where surfaces have begun to touch: if they rise again, nodes may cycle."""
    contact = contact_of(level.share)
    contact.lowered |= with_neighbours(contact.touching)
    contact.lower(level.film)


def with_neighbours(marked: BoolArray) -> BoolArray:
    """Return marked nodes and their neighbours along x."""
    near = marked.copy()
    near[:, 1:] |= marked[:, :-1]
    near[:, :-1] |= marked[:, 1:]
    return near


class ContactHomotopy(Homotopy):
    """Raises the heights where surfaces may touch, with fluxes of first order.

    Each increment starts from the solution of the last one: to extrapolate both would mix the nodes
    that touch.

    Parameters
    ----------
    newton : TouchingNewton
        Of the level.
    """

    first, least = 0.5, 0.01
    most_steps, quick, slow = 14, 6, 10
    larger, smaller, failed = 1.6, 0.8, 0.35

    def __init__(self, newton: TouchingNewton) -> None:
        super().__init__(newton.level, newton.refresh)
        self.newton, self.state = newton, newton.level.state()

    def run(self, iterate: Callable[[], float]) -> None:
        """Raise all heights; the orders of the fluxes are chosen again with all of them."""
        order = self.newton.order
        self.newton.set_order(1)
        self._steps(iterate)
        self.state = self.level.state()
        super().run(iterate)
        self.newton.set_order(order)

    def begin(self, part: float) -> None:
        """Start from the last solution."""
        del part
        self.level.set_state(*self.state)
        self.refresh()

    def keep(self, part: float) -> None:
        """Note the solution."""
        del part
        self.state = self.level.state()
