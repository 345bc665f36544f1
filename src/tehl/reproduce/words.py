"""Words that the page and its Markdown share."""

from collections import Counter
from typing import TYPE_CHECKING

from tehl.reproduce.findings import Findings, RunLine

if TYPE_CHECKING:
    from tehl.reproduce.judge import Word

TREATMENTS = (
    "Each contact is solved twice. “The paper's grid” is the paper's treatment as well as it "
    "can be read: 64 × 64 intervals on [-4, 1.5] × [-2, 2] half-widths, second order, five "
    "V-cycles or its stopping rule (sum of changes below 1e-4 of the sum of pressures), and "
    "where heat is computed, 21 uniform layers and a Reynolds equation with properties at the"
    " mean temperature. “Converged” is the right answer as well as it is known: grids of 257 "
    "or 513 nodes per direction (129 where heated oil flows between waves and finer grids do "
    "not settle) on a wide domain, and the generalised Reynolds equation, whose properties "
    "vary across the film. A number ± its error bar comes from three grids and a larger "
    "domain; with wavy surfaces the bar is that of the grid alone."
)
SETS = (
    "The paper states M and L; the dimensional case behind them is lost. Reference set A (steel"
    " on steel, 1.4 m/s) closes it; set B (four times radius and speed at the same M and L) "
    "shows how far the temperatures depend on what is lost. Viscosity is Roelands' law with S0 "
    "= 1.1, as printed laws (4) and (5) cannot be evaluated: they take the logarithm of a "
    "negative number."
)
MEANING = (
    "The pixels of the figures are not compared: a figure is judged by what the text says of "
    "it. Reproduced: all of that holds, on the paper's grid and converged. Trend only: part of "
    "it holds, or the answer is not converged. Cannot be: none of it holds."
)
RUNS = (
    "Residual: mean of the residual scaled by its diagonal. Change: largest change of pressure "
    "in the last cycle, in Hertz pressures. Runs on the paper's grid stop by its rule, which "
    "says nothing about either."
)


def counted(found: Findings) -> str:
    """Return how many tables and figures of the paper have which verdict."""
    verdicts = [one.verdict.word for one in found.tables]
    verdicts += [one.verdict.word for one in found.figures if one.spec.name.startswith("F")]
    count = Counter(verdicts)
    words: tuple[Word, ...] = ("reproduced", "trend only", "cannot be")
    return "Tables and figures: " + ", ".join(f"{count[word]} {word}" for word in words) + "."


def run_cells(one: RunLine) -> tuple[str, ...]:
    """Return the cells of a run in the list of all runs."""
    if not one.grid:
        return (one.name, one.outcome, *[""] * 7)
    return (
        one.name,
        one.outcome,
        one.grid,
        one.domain,
        f"{one.cycles}",
        f"{one.residual:.1e}",
        f"{one.change:.1e}",
        f"{one.load_error:.1e}",
        f"{one.seconds:.1f}",
    )
