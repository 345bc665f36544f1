"""The part of docs/validation.md on ellipses at an angle to the entrainment and on spin."""

from collections.abc import Iterator

import numpy as np
from tests.reference import read
from tests.solver.test_spin import RATIO, spinning
from tests.solver.test_turned import turned

from benchmarks.line_page import compared
from benchmarks.markdown import head
from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError, Result
from tehl.api.solvers import solve
from tehl.contact.options import Domain, Options

POINTS = 257
TITLE = f"""
## Entrainment at an angle, and spin, against an independent solver

Semi-smooth Newton solver with the exact Jacobian, h² extrapolation of its two finest grids, errors
0.15 % (central) and 0.3 % (minimum). {POINTS} x {POINTS} nodes, extrapolated, in the boxes of that
solver with zero pressure on their edges; H by the axis a_x of the ellipse. Left and right look
along the entrainment; the right one is the smallest nodal film there.
"""


def section() -> Iterator[str]:
    """Yield the lines of the section."""
    yield TITLE
    yield from head("case", "value", "tehl", "reference", "difference")
    for cited in (one for one in read("directions")["turned"].values() if isinstance(one, dict)):
        problem, on_axes = turned(cited["angle"]), turned(0.0)
        yield from _rows(f"k = 2, {cited['angle']}°", problem, on_axes, cited)
    for name, cited in read("directions")["spin"].items():
        ratio = RATIO if "kappa" in cited else 1.0
        problem = spinning(cited["spin"], cited["M"], cited["L"], ratio)
        yield from _rows(f"{name}, spin {cited['spin']}", problem, problem, cited)
    yield "\nTolerances: 0.2 % (central), 0.5 % (minimum)."


def _rows(
    name: str, problem: ContactProblem, on_axes: ContactProblem, cited: dict[str, float]
) -> Iterator[str]:
    """Yield the rows of a contact; the units of the reference are those of ``on_axes``."""
    found, film = _in_box(problem, on_axes, cited["box"])  # type: ignore[arg-type]
    yield compared(name, "central film", found.film.central / film, cited["h_central"])
    yield compared(name, "minimum film, left", found.film.minimum / film, cited["minimum_left"])
    if "minimum_right" in cited:
        right = float(np.min(found.film_thickness[found.y < 0.0])) / film
        yield compared(name, "minimum film, right", right, cited["minimum_right"])


def _in_box(
    problem: ContactProblem, on_axes: ContactProblem, box: tuple[float, ...]
) -> tuple[Result, float]:
    """Return the film in a box in units of a_x, and the unit of the film [m]."""
    unit, hertz = on_axes.hertz.half_width_x, problem.hertz
    across = hertz.half_width_y if problem is on_axes else unit
    x = [edge * unit / hertz.half_width_x for edge in box[:2]]
    y = [edge * across / hertz.half_width_y for edge in box[2:]]
    domain = Domain(x=(x[0], x[1]), y=(y[0], y[1]))
    options = Options(points=POINTS, domain=domain, edges="zero", extrapolate=True)
    try:
        found = solve(problem, options)
    except ConvergenceError as error:  # the box of 30 degrees is short at the sides
        found = error.result
    return found, unit**2 / on_axes.radius_x
