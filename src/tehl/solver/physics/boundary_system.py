"""Linear equations of a Newton step for surfaces that touch, and their preconditioner.

For given sets of free and of touching nodes the unknowns are the changes u of the oil pressure P,
the changes v of the sum of P and the contact pressure P_c, which are u where nothing touches, and c
of H00 (docs/theory/contact.md):

    L_P u + L_H (K v + c) = f - L   at free nodes, L_H without the films of touching nodes,
    K v + c = H_c - H               at touching nodes,
    sum(v) dx dy = w - sum(P + P_c) dx dy.

At a touching node the film is known, so the first equation is that of u alone and the second that
of v. The Krylov method is that of `tehl.solver.cycle.newton`. Where surfaces touch, and where the
oil conducts so little that it carries its film along, the film is known and the pressure makes it:
both are preconditioned by the inverse of K between mirrors at the edges.
"""

import numpy as np
from scipy.linalg import lu_factor, lu_solve
from scipy.sparse import csc_matrix, csr_matrix
from scipy.sparse.linalg import LinearOperator, SuperLU, gcrotmk, splu

from tehl.base.typing import Array, BoolArray, IntArray
from tehl.estimate.grid import Grid
from tehl.kernels import reynolds
from tehl.operators.deformation import Flattening
from tehl.operators.jacobian import Neighbours, flux_difference, jacobian, neighbour, rows
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.linearised import conductance_slopes
from tehl.solver.cycle.newton import ROUNDS, VECTORS, Newton
from tehl.solver.physics.solid_shares import contact_of

LARGEST_STEPS, FAR_RESIDUAL = (5.0, 1.0), 0.1
"""Largest change of the pressure of oil per step, in Hertz pressures, and residual above which the
second one holds. Near the solution that would leave the load out of balance."""
OPENING = 0.1
"""Pressure by which oil may exceed the sum of both at a node, which then opens, in Hertz pressures.
If it may not exceed it, patches that only a coarser grid has open node by node."""
STIFF, LEADING = 0.35, 0.2
"""Least parts of the film, and of that at the node itself, in the equation of a node whose oil
carries its film along."""
LARGEST_PRESS = 20.0
"""Largest change per step of the sum of both pressures where surfaces touch, in Hertz pressures:
the contact is linear, and small steps there only make many of them."""


class TouchingOperators(Newton):
    """What the steps on a level share: those of Newton's method for films, and two more.

    ``flattening`` and ``close_influence`` precondition known films, and the film between them.
    """

    def __init__(self, level: Level, coarse: Grid) -> None:
        super().__init__(level, coarse)
        self.flattening = Flattening(level.grid, level.equations.groups)
        self.close_influence = close_influence(level)


class TouchingSystem:
    """The linear equations of one step, each scaled by the sum of its coefficients.

    A vector has the changes u of the oil pressure, the changes v of the sum of both pressures at
    touching nodes, and that of the rigid approach, (2 n + 1,).
    """

    def __init__(self, operators: TouchingOperators) -> None:
        self.operators, self.level, self.products = operators, operators.level, 0
        level, film = self.level, self.level.film
        self.shape, self.size = film.p.shape, film.p.size
        self.touching: BoolArray = contact_of(level.share).touching.ravel()
        rest = np.empty(self.shape)
        reynolds.operator(film, level.balance, rest)
        np.subtract(level.sources.reynolds, rest, out=rest)
        inner = operators.neighbours.here.diagonal() > 0.0
        self.free: BoolArray = inner & ((film.p > 0.0) | (rest < 0.0)).ravel()
        by_pressure, by_film = jacobian(
            film,
            level.stencil,
            transport(level, operators.neighbours),
            *conductance_slopes(level),
        )
        by_film = csr_matrix(by_film @ rows((~self.touching).astype(float)))
        self_film = level.equations.influence.self_film
        size = np.asarray(abs(by_pressure).sum(1) + self_film * abs(by_film).sum(1)).ravel()
        scale = rows(np.where(self.free, 1.0 / np.where(self.free, size, 1.0), 0.0))
        self.by_pressure, self.by_film = (
            csr_matrix(scale @ by_pressure),
            csr_matrix(scale @ by_film),
        )
        self.stiffness = 1.0 / self_film
        self.rest = self._right_hand_side(scale @ rest.ravel())

    def _right_hand_side(self, rest: Array) -> Array:
        """Return the right-hand side, less the changes that are known before the solution.

        Oil that cavitates loses its pressure, and so does a contact that opens.
        """
        level, least = self.level, self.level.equations.solids.contact_film or 0.0
        oil = np.where(self.free, 0.0, -level.film.p.ravel())
        oil[~(self.operators.neighbours.here.diagonal() > 0.0)] = 0.0  # edges keep their pressure
        total = np.where(self.touching, 0.0, oil - level.film.asperity.ravel())
        self.known_oil = oil
        missing = self.stiffness * (least - level.separation.ravel())
        load = level.missing_load()
        if oil.any() or total.any():
            film = self.deflect(total)
            rest = rest - self.by_pressure @ oil - self.by_film @ film
            missing -= self.stiffness * film
            load -= float(self.operators.load_weights @ total)
        gap = np.where(self.touching, missing, 0.0)
        return np.concatenate([np.where(self.free, rest, 0.0), gap, [load]])

    def deflect(self, pressure: Array) -> Array:
        """Return K times a pressure, (n,)."""
        film = np.empty(self.shape)
        self.level.equations.deformation.deflect(pressure.reshape(self.shape), film)
        return film.ravel()

    def product(self, change: Array) -> Array:
        """Return the Jacobian times a change; identity where nothing is unknown."""
        self.products += 1
        oil, total = np.where(self.free, change[: self.size], 0.0), change[self.size : -1]
        both = np.where(self.touching, total, oil)
        film = self.deflect(both) + change[-1]
        flow = self.by_pressure @ oil + self.by_film @ film
        return np.concatenate(
            [
                np.where(self.free, flow, change[: self.size]),
                np.where(self.touching, self.stiffness * film, total),
                [self.operators.load_weights @ both],
            ]
        )

    def solve(self, accuracy: float) -> Array:
        """Return the solution by GCROT to a relative residual of ``accuracy``."""
        size, factors = self.rest.size, TouchingPreconditioner(self)
        change, _ = gcrotmk(
            LinearOperator((size, size), matvec=self.product, dtype=float),
            self.rest,
            rtol=accuracy,
            maxiter=ROUNDS,
            m=VECTORS,
            M=LinearOperator((size, size), matvec=factors.solve, dtype=float),
        )
        return np.asarray(change)

    def stepped(
        self, before: tuple[Array, Array, Array], change: Array, part: float, residual: float
    ) -> tuple[Array, Array, Array]:
        """Return oil pressure, rigid approach and contact pressure after part of a change.

        Where surfaces touch the sum of both pressures follows the change and the oil pressure has
        its part of it: one that falls does so by its density, whose slope at high pressure would
        take it far below the solution.

        Parameters
        ----------
        before : (Array, Array, Array)
            Oil pressure (ny, nx), rigid approach and contact pressure (ny, nx), in Hertz scales.
        change : Array
            Solution of the linear system.
        part : float
            Step length, 0 to 1.
        residual : float
            Before the change: far from the solution the oil changes by less.
        """
        (oil, approach, contact), shape = before, self.shape
        u = (np.where(self.free, change[: self.size], 0.0) + self.known_oil).reshape(shape)
        v = np.where(self.touching, change[self.size : -1], u.ravel() - contact.ravel())
        v, touching = v.reshape(shape), self.touching.reshape(shape)
        most = LARGEST_STEPS[int(residual > FAR_RESIDUAL)]
        step = part * np.clip(u, -most, most)
        total = np.maximum(oil + contact + part * np.clip(v, -LARGEST_PRESS, LARGEST_PRESS), 0.0)
        inside = np.where(u < 0.0, self._by_density(oil, part * u, step), oil + step)
        inside = np.minimum(inside, total + OPENING)
        pressure = np.where(touching, inside, np.maximum(oil + step, 0.0))
        opened = (1.0 - part) * contact
        carried = np.where(touching, total - inside, opened)
        return pressure, approach + part * float(change[-1]), carried

    def _by_density(self, oil: Array, change: Array, otherwise: Array) -> Array:
        """Return the pressure whose density is that of a linear ``change``, not negative."""
        film, flow = self.level.film, self.level.equations.flow
        density = flow.density[:, 0]
        if not density[-1] > density[0]:  # incompressible
            return np.maximum(oil + otherwise, 0.0)
        pressures, wanted = flow.step * np.arange(density.size), film.rho + film.drho * change
        # the difference, as the kernels interpolate by cubics
        fall = np.interp(wanted, density, pressures) - np.interp(film.rho, density, pressures)
        return np.maximum(oil + fall, 0.0)


class TouchingPreconditioner:
    """Approximate inverse of a system, in three stages, each of what the last one has left.

    A correction on a coarse grid; the pressures of oil, by a factorisation with close deflections;
    and, last, the pressures that make known films, by `TouchingOperators.flattening`.
    """

    def __init__(self, system: TouchingSystem) -> None:
        self.system, operators = system, system.operators
        free, touching = (rows(one.astype(float)) for one in (system.free, system.touching))
        apart = rows((system.free & ~system.touching).astype(float))
        near = system.by_film @ operators.close_influence @ apart
        self.close = splu(
            beside(system.by_pressure @ free + near + rows(1.0 - free.diagonal()), system.shape[1]),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.01,
            options={"SymmetricMode": True},
        )
        self.carried, self.wedge = self._wedge()
        moving = system.free | system.touching
        self.at_coarse = moving[operators.same].astype(float)
        self.to_fine = csr_matrix(
            rows(moving.astype(float)) @ operators.to_fine @ rows(self.at_coarse)
        )
        self.to_coarse = csr_matrix(rows(self.at_coarse) @ operators.to_coarse)
        by_pressure = self.to_coarse @ system.by_pressure @ apart @ self.to_fine
        by_film = self.to_coarse @ (apart @ system.by_film + system.stiffness * touching)
        size = operators.deflection.shape[0]
        matrix = np.zeros((size + 1, size + 1))
        matrix[:-1, :-1] = by_pressure.toarray()
        matrix[:-1, :-1] += (
            csr_matrix(by_film @ operators.to_fine) @ operators.deflection
        ) * self.at_coarse
        matrix[:-1, -1] = by_film @ np.ones(system.size)
        matrix[-1, :-1] = operators.load_weights @ self.to_fine
        empty = np.nonzero(~matrix[:-1, :-1].any(axis=1))[0]  # no moving fine node: identity
        matrix[empty, empty] = 1.0
        self.coarse = lu_factor(matrix)

    def _wedge(self) -> tuple[BoolArray, SuperLU]:
        """Return where oil carries its film along, and the factors of L_H there.

        Upstream along lines only: a triangular matrix, the factors of which have no more entries.
        """
        system = self.system
        part = np.asarray(abs(system.by_film).sum(1)).ravel() / system.stiffness
        leads = np.abs(system.by_film.diagonal()) / system.stiffness > LEADING
        carried: BoolArray = system.free & ~system.touching & (part > STIFF) & leads
        inside = rows(carried.astype(float))
        entries, nx = (inside @ system.by_film @ inside).tocoo(), system.shape[1]
        upstream = (entries.row // nx == entries.col // nx) & (entries.col <= entries.row)
        places = (entries.row[upstream], entries.col[upstream])
        lower = csc_matrix((entries.data[upstream], places), shape=entries.shape)
        matrix = csc_matrix(lower + rows(1.0 - inside.diagonal()))
        return carried, splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0)

    def solve(self, rest: Array) -> Array:
        """Return an approximate solution for the right-hand side ``rest``."""
        system, operators = self.system, self.system.operators
        size, free, touching = system.size, system.free, system.touching
        row = np.where(touching, rest[size:-1], np.where(free, rest[:size], 0.0))
        coarse = lu_solve(self.coarse, np.append(self.to_coarse @ row, rest[-1]))
        both = self.to_fine @ coarse[:-1]
        oil, total = np.where(touching, 0.0, both), np.where(touching, both, rest[size:-1])
        # the coarse deflection is accurate enough, and saves a product
        film = operators.to_fine @ (operators.deflection @ (self.at_coarse * coarse[:-1]))
        flow = system.by_pressure @ oil + system.by_film @ (film + coarse[-1])
        left = rest[:size] - np.where(free, flow, oil)
        oil += self.close.solve(left.astype(np.float32))
        if touching.any() or self.carried.any():
            left = rest - system.product(np.concatenate([oil, total, coarse[-1:]]))
            gap = np.where(touching, left[size:-1] / system.stiffness, 0.0)
            gap += self.wedge.solve(np.where(self.carried, left[:size], 0.0))
            flat = np.empty(system.shape)
            operators.flattening.deflect(gap.reshape(system.shape), flat)
            oil += np.where(self.carried, flat.ravel(), 0.0)
            total += np.where(touching, flat.ravel(), 0.0)
        return np.concatenate([oil, total, coarse[-1:]])


def beside(matrix: csr_matrix, nx: int) -> csc_matrix:
    """Return the entries of a matrix between nodes of a line, and of the next ones, as float32.

    The few others save no iterations, and double the cost of a factorisation.

    Parameters
    ----------
    matrix : csr_matrix
        Over all nodes, row by row.
    nx : int
        Nodes per line.
    """
    entries = matrix.tocoo()
    near = np.abs(entries.row // nx - entries.col // nx) <= 1
    places = (entries.row[near], entries.col[near])
    return csc_matrix((entries.data[near].astype(np.float32), places), shape=matrix.shape)


def transport(level: Level, neighbours: Neighbours, nodes: IntArray | None = None) -> Neighbours:
    """Return ``neighbours`` with the wedge of a level: by fluxes, or that of a time step.

    Parameters
    ----------
    level : Level
        With the marks of partly filled nodes and of the orders of fluxes.
    neighbours : Neighbours
        Of its grid.
    nodes : array of int or None
        Nodes whose neighbours are returned; all if None.
    """
    found = neighbours if nodes is None else neighbours.at(nodes)
    if not level.balance.conserves:
        return found
    partial = level.film.partial > 0
    before = np.zeros_like(partial)
    before[:, 1:] = partial[:, :-1]
    is_open = np.where(before & ~partial, 0.0, 1.0).ravel()
    flux = flux_difference(level.film, level.stencil, level.grid, _last_full(level), nodes)
    return found._replace(upstream=flux, open_west=is_open if nodes is None else is_open[nodes])


def _last_full(level: Level) -> IntArray:
    """Return the column of each full node, and for a partly filled one of that upstream."""
    partial = level.film.partial > 0
    found: IntArray = np.where(partial, -1, np.arange(level.grid.nx))
    return np.maximum.accumulate(found, axis=1)


def close_influence(level: Level) -> csr_matrix:
    """Return the influence of each node on itself and on the eight around it."""
    grid, influence = level.grid, level.equations.influence
    every = np.ones(grid.shape, bool)
    across = (-1, 0, 1) if grid.ny > 1 else (0,)
    parts = (
        neighbour(grid, every, j, i, float(influence(abs(j), abs(i))))
        for j in across
        for i in (-1, 0, 1)
    )
    return csr_matrix(sum(parts, start=csr_matrix((every.size, every.size))))
