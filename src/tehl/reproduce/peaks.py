"""Maxima of a curve that stand out from it."""

import numpy as np

from tehl.typing import Array


def peaks(values: Array, prominence: float) -> list[int]:
    """Return the places of the maxima that rise by ``prominence`` over both their saddles.

    Parameters
    ----------
    values : (n,) array
        The curve; its ends are no maxima.
    prominence : float
        Least height above the higher of the lowest points that part it from higher ground.
    """
    inner = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])) + 1
    return [int(k) for k in inner if _prominence(values, int(k)) >= prominence]


def _prominence(values: Array, place: int) -> float:
    """Return how far a maximum rises over the higher of its two saddles."""
    top = values[place]
    higher = np.flatnonzero(values > top)
    left = higher[higher < place]
    right = higher[higher > place]
    start = int(left[-1]) if left.size else 0
    end = int(right[0]) if right.size else values.size - 1
    saddle = max(values[start : place + 1].min(), values[place : end + 1].min())
    return float(top - saddle)
