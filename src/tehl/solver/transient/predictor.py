"""Initial guess of the pressure in a time step, by a least-squares predictor."""

import numpy as np

from tehl.base.typing import Array

TERMS = ((0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (1, 2), (2, 2), (2, 3))
"""Terms of the prediction, as steps back and strides downstream: parabolas in time of what stands
still and of what moves with the entrainment speed, and what lies between and beyond."""
STRAIGHT = np.array([{(0, 0): 2.0, (1, 0): -1.0}.get(term, 0.0) for term in TERMS])
"""Coefficients of linear extrapolation in time."""
LARGEST_PREDICTION_RATIO = 3.0
"""Predicted change over that of the last step, beyond which linear extrapolation is taken: the fit
does not contain sudden changes."""
REACH = 1 + max(back for back, _ in TERMS)
NOISE = 1e-5
"""Singular values of the terms, over the largest, below which they are linearly dependent."""


class Predictor:
    """Predicts the pressure of the next time step from the previous ones.

    The difference delta to the steady pressure is extrapolated as

        delta(x, t + dt) = sum_k c_k delta(x - s_k dx, t - j_k dt)

    (docs/theory/numerics-transient.md), with the coefficients that best fit the last step in
    the least-squares sense and, among equally good ones, are nearest to linear extrapolation. The
    fit adapts to what stands still and to what moves, at any speed. The normal equations are
    assembled without BLAS, whose threads cost more than they save here. ``steady`` is the pressure
    at time zero, (ny, nx), and ``stride`` the nodes that the mean motion passes per step.
    """

    def __init__(self, steady: Array, stride: int) -> None:
        self.steady, self.stride = steady.copy(), stride
        self.past = np.zeros((REACH + 1, *steady.shape))

    def note(self, pressure: Array) -> None:
        """Store the pressure of a converged step, (ny, nx)."""
        self.past[1:] = self.past[:-1].copy()
        np.subtract(pressure, self.steady, out=self.past[0])

    def onward(self) -> Array:
        """Return the initial guess of the next step, (ny, nx); cavities stay."""
        now, change = self.steady + self.past[0], self.past[0] - self.past[1]
        onward = now + change
        if self.past[REACH - 1].any():  # enough steps to fit the last one
            terms = self._terms(self.past[:-1])
            predicted = self.steady + np.einsum("k,kji->ji", self._coefficients(), terms)
            if np.abs(predicted - now).max() <= LARGEST_PREDICTION_RATIO * np.abs(change).max():
                onward = predicted
        return np.where(now > 0.0, np.maximum(onward, 0.0), 0.0)

    def _coefficients(self) -> Array:
        """Return the coefficients that best predict the last step on every second line."""
        lines = slice(None, None, 2)
        terms = self._terms(self.past[1:, lines]).reshape(len(TERMS), -1)
        # fit what linear extrapolation misses: the smallest such correction is nearest to it
        missed = self.past[0, lines].ravel() - np.einsum("k,kn->n", STRAIGHT, terms)
        gram = np.einsum("in,jn->ij", terms, terms)
        moments = np.einsum("in,n->i", terms, missed)
        values, vectors = np.linalg.eigh(gram)
        independent = values > NOISE**2 * values[-1]
        vectors = vectors[:, independent]
        return np.asarray(STRAIGHT + vectors @ ((vectors.T @ moments) / values[independent]))

    def _terms(self, past: Array) -> Array:
        """Return the shifted fields of `TERMS`, from ``past`` with the newest first."""
        terms = np.zeros((len(TERMS), *past.shape[1:]))
        for term, (back, strides) in zip(terms, TERMS, strict=True):
            shift = strides * self.stride
            term[:, shift:] = past[back, :, : max(term.shape[1] - shift, 0)]
        return terms
