"""Anderson acceleration of the multigrid cycle: a step combined of what earlier cycles did."""

import math

import numpy as np

from tehl.typing import Array

WORSE = 3.0
"""Change by a cycle, over the least one remembered, at which the memory is of another state."""
INDEPENDENT = 1e-6
"""Relative size of a combination of changes below which it says nothing."""


class Anderson:
    """The minimiser of the change by a cycle among the combinations of the last cycles.

    A cycle that is unstable in a few modes, because a coarse grid sees rough surfaces of another
    shape, converges with it (D. G. Anderson 1965; as a Krylov method, Walker and Ni 2011).

    Parameters
    ----------
    memory : int
        Cycles to remember besides the last.
    """

    def __init__(self, memory: int) -> None:
        self.memory = memory
        self.states: list[Array] = []
        self.changes: list[Array] = []

    def combine(self, before: Array, after: Array) -> Array:
        """Return the state to go on from.

        Parameters
        ----------
        before, after : (n,) array
            The state that the last cycle began with and the one it ended with.
        """
        change = after - before
        if self.changes and not _size(change) <= WORSE * min(map(_size, self.changes)):
            self.states, self.changes = [], []
        self.states = [*self.states, before][-self.memory - 1 :]
        self.changes = [*self.changes, change][-self.memory - 1 :]
        if len(self.changes) == 1:
            return after
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
    """Return the scalar product, without BLAS, whose threads cost more than they save here."""
    return float(np.einsum("i,i->", one, other))


def _weights(rows: Array, target: Array) -> Array:
    """Return the combination of ``rows`` (k, n) nearest to ``target`` (n,): QR by Gram and Schmidt.

    Modified, and with the target orthogonalised like the rows, it is backward stable (Björck 1967).
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
