"""The part of docs/validation.md on line contacts, and the moments of heated and starved lines."""

from collections.abc import Iterator

import numpy as np
from tests.solver.test_line import BOX, CITED, in_box, line, named
from tests.solver.test_line_physics import hot

from benchmarks.markdown import head, row
from benchmarks.table import Table
from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.operators.upstream import Beyond, rolling

POINTS = 2049
FILMS = f"""
## Line contacts against an independent solver

Semi-smooth Newton solver on pressure and rigid approach, extrapolated from two grids, errors below
2e-5. {POINTS} nodes on X from -4.5 to 1.5; H = hR/b², the rolling friction is the integral of
H P_X over this box. L = 0 is isoviscous and incompressible.
"""
UPSTREAM = """
Default grids and domains, with the oil upstream of the grid, against boxes from X = -20: the film,
and T = F/(E' R) W^(-3/2) with its error bar.
"""
HOT = """
Heated, 0.8 GPa, 1.5 m/s, SRR = 0.5, 513 nodes, 13 nodes across the film:
"""
SPEEDS, SLIDING, PRESSURES = (1.0, 3.0, 10.0), (0.0, 0.2, 1.0), ("0.3 GPa", "0.6 GPa")
SUPPLIED = (0.95, 0.9, 0.8, 0.6, 0.4, 0.2)
"""Oil that enters, over what passes if it is fully flooded."""


def compared(name: str, label: str, here: float, there: float) -> str:
    """Return a row of the comparison of a value with its reference."""
    return row(name, label, f"{here:.6g}", f"{there:.6g}", f"{100 * (here / there - 1):+.3f} %")


def section() -> Iterator[str]:
    """Yield the lines of the section."""
    yield FILMS
    yield from head("case", "value", "tehl", "reference", "difference")
    for name, cited in CITED["box"].items():
        found = in_box(name, POINTS)
        x, pressure, film = found.scaled.x, found.scaled.pressure, found.scaled.film
        yield compared(name, "central film", found.film_scaled.central, cited["h_central"])
        yield compared(name, "minimum film", found.film_scaled.minimum, cited["h_minimum"])
        alone = Beyond(*np.zeros((3, 1)))
        friction = rolling(x, pressure, film, alone, np.ones(1))[0]
        yield compared(name, "rolling friction", friction, cited["rolling"])
    yield UPSTREAM
    yield from head("case", "value", "tehl", "reference", "difference", "error bar")
    for name, cited in CITED["unbounded"].items():
        found = solve(line(*named(name)))
        number, bars = found.summary()["rolling"]["T"], found.errors
        for label, here, there, bar in (
            ("central film", found.film_scaled.central, cited["h_central"], bars.central),
            ("T", number, cited["T"], bars.of("rolling")),
        ):
            yield f"{compared(name, label, here, there)} {100 * bar:.3f} % |"
    yield HOT
    yield from head("case", "value", "tehl", "reference", "difference")
    found, cited = solve(hot(0.5), Options(points=513, domain=BOX)), CITED["heated"]
    summary = found.summary()
    yield compared("hot", "central film", found.film_scaled.central, cited["h_central"])
    yield compared("hot", "minimum film", found.film_scaled.minimum, cited["h_minimum"])
    rise = summary["temperature"]["mid_film_rise_central_k"]
    yield compared("hot", "rise at mid-film, K", rise, cited["mid_film_rise"])
    traction = summary["traction"]["mid_film"]
    yield compared("hot", "traction at mid-film", traction, cited["mid_film_traction"])
    yield "\nTolerances: 0.03 % (central), 0.1 % (minimum, rolling, heated)."


def bearing(pressure: str, speed: float, sliding: float = 0.0, **tables: object) -> ContactProblem:
    """Return a line contact of steel with mineral oil, radius 10 mm."""
    contact = {"type": "line", "radius": "10 mm", "hertz_pressure": pressure}
    contact |= {"entrainment_speed": speed, "slide_roll_ratio": sliding}
    steel = {"material": "steel"}
    tables |= {"contact": contact, "surface_1": steel, "surface_2": steel}
    return ContactProblem.model_validate(tables | {"lubricant": "mineral-oil"})


def relative(found: Result, other: Result) -> tuple[float, float]:
    """Return film and rolling friction over those of another result [-]."""
    assert found.rolling is not None
    assert other.rolling is not None
    return found.film.central / other.film.central, found.rolling.force / other.rolling.force


def tables(*, quick: bool = False) -> Iterator[Table]:
    """Yield film and rolling friction of heated and of starved lines over those without.

    Parameters
    ----------
    quick : bool
        Fewer cases.
    """
    heated = Table(
        title="Rolling friction of heated lines over that of isothermal ones",
        columns=("p_h", "u_m [m/s]", "M", "L", "SRR", "film", "friction"),
    )
    for pressure in PRESSURES[: 1 if quick else None]:
        for speed in SPEEDS[: 1 if quick else None]:
            cold = solve(bearing(pressure, speed))
            for sliding in SLIDING[: 1 if quick else None]:
                numbers = cold.groups.M, cold.groups.L
                found = relative(solve(bearing(pressure, speed, sliding, thermal={})), cold)
                heated.rows.append((pressure, speed, *numbers, sliding, *found))
    yield heated
    starved = Table(
        title="Rolling friction of starved lines over that of flooded ones, 0.6 GPa",
        columns=("u_m [m/s]", "oil", "film", "friction"),
    )
    for speed in (1.0, 10.0)[: 1 if quick else None]:
        cold = solve(bearing("0.6 GPa", speed))
        for ratio in SUPPLIED[: 1 if quick else None]:
            found = solve(bearing("0.6 GPa", speed, supply={"ratio": ratio}))
            starved.rows.append((speed, ratio, *relative(found, cold)))
    yield starved
