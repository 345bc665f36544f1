"""Where the pressure of a step in time begins: what would have told the last step best."""

import numpy as np

from tehl.typing import Array

TERMS = ((0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (1, 2), (2, 2), (2, 3))
"""Steps back and strides along x of the fields that a prediction is made of: parabolas in time of
what stands still and of what moves with the entrainment speed, and what lies between and beyond."""
STRAIGHT = np.array([{(0, 0): 2.0, (1, 0): -1.0}.get(term, 0.0) for term in TERMS])
"""Coefficients of the straight line in time through the last two steps."""
FARTHEST = 3.0
"""Change of a step over that of the step before, beyond which nothing is told but a straight line:
what has just begun looks like nothing that was."""
REACH = 1 + max(back for back, _ in TERMS)
NOISE = 1e-5
"""Singular values of the fields over the largest, below which they tell the same."""


class Predictor:
    """Tells the pressure of the next step from those of the last ones.

    Of the difference to the steady pressure, delta, it takes

        delta(x, t + dt) = sum_k c_k delta(x - s_k dx, t - j_k dt)

    with the coefficients that are best, in the sense of least squares, for the step before, and of
    those that are as good the nearest to a straight line in time. So it finds out by itself what
    stands still, what moves and how fast. Gram's matrix is made without BLAS, whose threads would
    cost more than they save.

    Parameters
    ----------
    steady : (ny, nx) array
        The pressure P at the beginning.
    stride : int
        Nodes that the mean motion passes in a step.
    """

    def __init__(self, steady: Array, stride: int) -> None:
        self.steady, self.stride = steady.copy(), stride
        self.past = np.zeros((REACH + 1, *steady.shape))

    def note(self, pressure: Array) -> None:
        """Learn the pressure of a step that has settled, (ny, nx)."""
        self.past[1:] = self.past[:-1].copy()
        np.subtract(pressure, self.steady, out=self.past[0])

    def onward(self) -> Array:
        """Return the pressure to begin the next step with, (ny, nx); cavities stay."""
        now, change = self.steady + self.past[0], self.past[0] - self.past[1]
        onward = now + change
        if self.past[REACH - 1].any():  # far enough back for the last step to be told from it
            terms = self._terms(self.past[:-1])
            told = self.steady + np.einsum("k,kji->ji", self._coefficients(), terms)
            if np.abs(told - now).max() <= FARTHEST * np.abs(change).max():
                onward = told
        return np.where(now > 0.0, np.maximum(onward, 0.0), 0.0)

    def _coefficients(self) -> Array:
        """Return what would have told every second line of the last step best."""
        lines = slice(None, None, 2)
        terms = self._terms(self.past[1:, lines]).reshape(len(TERMS), -1)
        missed = self.past[0, lines].ravel() - np.einsum("k,kn->n", STRAIGHT, terms)
        gram = np.einsum("in,jn->ij", terms, terms)
        moments = np.einsum("in,n->i", terms, missed)
        values, vectors = np.linalg.eigh(gram)
        told = values > NOISE**2 * values[-1]
        vectors = vectors[:, told]
        return np.asarray(STRAIGHT + vectors @ ((vectors.T @ moments) / values[told]))

    def _terms(self, past: Array) -> Array:
        """Return the fields that a prediction is made of, the newest of ``past`` first."""
        terms = np.zeros((len(TERMS), *past.shape[1:]))
        for term, (back, strides) in zip(terms, TERMS, strict=True):
            shift = strides * self.stride
            term[:, shift:] = past[back, :, : max(term.shape[1] - shift, 0)]
        return terms
