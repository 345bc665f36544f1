"""Each physics with each other on small grids: what converges, and what is refused and why."""

from itertools import combinations
from typing import Any

from benchmarks.table import Cell, Table
from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import ConvergenceError
from tehl.api.solvers import certify, solve, solve_transient
from tehl.base.errors import InputError
from tehl.contact.options import Options

Tables = dict[str, Any]

WAVE = {"type": "wave", "amplitude": "0.1 um", "wavelength": "120 um", "angle": "90 deg"}
FEATURES: dict[str, Tables] = {
    "heat": {"thermal": {}},
    "thinning": {"lubricant": {"shear": {"law": "eyring", "stress": "5 MPa"}}},
    "standing": {"surface_1": {"roughness": WAVE}},
    "moving": {"surface_2": {"roughness": WAVE}, "transient": {"duration": "3 ms"}},
    "starved": {"supply": {"layer": "0.4 um"}},
    "conserving": {"cavitation": {"model": "conserving"}},
    "asperities": {
        "asperities": {
            "model": "greenwood-tripp",
            "rms": "0.1 um",
            "summit_radius": "20 um",
            "summit_density": "2e10 1/m^2",
        }
    },
    "boundary": {"contact_film": {"thickness": "60 nm"}},
    "ellipse": {
        "contact": {"radius_x": "20 mm", "radius_y": "40 mm", "entrainment_angle": "30 deg"}
    },
    "load": {"transient": {"duration": "3 ms", "load": [["0 ms", 1.0], ["3 ms", 1.2]]}},
}
"""Tables of each physics, laid over `BASE`."""
LEAST_CERTIFIABLE = 129
"""Nodes from which a grid can be halved twice."""
BASE: Tables = {
    "contact": {"load": "10 N", "entrainment_speed": "0.4 m/s", "slide_roll_ratio": 0.3},
    "surface_1": {"material": "steel"},
    "surface_2": {"material": "steel"},
    "lubricant": {
        "viscosity": {"law": "roelands", "eta_0": "0.04 Pa s", "alpha": "22 1/GPa",
                      "gamma": "0.04 1/K"},
        "density": {"law": "dowson-higginson", "rho_0": "890 kg/m^3"},
        "conductivity": "0.14 W/(m K)",
        "heat_capacity": "2000 J/(kg K)",
    },
}  # fmt: skip


def contact(*features: str) -> ContactProblem:
    """Return a ball on a disc with some of `FEATURES`."""
    tables = {"contact": {"radius": "20 mm"}} if "ellipse" not in features else {}
    for part in (BASE, *(FEATURES[name] for name in features)):
        tables = _laid_over(tables, part)
    return case_from_tables(tables)[0]


def _laid_over(below: Tables, above: Tables) -> Tables:
    both = dict(below)
    for key, value in above.items():
        old = below.get(key)
        nested = isinstance(old, dict) and isinstance(value, dict)
        both[key] = _laid_over(old, value) if nested else value
    return both


def outcome(features: tuple[str, ...], points: int, *, bars: bool = False) -> str:
    """Solve a contact with some features; return "works", or why not in words.

    Parameters
    ----------
    features : tuple of str
        Of `FEATURES`.
    points : int
        Nodes per direction.
    bars : bool
        Certify the result of a steady contact.
    """
    options = Options(points=points)
    try:
        problem = contact(*features)
        if problem.transient is not None:
            run = solve_transient(problem, options)
            return "works" if run.status.converged else f"fails: {run.status.message}"
        found = certify(problem, options) if bars else solve(problem, options)
    except InputError as error:
        return f"refused: {error}"
    except ConvergenceError as error:
        return f"fails: {error}"
    return "works" if found.status.converged else f"fails: {found.status.message}"


def table(points: int, *, quick: bool = False) -> Table:
    """Return a row for each physics, a column for each other one, and one for error bars."""
    names = list(FEATURES)[:3] if quick else list(FEATURES)
    found = {frozenset(pair): outcome(pair, points) for pair in combinations(names, 2)}
    notes = sorted({text for text in found.values() if text != "works"})
    made = Table(
        title=f"Physics that work together, {points} x {points} nodes",
        columns=("physics", *names, "with error bars"),
        notes=[f"{number}: {note}" for number, note in enumerate(notes, start=1)],
    )
    for name in names:
        cells: list[Cell] = []
        for other in names:
            text = found.get(frozenset((name, other)), "")
            cells.append(notes.index(text) + 1 if text in notes else text)
        bars = outcome((name,), max(points, LEAST_CERTIFIABLE), bars=True)
        made.rows.append((name, *cells, bars))
    return made
