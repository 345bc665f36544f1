"""What a test does not determine, and what of it the model does not follow."""

import math
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from tehl.base.typing import Array
from tehl.base.units import percentage
from tehl.studies.fitting.constants import Fitted
from tehl.studies.fitting.estimate import Estimate

if TYPE_CHECKING:
    import pandas as pd


def remarks(
    constants: Sequence[Fitted],
    correlation: Array,
    table: "pd.DataFrame",
    found: Estimate,
    reached: float,
) -> Iterator[str]:
    """Yield sentences on what a test leaves open.

    Parameters
    ----------
    constants : sequence of Fitted
        With their intervals.
    correlation : Array
        Of the constants, (constants, constants).
    table : DataFrame
        Of the fit, a row per measured value.
    found : Estimate
        With the scatter.
    reached : float
        Largest shear stress over that of the shear law [-].
    """
    for one in constants:
        if one.high >= 4.0 * one.low:
            why = _why_open(one.constant.name, reached)
            yield f"the data do not determine {one.constant.name}: {one.interval}{why}"
        elif one.grid_error > 0.5 * math.log(one.high / one.low):
            yield (
                f"the error of the grid exceeds the interval of {one.constant.name}: state a "
                "smaller numerics.error"
            )
    for (i, first), (k, second) in combinations(enumerate(constants), 2):
        if abs(correlation[i, k]) > 0.99:
            yield (
                f"{first.constant.name} and {second.constant.name} are correlated by "
                f"{correlation[i, k]:.4f}: the data determine a combination of both only; fit one "
                "of them, or add points at another condition"
            )
    if set(table["kind"]) - set(found.noises) and found.scatter > 4.0:
        yield (
            f"the points scatter {math.sqrt(found.scatter):.1f} times as far as the stated noise: "
            "case or law miss something; the intervals are widened by that factor"
        )
    yield from _of_residuals(table)


def _why_open(name: str, reached: float) -> str:
    """Return why a constant of a shear law stays open; empty if the stress is not the reason."""
    if name.startswith("limiting") and reached < 0.8:
        return f"; the largest stress is {percentage(reached)} of the limit, which is not reached"
    if name.startswith(("eyring", "carreau")) and reached < 1.0:
        return f"; the largest stress is {percentage(reached)} of it, so that the oil hardly thins"
    return ""


def _of_residuals(table: "pd.DataFrame") -> Iterator[str]:
    """Yield sentences on residuals that follow a curve, and on points far off."""
    for kind, rows in table.groupby("kind", sort=False):
        residual = rows["residual"].to_numpy()
        steps = float(np.sum(np.diff(residual) ** 2) / max(float(residual @ residual), 1e-30))
        if residual.size >= 6 and steps < 1.0:
            yield (
                f"the residuals of {kind} follow a curve (Durbin-Watson {steps:.2f}, random ones "
                "have 2): case or law miss something, and the intervals are too narrow"
            )
    far = table[table["residual"].abs() > 3.5]
    for _, row in far.head(5).iterrows():
        yield (
            f"{row['point']}: {row['kind']} is {abs(row['residual']):.1f} times the noise off the "
            "fit: check the point, or remove it"
        )
