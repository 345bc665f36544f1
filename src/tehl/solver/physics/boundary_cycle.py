"""Multigrid cycles for films between surfaces that touch through a boundary film.

A cycle relaxes the pressures where the surfaces are apart, while the nodes that touch stay: there
the film is the boundary film, and the oil keeps its pressure. The rigid approach takes the contact
along (`tehl.solver.physics.share.Response`). Two problems follow on the finest grid
(docs/theory/contact.md):

1. contact, at fixed oil pressure: P_c >= 0 and H >= H_c by the primal-dual active set
   (Hintermüller, Ito and Kunisch 2002), each set by conjugate gradients with the deflection of the
   grid, preconditioned by its inverse between mirrors at the edges;
2. oil between surfaces that touch, at fixed film: relaxation by lines, and a sparse factorisation
   where patches are so wide that it is slow; the sum of both pressures stays.

A last sweep over the finest grid relaxes what both have changed.
"""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from scipy.sparse.linalg import LinearOperator, cg

from tehl.base.typing import Array
from tehl.operators.jacobian import neighbours_of
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.newton import one_thread
from tehl.solver.cycle.relaxation import LineSmoother, Relaxation
from tehl.solver.judging.convergence import DivergedError
from tehl.solver.physics.boundary_contact import (
    choose_orders,
    close_balance,
    lower_orders,
    oil_step,
)
from tehl.solver.physics.boundary_system import OPENING
from tehl.solver.physics.share import Response
from tehl.solver.physics.solid_shares import contact_of

FIXED_FILM = Relaxation(name="fixed film", threshold=0.0, point=1.0, dipole=0.0, stiff=True)
"""Stiff: with the conductance frozen, oil beside a patch under high pressure creeps for tens of
cycles (grooves, M 14, L 9, share 0.2, 129 nodes)."""
OIL_SWEEPS, SLOW_OIL, LARGEST_OIL_STEP = 8, 0.6, 0.1
"""Sweeps over the oil between surfaces that touch; part of its residual left by them from which a
factorisation follows; and its largest change of a pressure, in Hertz pressures. On 257 nodes
grooves and random surfaces (shares 0.05 to 0.93) take a fifth more with 5 sweeps or with 0.3."""
CHOOSING = (0, 2, 4)
"""Cycles on a grid that choose the orders of the fluxes, as the contact settles. The others only
lower them: nodes that touch may else follow the orders, and the orders them."""
MOST_CHANGES = 12
"""Most changes of the nodes that touch, at fixed oil pressure, after a cycle. Before its last sweep
one is enough: more of them touch where they will not."""
RUBBING_CYCLES = 3
"""Cycles per sweep of the energy equation where surfaces touch. Hot oil leaves the contact, the
surfaces touch where it was, and rub: the rim of the patch moves by a part of a node per cycle, and
a sweep costs as much as three (M 183, L 10, friction 0.1, 113 nodes: a share of 0.68 after 50
sweeps and 7 s, after 350 and 16 s with one cycle each)."""
CONTACT_ACCURACY, RESPONSE_ACCURACY, MOST_CONTACT_PRODUCTS = 0.1, 1e-3, 200
"""Relative residual of the contact pressures of a set, which further cycles reduce; of the response
to the rigid approach; and most products."""


class TouchingCycle:
    """Cycles on levels of which the last one has the contact.

    Parameters
    ----------
    levels : sequence of Level
        The coarsest first; the unknowns of the last one change in place.
    cycle : callable
        Performs one cycle.
    closing : float
        Residual below which the oil is balanced; zero if it need not be to the last digits.
    """

    def __init__(
        self, levels: Sequence[Level], cycle: Callable[[], None], closing: float = 0.0
    ) -> None:
        self.levels, self.level, self.cycle, self.closing = levels, levels[-1], cycle, closing
        grid, self.share = self.level.grid, contact_of(self.level.share)
        self.number, self.is_balanced = 0, False
        self.neighbours = neighbours_of(grid, self.level.stencil)
        self.oil = LineSmoother(grid, self.level.equations.influence, FIXED_FILM)
        shapes = self.oil.workspace.shapes
        for film in (shapes.point, shapes.dipole):
            film[:] = 0.0

    def begin(self) -> None:
        """Begin another time step."""
        self.number, self.is_balanced = 0, False

    def step(self) -> None:
        """Perform cycles, each with the contact, and relax what they have changed.

        Raises DivergedError when the nodes that touch do not settle.
        """
        if self.is_balanced and self.level.factors is None:
            return
        rubs = self.level.factors is not None and self.share.touching.any()
        for _ in range(RUBBING_CYCLES if rubs else 1):
            self._cycle()
        self._at_fixed_contact(partial(self.level.relax, 1))
        self._settle(MOST_CHANGES)
        self._set_orders()
        self.number += 1
        if self.closing and self.level.evaluate_residual() < self.closing:
            self.is_balanced = close_balance(self.level)

    def _cycle(self) -> None:
        self.level.update()
        indented = self._respond()
        self._at_fixed_contact(self.cycle)
        self._take_response(indented)
        self._settle(1)
        self._set_orders()
        self._relax_oil()

    def _respond(self) -> Array:
        """Set the response of the contact on the level; return phi, ``grid.shape``."""
        level, share = self.level, self.share
        indented, lift = np.zeros(level.grid.shape), np.empty(level.grid.shape)
        if share.touching.any():
            indented = self._pressed(np.ones(level.grid.shape), RESPONSE_ACCURACY)
            level.equations.deformation.deflect(indented, lift)
            stiffness, pressure = level.equations.balances.integral(indented), level.film.p.copy()
            share.response = Response(1.0 - lift, stiffness, level.rigid_approach, pressure)
        return indented

    def _take_response(self, indented: Array) -> None:
        """Let the contact pressure take what the rigid approach has changed."""
        level, found = self.level, self.share.response
        if found is not None:
            level.film.asperity[:] -= (level.rigid_approach - found.approach) * indented
        for one in self.levels:
            one.share.response = None

    def _at_fixed_contact(self, change: Callable[[], None]) -> None:
        """Let ``change`` act on the pressures while the nodes that touch stay.

        There it is a change of both pressures together: the contact takes it.
        """
        level, film, touching = self.level, self.level.film, self.share.touching
        oil = film.p.copy()
        level.smoother.frozen[:] = touching
        self.share.stays = True
        change()
        self.share.stays = False
        level.smoother.frozen[:] = 0
        film.asperity[touching] += (film.p - oil)[touching]
        film.p[touching] = oil[touching]

    def _set_orders(self) -> None:
        if self.number in CHOOSING:
            choose_orders(self.level)
        else:
            lower_orders(self.level)

    def _settle(self, passes: int, accuracy: float = CONTACT_ACCURACY) -> None:
        """Solve for the contact pressure at fixed oil pressure, in one pass or until it settles.

        Raises DivergedError when it does not.
        """
        level, film = self.level, self.level.film
        level.set_state(film.p, level.rigid_approach, film.asperity)
        level.update()
        for _ in range(passes):
            change = self._missing_contact(accuracy)
            if not change.any():
                return
            touching = self.share.touching.copy()
            level.set_state(film.p, level.rigid_approach, film.asperity + change)
            level.update()
            if np.array_equal(touching, self.share.touching):
                return
        if passes > 1:
            raise DivergedError

    def _missing_contact(self, accuracy: float) -> Array:
        """Return the change of the contact pressure for H = H_c at the present nodes, P_c = 0 else.

        Raises DivergedError when the film is not finite.
        """
        level, share, touching = self.level, self.share, self.share.touching
        change = share.opened(level)
        if not touching.any():
            return change
        gap = share.boundary.separation - level.separation
        pressed = change + share.jumped
        if pressed.any():
            moved = np.empty_like(gap)
            level.equations.deformation.deflect(pressed, moved)
            gap -= moved
        if not np.isfinite(gap[touching]).all():
            raise DivergedError
        return np.where(touching, self._pressed(gap, accuracy), change)

    def _pressed(self, film: Array, accuracy: float) -> Array:
        """Return the pressure of the nodes that touch that moves their film by ``film``.

        Both ``grid.shape``; ``accuracy`` is the relative residual.
        """
        roots, shape = np.where(self.share.touching, np.sqrt(self.share.lines), 0.0), film.shape
        inverse = np.divide(1.0, roots, out=np.zeros(shape), where=roots > 0.0)
        out = np.empty(shape)

        def operator(deflect: Callable[[Array, Array], None]) -> LinearOperator:
            def product(vector: Array) -> Array:
                deflect(inverse * vector.reshape(shape), out)
                return (roots * out).ravel()

            return LinearOperator((out.size, out.size), matvec=product, dtype=float)

        with one_thread():
            found, _ = cg(
                operator(self.level.equations.deformation.deflect),
                (roots * film).ravel(),
                rtol=accuracy,
                maxiter=MOST_CONTACT_PRODUCTS,
                M=operator(self.share.flattening.deflect),
            )
        return np.asarray(inverse * found.reshape(shape))

    def _relax_oil(self) -> None:
        """Relax the pressure of oil between surfaces that touch; the sum of both pressures stays.

        It may exceed the sum by `OPENING`: then the node opens.
        """
        level, film, touching = self.level, self.level.film, self.share.touching
        if not touching.any():
            return
        both, before = film.p + film.asperity, self._oil_residual()
        self.oil.frozen[:] = ~touching
        self.oil.ends[:] = np.where(touching.any(axis=1), touching.shape[1] - 1, 1)
        for _ in range(OIL_SWEEPS):
            self.oil.sweep(film, level.balance, level.sources.reynolds, level.equations.flow)
            np.minimum(film.p, both + OPENING, out=film.p, where=touching)
            level.update_properties()
        if self.number and self._oil_residual() > SLOW_OIL * before:
            step = np.nan_to_num(oil_step(level, self.neighbours, touching & (film.p > 0.0)))
            step = np.clip(step, -LARGEST_OIL_STEP, LARGEST_OIL_STEP)
            moved = np.minimum(film.p + step, both + OPENING)
            film.p[:] = np.where(touching, np.maximum(moved, 0.0), film.p)
            level.update_properties()
        film.asperity[:] = np.where(touching, both - film.p, film.asperity)

    def _oil_residual(self) -> float:
        """Return the sum of the residuals of the Reynolds equation where surfaces touch [-]."""
        self.level.evaluate_residual()
        return float(np.abs(self.level.sources.residual[self.share.touching]).sum())
