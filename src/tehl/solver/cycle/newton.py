"""Newton-Krylov method on one level, for films on which no relaxation converges.

Between steep asperities the conductance changes by orders of magnitude from node to node, and a
relaxation that freezes it diverges. Newton's method linearises all of it
(docs/theory/numerics-rough.md):

    L_P v + L_H (K v + c) = f - L(P),   sum(v) dx dy = w - sum(P) dx dy,

for changes v of the pressures and c of the rigid approach, or c + t Y with its moment balance where
the tilt of a roller follows from it. The free (inactive) nodes are those that
are wet or whose residual would wet them (Hintermüller, Ito and Kunisch 2002). The Krylov method
applies the full elastic deflection K. Its preconditioner is a correction on a coarse grid with
dense K, then a sparse factorisation of L_P + L_H K_00 with the deflection K_00 of a node by itself;
with the deflection by the neighbours as well the factorisation costs five times as much and saves
no products.
"""

import warnings
from contextlib import AbstractContextManager
from functools import cache, partial

import numpy as np
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve
from scipy.sparse import csc_matrix, csr_matrix
from scipy.sparse.linalg import LinearOperator, gcrotmk, splu
from threadpoolctl import ThreadpoolController

from tehl.base.typing import Array, BoolArray
from tehl.estimate.grid import Grid
from tehl.kernels import reynolds
from tehl.operators.influence import influence_of, matrix_of
from tehl.operators.jacobian import Neighbours, interpolation, jacobian, neighbours_of, rows
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.linearised import (
    APPROACH_WEIGHT,
    conductance_slopes,
    set_unknowns,
    unknowns,
)
from tehl.solver.judging.convergence import DivergedError

LINEAR_RESIDUAL, RETRY_RESIDUAL = 0.03, 0.001
"""Relative residual of the linear equations; and in a second solve if that step fails."""
VECTORS, ROUNDS = 40, 2
"""Directions of the Krylov method per restart, and number of restarts."""
MOST_PRODUCTS = 24
"""Products with the Jacobian, two per direction, beyond which the next step factorises again."""
LARGEST_NEWTON_CHANGE, OUTLIERS = 5.0, 5e-4
"""Largest change of a pressure per step, in Hertz pressures, and the part of the nodes that is
clipped without shortening the step: single nodes would change by a hundred."""
DESCENT, SHORTEST_LINE_STEP = 0.1, 0.02
"""Sufficient over predicted decrease of the residual, and shortest step of the line search."""
IRREDUCIBLE_RESIDUAL = 1e-8
"""Residual that no step can reduce further."""


@cache
def _libraries() -> ThreadpoolController:
    return ThreadpoolController()


def one_thread() -> AbstractContextManager[object]:
    """Return a context in which BLAS has one thread.

    Sums over vectors of a Krylov method are too short for more: on a machine that is busy the
    threads wait for each other, and a solve takes up to eight times as long.
    """
    return _libraries().limit(limits=1, user_api="blas")


class Newton:
    """Newton's method for pressure and rigid motions of a level, with their balances.

    It changes the unknowns of ``level`` in place. ``coarse`` is the grid of the coarse correction,
    of some hundred nodes.
    """

    def __init__(self, level: Level, coarse: Grid) -> None:
        self.level = level
        self.neighbours: Neighbours = neighbours_of(
            level.grid, level.stencil, level.equations.entrainment
        )
        self.to_fine = interpolation(level.grid, coarse)
        weights = np.asarray(self.to_fine.sum(0)).ravel()
        per_weight = np.divide(1.0, weights, out=np.zeros_like(weights), where=weights > 0.0)
        self.to_coarse = csr_matrix(rows(per_weight) @ self.to_fine.T)
        self.same = np.asarray(self.to_fine.argmax(axis=0)).ravel()  # fine node at each coarse one
        coarse_influence = influence_of(coarse, level.equations.groups)
        self.deflection = matrix_of(coarse, coarse_influence)
        self.load_weights = np.repeat(level.grid.dx * level.grid.widths, level.grid.nx)
        self.modes = np.repeat(level.equations.balances.modes, level.grid.nx, axis=1)
        self.preconditioner: Preconditioner | None = None

    def step(self) -> float:
        """Perform one step; return the part of the Newton step that was taken.

        Raises DivergedError when no part of the step reduces the residual.
        """
        self.level.update()
        system, old = System(self), self.preconditioner
        with one_thread():
            try:
                part = self._damped_step(system, LINEAR_RESIDUAL)
            except DivergedError:  # an inaccurate solution need not reduce the residual
                if self.preconditioner is old:
                    self.preconditioner = None
                part = self._damped_step(system, RETRY_RESIDUAL)
        if system.products > MOST_PRODUCTS or part < 1.0:
            self.preconditioner = None
        return part

    def _damped_step(self, system: "System", accuracy: float) -> float:
        """Solve the linear equations to a relative residual and search along the solution."""
        try:
            if self.preconditioner is None:
                self.preconditioner = Preconditioner(system)
            change = system.solve(self.preconditioner, accuracy)
        except (RuntimeError, ValueError) as error:  # singular or not finite
            raise DivergedError from error
        return self.line_search(change)

    def line_search(self, change: Array) -> float:
        """Halve the step along ``change`` until the residual decreases; return the part taken."""
        level, start = self.level, unknowns(self.level)
        residual = level.evaluate_residual()
        step, share = limited(change, level.rigid.size)
        part = 1.0 if np.isfinite(change).all() else 0.0
        while part > SHORTEST_LINE_STEP:
            set_unknowns(level, start + part * step)
            level.update()
            if level.evaluate_residual() < (1.0 - DESCENT * part * share) * residual:
                return part * share
            part *= 0.5
        set_unknowns(level, start)
        level.update()
        if residual < IRREDUCIBLE_RESIDUAL:
            return 1.0
        raise DivergedError

    def refresh(self) -> None:
        """Discard the preconditioner, so that the next step computes a new one."""
        self.preconditioner = None


class System:
    """The linear equations of one step, each scaled by the diagonal of the Reynolds operator."""

    def __init__(self, newton: Newton) -> None:
        self.newton, level = newton, newton.level
        film, stencil = level.film, level.stencil
        self.shape, self.products = film.p.shape, 0
        rest = np.empty(self.shape)
        reynolds.operator(film, stencil, rest)
        np.subtract(level.sources.reynolds, rest, out=rest)
        # free: nodes that are wet, and cavitated ones whose residual would wet them
        inner = newton.neighbours.here.diagonal() > 0.0
        self.free: BoolArray = inner & ((film.p > 0.0) | (rest < 0.0)).ravel()
        self.kept = rows(self.free.astype(float))
        # over the diagonal, nodes of inlet and contact count alike in the norm
        diagonal = np.empty(self.shape)
        reynolds.diagonal(film, stencil, level.equations.influence.self_film, diagonal)
        self.scale = np.where(self.free, 1.0 / np.where(self.free, diagonal.ravel(), 1.0), 0.0)
        by_pressure, by_film = jacobian(
            film, stencil, newton.neighbours, *conductance_slopes(level)
        )
        self.by_pressure = csr_matrix(rows(self.scale) @ by_pressure @ self.kept)
        self.by_film = csr_matrix(rows(self.scale) @ by_film)
        self.rest = np.append(self.scale * rest.ravel(), level.missing())

    def product(self, change: Array) -> Array:
        """Return the Jacobian times a change of pressures and motions, (n + motions,)."""
        self.products += 1
        newton, nodes = self.newton, self.free.size
        pressure = np.where(self.free, change[:nodes], 0.0)
        film = np.empty(self.shape)
        newton.level.equations.deformation.deflect(pressure.reshape(self.shape), film)
        moved = film.ravel() + change[nodes:] @ newton.modes
        flow = self.by_pressure @ pressure + self.by_film @ moved
        kept = np.where(self.free, flow, change[:nodes])  # identity at the other nodes
        return np.append(kept, newton.modes @ (newton.load_weights * pressure))

    def solve(self, preconditioner: "Preconditioner", accuracy: float) -> Array:
        """Return the Newton step of `unknowns`, by GCROT.

        Parameters
        ----------
        preconditioner : Preconditioner
            Of this or an earlier step.
        accuracy : float
            Relative residual at which the iteration ends [-].
        """
        size = self.rest.size
        change, _ = gcrotmk(
            LinearOperator((size, size), matvec=self.product, dtype=float),
            self.rest,
            rtol=accuracy,
            maxiter=ROUNDS,
            m=VECTORS,
            M=LinearOperator((size, size), matvec=partial(preconditioner.solve, self), dtype=float),
        )
        change[self.free.size :] *= APPROACH_WEIGHT
        return np.asarray(change)


class Preconditioner:
    """Approximate inverse of ``system``: coarse-grid correction, then sparse factorisation.

    Later steps use it as well.
    """

    def __init__(self, system: System) -> None:
        newton = system.newton
        fixed = rows(1.0 - system.free.astype(float))
        by_itself = newton.level.equations.influence.self_film * system.by_film @ system.kept
        close = system.by_pressure + by_itself + fixed
        self.close = splu(
            csc_matrix(close, dtype=np.float32),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.01,
            options={"SymmetricMode": True},
        )
        # a coarse node on a cavitated fine node would share its nodes with others: singular
        self.moving = system.free[newton.same].astype(float)
        self.to_fine = csr_matrix(system.kept @ newton.to_fine @ rows(self.moving))
        self.to_coarse = csr_matrix(rows(self.moving) @ newton.to_coarse)
        with warnings.catch_warnings(action="ignore", category=LinAlgWarning):
            self.coarse = lu_factor(self.coarse_matrix(system))

    def coarse_matrix(self, system: System) -> Array:
        """Return the matrix of the coarse grid: Reynolds equations, then the balances."""
        newton = system.newton
        by_film = csr_matrix(self.to_coarse @ system.by_film)
        size, motions = newton.deflection.shape[0], len(newton.modes)
        matrix = np.zeros((size + motions, size + motions))
        inner = matrix[:size, :size]
        inner[:] = (self.to_coarse @ system.by_pressure @ self.to_fine).toarray()
        inner += ((by_film @ newton.to_fine) @ newton.deflection) * self.moving
        matrix[:size, size:] = by_film @ newton.modes.T
        matrix[size:, :size] = (newton.load_weights * newton.modes) @ self.to_fine
        # coarse nodes without wet fine nodes: identity rows
        empty = np.nonzero(~inner.any(axis=1))[0]
        matrix[empty, empty] = 1.0
        return matrix

    def solve(self, system: System, rest: Array) -> Array:
        """Return an approximate solution: coarse-grid correction, then the sparse near field.

        Parameters
        ----------
        system : System
            Its product gives the residual after the coarse-grid correction.
        rest : Array
            Right-hand side, (n + motions,): the nodes, then load and moment.
        """
        nodes, size = system.free.size, self.to_fine.shape[1]
        coarse = lu_solve(self.coarse, np.append(self.to_coarse @ rest[:nodes], rest[nodes:]))
        change = np.append(self.to_fine @ coarse[:size], coarse[size:])
        left = rest - system.product(change)
        change[:nodes] += self.close.solve(left[:nodes].astype(np.float32))
        return change


def limited(change: Array, motions: int = 1) -> tuple[Array, float]:
    """Return a limited step, and its part of ``change``.

    No pressure changes by more than `LARGEST_NEWTON_CHANGE`. The few `OUTLIERS` are clipped and do
    not shorten the step.

    Parameters
    ----------
    change : (n + motions,) array
        Of `unknowns`.
    motions : int
        Rigid motions among them, which are not limited.
    """
    sizes = np.abs(change[:-motions])
    last = sizes.size - 1 - int(OUTLIERS * sizes.size)
    most = np.partition(sizes, last)[last]
    share = LARGEST_NEWTON_CHANGE / max(float(most), LARGEST_NEWTON_CHANGE)
    step = share * change
    step[:-motions] = np.clip(step[:-motions], -LARGEST_NEWTON_CHANGE, LARGEST_NEWTON_CHANGE)
    return step, share
