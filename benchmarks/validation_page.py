"""Make docs/validation.md: ``python -m benchmarks.validation_page``.

Each number is computed and compared with its reference; the references and their sources are in
``tests/reference``.
"""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.reference import (
    CLOSE,
    DOMAIN,
    heated_contact,
    heated_numbers,
    moes_contact,
    read,
    wavy_contact,
)

from benchmarks import directions_page, line_page, mixed_page, starved_page, uses_page, waves
from benchmarks.markdown import head, row
from benchmarks.table import show
from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.post.waves import WaveResponse, wave_responses
from tehl.solver.judging.richardson import estimate

PAGE = Path(__file__).parents[1] / "docs" / "validation.md"
GRIDS = (129, 257, 513)
HEAD = """\
# Validation

Results of tehl against independent solutions, theory and published curves. `python -m
benchmarks.validation_page` makes this page; `make validate` asserts the same comparisons.

H = h R_x / a_x², central film at X = Y = 0, minimum film between the nodes. Domain X in
[-4.5, 1.5], Y in [-3, 3]; Roelands' law with α = 22 /GPa and η₀ = 0.04 Pa s. The density constants
are stated with each table, because two roundings of the law in use differ by 0.4 % in the film.
"""
HEATED_TOLERANCE = 1e-5
HEATED = """\
Roelands' law with γ = 0.042 /K at T₀ = 313 K, ρ = ρ₀ [1 + 0.6 p / (1 + 1.7 p) - 6.5e-4 (T - T₀)]
with p in GPa; oil 0.14 W/m/K, 2000 J/kg/K, 890 kg/m³; both solids 46 W/m/K, 470 J/kg/K,
7850 kg/m³; p_h = 0.5 GPa, R = 20 mm, u_m = 1.5 m/s, E' = 226 GPa, oil and solids enter at T₀.
Newtonian film, nine nodes across it, `sources = "line"`. The rise is that of the mid-film
temperature at X = Y = 0; the traction is the integral of τ_zx over the pressurised film, over the
load, at surface 1 in pure rolling, else at mid-film. The contact is in
`tests/reference/thermal.toml`.
"""
ONE = """\

To compute one row, M = 200, L = 10 (`tehl new moes > case.toml` has the same lubricant, domain and
density):

```sh
tehl solve case.toml --set contact.moes_load=200 --set contact.moes_speed=10 \\
     --set numerics.points=513 --certify -o out.nc
```
"""


def film(case: dict[str, Any], points: int, density: tuple[float, float]) -> Result:
    """Return the film of a case, iterated to the tolerance."""
    problem = moes_contact(case["M"], case["L"], density=density)
    return solve(problem, Options(points=points, domain=DOMAIN, accuracy="tight"))


def independent(table: dict[str, Any]) -> Iterator[str]:
    """Yield the comparison of extrapolated films with the independent solver."""
    yield "\n## Extrapolated films against an independent solver\n"
    yield f"{table['source']} Density constants {constants(table)}.\n"
    yield from head(
        "M", "L", "film", *(f"{n}²" for n in GRIDS), "order", "tehl", "reference", "difference"
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
    yield "\nTolerances: 0.1 % (central) and 0.3 % (minimum), orders 1.8-2.2 and 1.6-2.5."


def c_program(table: dict[str, Any]) -> Iterator[str]:
    """Yield the comparison on one grid with the C program."""
    yield "\n## Films on 257 x 257 nodes against a C program\n"
    yield f"{table['source']} Density constants {constants(table)}.\n"
    yield from head("M", "L", "film", "tehl", "reference", "difference")
    density = (table["density_slope"], table["density_saturation"])
    for case in table["case"]:
        run = film(case, table["points"], density).film_scaled
        for label, here, there in (
            ("central", run.central, case["h_central"]),
            ("smallest node", run.minimum_node, case["h_minimum_node"]),
        ):
            yield row(
                f"{case['M']:g}", f"{case['L']:g}", label, f"{here:.6f}", f"{there:.6f}",
                f"{100 * (here / there - 1):+.2f} %",
            )  # fmt: skip
    yield "\nTolerances: 0.1 % (central) and 0.5 % (minimum)."


def heated_film(case: dict[str, Any], points: int) -> Result:
    """Return the heated film of a case."""
    problem = heated_contact(case["slide_roll_ratio"], reynolds=case["reynolds"])
    options = Options(points=points, domain=DOMAIN, accuracy="tight", tolerance=HEATED_TOLERANCE)
    return solve(problem, options)


def heated_quantities(case: dict[str, Any], run: Result) -> dict[str, float]:
    """Return the quantities to compare, by their keys in the reference."""
    friction = "traction_surface_1" if case["slide_roll_ratio"] == 0 else "traction_mid_film"
    numbers = heated_numbers(run)
    return {key: numbers[key] for key in ("h_central", "h_minimum", "mid_film_rise", friction)}


WAVY = """\
A wave stands on surface 2. Its ripples in film and pressure are fitted where |X|, |Y| < 0.4 after
the smooth film is subtracted; the fit of an oblique wave includes the streaks from the inlet.
[Theory](theory/roughness.md#linear-theory-of-a-wave) in the limit of large viscosity (Greenwood and
Morales-Espejel, Proc. IMechE J 208 (1994), 121-132; Hooke 2006 in the form of Morales-Espejel and
Brizmer, Tribology Transactions 54 (2011), 625-643): the film keeps C/(1 + C) of the wave, and the
pressure has 1/(1 + C) of π E' A/(2 λ), which flattens it, with C = h E' π/(2 λ B) and the bulk
modulus B of the density law. 513 x 513 nodes on [-2.5, 1.5] x [-2, 2], 19 to 90 nodes per
wavelength; density constants 0.6 and 1.7 /GPa.
"""
LOADS = ((200.0, 10.0), (500.0, 12.34))
WAVES = (0.15, 0.25, 0.35, 0.5)
ANGLES = (0.0, 45.0, 60.0, 90.0)
HEIGHT, WAVY_POINTS = 0.004, 513

PASSING = """\
A wave on surface 1 passes the contact in pure rolling; its harmonic in the film at the centre is
fitted over two periods. The curve is 1/(1 + 0.15 ∇ + 0.015 ∇²) with ∇ = (λ/a) √(M/L) (Venner and
Lubrecht, Proc. IMechE J 214 (2000), 43-62, eq. 29), a fit to computations. 257 x 257 nodes on
[-2.5, 1.5] x [-2, 2], time steps of one mesh width; Richardson extrapolation of second order with
129 x 129 nodes. The amplitude of the waves is 5 % of the film.
"""
PASSED = """
All amplitudes are within 16 % of the curve. The one value printed in its source, 0.739 (M = 1007.6,
L = 12.05, λ = a/4, isotropic), is 5 % above the curve and 2 % below this computation. The curve
does not distinguish transverse waves, which keep a little more, from isotropic ones. Dashes: 129
nodes are too few for the film."""
COLLAPSE = """
Twice the wavelength at a quarter of the load has the same ∇ and is the same wave in the inlet, but
its length relative to the contact differs. Extrapolated amplitudes:
"""
ORDER = """
Order in space and time together, M = 50, L = 10, λ = a on [-4.5, 1.5], 65, 129 and 257 nodes:
{0:.4f}, {1:.4f}, {2:.4f}, order {order:.1f}."""
LONG_WAVES = (0.5, 0.75, 1.0, 1.25, 1.5)
BALANCE_GRIDS, BALANCE_LAYERS = (65, 129, 257), (9, 13, 21)
LABELS = {
    "h_central": ("central film", 5),
    "h_minimum": ("minimum film", 5),
    "mid_film_rise": ("mid-film rise [K]", 4),
    "traction_surface_1": ("traction at surface 1", 7),
    "traction_mid_film": ("traction at mid-film", 5),
}
"""Label and digits of each quantity."""


def heated(table: dict[str, Any]) -> Iterator[str]:
    """Yield the comparison of heated films with the independent solver, and the heat balance."""
    yield "\n## Heated films against an independent solver\n"
    yield f"{table['source']}\n"
    yield HEATED
    runs = [(case, [heated_film(case, points) for points in GRIDS]) for case in table["case"]]
    yield from head(
        "Reynolds", "SRR", "quantity", *(f"{n}²" for n in GRIDS), "order", "tehl",
        "reference", "difference",
    )  # fmt: skip
    for case, films in runs:
        yield from heated_rows(case, films)
    yield (
        "\nTolerances: 0.2 % (films), 1 % or 0.01 K (rise) and 1.5 % or 2e-5 (traction). The "
        "traction of both codes converges with an observed order between one and two."
    )
    yield "\n## Heat balance\n"
    yield (
        "Relative error, in per cent, of shear heat + compression = heat into both solids + "
        "enthalpy carried out. The enthalpy is the divergence by central differences, which the "
        "solver does not use.\n"
    )
    yield from head(
        "Reynolds", "SRR", *(f"{n}²" for n in GRIDS), "shear heat [W]", "into solids [W]"
    )
    for case, films in runs:
        yield balance_row(case, films)
    yield (
        "\nTolerance 0.2 %. Halving the mesh width alone does not halve the error, because nine "
        "nodes across the film contribute 3e-4. Both refined, at SRR 0.5:\n"
    )
    yield from head("nodes across", *(f"{n}²" for n in BALANCE_GRIDS))
    for layers in BALANCE_LAYERS:
        missing = [balance_error(points, layers) for points in BALANCE_GRIDS]
        yield row(str(layers), *(f"{100 * error:.4f}" for error in missing))


def balance_error(points: int, layers: int) -> float:
    """Return the relative error of the heat balance of the sliding reference film."""
    options = Options(points=points, domain=DOMAIN, accuracy="tight", tolerance=HEATED_TOLERANCE)
    heat = solve(heated_contact(0.5, layers=layers), options).heat
    return heat.balance.error if heat else math.nan


def heated_rows(case: dict[str, Any], films: list[Result]) -> Iterator[str]:
    """Yield the rows of one heated film."""
    each = [heated_quantities(case, run) for run in films]
    for key in each[0]:
        first, second, third = (numbers[key] for numbers in each)
        found, there = estimate((first, second, third), domain=0.0), case[key]
        order = "-" if found.observed_order is None else f"{found.observed_order:.2f}"
        label, digits = LABELS[key]
        yield row(
            case["reynolds"], f"{case['slide_roll_ratio']:g}", label,
            *(f"{value:.{digits}f}" for value in (first, second, third)), order,
            f"{found.value:.{digits}f} ± {found.discretisation:.{digits}f}",
            f"{there['value']:.{digits}f} ± {there['error']:.{digits}f}",
            f"{100 * (found.value / there['value'] - 1):+.3f} %",
        )  # fmt: skip


def balance_row(case: dict[str, Any], films: list[Result]) -> str:
    """Return one row of the heat balance."""
    balances = [run.heat.balance for run in films if run.heat is not None]
    last = balances[-1]
    return row(
        case["reynolds"], f"{case['slide_roll_ratio']:g}",
        *(f"{100 * balance.error:.3f}" for balance in balances),
        f"{last.shear:.4f}", f"{last.surface_1 + last.surface_2:.4f}",
    )  # fmt: skip


def wavy() -> Iterator[str]:
    """Yield the comparison of standing waves with linear theory."""
    yield "\n## Standing waves against linear theory\n"
    yield WAVY
    yield from head(
        "M", "L", "λ/a", "angle", "film/wave", "theory", "difference", "pressure/flattening",
        "theory", "difference", "streaks/wave",
    )  # fmt: skip
    options = Options(points=WAVY_POINTS, domain=CLOSE)
    for groups in LOADS:
        smooth = solve(moes_contact(*groups), options)
        for wavelength in WAVES:
            for angle in ANGLES:
                case = wavy_contact(*groups, amplitude=HEIGHT, wavelength=wavelength, angle=angle)
                (found,) = wave_responses(solve(case, options), smooth)
                yield wavy_row(groups, wavelength, angle, found)
    yield (
        "\nTolerance 3 %, also for 30° and for amplitudes of 0.003 and 0.005 a²/R. Crests along "
        "the entrainment (90°) depend on the inlet, which this theory does not include. With a "
        "quadratic background instead of the smooth film the error is up to 5 % at λ = a/2 and 2 % "
        "at shorter waves."
    )


def wavy_row(
    groups: tuple[float, float], wavelength: float, angle: float, found: WaveResponse
) -> str:
    """Return the row of one wave."""
    theory = found.theory
    pressure = found.pressure_amplitude / theory.elastic_pressure
    expected = (theory.film_ratio, theory.pressure / theory.elastic_pressure)
    shown = ["-"] * 4
    if expected[1] > 0:
        shown = [
            f"{expected[0]:.4f}", f"{100 * (found.film_ratio / expected[0] - 1):+.2f} %",
            f"{expected[1]:.4f}", f"{100 * (pressure / expected[1] - 1):+.2f} %",
        ]  # fmt: skip
    return row(
        f"{groups[0]:g}", f"{groups[1]:g}", f"{wavelength:g}", f"{angle:g}°",
        f"{found.film_ratio:.4f}", *shown[:2], f"{pressure:.4f}", *shown[2:],
        f"{found.carried_amplitude / found.amplitude:.3f}",
    )  # fmt: skip


def passing() -> Iterator[str]:
    """Yield the amplitudes of waves that pass in pure rolling, and the published curve."""
    yield "\n## Waves that pass\n"
    yield PASSING
    made = waves.table()
    kept = ("form", "M", "L", "wavelength [a]", "nabla", "amplitude", "extrapolated", "curve",
            "over the curve")  # fmt: skip
    places = [made.columns.index(name) for name in kept]
    yield from head(*kept)
    for cells in made.rows:
        yield row(*(show(cells[place]) for place in places))
    yield PASSED
    yield COLLAPSE
    yield from head(
        "form", "∇", "λ/a at M = 50", "amplitude", "λ/a at M = 200", "amplitude", "difference"
    )
    for isotropic in (False, True):
        yield from (collapse_row(isotropic, wavelength) for wavelength in LONG_WAVES)
    found, order = waves.refined()
    yield ORDER.format(*found, order=order)


def collapse_row(isotropic: bool, wavelength: float) -> str:
    """Return the amplitudes of a wave at M = 50, and of its half at M = 200."""
    long, short = (
        waves.Passing(load=load, speed=10, wavelength=length, isotropic=isotropic)
        for load, length in ((50, wavelength), (200, 0.5 * wavelength))
    )
    one, other = waves.extrapolated(long), waves.extrapolated(short)
    if one is None or other is None:
        raise RuntimeError("a run with a wave failed")
    return row(
        "isotropic" if isotropic else "transverse",
        f"{long.nabla:.3f}",
        f"{wavelength:g}",
        f"{one:.4f}",
        f"{0.5 * wavelength:g}",
        f"{other:.4f}",
        f"{100.0 * (other / one - 1.0):+.1f} %",
    )


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
        *heated(read("thermal")["independent"]),
        *wavy(),
        *passing(),
        *starved_page.section(),
        *mixed_page.section(),
        *line_page.section(),
        *directions_page.section(),
        *uses_page.section(),
        ONE,
    ]
    PAGE.write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
