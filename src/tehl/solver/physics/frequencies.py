"""Solves A Q = a and (A - i Omega B) R = b + B Q of `tehl.solver.physics.response` at frequencies.

By conjugate residuals. The source of R is the same at all frequencies: solutions at some of them
span a space in which those at the others are found.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from tehl.base.typing import Array, IntArray
from tehl.operators.jacobian import rows
from tehl.solver.physics.response import FilmResponse

STATIC_RESIDUAL, RESPONSE_RESIDUAL = 1e-6, 3e-5
"""Relative residuals of Q and of R: k is then within 2e-6, c within 3e-5, rolling and cross terms
within 2e-4 (M 10 to 300, L 2 to 20, Omega 0.05 to 8; against 1e-9)."""
SAME_INVERSE = 2.0
"""Ratio of frequencies up to which one factorisation serves both."""
MOST_DIRECTIONS = 200
"""Search directions of a frequency, of which it needs 20 to 40, at which the solve fails."""
MOSTLY_NEW = 0.7
"""Length of an image without those before it, over its own, below which it is orthogonalised again
(Daniel, Gragg, Kaufman and Stewart 1976, Math. Comp. 30, 772)."""
DEPENDENT = 1e-13
"""Eigenvalue of the products of solutions, over the largest, below which they are dependent."""


class NoResponseError(ArithmeticError):
    """The search at ``omega``, a frequency omega a_x/u_m, did not end."""

    def __init__(self, omega: float) -> None:
        super().__init__(f"the response at omega a_x/u_m = {omega:g} does not converge")
        self.omega = omega


class CloseInverse:
    """Approximate inverse of A - i Omega B: each pressure deflects its own node alone.

    A coarse-grid correction before it, as that of `tehl.solver.cycle.newton`, takes more directions
    (21 in place of 15 at M = 50, L = 10). ``order`` of the unknowns is that of another frequency,
    whose search takes a third of the time of a factorisation.
    """

    def __init__(self, system: FilmResponse, omega: float, order: IntArray | None = None) -> None:
        self.omega, lag = omega, 1j * omega if omega else 0.0
        self.single = np.complex64 if omega else np.float32
        near = rows(system.level.equations.influence.self_film * system.carries)
        pressed = system.by_pressure - lag * rows(system.denser)
        opened = system.by_film - lag * rows(system.density)
        alone = rows(1.0 - system.unknown)
        matrix = csc_matrix(pressed + opened @ near + alone, dtype=self.single)
        self.order = order
        if order is not None:
            matrix = csc_matrix(matrix[order][:, order])
        self.close = splu(
            matrix,
            permc_spec="MMD_AT_PLUS_A" if order is None else "NATURAL",
            diag_pivot_thresh=0.01,
            options={"SymmetricMode": True},
        )

    def solve(self, rest: Array) -> Array:
        """Return an approximate solution for the right-hand side ``rest``."""
        if self.order is None:
            return np.asarray(self.close.solve(rest.astype(self.single)).astype(rest.dtype))
        found = np.empty_like(rest)
        found[self.order] = self.close.solve(rest.astype(self.single)[self.order])
        return found


class CloseInverses:
    """Approximate inverses at some frequencies, each for those near it too."""

    def __init__(self, system: FilmResponse) -> None:
        self.system, self.known = system, list[CloseInverse]()

    def at(self, omega: float) -> CloseInverse:
        """Return the inverse at a frequency, or at one within `SAME_INVERSE`."""
        for one in self.known:
            if one.omega / SAME_INVERSE <= omega <= one.omega * SAME_INVERSE:
                return one
        order = np.argsort(self.known[0].close.perm_c) if self.known else None
        self.known.append(CloseInverse(self.system, omega, order))
        return self.known[-1]


class SteadySteps(NamedTuple):
    """Steps of the search at frequency zero, with orthonormal images A u, and B u, (m, n) each."""

    steps: Array
    steady: Array
    stored: Array

    def at(self, omega: float) -> tuple[Array, Array]:
        """Return (A - i omega B) u as triangular parts of orthonormal rows, and those rows."""
        images = self.steady - 1j * omega * self.stored
        parts = cholesky(images.conj() @ images.T)
        return parts, solve_triangular(parts, images, trans="T")


class Directions:
    """Search directions at one frequency, and their orthonormal images: they serve all sources.

    Eisenstat, Elman and Schultz 1983, SIAM J. Numer. Anal. 20, 345 (generalised conjugate
    residuals). The image of step j is the sum of the images up to j times column j of ``parts``.
    Those that a steady film has taken lessen the number at each frequency by a fifth: smooth
    pressures, whose deflection the approximate inverse does not hold.
    """

    def __init__(
        self,
        system: FilmResponse,
        omega: float,
        close: CloseInverse,
        steady: SteadySteps | None = None,
    ) -> None:
        self.system, self.omega, self.close = system, omega, close
        self.number = 0 if steady is None else len(steady.steps)
        self.most, kind = self.number + MOST_DIRECTIONS, complex if omega else float
        size = self.most, system.unknown.size
        self.parts = np.zeros((self.most, self.most), kind)
        self.steps, self.images = np.empty(size, kind), np.empty(size, kind)
        if steady is not None:
            known = np.s_[: self.number]
            self.steps[known] = steady.steps
            self.parts[known, known], self.images[known] = steady.at(omega)

    def for_others(self) -> SteadySteps:
        """Return the directions at frequency zero, for the search at other frequencies."""
        known = np.s_[: self.number]
        steps = solve_triangular(self.parts[known, known], self.steps[known], trans="T")
        stored = np.array([self.system.parts(one)[1] for one in steps])
        return SteadySteps(steps, self.images[known], stored)

    def solve(self, source: Array, start: Array, residual: float) -> Array:
        """Return the solution of (A - i Omega B) u = source.

        Parameters
        ----------
        source, start : (n,) array
            Right-hand side, and a first guess.
        residual : float
            Relative residual to reach.
        """
        first = source - self.system.product(self.omega, start)
        rest, _ = self._without_images(first)
        least = residual * np.linalg.norm(source)
        while not np.linalg.norm(rest) <= least:  # NaN fails
            if self.number == self.most:
                raise NoResponseError(self.omega)
            image = self._next(rest)
            rest = rest - np.vdot(image, rest) * image
        known = np.s_[: self.number]
        weights = (self.images[known] @ first.conj()).conj()
        return np.asarray(
            start + solve_triangular(self.parts[known, known], weights) @ self.steps[known]
        )

    def _next(self, rest: Array) -> Array:
        """Return the image of a direction that lessens ``rest``; both join the others."""
        step = self.close.solve(rest)
        image = self.system.product(self.omega, step)
        size = np.linalg.norm(image)
        left, parts = self._without_images(image)
        if np.linalg.norm(left) < MOSTLY_NEW * size:  # twice is enough
            left, more = self._without_images(left)
            parts = parts + more
        new = np.linalg.norm(left)
        self.parts[: self.number, self.number], self.parts[self.number, self.number] = parts, new
        self.steps[self.number], self.images[self.number] = step, left / new
        self.number += 1
        return np.asarray(self.images[self.number - 1])

    def _without_images(self, image: Array) -> tuple[Array, Array]:
        """Return ``image`` without its parts along all images, and those parts."""
        images = self.images[: self.number]
        parts = (images @ image.conj()).conj()
        return image - parts @ images, parts


class Solutions:
    """Solutions of (A - i Omega B) R = source at some frequencies, as a space for the others.

    Those of one source serve the others too.
    """

    def __init__(self, system: FilmResponse, sources: list[Array]) -> None:
        self.system, self.sources = system, np.array(sources)
        self.vectors = self.images = np.zeros((0, system.unknown.size))  # an image by A, one by B
        self.products, self.along = np.zeros((0, 0)), np.zeros((0, len(sources)))

    def start(self, number: int, omega: float) -> tuple[Array, bool]:
        """Return the best of the space for a source, and if it has the `RESPONSE_RESIDUAL`."""
        start, error = self._within(number, omega)
        return start, error <= RESPONSE_RESIDUAL

    def at(self, number: int, directions: Directions, start: Array) -> Array:
        """Return the solution at the frequency of ``directions``, which joins the space."""
        found = directions.solve(self.sources[number], start, RESPONSE_RESIDUAL)
        for part in (found.real, found.imag) if directions.omega else (found,):
            self._join(np.where(self.system.unknown, part, 0.0))
        return found

    def _join(self, vector: Array) -> None:
        for _ in range(2):  # twice is enough
            vector = vector - self.vectors.T @ (self.vectors @ vector)
        vector = vector / np.linalg.norm(vector)
        new = np.array(self.system.parts(vector))
        with_others = self.images @ new.T
        self.products = np.block([[self.products, with_others], [with_others.T, new @ new.T]])
        self.along = np.vstack([self.along, new @ self.sources.T])
        self.vectors = np.vstack([self.vectors, vector])
        self.images = np.vstack([self.images, new])

    def _within(self, number: int, omega: float) -> tuple[Array, float]:
        """Return the vector of the space with the least residual, and that residual, relative."""
        source, size = self.sources[number], len(self.vectors)
        if not size:
            return np.zeros(source.size, complex if omega else float), np.inf
        one = np.array([[1.0], [-1j * omega if omega else 0.0]])
        turn = np.kron(np.eye(size), one)
        turned = turn.conj().T
        solved = np.linalg.lstsq(
            turned @ self.products @ turn, turned @ self.along[:, number], rcond=DEPENDENT
        )
        weights = np.asarray(solved[0])
        rest = source - _combined(turn @ weights, self.images)
        error = float(np.linalg.norm(rest) / np.linalg.norm(source))
        return _combined(weights, self.vectors), error


def _combined(weights: Array, rows: Array) -> Array:
    """Return weights @ rows; real rows are not copied to complex ones."""
    if np.iscomplexobj(weights):
        return np.asarray(weights.real @ rows + 1j * (weights.imag @ rows))
    return np.asarray(weights @ rows)
