"""Make docs/validation.md: ``python -m benchmarks.validation_page``.

Each number is computed anew and put beside its reference; the references, with their sources, are
in ``tests/reference``.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.reference import DOMAIN, moes_contact, read

from tehl.options import Options
from tehl.result import Result
from tehl.solver import solve
from tehl.solver.certify import estimate

PAGE = Path(__file__).parents[1] / "docs" / "validation.md"
GRIDS = (129, 257, 513)
HEAD = """\
# Validation

This page is made by `python -m benchmarks.validation_page`; `make validate` asserts the same
comparisons. H = h R_x / a_x², central film at X = Y = 0, minimum film between the nodes. Domain
X in [-4.5, 1.5], Y in [-3, 3]; Roelands' law with α = 22 /GPa and η₀ = 0.04 Pa s; the density
constants are stated with each table, because two roundings of the law in use differ by 0.4 % in the
film.
"""
ONE = """\

One row by hand, for M = 200, L = 10 (`tehl new moes > case.toml` writes the same lubricant, domain
and density):

```
tehl solve case.toml --set contact.moes_load=200 --set contact.moes_speed=10 \\
     --set numerics.points=513 --certify -o out.nc
```
"""


def film(case: dict[str, Any], points: int, density: tuple[float, float]) -> Result:
    """Return the film of a case, iterated to the tolerance."""
    problem = moes_contact(case["M"], case["L"], density=density)
    return solve(problem, Options(points=points, domain=DOMAIN, accuracy="tight"))


def row(*cells: object) -> str:
    """Return one line of a table."""
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def head(*names: str) -> list[str]:
    """Return the two first lines of a table."""
    return [row(*names), row(*("---:" for _ in names))]


def independent(table: dict[str, Any]) -> Iterator[str]:
    """Yield the comparison of extrapolated films with the independent solver."""
    yield "\n## Extrapolated films against an independent solver\n"
    yield f"{table['source']} Density constants {constants(table)}.\n"
    yield from head(
        "M", "L", "film", *(f"{n}²" for n in GRIDS), "order", "ours", "reference", "difference"
    )
    density = (table["density_slope"], table["density_saturation"])
    for case in table["case"]:
        runs = [film(case, points, density).film_scaled for points in GRIDS]
        for quantity in ("central", "minimum"):
            first, second, third = (getattr(run, quantity) for run in runs)
            found = estimate((first, second, third), domain=0.0)
            there = case[f"h_{quantity}"]
            order = "-" if found.observed_order is None else f"{found.observed_order:.2f}"
            yield row(
                f"{case['M']:g}", f"{case['L']:g}", quantity,
                *(f"{value:.5f}" for value in (first, second, third)), order,
                f"{found.value:.5f} ± {found.discretisation:.5f}",
                f"{there['value']:.5f} ± {there['error']:.5f}",
                f"{100 * (found.value / there['value'] - 1):+.3f} %",
            )  # fmt: skip
    yield "\nHeld to 0.1 % (central) and 0.3 % (minimum), orders 1.8-2.2 and 1.6-2.5."


def c_program(table: dict[str, Any]) -> Iterator[str]:
    """Yield the comparison on one grid with the C program."""
    yield "\n## Films on 257 x 257 nodes against a C program\n"
    yield f"{table['source']} Density constants {constants(table)}.\n"
    yield from head("M", "L", "film", "ours", "reference", "difference")
    density = (table["density_slope"], table["density_saturation"])
    for case in table["case"]:
        run = film(case, table["points"], density).film_scaled
        for label, ours, there in (
            ("central", run.central, case["h_central"]),
            ("smallest node", run.minimum_node, case["h_minimum_node"]),
        ):
            yield row(
                f"{case['M']:g}", f"{case['L']:g}", label, f"{ours:.6f}", f"{there:.6f}",
                f"{100 * (ours / there - 1):+.2f} %",
            )  # fmt: skip
    yield "\nHeld to 0.1 % (central) and 0.5 % (minimum)."


def constants(table: dict[str, Any]) -> str:
    """Return the constants of the density law as text."""
    slope, saturation = (1e9 * table[f"density_{name}"] for name in ("slope", "saturation"))
    return f"{slope:.4g} and {saturation:.4g} /GPa"


def main() -> None:
    """Write the page."""
    films = read("films")
    lines = [
        HEAD,
        *independent(films["independent"]),
        *c_program(films["c_program"]),
        ONE,
    ]
    PAGE.write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
