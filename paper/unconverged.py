"""Which of the fine runs did not converge, in words, and what would be needed."""

import math
from collections.abc import Iterable

import pandas as pd

from paper.runs import HEATS, Heat, Runs, Treatment

THINNING = {"C": "C-eyring"}
"""Series, and the same with shear-thinning oil."""
WELL_KNOWN = 0.05
"""Error bar of a film that is well known, over the film."""


def unconverged(
    runs: Runs,
    series: Iterable[str],
    heats: tuple[Heat, ...] = HEATS,
    values: tuple[float, ...] = (),
    treatment: Treatment = "converged",
) -> str:
    """Return which runs did not converge, empty if all did.

    Parameters
    ----------
    runs : Runs
        All runs.
    series : iterable of str
        Names of the series.
    heats, values
        Which of their runs; all values if empty.
    treatment : str
        Of these runs.
    """
    words = []
    for name in series:
        for heat in heats:
            line = runs.line(name, treatment, heat, values)
            words += _failed(runs, name, heat, line)
            coarser = line[line.treatment == "coarser"]
            words += [_coarser(runs, name, coarser)] if len(coarser) else []
    return "; ".join(words)


def _failed(runs: Runs, name: str, heat: Heat, line: pd.DataFrame) -> list[str]:
    """Return a sentence for each way in which runs of a line failed."""
    symbol = runs.series[name].symbol
    failed: dict[str, list[str]] = {}
    for value, run in line[~line.ok.astype(bool)].iterrows():
        cause = run.outcome.replace("not converged: ", "")
        failed.setdefault(f"{cause} on {run.grid} nodes of {run.domain}", []).append(f"{value:g}")
    return [
        f"the {heat} runs at {symbol} = {', '.join(values)} (series {name}) did not converge: {how}"
        for how, values in failed.items()
    ]


def _coarser(runs: Runs, name: str, line: pd.DataFrame) -> str:
    """Return which runs converge on the coarser grid only, and what a known film would take."""
    errors = line.H_min_error / line.H_min
    nodes = int(line.nodes.iloc[0])
    values = ", ".join(f"{value:g}" for value in line.index)
    needed = nodes_needed(nodes, errors.max())
    more = f"; {100 * WELL_KNOWN:.0f} % would take {needed} × {needed}" if needed > nodes else ""
    return (
        f"the thermal runs at {runs.series[name].symbol} = {values} (series {name}) converge on "
        f"{nodes} × {nodes} nodes only, with an error of H_min of {_percent(errors)}{more}"
        f"{_thinning(runs, name)}"
    )


def nodes_needed(nodes: int, error: float) -> int:
    """Return the nodes per direction of a grid on which a film is well known.

    The error falls with the square of the mesh width.

    Parameters
    ----------
    nodes : int
        Of the grid with the relative error ``error``.
    error : float
        Relative error of H_min.
    """
    finer = math.sqrt(max(error / WELL_KNOWN, 1.0))
    return (nodes - 1) * 2 ** math.ceil(math.log2(finer)) + 1


def _thinning(runs: Runs, name: str) -> str:
    """Return how runs with shear-thinning oil between the same waves end."""
    other = THINNING.get(name, "")
    line = runs.line(other, "converged", "thermal")
    if line.empty:
        return ""
    good = line[line.ok.astype(bool)]
    known = f", with an error of H_min of {_percent(good.H_min_error / good.H_min)}"
    return (
        f"; with shear-thinning oil (Eyring, 5 MPa) {len(good)} of {len(line)} runs converge on "
        f"{line.grid.iloc[0]} nodes{known if len(good) else ''}"
    )


def _percent(errors: pd.Series) -> str:
    return f"{100 * errors.min():.0f} to {100 * errors.max():.0f} %"
