"""Anderson acceleration of the multigrid cycle by the changes of earlier cycles."""

import math

import numpy as np

from tehl.base.typing import Array

DROPPING_RATIO = 3.0
"""Change by a cycle over the smallest one in memory, beyond which the memory is dropped, because it
belongs to another state."""
INDEPENDENT = 1e-6
"""Relative size of a combination of changes below which it is rounding error."""


class Anderson:
    """Affine combination of the last states whose change by a cycle is least.

    It makes a cycle converge that is unstable in a few modes, as between rough surfaces, which a
    coarse grid represents with another shape (D. G. Anderson 1965; as a Krylov method, Walker and
    Ni 2011). ``memory`` is the number of earlier cycles that are combined with the last one.
    """

    def __init__(self, memory: int) -> None:
        self.memory = memory
        self.states: list[Array] = []
        self.changes: list[Array] = []

    def combine(self, before: Array, after: Array) -> Array:
        """Return the start of the next cycle.

        Parameters
        ----------
        before, after : Array
            State at the start and at the end of the last cycle, (n,).
        """
        change = after - before
        if self.changes and not _size(change) <= DROPPING_RATIO * min(map(_size, self.changes)):
            self.states, self.changes = [], []
        self.states = [*self.states, before][-self.memory - 1 :]
        self.changes = [*self.changes, change][-self.memory - 1 :]
        if len(self.changes) == 1:
            return after
        # minimise |change - sum_k w_k (change - change_k)| over the weights w
        by_change = np.stack([change - earlier for earlier in self.changes[:-1]])
        combined = after.copy()
        for weight, state, moved in zip(
            _weights(by_change, change), self.states, by_change, strict=False
        ):
            combined -= weight * (before - state + moved)
        return combined


def _size(vector: Array) -> float:
    return math.sqrt(_product(vector, vector))


def _product(one: Array, other: Array) -> float:
    """Return the scalar product, without BLAS: its threads cost more than they save here."""
    return float(np.einsum("i,i->", one, other))


def _weights(rows: Array, target: Array) -> Array:
    """Return the least-squares weights of ``rows``, (k, n), for ``target``, (n,).

    By modified Gram-Schmidt, which is backward stable if the target is orthogonalised like the rows
    (Björck 1967).
    """
    basis, rest = rows.copy(), target.copy()
    triangle, moments = np.zeros((len(rows), len(rows))), np.zeros(len(rows))
    for i in range(len(rows)):
        triangle[i, i] = _size(basis[i])
        basis[i] /= triangle[i, i] or 1.0
        for j in range(i + 1, len(rows)):
            triangle[i, j] = _product(basis[i], basis[j])
            basis[j] -= triangle[i, j] * basis[i]
        moments[i] = _product(basis[i], rest)
        rest -= moments[i] * basis[i]
    return np.asarray(np.linalg.lstsq(triangle, moments, rcond=INDEPENDENT)[0])
